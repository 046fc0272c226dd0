//! Newton's method on all contacts, with nonlinear elimination.
//!
//! If a full step does not reduce the largest residual, the reason is one contact: it is at the edge of
//! another one, or near the end of its branch. The contacts around it are then solved alone, with the
//! displacement by all others held, and the method continues from there (Lanzkron, Rose & Wilkes, SIAM J.
//! Sci. Comput. 17:538, 1996). Shorter steps of all contacts cost more, and do not converge if there is no
//! equilibrium.

use super::global::GlobalSolver;
use super::local::{Extent, Hold, LocalProblem};
use super::newton::{Damping, NonlinearSystem, Worst, damped_newton};
use super::residual::NotConverged;
use super::trace::PenetrationTrace;
use crate::asperities::contact::state::{State, Status};
use crate::asperities::contact::transition::Transition;
use std::sync::Arc;

/// Action if the contacts around one have no equilibrium nearby.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Failing {
    /// The solution ends at once: the increment is to be shortened.
    EndsAtOnce,
    /// The solution ends, after short steps.
    Ends,
    /// They relax, and the solution continues.
    Relaxes,
}

impl Failing {
    fn damping(self) -> Damping {
        if self == Self::EndsAtOnce { Damping::NORMAL } else { Damping::PATIENT }
    }
}

/// Relaxations of groups of contacts in a solution.
#[derive(Debug, Default)]
pub(crate) struct Relaxed {
    /// Contact around which the first of them was, if there are any.
    pub(crate) leader: Option<usize>,
    /// Transitions on the way.
    pub(crate) transitions: Vec<Transition>,
}

impl GlobalSolver {
    /// Newton's method at the mean penetration of a state that was evaluated last.
    pub(crate) fn newton(
        &mut self,
        state: &mut State,
        first: NotConverged,
        failing: Failing,
        tolerance: f64,
    ) -> Result<Relaxed, NotConverged> {
        let exact = tolerance <= self.problem.tolerance_m();
        let relaxed = Relaxed::default();
        let mut descent = Descent {
            solver: self,
            state,
            exact,
            tolerance,
            failing,
            relaxed,
            step: Vec::new(),
            start: Vec::new(),
        };
        damped_newton(&mut descent, first.into(), failing.damping(), tolerance)?;
        Ok(descent.relaxed)
    }
}

/// Newton's method on all contacts of a state.
struct Descent<'a> {
    solver: &'a mut GlobalSolver,
    state: &'a mut State,
    exact: bool,
    tolerance: f64,
    failing: Failing,
    relaxed: Relaxed,
    step: Vec<f64>,
    /// Radii from which the step began \[m\].
    start: Vec<f64>,
}

impl NonlinearSystem for Descent<'_> {
    fn evaluate(&mut self) -> Worst {
        self.solver.effort.iterations += 1;
        self.solver.evaluate(self.state).into()
    }

    fn begin_step(&mut self, round: usize, worst: &Worst) {
        let limits = self.solver.problem.numerics.solver;
        // The first step reduces the residual to its square at best; the next ones are to be the last.
        let wanted = match (self.exact, round) {
            (true, 0) => limits.linear_residual,
            (true, _) => (0.1 * self.tolerance / worst.largest_m)
                .clamp(limits.linear_residual_min, limits.linear_residual),
            (false, _) => (0.3 * self.tolerance / worst.largest_m)
                .clamp(limits.linear_residual, limits.linear_residual_intermediate),
        };
        self.step = self.solver.newton_step(self.state, wanted);
        limit(&mut self.step, self.state, limits.radius_change);
        self.start = self.state.contacts.iter().map(|&i| self.state.radius[i]).collect();
    }

    fn advance(&mut self, share: f64) {
        for ((&i, s), from) in self.state.contacts.iter().zip(&self.step).zip(&self.start) {
            self.state.radius[i] = from + share * s;
        }
    }

    fn repair(&mut self, worst: &Worst) -> Option<Result<Worst, NotConverged>> {
        let mut local = self.around(worst.contact.asperity);
        let problem = &*Arc::clone(&self.solver.problem);
        let (start, effort) = (local.radius.clone(), &mut self.solver.effort);
        let solved = local.solve_with(problem, Hold::MeanPenetration, Damping::PATIENT, effort).is_ok()
            && local.rates(problem).1;
        if !solved {
            match self.failing {
                Failing::EndsAtOnce => return Some(Err(worst.contact)),
                Failing::Ends => return None,
                Failing::Relaxes => {}
            }
            local.radius = start;
            let Ok(transitions) = local.relax(problem, None, effort) else { return None };
            for change in &transitions {
                self.state.set(change.asperity, change.status(problem), 0.0);
            }
            self.relaxed.leader.get_or_insert(worst.contact.asperity);
            self.relaxed.transitions.extend(transitions);
        }
        for (member, a) in local.members.iter().zip(&local.radius) {
            self.state.radius[member.asperity] = *a;
        }
        Some(Ok(self.evaluate()))
    }
}

impl Descent<'_> {
    /// The contacts nearest to one, with the radii from which the step began and the present displacement by
    /// the others.
    fn around(&mut self, centre: usize) -> LocalProblem {
        let problem = &*Arc::clone(&self.solver.problem);
        let (state, mean_penetration) = (&*self.state, self.state.mean_penetration_m);
        let (all, count) = (state.contacts.len(), problem.numerics.events.local_contacts);
        let near = problem
            .neighbours
            .nearest(problem.place(centre), count, all, |i| state.status[i] == Status::Contact);
        let mut members: Vec<usize> = near.iter().map(|(_, i)| *i).collect();
        members.sort_unstable();
        let resting = |&i: &usize| {
            (
                i,
                PenetrationTrace::of(&problem.asperities[i], mean_penetration, state.radius[i], 0.0),
                state.radius[i],
            )
        };
        let contacts: Vec<_> = members.iter().map(resting).collect();
        let mut local = LocalProblem::default();
        local.gather(
            problem,
            &contacts,
            &[],
            mean_penetration,
            Extent::of(members.len(), all),
            &mut self.solver.effort,
        );
        for (k, i) in members.iter().enumerate() {
            let Ok(at) = state.contacts.binary_search(i) else { continue };
            local.members[k].outside -= self.solver.residual[at];
            local.radius[k] = self.start[at];
        }
        local
    }
}

/// Shortens a step to a largest relative change of a radius.
fn limit(step: &mut [f64], state: &State, most: f64) {
    let stride =
        state.contacts.iter().zip(&*step).map(|(&i, s)| s.abs() / state.radius[i]).fold(0.0, f64::max);
    if stride > most {
        step.iter_mut().for_each(|s| *s *= most / stride);
    }
}
