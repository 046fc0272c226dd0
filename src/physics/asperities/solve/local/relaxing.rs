//! Relaxation of a local problem ([`crate::asperities::solve::relaxation`]).

use super::{Hold, LocalProblem};
use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::transition::{ContactView, Transition};
use crate::asperities::solve::newton::Damping;
use crate::asperities::solve::relaxation::{Relaxing, relax};
use crate::asperities::solve::residual::NotConverged;
use crate::cycle::Effort;

impl LocalProblem {
    /// Relaxes at the present mean penetration ([`crate::asperities::solve::relaxation`]); the transitions on
    /// the way are returned.
    pub(crate) fn relax(
        &mut self,
        problem: &Problem,
        uncovered: Option<&Transition>,
        effort: &mut Effort,
    ) -> Result<Vec<Transition>, NotConverged> {
        relax(&mut Part { patch: self, problem, effort }, problem, uncovered)
    }
}

/// Local problem during a relaxation.
struct Part<'a> {
    patch: &'a mut LocalProblem,
    problem: &'a Problem,
    effort: &'a mut Effort,
}

impl Relaxing for Part<'_> {
    fn evaluate(&mut self) -> NotConverged {
        self.effort.iterations += 1;
        self.patch.evaluate(self.problem, self.effort)
    }

    fn spots(&self) -> Vec<ContactView> {
        let LocalProblem { members, radius, residual, .. } = &*self.patch;
        members.iter().zip(radius).zip(residual).map(|((m, a), r)| (m.asperity, *a, *r)).collect()
    }

    fn take_out(&mut self, change: &Transition) {
        if change.ends_contact() {
            self.patch.release(change.asperity);
        } else {
            self.patch.remove(change.asperity);
        }
    }

    fn finish(&mut self) -> bool {
        let rest = self.patch.radius.clone();
        let found =
            self.patch.solve_with(self.problem, Hold::MeanPenetration, Damping::PATIENT, self.effort).is_ok()
                && self.patch.rates(self.problem).1;
        if !found {
            self.patch.radius = rest;
        }
        found
    }

    fn step(&mut self, time: f64) -> (Vec<f64>, bool) {
        let patch = &mut *self.patch;
        patch.assemble(self.problem, 1.0 / time);
        patch.work.lu.factor(&patch.work.matrix, patch.members.len());
        let mut step = patch.residual.clone();
        patch.work.lu.solve(&mut step);
        (step, patch.work.lu.sign() > 0.0)
    }

    fn tolerance_m(&self) -> f64 {
        self.patch.tolerance_m(self.problem)
    }

    fn advance(&mut self, step: &[f64], share: f64) {
        for (radius, s) in self.patch.radius.iter_mut().zip(step) {
            *radius += share * s;
        }
    }
}
