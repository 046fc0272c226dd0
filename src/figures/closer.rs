//! Figures of a single cycle.

use super::FigureError;
use super::axis::Axis;
use super::captions::of_cycle;
use super::curve::{Curve, Stroke, XyPlot};
use super::cycle_loop::{Closer, Landmark, step_of};
use super::drawing::Drawing;
use super::hysteresis::of_branches;
use super::map::map;
use super::panels::Panel;
use super::style::{OTHER, RESULT, THEORY, curve, plot, shade};
use crate::stats::significant;
use crate::store::Frame;
use crate::text::counted;
use ndarray::ArrayView2;
use std::collections::BTreeMap;

/// Points of one scatter, at most: the largest are drawn.
const MOST_POINTS: usize = 2000;

/// Points of a distribution, at most.
const MOST_RANKS: usize = 300;

/// Bars of the histogram of curvatures, at most.
const MOST_BARS: usize = 40;

/// Panels of a single cycle, and the maps of its contact spots. Panels of contact spots that were not kept
/// are omitted.
///
/// # Errors
/// If a table lacks a column.
pub fn closer(
    of: &Closer<'_>,
    heights_m: ArrayView2<'_, f64>,
) -> Result<(Vec<Panel>, Option<Drawing>), FigureError> {
    let kept = of.landmarks()?;
    let branches = branches(of, step_of(&kept, Landmark::Turning))?;
    let panel = |name: &str, plot: XyPlot| panel(name, of_cycle(name, of), plot);
    let whole = of_loop(of.steps, of.max_load)?;
    let branches_of_loop = of_branches(&whole);
    let mut panels = vec![panel("loop", whole)];
    panels.extend(branches_of_loop.into_iter().map(|(name, plot)| panel(name, plot)));
    panels.extend([panel("events", events(of, &branches)?), panel("avalanches", avalanches(of, &branches)?)]);
    let styles = [(Landmark::Turning, RESULT, Stroke::Solid), (Landmark::PullOff, OTHER, Stroke::Dashed)];
    let end = |(landmark, hue, stroke)| step_of(&kept, landmark).map(|step| (landmark, step, hue, stroke));
    let ends: Vec<End> = styles.into_iter().filter_map(end).collect();
    if !ends.is_empty() {
        panels.push(panel("radii", radii(of, &ends)?));
        panels.push(panel("loads", loads(of, &ends)?));
    }
    panels.push(panel("spectrum", spectrum(of)));
    panels.push(panel("summits", summits(of)?));
    Ok((panels, map(of, &kept, heights_m)?))
}

/// A landmark with distributions, its step and how it is drawn.
type End = (Landmark, i64, [u8; 3], Stroke);

fn panel(name: &str, caption: String, plot: XyPlot) -> Panel {
    Panel::alone(name, caption, XyPlot { stem: format!("closer_{name}"), ..plot })
}

