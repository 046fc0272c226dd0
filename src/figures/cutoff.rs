//! Works of adhesion over the cut-off wavelength: models, and simulated ones as horizontal lines.

use super::FigureError;
use super::axis::Axis;
use super::captions;
use super::curve::{Curve, Stroke, XyPlot};
use super::panels::Panel;
use super::style::{NEUTRAL, OTHER, RESULT, THEORY, curve, entry, plot, shade};
use crate::store::Frame;

/// Works of adhesion of a case at a load reversal.
#[derive(Debug, Clone)]
pub struct SimulatedWorks {
    /// The case.
    pub case_id: String,
    /// Its label and load, for the caption.
    pub label: String,
    /// Names of the two works: closing and opening, or approach and retraction.
    pub names: [&'static str; 2],
    /// Simulated works \[J/m²\].
    pub works_j_m2: [Option<f64>; 2],
}

/// Line of a model: column, hue and stroke.
type Line = (&'static str, [u8; 3], Stroke);

/// Models with their lines.
const MODELS: [Line; 4] = [
    ("work_persson_tosatti_j_m2", THEORY, Stroke::Solid),
    ("work_dalvi_closing_j_m2", THEORY, Stroke::Dotted),
    ("work_pinning_closing_high_j_m2", RESULT, Stroke::Dashed),
    ("work_pinning_opening_low_j_m2", OTHER, Stroke::Dashed),
];

/// Units of length below the metre, descending.
const UNITS: [(f64, &str); 4] = [(1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"), (1e-12, "pm")];

/// Bands of pinning: name, the two columns of their edges, and hue.
const BANDS: [(&str, [&str; 2], [u8; 3]); 2] = [
    ("work_pinning_closing", ["work_pinning_closing_low_j_m2", "work_pinning_closing_high_j_m2"], RESULT),
    ("work_pinning_opening", ["work_pinning_opening_low_j_m2", "work_pinning_opening_high_j_m2"], OTHER),
];

/// Works of adhesion of one case over the cut-off wavelength, from the table `cutoff`; nothing without rows
/// of the case or where no model has a value. `number` distinguishes the panels of a report.
///
/// # Errors
/// If the table lacks a column.
pub fn works_over_cut_off(
    cutoff: &Frame,
    of: &SimulatedWorks,
    number: usize,
) -> Result<Option<Panel>, FigureError> {
    let ids = cutoff.text("case_id")?;
    let rows: Vec<usize> = (0..ids.len()).filter(|row| ids[*row] == of.case_id).collect();
    let cut_offs = cutoff.f64("cut_off_m")?;
    let (Some(longest), Some(shortest)) = (rows.first(), rows.last()) else { return Ok(None) };
    let ends = [cut_offs[*shortest], cut_offs[*longest]];
    let mut curves = bands(cutoff, &rows)?;
    for (column, hue, stroke) in MODELS {
        let values = cutoff.f64_or_null(column)?;
        let points = rows.iter().filter_map(|row| Some((cut_offs[*row], values[*row]?))).collect();
        curves.push(curve(column, &of.label, points, shade(hue, 0, 1), stroke));
    }
    if curves.iter().all(|curve| curve.points.is_empty()) {
        return Ok(None);
    }
    for ((name, work), hue) in of.names.iter().zip(of.works_j_m2).zip([RESULT, OTHER]) {
        let line = work.map(|work| ends.map(|end| (end, work)).to_vec()).unwrap_or_default();
        curves.push(curve(name, &of.label, line, shade(hue, 0, 1), Stroke::Solid));
    }
    let name = format!("works_{number}");
    let x = axis(ends, &mut curves);
    let y = Axis::holding("w [J/m²]", curves.iter().flat_map(Curve::heights), false).with_headroom(0.6);
    let has = |prefix: &str, is_band: bool| {
        let drawn = |curve: &&Curve| !curve.points.is_empty() && curve.band == is_band;
        curves.iter().filter(drawn).any(|curve| curve.name.starts_with(prefix))
    };
    let bands = if has("work_pinning", true) {
        " Bands: pinning, Δγ ∓ kU_el with k = 1.2 to 3, where kU_el < Δγ/2."
    } else {
        ""
    };
    let caption = format!(
        "Work of adhesion w against the cut-off wavelength λ_c: models for the roughness of all wavelengths \
         from λ_c up, where U_el < Δγ, and the simulated works of all roughness as horizontal lines, for \
         {}.{bands}{}",
        of.label,
        captions::data(&name)
    );
    let names = of.names.map(|name| format!("simulated, {name}"));
    let key = [
        (has(of.names[0], false), entry(&names[0], RESULT, Some(Stroke::Solid), false)),
        (has(of.names[1], false), entry(&names[1], OTHER, Some(Stroke::Solid), false)),
        (has(MODELS[0].0, false), entry("Persson–Tosatti", THEORY, Some(Stroke::Solid), false)),
        (has(MODELS[1].0, false), entry("Dalvi, Δγ − U_{el}", THEORY, Some(Stroke::Dotted), false)),
        (has("work_pinning", false), entry("pinning, k = 1.2", NEUTRAL, Some(Stroke::Dashed), false)),
        (has("work_pinning", true), entry("pinning, k = 1.2 to 3", NEUTRAL, Some(Stroke::Area), false)),
    ];
    let key = key.into_iter().filter(|(is_drawn, _)| *is_drawn).map(|(_, entry)| entry).collect();
    let plot = XyPlot { stem: name.clone(), key, ..plot(String::new(), x, y, curves, &[]) };
    Ok(Some(Panel::alone(&name, caption, plot)))
}

/// Axis of the cut-off wavelengths between two of them \[m\]: in metres over decades, or, for less than two
/// decades, in a smaller unit over doublings, to which the curves are converted.
fn axis([shortest, longest]: [f64; 2], curves: &mut [Curve]) -> Axis {
    let (unit, name) = UNITS.into_iter().find(|(unit, _)| shortest >= *unit).unwrap_or((1.0, "m"));
    if longest > 100.0 * shortest || unit == 1.0 {
        return Axis::of_decades("λ_{c} [m]", [shortest, longest]);
    }
    for point in curves.iter_mut().flat_map(|curve| &mut curve.points) {
        point.0 /= unit;
    }
    Axis::of_doublings(&format!("λ_{{c}} [{name}]"), [shortest / unit, longest / unit])
}

/// Bands of pinning where both edges are known.
fn bands(cutoff: &Frame, rows: &[usize]) -> Result<Vec<Curve>, FigureError> {
    let cut_offs = cutoff.f64("cut_off_m")?;
    let mut curves = Vec::new();
    for (name, edges, hue) in BANDS {
        let [low, high] = [cutoff.f64_or_null(edges[0])?, cutoff.f64_or_null(edges[1])?];
        let known: Vec<(f64, [f64; 2])> =
            rows.iter().filter_map(|row| Some((cut_offs[*row], [low[*row]?, high[*row]?]))).collect();
        let middle = known.iter().map(|(at, [low, high])| (*at, 0.5 * (low + high))).collect();
        let errors = known.iter().map(|(_, [low, high])| Some(0.5 * (high - low))).collect();
        let line = curve(name, "", middle, shade(hue, 0, 1), Stroke::Area);
        curves.push(Curve { errors, band: true, ..line });
    }
    Ok(curves)
}
