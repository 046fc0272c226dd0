//! Equilibrium at a fixed mean penetration: a local minimum of the energy, reached without passing over a
//! barrier.
//!
//! L-BFGS with two pairs and a *split* preconditioner, `M⁻¹ = P_O S K⁻¹ S P_O + P_C (V'' + 0.7)⁻¹ P_C` with
//! `M` in E*/dx. Points in contact `C`, of `V'' > 0.3 E*/dx`, are nearly fixed by the wall. On the open
//! points `O` the inverse of the elastic operator is the opposite-order (Calderón) preconditioner of the
//! hypersingular operator, with the factor `S = 1 − min(V'', 0)` where the law softens. The condition number
//! grows only as log² of the number of points along a side. An iteration is two operator applications, four
//! transforms.
//!
//! Where bonds change in a few places, as in most events, these are brought to equilibrium first, on
//! [patches](super::patch) of the grid.
//!
//! The state, its energy and its residual are in double precision at the beginning and at the end.
//! Directions, and displacement and pressure since the beginning, are in single precision. The pressure is
//! replaced by that of the displacement before a state counts as an equilibrium.

use super::increment::{SinglePrecisionIncrement, level};
use super::line::{Gaps, add_line};
use super::pairs::{Gradient, Pairs};
use super::passes::{Found, Points, Stride, advance};
use super::preconditioner::Preconditioner;
use super::trial::{Residual, TrialEvaluation};
use crate::PhysicsError;
use crate::elements::grid::half_space::{Operator, Waves};
use crate::elements::grid::sums::{grain, sums};
use crate::elements::law::Bonding;
use crate::elements::problem::{Nucleation, Problem, State};
use crate::memory::filled;
use rayon::prelude::*;

/// Loads of the states that are looked for \[E* dx²\].
pub(crate) type Loads = std::ops::Range<f64>;
/// All loads.
pub(crate) const ANY: Loads = f64::NEG_INFINITY..f64::INFINITY;

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

impl Accuracy {
    /// True if a residual is within it.
    pub(crate) fn includes(&self, residual: Residual, stress: f64) -> bool {
        residual.rms <= self.rms * stress && residual.largest <= self.largest * stress
    }
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
    /// True if an event moved the load out of the requested range; the state is then invalid.
    pub(crate) left: bool,
}

/// Work space.
pub struct Minimiser {
    double: Waves<f64>,
    pub(crate) single: Waves<f32>,
    pub(crate) gradient: Gradient,
    pub(crate) previous: Gradient,
    /// About the mean of pressure and tension of the whole grid, which is subtracted before the gradient is
    /// rounded.
    pub(crate) centre: f64,
    pub(crate) slopes: Vec<f32>,
    pub(crate) direction: Vec<f32>,
    pub(crate) response: Vec<f32>,
    pub(super) increment: SinglePrecisionIncrement,
    /// Rates of the step φ of [lines](super::line); empty without them.
    pub(super) rates: Vec<f32>,
    pub(crate) pairs: Pairs,
    /// Preconditioner.
    pub preconditioner: Preconditioner,
}

/// State during a minimisation.
pub(crate) struct WorkingState<'a> {
    pub(crate) problem: &'a Problem,
    /// Present bonds; mean penetration, displacement and pressure at the last rebase.
    pub(crate) state: &'a mut State,
    /// Displacement and pressure since then.
    pub(crate) displacement_change: &'a [f32],
    pub(crate) pressure_change: &'a [f32],
    /// Displacement by local relaxation, without its elastic response.
    pub(crate) relaxed: &'a mut [f32],
}

impl WorkingState<'_> {
    /// Displacement of a point.
    pub(crate) fn displacement(&self, point: usize) -> f64 {
        self.state.displacement[point]
            + f64::from(self.displacement_change[point])
            + f64::from(self.relaxed[point])
    }
}

/// Source of the elastic response to the direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ElasticResponse {
    /// The response that is kept.
    Kept,
    /// The operator applied to the transformed direction; the response is kept.
    Transformed,
}

/// Change of the displacement: `length` times the direction less its `mean`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Shift {
    pub(super) length: f64,
    pub(super) mean: f64,
}

