//! Validity checks of a cycle: contact area, sign of the dissipated energy, energy balance.
//!
//! Contact area within the nominal one, dissipated energy not negative, and energy balance hold for any
//! adhesive elastic contact. The asperity model violates them after strong coalescence: overlapping discs
//! count an area twice, the absorption rule has no potential, and the fields of large contacts are not
//! reciprocal. Such a cycle ends with an error, and its tables are not written. A violation that is small
//! compared with the work of loading leaves the curve of the loop as it is: then Θ alone is not resolved.

use super::record::{Branch, Cycle, Step};
use crate::LoopError;

/// Numerical resolution of the dissipated energy, relative to the largest work along the loop.
///
/// Θ is the difference of the works of loading and unloading, and each is integrated to about 1e-8.
pub const RESOLUTION: f64 = 1e-7;

/// Largest energy-balance error `|Θ − Σ events|` over Θ.
pub const LARGEST_IMBALANCE: f64 = 0.5;

/// Largest energy, relative to the largest work along the loop, by which a loop may violate sign or energy
/// balance. Its Θ is then not resolved.
///
/// Violations at weak adhesion are 1e-5 to 1e-4, those of a contact near full contact 0.01 to 1.
pub(super) const LARGEST_VIOLATION: f64 = 1e-3;

/// Energies of one loop \[J\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopEnergy {
    /// Dissipated energy `Θ = ∮F dΔ`.
    pub loss_j: f64,
    /// Sum of the energies dissipated in the events.
    pub events_j: f64,
    /// Largest magnitude of `∫F dΔ` along the loop.
    pub work_j: f64,
}

impl LoopEnergy {
    /// From the work so far on the branch and the dissipated energy of each step \[J\]: of the loading to the
    /// reversal, and of the unloading from its end.
    #[must_use]
    pub fn of(
        loading: impl IntoIterator<Item = (f64, f64)>,
        unloading_from_its_end: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let (mut at_reversal, mut events_j, mut largest) = (0.0, 0.0, 0.0_f64);
        for (work_j, dissipated_j) in loading {
            at_reversal = work_j;
            events_j += dissipated_j;
            largest = largest.max(work_j.abs());
        }
        let mut loss_j = None;
        for (work_j, dissipated_j) in unloading_from_its_end {
            let along = at_reversal + work_j;
            loss_j.get_or_insert(along);
            events_j += dissipated_j;
            largest = largest.max(along.abs());
        }
        Self { loss_j: loss_j.unwrap_or(at_reversal), events_j, work_j: largest }
    }

    /// Difference of loop area and event energies \[J\].
    #[must_use]
    pub fn imbalance_j(&self) -> f64 {
        (self.loss_j - self.events_j).abs()
    }

    /// Energy by which the loop violates the sign of Θ or the energy balance \[J\]; 0 for a loop that
    /// satisfies both within the numerical resolution.
    #[must_use]
    pub fn violation_j(&self) -> f64 {
        let numerical_j = RESOLUTION * self.work_j;
        let gain_j = if self.loss_j < -numerical_j { -self.loss_j } else { 0.0 };
        let imbalance_j = self.imbalance_j();
        let is_balanced = imbalance_j <= (LARGEST_IMBALANCE * self.loss_j.abs()).max(numerical_j);
        // Not `max`, which drops NaN.
        if is_balanced || gain_j > imbalance_j { gain_j } else { imbalance_j }
    }

    /// True if the violation is at most [`LARGEST_VIOLATION`] of the work; false for NaN.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.violation_j() <= LARGEST_VIOLATION * self.work_j
    }

    /// Dissipated energy below which Θ is not resolved \[J\]: that of the integration, or a violation.
    #[must_use]
    pub fn resolution_j(&self) -> f64 {
        (RESOLUTION * self.work_j).max(self.violation_j())
    }
}

/// Energies of the loop to the `k`-th load reversal.
///
/// Its unloading must be the last branch of the cycle so far.
#[must_use]
pub fn loop_energy<S>(cycle: &Cycle<S>, k: usize) -> LoopEnergy {
    let last = cycle.steps.last();
    let is_on_branch = |step: &&Step| {
        step.branch == Branch::Unloading && Some(step.max_load) == last.map(|last| last.max_load)
    };
    let back = cycle.steps.iter().rev().take_while(is_on_branch);
    let energies = |step: &Step| (step.work_j, step.dissipated_j);
    LoopEnergy::of(cycle.steps[..=cycle.turning[k].0].iter().map(energies), back.map(energies))
}

/// Dissipated energy of the events of the loading path to the `k`-th load reversal \[J\].
fn loading_events<S>(cycle: &Cycle<S>, k: usize) -> f64 {
    cycle.steps[..=cycle.turning[k].0].iter().map(|step| step.dissipated_j).sum()
}

/// Refuses a loop with negative dissipation or a large energy-balance error, unless the violation is below
/// [`LARGEST_VIOLATION`] of the work.
///
/// # Errors
/// [`LoopError::NegativeDissipation`] and [`LoopError::EnergyImbalance`].
pub fn check_energy<S>(cycle: &Cycle<S>, k: usize) -> Result<(), LoopError> {
    let energy = loop_energy(cycle, k);
    let LoopEnergy { loss_j, events_j, work_j } = energy;
    // Without adhesion events are reversed exactly; the events of the loading path are compared with the
    // largest work.
    let is_reversed = loss_j != 0.0 || loading_events(cycle, k).abs() <= LARGEST_IMBALANCE * work_j;
    if is_reversed && energy.is_sound() {
        return Ok(());
    }
    let max_load = cycle.steps.last().and_then(|step| step.max_load).unwrap_or(f64::NAN);
    Err(if loss_j < -LARGEST_VIOLATION * work_j {
        LoopError::NegativeDissipation { max_load, loss_j, fraction: loss_j.abs() / work_j }
    } else {
        LoopError::EnergyImbalance { max_load, loss_j, events_j }
    })
}
