//! Local problem of an event: the contacts next to it as unknowns, the displacement by all others to first
//! order in Δ.
//!
//! An event changes its neighbours strongly and the rest of the contact weakly, since its neighbours lose
//! what it gains: the response decays within a few spacings. The global problem is solved at the end of each
//! increment, and the difference is measured (see [`crate::asperities::path`]). A local problem that holds
//! all contacts has no difference.

pub(crate) mod curve;
mod descent;
pub(crate) mod outside;
mod relaxing;

use super::newton::{Damping, NonlinearSystem as _, damped_newton};
use super::residual::NotConverged;
use super::trace::PenetrationTrace;
use crate::asperities::contact::problem::Problem;
use crate::asperities::field::{PairTable, Spots, SumPrecision};
use crate::cycle::Effort;
use crate::math::dense::Lu;
use descent::Descent;

/// Bounded rate of the displacement by the outside: next to a global fold the estimate diverges.
fn bounded(drift: f64) -> f64 {
    drift.clamp(-2.0, 3.0)
}

/// Displacement at an asperity by the contacts outside the local problem.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OutsideField {
    pub(crate) asperity: usize,
    /// Displacement at the reference mean penetration \[m\].
    pub(crate) outside: f64,
    /// Derivative to the mean penetration.
    pub(crate) drift: f64,
}

/// State on the solution curve, with its tangent.
#[derive(Debug, Clone, Default)]
pub(crate) struct CurveState {
    pub(crate) radius: Vec<f64>,
    pub(crate) mean_penetration: f64,
    /// Derivatives of radii and mean penetration to the radius `at` \[m\] of the member that is followed.
    pub(crate) direction: Vec<f64>,
    pub(crate) slope: f64,
    pub(crate) at: f64,
}

/// Quantity that is held while a local problem is solved. Unless it is the mean penetration, that is an
/// unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Hold {
    /// Mean penetration.
    MeanPenetration,
    /// Radius of a member, by its position.
    Radius(usize),
    /// Penetration of a watched asperity, by its position \[m\].
    Penetration(usize, f64),
}

/// Part of the contact that a local problem holds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Extent {
    /// All contacts.
    #[default]
    Whole,
    /// Some of them: there are contacts outside, whose response is known to first order.
    Part,
}

impl Extent {
    /// Extent of a local problem with a number of members, of all contacts.
    pub(crate) fn of(members: usize, contacts: usize) -> Self {
        if members < contacts { Self::Part } else { Self::Whole }
    }

    /// Precision of the sums: with contacts outside, image sums of six digits are sufficient.
    fn sums(self) -> SumPrecision {
        match self {
            Self::Whole => SumPrecision::Full,
            Self::Part => SumPrecision::Intermediate,
        }
    }
}

/// Contacts around an event, ascending, and the free asperities among them.
#[derive(Debug, Clone, Default)]
pub(crate) struct LocalProblem {
    /// Mean penetration \[m\].
    pub(crate) mean_penetration: f64,
    reference: f64,
    pub(crate) members: Vec<OutsideField>,
    /// Contact radii of the members \[m\].
    pub(crate) radius: Vec<f64>,
    pub(crate) watched: Vec<OutsideField>,
    extent: Extent,
    /// States on the way to an event, if a radius was followed.
    pub(crate) way: Vec<CurveState>,
    /// Displacements at the members by one another \[m\], and their derivatives to the radii.
    field: Vec<f64>,
    slopes: Vec<f64>,
    residual: Vec<f64>,
    work: Workspace,
}

/// Work space of a local problem.
#[derive(Debug, Clone, Default)]
struct Workspace {
    /// Members as sources, and their pairs.
    spots: Spots,
    pairs: PairTable,
    /// Rates for the radii of these sources, if they are known.
    rates: Option<(Vec<f64>, bool)>,
    /// Derivatives of the displacement at one asperity to the radii of the members.
    row: Vec<f64>,
    /// Jacobian and its factors.
    matrix: Vec<f64>,
    lu: Lu,
}

