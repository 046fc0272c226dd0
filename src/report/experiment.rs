//! Part of the report: measured loops and the simulated ones.

use super::cases::Cases;
use super::layout::{Numbers, grid, heading, prose, unbroken, wide};
use super::numbers::{Scale, scaled, with_half_width};
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
    let sources = of.loops.text("source")?;
    let mut rows = vec![Vec::new(); sources.len() + cases.rows().len()];
    let mut scales = Vec::new();
    for (_, column) in COLUMNS {
        let measured = of.loops.f64_or_null(column)?;
        let limits = of.loops.f64_or_null(&format!("{column}_ci95_high"))?;
        let mut simulated = Vec::new();
        for listed in cases.rows() {
            simulated.push(mean(cases, listed.row, column)?);
        }
        let known: Vec<f64> = measured.iter().chain(&simulated).flatten().copied().collect();
        let scale = Scale::of(&known);
        let half = |row: usize| limits[row].zip(measured[row]).map(|(limit, value)| limit - value);
        let values = (0..sources.len()).map(|row| with_half_width(measured[row], half(row), scale));
        let values = values.chain(simulated.iter().map(|value| scaled(*value, scale)));
        rows.iter_mut().zip(values).for_each(|(row, value)| row.push(value));
        scales.push(scale);
    }
    let head = html! {
        th { "loop" }
        th { "kind" }
        @for ((heading, _), scale) in COLUMNS.iter().zip(&scales) { th { (prose(heading)) (scale.head()) } }
    };
    let measured = sources.iter().map(|source| html! { td { (source) } td { "measured" } });
    let simulated = cases.rows().iter().map(|listed| {
        let load = format!("{} = {}", cases.load_symbol(), cases.load(listed.row));
        html! { td { (unbroken(&listed.label)) ", " (prose(&unbroken(&load))) } td { "simulated" } }
    });
    let rows: Vec<Markup> = measured
        .chain(simulated)
        .zip(rows)
        .map(|(name, cells)| html! { (name) @for cell in cells { td { (cell) } } })
        .collect();
    Ok(html! {
        (heading("Measured loops"))
        p { (prose(NOTE)) } "\n"
        (wide("measured loops", &head, &rows))
        (grid(numbers, [&of.panel]))
    })
}
