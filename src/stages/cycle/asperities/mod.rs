//! A cycle of the asperity model.

mod cost;
mod step_count;
mod trial;

pub(super) use cost::{OF_ASPERITIES, cost};
pub(super) use step_count::MOST as MOST_STEPS;
pub(in crate::stages) use trial::Trial;

use super::super::StageError;
use super::super::extract::read_summits;
use super::super::identity::Identity;
use super::super::previews::Known;
use super::super::surface::{Scale, scale};
use super::{Computed, CycleTask};
use crate::campaign::{Campaign, CycleUnit};
use crate::model::AsperityOptions;
use crate::physics::SpotStatus;
use crate::physics::asperities::contact::rows::Kept;
use crate::physics::asperities::contact::{Problem, Rules, State, Status};
use crate::physics::asperities::{Asperities, Options, summits_on_probe};
use crate::physics::cycle::{Cycle, Merged, Method};
use crate::physics::surface::summits::Summit;
use crate::schema;
use crate::spec::CaseParams;
use crate::store::{Frame, parquet};
use std::collections::HashMap;
use std::path::Path;

/// A case of the asperity model.
#[derive(Clone, Copy)]
struct AsperityCase<'a> {
    params: &'a CaseParams,
    options: &'a AsperityOptions,
}

/// The error by which cycles on a measured surface fail; nothing for one whose asperities are not known.
pub(super) fn refusal(params: &CaseParams, options: &AsperityOptions, known: &Known) -> Option<StageError> {
    let scale = Scale::of(&known.header);
    checked(AsperityCase { params, options }, scale, &known.found()?.found.list).err()
}

/// The asperity model of a case on the asperities of a table.
fn method(
    of: AsperityCase<'_>,
    scale: Scale,
    summits: &[Summit],
    max_loads: &[f64],
) -> Result<Asperities, StageError> {
    let AsperityCase { params, options } = of;
    let rules = Rules {
        interaction: options.interaction,
        boundary: options.boundary,
        coalescence: options.coalescence,
        jump_in: options.jump_in,
        allow_low_tabor: options.allow_low_tabor,
        slips: params.slips(),
    };
    let options = Options {
        rules,
        probe: params.probe,
        machine: params.machine,
        approach_step: options.approach_step,
        contacts: params.cycle.contacts,
        ..Options::default()
    };
    Ok(Asperities::of_summits(
        summits,
        scale.length_m,
        scale.rms_height_m,
        &scale.material(&params.material),
        max_loads,
        &options,
    )?)
}

/// The asperity model of a case, whose number of steps is limited.
///
/// # Errors
/// Asperities, a Tabor parameter or a number of steps that the asperity model refuses.
fn checked(of: AsperityCase<'_>, scale: Scale, summits: &[Summit]) -> Result<Asperities, StageError> {
    let method = method(of, scale, summits, &of.params.cycle.max_load)?;
    step_count::bound(&method.problem, summits, of)?;
    Ok(method)
}

pub(super) fn run(task: &CycleTask<'_>, options: &AsperityOptions) -> Result<Computed, StageError> {
    let (campaign, unit, params) = (task.campaign, task.unit, task.params());
    let surface = &campaign.surfaces[unit.surface];
    let summits = read_summits(&campaign.asperities_path(surface))?;
    let method = checked(AsperityCase { params, options }, scale(campaign, surface)?, &summits)?;
    let cycle = task.follow(&method)?;
    let (of, problem) = (Identity::of(campaign, unit), &method.problem);
    let tables = vec![turning(of, &cycle, problem, &params.cycle.max_load)?, merged(of, &cycle)?];
    let (load_unit_n, area_m2, rms_height_m) =
        (problem.load_unit_n(), problem.length_m * problem.length_m, problem.rms_height_m);
    Ok(Computed {
        method: Asperities::NAME,
        size: method.size(),
        cycle: with_centres(cycle.without_states(), &places(&method, params, &summits)?),
        tables,
        files: Vec::new(),
        load_unit_n,
        area_m2,
        rms_height_m,
        summits,
        adhesionless: Vec::new(),
        per_wavelength: None,
    })
}

/// The asperities at their places on the probe, or on the flat surface.
fn places(method: &Asperities, params: &CaseParams, summits: &[Summit]) -> Result<Vec<Summit>, StageError> {
    let Some(probe) = params.probe else { return Ok(summits.to_vec()) };
    Ok(summits_on_probe(summits, probe, method.problem.length_m, params.boundary())?)
}

