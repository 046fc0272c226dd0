//! Merging and splitting in a local problem.

use super::equilibrium_path::EquilibriumPath;
use super::propagation::Before;
use crate::PhysicsError;
use crate::asperities::contact::Status;
use crate::asperities::contact::merged_spot::pair_of;
use crate::asperities::contact::transition::Transition;
use crate::cycle::Merged;
use std::sync::Arc;

/// Effect of the end of a field on the members of the local problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Members {
    /// Their displacements contain it already.
    Settled,
    /// It is pending, as for all other contacts.
    Pending,
}

impl EquilibriumPath {
    /// Replaces two contacts of the local problem by one of the same area and load, which is in equilibrium
    /// there; the transition names it. Nothing else changes: the local problem is the one `before` any
    /// response.
    pub(super) fn merge(
        &mut self,
        transition: Transition,
        before: &mut Before,
    ) -> Result<Transition, PhysicsError> {
        let problem = self.problem();
        let pair = [transition.by.unwrap_or(transition.asperity), transition.asperity];
        let mean_penetration = self.neighbourhood.local.mean_penetration;
        let at = pair.map(|i| self.neighbourhood.local.find(i));
        let [Some(first), Some(second)] = at else { return Ok(Transition::snap(transition.asperity)) };
        let local = &self.neighbourhood.local;
        let radii = [local.radius[first], local.radius[second]];
        let share = radii.map(|a| a * a / (radii[0] * radii[0] + radii[1] * radii[1]));
        let drift = share[0] * local.members[first].drift + share[1] * local.members[second].drift;
        let contacts: Vec<(usize, f64)> = self.contacts_without(&pair, mean_penetration);
        let mut merged = problem.merged(pair, radii, mean_penetration);
        let (number, radius) = (problem.len(), merged.contact_radius_m());
        drop(problem);
        Arc::make_mut(&mut self.solver.problem).add(&merged)?;
        let outside = self.solver.displacements(&contacts, &[pair[0], pair[1], number]);
        let displaced = self.displaced(number, &merged, outside);
        let problem = self.problem();
        let difference = problem.difference_field(number, &merged, self.state());
        let height = problem.asperities[number].penetration(radius) + displaced[2] - mean_penetration;
        merged.height_m = height + problem.differences_at(self.state(), number);
        merged.offset_j = problem.exchange_j(number, &merged, &contacts, &difference, displaced);
        drop(problem);
        let grown = Arc::make_mut(&mut self.solver.problem);
        grown.heights[number] = height;
        grown.potential_offset[number] = merged.offset_j;
        grown.lower(&difference, 1.0);
        let problem = &*self.problem();
        let (local, effort) = (&mut self.neighbourhood.local, &mut self.solver.effort);
        for part in pair {
            local.remove(part);
        }
        local.evaluate(problem, effort);
        let place = local.place(problem, number, outside[2], drift, effort);
        local.insert(place, radius);
        self.predictor.extend(merged);
        self.pending.grow(problem.len());
        self.pending.set_applied(number);
        self.chatter.join(pair);
        *before = self.exchanged(before, 0.0);
        Ok(Transition::merged(number))
    }

    /// Replaces a merged contact of the local problem by its parts, with its present area; the local problem
    /// is the one `before` any response.
    pub(super) fn split(&mut self, number: usize, before: &mut Before) {
        let mean_penetration = self.neighbourhood.local.mean_penetration;
        let Some(at) = self.neighbourhood.local.find(number) else { return };
        let contacts: Vec<(usize, f64)> = self.contacts_without(&[number], mean_penetration);
        let problem = self.problem();
        let merged = self.predictor.state.merged[number - problem.summits()];
        let (radius, drift) =
            (self.neighbourhood.local.radius[at], self.neighbourhood.local.members[at].drift);
        let present = merged.scaled(radius / merged.contact_radius_m());
        let difference = problem.difference_field(number, &merged, self.state());
        // Beyond the radius at which it merged the fields of its parts differ by something else from its own.
        let has_shrunk =
            radius < (1.0 - 10.0 * problem.numerics.events.radius_resolution) * merged.contact_radius_m();
        let now = has_shrunk.then(|| problem.difference_field(number, &present, self.state()));
        let outside = self.solver.displacements(&contacts, &[merged.parts[0], merged.parts[1], number]);
        let displaced = self.displaced(number, &present, outside);
        let exchanged =
            problem.exchange_j(number, &present, &contacts, now.as_ref().unwrap_or(&difference), displaced);
        drop(problem);
        Arc::make_mut(&mut self.solver.problem).lower(&difference, -1.0);
        let excess: Vec<f64> =
            now.iter().flatten().zip(&difference).map(|(begins, ends)| ends - begins).collect();
        let gained = exchanged - merged.offset_j + self.end_field(&excess, Members::Settled);
        let problem = &*self.problem();
        let (local, effort) = (&mut self.neighbourhood.local, &mut self.solver.effort);
        local.remove(number);
        local.evaluate(problem, effort);
        for (part, (displacement, radius)) in
            merged.parts.into_iter().zip(outside.into_iter().zip(present.radii_m))
        {
            let place = local.place(problem, part, displacement, drift, effort);
            local.insert(place, radius);
            self.pending.set_applied(part);
        }
        for (part, radius) in merged.parts.into_iter().zip(present.radii_m) {
            self.part_pairs(part, radius, Some(number));
        }
        self.predictor.parted.insert(pair_of(merged.parts[0], merged.parts[1]));
        *before = self.exchanged(before, gained);
    }

