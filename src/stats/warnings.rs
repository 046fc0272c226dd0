//! Warnings of a run with measured values, limits and rows.

use super::cautions::{CAUTIONS, Caution, GRID_ERROR, LIMITS, Limit};
use super::{StatsError, grid_percent, significant};
use crate::store::Frame;
use crate::text::counted;

/// A warning of one or more rows of the table `cases`.
#[derive(Debug, Clone, PartialEq)]
pub struct Warning {
    /// Code, label, consequence and action.
    pub kind: Caution,
    /// Measured values over these rows, and the limit.
    pub measured: String,
    /// The rows, in order.
    pub rows: Vec<usize>,
}

/// All warnings of the table `cases`, in the order of [`CAUTIONS`].
///
/// # Errors
/// If the table lacks a column.
pub fn warnings(cases: &Frame) -> Result<Vec<Warning>, StatsError> {
    let all: Vec<usize> = (0..cases.row_count()).collect();
    warnings_of(cases, &all)
}

/// The warnings of some rows of the table `cases`, with the values of these rows.
///
/// # Errors
/// If the table lacks a column.
pub fn warnings_of(cases: &Frame, among: &[usize]) -> Result<Vec<Warning>, StatsError> {
    let codes = cases.text("caution")?;
    let mut found = Vec::new();
    for kind in CAUTIONS {
        let has = |row: &usize| codes[*row].split('+').any(|code| code == kind.code);
        let rows: Vec<usize> = among.iter().copied().filter(has).collect();
        if !rows.is_empty() {
            found.push(Warning { kind, measured: measured(cases, &kind, &rows)?, rows });
        }
    }
    Ok(found)
}

fn measured(cases: &Frame, kind: &Caution, rows: &[usize]) -> Result<String, StatsError> {
    if let Some(limit) = LIMITS.iter().find(|limit| limit.caution == kind.code) {
        let numbers = cases.f64_or_null(limit.column)?;
        let values: Vec<f64> = rows.iter().filter_map(|row| numbers[*row]).collect();
        let text = measured_text(kind, *limit, &values);
        return Ok(if kind.code == "coarse" { text + &grid_errors(cases, rows)? } else { text });
    }
    let (done, planned, failed) =
        (cases.i64("done_count")?, cases.i64("planned_count")?, cases.i64("failed_count")?);
    let not_reached = cases.i64_or_null("not_reached_count")?;
    // A case has a row for each load reversal, and its cycles count once.
    let ids = cases.text("case_id")?;
    let firsts: Vec<usize> = rows
        .iter()
        .copied()
        .filter(|row| rows.iter().find(|other| ids[**other] == ids[*row]) == Some(row))
        .collect();
    let total = |counts: &[i64]| firsts.iter().map(|row| counts[*row]).sum::<i64>();
    if kind.code == "full_contact" {
        return Ok(kind.text.replace("{}", "1"));
    }
    if kind.code == "coarse_steps" {
        let (steps, halvings) = (cases.f64_or_null("approach_step")?, cases.f64_or_null("halvings")?);
        let shortest = rows.iter().filter_map(|row| Some(steps[*row]? / halvings[*row]?.exp2()));
        return Ok(kind.text.replace("{}", &significant(shortest.fold(0.0, f64::max), 3)));
    }
    if kind.code == "not_reached" {
        let unreached: i64 = rows.iter().map(|row| not_reached[*row].unwrap_or_default()).sum();
        let all: i64 = rows.iter().map(|row| done[*row] + not_reached[*row].unwrap_or_default()).sum();
        return Ok(kind.text.replace(
            "{}",
            &format!("{unreached} of {}", counted(usize::try_from(all).unwrap_or_default(), "loop")),
        ));
    }
    if kind.code == GRID_ERROR {
        let range = range_of_errors(cases, "loss_grid_error", rows)?;
        return Ok(kind
            .text
            .replace("{}", &range.map_or_else(|| "is unknown".to_owned(), |of| format!("= {of}"))));
    }
    if kind.code != "incomplete" {
        let all = counted(usize::try_from(total(&planned)).unwrap_or_default(), "realization");
        return Ok(kind.text.replace("{}", &format!("{} of {all}", total(&failed))));
    }
    let of_rows = || rows.iter().map(|row| done[*row]);
    let (low, high) = (of_rows().min().unwrap_or_default(), of_rows().max().unwrap_or_default());
    let each = match (firsts.len(), low == high) {
        (1, _) => String::new(),
        (_, true) => format!(" ({low} per case)"),
        (_, false) => format!(" ({low} to {high} per case)"),
    };
    Ok(kind.text.replace("{}", &format!("{} of {}", total(&done), total(&planned))) + &each)
}

/// Estimated grid errors of Θ and F_po of rows, as the end of a sentence; empty without any.
fn grid_errors(cases: &Frame, rows: &[usize]) -> Result<String, StatsError> {
    let mut parts = Vec::new();
    for (symbol, column) in [("Θ", "loss_grid_error"), ("F_po", "pull_off_grid_error")] {
        parts.extend(range_of_errors(cases, column, rows)?.map(|range| format!("{range} of {symbol}")));
    }
    Ok(if parts.is_empty() { String::new() } else { format!("; grid error {}", parts.join(", ")) })
}

/// Smallest and largest grid error of rows; nothing where all are unknown.
fn range_of_errors(cases: &Frame, column: &str, rows: &[usize]) -> Result<Option<String>, StatsError> {
    let errors = cases.f64_or_null(column)?;
    let known = || rows.iter().filter_map(|row| errors[*row]);
    let [low, high] =
        [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| known().reduce(pick).map(grid_percent));
    let range = |(low, high): (String, String)| {
        if low == high { low } else { format!("{} to {high}", low.trim_end_matches(" %")) }
    };
    Ok(low.zip(high).map(range).map(|range| range.replace(" %", "\u{a0}%")))
}

/// Measured values of a warning with their limit: `A/A₀ = 31 to 35 % (limit 30 %)`.
#[must_use]
pub fn measured_text(kind: &Caution, limit: Limit, values: &[f64]) -> String {
    format!("{} (limit {})", kind.text.replace("{}", &range(limit, values)), bound(limit))
}

/// The interval of measured values: `76 %`, `76 to 87 %`, `0.99 to 1.02`.
fn range(limit: Limit, values: &[f64]) -> String {
    let number =
        |value: f64| if limit.is_fraction() { significant(100.0 * value, 2) } else { significant(value, 3) };
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    let (low, high) = (number(low), number(high));
    let text = if low == high { low } else { format!("{low} to {high}") };
    if limit.is_fraction() { format!("{text}\u{a0}%") } else { text }
}

fn bound(limit: Limit) -> String {
    match limit {
        _ if limit.is_fraction() => format!("{}\u{a0}%", significant(100.0 * limit.bound, 2)),
        _ if limit.at_least => format!("≥ {}", limit.bound),
        _ => format!("≤ {}", limit.bound),
    }
}
