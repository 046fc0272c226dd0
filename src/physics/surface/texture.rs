//! Texture of a surface: aspect ratio of its slopes and of its autocorrelation.

use super::edges::Edges;
use super::modes::Field;
use crate::PhysicsError;
use crate::memory::zeros;
use ndarray::{Array2, ArrayView2};
use std::f64::consts::PI;

/// Texture of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texture {
    /// Ratio of the rms slopes along the principal axes of `⟨∂_a h ∂_b h⟩`, the larger over the smaller.
    pub slope_ratio: f64,
    /// Direction of the smaller rms slope, along the ridges, from the x axis to the y axis, 0 ≤ angle < π
    /// \[rad\].
    pub direction_rad: f64,
    /// Str of ISO 25178-2: the shortest over the longest distance at which the autocorrelation decays to 0.2.
    ///
    /// An upper limit if the longest exceeds half of the side.
    pub aspect_ratio_str: f64,
    /// Shortest distance at which the autocorrelation decays to 0.2 (Sal), over the side.
    pub decay_length: f64,
}

/// Autocorrelation to which Str and Sal refer (ISO 25178-2).
const DECAYED: f64 = 0.2;
/// Directions of the autocorrelation, from 0 to π.
const DIRECTIONS: usize = 180;
/// Distance between the points on a ray of the autocorrelation, in points.
const STEP: f64 = 0.5;
/// Maximum number of points along a side of the autocorrelation; of larger fields blocks are averaged.
const MAX_POINTS: usize = 2048;
/// Sides over decay lengths from which Str is determined: fewer are too small a sample, and Str of an
/// isotropic surface is below ½ by chance.
const DECAY_LENGTHS: f64 = 20.0;
/// Minimum mean square slope along an axis, relative to the other: rounding.
const ROUNDING: f64 = 1e-12;

impl Texture {
    /// Texture of heights \[m\]; nothing for fewer than five points along a side.
    ///
    /// # Errors
    /// Too little memory.
    pub fn of(heights_m: ArrayView2<'_, f64>, edges: Edges) -> Result<Option<Self>, PhysicsError> {
        if heights_m.nrows() < 5 || heights_m.nrows() != heights_m.ncols() {
            return Ok(None);
        }
        let (slope_ratio, direction_rad) = slopes(heights_m, edges);
        let coarse = averaged(heights_m)?;
        let side = coarse.nrows();
        let correlation = autocorrelation(coarse, edges)?;
        let decays = (0..DIRECTIONS).map(|k| decay(&correlation, side, PI * k as f64 / DIRECTIONS as f64));
        let (shortest, longest) =
            decays.fold((f64::INFINITY, 0.0_f64), |(least, most), decay| (least.min(decay), most.max(decay)));
        Ok(Some(Self {
            slope_ratio,
            direction_rad,
            aspect_ratio_str: shortest / longest,
            decay_length: shortest / side as f64,
        }))
    }

    /// Texture aspect ratio: the larger of the slope ratio and 1/Str, if the surface is large enough for Str.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        if self.decay_length * DECAY_LENGTHS <= 1.0 {
            self.slope_ratio.max(1.0 / self.aspect_ratio_str)
        } else {
            self.slope_ratio
        }
    }
}

