//! Results by boundary elements over the spacing of the grid, with the error of the finest one.

use super::FigureError;
use super::axis::Axis;
use super::captions;
use super::curve::{Curve, Stroke, XyPlot};
use super::panels::Panel;
use super::style::{OTHER, RESULT, curve, entry, plot, shade};
use crate::store::Frame;

/// Results: column of the table `grids` without its ending, stem of its error, name in the key, and hue.
const QUANTITIES: [(&str, &str, &str, [u8; 3]); 2] =
    [("loss", "loss", "Θ", RESULT), ("pull_off_load", "pull_off", "F_{po}", OTHER)];

/// Ratios that the panel shows: beyond, a value is outside.
const SHOWN: [f64; 2] = [-1.0, 3.0];

/// A case at a load reversal.
#[derive(Debug, Clone)]
pub struct OfGrids<'a> {
    /// The case.
    pub case_id: &'a str,
    /// Its load reversal F_max/(E* A0).
    pub max_load: f64,
    /// Its label and load, for the caption.
    pub label: &'a str,
}

/// Dissipated energy and pull-off force of a case on its grids, over their values on the finest grid; nothing
/// without rows of the table `grids`. `number` distinguishes the panels of a report.
///
/// # Errors
/// If the table lacks a column.
pub fn over_grids(grids: &Frame, of: &OfGrids<'_>, number: usize) -> Result<Option<Panel>, FigureError> {
    let (ids, loads) = (grids.text("case_id")?, grids.f64("max_load")?);
    let rows: Vec<usize> =
        (0..ids.len()).filter(|row| ids[*row] == of.case_id && loads[*row] == of.max_load).collect();
    let points = grids.f64("elements_per_wavelength")?;
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return Ok(None) };
    let spacing = |row: usize| 1.0 / points[row];
    let coarsest = 1.05 * spacing(*first);
    let (mut curves, mut key) = (Vec::new(), Vec::new());
    for (column, stem, name, hue) in QUANTITIES {
        let means = grids.f64_or_null(&format!("{column}_mean"))?;
        let error = grids.f64_or_null(&format!("{stem}_grid_error"))?[*last];
        let limit = grids.f64_or_null(&format!("{stem}_extrapolated"))?[*last];
        let Some(finest) = means[*last].filter(|finest| *finest != 0.0) else { continue };
        let band =
            curve("grid_error", name, vec![(0.0, 1.0), (coarsest, 1.0)], shade(hue, 0, 1), Stroke::Area);
        curves.extend(error.map(|_| Curve { errors: vec![error; 2], band: true, ..band }));
        let values = rows.iter().filter_map(|row| Some((spacing(*row), means[*row]? / finest))).collect();
        let line = curve(column, name, values, shade(hue, 0, 1), Stroke::Solid);
        curves.push(Curve { marked: true, ..line });
        let at_limit = limit.map(|limit| (0.0, limit / finest)).into_iter().collect();
        curves.push(curve("extrapolated", name, at_limit, shade(hue, 0, 1), Stroke::Diamonds));
        key.push(entry(name, hue, Some(Stroke::Solid), true));
        key.push(entry(&format!("{name}, grid error"), hue, Some(Stroke::Area), false));
    }
    let name = format!("grids_{number}");
    let x = Axis::holding("grid spacing/shortest wavelength", [0.0, coarsest], true);
    let heights = curves.iter().flat_map(Curve::heights).map(|height| height.clamp(SHOWN[0], SHOWN[1]));
    let y = Axis::holding("value/value on finest grid", heights, false);
    let has = |wanted: &str| curves.iter().any(|curve| curve.name == wanted && !curve.points.is_empty());
    let bands = if has("grid_error") { " Bands: estimated error of the finest grid." } else { "" };
    let limits = if has("extrapolated") {
        " Diamonds: extrapolated to an infinitely fine grid, where three grids have a regular series."
    } else {
        ""
    };
    let caption = format!(
        "Θ and F_po against the grid spacing, over their values on the finest grid, for {}: means over \
         surfaces that all grids have.{bands}{limits}{}",
        of.label,
        captions::data(&name)
    );
    let plot =
        XyPlot { stem: name.clone(), key, ..plot(String::new(), x, y.with_headroom(0.5), curves, &[]) };
    Ok(Some(Panel::alone(&name, caption, plot)))
}
