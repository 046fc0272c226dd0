//! Equilibrium on a grid: L-BFGS with events followed on patches, and Newton's method where that does not
//! end.

mod descent;
mod increment;
mod line;
mod line_slopes;
pub mod minimise;
pub(crate) mod newton;
mod pairs;
mod passes;
pub mod patch;
pub(crate) mod places;
pub mod preconditioner;
mod trial;

use crate::PhysicsError;
use crate::elements::problem::{Problem, State};
use minimise::{ANY, Accuracy, Loads, LocalRelaxation, Minimiser, Outcome};
use newton::Rate;
use patch::Patches;

/// Work space for the equilibria of one problem.
pub struct Equilibrium {
    minimiser: Minimiser,
    patches: Patches,
    /// Points of one transform of the grid.
    points: u64,
}

impl Equilibrium {
    /// Work space for a problem, with patches or [none](Patches::none).
    ///
    /// # Errors
    /// Not enough memory.
    pub fn new(problem: &Problem, patches: Patches) -> Result<Self, PhysicsError> {
        Ok(Self { minimiser: Minimiser::new(problem)?, patches, points: problem.half_space.transformed() })
    }

    /// Moves `state` to the local minimum of the energy at its mean penetration; bonds around contacts grow
    /// on the way. The iterations are those on the whole grid.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn find(
        &mut self,
        problem: &Problem,
        state: &mut State,
        accuracy: Accuracy,
    ) -> Result<Outcome, PhysicsError> {
        self.find_within(problem, state, accuracy, &ANY)
    }

    /// As [`Self::find`], unless an event takes the load out of `loads`.
    pub(crate) fn find_within(
        &mut self,
        problem: &Problem,
        state: &mut State,
        accuracy: Accuracy,
        loads: &Loads,
    ) -> Result<Outcome, PhysicsError> {
        let events: Option<&mut dyn LocalRelaxation> =
            if self.patches.are_none() { None } else { Some(&mut self.patches) };
        let first = self.minimiser.minimise_with(problem, state, accuracy, loads, events);
        if first.converged || first.left {
            return Ok(first);
        }
        let second = self.minimiser.newton(problem, state, accuracy)?;
        Ok(Outcome { iterations: first.iterations + second.iterations, ..second })
    }

    /// Rate at which an equilibrium follows the mean penetration.
    ///
    /// # Errors
    /// Not enough memory.
    pub(crate) fn rate(&mut self, problem: &Problem, state: &State) -> Result<Rate, PhysicsError> {
        self.minimiser.rate(problem, state)
    }

    /// Points of the real transforms so far, those of patches included.
    #[must_use]
    pub fn transformed(&self) -> u64 {
        self.minimiser.transforms() * self.points + self.patches.transformed()
    }

    /// Real transforms since [`Self::transformed`] was `since`, in those of the whole grid and rounded up.
    #[must_use]
    pub fn transforms(&self, since: u64) -> u64 {
        (self.transformed() - since).div_ceil(self.points)
    }
}
