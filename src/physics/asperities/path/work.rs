//! Work of the load of one contact along a path.

use crate::asperities::contact::Problem;
use crate::asperities::solve::local::CurveState;
use crate::asperities::solve::trace::PenetrationTrace;
use crate::jkr::Asperity;
use crate::math::quadrature::{gauss, gauss_at_once, hermite, hermite_slope};

/// `∫F dΔ` of a contact between two states, with the penetration as a cubic in the mean penetration \[J\].
pub(super) fn work(problem: &Problem, i: usize, from: PenetrationTrace, to: PenetrationTrace) -> f64 {
    let asperity = &problem.asperities[i];
    let span = to.at - from.at;
    if span == 0.0 {
        return 0.0;
    }
    let [start, end] = [from, to].map(|trace| trace.penetration_or_nan());
    gauss_at_once(|points| {
        let penetrations = points.map(|p| hermite(p, start, end, from.rate * span, to.rate * span));
        Asperity::radii_ahead([asperity; 4], penetrations).map(|a| asperity.load(a) * span)
    })
}

/// `∫F dΔ` of a member of a local problem along a solution curve, with radius and mean penetration as cubics
/// in the radius that was followed \[J\].
pub(super) fn work_along(problem: &Problem, i: usize, member: usize, curve: &[CurveState]) -> f64 {
    let asperity = &problem.asperities[i];
    let part = |pair: &[CurveState]| {
        let (from, to, span) = (&pair[0], &pair[1], pair[1].at - pair[0].at);
        gauss(|p| {
            let [start, end] = [from, to].map(|state| (state.radius[member], state.direction[member] * span));
            let a = hermite(p, start.0, end.0, start.1, end.1);
            asperity.load(a)
                * hermite_slope(
                    p,
                    from.mean_penetration,
                    to.mean_penetration,
                    from.slope * span,
                    to.slope * span,
                )
        })
    };
    curve.windows(2).map(part).sum()
}

/// `∫s² dΔ` along a solution curve, or a way \[m\] without one, on which s rises from 0 to 1 in proportion to
/// the radius that was followed, or to Δ \[m\].
pub(super) fn mean_square(curve: &[CurveState], way: f64) -> f64 {
    let (Some(first), Some(last)) = (curve.first(), curve.last()) else { return way / 3.0 };
    let whole = last.at - first.at;
    if whole == 0.0 {
        return way / 3.0;
    }
    let part = |pair: &[CurveState]| {
        let span = pair[1].at - pair[0].at;
        gauss(|p| {
            let s = (pair[0].at + p * span - first.at) / whole;
            s * s
                * hermite_slope(
                    p,
                    pair[0].mean_penetration,
                    pair[1].mean_penetration,
                    pair[0].slope * span,
                    pair[1].slope * span,
                )
        })
    };
    curve.windows(2).map(part).sum()
}
