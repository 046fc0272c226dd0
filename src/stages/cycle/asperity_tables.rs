//! Tables of a cycle of the asperity model.

use super::super::StageError;
use super::super::identity::Identity;
use crate::physics::contact::Merged;
use crate::physics::contact::rows::Kept;
use crate::physics::contact::{Problem, Status};
use crate::physics::cycle::{Cycle, Step};
use crate::physics::surface::summits::Summit;
use crate::schema;
use crate::store::Frame;
use std::collections::HashMap;
use std::iter::repeat_n;

/// A state counts as converged below this residual, of the rms height.
pub(super) const CONVERGED: f64 = 1e-8;
/// Word of the method in the tables.
const METHOD: &str = "asperities";

pub(super) fn turning(of: Identity<'_>, cycle: &Cycle, problem: &Problem, loads: &[f64]) -> Result<Frame, StageError> {
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

/// State of an asperity in the tables.
pub(super) fn word(status: Status) -> &'static str {
    match status {
        Status::Contact => "contact",
        Status::Covered { .. } => "covered",
        Status::Merged { .. } => "merged",
        Status::Free => "free",
    }
}

pub(super) fn merged(of: Identity<'_>, cycle: &Cycle) -> Result<Frame, StageError> {
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
        .f64("offset_j", each(|s| s.offset_j))
        .build()?)
}

pub(super) fn steps(of: Identity<'_>, cycle: &Cycle, loads: &[f64], problem: &Problem) -> Result<Frame, StageError> {
    let steps = &cycle.steps;
    let each = |value: fn(&Step) -> f64| steps.iter().map(value);
    let count = |value: fn(&Step) -> usize| steps.iter().map(value);
    let area_unit = problem.length_m * problem.length_m;
    let tolerance = CONVERGED * problem.rms_height_m;
    let mut reversals = vec![None; steps.len()];
    for ((step, _), load) in cycle.turning.iter().zip(loads) {
        reversals[*step] = Some(*load);
    }
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
        .count("contact_count", count(|s| s.counts.contacts))
        .count("covered_count", count(|s| s.counts.covered))
        .counts(steps.iter().map(|s| s.counts.events))
        .count("held_count", count(|s| s.counts.held))
        .count("touching_count", count(|s| s.counts.touching))
        .f64("dissipated_j", each(|s| s.dissipated_j))
        .f64("work_j", each(|s| s.work_j))
        .f64("residual_m", each(|s| s.numerics.residual_m))
        .f64("drift_m", each(|s| s.numerics.drift_m))
        .f64("stability", each(|s| s.numerics.stability))
        .bool("converged", steps.iter().map(|s| s.numerics.residual_m <= tolerance))
        .count("iteration_count", count(|s| s.numerics.effort.iterations as usize))
        .count("pair_evaluation_count", count(|s| s.numerics.effort.pairs as usize))
        .count("product_count", count(|s| s.numerics.effort.products as usize))
        .count("transform_count", count(|s| s.numerics.effort.transforms as usize))
        .f64("load", steps.iter().map(|s| s.load_n / problem.load_unit_n()))
        .f64("area", steps.iter().map(|s| s.area_m2 / area_unit))
        .f64("penetration", steps.iter().map(|s| s.approach_m / problem.rms_height_m))
        .text("method", repeat_n(METHOD, steps.len()))
        .f64("residual", repeat_n(None::<f64>, steps.len()))
        .f64("stiffness_n_m", repeat_n(None::<f64>, steps.len()))
        .f64("stiffness", repeat_n(None::<f64>, steps.len()))
        .f64("reversal_load", reversals)
        .build()?)
}

/// Centre of each stored contact spot \[m\]. Numbers of merged spots go on during each unloading from that of its load reversal.
fn centres(cycle: &Cycle, summits: &[Summit]) -> Vec<Option<[f64; 2]>> {
    let branch = |step: usize| cycle.steps[step].max_load.map(f64::to_bits);
    let merged: HashMap<_, _> = cycle.merged.iter().map(|m| ((branch(m.step), m.asperity), m.spot.place_m)).collect();
    let of_asperity = |i: usize| summits.get(i).map(|summit| [summit.x_m, summit.y_m]);
    let of_merged = |step: usize, i: usize| merged.get(&(branch(step), i)).or_else(|| merged.get(&(None, i))).copied();
    cycle.contacts.iter().map(|spot| of_asperity(spot.asperity).or_else(|| of_merged(spot.step, spot.asperity))).collect()
}

pub(super) fn contacts(of: Identity<'_>, cycle: &Cycle, summits: &[Summit]) -> Result<Frame, StageError> {
    let (spots, centres) = (&cycle.contacts, centres(cycle, summits));
    let centre = |axis: usize| centres.iter().map(move |centre| centre.map(|centre| centre[axis]));
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
        .text("method", repeat_n(METHOD, spots.len()))
        .f64("centroid_x_m", centre(0))
        .f64("centroid_y_m", centre(1))
        .f64("area_m2", repeat_n(None::<f64>, spots.len()))
        .f64("perimeter_m", repeat_n(None::<f64>, spots.len()))
        .i64("summit_count", repeat_n(None::<i64>, spots.len()))
        .build()?)
}

pub(super) fn events(of: Identity<'_>, cycle: &Cycle) -> Result<Frame, StageError> {
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
        .text("method", repeat_n(METHOD, events.len()))
        .build()?)
}