impl LocalProblem {
    /// Gathers contacts and free asperities at a mean penetration \[m\], with their predictors and the radii
    /// of the contacts \[m\]; both lists ascend.
    pub(crate) fn gather(
        &mut self,
        problem: &Problem,
        contacts: &[(usize, PenetrationTrace, f64)],
        free: &[(usize, PenetrationTrace)],
        mean_penetration: f64,
        extent: Extent,
        effort: &mut Effort,
    ) {
        (self.mean_penetration, self.reference, self.extent) = (mean_penetration, mean_penetration, extent);
        self.members.clear();
        self.way.clear();
        self.radius.clear();
        let mut speeds = Vec::with_capacity(contacts.len());
        for (i, trace, a) in contacts {
            let (asperity, a) = (&problem.asperities[*i], *a);
            self.members.push(OutsideField { asperity: *i, outside: 0.0, drift: 0.0 });
            self.radius.push(a);
            speeds.push(trace.speed(asperity, a));
        }
        self.evaluate_fields(problem, effort);
        let n = self.members.len();
        for (k, (i, trace, _)) in contacts.iter().enumerate() {
            let (asperity, a) = (&problem.asperities[*i], self.radius[k]);
            let displaced = mean_penetration + problem.heights[*i] - asperity.penetration(a);
            let by_members: f64 =
                self.slopes[k * n..(k + 1) * n].iter().zip(&speeds).map(|(s, v)| s * v).sum();
            self.members[k].outside = displaced - self.field[k];
            self.members[k].drift = bounded(1.0 - trace.rate - by_members);
        }
        self.watched.clear();
        let places: Vec<usize> = free.iter().map(|(i, _)| *i).collect();
        problem.field.rows(&self.work.spots, &places, self.extent.sums(), effort, |k, field, slopes| {
            let (i, trace) = free[k];
            let by_members: f64 = slopes.iter().zip(&speeds).map(|(s, v)| s * v).sum();
            let displaced = mean_penetration + problem.heights[i] - trace.ahead(mean_penetration);
            let drift = bounded(1.0 - trace.rate - by_members);
            self.watched.push(OutsideField { asperity: i, outside: displaced - field, drift });
        });
    }

    /// Residual below which it is in equilibrium \[m\]. With contacts outside, whose response is known to
    /// first order, the tolerance is larger.
    pub(crate) fn tolerance_m(&self, problem: &Problem) -> f64 {
        match self.extent {
            Extent::Whole => problem.tolerance_m(),
            Extent::Part => problem.numerics.solver.local_residual * problem.unit_m,
        }
    }

    /// Position of a member.
    pub(crate) fn find(&self, asperity: usize) -> Option<usize> {
        self.members.binary_search_by_key(&asperity, |m| m.asperity).ok()
    }

    /// Inserts an asperity in contact.
    pub(crate) fn insert(&mut self, place: OutsideField, radius: f64) {
        if let Err(at) = self.members.binary_search_by_key(&place.asperity, |m| m.asperity) {
            self.members.insert(at, place);
            self.radius.insert(at, radius);
            self.watched.retain(|w| w.asperity != place.asperity);
        }
    }

    /// Removes a member.
    pub(crate) fn remove(&mut self, asperity: usize) -> Option<OutsideField> {
        let at = self.find(asperity)?;
        self.radius.remove(at);
        Some(self.members.remove(at))
    }

    /// Moves a member that has left contact to the watched asperities.
    pub(crate) fn release(&mut self, asperity: usize) {
        let place = self.remove(asperity);
        self.watched.extend(place);
    }

    /// An asperity with a known displacement at the present mean penetration \[m\]; `drift` is the rate of
    /// its part by the outside.
    pub(crate) fn place(
        &mut self,
        problem: &Problem,
        asperity: usize,
        displacement: f64,
        drift: f64,
        effort: &mut Effort,
    ) -> OutsideField {
        let field = self.field_at(problem, asperity, effort);
        let outside = displacement - field - drift * (self.mean_penetration - self.reference);
        OutsideField { asperity, outside, drift }
    }

    /// Displacement at an asperity by the members \[m\]; the derivatives to their radii are left in `row`.
    fn field_at(&mut self, problem: &Problem, asperity: usize, effort: &mut Effort) -> f64 {
        let mut field = 0.0;
        problem.field.rows(&self.work.spots, &[asperity], self.extent.sums(), effort, |_, sum, slopes| {
            field = sum;
            self.work.row.clear();
            self.work.row.extend_from_slice(slopes);
        });
        field
    }

    /// Displacement by the outside at the present mean penetration \[m\].
    fn outside(&self, place: &OutsideField) -> f64 {
        place.outside + place.drift * (self.mean_penetration - self.reference)
    }

    /// Evaluates fields, slopes and residuals of the members; returns the largest residual with its asperity.
    /// Fields of the same radii are kept.
    pub(crate) fn evaluate(&mut self, problem: &Problem, effort: &mut Effort) -> NotConverged {
        let Spots { index, columns } = &self.work.spots;
        let same =
            self.members.iter().map(|m| &m.asperity).eq(index) && columns.a[..columns.len()] == self.radius;
        if !same {
            self.evaluate_fields(problem, effort);
        }
        self.residual.clear();
        let mut worst = NotConverged::residual(0.0, self.members.first().map_or(0, |m| m.asperity));
        for k in 0..self.members.len() {
            let member = self.members[k];
            let i = member.asperity;
            let residual = self.mean_penetration + problem.heights[i]
                - self.outside(&member)
                - self.field[k]
                - problem.asperities[i].penetration(self.radius[k]);
            self.residual.push(residual);
            worst = worst.or_residual(residual, i);
        }
        worst
    }

