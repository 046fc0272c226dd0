//! Number of steps of a cycle, estimated before it begins.

use super::AsperityCase;
use crate::physics::asperities::contact::Problem;
use crate::physics::surface::summits::Summit;
use crate::stages::StageError;

/// Steps of all branches of a cycle at most: they take about 2 GB of memory.
pub(in super::super) const MOST: u64 = 2_000_000;

/// Penetration beyond which no load is looked for, in rms heights.
const DEEPEST: f64 = 100.0;

/// Halvings of the interval of penetrations: to 1e-4 rms heights.
const HALVINGS: u32 = 20;

/// Refuses a cycle of more than [`MOST`] steps.
///
/// The penetrations at its loads are those of Hertz contacts without interaction and adhesion, which carry
/// more load at the same penetration than the contact does. So the number of steps is estimated from below.
pub(super) fn bound(problem: &Problem, summits: &[Summit], of: AsperityCase<'_>) -> Result<(), StageError> {
    let (params, approach_step) = (of.params, of.options.approach_step);
    let loads = &params.cycle.max_load;
    let branches = loads.len() as f64 + 1.0;
    if branches * DEEPEST / approach_step <= MOST as f64 {
        return Ok(());
    }
    let highest = summits.iter().map(|summit| summit.height_m).fold(f64::NEG_INFINITY, f64::max);
    let load_n = |penetration_m: f64| -> f64 {
        let hertz = |summit: &Summit| {
            let own = (penetration_m - (highest - summit.height_m)).max(0.0);
            4.0 / 3.0 * params.material.contact_modulus_pa * summit.radius_m().sqrt() * own.powf(1.5)
        };
        summits.iter().map(hertz).sum()
    };
    let penetration = |load: f64| {
        let (mut low, mut high) = (0.0, DEEPEST);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let reached = load_n(middle * problem.rms_height_m) >= load * problem.load_unit_n();
            *(if reached { &mut high } else { &mut low }) = middle;
        }
        low
    };
    let unloading: Vec<f64> = loads.iter().map(|load| penetration(*load)).collect();
    let steps =
        (unloading.iter().sum::<f64>() + unloading.iter().copied().fold(0.0, f64::max)) / approach_step;
    if steps > MOST as f64 {
        Err(StageError::TooManySteps { approach_step, steps, limit: MOST })
    } else {
        Ok(())
    }
}