    /// Displacements \[m\] at two contacts, by one another and by all images, and at the one in their place,
    /// by its images, with those by the `outside`.
    fn displaced(&mut self, number: usize, merged: &Merged, outside: [f64; 3]) -> [f64; 3] {
        let pair = [0, 1].map(|k| (merged.parts[k], merged.radii_m[k]));
        let [first, second] = self.solver.displacements(&pair, &merged.parts);
        let own = self.solver.displacement(&[(number, merged.contact_radius_m())], number);
        [outside[0] + first, outside[1] + second, outside[2] + own]
    }

    /// The local problem after an exchange of contacts that has gained energy \[J\] and changed nothing
    /// elsewhere.
    fn exchanged(&mut self, before: &Before, gained_j: f64) -> Before {
        let problem = &*self.problem();
        self.neighbourhood.local.evaluate(problem, &mut self.solver.effort);
        let now = self.begin();
        Before { totals: before.totals, potential: now.potential - gained_j, ..now }
    }

    /// Contacts and their predicted radii at a mean penetration \[m\], without some.
    fn contacts_without(&self, some: &[usize], mean_penetration: f64) -> Vec<(usize, f64)> {
        let all = self.predictor.radii(&self.problem(), mean_penetration);
        all.into_iter().filter(|(i, _)| !some.contains(i)).collect()
    }

    /// Frees the parts of a merged contact that has left contact, and blocks them from re-entry; they are
    /// returned, with the energy that the loads of the other contacts gain as its difference field ends
    /// \[J\].
    pub(super) fn free_parts(&mut self, number: usize) -> (Vec<usize>, f64) {
        let summits = self.problem().summits();
        let (mut freed, mut gained_j, mut left) = (Vec::new(), 0.0, vec![number]);
        while let Some(into) = left.pop() {
            let Some(merged) = into.checked_sub(summits).map(|k| self.predictor.state.merged[k]) else {
                continue;
            };
            gained_j += self.end_difference(into, &merged);
            for part in merged.parts {
                if self.predictor.state.status[part] == (Status::Merged { into }) {
                    self.predictor.set(part, Status::Free, 0.0);
                    self.predictor.state.barred[part] = part < summits;
                    freed.push(part);
                    left.push(part);
                }
            }
        }
        (freed, gained_j)
    }

    /// Ends the difference field of a merged contact that has left contact: all contacts have that as a
    /// pending displacement. The energy that their loads gain is returned \[J\].
    fn end_difference(&mut self, number: usize, merged: &Merged) -> f64 {
        let problem = self.problem();
        let difference = problem.difference_field(number, merged, self.state());
        drop(problem);
        Arc::make_mut(&mut self.solver.problem).lower(&difference, -1.0);
        self.end_field(&difference, Members::Pending)
    }

    /// Ends a field, by asperity: contacts have that as a pending displacement. The energy that their loads
    /// gain is returned \[J\].
    fn end_field(&mut self, field: &[f64], members: Members) -> f64 {
        let (problem, limit) = (self.problem(), self.pending_limit());
        let mut gained_j = 0.0;
        for (i, displacement) in
            field.iter().copied().enumerate().filter(|(_, displacement)| *displacement != 0.0)
        {
            if self.predictor.state.status[i] == Status::Contact {
                if members == Members::Pending || self.neighbourhood.local.find(i).is_none() {
                    gained_j += displacement * problem.asperities[i].load(self.predictor.state.radius[i]);
                    self.pending.add_near(i, -displacement, limit);
                }
            } else if self.predictor.traces[i].is_known() {
                self.predictor.displace(&problem, i, -displacement);
            }
        }
        gained_j
    }

    /// Blocks pairs of a new contact of radius `a` \[m\] with the contacts that it overlaps, except for
    /// `replaced`: they do not merge before they have been apart.
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
