//! Equal-area merging of overlapping spots and their splitting, for coalescence `merge`.
//!
//! Two spots with `r < a_i + a_j` merge into one of the same area and load, at their area-weighted centre:
//! `a² = a_i² + a_j²`, `F = F_i + F_j`.
//! The radius of its sphere is `R = (4/3)E*a³/(F + sqrt(8πE*Δγa³))` (Eq 1), and its height makes it an equilibrium (Eqs 2 and 5).
//! From then on it is an asperity, which may merge again. It splits when its area has returned to the value at merging.
//!
//! Spots merge in equilibrium, when they begin to overlap, one pair at a time and the largest overlap first.
//! Merging during the solution for an equilibrium is unstable.
//! An asperity is absorbed as with `cover` if a larger spot reaches its centre before they have merged.
//! This happens if the asperity is free, or during the solution for an equilibrium.
//! A pair whose tensile load would put the merged spot beyond the end of its branch merges only when this is no longer so.
//! A pair that has split must have been apart before it merges again.
//!
//! A merged spot is a different sphere from its two parts, and its potential on its branch is another one. The difference at merging is a
//! constant of the merged spot and part of its potential: the potentials of the parts and their interaction are functions of their radii
//! alone, which are the same again when it splits. So merging and splitting alone dissipate nothing; what they change is the interaction
//! with other contacts, which respond to it.

use super::merged_spot::Merged;
use super::merged_spot::TouchingPairs;
use super::problem::Problem;
use super::state::{State, Status};
use crate::model::{Coalescence, Interaction};
use crate::physics::PhysicsError;
use crate::physics::half_space::{Effort, Interaction as _, Spots};
use crate::physics::jkr::Asperity;

/// Maximum overlap at merging, relative to the distance of the spots.
pub(crate) const TOUCH: f64 = 1e-3;

/// Factor on the relative distance to the release radius, which tightens the tolerance for splitting.
const SPLIT_FACTOR: f64 = 10.0;

/// Relative change of a contact radius below the accuracy of an equilibrium.
pub(crate) const ROUNDING: f64 = 1e-8;

/// Maximum tensile load of a merged spot, relative to `sqrt(8πE*Δγa³)`.
///
/// The branch ends at 5/6.
const MAX_TENSILE_LOAD: f64 = 0.8;

/// A pending change of the merged spots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum CoalescenceEvent {
    /// Two spots merge.
    Touch(usize, usize),
    /// A merged spot splits into its parts.
    Part(usize),
    /// A merged spot has left contact, and its parts become free.
    Leave,
}

