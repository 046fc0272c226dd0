//! Fit of load against penetration on both branches, for loops without contact radius.
//!
//! Both branches have one modulus and one origin `δ0` of the penetration, and each its own work of adhesion.
//! The load of JKR's stable branch at `δ − δ0` is fitted by the method of Levenberg and Marquardt.
//! Parameters are `E*`, `s = sqrt(w)` of each branch and `δ0`; `s` may become negative, which is less
//! contact than without adhesion. After the load reversal the contact radius is constant until the energy
//! release rate is the work of adhesion on retraction, so that the load is that of a flat punch, `F = 2E*(aδ
//! − a³/(3R))`.

use super::regression::{Residuals, solve, variance_along};
use super::{Estimate, Probe};
use crate::PhysicsError;
use std::f64::consts::PI;

/// Fewest points of a branch.
pub(super) const FEWEST: usize = 6;
/// Most steps of the minimisation.
const MOST_STEPS: usize = 500;
/// Half the relative difference of derivatives.
const DIFFERENCE: f64 = 1e-6;
/// Relative damping that ends it: shorter steps do not reduce the residual.
const MOST_DAMPING: f64 = 1e4;
/// Relative step that ends it.
const STEP: f64 = 1e-10;

/// Penetrations and loads along a part of a branch with contact.
#[derive(Debug, Clone, Copy, Default)]
pub struct Path<'a> {
    /// Penetration \[m\], from any origin.
    pub penetration_m: &'a [f64],
    /// Normal load \[N\], positive in compression.
    pub load_n: &'a [f64],
}

/// Fit of load against penetration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceFit {
    /// Apparent work of adhesion on approach \[J/m²\]; nothing if it is not positive or was not fitted.
    pub approach_j_m2: Option<Estimate>,
    /// Apparent work of adhesion on retraction \[J/m²\]; nothing if it is not positive.
    pub retraction_j_m2: Option<Estimate>,
    /// Reduced modulus \[Pa\], if it was fitted.
    pub modulus_pa: Option<Estimate>,
    /// Penetration at which the undeformed probe touches the half-space \[m\].
    pub origin_m: Estimate,
    /// Root-mean-square residuals of approach and retraction \[N\]; 0 for an approach that was not fitted.
    pub residuals_n: [f64; 2],
    /// The residuals of both branches over the maximum magnitude of the load.
    pub residual: f64,
    /// Points that were fitted.
    pub count: usize,
}

/// Parameters of the model.
#[derive(Debug, Clone, Copy)]
struct Model {
    radius: f64,
    modulus: f64,
    /// Square root of the work of adhesion, with a sign, of approach and retraction.
    roots: [f64; 2],
    origin: f64,
    /// Penetration of the load reversal, if the approach is fitted.
    pinned_at: Option<f64>,
    /// Contact radius there.
    largest: f64,
}

impl Model {
    /// Load at a penetration on a branch.
    fn load(&self, penetration: f64, branch: usize) -> f64 {
        let depth = penetration - self.origin;
        let a = self.radius_at(depth, branch);
        let radius = self.radius;
        if branch == 1 && a > self.largest {
            // The load at constant contact radius is ∂U/∂δ.
            let a = self.largest;
            return 2.0 * self.modulus * (a * depth - a.powi(3) / (3.0 * radius));
        }
        self.modulus * a * (4.0 * a * a / (3.0 * radius) - 2.0 * self.pull(branch) * a.sqrt())
    }

    /// The model with the contact radius at its load reversal.
    fn turned(mut self) -> Self {
        self.largest = self.pinned_at.map_or(f64::INFINITY, |turn| self.radius_at(turn - self.origin, 0));
        self
    }

    fn pull(&self, branch: usize) -> f64 {
        (2.0 * PI / self.modulus).sqrt() * self.roots[branch]
    }

    /// Contact radius of JKR's stable branch at a penetration; at the end of the branch below it.
    fn radius_at(&self, depth: f64, branch: usize) -> f64 {
        root_of_radius(depth, self.radius, self.pull(branch)).powi(2)
    }
}

/// `t = sqrt(a)` on the stable branch of `δ = t⁴/R − p t`; at the end of the branch below it, 0 without
/// adhesion.
///
/// The left side is convex and increasing from its minimum on: Newton's method from above converges.
fn root_of_radius(penetration: f64, radius: f64, pull: f64) -> f64 {
    let end = if pull > 0.0 { (0.25 * pull * radius).cbrt() } else { 0.0 };
    if penetration <= end.powi(4) / radius - pull * end {
        return end;
    }
    let mut t =
        (2.0 * radius * penetration.max(0.0)).sqrt().sqrt().max((2.0 * radius * pull.max(0.0)).cbrt());
    for _ in 0..100 {
        let step = (t.powi(4) / radius - pull * t - penetration) / (4.0 * t.powi(3) / radius - pull);
        t -= step;
        // Steps go down; rounding turns them.
        if step <= 1e-15 * t {
            break;
        }
    }
    t
}

