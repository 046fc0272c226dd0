//! Levelling of measured heights, and checks of their range.

use crate::PhysicsError;
use crate::model::Detrend;
use ndarray::Array2;

/// Heights attributed to rounding, relative to their range and to their mean.
pub(crate) const ROUNDING: f64 = 1e-12;
const ROUNDING_OF_MEAN: f64 = 1e-15;
/// Maximum height and minimum deviation \[m\], for which squares neither overflow nor underflow.
const MAX_HEIGHT: f64 = 1e9;
const MIN_DEVIATION: f64 = 1e-60;

/// Refuses heights \[m\] whose squares would overflow.
///
/// Non-finite heights are missing points.
pub(crate) fn check_size(heights_m: &Array2<f64>) -> Result<(), PhysicsError> {
    let largest = heights_m.iter().filter(|h| h.is_finite()).fold(0.0_f64, |most, h| most.max(h.abs()));
    if largest <= MAX_HEIGHT {
        return Ok(());
    }
    Err(PhysicsError::Surface {
        problem: format!("heights too large: up to {largest:.1e} m (limit {MAX_HEIGHT:e} m)"),
        help: "check the unit of the heights (--unit, surface.unit), and that no value marks missing points",
    })
}

/// Levels heights \[m\]; returns the rms height of the removed form \[m\].
///
/// # Errors
/// Constant or too small heights, or heights that are zero to rounding after levelling.
pub(crate) fn level(heights: &mut Array2<f64>, kind: Detrend) -> Result<f64, PhysicsError> {
    let before = range(heights)?;
    let trend_m = detrend(heights, kind);
    left_over(heights, &before, trend_m)?;
    Ok(trend_m)
}

/// Mean and range of heights before levelling \[m\].
struct Range {
    mean: f64,
    /// Largest deviation from the mean.
    deviation: f64,
}

/// Mean and range of heights.
///
/// Refuses constant heights and those whose squares would underflow.
fn range(heights: &Array2<f64>) -> Result<Range, PhysicsError> {
    let (low, high) =
        heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(*h), high.max(*h)));
    let mean = heights.sum() / heights.len() as f64;
    let deviation = (high - mean).max(mean - low);
    if low < high && deviation < MIN_DEVIATION {
        return Err(PhysicsError::Surface {
            problem: format!("height range too small: {:.1e} m", high - low),
            help: "check the unit of the heights (--unit, surface.unit)",
        });
    }
    if low < high {
        Ok(Range { mean, deviation })
    } else {
        Err(flat(format!("its heights are constant: all are {low:e} m")))
    }
}

/// Checks that levelled heights exceed rounding.
fn left_over(heights: &Array2<f64>, before: &Range, trend_m: f64) -> Result<(), PhysicsError> {
    let most = heights.iter().fold(0.0_f64, |most, h| most.max(h.abs()));
    if most > ROUNDING * before.deviation + ROUNDING_OF_MEAN * before.mean.abs() {
        return Ok(());
    }
    Err(flat(format!(
        "it is flat to rounding: nothing is left after levelling, which removed {trend_m:.3e} m rms"
    )))
}

fn flat(problem: String) -> PhysicsError {
    PhysicsError::Surface {
        problem,
        help: "a rough surface is needed: check which field of the file is read, and its units",
    }
}

/// Subtracts a least-squares form; returns its rms height \[m\] about its mean.
///
/// The mean is always subtracted.
fn detrend(heights: &mut Array2<f64>, kind: Detrend) -> f64 {
    let n = heights.nrows();
    let count = heights.len() as f64;
    // On a complete square grid these shapes are orthogonal, so each coefficient is independent.
    let at = |k: usize| (2 * k + 1) as f64 / n as f64 - 1.0;
    let mean_square = (0..n).map(|k| at(k).powi(2)).sum::<f64>() / n as f64;
    type Shape<'a> = Box<dyn Fn(f64, f64) -> f64 + 'a>;
    let plane: [Shape<'_>; 2] = [Box::new(|x, _| x), Box::new(|_, y| y)];
    let curved: [Shape<'_>; 3] = [
        Box::new(|x, y| x * y),
        Box::new(move |x, _| x * x - mean_square),
        Box::new(move |_, y| y * y - mean_square),
    ];
    let mean = heights.sum() / count;
    heights.mapv_inplace(|h| h - mean);
    let mut squares = 0.0;
    let shapes = plane
        .iter()
        .filter(|_| kind != Detrend::Mean)
        .chain(curved.iter().filter(|_| kind == Detrend::Quadratic));
    for shape in shapes {
        let (mut product, mut norm) = (0.0, 0.0);
        for ((i, j), h) in heights.indexed_iter() {
            let value = shape(at(i), at(j));
            product += value * h;
            norm += value * value;
        }
        let coefficient = product / norm;
        heights.indexed_iter_mut().for_each(|((i, j), h)| *h -= coefficient * shape(at(i), at(j)));
        squares += coefficient * coefficient * norm / count;
    }
    squares.sqrt()
}
