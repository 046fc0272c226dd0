//! Search for the mean penetration of a load at which a path reverses.

use super::records::Step;
use super::step::{Attempt, CycleRun};
use crate::PhysicsError;
use crate::elements::equilibrium::minimise::Accuracy;

impl CycleRun<'_> {
    /// True if the load at a reversal after a jump is near that of the spec.
    pub(crate) fn exceeds_by_a_jump(&self, load: f64, max_load: f64) -> bool {
        (load / max_load - 1.0).abs() < self.problem.numerics.reversal.jump_tolerance
    }

    /// The equilibrium at `max_load` between the last state and a step `beyond` it, or after a jump of the
    /// load across it. States of a smaller load on the way are steps of the path, so that each equilibrium is
    /// near the last one. None if the load falls on this way and does not reach `max_load`.
    ///
    /// The load at the end of a bracket falls where an event, or the sharper tolerance of the equilibrium,
    /// takes it below `max_load`. The search then goes on up to `beyond`. Without a path to return to, the
    /// path itself goes on.
    pub(crate) fn reach(&mut self, max_load: f64, beyond: Step) -> Result<Option<Attempt>, PhysicsError> {
        let limits = self.problem.numerics.reversal;
        let Accuracy { rms, largest, iterations } = self.settings.accuracy;
        let sharper =
            Accuracy { rms: limits.precision * rms, largest: limits.precision * largest, iterations };
        let off = |load: f64| (load / max_load - 1.0).abs();
        let end = (beyond.mean_penetration, beyond.totals.load);
        let mut high = end;
        let mut falls = false;
        for searched in 1_u32.. {
            let low = (self.at.last.mean_penetration, self.at.last.totals.load);
            let closed = high.0 - low.0 < limits.bracket * self.settings.step;
            // The secant, and bisection where that does not help.
            let secant = ((max_load - low.1) / (high.1 - low.1)).clamp(0.02, 0.98);
            let part = if searched.is_multiple_of(3) { 0.5 } else { secant };
            let mean_penetration = if closed { high.0 } else { low.0 + part * (high.0 - low.0) };
            let near = closed || falls || off(low.1).min(off(high.1)) < limits.precise_within;
            let mut attempt =
                self.attempt(mean_penetration, if near { sharper } else { self.settings.accuracy })?;
            let load = attempt.step.totals.load;
            let reached = off(load) < limits.load_tolerance;
            let jumps = closed && load > max_load;
            if reached || jumps || searched == limits.equilibria {
                attempt.step.converged &= reached || jumps && self.exceeds_by_a_jump(load, max_load);
                return Ok(Some(attempt));
            }
            if load > max_load {
                high = (mean_penetration, load);
                continue;
            }
            self.accept(attempt);
            if closed {
                if self.at.trunk.is_none() || mean_penetration >= end.0 {
                    break;
                }
                (high, falls) = (end, true);
            }
        }
        Ok(None)
    }
}
