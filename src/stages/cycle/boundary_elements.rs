//! A cycle by boundary elements: steps, regions, events and maps in SI units.

use super::super::done::Outcome;
use super::super::identity::Identity;
use super::super::{StageError, Watch};
use super::elements_setup::setup;
use super::elements_tables::{Counts, adhesionless, branch, contacts, events, steps};
use super::{Checkpoints, Progress, effort_of, not_reached, serialized, write_tables};
use crate::campaign::{Campaign, CycleUnit};
use crate::model::KeptContacts;
use crate::physics::PhysicsError;
use crate::physics::boundary_elements::adhesionless::{FreeStep, load_freely};
use crate::physics::boundary_elements::contact::Problem;
use crate::physics::boundary_elements::cycle::{self, Cycle, Halfway, Settings, Turning};
use crate::physics::boundary_elements::regions::Labels;
use crate::physics::elements::{Elements, Units, remove_unsound};
use crate::physics::theory::approximate_jkr::{CurvePoint, adhesive_curve};
use crate::store::{ContactMap, MapsHeader, read_halfway, write_maps, write_state};
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

pub(super) fn run(campaign: &Campaign, unit: &CycleUnit, watch: &dyn Watch) -> Result<Outcome, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let (Elements { problem, settings, units }, summits) = setup(campaign, unit)?;
    let dir = campaign.cycle_dir(unit);
    let progress = Progress::of(watch, &unit.id);
    let mut checkpoints = Checkpoints::of(campaign, unit, watch);
    let kept: Option<(Halfway, Counts)> = checkpoints.read();
    let (halfway, mut counts) = kept.map_or((None, Counts::new()), |(halfway, counts)| (Some(halfway), counts));
    let mut keep = |halfway: &Halfway| {
        counts.push((halfway.steps().len() - 1, summit_counts(halfway.labels(), &summits)));
        checkpoints.keep(&(halfway, &counts));
    };
    let outcome = cycle::run(&problem, &settings, halfway, &mut keep, &|at| progress.reached(at));
    progress.end();
    let mut cycle = outcome.map_err(|error| units.in_si(error))?;
    let loads = &params.cycle.max_load;
    for removed in remove_unsound(&mut cycle) {
        counts.retain(|(step, _)| !removed.contains(step));
        counts.iter_mut().filter(|(step, _)| *step >= removed.end).for_each(|(step, _)| *step -= removed.len());
    }
    let unreached: Vec<(f64, PhysicsError)> =
        cycle.unreached.iter().map(|(load, reason)| (loads[*load], units.in_si(reason.error(settings.max_loads[*load])))).collect();
    if let Some((_, error)) = unreached.first().filter(|_| unreached.len() == loads.len()) {
        return Err(error.clone().into());
    }
    let of = Identity::of(campaign, unit);
    let kept = if params.cycle.contacts == KeptContacts::None { &[][..] } else { &cycle.regions[..] };
    let effort = effort(&cycle, &problem);
    let contact_gap_m = problem.law.contact_gap() * units.spacing_m();
    let free = without_adhesion(problem, &settings, &cycle)?;
    let tables = [
        contacts(of, (&cycle, kept), loads, &units, &counts)?,
        events(of, &cycle, loads, &units)?,
        adhesionless(of, &free, &units)?,
        steps(of, &cycle, loads, &units)?,
    ];
    let mut files = write_tables(campaign, unit, &tables)?;
    let points = units.own_points();
    let length_m = points as f64 * units.spacing_m();
    let header = MapsHeader { key: &unit.key, cycle_id: &unit.id, length_m, points, first_m: units.first_m, contact_gap_m };
    files.push(write_maps(&dir.join("maps.h5"), &header, &maps(&cycle, loads, &units))?);
    let turning = serialized(&cycle.turning).map_err(|error| StageError::State { what: error.to_string() })?;
    files.push(write_state(&turning_path(&dir), &unit.key, &turning)?);
    let unreached: Vec<(f64, String)> = unreached.into_iter().map(|(max_load, error)| (max_load, error.to_string())).collect();
    files.extend(not_reached::record(campaign, unit, &unreached, watch)?);
    Ok(Outcome { files, effort })
}

/// Step of loading without adhesion, in steps of the cycle.
pub(super) const FREE_STEP: f64 = 2.0;

/// Loading of the problem without adhesion, until the adhesive states that follow from it reach the largest load, at most by the range of the heights beyond
/// the cycle.
fn without_adhesion(problem: Problem, settings: &Settings, cycle: &Cycle) -> Result<Vec<FreeStep>, StageError> {
    let work_length = problem.law.work();
    let wanted = settings.max_loads.iter().copied().fold(0.0, f64::max);
    let range = -problem.heights.iter().copied().fold(0.0, f64::min);
    let farthest = range + cycle.steps.iter().map(|step| step.approach).fold(0.0, f64::max);
    let free = problem.without_adhesion();
    let mut enough = |steps: &[FreeStep]| {
        let reached = || adhesive_curve(&curve(steps), work_length).last().is_some_and(|point| point.load_m2 > wanted);
        steps.last().is_some_and(|step| step.approach > farthest) || reached()
    };
    Ok(load_freely(&free, FREE_STEP * settings.step, settings.accuracy, &mut enough)?)
}

