//! Equal-area merging of overlapping contacts and their splitting, for coalescence `merge`.
//!
//! Two contacts with `r < a_i + a_j` merge into one of the same area and load, at their area-weighted centre:
//! `a² = a_i² + a_j²`, `F = F_i + F_j`.
//! The radius of its sphere is `R = (4/3)E*a³/(F + sqrt(8πE*Δγa³))` (Eq 1), and its height makes it an equilibrium (Eqs 2 and 5).
//! From then on it is an asperity, which may merge again. It splits when its area has returned to the value at merging.
//!
//! Contacts merge in equilibrium, one pair at a time and the largest overlap first.
//! An asperity is absorbed as with `cover` if a larger contact reaches its centre before they have merged.
//! This happens if the asperity is free, or during the solution for an equilibrium.
//! A pair whose tensile load would put the merged contact beyond the end of its branch merges only when this is no longer so.
//! A pair that has split must have been apart before it merges again.
//!
//! A merged contact is a different sphere from its two parts, and its potential on its branch is another one. The difference at merging is a
//! constant of the merged contact and part of its potential: the potentials of the parts and their interaction are functions of their radii
//! alone, which are the same again when it splits. So merging and splitting alone dissipate nothing; what they change is the interaction
//! with other contacts, which respond to it.

use super::merged_spot::{Merged, TouchingPairs};
use super::problem::Problem;
use super::state::State;
use crate::model::{Coalescence, Interaction};
use crate::physics::PhysicsError;
use crate::physics::jkr::Asperity;

/// Relative change of a contact radius below the accuracy of an equilibrium.
pub(crate) const ROUNDING: f64 = 1e-8;

/// Maximum tensile load of a merged contact, relative to `sqrt(8πE*Δγa³)`.
///
/// The branch ends at 5/6.
const MAX_TENSILE_LOAD: f64 = 0.8;

impl Problem {
    /// True if contacts merge.
    pub(crate) fn merges(&self) -> bool {
        self.rules.coalescence == Coalescence::Merge
    }

    /// The problem with the merged contacts of a state.
    pub(crate) fn grown(&self, merged: &[Merged]) -> Result<Self, PhysicsError> {
        let mut grown = self.clone();
        for spot in merged {
            grown.add(spot)?;
        }
        Ok(grown)
    }

    /// Adds a merged contact; it gets the next number.
    pub(crate) fn add(&mut self, merged: &Merged) -> Result<(), PhysicsError> {
        let asperity = Asperity::as_printed(merged.radius_m, &self.material, self.rules.slips)?;
        let number = self.len();
        self.asperities.push(asperity);
        self.potential_offset.push(0.0);
        let ([i, j], [a, b]) = (merged.parts, merged.radii_m);
        let parts = self.self_potential(i, a) + self.self_potential(j, b) + self.interaction_energy([i, j], [a, b]);
        self.potential_offset[number] = parts - self.self_potential(number, merged.contact_radius_m());
        self.heights.push(merged.height_m);
        // After splitting, it cannot form a contact again.
        self.jump_in.push(f64::INFINITY);
        self.field.add(merged.place_m);
        self.neighbours.add(merged.place_m);
        Ok(())
    }

    /// `½(F_i ŵ_ij + F_j ŵ_ji)` of two contacts of these radii \[J\].
    fn interaction_energy(&self, [i, j]: [usize; 2], [a, b]: [f64; 2]) -> f64 {
        if self.rules.interaction == Interaction::None {
            return 0.0;
        }
        let r = self.distance(i, j);
        let (one, other) = (&self.asperities[i], &self.asperities[j]);
        0.5 * (one.load(a) * self.spot_field(other, r, b).0 + other.load(b) * self.spot_field(one, r, a).0)
    }

    /// Load of the contact that two contacts would merge into, and its adhesive part `sqrt(8πE*Δγa³)` \[N\].
    fn joint_load(&self, [i, j]: [usize; 2], [a, b]: [f64; 2]) -> (f64, f64) {
        let area_radius = a.hypot(b);
        let root = 2.0 * self.material.contact_modulus_pa * self.material.pull() * area_radius * area_radius.sqrt();
        (self.asperities[i].load(a) + self.asperities[j].load(b), root)
    }

    /// Converts a merged contact to the caller's numbers and positions.
    pub(crate) fn outward(&self, spot: &Merged) -> Merged {
        Merged { parts: spot.parts.map(|part| self.number(part)), place_m: self.places.outward(spot.place_m), ..*spot }
    }

    /// Overlap of two contacts of these radii \[m\] over their distance, or the distance of their joint load from the limit if that is
    /// less: negative as long as they do not merge.
    pub(crate) fn meeting(&self, pair: [usize; 2], radii: [f64; 2]) -> f64 {
        let overlap = (radii[0] + radii[1]) / self.distance(pair[0], pair[1]) - 1.0;
        let (load, root) = self.joint_load(pair, radii);
        if root > 0.0 { overlap.min(load / root + MAX_TENSILE_LOAD) } else { overlap }
    }

    /// Pairs that overlap and could merge.
    pub(crate) fn touching(&self, state: &State) -> TouchingPairs {
        let mut pairs = TouchingPairs::new();
        if !self.merges() {
            return pairs;
        }
        let largest = state.largest_radius();
        for &i in &state.contacts {
            self.neighbours.within(i, state.radius[i] + largest, |_, j| {
                if j > i && state.radius[j] > 0.0 && self.meeting([i, j], [state.radius[i], state.radius[j]]) >= 0.0 {
                    pairs.insert((i, j));
                }
            });
        }
        pairs
    }

    /// The contact that two contacts merge into at a mean penetration \[m\], without its height.
    pub(crate) fn merged(&self, [i, j]: [usize; 2], [a, b]: [f64; 2], approach_m: f64) -> Merged {
        let radius = a.hypot(b);
        let (load, root) = self.joint_load([i, j], [a, b]);
        let (from, way) = (*self.place(i), self.neighbours.apart(self.place(j), self.place(i)));
        let between = [0, 1].map(|k| from[k] + b * b / (radius * radius) * way[k]);
        Merged {
            parts: [i, j],
            radii_m: [a, b],
            // Rounded as after writing and reading it back.
            place_m: self.places.inward(self.places.outward(between)),
            radius_m: 4.0 / 3.0 * self.material.contact_modulus_pa * radius.powi(3) / (load + root),
            height_m: 0.0,
            release_m: (1.0 - ROUNDING) * radius,
            approach_m,
        }
    }
}
