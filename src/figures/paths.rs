//! Panels A and C: what goes along the path of a cycle.

use super::FigureError;
use super::axis::Axis;
use super::plot::{Curve, Note, Stroke, XyPlot};
use super::style::{LOADING, MOST_NOTES, UNLOADING, curve, entry, shade};
use super::sweep::{Member, Sweep};
use crate::store::Frame;

const LOAD: &str = "F/(E^{*}A_{0})";

/// Loading and unloading paths of every member.
pub(super) fn paths(table: &Frame, sweep: &Sweep, column: &str, label: &str) -> Result<XyPlot, FigureError> {
    let (ids, branches) = (table.text("case_id")?, table.text("branch")?);
    let (max_loads, loads, values) = (table.f64_or_null("max_load")?, table.f64("load")?, table.f64(column)?);
    let picked = |member: &Member, branch: &str, max_load: Option<f64>| -> Vec<(f64, f64)> {
        let rows = (0..table.row_count()).filter(|row| {
            ids.get(*row) == Some(&member.case_id.as_str()) && branches.get(*row) == Some(&branch) && max_loads.get(*row) == Some(&max_load)
        });
        rows.filter_map(|row| loads.get(row).copied().zip(values.get(row).copied())).collect()
    };
    let (mut curves, mut notes, mut drawn) = (Vec::new(), Vec::new(), Vec::new());
    let beside = !sweep.differing.is_empty();
    let every = sweep.members.len().div_ceil(MOST_NOTES);
    for (at, member) in sweep.members.iter().enumerate() {
        // One loading path serves all turning points of a case.
        if !drawn.contains(&member.case_id) {
            curves.push(curve(
                picked(member, "loading", None),
                shade(LOADING, at, if beside { sweep.members.len() } else { 1 }),
                Stroke::Dashed,
            ));
            drawn.push(member.case_id.clone());
        }
        let unloading = picked(member, "unloading", Some(member.max_load));
        if let Some(end) = unloading.first()
            && sweep.members.len() > 1
            && at % every == 0
        {
            notes.push(Note { at: *end, text: member.label.clone(), beside });
        }
        curves.push(curve(unloading, shade(UNLOADING, at, sweep.members.len()), Stroke::Solid));
    }
    let mut key = vec![entry("loading", LOADING, Some(Stroke::Dashed), false), entry("unloading", UNLOADING, Some(Stroke::Solid), false)];
    if !beside && !notes.is_empty() {
        key.push(entry("numbers: F_{max}/(E^{*}A_{0})", LOADING, None, false));
    }
    let all = || curves.iter().flat_map(|curve: &Curve| curve.points.iter());
    // Numbers at the ends need room to the right of the last one.
    let room = if beside || notes.is_empty() { 0.0 } else { 0.1 };
    let (x, y) =
        (Axis::holding(LOAD, all().map(|point| point.0), true).with_headroom(room), Axis::holding(label, all().map(|point| point.1), true));
    Ok(XyPlot { stem: String::new(), letter: ' ', title: String::new(), x, y, curves, key, notes })
}
