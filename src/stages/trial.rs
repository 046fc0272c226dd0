//! Errors of the asperity model on generated surfaces before a run: the first surface of a case is made, and its asperities are checked.

use super::cycle::checked;
use super::surface::Scale;
use crate::campaign::{Campaign, CaseUnit, CycleUnit};
use crate::physics::surface::spectrum::Spectrum;
use crate::physics::surface::summits::{Summit, find_summits};
use crate::physics::surface::synthesis::{realization_seed, synthesize};
use std::cell::RefCell;
use std::collections::HashMap;

/// Largest number of points along a side of a surface that is made before a run.
const LARGEST: usize = 256;
/// Maximum number of such surfaces.
const MOST: usize = 8;

/// Asperities of surfaces made before a run, by their places in [`Campaign::surfaces`].
#[derive(Default)]
pub(super) struct Trial(RefCell<HashMap<usize, Vec<Summit>>>);

impl Trial {
    /// The error by which the first cycle of a case by the asperity model fails; nothing if it is not known.
    pub(super) fn error(&self, campaign: &Campaign, unit: &CaseUnit, cycle: &CycleUnit) -> Option<String> {
        let (params, surface) = (&unit.case.params, &campaign.surfaces[cycle.surface]);
        let grid = surface.params.grid() as usize;
        let mut known = self.0.borrow_mut();
        if params.by_elements()
            || surface.params.is_measured()
            || grid > LARGEST
            || (known.len() >= MOST && !known.contains_key(&cycle.surface))
        {
            return None;
        }
        let scale = Scale { length_m: params.surface.length_m, rms_height_m: params.surface.rms_height_m };
        let summits = known.entry(cycle.surface).or_insert_with(|| {
            let seed = realization_seed(campaign.spec.seed, u64::from(surface.realization));
            let heights_m = synthesize(&Spectrum::from(&surface.params), &seed, grid).heights_m;
            let per_wavelength = f64::from(surface.params.points_per_shortest_wavelength);
            find_summits(heights_m.view(), surface.params.length_m, per_wavelength).map(|found| found.list).unwrap_or_default()
        });
        checked(params, scale, summits).err().map(|error| error.to_string())
    }
}
