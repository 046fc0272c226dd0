//! Fit of contact radius against load.
//!
//! With `X = a^(3/2)` JKR's load `F = 4E*a³/(3R) − sqrt(8πE*w a³)` is `αX² − βX`, linear in `α = 4E*/(3R)`
//! and `β = sqrt(8πE*w)`. Residuals are those of the load.

use super::regression::{Normal, Residuals, solve};
use super::{Branch, Estimate, JkrFit, Probe};
use crate::PhysicsError;
use std::f64::consts::PI;

/// Fewest points in contact of a fit.
pub(super) const FEWEST: usize = 4;

/// Part of the maximum contact area above which a retraction is not fitted: after the load reversal the edge
/// may be pinned, and the area constant.
const PINNED: f64 = 0.96;

/// Loads and areas of a retraction less the points at which the contact edge may be pinned.
pub(super) fn receding(branch: Branch<'_>) -> [Vec<f64>; 2] {
    let most = PINNED * branch.area_m2.iter().copied().fold(0.0, f64::max);
    let kept = branch.load_n.iter().zip(branch.area_m2).filter(|(_, area)| **area <= most);
    let (load, area) = kept.map(|(load, area)| (*load, *area)).unzip();
    [load, area]
}

/// Points in contact: `X = a^(3/2)` \[m^(3/2)\] and load \[N\].
pub(super) fn points(branch: Branch<'_>) -> Result<Vec<[f64; 2]>, PhysicsError> {
    let Branch { load_n, area_m2 } = branch;
    if load_n.len() != area_m2.len() {
        let problem = format!("{} loads and {} contact areas of one branch", load_n.len(), area_m2.len());
        return Err(PhysicsError::ProbeLoop { problem, help: "give one contact area for each load" });
    }
    let in_contact = load_n.iter().zip(area_m2).filter(|(_, area)| **area > 0.0);
    let points: Vec<_> = in_contact.map(|(load, area)| [(area / PI).powf(0.75), *load]).collect();
    match points.iter().flatten().find(|value| !value.is_finite()) {
        None => Ok(points),
        Some(value) => Err(super::domain("a JKR fit", "a load or an area", *value, "finite numbers")),
    }
}

impl Probe {
    /// JKR fit of the contact radius `a = sqrt(A/π)` against the load of one branch.
    ///
    /// With the modulus of the probe the only parameter is the work of adhesion; without, the modulus is the
    /// second one. Standard errors assume errors of the load alone, with the correlation of neighbours.
    ///
    /// # Errors
    /// Four points in contact with different areas, and columns of equal length.
    pub fn fit_radius(&self, branch: Branch<'_>) -> Result<JkrFit, PhysicsError> {
        let points = points(branch)?;
        let too_few = || PhysicsError::ProbeLoop {
            problem: format!("a JKR fit of {} points in contact", points.len()),
            help: "a fit needs at least 4 points with different contact areas on each branch",
        };
        if points.len() < FEWEST {
            return Err(too_few());
        }
        let given = self.contact_modulus_pa.map(|modulus| 4.0 * modulus / (3.0 * self.radius_m));
        let row = |[x, load]: &[f64; 2]| match given {
            Some(alpha) => (vec![-x], load - alpha * x * x),
            None => (vec![-x, x * x], *load),
        };
        let rows: Vec<_> = points.iter().map(row).collect();
        let fit = solve(&rows, 0.0).ok_or_else(too_few)?;
        let alpha = given.or_else(|| fit.values.get(1).copied()).unwrap_or_default();
        let beta = fit.values[0];
        let residuals: Vec<f64> = points.iter().map(|[x, load]| load - (alpha * x - beta) * x).collect();
        let residuals = Residuals::of(&residuals, rows[0].0.len());
        let largest = points.iter().map(|[_, load]| load.abs()).fold(0.0, f64::max);
        let [work_j_m2, modulus_pa] = self.parameters(&fit, alpha, residuals);
        Ok(JkrFit {
            work_j_m2: work_j_m2.filter(|_| beta > 0.0 && alpha > 0.0),
            modulus_pa: modulus_pa.filter(|_| alpha > 0.0),
            residual_n: residuals.rms,
            residual: if largest > 0.0 { residuals.rms / largest } else { 0.0 },
            count: points.len(),
        })
    }

    /// Work of adhesion `β²/(6πRα)` and modulus `3Rα/4`, if it was fitted, with their standard errors.
    fn parameters(&self, fit: &Normal, alpha: f64, residuals: Residuals) -> [Option<Estimate>; 2] {
        let beta = fit.values[0];
        let size = fit.values.len();
        let work = beta * beta / (6.0 * PI * self.radius_m * alpha);
        let variance = residuals.variance * residuals.inflation;
        let estimate = |value: f64, gradient: &[f64]| Estimate {
            value,
            standard_error: (variance * super::regression::variance_along(&fit.inverse, gradient)).sqrt(),
            degrees_of_freedom: residuals.degrees_of_freedom,
        };
        let gradient = [2.0 * work / beta, -work / alpha];
        let slope = 0.75 * self.radius_m;
        [Some(estimate(work, &gradient[..size])), (size == 2).then(|| estimate(slope * alpha, &[0.0, slope]))]
    }
}