    /// Evaluates the displacements at the members by one another, and their derivatives.
    fn evaluate_fields(&mut self, problem: &Problem, effort: &mut Effort) {
        problem.columns(
            self.members.iter().map(|m| m.asperity).zip(self.radius.iter().copied()),
            &mut self.work.spots,
        );
        self.work.rates = None;
        self.field.clear();
        self.slopes.clear();
        match self.extent {
            Extent::Part => problem.field.among(
                &self.work.spots,
                &mut self.work.pairs,
                &mut self.field,
                &mut self.slopes,
                effort,
            ),
            Extent::Whole => {
                problem.field.rows(
                    &self.work.spots,
                    &self.work.spots.index,
                    SumPrecision::Full,
                    effort,
                    |_, sum, slopes| {
                        self.field.push(sum);
                        self.slopes.extend_from_slice(slopes);
                    },
                );
            }
        }
    }

    /// The Jacobian `∂(δ_JKR + ŵ)/∂a`, with `1/time` on its diagonal.
    fn assemble(&mut self, problem: &Problem, damping: f64) {
        let n = self.members.len();
        self.work.matrix.clear();
        self.work.matrix.extend_from_slice(&self.slopes);
        for (k, (member, a)) in self.members.iter().zip(&self.radius).enumerate() {
            self.work.matrix[k * n + k] +=
                problem.asperities[member.asperity].penetration_slope(*a) + damping;
        }
    }

    /// Puts `−∂residual/∂Δ` into column `at` of the Jacobian, where Δ is an unknown instead of a radius.
    fn exchange(&mut self, at: usize) {
        let n = self.members.len();
        for (k, member) in self.members.iter().enumerate() {
            self.work.matrix[k * n + at] = member.drift - 1.0;
        }
    }

    /// Newton step of the radii and of the mean penetration.
    fn newton_step(&mut self, problem: &Problem, hold: Hold, effort: &mut Effort) -> (Vec<f64>, f64) {
        let n = self.members.len();
        let mut step = self.residual.clone();
        self.assemble(problem, 0.0);
        let mean_penetration = match hold {
            Hold::MeanPenetration => {
                self.work.lu.factor(&self.work.matrix, n);
                self.work.lu.solve(&mut step);
                0.0
            }
            Hold::Radius(at) => {
                self.exchange(at);
                self.work.lu.factor(&self.work.matrix, n);
                self.work.lu.solve(&mut step);
                std::mem::replace(&mut step[at], 0.0)
            }
            Hold::Penetration(watched, wanted) => {
                step.push(wanted - self.penetration_of(problem, watched, effort));
                let mut bordered = Vec::with_capacity((n + 1) * (n + 1));
                for (k, member) in self.members.iter().enumerate() {
                    bordered.extend_from_slice(&self.work.matrix[k * n..(k + 1) * n]);
                    bordered.push(member.drift - 1.0);
                }
                bordered.extend(self.work.row[..n].iter().map(|s| -s));
                bordered.push(1.0 - self.watched[watched].drift);
                self.work.lu.factor(&bordered, n + 1);
                self.work.lu.solve(&mut step);
                step.pop().unwrap_or(0.0)
            }
        };
        (step, mean_penetration)
    }

    /// Newton's method from the present radii and mean penetration.
    pub(crate) fn solve(
        &mut self,
        problem: &Problem,
        hold: Hold,
        effort: &mut Effort,
    ) -> Result<(), NotConverged> {
        self.solve_with(problem, hold, Damping::NORMAL, effort)
    }

    /// Newton's method with other limits.
    pub(crate) fn solve_with(
        &mut self,
        problem: &Problem,
        hold: Hold,
        damping: Damping,
        effort: &mut Effort,
    ) -> Result<(), NotConverged> {
        let mut descent =
            Descent { local: self, problem, hold, effort, step: (Vec::new(), 0.0), start: (Vec::new(), 0.0) };
        let first = descent.evaluate();
        let tolerance_m = descent.local.tolerance_m(problem);
        damped_newton(&mut descent, first, damping, tolerance_m)
    }

