//! Work of the load along a path, of one contact or of all of them.
//!
//! With a soft spring in series the load follows the spring, `F = (D − Δ)/c`: an error of a penetration
//! between two states is one of Δ, and not of the load times its stiffness. The work of all contacts is
//! therefore integrated from the load itself, and that of the spring is exact: `½c[F²]`.

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

/// Load of all contacts \[N\], and its derivative to the displacement of the machine \[N/m\].
fn load_of_all(problem: &Problem, traces: impl Iterator<Item = (usize, PenetrationTrace)>) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (i, trace) in traces {
        let asperity = &problem.asperities[i];
        let a = asperity.radius_ahead(trace.penetration_or_nan());
        sums[0] += asperity.load(a);
        sums[1] += asperity.load_slope(a) * trace.speed(asperity, a);
    }
    sums
}

/// Rate of a penetration from which on its radius is the better parameter: near a limit point it is infinite.
const RATE_OF_CURVE: f64 = 1.2;

/// Two states as a curve in the radius of the contact that is fastest at the end, if that is fast; nothing
/// where that radius turns back.
fn short_curve(
    problem: &Problem,
    traces: &[(usize, PenetrationTrace, PenetrationTrace)],
) -> Option<[CurveState; 2]> {
    let fastest = (0..traces.len()).max_by(|i, j| traces[*i].2.rate.total_cmp(&traces[*j].2.rate))?;
    if traces[fastest].2.rate < RATE_OF_CURVE {
        return None;
    }
    let curve = [true, false].map(|is_first| {
        let state = |(i, from, to): &(usize, PenetrationTrace, PenetrationTrace)| {
            let (asperity, trace) = (&problem.asperities[*i], if is_first { from } else { to });
            let a = asperity.radius_ahead(trace.penetration_or_nan());
            (a, trace.speed(asperity, a), trace.at)
        };
        let (at, speed, mean_penetration) = state(&traces[fastest]);
        CurveState {
            radius: traces.iter().map(|trace| state(trace).0).collect(),
            direction: traces.iter().map(|trace| state(trace).1 / speed).collect(),
            mean_penetration,
            slope: 1.0 / speed,
            at,
        }
    });
    let [from, to] = &curve;
    let way = (to.mean_penetration - from.mean_penetration) / (to.at - from.at);
    (way * from.slope > 0.0 && way * to.slope > 0.0).then_some(curve)
}

/// `∫F dD` of all contacts between two states without an event, with the load as a cubic in the displacement
/// D of the machine, or in a radius near a limit point \[J\].
pub(super) fn work_of_all(problem: &Problem, traces: &[(usize, PenetrationTrace, PenetrationTrace)]) -> f64 {
    let Some((_, first, last)) = traces.first() else { return 0.0 };
    let span = last.at - first.at;
    if span == 0.0 {
        return 0.0;
    }
    if let Some(curve) = short_curve(problem, traces) {
        let members: Vec<usize> = traces.iter().map(|(i, ..)| *i).collect();
        return work_of_all_along(problem, &members, &curve);
    }
    let start = load_of_all(problem, traces.iter().map(|(i, from, _)| (*i, *from)));
    let end = load_of_all(problem, traces.iter().map(|(i, _, to)| (*i, *to)));
    span * (0.5 * (start[0] + end[0]) + span * (start[1] - end[1]) / 12.0)
}

/// `∫F dD` of the members of a local problem of all contacts along a solution curve \[J\]: `∫F dΔ`, with load
/// and Δ as cubics in the radius that was followed, and `½c[F²]`.
pub(super) fn work_of_all_along(problem: &Problem, members: &[usize], curve: &[CurveState]) -> f64 {
    let compliance = problem.field.uniform();
    let loads = |state: &CurveState| {
        let all = members.iter().zip(&state.radius).zip(&state.direction);
        all.fold([0.0; 2], |[load, slope], ((i, a), speed)| {
            let asperity = &problem.asperities[*i];
            [load + asperity.load(*a), slope + asperity.load_slope(*a) * speed]
        })
    };
    let part = |pair: &[CurveState]| {
        let (from, to, span) = (&pair[0], &pair[1], pair[1].at - pair[0].at);
        let [start, end] = [from, to].map(loads);
        let ends = [(from, start), (to, end)].map(|(state, [load, slope])| {
            (state.mean_penetration - compliance * load, (state.slope - compliance * slope) * span)
        });
        let contact = gauss(|p| {
            hermite(p, start[0], end[0], start[1] * span, end[1] * span)
                * hermite_slope(p, ends[0].0, ends[1].0, ends[0].1, ends[1].1)
        });
        contact + 0.5 * compliance * (end[0] * end[0] - start[0] * start[0])
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
