//! Apparent works of adhesion and modulus of a measured loop.

use super::force_fit::Path;
use super::measured_loop::{Evaluated, Zero, fault};
use super::radius_fit::receding;
use super::regression::variance_along;
use super::{Branch, Estimate, Probe};
use crate::PhysicsError;
use std::f64::consts::PI;

/// Apparent works of adhesion and modulus of a measured loop.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Apparent {
    /// From the pull-off force \[J/m²\].
    pub pull_off_j_m2: Option<Estimate>,
    /// From the dissipated energy \[J/m²\].
    pub loss_j_m2: Option<Estimate>,
    /// Fit on approach \[J/m²\].
    pub approach_j_m2: Option<Estimate>,
    /// Fit on retraction \[J/m²\].
    pub retraction_j_m2: Option<Estimate>,
    /// Fitted reduced modulus \[Pa\].
    pub modulus_pa: Option<Estimate>,
    /// Root-mean-square residuals of the load on approach and retraction \[N\].
    pub residuals_n: [Option<f64>; 2],
    /// Residual of retraction over the maximum magnitude of the load.
    pub residual: Option<f64>,
    /// True if contact radius was fitted; else load against penetration.
    pub is_of_radius: bool,
}

/// Loads and penetrations of all rows.
#[derive(Clone, Copy)]
struct Rows<'a> {
    penetration_m: &'a [f64],
    load_n: &'a [f64],
}

impl Evaluated {
    /// Apparent works of adhesion and modulus for a probe. `contact_radius_m` has one value for each row, 0
    /// or no number without contact; without it, load against penetration is fitted.
    ///
    /// With the modulus of the probe the works are fitted with it, and the modulus apart from that. What
    /// cannot be fitted is nothing.
    ///
    /// # Errors
    /// A contact radius with another number of rows.
    pub fn apparent(
        &self,
        probe: &Probe,
        contact_radius_m: Option<&[f64]>,
    ) -> Result<Apparent, PhysicsError> {
        if let Some(radius) = contact_radius_m.filter(|radius| radius.len() != self.load_n.len()) {
            return Err(fault(
                format!("{} contact radii and {} loads", radius.len(), self.load_n.len()),
                "give one contact radius for each load",
            ));
        }
        let fit = |rows: Rows<'_>| match contact_radius_m {
            Some(radius) => self.of_radius(probe, rows, radius),
            None => self.of_force(probe, rows),
        };
        let mut found = fit(Rows { penetration_m: &self.penetration_m, load_n: &self.load_n });
        self.pool(&mut found);
        self.zero.widen(self, &mut found, fit);
        let scaled = |estimate: Estimate, value: f64, relative: f64| Estimate {
            value,
            standard_error: relative * value,
            ..estimate
        };
        found.pull_off_j_m2 = self.pull_off_n.and_then(|force| {
            let work = probe.work_from_pull_off(force.value).ok()?;
            Some(scaled(force, work, force.standard_error / force.value))
        });
        let given = probe.contact_modulus_pa.map(|value| (value, 0.0));
        let fitted = found.modulus_pa.map(|modulus| (modulus.value, modulus.standard_error / modulus.value));
        found.loss_j_m2 = given.or(fitted).and_then(|(modulus, relative)| {
            let work = probe.with_modulus(modulus).ok()?.work_from_loss(self.loss_j.value).ok()?;
            let of_loss = 0.6 * self.loss_j.standard_error / self.loss_j.value;
            // w ∝ Θ^(3/5) E*^(2/5).
            (work > 0.0).then(|| scaled(self.loss_j, work, of_loss.hypot(0.4 * relative)))
        });
        Ok(found)
    }

    /// Standard errors of fits with at least the scatter of the load without contact.
    fn pool(&self, found: &mut Apparent) {
        let factors = found.residuals_n.iter().flatten().map(|residual| self.noise_n / residual);
        let factor = factors.filter(|factor| factor.is_finite()).fold(1.0, f64::max);
        let estimates = [&mut found.approach_j_m2, &mut found.retraction_j_m2, &mut found.modulus_pa];
        estimates.into_iter().flatten().for_each(|estimate| estimate.standard_error *= factor);
    }

    fn of_radius(&self, probe: &Probe, rows: Rows<'_>, radius: &[f64]) -> Apparent {
        let free = Probe { contact_modulus_pa: None, ..*probe };
        let all = rows.load_n;
        let area: Vec<f64> =
            radius.iter().map(|a| if a.is_finite() { PI * a.max(0.0).powi(2) } else { 0.0 }).collect();
        let approach = Branch { load_n: &all[..self.turn + 1], area_m2: &area[..self.turn + 1] };
        let approach = probe.fit_radius(approach).ok();
        let back = self.turn..area.len();
        let [load_n, area_m2] = receding(Branch { load_n: &all[back.clone()], area_m2: &area[back] });
        let retraction = Branch { load_n: &load_n, area_m2: &area_m2 };
        let free = free.fit_radius(retraction).ok();
        let retraction = probe.fit_radius(retraction).ok();
        Apparent {
            approach_j_m2: approach.and_then(|fit| fit.work_j_m2),
            retraction_j_m2: retraction.and_then(|fit| fit.work_j_m2),
            modulus_pa: free.and_then(|fit| fit.modulus_pa),
            residuals_n: [approach, retraction].map(|fit| fit.map(|fit| fit.residual_n)),
            residual: retraction.map(|fit| fit.residual),
            is_of_radius: true,
            ..Apparent::default()
        }
    }

    /// First row of the approach that is fitted: after the jump into contact, or where the load is smallest.
    fn first_of_approach(&self) -> usize {
        let touch = self.in_contact.iter().position(|in_contact| *in_contact).unwrap_or(self.turn);
        let rows = touch..=self.turn;
        let least = rows.min_by(|u, v| self.load_n[*u].total_cmp(&self.load_n[*v])).unwrap_or(self.turn);
        let next = (touch + 1).min(self.turn);
        // Of noisy loads the smallest is no fair choice.
        if self.load_n[next] < 0.5 * self.load_n[least] { next } else { least }
    }

    fn of_force(&self, probe: &Probe, rows: Rows<'_>) -> Apparent {
        let free = Probe { contact_modulus_pa: None, ..*probe };
        let path = |range: std::ops::Range<usize>| Path {
            penetration_m: &rows.penetration_m[range.clone()],
            load_n: &rows.load_n[range],
        };
        let first = self.first_of_approach();
        let fit = |probe: &Probe| {
            probe.fit_force(path(first..self.turn + 1), path(self.turn..self.pull_off_row + 1)).ok()
        };
        let of_works = fit(probe);
        let of_free = if probe.contact_modulus_pa.is_some() { fit(&free) } else { of_works };
        let approach = of_works.filter(|fit| fit.approach_j_m2.is_some());
        Apparent {
            approach_j_m2: of_works.and_then(|fit| fit.approach_j_m2),
            retraction_j_m2: of_works.and_then(|fit| fit.retraction_j_m2),
            modulus_pa: of_free.and_then(|fit| fit.modulus_pa),
            residuals_n: [approach.map(|fit| fit.residuals_n[0]), of_works.map(|fit| fit.residuals_n[1])],
            residual: of_works.map(|fit| fit.residual),
            ..Apparent::default()
        }
    }
}