/// One point: penetration, load, branch.
type Point = (f64, f64, usize);

/// A minimisation, whose parameters are `E*` (unless it is given), the roots, and the origin.
struct Search {
    points: Vec<Point>,
    has_modulus: bool,
    has_approach: bool,
}

impl Search {
    fn parameter_count(&self) -> usize {
        2 + usize::from(self.has_modulus) + usize::from(self.has_approach)
    }

    fn moved(&self, model: &Model, step: &[f64]) -> Model {
        let mut moved = *model;
        let mut step = step.iter();
        let mut next = || step.next().copied().unwrap_or_default();
        if self.has_modulus {
            moved.modulus += next();
        }
        if self.has_approach {
            moved.roots[0] += next();
        }
        moved.roots[1] += next();
        moved.origin += next();
        moved.turned()
    }

    fn squares(&self, model: &Model) -> f64 {
        self.points.iter().map(|(at, load, branch)| (load - model.load(*at, *branch)).powi(2)).sum()
    }

    /// Gradient of the model by central differences, and residual, at every point.
    fn rows(&self, model: &Model) -> Vec<(Vec<f64>, f64)> {
        let count = self.parameter_count();
        let length = self.points.iter().map(|point| (point.0 - model.origin).abs()).fold(0.0, f64::max);
        let mut sizes = vec![model.roots[1].abs(); count];
        if self.has_modulus {
            sizes[0] = model.modulus;
        }
        sizes[count - 1] = length;
        let sides: Vec<(f64, [Model; 2])> = (0..count)
            .map(|place| {
                let mut step = vec![0.0; count];
                step[place] = DIFFERENCE * sizes[place];
                let back: Vec<f64> = step.iter().map(|step| -step).collect();
                (2.0 * step[place], [self.moved(model, &step), self.moved(model, &back)])
            })
            .collect();
        let row = |(at, load, branch): &Point| {
            let slope = |(width, [up, down]): &(f64, [Model; 2])| {
                (up.load(*at, *branch) - down.load(*at, *branch)) / width
            };
            (sides.iter().map(slope).collect(), load - model.load(*at, *branch))
        };
        self.points.iter().map(row).collect()
    }

    /// The minimum from a start; nothing if the points do not determine the parameters.
    fn minimum(&self, start: Model) -> Option<Model> {
        let (mut model, mut squares, mut damping) = (start, self.squares(&start), 1e-3);
        for _ in 0..MOST_STEPS {
            let rows = self.rows(&model);
            let step = solve(&rows, damping)?.values;
            let next = self.moved(&model, &step);
            let after = if next.modulus > 0.0 { self.squares(&next) } else { f64::INFINITY };
            let parts = [
                (next.modulus - model.modulus) / model.modulus,
                (next.roots[1] - model.roots[1]) / model.roots[1],
                (next.origin - model.origin) / (self.points[0].0 - model.origin),
            ];
            let is_small = parts.iter().all(|part| part.abs() < STEP);
            if after <= squares {
                (model, squares, damping) = (next, after, damping / 10.0);
            } else {
                damping = (damping * 10.0).max(1e-12);
            }
            if is_small || damping > MOST_DAMPING || squares == 0.0 {
                break;
            }
        }
        Some(model)
    }
}

