//! A measured surface made fit for the model: a square of it, missing points, its trend, and the waves that are kept.
//!
//! The model wants what a generated surface is: a band-limited field on a square grid. A scan has noise down to its points, so waves shorter than
//! `points_per_shortest_wavelength` of them are taken off (sharply, on a disc of wavevectors); what is left determines the summits as on a generated surface.
//!
//! A field that does not continue periodically is continued by its mirror images for this: heights stay continuous, where periodic images would jump. Summits nearer
//! to an edge than half a shortest wavelength are left out, since there the mirror makes ridges of slopes.

use crate::physics::PhysicsError;

use super::levelling::{ROUNDING, check_size, level};
use super::modes::Field;
use super::modes::mirrored;
use super::periodogram::windowed_periodogram;
use super::psd_bin::Ring;
use super::spectrum::Moments;
use super::summits::{Summits, find_summits};
use crate::model::{Detrend, Missing};
use crate::physics::memory::zeros;
use ndarray::{Array2, ArrayView2, s};

/// Points along a side, at least and at most.
pub const FEWEST_POINTS: usize = 16;
/// 1 GiB of heights; the mirror images make four of them while they are filtered.
pub const MOST_POINTS: usize = 8192;

/// Largest share of points that may be missing.
const MOST_MISSING: f64 = 0.5;
/// How far the distances of points along the two directions may differ and count as one.
const SQUARE: f64 = 1e-3;
/// Largest ratio of the two that is resampled.
const MOST_OBLONG: f64 = 16.0;

/// Preprocessing of a measured surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Treatment {
    /// Treatment of missing points.
    pub missing: Missing,
    /// Form subtracted from the heights.
    pub detrend: Detrend,
    /// True if the field continues periodically.
    pub periodic: bool,
    /// Shorter waves than so many points are taken off.
    pub points_per_shortest_wavelength: f64,
}

/// A measured surface that is fit for the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// Heights from their mean \[m\], on a square.
    pub heights_m: Array2<f64>,
    /// Side of the square \[m\].
    pub length_m: f64,
    /// Moments, from its modes.
    pub moments: Moments,
    /// Spectrum before short waves were taken off, in rings.
    pub rings: Vec<Ring>,
    /// Number of missing points in the square.
    pub missing_count: usize,
    /// Rms height of what was taken off as trend \[m\].
    pub trend_m: f64,
    /// Rms height of the short waves that were taken off \[m\].
    pub noise_m: f64,
    /// The wavelength below which they were \[m\].
    pub shortest_wavelength_m: f64,
}

/// Prepares heights \[m\], missing ones not a number, whose points are `spacing_m` apart along rows and along columns.
///
/// Of a field that is no square the middle one is taken; a periodic one must be square. Where points lie farther apart along one direction, heights between them are
/// interpolated (polynomials of the fifth degree), and the short waves are those of the greater distance.
///
/// # Errors
/// Too few or too many points, distances that are not positive or too unequal, too many missing points or any that are to be refused, constant heights, too little memory; the sentence says what is allowed.
pub fn prepare(heights_m: Array2<f64>, spacing_m: [f64; 2], treatment: &Treatment) -> Result<Prepared, PhysicsError> {
    let Square { mut heights, fine, coarsening } = square(heights_m, spacing_m, treatment.periodic)?;
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
    if share > MOST_MISSING {
        return Err(domain("the number of missing points", missing_count as f64, "up to half of all"));
    }
    fill(&mut heights, treatment.periodic);
    let trend_m = level(&mut heights, treatment.detrend)?;
    let length_m = side as f64 * fine;
    let points = treatment.points_per_shortest_wavelength * coarsening;
    let rings = if treatment.periodic { None } else { Some(windowed_periodogram(heights.view(), length_m)?) };
    let mut field = Field::of(heights.view(), length_m, treatment.periodic)?;
    drop(heights);
    let rings = rings.unwrap_or_else(|| field.rings());
    let before = field.moments();
    field.cut(points);
    let moments = field.moments();
    if moments.rms_height_m() <= ROUNDING * before.rms_height_m() {
        return Err(PhysicsError::Surface {
            problem: format!("no wavelengths above the S-filter cut-off, {:.3e} m", points * fine),
            help: "reduce the cut-off (--points, points_per_shortest_wavelength)",
        });
    }
    let noise_m = (before.m0_m2 - moments.m0_m2).max(0.0).sqrt();
    Ok(Prepared {
        heights_m: field.heights(side)?,
        length_m,
        moments,
        rings,
        missing_count,
        trend_m,
        noise_m,
        shortest_wavelength_m: points * fine,
    })
}

