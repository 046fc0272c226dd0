//! JKR equations of one asperity: a rigid paraboloid of radius R on a soft half-space.
//!
//! Source: Violano & Afferrante, Lubricants 9(1):7 (2021), Eqs 1–4 and A1; Johnson, Kendall & Roberts, Proc.
//! R. Soc. A 324:301 (1971). Symbols: contact radius `a` \[m\], penetration `δ` \[m\] (positive inwards),
//! load `F` \[N\] (positive in compression), radius of curvature `R` \[m\], reduced modulus
//! `E*` \[Pa\], work of adhesion `Δγ` \[J/m²\].
//!
//! In units `a: (R²Δγ/E*)^⅓`, `δ: (RΔγ²/E*²)^⅓`, `F: RΔγ` all asperities have the same curves.
//!
//! # Without adhesion
//! At `Δγ = 0` Eqs 1 and 2 are those of Hertz. The branch then ends at `a = 0`, where
//! `dδ/da` vanishes and Newton's method fails. Contact therefore begins and ends at `a_off =` [`HERTZ_EDGE`]
//! `R`, where the penetration is `1e-10 R` and the load `(4/3)·1e-15 E*R²`.
//!
//! # Erratum in Eq 9
//! The denominator of Eq 9 is the slope dδ/da of Eq 2, printed as `2a/R − sqrt(πΔγ/(E*a))`. Eq 9 is only an
//! iteration to the equilibrium, which does not depend on this slope. The end of the branch does: it is where
//! the slope vanishes, with the printed slope at `a = (πR²Δγ/(4E*))^⅓ = 2^⅓ a_off`. With the printed equation
//! ([`Asperity::as_printed`]) a spot's branch ends there and the spot leaves contact, at a penetration that
//! is 3 % less deep than `δ_off`. The printed Eq 4 for `δ_off` is right, so the two do not agree.

use crate::PhysicsError;
use crate::constants::Constant;
use crate::model::{Material, Slips};
use multiversion::multiversion;
use std::f64::consts::PI;

/// Contact radius over the radius of curvature at which a contact without adhesion begins and ends.
pub const HERTZ_EDGE: f64 = 1e-5;

/// Smallest Tabor parameter at which Wu's jump-in distance (Eq 3) holds.
pub const MIN_TABOR: f64 = 2.0;

/// Constants of one asperity.
pub(super) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "Tabor parameter of Wu's criterion",
        &[MIN_TABOR],
        "",
        "With a smaller one a cycle fails, unless `model.allow_low_tabor = true`.",
        "",
    ),
    Constant::new(
        "contact radius without adhesion",
        &[HERTZ_EDGE],
        "of `R`",
        "A contact without adhesion begins and ends at this radius.",
        "",
    ),
];

/// JKR asperity with its material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asperity {
    radius: f64,
    modulus: f64,
    adhesion: f64,
    /// `sqrt(2πΔγ/E*)` \[m^½\].
    pull: f64,
    /// Contact radius at which the correct dδ/da vanishes \[m\].
    fold_radius: f64,
    /// Contact radius at the end of the branch \[m\]: `fold_radius`, or where the printed slope vanishes.
    jump_off_radius: f64,
    jump_off_penetration: f64,
}

impl Asperity {
    /// Asperity with radius of curvature `radius_m` \[m\] on `material`.
    ///
    /// # Errors
    /// Radius and modulus must be positive and finite, the work of adhesion zero or positive and finite.
    pub fn new(radius_m: f64, material: &Material) -> Result<Self, PhysicsError> {
        Self::as_printed(radius_m, material, Slips::NONE)
    }

