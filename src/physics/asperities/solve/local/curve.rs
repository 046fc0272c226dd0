//! Events on the solution curve of a local problem.
//!
//! The radius of a contact is the better parameter of the curve: at a fold Δ reverses and the radius
//! continues; where a contact reaches the centre of another, the field has an infinite slope in that radius
//! alone. So an event of a contact is found with its radius held and Δ unknown; a fold is a zero of `dΔ/da`.

use super::{CurveState, Hold, LocalProblem};
use crate::asperities::contact::problem::Problem;
use crate::asperities::solve::residual::NotConverged;
use crate::cycle::Effort;
use crate::math::bracket::{End, Illinois};

/// Search along the curve.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CurveSearch {
    /// Member whose radius is followed, by its position.
    pub(crate) member: usize,
    /// Radius at which the search ends \[m\].
    pub(crate) bound: f64,
    /// Mean penetration at which the search ends \[m\].
    pub(crate) target: f64,
    /// Sense of the path: 1 loading, −1 unloading.
    pub(crate) path_sense: f64,
}

/// End of a search along the curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CurveEnd {
    /// At a fold; the local problem is there.
    Fold,
    /// At the radius that bounds the search; the local problem is there.
    Bound,
    /// Neither occurs before the end of the search.
    Beyond,
}

impl LocalProblem {
    /// Continues along the curve from one of its states until the radius of member `at` is `value` \[m\].
    fn continue_to_radius(
        &mut self,
        problem: &Problem,
        at: usize,
        from: &CurveState,
        value: f64,
        effort: &mut Effort,
    ) -> Result<(), NotConverged> {
        let span = value - from.at;
        for ((radius, was), d) in self.radius.iter_mut().zip(&from.radius).zip(&from.direction) {
            // A contact at the end of its branch has no tangent in the radius of another.
            *radius = was + (d * span).clamp(-0.3 * was, 0.3 * was);
        }
        self.radius[at] = value;
        self.mean_penetration = from.mean_penetration + from.slope * span;
        self.solve(problem, Hold::Radius(at), effort)
    }

    /// Follows a member to a radius, until Δ reverses or has passed the target.
    pub(crate) fn trace_curve(
        &mut self,
        problem: &Problem,
        search: CurveSearch,
        effort: &mut Effort,
    ) -> Result<CurveEnd, NotConverged> {
        let CurveSearch { member: at, bound, target, path_sense } = search;
        let sense = (bound - self.radius[at]).signum();
        let ahead = sense * path_sense;
        self.way.clear();
        let mut before = self.point(problem, at);
        self.way.push(before.clone());
        if before.slope * ahead <= 0.0 {
            // It moves away from the bound.
            return Ok(CurveEnd::Beyond);
        }
        // The work of a soft spring needs the load of all contacts between two points of the curve.
        let most = if problem.spring.moves_as_one { 0.05 } else { 0.2 };
        // Near a fold the radius changes twice as fast as its rate predicts.
        let left = (target - self.mean_penetration).abs();
        let mut stride =
            (2.0 * left / before.slope.abs()).clamp(1e-4 * self.radius[at], most * self.radius[at]);
        let beyond = loop {
            let left = (bound - before.at).abs();
            let next = if left <= stride { bound } else { before.at + sense * stride };
            match self.continue_to_radius(problem, at, &before, next, effort) {
                Ok(()) => {
                    let point = self.point(problem, at);
                    if point.slope * ahead <= 0.0 {
                        break point;
                    }
                    if (point.mean_penetration - target) * path_sense > 0.0 {
                        return Ok(CurveEnd::Beyond);
                    }
                    self.way.push(point.clone());
                    if next == bound {
                        return Ok(CurveEnd::Bound);
                    }
                    before = point;
                    stride = (2.0 * stride).min(most * self.radius[at]);
                }
                Err(unsettled) => {
                    stride *= 0.25;
                    if stride < 1e-6 * before.at || self.way.len() > problem.numerics.solver.curve_points {
                        return Err(unsettled);
                    }
                }
            }
        };
        self.bracket(problem, at, before, beyond, effort)?;
        Ok(if (self.mean_penetration - target) * path_sense > 0.0 {
            CurveEnd::Beyond
        } else {
            CurveEnd::Fold
        })
    }

    /// The fold between two states of the curve, by the Illinois rule on `dΔ/da`.
    fn bracket(
        &mut self,
        problem: &Problem,
        at: usize,
        mut before: CurveState,
        mut beyond: CurveState,
        effort: &mut Effort,
    ) -> Result<(), NotConverged> {
        let tolerance = 1e-9 * problem.unit_m;
        let mut ends = Illinois::new(before.slope, beyond.slope);
        for _ in 0..60 {
            let span = beyond.at - before.at;
            if (before.slope * span).abs() <= tolerance || span.abs() <= 1e-9 * before.at {
                break;
            }
            let value = before.at + ends.share(0.02) * span;
            self.continue_to_radius(problem, at, &before, value, effort)?;
            let point = self.point(problem, at);
            if point.slope * before.slope > 0.0 {
                ends.narrow(End::Low, point.slope);
                before = point;
            } else {
                ends.narrow(End::High, point.slope);
                beyond = point;
            }
        }
        self.radius.clone_from(&before.radius);
        self.mean_penetration = before.mean_penetration;
        self.evaluate(problem, effort);
        self.way.push(before);
        Ok(())
    }

    fn point(&mut self, problem: &Problem, at: usize) -> CurveState {
        let (direction, slope) = self.along(problem, at);
        CurveState {
            radius: self.radius.clone(),
            mean_penetration: self.mean_penetration,
            direction,
            slope,
            at: self.radius[at],
        }
    }
}
