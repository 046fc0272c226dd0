//! Tables of a cycle by boundary elements.

use super::super::StageError;
use super::super::identity::Identity;
use crate::physics::EventCounts;
use crate::physics::boundary_elements::adhesionless::FreeStep;
use crate::physics::boundary_elements::cycle::{Cycle, Step};
use crate::physics::boundary_elements::regions::Region;
use crate::physics::elements::Units;
use crate::schema;
use crate::store::Frame;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::iter::repeat_n;

/// Numbers of asperities in the regions of the steps.
pub(super) type Counts = Vec<(usize, Vec<u32>)>;

/// Word of the method in the tables.
const METHOD: &str = "boundary_elements";

pub(super) fn branch(step: &Step) -> &'static str {
    if step.reversal.is_some() { "unloading" } else { "loading" }
}

fn max_load(step: &Step, loads: &[f64]) -> Option<f64> {
    step.reversal.and_then(|at| loads.get(at)).copied()
}

pub(super) fn steps(of: Identity<'_>, cycle: &Cycle, loads: &[f64], units: &Units) -> Result<Frame, StageError> {
    let steps = &cycle.steps;
    let (spacing, load, energy, all) = (units.spacing_m(), units.load_n(), units.energy_j(), units.all());
    let each = |value: fn(&Step) -> f64, unit: f64| steps.iter().map(move |step| value(step) * unit);
    let zeros = || repeat_n(0_usize, steps.len());
    let nothing = || repeat_n(None::<f64>, steps.len());
    let mut counts = vec![EventCounts::default(); steps.len()];
    for event in &cycle.events {
        counts[event.step].extend([event.kind.kind()]);
    }
    let reversal_load = |step: usize| cycle.reversal_at(step).and_then(|at| loads.get(at)).copied();
    let area_m2: Vec<f64> = steps.iter().map(|step| step.totals.contact as f64 * units.area_m2()).collect();
    Ok(of
        .begin(&schema::STEPS, steps.len())
        .i64("step", (0..steps.len()).map(|k| k as i64))
        .text("branch", steps.iter().map(branch))
        .f64("max_load", steps.iter().map(|step| max_load(step, loads)))
        // Not −0.
        .f64("approach_m", each(|s| s.approach + 0.0, spacing))
        .f64("load_n", each(|s| s.totals.load, load))
        .f64("least_load_n", (0..steps.len()).map(|step| cycle.least_load(step) * load))
        .f64("area_m2", area_m2.iter().copied())
        .f64("area_union_m2", area_m2.iter().copied())
        .count("contact_count", steps.iter().map(|s| s.regions))
        .count("covered_count", zeros())
        .counts(counts)
        .count("held_count", zeros())
        .count("touching_count", zeros())
        .f64("dissipated_j", each(|s| s.dissipated, energy))
        .f64("work_j", each(|s| s.work, energy))
        .f64("residual_m", nothing())
        .f64("drift_m", nothing())
        .f64("stability", nothing())
        .bool("converged", steps.iter().map(|s| s.converged))
        .count("iteration_count", steps.iter().map(|s| s.iterations as usize))
        .count("pair_evaluation_count", zeros())
        .count("product_count", zeros())
        .count("transform_count", steps.iter().map(|s| s.transforms as usize))
        .f64("load", steps.iter().map(|s| s.totals.load / all))
        .f64("area", steps.iter().map(|s| s.totals.contact as f64 / all))
        .f64("penetration", steps.iter().map(|s| (s.approach + 0.0) * spacing / units.rms_height_m))
        .text("method", repeat_n(METHOD, steps.len()))
        .f64("residual", each(|s| s.residual, 1.0))
        .f64("stiffness_n_m", each(|s| s.stiffness, load / spacing))
        .f64("stiffness", each(|s| s.stiffness, units.rms_height_m / (all * spacing)))
        .f64("reversal_load", (0..steps.len()).map(reversal_load))
        .build()?)
}

