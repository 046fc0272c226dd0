//! Import of a measured surface: central crop, harmonic in-fill, levelling and S-filter.
//!
//! The model requires a smooth field on a square grid, as a generated surface is. A scan has noise down to
//! its points. Wavelengths shorter than `points_per_shortest_wavelength` points are removed, by a Gaussian
//! filter or by a sharp cut-off on a disc of wavevectors. The remaining field determines the summits as on a
//! generated surface.
//!
//! A field that does not continue periodically has derivatives of its own ([`super::continuation`]). For the
//! sharp cut-off it is extended by its mirror images: heights then stay continuous, whereas periodic images
//! would jump. Summits closer to an edge than half a shortest wavelength are excluded, since heights there
//! depend on the rule for the edges.

pub use super::measured_summits::find_measured;
use crate::PhysicsError;

use super::continuation::{self, margin};
use super::edges::Edges;
use super::infill::fill;
use super::levelling::{ROUNDING, check_size, level};
use super::modes::Field;
use super::periodogram::{continues, tapered_periodogram, windowed_periodogram};
use super::psd_bin::{Estimate, Ring};
use super::s_filter::{gaussian, overshoot};
use super::self_affine::{SelfAffine, fit_self_affine};
use super::spectrum::Moments;
use crate::memory::zeros;
use crate::model::{Detrend, Filter, Missing};
use ndarray::{Array2, ArrayView2, s};

/// Minimum and maximum number of points along a side.
pub const MIN_POINTS: usize = 16;
/// 1 GiB of heights.
///
/// The mirror extension needs four times as much during filtering.
pub const MAX_POINTS: usize = 8192;

/// Maximum fraction of missing points.
pub(super) const MAX_MISSING_FRACTION: f64 = 0.5;
/// Relative difference of the point spacings below which they count as equal.
pub(super) const SPACING_TOLERANCE: f64 = 1e-3;
/// Maximum ratio of the two spacings that is resampled.
pub(super) const MAX_SPACING_RATIO: f64 = 16.0;

/// Share of the mean square Laplacian that an octave of wavelengths must hold to affect the asperities.
///
/// Without an octave that holds less, the rms curvature is lower by up to 5 %.
pub const MIN_CURVATURE_SHARE: f64 = 0.1;

/// Preprocessing of a measured surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Treatment {
    /// Treatment of missing points.
    pub missing: Missing,
    /// Form subtracted from the heights.
    pub detrend: Detrend,
    /// True if the field continues periodically.
    pub periodic: bool,
    /// Low-pass filter.
    pub filter: Filter,
    /// S-filter cut-off wavelength in points.
    pub points_per_shortest_wavelength: f64,
}

/// Measured surface after import, ready for the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// Heights relative to their mean \[m\], on a square.
    pub heights_m: Array2<f64>,
    /// Side of the square \[m\].
    pub length_m: f64,
    /// Moments of the realised spectrum.
    pub moments: Moments,
    /// Power spectral density before the S-filter, in rings of wavevectors.
    pub rings: Vec<Ring>,
    /// Self-affine spectrum that fits it; nothing where too few rings hold data.
    pub fit: Option<SelfAffine>,
    /// Number of missing points in the square.
    pub missing_count: usize,
    /// Rms height of the form removed by levelling \[m\].
    pub trend_m: f64,
    /// Rms height of the short wavelengths removed by the S-filter \[m\].
    pub noise_m: f64,
    /// Largest height of filtered maxima above the unfiltered heights nearby, beyond the noise \[m\].
    pub overshoot_m: f64,
    /// S-filter cut-off, the shortest wavelength \[m\].
    pub shortest_wavelength_m: f64,
}

