//! Arrival of a path at the mean penetration of a global solve.

/// Arrival of the contact at the mean penetration at which it is corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arrival {
    /// By a jump at this mean penetration: it followed its predictors up to here.
    Jump,
    /// By an increment, along which the difference to the predictors grew.
    Increment,
    /// By an increment; a solution too far from the predictors is rejected.
    CheckedIncrement,
}
