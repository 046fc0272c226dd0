//! A cycle of the asperity model.

use super::super::done::Outcome;
use super::super::extract::read_summits;
use super::super::identity::Identity;
use super::super::surface::{Scale, scale};
use super::super::{StageError, Watch, step_count};
use super::asperity_tables::{contacts, events, merged, steps, turning, word};
use super::{Checkpoints, Progress, effort_of, not_reached, write_tables};
use crate::campaign::{Campaign, CycleUnit};
use crate::physics::contact::Merged;
use crate::physics::contact::rows::Kept;
use crate::physics::contact::{Problem, Rules, State, Status};
use crate::physics::cycle::{self, Cycle, Halfway, Settings};
use crate::physics::half_space::Effort;
use crate::physics::surface::summits::Summit;
use crate::schema;
use crate::spec::CaseParams;
use crate::store::parquet;
use serde_json::{Map, Value};
use std::path::Path;

/// The contact problem of a case on the asperities of a table.
pub(super) fn problem(params: &CaseParams, scale: Scale, summits: &[Summit]) -> Result<Problem, StageError> {
    let rules = Rules {
        interaction: params.model.interaction,
        boundary: params.model.boundary,
        coalescence: params.model.coalescence,
        jump_in: params.model.jump_in,
        allow_low_tabor: params.model.allow_low_tabor,
        slips: params.model.slips(),
    };
    Ok(Problem::new(summits, scale.length_m, scale.rms_height_m, params.material, rules)?)
}

/// The contact problem of a case, whose number of steps is limited.
///
/// # Errors
/// Asperities, a Tabor parameter or a number of steps that the asperity model refuses.
pub(in crate::stages) fn checked(params: &CaseParams, scale: Scale, summits: &[Summit]) -> Result<Problem, StageError> {
    let problem = problem(params, scale, summits)?;
    step_count::bound(&problem, summits, params)?;
    Ok(problem)
}

/// Asperities from which on a cycle has checkpoints, and their interval of the mean penetration over the rms height.
pub(super) const MANY: usize = 20_000;
pub(super) const REST_EVERY: f64 = 0.1;

pub(super) fn run(campaign: &Campaign, unit: &CycleUnit, watch: &dyn Watch) -> Result<Outcome, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let summits = read_summits(&campaign.asperities_path(&campaign.surfaces[unit.surface]))?;
    let problem = checked(params, scale(campaign, &campaign.surfaces[unit.surface])?, &summits)?;
    let settings = settings(params, summits.len());
    let progress = Progress::of(watch, &unit.id);
    let mut checkpoints = Checkpoints::of(campaign, unit, watch);
    let halfway: Option<Halfway> = checkpoints.read();
    let mut keep = |halfway: &Halfway| checkpoints.keep(halfway);
    let outcome = cycle::run_from(&problem, &settings, halfway, &mut keep, &|at| progress.reached(at));
    progress.end();
    let cycle = outcome?;
    let of = Identity::of(campaign, unit);
    let tables = [
        contacts(of, &cycle, &summits)?,
        turning(of, &cycle, &problem, &settings.max_loads)?,
        merged(of, &cycle)?,
        events(of, &cycle)?,
        steps(of, &cycle, &settings.max_loads, &problem)?,
    ];
    let mut files = write_tables(campaign, unit, &tables)?;
    let unreached: Vec<(f64, String)> = cycle.unreached.iter().map(|(load, error)| (settings.max_loads[*load], error.clone())).collect();
    files.extend(not_reached::record(campaign, unit, &unreached, watch)?);
    Ok(Outcome { files, effort: effort(&cycle, &problem) })
}

/// Effort of a cycle, for its receipt.
fn effort(cycle: &Cycle, problem: &Problem) -> Map<String, Value> {
    let all = cycle.steps.iter().fold(Effort::default(), |mut sum, step| {
        sum += step.numerics.effort;
        sum
    });
    effort_of(&[
        ("asperity_count", problem.len() as u64),
        ("step_count", cycle.steps.len() as u64),
        ("event_count", cycle.events.len() as u64),
        ("iteration_count", all.iterations),
        ("pair_evaluation_count", all.pairs),
        ("product_count", all.products),
        ("transform_count", all.transforms),
    ])
}

