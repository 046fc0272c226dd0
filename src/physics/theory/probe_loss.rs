//! Deng and Kesari's dissipated energy of a spherical probe, with its radius as the radius of the tip.

use super::mean_loop_loss_as_printed;
use crate::PhysicsError;
use crate::jkr::Asperity;
use crate::model::{Material, Slips};
use crate::surface::spectrum::Moments;
use std::f64::consts::PI;

/// Contact areas of a smooth probe by JKR theory \[m²\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbeAreas {
    /// At the load reversal.
    pub reversal_m2: f64,
    /// After its jump into contact at zero penetration, `A_in = π (2πΔγR²/E*)^(2/3)`.
    pub jump_in_m2: f64,
}

impl ProbeAreas {
    /// Of a probe of a radius \[m\] with a load reversal at `max_load_n` \[N\], positive in compression.
    /// Nothing for a load below the smallest of the branch.
    ///
    /// # Errors
    /// Radius and material must be positive and finite.
    pub fn of(radius_m: f64, material: &Material, max_load_n: f64) -> Result<Option<Self>, PhysicsError> {
        let sphere = Asperity::new(radius_m, material)?;
        let area = |radius: f64| PI * radius * radius;
        let radii = sphere.radius_at_load(max_load_n).zip(sphere.radius_at_penetration(0.0));
        Ok(radii.map(|(reversal, jump_in)| Self { reversal_m2: area(reversal), jump_in_m2: area(jump_in) }))
    }

    /// Area `A_max − A_in` of the asperities that dissipate \[m²\], at least 0.
    #[must_use]
    pub fn swept_m2(&self) -> f64 {
        (self.reversal_m2 - self.jump_in_m2).max(0.0)
    }
}

/// Deng and Kesari's dissipated energy of a probe per contact area, `η ⟨θ⟩` with `R_tip = R` \[J/m²\]. Eqs A3
/// and A4.
///
/// Times the area [`ProbeAreas::swept_m2`] it is their Θ: contact areas are those of the smooth sphere.
/// `R → ∞` is the value of nominally flat surfaces.
///
/// # Errors
/// As [`mean_loop_loss_as_printed`].
pub fn deng_kesari_probe_loss(
    moments: &Moments,
    material: &Material,
    radius_m: f64,
    slips: Slips,
) -> Result<f64, PhysicsError> {
    let mean_j = mean_loop_loss_as_printed(moments, material, Some(radius_m), slips)?;
    Ok(moments.summit_density_1_m2() * mean_j)
}
