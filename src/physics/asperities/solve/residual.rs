//! Residual of an equilibrium.

use crate::Reason;

/// State without equilibrium: largest residual with its asperity, or another reason.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NotConverged {
    pub(crate) residual_m: f64,
    pub(crate) asperity: usize,
    pub(crate) reason: Reason,
}

impl NotConverged {
    /// Largest residual \[m\] and its asperity.
    pub(crate) fn residual(residual_m: f64, asperity: usize) -> Self {
        Self { residual_m, asperity, reason: Reason::Residual }
    }

    /// Another reason, at an asperity.
    pub(crate) fn because(reason: Reason, asperity: usize) -> Self {
        Self { residual_m: f64::NAN, asperity, reason }
    }
}
