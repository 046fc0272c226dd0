//! Contact spots that stand for two, where coalescence is `merge`.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A spot that stands for two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Merged {
    /// Parts: summits, or merged spots themselves.
    pub parts: [usize; 2],
    /// Their contact radii when they merged \[m\].
    pub radii_m: [f64; 2],
    /// Centre \[m\].
    pub place_m: [f64; 2],
    /// Radius of curvature R \[m\].
    pub radius_m: f64,
    /// Height over the highest summit \[m\].
    pub height_m: f64,
    /// The contact radius at which it parts \[m\].
    pub release_m: f64,
    /// Approach at which they merged \[m\].
    pub approach_m: f64,
}

impl Merged {
    /// Contact radius when the parts merged \[m\].
    #[must_use]
    pub fn contact_radius_m(&self) -> f64 {
        self.radii_m[0].hypot(self.radii_m[1])
    }
}

/// Pairs that touch and are no news.
pub(crate) type TouchingPairs = BTreeSet<(usize, usize)>;