    /// `da_i/dΔ` of the members at the equilibrium that was evaluated last, and whether it is stable: the
    /// sign of the determinant of the Jacobian.
    pub(crate) fn rates(&mut self, problem: &Problem) -> (Vec<f64>, bool) {
        if let Some(known) = &self.work.rates {
            return known.clone();
        }
        let mut rates: Vec<f64> = self.members.iter().map(|m| 1.0 - m.drift).collect();
        self.assemble(problem, 0.0);
        self.work.lu.factor(&self.work.matrix, self.members.len());
        self.work.lu.solve(&mut rates);
        let stable = self.work.lu.sign() > 0.0 && rates.iter().all(|rate| rate.is_finite());
        self.work.rates.insert((rates, stable)).clone()
    }

    /// Tangent of the solution curve: derivatives of the other radii and of Δ to the radius of member `at`.
    pub(crate) fn along(&mut self, problem: &Problem, at: usize) -> (Vec<f64>, f64) {
        let n = self.members.len();
        self.assemble(problem, 0.0);
        let mut direction: Vec<f64> = (0..n).map(|k| -self.work.matrix[k * n + at]).collect();
        self.exchange(at);
        self.work.lu.factor(&self.work.matrix, n);
        self.work.lu.solve(&mut direction);
        let mean_penetration = std::mem::replace(&mut direction[at], 1.0);
        (direction, mean_penetration)
    }

    /// Penetration of a watched asperity \[m\].
    pub(crate) fn penetration_of(&mut self, problem: &Problem, watched: usize, effort: &mut Effort) -> f64 {
        let place = self.watched[watched];
        let field = self.field_at(problem, place.asperity, effort);
        self.mean_penetration + problem.heights[place.asperity] - self.outside(&place) - field
    }

    /// Penetrations of the watched asperities, with their rates for given rates of the members.
    pub(crate) fn watch(
        &self,
        problem: &Problem,
        rates: &[f64],
        effort: &mut Effort,
    ) -> Vec<PenetrationTrace> {
        let places: Vec<usize> = self.watched.iter().map(|place| place.asperity).collect();
        let mut traces = Vec::with_capacity(places.len());
        problem.field.rows(&self.work.spots, &places, self.extent.sums(), effort, |k, field, slopes| {
            let place = &self.watched[k];
            let value = self.mean_penetration + problem.heights[place.asperity] - self.outside(place) - field;
            let by_members: f64 = slopes.iter().zip(rates).map(|(s, v)| s * v).sum();
            traces.push(PenetrationTrace::new(self.mean_penetration, value, 1.0 - place.drift - by_members));
        });
        traces
    }

    /// Load of the members \[N\], and the part of the potential that changes with them \[J\]:
    /// `Σ[U(d_i, a_i) − Δγπa_i²] + ½ΣF_iŵ_i`, with ŵ by one another.
    ///
    /// The displacement by the outside is held, and `Π` is stationary: the change is that of the whole
    /// potential to second order in the response of the outside.
    pub(crate) fn totals(&self, problem: &Problem) -> (f64, f64) {
        let (mut whole, mut potential) = (0.0, 0.0);
        for ((member, &a), field) in self.members.iter().zip(&self.radius).zip(&self.field) {
            let asperity = &problem.asperities[member.asperity];
            let load = asperity.load(a);
            whole += load;
            potential += problem.self_potential(member.asperity, a) + 0.5 * load * field;
        }
        (whole, potential)
    }

    /// `∂Π/∂Δ` at fixed radii: the loads, less the part that the displacement by the outside takes up \[N\].
    pub(crate) fn potential_slope(&self, problem: &Problem) -> f64 {
        let pairs = self.members.iter().zip(&self.radius);
        pairs.map(|(member, a)| problem.asperities[member.asperity].load(*a) * (1.0 - member.drift)).sum()
    }

    /// Moves to another mean penetration \[m\] by linear extrapolation of the penetrations.
    pub(crate) fn ahead(&mut self, problem: &Problem, mean_penetration: f64) {
        let (rates, _) = self.rates(problem);
        let way = mean_penetration - self.mean_penetration;
        for (k, rate) in rates.into_iter().enumerate() {
            let (asperity, a) = (&problem.asperities[self.members[k].asperity], self.radius[k]);
            let speed = asperity.penetration_slope(a) * rate;
            self.radius[k] = asperity.radius_ahead(asperity.penetration(a) + speed * way);
        }
        self.mean_penetration = mean_penetration;
    }

    /// Moves over a fold: member `at` by a share of its radius, the others along the tangent, Δ by `gap`
    /// \[m\].
    pub(crate) fn step_over_fold(&mut self, problem: &Problem, at: usize, share: f64, gap: f64) {
        let (direction, _) = self.along(problem, at);
        let span = share * self.radius[at];
        for (radius, d) in self.radius.iter_mut().zip(&direction) {
            *radius += (d * span).clamp(-0.05 * *radius, 0.05 * *radius);
        }
        self.mean_penetration += gap;
    }
}
