//! Equilibrium at a fixed approach: a local minimum of the energy, reached without passing over a barrier.
//!
//! L-BFGS with three pairs and a *split* preconditioner, `M⁻¹ = P_O K⁻¹ P_O + P_C (V'' + 0.7)⁻¹ P_C` with `M` in E*/dx. Points in contact `C`, of
//! `V'' > 0.3 E*/dx`, are nearly fixed by the wall. On the open points `O` the inverse of the elastic operator is the opposite-order (Calderón)
//! preconditioner of the hypersingular operator. The condition number grows only as log² of the number of points along a side. An iteration is two
//! operator applications, four transforms.
//!
//! Where bonds change in a few places, as in most events, these are brought to equilibrium first, on [patches](super::patch) of the grid.
//!
//! The state, its energy and its residual are in double precision; directions and what they are made of in single precision. The pressure that the
//! increments have added up to is replaced by that of the displacement before a state counts as an equilibrium.

use super::contact::{Problem, State};
use super::grid::{Operator, Waves};
use super::pairs::{Gradient, Pairs};
use super::preconditioner::Preconditioner;
use super::sums::{PANEL, grain, panel_largest, panel_sums, panel_work, total};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;

/// Change of the displacement between two updates of the bonds, relative to the reach of the law.
const LOOK: f64 = 0.02;
/// Largest residual at which bonds are updated, relative to [`Problem::stress`]. Far from equilibrium, edges of contact lie where no equilibrium has
/// them.
const NEAR: f64 = 0.4;
/// Iterations on the whole grid before an event counts as one: the first follow the approach everywhere.
const EVERYWHERE: usize = 8;
/// Shortenings of a step that would raise the energy.
const SHORTENINGS: u32 = 30;

/// Criteria of convergence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Root mean square of the residual, relative to [`Problem::stress`].
    pub rms: f64,
    /// Largest residual, relative to [`Problem::stress`].
    pub largest: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// Result of a minimisation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Outcome {
    /// Iterations of L-BFGS, or of conjugate gradients by [`Minimiser::newton`].
    pub iterations: usize,
    /// Root mean square of the residual, relative to [`Problem::stress`].
    pub residual: f64,
    /// True if the accuracy was reached.
    pub converged: bool,
}

/// Energy of the law and residual at a state.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Here {
    /// Energy of the law, and the sum of its magnitudes.
    energy: f64,
    scale: f64,
    /// Root mean square of the residual and a bound of its largest magnitude.
    pub(super) rms: f64,
    pub(super) largest: f64,
}

impl Here {
    pub(super) fn within(&self, accuracy: Accuracy, stress: f64) -> bool {
        self.rms <= accuracy.rms * stress && self.largest <= accuracy.largest * stress
    }
}

/// A direction of descent: its mean, which is no part of it, and the slope of the energy along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Descent {
    pub(super) mean: f64,
    pub(super) slope: f64,
}

/// Work space.
pub struct Minimiser {
    double: Waves<f64>,
    pub(super) single: Waves<f32>,
    pub(super) gradient: Gradient,
    previous: Gradient,
    /// Mean of pressure and tension of the whole grid, which is subtracted before the gradient is rounded.
    pub(super) centre: f64,
    pub(super) slopes: Vec<f32>,
    pub(super) direction: Vec<f32>,
    pub(super) response: Vec<f32>,
    pairs: Pairs,
    /// Preconditioner.
    pub preconditioner: Preconditioner,
}

/// Local relaxation after events.
pub(super) trait Follow {
    /// Brings the places around the points whose bonds have changed to equilibrium, given from the largest residual to the smallest: whether the state has
    /// moved. `centre` is the mean of pressure and tension of the grid.
    fn follow(&mut self, on: (&Problem, &mut State), changed: &[usize], centre: f64, accuracy: Accuracy) -> bool;
}

