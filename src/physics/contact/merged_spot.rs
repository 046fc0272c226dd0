//! Merged contact spots: one spot in place of two, for coalescence `merge`.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A merged spot, which replaces two contact spots.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Merged {
    /// Parts: asperities of the surface, or merged spots themselves.
    pub parts: [usize; 2],
    /// Contact radii of the parts at merging \[m\].
    pub radii_m: [f64; 2],
    /// Centre \[m\].
    pub place_m: [f64; 2],
    /// Radius of curvature R \[m\].
    pub radius_m: f64,
    /// Height relative to the highest asperity \[m\], without the difference fields of other merged contacts.
    pub height_m: f64,
    /// Constant of its potential \[J\].
    pub offset_j: f64,
    /// Contact radius at which the spot splits \[m\].
    pub release_m: f64,
    /// Mean penetration at merging \[m\].
    pub approach_m: f64,
}

impl Merged {
    /// Contact radius of the spot at merging \[m\].
    #[must_use]
    pub fn contact_radius_m(&self) -> f64 {
        self.radii_m[0].hypot(self.radii_m[1])
    }

    /// This contact at another size of both parts.
    pub(crate) fn scaled(&self, share: f64) -> Self {
        Self { radii_m: self.radii_m.map(|a| share * a), ..*self }
    }
}

/// Set of pairs of overlapping spots, as [`pair_of`].
pub(crate) type TouchingPairs = BTreeSet<(usize, usize)>;

/// A pair of spots, the lower number first.
pub(crate) fn pair_of(i: usize, j: usize) -> (usize, usize) {
    (i.min(j), i.max(j))
}