/// Steps without adhesion in grid units.
fn curve(steps: &[FreeStep]) -> Vec<CurvePoint> {
    let point =
        |step: &FreeStep| CurvePoint { penetration_m: step.approach, load_m2: step.totals.load, area_m2: step.totals.contact as f64 };
    steps.iter().map(point).collect()
}

/// Number of asperities in each region.
fn summit_counts(labels: &Labels, summits: &[usize]) -> Vec<u32> {
    let mut counts = vec![0; labels.count];
    for label in summits.iter().filter_map(|point| labels.of.get(*point)).filter(|label| **label > 0) {
        counts[*label as usize - 1] += 1;
    }
    counts
}

/// Maps of the surface in SI units, without its mirror images, in the order of the steps.
fn maps(cycle: &Cycle, loads: &[f64], units: &Units) -> Vec<ContactMap> {
    let (length, stress) = (units.spacing_m(), units.modulus_pa);
    let of_the_surface = |field: &[f32], stride: usize, unit: f64| -> Vec<f32> {
        let [all, own] = [units.points, units.own_points()].map(|points| points.div_ceil(stride));
        field.chunks(all).take(own).flat_map(|row| &row[..own]).map(|value| (f64::from(*value) * unit) as f32).collect()
    };
    let map_of = |map: &cycle::Map, value: fn(f32) -> f32| {
        let step = &cycle.steps[map.step];
        let reversal = step.reversal.or_else(|| cycle.reversal_at(map.step));
        ContactMap {
            step: map.step as i64,
            branch: branch(step),
            max_load: reversal.and_then(|at| loads.get(at)).copied().unwrap_or(f64::NAN),
            approach_m: step.approach * length,
            load_n: step.totals.load * units.load_n(),
            stride: map.stride,
            gap_m: of_the_surface(&map.gap, map.stride, length).into_iter().map(value).collect(),
            pressure_pa: of_the_surface(&map.pressure, map.stride, stress).into_iter().map(value).collect(),
        }
    };
    let ends = || cycle.maps.iter();
    // A step may be at the maximum tensile load as well.
    let between = cycle.between.iter().filter(|map| ends().all(|end| end.step != map.step));
    let mut maps: Vec<ContactMap> = ends().map(|map| map_of(map, |value| value)).chain(between.map(|map| map_of(map, rounded))).collect();
    maps.sort_by_key(|map| map.step);
    maps
}

/// A number with 10 bits of its mantissa, which compresses to less than half: relative error at most 2⁻¹¹.
fn rounded(value: f32) -> f32 {
    f32::from_bits(value.to_bits().wrapping_add(0x1000) & !0x1fff)
}

/// File of the states at the load reversals.
fn turning_path(dir: &Path) -> PathBuf {
    dir.join("turning.bin")
}

/// Unloads by boundary elements from a load reversal of a finished cycle: the cycle in the units of the solver, and these units.
///
/// # Errors
/// The files of the cycle and of its surface must be complete, and contain that load.
pub fn unload_elements_again(campaign: &Campaign, unit: &CycleUnit, max_load: f64) -> Result<(Cycle, Units), StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let (Elements { problem, settings, units }, _) = setup(campaign, unit)?;
    let path = turning_path(&campaign.cycle_dir(unit));
    let states: Option<Vec<Turning>> = read_halfway(&path, &unit.key).and_then(|bytes| postcard::from_bytes(&bytes).ok());
    let reversal = params.cycle.max_load.iter().position(|load| *load == max_load);
    let kept = || format!("the loads {:?}", params.cycle.max_load);
    let lacking = || StageError::NoTurning { max_load, path: path.clone(), kept: kept() };
    let reversal = reversal.ok_or_else(lacking)?;
    let turning = states.and_then(|mut all| (reversal < all.len()).then(|| all.swap_remove(reversal))).ok_or_else(lacking)?;
    if turning.state.displacement.len() != problem.half_space.points() {
        return Err(lacking());
    }
    let cycle = cycle::unload_from(&problem, &settings, reversal, &turning).map_err(|error| units.in_si(error))?;
    Ok((cycle, units))
}

/// Effort of a cycle, for its provenance record.
fn effort(cycle: &Cycle, problem: &Problem) -> Map<String, Value> {
    let sum = |value: fn(&cycle::Step) -> u64| cycle.steps.iter().map(value).sum::<u64>();
    effort_of(&[
        ("point_count", problem.half_space.points() as u64),
        ("step_count", cycle.steps.len() as u64),
        ("event_count", cycle.events.len() as u64),
        ("iteration_count", sum(|step| step.iterations)),
        ("transform_count", sum(|step| step.transforms)),
    ])
}
