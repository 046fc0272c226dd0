//! Search for the approach of a load at which a path reverses.

use super::minimise::Accuracy;
use super::records::Step;
use super::step::{Attempt, Walk};
use crate::physics::PhysicsError;

/// Relative accuracy of the load at a reversal.
const LOAD_ACCURACY: f64 = 1e-5;
/// Tolerance of the equilibria in the search for that load, relative to that elsewhere.
const SHARPER: f64 = 0.02;
/// Most equilibria of a search.
const SEARCHED: u32 = 40;
/// Where the load jumps across that of a reversal: the bracket of the approach, in steps, at which the search ends, and the relative jump that counts as
/// reached.
const CLOSED: f64 = 1e-6;
const JUMP: f64 = 1e-3;

impl Walk<'_> {
    /// The equilibrium at `max_load` between the last state and a step beyond it, to the accuracy of the load or of the search.
    pub(super) fn reach(&mut self, max_load: f64, beyond: Step) -> Result<Attempt, PhysicsError> {
        let (mut low, mut high) = ((self.at.last.approach, self.at.last.totals.load), (beyond.approach, beyond.totals.load));
        let Accuracy { rms, largest, iterations: most } = self.settings.accuracy;
        let accuracy = Accuracy { rms: SHARPER * rms, largest: SHARPER * largest, iterations: most };
        let mut searched = 0_u32;
        loop {
            searched += 1;
            // The secant, and bisection where that does not help.
            let secant = ((max_load - low.1) / (high.1 - low.1)).clamp(0.02, 0.98);
            let part = if searched.is_multiple_of(3) { 0.5 } else { secant };
            let approach = low.0 + part * (high.0 - low.0);
            let mut attempt = self.attempt(approach, accuracy)?;
            let step = &mut attempt.step;
            let load = step.totals.load;
            if load > max_load {
                high = (approach, load);
            } else {
                low = (approach, load);
            }
            let error = (load / max_load - 1.0).abs();
            let jumps = high.0 - low.0 < CLOSED * self.settings.step && error < JUMP;
            let reached = error < LOAD_ACCURACY || jumps;
            if reached || searched == SEARCHED {
                step.converged &= reached;
                return Ok(attempt);
            }
        }
    }
}
