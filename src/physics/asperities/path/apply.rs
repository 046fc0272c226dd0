//! Application of one transition in a local problem.

use super::avalanche::Avalanche;
use super::equilibrium_path::EquilibriumPath;
use super::events::Located;
use super::propagation::Before;
use super::rejection::Rejection;
use crate::PhysicsError;
use crate::asperities::contact::Status;
use crate::asperities::contact::transition::Transition;
use crate::asperities::solve::local::Hold;
use crate::event_kind::{EventKind, SpotStatus};

impl EquilibriumPath {
    /// Applies a transition in the local problem that is at it, relaxes the local problem, and records both;
    /// nothing if the transition would be undone at once.
    pub(super) fn apply(
        &mut self,
        transition: Transition,
        located: Option<Located>,
        avalanche: &mut Avalanche,
    ) -> Result<(), Rejection> {
        let mut before = self.begin();
        let applied = match located {
            Some(Located::Fold(at)) => {
                let leader = self.neighbourhood.local.members[at].asperity;
                before.potential += self.step_over_fold(at);
                self.relax_or_snap(leader)?
            }
            _ => match self.change_status(transition, &mut before)? {
                Some(applied) => applied,
                None => return Ok(()),
            },
        };
        let energy = before.potential - self.neighbourhood.local.totals(&self.problem()).1;
        self.finish(&before, applied, energy, avalanche);
        Ok(())
    }

    /// Moves the local problem over the fold at which it is; the change of the potential on the way is
    /// returned \[J\].
    fn step_over_fold(&mut self, at: usize) -> f64 {
        let problem = &*self.problem();
        let local = &mut self.neighbourhood.local;
        let sense = if local.radius[at] > self.neighbourhood.origin[at] { 1.0 } else { -1.0 };
        let gap = self.frame.sense * problem.numerics.events.position_tolerance * problem.unit_m;
        let potential = gap * local.potential_slope(problem);
        self.log.work_j += gap * local.totals(problem).0;
        local.step_over_fold(problem, at, sense * problem.numerics.events.fold_step, gap);
        potential
    }

    /// Inserts or removes an asperity and solves the local problem; all transitions on the way are returned,
    /// nothing if none is applied.
    fn change_status(
        &mut self,
        transition: Transition,
        before: &mut Before,
    ) -> Result<Option<Vec<Transition>>, Rejection> {
        let load_n = self.neighbourhood.local.totals(&self.problem()).0;
        let Some(entered) = self.insert_or_remove(transition, before)? else { return Ok(None) };
        let problem = &*self.problem();
        let uncovers = transition.kind == EventKind::Uncover;
        let mean_penetration = self.neighbourhood.local.mean_penetration;
        let mut applied = vec![entered];
        let (local, effort) = (&mut self.neighbourhood.local, &mut self.solver.effort);
        local.follow_spring(problem, load_n);
        let start = local.radius.clone();
        if !(local.solve(problem, Hold::MeanPenetration, effort).is_ok() && local.rates(problem).1) {
            local.radius = start;
            match local.relax(problem, uncovers.then_some(&transition), effort) {
                Ok(further) => applied.extend(further),
                Err(_) if uncovers => {
                    self.keep_covered(transition.asperity, mean_penetration);
                    return Ok(None);
                }
                Err(reason) => return Err(reason.into()),
            }
        }
        if uncovers && self.would_be_undone(&transition, &applied) {
            self.keep_covered(transition.asperity, mean_penetration);
            return Ok(None);
        }
        Ok(Some(applied))
    }

