//! Equilibrium at a fixed approach: a local minimum of the energy, reached without passing over a barrier.
//!
//! L-BFGS with three pairs and a *split* preconditioner, `M⁻¹ = P_O K⁻¹ P_O + P_C (max(V'', 0) + 0.7)⁻¹ P_C` in E*/dx: points in contact `C` are
//! nearly fixed by the wall, and on the open points `O` the inverse of the elastic operator is the opposite-order (Calderón) preconditioner of the
//! hypersingular operator. So the iterations grow only with log² of the grid. An iteration is two operator applications, four transforms.

use super::contact::{Problem, State};
use super::grid::{Operator, Waves};
use super::sums::{PANEL, add, dot, grain, largest, remove_mean, sums};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;

/// Pairs of steps and gradient changes that are kept.
const PAIRS: usize = 3;
/// Slope of the law from which a point counts as in contact, and the addition to it, in E*/dx.
const STIFF: f64 = 0.3;
const ADDED: f64 = 0.7;

/// How exactly, and how long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Root mean square of the residual, of the maximum tension.
    pub rms: f64,
    /// Largest residual, of the maximum tension.
    pub largest: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// Result of a minimisation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Outcome {
    /// Iterations.
    pub iterations: usize,
    /// Root mean square of the residual, of the maximum tension.
    pub residual: f64,
    /// Whether the accuracy was reached.
    pub converged: bool,
}

/// Work space.
pub struct Minimiser {
    /// Waves of the operator.
    pub waves: Waves,
    pub(super) residual: Vec<f64>,
    pub(super) slopes: Vec<f64>,
    previous: Vec<f64>,
    pub(super) direction: Vec<f64>,
    pub(super) response: Vec<f64>,
    masked: Vec<f64>,
    pairs: Vec<Pair>,
    /// Whether the points in contact have a preconditioner of their own; else that of the open points, shifted, is used for all.
    pub split: bool,
}

struct Pair {
    step: Vec<f64>,
    change: Vec<f64>,
    curvature: f64,
    weight: f64,
}

