//! Continuation of a field that is not periodic, and its derivatives.
//!
//! The field is continued by point reflection at its edges: `h(−x) = 2 h(0) − h(x)`. Heights and slopes are
//! then continuous. Mirror images `h(−x) = h(x)` have a kink at the edges, which rings in the second
//! derivatives.

use super::band_limited::BandLimited;
use super::spectrum::Moments;
use crate::PhysicsError;
use crate::memory::zeros;
use ndarray::{Array2, ArrayView2};
use rayon::prelude::*;

/// Minimum distance from the edges, in points, where derivatives and asperities are taken.
pub(super) const MIN_MARGIN: usize = 4;

/// Points along each edge whose derivatives and asperities are excluded: half a cut-off wavelength, at least
/// four points.
///
/// The heights there depend on the rule for the edges.
pub(super) fn margin(points_per_shortest_wavelength: f64) -> usize {
    ((0.5 * points_per_shortest_wavelength).ceil() as usize).max(MIN_MARGIN)
}

/// A square field with `width` further points on each side.
///
/// # Errors
/// Too little memory.
pub(super) fn continued(heights: ArrayView2<'_, f64>, width: usize) -> Result<Array2<f64>, PhysicsError> {
    let n = heights.nrows();
    let sources: Vec<[(usize, f64); 3]> =
        (0..n + 2 * width).map(|k| source(k as i64 - width as i64, n)).collect();
    let mut whole = zeros((n + 2 * width, n + 2 * width))?;
    whole.indexed_iter_mut().for_each(|((i, j), h)| {
        let [rows, columns] = [&sources[i], &sources[j]];
        *h = if let ([(row, _), (_, 0.0), _], [(column, _), (_, 0.0), _]) = (rows, columns) {
            heights[[*row, *column]]
        } else {
            rows.iter()
                .map(|(row, a)| {
                    columns.iter().map(|(column, b)| a * b * heights[[*row, *column]]).sum::<f64>()
                })
                .sum()
        };
    });
    Ok(whole)
}

/// Points of a line of `n` points, with weights, whose sum is the continued height at point `k`. The second
/// weight is 0 inside the line only.
fn source(mut k: i64, n: usize) -> [(usize, f64); 3] {
    let last = n as i64 - 1;
    let (mut sign, mut first, mut end) = (1.0, 0.0, 0.0);
    while !(0..=last).contains(&k) {
        if k < 0 {
            first += 2.0 * sign;
            k = -k;
        } else {
            end += 2.0 * sign;
            k = 2 * last - k;
        }
        sign = -sign;
    }
    if first == 0.0 {
        [(k as usize, sign), (last as usize, end), (0, first)]
    } else {
        [(k as usize, sign), (0, first), (last as usize, end)]
    }
}

/// Moments of a square field that is not periodic, with a spacing in \[m\] and a mean of 0.
///
/// `m0 = ⟨h²⟩` is the mean over the square. `m2 = ½⟨|∇h|²⟩` and `m4 = ⅜⟨(∇²h)²⟩` are means over the points
/// farther than [`margin`] from its edges.
///
/// # Errors
/// Too little memory.
pub(super) fn moments(
    heights: ArrayView2<'_, f64>,
    spacing_m: f64,
    points: f64,
) -> Result<Moments, PhysicsError> {
    let n = heights.nrows();
    let [slope, second] = BandLimited::stencils(points);
    let whole = continued(heights, slope.len() / 2)?;
    let edge = margin(points);
    let inside = edge..n - edge;
    // Sums of each row, added in the order of the rows.
    let of_row = |row: usize| {
        let sum = |stencil: &[f64], of: fn(f64, f64) -> f64| {
            let [x, y] = along_both(whole.view(), row, stencil, n);
            inside.clone().map(|column| of(x[column], y[column])).sum::<f64>()
        };
        [sum(&slope, |x, y| x * x + y * y), sum(&second, |xx, yy| (xx + yy).powi(2))]
    };
    let rows: Vec<[f64; 2]> = inside.clone().into_par_iter().map(of_row).collect();
    let [slopes, laplacians] = rows.iter().fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
    let count = (inside.len() * inside.len()) as f64;
    Ok(Moments {
        m0_m2: heights.iter().map(|h| h * h).sum::<f64>() / (n * n) as f64,
        m2: 0.5 * slopes / count / spacing_m.powi(2),
        m4_1_m2: 0.375 * laplacians / count / spacing_m.powi(4),
    })
}

/// Laplacian of a square field that is not periodic, for a spacing of 1.
///
/// # Errors
/// Too little memory.
pub(crate) fn laplacian(heights: ArrayView2<'_, f64>, points: f64) -> Result<Array2<f64>, PhysicsError> {
    let n = heights.nrows();
    let [_, second] = BandLimited::stencils(points);
    let whole = continued(heights, second.len() / 2)?;
    let mut field = zeros((n, n))?;
    let Some(values) = field.as_slice_mut() else { return Ok(field) };
    values.par_chunks_mut(n).enumerate().for_each(|(row, line)| {
        let [xx, yy] = along_both(whole.view(), row, &second, n);
        line.iter_mut().zip(xx.iter().zip(&yy)).for_each(|(to, (a, b))| *to = a + b);
    });
    Ok(field)
}

/// Derivatives along x and along y at the `n` points of a row of a continued field.
fn along_both(whole: ArrayView2<'_, f64>, row: usize, stencil: &[f64], n: usize) -> [Vec<f64>; 2] {
    let width = stencil.len() / 2;
    let mut along_x = vec![0.0; n];
    for (k, weight) in stencil.iter().enumerate() {
        along_x.iter_mut().zip(whole.row(row + k).iter().skip(width)).for_each(|(sum, h)| *sum += weight * h);
    }
    let line = whole.row(row + width);
    let at = |column: usize| line.iter().skip(column).zip(stencil).map(|(h, weight)| h * weight).sum();
    [along_x, (0..n).map(at).collect()]
}
