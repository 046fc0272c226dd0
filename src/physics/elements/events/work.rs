//! Work of the load between equilibria.

/// Jump of the load in a step, relative to its curvature over the step, from which on the load counts as
/// discontinuous. For a load with a limit point (`F² ∝ Δ`) the cubic is worse than the trapezoid from here
/// on.
pub(crate) const DISCONTINUITY: f64 = 1.0 / 3.0;

/// A point of a loop: mean penetration `Δ`, load `F` and stiffness `dF/dΔ`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnLoop {
    /// Mean penetration Δ.
    pub mean_penetration: f64,
    /// Load.
    pub load: f64,
    /// Slope of the load.
    pub stiffness: f64,
}

/// `∫F dΔ` between two points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Work {
    /// By the trapezoid rule.
    pub straight: f64,
    /// By how much that of the cubic through loads and slopes at both ends exceeds it (Hermite); 0 where the
    /// load jumps and its slope changes by more than the load, as at a limit point.
    pub bend: f64,
    /// Largest error of the trapezoid rule where the load jumps in between, which it may do anywhere; else 0.
    pub across: f64,
}

/// Number of parts of a step in which the minimum of the load is searched.
const SEARCHED_PARTS: usize = 32;

/// Minimum load between two points, by the cubic through loads and slopes at both.
#[must_use]
pub fn least_between(start: OnLoop, end: OnLoop) -> f64 {
    let length = end.mean_penetration - start.mean_penetration;
    let (s0, s1) = (start.stiffness * length, end.stiffness * length);
    let rise = end.load - start.load;
    let load = |part: usize| {
        let t = part as f64 / SEARCHED_PARTS as f64;
        start.load + t * (s0 + t * (3.0 * rise - 2.0 * s0 - s1 + t * (s0 + s1 - 2.0 * rise)))
    };
    (0..=SEARCHED_PARTS).map(load).fold(f64::INFINITY, f64::min)
}

/// The work between two points. The load jumps in between, in events or at a limit point, where it differs
/// from the cubic by more than that from a straight line.
///
/// Many small jumps leave the curvature of the load as it is, and without it all errors have the same sign:
/// `bend` is omitted only where the slopes say nothing about the load in between.
#[must_use]
pub fn work_between(start: OnLoop, end: OnLoop) -> Work {
    let length = end.mean_penetration - start.mean_penetration;
    let bend = start.stiffness - end.stiffness;
    let jump = end.load - start.load - 0.5 * (start.stiffness + end.stiffness) * length;
    let jumps = jump.abs() > DISCONTINUITY * (bend * length).abs();
    let steep = (bend * length).abs() > (end.load - start.load).abs();
    Work {
        straight: 0.5 * (start.load + end.load) * length,
        bend: if jumps && steep { 0.0 } else { length * length * bend / 12.0 },
        across: if jumps { 0.5 * (jump * length).abs() } else { 0.0 },
    }
}
