//! Work of the load between equilibria.

/// `∫F dΔ` between two points `(Δ, F)` by the trapezoid rule.
#[must_use]
pub fn work_between(start: (f64, f64), end: (f64, f64)) -> f64 {
    0.5 * (start.1 + end.1) * (end.0 - start.0)
}

/// `∫F dΔ` from `start` to `end` of the parabola through these two points `(Δ, F)` and the one before them; the trapezoid where two of them coincide.
#[must_use]
pub fn work_after(before: (f64, f64), start: (f64, f64), end: (f64, f64)) -> f64 {
    let slope = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1) / (b.0 - a.0);
    let bend = (slope(start, end) - slope(before, start)) / (end.0 - before.0);
    let correction = bend * (end.0 - start.0).powi(3) / 6.0;
    work_between(start, end) - if correction.is_finite() { correction } else { 0.0 }
}
