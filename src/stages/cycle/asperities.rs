//! cycle: load and unload one case on one surface, and write every step.

use super::done::Outcome;
use super::identity::Identity;
use super::surface::{Scale, read_summits, scale};
use super::{StageError, Watch, step_count};
use crate::campaign::{Campaign, CycleUnit, Stage};
use crate::physics::cycle::{self, Cycle, Halfway, Settings, Step};
use crate::physics::interaction::Effort;
use crate::physics::merge::Merged;
use crate::physics::restart::Kept;
use crate::physics::state::{Problem, Rules, State, Status};
use crate::physics::summits::Summit;
use crate::schema;
use crate::spec::CaseParams;
use crate::store::{Frame, parquet, read_halfway, write_halfway};
use serde_json::{Map, Value};
use std::path::Path;
use std::time::{Duration, Instant};

/// A state counts as converged below this residual, of the rms height.
const CONVERGED: f64 = 1e-8;

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

/// Asperities from which on a cycle takes so long that what is needed to go on is kept on the way; where it rests for that, of the rms height; and how
/// long it goes on from there at least before it is kept again.
const MANY: usize = 20_000;
const REST_EVERY: f64 = 0.1;
const KEPT_FOR: Duration = Duration::from_secs(60);

pub(super) fn run(campaign: &Campaign, unit: &CycleUnit, watch: &dyn Watch) -> Result<Outcome, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let summits = read_summits(&campaign.asperities_path(&campaign.surfaces[unit.surface]))?;
    let dir = campaign.cycle_dir(unit);
    std::fs::create_dir_all(&dir).map_err(|source| StageError::Folder { path: dir.clone(), source })?;
    let problem = problem(params, scale(campaign, &campaign.surfaces[unit.surface])?, &summits)?;
    step_count::bound(&problem, &summits, params)?;
    let settings = settings(params, summits.len());
    // The physics tells how far it is; the watch wants what was added.
    let reached = std::cell::Cell::new(0.0);
    let report = |done: f64| {
        let done = done.max(reached.get());
        watch.progress(Stage::Cycle, done - reached.replace(done));
    };
    let path = campaign.halfway_path(unit);
    let halfway = read_halfway(&path, &unit.key).and_then(|bytes| postcard::from_bytes(&bytes).ok());
    let mut kept_at = Instant::now();
    let mut keep = |halfway: &Halfway| {
        if kept_at.elapsed() >= KEPT_FOR {
            kept_at = Instant::now();
            let kept = postcard::to_stdvec(halfway).map_err(|error| error.to_string());
            if let Err(why) = kept.and_then(|bytes| write_halfway(&path, &unit.key, &bytes).map_err(|error| error.to_string())) {
                watch.notice(&format!("{}: {why}; continuing without checkpoint, an interrupted cycle restarts", unit.id));
            }
        }
    };
    let outcome = cycle::run_from(&problem, &settings, halfway, &mut keep, &report);
    // A failed case leaves the bar as a finished one does.
    watch.progress(Stage::Cycle, 1.0 - reached.get());
    let cycle = outcome?;
    let keys = [("key", unit.key.clone())];
    let of = Identity::of(campaign, unit);
    let tables = [
        contacts(of, &cycle)?,
        turning(of, &cycle, &problem, &settings.max_loads)?,
        merged(of, &cycle)?,
        events(of, &cycle)?,
        steps(of, &cycle, &problem)?,
    ];
    let write = |frame: &Frame| Ok(parquet::write_table(&dir.join(format!("{}.parquet", frame.table().name)), frame, &keys)?);
    let files = tables.iter().map(write).collect::<Result<_, StageError>>()?;
    Ok(Outcome { files, effort: effort(&cycle, &problem) })
}

/// What a cycle has taken, for its receipt.
fn effort(cycle: &Cycle, problem: &Problem) -> Map<String, Value> {
    let all = cycle.steps.iter().fold(Effort::default(), |mut sum, step| {
        sum += step.effort;
        sum
    });
    let counts = [
        ("asperity_count", problem.len() as u64),
        ("step_count", cycle.steps.len() as u64),
        ("event_count", cycle.events.len() as u64),
        ("iteration_count", all.iterations),
        ("pair_evaluation_count", all.pairs),
        ("product_count", all.products),
        ("transform_count", all.transforms),
    ];
    counts.into_iter().map(|(name, count)| (name.to_owned(), count.into())).collect()
}

