//! What a cycle consists of: steps, events, maps and states at load reversals.

use super::contact::{State, Totals};
use super::regions::{Change, Region};
use crate::PhysicsError;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// An equilibrium on the path and the energy dissipated since the one before.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Step {
    /// Load reversal from which the step unloads; none while loading.
    pub reversal: Option<usize>,
    /// Approach Δ \[dx\].
    pub approach: f64,
    /// Load, energy and area.
    pub totals: Totals,
    /// Stiffness `dF/dΔ` at constant bonds \[E* dx\].
    pub stiffness: f64,
    /// Connected regions of contact.
    pub regions: usize,
    /// Energy dissipated in events since the step before \[E* dx³\]: the sum of `∫F dΔ − ΔΠ` since the last event, if that exceeds its uncertainty.
    pub dissipated: f64,
    /// `∫F dΔ − ΔΠ` since the step before \[E* dx³\], its error included.
    pub imbalance: f64,
    /// Energy dissipated since the last event and not counted as one, or, if negative, gained by errors of the integral \[E* dx³\].
    pub pending: f64,
    /// Estimated error of that integral \[E* dx³\]: a part of the difference between the cubic through loads and stiffnesses and the trapezoid, or of the error
    /// that a jump of the load may cause.
    pub uncertainty: f64,
    /// Work `∫F dΔ` since the branch began \[E* dx³\].
    pub work: f64,
    /// Iterations on the whole grid, those of discarded longer steps included.
    pub iterations: u64,
    /// Real transforms of the grid, those of halved steps included; transforms of patches count by their points.
    pub transforms: u64,
    /// Root mean square of the residual, relative to the maximum tension, and without adhesion to the height range over the side.
    pub residual: f64,
    /// True if the accuracy was reached.
    pub converged: bool,
}

/// A sudden change of the contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Number of the step at whose approach the event is over.
    pub step: usize,
    /// Change of the region whose area has changed most.
    pub kind: Change,
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

/// Why a load reversal of a cycle has no result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Unreached {
    /// The load is not reached.
    Load {
        /// Load at the end of the search \[E* dx²\].
        reached: f64,
        /// Approach at the end of the search \[dx\].
        approach: f64,
    },
    /// Full contact, which does not open.
    Closed {
        /// Approach \[dx\].
        approach: f64,
    },
    /// The surfaces do not separate.
    Inseparable {
        /// Approach at the end of the search \[dx\].
        approach: f64,
    },
    /// Steps that do not resolve the dissipated energy.
    Unresolved {
        /// Dissipated energy `∮F dΔ` \[E* dx³\].
        loss: f64,
        /// Energy dissipated in the events \[E* dx³\].
        events: f64,
        /// Largest magnitude of `∫F dΔ` along the loop \[E* dx³\].
        work: f64,
    },
}

impl Unreached {
    /// The error of a cycle without any result, in the units of the solver.
    #[must_use]
    pub fn error(self, max_load: f64) -> PhysicsError {
        match self {
            Self::Load { reached, approach } => PhysicsError::LoadNotReached { wanted: max_load, reached, approach_m: approach },
            Self::Closed { approach } => PhysicsError::Closed { approach_m: approach },
            Self::Inseparable { approach } => PhysicsError::Inseparable { approach_m: approach },
            Self::Unresolved { loss, events, work } => {
                PhysicsError::UnresolvedLoop { max_load, loss_j: loss, events_j: events, work_j: work }
            }
        }
    }
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
    /// Load reversals without a result, by their place in the settings.
    #[serde(skip)]
    pub unreached: Vec<(usize, Unreached)>,
    /// Steps between which and the one before the load was smaller than at both, with that load \[E* dx²\]: full contact before it opens.
    #[serde(skip)]
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

    /// Removes the unloading from a load reversal, which then has no result for a reason. The numbers that its steps had.
    pub fn remove_unloading(&mut self, reversal: usize, reason: Unreached) -> Range<usize> {
        self.unreached.push((reversal, reason));
        let of = |step: &Step| step.reversal == Some(reversal);
        let Some(first) = self.steps.iter().position(of) else { return 0..0 };
        let removed = first..first + self.steps[first..].iter().take_while(|step| of(step)).count();
        self.steps.drain(removed.clone());
        let renumber = |step: &mut usize| {
            let is_kept = !removed.contains(step);
            if *step >= removed.end {
                *step -= removed.len();
            }
            is_kept
        };
        self.events.retain_mut(|event| renumber(&mut event.step));
        self.regions.retain_mut(|(step, _)| renumber(step));
        self.maps.retain_mut(|map| renumber(&mut map.step));
        self.between.retain_mut(|map| renumber(&mut map.step));
        self.least_loads.retain_mut(|(step, _)| renumber(step));
        removed
    }

    pub(super) fn keep(&mut self, map: Map, found: Vec<Region>) {
        self.keep_regions(map.step, found);
        self.maps.push(map);
    }

    pub(super) fn keep_regions(&mut self, step: usize, found: Vec<Region>) {
        self.regions.extend(found.into_iter().map(|region| (step, region)));
    }
}
