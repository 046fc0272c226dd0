//! Merging and splitting in a local problem.

use super::equilibrium_path::EquilibriumPath;
use crate::physics::PhysicsError;
use crate::physics::contact::Status;
use crate::physics::contact::merged_spot::pair_of;
use crate::physics::contact::transition::{Kind, Transition};
use std::sync::Arc;

impl EquilibriumPath {
    /// Replaces two contacts of the local problem by one of the same area and load, which is in equilibrium there; the transition names it.
    pub(super) fn merge(&mut self, transition: Transition) -> Result<Transition, PhysicsError> {
        let problem = self.problem();
        let pair = [transition.by.unwrap_or(transition.asperity), transition.asperity];
        let approach = self.neighbourhood.local.approach;
        let at = pair.map(|i| self.neighbourhood.local.find(i));
        let [Some(first), Some(second)] = at else { return Ok(Transition { kind: Kind::Snap, ..transition }) };
        let local = &self.neighbourhood.local;
        let radii = [local.radius[first], local.radius[second]];
        let share = radii.map(|a| a * a / (radii[0] * radii[0] + radii[1] * radii[1]));
        let drift = share[0] * local.members[first].drift + share[1] * local.members[second].drift;
        let contacts: Vec<(usize, f64)> = self.contacts_without(&pair, approach);
        let mut merged = problem.merged(pair, radii, approach);
        let number = problem.len();
        drop(problem);
        let grown = Arc::make_mut(&mut self.solver.problem);
        grown.add(&merged)?;
        let by_others = self.solver.displacement(&contacts, number);
        // The images of the merged contact displace it as well.
        let displacement = by_others + self.solver.displacement(&[(number, merged.contact_radius_m())], number);
        let grown = Arc::make_mut(&mut self.solver.problem);
        merged.height_m = grown.asperities[number].penetration(merged.contact_radius_m()) + displacement - approach;
        grown.heights[number] = merged.height_m;
        let problem = &*self.problem();
        let (local, effort) = (&mut self.neighbourhood.local, &mut self.solver.effort);
        for part in pair {
            local.remove(part, false);
        }
        local.evaluate(problem, effort);
        let place = local.place(problem, number, (by_others, drift), effort);
        local.insert(place, merged.contact_radius_m());
        self.predictor.extend(merged);
        self.pending.grow(problem.len());
        self.pending.set_applied(number);
        self.chatter.join(pair);
        Ok(Transition { kind: Kind::Merge, asperity: number, by: None })
    }

    /// Replaces a merged contact of the local problem by its parts, with its present area.
    pub(super) fn split(&mut self, number: usize) {
        let problem = &*self.problem();
        let approach = self.neighbourhood.local.approach;
        let Some(at) = self.neighbourhood.local.find(number) else { return };
        let merged = self.predictor.state.merged[number - problem.summits()];
        let share = self.neighbourhood.local.radius[at] / merged.contact_radius_m();
        let drift = self.neighbourhood.local.members[at].drift;
        let contacts: Vec<(usize, f64)> = self.contacts_without(&[number], approach);
        let displacements = merged.parts.map(|part| self.solver.displacement(&contacts, part));
        let (local, effort) = (&mut self.neighbourhood.local, &mut self.solver.effort);
        local.remove(number, false);
        local.evaluate(problem, effort);
        let [first, second] = [0, 1].map(|k| local.place(problem, merged.parts[k], (displacements[k], drift), effort));
        local.insert(first, share * merged.radii_m[0]);
        local.insert(second, share * merged.radii_m[1]);
        merged.parts.iter().for_each(|part| self.pending.set_applied(*part));
        let parts = [0, 1].map(|k| (merged.parts[k], share * merged.radii_m[k]));
        parts.into_iter().for_each(|(part, a)| self.part_pairs(part, a, Some(number)));
        let [i, j] = merged.parts;
        self.predictor.parted.insert(pair_of(i, j));
    }

    /// Contacts and their predicted radii at a mean penetration \[m\], without some.
    fn contacts_without(&self, some: &[usize], approach: f64) -> Vec<(usize, f64)> {
        let all = self.predictor.radii(&self.problem(), approach);
        all.into_iter().filter(|(i, _)| !some.contains(i)).collect()
    }

    /// Frees the parts of a merged contact that has left contact, and blocks them from re-entry; they are returned.
    pub(super) fn free_parts(&mut self, number: usize) -> Vec<usize> {
        let summits = self.problem().summits();
        let (mut freed, mut left) = (Vec::new(), vec![number]);
        while let Some(into) = left.pop() {
            let Some(merged) = into.checked_sub(summits).map(|k| self.predictor.state.merged[k]) else { continue };
            for part in merged.parts {
                if self.predictor.state.status[part] == (Status::Merged { into }) {
                    self.predictor.set(part, Status::Free, 0.0);
                    self.predictor.state.barred[part] = part < summits;
                    freed.push(part);
                    left.push(part);
                }
            }
        }
        freed
    }

    /// Pairs of a contact of radius `a` \[m\], which has just come into being, with those that it overlaps but for one that it replaces: they
    /// do not merge before they have been apart.
    pub(super) fn part_pairs(&mut self, part: usize, a: f64, replaced: Option<usize>) {
        let problem = &*self.problem();
        let mut parted = Vec::new();
        self.predictor.near(problem, part, a, |i, _| {
            if replaced != Some(i) && problem.meeting([part, i], [a, self.predictor.state.radius[i]]) >= 0.0 {
                parted.push(pair_of(part, i));
            }
        });
        self.predictor.parted.extend(parted);
    }
}
