//! Equal-area merging of overlapping contacts and their splitting, for coalescence `merge`.
//!
//! Two contacts with `r < a_i + a_j` merge into one of the same area and load, at their area-weighted centre:
//! `a² = a_i² + a_j²`, `F = F_i + F_j`. The radius of its sphere is `R = (4/3)E*a³/(F + sqrt(8πE*Δγa³))` (Eq
//! 1), and its height makes it an equilibrium (Eqs 2 and 5). From then on it is an asperity, which may merge
//! again. It splits when its area has returned to the value at merging.
//!
//! Contacts merge in equilibrium, one pair at a time and the largest overlap first. An asperity is absorbed
//! as with `cover` if a larger contact reaches its centre before they have merged. This happens if the
//! asperity is free, or during the solution for an equilibrium. A pair whose tensile load would put the
//! merged contact beyond the end of its branch merges only when this is no longer so. A pair that has split
//! must have been apart before it merges again. In other surroundings the parts are no longer in equilibrium
//! when it splits; they relax, and the energy of that is dissipated.
//!
//! A merged contact is a different sphere from its two parts, with another field and another potential. Both
//! differences at merging are constants of the merged contact:
//! - The difference of the fields stays at all other asperities, as a change of their heights, until it
//!   splits. Then nothing moves when contacts merge, and nothing when they split in the same surroundings.
//! - The difference of the potentials is part of its potential. So merging dissipates nothing, nor does
//!   splitting in the same surroundings.

use super::merged_spot::TouchingPairs;
use super::problem::Problem;
use super::state::{State, Status};
use crate::PhysicsError;
use crate::asperities::field::spot_field::Spot;
use crate::cycle::Merged;
use crate::jkr::Asperity;
use crate::model::Coalescence;

/// Maximum tensile load of a merged contact, relative to `sqrt(8πE*Δγa³)`.
///
/// The branch ends at 5/6.
pub(super) const MAX_TENSILE_LOAD: f64 = 0.8;

impl Problem {
    /// True if contacts merge.
    pub(crate) fn merges(&self) -> bool {
        self.rules.coalescence == Coalescence::Merge
    }

    /// The problem with the merged contacts of a state, and with heights that are known \[m\].
    pub(crate) fn grown(&self, state: &State, heights: Option<Vec<f64>>) -> Result<Self, PhysicsError> {
        let mut grown = self.clone();
        for spot in &state.merged {
            grown.add(spot)?;
        }
        if let Some(heights) = heights {
            return Ok(Self { heights, ..grown });
        }
        for number in self.live_merged(state) {
            let difference = grown.difference_field(number, &state.merged[number - self.summits()], state);
            grown.lower(&difference, 1.0);
        }
        Ok(grown)
    }

    /// Merged contacts that exist, ascending.
    pub(crate) fn live_merged(&self, state: &State) -> impl Iterator<Item = usize> {
        (self.summits()..state.status.len()).filter(|i| state.status[*i] != Status::Free)
    }

    /// Displacement \[m\] by two contacts beyond that of the contact that they merge into, at the radii at
    /// merging.
    ///
    /// By number, at all asperities and merged contacts that exist; 0 at the contact itself.
    pub(crate) fn difference_field(&self, number: usize, merged: &Merged, state: &State) -> Vec<f64> {
        let targets = (0..self.summits()).chain(self.live_merged(state)).filter(|i| *i != number);
        self.field.at_many(&self.difference(number, merged), targets)
    }

    /// Sum of the difference fields of merged contacts at the place of another \[m\].
    pub(crate) fn differences_at(&self, state: &State, number: usize) -> f64 {
        let sources = self.live_merged(state).filter(|k| *k != number);
        let sources: Vec<_> =
            sources.flat_map(|k| self.difference(k, &state.merged[k - self.summits()])).collect();
        self.field.at_one(&sources, number)
    }