/// Fields that a step reads and changes.
struct Fields<'a> {
    increment: &'a mut SinglePrecisionIncrement,
    direction: &'a [f32],
    gradient: &'a mut [f32],
    slopes: &'a mut [f32],
    bonds: &'a [Bonding],
}

impl<'a> Fields<'a> {
    /// Rows of the fields, each with its flag of stale bonds.
    fn rows(self, columns: usize) -> impl IndexedParallelIterator<Item = (Points<'a>, &'a mut bool)> {
        let SinglePrecisionIncrement { gap, residual, displacement, pressure, touching, stale, .. } =
            self.increment;
        let before =
            gap.par_chunks(columns).zip(residual.par_chunks(columns)).zip(self.direction.par_chunks(columns));
        let after = displacement
            .par_chunks_mut(columns)
            .zip(pressure.par_chunks_mut(columns))
            .zip(touching.par_chunks_mut(columns));
        let law = self
            .gradient
            .par_chunks_mut(columns)
            .zip(self.slopes.par_chunks_mut(columns))
            .zip(self.bonds.par_chunks(columns));
        before.zip(after).zip(law).zip(stale).map(
            |(
                (
                    (((gap, residual), direction), ((displacement, pressure), touching)),
                    ((gradient, slopes), bonds),
                ),
                stale,
            )| {
                (
                    Points {
                        gap,
                        residual,
                        displacement,
                        pressure,
                        bonds,
                        direction,
                        gradient,
                        slopes,
                        touching,
                    },
                    stale,
                )
            },
        )
    }
}

