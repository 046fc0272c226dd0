//! A cycle by boundary elements, and the files that only this method writes.

mod announced;
mod cost;
mod lattice;
mod setup;
mod slow_grid;

pub(in crate::stages) use announced::announced;
pub(super) use cost::{LONG, OF_POINTS};
pub(in crate::stages) use lattice::{Lattice, Square};

use super::super::StageError;
use super::super::cost::Cost;
use super::super::identity::Identity;
use super::super::previews::Known;
use super::{Computed, CycleTask, serialized};
use crate::campaign::{Campaign, CycleUnit};
use crate::model::{ElementOptions, SurfaceSource};
use crate::physics::cycle::{Cycle, Map, Method};
use crate::physics::elements::path::cycle::Turning;
use crate::physics::elements::{Elements, FreeStep};
use crate::physics::theory::approximate_jkr::CurvePoint;
use crate::schema;
use crate::spec::CaseParams;
use crate::store::{ContactMap, Frame, MapsHeader, read_halfway, write_maps, write_state};
use lattice::{checked_lattice, enough_memory};
use setup::{Setup, setup};
use std::path::{Path, PathBuf};

/// A case of boundary elements.
#[derive(Clone, Copy)]
pub(super) struct ElementsCase<'a> {
    pub(super) params: &'a CaseParams,
    pub(super) options: &'a ElementOptions,
}

impl ElementsCase<'_> {
    /// Grid of a case on a generated surface, or on the square of a measured one; nothing without it.
    pub(super) fn lattice(self, square: Option<Square>) -> Option<Lattice> {
        match &self.params.surface {
            SurfaceSource::Generated(surface) => Some(Lattice::of_generated(self, surface)),
            SurfaceSource::Measured(_) => Some(Lattice::of_measured(self, square?)),
        }
    }

    /// Steps over the gaps at which an attraction with a range acts; nothing in the JKR limit.
    fn range_steps(self, lattice: &Lattice, rms_height_m: f64) -> Option<f64> {
        Some(self.options.range_steps(lattice.range_m?, rms_height_m, self.params.cycle.max_load.len()))
    }

    /// Memory and time of a cycle at a ratio `U_el/Δγ`, on a generated surface or on a measured one that is
    /// known.
    pub(super) fn cost(self, known: Option<&Known>, ratio: Option<f64>) -> Option<Cost> {
        let lattice = self.lattice(known.map(|known| Square::of(self.params, &known.header)))?;
        let of_generated = self.params.surface.generated().map(|surface| surface.rms_height_m);
        let rms_height_m = of_generated.or_else(|| known.map(|known| known.header.rms_height_m))?;
        let range_steps = self.range_steps(&lattice, rms_height_m).unwrap_or_default();
        let cost = cost::cost(&lattice, self.params, ratio, range_steps);
        let shortest =
            known.and_then(Known::found).map_or(1.0, |found| found.estimates.per_shortest_wavelength(1.0));
        Some(Cost { per_wavelength: shortest * cost.per_wavelength, ..cost })
    }

    /// The error by which cycles fail, as far as it is known before them.
    pub(super) fn refusal(self, known: Option<&Known>) -> Option<StageError> {
        match (known, &self.params.surface) {
            (Some(known), _) => checked_lattice(self, &known.header, known.header.rms_height_m).err(),
            (None, SurfaceSource::Generated(surface)) => {
                let lattice = Lattice::of_generated(self, surface);
                let memory = enough_memory(lattice.points, self.params.cycle.max_load.len()).err();
                let medium = || self.refusal_of_medium(surface.length_m, lattice.points);
                let of_medium = || medium().map(|(problem, help)| StageError::Range { problem, help });
                memory.map(StageError::from).or_else(of_medium)
            }
            (None, SurfaceSource::Measured(_)) => None,
        }
    }
}

/// Computes a cycle.
pub(super) fn run(task: &CycleTask<'_>, options: &ElementOptions) -> Result<Computed, StageError> {
    let (campaign, unit) = (task.campaign, task.unit);
    let Setup { method, summits, per_wavelength } =
        setup(campaign, unit, ElementsCase { params: task.params(), options })?;
    let cycle = task.follow(&method)?;
    let (size, units, dir) = (method.size(), method.units, campaign.cycle_dir(unit));
    let contact_gap_m = method.problem.law.true_contact_gap() * units.spacing_m();
    let free = method.load_without_adhesion(&cycle)?;
    let points = units.own_points();
    let length_m = points as f64 * units.spacing_m();
    let header = MapsHeader {
        key: &unit.key,
        cycle_id: &unit.id,
        length_m,
        points,
        first_m: units.first_m,
        contact_gap_m,
    };
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
        summits,
        adhesionless: free.iter().map(|step| curve_point(step, units.modulus_pa)).collect(),
        per_wavelength: Some(per_wavelength),
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

/// Point of the adhesionless curve, with E* \[Pa\].
fn curve_point(step: &FreeStep, modulus_pa: f64) -> CurvePoint {
    CurvePoint {
        penetration_m: step.mean_penetration_m,
        load_m2: step.load_n / modulus_pa,
        area_m2: step.area_m2,
    }
}

/// Maps as they are stored, with the load at their reversal.
fn maps<S>(cycle: &Cycle<S>, max_loads: &[f64]) -> Vec<ContactMap> {
    let reversal_load = |step: usize| {
        cycle.turning.iter().position(|(at, _)| *at == step).and_then(|at| max_loads.get(at)).copied()
    };
    let stored = |map: &Map| {
        let step = &cycle.steps[map.step];
        let values = |field: &[f32]| {
            field.iter().map(|value| if map.is_further { rounded(*value) } else { *value }).collect()
        };
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
pub(super) fn unload_again(
    campaign: &Campaign,
    unit: &CycleUnit,
    options: &ElementOptions,
    max_load: f64,
) -> Result<Cycle<()>, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let Setup { method, .. } = setup(campaign, unit, ElementsCase { params, options })?;
    let path = turning_path(&campaign.cycle_dir(unit));
    let states: Option<Vec<Turning>> =
        read_halfway(&path, &unit.key).and_then(|bytes| postcard::from_bytes(&bytes).ok());
    let reversal = params.cycle.max_load.iter().position(|load| *load == max_load);
    let kept = || format!("the loads {:?}", params.cycle.max_load);
    let lacking = || StageError::NoTurning { max_load, path: path.clone(), kept: kept() };
    let reversal = reversal.ok_or_else(lacking)?;
    let turning = states
        .and_then(|mut all| (reversal < all.len()).then(|| all.swap_remove(reversal)))
        .ok_or_else(lacking)?;
    if turning.state.displacement.len() != method.problem.half_space.points() {
        return Err(lacking());
    }
    Ok(method.unload_from(reversal, turning)?.without_states())
}
