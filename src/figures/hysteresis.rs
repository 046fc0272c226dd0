//! Panels of the two branches of a loop: their difference, and the tensile part.

use super::axis::Axis;
use super::curve::{Stroke, XyPlot};
use super::style::{NEUTRAL, RESULT, curve, plot, shade};

/// Upper end of the tensile part, in pull-off forces.
const ABOVE: f64 = 0.5;

/// From the plot of a loop, whose first curves are loading and unloading: the load of loading less that of
/// unloading (`hysteresis`), and where the load is tensile both branches (`tension`), with their names.
pub(super) fn of_branches(of: &XyPlot) -> Vec<(&'static str, XyPlot)> {
    let [loading, unloading, ..] = &of.curves[..] else { return Vec::new() };
    if loading.points.is_empty() || unloading.points.is_empty() {
        return Vec::new();
    }
    let (up, down) = (loading.points.as_slice(), unloading.points.as_slice());
    let mut plots = vec![("hysteresis", difference(of, up, down))];
    plots.extend(tension(of, up, down).map(|plot| ("tension", plot)));
    plots
}

fn difference(of: &XyPlot, up: &[(f64, f64)], down: &[(f64, f64)]) -> XyPlot {
    let points: Vec<(f64, f64)> = on_both(up, down).into_iter().map(|(x, up, down)| (x, up - down)).collect();
    let y =
        Axis::holding("(F_{loading} − F_{unloading})/(E^{*}A_{0})", points.iter().map(|point| point.1), true);
    let line = curve("hysteresis", "", points, shade(RESULT, 0, 1), Stroke::Solid);
    plot(String::new(), of.x.clone(), y, vec![line], &[])
}

/// The part of both branches below half the pull-off force; nothing without tension.
fn tension(of: &XyPlot, up: &[(f64, f64)], down: &[(f64, f64)]) -> Option<XyPlot> {
    let lowest = down.iter().map(|point| point.1).fold(0.0, f64::min);
    let part = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
        points.iter().copied().filter(|point| point.1 <= -ABOVE * lowest).collect()
    };
    let (up, down) = (part(up), part(down));
    if lowest == 0.0 || down.len() < 2 {
        return None;
    }
    let all = || up.iter().chain(&down);
    let axes = [
        Axis::holding(&of.x.label, all().map(|point| point.0), false),
        Axis::holding(&of.y.label, all().map(|point| point.1), false).with_headroom(0.1),
    ];
    let (left, right) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, r), p| (l.min(p.0), r.max(p.0)));
    let colour = shade(RESULT, 0, 1);
    let curves = vec![
        curve("loading", "", up.clone(), colour.clone(), Stroke::Dashed),
        curve("unloading", "", down.clone(), colour, Stroke::Solid),
        curve("zero", "", vec![(left, 0.0), (right, 0.0)], shade(NEUTRAL, 0, 1), Stroke::Dotted),
    ];
    let [x, y] = axes;
    let key = [("loading", RESULT, Stroke::Dashed), ("unloading", RESULT, Stroke::Solid)];
    Some(plot(String::new(), x, y, curves, &key))
}

/// Loads of two branches at the penetrations of both, in ascending order. Before the first contact and after
/// the last separation the load is zero.
pub(super) fn on_both(loading: &[(f64, f64)], unloading: &[(f64, f64)]) -> Vec<(f64, f64, f64)> {
    let ordered = |points: &[(f64, f64)]| {
        let mut points = points.to_vec();
        points.sort_by(|u, v| u.0.total_cmp(&v.0));
        points
    };
    let (up, down) = (ordered(loading), ordered(unloading));
    let mut at: Vec<f64> = up.iter().chain(&down).map(|point| point.0).collect();
    at.sort_by(f64::total_cmp);
    at.dedup();
    at.into_iter().map(|x| (x, between(&up, x), between(&down, x))).collect()
}

/// The load at a penetration, linear between the points of a branch, 0 before the first one and that of the
/// last one after it.
fn between(points: &[(f64, f64)], x: f64) -> f64 {
    let next = points.partition_point(|point| point.0 < x);
    match (next.checked_sub(1).and_then(|before| points.get(before)), points.get(next)) {
        (_, Some(point)) if point.0 == x => point.1,
        (Some(from), Some(to)) => from.1 + (to.1 - from.1) * (x - from.0) / (to.0 - from.0),
        (Some(last), None) => last.1,
        (None, _) => 0.0,
    }
}