    /// Asperity with the end of the branch by Eq 9 as printed, if `slips` contains it.
    ///
    /// See the head of this module. It changes only
    /// [`Self::jump_off_radius`], [`Self::jump_off_penetration`],
    /// [`Self::loop_loss_from`] and the domain of [`Self::radius_at_penetration`].
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn as_printed(radius_m: f64, material: &Material, slips: Slips) -> Result<Self, PhysicsError> {
        let (modulus, adhesion) = (material.contact_modulus_pa, material.work_of_adhesion_j_m2);
        let refused = |quantity, value, allowed| PhysicsError::Domain {
            action: "a JKR asperity",
            quantity,
            value,
            allowed,
        };
        for (quantity, value) in
            [("the radius of curvature [m]", radius_m), ("the contact modulus [Pa]", modulus)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(refused(quantity, value, "a positive, finite number"));
            }
        }
        if !(adhesion >= 0.0 && adhesion.is_finite()) {
            return Err(refused(
                "the work of adhesion [J/m2]",
                adhesion,
                "zero or a positive, finite number",
            ));
        }
        if adhesion == 0.0 {
            return Ok(Self::hertz(radius_m, modulus));
        }
        let pull_squared = 2.0 * PI * adhesion / modulus;
        let fold_radius = (pull_squared * radius_m * radius_m / 16.0).cbrt();
        // In units of a_off and a_off²/R Eq 2 is κ² − 4 sqrt(κ).
        let (stretch, depth) =
            if slips.eq9 { (2f64.cbrt(), 4.0 * 2f64.cbrt().sqrt() - 4f64.cbrt()) } else { (1.0, 3.0) };
        Ok(Self {
            radius: radius_m,
            modulus,
            adhesion,
            pull: pull_squared.sqrt(),
            fold_radius,
            jump_off_radius: stretch * fold_radius,
            jump_off_penetration: -depth * fold_radius * fold_radius / radius_m,
        })
    }

    /// The limit `Δγ = 0`; see the head of this module.
    fn hertz(radius: f64, modulus: f64) -> Self {
        let jump_off_radius = HERTZ_EDGE * radius;
        let jump_off_penetration = jump_off_radius * HERTZ_EDGE;
        Self {
            radius,
            modulus,
            adhesion: 0.0,
            pull: 0.0,
            fold_radius: 0.0,
            jump_off_radius,
            jump_off_penetration,
        }
    }

    /// Radius of curvature R \[m\].
    #[must_use]
    pub fn radius_m(&self) -> f64 {
        self.radius
    }

    /// Adhesion length scale `sqrt(2πΔγ/E*)` \[m^½\].
    ///
    /// Adhesion reduces the penetration by this times `sqrt(a)`.
    #[must_use]
    pub fn pull_sqrt_m(&self) -> f64 {
        self.pull
    }

    /// Load `F = 4E*a³/(3R) − sqrt(8πE*Δγa³)` \[N\], at contact radius `a ≥ 0` \[m\]. Eq 1.
    #[must_use]
    pub fn load(&self, a: f64) -> f64 {
        self.modulus * a * (4.0 * a * a / (3.0 * self.radius) - 2.0 * self.pull * a.sqrt())
    }

    /// `dF/da = 4E*a²/R − (3/2) sqrt(8πE*Δγa)` \[N/m\], at contact radius `a ≥ 0` \[m\]. Derivative of Eq 1.
    #[must_use]
    pub fn load_slope(&self, a: f64) -> f64 {
        self.modulus * (4.0 * a * a / self.radius - 3.0 * self.pull * a.sqrt())
    }

    /// Penetration `δ = a²/R − sqrt(2πaΔγ/E*)` \[m\], at contact radius `a ≥ 0` \[m\]. Eq 2.
    #[must_use]
    pub fn penetration(&self, a: f64) -> f64 {
        a * a / self.radius - self.pull * a.sqrt()
    }

    /// `dδ/da = 2a/R − sqrt(πΔγ/(2E*a))` (dimensionless), at contact radius `a > 0` \[m\]. Derivative of Eq
    /// 2.
    ///
    /// # Deviations
    /// The denominator of the paper's Eq 9 has `sqrt(πΔγ/(E*a))`, which is not the derivative of Eq 2: it
    /// vanishes before the true jump-off. This function is correct also with Eq 9 as printed, since
    /// equilibria are solved with it.
    #[must_use]
    pub fn penetration_slope(&self, a: f64) -> f64 {
        2.0 * a / self.radius - self.pull / (2.0 * a.sqrt())
    }

    /// Contact radius at jump-off under displacement control `(πR²Δγ/(8E*))^⅓` \[m\], where `dδ/da = 0`.
    ///
    /// With Eq 9 as printed it is `(πR²Δγ/(4E*))^⅓`.
    #[must_use]
    pub fn jump_off_radius(&self) -> f64 {
        self.jump_off_radius
    }

    /// Penetration at jump-off `δ_off = −(27π²Δγ²R/(64E*²))^⅓` \[m\]. Eq 4.
    ///
    /// With Eq 9 as printed it is Eq 2 at the jump-off radius, which is `(4·2^(1/6) − 2^(2/3))/3 = 0.9675` of
    /// it.
    #[must_use]
    pub fn jump_off_penetration(&self) -> f64 {
        self.jump_off_penetration
    }

    /// Contact radius `(9πR²Δγ/(8E*))^⅓` \[m\] at the pull-off force.
    #[must_use]
    pub fn pull_off_radius(&self) -> f64 {
        self.fold_radius * 9f64.cbrt()
    }

    /// Load `−(3/2)πRΔγ` \[N\] at the pull-off force, the most negative load.
    #[must_use]
    pub fn pull_off_load(&self) -> f64 {
        -1.5 * PI * self.radius * self.adhesion
    }

    /// Contact radius \[m\] on the stable branch at penetration `δ` \[m\], the inverse of Eq 2.
    ///
    /// `None` below the jump-off penetration.
    ///
    /// With `a = a_off(1 + e)²` Eq 2 reads `6e² + 4e³ + e⁴ = (δ − δ_off)/(a_off²/R)`, whose left side is
    /// convex. Newton's method from above converges from any start, and the root is accurate down to the
    /// jump-off itself.
    #[must_use]
    pub fn radius_at_penetration(&self, penetration: f64) -> Option<f64> {
        let [radius] = Self::radii_at_penetrations([self], [penetration]);
        radius.is_finite().then_some(radius)
    }

    /// [`Self::radius_at_penetration`] of several asperities at once, each at its penetration \[m\]; not
    /// finite below the end of the branch. Divisions of one asperity wait for one another, those of several
    /// do not.
    fn radii_at_penetrations<const N: usize>(asperities: [&Self; N], penetrations: [f64; N]) -> [f64; N] {
        let excess: [f64; N] = std::array::from_fn(|k| {
            let (off, radius) = (asperities[k].fold_radius, asperities[k].radius);
            (penetrations[k] + 3.0 * off * off / radius) * radius / (off * off)
        });
        let e = beyond_the_fold(&excess);
        std::array::from_fn(|k| {
            let Self { fold_radius: off, radius, jump_off_penetration, .. } = *asperities[k];
            if penetrations[k] < jump_off_penetration {
                f64::NAN
            } else if off == 0.0 {
                (radius * penetrations[k]).sqrt()
            } else {
                off * (1.0 + e[k]) * (1.0 + e[k])
            }
        })
    }

    /// [`Self::radius_ahead`] of several asperities at once.
    pub(crate) fn radii_ahead<const N: usize>(asperities: [&Self; N], penetrations: [f64; N]) -> [f64; N] {
        let radii = Self::radii_at_penetrations(asperities, penetrations);
        std::array::from_fn(|k| if radii[k].is_finite() { radii[k] } else { asperities[k].jump_off_radius })
    }

    /// [`Self::radius_at_penetration`], or the jump-off radius below the end of the branch.
    pub(crate) fn radius_ahead(&self, penetration: f64) -> f64 {
        let [radius] = Self::radii_ahead([self], [penetration]);
        radius
    }

    /// Contact radius \[m\] on the branch that is stable under control of the load, at a load `F` \[N\]:
    /// `a³ = (3R/(4E*)) (F + 3πRΔγ + sqrt(6πRΔγF + (3πRΔγ)²))`.
    ///
    /// `None` at a tension above the pull-off force. Johnson, Kendall & Roberts, Proc. R. Soc. A 324, 301
    /// (1971).
    #[must_use]
    pub fn radius_at_load(&self, load: f64) -> Option<f64> {
        let pull = 3.0 * PI * self.radius * self.adhesion;
        let root = (2.0 * pull * load + pull * pull).sqrt();
        let hertz = load + pull + root;
        root.is_finite().then(|| (0.75 * self.radius * hertz / self.modulus).cbrt())
    }

    /// Stored elastic energy at fixed contact radius `U(δ, a) = E*(aδ² − 2a³δ/(3R) + a⁵/(5R²))` \[J\].
    ///
    /// On the equilibrium path `∂U/∂δ = F` and `∂U/∂(πa²) = Δγ`.
    #[must_use]
    pub fn stored_energy(&self, penetration: f64, a: f64) -> f64 {
        let flat = a * a / self.radius;
        self.modulus * a * (penetration * penetration - 2.0 * flat * penetration / 3.0 + flat * flat / 5.0)
    }

    /// Tabor parameter `μ = (RΔγ²/E*²)^⅓ / ε`, with the range of attraction `ε > 0` \[m\]. Below Eq 3.
    #[must_use]
    pub fn tabor(&self, range: f64) -> f64 {
        (self.radius * (self.adhesion / self.modulus).powi(2)).cbrt() / range
    }

    /// Wu's jump-in penetration `δ_in = (1 − 2.641 μ^(3/7)) ε` \[m\], valid for `μ ≥ 2`. Eq 3.
    ///
    /// # Deviations
    /// This penetration is negative: contact forms where the gap falls below `|δ_in|`, not below `δ_in` as
    /// §2.2 says.
    #[must_use]
    pub fn wu_jump_in_penetration(&self, range: f64) -> f64 {
        (1.0 - 2.641 * self.tabor(range).powf(3.0 / 7.0)) * range
    }

    /// Dissipated energy \[J\] of a loop with jump-in at `δ = 0`.
    ///
    /// `θ = 2E*R³ (πΔγ/(E*R))^(5/3) × 0.5262…`. Eq A1.
    ///
    /// # Deviations
    /// The constant is exact here, `2^⅔ (3/10 + (1/5) 16^(−⅔))`. The paper prints 0.5262. Eq 9 as printed has
    /// no effect.
    #[must_use]
    pub fn loop_loss(&self) -> f64 {
        let ratio = PI * self.adhesion / (self.modulus * self.radius);
        2.0 * self.modulus * self.radius.powi(3) * ratio.powf(5.0 / 3.0) * loop_loss_constant()
    }

    /// Dissipated energy \[J\] of a loop with jump-in at `jump_in` \[m\], `δ_off ≤ jump_in ≤ 0`.
    ///
    /// It is the decrease of `U − Δγπa²` in the two jumps. `None` if the jump-in is below the end of the
    /// branch. The loop ends where the branch ends.
    #[must_use]
    pub fn loop_loss_from(&self, jump_in: f64) -> Option<f64> {
        let energy =
            |penetration: f64, a: f64| self.stored_energy(penetration, a) - PI * self.adhesion * a * a;
        let landed = self.radius_at_penetration(jump_in)?;
        Some(energy(self.jump_off_penetration(), self.jump_off_radius) - energy(jump_in, landed))
    }
}

