//! Work of the load between equilibria.

/// Jump of the load in a step, relative to its curvature over the step, from which on slopes are no basis for an integral.
const JUMP: f64 = 0.5;

/// A point of a loop: approach `Δ`, load `F` and stiffness `dF/dΔ`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnLoop {
    /// Approach Δ.
    pub approach: f64,
    /// Load.
    pub load: f64,
    /// Slope of the load.
    pub stiffness: f64,
}

/// `∫F dΔ` between two points by the trapezoid rule, and by how much that of the cubic through loads and slopes at both ends exceeds it (Hermite). The
/// second is 0 where the load jumps in between, as in an event or at a limit point.
#[must_use]
pub fn work_between(start: OnLoop, end: OnLoop) -> (f64, f64) {
    let length = end.approach - start.approach;
    let bend = start.stiffness - end.stiffness;
    let jump = end.load - start.load - 0.5 * (start.stiffness + end.stiffness) * length;
    let smooth = jump.abs() <= JUMP * (bend * length).abs();
    (0.5 * (start.load + end.load) * length, if smooth { length * length * bend / 12.0 } else { 0.0 })
}