/// Unloads anew from a turning point that a finished cycle has kept.
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
    let [release, approach] = [frame.f64("release_m")?, frame.f64("approach_m")?];
    let row = |k: usize| Merged {
        parts: [first[k] as usize, second[k] as usize],
        radii_m: [a[k], b[k]],
        place_m: [x[k], y[k]],
        radius_m: radius[k],
        height_m: height[k],
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

fn turning(of: Identity<'_>, cycle: &Cycle, problem: &Problem, loads: &[f64]) -> Result<Frame, StageError> {
    let states = loads.iter().zip(&cycle.turning);
    let rows: Vec<(f64, f64, Kept, usize)> = states
        .flat_map(|(load, (_, state))| state.kept(problem).into_iter().map(|kept| (*load, state.approach_m, kept, state.merged.len())))
        .collect();
    let covered = |status: Status| match status {
        Status::Covered { by, release_m } => Some((by, release_m)),
        _ => None,
    };
    Ok(of
        .begin(&schema::TURNING, rows.len())
        .f64("max_load", rows.iter().map(|row| row.0))
        .f64("approach_m", rows.iter().map(|row| row.1))
        .i64("asperity_id", rows.iter().map(|row| row.2.asperity as i64))
        .text("state", rows.iter().map(|row| word(row.2.status)))
        .f64("contact_radius_m", rows.iter().map(|row| row.2.radius_m))
        .i64("covered_by", rows.iter().map(|row| covered(row.2.status).map(|(by, _)| by as i64)))
        .f64("release_m", rows.iter().map(|row| covered(row.2.status).map(|(_, release_m)| release_m)))
        .bool("barred", rows.iter().map(|row| row.2.barred))
        .i64("merged_into", rows.iter().map(|row| if let Status::Merged { into } = row.2.status { Some(into as i64) } else { None }))
        .i64("merged_count", rows.iter().map(|row| row.3 as i64))
        .build()?)
}

/// What an asperity is doing, in the tables.
fn word(status: Status) -> &'static str {
    match status {
        Status::Contact => "contact",
        Status::Covered { .. } => "covered",
        Status::Merged { .. } => "merged",
        Status::Free => "free",
    }
}

fn merged(of: Identity<'_>, cycle: &Cycle) -> Result<Frame, StageError> {
    let spots = &cycle.merged;
    let step = |k: usize| &cycle.steps[k];
    let each = |value: fn(&Merged) -> f64| spots.iter().map(move |s| value(&s.spot));
    Ok(of
        .begin(&schema::MERGED, spots.len())
        .i64("step", spots.iter().map(|s| s.step as i64))
        .text("branch", spots.iter().map(|s| step(s.step).branch.word()))
        .f64("max_load", spots.iter().map(|s| step(s.step).max_load))
        .i64("asperity_id", spots.iter().map(|s| s.asperity as i64))
        .f64("approach_m", each(|s| s.approach_m))
        .i64("first_id", spots.iter().map(|s| s.spot.parts[0] as i64))
        .i64("second_id", spots.iter().map(|s| s.spot.parts[1] as i64))
        .f64("first_radius_m", each(|s| s.radii_m[0]))
        .f64("second_radius_m", each(|s| s.radii_m[1]))
        .f64("release_m", each(|s| s.release_m))
        .f64("x_m", each(|s| s.place_m[0]))
        .f64("y_m", each(|s| s.place_m[1]))
        .f64("height_m", each(|s| s.height_m))
        .f64("radius_m", each(|s| s.radius_m))
        .build()?)
}

