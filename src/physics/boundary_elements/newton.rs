//! Newton's method with truncated conjugate gradients (Steihaug): the second way to an equilibrium, where L-BFGS does not end.
//!
//! The model of the energy is `g·p + ½ p·(K + V'')p`. Its minimum is approached by conjugate gradients with the split preconditioner, until a direction has
//! a negative curvature or the step would exceed the reach of the law; such a step ends at that reach.

use super::contact::{Problem, State};
use super::grid::Operator;
use super::minimise::{Accuracy, Minimiser, Outcome};
use super::sums::{PANEL, add, dot, grain, largest, remove_mean};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;

/// Steps of conjugate gradients to one of Newton.
const INNER: usize = 80;
/// Decrease of the residual by conjugate gradients.
const FORCING: f64 = 0.05;

/// Fields of the inner iteration.
struct Inner {
    step: Vec<f64>,
    response: Vec<f64>,
    residual: Vec<f64>,
    search: Vec<f64>,
    stiff: Vec<f64>,
    curved: Vec<f64>,
}

impl Minimiser {
    /// Moves `state` to a local minimum as [`Self::minimise`] does, by Newton's method.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn newton(&mut self, problem: &Problem, state: &mut State, accuracy: Accuracy) -> Result<Outcome, PhysicsError> {
        let field = || filled(problem.half_space.points(), 0.0);
        let mut inner =
            Inner { step: field()?, response: field()?, residual: field()?, search: field()?, stiff: field()?, curved: field()? };
        let strength = problem.stress();
        let mut outcome = Outcome::default();
        problem.refresh(state, &mut self.waves);
        loop {
            problem.update_bonds(state, false);
            let (rms, most) = problem.residual(state, &mut self.residual, &mut self.slopes);
            outcome.residual = rms / strength;
            outcome.converged = rms <= accuracy.rms * strength && most <= accuracy.largest * strength;
            if outcome.converged || outcome.iterations >= accuracy.iterations {
                return Ok(outcome);
            }
            outcome.iterations += self.conjugate_gradients(problem, &mut inner);
            std::mem::swap(&mut self.direction, &mut inner.step);
            std::mem::swap(&mut self.response, &mut inner.response);
            let length = self.step_length(problem, state);
            add(&mut state.displacement, length, &self.direction);
            add(&mut state.pressure, length, &self.response);
            if length == 0.0 {
                return Ok(outcome);
            }
        }
    }

    /// The step within the reach of the law, and the iterations it took.
    fn conjugate_gradients(&mut self, problem: &Problem, inner: &mut Inner) -> usize {
        inner.step.fill(0.0);
        inner.response.fill(0.0);
        inner.residual.par_iter_mut().zip(&self.residual).with_min_len(grain(1)).for_each(|(to, from)| *to = -from);
        let goal = FORCING * dot(&inner.residual, &inner.residual).sqrt();
        self.precondition_from(problem, &inner.residual);
        inner.search.copy_from_slice(&self.direction);
        let mut product = dot(&inner.residual, &self.direction);
        let reach = problem.reach();
        for iteration in 1..=INNER {
            problem.half_space.apply(Operator::Stiffness, &inner.search, &mut inner.stiff, &mut self.waves);
            self.curve(inner);
            let curvature = dot(&inner.search, &inner.curved);
            let room = (reach - largest(&inner.step)).max(0.0) / largest(&inner.search).max(f64::MIN_POSITIVE);
            let length = product / curvature;
            if curvature <= 0.0 || length > room {
                // Along a direction of descent as far as the law reaches.
                add(&mut inner.step, room, &inner.search);
                add(&mut inner.response, room, &inner.stiff);
                return iteration;
            }
            add(&mut inner.step, length, &inner.search);
            add(&mut inner.response, length, &inner.stiff);
            add(&mut inner.residual, -length, &inner.curved);
            if dot(&inner.residual, &inner.residual).sqrt() <= goal {
                return iteration;
            }
            self.precondition_from(problem, &inner.residual);
            let next = dot(&inner.residual, &self.direction);
            let ratio = next / product;
            product = next;
            let direction = &self.direction;
            inner.search.par_iter_mut().zip(direction).with_min_len(grain(1)).for_each(|(to, from)| *to = from + ratio * *to);
        }
        INNER
    }

    /// `curved ← (K + V'') search`, without its mean.
    fn curve(&self, inner: &mut Inner) {
        let Inner { search, stiff, curved, .. } = inner;
        let slopes = &self.slopes;
        curved.par_chunks_mut(PANEL).enumerate().with_min_len(grain(PANEL)).for_each(|(panel, part)| {
            for (k, value) in part.iter_mut().enumerate() {
                let point = panel * PANEL + k;
                *value = stiff[point] + slopes[point] * search[point];
            }
        });
        remove_mean(curved);
    }

    /// `direction ← M⁻¹ field`, without its mean.
    fn precondition_from(&mut self, problem: &Problem, field: &[f64]) {
        self.direction.copy_from_slice(field);
        self.precondition(problem);
        remove_mean(&mut self.direction);
    }
}