fn domain(quantity: &'static str, value: f64, allowed: &'static str) -> PhysicsError {
    PhysicsError::Domain { action: "the measured surface", quantity, value, allowed }
}

/// The central square of a scan, its points as far apart along both directions.
struct Square {
    heights: Array2<f64>,
    /// Distance of points \[m\].
    fine: f64,
    /// The larger distance of points of the scan over the smaller one; 1 where they count as equal.
    coarsening: f64,
}

fn square(heights_m: Array2<f64>, spacing_m: [f64; 2], periodic: bool) -> Result<Square, PhysicsError> {
    if !(spacing_m.iter().all(|d| *d > 0.0 && d.is_finite())) {
        let wrong = spacing_m.into_iter().find(|d| !(*d > 0.0 && d.is_finite())).unwrap_or(f64::NAN);
        return Err(domain("the pixel size [m]", wrong, "a positive number"));
    }
    check_size(&heights_m)?;
    let fine = spacing_m[0].min(spacing_m[1]);
    let ratio = spacing_m[0].max(spacing_m[1]) / fine;
    if ratio > MOST_OBLONG {
        return Err(domain("the ratio of the pixel sizes along both axes", ratio, "up to 16"));
    }
    let oblong = ratio > 1.0 + SQUARE;
    let coarsening = if oblong { ratio } else { 1.0 };
    if oblong && periodic {
        return Err(domain("the ratio of the pixel sizes along both axes", ratio, "1 for a periodic surface, or periodic = false"));
    }
    let largest = heights_m.len() as f64 * coarsening;
    if largest > MOST_AT_ALL {
        return Err(domain("the number of points", largest, "up to 2^28"));
    }
    let heights_m = match oblong {
        true if spacing_m[0] > spacing_m[1] => resampled(heights_m.t(), ratio)?.reversed_axes(),
        true => resampled(heights_m.view(), ratio)?,
        false => heights_m,
    };
    let (rows, columns) = heights_m.dim();
    let side = rows.min(columns);
    if side < FEWEST_POINTS {
        return Err(domain("the number of points along its shorter side", side as f64, "16 or more"));
    }
    if side > MOST_POINTS {
        return Err(domain(
            "the number of points along its shorter side",
            side as f64,
            "up to 8192: use a part of the scan, or every second point",
        ));
    }
    if periodic && rows != columns {
        let allowed = "the number of columns for a periodic surface, or periodic = false";
        return Err(domain("the number of rows", rows as f64, allowed));
    }
    Ok(Square { heights: middle(heights_m, side)?, fine, coarsening })
}

/// The central square, in one order in memory, in which sums are then made.
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

/// Points between those of each row, `ratio` times as close, from the first on to the last: Lagrange's polynomials through six points. Where one of these is missing, so is
/// what lies between them.
fn resampled(heights: ArrayView2<'_, f64>, ratio: f64) -> Result<Array2<f64>, PhysicsError> {
    let (rows, columns) = heights.dim();
    if columns < TAPS {
        return zeros((rows, columns));
    }
    let count = ((columns - 1) as f64 * ratio).floor() as usize + 1;
    let mut fine = zeros((rows, count))?;
    for k in 0..count {
        let place = k as f64 / ratio;
        let first = (place.floor() as usize).saturating_sub(TAPS / 2 - 1).min(columns - TAPS);
        let weight = |tap: usize| {
            let others = (0..TAPS).filter(|other| *other != tap);
            others.map(|other| (place - (first + other) as f64) / (tap as f64 - other as f64)).product::<f64>()
        };
        let weights: [f64; TAPS] = std::array::from_fn(weight);
        for row in 0..rows {
            // A weight of zero takes nothing, not even what is missing.
            let near = weights.iter().enumerate().filter(|(_, w)| **w != 0.0);
            fine[[row, k]] = near.map(|(tap, w)| w * heights[[row, first + tap]]).sum();
        }
    }
    Ok(fine)
}

