//! Residual of an equilibrium and the limit of a step towards it.

use crate::physics::Reason;

/// Greatest relative change of a radius in one iteration, here as in Newton's method.
pub(crate) const STRIDE: f64 = 0.2;

/// A state that is not in equilibrium: the worst residual and its asperity, and what else prevents an equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NotConverged {
    pub(crate) residual_m: f64,
    pub(crate) asperity: usize,
    pub(crate) reason: Reason,
}

impl NotConverged {
    /// The worst residual \[m\] and its asperity.
    pub(crate) fn residual(residual_m: f64, asperity: usize) -> Self {
        Self { residual_m, asperity, reason: Reason::Residual }
    }

    /// Another reason, at an asperity.
    pub(crate) fn because(reason: Reason, asperity: usize) -> Self {
        Self { residual_m: f64::NAN, asperity, reason }
    }
}
