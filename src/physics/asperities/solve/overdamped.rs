//! Relaxation of all contacts ([`super::relaxation`]).

use super::descent::Failing;
use super::global::GlobalSolver;
use super::relaxation::{Relaxing, relax};
use super::residual::NotConverged;
use crate::asperities::contact::state::State;
use crate::asperities::contact::transition::{ContactView, Transition};
use std::sync::Arc;

impl GlobalSolver {
    /// Relaxes from a state; the transitions on the way are returned.
    pub(crate) fn relax(&mut self, state: &mut State) -> Result<Vec<Transition>, NotConverged> {
        let problem = &*Arc::clone(&self.problem);
        relax(&mut Whole { solver: self, state }, problem, None)
    }
}

/// Global problem during a relaxation.
struct Whole<'a> {
    solver: &'a mut GlobalSolver,
    state: &'a mut State,
}

impl Relaxing for Whole<'_> {
    fn evaluate(&mut self) -> NotConverged {
        self.solver.effort.iterations += 1;
        self.solver.evaluate(self.state)
    }

    fn spots(&self) -> Vec<ContactView> {
        self.state
            .contacts
            .iter()
            .zip(&self.solver.residual)
            .map(|(&i, r)| (i, self.state.radius[i], *r))
            .collect()
    }

    fn take_out(&mut self, change: &Transition) {
        self.state.set(change.asperity, change.status(&self.solver.problem), 0.0);
    }

    fn finish(&mut self) -> bool {
        let mut end = self.state.clone();
        let first = self.solver.evaluate(&mut end);
        let found =
            self.solver.newton(&mut end, first, Failing::Ends, self.solver.problem.tolerance_m()).is_ok();
        if found {
            *self.state = end;
        }
        found
    }

    fn step(&mut self, time: f64) -> (Vec<f64>, bool) {
        (self.solver.relaxation_step(time), true)
    }

    fn tolerance_m(&self) -> f64 {
        self.solver.problem.tolerance_m()
    }

    fn advance(&mut self, step: &[f64], share: f64) {
        for (&i, s) in self.state.contacts.iter().zip(step) {
            self.state.radius[i] += share * s;
        }
    }
}
