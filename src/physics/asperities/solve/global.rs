//! Global problem: equilibrium of all contacts at one mean penetration.
//!
//! Unknowns are the contact radii; the residual of each is `D_i − ŵ_i − δ_JKR(a_i)`, with `D_i = Δ + z_i`.
//! The paper's Eq 9 is a diagonal Newton update of all contacts at once; it diverges. Here:
//! - [`GlobalSolver::newton`]: Newton's method with GMRES ([`super::descent`]);
//! - [`GlobalSolver::relax`]: overdamped relaxation ([`super::overdamped`]), where Newton's method fails at a
//!   fold or after a jump.

use super::precision::Precision;
use super::residual::NotConverged;
use super::schwarz::LocalInverse;
use super::trace::PenetrationTrace;
use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::state::State;
use crate::asperities::field::{Interaction as _, Spots, Tangent};
use crate::cycle::Effort;
use crate::math::gmres::{Limits, LinearOperator, Solution, gmres, gmres_and_least};
use std::sync::Arc;

/// Tangents of one precision.
#[derive(Debug, Default)]
struct Tangents {
    /// At the contacts.
    contacts: Tangent,
    /// Positions of free asperities relative to the contacts.
    free: Tangent,
}

/// Solver of the global problem, with its work space.
pub(crate) struct GlobalSolver {
    pub(crate) problem: Arc<Problem>,
    pub(crate) effort: Effort,
    spots: Spots,
    /// Precision of the present solution.
    precision: Precision,
    /// Tangents of the present precision, and of the other one for the positions that they have found.
    tangents: Tangents,
    others: Tangents,
    /// Mean penetration at which all free asperities were evaluated last \[m\].
    swept_at: Option<f64>,
    inverse: LocalInverse,
    /// Residuals of the contacts that were evaluated last \[m\].
    pub(crate) residual: Vec<f64>,
    diagonal: Vec<f64>,
}

impl GlobalSolver {
    pub(crate) fn new(problem: Arc<Problem>) -> Self {
        Self {
            problem,
            effort: Effort::default(),
            spots: Spots::default(),
            precision: Precision::Exact,
            tangents: Tangents::default(),
            others: Tangents::default(),
            swept_at: None,
            inverse: LocalInverse::default(),
            residual: Vec::new(),
            diagonal: Vec::new(),
        }
    }

    /// Goes on with another number of merged contacts.
    pub(crate) fn replace_problem(&mut self, problem: Arc<Problem>) {
        let inverse = std::mem::take(&mut self.inverse);
        *self = Self {
            effort: self.effort,
            swept_at: self.swept_at,
            precision: self.precision,
            inverse,
            ..Self::new(problem)
        };
    }

    /// Begins a solution.
    pub(crate) fn begin(&mut self, precision: Precision) {
        self.inverse.begin();
        if self.precision != precision {
            self.precision = precision;
            std::mem::swap(&mut self.tangents, &mut self.others);
        }
    }

    /// Evaluates displacements, residuals and tangent of a state; returns the largest residual with its
    /// asperity.
    pub(crate) fn evaluate(&mut self, state: &mut State) -> NotConverged {
        let problem = &*Arc::clone(&self.problem);
        problem.spots(state, &mut self.spots);
        let field = problem.field.for_spots(&self.spots, self.precision.of_sums());
        field.linearise(&self.spots, &mut state.displacement, &mut self.tangents.contacts, &mut self.effort);
        if problem.field.uniform() != 0.0 {
            let by_spring = problem.field.by_spring(&self.spots);
            state.displacement.iter_mut().for_each(|w| *w += by_spring);
        }
        self.residual.clear();
        self.diagonal.clear();
        let mut worst = NotConverged::residual(0.0, state.contacts.first().copied().unwrap_or(0));
        for (&i, w) in state.contacts.iter().zip(&state.displacement) {
            let (asperity, a) = (&problem.asperities[i], state.radius[i]);
            let residual = state.mean_penetration_m + problem.heights[i] - w - asperity.penetration(a);
            self.residual.push(residual);
            self.diagonal.push(asperity.penetration_slope(a));
            worst = worst.or_residual(residual, i);
        }
        state.residual_m = worst.residual_m;
        worst
    }

    /// Counts the products of a solution.
    fn count(&mut self, found: Solution) -> Vec<f64> {
        self.effort.products += found.products;
        self.effort.transforms += found.products * self.tangents.contacts.transforms();
        found.x
    }

    /// Newton step with a relative residual of the linear solve.
    pub(super) fn newton_step(&mut self, state: &State, wanted: f64) -> Vec<f64> {
        let Self { problem, tangents, inverse, diagonal, residual, .. } = self;
        let jacobian = Jacobian { tangent: &tangents.contacts, diagonal };
        let inverse = inverse.of(problem, state, &tangents.contacts, diagonal);
        let limits = Limits { tolerance: wanted, products: problem.numerics.solver.products };
        let found = gmres(&jacobian, inverse, residual, limits);
        let uniform = (problem.field.uniform() != 0.0)
            .then(|| gmres(&jacobian, inverse, &vec![1.0; residual.len()], limits));
        let step = self.count(found);
        self.on_spring(step, uniform)
    }

    /// Step `x = J⁻¹r` with the spring in series, whose part of the Jacobian is `c·1⊗F'` (Sherman & Morrison,
    /// Ann. Math. Stat. 21:124, 1950): `x − u·c(F'·x)/(1 + c F'·u)`, with `u = J⁻¹1`.
    fn on_spring(&mut self, mut step: Vec<f64>, uniform: Option<Solution>) -> Vec<f64> {
        let Some(uniform) = uniform.map(|found| self.count(found)) else { return step };
        let field = &self.problem.field;
        let share =
            field.by_spring_along(&self.spots, &step) / (1.0 + field.by_spring_along(&self.spots, &uniform));
        step.iter_mut().zip(&uniform).for_each(|(s, u)| *s -= share * u);
        step
    }

