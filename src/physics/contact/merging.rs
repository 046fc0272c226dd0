//! Touching spots become one and part again, where coalescence is `merge`.
//!
//! Two spots with `r < a_i + a_j` become one of the same area and load: `a² = a_i² + a_j²`, at their area-weighted centre, `F = F_i + F_j`. So its
//! sphere is that of radius `R = (4/3)E*a³/(F + sqrt(8πE*Δγa³))` (Eq 1), at the height at which it is in equilibrium as it is (Eqs 2 and 5). It is an
//! asperity from then on, may merge again, and parts where its area has come back to what it was then.
//!
//! Spots merge where they come to touch, in equilibrium, one pair at a time, the most overlapping first; merging on the way to an equilibrium runs
//! away. An asperity whose centre a greater spot reaches before they have merged, since it is free or on the way to an equilibrium, is covered
//! as with `cover`. A pair that would be beyond the end of its branch, by its tension, does not merge until it would not be; one that has parted must have been
//! apart before it merges again.
//!
//! A merged spot is another sphere than its two parts, and has another potential. What the potential loses when they merge is no dissipation
//! alone: parting gives it back, and only the sum over both is a loss.

use super::merged_spot::Merged;
use super::merged_spot::TouchingPairs;
use super::problem::Problem;
use super::state::{State, Status};
use crate::model::Coalescence;
use crate::physics::PhysicsError;
use crate::physics::half_space::{Effort, Interaction as _, Spots};
use crate::physics::jkr::Asperity;

/// Overlap at which spots merge at the latest, of their distance.
pub(crate) const TOUCH: f64 = 1e-3;

/// How many times nearer to its radius of release a spot parts at the latest.
const NEARER: f64 = 10.0;

/// Relative change of a radius that an equilibrium does not tell from none.
pub(crate) const ROUNDING: f64 = 1e-8;

/// Greatest tension of a merged spot, of `sqrt(8πE*Δγa³)`. The branch ends at 5/6.
const TENSEST: f64 = 0.8;

/// What is to be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum CoalescenceEvent {
    /// These spots become one.
    Touch(usize, usize),
    /// This merged spot parts.
    Part(usize),
    /// A merged spot has left, and what it stood for is free.
    Leave,
}

impl Problem {
    /// The problem of a state that has merged spots; nothing where it has none.
    pub(crate) fn grown(&self, merged: &[Merged]) -> Result<Option<Self>, PhysicsError> {
        if merged.is_empty() {
            return Ok(None);
        }
        let mut grown = self.clone();
        for spot in merged {
            grown.add(spot)?;
        }
        Ok(Some(grown))
    }

    fn add(&mut self, merged: &Merged) -> Result<(), PhysicsError> {
        let asperity = Asperity::as_printed(merged.radius_m, &self.material, self.rules.slips)?;
        self.tabor.push(asperity.tabor(self.material.interaction_range_m));
        self.asperities.push(asperity);
        self.heights.push(merged.height_m);
        self.positions.push(merged.place_m);
        // Once it has parted it is nothing.
        self.jump_in.push(f64::INFINITY);
        self.field.add(merged.place_m);
        self.neighbours.add(merged.place_m);
        Ok(())
    }

    /// Load of the contact that two contacts would become, and its adhesive part `sqrt(8πE*Δγa³)` \[N\].
    fn joint_load(&self, state: &State, i: usize, j: usize) -> (f64, f64) {
        let [a, b] = [state.radius[i], state.radius[j]];
        let area_radius = a.hypot(b);
        let root = 2.0 * self.material.contact_modulus_pa * self.material.pull() * area_radius * area_radius.sqrt();
        (self.asperities[i].load(a) + self.asperities[j].load(b), root)
    }

    /// A merged spot by the caller's numbers and places.
    pub(crate) fn outward(&self, spot: &Merged) -> Merged {
        Merged { parts: spot.parts.map(|part| self.number(part)), place_m: self.places.outward(spot.place_m), ..*spot }
    }

    /// How far a state is beyond a meeting: negative before it.
    pub(crate) fn beyond(&self, state: &State, meeting: CoalescenceEvent) -> f64 {
        match meeting {
            CoalescenceEvent::Touch(i, j) if state.radius[i] > 0.0 && state.radius[j] > 0.0 => {
                let overlap = (state.radius[i] + state.radius[j]) / self.neighbours.distance(&self.positions[i], &self.positions[j]) - 1.0;
                let (load, root) = self.joint_load(state, i, j);
                if root > 0.0 { overlap.min(load / root + TENSEST) } else { overlap }
            }
            CoalescenceEvent::Part(m) if state.radius[m] > 0.0 => {
                NEARER * (1.0 - state.radius[m] / state.merged[m - self.summits].release_m)
            }
            _ => -1.0,
        }
    }

