//! Apparent work of adhesion of a spherical probe on an elastic half-space.
//!
//! A loop of a probe of radius `R` on a half-space of reduced modulus `E*` is read as that of a smooth JKR
//! sphere. Four numbers follow, which are equal for a smooth sphere and differ for a rough one:
//!
//! - from the pull-off force, `w = F_po/(1.5πR)`;
//! - from the dissipated energy of a loop under displacement control with jump into contact at `δ = 0`,
//!   `Θ = 2E*R³ (πw/(E*R))^(5/3) × 0.5262… = 7.092196 w^(5/3) R^(4/3) E*^(-2/3)`;
//! - from a fit of contact radius against load, on approach and on retraction ([`Probe::fit_radius`]);
//! - from a fit of load against penetration, if no contact radius was measured ([`Probe::fit_force`]).
//!
//! [`measured_loop`] evaluates a measured loop: baseline, load reversal, pull-off force, energies.

mod apparent;
mod baseline;
mod force_fit;
pub mod measured_loop;
mod orientation;
mod pull_off;
mod radius_fit;
mod regression;

use crate::PhysicsError;
use crate::jkr::loop_loss_constant;
use std::f64::consts::PI;

pub use apparent::Apparent;
pub use force_fit::{ForceFit, Path};
pub use orientation::{Oriented, oriented};

/// Estimate with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Estimate {
    /// Value.
    pub value: f64,
    /// Standard error, in the unit of the value.
    pub standard_error: f64,
    /// Degrees of freedom of the standard error: independent residuals less parameters; at least 1.
    pub degrees_of_freedom: usize,
}

/// Fit of JKR's equations to one branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JkrFit {
    /// Apparent work of adhesion \[J/m²\]; nothing if the branch has less contact than without adhesion.
    pub work_j_m2: Option<Estimate>,
    /// Reduced modulus \[Pa\], if it was fitted.
    pub modulus_pa: Option<Estimate>,
    /// Root-mean-square residual of the load \[N\].
    pub residual_n: f64,
    /// The residual over the maximum magnitude of the load.
    pub residual: f64,
    /// Points that were fitted.
    pub count: usize,
}

/// Loads and contact areas along one branch, in the order of the path.
#[derive(Debug, Clone, Copy)]
pub struct Branch<'a> {
    /// Normal load \[N\], positive in compression.
    pub load_n: &'a [f64],
    /// Contact area \[m²\]; points without contact are not fitted.
    pub area_m2: &'a [f64],
}

/// Apparent works of adhesion of a loop \[J/m²\]; nothing where the loop gives none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ApparentWorks {
    /// From the pull-off force.
    pub pull_off_j_m2: Option<f64>,
    /// From the dissipated energy.
    pub loss_j_m2: Option<f64>,
    /// Fit of the equivalent radius `sqrt(A/π)` against load on approach, with the given modulus.
    pub approach: Option<JkrFit>,
    /// The fit on retraction.
    pub retraction: Option<JkrFit>,
}

/// Spherical probe on a half-space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    radius_m: f64,
    contact_modulus_pa: Option<f64>,
}

impl Probe {
    /// Probe of radius `R` \[m\] on a half-space of reduced modulus `E*` \[Pa\]; without modulus, fits have
    /// it as a parameter.
    ///
    /// # Errors
    /// Both must be positive and finite.
    pub fn new(radius_m: f64, contact_modulus_pa: Option<f64>) -> Result<Self, PhysicsError> {
        let known = contact_modulus_pa.map(|modulus| ("the contact modulus [Pa]", modulus));
        for (quantity, value) in [("the radius of the probe [m]", radius_m)].into_iter().chain(known) {
            if !(value > 0.0 && value.is_finite()) {
                return Err(domain("a probe", quantity, value, "a positive, finite number"));
            }
        }
        Ok(Self { radius_m, contact_modulus_pa })
    }

