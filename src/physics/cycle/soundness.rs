//! Validity checks of a cycle: contact area, sign of the dissipated energy, energy balance.
//!
//! Contact area within the nominal one, dissipated energy not negative, and energy balance hold for any adhesive elastic contact.
//! The asperity model violates them after strong coalescence: overlapping discs count an area twice, and the absorption rule
//! has no potential. Such a cycle ends with an error, and its tables are not written.

use super::table::{Branch, Cycle, Step};
use crate::physics::PhysicsError;
use crate::physics::path::EquilibriumPath;

/// Numerical resolution of the dissipated energy, relative to the largest work along the loop.
///
/// Θ is the difference of the works of loading and unloading, and each is integrated to about 1e-8.
pub const RESOLUTION: f64 = 1e-7;

/// Accuracy of the sum over the events, relative to the largest work along the loop.
///
/// The energy of an event is a difference of potentials of a local problem.
pub const EVENT_ACCURACY: f64 = 1e-5;

/// Largest energy-balance error `|Θ − Σ events|` over Θ.
pub const LARGEST_IMBALANCE: f64 = 0.5;

/// Refuses a state whose contact area Σπa² exceeds the nominal area A0, or whose largest contact spans the square.
///
/// The area of the union of the contacts is smaller than that sum. `load_before_n` is the load \[N\] of the increment before, for the error: that of the
/// refused state is meaningless.
///
/// # Errors
/// [`PhysicsError::ExcessArea`].
pub(crate) fn check_area(path: &EquilibriumPath, load_before_n: f64) -> Result<(), PhysicsError> {
    let side = path.problem().length_m;
    let share = path.totals().area_m2 / (side * side);
    // NaN is refused as well.
    if share <= 1.0 && path.state().largest_radius() < 0.5 * side {
        return Ok(());
    }
    // Not −0.
    Err(PhysicsError::ExcessArea { approach_m: path.state().approach_m + 0.0, share, load_before_n })
}

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
    /// Dissipated energy below which Θ is not resolved \[J\].
    #[must_use]
    pub fn resolution_j(&self) -> f64 {
        RESOLUTION * self.work_j
    }
}

/// Energies of the loop to the `k`-th load reversal.
///
/// Its unloading must be the last branch of the cycle so far.
#[must_use]
pub fn loop_energy(cycle: &Cycle, k: usize) -> LoopEnergy {
    let reversal = cycle.turning[k].0;
    let loading = &cycle.steps[..=reversal];
    let last = cycle.steps.last();
    let unloading = cycle
        .steps
        .iter()
        .rev()
        .take_while(|step| step.branch == Branch::Unloading && Some(step.max_load) == last.map(|last| last.max_load));
    let back: Vec<&Step> = unloading.collect();
    let at_reversal = cycle.steps[reversal].work_j;
    let works = loading.iter().map(|step| step.work_j.abs()).chain(back.iter().map(|step| (at_reversal + step.work_j).abs()));
    LoopEnergy {
        loss_j: at_reversal + back.first().map_or(0.0, |step| step.work_j),
        events_j: loading.iter().chain(back.iter().copied()).map(|step| step.dissipated_j).sum(),
        work_j: works.fold(0.0, f64::max),
    }
}

/// Dissipated energy of the events of the loading path to the `k`-th load reversal \[J\].
fn loading_events(cycle: &Cycle, k: usize) -> f64 {
    cycle.steps[..=cycle.turning[k].0].iter().map(|step| step.dissipated_j).sum()
}

/// Refuses a loop with negative dissipation or a large energy-balance error.
///
/// The limit of the error is half of the dissipated energy.
///
/// # Errors
/// [`PhysicsError::NegativeDissipation`] and [`PhysicsError::EnergyImbalance`], neither below the numerical resolution.
pub fn check_energy(cycle: &Cycle, k: usize) -> Result<(), PhysicsError> {
    let energy = loop_energy(cycle, k);
    let LoopEnergy { loss_j, events_j, work_j } = energy;
    let max_load = cycle.steps.last().and_then(|step| step.max_load).unwrap_or(f64::NAN);
    if loss_j < -energy.resolution_j() {
        return Err(PhysicsError::NegativeDissipation { max_load, loss_j, fraction: loss_j.abs() / work_j });
    }
    // Without adhesion events are reversed exactly; the events of the loading path are compared with the largest work.
    let gap = if loss_j == 0.0 { loading_events(cycle, k).abs() } else { (loss_j - events_j).abs() };
    let scale = if loss_j == 0.0 { work_j } else { loss_j };
    if gap > (LARGEST_IMBALANCE * scale).max(EVENT_ACCURACY * work_j) {
        return Err(PhysicsError::EnergyImbalance { max_load, loss_j, events_j });
    }
    Ok(())
}