impl Zero {
    /// Adds the uncertainty of the zero of load to the standard errors of fits, which are repeated with the
    /// load of each parameter of the baseline added.
    fn widen(&self, of: &Evaluated, found: &mut Apparent, fit: impl Fn(Rows<'_>) -> Apparent) {
        let count = self.terms.len();
        let moved: Vec<(f64, Apparent)> = (0..count)
            .map(|term| {
                let size = self.covariance[term * count + term].sqrt();
                let shift = |load: &f64, by: &f64| load + size * by;
                let load: Vec<f64> =
                    of.load_n.iter().zip(&self.terms[term]).map(|(u, v)| shift(u, v)).collect();
                let ways = of.penetration_m.iter().zip(&self.terms[term]);
                let way: Vec<f64> = ways.map(|(way, by)| way - self.compliance_m_n * size * by).collect();
                (size, fit(Rows { penetration_m: &way, load_n: &load }))
            })
            .collect();
        let places: [fn(&mut Apparent) -> &mut Option<Estimate>; 3] =
            [|of| &mut of.approach_j_m2, |of| &mut of.retraction_j_m2, |of| &mut of.modulus_pa];
        for place in places {
            let Some(estimate) = *place(found) else { continue };
            let slope = |(size, other): &(f64, Apparent)| {
                let other = place(&mut other.clone()).map_or(estimate.value, |other| other.value);
                if *size > 0.0 { (other - estimate.value) / size } else { 0.0 }
            };
            let gradient: Vec<f64> = moved.iter().map(slope).collect();
            let standard_error =
                estimate.standard_error.hypot(variance_along(&self.covariance, &gradient).sqrt());
            *place(found) = Some(Estimate { standard_error, ..estimate });
        }
    }
}
