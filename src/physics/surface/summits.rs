//! Summits of a height field, the asperities of the contact model.
//!
//! A summit is a local maximum over its eight neighbours, refined to the apex between grid points. With four
//! neighbours the density converges to a value 29 % too high. Curvatures are those of the band-limited
//! surface. Finite differences would be 3 % low at 8 points per shortest wavelength.
//!
//! Of equal neighbours the first in grid order is the summit, and a flat surface has none.
//! A maximum whose apex cannot be refined within one grid spacing stays at its grid point.
//! It is excluded if its mean curvature there is not positive. Both cases are counted.

use super::band_limited::{BandLimited, Jet};
use crate::PhysicsError;
use ndarray::ArrayView2;
use rayon::prelude::*;
use std::ops::Range;

/// A local maximum of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summit {
    /// Position x \[m\], in `[0, L)`.
    pub x_m: f64,
    /// Position y \[m\], in `[0, L)`.
    pub y_m: f64,
    /// Height over the surface's mean plane \[m\].
    pub height_m: f64,
    /// Mean curvature `k = −½∇²h` \[1/m\]; the radius of curvature is 1/k.
    pub curvature_1_m: f64,
    /// The smaller principal curvature \[1/m\].
    pub curvature_min_1_m: f64,
    /// The larger principal curvature \[1/m\].
    pub curvature_max_1_m: f64,
    /// Grid row of the maximum.
    pub grid_row: usize,
    /// Grid column of the maximum.
    pub grid_col: usize,
    /// True if position, height and curvatures are those of the apex between grid points.
    pub refined: bool,
}

impl Summit {
    /// Radius of curvature R = 1/k \[m\].
    #[must_use]
    pub fn radius_m(&self) -> f64 {
        1.0 / self.curvature_1_m
    }
}

/// Summits of a surface in grid order, and the counts of excluded and unrefined maxima.
#[derive(Debug, Clone, PartialEq)]
pub struct Summits {
    /// The summits.
    pub list: Vec<Summit>,
    /// Number of grid maxima excluded because their mean curvature is not positive.
    pub rejected: usize,
    /// Number of summits that stayed at their grid point.
    pub unrefined: usize,
}

/// Finds the summits of a periodic band-limited surface.
///
/// # Errors
/// More than two points per shortest wavelength are needed; with fewer the heights do not determine the
/// surface.
pub fn find_summits(
    heights_m: ArrayView2<'_, f64>,
    length_m: f64,
    points_per_shortest_wavelength: f64,
) -> Result<Summits, PhysicsError> {
    check_points(points_per_shortest_wavelength)?;
    let found = apexes(heights_m, length_m, points_per_shortest_wavelength, 0..heights_m.nrows());
    let all = found.len();
    let list: Vec<Summit> = found.into_iter().flatten().collect();
    Ok(Summits {
        rejected: all - list.len(),
        unrefined: list.iter().filter(|summit| !summit.refined).count(),
        list,
    })
}

/// Refuses a number of points per shortest wavelength that does not determine the surface.
pub(super) fn check_points(points_per_shortest_wavelength: f64) -> Result<(), PhysicsError> {
    if !(points_per_shortest_wavelength > 2.0 && points_per_shortest_wavelength.is_finite()) {
        return Err(PhysicsError::Domain {
            action: "summits of a band-limited surface",
            quantity: "the number of points per shortest wavelength",
            value: points_per_shortest_wavelength,
            allowed: "more than 2 (the Nyquist limit)",
        });
    }
    Ok(())
}

/// Apexes of the grid maxima whose row and column are in a range; nothing where the mean curvature is not
/// positive.
pub(super) fn apexes(
    heights: ArrayView2<'_, f64>,
    length: f64,
    points_per_shortest_wavelength: f64,
    within: Range<usize>,
) -> Vec<Option<Summit>> {
    let surface = BandLimited::new(heights, length, points_per_shortest_wavelength);
    let spacing = length / heights.nrows() as f64;
    let columns = within.clone();
    within
        .into_par_iter()
        .flat_map_iter(|row| maxima_of_row(heights, row))
        .filter(|(_, column)| columns.contains(column))
        .map(|(row, column)| apex(&surface, row, column, spacing, length))
        .collect()
}

