//! Artefacts of a measurement: their correction, and the remaining ones.

use super::edges::Edges;
use super::outliers::{deviations, find_outliers, replace_outliers};
use super::psd_bin::Ring;
use super::rows::{Aligned, align, line_jump};
use super::spectrum::Moments;
use crate::model::FastAxis;
use ndarray::Array2;
use std::f64::consts::{PI, TAU};

/// Corrections of a scan before its preprocessing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corrections {
    /// True if outliers are replaced.
    pub outliers: bool,
    /// Direction of the scan lines whose offsets are removed; nothing if they are kept.
    pub align: Option<FastAxis>,
    /// True if the scan continues periodically.
    pub periodic: bool,
}

/// Corrected and remaining artefacts of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Artefacts {
    /// Outliers that were replaced.
    pub outlier_count: usize,
    /// Outliers that remain.
    pub outlier_left_count: usize,
    /// Largest height or depth of these against their neighbours \[m\].
    pub outlier_left_m: f64,
    /// Rms value of these heights over all points of the scan \[m\].
    pub outlier_left_rms_m: f64,
    /// Offsets of scan lines that were removed.
    pub aligned: Option<Aligned>,
    /// Rms offset of scan lines that remains \[m\], 0 if there is none.
    pub line_jump_m: f64,
    /// Direction of the lines with that offset.
    pub jump_axis: FastAxis,
}

/// Corrects heights \[m\], and counts what remains. Heights that are not finite are missing and remain
/// missing.
pub fn correct(heights_m: &mut Array2<f64>, corrections: &Corrections) -> Artefacts {
    let aligned = corrections.align.map(|axis| align(heights_m, axis));
    let edges = Edges::of(corrections.periodic);
    let mut found = find_outliers(heights_m.view(), edges);
    let mut outlier_count = 0;
    if corrections.outliers && !found.is_empty() {
        replace_outliers(heights_m, &found, edges);
        outlier_count = found.len();
        found = find_outliers(heights_m.view(), edges);
    }
    let left = deviations(heights_m.view(), &found, edges);
    let squares: f64 = left.iter().map(|height| height * height).sum();
    let [rows, columns] = [line_jump(heights_m.view()), line_jump(heights_m.t())];
    Artefacts {
        outlier_count,
        outlier_left_count: found.len(),
        outlier_left_m: left.iter().fold(0.0, |most: f64, height| most.max(height.abs())),
        outlier_left_rms_m: (squares / heights_m.len().max(1) as f64).sqrt(),
        aligned,
        line_jump_m: rows.max(columns),
        jump_axis: if columns > rows { FastAxis::Columns } else { FastAxis::Rows },
    }
}

/// Limits of the effect of an outlier: its height after the S-filter over h_rms, its curvature after the
/// S-filter over the rms mean curvature, and the rms height of all outliers over h_rms.
const EFFECTS: [f64; 3] = [0.1, 1.0, 0.03];

/// Largest effect of the remaining outliers on the filtered surface, over its limit.
///
/// A low-pass of cut-off `points` leaves an isolated point the height π/points², and the curvature of its
/// shortest wavelength.
#[must_use]
pub fn outlier_effect(artefacts: &Artefacts, moments: &Moments, points: f64, shortest_m: f64) -> f64 {
    let height = artefacts.outlier_left_m * PI / (points * points);
    let rms_height = moments.rms_height_m();
    let curvature = height * (TAU / shortest_m).powi(2);
    let of_limit = [
        height / rms_height,
        curvature / (0.5 * moments.rms_curvature_1_m()),
        artefacts.outlier_left_rms_m / rms_height,
    ];
    of_limit.into_iter().zip(EFFECTS).map(|(effect, limit)| effect / limit).fold(0.0, f64::max)
}

/// Exponent p of the spectral density `C ∝ q^p` of the wavelengths up to `shortest_m` \[m\], which the
/// S-filter removes; nothing with fewer than three rings.
///
/// It is -2(H+1), below -2, for a self-affine surface, and 0 for independent errors of the points.
#[must_use]
pub fn noise_exponent(rings: &[Ring], shortest_m: f64) -> Option<f64> {
    let removed =
        rings.iter().filter(|ring| ring.wavenumber_1_m * shortest_m >= TAU && ring.density_m4 > 0.0);
    let points: Vec<[f64; 3]> =
        removed.map(|r| [r.wavenumber_1_m.ln(), r.density_m4.ln(), r.mode_count as f64]).collect();
    if points.len() < 3 {
        return None;
    }
    let whole: f64 = points.iter().map(|[_, _, weight]| weight).sum();
    let mean =
        |of: &dyn Fn(&[f64; 3]) -> f64| points.iter().map(|point| point[2] * of(point)).sum::<f64>() / whole;
    let (x, y) = (mean(&|point| point[0]), mean(&|point| point[1]));
    let exponent = mean(&|point| (point[0] - x) * (point[1] - y)) / mean(&|point| (point[0] - x).powi(2));
    exponent.is_finite().then_some(exponent)
}
