//! Accuracy of events, reversals and global solves. That of the path in between is [`crate::asperities::contact::numerics::Accuracy`].

/// Tolerance of the mean penetration of an event, in rms heights: the order of two events, and the step over a fold.
pub const EVENT_TOLERANCE: f64 = 1e-6;

/// Relative tolerance of the load at a reversal; and of its mean penetration, in rms heights, where the load jumps over it.
pub(super) const LOAD_TOLERANCE: f64 = 1e-9;

/// Grid of mean penetrations, in rms heights, on which global solves are exact.
pub(super) const EXACT_GRID: f64 = 0.01;

/// Minimum scale of the path, in rms heights: below it adhesion does not set the scale.
pub(super) const LEAST_SCALE: f64 = 0.02;

/// Limit of the growth of the penetration of a free asperity by all reasons, over the way of the mean penetration.
const STEEPEST_RISE: f64 = 3.0;

/// Distance of a free asperity from its jump-in beyond which it stays farther than `scale` from it while the mean penetration changes by `way`; all \[m\].
pub(super) fn out_of_reach(way: f64, scale: f64) -> f64 {
    STEEPEST_RISE * way.abs() + scale
}

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

/// Largest residual of an equilibrium, relative to the rms height.
pub(crate) const CONVERGED: f64 = 1e-8;
