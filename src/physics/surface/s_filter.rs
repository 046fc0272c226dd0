//! Gaussian low-pass filter (S-filter) of ISO 16610-61, and its comparison with the unfiltered heights.
//!
//! Weights `exp(−π(x/(α λc))²)` with `α = sqrt(ln 2/π)`: half of the amplitude of the wavelength λc is
//! transmitted. The weights are positive, so that filtered heights are between the lowest and the highest
//! height nearby. A sharp cut-off in wavevectors rings at steps instead.
//!
//! Near an edge the kernel is truncated. A linear factor then retains its moments of order 0 and 1, so that
//! planes are transmitted unchanged (moment retainment, ISO/TS 16610-28).

use super::edges::Edges;
use super::summits::maxima_of_row;
use crate::PhysicsError;
use crate::memory::zeros;
use ndarray::{Array2, ArrayView2, s};
use rayon::prelude::*;
use std::f64::consts::{LN_2, PI};

/// Range of the kernel in cut-off wavelengths: the weight there is 1e-17 of that at the centre.
const KERNEL_RANGE: f64 = 1.9;

/// Ratio of the standard deviation to the median absolute value of normally distributed numbers.
const NORMAL: f64 = 1.4826;

/// Weight at a distance in cut-off wavelengths, with α² = ln 2/π.
fn weight(distance: f64) -> f64 {
    (-PI * PI / LN_2 * distance * distance).exp()
}

/// Transmission of the sampled kernel with a cut-off of `points` points, at a number of cycles per point
/// along one direction.
///
/// The transmission of the continuous kernel is `exp(−π(α λc/λ)²) = 2^(−(λc/λ)²)`. Sampling adds its images
/// (Poisson's formula).
pub(super) fn transmission(points: f64, cycles_per_point: f64) -> f64 {
    let images = |cycles: f64| {
        (-4..=4).map(|image| (-(points * (cycles + f64::from(image))).powi(2)).exp2()).sum::<f64>()
    };
    images(cycles_per_point) / images(0.0)
}

/// Filters heights that do not continue periodically, with a cut-off of `points` points.
///
/// # Errors
/// Too little memory.
pub(super) fn gaussian(heights: ArrayView2<'_, f64>, points: f64) -> Result<Array2<f64>, PhysicsError> {
    let kernel = Kernel::new(heights.nrows(), points);
    let once = kernel.filtered_rows(heights)?;
    let twice = kernel.filtered_rows(once.t())?;
    let mut filtered = zeros(heights.dim())?;
    filtered.assign(&twice.t());
    Ok(filtered)
}

/// Weights along a line of points.
struct Kernel {
    reach: usize,
    /// Weights far from the edges.
    inner: Vec<f64>,
    /// Weights of the points closer to an edge than `reach`; empty for the others.
    near_edge: Vec<Vec<f64>>,
}

impl Kernel {
    fn new(n: usize, points: f64) -> Self {
        let reach = (KERNEL_RANGE * points).ceil() as usize;
        let inner = normalised((0..=2 * reach).map(|k| weight((k as f64 - reach as f64) / points)).collect());
        let of_point = |i: usize| {
            if i >= reach && i + reach < n {
                return Vec::new();
            }
            let places = i.saturating_sub(reach)..(i + reach + 1).min(n);
            retaining(places.map(|j| (j as f64 - i as f64) / points).collect())
        };
        Self { reach, inner, near_edge: (0..n).map(of_point).collect() }
    }

    /// First point and weights of the filtered value at a point.
    fn at(&self, i: usize) -> (usize, &[f64]) {
        match self.near_edge[i].as_slice() {
            [] => (i - self.reach, &self.inner),
            weights => (i.saturating_sub(self.reach), weights),
        }
    }

    fn filtered_rows(&self, heights: ArrayView2<'_, f64>) -> Result<Array2<f64>, PhysicsError> {
        let (rows, columns) = heights.dim();
        let mut result = zeros((rows, columns))?;
        let Some(values) = result.as_slice_mut() else { return Ok(result) };
        values.par_chunks_mut(columns).enumerate().for_each_init(
            || vec![0.0; columns],
            |line, (row, filtered)| {
                line.iter_mut().zip(heights.row(row)).for_each(|(to, from)| *to = *from);
                for (i, value) in filtered.iter_mut().enumerate() {
                    let (first, weights) = self.at(i);
                    *value = line[first..first + weights.len()].iter().zip(weights).map(|(h, w)| h * w).sum();
                }
            },
        );
        Ok(result)
    }
}

fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    weights
}

/// Weights at distances in cut-off wavelengths, with the sum 1 and the mean distance 0.
fn retaining(distances: Vec<f64>) -> Vec<f64> {
    let moment = |order: i32| distances.iter().map(|t| t.powi(order) * weight(*t)).sum::<f64>();
    let (m0, m1, m2) = (moment(0), moment(1), moment(2));
    let determinant = m0 * m2 - m1 * m1;
    distances.iter().map(|t| (m2 - m1 * t) / determinant * weight(*t)).collect()
}

/// Height of filtered maxima above all unfiltered heights nearby, beyond the noise \[m\]; 0 where there is no
/// such maximum.
///
/// Nearby is within one cut-off wavelength of `points` points along rows and columns.
/// Maxima within `margin` points of the edges are left out; a margin of 0 is a periodic field.
/// The noise is the median absolute value of the removed heights times 1.4826, which steps do not affect.
pub(super) fn overshoot(
    raw: ArrayView2<'_, f64>,
    filtered: ArrayView2<'_, f64>,
    points: f64,
    margin: usize,
) -> f64 {
    let n = raw.nrows();
    let reach = points.ceil() as usize;
    let above = |(row, column): (usize, usize)| {
        let clear = |k: usize| (margin..n - margin).contains(&k);
        if !(clear(row) && clear(column)) {
            return f64::NEG_INFINITY;
        }
        let height = filtered[[row, column]];
        let edges = Edges::of(margin == 0);
        height - highest_near(raw, [row, column], reach, edges, height)
    };
    let most =
        |row: usize| maxima_of_row(filtered, row).into_iter().map(above).fold(f64::NEG_INFINITY, f64::max);
    let most = (0..n).into_par_iter().map(most).reduce(|| f64::NEG_INFINITY, f64::max);
    if most > 0.0 { (most - noise(raw, filtered)).max(0.0) } else { 0.0 }
}

/// Highest of the heights around a point, or the first one above `enough`.
fn highest_near(
    raw: ArrayView2<'_, f64>,
    [row, column]: [usize; 2],
    reach: usize,
    edges: Edges,
    enough: f64,
) -> f64 {
    let n = raw.nrows();
    if edges == Edges::Open {
        let span = |k: usize| k.saturating_sub(reach)..(k + reach + 1).min(n);
        let near = raw.slice(s![span(row), span(column)]);
        return near.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    }
    let reach = reach.min(n / 2);
    let mut highest = f64::NEG_INFINITY;
    for i in 0..=2 * reach {
        for j in 0..=2 * reach {
            highest = highest.max(raw[[(row + n + i - reach) % n, (column + n + j - reach) % n]]);
        }
        if highest > enough {
            break;
        }
    }
    highest
}

/// Robust standard deviation of the removed heights \[m\].
fn noise(raw: ArrayView2<'_, f64>, filtered: ArrayView2<'_, f64>) -> f64 {
    let mut removed: Vec<f64> = raw.iter().zip(filtered).map(|(a, b)| (a - b).abs()).collect();
    let middle = removed.len() / 2;
    let (_, median, _) = removed.select_nth_unstable_by(middle, f64::total_cmp);
    NORMAL * *median
}
