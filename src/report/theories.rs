//! Part of the report: comparison with analytical models.

use super::cases::Cases;
use super::layout::{heading, prose};
use super::numbers::scaled;
use crate::stats::{Listed, StatsError};
use maud::{Markup, html};

/// Heading, and column of the table `cases` without its `_mean`.
type Columns = &'static [(&'static str, &'static str)];

const ENERGIES: Columns = &[
    ("Θ, this simulation", "loss"),
    ("Θ_{DK}, target spectrum", "loss_dk"),
    ("Θ_{DK}, realised spectrum", "loss_dk_realised"),
    ("Θ_{DK}, R_{tip} = R, target spectrum", "loss_dk_probe"),
    ("Θ_{DK}, R_{tip} = R, realised spectrum", "loss_dk_probe_realised"),
    ("Σθ over contacting asperities", "loss_touched"),
    ("Δγ A", "loss_dalvi"),
    ("2kU_{el}A, pinning", "loss_pinning"),
    ("Θ, JKR from adhesionless curve", "loss_jkr_curve"),
];

const AREAS: Columns = &[
    ("A/A_{0}, this simulation", "area_at_max_load"),
    ("A/A_{0}, JKR from adhesionless curve", "area_jkr_curve"),
    ("A/A_{0}, Persson, adhesionless", "area_adhesionless"),
    ("2F/(E*A_{0}h′), adhesionless", "area_adhesionless_small"),
    ("U_{el}/Δγ", "persson_tosatti_realised"),
    ("U_{el}/(2Δγ)", "sticky_line"),
    ("Fuller–Tabor parameter", "fuller_tabor"),
];

/// Column that the asperity model alone has.
const OF_SPOTS: &str = "loss_touched";

/// Columns that a probe alone has.
const OF_PROBE: [&str; 2] = ["loss_dk_probe", "loss_dk_probe_realised"];

const NOTE: &str = "Dissipated energies are over E*A_{0}h_{rms}, at the simulated contact area.";

const MODELS: [&str; 8] = [
    "Θ_{DK}, Deng and Kesari (Eqs A1–A4, corrected): mean dissipated energy of one asperity times Nayak's \
     summit density and the contact area.",
    "Θ_{DK} with R_{tip} = R: the same for a probe of radius R, with the contact area of the smooth sphere \
     by JKR theory at load reversal less that after its jump into contact. Other Θ_{DK} have R_{tip} → ∞.",
    "Σθ: sum over contacting asperities without elastic interaction, with jump into contact at zero \
     penetration.",
    "Δγ A: work of adhesion times contact area, an empirical relation near full contact (Dalvi et al. 2019).",
    "2kU_{el}A with k = 1.35: crack-front pinning in a connected, weakly rough contact (Sanner et al. 2024; \
     prefactor of hysteron), empty for kU_{el} ≥ Δγ/2.",
    "JKR from adhesionless curve: load and area of adhesive contact from those without adhesion on the same \
     surface (Ciavarella 2018); boundary elements only.",
    "Adhesionless areas: Persson's theory, and the small-load limit of boundary-element results, with the \
     realised rms slope h′.",
    "U_{el}/Δγ (Persson and Tosatti) or U_{el}/(2Δγ) (Wang and Müser) below 1, or a Fuller–Tabor parameter \
     below about 10: adhesion is strong.",
];

/// Dissipated energies, contact areas and adhesion parameters of analytical models.
pub(super) fn theories(cases: &Cases<'_>) -> Result<Markup, StatsError> {
    let has_spots = cases.has_spots()?;
    let has_probe = cases.has_probe()?;
    Ok(html! {
        (heading("Comparison with analytical models"))
        p { (prose(NOTE)) } "\n"
        ul {
            "\n"
            @for model in MODELS.iter().filter(|model| {
                (has_spots || !model.starts_with("Σθ"))
                    && (has_probe || !model.starts_with("Θ_{DK} with R_{tip}"))
            }) {
                li { (prose(model)) } "\n"
            }
        } "\n"
        (table(cases, "models", ENERGIES)?)
        (table(cases, "models-area", AREAS)?)
    })
}

/// A table of columns that the run has.
fn table(cases: &Cases<'_>, name: &str, columns: Columns) -> Result<Markup, StatsError> {
    let (has_spots, has_probe) = (cases.has_spots()?, cases.has_probe()?);
    let is_shown =
        |column: &str| (has_spots || column != OF_SPOTS) && (has_probe || !OF_PROBE.contains(&column));
    let mut shown = Vec::new();
    for (heading, column) in columns.iter().filter(|(_, column)| is_shown(column)) {
        shown.push((heading, column, cases.scale(column)?));
    }
    let head = html! {
        (cases.name_heads()) @for (heading, _, scale) in &shown { th { (prose(heading)) (scale.head()) } }
    };
    let row = |listed: &Listed| -> Result<(usize, Markup), StatsError> {
        let mut cells = Vec::new();
        for (_, column, scale) in &shown {
            cells.push(scaled(cases.number(&format!("{column}_mean"), listed.row)?, *scale));
        }
        Ok((listed.row, html! { (cases.name(listed)) @for cell in cells { td { (cell) } } }))
    };
    let rows = cases.rows().iter().map(row).collect::<Result<Vec<_>, _>>()?;
    Ok(cases.wide(name, &head, rows))
}
