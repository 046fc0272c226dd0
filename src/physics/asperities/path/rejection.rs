//! Reasons to reject an attempt of a path increment.

use crate::PhysicsError;
use crate::asperities::solve::residual::NotConverged;

/// Why an increment was rejected.
#[derive(Debug)]
pub(super) enum Rejection {
    /// It is too long, leads to no equilibrium, or an event was found too late.
    NotConverged(NotConverged),
    /// It cannot succeed.
    Failed(PhysicsError),
}

impl From<NotConverged> for Rejection {
    fn from(reason: NotConverged) -> Self {
        Self::NotConverged(reason)
    }
}

impl From<PhysicsError> for Rejection {
    fn from(error: PhysicsError) -> Self {
        Self::Failed(error)
    }
}
