//! Loading and unloading paths, averaged over realizations.

use super::cycle::Cycle;
use super::realizations::{case_of, identity};
use super::rows::{Rows, Value};
use super::student::Sample;
use super::walk::{COMPRESSION_STATIONS, Point, STATIONS, Walk, tension_fraction};
use super::{CaseInput, CycleInput, Given, StatsError};
use crate::schema::CURVES;
use crate::store::Frame;

/// Averages the branches of each case at common stations. Rows are ordered by case, branch, load reversal and
/// station, independently of the order of the inputs.
///
/// Each branch is read by [`Walk::at`]: at the first crossing of a load on the way from the load reversal,
/// with the path between two steps linear. From the load reversal to zero load, all realizations have the
/// same loads. Below zero the stations are equal fractions of the maximum tension of each realization on that
/// branch, and `load` is the mean of their loads. The averaged unloading path therefore ends at the mean
/// pull-off, and no realization is missing before it. The path after the pull-off is omitted. Without tension
/// there are no stations below zero.
///
/// One loading branch serves every load reversal: it ends at the largest one. `grid_index` follows the path
/// on both branches: loading begins at the lowest tension of loading, unloading at the load reversal.
/// Stations that no realization reaches have no row.
///
/// # Errors
/// If a table of steps cannot be read, or if a cycle names an unknown case.
pub fn curves(cases: &[CaseInput], cycles: &[CycleInput]) -> Result<Frame, StatsError> {
    let mut ordered: Vec<(&CaseInput, &CycleInput)> = Vec::new();
    for input in cycles {
        ordered.push((case_of(cases, input)?, input));
    }
    ordered.sort_by(|a, b| a.0.case_id.cmp(&b.0.case_id).then(a.1.realization.cmp(&b.1.realization)));
    let mut rows = Rows::of(&CURVES);
    for of_case in ordered.chunk_by(|a, b| a.0.case_id == b.0.case_id) {
        push_case(&mut rows, of_case)?;
    }
    rows.build()
}

/// The walks of all realizations of one case on one branch.
struct Bundle {
    /// Nothing while loading.
    max_load: Option<f64>,
    /// The load at which the walks begin.
    from: f64,
    walks: Vec<Walk>,
}

fn push_case(rows: &mut Rows, of_case: &[(&CaseInput, &CycleInput)]) -> Result<(), StatsError> {
    let mut bundles: Vec<Bundle> = Vec::new();
    let mut add = |max_load: Option<f64>, from: f64, walk: Walk| match bundles
        .iter_mut()
        .find(|bundle| bundle.max_load == max_load)
    {
        Some(bundle) => {
            bundle.from = bundle.from.max(from);
            bundle.walks.push(walk);
        }
        None => bundles.push(Bundle { max_load, from, walks: vec![walk] }),
    };
    for (_, input) in of_case {
        let cycle = Cycle::read(&input.steps)?;
        let points: Vec<Point> = cycle.loading.points().collect();
        for (at, (max_load, unloading)) in cycle.unloading.iter().enumerate() {
            let row = cycle.turning_row(input, *max_load)?;
            if at + 1 == cycle.unloading.len() {
                add(None, *max_load, exact(cycle.loading.backwards_from(row), *max_load));
            }
            add(
                Some(*max_load),
                *max_load,
                exact(unloading.onwards_from(points.get(row).copied()), *max_load),
            );
        }
    }
    bundles.sort_by(|a, b| a.max_load.is_some().cmp(&b.max_load.is_some()).then(a.from.total_cmp(&b.from)));
    if let Some((case, _)) = of_case.first() {
        for bundle in &bundles {
            push_bundle(rows, &identity(case), bundle);
        }
    }
    Ok(())
}

/// A walk whose first load is the turning point's exactly: solved to 1e-9, it could else lie just below the
/// first station and miss it.
fn exact(mut walk: Walk, max_load: f64) -> Walk {
    if let Some(first) = walk.0.first_mut() {
        first.load = max_load;
    }
    walk
}

fn push_bundle(rows: &mut Rows, identity: &Given, bundle: &Bundle) {
    let read: Vec<Vec<Option<Point>>> = bundle.walks.iter().map(|walk| walk.stations(bundle.from)).collect();
    let stations = if bundle.walks.iter().all(|walk| walk.greatest_tension() == 0.0) {
        COMPRESSION_STATIONS
    } else {
        STATIONS
    };
    let loading = bundle.max_load.is_none();
    for index in 0..stations {
        // A loading branch is walked backwards, and its rows follow the path.
        let station = if loading { stations - 1 - index } else { index };
        let points: Vec<Point> =
            read.iter().filter_map(|walk| walk.get(station).copied().flatten()).collect();
        let Some(first) = points.first() else {
            continue;
        };
        let over = |what: fn(&Point) -> f64| Sample::of(&points.iter().map(what).collect::<Vec<_>>());
        let (area, penetration) = (over(|point| point.area), over(|point| point.penetration));
        // A mean of equal numbers need not be that number to the last bit.
        let common = points.iter().all(|point| point.load == first.load);
        let load = if common { Some(first.load) } else { over(|point| point.load).mean };
        let fraction = tension_fraction(station);
        let columns: [(&str, Value); 11] = [
            ("max_load", bundle.max_load.into()),
            ("branch", if loading { "loading" } else { "unloading" }.into()),
            ("grid_index", index.into()),
            ("station", if fraction.is_some() { "tension_fraction" } else { "load" }.into()),
            ("tension_fraction", fraction.into()),
            ("load", load.into()),
            ("area_mean", area.mean.into()),
            ("area_sd", area.sd.into()),
            ("penetration_mean", penetration.mean.into()),
            ("penetration_sd", penetration.sd.into()),
            ("realization_count", points.len().into()),
        ];
        let row: Given = columns.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        rows.push(&[identity, &row]);
    }
}
