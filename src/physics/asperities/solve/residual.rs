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

    /// The larger of two residuals \[m\], of an asperity. One that is not a number must not pass as a small
    /// one.
    pub(crate) fn or_residual(self, residual_m: f64, asperity: usize) -> Self {
        let residual_m = residual_m.abs();
        if residual_m.is_nan() || residual_m > self.residual_m {
            Self::residual(residual_m, asperity)
        } else {
            self
        }
    }

    /// Another reason, at an asperity.
    pub(crate) fn because(reason: Reason, asperity: usize) -> Self {
        Self { residual_m: f64::NAN, asperity, reason }
    }
}
