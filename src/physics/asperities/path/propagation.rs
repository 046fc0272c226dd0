//! Effects of a change of a local problem: status of its members, energy of the event, and propagation to the
//! rest of the contact.
//!
//! A local problem changes the field around it. Free asperities of its shell take the change at once.
//! Contacts have it as a pending displacement until they are members of a local problem, or until the global
//! solve; a sequence of local solves continues while a pending displacement exceeds the limit. The load with
//! which they will respond is counted before, to first order: by reciprocity it is the effect of the rest of
//! the contact on the loads of the members.

use super::avalanche::Avalanche;
use super::equilibrium_path::EquilibriumPath;
use super::rejection::Rejection;
use super::work::{mean_square, work, work_along, work_of_all, work_of_all_along};
use crate::asperities::contact::Status;
use crate::asperities::contact::transition::Transition;
use crate::asperities::solve::local::outside::ReferenceState;
use crate::asperities::solve::local::{CurveState, Hold, OutsideField};
use crate::asperities::solve::trace::PenetrationTrace;
use crate::cycle::Totals;
use crate::event_kind::EventKind;

/// A local problem before it changes.
pub(super) struct Before {
    pub(super) totals: Totals,
    /// Part of the potential that changes with the members \[J\].
    pub(super) potential: f64,
    /// Members.
    pub(super) members: Vec<ReferenceState>,
    /// Load of the members, and `Σ F_i ∂ŵ_i/∂Δ` by the outside \[N\].
    pub(super) load: f64,
    pub(super) reciprocal_load: f64,
}

/// A member before its pending displacement is applied.
struct Pending {
    asperity: usize,
    radius: f64,
    load: f64,
    displacement: f64,
}

impl EquilibriumPath {
    /// True if members have pending displacements that matter.
    pub(super) fn has_pending(&self) -> bool {
        let limit = self.numerics().events.negligible_pending * self.pending_limit();
        self.neighbourhood.to_apply.iter().any(|displacement| displacement.abs() > limit)
    }

    /// Contact with the largest pending displacement above the limit.
    pub(super) fn worst_pending(&mut self) -> Option<usize> {
        let limit = self.pending_limit();
        self.pending.worst(&self.predictor.state.status, limit)
    }

    /// Applies the pending displacements of the members of the neighbourhood of a transition, and solves it.
    /// Contacts that leave or are absorbed by that are transitions of the avalanche.
    pub(super) fn apply_pending(
        &mut self,
        transition: &Transition,
        avalanche: &mut Avalanche,
    ) -> Result<(), Rejection> {
        let (before, start, solved) = self.solve_pending();
        let applied = if solved {
            Vec::new()
        } else {
            self.neighbourhood
                .local
                .radius
                .iter_mut()
                .zip(&start)
                .for_each(|(radius, from)| *radius = from.radius);
            self.relax_or_snap(transition.asperity)?
        };
        let energy = self.settle_pending(&before, start);
        if applied.is_empty() {
            self.log.charge(energy);
        }
        self.finish(&before, applied, energy, avalanche);
        Ok(())
    }

    /// Solves the local problem with the pending displacements applied; false if it has no stable equilibrium
    /// nearby.
    fn solve_pending(&mut self) -> (Before, Vec<Pending>, bool) {
        let problem = &*self.problem();
        self.advance_members(&[], None);
        let before = self.begin();
        let near = &mut self.neighbourhood;
        for (member, displacement) in near.local.members.iter_mut().zip(&near.to_apply) {
            member.outside += displacement;
        }
        let members = near.local.members.iter().zip(&near.local.radius).zip(&near.to_apply);
        let start = members
            .map(|((member, radius), displacement)| Pending {
                asperity: member.asperity,
                radius: *radius,
                load: problem.asperities[member.asperity].load(*radius),
                displacement: *displacement,
            })
            .collect();
        let solved = near.local.solve(problem, Hold::MeanPenetration, &mut self.solver.effort).is_ok()
            && near.local.rates(problem).1;
        (before, start, solved)
    }