fn steps(of: Identity<'_>, cycle: &Cycle, problem: &Problem) -> Result<Frame, StageError> {
    let steps = &cycle.steps;
    let each = |value: fn(&Step) -> f64| steps.iter().map(value);
    let count = |value: fn(&Step) -> usize| steps.iter().map(value);
    let area_unit = problem.length_m * problem.length_m;
    let tolerance = CONVERGED * problem.rms_height_m;
    Ok(of
        .begin(&schema::STEPS, steps.len())
        .i64("step", (0..steps.len()).map(|k| k as i64))
        .text("branch", steps.iter().map(|s| s.branch.word()))
        .f64("max_load", steps.iter().map(|s| s.max_load))
        .f64("approach_m", each(|s| s.approach_m))
        .f64("load_n", each(|s| s.load_n))
        .f64("least_load_n", each(|s| s.least_load_n))
        .f64("area_m2", each(|s| s.area_m2))
        .f64("area_union_m2", each(|s| s.area_union_m2))
        .count("contact_count", count(|s| s.contact_count))
        .count("covered_count", count(|s| s.covered_count))
        .count("jump_in_count", count(|s| s.event_counts[0]))
        .count("jump_off_count", count(|s| s.event_counts[1]))
        .count("cover_count", count(|s| s.event_counts[2]))
        .count("uncover_count", count(|s| s.event_counts[3]))
        .count("snap_count", count(|s| s.event_counts[4]))
        .count("merge_count", count(|s| s.event_counts[5]))
        .count("split_count", count(|s| s.event_counts[6]))
        .count("held_count", count(|s| s.held_count))
        .count("touching_count", count(|s| s.touching_count))
        .f64("dissipated_j", each(|s| s.dissipated_j))
        .f64("work_j", each(|s| s.work_j))
        .f64("residual_m", each(|s| s.residual_m))
        .f64("drift_m", each(|s| s.drift_m))
        .f64("stability", each(|s| s.stability))
        .bool("converged", steps.iter().map(|s| s.residual_m <= tolerance))
        .count("iteration_count", count(|s| s.effort.iterations as usize))
        .count("pair_evaluation_count", count(|s| s.effort.pairs as usize))
        .count("product_count", count(|s| s.effort.products as usize))
        .count("transform_count", count(|s| s.effort.transforms as usize))
        .f64("load", steps.iter().map(|s| s.load_n / problem.load_unit_n()))
        .f64("area", steps.iter().map(|s| s.area_m2 / area_unit))
        .f64("penetration", steps.iter().map(|s| s.approach_m / problem.rms_height_m))
        .build()?)
}

fn contacts(of: Identity<'_>, cycle: &Cycle) -> Result<Frame, StageError> {
    let spots = &cycle.contacts;
    let step = |k: usize| &cycle.steps[k];
    Ok(of
        .begin(&schema::CONTACTS, spots.len())
        .i64("step", spots.iter().map(|s| s.step as i64))
        .text("branch", spots.iter().map(|s| step(s.step).branch.word()))
        .f64("max_load", spots.iter().map(|s| step(s.step).max_load))
        .i64("asperity_id", spots.iter().map(|s| s.asperity as i64))
        .text("state", spots.iter().map(|s| if s.covered { "covered" } else { "contact" }))
        .f64("contact_radius_m", spots.iter().map(|s| s.contact_radius_m))
        .f64("load_n", spots.iter().map(|s| s.load_n))
        .f64("penetration_m", spots.iter().map(|s| s.penetration_m))
        .f64("interaction_m", spots.iter().map(|s| s.interaction_m))
        .build()?)
}

fn events(of: Identity<'_>, cycle: &Cycle) -> Result<Frame, StageError> {
    let events = &cycle.events;
    let step = |k: usize| &cycle.steps[k];
    // Avalanches are counted along each branch; in the table their numbers go on along the whole path.
    let mut numbers = Vec::with_capacity(events.len());
    let mut number: i64 = -1;
    let mut last = None;
    for (at, event) in events {
        let branch = step(*at);
        let identity = (branch.branch, branch.max_load.map(f64::to_bits), event.avalanche);
        if last != Some(identity) {
            number += 1;
            last = Some(identity);
        }
        numbers.push(number);
    }
    Ok(of
        .begin(&schema::EVENTS, events.len())
        .i64("step", events.iter().map(|(at, _)| *at as i64))
        .text("branch", events.iter().map(|(at, _)| step(*at).branch.word()))
        .f64("max_load", events.iter().map(|(at, _)| step(*at).max_load))
        .text("kind", events.iter().map(|(_, e)| e.kind.word()))
        .i64("asperity_id", events.iter().map(|(_, e)| e.asperity as i64))
        .f64("approach_m", events.iter().map(|(_, e)| e.approach_m))
        .i64("avalanche_id", numbers)
        .f64("load_before_n", events.iter().map(|(_, e)| e.before.load_n))
        .f64("load_after_n", events.iter().map(|(_, e)| e.after.load_n))
        .f64("area_before_m2", events.iter().map(|(_, e)| e.before.area_m2))
        .f64("area_after_m2", events.iter().map(|(_, e)| e.after.area_m2))
        .f64("energy_lost_j", events.iter().map(|(_, e)| e.energy_lost_j))
        .build()?)
}
