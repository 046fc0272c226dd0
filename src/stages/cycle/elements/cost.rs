//! Memory and time of a loop by boundary elements, estimated before it begins.

use super::super::super::cost::Cost;
use super::lattice::Lattice;
use crate::model::Control;
use crate::physics::elements::{Numerics, memory_bytes};
use crate::spec::CaseParams;

/// Time of one loop by boundary elements, `a N² + b N³` for a grid of N x N points \[s\].
pub(in super::super) const OF_POINTS: [f64; 2] = [6e-5, 3e-7];
/// Exponent of the number of steps: quiet steps are cheaper than those with events. Measured: 3.0 and 12
/// times the transforms with 6 and 30 times the steps.
const OF_STEPS: f64 = 0.7;
/// Steps of a loop by boundary elements without weak adhesion, in the mean.
const STEPS: f64 = 170.0;
/// Time under load control over that under displacement control: more steps and longer searches. Measured: 3
/// on a nearly smooth sphere, 12 to 21 on rough surfaces and scans.
const OF_LOAD_CONTROL: f64 = 12.0;
/// Time of a loop that is announced before it starts \[s\].
pub(in super::super) const LONG: f64 = 600.0;

/// Memory and time of a loop of the parameters at a ratio `U_el/Δγ`; `range_steps` are the steps over the
/// gaps at which an attraction with a range acts.
pub(super) fn cost(lattice: &Lattice, params: &CaseParams, ratio: Option<f64>, range_steps: f64) -> Cost {
    let loads = params.cycle.max_load.len();
    let of_control = if params.machine.control == Control::Load { OF_LOAD_CONTROL } else { 1.0 };
    let n = lattice.points as f64;
    let [square, cube] = OF_POINTS;
    let plain = square * n.powi(2) + cube * n.powi(3);
    let steps =
        Numerics::default().refinement(ratio.unwrap_or(f64::INFINITY)).0.powf(OF_STEPS) + range_steps / STEPS;
    Cost {
        points: lattice.points as u64,
        per_wavelength: lattice.per_wavelength,
        is_mirrored: lattice.is_mirrored,
        memory_bytes: memory_bytes(lattice.points, loads) as f64,
        seconds: 0.5 * (1 + loads) as f64 * steps * of_control * plain,
    }
}