/// The root `e ≥ 0` of `6e² + 4e³ + e⁴ = excess` for each excess.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn beyond_the_fold<const N: usize>(excess: &[f64; N]) -> [f64; N] {
    let mut e = excess.map(|excess| (excess / 6.0).sqrt().min(excess.sqrt().sqrt() + 0.6));
    let mut moving = [true; N];
    for _ in 0..60 {
        for k in 0..N {
            let value = e[k] * e[k] * (6.0 + e[k] * (4.0 + e[k])) - excess[k];
            let slope = e[k] * (12.0 + e[k] * (12.0 + 4.0 * e[k]));
            let next = e[k] - value / slope;
            moving[k] &= slope > 0.0;
            let step = (next - e[k]).abs();
            e[k] = if moving[k] { next } else { e[k] };
            moving[k] &= step > 4e-16 * e[k];
        }
        if moving == [false; N] {
            break;
        }
    }
    e
}

/// Exact constant of Deng and Kesari's loop loss, `2^⅔ (3/10 + (1/5)·16^(−⅔)) = 0.5262203…`.
#[must_use]
pub fn loop_loss_constant() -> f64 {
    4f64.cbrt() * (0.3 + 0.2 / 256f64.cbrt())
}

#[cfg(test)]
mod tests {
    use super::Asperity;
    use crate::model::Material;

    #[test]
    fn law_radii_of_several_asperities_are_those_of_each() {
        let adhesive =
            Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
        let elastic = Material { work_of_adhesion_j_m2: 0.0, ..adhesive };
        let of = |(radius, material)| Asperity::new(radius, material).ok();
        let all: Vec<Asperity> =
            [(2e-5, &adhesive), (3e-4, &adhesive), (1e-4, &elastic)].into_iter().filter_map(of).collect();
        let asperities: [&Asperity; 6] = std::array::from_fn(|k| &all[k % 3]);
        let off = all[0].jump_off_penetration();
        // On the branch, at its end, below it, and no number.
        let penetrations = [off, 2e-6, 1e-7, 1.01 * off, f64::NAN, -1e-9];
        let together = Asperity::radii_ahead(asperities, penetrations);
        for ((asperity, penetration), radius) in asperities.iter().zip(penetrations).zip(together) {
            assert_eq!(
                radius,
                asperity.radius_at_penetration(penetration).unwrap_or(asperity.jump_off_radius()),
                "{penetration}"
            );
        }
        assert_eq!(
            together[3..],
            [all[0].jump_off_radius(), all[1].jump_off_radius(), all[2].jump_off_radius()]
        );
    }
}
