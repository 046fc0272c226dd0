//! Loading without adhesion, from which analytical estimates of the adhesive loop follow.

use super::Elements;
use crate::PhysicsError;
use crate::cycle::Cycle;
use crate::elements::path::adhesionless::{FreeStep as GridStep, load_freely};
use crate::theory::approximate_jkr::{CurvePoint, adhesive_curve};

/// A step of loading without adhesion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeStep {
    /// Mean penetration Δ \[m\].
    pub mean_penetration_m: f64,
    /// Load \[N\].
    pub load_n: f64,
    /// Contact area \[m²\].
    pub area_m2: f64,
    /// True if the accuracy was reached.
    pub is_converged: bool,
    /// Transforms of the grid.
    pub transforms: u64,
}

impl Elements {
    /// Loading of the surface without adhesion, until the adhesive states that follow from it reach the
    /// largest load, at most by the range of the heights beyond the cycle.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn load_without_adhesion<S>(self, cycle: &Cycle<S>) -> Result<Vec<FreeStep>, PhysicsError> {
        let Self { problem, settings, units, .. } = self;
        let work_length = problem.law.work();
        let wanted = settings.max_loads.iter().copied().fold(0.0, f64::max);
        let range = -problem.heights.iter().copied().fold(0.0, f64::min);
        let deepest_m = cycle.steps.iter().map(|step| step.mean_penetration_m).fold(0.0, f64::max);
        let farthest = range + deepest_m / units.spacing_m();
        let mut is_enough = |steps: &[GridStep]| {
            let is_reached = || {
                adhesive_curve(&curve(steps), work_length).last().is_some_and(|point| point.load_m2 > wanted)
            };
            steps.last().is_some_and(|step| step.mean_penetration > farthest) || is_reached()
        };
        let free = problem.without_adhesion()?;
        let steps = load_freely(
            &free,
            free.numerics.steps.free_step * settings.step,
            settings.accuracy,
            &mut is_enough,
        )?;
        let in_si = |step: &GridStep| FreeStep {
            mean_penetration_m: step.mean_penetration * units.spacing_m(),
            load_n: step.totals.load * units.load_n(),
            area_m2: step.totals.contact as f64 * units.area_m2(),
            is_converged: step.converged,
            transforms: step.transforms,
        };
        Ok(steps.iter().map(in_si).collect())
    }
}

/// Steps without adhesion in grid units.
fn curve(steps: &[GridStep]) -> Vec<CurvePoint> {
    let point = |step: &GridStep| CurvePoint {
        penetration_m: step.mean_penetration,
        load_m2: step.totals.load,
        area_m2: step.totals.contact as f64,
    };
    steps.iter().map(point).collect()
}
