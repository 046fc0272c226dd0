//! Equilibrium at a fixed approach: a local minimum of the energy, reached without passing over a barrier.
//!
//! L-BFGS with three pairs and a *split* preconditioner, `M⁻¹ = P_O K⁻¹ P_O + P_C (max(V'', 0) + 0.7)⁻¹ P_C` in E*/dx: points in contact `C` are
//! nearly fixed by the wall, and on the open points `O` the inverse of the elastic operator is the opposite-order (Calderón) preconditioner of the
//! hypersingular operator. So the iterations grow only with log² of the grid. An iteration is two operator applications, four transforms.

use super::contact::{Problem, State};
use super::grid::{Operator, Waves};
use super::pairs::Pairs;
use super::sums::{PANEL, add, dot, grain, largest, sums, sums_of};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;

/// Slope of the law from which a point counts as in contact, and the addition to it, in E*/dx.
const STIFF: f64 = 0.3;
const ADDED: f64 = 0.7;
/// Change of the displacement after which bonds are looked at, of the reach of the law.
const LOOK: f64 = 0.02;

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
    pub(super) direction: Vec<f64>,
    pub(super) response: Vec<f64>,
    previous: Vec<f64>,
    masked: Vec<f64>,
    pairs: Pairs,
    /// Whether the points in contact have a preconditioner of their own; else that of the open points, shifted, is used for all.
    pub split: bool,
}

impl Minimiser {
    /// Work space for a problem.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn new(problem: &Problem) -> Result<Self, PhysicsError> {
        let points = problem.half_space.points();
        let field = || filled(points, 0.0);
        Ok(Self {
            waves: problem.half_space.waves()?,
            residual: field()?,
            slopes: field()?,
            direction: field()?,
            response: field()?,
            previous: field()?,
            masked: field()?,
            pairs: Pairs::new(points)?,
            split: true,
        })
    }

    /// Moves `state` to the local minimum of the energy at its approach; bonds around contacts grow on the way.
    pub fn minimise(&mut self, problem: &Problem, state: &mut State, accuracy: Accuracy) -> Outcome {
        let stress = problem.stress();
        let mut outcome = Outcome::default();
        // Infinite, so that bonds are looked at first.
        let mut moved = f64::INFINITY;
        problem.refresh(state, &mut self.waves);
        self.pairs.clear();
        let mut same = false;
        loop {
            if moved > LOOK * problem.reach() {
                moved = 0.0;
                if problem.update_bonds(state, false) {
                    self.pairs.clear();
                    same = false;
                }
            }
            let (rms, most) = problem.residual(state, &mut self.residual, &mut self.slopes);
            outcome.residual = rms / stress;
            outcome.converged = rms <= accuracy.rms * stress && most <= accuracy.largest * stress;
            if outcome.converged && moved > 0.0 {
                // An equilibrium of the bonds as they are; they may have to change.
                moved = f64::INFINITY;
                continue;
            }
            if outcome.converged || outcome.iterations >= accuracy.iterations {
                return outcome;
            }
            // A change of the bonds changes the gradient too.
            if same {
                self.pairs.remember(&self.direction, &self.residual, &self.previous);
            }
            outcome.iterations += 1;
            self.search(problem);
            problem.half_space.apply(Operator::Stiffness, &self.direction, &mut self.response, &mut self.waves);
            let step = self.step_length(problem, state);
            if step == 0.0 {
                return outcome;
            }
            self.previous.copy_from_slice(&self.residual);
            moved += self.take(state, step);
            same = true;
        }
    }

    /// Takes a step along the direction, which becomes that step: the largest change of the displacement.
    fn take(&mut self, state: &mut State, step: f64) -> f64 {
        add(&mut state.pressure, step, &self.response);
        let fields = state.displacement.par_chunks_mut(PANEL).zip(self.direction.par_chunks_mut(PANEL)).with_min_len(grain(PANEL));
        let one = |(to, direction): (&mut [f64], &mut [f64])| {
            let mut most = 0.0_f64;
            for (u, d) in to.iter_mut().zip(direction) {
                *d *= step;
                *u += *d;
                most = most.max(d.abs());
            }
            most
        };
        fields.map(one).reduce(|| 0.0, f64::max)
    }

    /// A direction of descent, by the pairs if they give one.
    fn search(&mut self, problem: &Problem) {
        self.pairs.first(&self.residual, &mut self.direction);
        self.precondition(problem);
        self.pairs.second(&mut self.direction);
        if dot(&self.direction, &self.residual) >= 0.0 {
            self.pairs.clear();
            self.direction.copy_from_slice(&self.residual);
            self.precondition(problem);
            self.pairs.second(&mut self.direction);
        }
    }

    /// `direction ← M⁻¹ direction`.
    pub(super) fn precondition(&mut self, problem: &Problem) {
        if !self.split {
            problem.half_space.apply(Operator::Shifted, &self.direction, &mut self.response, &mut self.waves);
            self.direction.copy_from_slice(&self.response);
            return;
        }
        let slopes = &self.slopes;
        let open = self.masked.par_chunks_mut(PANEL).zip(self.direction.par_chunks(PANEL)).zip(slopes.par_chunks(PANEL));
        open.with_min_len(grain(PANEL)).for_each(|((to, from), slopes)| {
            for ((x, y), slope) in to.iter_mut().zip(from).zip(slopes) {
                *x = if *slope > STIFF { 0.0 } else { *y };
            }
        });
        problem.half_space.apply(Operator::Compliance, &self.masked, &mut self.response, &mut self.waves);
        let all = self.direction.par_chunks_mut(PANEL).zip(self.response.par_chunks(PANEL)).zip(slopes.par_chunks(PANEL));
        all.with_min_len(grain(PANEL)).for_each(|((to, open), slopes)| {
            for ((x, y), slope) in to.iter_mut().zip(open).zip(slopes) {
                *x = if *slope > STIFF { *x / (slope + ADDED) } else { *y };
            }
        });
    }

    /// Length of the step along the direction: at most the reach of the law, and such that the energy falls.
    pub(super) fn step_length(&self, problem: &Problem, state: &State) -> f64 {
        let (direction, residual) = (&self.direction, &self.residual);
        let mut step = (problem.reach() / largest(direction)).min(1.0);
        let [slope, linear, quadratic] =
            sums_of([direction, residual, &state.pressure, &self.response], |[d, r, p, k]| [d * r, d * p, d * k]);
        for _ in 0..30 {
            // Change of the energy of the law: points that are open before and after have none.
            let [change, scale] = sums::<2>(direction.len(), |range, sum| {
                for k in range {
                    let (bonding, gap) = (state.bonds[k], problem.gap(state, k));
                    let (before, after) = (problem.bond(bonding, gap).energy, problem.bond(bonding, gap + step * direction[k]).energy);
                    sum[0] += after - before;
                    sum[1] += before.abs();
                }
            });
            // Below rounding of the energies the slope alone decides.
            if step * (linear + 0.5 * step * quadratic) + change <= 1e-4 * step * slope + 1e-13 * scale {
                return step;
            }
            step *= 0.4;
        }
        0.0
    }
}
