//! Relaxation of a local problem ([`crate::asperities::solve::relaxation`]).

use super::{Hold, LocalProblem};
use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::transition::{ContactView, Transition};
use crate::asperities::solve::newton::Damping;
use crate::asperities::solve::relaxation::{Relaxing, relax};
use crate::asperities::solve::residual::NotConverged;
use crate::cycle::Effort;
use crate::math::bracket::{End, Illinois};

/// Maximum number of trials for the equilibrium of the spring.
const SPRING_TRIALS: usize = 60;

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

    /// Moves all members along their branches by one change of penetration `s` \[m\], after a change of state
    /// has changed their load from `load_n`: `s + c(F(s) − load_n) = 0`.
    ///
    /// A soft spring moves all contacts at once where its load is not that of the contact. The
    /// relaxation of the contacts begins from there.
    pub(crate) fn follow_spring(&mut self, problem: &Problem, load_n: f64) {
        if !problem.spring.moves_as_one {
            return;
        }
        let members: Vec<_> = self
            .members
            .iter()
            .zip(&self.radius)
            .map(|(member, a)| {
                let asperity = &problem.asperities[member.asperity];
                (asperity, asperity.penetration(*a))
            })
            .collect();
        let excess = |s: f64| {
            let load: f64 =
                members.iter().map(|(asperity, d)| asperity.load(asperity.radius_ahead(d + s))).sum();
            s + problem.field.uniform() * (load - load_n)
        };
        let first = excess(0.0);
        let (mut near, mut far) = (0.0, -first);
        if first.abs() <= self.tolerance_m(problem) || excess(far) * first > 0.0 {
            return;
        }
        let mut ends = Illinois::new(first, excess(far));
        for _ in 0..SPRING_TRIALS {
            let middle = near + ends.share(0.01) * (far - near);
            let now = excess(middle);
            if now * first > 0.0 {
                near = middle;
                ends.narrow(End::Low, now);
            } else {
                far = middle;
                ends.narrow(End::High, now);
            }
            if now.abs() <= 1e-6 * first.abs() {
                break;
            }
        }
        for (radius, (asperity, d)) in self.radius.iter_mut().zip(&members) {
            *radius = asperity.radius_ahead(d + far);
        }
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
        let load_n = self.patch.totals(self.problem).0;
        if change.ends_contact() {
            self.patch.release(change.asperity);
        } else {
            self.patch.remove(change.asperity);
        }
        self.patch.follow_spring(self.problem, load_n);
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
