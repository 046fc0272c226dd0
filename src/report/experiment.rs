//! Part of the report: measured loops and the simulated ones.

use super::cases::Cases;
use super::layout::{Numbers, grid, heading, prose, wide};
use super::numbers::{Shown, shown};
use crate::figures::Panel;
use crate::stats::StatsError;
use crate::store::Frame;
use maud::{Markup, html};

/// Measured loops with their figure.
#[derive(Debug, Clone)]
pub struct MeasuredLoops {
    /// Table `measured_loops`.
    pub loops: Frame,
    /// Load over penetration.
    pub panel: Panel,
}

const NOTE: &str = "Measured: ± half-width of the 95 % confidence interval. Simulated: mean over \
    realizations of the nominal square. F_{po}: pull-off force. Θ: dissipated energy. E_{c}, E_{o}: \
    energies of closing and of opening. \
    w: apparent works of adhesion, from F_{po}, from Θ, and from JKR fits of approach and retraction. E*: \
    apparent modulus. Data: `measured_loops.parquet` and `measured_steps.parquet` in `statistics`.";

/// Heading and column of the measured loops. A column of this name of the table `realizations` has the
/// simulated value.
const COLUMNS: [(&str, &str); 9] = [
    ("F_{po} [N]", "pull_off_load_n"),
    ("Θ [J]", "loss_j"),
    ("E_{c} [J]", "work_closing_j"),
    ("E_{o} [J]", "work_opening_j"),
    ("w, F_{po} [J/m²]", "work_pull_off_j_m2"),
    ("w, Θ [J/m²]", "work_loss_j_m2"),
    ("w, approach [J/m²]", "work_approach_j_m2"),
    ("w, retraction [J/m²]", "work_retraction_j_m2"),
    ("E* [Pa]", "contact_modulus_fit_pa"),
];

/// Mean over the realizations of a row of the table `cases`, if they have the column.
fn mean(cases: &Cases<'_>, row: usize, column: &str) -> Result<Option<f64>, StatsError> {
    let of = cases.realizations;
    if of.table().column(column).is_none() {
        return Ok(None);
    }
    let (ids, loads) = (of.text("case_id")?, of.f64("max_load")?);
    let case = (cases.frame.text("case_id")?[row], cases.frame.f64("max_load")?[row]);
    let own = of.f64_or_null(column)?.iter().enumerate().filter(|(k, _)| (ids[*k], loads[*k]) == case);
    let values: Vec<f64> = own.filter_map(|(_, value)| *value).collect();
    Ok((!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64))
}

/// One figure and one table of measured and simulated loops.
pub(super) fn section(
    of: &MeasuredLoops,
    cases: &Cases<'_>,
    numbers: &Numbers<'_>,
) -> Result<Markup, StatsError> {
    let head = html! {
        th { "loop" } th { "kind" } @for (heading, ..) in COLUMNS { th { (prose(heading)) } }
    };
    let sources = of.loops.text("source")?;
    let mut rows = Vec::new();
    for (row, source) in sources.iter().enumerate() {
        let mut cells = Vec::new();
        for (_, column) in COLUMNS {
            let value = of.loops.f64_or_null(column)?.get(row).copied().flatten();
            let limit = of.loops.f64_or_null(&format!("{column}_ci95_high"))?.get(row).copied().flatten();
            let width = limit.zip(value).map(|(limit, value)| limit - value);
            cells.push(html! {
                (shown(value, Shown::Plain)) @if width.is_some() { " ± " (shown(width, Shown::Plain)) }
            });
        }
        rows.push(html! { td { (source) } td { "measured" } @for cell in cells { td { (cell) } } });
    }
    for listed in cases.rows() {
        let mut cells = Vec::new();
        for (_, column) in COLUMNS {
            cells.push(shown(mean(cases, listed.row, column)?, Shown::Plain));
        }
        rows.push(html! {
            td { (listed.label) ", " (prose(cases.load_symbol())) " = " (cases.load(listed.row)) }
            td { "simulated" } @for cell in cells { td { (cell) } }
        });
    }
    Ok(html! {
        (heading("Measured loops"))
        p { (prose(NOTE)) } "\n"
        (wide("measured loops", &head, &rows))
        (grid(numbers, [&of.panel]))
    })
}
