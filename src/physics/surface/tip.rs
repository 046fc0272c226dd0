//! Tip of a scanning instrument: reliability cut-off, and the rounding that it leaves.
//!
//! A tip of radius R traces no summit that is sharper than itself. Sanner, Nöhring, Thimons, Jacobs and
//! Pastewka (Appl. Surf. Sci. Adv. 7:100190, 2022) therefore compare the curvature of a surface at a scale
//! with that of the tip.

use super::psd_bin::Ring;
use ndarray::ArrayView2;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Half the width of a ring of wavevectors, in octaves.
const HALF_RING: f64 = 0.125;

/// Reliability cut-off of a tip of radius R: the wavelength \[m\] down to which the rms mean curvature of a
/// surface is below 1/R.
///
/// The rms mean curvature is half of the rms Laplacian. It is summed up from the longest wavelength, over the
/// spectrum of the square of side `length_m`. Sanner et al. compare the extreme curvature at a scale with
/// 1/(2R). Nothing if the curvature of all wavelengths together is below 1/R.
#[must_use]
pub fn reliability_cutoff(rings: &[Ring], length_m: f64, radius_m: f64) -> Option<f64> {
    let lowest = TAU / length_m;
    let target = radius_m.powi(-2);
    let (mut below, mut from) = (0.0, lowest);
    for ring in rings {
        let power = ring.density_m4 * ring.mode_count as f64 * lowest * lowest;
        let sum = below + 0.25 * power * ring.wavenumber_1_m.powi(4);
        let to = ring.wavenumber_1_m * HALF_RING.exp2();
        if sum >= target {
            // Between the edges of a ring the sum is a power of the wavenumber.
            let part = if below > 0.0 { (target / below).ln() / (sum / below).ln() } else { 0.0 };
            return Some(TAU / (from * (to / from).powf(part)));
        }
        (below, from) = (sum, to);
    }
    None
}

/// Quantile of the Laplacian that counts as sharp.
const SHARP: f64 = 0.01;
/// Minimum of minus the median Laplacian over its rms, of a surface that consists of rounded summits.
const ROUNDED: f64 = 0.1;
/// Maximum number of points from which quantiles are taken.
const SAMPLE: usize = 1 << 20;

/// Curvature of the sharpest summits over that of the sharpest valleys, of a surface that is rounded nearly
/// everywhere; nothing for other surfaces.
///
/// These are the 1 % quantiles of the Laplacian, by finite differences over
/// `step` points of spacings `spacing_m` along rows and columns. A surface is rounded if the median Laplacian
/// is below -0.1 of its rms. A tip rounds summits to its own radius and leaves valleys as cusps.
#[must_use]
pub fn curvature_ratio(heights_m: ArrayView2<'_, f64>, spacing_m: [f64; 2], step: usize) -> Option<f64> {
    let (rows, columns) = heights_m.dim();
    let inner = |count: usize| count.saturating_sub(2 * step);
    let count = inner(rows) * inner(columns);
    let stride = count.div_ceil(SAMPLE) | 1;
    let [along_rows, along_columns] = spacing_m.map(|spacing| (step as f64 * spacing).powi(-2));
    let laplacian = |k: usize| {
        let (i, j) = (step + k / inner(columns), step + k % inner(columns));
        let twice = 2.0 * heights_m[(i, j)];
        let bend = |a: (usize, usize), b: (usize, usize)| heights_m[a] + heights_m[b] - twice;
        bend((i - step, j), (i + step, j)) * along_rows + bend((i, j - step), (i, j + step)) * along_columns
    };
    let all = (0..count).into_par_iter().step_by(stride).map(laplacian).filter(|value| value.is_finite());
    let mut values: Vec<f64> = all.collect();
    values.par_sort_unstable_by(f64::total_cmp);
    let quantile = |part: f64| values.get((part * values.len() as f64) as usize).copied();
    let (summits, valleys, middle) = (quantile(SHARP)?, quantile(1.0 - SHARP)?, quantile(0.5)?);
    let square: f64 = values.iter().map(|value| value.clamp(summits, valleys).powi(2)).sum();
    let rms = (square / values.len() as f64).sqrt();
    (summits < 0.0 && valleys > 0.0 && middle < -ROUNDED * rms).then(|| -summits / valleys)
}
