//! Pull-off force of a measured branch with noise.
//!
//! The smallest of many noisy loads is too small. So a polynomial is fitted to the loads near the minimum,
//! and its minimum is taken.

use super::Estimate;
use super::regression::{Residuals, solve, variance_along};

/// Depth of the loads that are fitted, as a part of the minimum.
const DEPTH: f64 = 0.93;
/// Fewest points of a fit.
const FEWEST: usize = 8;
/// Points of the moving mean that finds the minimum.
const SMOOTH: usize = 5;

/// Pull-off force \[N\] from the loads of the unloading branch while in contact, and the row of its minimum.
/// The standard error has the difference of two polynomials in it. `noise` is the standard deviation of one
/// load.
pub(super) fn pull_off(load: &[f64], noise: f64, inflation: f64) -> Option<(Estimate, usize)> {
    let smallest = |values: &mut dyn Iterator<Item = (usize, f64)>| values.min_by(|u, v| u.1.total_cmp(&v.1));
    let (raw_row, raw) = smallest(&mut load.iter().copied().enumerate())?;
    let mut means = load
        .windows(SMOOTH)
        .enumerate()
        .map(|(k, near)| (k + SMOOTH / 2, near.iter().sum::<f64>() / SMOOTH as f64));
    let is_noisy = noise > 1e-9 * raw.abs();
    let (row, least) = if is_noisy { smallest(&mut means).unwrap_or((raw_row, raw)) } else { (raw_row, raw) };
    if least >= 0.0 || raw >= 0.0 {
        return None;
    }
    let is_deep = |k: usize| load[k] <= DEPTH * least || (load[k] - DEPTH * least).abs() < noise;
    let end = |step: &mut dyn Iterator<Item = usize>| step.take_while(|k| is_deep(*k)).last().unwrap_or(row);
    let window = end(&mut (0..=row).rev())..=end(&mut (row..load.len()));
    let simple = (Estimate { value: -raw, standard_error: noise, degrees_of_freedom: load.len() }, raw_row);
    if window.clone().count() < FEWEST {
        return Some(simple);
    }
    let [cubic, quadratic] = [4, 3].map(|terms| minimum(load, window.clone(), terms));
    let (Some(cubic), Some(quadratic)) = (cubic, quadratic) else { return Some(simple) };
    let local = cubic.residuals;
    let variance = local.variance.max(noise * noise) * local.inflation.max(inflation);
    let difference = 0.5 * (cubic.value - quadratic.value);
    let standard_error = (variance * cubic.leverage + difference * difference).sqrt();
    let degrees_of_freedom = local.degrees_of_freedom;
    Some((Estimate { value: -cubic.value, standard_error, degrees_of_freedom }, row))
}

/// Minimum of a fitted polynomial.
struct Minimum {
    value: f64,
    /// Variance of the value for a variance of 1.
    leverage: f64,
    residuals: Residuals,
}

/// Minimum of a polynomial with `terms` terms over a window of rows.
fn minimum(load: &[f64], window: std::ops::RangeInclusive<usize>, terms: i32) -> Option<Minimum> {
    let (low, high) = (*window.start() as f64, *window.end() as f64);
    let powers = |row: f64| {
        let x = (2.0 * row - low - high) / (high - low);
        (0..terms).map(|power| x.powi(power)).collect::<Vec<_>>()
    };
    let rows: Vec<_> = window.map(|row| (powers(row as f64), load[row])).collect();
    let fit = solve(&rows, 0.0)?;
    let value = |gradient: &[f64]| gradient.iter().zip(&fit.values).map(|(u, v)| u * v).sum::<f64>();
    let fine = (0..=1000).map(|k| low + (high - low) * f64::from(k) / 1000.0);
    let at = fine.min_by(|u, v| value(&powers(*u)).total_cmp(&value(&powers(*v))))?;
    let residuals: Vec<f64> = rows.iter().map(|(gradient, load)| load - value(gradient)).collect();
    let gradient = powers(at);
    Some(Minimum {
        value: value(&gradient),
        leverage: variance_along(&fit.inverse, &gradient),
        residuals: Residuals::of(&residuals, rows[0].0.len()),
    })
}
