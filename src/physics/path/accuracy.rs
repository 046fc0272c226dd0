//! Accuracy of events, reversals and global solves. That of the path in between is [`crate::physics::contact::numerics::Accuracy`].

/// Tolerance of the mean penetration of an event, in rms heights: the order of two events, and the step over a fold.
pub const EVENT_TOLERANCE: f64 = 1e-6;

/// Relative tolerance of the load at a reversal; and of its mean penetration, in rms heights, where the load jumps over it.
pub(super) const LOAD_TOLERANCE: f64 = 1e-9;

/// Grid of mean penetrations, in rms heights, on which global solves are exact.
pub(super) const EXACT_GRID: f64 = 0.01;

/// Minimum scale of the path, in rms heights: below it adhesion does not set the scale.
pub(super) const LEAST_SCALE: f64 = 0.02;

/// Precision of a global solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Precision {
    /// To the tolerance of an equilibrium: the state may be written down.
    Exact,
    /// To that of the path: the difference is found by the next solve.
    Sufficient,
}
