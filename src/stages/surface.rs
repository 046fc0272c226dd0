//! Surfaces of a run: spectrum, scale and tasks.

use super::done::Outcome;
use super::failure::in_the_way;
use super::runner::{Context, Tasks};
use super::{StageError, failure};
use crate::campaign::{Campaign, CycleUnit, Stage, Standing, SurfaceUnit, Unit};
use crate::model::{GeneratedSurface, Material, SurfaceSource};
use crate::stats::MOST_LEFT_OUT;
use crate::store::hdf5::{SurfaceHeader, read_header};
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::marker::PhantomData;

/// Units of the lengths and heights of a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// Side of the square \[m\].
    pub(super) length_m: f64,
    /// Rms height: target of a generated surface, value of a measured one \[m\].
    pub(super) rms_height_m: f64,
    /// Flattening of the wavelengths of a tabulated spectrum below the shortest one, `U_el/E*` \[m\].
    pub(super) left_out_m: f64,
}

impl Scale {
    /// Scale of a generated surface whose spectrum is known.
    pub(super) fn of_generated(surface: &GeneratedSurface) -> Self {
        let GeneratedSurface { length_m, rms_height_m, .. } = *surface;
        Self { length_m, rms_height_m, left_out_m: surface.spectrum().left_out_m() }
    }

    /// Scale of a surface with this header.
    pub(super) fn of(header: &SurfaceHeader) -> Self {
        let generated = header.generated.as_ref();
        Self {
            length_m: header.length_m,
            rms_height_m: generated.map_or(header.rms_height_m, |of| of.target_rms_height_m),
            left_out_m: generated.and_then(|of| of.left_out_m).unwrap_or_default(),
        }
    }

    /// Material of a cycle: the elastic energy of roughness below the shortest wavelength of a tabulated
    /// spectrum is subtracted from the work of adhesion, where it is small.
    pub(super) fn material(self, material: &Material) -> Material {
        let energy_j_m2 = material.contact_modulus_pa * self.left_out_m;
        let mut material = *material;
        if energy_j_m2 <= MOST_LEFT_OUT * material.work_of_adhesion_j_m2 {
            material.work_of_adhesion_j_m2 -= energy_j_m2;
        }
        material
    }
}

/// Scale of a surface; that of a measured one, and of a table whose file is missing, is read from its file.
pub(super) fn scale(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Scale, StageError> {
    if let SurfaceSource::Generated(surface) = &unit.params
        && surface.has_spectrum()
    {
        return Ok(Scale::of_generated(surface));
    }
    Ok(Scale::of(&read_header(&campaign.surface_path(unit))?))
}

/// A stage with one task for each surface.
pub(super) trait SurfaceStage {
    /// The stage.
    const STAGE: Stage;

    /// Identity of the task of a surface.
    fn unit(of: &SurfaceUnit) -> Unit<'_>;

    /// Task of an earlier stage that writes the input.
    fn input(of: &SurfaceUnit) -> Option<Unit<'_>>;

    /// Computes the task of a surface and writes its files.
    fn compute(campaign: &Campaign, of: &SurfaceUnit) -> Result<Outcome, StageError>;
}

/// Tasks of a stage: one for each selected surface, with the cycles that need it.
pub(super) struct Surfaces<'a, S> {
    context: Context<'a>,
    cycles: HashMap<&'a str, Vec<&'a CycleUnit>>,
    stage: PhantomData<fn() -> S>,
}

impl<'a, S> Surfaces<'a, S> {
    pub(super) fn of(context: Context<'a>) -> Self {
        Self { context, cycles: failure::by_surface(context.campaign), stage: PhantomData }
    }

    /// Cycles of a surface.
    fn cycles_of(&self, unit: &SurfaceUnit) -> &[&'a CycleUnit] {
        self.cycles.get(unit.id.as_str()).map_or(&[], Vec::as_slice)
    }
}

impl<S: SurfaceStage> Tasks for Surfaces<'_, S> {
    type Of = SurfaceUnit;

    const STAGE: Stage = S::STAGE;

    fn selected(&self) -> Vec<&SurfaceUnit> {
        let Context { campaign, task, .. } = self.context;
        campaign
            .surfaces
            .iter()
            .enumerate()
            .filter(|(place, _)| task.shard.holds(*place))
            .map(|(_, unit)| unit)
            .collect()
    }

    fn unit<'a>(&self, of: &'a SurfaceUnit) -> Unit<'a> {
        S::unit(of)
    }

    fn key_inputs(&self, of: &SurfaceUnit) -> Map<String, Value> {
        self.context.campaign.surface_preimages(of, S::STAGE)
    }

    fn standing(&self, of: &SurfaceUnit) -> Standing {
        self.context.campaign.standing(&S::unit(of), self.context.task.check)
    }

    fn is_given_up(&self, of: &SurfaceUnit, _: &Standing) -> bool {
        failure::given_up(self.context.campaign, self.cycles_of(of), S::STAGE, &self.context.task.retried)
    }

    fn input(&self, of: &SurfaceUnit) -> Option<(String, Standing)> {
        let Context { campaign, task, .. } = self.context;
        S::input(of).map(|unit| (of.id.clone(), campaign.standing(&unit, task.check)))
    }

    fn compute(&self, of: &SurfaceUnit) -> Result<Outcome, StageError> {
        let Context { campaign, watch, .. } = self.context;
        let outcome = in_the_way(campaign, &S::unit(of)).and_then(|()| S::compute(campaign, of));
        watch.progress(S::STAGE, 1.0);
        outcome
    }

    fn cycles<'a>(&'a self, of: &'a SurfaceUnit) -> Vec<&'a CycleUnit> {
        self.cycles_of(of).to_vec()
    }

    fn clean_up(&self, of: &SurfaceUnit) {
        failure::forget(self.context.campaign, self.cycles_of(of), S::STAGE);
    }
}