/// Ratio of the rms slopes along the principal axes, and the direction of the smaller \[rad\].
///
/// Slopes are differences of the fourth order inside the field: mirror images of a field would cancel the
/// mixed product.
fn slopes(heights_m: ArrayView2<'_, f64>, edges: Edges) -> (f64, f64) {
    let n = heights_m.nrows();
    let inside = match edges {
        Edges::Periodic => 0..n,
        Edges::Open => 2..n - 2,
    };
    let difference = |of: &dyn Fn(usize) -> f64| (8.0 * (of(1) - of(n - 1)) - (of(2) - of(n - 2))) / 12.0;
    let mut tensor = [0.0; 3];
    for i in inside.clone() {
        for j in inside.clone() {
            let x = difference(&|by| heights_m[[(i + by) % n, j]]);
            let y = difference(&|by| heights_m[[i, (j + by) % n]]);
            tensor = [tensor[0] + x * x, tensor[1] + x * y, tensor[2] + y * y];
        }
    }
    let [xx, xy, yy] = tensor;
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let distance = half.hypot(xy);
    let ratio = ((mean + distance) / (mean - distance).max(ROUNDING * mean)).sqrt();
    // The steepest direction is at half the angle of (half, xy); ridges are perpendicular to it.
    let ridges = 0.5 * xy.atan2(half) + 0.5 * PI;
    (if mean > 0.0 { ratio } else { 1.0 }, ridges.rem_euclid(PI))
}

/// Means of square blocks, so that at most [`MAX_POINTS`] points remain along a side.
fn averaged(heights_m: ArrayView2<'_, f64>) -> Result<Array2<f64>, PhysicsError> {
    let block = heights_m.nrows().div_ceil(MAX_POINTS);
    let side = heights_m.nrows() / block;
    let mut coarse = zeros((side, side))?;
    for (means, lines) in
        coarse.rows_mut().into_iter().zip(heights_m.exact_chunks((block, heights_m.ncols())))
    {
        for (mean, square) in means.into_iter().zip(lines.exact_chunks((block, block))) {
            *mean = square.sum() / (block * block) as f64;
        }
    }
    let mean = coarse.sum() / (side * side) as f64;
    coarse -= mean;
    Ok(coarse)
}

/// Autocorrelation over all lags, over that at zero lag. The negative lags follow after the others, as in a
/// periodic field.
///
/// Of a field that is not periodic the mean is over the points that overlap.
fn autocorrelation(heights: Array2<f64>, edges: Edges) -> Result<Array2<f64>, PhysicsError> {
    let n = heights.nrows();
    let field = match edges {
        Edges::Periodic => heights,
        Edges::Open => {
            let mut padded = zeros((2 * n, 2 * n))?;
            padded.slice_mut(ndarray::s![..n, ..n]).assign(&heights);
            padded
        }
    };
    let mut correlation = Field::of(field.view(), 1.0, Edges::Periodic)?.autocorrelation()?;
    let around = field.nrows();
    let variance = correlation[[0, 0]];
    let overlap = |k: usize| match edges {
        Edges::Periodic => 1.0,
        Edges::Open => n.saturating_sub(k.min(around - k)).max(1) as f64 / n as f64,
    };
    correlation.indexed_iter_mut().for_each(|((i, j), value)| *value /= variance * overlap(i) * overlap(j));
    Ok(correlation)
}

/// Distance in points at which the autocorrelation decays to [`DECAYED`] along a direction \[rad\]; half of
/// the side if it does not.
fn decay(correlation: &Array2<f64>, side: usize, direction_rad: f64) -> f64 {
    let limit = 0.5 * side as f64;
    let (along_y, along_x) = direction_rad.sin_cos();
    let mut before = 1.0;
    for step in 1..=(limit / STEP) as usize {
        let distance = STEP * step as f64;
        let value = between(correlation, distance * along_x, distance * along_y);
        if value <= DECAYED {
            return distance - STEP * (DECAYED - value) / (before - value);
        }
        before = value;
    }
    limit
}

/// Bilinear interpolation in a periodic field.
fn between(field: &Array2<f64>, x: f64, y: f64) -> f64 {
    let n = field.nrows() as i64;
    let at = |i: i64, j: i64| field[[i.rem_euclid(n) as usize, j.rem_euclid(n) as usize]];
    let (i, j) = (x.floor() as i64, y.floor() as i64);
    let (u, v) = (x - x.floor(), y - y.floor());
    (1.0 - u) * ((1.0 - v) * at(i, j) + v * at(i, j + 1))
        + u * ((1.0 - v) * at(i + 1, j) + v * at(i + 1, j + 1))
}
