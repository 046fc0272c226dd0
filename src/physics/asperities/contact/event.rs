//! Events of an equilibrium path.

use crate::cycle::Totals;
use crate::event_kind::EventKind;
use serde::{Deserialize, Serialize};

/// An event with its load, area and energy change.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Kind of event.
    pub kind: EventKind,
    /// Asperity that changes state.
    pub asperity: usize,
    /// Mean penetration Δ \[m\] at the event.
    pub mean_penetration_m: f64,
    /// Number of its avalanche, counted along the branch.
    pub avalanche: u64,
    /// Load and area before the event.
    pub before: Totals,
    /// Load and area after relaxation of the other contacts.
    pub after: Totals,
    /// Decrease of the potential \[J\].
    pub energy_lost_j: f64,
}
