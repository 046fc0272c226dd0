//! Precision of a global solve.

use crate::asperities::field::SumPrecision;

/// Precision of a global solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Precision {
    /// To the tolerance of an equilibrium: the state may be written down.
    Exact,
    /// To that of the path: the difference is found by the next solve.
    Sufficient,
}

impl Precision {
    /// Precision of the sums over contacts.
    pub(crate) fn of_sums(self) -> SumPrecision {
        match self {
            Self::Exact => SumPrecision::Full,
            Self::Sufficient => SumPrecision::Intermediate,
        }
    }
}
