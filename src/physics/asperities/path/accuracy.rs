//! Accuracy of events, reversals and global solves. That of the path in between is [`crate::asperities::contact::numerics::Accuracy`].

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
