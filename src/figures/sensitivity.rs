//! Sensitivity chart: relative differences of all cases from the reference case.

use super::axis::Axis;
use super::drawing::Drawing;
use super::style::{RESULT, shade};
use super::{FigureError, markup};
use crate::stats::{Difference, difference_of, labels, listing};
use crate::store::Frame;
use std::fmt::Write as _;

/// Compared quantities: symbol and column of the table `cases` without its ending.
const QUANTITIES: [(&str, &str); 3] = [("A", "area_at_max_load"), ("F_{po}", "pull_off_load"), ("Θ", "loss")];
/// The quantity that orders the rows.
const ORDER: usize = 2;
/// Rows, at most: those with the largest differences are drawn.
const MOST_ROWS: usize = 40;
/// Height of a row, height of a bar, width of a column and gap between two columns \[pixels\].
const ROW: f64 = 22.0;
const BAR: f64 = 13.0;
const COLUMN: f64 = 210.0;
const GAP: f64 = 22.0;
const TEXT: u32 = 13;

/// A case: label, and relative difference with the half-width of its confidence interval of each quantity, in
/// percent.
struct Row {
    label: String,
    changes: [Option<(f64, Option<f64>)>; 3],
}

/// The chart; nothing where fewer than two cases differ from a reference case.
///
/// # Errors
/// If a table lacks a column.
pub fn sensitivity(cases: &Frame, realizations: &Frame) -> Result<Option<Drawing>, FigureError> {
    let (mut rows, reference) = rows(cases, realizations)?;
    let Some(reference) = reference.filter(|_| rows.len() > 1) else { return Ok(None) };
    let size = |row: &Row| row.changes[ORDER].map_or(0.0, |change| change.0.abs());
    rows.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let all = rows.len();
    rows.truncate(MOST_ROWS);
    let left = rows.iter().map(|row| markup::width(&row.label, TEXT)).fold(0.0, f64::max) + 12.0;
    let (width, foot) = (left + QUANTITIES.len() as f64 * (COLUMN + GAP), 14.0 + rows.len() as f64 * ROW);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {width:.1} {0:.1}\" xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.1}\" \
         height=\"{0:.1}\" font-family=\"DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif\" \
         fill=\"black\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>",
        foot + 44.0
    );
    for (k, row) in rows.iter().enumerate() {
        let y = 14.0 + (k as f64 + 0.5) * ROW;
        // Writing to a string cannot fail.
        let _ = write!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"{TEXT}\" text-anchor=\"end\">{}</text>",
            left - 8.0,
            y + 4.5,
            escaped(&row.label)
        );
    }
    for (place, (symbol, _)) in QUANTITIES.iter().enumerate() {
        svg += &column(&rows, place, symbol, left + place as f64 * (COLUMN + GAP), foot);
    }
    svg += "</svg>";
    let shown = if all > rows.len() {
        format!("the {} cases with the largest differences of {all}", rows.len())
    } else {
        format!("{all} cases")
    };
    let caption = format!(
        "Relative differences of the means from the reference case ({reference}) at the same load, {shown}: \
         contact area A, pull-off force F_po and dissipated energy Θ. Lines: 95 % confidence interval. Data: \
         statistics/cases.parquet and realizations.parquet (area_at_max_load, pull_off_load, loss)."
    );
    Ok(Some(Drawing::new("sensitivity", caption, &markup::render(&svg))))
}

/// The cases that differ from a reference case, and the reference case.
fn rows(cases: &Frame, realizations: &Frame) -> Result<(Vec<Row>, Option<String>), FigureError> {
    let list = listing(cases)?;
    let loads = cases.f64("max_load")?;
    let texts = labels(&loads);
    let many = loads.windows(2).any(|pair| pair[0] != pair[1]);
    let mut rows = Vec::new();
    for (listed, reference) in
        list.rows.iter().filter_map(|listed| listed.reference.map(|reference| (listed, reference)))
    {
        let mut changes = [None; 3];
        for (change, (_, name)) in changes.iter_mut().zip(QUANTITIES) {
            *change = difference_of(cases, realizations, [listed.row, reference], name)?.and_then(percent);
        }
        let load = if many { format!(", F_{{max}} = {}", texts[listed.row]) } else { String::new() };
        rows.push(Row { label: format!("{}{load}", listed.label), changes });
    }
    Ok((rows, list.reference))
}

/// A difference and its half-width in percent of the reference.
fn percent(of: Difference) -> Option<(f64, Option<f64>)> {
    let share = |part: f64| Some(100.0 * part / of.means[1].abs()).filter(|share| share.is_finite());
    share(of.of).map(|change| (change, of.ci95.and_then(share)))
}

/// The bars of a quantity above their axis.
fn column(rows: &[Row], place: usize, symbol: &str, left: f64, foot: f64) -> String {
    let changes = || rows.iter().map(|row| row.changes[place]);
    let ends = changes()
        .flatten()
        .flat_map(|(change, half)| [change - half.unwrap_or(0.0), change, change + half.unwrap_or(0.0)]);
    let axis = Axis::holding(&format!("change of {symbol} [%]"), ends.chain([0.0]), false);
    let (low, high) = axis.drawn_range();
    let at = |value: f64| left + COLUMN * (axis.drawn(value) - low) / (high - low);
    let mut svg = String::new();
    for (k, (change, half)) in
        changes().enumerate().filter_map(|(k, change)| change.map(|change| (k, change)))
    {
        let y = 14.0 + (k as f64 + 0.5) * ROW;
        let (from, to) = (at(change.min(0.0)), at(change.max(0.0)));
        let _ = write!(
            svg,
            "<rect x=\"{from:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{BAR}\" fill=\"{}\"/>",
            y - BAR / 2.0,
            to - from,
            shade(RESULT, 0, 2)
        );
        if let Some(half) = half {
            let _ = write!(
                svg,
                "<path d=\"M{:.1} {y:.1}H{:.1}\" stroke=\"black\" stroke-width=\"1.5\"/>",
                at(change - half),
                at(change + half)
            );
        }
    }
    let _ = write!(
        svg,
        "<path d=\"M{0:.1} 10V{foot:.1}\" stroke=\"black\"/>\
         <path d=\"M{left:.1} {foot:.1}h{COLUMN}\" stroke=\"black\"/>\
         <text x=\"{1:.1}\" y=\"{2:.1}\" font-size=\"14\" text-anchor=\"middle\">{3}</text>",
        at(0.0),
        left + COLUMN / 2.0,
        foot + 37.0,
        axis.full_label()
    );
    for tick in axis.ticks() {
        let x = left + COLUMN * (tick - low) / (high - low);
        let _ = write!(
            svg,
            "<path d=\"M{x:.1} {foot:.1}v4\" stroke=\"black\"/><text x=\"{x:.1}\" y=\"{:.1}\" \
             font-size=\"12\" text-anchor=\"middle\">{}</text>",
            foot + 17.0,
            axis.tick_label(tick)
        );
    }
    svg
}

/// Text without the signs of a tag.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
