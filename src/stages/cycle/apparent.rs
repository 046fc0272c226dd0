//! Apparent works of adhesion of a cycle with a probe, as of an experiment.

use super::super::StageError;
use super::Computed;
use crate::physics::cycle::{Branch, Cycle, Step};
use crate::physics::theory::probe::{Branch as Fitted, JkrFit, Probe};
use crate::spec::CaseParams;
use crate::store::FrameBuilder;
use std::f64::consts::PI;

/// Apparent works of adhesion of the loop of one load reversal, and the extent of its contact.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Apparent {
    pull_off_j_m2: Option<f64>,
    loss_j_m2: Option<f64>,
    approach: Option<JkrFit>,
    retraction: Option<JkrFit>,
    extent: Option<f64>,
}

impl Apparent {
    /// Of the loop whose loading ends at the step `turning` with the load `max_load`, on a square of a side
    /// \[m\]. Nothing without a probe.
    fn of(
        cycle: &Cycle<()>,
        (turning, max_load): (usize, f64),
        params: &CaseParams,
        length_m: f64,
    ) -> Result<Self, StageError> {
        // JKR holds on a half-space.
        let Some(sphere) = params.probe.filter(|_| params.substrate.is_none()) else {
            return Ok(Self {
                extent: params.probe.and_then(|_| extent(cycle, turning, length_m)),
                ..Self::default()
            });
        };
        let probe = Probe::new(sphere.radius_m, Some(params.material.contact_modulus_pa))?;
        let loading: Vec<&Step> =
            cycle.steps[..=turning].iter().filter(|step| step.branch == Branch::Loading).collect();
        let unloading: Vec<&Step> =
            cycle.steps.iter().filter(|step| step.max_load == Some(max_load)).collect();
        let work_j = |steps: &[&Step]| steps.last().map_or(0.0, |step| step.work_j);
        let pull_off_n = unloading.iter().map(|step| -step.least_load_n).fold(0.0, f64::max);
        let loss_j = work_j(&loading) + work_j(&unloading);
        let columns = |steps: &[&Step]| -> [Vec<f64>; 2] {
            let each = |value: fn(&Step) -> f64| steps.iter().map(|step| value(step)).collect();
            [each(|step| step.load_n), each(|step| step.area_m2)]
        };
        let ([load_n, area_m2], [back_n, back_m2]) = (columns(&loading), columns(&unloading));
        let works = probe.apparent_works(
            Some(pull_off_n).filter(|force| *force > 0.0),
            Some(loss_j).filter(|energy| *energy > 0.0),
            Fitted { load_n: &load_n, area_m2: &area_m2 },
            Fitted { load_n: &back_n, area_m2: &back_m2 },
        )?;
        Ok(Self {
            pull_off_j_m2: works.pull_off_j_m2,
            loss_j_m2: works.loss_j_m2,
            approach: works.approach,
            retraction: works.retraction,
            extent: extent(cycle, turning, length_m),
        })
    }
}

/// Those of each load reversal, with its step and load; nothing for a load that is not reached.
pub(super) fn of_reversals(
    computed: &Computed,
    reversals: &[Option<(usize, f64)>],
    params: &CaseParams,
) -> Result<Vec<Apparent>, StageError> {
    let of_loop = |at| Apparent::of(&computed.cycle, at, params, computed.area_m2.sqrt());
    reversals.iter().map(|turning| turning.map_or(Ok(Apparent::default()), of_loop)).collect()
}

/// Largest distance of a contact edge from the middle of a square at a step, over its side; nothing if the
/// contacts of the step are not kept.
fn extent(cycle: &Cycle<()>, step: usize, length_m: f64) -> Option<f64> {
    let of_step = cycle.contacts.iter().filter(|contact| contact.step == step && !contact.covered);
    let edge = |centre: [f64; 2], area_m2: Option<f64>, radius_m: f64| {
        let [x, y] = centre.map(|place| place - 0.5 * length_m);
        (x.hypot(y) + area_m2.map_or(radius_m, |area_m2| (area_m2 / PI).sqrt())) / length_m
    };
    let edges = of_step.filter_map(|contact| {
        let area_m2 = contact.region.map(|region| region.area_m2);
        Some(edge(contact.centroid_m?, area_m2, contact.contact_radius_m))
    });
    edges.reduce(f64::max)
}

/// Largest residual of a fit over the maximum magnitude of the load: beyond, the branch is not that of JKR.
const LARGEST_RESIDUAL: f64 = 0.1;

/// Work of adhesion of a fit that describes its branch.
fn work(fit: Option<JkrFit>) -> Option<f64> {
    let fit = fit.filter(|fit| fit.residual <= LARGEST_RESIDUAL)?;
    fit.work_j_m2.map(|work| work.value)
}

/// Columns of the table of estimates, one row for each load reversal.
pub(super) fn columns(frame: FrameBuilder, all: &[Apparent]) -> FrameBuilder {
    let each = |value: fn(&Apparent) -> Option<f64>| all.iter().map(value);
    frame
        .f64("work_pull_off_j_m2", each(|of| of.pull_off_j_m2))
        .f64("work_loss_j_m2", each(|of| of.loss_j_m2))
        .f64("work_approach_j_m2", each(|of| work(of.approach)))
        .f64("work_retraction_j_m2", each(|of| work(of.retraction)))
        .f64("fit_residual_approach_n", each(|of| of.approach.map(|fit| fit.residual_n)))
        .f64("fit_residual_retraction_n", each(|of| of.retraction.map(|fit| fit.residual_n)))
        .f64("probe_extent", each(|of| of.extent))
}
