//! Events of an equilibrium path.

use super::state::Status;
use crate::cycle::Totals;
use crate::event_kind::{EventKind, SpotStatus};
use serde::{Deserialize, Serialize};

/// An event with its load, area and energy change.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Kind of event.
    pub kind: EventKind,
    /// Asperity that changes state.
    pub asperity: usize,
    /// Its status after the relaxation.
    pub status: SpotStatus,
    /// Kind of the event that causes the relaxation in which it happens.
    pub cause: EventKind,
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

impl From<Status> for SpotStatus {
    fn from(status: Status) -> Self {
        match status {
            Status::Free => Self::Free,
            Status::Contact => Self::Contact,
            Status::Covered { .. } => Self::Covered,
            Status::Merged { .. } => Self::Merged,
        }
    }
}