impl Problem {
    /// Extends the problem by the merged spots of a state; `None` if there are none.
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
        let number = self.len();
        self.asperities.push(asperity);
        self.potential_offset.push(0.0);
        let ([i, j], [a, b]) = (merged.parts, merged.radii_m);
        let parts = self.self_potential(i, a) + self.self_potential(j, b) + self.interaction_energy([i, j], [a, b]);
        self.potential_offset[number] = parts - self.self_potential(number, merged.contact_radius_m());
        self.heights.push(merged.height_m);
        self.positions.push(merged.place_m);
        // After splitting, it cannot form a contact again.
        self.jump_in.push(f64::INFINITY);
        self.field.add(merged.place_m);
        self.neighbours.add(merged.place_m);
        Ok(())
    }

    /// `½(F_i ŵ_ij + F_j ŵ_ji)` of two spots of these radii \[J\].
    fn interaction_energy(&self, [i, j]: [usize; 2], [a, b]: [f64; 2]) -> f64 {
        if self.rules.interaction == Interaction::None {
            return 0.0;
        }
        let r = self.neighbours.distance(&self.positions[i], &self.positions[j]);
        let (one, other) = (&self.asperities[i], &self.asperities[j]);
        0.5 * (one.load(a) * self.spot_field(other, r, b).0 + other.load(b) * self.spot_field(one, r, a).0)
    }

    /// Load of the spot that two spots would merge into, and its adhesive part `sqrt(8πE*Δγa³)` \[N\].
    fn joint_load(&self, state: &State, i: usize, j: usize) -> (f64, f64) {
        let [a, b] = [state.radius[i], state.radius[j]];
        let area_radius = a.hypot(b);
        let root = 2.0 * self.material.contact_modulus_pa * self.material.pull() * area_radius * area_radius.sqrt();
        (self.asperities[i].load(a) + self.asperities[j].load(b), root)
    }

    /// Converts a merged spot to the caller's numbers and positions.
    pub(crate) fn outward(&self, spot: &Merged) -> Merged {
        Merged { parts: spot.parts.map(|part| self.number(part)), place_m: self.places.outward(spot.place_m), ..*spot }
    }

    /// Signed distance of a state past a coalescence event: negative before the event.
    pub(crate) fn beyond(&self, state: &State, meeting: CoalescenceEvent) -> f64 {
        match meeting {
            CoalescenceEvent::Touch(i, j) if state.radius[i] > 0.0 && state.radius[j] > 0.0 => {
                let overlap = (state.radius[i] + state.radius[j]) / self.neighbours.distance(&self.positions[i], &self.positions[j]) - 1.0;
                let (load, root) = self.joint_load(state, i, j);
                if root > 0.0 { overlap.min(load / root + MAX_TENSILE_LOAD) } else { overlap }
            }
            CoalescenceEvent::Part(m) if state.radius[m] > 0.0 => {
                SPLIT_FACTOR * (1.0 - state.radius[m] / state.merged[m - self.summits()].release_m)
            }
            _ => -1.0,
        }
    }

    /// Pairs that overlap and could merge.
    pub(crate) fn touching(&self, state: &State) -> TouchingPairs {
        let mut pairs = TouchingPairs::new();
        if self.rules.coalescence != Coalescence::Merge {
            return pairs;
        }
        let largest = state.largest_radius();
        for &i in &state.contacts {
            self.neighbours.within(i, state.radius[i] + largest, |_, j| {
                if j > i && self.beyond(state, CoalescenceEvent::Touch(i, j)) >= 0.0 {
                    pairs.insert((i, j));
                }
            });
        }
        pairs
    }

    /// Pending coalescence events, the furthest past first, given the overlapping pairs.
    pub(crate) fn meetings(&self, state: &State, touching: &TouchingPairs, known: &TouchingPairs) -> Vec<(f64, CoalescenceEvent)> {
        let touching = touching.difference(known).map(|(i, j)| CoalescenceEvent::Touch(*i, *j));
        let parting = (self.summits()..self.len()).map(CoalescenceEvent::Part);
        let mut due: Vec<(f64, CoalescenceEvent)> =
            touching.chain(parting).map(|m| (self.beyond(state, m), m)).filter(|due| due.0 >= 0.0).collect();
        due.sort_by(|u, v| v.0.total_cmp(&u.0).then(u.1.cmp(&v.1)));
        due
    }

    /// Merges two spots of a state; returns the number of the merged spot.
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
            // Rounded as after writing and reading it back.
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

    /// Splits a merged spot of a state into its parts, with its current area.
    pub(crate) fn part(&self, state: &mut State, number: usize) {
        let merged = state.merged[number - self.summits()];
        let share = state.radius[number] / merged.contact_radius_m();
        state.set(number, Status::Free, 0.0);
        for (part, radius) in merged.parts.into_iter().zip(merged.radii_m) {
            state.set(part, Status::Contact, share * radius);
        }
    }

    /// Frees the parts of merged spots that have left contact, and blocks them from re-entry.
    pub(crate) fn free_orphans(&self, state: &mut State) {
        // A part has a lower number than its merged spot.
        for i in (0..state.status.len()).rev() {
            if state.is_orphan(i) {
                state.set(i, Status::Free, 0.0);
                state.barred[i] = i < self.summits();
            }
        }
    }

    /// Displacement \[m\] at asperity `i` by the spots of a state.
    fn surrounding(&self, state: &State, i: usize) -> f64 {
        let (mut spots, mut found) = (Spots::default(), Vec::new());
        self.spots(state, &mut spots);
        self.field.displacements(&spots, &[i], &mut found, &mut Effort::default());
        found[0]
    }

    /// Refuses a state whose area \[m²\] reaches the nominal area or whose largest spot spans the square.
    pub(crate) fn check_room(&self, state: &State, area: f64) -> Result<(), PhysicsError> {
        let share = area / (self.length_m * self.length_m);
        if share < 1.0 && state.largest_radius() < 0.5 * self.length_m {
            return Ok(());
        }
        Err(PhysicsError::FullContact { approach_m: state.approach_m, share })
    }
}