/// Local relaxation after events.
pub(crate) trait LocalRelaxation {
    /// Brings the places around the points whose bonds have changed to equilibrium, given from the largest
    /// residual to the smallest. `centre` is the mean of pressure and tension of the grid. The points whose
    /// bond has changed since, with the bond before.
    fn relax(
        &mut self,
        on: WorkingState<'_>,
        changed: &[usize],
        centre: f64,
        accuracy: Accuracy,
    ) -> Vec<(usize, Bonding)>;
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
            increment: SinglePrecisionIncrement::new(problem)?,
            rates: filled(if problem.law.has_line() { points } else { 0 }, 0.0)?,
            pairs: Pairs::new(points)?,
            preconditioner: Preconditioner { split: true },
        })
    }

    /// Real transforms so far, in both precisions.
    #[must_use]
    pub fn transforms(&self) -> u64 {
        self.double.transforms + self.single.transforms
    }

    /// Moves `state` to the local minimum of the energy at its mean penetration; bonds around contacts grow
    /// on the way.
    pub fn minimise(&mut self, problem: &Problem, state: &mut State, accuracy: Accuracy) -> Outcome {
        self.minimise_with(problem, state, accuracy, &ANY, None)
    }

    /// As [`Self::minimise`], with events relaxed by `local` first. Ends where an event takes the load out of
    /// `loads`.
    pub(crate) fn minimise_with(
        &mut self,
        problem: &Problem,
        state: &mut State,
        accuracy: Accuracy,
        loads: &Loads,
        mut local: Option<&mut dyn LocalRelaxation>,
    ) -> Outcome {
        let (stress, limits) = (problem.stress(), &problem.numerics.equilibrium);
        let mut outcome = Outcome::default();
        self.pairs.clear();
        let mut here = self.start_from(problem, state);
        let (mut change, mut exact, mut first) = (0.0, true, here.rms);
        loop {
            (outcome.residual, outcome.converged) = (here.rms / stress, accuracy.includes(here, stress));
            if !exact && (outcome.converged || here.rms < limits.renewed_residual * first) {
                // Checked once more with the pressure without rounding and with bonds renewed, or continued
                // from there.
                self.commit(state);
                exact = problem.update_bonds(state, Nucleation::Suppressed).is_empty();
                here = self.start_from(problem, state);
                (change, first) = (0.0, here.rms);
                self.pairs.project_gradient(&self.gradient);
                continue;
            }
            if outcome.converged || outcome.iterations >= accuracy.iterations {
                self.commit(state);
                return outcome;
            }
            outcome.iterations += 1;
            let descent = self.search(problem);
            let found = self.descend(problem, state, descent, ElasticResponse::Transformed);
            let Some((step, residual)) = found else {
                self.commit(state);
                if exact {
                    return outcome;
                }
                // The energy falls by less than its rounding.
                here = self.start_from(problem, state);
                (exact, first) = (true, here.rms);
                self.pairs.clear();
                continue;
            };
            (here, exact) = (residual, false);
            change += step.largest;
            let is_settled = here.largest <= limits.bond_update_residual * stress;
            if change > limits.bond_update_change * problem.reach() && is_settled {
                change = 0.0;
                let late = outcome.iterations >= limits.whole_iterations;
                outcome.left = late && !loads.contains(&self.load(problem, state));
                if outcome.left {
                    return outcome;
                }
                let (increment, bonds) = (&mut self.increment, &mut state.bonds);
                let changed = problem.spread_bonds(bonds, &increment.touching, &mut increment.stale);
                if !changed.is_empty() {
                    self.increment.rebond(problem, &state.bonds, &changed);
                    if late && let Some(local) = local.as_mut() {
                        here = self.relax_locally(problem, state, &changed, accuracy, *local);
                        self.pairs.clear();
                        continue;
                    }
                    here = self.present_residual(problem, state);
                }
            }
            let Self { pairs, direction, gradient, previous, .. } = self;
            pairs.push_pair(direction, descent.mean, step.length, gradient, previous);
        }
    }

    /// Load of the present state: pressure less the gradient, which is pressure and tension. With a fixed
    /// mean displacement the mean pressure is 0.
    fn load(&self, problem: &Problem, state: &State) -> f64 {
        if problem.half_space.fixes_mean() {
            return -self.centre * self.slopes.len() as f64;
        }
        let (pressure, change) = (&state.pressure, &self.increment.pressure);
        let [load] = sums(pressure.len(), |range, sum| {
            for k in range {
                sum[0] += pressure[k] + f64::from(change[k]) - f64::from(self.gradient.values[k]);
            }
        });
        load
    }

    /// Relaxes the places of changed bonds, moves the state by that and returns its residual.
    fn relax_locally(
        &mut self,
        problem: &Problem,
        state: &mut State,
        changed: &[(usize, Bonding)],
        accuracy: Accuracy,
        local: &mut dyn LocalRelaxation,
    ) -> Residual {
        let changed = self.sorted(changed);
        let Self { increment, direction, single, .. } = self;
        direction.fill(0.0);
        let (displacement_change, pressure_change) = (&increment.displacement, &increment.pressure);
        let on = WorkingState { problem, state, displacement_change, pressure_change, relaxed: direction };
        let changed = local.relax(on, &changed, self.centre, accuracy);
        increment.rebond(problem, &state.bonds, &changed);
        let columns = problem.half_space.columns();
        let sums = problem.half_space.forward(single, direction.par_chunks(columns), |from, row| {
            row.copy_from_slice(from);
            from.iter().map(|moved| f64::from(*moved)).sum::<f64>()
        });
        let mean = self.mean(problem, sums.iter().sum());
        self.evaluate(problem, state, Shift { length: 1.0, mean }, ElasticResponse::Transformed).residual
    }

    /// Points whose bond has changed, from the largest residual to the smallest.
    fn sorted(&self, changed: &[(usize, Bonding)]) -> Vec<usize> {
        let mut points: Vec<usize> = changed.iter().map(|(point, _)| *point).collect();
        let residual = |point: &usize| (self.gradient.values[*point] - self.gradient.mean as f32).abs();
        points.sort_by(|a, b| residual(b).total_cmp(&residual(a)));
        points
    }

    /// Starts from a state: its pressure without the rounding of increments, and its gradient. A patch keeps
    /// the pressure and the mean of the whole grid.
    pub(crate) fn start_from(&mut self, problem: &Problem, state: &mut State) -> Residual {
        if !problem.half_space.is_patch() {
            problem.refresh(state, &mut self.double);
            self.centre = if problem.half_space.fixes_mean() { level(problem, state) } else { 0.0 };
        }
        self.increment.rebase(problem, state, self.centre);
        self.present_residual(problem, state)
    }

    /// Evaluates gradient and slopes of the law at a state, without changing it.
    pub(crate) fn evaluate_at(&mut self, problem: &Problem, state: &State) {
        self.centre = 0.0;
        self.increment.rebase(problem, state, 0.0);
        self.present_residual(problem, state);
    }

    /// Adds the changes since [`Self::start_from`] to the state.
    pub(crate) fn commit(&self, state: &mut State) {
        self.increment.commit(state);
    }

    /// Adds the elastic pressure of a displacement `moved` to the state.
    pub(crate) fn add_pressure(&mut self, problem: &Problem, state: &mut State, moved: &[f64]) {
        let mut added = vec![0.0; moved.len()];
        problem.half_space.apply(Operator::Stiffness, moved, &mut added, &mut self.double);
        state.pressure.iter_mut().zip(&added).for_each(|(pressure, added)| *pressure += added);
    }

    /// Mean of a field of which the sum is given, to be subtracted: none where the mean is not fixed.
    pub(super) fn mean(&self, problem: &Problem, sum: f64) -> f64 {
        if problem.half_space.fixes_mean() { sum / self.slopes.len() as f64 } else { 0.0 }
    }

    /// Moves the state along the direction, and computes the gradient and the slopes of the law there.
    pub(super) fn evaluate(
        &mut self,
        problem: &Problem,
        state: &State,
        shift: Shift,
        response: ElasticResponse,
    ) -> TrialEvaluation {
        let columns = problem.half_space.columns();
        let stride = Stride {
            length: shift.length as f32,
            mean: shift.mean as f32,
            centre: (self.centre - self.increment.centre) as f32,
        };
        let pieces = self.increment.pieces;
        let fields = Fields {
            increment: &mut self.increment,
            direction: &self.direction,
            gradient: &mut self.gradient.values,
            slopes: &mut self.slopes,
            bonds: &state.bonds,
        };
        let rows = fields.rows(columns);
        let take = |(mut points, stale): (Points<'_>, &mut bool), response: &[f32]| {
            let found = advance(&mut points, response, stride, &problem.law, &pieces);
            *stale |= found.changed;
            found
        };
        let parts: Vec<Found> = match response {
            ElasticResponse::Transformed => {
                let rows = rows.zip(self.response.par_chunks_mut(columns));
                problem.half_space.backward(
                    Operator::Stiffness,
                    &mut self.single,
                    rows,
                    |(row, kept), response| {
                        kept.copy_from_slice(response);
                        take(row, response)
                    },
                )
            }
            ElasticResponse::Kept => {
                let rows = rows.zip(self.response.par_chunks(columns)).with_min_len(grain(columns));
                rows.map(|(row, response)| take(row, response)).collect()
            }
        };
        let mut all = Found::default();
        parts.iter().for_each(|part| all.add(part));
        if problem.law.has_line() {
            let SinglePrecisionIncrement { gap, displacement, .. } = &self.increment;
            let from = Gaps { gap, displacement, direction: &self.direction, bonds: &state.bonds };
            let bent = add_line(problem, from, &mut self.gradient.values, &mut self.slopes, stride);
            all = Found { beyond: all.beyond + bent.beyond, curvature: all.curvature, ..bent };
        }
        let (points, [sum, square]) = (self.slopes.len() as f64, all.gradient);
        let lowered = self.mean(problem, sum);
        self.gradient.mean = lowered;
        self.centre += lowered;
        let rms = (square / points - lowered * lowered).max(0.0).sqrt();
        TrialEvaluation {
            residual: Residual { rms, largest: all.largest + lowered.abs() },
            slope: all.slope - points * shift.mean * lowered,
            curvature: all.curvature,
            beyond: all.beyond,
        }
    }

    /// Residual of the present state.
    fn present_residual(&mut self, problem: &Problem, state: &State) -> Residual {
        self.evaluate(problem, state, Shift::default(), ElasticResponse::Kept).residual
    }
}
