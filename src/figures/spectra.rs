//! Power spectral densities of the scans of one sample, and their common spectrum.

use super::FigureError;
use super::axis::Axis;
use super::captions;
use super::curve::{Curve, KeyEntry, Stroke, XyPlot};
use super::panels::Panel;
use super::style::{THEORY, case_colour, curve, entry, plot};
use crate::store::Frame;

/// Name of the panel in the table of panels.
const NAME: &str = "spectrum";
/// Scans that the key names.
const MOST_NAMED: usize = 7;

/// Tables of the scans of a run.
#[derive(Debug, Clone, Copy)]
pub struct Spectra<'a> {
    /// Table `spectrum`.
    pub common: &'a Frame,
    /// Table `scan_spectra`.
    pub of_scans: &'a Frame,
    /// Table `scans`.
    pub scans: &'a Frame,
}

/// A panel for each case with a common spectrum: density of each scan, and of all.
///
/// # Errors
/// If a table lacks a column.
pub fn spectra(tables: &Spectra<'_>) -> Result<Vec<Panel>, FigureError> {
    let mut cases: Vec<&str> = tables.of_scans.text("case_id")?;
    cases.dedup();
    cases.into_iter().enumerate().map(|(place, case)| panel(tables, place, case)).collect()
}

fn panel(tables: &Spectra<'_>, place: usize, case: &str) -> Result<Panel, FigureError> {
    let (mut curves, mut key) = of_scans(tables, case)?;
    let points = rows(tables.common, case, &["wavenumber_1_m", "density_m4"])?;
    let common = points.iter().map(|row| (row[0], row[1])).collect();
    let common = curve("common spectrum", case, common, super::style::shade(THEORY, 0, 1), Stroke::Solid);
    curves.push(Curve { marked: true, ..common });
    key.push(entry("common spectrum", THEORY, Some(Stroke::Solid), true));
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let x = Axis::of_decades("q [1/m]", all().map(|point| point.0));
    let y = Axis::of_decades("C [m^{4}]", all().map(|point| point.1)).with_headroom(0.25);
    let stem = if place == 0 { NAME.to_owned() } else { format!("{NAME}_{}", place + 1) };
    let caption = format!(
        "Power spectral density C with ∫ C d²q = h_rms² against wavenumber q = 2π/λ. Each scan: solid \
         between its limits of reliability (crosses), dotted outside. Common spectrum: mean over \
         the scans that are reliable at q.{}",
        captions::data(&stem)
    );
    let plot = XyPlot { stem: stem.clone(), key, ..plot(String::new(), x, y, curves, &[]) };
    Ok(Panel::alone(&stem, caption, plot))
}

/// Curves and key of the scans of a case.
fn of_scans(tables: &Spectra<'_>, case: &str) -> Result<(Vec<Curve>, Vec<KeyEntry>), FigureError> {
    let of = tables.of_scans;
    let (cases, scans) = (of.text("case_id")?, of.i64("realization")?);
    let (q, density, reliable) = (of.f64("wavenumber_1_m")?, of.f64("density_m4")?, of.bool("reliable")?);
    let names = names(tables.scans, case)?;
    let (mut curves, mut key) = (Vec::new(), Vec::new());
    for (place, (scan, name)) in names.iter().enumerate() {
        let rows: Vec<usize> =
            (0..q.len()).filter(|k| cases[*k] == case && scans[*k] == *scan && density[*k] > 0.0).collect();
        let inside = |k: &&usize| reliable[**k];
        let point = |k: &usize| (q[*k], density[*k]);
        let first = rows.iter().position(|k| reliable[*k]).unwrap_or(rows.len());
        let last = rows.iter().rposition(|k| reliable[*k]).unwrap_or_default();
        let colour = case_colour(place, 0, 1);
        let mut add = |name: &str, points: Vec<(f64, f64)>, stroke: Stroke| {
            // One point outside would be drawn as a mark.
            if points.len() > 1 || stroke == Stroke::Solid && points.len() == 1 {
                curves.push(curve(name, case, points, colour.clone(), stroke));
            }
        };
        add(name, rows.iter().filter(inside).map(point).collect(), Stroke::Solid);
        let outside = format!("{name}, outside");
        add(&outside, rows.iter().take(first + 1).map(point).collect(), Stroke::Dotted);
        if first < rows.len() {
            add(&outside, rows.iter().skip(last).map(point).collect(), Stroke::Dotted);
            let ends = [rows[first], rows[last]];
            add(&format!("{name}, limits"), ends.iter().map(point).collect(), Stroke::Crosses);
        }
        let mut named = entry(name, THEORY, Some(Stroke::Solid), false);
        named.colour = colour;
        if place < MOST_NAMED {
            key.push(named);
        }
    }
    if names.len() > MOST_NAMED {
        key.push(entry(&format!("{} more", names.len() - MOST_NAMED), THEORY, None, false));
    }
    Ok((curves, key))
}

/// Numbers and files of the scans of a case.
fn names(scans: &Frame, case: &str) -> Result<Vec<(i64, String)>, FigureError> {
    let (cases, numbers) = (scans.text("case_id")?, scans.i64_or_null("realization")?);
    let files = scans.text_or_null("surface_file")?;
    let of_case = (0..cases.len()).filter(|k| cases[*k] == case);
    Ok(of_case.filter_map(|k| Some((numbers[k]?, files[k].clone().unwrap_or_default()))).collect())
}

/// Values of columns in the rows of a case.
fn rows(frame: &Frame, case: &str, columns: &[&str]) -> Result<Vec<Vec<f64>>, FigureError> {
    let cases = frame.text("case_id")?;
    let values: Vec<Vec<f64>> = columns.iter().map(|name| frame.f64(name)).collect::<Result<_, _>>()?;
    let of_case = (0..cases.len()).filter(|k| cases[*k] == case);
    Ok(of_case.map(|k| values.iter().map(|column| column[k]).collect()).collect())
}