impl Probe {
    /// JKR fit of load against penetration: retraction from the load reversal to the pull-off force, and
    /// approach after the jump into contact, which may be empty.
    ///
    /// # Errors
    /// Six points of retraction with tension at their end, and parameters that the points determine.
    pub fn fit_force(&self, approach: Path<'_>, retraction: Path<'_>) -> Result<ForceFit, PhysicsError> {
        let points = |path: Path<'_>, branch: usize| -> Vec<Point> {
            path.penetration_m.iter().zip(path.load_n).map(|(at, load)| (*at, *load, branch)).collect()
        };
        let (mut all, back) = (points(approach, 0), points(retraction, 1));
        let pull_off = -back.iter().map(|(_, load, _)| *load).fold(0.0, f64::min);
        if back.len() < FEWEST || pull_off <= 0.0 {
            return Err(PhysicsError::ProbeLoop {
                problem: format!(
                    "a JKR fit of load against penetration, with {} points on retraction and a pull-off \
                     force of {pull_off:.3e} N",
                    back.len()
                ),
                help: "the fit needs at least 6 points between the load reversal and a tensile pull-off \
                    force",
            });
        }
        if all.len() < FEWEST {
            all.clear();
        }
        let has_approach = !all.is_empty();
        all.extend(&back);
        let search = Search { points: all, has_modulus: self.contact_modulus_pa.is_none(), has_approach };
        let undetermined = || PhysicsError::ProbeLoop {
            problem: "the points of the loop do not determine the parameters of a JKR fit".to_owned(),
            help: "give the modulus, or record the loop to a larger load",
        };
        let mut start = self.start(&back, pull_off).ok_or_else(undetermined)?;
        start.pinned_at = back.first().map(|point| point.0).filter(|_| has_approach);
        let start = start.turned();
        let model = search.minimum(start).ok_or_else(undetermined)?;
        self.fitted(&search, &model).ok_or_else(undetermined)
    }

    /// First guess from the load reversal and the point of the pull-off force.
    fn start(&self, back: &[Point], pull_off: f64) -> Option<Model> {
        let radius = self.radius_m;
        let work = pull_off / (1.5 * PI * radius);
        let turn = back.iter().max_by(|u, v| u.1.total_cmp(&v.1))?;
        let least = back.iter().min_by(|u, v| u.1.total_cmp(&v.1))?;
        let way = (turn.0 - least.0).abs();
        // Penetration at a load, on the upper branch: X = a^(3/2) of αX² − βX = F.
        let penetration = |load: f64, modulus: f64| {
            let (alpha, beta) = (4.0 * modulus / (3.0 * radius), (8.0 * PI * modulus * work).sqrt());
            let x = (beta + (beta * beta + 4.0 * alpha * load).max(0.0).sqrt()) / (2.0 * alpha);
            let a = x.powf(2.0 / 3.0);
            a * a / radius - (2.0 * PI * a * work / modulus).sqrt()
        };
        let depth = |modulus: f64| penetration(turn.1, modulus) - penetration(-pull_off, modulus);
        // Hertz's modulus of both points.
        let hertz = 0.75 * (turn.1 + pull_off) / (radius.sqrt() * way.powf(1.5));
        let mut modulus = self.contact_modulus_pa.unwrap_or(hertz);
        if self.contact_modulus_pa.is_none() {
            // The depth between both points falls with the modulus.
            let (mut low, mut high) = (1e-6 * hertz, 1e6 * hertz);
            for _ in 0..200 {
                modulus = (low * high).sqrt();
                if depth(modulus) > way { low = modulus } else { high = modulus }
            }
        }
        let origin = turn.0 - penetration(turn.1, modulus);
        (way > 0.0).then_some(Model {
            radius,
            modulus,
            roots: [work.sqrt(); 2],
            origin,
            pinned_at: None,
            largest: f64::INFINITY,
        })
    }

    /// Parameters of the minimum with their errors.
    fn fitted(&self, search: &Search, model: &Model) -> Option<ForceFit> {
        let rows = search.rows(model);
        let inverse = solve(&rows, 0.0)?.inverse;
        let parameters = rows.first()?.0.len();
        let of = |branch: usize| -> Vec<f64> {
            let own = search.points.iter().zip(&rows).filter(|(point, _)| point.2 == branch);
            own.map(|(_, row)| row.1).collect()
        };
        let branches = [of(0), of(1)].map(|residuals| Residuals::of(&residuals, 0).rms);
        let all: Vec<f64> = rows.iter().map(|row| row.1).collect();
        let residuals = Residuals::of(&all, parameters);
        let variance = residuals.variance * residuals.inflation;
        let estimate = |value: f64, place: usize, slope: f64| {
            let mut gradient = vec![0.0; parameters];
            gradient[place] = slope;
            Estimate {
                value,
                standard_error: (variance * variance_along(&inverse, &gradient)).sqrt(),
                degrees_of_freedom: residuals.degrees_of_freedom,
            }
        };
        let work = |root: f64, place: usize| (root > 0.0).then(|| estimate(root * root, place, 2.0 * root));
        let first = usize::from(search.has_modulus);
        let largest = search.points.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
        Some(ForceFit {
            approach_j_m2: work(model.roots[0], first).filter(|_| search.has_approach),
            retraction_j_m2: work(model.roots[1], parameters - 2),
            modulus_pa: search.has_modulus.then(|| estimate(model.modulus, 0, 1.0)),
            origin_m: estimate(model.origin, parameters - 1, 1.0),
            residuals_n: branches,
            residual: residuals.rms / largest,
            count: all.len(),
        })
    }
}
