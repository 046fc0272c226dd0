//! Offsets of scan lines: their detection and removal.
//!
//! A scanning instrument measures line by line along its fast axis, and drift or vibration gives each line an
//! offset of its own.

use super::outliers::median;
use crate::model::FastAxis;
use ndarray::{Array2, ArrayView1, ArrayView2, Axis};
use rayon::prelude::*;

/// Parts of a line whose offsets are compared.
const PARTS: usize = 8;
/// Fewest points of a line, and fewest lines, in which offsets are looked for.
const MIN_LINES: usize = 16;
/// Standard deviations beyond which an offset is clipped, so that a few steps of the surface do not count.
const CLIP: f64 = 4.0 * 1.4826;
/// Minimum part of the variance of the differences that all parts of a line have in common.
pub(super) const COMMON: f64 = 0.5;
/// Rms fourth difference over rms second difference of offsets, both of unit response to independent offsets:
/// about 1. Smooth surfaces are below.
const INDEPENDENT: [f64; 2] = [0.77, 1.35];
/// Maximum correlation of the offsets at any distance. Periodic surfaces are above.
pub(super) const PERIODIC: f64 = 0.8;
/// Largest distance of that correlation in lines.
const LONGEST_LAG: usize = 512;
/// Variance of a fourth difference over 6, and of a second difference over 2, of independent numbers of
/// variance 1.
const VARIANCES: [f64; 2] = [70.0 / 36.0, 1.5];
/// Standard deviations beyond which a single line is displaced.
const DISPLACED: f64 = 6.0 * 1.4826;

/// Offsets that were removed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aligned {
    /// Direction of the scan lines.
    pub axis: FastAxis,
    /// Rms offset, without its linear trend.
    pub offset: f64,
}

/// Removes the offset of each scan line: the median of its differences from the line before, added up.
///
/// The linear trend of the offsets is kept, since levelling removes it with the slope of the surface.
/// Components of the true roughness that vary across the lines only are removed as well.
/// With [`FastAxis::Auto`] lines are columns if [`line_jump`] is larger for them, else rows.
pub fn align(heights: &mut Array2<f64>, axis: FastAxis) -> Aligned {
    let axis = match axis {
        FastAxis::Auto if line_jump(heights.t()) > line_jump(heights.view()) => FastAxis::Columns,
        FastAxis::Auto => FastAxis::Rows,
        chosen => chosen,
    };
    let across = Axis(usize::from(axis == FastAxis::Columns));
    let offsets = offsets(if axis == FastAxis::Columns { heights.t() } else { heights.view() });
    for (mut line, offset) in heights.axis_iter_mut(across).zip(&offsets) {
        line.mapv_inplace(|height| height - offset);
    }
    Aligned { axis, offset: rms(&offsets) }
}

/// Offsets of the rows, without mean and linear trend.
fn offsets(heights: ArrayView2<'_, f64>) -> Vec<f64> {
    let rows = heights.nrows();
    let step = |row: usize| difference(heights.row(row), heights.row(row + 1)).unwrap_or(0.0);
    let steps: Vec<f64> = (0..rows.saturating_sub(1)).into_par_iter().map(step).collect();
    let mut offsets = vec![0.0; rows];
    for (row, step) in steps.iter().enumerate() {
        offsets[row + 1] = offsets[row] + step;
    }
    let count = rows as f64;
    let mean = offsets.iter().sum::<f64>() / count;
    let place = |row: usize| row as f64 - 0.5 * (count - 1.0);
    let norm: f64 = (0..rows).map(|row| place(row).powi(2)).sum();
    let slope =
        offsets.iter().enumerate().map(|(row, offset)| place(row) * offset).sum::<f64>() / norm.max(1.0);
    offsets.iter().enumerate().map(|(row, offset)| offset - mean - slope * place(row)).collect()
}

/// Median difference of two lines where both are known.
fn difference(from: ArrayView1<'_, f64>, to: ArrayView1<'_, f64>) -> Option<f64> {
    let mut differences: Vec<f64> =
        from.iter().zip(to).map(|(from, to)| to - from).filter(|step| step.is_finite()).collect();
    (!differences.is_empty()).then(|| median(&mut differences))
}

/// Rms offset of the rows against each other, 0 if there is none.
///
/// Offsets of scan lines are the same along a whole line and independent of the offsets of other lines. Three
/// conditions must therefore hold for the medians of the differences of adjacent rows, taken in eight parts
/// along the rows:
/// - At least half of the variance of their third differences is common to all parts.
/// - These vary from row to row as independent offsets do, and not smoothly as a surface does.
/// - They do not repeat periodically.
///
/// Single rows that are displaced against both neighbours along their whole length count as well.
#[must_use]
pub fn line_jump(heights: ArrayView2<'_, f64>) -> f64 {
    let (rows, columns) = heights.dim();
    if rows < MIN_LINES || columns < MIN_LINES {
        return 0.0;
    }
    let part = |part: usize| part * columns / PARTS..(part + 1) * columns / PARTS;
    let steps: Vec<Option<[f64; PARTS]>> = (0..rows - 1)
        .into_par_iter()
        .map(|row| {
            let mut steps = [0.0; PARTS];
            for (k, step) in steps.iter_mut().enumerate() {
                let of = |row: usize| heights.row(row).slice_move(ndarray::s![part(k)]);
                *step = difference(of(row), of(row + 1))?;
            }
            Some(steps)
        })
        .collect();
    let of_all = independent_offset(&steps);
    if of_all > 0.0 { of_all } else { displaced_offset(&steps, rows) }
}

