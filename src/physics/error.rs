//! Errors of the physics.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Errors of the physics, with quantity, value and action.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PhysicsError {
    /// A number of a load reversal beyond those of the settings.
    #[error("cannot unload from load reversal {reversal}: there are {count}")]
    UnknownReversal {
        /// The number, from 0.
        reversal: usize,
        /// Number of load reversals.
        count: usize,
    },
    /// A quantity outside the domain of its equation.
    #[error("cannot evaluate {action}: {quantity} is {}\nhelp: expected {allowed}", short(*value))]
    Domain {
        /// Quantity that was to be evaluated.
        action: &'static str,
        /// The quantity, with its unit.
        quantity: &'static str,
        /// Value.
        value: f64,
        /// Range of the equation.
        allowed: &'static str,
    },
    /// A surface that cannot be used.
    #[error("{problem}\nhelp: {help}")]
    Surface {
        /// Fault, with its numbers.
        problem: String,
        /// Recommended action.
        help: &'static str,
    },
    /// A loop of a probe that cannot be evaluated.
    #[error("{problem}\nhelp: {help}")]
    ProbeLoop {
        /// Fault, with its numbers.
        problem: String,
        /// Recommended action.
        help: &'static str,
    },
    /// A surface without asperities.
    #[error(
        "the surface has no asperity: no local maximum with positive mean curvature\nhelp: use a larger \
         surface or a smaller S-filter cut-off"
    )]
    NoSummit,
    /// Asperities with a Tabor parameter below the limit of Wu's criterion.
    #[error(
        "Wu's criterion for jump into contact (Eq 3) is invalid: {below} of {all} asperities have a Tabor \
         parameter below 2 (minimum {smallest:.3})"
    )]
    LowTabor {
        /// Minimum Tabor parameter.
        smallest: f64,
        /// Number of asperities below 2.
        below: usize,
        /// Number of asperities.
        all: usize,
    },
    /// A stored state with an asperity that the surface does not have.
    #[error(
        "cannot restore the state: it contains asperity {asperity}, but the surface has {count} \
         asperities\nhelp: use a state of the same surface"
    )]
    UnknownAsperity {
        /// The number of the asperity.
        asperity: usize,
        /// Number of asperities.
        count: usize,
    },
    /// A branch that ends before its load reversal or its last separation.
    #[error(transparent)]
    Loop(#[from] LoopError),
}

/// Why a loop has no result. What was passed before on the path remains valid.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
pub enum LoopError {
    /// No equilibrium was found near the last one, not even by relaxation.
    #[error(
        "no equilibrium at the mean penetration {mean_penetration_m:e} m after {iterations} iterations: {} \
         (asperity {asperity})",
        reason.sentence(*residual_m)
    )]
    NoEquilibrium {
        /// Mean penetration Δ \[m\].
        mean_penetration_m: f64,
        /// Reason.
        reason: Reason,
        /// The largest residual \[m\]; not a number for another reason.
        residual_m: f64,
        /// The asperity that has it.
        asperity: usize,
        /// Iterations spent.
        iterations: u64,
    },
    /// Events go on without end within one increment of the mean penetration.
    #[error(
        "no stable state at the mean penetration {mean_penetration_m:e} m after {events} changes of state \
         (asperity {asperity} last)"
    )]
    EndlessAvalanche {
        /// Mean penetration Δ \[m\].
        mean_penetration_m: f64,
        /// Changes of state so far.
        events: usize,
        /// The asperity that changed last.
        asperity: usize,
    },
    /// Full contact at a load reversal, with bonds that open at edges only.
    #[error(
        "full contact at the mean penetration {mean_penetration_m:e} m: there is no edge from which the \
         surfaces can separate"
    )]
    Closed {
        /// Mean penetration Δ \[m\].
        mean_penetration_m: f64,
    },
    /// Surfaces that stay in contact on unloading.
    #[error(
        "the surfaces have not separated at the mean penetration {mean_penetration_m:e} m, where the search \
         ends"
    )]
    Inseparable {
        /// Mean penetration Δ \[m\].
        mean_penetration_m: f64,
    },
    /// The contacts have a larger area than the nominal one, or one of them spans the square.
    #[error(
        "the contact area {share:.3} A0 leaves no gap at the mean penetration {mean_penetration_m:.3e} m: \
         the contacts have grown together, and the asperity model is invalid"
    )]
    ExcessArea {
        /// Mean penetration Δ \[m\].
        mean_penetration_m: f64,
        /// Contact area Σπa² over A0.
        share: f64,
        /// Load before it \[N\].
        load_before_n: f64,
    },
    /// A loop with negative dissipated energy.
    #[error(
        "negative dissipated energy of the loop to F/(E* A0) = {max_load}: Θ = {loss_j:e} J ({fraction:.1e} \
         of the work of loading)"
    )]
    NegativeDissipation {
        /// F/(E* A0) at the load reversal; not a number under displacement control.
        max_load: f64,
        /// Dissipated energy Θ \[J\].
        loss_j: f64,
        /// Magnitude over the work of loading.
        fraction: f64,
    },
    /// The sum of the event energies differs from the loop area.
    #[error(
        "energy-balance error above half of Θ in the loop to F/(E* A0) = {max_load}: Θ = {loss_j:e} J, sum \
         over events {events_j:e} J"
    )]
    EnergyImbalance {
        /// F/(E* A0) at the load reversal; not a number under displacement control.
        max_load: f64,
        /// Dissipated energy Θ \[J\].
        loss_j: f64,
        /// Energy dissipated in the events \[J\].
        events_j: f64,
    },
    /// A loop by boundary elements whose steps do not resolve its dissipated energy.
    #[error(
        "the steps do not resolve the loop to F/(E* A0) = {max_load}: Θ = {loss_j:e} J, sum over events \
         {events_j:e} J, work of loading {work_j:e} J"
    )]
    UnresolvedLoop {
        /// F/(E* A0) at the load reversal.
        max_load: f64,
        /// Dissipated energy Θ \[J\].
        loss_j: f64,
        /// Energy dissipated in the events \[J\].
        events_j: f64,
        /// Largest magnitude of `∫F dΔ` along the loop \[J\].
        work_j: f64,
    },
    /// The maximum load is not reached.
    #[error(
        "load F/(E* A0) = {wanted} not reached: it is {reached} at the mean penetration \
         {mean_penetration_m:e} m"
    )]
    LoadNotReached {
        /// The requested load.
        wanted: f64,
        /// The load reached.
        reached: f64,
        /// Mean penetration Δ at the end of the search \[m\].
        mean_penetration_m: f64,
    },
}

/// Why no equilibrium was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Reason {
    /// A residual stays above the tolerance.
    Residual,
    /// The equilibrium that was found is unstable.
    Unstable,
    /// A load or an energy is not a number.
    NotANumber,
}

impl Reason {
    /// The reason in words, with the largest residual \[m\].
    fn sentence(self, residual_m: f64) -> String {
        match self {
            Self::Residual if residual_m.is_nan() => Self::NotANumber.sentence(residual_m),
            Self::Residual => format!("the largest residual stays at {residual_m:e} m"),
            Self::Unstable => "the equilibrium found is unstable".to_owned(),
            Self::NotANumber => "a load or an energy is not a number".to_owned(),
        }
    }
}

/// A number as a sentence has it: a count by its digits.
fn short(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e6 { format!("{value}") } else { format!("{value:e}") }
}
