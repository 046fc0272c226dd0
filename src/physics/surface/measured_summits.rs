//! Summits of a measured surface after the S-filter.

use super::band_limited::BandLimited;
use super::continuation::{continued, margin};
use super::edges::Edges;
use super::height_map::SquareMap;
use super::summits::{Summit, Summits, apexes, check_points, find_summits};
use crate::PhysicsError;
use ndarray::ArrayView2;
use std::f64::consts::TAU;

/// Curvature attributed to rounding: that of ripples with the cut-off wavelength and this amplitude, relative
/// to the range of heights.
///
/// It is below the resolution of single precision.
pub(super) const ROUNDING_OF_RIPPLES: f64 = 2e-8;

/// Smaller over larger principal curvature below which a maximum is one of a ridge, due to rounding and to
/// the rule for the edges.
pub(super) const RIDGE: f64 = 1e-3;

/// Summits of a prepared surface, and the number excluded at the edges of a non-periodic one.
///
/// `points` is the number of grid points per shortest wavelength. Maxima of a plateau or along a ridge that
/// are due to rounding are rejected: one of their principal curvatures is zero or far below the other.
///
/// # Errors
/// As [`find_summits`].
pub fn find_measured(map: SquareMap<'_>, points: f64) -> Result<(Summits, usize), PhysicsError> {
    let SquareMap { heights_m, length_m, edges } = map;
    let (mut found, edge) = match edges {
        Edges::Periodic => (find_summits(heights_m, length_m, points)?, 0),
        Edges::Open => find_inside(heights_m, length_m, points)?,
    };
    let (low, high) = heights_m
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(*h), high.max(*h)));
    let wavenumber = TAU * heights_m.nrows() as f64 / (points * length_m);
    let flat = ROUNDING_OF_RIPPLES * (high - low) * wavenumber * wavenumber;
    let all = found.list.len();
    found.list.retain(|summit| summit.curvature_min_1_m.abs() > flat.max(RIDGE * summit.curvature_max_1_m));
    found.rejected += all - found.list.len();
    found.unrefined = found.list.iter().filter(|summit| !summit.refined).count();
    Ok((found, edge))
}

/// Asperities of a field that is not periodic, and the number of asperities too close to its edges.
fn find_inside(
    heights_m: ArrayView2<'_, f64>,
    length_m: f64,
    points: f64,
) -> Result<(Summits, usize), PhysicsError> {
    check_points(points)?;
    let n = heights_m.nrows();
    let spacing = length_m / n as f64;
    // An apex is up to one point from its grid maximum.
    let width = BandLimited::reach(points) + 1;
    let whole = continued(heights_m, width)?;
    let found = apexes(whole.view(), whole.nrows() as f64 * spacing, points, width..width + n);
    let all = found.len();
    let moved = |summit: Summit| Summit {
        x_m: summit.x_m - width as f64 * spacing,
        y_m: summit.y_m - width as f64 * spacing,
        grid_row: summit.grid_row - width,
        grid_col: summit.grid_col - width,
        ..summit
    };
    let mut list: Vec<Summit> = found.into_iter().flatten().map(moved).collect();
    let rejected = all - list.len();
    let edge = margin(points).min(n / 2);
    let clear = |k: usize| (edge..n - edge).contains(&k);
    list.retain(|summit| clear(summit.grid_row) && clear(summit.grid_col));
    let at_edge = all - rejected - list.len();
    Ok((Summits { unrefined: 0, rejected, list }, at_edge))
}