    /// Relaxes the local problem: without a change of status the transition is a snap of `leader`.
    pub(super) fn relax_or_snap(&mut self, leader: usize) -> Result<Vec<Transition>, Rejection> {
        let mut applied =
            self.neighbourhood.local.relax(&self.solver.problem, None, &mut self.solver.effort)?;
        if applied.is_empty() {
            applied.push(Transition::snap(leader));
        }
        Ok(applied)
    }

    /// Marks the pending displacements as applied; the energy that the local problem has lost beyond their
    /// work is returned \[J\].
    ///
    /// The event that caused them was charged as if the loads here had not changed, so the work of these
    /// loads is not part of the energy.
    fn settle_pending(&mut self, before: &Before, start: Vec<Pending>) -> f64 {
        let mut energy = before.potential - self.neighbourhood.local.totals(&self.problem()).1;
        let mut expected = 0.0;
        for member in start {
            self.pending.set_applied(member.asperity);
            energy -= member.displacement * member.load;
            expected += self.predictor.load_rate(&self.problem(), member.asperity) * member.displacement;
        }
        self.expect_load(self.neighbourhood.local.mean_penetration, expected);
        energy
    }

    /// Records the local problem before it changes.
    pub(super) fn begin(&mut self) -> Before {
        let problem = &*self.problem();
        let local = &self.neighbourhood.local;
        let totals = self.predictor.totals(local.mean_penetration);
        self.log.pass(local.mean_penetration, totals.load_n);
        let (load, potential) = local.totals(problem);
        Before {
            totals,
            potential,
            load,
            members: local.reference_states(),
            reciprocal_load: local.reciprocal_load_rate(problem),
        }
    }

    /// Updates the predictor after the local problem has changed, and records the transitions with the energy
    /// that it has lost \[J\].
    pub(super) fn finish(
        &mut self,
        before: &Before,
        applied: Vec<Transition>,
        energy: f64,
        avalanche: &mut Avalanche,
    ) {
        let problem = &*self.problem();
        let near = &self.neighbourhood;
        let mean_penetration = near.local.mean_penetration;
        let changes = near.local.displacement_changes(problem, &near.shell, &near.centre, &before.members);
        let load = near.local.totals(problem).0 - before.load;
        let response = before.reciprocal_load - near.local.reciprocal_load_rate(problem);
        self.propagate(&changes, load, response, avalanche);
        let gained_j: f64 = applied.iter().map(|transition| self.enter(transition, avalanche)).sum();
        let (rates, _) = self.neighbourhood.local.rates(problem);
        let local = &self.neighbourhood.local;
        let trace = |((member, a), rate): ((&OutsideField, &f64), &f64)| {
            let i = member.asperity;
            (i, *a, PenetrationTrace::of(&problem.asperities[i], mean_penetration, *a, *rate))
        };
        let traces: Vec<_> = local.members.iter().zip(&local.radius).zip(&rates).map(trace).collect();
        avalanche.open.extend(traces.iter().map(|trace| trace.0));
        self.predictor.replace_all(problem, &traces);
        self.finish_free(&rates, avalanche);
        let after = self.predictor.totals(mean_penetration);
        self.log.restart(mean_penetration, after.load_n);
        self.record(&applied, mean_penetration, before.totals, after, energy - gained_j);
        avalanche.moved.extend(applied);
    }

    /// Updates the free asperities of the local problem.
    fn finish_free(&mut self, rates: &[f64], avalanche: &mut Avalanche) {
        let problem = &*self.problem();
        let traces = self.neighbourhood.local.watch(problem, rates, &mut self.solver.effort);
        for (place, trace) in self.neighbourhood.local.watched.iter().zip(traces) {
            let i = place.asperity;
            self.predictor.traces[i] = trace;
            self.predictor.state.barred[i] &= trace.has_reached(problem.jump_in[i]);
            avalanche.open.push(i);
        }
    }

