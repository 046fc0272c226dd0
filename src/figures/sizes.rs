//! Panel F: number of avalanches per surface with at least a dissipated energy, over all surfaces of a case.

use super::FigureError;
use super::axis::Axis;
use super::curve::{Curve, Stroke, XyPlot};
use super::paths::{Parts, facet_title, facets, key_of, noted, unnamed, with_loading};
use super::style::curve;
use super::sweep::{Member, Sweep, Tables};
use super::units::Units;

/// Points of a distribution, at most.
const MOST_RANKS: usize = 200;

/// The distributions of every member, loading and unloading apart: one plot, or one for each value of the
/// first parameter where several vary. Loading is common to all loads of a case and is drawn with the
/// largest. Nothing without the table of avalanches or without avalanches.
pub(super) fn sizes(tables: &Tables<'_>, sweep: &Sweep, units: Units) -> Result<Vec<XyPlot>, FigureError> {
    let Some(table) = tables.avalanches else { return Ok(Vec::new()) };
    let column = if units == Units::Si { "energy_lost_j" } else { "energy_lost" };
    let (ids, branches) = (table.text("case_id")?, table.text("branch")?);
    let (loads, energies) = (table.f64_or_null("max_load")?, table.f64(column)?);
    let done = tables.cases.i64("done_count")?;
    let of = |member: &Member, branch: &str, load: Option<f64>, stroke: Stroke| -> Curve {
        let fits = |k: &usize| ids[*k] == member.case_id && branches[*k] == branch && loads[*k] == load;
        let lost = (0..ids.len()).filter(fits).map(|k| energies[k]).filter(|energy| *energy > 0.0).collect();
        let points = at_least(lost, done[member.row]);
        curve(branch, &member.label, points, member.colour.clone(), stroke)
    };
    let of_group = |members: Vec<&Member>| {
        let loading = with_loading(&members).map(|member| of(member, "loading", None, Stroke::Dashed));
        let mut curves: Vec<Curve> = loading.collect();
        let back = |member: &&Member| of(member, "unloading", Some(member.max_load), Stroke::Solid);
        let unloading: Vec<Curve> = members.iter().map(back).collect();
        let ends: Vec<Curve> = unloading.iter().map(|back| at_largest(back, &curves)).collect();
        let notes = noted(sweep, members.iter().copied(), &ends);
        curves.extend(unloading);
        curves.retain(|curve| !curve.points.is_empty());
        (facet_title(sweep, &members), curves, notes)
    };
    let groups: Vec<Parts> = facets(sweep).into_iter().map(of_group).collect();
    let points = || groups.iter().flat_map(|(_, curves, _)| curves).flat_map(|curve| curve.points.iter());
    if points().next().is_none() {
        return Ok(Vec::new());
    }
    let label = if units == Units::Si { "energy [J]" } else { "energy/(E^{*}A_{0}h_{rms})" };
    let x = Axis::of_decades(label, points().map(|point| point.0));
    let y = Axis::of_decades("avalanches per surface", points().map(|point| point.1)).with_headroom(0.06);
    let plot = |(title, curves, notes): Parts| {
        let key = key_of(&curves);
        XyPlot { title, notes, ..unnamed([x.clone(), y.clone()], curves, key) }
    };
    Ok(groups.into_iter().map(plot).collect())
}

/// A curve of the one point at which its name begins: the largest value of it and of loading.
fn at_largest(back: &Curve, loading: &[Curve]) -> Curve {
    let of_it = loading.iter().filter(|curve| curve.of == back.of).chain([back]);
    let last = of_it.filter_map(|curve| curve.points.last()).max_by(|a, b| a.0.total_cmp(&b.0));
    Curve { points: last.copied().into_iter().collect(), ..back.clone() }
}

/// Number per surface of values of at least each value; of many values, some evenly spaced in the logarithm
/// of the rank.
fn at_least(mut values: Vec<f64>, surfaces: i64) -> Vec<(f64, f64)> {
    values.sort_by(|a, b| b.total_cmp(a));
    let count = values.len();
    let mut ranks: Vec<usize> = if count <= MOST_RANKS {
        (1..=count).collect()
    } else {
        let rank = |k: usize| (count as f64).powf(k as f64 / (MOST_RANKS - 1) as f64).round() as usize;
        (0..MOST_RANKS).map(rank).collect()
    };
    ranks.dedup();
    ranks.into_iter().rev().map(|rank| (values[rank - 1], rank as f64 / surfaces.max(1) as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn law_counts_fall_with_the_size() {
        assert_eq!(at_least(vec![2.0, 1.0, 4.0, 2.0], 2), [(1.0, 2.0), (2.0, 1.5), (2.0, 1.0), (4.0, 0.5)]);
        let many = at_least((1..=5000).map(f64::from).collect(), 1);
        assert!(
            many.len() <= MOST_RANKS && many[0] == (1.0, 5000.0) && many[many.len() - 1] == (5000.0, 1.0)
        );
        assert!(many.iter().all(|(value, count)| value + count == 5001.0));
    }
}