/// Points that a value between them is made of.
const TAPS: usize = 6;
/// Points at most, before a square is taken of them.
const MOST_AT_ALL: f64 = (1u64 << 28) as f64;

/// Continues the heights into missing points: their discrete Laplacian vanishes there, as of a membrane that is held at the edges of the hole. At the edges of the
/// field its slope vanishes, or it continues periodically.
fn fill(heights: &mut Array2<f64>, periodic: bool) {
    let (rows, columns) = heights.dim();
    let holes: Vec<(usize, usize)> = heights.indexed_iter().filter(|(_, h)| !h.is_finite()).map(|(place, _)| place).collect();
    if holes.is_empty() {
        return;
    }
    let step = |at: usize, by: isize, n: usize| -> usize {
        let to = at as isize + by;
        if periodic { to.rem_euclid(n as isize) as usize } else { to.clamp(0, n as isize - 1) as usize }
    };
    let around =
        |(i, j): (usize, usize)| [(step(i, -1, rows), j), (step(i, 1, rows), j), (i, step(j, -1, columns)), (i, step(j, 1, columns))];
    // From the edges of the holes inwards, each point the mean of the known ones around it: a start.
    let mut open = holes.clone();
    while !open.is_empty() {
        let found: Vec<((usize, usize), f64)> = open
            .iter()
            .filter_map(|place| {
                let known: Vec<f64> = around(*place).into_iter().map(|at| heights[at]).filter(|h| h.is_finite()).collect();
                (!known.is_empty()).then(|| (*place, known.iter().sum::<f64>() / known.len() as f64))
            })
            .collect();
        if found.is_empty() {
            return;
        }
        found.iter().for_each(|(place, h)| heights[*place] = *h);
        open.retain(|place| !heights[*place].is_finite());
    }
    // Then successive over-relaxation, until nothing moves by more than a millionth of the range: far below what a measurement is good for.
    let (low, high) = heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(*h), high.max(*h)));
    let width = (holes.len() as f64).sqrt().min(rows as f64);
    let over = 2.0 / (1.0 + (std::f64::consts::PI / (width + 1.0)).sin());
    for _ in 0..MOST_SWEEPS {
        let mut moved = 0.0_f64;
        for place in &holes {
            let mean = around(*place).into_iter().map(|at| heights[at]).sum::<f64>() / 4.0;
            let by = over * (mean - heights[*place]);
            heights[*place] += by;
            moved = moved.max(by.abs());
        }
        if moved <= 1e-6 * (high - low) {
            return;
        }
    }
}

/// Sweeps over the missing points, at most.
const MOST_SWEEPS: usize = 3000;

/// Summits of a prepared surface with so many points to its shortest wavelength, and how many were left out at the edges of one that is not periodic.
///
/// # Errors
/// As [`find_summits`].
pub fn find_measured(
    heights_m: ArrayView2<'_, f64>,
    length_m: f64,
    (periodic, points): (bool, f64),
) -> Result<(Summits, usize), PhysicsError> {
    if periodic {
        return Ok((find_summits(heights_m, length_m, points)?, 0));
    }
    let n = heights_m.nrows();
    let mut found = find_summits(mirrored(heights_m)?.view(), 2.0 * length_m, points)?;
    let margin = (0.5 * points).ceil() as usize;
    let inside = |k: usize| k < n;
    found.list.retain(|summit| inside(summit.grid_row) && inside(summit.grid_col));
    let all = found.list.len();
    let clear = |k: usize| (margin..n - margin).contains(&k);
    found.list.retain(|summit| clear(summit.grid_row) && clear(summit.grid_col));
    let edge = all - found.list.len();
    found.unrefined = found.list.iter().filter(|summit| !summit.refined).count();
    // Each of the four images has them.
    found.rejected /= 4;
    Ok((found, edge))
}