    /// Enters the status after a transition into the predictor; the energy that it gives to other contacts is
    /// returned \[J\].
    fn enter(&mut self, transition: &Transition, avalanche: &mut Avalanche) -> f64 {
        let problem = &*self.problem();
        let i = transition.asperity;
        avalanche.open.push(i);
        let parts = i.checked_sub(problem.summits()).map(|k| self.predictor.state.merged[k].parts);
        match (transition.kind, parts) {
            (EventKind::Snap, _) => {}
            (EventKind::Merge, Some(parts)) => {
                for part in parts {
                    self.enter_status(part, Status::Merged { into: i });
                }
                self.enter_status(i, Status::Contact);
            }
            (EventKind::Split, Some(parts)) => {
                self.enter_status(i, Status::Free);
                for part in parts {
                    self.enter_status(part, Status::Contact);
                }
                avalanche.open.extend(parts);
            }
            (EventKind::JumpIn | EventKind::Uncover, _) if self.neighbourhood.local.find(i).is_some() => {
                self.enter_status(i, Status::Contact);
            }
            // A merged contact that leaves, or is free when it is released.
            (EventKind::JumpOff | EventKind::Uncover, Some(_)) => {
                self.enter_status(i, Status::Free);
                let (parts, gained_j) = self.free_parts(i);
                avalanche.open.extend(parts);
                return gained_j;
            }
            (
                EventKind::JumpIn
                | EventKind::JumpOff
                | EventKind::Cover
                | EventKind::Uncover
                | EventKind::Merge
                | EventKind::Split,
                _,
            ) => {
                self.enter_status(i, transition.status(problem));
            }
        }
        0.0
    }

    /// Enters a status into the predictor.
    fn enter_status(&mut self, i: usize, now: Status) {
        if self.predictor.state.status[i] == Status::Contact
            && now != Status::Contact
            && self.predictor.traces[i].is_known()
        {
            let mean_penetration = self.neighbourhood.local.mean_penetration;
            self.predictor.count(&self.solver.problem, i, -1.0, mean_penetration);
        }
        self.pending.set_applied(i);
        self.predictor.traces[i].forget();
        self.predictor.set(i, now, 0.0);
    }

    /// Changes the field around the local problem by
    /// `changes` at the shell \[m\], since its load has changed by `load`. The load of the contact will
    /// change by `response` \[N\] when the pending displacements are applied.
    fn propagate(&mut self, changes: &[f64], load: f64, response: f64, avalanche: &mut Avalanche) {
        let (limit, scale) = (self.pending_limit(), self.frame.scale);
        let problem = &*self.problem();
        let near = &self.neighbourhood;
        for (&j, &change) in near.shell.iter().zip(changes) {
            if self.predictor.state.status[j] == Status::Contact {
                self.pending.add_near(j, change, limit);
            } else {
                self.predictor.displace(problem, j, change);
                // Farther from its jump-in nothing is due, nor is it in this increment.
                if self.predictor.traces[j].exceeds(problem.jump_in[j] - scale) {
                    avalanche.open.push(j);
                }
            }
        }
        if !near.shell.is_empty() {
            let far =
                |targets: &[usize]| problem.field.far_from_load(load, &near.centre, near.reach, targets);
            for (&i, change) in self.predictor.state.contacts.iter().zip(far(&self.predictor.state.contacts))
            {
                self.pending.add_far(i, change);
            }
            let candidates = std::mem::take(&mut self.predictor.candidates);
            for (&i, change) in candidates.iter().zip(far(&candidates)) {
                self.predictor.displace(problem, i, change);
            }
            self.predictor.candidates = candidates;
        }
        self.expect_load(self.neighbourhood.local.mean_penetration, response);
    }