/// A combination of steps between adjacent rows, wherever all of them are known.
fn combined<const N: usize>(steps: &[Option<[f64; PARTS]>], weights: [f64; N]) -> Vec<[f64; PARTS]> {
    let sum = |window: &[Option<[f64; PARTS]>]| {
        let mut sum = [0.0; PARTS];
        for (steps, weight) in window.iter().zip(weights) {
            let steps = steps.as_ref()?;
            sum.iter_mut().zip(steps).for_each(|(sum, step)| *sum += weight * step);
        }
        Some(sum)
    };
    steps.windows(N).filter_map(sum).collect()
}

/// Rms of independent offsets of all rows; 0 without any.
fn independent_offset(steps: &[Option<[f64; PARTS]>]) -> f64 {
    // The fourth difference of the offsets over 6, and the second one over 2.
    let fourth = combined(steps, [1.0, -3.0, 3.0, -1.0].map(|weight| weight / 6.0));
    let second = combined(steps, [0.5, -0.5]);
    if fourth.len() < MIN_LINES / 2 {
        return 0.0;
    }
    let [(common, all), (smoother, _)] = [&fourth, &second].map(|list| variances(list));
    if !(common > 0.0 && smoother > 0.0 && common >= COMMON * all) {
        return 0.0;
    }
    let [fine, coarse] = [common / VARIANCES[0], smoother / VARIANCES[1]];
    let ratio = (fine / coarse).sqrt();
    let independent = (INDEPENDENT[0]..=INDEPENDENT[1]).contains(&ratio) && correlation(&fourth) < PERIODIC;
    if independent { fine.sqrt() } else { 0.0 }
}

/// Variance that all parts have in common, and the mean variance of a part, both of clipped values.
fn variances(list: &[[f64; PARTS]]) -> (f64, f64) {
    let mut sizes: Vec<f64> = list.iter().flatten().map(|value| value.abs()).collect();
    let most = CLIP * median(&mut sizes);
    let (mut products, mut squares) = (0.0, 0.0);
    for parts in list {
        let parts = parts.map(|value| value.clamp(-most, most));
        let (sum, square) = (parts.iter().sum::<f64>(), parts.iter().map(|value| value * value).sum::<f64>());
        products += sum * sum - square;
        squares += square;
    }
    let count = list.len() as f64;
    (products / (count * (PARTS * (PARTS - 1)) as f64), squares / (count * PARTS as f64))
}

/// Largest correlation of the medians of rows at distances that share no row.
fn correlation(list: &[[f64; PARTS]]) -> f64 {
    let medians: Vec<f64> = list.iter().map(|parts| median(&mut parts.clone())).collect();
    let of_lag = |lag: usize| {
        let (early, late) = (&medians[..medians.len() - lag], &medians[lag..]);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let norm = (product(early, early) * product(late, late)).sqrt();
        if norm > 0.0 { product(early, late) / norm } else { 0.0 }
    };
    (5..=(medians.len() / 3).min(LONGEST_LAG)).map(of_lag).fold(0.0, f64::max)
}

/// Rms offset of single rows that are displaced against both neighbours.
fn displaced_offset(steps: &[Option<[f64; PARTS]>], rows: usize) -> f64 {
    let bends: Vec<Option<[f64; PARTS]>> =
        steps.windows(2).map(|pair| combined(pair, [0.5, -0.5]).into_iter().next()).collect();
    let middle = |bend: &Option<[f64; PARTS]>| bend.as_ref().map(|parts| median(&mut parts.clone()));
    let medians: Vec<Option<f64>> = bends.iter().map(middle).collect();
    let mut sizes: Vec<f64> = medians.iter().flatten().map(|bend| bend.abs()).collect();
    if sizes.len() < MIN_LINES / 2 {
        return 0.0;
    }
    let limit = DISPLACED * median(&mut sizes);
    let displaced = |k: &usize| {
        let (Some(parts), Some(bend)) = (bends[*k], medians[*k]) else { return false };
        // All parts bend alike, and both neighbours by half as much the other way.
        let alike = parts.iter().all(|part| part / bend > 0.5);
        let opposed = [k - 1, k + 1]
            .iter()
            .all(|next| medians[*next].is_some_and(|next| (-0.8..=-0.2).contains(&(next / bend))));
        bend.abs() > limit && alike && opposed
    };
    let found = (1..bends.len().saturating_sub(1)).filter(displaced);
    let squares: f64 = found.filter_map(|k| medians[k]).map(|bend| bend * bend).sum();
    (squares / rows as f64).sqrt()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