/// Grid maxima of one row over the eight periodic neighbours.
pub(super) fn maxima_of_row(heights: ArrayView2<'_, f64>, row: usize) -> Vec<(usize, usize)> {
    let (rows, columns) = heights.dim();
    let above = heights.row((row + rows - 1) % rows);
    let here = heights.row(row);
    let below = heights.row((row + 1) % rows);
    let mut maxima = Vec::new();
    for column in 0..columns {
        let (left, right) = ((column + columns - 1) % columns, (column + 1) % columns);
        let h = here[column];
        // Strictly above the preceding neighbours and not below the following ones: one summit per plateau of
        // two points.
        let before = h > above[left] && h > above[column] && h > above[right] && h > here[left];
        if before && h >= here[right] && h >= below[left] && h >= below[column] && h >= below[right] {
            maxima.push((row, column));
        }
    }
    maxima
}

/// Apex near a grid maximum by Newton's method on the gradient, or the grid point if that leaves the
/// vicinity.
fn apex(surface: &BandLimited<'_>, row: usize, column: usize, spacing: f64, length: f64) -> Option<Summit> {
    let start = [row as f64 * spacing, column as f64 * spacing];
    let refined = refine(surface, start, spacing);
    let ([x, y], jet) = refined.unwrap_or_else(|| (start, surface.jet(start[0], start[1])));
    let [xx, xy, yy] = jet.hessian_1_m;
    let mean = -0.5 * (xx + yy);
    let deviator = (0.25 * (xx - yy).powi(2) + xy * xy).sqrt();
    (mean > 0.0).then(|| Summit {
        x_m: wrapped(x, length),
        y_m: wrapped(y, length),
        height_m: jet.height_m,
        curvature_1_m: mean,
        curvature_min_1_m: mean - deviator,
        curvature_max_1_m: mean + deviator,
        grid_row: row,
        grid_col: column,
        refined: refined.is_some(),
    })
}

/// Wraps a coordinate to `[0, length)`: `rem_euclid` of a tiny negative number rounds to the length itself.
fn wrapped(coordinate: f64, length: f64) -> f64 {
    let inside = coordinate.rem_euclid(length);
    if inside < length { inside } else { 0.0 }
}

fn refine(surface: &BandLimited<'_>, start: [f64; 2], spacing: f64) -> Option<([f64; 2], Jet)> {
    let mut here = start;
    let mut jet = surface.jet(here[0], here[1]);
    for _ in 0..60 {
        let [gx, gy] = jet.gradient;
        let [xx, xy, yy] = jet.hessian_1_m;
        let determinant = xx * yy - xy * xy;
        let concave = determinant > 0.0 && xx < 0.0;
        // Newton step, or a step along the gradient if the Hessian is not negative definite, since Newton
        // would converge to a saddle.
        let slope = gx.hypot(gy);
        let mut step = if concave {
            [(xy * gy - yy * gx) / determinant, (xy * gx - xx * gy) / determinant]
        } else if slope > 0.0 {
            [0.5 * spacing * gx / slope, 0.5 * spacing * gy / slope]
        } else {
            return None;
        };
        if concave && step[0].abs().max(step[1].abs()) < 1e-10 * spacing {
            return Some((here, jet));
        }
        // Halve the step until the height grows within the vicinity: long ridges overshoot.
        let mut moved = None;
        for _ in 0..12 {
            let there = [here[0] + step[0], here[1] + step[1]];
            let inside = (0..2).all(|k| (there[k] - start[k]).abs() <= spacing);
            let next = surface.jet(there[0], there[1]);
            // Below a thousandth of a spacing heights differ by rounding only, and the Newton step is
            // accepted.
            if inside && (next.height_m > jet.height_m || step[0].abs().max(step[1].abs()) < 1e-3 * spacing) {
                moved = Some((there, next));
                break;
            }
            step = step.map(|component| 0.5 * component);
        }
        (here, jet) = moved?;
    }
    None
}
