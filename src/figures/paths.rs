//! Panels A and C: what goes along the path of a cycle.

use super::FigureError;
use super::axis::Axis;
use super::curve::{Curve, KeyEntry, Note, Stroke, XyPlot};
use super::style::{NEUTRAL, curve, entry};
use super::sweep::{Member, Sweep};
use super::units::{Quantity, Scales};
use crate::store::Frame;

/// Curves of a plot with bands, at most.
const MOST_BANDS: usize = 4;
/// Values of the horizontal axis of the results that have a panel of paths each.
pub(super) const MOST_FACETS: usize = 6;

/// Loading and unloading paths of every member, of a quantity in some units: one plot, or one for each value
/// of the first parameter where several vary. The area cannot be negative.
pub(super) fn paths(
    table: &Frame,
    sweep: &Sweep,
    column: &str,
    (quantity, scales): (Quantity, &Scales<'_>),
) -> Result<Vec<XyPlot>, FigureError> {
    let groups = facets(sweep);
    let of_group = |members: &Vec<&Member>| -> Result<Parts, FigureError> {
        let source = Source { table, column, quantity, scales };
        let mut curves: Vec<Curve> = with_loading(members)
            .map(|member| source.curve(member, "loading", members.len()))
            .collect::<Result<_, _>>()?;
        let unloading: Vec<Curve> = members
            .iter()
            .map(|member| source.curve(member, "unloading", members.len()))
            .collect::<Result<_, _>>()?;
        let notes = noted(sweep, members.iter().copied(), &unloading);
        curves.extend(unloading);
        Ok((facet_title(sweep, members), curves, notes))
    };
    let parts: Vec<Parts> = groups.iter().map(of_group).collect::<Result<_, _>>()?;
    let all = || parts.iter().flat_map(|(_, curves, _)| curves);
    // Numbers at the ends need room to the right of the last one.
    let beside = !sweep.differing.is_empty();
    let room = if beside || parts.iter().all(|(_, _, notes)| notes.is_empty()) { 0.0 } else { 0.1 };
    let loads = all().flat_map(|curve| curve.points.iter().map(|point| point.0));
    let x = Axis::holding(scales.label(Quantity::Load), loads, true).with_headroom(room);
    let y = Axis::holding(scales.label(quantity), all().flat_map(Curve::heights), true);
    let plot = |(title, curves, notes): Parts| {
        let mut key = key_of(&curves);
        if !beside && !notes.is_empty() {
            let symbol = sweep.load_symbol.replace('*', "^{*}");
            key.push(entry(&format!("numbers: {symbol}"), NEUTRAL, None, false));
        }
        XyPlot { title, notes, ..unnamed([x.clone(), y.clone()], curves, key) }
    };
    Ok(parts.into_iter().map(plot).collect())
}

/// The last member of each case, by load. One loading path serves all load reversals of a case: it has the
/// colour of the largest load.
pub(super) fn with_loading<'a>(members: &[&'a Member]) -> impl Iterator<Item = &'a Member> {
    let is_last = |k: &usize| members[k + 1..].iter().all(|later| later.case_id != members[*k].case_id);
    (0..members.len()).filter(is_last).map(|k| members[k])
}

/// Names of finished members at the ends of their curves.
pub(super) fn noted<'a>(
    sweep: &Sweep,
    members: impl IntoIterator<Item = &'a Member>,
    curves: &[Curve],
) -> Vec<Note> {
    let beside = !sweep.differing.is_empty();
    let named = members.into_iter().zip(curves).filter(|_| curves.len() > 1 || sweep.has_facets);
    let note = |(member, curve): (&Member, &Curve)| {
        let text = if sweep.has_facets { &member.series } else { &member.label };
        curve.points.first().map(|end| Note { at: *end, text: text.clone(), beside })
    };
    named.filter_map(note).collect()
}

/// Title of the plot of some members: the value that they share.
pub(super) fn facet_title(sweep: &Sweep, members: &[&Member]) -> String {
    members.first().filter(|_| sweep.has_facets).map_or_else(String::new, |member| member.facet.clone())
}

/// Title, curves and notes of a plot.
pub(super) type Parts = (String, Vec<Curve>, Vec<Note>);

/// Members by value of the first parameter where several vary; of many values the first, the last and some
/// between.
pub(super) fn facets(sweep: &Sweep) -> Vec<Vec<&Member>> {
    if !sweep.has_facets {
        return vec![sweep.members.iter().collect()];
    }
    let places = places(sweep);
    let last = places.len().saturating_sub(1);
    let shown = places.len().min(MOST_FACETS);
    let at = |k: usize| places[if shown > 1 { k * last / (shown - 1) } else { 0 }];
    let members = |x: f64| sweep.members.iter().filter(|one| one.x.total_cmp(&x).is_eq()).collect();
    (0..shown).map(at).map(members).collect()
}

/// Different values of the first parameter with finished cases, in ascending order.
pub(super) fn places(sweep: &Sweep) -> Vec<f64> {
    let finished = sweep.members.iter().filter(|member| member.is_finished);
    let mut places: Vec<f64> = finished.map(|member| member.x).collect();
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| a.total_cmp(b).is_eq());
    places
}

/// Table and columns of paths, with their units.
struct Source<'a> {
    table: &'a Frame,
    column: &'a str,
    quantity: Quantity,
    scales: &'a Scales<'a>,
}

impl Source<'_> {
    /// Path of a branch of a member, one of a number in the same plot.
    fn curve(&self, member: &Member, branch: &str, of: usize) -> Result<Curve, FigureError> {
        let Self { table, column, quantity, scales } = *self;
        let (ids, branches) = (table.text("case_id")?, table.text("branch")?);
        let (max_loads, loads, values) =
            (table.f64_or_null("max_load")?, table.f64("load")?, table.f64(&format!("{column}_mean"))?);
        let spreads = table.f64_or_null(&format!("{column}_sd"))?;
        let (max_load, stroke) = match branch {
            "loading" => (None, Stroke::Dashed),
            _ => (Some(member.max_load), Stroke::Solid),
        };
        let of_it = |row: &usize| {
            ids[*row] == member.case_id && branches[*row] == branch && max_loads[*row] == max_load
        };
        let units = scales.factor(Quantity::Load, member.row).zip(scales.factor(quantity, member.row));
        let rows: Vec<usize> = (0..table.row_count()).filter(|row| units.is_some() && of_it(row)).collect();
        let (unit_x, unit_y) = units.unwrap_or_default();
        let points = rows.iter().map(|row| (unit_x * loads[*row], unit_y * values[*row])).collect();
        let errors: Vec<Option<f64>> = rows
            .iter()
            .map(|row| spreads[*row].map(|spread| unit_y * spread).filter(|_| of <= MOST_BANDS))
            .collect();
        let band = errors.iter().any(Option::is_some);
        let positive = quantity == Quantity::Area;
        let path = curve(branch, &member.label, points, member.colour.clone(), stroke);
        Ok(Curve { band, errors, positive, ..path })
    }
}

/// A plot without names and notes.
pub(super) fn unnamed([x, y]: [Axis; 2], curves: Vec<Curve>, key: Vec<KeyEntry>) -> XyPlot {
    let (stem, title, notes) = (String::new(), String::new(), Vec::new());
    XyPlot { stem, letter: ' ', title, x, y, curves, key, notes, margin: 0.0 }
}

/// Entries of the strokes and of the bands.
pub(super) fn key_of(curves: &[Curve]) -> Vec<KeyEntry> {
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
