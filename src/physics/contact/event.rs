//! Event of a path.

use super::problem::Totals;
use super::transition::Kind;
use serde::{Deserialize, Serialize};

/// An event as it happened.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Kind of event.
    pub kind: Kind,
    /// To which asperity.
    pub asperity: usize,
    /// At which approach δ \[m\].
    pub approach_m: f64,
    /// Which avalanche it belongs to, counted along the branch.
    pub avalanche: u64,
    /// Load and area before.
    pub before: Totals,
    /// Load and area when the rest has relaxed.
    pub after: Totals,
    /// Potential lost \[J\].
    pub energy_lost_j: f64,
}
