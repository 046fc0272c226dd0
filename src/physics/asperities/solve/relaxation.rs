//! Overdamped relaxation `da_i/dt = residual_i` (pseudo-transient continuation), where Newton's method finds
//! no equilibrium: after a fold or a jump.
//!
//! Implicit Euler steps grow as the residual falls. A contact whose branch has ended leaves, and a contact
//! that a larger one has reached is absorbed. The order follows from the flow and not from the output steps.
//! For point interaction it is a gradient flow of the potential.

use super::residual::NotConverged;
use crate::Reason;
use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::transition::{ContactView, Transition};
use crate::math::vector::dot;

/// A contact, or a local problem, at one mean penetration.
pub(crate) trait Relaxing {
    /// Evaluates fields and residuals; returns the largest residual with its asperity.
    fn evaluate(&mut self) -> NotConverged;
    /// Contacts as they were evaluated last, ascending.
    fn spots(&self) -> Vec<ContactView>;
    /// Removes a contact.
    fn take_out(&mut self, change: &Transition);
    /// Tries to finish by Newton's method in short steps; without success nothing is changed.
    fn finish(&mut self) -> bool;
    /// Implicit step over a pseudo-time, and whether the flow is stable over it as far as is known.
    fn step(&mut self, time: f64) -> (Vec<f64>, bool);
    /// Residual below which it is in equilibrium \[m\].
    fn tolerance_m(&self) -> f64;
    /// Moves the radii by a share of a step.
    fn advance(&mut self, step: &[f64], share: f64);
}

/// Relaxes to an equilibrium; the transitions on the way are returned.
///
/// It ends early where an asperity that has just been uncovered (`uncovered`) is absorbed again, or absorbs
/// the contact that covered it.
pub(crate) fn relax(
    contact: &mut impl Relaxing,
    problem: &Problem,
    uncovered: Option<&Transition>,
) -> Result<Vec<Transition>, NotConverged> {
    let mut changes: Vec<Transition> = Vec::new();
    let (limits, most) = (&problem.numerics.solver.relaxation, problem.numerics.solver.radius_change);
    let (mut time, mut finish) = (1.0, limits.finish);
    let mut last = NotConverged::because(Reason::NotANumber, 0);
    let mut round = 0;
    while round < limits.steps {
        round += 1;
        last = contact.evaluate();
        if last.residual_m <= contact.tolerance_m() {
            return Ok(changes);
        }
        if last.residual_m.is_nan() {
            return Err(last);
        }
        let spots = contact.spots();
        if let Some(change) = problem.overtaken(&spots) {
            contact.take_out(&change);
            changes.push(change);
            if uncovered.is_some_and(|earlier| change.undoes(earlier)) {
                return Ok(changes);
            }
            (round, time, finish) = (0, 1.0, limits.finish);
            continue;
        }
        if time > finish {
            // Near the equilibrium Newton's method finishes, unless the equilibrium is unstable. At the edge
            // of a contact, where the slope of its field jumps, implicit steps would alternate without end,
            // while short descending steps converge.
            if contact.finish() {
                continue;
            }
            contact.evaluate();
            finish *= limits.finish_growth;
        }
        let residual: Vec<f64> = spots.iter().map(|spot| spot.2).collect();
        let stride =
            |step: &[f64]| step.iter().zip(&spots).map(|(s, spot)| s.abs() / spot.1).fold(0.0, f64::max);
        let mut step = Vec::new();
        for _ in 0..limits.attempts {
            let stable;
            (step, stable) = contact.step(time);
            // With too long a step a saddle attracts: the step must follow the flow.
            if stable && stride(&step) <= most && dot(&step, &residual) > 0.0 {
                break;
            }
            time *= 0.25;
        }
        let stride = stride(&step);
        let share = if stride > most { most / stride } else { 1.0 };
        contact.advance(&step, share);
        time = (time * limits.step_growth).min(limits.longest_step);
    }
    Err(last)
}
