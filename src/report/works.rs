//! Part of the report: works of adhesion, simulated and predicted by models.

use super::cases::Cases;
use super::layout::{Numbers, grid, heading, prose};
use super::numbers::{Scale, Shown, scaled, shown};
use crate::figures::Panel;
use crate::stats::{Listed, StatsError};
use crate::store::Frame;
use maud::{Markup, html};

/// Works of adhesion over the cut-off wavelength with their figures.
#[derive(Debug, Clone)]
pub struct Works {
    /// Table `cutoff`.
    pub cutoff: Frame,
    /// Works over the cut-off wavelength, a panel for each of the first cases.
    pub panels: Vec<Panel>,
}

const NOTE: &str = "In mJ/m². Simulated: of closing and opening per nominal area, or, with a probe, apparent \
    works on approach and retraction. Models, for all roughness in full contact: U_{el}, elastic energy of \
    flattening; Persson–Tosatti, Δγ(1 + h′²/2) − U_{el} of both branches; Dalvi, closing by Δγ − U_{el} and \
    Θ = ΔγA; pinning, Δγ ∓ kU_{el} with k from 3 to 1.2 (closing) and 1.2 to 3 (opening). Models are empty \
    for U_{el} ≥ Δγ, those of pinning for kU_{el} ≥ Δγ/2. A case without a model at any cut-off wavelength \
    has no figure.";

/// Heads of the columns of the simulated works: of flat surfaces, of probes, and of both.
const SIMULATED: [[&str; 2]; 3] =
    [["closing", "opening"], ["approach", "retraction"], ["closing or approach", "opening or retraction"]];

/// Heads of the columns of models.
const HEADS: [&str; 7] = [
    "Δγ",
    "U_{el}",
    "Persson–Tosatti",
    "Dalvi, closing",
    "pinning, closing",
    "pinning, opening",
    "Δγ A/A_{0}, Dalvi",
];

/// The works of each case next to those of models with all of its roughness, and the figures.
pub(super) fn section(of: &Works, cases: &Cases<'_>, numbers: &Numbers<'_>) -> Result<Markup, StatsError> {
    let mut known = Vec::new();
    for listed in cases.rows() {
        known.extend(simulated(cases.frame, listed.row)?.into_iter().flatten().map(|work| 1e3 * work));
    }
    let scale = Scale::of(&known);
    let radii = cases.frame.f64_or_null("probe_radius_m")?;
    let probes = radii.iter().flatten().count();
    let simulated = match probes {
        0 => SIMULATED[0],
        _ if probes == radii.len() => SIMULATED[1],
        _ => SIMULATED[2],
    };
    let head = html! {
        (cases.name_heads())
        @for heading in simulated { th { (heading) (scale.head()) } }
        @for heading in HEADS { th { (prose(heading)) } }
    };
    let rows = cases
        .rows()
        .iter()
        .map(|listed| Ok((listed.row, row(of, cases, listed, scale)?)))
        .collect::<Result<Vec<_>, StatsError>>()?;
    Ok(html! {
        (heading("Works of adhesion and the models"))
        p { (prose(NOTE)) } "\n"
        (cases.wide("works", &head, rows))
        @if !of.panels.is_empty() { (grid(numbers, &of.panels)) }
    })
}

fn row(of: &Works, cases: &Cases<'_>, listed: &Listed, scale: Scale) -> Result<Markup, StatsError> {
    let ids = of.cutoff.text("case_id")?;
    let id = cases.frame.text("case_id")?[listed.row];
    let last = ids.iter().rposition(|known| *known == id);
    let model = |column: &str| -> Result<Option<f64>, StatsError> {
        Ok(last
            .and_then(|row| of.cutoff.f64_or_null(column).map(|values| values[row]).transpose())
            .transpose()?)
    };
    let simulated = simulated(cases.frame, listed.row)?;
    let milli = |value: Option<f64>| shown(value.map(|value| 1e3 * value), Shown::Plain);
    let pinning = |branch: &str| -> Result<Markup, StatsError> {
        let edge = |end: &str| model(&format!("work_pinning_{branch}_{end}_j_m2"));
        let (low, high) = (edge("low")?, edge("high")?);
        Ok(match (low, high) {
            (Some(_), Some(_)) => html! { (milli(low)) " to " (milli(high)) },
            _ => milli(low.or(high)),
        })
    };
    let area = cases.number("area_at_max_load_mean", listed.row)?;
    let dalvi = model("loss_dalvi_j_m2")?.zip(area).map(|(adhesion, area)| adhesion * area);
    Ok(html! {
        (cases.name(listed))
        @for value in simulated { td { (scaled(value.map(|value| 1e3 * value), scale)) } }
        td { (milli(model("work_of_adhesion_j_m2")?)) }
        td { (milli(model("flattening_j_m2")?)) }
        td { (milli(model("work_persson_tosatti_j_m2")?)) }
        td { (milli(model("work_dalvi_closing_j_m2")?)) }
        td { (pinning("closing")?) }
        td { (pinning("opening")?) }
        td { (milli(dalvi)) }
    })
}

/// Simulated works of adhesion of a row of the table `cases` \[J/m²\]: of closing and opening, with a probe
/// on approach and retraction.
///
/// # Errors
/// If the table lacks a column.
pub fn simulated(cases: &Frame, row: usize) -> Result<[Option<f64>; 2], StatsError> {
    let value = |column: &str| -> Result<Option<f64>, StatsError> {
        Ok(cases.f64_or_null(column)?.get(row).copied().flatten())
    };
    let is_probe = value("probe_radius_m")?.is_some();
    let [first, second] = if is_probe { ["approach", "retraction"] } else { ["closing", "opening"] };
    Ok([value(&format!("work_{first}_j_m2_mean"))?, value(&format!("work_{second}_j_m2_mean"))?])
}
