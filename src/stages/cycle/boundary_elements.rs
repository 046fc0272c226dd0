//! A cycle by boundary elements, and the files that only this method writes.

use super::super::StageError;
use super::super::identity::Identity;
use super::elements_setup::setup;
use super::{Computed, CycleTask, serialized};
use crate::campaign::{Campaign, CycleUnit};
use crate::physics::cycle::{Cycle, Map, Method};
use crate::physics::elements::path::cycle::Turning;
use crate::physics::elements::{Elements, FreeStep};
use crate::schema;
use crate::store::{ContactMap, Frame, MapsHeader, read_halfway, write_maps, write_state};
use std::path::{Path, PathBuf};

pub(super) fn run(task: &CycleTask<'_>) -> Result<Computed, StageError> {
    let (campaign, unit) = (task.campaign, task.unit);
    let method = setup(campaign, unit)?;
    let cycle = task.follow(&method)?;
    let (size, units, dir) = (method.size(), method.units, campaign.cycle_dir(unit));
    let contact_gap_m = method.problem.law.contact_gap() * units.spacing_m();
    let free = method.load_without_adhesion(&cycle)?;
    let points = units.own_points();
    let length_m = points as f64 * units.spacing_m();
    let header = MapsHeader { key: &unit.key, cycle_id: &unit.id, length_m, points, first_m: units.first_m, contact_gap_m };
    let states: Vec<&Turning> = cycle.turning.iter().map(|(_, state)| state).collect();
    let states = serialized(&states).map_err(|error| StageError::State { what: error.to_string() })?;
    let files = vec![
        write_maps(&dir.join("maps.h5"), &header, &maps(&cycle, &task.params().cycle.max_load))?,
        write_state(&turning_path(&dir), &unit.key, &states)?,
    ];
    Ok(Computed {
        method: Elements::NAME,
        size,
        cycle: cycle.without_states(),
        tables: vec![adhesionless(Identity::of(campaign, unit), &free)?],
        files,
        load_unit_n: units.modulus_pa * length_m * length_m,
        area_m2: length_m * length_m,
        rms_height_m: units.rms_height_m,
    })
}

fn adhesionless(of: Identity<'_>, steps: &[FreeStep]) -> Result<Frame, StageError> {
    let each = |value: fn(&FreeStep) -> f64| steps.iter().map(value);
    Ok(of
        .begin(&schema::ADHESIONLESS, steps.len())
        .i64("step", (0..steps.len()).map(|k| k as i64))
        .f64("approach_m", each(|step| step.mean_penetration_m))
        .f64("load_n", each(|step| step.load_n))
        .f64("area_m2", each(|step| step.area_m2))
        .bool("converged", steps.iter().map(|step| step.is_converged))
        .count("transform_count", steps.iter().map(|step| step.transforms as usize))
        .build()?)
}

/// Maps as they are stored, with the load at their reversal.
fn maps<S>(cycle: &Cycle<S>, max_loads: &[f64]) -> Vec<ContactMap> {
    let reversal_load = |step: usize| cycle.turning.iter().position(|(at, _)| *at == step).and_then(|at| max_loads.get(at)).copied();
    let stored = |map: &Map| {
        let step = &cycle.steps[map.step];
        let values = |field: &[f32]| field.iter().map(|value| if map.is_further { rounded(*value) } else { *value }).collect();
        ContactMap {
            step: map.step as i64,
            branch: step.branch.word(),
            max_load: step.max_load.or_else(|| reversal_load(map.step)).unwrap_or(f64::NAN),
            approach_m: step.mean_penetration_m,
            load_n: step.load_n,
            stride: map.stride,
            gap_m: values(&map.gap_m),
            pressure_pa: values(&map.pressure_pa),
        }
    };
    cycle.maps.iter().map(stored).collect()
}

/// A number with 10 bits of its mantissa, which compresses to less than half: relative error at most 2⁻¹¹.
fn rounded(value: f32) -> f32 {
    f32::from_bits(value.to_bits().wrapping_add(0x1000) & !0x1fff)
}

/// File of the states at the load reversals.
fn turning_path(dir: &Path) -> PathBuf {
    dir.join("turning.bin")
}

/// Unloads again from a load reversal of a finished cycle.
///
/// # Errors
/// The files of the cycle and of its surface must be complete, and contain that load.
pub(super) fn unload_again(campaign: &Campaign, unit: &CycleUnit, max_load: f64) -> Result<Cycle<()>, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let method = setup(campaign, unit)?;
    let path = turning_path(&campaign.cycle_dir(unit));
    let states: Option<Vec<Turning>> = read_halfway(&path, &unit.key).and_then(|bytes| postcard::from_bytes(&bytes).ok());
    let reversal = params.cycle.max_load.iter().position(|load| *load == max_load);
    let kept = || format!("the loads {:?}", params.cycle.max_load);
    let lacking = || StageError::NoTurning { max_load, path: path.clone(), kept: kept() };
    let reversal = reversal.ok_or_else(lacking)?;
    let turning = states.and_then(|mut all| (reversal < all.len()).then(|| all.swap_remove(reversal))).ok_or_else(lacking)?;
    if turning.state.displacement.len() != method.problem.half_space.points() {
        return Err(lacking());
    }
    Ok(method.unload_from(reversal, turning)?.without_states())
}