/// Prepares heights \[m\] with spacings `spacing_m` along rows and along columns.
///
/// Missing points are NaN. A field that is not square is cropped to its central square; a periodic one must
/// be square. With unequal spacings, heights along the coarser direction are interpolated by polynomials of
/// the fifth degree. The cut-off then refers to the larger spacing.
///
/// # Errors
/// Too few or too many points; spacings that are not positive or too unequal; constant heights; too little
/// memory. Too many missing points, or any if they are refused. The message states the allowed values.
pub fn prepare(
    heights_m: Array2<f64>,
    spacing_m: [f64; 2],
    treatment: &Treatment,
) -> Result<Prepared, PhysicsError> {
    let edges = Edges::of(treatment.periodic);
    let Square { mut heights, fine, coarsening } = square(heights_m, spacing_m, edges)?;
    let side = heights.nrows();
    let missing_count = heights.iter().filter(|h| !h.is_finite()).count();
    let share = missing_count as f64 / heights.len() as f64;
    if missing_count > 0 && treatment.missing == Missing::Refuse {
        return Err(domain(
            "the number of missing points",
            missing_count as f64,
            "none, or missing = \"fill\" (--fill; fill=True in Python) for harmonic in-fill",
        ));
    }
    if share > MAX_MISSING_FRACTION {
        return Err(domain("the number of missing points", missing_count as f64, "up to half of all"));
    }
    fill(&mut heights, edges);
    let length_m = side as f64 * fine;
    // Levelling breaks the continuation of a periodic field.
    let continued = !treatment.periodic && continues(heights.view());
    let untapered =
        if continued { Some(Field::of(heights.view(), length_m, Edges::Periodic)?.rings()) } else { None };
    let trend_m = level(&mut heights, treatment.detrend)?;
    let points = treatment.points_per_shortest_wavelength * coarsening;
    let Filtered { heights_m, moments, rings } = filtered(&heights, length_m, points, treatment)?;
    let fit = if treatment.periodic || continued {
        fit_self_affine(untapered.as_ref().unwrap_or(&rings), length_m, Estimate::Periodogram)
    } else {
        fit_self_affine(&tapered_periodogram(heights.view(), length_m)?, length_m, Estimate::Tapered)
    };
    let rms_m = (heights.iter().map(|h| h * h).sum::<f64>() / heights.len() as f64).sqrt();
    if moments.rms_height_m() <= ROUNDING * rms_m {
        return Err(short(points * fine));
    }
    let removed = heights.iter().zip(&heights_m).map(|(before, after)| (before - after).powi(2)).sum::<f64>();
    let edge = if treatment.periodic { 0 } else { margin(points) };
    Ok(Prepared {
        overshoot_m: overshoot(heights.view(), heights_m.view(), points, edge),
        noise_m: (removed / heights.len() as f64).sqrt(),
        heights_m,
        length_m,
        moments,
        rings,
        fit,
        missing_count,
        trend_m,
        shortest_wavelength_m: points * fine,
    })
}

/// Heights after the S-filter, their moments, and the spectrum before it.
struct Filtered {
    heights_m: Array2<f64>,
    moments: Moments,
    rings: Vec<Ring>,
}

/// Applies the S-filter with a cut-off of `points` points to levelled heights \[m\] on a square.
fn filtered(
    heights: &Array2<f64>,
    length_m: f64,
    points: f64,
    treatment: &Treatment,
) -> Result<Filtered, PhysicsError> {
    let side = heights.nrows();
    if treatment.periodic {
        let mut field = Field::of(heights.view(), length_m, Edges::Periodic)?;
        let rings = field.rings();
        match treatment.filter {
            Filter::Gaussian => field.smooth(points),
            Filter::Sharp => field.cut(points),
        }
        let moments = field.moments();
        return Ok(Filtered { heights_m: field.heights(side)?, moments, rings });
    }
    let spacing = length_m / side as f64;
    if side <= 2 * margin(points) {
        return Err(short(points * spacing));
    }
    let rings = windowed_periodogram(heights.view(), length_m)?;
    let mut heights_m = match treatment.filter {
        Filter::Gaussian => gaussian(heights.view(), points)?,
        Filter::Sharp => {
            let mut field = Field::of(heights.view(), length_m, Edges::Open)?;
            field.cut(points);
            field.heights(side)?
        }
    };
    let mean = heights_m.sum() / heights_m.len() as f64;
    heights_m -= mean;
    let moments = continuation::moments(heights_m.view(), spacing, points)?;
    Ok(Filtered { heights_m, moments, rings })
}

/// Error if the S-filter leaves nothing.
fn short(cut_off_m: f64) -> PhysicsError {
    PhysicsError::Surface {
        problem: format!("no wavelengths above the S-filter cut-off, {cut_off_m:.3e} m"),
        help: "reduce the cut-off (--points, points_per_shortest_wavelength)",
    }
}

fn domain(quantity: &'static str, value: f64, allowed: &'static str) -> PhysicsError {
    PhysicsError::Domain { action: "the measured surface", quantity, value, allowed }
}

/// Central square of a scan, with equal spacings along both directions.
struct Square {
    heights: Array2<f64>,
    /// Point spacing \[m\].
    fine: f64,
    /// Ratio of the larger to the smaller point spacing of the scan.
    ///
    /// It is 1 if they count as equal.
    coarsening: f64,
}

/// Side \[m\] of the central square that [`prepare`] makes of a scan.
///
/// It is the number of points along the shorter side times the smaller spacing, after interpolation along the
/// direction of the larger spacing.
#[must_use]
pub fn square_side(counts: [usize; 2], spacing_m: [f64; 2]) -> f64 {
    let fine = spacing_m[0].min(spacing_m[1]);
    let count = |along: usize| {
        let ratio = spacing_m[along] / fine;
        if ratio > 1.0 + SPACING_TOLERANCE { fine_count(counts[along], ratio) } else { counts[along] }
    };
    count(0).min(count(1)) as f64 * fine
}

