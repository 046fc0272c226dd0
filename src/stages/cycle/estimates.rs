//! Table of the analytical estimates of a cycle.

use super::super::StageError;
use super::super::estimates::{finite, ratio_columns, read_surface_estimates, target};
use super::super::identity::Identity;
use super::super::surface::scale;
use super::{Computed, CycleTask};
use super::{apparent, deng_kesari};
use crate::physics::EventKind;
use crate::physics::cycle::soundness::LoopEnergy;
use crate::physics::cycle::{Branch, Cycle, Event};
use crate::physics::theory::estimates::{CycleEstimates, LoadEstimates, Tabor};
use crate::schema::ESTIMATES;
use crate::store::Frame;
use std::iter::repeat_n;

/// One row for each load reversal of the spec.
pub(super) fn table(task: CycleTask<'_>, computed: &Computed) -> Result<Frame, StageError> {
    let (campaign, params) = (task.campaign, task.params());
    let surface = read_surface_estimates(&campaign.estimates_path(&campaign.surfaces[task.unit.surface]))?;
    let scale = scale(campaign, &campaign.surfaces[task.unit.surface])?;
    let (target, material) = (target(params), &scale.material(&params.material));
    let all =
        CycleEstimates::of(&surface, target.as_ref(), &computed.summits, material, &computed.adhesionless)?;
    let (loads, nominal_m2) = (&params.cycle.max_load, surface.nominal_area_m2());
    let rms_height_m = computed.rms_height_m;
    let energy_scale_j = params.material.contact_modulus_pa * nominal_m2 * rms_height_m;
    let same = |value: Option<f64>| repeat_n(value.filter(finite), loads.len());
    let at_load: Vec<LoadEstimates> = loads.iter().map(|load| all.at_load(*load)).collect();
    let each = |value: fn(&LoadEstimates) -> Option<f64>, unit: f64| {
        at_load.iter().map(move |at| value(at).map(|value| value / unit))
    };
    let touched = |(turning, load): &(usize, f64)| {
        all.isolated_loss_j(&touched(&computed.cycle, *turning, *load)) / energy_scale_j
    };
    let reversals = reversals(&computed.cycle, loads);
    let by_asperities = |turning: &Option<(usize, f64)>| {
        turning.as_ref().filter(|_| computed.per_wavelength.is_none()).map(touched)
    };
    let per_wavelength = computed.per_wavelength.map(|points| surface.per_shortest_wavelength(points));
    let tabor = |value: fn(&Tabor) -> f64| same(all.tabor.as_ref().map(value));
    let mut frame = Identity::of(campaign, task.unit)
        .begin(&ESTIMATES, loads.len())
        .f64("max_load", loads.iter().copied())
        .f64("energy_scale_j", same(Some(energy_scale_j)))
        .f64("loss_dalvi_nominal_j", same(Some(all.dalvi_nominal_j)))
        .f64("loss_pinning_nominal_j", same(all.pinning_nominal_j))
        .f64("resolution_j", reversals.iter().map(|turning| resolution_j(&computed.cycle, *turning)))
        .f64("tabor_min", tabor(|of| of.min))
        .f64("tabor_median", tabor(|of| of.median))
        .f64("tabor_max", tabor(|of| of.max))
        .f64("tabor_mean", tabor(|of| of.mean))
        .f64("low_tabor_share", tabor(|of| of.low_share))
        .f64("fuller_tabor", same(all.fuller_tabor))
        .f64("elements_per_wavelength", same(per_wavelength))
        .f64("area_adhesionless", at_load.iter().map(|at| at.area_adhesionless))
        .f64("area_adhesionless_small", at_load.iter().map(|at| at.area_adhesionless_small))
        .f64("area_jkr_curve", each(|at| at.jkr_curve.map(|found| found.area_m2), nominal_m2))
        .f64("pull_off_jkr_curve", each(|at| at.jkr_curve.map(|found| found.pull_off_m2), nominal_m2))
        .f64("loss_jkr_curve", each(|at| at.jkr_curve.map(|found| found.loss_m3), nominal_m2 * rms_height_m))
        .f64("loss_touched", reversals.iter().map(by_asperities));
    frame = apparent::columns(frame, &apparent::of_reversals(computed, &reversals, params)?);
    for (name, value) in ratio_columns(&all.ratios) {
        frame = frame.f64(name, same(value));
    }
    frame = deng_kesari::columns(frame, params, material, (&surface, target.as_ref()), &all)?;
    Ok(frame.build()?)
}

/// Step and load of each load reversal of the spec; nothing for a load that is not reached.
fn reversals(cycle: &Cycle<()>, loads: &[f64]) -> Vec<Option<(usize, f64)>> {
    loads
        .iter()
        .enumerate()
        .map(|(at, load)| cycle.turning.get(at).map(|(step, ())| (*step, *load)))
        .collect()
}

/// Asperities that jumped into contact in the loop of a load reversal, each once, ascending.
fn touched(cycle: &Cycle<()>, turning: usize, max_load: f64) -> Vec<usize> {
    let is_in_loop = |event: &&Event| match cycle.steps[event.step].max_load {
        None => event.step <= turning,
        Some(load) => load == max_load,
    };
    let jumps = cycle.events.iter().filter(is_in_loop).filter(|event| event.kind == EventKind::JumpIn);
    let mut touched: Vec<usize> = jumps.filter_map(Event::asperity).collect();
    touched.sort_unstable();
    touched.dedup();
    touched
}

/// Dissipated energy below which that of a loop is not resolved \[J\]; nothing without its unloading.
fn resolution_j(cycle: &Cycle<()>, turning: Option<(usize, f64)>) -> Option<f64> {
    let (turning, max_load) = turning?;
    let loading = || cycle.steps[..=turning].iter().filter(|step| step.branch == Branch::Loading);
    let unloading = || cycle.steps.iter().filter(|step| step.max_load == Some(max_load));
    let at_reversal = loading().next_back()?.work_j;
    let loss_j = at_reversal + unloading().next_back()?.work_j;
    let works = loading().map(|step| step.work_j).chain(unloading().map(|step| at_reversal + step.work_j));
    let work_j = works.map(f64::abs).fold(0.0, f64::max);
    // Without adhesion the events of loading are undone on unloading, and nothing but rounding remains.
    let events = || {
        loading().map(|step| step.dissipated_j).sum::<f64>()
            + unloading().map(|step| step.dissipated_j).sum::<f64>()
    };
    let events_j = if loss_j == 0.0 { 0.0 } else { events() };
    Some(LoopEnergy { loss_j, events_j, work_j }.resolution_j())
}
