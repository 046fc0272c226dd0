//! Records of a cycle: steps, events, maps and states at load reversals.

use crate::LoopError;
use crate::elements::events::regions::Region;
use crate::elements::problem::{State, Totals};
use crate::event_kind::RegionChange;
use serde::{Deserialize, Serialize};

/// An equilibrium on the path and the energy dissipated since the one before.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Step {
    /// Load reversal from which the step unloads; none while loading.
    pub reversal: Option<usize>,
    /// Mean penetration Δ, with the displacement of the machine's spring \[dx\].
    pub mean_penetration: f64,
    /// Load, energy and area.
    pub totals: Totals,
    /// Stiffness `dF/dΔ` at constant bonds \[E* dx\].
    pub stiffness: f64,
    /// Connected regions of contact.
    pub regions: usize,
    /// Energy dissipated in events since the step before \[E* dx³\]: the sum of `∫F dΔ − ΔΠ` since the last
    /// event, if that exceeds its uncertainty.
    pub dissipated: f64,
    /// `∫F dΔ − ΔΠ` since the step before \[E* dx³\], its error included.
    pub imbalance: f64,
    /// Energy dissipated since the last event and not counted as one, or, if negative, gained by errors of
    /// the integral \[E* dx³\].
    pub pending: f64,
    /// Estimated error of that integral \[E* dx³\]: a part of the difference between the cubic through loads
    /// and stiffnesses and the trapezoid, or of the error that a jump of the load may cause.
    pub uncertainty: f64,
    /// Work `∫F dΔ` of the contact since the branch began \[E* dx³\].
    pub work: f64,
    /// Iterations on the whole grid, those of discarded longer steps included.
    pub iterations: u64,
    /// Real transforms of the grid, those of halved steps included; transforms of patches count by their
    /// points.
    pub transforms: u64,
    /// Root mean square of the residual, relative to the maximum tension, and without adhesion to the height
    /// range over the side.
    pub residual: f64,
    /// True if the accuracy was reached.
    pub converged: bool,
}

impl Step {
    /// Mean penetration of the contact \[dx\]: without the displacement of the machine's spring.
    #[must_use]
    pub fn penetration(&self) -> f64 {
        self.mean_penetration - self.totals.machine
    }
}

/// A sudden change of the contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Number of the step at whose mean penetration the event is over.
    pub step: usize,
    /// Change of the region whose area has changed most.
    pub kind: RegionChange,
    /// Load, energy and area before.
    pub before: Totals,
    /// Load, energy and area after.
    pub after: Totals,
    /// Dissipated energy \[E* dx³\].
    pub dissipated: f64,
}

/// Gap and pressure at a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Number of the step.
    pub step: usize,
    /// Distance of two points along a side \[dx\].
    pub stride: usize,
    /// Gap \[dx\].
    pub gap: Vec<f32>,
    /// Pressure, compression positive \[E*\].
    pub pressure: Vec<f32>,
}

/// A state at a load reversal, from which another process unloads to the same bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Turning {
    /// Number of its step.
    pub step: usize,
    /// State at the reversal.
    pub state: State,
    /// Step that led to it.
    pub last: Step,
    /// Energy dissipated so far \[E* dx³\].
    pub dissipated: f64,
}

/// A cycle: every step, the events, regions and maps.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Steps; the number of a step is its place.
    pub steps: Vec<Step>,
    /// Events.
    pub events: Vec<Event>,
    /// Regions of the kept steps, with the number of the step.
    pub regions: Vec<(usize, Region)>,
    /// Maps at the load reversals and at the maximum tensile load of each unloading.
    pub maps: Vec<Map>,
    /// Maps of further steps, spread over the branches.
    pub between: Vec<Map>,
    /// States at the load reversals.
    pub turning: Vec<Turning>,
    /// Load reversals without a result, by their place in the settings, with the error in the units of the
    /// solver.
    #[serde(skip)]
    pub unreached: Vec<(usize, LoopError)>,
    /// Steps between which and the one before the load was smaller than at both, with that load \[E* dx²\]:
    /// full contact before it opens.
    pub least_loads: Vec<(usize, f64)>,
}

impl Cycle {
    /// The load reversal at a step.
    #[must_use]
    pub fn reversal_at(&self, step: usize) -> Option<usize> {
        self.turning.iter().position(|turning| turning.step == step)
    }

    /// Smallest load between a step and the one before it, the step included \[E* dx²\].
    #[must_use]
    pub fn least_load(&self, step: usize) -> f64 {
        let before = self.least_loads.iter().filter(|(at, _)| *at == step).map(|(_, load)| *load);
        before.fold(self.steps[step].totals.load, f64::min)
    }

    /// Removes the unloading from a load reversal, if it is the last branch.
    pub(crate) fn remove_unloading(&mut self, reversal: usize) {
        let Some(first) = self.steps.iter().position(|step| step.reversal == Some(reversal)) else { return };
        self.steps.truncate(first);
        self.events.retain(|event| event.step < first);
        self.regions.retain(|(step, _)| *step < first);
        self.maps.retain(|map| map.step < first);
        self.between.retain(|map| map.step < first);
        self.least_loads.retain(|(step, _)| *step < first);
    }

    pub(crate) fn keep(&mut self, map: Map, found: Vec<Region>) {
        self.keep_regions(map.step, found);
        self.maps.push(map);
    }

    pub(crate) fn keep_regions(&mut self, step: usize, found: Vec<Region>) {
        self.regions.extend(found.into_iter().map(|region| (step, region)));
    }
}
