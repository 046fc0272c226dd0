//! Loading without adhesion, under displacement control.

use crate::PhysicsError;
use crate::elements::equilibrium::Equilibrium;
use crate::elements::equilibrium::minimise::Accuracy;
use crate::elements::equilibrium::patch::Patches;
use crate::elements::problem::{Problem, Totals};

/// An equilibrium without adhesion, of [`Attraction::None`](crate::elements::problem::Attraction::None).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeStep {
    /// Mean penetration Δ \[dx\].
    pub mean_penetration: f64,
    /// Load, energy and area.
    pub totals: Totals,
    /// Real transforms.
    pub transforms: u64,
    /// True if the accuracy was reached.
    pub converged: bool,
}

/// Loads a problem without attraction in steps of the mean penetration \[dx\] until `enough` is true for the
/// steps so far, or all points are in contact.
///
/// # Errors
/// Not enough memory.
pub fn load_freely(
    problem: &Problem,
    step: f64,
    accuracy: Accuracy,
    enough: &mut dyn FnMut(&[FreeStep]) -> bool,
) -> Result<Vec<FreeStep>, PhysicsError> {
    let mut equilibrium = Equilibrium::new(problem, Patches::none())?;
    let mut state = problem.apart(0.0)?;
    let mut before = state.displacement.clone();
    let mut steps: Vec<FreeStep> = Vec::new();
    loop {
        let transformed = equilibrium.transformed();
        let outcome = equilibrium.find(problem, &mut state, accuracy)?;
        let totals = problem.totals(&state);
        let transforms = equilibrium.transforms(transformed);
        steps.push(FreeStep {
            mean_penetration: state.mean_penetration,
            totals,
            transforms,
            converged: outcome.converged,
        });
        if totals.contact == problem.half_space.points() || enough(&steps) {
            return Ok(steps);
        }
        state.mean_penetration += step;
        for (now, before) in state.displacement.iter_mut().zip(&mut before) {
            let next = 2.0 * *now - *before;
            *before = std::mem::replace(now, next);
        }
    }
}
