//! Part of the report: discretization errors of boundary elements.

use super::cases::Cases;
use super::failures::Failure;
use super::layout::{Numbers, grid, heading, plain, prose};
use super::numbers::{Shown, scaled, shown};
use crate::figures::Panel;
use crate::stats::{Listed, StatsError, grid_help, grid_percent};
use crate::store::Frame;
use crate::text::counted;
use maud::{Markup, html};

/// Grids of the cases with their figures.
#[derive(Debug, Clone)]
pub struct Grids {
    /// Table `grids`.
    pub table: Frame,
    /// Results over the spacing of the grid, a panel for each of the first cases.
    pub panels: Vec<Panel>,
    /// Shifted copies of the coarsest grid.
    pub shifted_copies: u32,
    /// Failed cycles on coarser grids by reason.
    pub failures: Vec<Failure>,
}

const NOTE: &str = "Estimated relative errors of results by boundary elements on the finest grid: contact \
    area A, pull-off force F_{po}, dissipated energy Θ and its parts of events on loading and unloading. \
    The errors follow from the means over surfaces that all grids have, after Roache (1994): with a factor \
    of safety of 1.25 for three grids and 2 for two. They exclude an avalanche that happens next to F_{max} \
    on finer grids only: compare several loads or surfaces. Points: per shortest wavelength, of all grids. \
    Extrapolated Θ: value on an infinitely fine grid, where three grids have a regular series.";

const OF_COPIES: &str = " The errors contain the scatter by the position of the grid: twice the standard \
    deviation over the coarsest grid and its shifted copies, taken as proportional to the spacing.";

/// Columns of errors with their heads.
const ERRORS: [(&str, &str); 5] = [
    ("A", "area_grid_error"),
    ("F_{po}", "pull_off_grid_error"),
    ("Θ", "loss_grid_error"),
    ("Θ, loading", "loading_grid_error"),
    ("Θ, unloading", "unloading_grid_error"),
];

/// Errors of each case with coarser grids, and the figures; nothing without results by boundary elements.
pub(super) fn section(
    of: &Grids,
    cases: &Cases<'_>,
    numbers: &Numbers<'_>,
) -> Result<Option<Markup>, StatsError> {
    let help = grid_help(cases.frame, &(0..cases.frame.row_count()).collect::<Vec<_>>())?;
    let mut rows = Vec::new();
    for listed in cases.rows() {
        rows.extend(row(of, cases, listed)?.map(|cells| (listed.row, cells)));
    }
    if rows.is_empty() && help.is_none() && of.failures.is_empty() {
        return Ok(None);
    }
    let head = html! {
        (cases.name_heads())
        th { "points" } th { "surfaces" } th { "Θ" (cases.scale("loss")?.head()) }
        @for (heading, _) in ERRORS { th { "error of " (prose(heading)) } }
        th { "extrapolated Θ" (cases.scale("loss")?.head()) }
    };
    Ok(Some(html! {
        (heading("Grid error"))
        @if !rows.is_empty() {
            p { (prose(NOTE)) @if of.shifted_copies > 0 { (prose(OF_COPIES)) } } "\n"
            (cases.wide("grid-error", &head, rows))
            @if !of.panels.is_empty() { (grid(numbers, &of.panels)) }
        }
        (failures(&of.failures))
        @if let Some(help) = &help { p { (plain(&sentence(help))) } "\n" }
    }))
}

/// A hint as a sentence.
fn sentence(hint: &str) -> String {
    let mut letters = hint.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).chain(['.']).collect()
}

/// Failed cycles on coarser grids.
fn failures(failures: &[Failure]) -> Markup {
    let count: usize = failures.iter().map(|of| of.count).sum();
    html! {
        @if count > 0 {
            p { (counted(count, "cycle")) " on coarser grids failed: the errors follow from the other \
                 grids, or are unknown." }
            "\n"
            @for of in failures {
                p { (of.example) ": " (plain(&of.problem)) "." }
                "\n"
            }
        }
    }
}

/// Row of a case with coarser grids.
fn row(of: &Grids, cases: &Cases<'_>, listed: &Listed) -> Result<Option<Markup>, StatsError> {
    let id = cases.frame.text("case_id")?[listed.row];
    let load = cases.frame.f64("max_load")?[listed.row];
    let (ids, loads) = (of.table.text("case_id")?, of.table.f64("max_load")?);
    let rows: Vec<usize> = (0..ids.len()).filter(|row| ids[*row] == id && loads[*row] == load).collect();
    let Some(last) = rows.last() else { return Ok(None) };
    let points = of.table.f64("elements_per_wavelength")?;
    let scale = cases.scale("loss")?;
    let errors = ERRORS
        .iter()
        .map(|(_, column)| cases.number(column, listed.row))
        .collect::<Result<Vec<_>, StatsError>>()?;
    Ok(Some(html! {
        (cases.name(listed))
        td { @for (place, row) in rows.iter().enumerate() {
            @if place > 0 { ", " } (shown(Some(points[*row]), Shown::Plain))
        } }
        td { (of.table.i64("surface_count")?[*last]) }
        td { (scaled(cases.number("loss_mean", listed.row)?, scale)) }
        @for error in errors {
            td { @match error {
                Some(error) => (grid_percent(error)),
                None => (shown(None, Shown::Percent)),
            } }
        }
        td { (scaled(of.table.f64_or_null("loss_extrapolated")?[*last], scale)) }
    }))
}
