//! Newton's method with truncated conjugate gradients (Steihaug, SIAM J. Numer. Anal. 20:626, 1983): the
//! second way to an equilibrium, where L-BFGS does not end.
//!
//! The model of the energy is `g·p + ½ p·(K + V'')p`, with `V''` for all second derivatives of the law. Its
//! minimum is approached by conjugate gradients with the split preconditioner, until a direction has a
//! negative curvature or the step would exceed the reach of the law; such a step ends at that reach.

use super::minimise::{Accuracy, ElasticResponse, Minimiser, Outcome};
use super::passes::{PAIRS, Right};
use super::trial::Descent;
use crate::PhysicsError;
use crate::elements::grid::half_space::Operator;
use crate::elements::grid::sums::{PANEL, add, dot, grain, largest, panel_sums, total};
use crate::elements::problem::{Nucleation, Problem, State};
use crate::memory::filled;
use rayon::prelude::*;
use std::mem::take;

/// Scratch buffers of the conjugate gradients: fields of the minimiser, which does not use them meanwhile.
struct Inner {
    residual: Vec<f32>,
    search: Vec<f32>,
    stiff: Vec<f32>,
}

/// A solution of conjugate gradients and the elastic response to it, or nothing where that is not needed.
struct Solution {
    step: Vec<f32>,
    response: Vec<f32>,
}

/// Limits at which conjugate gradients end.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// Largest magnitude of the step.
    step: f64,
    /// Norm of the residual.
    residual: f64,
}

/// Change of an equilibrium with the mean penetration.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rate {
    /// `du/dΔ` at each point.
    pub(crate) displacement: Vec<f32>,
    /// `dF/dΔ` \[E* dx\].
    pub(crate) stiffness: f64,
}

