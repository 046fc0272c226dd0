//! Search for the approach of a load at which a path reverses.

use super::records::Step;
use super::step::{Attempt, CycleRun};
use crate::PhysicsError;
use crate::elements::equilibrium::minimise::Accuracy;

/// Relative accuracy of the load at a reversal.
pub(crate) const LOAD_ACCURACY: f64 = 1e-5;
/// Relative accuracy of a jump of the load across that of a reversal.
pub(crate) const JUMP_ACCURACY: f64 = 1e-3;
/// Tolerance of the equilibria near that load, relative to that elsewhere, and the relative distance at which it begins.
pub(crate) const SHARPER: f64 = 0.02;
const SHARPER_WITHIN: f64 = 0.02;
/// Bracket of the approach at which the load jumps, in steps.
const CLOSED: f64 = 1e-5;
/// Most equilibria of a search.
pub(crate) const SEARCHED: u32 = 40;

impl CycleRun<'_> {
    /// True if the load at a reversal after a jump is near that of the spec.
    pub(crate) fn exceeds_by_a_jump(load: f64, max_load: f64) -> bool {
        (load / max_load - 1.0).abs() < JUMP_ACCURACY
    }

    /// The equilibrium at `max_load` between the last state and a step `beyond` it, or after a jump of the load across it. States of a smaller load on the
    /// way are steps of the path, so that each equilibrium is near the last one. None if the load falls on this way and does not reach `max_load`.
    pub(crate) fn reach(&mut self, max_load: f64, beyond: Step) -> Result<Option<Attempt>, PhysicsError> {
        let Accuracy { rms, largest, iterations } = self.settings.accuracy;
        let sharper = Accuracy { rms: SHARPER * rms, largest: SHARPER * largest, iterations };
        let off = |load: f64| (load / max_load - 1.0).abs();
        let mut high = (beyond.approach, beyond.totals.load);
        for searched in 1_u32.. {
            let low = (self.at.last.approach, self.at.last.totals.load);
            let closed = high.0 - low.0 < CLOSED * self.settings.step;
            // The secant, and bisection where that does not help.
            let secant = ((max_load - low.1) / (high.1 - low.1)).clamp(0.02, 0.98);
            let part = if searched.is_multiple_of(3) { 0.5 } else { secant };
            let approach = if closed { high.0 } else { low.0 + part * (high.0 - low.0) };
            let near = closed || off(low.1).min(off(high.1)) < SHARPER_WITHIN;
            let mut attempt = self.attempt(approach, if near { sharper } else { self.settings.accuracy })?;
            let load = attempt.step.totals.load;
            let reached = off(load) < LOAD_ACCURACY;
            let jumps = closed && load > max_load;
            if reached || jumps || searched == SEARCHED {
                attempt.step.converged &= reached || jumps && Self::exceeds_by_a_jump(load, max_load);
                return Ok(Some(attempt));
            }
            if load > max_load {
                high = (approach, load);
                continue;
            }
            self.accept(attempt);
            if closed {
                break;
            }
        }
        Ok(None)
    }
}
