//! Overdamped relaxation `da_i/dt = residual_i`, where Newton's method finds no equilibrium: after a fold, or a jump.
//!
//! Implicit Euler steps, that grow as the contact comes to rest. On the way a spot whose own branch has ended leaves, and one that a greater spot has
//! reached is covered: the flow decides who, without reference to the step of the approach. For `point` it is a gradient flow of the potential.

use super::residual::{NotConverged, STRIDE};
use crate::physics::Reason;
use crate::physics::contact::problem::Problem;
use crate::physics::contact::transition::{ContactView, Transition};
use crate::physics::math::vector::dot;

/// Steps at most since a spot was taken out last: however many go, each is a step towards rest.
const STEPS: usize = 1000;

/// Steps without rest after which a spot at the edge of another is covered.
const RESTLESS: usize = 200;

/// Time after which Newton's method may finish, and how much longer the flow goes on where it does not.
const NEARLY: f64 = 100.0;
const LONGER: f64 = 1e3;

/// The longest step of time, and how much longer each is than the one before.
const LONGEST: f64 = 1e9;
const GROWTH: f64 = 3.0;

/// Attempts at a step, each a quarter as long as the one before.
const ATTEMPTS: usize = 24;

/// A contact, or a part of one, at an approach.
pub(crate) trait Relaxing {
    /// Evaluates fields and residuals; the worst residual, and whose it is.
    fn evaluate(&mut self) -> NotConverged;
    /// The spots, ascending, as they were evaluated last.
    fn spots(&self) -> Vec<ContactView>;
    /// Applies a change that takes a spot out.
    fn take_out(&mut self, change: &Transition);
    /// Tries to finish by Newton's method in short steps; where that does not lead to rest, all is as before.
    fn finish(&mut self) -> bool;
    /// The implicit step over a time, and whether the flow is stable over it as far as is known.
    fn step(&mut self, time: f64) -> (Vec<f64>, bool);
    /// Changes the radii by a share of a step.
    fn advance(&mut self, step: &[f64], share: f64);
}

/// Relaxes. Spots that leave or are covered on the way are taken out, and returned.
///
/// Where an asperity has just been uncovered (`uncovered`) and is covered again on the way, or exchanges parts with the spot that covered it, the rest
/// of the way is of no interest, and the relaxation ends there.
pub(crate) fn relax(
    contact: &mut impl Relaxing,
    problem: &Problem,
    uncovered: Option<&Transition>,
) -> Result<Vec<Transition>, NotConverged> {
    let mut changes: Vec<Transition> = Vec::new();
    let (mut time, mut finish) = (1.0, NEARLY);
    let mut last = NotConverged::because(Reason::NotANumber, 0);
    let mut round = 0;
    while round < STEPS {
        round += 1;
        last = contact.evaluate();
        if last.residual_m <= problem.tolerance_m() {
            return Ok(changes);
        }
        if last.residual_m.is_nan() {
            return Err(last);
        }
        let spots = contact.spots();
        let restless = if round.is_multiple_of(RESTLESS) { problem.at_edge(&spots, last.asperity) } else { None };
        if let Some(change) = problem.overtaken(&spots).or(restless) {
            contact.take_out(&change);
            changes.push(change);
            if uncovered.is_some_and(|earlier| change.undoes(earlier)) {
                return Ok(changes);
            }
            (round, time, finish) = (0, 1.0, NEARLY);
            continue;
        }
        if time > finish {
            // Nearly at rest: Newton's method finishes, unless it is led to an equilibrium that repels. At the edge of a spot, where the slope of its
            // field jumps, implicit steps would go to and fro for ever, while short steps that descend arrive.
            if contact.finish() {
                continue;
            }
            contact.evaluate();
            finish *= LONGER;
        }
        let residual: Vec<f64> = spots.iter().map(|spot| spot.2).collect();
        let stride = |step: &[f64]| step.iter().zip(&spots).map(|(s, spot)| s.abs() / spot.1).fold(0.0, f64::max);
        let mut step = Vec::new();
        for _ in 0..ATTEMPTS {
            let stable;
            (step, stable) = contact.step(time);
            // With too long a step a saddle attracts: the step must go along the flow.
            if stable && stride(&step) <= STRIDE && dot(&step, &residual) > 0.0 {
                break;
            }
            time *= 0.25;
        }
        let stride = stride(&step);
        let share = if stride > STRIDE { STRIDE / stride } else { 1.0 };
        contact.advance(&step, share);
        time = (time * GROWTH).min(LONGEST);
    }
    Err(last)
}
