//! State of a contact: status and radius of every asperity.

use super::problem::Problem;
use crate::asperities::field::Spots;
use crate::cycle::{Merged, Totals};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Status of an asperity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Status {
    /// Out of contact.
    Free,
    /// In contact, on its own JKR branch.
    Contact,
    /// Absorbed by a larger spot: it carries no load and has no area.
    Covered {
        /// Asperity whose spot absorbs it.
        by: usize,
        /// Radius of that spot below which it is released \[m\].
        ///
        /// It is the distance of the two, or less if absorption made the spot shrink.
        release_m: f64,
    },
    /// Part of a merged spot.
    Merged {
        /// Number of the merged spot.
        into: usize,
    },
}

/// State along the path, sufficient to continue from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Mean penetration Δ \[m\], 0 at the highest summit.
    pub mean_penetration_m: f64,
    /// Status of each asperity.
    pub status: Vec<Status>,
    /// Contact radius of each asperity \[m\], 0 out of contact.
    pub radius: Vec<f64>,
    /// Asperities blocked from re-entry after they left contact.
    ///
    /// They left while their penetration was above the jump-in, and stay free until it falls below.
    pub barred: Vec<bool>,
    /// Merged spots in order of creation.
    ///
    /// Their numbers follow those of the asperities of the surface.
    pub merged: Vec<Merged>,
    /// Asperities in contact, ascending.
    pub contacts: Vec<usize>,
    /// Displacement ŵ at the asperities in contact \[m\], in their order.
    pub displacement: Vec<f64>,
    /// Largest residual of the equilibrium \[m\].
    pub residual_m: f64,
    /// Smallest eigenvalue of the scaled tangent `∂(δ_JKR + ŵ)/∂a`.
    ///
    /// Each column of the tangent is divided by its diagonal element.
    ///
    /// It is 1 without coupling, 0 at a limit point, and negative for an unstable equilibrium.
    pub stability: f64,
}

impl State {
    /// State at a mean penetration \[m\] with all asperities free.
    #[must_use]
    pub fn free(problem: &Problem, mean_penetration_m: f64) -> Self {
        let n = problem.len();
        Self {
            mean_penetration_m,
            status: vec![Status::Free; n],
            radius: vec![0.0; n],
            barred: vec![false; n],
            merged: Vec::new(),
            contacts: Vec::new(),
            displacement: Vec::new(),
            residual_m: 0.0,
            stability: 1.0,
        }
    }

    /// Largest contact radius \[m\], 0 without contact.
    pub(crate) fn largest_radius(&self) -> f64 {
        self.contacts.iter().map(|&i| self.radius[i]).fold(0.0, f64::max)
    }

    /// Spot in contact that absorbs an asperity, directly or through absorbed asperities and merged spots.
    pub(crate) fn carrier(&self, mut i: usize) -> Option<usize> {
        // The bound ends a cycle of asperities that absorb one another, in which none is in contact.
        for _ in 0..self.status.len() {
            match self.status[i] {
                Status::Contact => return Some(i),
                Status::Covered { by, .. } => i = by,
                Status::Merged { into } => i = into,
                Status::Free => return None,
            }
        }
        None
    }

    /// Radius at which a merged contact splits \[m\].
    pub(crate) fn release_of_merged(&self, problem: &Problem, i: usize) -> Option<f64> {
        Some(self.merged.get(i.checked_sub(problem.summits())?)?.release_m)
    }

    /// Adds a merged contact, which is free until it is set.
    pub(crate) fn extend(&mut self, merged: Merged) {
        self.status.push(Status::Free);
        self.radius.push(0.0);
        self.barred.push(false);
        self.merged.push(merged);
    }

    pub(crate) fn set(&mut self, i: usize, status: Status, radius: f64) {
        match (self.contacts.binary_search(&i), status) {
            (Ok(at), Status::Free | Status::Covered { .. } | Status::Merged { .. }) => {
                self.contacts.remove(at);
                if at < self.displacement.len() {
                    self.displacement.remove(at);
                }
            }
            (Err(at), Status::Contact) => {
                self.contacts.insert(at, i);
                self.displacement.insert(at.min(self.displacement.len()), 0.0);
            }
            _ => {}
        }
        self.status[i] = status;
        self.radius[i] = radius;
    }

    /// Number of absorbed asperities.
    #[must_use]
    pub fn covered_count(&self) -> usize {
        self.status.iter().filter(|s| matches!(s, Status::Covered { .. })).count()
    }
}

impl Problem {
    /// Spots of a state as sources of displacement.
    pub(crate) fn spots(&self, state: &State, spots: &mut Spots) {
        self.columns(state.contacts.iter().map(|&i| (i, state.radius[i])), spots);
    }

    /// Load, area and potential \[J\] of an equilibrium with known displacements at the spots.
    ///
    /// The potential is `Π = Σ[U(d_i, a_i) − Δγπa_i²] + ½ΣF_iŵ_i`: exact for point interaction.
    pub(crate) fn totals(&self, state: &State) -> (Totals, f64) {
        let mut totals = Totals::default();
        let mut potential = 0.0;
        for (&i, &w) in state.contacts.iter().zip(&state.displacement) {
            let (asperity, a) = (&self.asperities[i], state.radius[i]);
            let load = asperity.load(a);
            let spot = PI * a * a;
            totals.load_n += load;
            totals.area_m2 += spot;
            potential += self.self_potential(i, a) + 0.5 * load * w;
        }
        (totals, potential)
    }
}