    /// Two contacts with a positive sign, and the merged contact with a negative one: their fields sum to the
    /// difference field.
    fn difference(&self, number: usize, merged: &Merged) -> [(f64, Spot); 3] {
        let part = |k: usize| (1.0, self.spot(merged.parts[k], merged.radii_m[k]));
        [part(0), part(1), (-1.0, self.spot(number, merged.contact_radius_m()))]
    }

    /// Lowers heights by a difference field (1), or raises them again (−1).
    pub(crate) fn lower(&mut self, field: &[f64], sign: f64) {
        for (height, displacement) in self.heights.iter_mut().zip(field) {
            *height -= sign * displacement;
        }
    }

    /// Potential of two contacts beyond that of the contact in their place \[J\], of which the constant does
    /// not count.
    ///
    /// It consists of their own potentials and those of interaction, with each other and with
    /// `others`, whose radii are \[m\]. `difference` is the difference of their fields by number. `displaced`
    /// are the displacements at the two contacts and at the one \[m\].
    pub(crate) fn exchange_j(
        &self,
        number: usize,
        merged: &Merged,
        others: &[(usize, f64)],
        difference: &[f64],
        displaced: [f64; 3],
    ) -> f64 {
        let ([i, j], [a, b], radius) = (merged.parts, merged.radii_m, merged.contact_radius_m());
        let load = |i: usize, a: f64| self.asperities[i].load(a);
        let own =
            |i: usize, a: f64, displacement: f64| self.self_potential(i, a) + 0.5 * load(i, a) * displacement;
        let fields: f64 = others.iter().map(|(k, a)| difference[*k] * load(*k, *a)).sum();
        own(i, a, displaced[0]) + own(j, b, displaced[1]) - own(number, radius, displaced[2])
            + self.potential_offset[number]
            + 0.5 * fields
    }

    /// Adds a merged contact; it gets the next number.
    pub(crate) fn add(&mut self, merged: &Merged) -> Result<(), PhysicsError> {
        let asperity = Asperity::as_printed(merged.radius_m, &self.material, self.rules.slips)?;
        self.asperities.push(asperity);
        self.potential_offset.push(merged.offset_j);
        self.heights.push(merged.height_m);
        // After splitting, it cannot form a contact again.
        self.jump_in.push(f64::INFINITY);
        self.field.add(merged.place_m);
        self.neighbours.add(merged.place_m);
        Ok(())
    }

    /// Load of the contact that two contacts would merge into, and its adhesive part `sqrt(8πE*Δγa³)` \[N\].
    fn joint_load(&self, [i, j]: [usize; 2], [a, b]: [f64; 2]) -> (f64, f64) {
        let area_radius = a.hypot(b);
        let root =
            2.0 * self.material.contact_modulus_pa * self.material.pull() * area_radius * area_radius.sqrt();
        (self.asperities[i].load(a) + self.asperities[j].load(b), root)
    }

    /// Converts a merged contact to the caller's numbers and positions.
    pub(crate) fn outward(&self, spot: &Merged) -> Merged {
        Merged {
            parts: spot.parts.map(|part| self.number(part)),
            place_m: self.places.outward(spot.place_m),
            ..*spot
        }
    }

    /// Overlap of two contacts of these radii \[m\] over their distance, or the distance of their joint load
    /// from the limit if that is less: negative as long as they do not merge.
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
                if j > i
                    && state.radius[j] > 0.0
                    && self.meeting([i, j], [state.radius[i], state.radius[j]]) >= 0.0
                {
                    pairs.insert((i, j));
                }
            });
        }
        pairs
    }

    /// The contact that two contacts merge into at a mean penetration \[m\], without its height.
    pub(crate) fn merged(&self, [i, j]: [usize; 2], [a, b]: [f64; 2], mean_penetration_m: f64) -> Merged {
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
            offset_j: 0.0,
            release_m: (1.0 - self.numerics.events.radius_resolution) * radius,
            mean_penetration_m,
        }
    }
}
