//! Reasons to reject an attempt of a path increment.

use crate::physics::PhysicsError;
use crate::physics::contact::transition::Transition;
use crate::physics::solve::residual::NotConverged;

/// Why an increment was rejected.
#[derive(Debug)]
pub(super) enum Rejection {
    /// It is too long, or leads to no equilibrium.
    NotConverged(NotConverged),
    /// These transitions were found too late.
    Late(Vec<Transition>, NotConverged),
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
