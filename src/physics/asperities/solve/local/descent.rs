//! Newton's method on a local problem.

use super::{Hold, LocalProblem};
use crate::asperities::contact::problem::Problem;
use crate::asperities::solve::newton::{NonlinearSystem, Worst};
use crate::cycle::Effort;

/// Newton's method on a local problem.
pub(super) struct Descent<'a> {
    pub(super) local: &'a mut LocalProblem,
    pub(super) problem: &'a Problem,
    pub(super) hold: Hold,
    pub(super) effort: &'a mut Effort,
    /// Step of the radii and of the mean penetration \[m\], and where it began.
    pub(super) step: (Vec<f64>, f64),
    pub(super) start: (Vec<f64>, f64),
}

impl NonlinearSystem for Descent<'_> {
    fn evaluate(&mut self) -> Worst {
        self.effort.iterations += 1;
        let contact = self.local.evaluate(self.problem, self.effort);
        let mut largest_m = contact.residual_m;
        if let Hold::Penetration(watched, wanted) = self.hold {
            largest_m =
                largest_m.max((self.local.penetration_of(self.problem, watched, self.effort) - wanted).abs());
        }
        Worst { contact, largest_m }
    }

    fn begin_step(&mut self, _round: usize, _worst: &Worst) {
        self.step = self.local.newton_step(self.problem, self.hold, self.effort);
        let stride =
            self.step.0.iter().zip(&self.local.radius).map(|(s, a)| (s / a).abs()).fold(0.0, f64::max);
        let most = self.problem.numerics.solver.radius_change;
        if stride > most {
            self.step.0.iter_mut().for_each(|s| *s *= most / stride);
            self.step.1 *= most / stride;
        }
        self.start = (self.local.radius.clone(), self.local.mean_penetration);
    }

    fn advance(&mut self, share: f64) {
        for ((radius, from), s) in self.local.radius.iter_mut().zip(&self.start.0).zip(&self.step.0) {
            *radius = from + share * s;
        }
        self.local.mean_penetration = self.start.1 + share * self.step.1;
    }
}