/// Unloads again from a load reversal of a finished cycle.
///
/// # Errors
/// The tables of the cycle and of its surface must be there and whole, and hold that load.
pub(super) fn unload_again(
    campaign: &Campaign,
    unit: &CycleUnit,
    options: &AsperityOptions,
    max_load: f64,
) -> Result<Cycle<()>, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let summits = read_summits(&campaign.asperities_path(&campaign.surfaces[unit.surface]))?;
    let method = method(
        AsperityCase { params, options },
        scale(campaign, &campaign.surfaces[unit.surface])?,
        &summits,
        &[max_load],
    )?;
    let path = campaign.cycle_dir(unit).join("turning.parquet");
    let frame = parquet::read_table(&path, &schema::TURNING)?;
    let (loads, approaches) = (frame.f64("max_load")?, frame.f64("approach_m")?);
    let (asperities, states, radii) =
        (frame.i64("asperity_id")?, frame.text("state")?, frame.f64("contact_radius_m")?);
    let (covering, release, barred) =
        (frame.i64_or_null("covered_by")?, frame.f64_or_null("release_m")?, frame.bool("barred")?);
    let rows: Vec<usize> = (0..frame.row_count()).filter(|k| loads[*k] == max_load).collect();
    let (into, counts) = (frame.i64_or_null("merged_into")?, frame.i64("merged_count")?);
    let status = |k: usize| match (covering[k], release[k], into[k]) {
        (Some(by), Some(release_m), _) => Status::Covered { by: by as usize, release_m },
        (_, _, Some(into)) => Status::Merged { into: into as usize },
        _ if states[k] == SpotStatus::Contact.word() => Status::Contact,
        _ => Status::Free,
    };
    let kept = |&k: &usize| Kept {
        asperity: asperities[k] as usize,
        status: status(k),
        radius_m: radii[k],
        barred: barred[k],
    };
    let Some(approach) = rows.first().map(|k| approaches[*k]) else {
        let mut kept = loads;
        kept.dedup();
        return Err(StageError::NoTurning { max_load, path, kept: format!("the loads {kept:?}") });
    };
    let merged = merged_rows(&campaign.cycle_dir(unit).join("merged.parquet"), counts[rows[0]] as usize)?;
    let state =
        State::restored(&method.problem, approach, &merged, &rows.iter().map(kept).collect::<Vec<_>>())?;
    let cycle = method.unload_from(0, state)?.without_states();
    Ok(with_centres(cycle, &places(&method, params, &summits)?))
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
        mean_penetration_m: approach[k],
    };
    Ok((0..count.min(frame.row_count())).map(row).collect())
}

fn turning(
    of: Identity<'_>,
    cycle: &Cycle<State>,
    problem: &Problem,
    loads: &[f64],
) -> Result<Frame, StageError> {
    let states = loads.iter().zip(&cycle.turning);
    let rows: Vec<(f64, f64, Kept, usize)> = states
        .flat_map(|(load, (_, state))| {
            state
                .kept(problem)
                .into_iter()
                .map(|kept| (*load, state.mean_penetration_m, kept, state.merged.len()))
        })
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
        .text("state", rows.iter().map(|row| SpotStatus::from(row.2.status).word()))
        .f64("contact_radius_m", rows.iter().map(|row| row.2.radius_m))
        .i64("covered_by", rows.iter().map(|row| covered(row.2.status).map(|(by, _)| by as i64)))
        .f64("release_m", rows.iter().map(|row| covered(row.2.status).map(|(_, release_m)| release_m)))
        .bool("barred", rows.iter().map(|row| row.2.barred))
        .i64(
            "merged_into",
            rows.iter()
                .map(|row| if let Status::Merged { into } = row.2.status { Some(into as i64) } else { None }),
        )
        .i64("merged_count", rows.iter().map(|row| row.3 as i64))
        .build()?)
}

fn merged(of: Identity<'_>, cycle: &Cycle<State>) -> Result<Frame, StageError> {
    let spots = &cycle.merged;
    let step = |k: usize| &cycle.steps[k];
    let each = |value: fn(&Merged) -> f64| spots.iter().map(move |s| value(&s.spot));
    Ok(of
        .begin(&schema::MERGED, spots.len())
        .i64("step", spots.iter().map(|s| s.step as i64))
        .text("branch", spots.iter().map(|s| step(s.step).branch.word()))
        .f64("max_load", spots.iter().map(|s| step(s.step).max_load))
        .i64("asperity_id", spots.iter().map(|s| s.asperity as i64))
        .f64("approach_m", each(|s| s.mean_penetration_m))
        .i64("first_id", spots.iter().map(|s| s.spot.parts[0] as i64))
        .i64("second_id", spots.iter().map(|s| s.spot.parts[1] as i64))
        .f64("first_radius_m", each(|s| s.radii_m[0]))
        .f64("second_radius_m", each(|s| s.radii_m[1]))
        .f64("release_m", each(|s| s.release_m))
        .f64("x_m", each(|s| s.place_m[0]))
        .f64("y_m", each(|s| s.place_m[1]))
        .f64("height_m", each(|s| s.height_m))
        .f64("radius_m", each(|s| s.radius_m))
        .f64("offset_j", each(|s| s.offset_j))
        .build()?)
}

/// Adds the centre of each stored contact spot. Numbers of merged spots go on during each unloading from that
/// of its load reversal.
fn with_centres(mut cycle: Cycle<()>, summits: &[Summit]) -> Cycle<()> {
    let branch = |step: usize| cycle.steps[step].max_load.map(f64::to_bits);
    let merged: HashMap<_, _> =
        cycle.merged.iter().map(|m| ((branch(m.step), m.asperity), m.spot.place_m)).collect();
    let of_asperity = |i: usize| summits.get(i).map(|summit| [summit.x_m, summit.y_m]);
    let of_merged =
        |step: usize, i: usize| merged.get(&(branch(step), i)).or_else(|| merged.get(&(None, i))).copied();
    let centre = |step: usize, i: usize| of_asperity(i).or_else(|| of_merged(step, i));
    let centres: Vec<_> =
        cycle.contacts.iter().map(|spot| spot.asperity.and_then(|i| centre(spot.step, i))).collect();
    cycle.contacts.iter_mut().zip(centres).for_each(|(spot, centre)| spot.centroid_m = centre);
    cycle
}