impl Minimiser {
    /// Moves `state` to a local minimum as [`Self::minimise`] does, by Newton's method.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn newton(
        &mut self,
        problem: &Problem,
        state: &mut State,
        accuracy: Accuracy,
    ) -> Result<Outcome, PhysicsError> {
        let points = problem.half_space.points();
        let mut found = Solution { step: filled(points, 0.0)?, response: filled(points, 0.0)? };
        let stress = problem.stress();
        let mut outcome = Outcome::default();
        loop {
            problem.update_bonds(state, Nucleation::Suppressed);
            let here = self.start_from(problem, state);
            (outcome.residual, outcome.converged) = (here.rms / stress, accuracy.includes(here, stress));
            if outcome.converged || outcome.iterations >= accuracy.iterations {
                return Ok(outcome);
            }
            self.linearise_line(problem, state);
            outcome.iterations += self.conjugate_gradients(problem, &mut found);
            std::mem::swap(&mut self.direction, &mut found.step);
            std::mem::swap(&mut self.response, &mut found.response);
            let alike = problem.moves_images_alike();
            if alike {
                problem.half_space.mirror(&mut self.direction);
            }
            if alike || problem.law.has_line() {
                // The response of the conjugate gradients is not that of the direction alone.
                let Self { direction, response, single, .. } = self;
                problem.half_space.apply(Operator::Stiffness, direction, response, single);
            }
            let descent = Descent {
                mean: 0.0,
                slope: dot(&self.direction, &self.gradient.values),
                largest: largest(&self.direction),
            };
            let accepted = self.descend(problem, state, descent, ElasticResponse::Kept);
            self.commit(state);
            if accepted.is_none() {
                return Ok(outcome);
            }
        }
    }

    /// Rate at which the displacement follows the mean penetration at an equilibrium, and the stiffness
    /// `dF/dΔ` of the contact: `(K + V'')·rate = V''`, of zero mean if that is fixed, by conjugate gradients.
    /// The stiffness `Σ V''·(1 − rate)` has an error of second order in that of the rate.
    ///
    /// # Errors
    /// Not enough memory.
    pub(crate) fn rate(&mut self, problem: &Problem, state: &State) -> Result<Rate, PhysicsError> {
        let mut found = Solution { step: filled(problem.half_space.points(), 0.0)?, response: Vec::new() };
        self.evaluate_at(problem, state);
        let mut inner = self.take_scratch();
        self.linearise_line(problem, state);
        inner.residual.copy_from_slice(&self.slopes);
        if problem.law.has_line() {
            inner.search.fill(1.0);
            self.add_line_response(problem, &inner.search, &mut inner.residual);
        }
        problem.half_space.fix_mean(&mut inner.residual);
        let residual =
            problem.numerics.equilibrium.rate_residual * dot(&inner.residual, &inner.residual).sqrt();
        self.solve(problem, &mut inner, &mut found, Limits { step: f64::INFINITY, residual });
        // The second derivatives of the energy of the law times 1 − rate.
        let Inner { search, stiff, .. } = &mut inner;
        (&mut *search, &mut *stiff, &found.step, &self.slopes)
            .into_par_iter()
            .with_min_len(grain(1))
            .for_each(|(left, to, rate, slope)| (*left, *to) = (1.0 - rate, slope * (1.0 - rate)));
        self.add_line_response(problem, search, stiff);
        let [stiffness] =
            total(inner.stiff.par_chunks(PANEL).map(|stiff| panel_sums([stiff], |[stiff]| [stiff])));
        self.return_scratch(inner);
        if problem.moves_images_alike() {
            problem.half_space.mirror(&mut found.step);
        }
        Ok(Rate { stiffness, displacement: found.step })
    }

    /// Moves the buffers for conjugate gradients out. Removes the pairs.
    fn take_scratch(&mut self) -> Inner {
        let search = self.pairs.take_scratch();
        Inner { residual: take(&mut self.previous.values), search, stiff: take(&mut self.response) }
    }

    fn return_scratch(&mut self, Inner { residual, search, stiff }: Inner) {
        self.pairs.return_scratch(search);
        (self.previous.values, self.response) = (residual, stiff);
    }

    /// Computes the step within the reach of the law and its response, and returns the iterations of
    /// conjugate gradients.
    fn conjugate_gradients(&mut self, problem: &Problem, found: &mut Solution) -> usize {
        found.step.fill(0.0);
        found.response.fill(0.0);
        let mut inner = self.take_scratch();
        let mean = self.gradient.mean as f32;
        let fields = (&mut inner.residual, &self.gradient.values).into_par_iter().with_min_len(grain(1));
        fields.for_each(|(to, from)| *to = mean - from);
        let residual =
            problem.numerics.equilibrium.inner_residual * dot(&inner.residual, &inner.residual).sqrt();
        let iterations = self.solve(problem, &mut inner, found, Limits { step: problem.reach(), residual });
        self.return_scratch(inner);
        iterations
    }

    /// Solves `(K + V'') step = residual` from a step of 0 to one of the limits: the iterations.
    fn solve(&mut self, problem: &Problem, inner: &mut Inner, found: &mut Solution, limits: Limits) -> usize {
        if dot(&inner.residual, &inner.residual).sqrt() <= limits.residual {
            return 0;
        }
        self.precondition_from(problem, &inner.residual);
        inner.search.copy_from_slice(&self.direction);
        let mut product = dot(&inner.residual, &self.direction);
        let most = problem.numerics.equilibrium.inner_iterations;
        for iteration in 1..=most {
            problem.half_space.apply(Operator::Stiffness, &inner.search, &mut inner.stiff, &mut self.single);
            self.add_line_response(problem, &inner.search, &mut inner.stiff);
            let [curvature] = total(
                (
                    inner.stiff.par_chunks(PANEL),
                    self.slopes.par_chunks(PANEL),
                    inner.search.par_chunks(PANEL),
                )
                    .into_par_iter()
                    .map(|(stiff, slopes, search)| {
                        panel_sums([stiff, slopes, search], |[k, slope, p]| [p * (k + slope * p)])
                    }),
            );
            let room =
                (limits.step - largest(&found.step)).max(0.0) / largest(&inner.search).max(f64::MIN_POSITIVE);
            let length = product / curvature;
            if curvature <= 0.0 && limits.step.is_infinite() {
                return iteration;
            }
            if curvature <= 0.0 || length > room {
                // Along a direction of descent as far as the law reaches.
                add(&mut found.step, room, &inner.search);
                add(&mut found.response, room, &inner.stiff);
                return iteration;
            }
            add(&mut found.step, length, &inner.search);
            add(&mut found.response, length, &inner.stiff);
            self.lower(problem, inner, length as f32);
            if dot(&inner.residual, &inner.residual).sqrt() <= limits.residual {
                return iteration;
            }
            self.precondition_from(problem, &inner.residual);
            let next = dot(&inner.residual, &self.direction);
            let ratio = (next / product) as f32;
            product = next;
            let fields = (&mut inner.search, &self.direction).into_par_iter().with_min_len(grain(1));
            fields.for_each(|(to, from)| *to = from + ratio * *to);
        }
        most
    }

    /// `residual ← residual − length (K + V'') search`, without its mean if that is fixed.
    fn lower(&self, problem: &Problem, inner: &mut Inner, length: f32) {
        let fields = (&mut inner.residual, &inner.stiff, &self.slopes, &inner.search)
            .into_par_iter()
            .with_min_len(grain(1));
        fields.for_each(|(to, stiff, slope, search)| *to -= length * (stiff + slope * search));
        problem.half_space.fix_mean(&mut inner.residual);
    }

    /// `direction ← M⁻¹ field`, without its mean if that is fixed.
    fn precondition_from(&mut self, problem: &Problem, field: &[f32]) {
        let right = Right { field, mean: 0.0, changes: self.pairs.changes(), weights: [0.0; PAIRS] };
        self.preconditioner.divide(problem, &mut self.single, &mut self.direction, &right, &self.slopes);
        problem.half_space.fix_mean(&mut self.direction);
    }
}