impl Minimiser {
    /// Work space for a problem.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn new(problem: &Problem) -> Result<Self, PhysicsError> {
        let field = || filled(problem.half_space.points(), 0.0);
        Ok(Self {
            waves: problem.half_space.waves()?,
            residual: field()?,
            slopes: field()?,
            previous: field()?,
            direction: field()?,
            response: field()?,
            masked: field()?,
            pairs: Vec::new(),
            split: true,
        })
    }

    /// Moves `state` to the local minimum of the energy at its approach; bonds around contacts grow on the way.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn minimise(&mut self, problem: &Problem, state: &mut State, accuracy: Accuracy) -> Result<Outcome, PhysicsError> {
        let strength = problem.stress();
        let mut outcome = Outcome::default();
        let mut free: Vec<Pair> = std::mem::take(&mut self.pairs);
        let mut pairs: Vec<Pair> = Vec::new();
        problem.refresh(state, &mut self.waves);
        loop {
            if problem.update_bonds(state, false) {
                free.append(&mut pairs);
            }
            let (rms, most) = problem.residual(state, &mut self.residual, &mut self.slopes);
            outcome.residual = rms / strength;
            outcome.converged = rms <= accuracy.rms * strength && most <= accuracy.largest * strength;
            if outcome.converged || outcome.iterations >= accuracy.iterations {
                break;
            }
            outcome.iterations += 1;
            if outcome.iterations > 1 {
                self.remember(&mut pairs, &mut free)?;
            }
            self.direction(problem, &mut pairs);
            if dot(&self.direction, &self.residual) >= 0.0 {
                free.append(&mut pairs);
                self.direction(problem, &mut pairs);
            }
            problem.half_space.apply(Operator::Stiffness, &self.direction, &mut self.response, &mut self.waves);
            let step = self.step_length(problem, state);
            self.previous.copy_from_slice(&self.residual);
            add(&mut state.displacement, step, &self.direction);
            add(&mut state.pressure, step, &self.response);
            let scale = step;
            self.direction.par_chunks_mut(PANEL).with_min_len(grain(PANEL)).for_each(|part| part.iter_mut().for_each(|x| *x *= scale));
            if step == 0.0 {
                break;
            }
        }
        free.append(&mut pairs);
        self.pairs = free;
        Ok(outcome)
    }

    /// Keeps the last step and the change of the gradient that it brought.
    fn remember(&mut self, pairs: &mut Vec<Pair>, free: &mut Vec<Pair>) -> Result<(), PhysicsError> {
        let curvature = dot(&self.direction, &self.residual) - dot(&self.direction, &self.previous);
        if curvature <= 1e-12 * dot(&self.direction, &self.direction) {
            return Ok(());
        }
        let points = self.direction.len();
        let mut pair = match free.pop() {
            Some(pair) => pair,
            None if pairs.len() >= PAIRS => pairs.remove(0),
            None => Pair { step: filled(points, 0.0)?, change: filled(points, 0.0)?, curvature: 0.0, weight: 0.0 },
        };
        if pairs.len() >= PAIRS {
            free.push(pairs.remove(0));
        }
        pair.step.copy_from_slice(&self.direction);
        let (residual, previous) = (&self.residual, &self.previous);
        pair.change.par_chunks_mut(PANEL).enumerate().with_min_len(grain(PANEL)).for_each(|(panel, part)| {
            let from = panel * PANEL;
            part.iter_mut().enumerate().for_each(|(k, x)| *x = residual[from + k] - previous[from + k]);
        });
        pair.curvature = curvature;
        pairs.push(pair);
        Ok(())
    }

    /// The two loops of L-BFGS with the split preconditioner between them; a direction of descent without a mean.
    fn direction(&mut self, problem: &Problem, pairs: &mut [Pair]) {
        self.direction.copy_from_slice(&self.residual);
        for pair in pairs.iter_mut().rev() {
            pair.weight = dot(&pair.step, &self.direction) / pair.curvature;
            add(&mut self.direction, -pair.weight, &pair.change);
        }
        self.precondition(problem);
        for pair in pairs.iter() {
            let weight = pair.weight - dot(&pair.change, &self.direction) / pair.curvature;
            add(&mut self.direction, weight, &pair.step);
        }
        self.direction.par_chunks_mut(PANEL).with_min_len(grain(PANEL)).for_each(|part| part.iter_mut().for_each(|x| *x = -*x));
        remove_mean(&mut self.direction);
    }

    /// `direction ← M⁻¹ direction`.
    pub(super) fn precondition(&mut self, problem: &Problem) {
        if !self.split {
            problem.half_space.apply(Operator::Shifted, &self.direction, &mut self.response, &mut self.waves);
            self.direction.copy_from_slice(&self.response);
            return;
        }
        let slopes = &self.slopes;
        self.masked.par_chunks_mut(PANEL).zip(self.direction.par_chunks(PANEL)).enumerate().with_min_len(grain(PANEL)).for_each(
            |(panel, (to, from))| {
                for (k, (x, y)) in to.iter_mut().zip(from).enumerate() {
                    *x = if slopes[panel * PANEL + k] > STIFF { 0.0 } else { *y };
                }
            },
        );
        problem.half_space.apply(Operator::Compliance, &self.masked, &mut self.response, &mut self.waves);
        let response = &self.response;
        self.direction.par_chunks_mut(PANEL).enumerate().with_min_len(grain(PANEL)).for_each(|(panel, part)| {
            for (k, x) in part.iter_mut().enumerate() {
                let point = panel * PANEL + k;
                *x = if slopes[point] > STIFF { *x / (slopes[point] + ADDED) } else { response[point] };
            }
        });
    }

    /// Length of the step along the direction: at most the reach of the law, and such that the energy falls.
    pub(super) fn step_length(&self, problem: &Problem, state: &State) -> f64 {
        let mut step = (problem.reach() / largest(&self.direction)).min(1.0);
        let [slope, linear, quadratic, start] = sums::<4>(self.direction.len(), |range, sum| {
            for k in range {
                sum[0] += self.direction[k] * self.residual[k];
                sum[1] += self.direction[k] * state.pressure[k];
                sum[2] += self.direction[k] * self.response[k];
                sum[3] += problem.bond(state.bonds[k], problem.gap(state, k)).energy;
            }
        });
        for _ in 0..30 {
            let end = sums::<1>(self.direction.len(), |range, sum| {
                for k in range {
                    sum[0] += problem.bond(state.bonds[k], problem.gap(state, k) + step * self.direction[k]).energy;
                }
            })[0];
            // Below rounding of the energies the slope alone decides.
            let change = step * (linear + 0.5 * step * quadratic) + (end - start);
            if change <= 1e-4 * step * slope + 1e-13 * start.abs() {
                return step;
            }
            step *= 0.4;
        }
        0.0
    }
}
