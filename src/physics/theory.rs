//! Theories beside a run: here Deng and Kesari's estimate of the loss, from Nayak's statistics of summits.

use super::PhysicsError;
use super::jkr::loop_loss_constant;
use super::spectrum::Moments;
use crate::model::Material;
use std::f64::consts::PI;

/// Nayak's density of the reduced summit curvature in the limit that Deng and Kesari use,
/// `p_k(t) = sqrt(3/(4π)) (t² − 2 + 2e^(−t²/2)) e^(−t²/4)` for `t < 0`, with `t = −sqrt(3/m4) k_m`. Eq A2; it integrates to 1.
///
/// # Deviations
/// The exponent printed in Eq A2 is `8(C1² − C2²)t²/(16C1)`; Nayak's marginal has `(8C1² − C2²)t²/(16C1) = t²/4`, and only this integrates to 1.
#[must_use]
pub fn curvature_density(t: f64) -> f64 {
    if t >= 0.0 {
        return 0.0;
    }
    let half = 0.5 * t * t;
    // t² − 2 + 2e^(−t²/2) = 2(h + expm1(−h)), h = t²/2: as printed it cancels near 0.
    let bracket = if half < 1e-2 {
        half * half * (1.0 - half / 3.0 + half * half / 12.0 - half.powi(3) / 60.0 + half.powi(4) / 360.0 - half.powi(5) / 2520.0)
    } else {
        2.0 * (half + (-half).exp_m1())
    };
    (3.0 / (4.0 * PI)).sqrt() * bracket * (-0.5 * half).exp()
}

/// Mean loss of one asperity `⟨θ⟩ = ∫ 2E*R³ (πΔγ/(E*R))^(5/3) × 0.5262… p_k(t) dt` \[J\], with `1/R(t) = 1/R_tip + sqrt(m4/3)|t|`. Eq A3.
///
/// `tip_radius_m` is the radius of a spherical indenter \[m\]; nothing for nominally flat surfaces.
///
/// # Deviations
/// The curvature printed below Eq A3 is `sqrt(m4/3t)`; from `t = −sqrt(3/m4) k_m` it is `sqrt(m4/3)·t`.
///
/// # Errors
/// m4 must be positive and finite, and so must the tip's radius.
pub fn mean_loop_loss(moments: &Moments, material: &Material, tip_radius_m: Option<f64>) -> Result<f64, PhysicsError> {
    let domain = |quantity, value| PhysicsError::Domain {
        action: "Deng and Kesari's mean loss (Eq A3)",
        quantity,
        value,
        allowed: "a positive, finite number",
    };
    if !(moments.m4_1_m2 > 0.0 && moments.m4_1_m2.is_finite()) {
        return Err(domain("m4 [1/m2]", moments.m4_1_m2));
    }
    let tip_curvature = match tip_radius_m {
        None => 0.0,
        Some(radius) if radius > 0.0 && radius.is_finite() => 1.0 / radius,
        Some(radius) => return Err(domain("the tip radius [m]", radius)),
    };
    let (modulus, adhesion) = (material.contact_modulus_pa, material.work_of_adhesion_j_m2);
    let unit = (moments.m4_1_m2 / 3.0).sqrt();
    // θ(R) = 2·0.5262 E* (πΔγ/E*)^(5/3) R^(4/3).
    let prefactor = 2.0 * loop_loss_constant() * modulus * (PI * adhesion / modulus).powf(5.0 / 3.0);
    // With t = −y³ the integrand p(t)·(…)^(−4/3) has no fractional power at 0 left; beyond |t| = 15 the density is below 1e-21.
    let most = 15f64.cbrt();
    let integrand = |y: f64| {
        let t = y.powi(3);
        if y == 0.0 { 0.0 } else { curvature_density(-t) * (tip_curvature + unit * t).powf(-4.0 / 3.0) * 3.0 * y * y }
    };
    Ok(prefactor * gauss_panels(integrand, 0.0, most, 48))
}

/// Composite five-point Gauss quadrature.
fn gauss_panels(f: impl Fn(f64) -> f64, from: f64, to: f64, panels: usize) -> f64 {
    let nodes = [0.0, 0.538_469_310_105_683_1, 0.906_179_845_938_664];
    let weights = [0.568_888_888_888_888_9, 0.478_628_670_499_366_47, 0.236_926_885_056_189_08];
    let half = 0.5 * (to - from) / panels as f64;
    (0..panels)
        .map(|k| {
            let middle = from + (2 * k + 1) as f64 * half;
            let pairs: f64 = nodes.iter().zip(&weights).skip(1).map(|(x, w)| w * (f(middle - half * x) + f(middle + half * x))).sum();
            half * (weights[0] * f(middle) + pairs)
        })
        .sum()
}

/// Deng and Kesari's loss `Θ = η A ⟨θ⟩` \[J\] of the true contact area `A` \[m²\] reached at the end of loading, with Nayak's density η. Eq A4.
///
/// # Errors
/// As [`mean_loop_loss`].
pub fn deng_kesari_loss(moments: &Moments, material: &Material, area_m2: f64) -> Result<f64, PhysicsError> {
    Ok(moments.summit_density_1_m2() * area_m2 * mean_loop_loss(moments, material, None)?)
}