/// A branch, and its events as places in their table.
type OfBranch = (&'static str, Vec<usize>);

/// Events of the loop, by branch.
fn branches(of: &Closer<'_>, turning: Option<i64>) -> Result<[OfBranch; 2], FigureError> {
    let (branches, max_loads, steps) =
        (of.events.text("branch")?, of.events.f64_or_null("max_load")?, of.events.i64("step")?);
    // Loading continues beyond a load reversal that is not the last one.
    let turning = turning.unwrap_or(i64::MAX);
    let all = || 0..of.events.row_count();
    let loading = all().filter(|k| branches[*k] == "loading" && steps[*k] <= turning).collect();
    let unloading =
        all().filter(|k| branches[*k] == "unloading" && max_loads[*k] == Some(of.max_load)).collect();
    Ok([("loading", loading), ("unloading", unloading)])
}

/// Hysteresis loop: load over penetration, up to the load reversal and back.
pub(super) fn of_loop(steps: &Frame, max_load: f64) -> Result<XyPlot, FigureError> {
    let (branches, max_loads) = (steps.text("branch")?, steps.f64_or_null("max_load")?);
    let (approaches, loads) = (steps.f64("penetration")?, steps.f64("load")?);
    let points = |fits: &dyn Fn(usize) -> bool| -> Vec<(f64, f64)> {
        (0..branches.len()).filter(|k| fits(*k)).map(|k| (approaches[k], loads[k])).collect()
    };
    let mut unloading = points(&|k| branches[k] == "unloading" && max_loads[k] == Some(max_load));
    // The first step of unloading by boundary elements comes after the reversal.
    let reversal = steps.f64_or_null("reversal_load")?.iter().position(|load| *load == Some(max_load));
    if let Some(point) = reversal
        .map(|k| (approaches[k], loads[k]))
        .filter(|point| unloading.first().is_some_and(|first| first.0 < point.0))
    {
        unloading.insert(0, point);
    }
    // Loading continues beyond a load reversal that is not the last one.
    let most = unloading.iter().map(|point| point.0).fold(f64::NEG_INFINITY, f64::max);
    let loading = points(&|k| branches[k] == "loading" && approaches[k] <= most);
    let all = || loading.iter().chain(&unloading);
    let (x, y) = (
        Axis::holding("Δ/h_{rms}", all().map(|point| point.0), false),
        Axis::holding("F/(E^{*}A_{0})", all().map(|point| point.1), true).with_headroom(0.1),
    );
    let curves = vec![
        curve("loading", "", loading.clone(), shade(RESULT, 0, 1), Stroke::Dashed),
        curve("unloading", "", unloading.clone(), shade(RESULT, 0, 1), Stroke::Solid),
    ];
    Ok(plot(
        String::new(),
        x,
        y,
        curves,
        &[("loading", RESULT, Stroke::Dashed), ("unloading", RESULT, Stroke::Solid)],
    ))
}

/// Energy that each event lost, over the approach.
fn events(of: &Closer<'_>, branches: &[OfBranch; 2]) -> Result<XyPlot, FigureError> {
    let (approaches, energies) = (of.events.f64("approach_m")?, of.events.f64("energy_lost_j")?);
    let (mut curves, mut all, mut drawn) = (Vec::new(), 0, 0);
    for (name, rows) in branches {
        let mut lost: Vec<(f64, f64)> = rows
            .iter()
            .map(|k| (approaches[*k] / of.rms_height_m, energies[*k] / of.energy_j))
            .filter(|point| point.1 > 0.0)
            .collect();
        all += lost.len();
        lost.sort_by(|u, v| v.1.total_cmp(&u.1).then(u.0.total_cmp(&v.0)));
        lost.truncate(MOST_POINTS);
        drawn += lost.len();
        let stroke = if *name == "loading" { Stroke::Diamonds } else { Stroke::Points };
        curves.push(curve(name, "", lost, shade(RESULT, 0, 1), stroke));
    }
    let points = || curves.iter().flat_map(|curve: &Curve| curve.points.iter());
    let (x, y) = (
        Axis::holding("Δ/h_{rms}", points().map(|point| point.0), false),
        Axis::of_decades("dissipated energy/(E^{*}A_{0}h_{rms})", points().map(|point| point.1))
            .with_headroom(0.12),
    );
    let title = if drawn < all {
        format!("the largest {drawn} of {all} dissipative events")
    } else {
        counted(all, "dissipative event")
    };
    Ok(plot(
        title,
        x,
        y,
        curves,
        &[("loading", RESULT, Stroke::Diamonds), ("unloading", RESULT, Stroke::Points)],
    ))
}

/// Number of avalanches with at least as many events.
fn avalanches(of: &Closer<'_>, branches: &[OfBranch; 2]) -> Result<XyPlot, FigureError> {
    let ids = of.events.i64("avalanche_id")?;
    let mut curves = Vec::new();
    let mut total = 0;
    for (name, rows) in branches {
        let mut sizes: BTreeMap<i64, usize> = BTreeMap::new();
        for k in rows {
            *sizes.entry(ids[*k]).or_default() += 1;
        }
        let mut sizes: Vec<usize> = sizes.into_values().collect();
        sizes.sort_unstable();
        total += sizes.len();
        let mut points: Vec<(f64, f64)> =
            sizes.iter().enumerate().map(|(k, size)| (*size as f64, (sizes.len() - k) as f64)).collect();
        points.dedup_by_key(|point| point.0);
        let stroke = if *name == "loading" { Stroke::Dashed } else { Stroke::Solid };
        curves.push(Curve { marked: true, ..curve(name, "", points, shade(RESULT, 0, 1), stroke) });
    }
    let points = || curves.iter().flat_map(|curve: &Curve| curve.points.iter());
    let (x, y) = (
        Axis::of_decades("events per avalanche, s", points().map(|point| point.0)),
        Axis::of_decades("avalanches with at least s events", points().map(|point| point.1)),
    );
    Ok(plot(
        counted(total, "avalanche"),
        x,
        y,
        curves,
        &[("loading", RESULT, Stroke::Dashed), ("unloading", RESULT, Stroke::Solid)],
    ))
}

/// Cumulative distribution of a value of each contact spot at the load reversal and at the pull-off.
fn distribution(
    of: &Closer<'_>,
    ends: &[End],
    label: &str,
    value: impl Fn(usize) -> Option<f64>,
) -> Result<XyPlot, FigureError> {
    let (steps, states) = (of.contacts.i64("step")?, of.contacts.text("state")?);
    let (mut curves, mut key) = (Vec::new(), Vec::new());
    for (landmark, step, hue, stroke) in ends.iter().copied() {
        let mut values: Vec<f64> = (0..steps.len())
            .filter(|k| steps[*k] == step && states[*k] == "contact")
            .filter_map(&value)
            .collect();
        values.sort_by(f64::total_cmp);
        let count = values.len();
        curves.push(curve(landmark.words(), "", cumulative(&values), shade(hue, 0, 1), stroke));
        key.push((format!("{}: {}", landmark.words(), counted(count, "contact spot")), hue, stroke));
    }
    let points = || curves.iter().flat_map(|curve: &Curve| curve.points.iter());
    let (x, y) = (
        Axis::holding(label, points().map(|point| point.0), false),
        Axis::holding("cumulative fraction of contact spots", [0.0, 1.0], true).with_headroom(0.16),
    );
    let key: Vec<(&str, [u8; 3], Stroke)> =
        key.iter().map(|(text, hue, stroke)| (text.as_str(), *hue, *stroke)).collect();
    Ok(plot(String::new(), x, y, curves, &key))
}

/// The share of values below: a step at each of them, or, of many, a line through evenly spaced ranks.
fn cumulative(ordered: &[f64]) -> Vec<(f64, f64)> {
    let count = ordered.len();
    if count <= MOST_RANKS {
        let share = |rank: usize| rank as f64 / count as f64;
        return ordered
            .iter()
            .enumerate()
            .flat_map(|(rank, value)| [(*value, share(rank)), (*value, share(rank + 1))])
            .collect();
    }
    let rank = |k: usize| (2 * k + 1) * count / (2 * MOST_RANKS);
    (0..MOST_RANKS).map(rank).map(|at| (ordered[at], (at as f64 + 0.5) / count as f64)).collect()
}

fn radii(of: &Closer<'_>, ends: &[End]) -> Result<XyPlot, FigureError> {
    let radii = of.contacts.f64("contact_radius_m")?;
    distribution(of, ends, "contact radius/L", |k| Some(radii[k] / of.length_m))
}

fn loads(of: &Closer<'_>, ends: &[End]) -> Result<XyPlot, FigureError> {
    let (loads, asperities, radii) =
        (of.contacts.f64("load_n")?, of.contacts.i64("asperity_id")?, of.asperities.f64("radius_m")?);
    if of.pull_off_n_m == 0.0 {
        return distribution(of, ends, "normal load of a contact spot [N]", |k| Some(loads[k]));
    }
    // Merged contacts have numbers beyond those of the asperities, and no pull-off force of one asperity.
    let own = |k: usize| {
        usize::try_from(asperities[k])
            .ok()
            .and_then(|id| radii.get(id))
            .map(|radius| of.pull_off_n_m * radius)
    };
    distribution(of, ends, "normal load/pull-off force of the asperity", |k| own(k).map(|own| loads[k] / own))
}

/// The realised spectrum, and the target at the same rms height.
fn spectrum(of: &Closer<'_>) -> XyPlot {
    // Below the resolution of the transform there is rounding alone.
    let most = of.found.iter().map(|point| point.1).fold(0.0, f64::max);
    let found: Vec<(f64, f64)> = of.found.iter().filter(|point| point.1 > 1e-14 * most).copied().collect();
    // The target lies on the realised spectrum, and is painted over it.
    let curves = vec![
        Curve { marked: true, ..curve("realised", "", found, shade(RESULT, 0, 1), Stroke::Solid) },
        curve("target", "", of.asked.to_vec(), shade(THEORY, 0, 1), Stroke::Dashed),
    ];
    let points = || curves.iter().flat_map(|curve: &Curve| curve.points.iter());
    let (x, y) = (
        Axis::of_decades("q/q_{L}", points().map(|point| point.0)),
        Axis::of_decades("C q_{L}^{2}/h_{rms}^{2}", points().map(|point| point.1)).with_headroom(0.06),
    );
    let target = of.asked_factor.map(|factor| format!("target: {} × Eq 10", significant(factor, 3)));
    let mut key = vec![("realised", RESULT, Stroke::Solid)];
    key.extend(target.as_deref().map(|text| (text, THEORY, Stroke::Dashed)));
    plot(String::new(), x, y, curves, &key)
}

/// Curvatures of the summits over Nayak's density.
fn summits(of: &Closer<'_>) -> Result<XyPlot, FigureError> {
    let curvatures: Vec<f64> =
        of.asperities.f64("curvature_1_m")?.iter().map(|k| k / of.curvature_1_m).collect();
    let most = curvatures.iter().copied().fold(0.0, f64::max).max(1.0);
    // Rule of Rice.
    let wanted = (2.0 * (curvatures.len() as f64).cbrt()).ceil() as usize;
    let mut counts = vec![0usize; wanted.clamp(1, MOST_BARS)];
    let width = most / counts.len() as f64;
    for curvature in &curvatures {
        let place = ((curvature / width) as usize).min(counts.len() - 1);
        counts[place] += 1;
    }
    let unit = 1.0 / (width * curvatures.len().max(1) as f64);
    // Its outline: each bar from its left to its right end.
    let bars = counts
        .iter()
        .enumerate()
        .flat_map(|(k, count)| [k, k + 1].map(|at| (at as f64 * width, *count as f64 * unit)));
    let curves = vec![
        curve("nayak", "", of.nayak.to_vec(), shade(THEORY, 0, 1), Stroke::Dashed),
        curve("realised", "", bars.collect(), shade(RESULT, 0, 1), Stroke::Solid),
    ];
    let points = || curves.iter().flat_map(|curve: &Curve| curve.points.iter());
    let (x, y) = (
        Axis::holding("summit curvature/(m_{4}/3)^{1/2}", points().map(|point| point.0), true),
        Axis::holding("probability density", points().map(|point| point.1), true).with_headroom(0.1),
    );
    let [found, nayak] = of.densities_1_m2.map(|density| density * of.length_m * of.length_m);
    let title = format!("{}; Nayak: {nayak:.0}", counted(found.round() as usize, "summit"));
    Ok(plot(
        title,
        x,
        y,
        curves,
        &[("this surface", RESULT, Stroke::Solid), ("Nayak, Eq A2", THEORY, Stroke::Dashed)],
    ))
}
