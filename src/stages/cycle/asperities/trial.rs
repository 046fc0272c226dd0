//! Errors of the asperity model on generated surfaces before a run: the first surface of a case is made, and
//! its asperities are checked.

use super::{AsperityCase, checked};
use crate::campaign::{Campaign, CaseUnit, CycleUnit};
use crate::physics::surface::summits::{Summit, find_summits};
use crate::physics::surface::synthesis::{realization_seed, synthesize};
use crate::stages::StageError;
use crate::stages::surface::Scale;
use std::cell::RefCell;
use std::collections::HashMap;

/// Largest number of points along a side of a surface that is made before a run.
const LARGEST: usize = 256;
/// Maximum number of such surfaces.
const MOST: usize = 8;

/// Asperities of surfaces made before a run, by their places in [`Campaign::surfaces`].
#[derive(Default)]
pub(in crate::stages) struct Trial(RefCell<HashMap<usize, Result<Vec<Summit>, String>>>);

impl Trial {
    /// The error by which the first cycle of a case by the asperity model fails; nothing if it is not known.
    pub(in crate::stages) fn error(
        &self,
        campaign: &Campaign,
        unit: &CaseUnit,
        cycle: &CycleUnit,
    ) -> Option<String> {
        let (params, place) = (&unit.case.params, cycle.surface);
        let (options, surface) = (params.asperities()?, params.surface.generated()?);
        if !surface.has_spectrum() {
            return None;
        }
        let grid = surface.grid() as usize;
        let mut known = self.0.borrow_mut();
        if grid > LARGEST || (known.len() >= MOST && !known.contains_key(&place)) {
            return None;
        }
        let scale = Scale::of_generated(surface);
        let summits = known.entry(place).or_insert_with(|| {
            let seed = realization_seed(campaign.spec.seed, u64::from(campaign.surfaces[place].realization));
            let heights_m = synthesize(&surface.spectrum(), &seed, grid).heights_m;
            let per_wavelength = f64::from(surface.points_per_shortest_wavelength);
            let found = find_summits(heights_m.view(), surface.length_m, per_wavelength);
            found.map(|found| found.list).map_err(|error| StageError::from(error).to_string())
        });
        let summits = match summits {
            Ok(summits) => summits,
            Err(error) => return Some(error.clone()),
        };
        checked(AsperityCase { params, options }, scale, summits).err().map(|error| error.to_string())
    }
}