/// Unloads again from a load reversal of a finished cycle.
///
/// # Errors
/// The tables of the cycle and of its surface must be there and whole, and hold that load.
pub fn unload_again(campaign: &Campaign, unit: &CycleUnit, max_load: f64) -> Result<Cycle, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let summits = read_summits(&campaign.asperities_path(&campaign.surfaces[unit.surface]))?;
    let problem = problem(params, scale(campaign, &campaign.surfaces[unit.surface])?, &summits)?;
    let path = campaign.cycle_dir(unit).join("turning.parquet");
    let frame = parquet::read_table(&path, &schema::TURNING)?;
    let (loads, approaches) = (frame.f64("max_load")?, frame.f64("approach_m")?);
    let (asperities, states, radii) = (frame.i64("asperity_id")?, frame.text("state")?, frame.f64("contact_radius_m")?);
    let (covering, release, barred) = (frame.i64_or_null("covered_by")?, frame.f64_or_null("release_m")?, frame.bool("barred")?);
    let rows: Vec<usize> = (0..frame.row_count()).filter(|k| loads[*k] == max_load).collect();
    let (into, counts) = (frame.i64_or_null("merged_into")?, frame.i64("merged_count")?);
    let status = |k: usize| match (covering[k], release[k], into[k]) {
        (Some(by), Some(release_m), _) => Status::Covered { by: by as usize, release_m },
        (_, _, Some(into)) => Status::Merged { into: into as usize },
        _ if states[k] == word(Status::Contact) => Status::Contact,
        _ => Status::Free,
    };
    let kept = |&k: &usize| Kept { asperity: asperities[k] as usize, status: status(k), radius_m: radii[k], barred: barred[k] };
    let Some(approach) = rows.first().map(|k| approaches[*k]) else {
        let mut kept = loads;
        kept.dedup();
        return Err(StageError::NoTurning { max_load, path, kept: format!("the loads {kept:?}") });
    };
    let merged = merged_rows(&campaign.cycle_dir(unit).join("merged.parquet"), counts[rows[0]] as usize)?;
    let state = State::restored(&problem, approach, &merged, &rows.iter().map(kept).collect::<Vec<_>>())?;
    Ok(cycle::unload_from(&problem, &settings(params, summits.len()), max_load, state)?)
}

/// The first spots that have merged on loading.
fn merged_rows(path: &Path, count: usize) -> Result<Vec<Merged>, StageError> {
    let frame = parquet::read_table(path, &schema::MERGED)?;
    let (first, second) = (frame.i64("first_id")?, frame.i64("second_id")?);
    let [a, b] = [frame.f64("first_radius_m")?, frame.f64("second_radius_m")?];
    let [x, y] = [frame.f64("x_m")?, frame.f64("y_m")?];
    let [radius, height] = [frame.f64("radius_m")?, frame.f64("height_m")?];
    let offset = frame.f64("offset_j")?;
    let [release, approach] = [frame.f64("release_m")?, frame.f64("approach_m")?];
    let row = |k: usize| Merged {
        parts: [first[k] as usize, second[k] as usize],
        radii_m: [a[k], b[k]],
        place_m: [x[k], y[k]],
        radius_m: radius[k],
        height_m: height[k],
        offset_j: offset[k],
        release_m: release[k],
        approach_m: approach[k],
    };
    Ok((0..count.min(frame.row_count())).map(row).collect())
}

fn settings(params: &CaseParams, asperities: usize) -> Settings {
    Settings {
        max_loads: params.cycle.max_load.clone(),
        approach_step: params.cycle.approach_step,
        contacts: params.cycle.contacts,
        rest_every: (asperities >= MANY).then_some(REST_EVERY),
    }
}