    /// Step of an implicit relaxation over a pseudo-time.
    pub(super) fn relaxation_step(&mut self, time: f64) -> Vec<f64> {
        let Self { problem, tangents, diagonal, residual, .. } = &*self;
        let damped: Vec<f64> = diagonal.iter().map(|d| d + 1.0 / time).collect();
        let limits = Limits { tolerance: 1e-3, products: problem.numerics.solver.products };
        let jacobian = Jacobian { tangent: &tangents.contacts, diagonal: &damped };
        let found = gmres(&jacobian, None, residual, limits);
        let uniform = (problem.field.uniform() != 0.0)
            .then(|| gmres(&jacobian, None, &vec![1.0; residual.len()], limits));
        let step = self.count(found);
        self.on_spring(step, uniform)
    }

    /// `da_i/dΔ` at the equilibrium that was evaluated last; at a precision. The
    /// stability is entered into the state. Its sign is right at either precision, since the smallest
    /// eigenvalue is in the Krylov space where it is small.
    pub(crate) fn rates(&mut self, state: &mut State, precision: Precision) -> Vec<f64> {
        let ones = vec![1.0; state.contacts.len()];
        let Self { problem, tangents, inverse, diagonal, .. } = self;
        let jacobian = Jacobian { tangent: &tangents.contacts, diagonal };
        let inverse = inverse.of(problem, state, &tangents.contacts, diagonal);
        let accuracy = &problem.numerics.solver;
        let tolerance = match precision {
            Precision::Exact => accuracy.rates_residual,
            Precision::Sufficient => accuracy.rates_residual_intermediate,
        };
        let limits = Limits { tolerance, products: accuracy.products };
        let (rates, least) = gmres_and_least(&jacobian, inverse, &ones, limits);
        state.stability = least;
        let mut rates = self.count(rates);
        let field = &self.problem.field;
        if field.uniform() != 0.0 {
            // `dD/dΔ = 1 + c dF/dΔ` changes its sign where the spring makes the contact unstable.
            let stiffness = 1.0 + field.by_spring_along(&self.spots, &rates);
            state.stability = least.min(stiffness);
            rates.iter_mut().for_each(|rate| *rate /= stiffness);
        }
        rates
    }

    /// True if all free asperities are to be evaluated at a mean penetration \[m\]: the first in each
    /// interval of the numerics.
    pub(crate) fn begins_block(&mut self, mean_penetration: f64) -> bool {
        let interval = self.problem.numerics.solver.free_interval * self.problem.unit_m;
        let block = |at: f64| (at / interval).floor();
        let begins = self.swept_at.is_none_or(|at| block(mean_penetration) != block(at));
        self.swept_at = if begins { Some(mean_penetration) } else { self.swept_at };
        begins
    }

    /// Penetrations `D_i − ŵ_i` of free asperities, with their rates, at an equilibrium with given rates.
    pub(crate) fn penetrations(
        &mut self,
        state: &State,
        rates: &[f64],
        wanted: &[usize],
    ) -> Vec<PenetrationTrace> {
        let problem = &*Arc::clone(&self.problem);
        problem.spots(state, &mut self.spots);
        let (mut displacement, mut slopes) = (Vec::new(), Vec::new());
        let found = [&mut displacement, &mut slopes];
        let field = problem.field.for_targets(&self.spots, wanted, self.precision.of_sums());
        field.along_path(&self.spots, rates, wanted, found, &mut self.tangents.free, &mut self.effort);
        let at = state.mean_penetration_m;
        if problem.field.uniform() != 0.0 {
            let by_spring = problem.field.by_spring(&self.spots);
            let along = problem.field.by_spring_along(&self.spots, rates);
            displacement.iter_mut().for_each(|w| *w += by_spring);
            slopes.iter_mut().for_each(|slope| *slope += along);
        }
        let pairs = displacement.iter().zip(&slopes).zip(wanted);
        pairs
            .map(|((w, slope), &i)| PenetrationTrace::new(at, at + problem.heights[i] - w, 1.0 - slope))
            .collect()
    }

    /// Displacement at one asperity by contacts of these radii \[m\].
    pub(crate) fn displacement(&mut self, spots: &[(usize, f64)], asperity: usize) -> f64 {
        let [displacement] = self.displacements(spots, &[asperity]);
        displacement
    }

    /// Displacements at asperities by contacts of these radii \[m\].
    pub(crate) fn displacements<const N: usize>(
        &mut self,
        spots: &[(usize, f64)],
        asperities: &[usize; N],
    ) -> [f64; N] {
        self.problem.columns(spots.iter().copied(), &mut self.spots);
        let mut displacements = Vec::with_capacity(N);
        self.problem.field.displacements(&self.spots, asperities, &mut displacements, &mut self.effort);
        std::array::from_fn(|k| displacements[k])
    }
}

/// Jacobian `∂(δ_JKR + ŵ)/∂a`: the slopes `dδ/da` of the asperities and the tangent of the field.
struct Jacobian<'a> {
    tangent: &'a Tangent,
    diagonal: &'a [f64],
}

impl LinearOperator for Jacobian<'_> {
    fn product(&self, x: &[f64], y: &mut [f64]) {
        self.tangent.product(x, y);
        for (yi, (di, xi)) in y.iter_mut().zip(self.diagonal.iter().zip(x)) {
            *yi += di * xi;
        }
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.diagonal[i] + self.tangent.own(i)
    }
}