fn square(heights_m: Array2<f64>, spacing_m: [f64; 2], edges: Edges) -> Result<Square, PhysicsError> {
    if !(spacing_m.iter().all(|d| *d > 0.0 && d.is_finite())) {
        let wrong = spacing_m.into_iter().find(|d| !(*d > 0.0 && d.is_finite())).unwrap_or(f64::NAN);
        return Err(domain("the pixel size [m]", wrong, "a positive number"));
    }
    check_size(&heights_m)?;
    let fine = spacing_m[0].min(spacing_m[1]);
    let ratio = spacing_m[0].max(spacing_m[1]) / fine;
    if ratio > MAX_SPACING_RATIO {
        return Err(domain("the ratio of the pixel sizes along both axes", ratio, "up to 16"));
    }
    let oblong = ratio > 1.0 + SPACING_TOLERANCE;
    let coarsening = if oblong { ratio } else { 1.0 };
    if oblong && edges == Edges::Periodic {
        return Err(domain(
            "the ratio of the pixel sizes along both axes",
            ratio,
            "1 for a periodic surface, or periodic = false",
        ));
    }
    let largest = heights_m.len() as f64 * coarsening;
    if largest > MAX_POINTS_BEFORE_CROP {
        return Err(domain("the number of points", largest, "up to 2^28"));
    }
    let heights_m = match oblong {
        true if spacing_m[0] > spacing_m[1] => resampled(heights_m.t(), ratio)?.reversed_axes(),
        true => resampled(heights_m.view(), ratio)?,
        false => heights_m,
    };
    let (rows, columns) = heights_m.dim();
    let side = rows.min(columns);
    if side < MIN_POINTS {
        return Err(domain(
            "the number of points along its shorter side",
            side as f64,
            "16 or more: use a larger scan; of a text, check --width and --skip-lines",
        ));
    }
    if side > MAX_POINTS {
        return Err(domain(
            "the number of points along its shorter side",
            side as f64,
            "up to 8192: use a part of the scan, or every second point",
        ));
    }
    if edges == Edges::Periodic && rows != columns {
        let allowed = "the number of columns for a periodic surface, or periodic = false";
        return Err(domain("the number of rows", rows as f64, allowed));
    }
    Ok(Square { heights: middle(heights_m, side)?, fine, coarsening })
}

/// Central square in standard memory order, which fixes the order of sums.
fn middle(heights_m: Array2<f64>, side: usize) -> Result<Array2<f64>, PhysicsError> {
    let (rows, columns) = heights_m.dim();
    if rows == side && columns == side && heights_m.is_standard_layout() {
        return Ok(heights_m);
    }
    let (top, left) = ((rows - side) / 2, (columns - side) / 2);
    let mut square = zeros((side, side))?;
    square.assign(&heights_m.slice(s![top..top + side, left..left + side]));
    Ok(square)
}

/// Interpolates each row to a spacing smaller by `ratio`, by Lagrange polynomials through six points.
///
/// A value is missing if one of its six points is missing.
fn resampled(heights: ArrayView2<'_, f64>, ratio: f64) -> Result<Array2<f64>, PhysicsError> {
    let (rows, columns) = heights.dim();
    if columns < TAPS {
        return zeros((rows, columns));
    }
    let count = fine_count(columns, ratio);
    let mut fine = zeros((rows, count))?;
    for k in 0..count {
        let place = k as f64 / ratio;
        let first = (place.floor() as usize).saturating_sub(TAPS / 2 - 1).min(columns - TAPS);
        let weight = |tap: usize| {
            let others = (0..TAPS).filter(|other| *other != tap);
            others
                .map(|other| (place - (first + other) as f64) / (tap as f64 - other as f64))
                .product::<f64>()
        };
        let weights: [f64; TAPS] = std::array::from_fn(weight);
        for row in 0..rows {
            // A weight of zero excludes a point even if it is missing.
            let near = weights.iter().enumerate().filter(|(_, w)| **w != 0.0);
            fine[[row, k]] = near.map(|(tap, w)| w * heights[[row, first + tap]]).sum();
        }
    }
    Ok(fine)
}

/// Number of points after interpolation to a spacing smaller by `ratio`.
fn fine_count(count: usize, ratio: f64) -> usize {
    (count.saturating_sub(1) as f64 * ratio).floor() as usize + 1
}

/// Number of points in the interpolation of a value.
const TAPS: usize = 6;
/// Maximum number of points before the crop.
const MAX_POINTS_BEFORE_CROP: f64 = (1u64 << 28) as f64;