    /// Pairs that touch and could merge.
    pub(crate) fn touching(&self, state: &State) -> TouchingPairs {
        let mut pairs = TouchingPairs::new();
        if self.rules.coalescence != Coalescence::Merge {
            return pairs;
        }
        let greatest = state.greatest_radius();
        for &i in &state.contacts {
            self.neighbours.within(i, state.radius[i] + greatest, |_, j| {
                if j > i && self.beyond(state, CoalescenceEvent::Touch(i, j)) >= 0.0 {
                    pairs.insert((i, j));
                }
            });
        }
        pairs
    }

    /// Meetings that are due, the furthest beyond first, given who is touching.
    pub(crate) fn meetings(&self, state: &State, touching: &TouchingPairs, known: &TouchingPairs) -> Vec<(f64, CoalescenceEvent)> {
        let touching = touching.difference(known).map(|(i, j)| CoalescenceEvent::Touch(*i, *j));
        let parting = (self.summits..self.len()).map(CoalescenceEvent::Part);
        let mut due: Vec<(f64, CoalescenceEvent)> =
            touching.chain(parting).map(|m| (self.beyond(state, m), m)).filter(|due| due.0 >= 0.0).collect();
        due.sort_by(|u, v| v.0.total_cmp(&u.0).then(u.1.cmp(&v.1)));
        due
    }

    /// Makes two spots of a state one; its number is returned.
    pub(crate) fn join(&mut self, state: &mut State, i: usize, j: usize) -> Result<usize, PhysicsError> {
        let [a, b] = [state.radius[i], state.radius[j]];
        let radius = a.hypot(b);
        let (load, root) = self.joint_load(state, i, j);
        let number = self.len();
        let (from, way) = (self.positions[i], self.neighbours.apart(&self.positions[j], &self.positions[i]));
        let between = [0, 1].map(|k| from[k] + b * b / (radius * radius) * way[k]);
        let mut merged = Merged {
            parts: [i, j],
            radii_m: [a, b],
            // As it will be when it has been written down and read again.
            place_m: self.places.inward(self.places.outward(between)),
            radius_m: 4.0 / 3.0 * self.material.contact_modulus_pa * radius.powi(3) / (load + root),
            height_m: 0.0,
            release_m: radius,
            approach_m: state.approach_m,
        };
        self.add(&merged)?;
        state.extend();
        for part in [i, j] {
            state.set(part, Status::Merged { into: number }, 0.0);
        }
        state.set(number, Status::Contact, radius);
        let displacement = self.surrounding(state, number);
        merged.height_m = self.asperities[number].penetration(radius) + displacement - state.approach_m;
        self.heights[number] = merged.height_m;
        state.merged.push(merged);
        Ok(number)
    }

    /// A merged spot of a state becomes its parts again, of the area that it has.
    pub(crate) fn part(&self, state: &mut State, number: usize) {
        let merged = state.merged[number - self.summits];
        let share = state.radius[number] / merged.contact_radius_m();
        state.set(number, Status::Free, 0.0);
        for (part, radius) in merged.parts.into_iter().zip(merged.radii_m) {
            state.set(part, Status::Contact, share * radius);
        }
    }

    /// Where a merged spot has left, what it stood for is free, as anything that has left.
    pub(crate) fn free_orphans(&self, state: &mut State) {
        // A part has a lower number than its spot.
        for i in (0..state.status.len()).rev() {
            if state.is_orphan(i) {
                state.set(i, Status::Free, 0.0);
                state.barred[i] = i < self.summits;
            }
        }
    }

    /// Displacement at a spot by those of a state \[m\].
    fn surrounding(&self, state: &State, i: usize) -> f64 {
        let (mut spots, mut found) = (Spots::default(), Vec::new());
        self.spots(state, &mut spots);
        self.field.displacements(&spots, &[i], &mut found, &mut Effort::default());
        found[0]
    }

    /// True if there is room for the spots of a state, which have this area \[m²\].
    pub(crate) fn check_room(&self, state: &State, area: f64) -> Result<(), PhysicsError> {
        let share = area / (self.length_m * self.length_m);
        if share < 1.0 && state.greatest_radius() < 0.5 * self.length_m {
            return Ok(());
        }
        Err(PhysicsError::FullContact { approach_m: state.approach_m, share })
    }
}
