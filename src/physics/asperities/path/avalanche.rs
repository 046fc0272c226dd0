//! Avalanches: all transitions at one mean penetration that follow from an event.
//!
//! One transition is applied at a time, the most overdue first, and the local problem relaxes before the next
//! is chosen. Contacts merge and split only when nothing else is due. An asperity that has left contact does
//! not return within the avalanche. Contacts with a large pending displacement are solved in local problems
//! of their own, the largest first. After a large avalanche the global problem is solved.

use super::equilibrium_path::EquilibriumPath;
use super::rejection::Rejection;
use super::triggers::Trigger;
use crate::asperities::contact::transition::Transition;
use crate::asperities::contact::{State, Status};
use std::sync::Arc;

/// Transitions of an avalanche, and the asperities that it has touched.
#[derive(Debug, Default)]
pub(super) struct Avalanche {
    /// Transitions applied so far.
    pub(super) moved: Vec<Transition>,
    /// Asperities whose state has changed.
    pub(super) open: Vec<usize>,
}

impl EquilibriumPath {
    /// Applies a transition that is due at the present mean penetration, with its avalanche.
    pub(super) fn start_avalanche(&mut self, first: Transition) -> Result<(), Rejection> {
        self.log.begin_avalanche();
        self.gather(&first, Some(self.state().mean_penetration_m));
        self.advance_members(&[], None);
        let mut avalanche = Avalanche::default();
        self.apply(first, None, &mut avalanche)?;
        self.run_avalanche(avalanche).map(|_| ())
    }

    /// Applies what is due among the open asperities until nothing is, and no pending displacement exceeds
    /// the limit; the touched asperities are returned. A transition that would undo an earlier one waits for
    /// the path to continue. Nothing is returned if the propagation does not end or the avalanche is large:
    /// the global problem is to be solved.
    pub(super) fn run_avalanche(
        &mut self,
        mut avalanche: Avalanche,
    ) -> Result<Option<Vec<usize>>, Rejection> {
        let mean_penetration = self.neighbourhood.local.mean_penetration;
        let mut solves = 0;
        let mut propagated = true;
        loop {
            // Most of them are in order: a stable sort makes use of it.
            avalanche.open.sort();
            avalanche.open.dedup();
            let due = self.due_transitions(&avalanche.open, &avalanche.open);
            // Contacts merge and split in equilibrium: where others have yet to respond, they have grown too
            // far.
            let mut coalescing = Vec::new();
            let due_now = most_overdue(&due, &avalanche.moved, self.state());
            let next = due_now.or_else(|| self.worst_pending().map(Transition::snap)).or_else(|| {
                coalescing = self.due_coalescence(&avalanche.open);
                most_overdue(&coalescing, &avalanche.moved, self.state())
            });
            let Some(transition) = next else {
                self.postponed
                    .extend(due.iter().chain(&coalescing).map(|trigger| trigger.transition.asperity));
                break;
            };
            self.count_trial(mean_penetration, transition.asperity)?;
            self.gather(&transition, Some(mean_penetration));
            if transition.keeps_contacts() || self.has_pending() {
                solves += 1;
                let few = self.numerics().events.avalanche_solves;
                propagated = solves <= few.max(self.state().contacts.len() / few);
                if !propagated {
                    break;
                }
                self.apply_pending(&transition, &mut avalanche)?;
            } else {
                self.advance_members(&[], None);
                self.apply(transition, None, &mut avalanche)?;
            }
        }
        self.close_avalanche(&avalanche.moved);
        propagated &= avalanche.moved.len() < self.numerics().events.large_avalanche
            && !self.problem().spring.moves_as_one;
        Ok(propagated.then_some(avalanche.open))
    }

    /// At the end of an avalanche: sets the radii of release of absorbed asperities, blocks asperities that
    /// have left contact, and removes merged contacts that no longer exist.
    fn close_avalanche(&mut self, moved: &[Transition]) {
        let (status, summits) = (&self.predictor.state.status, self.solver.problem.summits());
        for i in moved
            .iter()
            .map(|transition| transition.asperity)
            .filter(|i| *i >= summits && status[*i] == Status::Free)
        {
            Arc::make_mut(&mut self.solver.problem).neighbours.remove(i);
        }
        let problem = &*self.problem();
        for transition in moved {
            let i = transition.asperity;
            if transition.merges() {
                self.predictor.keep_merged(problem, i);
            }
            match self.predictor.state.status[i] {
                Status::Covered { by, release_m } => {
                    let edge = (1.0 - problem.numerics.events.radius_resolution) * release_m;
                    if self.predictor.state.radius[by] < edge {
                        // The covering contact has shrunk by absorbing it, or has left since.
                        self.keep_covered(i, self.neighbourhood.local.mean_penetration);
                    } else {
                        // It is at the edge, and rounding must not decide whether it has shrunk.
                        self.predictor.state.status[i] = Status::Covered { by, release_m: edge };
                    }
                }
                Status::Contact | Status::Merged { .. } => {}
                Status::Free => {
                    self.predictor.state.barred[i] |=
                        self.predictor.traces[i].has_reached(problem.jump_in[i]);
                }
            }
        }
    }

    /// Merging and splitting that are due, but for those of asperities that change to and fro.
    pub(super) fn due_coalescence(&mut self, touched: &[usize]) -> Vec<Trigger> {
        let mut due = self.problem().coalescing(&self.predictor, touched);
        let most = self.numerics().events.changes_per_asperity;
        due.retain(|trigger| self.chatter.admit(&trigger.transition, most));
        due
    }

    /// Other transitions that are due, but for those of asperities that change to and fro: such an asperity
    /// is frozen for a while, and counted. Two contacts that each grow with the other and shrink without it
    /// have no stable state otherwise; nor have three of which each absorbs the next.
    pub(super) fn due_transitions(&mut self, touched: &[usize], free: &[usize]) -> Vec<Trigger> {
        let mut due = self.problem().triggers(&self.predictor, touched, free);
        let most = self.numerics().events.changes_per_asperity;
        let state = &self.predictor.state;
        let chatter = &mut self.chatter;
        let (mut carried, mut postponed) = (Vec::new(), Vec::new());
        due.retain(|trigger| {
            let i = trigger.transition.asperity;
            let mut allowed = chatter.allows(&trigger.transition, most);
            if let Status::Covered { by, .. } = state.status[i]
                && state.radius[by] == 0.0
                && !allowed
            {
                // Its covering contact has left: it is uncovered, or absorbed by the contact that covers that
                // one.
                allowed = state.carrier(by).is_none();
                if !allowed {
                    carried.push(i);
                }
            }
            if !allowed {
                chatter.freeze(i);
                postponed.push(i);
            }
            allowed
        });
        self.postponed.extend(postponed);
        for i in carried {
            self.keep_covered(i, self.neighbourhood.local.mean_penetration);
        }
        due
    }
}

/// The most overdue transition that does not undo one of an avalanche.
fn most_overdue(due: &[Trigger], moved: &[Transition], state: &State) -> Option<Transition> {
    due.iter()
        .filter(|trigger| !trigger.transition.returns(moved, state))
        .max_by(|u, v| {
            u.overshoot.total_cmp(&v.overshoot).then(v.transition.asperity.cmp(&u.transition.asperity))
        })
        .map(|trigger| trigger.transition)
}
