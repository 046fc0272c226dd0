//! Panels A and C: what goes along the path of a cycle.

use super::FigureError;
use super::axis::Axis;
use super::curve::{Curve, KeyEntry, Note, Stroke, XyPlot};
use super::style::{MOST_NOTES, NEUTRAL, curve, entry};
use super::sweep::{Member, Sweep};
use super::units::{Quantity, Scales};
use crate::store::Frame;

/// Loading and unloading paths of every member, of a quantity in some units. The area cannot be negative.
pub(super) fn paths(
    table: &Frame,
    sweep: &Sweep,
    column: &str,
    (quantity, scales): (Quantity, &Scales<'_>),
) -> Result<XyPlot, FigureError> {
    let (ids, branches) = (table.text("case_id")?, table.text("branch")?);
    let (max_loads, loads, values) =
        (table.f64_or_null("max_load")?, table.f64("load")?, table.f64(&format!("{column}_mean"))?);
    let spreads = table.f64_or_null(&format!("{column}_sd"))?;
    let picked = |member: &Member, branch: &str, max_load: Option<f64>, stroke: Stroke| -> Curve {
        let of_it = |row: &usize| {
            ids.get(*row) == Some(&member.case_id.as_str())
                && branches.get(*row) == Some(&branch)
                && max_loads.get(*row) == Some(&max_load)
        };
        let units = scales.factor(Quantity::Load, member.row).zip(scales.factor(quantity, member.row));
        let rows: Vec<usize> = (0..table.row_count()).filter(|row| units.is_some() && of_it(row)).collect();
        let (unit_x, unit_y) = units.unwrap_or_default();
        let point = |row: &usize| Some((unit_x * loads.get(*row)?, unit_y * values.get(*row)?));
        let points = rows.iter().filter_map(point).collect();
        let error = |row: &usize| spreads.get(*row).copied().flatten().map(|spread| unit_y * spread);
        let errors: Vec<Option<f64>> = rows.iter().map(error).collect();
        let of_path = curve(branch, &member.label, points, member.colour.clone(), stroke);
        let positive = quantity == Quantity::Area;
        Curve { band: errors.iter().any(Option::is_some), errors, positive, ..of_path }
    };
    let (mut curves, mut notes, mut drawn) = (Vec::new(), Vec::new(), Vec::new());
    let (beside, every) = (!sweep.differing.is_empty(), sweep.members.len().div_ceil(MOST_NOTES));
    // One loading path serves all load reversals of a case: it has the colour of the largest load.
    for member in sweep.members.iter().rev() {
        if !drawn.contains(&member.case_id) {
            curves.push(picked(member, "loading", None, Stroke::Dashed));
            drawn.push(member.case_id.clone());
        }
    }
    curves.reverse();
    for (at, member) in sweep.members.iter().enumerate() {
        let unloading = picked(member, "unloading", Some(member.max_load), Stroke::Solid);
        if let Some(end) = unloading.points.first()
            && sweep.members.len() > 1
            && at % every == 0
        {
            notes.push(Note { at: *end, text: member.label.clone(), beside });
        }
        curves.push(unloading);
    }
    let mut key = key_of(&curves);
    if !beside && !notes.is_empty() {
        let symbol = sweep.load_symbol.replace('*', "^{*}");
        key.push(entry(&format!("numbers: {symbol}"), NEUTRAL, None, false));
    }
    let all = || curves.iter().flat_map(|curve: &Curve| curve.points.iter());
    // Numbers at the ends need room to the right of the last one.
    let room = if beside || notes.is_empty() { 0.0 } else { 0.1 };
    let (x, y) = (
        Axis::holding(scales.label(Quantity::Load), all().map(|point| point.0), true).with_headroom(room),
        Axis::holding(scales.label(quantity), curves.iter().flat_map(Curve::heights), true),
    );
    Ok(XyPlot { notes, ..unnamed([x, y], curves, key) })
}

/// A plot without names and notes.
pub(super) fn unnamed([x, y]: [Axis; 2], curves: Vec<Curve>, key: Vec<KeyEntry>) -> XyPlot {
    let (stem, title, notes) = (String::new(), String::new(), Vec::new());
    XyPlot { stem, letter: ' ', title, x, y, curves, key, notes, margin: 0.0 }
}

/// Entries of the strokes and of the bands.
fn key_of(curves: &[Curve]) -> Vec<KeyEntry> {
    let mut key = vec![
        entry("loading", NEUTRAL, Some(Stroke::Dashed), false),
        entry("unloading", NEUTRAL, Some(Stroke::Solid), false),
    ];
    if curves.iter().any(|curve| curve.band) {
        let cut = if curves.iter().any(Curve::is_cut) { ", end at 0" } else { "" };
        key.push(entry(&format!("bands: ± one standard deviation{cut}"), NEUTRAL, None, false));
    }
    key
}
