//! Deng and Kesari's estimates of a cycle: of flat surfaces, and with the radius of a probe.

use super::super::StageError;
use crate::model::Material;
use crate::physics::surface::spectrum::{Moments, Spectrum};
use crate::physics::theory::estimates::{CycleEstimates, DengKesari, SurfaceEstimates};
use crate::physics::theory::probe_loss::ProbeAreas;
use crate::schema::{DENG_KESARI, DENG_KESARI_PROBE, DENG_KESARI_PROBE_REALISED, DENG_KESARI_REALISED};
use crate::spec::CaseParams;
use crate::store::FrameBuilder;
use std::iter::repeat_n;

/// Columns of the estimates, one row for each load reversal.
pub(super) fn columns(
    frame: FrameBuilder,
    params: &CaseParams,
    material: &Material,
    (surface, target): (&SurfaceEstimates, Option<&Spectrum>),
    all: &CycleEstimates,
) -> Result<FrameBuilder, StageError> {
    let (loads, nominal_m2) = (&params.cycle.max_load, surface.nominal_area_m2());
    // JKR holds on a half-space.
    let radius_m = params.probe.filter(|_| params.substrate.is_none()).map(|probe| probe.radius_m);
    let of_probe = |moments: Option<Moments>| {
        let pair = radius_m.zip(moments);
        let loss = pair.map(|(radius, moments)| DengKesari::of_probe(&moments, material, nominal_m2, radius));
        loss.transpose()
    };
    let estimates = [
        (&DENG_KESARI, all.deng_kesari),
        (&DENG_KESARI_REALISED, Some(all.deng_kesari_realised)),
        (&DENG_KESARI_PROBE, of_probe(target.map(Spectrum::moments))?),
        (&DENG_KESARI_PROBE_REALISED, of_probe(Some(surface.roughness.moments()))?),
    ];
    let areas = probe_areas(radius_m, material, loads, nominal_m2)?;
    let area =
        |value: fn(&ProbeAreas) -> f64| areas.iter().map(move |of| of.map(|of| value(&of) / nominal_m2));
    let mut frame = frame
        .f64("area_jkr_probe", area(|of| of.reversal_m2))
        .f64("area_jkr_jump_in", area(|of| of.jump_in_m2));
    for (columns, of) in estimates {
        for (place, column) in columns.iter().enumerate() {
            let value = of.and_then(|of| of.nominal_j[place]).filter(|value| value.is_finite());
            frame = frame.f64(column.name, repeat_n(value, loads.len()));
        }
    }
    Ok(frame)
}

/// Contact areas of the smooth probe at each load `F/(E* A0)`; nothing without a probe.
fn probe_areas(
    radius_m: Option<f64>,
    material: &Material,
    loads: &[f64],
    nominal_m2: f64,
) -> Result<Vec<Option<ProbeAreas>>, StageError> {
    let unit_n = material.contact_modulus_pa * nominal_m2;
    let at = |load: &f64| match radius_m {
        Some(radius_m) => Ok(ProbeAreas::of(radius_m, material, load * unit_n)?),
        None => Ok(None),
    };
    loads.iter().map(at).collect()
}
