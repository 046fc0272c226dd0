//! Load of an instrument without contact, from the points before contact and after separation.

use super::regression::{Normal, Residuals, solve, variance_along};
use crate::model::Baseline;

/// Fewest points without contact at one end of a loop.
pub(super) const FEWEST: usize = 8;
/// Points on each of two ends from which on slope and drift are fitted besides an offset.
const MANY: usize = 12;
/// Deviation from the baseline that is contact, in standard deviations.
const CONTACT: f64 = 6.0;
/// Deviation that is contact, as a part of the range of the load: rounding of loads without noise.
const ROUNDING: f64 = 1e-9;
/// Part of a branch in which the search for contact begins.
const SEED: f64 = 0.1;

/// Fitted baseline.
pub(super) struct Fitted {
    /// Offset \[N\], slope \[N per range of displacement\], drift \[N per loop\]; missing ones are left out.
    pub(super) normal: Option<Normal>,
    /// Rows without contact at the beginning, and first row without contact at the end.
    pub(super) free: [usize; 2],
    /// First row with contact, and first row without contact after it, before points are left out.
    pub(super) contact: [usize; 2],
    /// Scatter of the load without contact.
    pub(super) residuals: Residuals,
    terms: usize,
    range: [f64; 2],
}

impl Fitted {
    /// Gradient of the baseline by its parameters at a row of a loop.
    pub(super) fn gradient(&self, displacement: f64, place: f64) -> Vec<f64> {
        let [low, width] = self.range;
        let full = [1.0, (displacement - low) / width, place];
        full[..self.terms].to_vec()
    }

    /// Offset \[N\], slope \[N/m\] and drift over the loop \[N\]; a parameter that was not fitted is 0.
    pub(super) fn terms(&self) -> [f64; 3] {
        let value = |term: usize| self.normal.as_ref().and_then(|of| of.values.get(term)).copied();
        let [low, width] = self.range;
        let slope = value(1).unwrap_or_default() / width;
        [value(0).unwrap_or_default() - slope * low, slope, value(2).unwrap_or_default()]
    }

    /// Baseline at a row \[N\].
    pub(super) fn load(&self, displacement: f64, place: f64) -> f64 {
        let Some(normal) = &self.normal else { return 0.0 };
        self.gradient(displacement, place).iter().zip(&normal.values).map(|(u, v)| u * v).sum()
    }

    /// Load of each parameter at each row of a loop.
    pub(super) fn by_term(&self, displacement: &[f64]) -> Vec<Vec<f64>> {
        let count = displacement.len() as f64;
        let term = |term: usize| {
            let rows = displacement.iter().enumerate();
            rows.map(|(row, way)| self.gradient(*way, row as f64 / count)[term]).collect()
        };
        (0..self.terms).map(term).collect()
    }

    /// Covariance of its parameters, row by row.
    pub(super) fn covariance(&self) -> Vec<f64> {
        let variance = self.residuals.variance * self.residuals.inflation;
        let inverse = self.normal.as_ref().map_or(&[][..], |normal| &normal.inverse);
        inverse.iter().map(|entry| variance * entry).collect()
    }

    /// Variance of a linear functional of the baseline with this gradient.
    pub(super) fn variance(&self, gradient: &[f64]) -> f64 {
        let Some(normal) = &self.normal else { return 0.0 };
        self.residuals.variance * self.residuals.inflation * variance_along(&normal.inverse, gradient)
    }
}

/// Number of points from the beginning of a branch to the first contact. `load` and `at` begin without
/// contact.
fn until_contact(load: &[f64], at: &[f64], floor: f64) -> usize {
    let seed = ((SEED * load.len() as f64) as usize).max(FEWEST).min(load.len());
    let mut end = seed;
    loop {
        let rows: Vec<_> = (0..end).map(|k| (vec![1.0, at[k] - at[0]], load[k])).collect();
        let line = solve(&rows, 0.0).map_or_else(
            || [load[..end].iter().sum::<f64>() / end as f64, 0.0],
            |normal| [normal.values[0], normal.values[1]],
        );
        let apart = |k: usize| load[k] - line[0] - line[1] * (at[k] - at[0]);
        let residuals: Vec<f64> = (0..end).map(apart).collect();
        let limit = (CONTACT * Residuals::of(&residuals, 2).variance.sqrt()).max(floor);
        let first = (0..load.len()).find(|k| apart(*k).abs() > limit).unwrap_or(load.len());
        if first <= end {
            return first;
        }
        // The line is fitted again to more points, up to twice as many.
        end = first.min(2 * end);
    }
}

/// Fits the baseline of a loop with its load reversal at row `turn`.
pub(super) fn fit(load: &[f64], displacement: &[f64], turn: usize, kind: Baseline) -> Fitted {
    let count = load.len();
    let extremes = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        [low, values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low]
    };
    let floor = ROUNDING * extremes(load)[1];
    let before = until_contact(&load[..turn], &displacement[..turn], floor);
    let backwards = |values: &[f64]| values[turn + 1..].iter().rev().copied().collect::<Vec<_>>();
    let after = until_contact(&backwards(load), &backwards(displacement), floor);
    let keep = |rows: usize| if rows < FEWEST { 0 } else { rows };
    // The last points before contact may have contact below the noise.
    let kept = [keep(before), keep(after)].map(|rows| rows - rows / 20);
    let free = [kept[0], count - kept[1]];
    let contact = [before, count - after];
    let range = extremes(displacement);
    let both = kept[0] >= MANY && kept[1] >= MANY;
    let terms = match kind {
        Baseline::None => 0,
        Baseline::Line if both => 3,
        _ => 1,
    };
    let mut fitted = Fitted { normal: None, free, contact, residuals: Residuals::of(&[], 0), terms, range };
    let rows: Vec<usize> = (0..free[0]).chain(free[1]..count).collect();
    let place = |row: usize| row as f64 / count as f64;
    if terms > 0 {
        let equations: Vec<_> =
            rows.iter().map(|row| (fitted.gradient(displacement[*row], place(*row)), load[*row])).collect();
        fitted.normal = solve(&equations, 0.0);
        if fitted.normal.is_none() {
            fitted.terms = 1;
            let equations: Vec<_> = rows.iter().map(|row| (vec![1.0], load[*row])).collect();
            fitted.normal = solve(&equations, 0.0);
        }
    }
    let residuals: Vec<f64> =
        rows.iter().map(|row| load[*row] - fitted.load(displacement[*row], place(*row))).collect();
    fitted.residuals = Residuals::of(&residuals, fitted.terms);
    fitted
}