pub(super) fn contacts(
    of: Identity<'_>,
    (cycle, kept): (&Cycle, &[(usize, Region)]),
    loads: &[f64],
    units: &Units,
    counts: &Counts,
) -> Result<Frame, StageError> {
    let mut rows: Vec<(usize, Region, Option<u32>)> = Vec::with_capacity(kept.len());
    let counted: HashMap<usize, &[u32]> = counts.iter().map(|(step, counts)| (*step, counts.as_slice())).collect();
    for of_step in kept.chunk_by(|a, b| a.0 == b.0) {
        let known = |at: usize| counted.get(&of_step[0].0).and_then(|counts| counts.get(at)).copied();
        rows.extend(of_step.iter().enumerate().map(|(at, (step, region))| (*step, *region, known(at))));
    }
    // Regions at the maximum tensile load are found when the branch ends: stable, so that those of a step keep their order.
    rows.sort_by_key(|row| row.0);
    let spacing = units.spacing_m();
    let step = |row: &(usize, Region, Option<u32>)| &cycle.steps[row.0];
    let area = |region: &Region| region.points as f64 * spacing * spacing;
    let nothing = || repeat_n(None::<f64>, rows.len());
    Ok(of
        .begin(&schema::CONTACTS, rows.len())
        .i64("step", rows.iter().map(|row| row.0 as i64))
        .text("branch", rows.iter().map(|row| branch(step(row))))
        .f64("max_load", rows.iter().map(|row| max_load(step(row), loads)))
        .i64("asperity_id", repeat_n(None::<i64>, rows.len()))
        .text("state", repeat_n("contact", rows.len()))
        .f64("contact_radius_m", rows.iter().map(|row| (area(&row.1) / PI).sqrt()))
        .f64("load_n", rows.iter().map(|row| row.1.load * units.point_load_n()))
        .f64("penetration_m", nothing())
        .f64("interaction_m", nothing())
        .text("method", repeat_n(METHOD, rows.len()))
        .f64("centroid_x_m", rows.iter().map(|row| units.place_m(row.1.centroid[0])))
        .f64("centroid_y_m", rows.iter().map(|row| units.place_m(row.1.centroid[1])))
        .f64("area_m2", rows.iter().map(|row| area(&row.1)))
        .f64("perimeter_m", rows.iter().map(|row| row.1.perimeter * spacing))
        .i64("summit_count", rows.iter().map(|row| row.2.map(i64::from)))
        .build()?)
}

pub(super) fn adhesionless(of: Identity<'_>, steps: &[FreeStep], units: &Units) -> Result<Frame, StageError> {
    let each = |value: fn(&FreeStep) -> f64, unit: f64| steps.iter().map(move |step| value(step) * unit);
    Ok(of
        .begin(&schema::ADHESIONLESS, steps.len())
        .i64("step", (0..steps.len()).map(|k| k as i64))
        .f64("approach_m", each(|step| step.approach, units.spacing_m()))
        .f64("load_n", each(|step| step.totals.load, units.load_n()))
        .f64("area_m2", each(|step| step.totals.contact as f64, units.area_m2()))
        .bool("converged", steps.iter().map(|step| step.converged))
        .count("transform_count", steps.iter().map(|step| step.transforms as usize))
        .build()?)
}

pub(super) fn events(of: Identity<'_>, cycle: &Cycle, loads: &[f64], units: &Units) -> Result<Frame, StageError> {
    let events = &cycle.events;
    let (spacing, load) = (units.spacing_m(), units.load_n());
    let step = |at: usize| &cycle.steps[at];
    let area = units.area_m2();
    Ok(of
        .begin(&schema::EVENTS, events.len())
        .i64("step", events.iter().map(|event| event.step as i64))
        .text("branch", events.iter().map(|event| branch(step(event.step))))
        .f64("max_load", events.iter().map(|event| max_load(step(event.step), loads)))
        .text("kind", events.iter().map(|event| event.kind.word()))
        .i64("asperity_id", repeat_n(None::<i64>, events.len()))
        .f64("approach_m", events.iter().map(|event| step(event.step).approach * spacing))
        .i64("avalanche_id", (0..events.len()).map(|k| k as i64))
        .f64("load_before_n", events.iter().map(|event| event.before.load * load))
        .f64("load_after_n", events.iter().map(|event| event.after.load * load))
        .f64("area_before_m2", events.iter().map(|event| event.before.contact as f64 * area))
        .f64("area_after_m2", events.iter().map(|event| event.after.contact as f64 * area))
        .f64("energy_lost_j", events.iter().map(|event| event.dissipated * units.energy_j()))
        .text("method", repeat_n(METHOD, events.len()))
        .build()?)
}