    /// Propagates the difference between the solution curve of a local problem and its linear prediction,
    /// which the rest of the contact does not have.
    pub(super) fn propagate_curve(&mut self, curve: &[CurveState], avalanche: &mut Avalanche) {
        let near = &self.neighbourhood;
        if near.shell.is_empty() {
            return;
        }
        let problem = &*self.problem();
        let way = near.local.mean_penetration - near.reference;
        let reference = |(member, a): (&OutsideField, &f64)| {
            let i = member.asperity;
            ReferenceState { asperity: i, radius: *a, more: self.predictor.radius_rate(problem, i) * way }
        };
        let members: Vec<ReferenceState> =
            near.local.members.iter().zip(&near.origin).map(reference).collect();
        let changes = near.local.displacement_changes(problem, &near.shell, &near.centre, &members);
        let (load, reciprocal_load) = near.local.unexpected_load(problem, &members);
        let before = self.energy.expected_n();
        self.propagate(&changes, load, -reciprocal_load, avalanche);
        // It has grown on the way, slowly at first.
        let grown = self.energy.expected_n() - before;
        self.log.work_j += grown * mean_square(curve, way);
    }

    /// Counts the work of the load that contacts will have when pending displacements are applied; from here
    /// on it is larger by `more` \[N\].
    pub(super) fn expect_load(&mut self, mean_penetration: f64, more: f64) {
        self.log.work_j += self.energy.expect_load(mean_penetration, more);
        self.predictor.add_load(more);
    }

    /// Advances the predictors of the members to the mean penetration of the local problem, and counts the
    /// work: along a solution curve if there is one. Without new `rates` they keep theirs.
    pub(super) fn advance_members(&mut self, curve: &[CurveState], rates: Option<&[f64]>) {
        let problem = &*self.problem();
        let local = &self.neighbourhood.local;
        let mut traces = Vec::with_capacity(local.members.len());
        let mut together = Vec::new();
        for (k, (member, a)) in local.members.iter().zip(&local.radius).enumerate() {
            let i = member.asperity;
            let (asperity, from) = (&problem.asperities[i], self.predictor.traces[i]);
            let trace = match rates {
                Some(rates) => PenetrationTrace::of(asperity, local.mean_penetration, *a, rates[k]),
                None => PenetrationTrace::new(local.mean_penetration, asperity.penetration(*a), from.rate),
            };
            let along_curve = from.at == self.neighbourhood.reference && curve.len() > 1;
            if problem.spring.moves_as_one {
                together.push((i, from, trace));
            } else {
                self.log.work_j += if along_curve {
                    work_along(problem, i, k, curve)
                } else {
                    work(problem, i, from, trace)
                };
            }
            traces.push((i, *a, trace));
        }
        self.log.work_j += self.work_together(&together, curve);
        self.predictor.replace_all(problem, &traces);
    }

    /// Work of all contacts, which a soft spring moves together \[J\]: along a solution curve if there is
    /// one.
    fn work_together(
        &self,
        together: &[(usize, PenetrationTrace, PenetrationTrace)],
        curve: &[CurveState],
    ) -> f64 {
        let reference = self.neighbourhood.reference;
        let is_along = curve.len() > 1 && together.iter().all(|(_, from, _)| from.at == reference);
        if is_along {
            let members: Vec<usize> = together.iter().map(|(i, ..)| *i).collect();
            work_of_all_along(&self.problem(), &members, curve)
        } else {
            work_of_all(&self.problem(), together)
        }
    }

    /// Records the transitions of one relaxation; its energy is that of the first.
    pub(super) fn record(
        &mut self,
        applied: &[Transition],
        mean_penetration: f64,
        before: Totals,
        after: Totals,
        energy: f64,
    ) {
        let mut moved = Vec::with_capacity(applied.len());
        for transition in applied {
            if !matches!(transition.kind, EventKind::JumpOff | EventKind::Merge) {
                self.chatter.count(transition.asperity);
            }
            moved.push((*transition, transition.status_after(self.state())));
        }
        self.log.record(&moved, mean_penetration, [before, after], energy);
    }
}