    /// Radius of the probe \[m\].
    #[must_use]
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Reduced modulus \[Pa\], if it is given.
    #[must_use]
    pub fn contact_modulus_pa(&self) -> Option<f64> {
        self.contact_modulus_pa
    }

    /// The probe with a reduced modulus \[Pa\], such as that of a fit.
    ///
    /// # Errors
    /// It must be positive and finite.
    pub fn with_modulus(&self, contact_modulus_pa: f64) -> Result<Self, PhysicsError> {
        Self::new(self.radius_m, Some(contact_modulus_pa))
    }

    /// Work of adhesion \[J/m²\] from the pull-off force `F_po ≥ 0` \[N\], `w = F_po/(1.5πR)`.
    ///
    /// # Errors
    /// The force must not be negative.
    pub fn work_from_pull_off(&self, pull_off_n: f64) -> Result<f64, PhysicsError> {
        not_negative("the work of adhesion from the pull-off force", "the pull-off force [N]", pull_off_n)?;
        Ok(pull_off_n / (1.5 * PI * self.radius_m))
    }

    /// Work of adhesion \[J/m²\] from the dissipated energy `Θ ≥ 0` \[J\] of a loop under displacement
    /// control.
    ///
    /// `w = (E*R/π) (Θ/(2 × 0.5262… E*R³))^(3/5)`, the inverse of Eq A1. A compliant machine dissipates
    /// more, so that its loop gives a work that is too large.
    ///
    /// # Errors
    /// The energy must not be negative, and the modulus must be given.
    pub fn work_from_loss(&self, loss_j: f64) -> Result<f64, PhysicsError> {
        not_negative("the work of adhesion from the dissipated energy", "the dissipated energy [J]", loss_j)?;
        let modulus = self.modulus("the work of adhesion from the dissipated energy")?;
        let unit_j = 2.0 * loop_loss_constant() * modulus * self.radius_m.powi(3);
        Ok(modulus * self.radius_m / PI * (loss_j / unit_j).powf(0.6))
    }

    /// Apparent works of adhesion of a loop from its pull-off force \[N\], its dissipated energy \[J\] and
    /// its two branches. Fits have the modulus of the probe. Points of the retraction with more than 96 % of
    /// the maximum contact area are left out: there the contact edge may be pinned.
    ///
    /// # Errors
    /// The modulus must be given, and the columns of a branch must be equally long.
    pub fn apparent_works(
        &self,
        pull_off_n: Option<f64>,
        loss_j: Option<f64>,
        approach: Branch<'_>,
        retraction: Branch<'_>,
    ) -> Result<ApparentWorks, PhysicsError> {
        self.modulus("the apparent works of adhesion")?;
        let fit = |branch: Branch<'_>| match radius_fit::points(branch)?.len() {
            0..radius_fit::FEWEST => Ok(None),
            _ => self.fit_radius(branch).map(Some),
        };
        let [load_n, area_m2] = radius_fit::receding(retraction);
        let retraction = Branch { load_n: &load_n, area_m2: &area_m2 };
        Ok(ApparentWorks {
            pull_off_j_m2: pull_off_n.map(|force| self.work_from_pull_off(force)).transpose()?,
            loss_j_m2: loss_j.map(|energy| self.work_from_loss(energy)).transpose()?,
            approach: fit(approach)?,
            retraction: fit(retraction)?,
        })
    }

    /// The modulus, or the error of an evaluation that needs it.
    fn modulus(&self, action: &'static str) -> Result<f64, PhysicsError> {
        self.contact_modulus_pa
            .ok_or_else(|| domain(action, "the contact modulus [Pa]", f64::NAN, "a positive, finite number"))
    }
}

fn domain(action: &'static str, quantity: &'static str, value: f64, allowed: &'static str) -> PhysicsError {
    PhysicsError::Domain { action, quantity, value, allowed }
}

fn not_negative(action: &'static str, quantity: &'static str, value: f64) -> Result<(), PhysicsError> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(domain(action, quantity, value, "zero or a positive, finite number"))
}
