//! Surfaces of a run: spectrum, scale and tasks.

use super::runner::Context;
use super::{StageError, failure};
use crate::campaign::{Campaign, CycleUnit, Stage, SurfaceUnit};
use crate::physics::surface::spectrum::Spectrum;
use crate::spec::{CaseParams, SurfaceParams};
use crate::store::hdf5::{SurfaceHeader, read_header};
use std::collections::HashMap;

/// Target spectrum of a generated surface.
pub(super) fn spectrum(params: &SurfaceParams) -> Spectrum {
    Spectrum {
        length_m: params.length_m,
        rms_height_m: params.rms_height_m,
        hurst: params.hurst,
        magnification: params.magnification,
        normalization: params.normalization,
        amplitudes: params.amplitudes,
    }
}

/// Target spectrum of a case; a measured surface has none.
pub(super) fn target(params: &CaseParams) -> Option<Spectrum> {
    (!params.surface.is_measured()).then(|| spectrum(&params.surface))
}

/// Units of the lengths and heights of a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// Side of the square \[m\].
    pub(super) length_m: f64,
    /// Rms height: target of a generated surface, value of a measured one \[m\].
    pub(super) rms_height_m: f64,
}

/// Scale of a surface; that of a measured one is read from its file.
pub(super) fn scale(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Scale, StageError> {
    if unit.params.is_measured() {
        let SurfaceHeader { length_m, rms_height_m, .. } = read_header(&campaign.surface_path(unit))?;
        return Ok(Scale { length_m, rms_height_m });
    }
    Ok(Scale { length_m: unit.params.length_m, rms_height_m: unit.params.rms_height_m })
}

/// Selected surfaces, with the cycles that need them.
pub(super) struct Surfaces<'a> {
    pub(super) context: Context<'a>,
    cycles: HashMap<&'a str, Vec<&'a CycleUnit>>,
}

impl<'a> Surfaces<'a> {
    pub(super) fn of(context: Context<'a>) -> Self {
        Self { context, cycles: failure::by_surface(context.campaign) }
    }

    pub(super) fn selected(&self) -> Vec<&SurfaceUnit> {
        let Context { campaign, task, .. } = self.context;
        campaign.surfaces.iter().enumerate().filter(|(place, _)| task.shard.holds(*place)).map(|(_, unit)| unit).collect()
    }

    /// Cycles of a surface.
    pub(super) fn cycles(&self, unit: &SurfaceUnit) -> &[&'a CycleUnit] {
        self.cycles.get(unit.id.as_str()).map_or(&[], Vec::as_slice)
    }

    /// True if a stage is not tried for a surface.
    pub(super) fn is_given_up(&self, unit: &SurfaceUnit, stage: Stage) -> bool {
        failure::given_up(self.context.campaign, self.cycles(unit), stage, &self.context.task.retried)
    }

    /// Removes the records of earlier failures at a stage.
    pub(super) fn forget(&self, unit: &SurfaceUnit, stage: Stage) {
        failure::forget(self.context.campaign, self.cycles(unit), stage);
    }
}
