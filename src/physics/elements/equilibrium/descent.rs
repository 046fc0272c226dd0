//! Direction of descent by L-BFGS, and a step along it that lowers the energy.

use super::minimise::{ElasticResponse, Minimiser, Shift};
use super::passes::{PAIRS, Right, descending};
use super::trial::{AcceptedStep, Descent, Residual, Trial};
use crate::elements::problem::{Problem, State};
use rayon::prelude::*;

impl Minimiser {
    /// A direction of descent, by the pairs if they give one, and its wave.
    pub(super) fn search(&mut self, problem: &Problem) -> Descent {
        let weights = self.pairs.first();
        let onto = self.precondition(problem, weights);
        let descent = self.descent(problem, self.pairs.second(weights, onto));
        if descent.slope < 0.0 {
            return descent;
        }
        self.pairs.clear();
        self.precondition(problem, [0.0; PAIRS]);
        self.descent(problem, [0.0; PAIRS])
    }

    /// `direction ← M⁻¹ (gradient − Σ weights_i y_i)`: its products with the changes `y`.
    fn precondition(&mut self, problem: &Problem, weights: [f64; PAIRS]) -> [f64; PAIRS] {
        let Self { preconditioner, single, direction, gradient, pairs, slopes, .. } = self;
        let weights = weights.map(|weight| weight as f32);
        let right =
            Right { field: &gradient.values, mean: gradient.mean as f32, changes: pairs.changes(), weights };
        let products = preconditioner.divide(problem, single, direction, &right, slopes);
        if problem.moves_images_alike() {
            problem.half_space.mirror(direction);
        }
        products
    }

    /// Adds the weighted steps of the pairs to the direction and transforms its rows.
    fn descent(&mut self, problem: &Problem, weights: [f64; PAIRS]) -> Descent {
        let columns = problem.half_space.columns();
        let weights = weights.map(|weight| weight as f32);
        let [a, b] = self.pairs.steps().map(|step| step.par_chunks(columns));
        let rows = self
            .direction
            .par_chunks_mut(columns)
            .zip(a.zip(b))
            .zip(self.gradient.values.par_chunks(columns));
        let parts =
            problem.half_space.forward(&mut self.single, rows, |((direction, (a, b)), gradient), to| {
                descending(direction, to, [a, b], weights, gradient)
            });
        let [sum, product, largest] = parts
            .iter()
            .fold([0.0; 3], |all: [f64; 3], part| [all[0] + part[0], all[1] + part[1], all[2].max(part[2])]);
        let mean = self.mean(problem, sum);
        Descent {
            mean,
            slope: product - self.slopes.len() as f64 * mean * self.gradient.mean,
            largest: largest + mean.abs(),
        }
    }

    /// Moves the state along the direction by at most the reach of the law and so far that the energy falls:
    /// the step and the residual after it. Without such a step the state stays.
    pub(crate) fn descend(
        &mut self,
        problem: &Problem,
        state: &State,
        descent: Descent,
        response: ElasticResponse,
    ) -> Option<(AcceptedStep, Residual)> {
        let mut trial = Trial::new(descent);
        let length = (problem.reach() / descent.largest).min(1.0);
        std::mem::swap(&mut self.gradient, &mut self.previous);
        let there = self.evaluate(problem, state, Shift { length, mean: descent.mean }, response);
        if trial.suffices(length, &there) {
            return Some((AcceptedStep { length, largest: length * descent.largest }, there.residual));
        }
        self.shorten(problem, state, trial)
    }

    /// As [`Self::descend`], with a known response and after a first trial.
    fn shorten(
        &mut self,
        problem: &Problem,
        state: &State,
        mut trial: Trial,
    ) -> Option<(AcceptedStep, Residual)> {
        let Descent { mean, largest, .. } = trial.descent;
        for _ in 0..problem.numerics.equilibrium.shortenings {
            let shorter = trial.shorter();
            let there = self.evaluate(
                problem,
                state,
                Shift { length: shorter - trial.length, mean },
                ElasticResponse::Kept,
            );
            if trial.suffices(shorter, &there) {
                return Some((AcceptedStep { length: shorter, largest: shorter * largest }, there.residual));
            }
        }
        self.evaluate(problem, state, Shift { length: -trial.length, mean }, ElasticResponse::Kept);
        None
    }
}