    /// Inserts an asperity into the local problem or removes it, without solving; the transition is returned
    /// as it is recorded, nothing if there is nothing to solve or record.
    fn insert_or_remove(
        &mut self,
        transition: Transition,
        before: &mut Before,
    ) -> Result<Option<Transition>, PhysicsError> {
        let problem = &*self.problem();
        let i = transition.asperity;
        let asperity = &problem.asperities[i];
        match transition.kind {
            EventKind::JumpIn => {
                let local = &mut self.neighbourhood.local;
                if let Some(at) = local.watched.iter().position(|place| place.asperity == i) {
                    let place = local.watched[at];
                    let penetration = local.penetration_of(problem, at, &mut self.solver.effort);
                    local.insert(place, asperity.radius_ahead(penetration));
                }
            }
            EventKind::JumpOff => self.neighbourhood.local.release(i),
            EventKind::Cover => {
                self.neighbourhood.local.remove(i);
            }
            EventKind::Uncover => {
                if let Some((by, release_m)) = problem.covering(&self.predictor.state, i, transition.by) {
                    // Another contact covers it as well: nothing moves.
                    self.predictor.set(i, Status::Covered { by, release_m }, 0.0);
                    return Ok(None);
                }
                self.insert_uncovered(transition);
            }
            EventKind::Merge => return self.merge(transition, before).map(Some),
            EventKind::Split => self.split(i, before),
            EventKind::Snap => {}
        }
        Ok(Some(transition))
    }

    /// Inserts an asperity that was absorbed, in contact or free.
    fn insert_uncovered(&mut self, transition: Transition) {
        let problem = &*self.problem();
        let i = transition.asperity;
        let mean_penetration = self.neighbourhood.local.mean_penetration;
        let contacts: Vec<(usize, f64)> = self.predictor.radii(problem, mean_penetration);
        let displacement = self.solver.displacement(&contacts, i);
        let local = &mut self.neighbourhood.local;
        // The displacement by the outside changes here as it does at the covering contact.
        let drift = transition.by.and_then(|by| local.find(by)).map_or(0.0, |k| local.members[k].drift);
        let place = local.place(problem, i, displacement, drift, &mut self.solver.effort);
        // The displacement by contacts as they are predicted contains what is pending for it.
        self.pending.set_applied(i);
        match problem.asperities[i]
            .radius_at_penetration(mean_penetration + problem.heights[i] - displacement)
        {
            Some(radius) => {
                local.insert(place, radius);
                if problem.merges() {
                    self.part_pairs(i, radius, None);
                }
            }
            None => local.watched.push(place),
        }
    }

    /// True if an uncovering was undone on the way, or would be at once.
    fn would_be_undone(&self, uncovering: &Transition, applied: &[Transition]) -> bool {
        let problem = &*self.problem();
        let local = &self.neighbourhood.local;
        let Some(by) = uncovering.by else { return false };
        let i = uncovering.asperity;
        let radius = |j: usize| local.find(j).map_or(0.0, |k| local.radius[k]);
        let absorbing = problem.absorbing_radius(i, by);
        let (mine, its) = (radius(i), radius(by));
        let covered_again = (its >= absorbing && mine < its) || (mine >= absorbing && its < mine);
        covered_again || applied.iter().any(|transition| transition.undoes(uncovering))
    }

    /// Postpones an uncovering until the covering contact has shrunk further. Where that has left, the
    /// asperity is absorbed by the contact that covers it; without one it is free, and blocked until its
    /// penetration falls below the jump-in.
    pub(super) fn keep_covered(&mut self, i: usize, mean_penetration: f64) {
        let Status::Covered { by, release_m } = self.predictor.state.status[i] else { return };
        let (radius, retried) =
            (&self.predictor.state.radius, self.solver.problem.numerics.events.retried_release);
        match self.predictor.state.carrier(by) {
            Some(carrier) if carrier == by => {
                self.predictor.state.status[i] =
                    Status::Covered { by, release_m: retried * radius[by].min(release_m) };
            }
            Some(carrier) => {
                let release_m = retried * radius[carrier];
                self.predictor.set(i, Status::Covered { by: carrier, release_m }, 0.0);
            }
            None => {
                self.predictor.set(i, Status::Free, 0.0);
                self.predictor.state.barred[i] = true;
                self.predictor.traces[i].forget();
                let totals = self.predictor.totals(mean_penetration);
                self.log.note((Transition::uncover(i, by), SpotStatus::Free), mean_penetration, totals);
                let gained_j = self.free_parts(i).1;
                self.log.charge(-gained_j);
            }
        }
    }
}