/// Nothing: events are followed on the whole grid.
impl Follow for () {
    fn follow(&mut self, _: (&Problem, &mut State), _: &[usize], _: f64, _: Accuracy) -> bool {
        false
    }
}

impl Minimiser {
    /// Work space for a problem.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn new(problem: &Problem) -> Result<Self, PhysicsError> {
        let points = problem.half_space.points();
        let field = || filled(points, 0.0_f32);
        let gradient = || Ok::<_, PhysicsError>(Gradient { values: field()?, mean: 0.0 });
        Ok(Self {
            double: problem.half_space.waves()?,
            single: problem.half_space.waves()?,
            gradient: gradient()?,
            previous: gradient()?,
            centre: 0.0,
            slopes: field()?,
            direction: field()?,
            response: field()?,
            pairs: Pairs::new(points)?,
            preconditioner: Preconditioner::new(points)?,
        })
    }

    /// Real transforms so far, in both precisions.
    #[must_use]
    pub fn transforms(&self) -> u64 {
        self.double.transforms + self.single.transforms
    }

    /// Moves `state` to the local minimum of the energy at its approach; bonds around contacts grow on the way.
    pub fn minimise(&mut self, problem: &Problem, state: &mut State, accuracy: Accuracy) -> Outcome {
        self.minimise_with(problem, state, accuracy, &mut ())
    }

    /// As [`Self::minimise`], with events followed by `events` first.
    pub(super) fn minimise_with(&mut self, problem: &Problem, state: &mut State, accuracy: Accuracy, events: &mut dyn Follow) -> Outcome {
        let stress = problem.stress();
        let mut outcome = Outcome::default();
        self.pairs.clear();
        let mut here = self.begin(problem, state);
        let (mut moved, mut exact) = (0.0, true);
        loop {
            (outcome.residual, outcome.converged) = (here.rms / stress, here.within(accuracy, stress));
            if outcome.converged && !exact {
                // Converged with the accumulated pressure and the bonds so far: checked once more with both renewed.
                exact = problem.update_bonds(state, false).is_empty();
                here = self.begin(problem, state);
                moved = 0.0;
                self.pairs.face(&self.gradient);
                continue;
            }
            if outcome.converged || outcome.iterations >= accuracy.iterations {
                return outcome;
            }
            outcome.iterations += 1;
            let descent = self.search(problem);
            problem.half_space.apply(Operator::Stiffness, &self.direction, &mut self.response, &mut self.single);
            let Some((step, there)) = self.descend(problem, state, here, descent) else { return outcome };
            (here, exact) = (there, false);
            moved += step.largest;
            let look = moved > LOOK * problem.reach() && here.largest <= NEAR * stress;
            if look {
                moved = 0.0;
            }
            let mut changed = if look { problem.update_bonds(state, false) } else { Vec::new() };
            let event = outcome.iterations >= EVERYWHERE && !changed.is_empty();
            if event && events.follow((problem, state), self.sorted(&mut changed), self.centre, accuracy) {
                here = self.begin(problem, state);
                self.pairs.clear();
                continue;
            }
            if !changed.is_empty() {
                here = self.evaluate(problem, state, 0.0, 0.0);
            }
            self.pairs.remember(&mut self.direction, descent.mean, step.length, &self.gradient, &self.previous);
        }
    }

    /// Points from the largest residual to the smallest.
    fn sorted<'p>(&self, points: &'p mut [usize]) -> &'p [usize] {
        let residual = |point: &usize| (self.gradient.values[*point] - self.gradient.mean as f32).abs();
        points.sort_by(|a, b| residual(b).total_cmp(&residual(a)));
        points
    }

    /// Pressure without the rounding of its increments, and gradient of a state. A patch keeps the pressure and the mean of the whole grid.
    pub(super) fn begin(&mut self, problem: &Problem, state: &mut State) -> Here {
        if !problem.half_space.is_patch() {
            problem.refresh(state, &mut self.double);
            self.centre = -problem.totals(state).load / self.slopes.len() as f64;
        }
        self.evaluate(problem, state, 0.0, 0.0)
    }

    /// Adds the pressure of a displacement that the state has moved by.
    pub(super) fn press(&mut self, problem: &Problem, state: &mut State, moved: &[f64]) {
        let mut added = vec![0.0; moved.len()];
        problem.half_space.apply(Operator::Stiffness, moved, &mut added, &mut self.double);
        state.pressure.iter_mut().zip(&added).for_each(|(pressure, added)| *pressure += added);
    }

    /// Mean of a field of which the sum is given, to be subtracted: none on a patch, where the mean is not fixed.
    fn mean(&self, problem: &Problem, sum: f64) -> f64 {
        if problem.half_space.is_patch() { 0.0 } else { sum / self.slopes.len() as f64 }
    }

    /// Moves the state by `length` along the direction less its mean, and computes the gradient and the slopes of the law there.
    fn evaluate(&mut self, problem: &Problem, state: &mut State, length: f64, mean: f64) -> Here {
        let centre = self.centre;
        let points = self.slopes.len() as f64;
        let fields = (
            state.displacement.par_chunks_mut(PANEL),
            state.pressure.par_chunks_mut(PANEL),
            state.bonds.par_chunks(PANEL),
            problem.heights.par_chunks(PANEL),
            self.direction.par_chunks(PANEL),
            self.response.par_chunks(PANEL),
            self.gradient.values.par_chunks_mut(PANEL),
            self.slopes.par_chunks_mut(PANEL),
        );
        let approach = state.approach;
        let parts = fields.into_par_iter().map(|(u, p, bonds, z, d, k, g, slopes)| {
            if length != 0.0 {
                u.iter_mut().zip(d).for_each(|(u, d)| *u += length * (f64::from(*d) - mean));
                p.iter_mut().zip(k).for_each(|(p, k)| *p += length * f64::from(*k));
            }
            let (mut energy, mut scale) = (0.0, 0.0);
            let points = u.iter().zip(p.iter()).zip(bonds.iter().zip(z)).zip(g.iter_mut().zip(slopes));
            for (((u, p), (bonding, z)), (g, slope)) in points {
                let bond = problem.bond(*bonding, u - approach - z);
                (*g, *slope) = ((p + bond.tension - centre) as f32, bond.slope as f32);
                energy += bond.energy;
                scale += bond.energy.abs();
            }
            let [sum, square] = panel_sums([&*g], |[g]| [g, g * g]);
            [energy, scale, sum, square, panel_largest(g)]
        });
        let parts: Vec<[f64; 5]> = parts.with_min_len(grain(PANEL)).collect();
        let [energy, scale, sum, square, largest] = parts.iter().fold([0.0; 5], |all: [f64; 5], part| {
            [all[0] + part[0], all[1] + part[1], all[2] + part[2], all[3] + part[3], all[4].max(part[4])]
        });
        let mean = self.mean(problem, sum);
        self.gradient.mean = mean;
        self.centre += mean;
        Here { energy, scale, rms: (square / points - mean * mean).max(0.0).sqrt(), largest: largest + mean.abs() }
    }

    /// A direction of descent, by the pairs if they give one.
    fn search(&mut self, problem: &Problem) -> Descent {
        let weights = self.pairs.first();
        let onto = self.precondition(problem, weights);
        let descent = self.finish(problem, self.pairs.second(weights, onto));
        if descent.slope < 0.0 {
            return descent;
        }
        self.pairs.clear();
        self.precondition(problem, [0.0; 3]);
        self.finish(problem, [0.0; 3])
    }

    /// Adds the weighted steps of the pairs to the direction.
    fn finish(&mut self, problem: &Problem, weights: [f64; 3]) -> Descent {
        let [sum, product] = self.pairs.finish(&mut self.direction, weights, &self.gradient);
        let mean = self.mean(problem, sum);
        Descent { mean, slope: product - self.slopes.len() as f64 * mean * self.gradient.mean }
    }

    /// `direction ← M⁻¹ (gradient − Σ weights_i y_i)`: its products with the changes `y`.
    fn precondition(&mut self, problem: &Problem, weights: [f64; 3]) -> [f64; 3] {
        let [wa, wb, wc] = weights.map(|weight| weight as f32);
        let mean = self.gradient.mean as f32;
        let [a, b, c] = self.pairs.changes();
        let fields = (
            self.direction.par_chunks_mut(PANEL),
            self.gradient.values.par_chunks(PANEL),
            a.par_chunks(PANEL),
            b.par_chunks(PANEL),
            c.par_chunks(PANEL),
        );
        fields.into_par_iter().with_min_len(grain(PANEL)).for_each(|(d, g, a, b, c)| {
            for ((((d, g), a), b), c) in d.iter_mut().zip(g).zip(a).zip(b).zip(c) {
                *d = g - mean - wa * a - wb * b - wc * c;
            }
        });
        self.divide(problem);
        let [a, b, c] = self.pairs.changes();
        let fields = (self.direction.par_chunks(PANEL), a.par_chunks(PANEL), b.par_chunks(PANEL), c.par_chunks(PANEL));
        total(fields.into_par_iter().map(|(d, a, b, c)| panel_sums([d, a, b, c], |[d, a, b, c]| [d * a, d * b, d * c])))
    }

    /// `direction ← M⁻¹ direction`.
    pub(super) fn divide(&mut self, problem: &Problem) {
        let Self { preconditioner, single, direction, response, slopes, .. } = self;
        preconditioner.divide(problem, single, (direction, response), slopes);
    }

    /// Moves the state along the direction, whose elastic response is known, by at most the reach of the law and so far that the energy falls: the step
    /// and the energy and residual after it. Without such a step the state stays.
    pub(super) fn descend(&mut self, problem: &Problem, state: &mut State, here: Here, descent: Descent) -> Option<(Taken, Here)> {
        let Descent { mean, slope } = descent;
        // On a patch the direction has a mean, which moves the rest of the grid against the mean of the whole.
        let against = if problem.half_space.is_patch() { self.centre } else { 0.0 };
        let fields = (self.direction.par_chunks(PANEL), self.response.par_chunks(PANEL), state.pressure.par_chunks(PANEL));
        let parts = fields.into_par_iter().map(|(d, k, p)| {
            let [quadratic, sum] = panel_sums([d, k], |[d, k]| [d * k, d]);
            [panel_work(d, p) - against * sum, quadratic, panel_largest(d)]
        });
        let parts: Vec<[f64; 3]> = parts.with_min_len(grain(PANEL)).collect();
        let [linear, quadratic, largest] =
            parts.iter().fold([0.0; 3], |all: [f64; 3], part| [all[0] + part[0], all[1] + part[1], all[2].max(part[2])]);
        std::mem::swap(&mut self.gradient, &mut self.previous);
        let largest = largest + mean.abs();
        let mut step = (problem.reach() / largest).min(1.0);
        let mut taken = 0.0;
        for _ in 0..SHORTENINGS {
            let there = self.evaluate(problem, state, step - taken, mean);
            taken = step;
            let change = there.energy - here.energy;
            // Armijo's condition; a rise below the rounding of the energy is accepted.
            if step * (linear + 0.5 * step * quadratic) + change <= 1e-4 * step * slope + 1e-13 * here.scale {
                return Some((Taken { length: step, largest: step * largest }, there));
            }
            step *= 0.4;
        }
        self.evaluate(problem, state, -taken, mean);
        None
    }
}

/// A step that was taken: its length along the direction and the largest change of the displacement.
#[derive(Debug, Clone, Copy)]
pub(super) struct Taken {
    pub(super) length: f64,
    largest: f64,
}
