//! Accuracy of a path.
//!
//! Lengths are in units of the scale of the path, the mean jump-off penetration rounded down. Halving all of them changes no result beyond
//! the digits that the tests state.

/// Maximum root-mean-square predictor residual at the end of an increment.
pub const DRIFT: f64 = 1e-2;

/// Maximum predictor residual of one contact there.
pub(super) const WORST_RESIDUAL: f64 = 1e-1;

/// Maximum lateness of a transition that is found there.
pub(super) const LATENESS: f64 = 5e-3;

/// Maximum pending displacement of a contact.
pub(super) const PENDING: f64 = 5e-3;

/// Residual of a global solve whose state is not written down.
pub(super) const SUFFICIENT: f64 = 2e-5;

/// Tolerance of the mean penetration of an event, in rms heights: the order of two events, and the step over a fold.
pub const EVENT_TOLERANCE: f64 = 1e-6;

/// Relative tolerance of the load at a reversal; and of its mean penetration, in rms heights, where the load jumps over it.
pub(super) const LOAD_TOLERANCE: f64 = 1e-9;

/// Grid of mean penetrations, in rms heights, on which global solves are exact.
pub(super) const EXACT_GRID: f64 = 0.01;

/// Longest increment.
pub(super) const LONGEST_INCREMENT: f64 = 0.05;

/// Longest increment where local problems hold all contacts: nothing is neglected then, and the work is to be as exact as the events.
pub(super) const FINE_INCREMENT: f64 = 0.00625;

/// Minimum scale of the path, in rms heights: below it adhesion does not set the scale.
pub(super) const LEAST_SCALE: f64 = 0.02;

/// Precision of a global solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Precision {
    /// To 1e-10 of the rms height: the state may be written down.
    Exact,
    /// To [`SUFFICIENT`]: the difference is found by the next solve.
    Sufficient,
}
