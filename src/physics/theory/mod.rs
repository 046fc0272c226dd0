//! Analytical models for comparison with a simulated cycle.
//!
//! Dissipated energy from Nayak's statistics of summits (Deng and Kesari) and in full contact (Dalvi et al.),
//! crack-front pinning, contact area without adhesion, and the adhesion parameter of Fuller and Tabor.
//!
//! Not included, since their formulae could not be confirmed at their sources: the bearing-area model
//! (Ciavarella 2018) and the criterion of Pastewka and Robbins (2014). Persson and Tosatti's criterion is in
//! [`flattening`].

pub mod approximate_jkr;
pub mod cut_off;
pub mod estimates;
pub mod flattening;
pub mod grid_convergence;
pub mod probe;
pub mod probe_loss;
pub mod regime;
pub mod works;

use crate::PhysicsError;
use crate::constants::Constant;
use crate::jkr::loop_loss_constant;
use crate::model::{Material, Slips};
use crate::surface::spectrum::Moments;
use grid_convergence::CONSTANTS as GRIDS;
use std::f64::consts::PI;

/// Constants of the analytical models.
pub(super) const CONSTANTS: &[Constant] = &[
    Constant::new("pinning of a contact edge, `k`", &[PINNING], "", "Prefactor of `loss_pinning`.", ""),
    Constant::new(
        "band of `k`",
        &works::PINNING_BAND,
        "",
        "Prefactors of the works of adhesion of pinning in the table `cutoff`.",
        "",
    ),
    GRIDS[0],
    GRIDS[1],
    GRIDS[2],
    GRIDS[3],
    GRIDS[4],
];

/// Nayak's density of the reduced summit curvature in the limit used by Deng and Kesari. Eq A2.
///
/// `p_k(t) = sqrt(3/(4π)) (t² − 2 + 2e^(−t²/2)) e^(−t²/4)` for `t < 0`, with `t = −sqrt(3/m4) k_m`. It
/// integrates to 1.
///
/// # Deviations
/// The exponent printed in Eq A2 is `8(C1² − C2²)t²/(16C1)`.
/// Nayak's marginal has `(8C1² − C2²)t²/(16C1) = t²/4`, and only this integrates to 1.
/// [`curvature_decay`] and [`curvature_density_as_printed`] can restore the printed equation.
#[must_use]
pub fn curvature_density(t: f64) -> f64 {
    curvature_density_as_printed(t, NAYAK_DECAY)
}

/// Decay `c` in the factor `e^(−ct²)` of the density of curvature.
const NAYAK_DECAY: f64 = 0.25;

/// Decay `c` in the factor `e^(−ct²)` of Eq A2, for the bandwidth (Nayak) parameter.
///
/// With `α = m0 m4/m2² ≥ 3/2` (dimensionless) it is `(8C1² − C2²)/(16C1)` with
/// `C1 = α/(2α − 3)` and `C2 = C1 sqrt(12/α)`, which is ¼ for every `α`.
///
/// With Eq A2 as printed it is `8(C1² − C2²)/(16C1) = (α − 12)/(2(2α − 3))`, which is below ¼ and approaches
/// it for large `α`. The density then integrates to `(√3/2)(c^(−3/2)/4 − c^(−1/2) + (c + ½)^(−1/2)) > 1`. For
/// `α ≤ 12` the integral diverges, and the result is `None`.
#[must_use]
pub fn curvature_decay(nayak_parameter: f64, slips: Slips) -> Option<f64> {
    if !slips.a2 {
        return Some(NAYAK_DECAY);
    }
    let decay = (nayak_parameter - 12.0) / (2.0 * (2.0 * nayak_parameter - 3.0));
    (nayak_parameter > 12.0 && decay > 0.0).then_some(decay)
}

/// Density of curvature with the decay `c`: Eq A2 as printed, with `c` of [`curvature_decay`].
///
/// `p_k(t) = sqrt(3/(4π)) (t² − 2 + 2e^(−t²/2)) e^(−ct²)` for `t < 0`. It integrates to 1 only with `c = ¼`.
#[must_use]
pub fn curvature_density_as_printed(t: f64, decay: f64) -> f64 {
    if t >= 0.0 {
        return 0.0;
    }
    let half = 0.5 * t * t;
    // t² − 2 + 2e^(−t²/2) = 2(h + expm1(−h)), h = t²/2: the printed form suffers from cancellation near 0.
    let bracket = if half < 1e-2 {
        half * half
            * (1.0 - half / 3.0 + half * half / 12.0 - half.powi(3) / 60.0 + half.powi(4) / 360.0
                - half.powi(5) / 2520.0)
    } else {
        2.0 * (half + (-half).exp_m1())
    };
    (3.0 / (4.0 * PI)).sqrt() * bracket * (-decay * t * t).exp()
}

/// Mean dissipated energy of one asperity \[J\]. Eq A3.
///
/// `⟨θ⟩ = ∫ 2E*R³ (πΔγ/(E*R))^(5/3) × 0.5262… p_k(t) dt`, with `1/R(t) = 1/R_tip + sqrt(m4/3)|t|`.
/// `tip_radius_m` is the radius of a spherical indenter \[m\], `None` for nominally flat surfaces.
///
/// # Deviations
/// The curvature printed below Eq A3 is `sqrt(m4/3t)`; from `t = −sqrt(3/m4) k_m` it is `sqrt(m4/3)·t`.
/// [`mean_loop_loss_as_printed`] can restore this and Eq A2 as printed.
///
/// # Errors
/// m4 must be positive and finite, and so must the tip radius.
pub fn mean_loop_loss(
    moments: &Moments,
    material: &Material,
    tip_radius_m: Option<f64>,
) -> Result<f64, PhysicsError> {
    mean_loop_loss_as_printed(moments, material, tip_radius_m, Slips::NONE)
}

/// [`mean_loop_loss`] with the printed Eq A2 and the printed curvature below Eq A3, if `slips` contains them.
///
/// The printed `1/R(t) = 1/R_tip − sqrt(m4/3t)` is read as `1/R_tip + sqrt((m4/3)|t|)`: the root extends one
/// symbol too far. The same page writes `h''_rms = sqrt(8/3m4)` for
/// `sqrt((8/3)m4)`, so a slash applies to one symbol only. As `t < 0`, no reading has a root without `|t|`.
///
/// # Errors
/// As [`mean_loop_loss`]. With Eq A2 as printed the bandwidth parameter must exceed 12 too, since the mean
/// diverges otherwise.
pub fn mean_loop_loss_as_printed(
    moments: &Moments,
    material: &Material,
    tip_radius_m: Option<f64>,
    slips: Slips,
) -> Result<f64, PhysicsError> {
    let refused = |quantity, value, allowed| PhysicsError::Domain {
        action: "Deng and Kesari's mean loss (Eq A3)",
        quantity,
        value,
        allowed,
    };
    let domain = |quantity, value| refused(quantity, value, "a positive, finite number");
    if !(moments.m4_1_m2 > 0.0 && moments.m4_1_m2.is_finite()) {
        return Err(domain("m4 [1/m2]", moments.m4_1_m2));
    }
    let nayak = moments.nayak_parameter();
    let Some(decay) = curvature_decay(nayak, slips) else {
        return Err(refused("Nayak's parameter", nayak, "with Eq A2 as printed, above 12"));
    };
    let tip_curvature = match tip_radius_m {
        None => 0.0,
        Some(radius) if radius > 0.0 && radius.is_finite() => 1.0 / radius,
        Some(radius) => return Err(domain("the tip radius [m]", radius)),
    };
    let (modulus, adhesion) = (material.contact_modulus_pa, material.work_of_adhesion_j_m2);
    let unit = (moments.m4_1_m2 / 3.0).sqrt();
    // θ(R) = 2·0.5262 E* (πΔγ/E*)^(5/3) R^(4/3).
    let prefactor = 2.0 * loop_loss_constant() * modulus * (PI * adhesion / modulus).powf(5.0 / 3.0);
    // With t = −y³ the integrand p(t)·(…)^(−4/3) has no fractional power at 0, except far below its rounding.
    // Beyond ct² = 56, which is |t| = 15, the density is below 1e-21.
    let most = (7.5 / decay.sqrt()).cbrt();
    let panels = (48.0 * most / 15f64.cbrt()).ceil() as usize;
    let integrand = |y: f64| {
        let t = y.powi(3);
        let reduced = if slips.a3 { t.sqrt() } else { t };
        let size = tip_curvature + unit * reduced;
        if y == 0.0 {
            0.0
        } else {
            curvature_density_as_printed(-t, decay) * size.powf(-4.0 / 3.0) * 3.0 * y * y
        }
    };
    Ok(prefactor * gauss_panels(integrand, 0.0, most, panels))
}

/// Composite five-point Gauss quadrature.
fn gauss_panels(f: impl Fn(f64) -> f64, from: f64, to: f64, panels: usize) -> f64 {
    let nodes = [0.0, 0.538_469_310_105_683_1, 0.906_179_845_938_664];
    let weights = [0.568_888_888_888_888_9, 0.478_628_670_499_366_47, 0.236_926_885_056_189_08];
    let half = 0.5 * (to - from) / panels as f64;
    (0..panels)
        .map(|k| {
            let middle = from + (2 * k + 1) as f64 * half;
            let pairs: f64 = nodes
                .iter()
                .zip(&weights)
                .skip(1)
                .map(|(x, w)| w * (f(middle - half * x) + f(middle + half * x)))
                .sum();
            half * (weights[0] * f(middle) + pairs)
        })
        .sum()
}

/// Deng and Kesari's dissipated energy `Θ = η A ⟨θ⟩` \[J\], with Nayak's density η. Eq A4.
/// `A` \[m²\] is the true contact area at the end of loading.
///
/// # Errors
/// As [`mean_loop_loss`].
pub fn deng_kesari_loss(moments: &Moments, material: &Material, area_m2: f64) -> Result<f64, PhysicsError> {
    deng_kesari_loss_as_printed(moments, material, area_m2, Slips::NONE)
}

/// [`deng_kesari_loss`] with Eqs A2 and A3 as printed, if `slips` contains them.
///
/// # Errors
/// As [`mean_loop_loss_as_printed`].
pub fn deng_kesari_loss_as_printed(
    moments: &Moments,
    material: &Material,
    area_m2: f64,
    slips: Slips,
) -> Result<f64, PhysicsError> {
    Ok(moments.summit_density_1_m2() * area_m2 * mean_loop_loss_as_printed(moments, material, None, slips)?)
}

/// Dissipated energy `Θ = Δγ A` \[J\] of separation by the full work of adhesion.
///
/// The contact forms without dissipation.
///
/// `A` \[m²\] is the true contact area at the end of loading, and Δγ is in J/m².
/// Dalvi et al., PNAS 116:25484 (2019), found it for soft spheres in nearly full contact with nanodiamond.
/// For separate contact spots it is an upper bound, since each recovers a part of the energy elastically.
#[must_use]
pub fn dalvi_loss(material: &Material, area_m2: f64) -> f64 {
    material.work_of_adhesion_j_m2 * area_m2
}

/// Prefactor k of the work of adhesion of an advancing and a receding contact line, `Δγ ∓ k U_el`.
const PINNING: f64 = 1.35;

/// Energy dissipated by crack-front pinning, `2 k U_el A` with k = 1.35 \[J\].
///
/// `A` is the contact area \[m²\], and `U_el` \[J/m²\] is the elastic energy per area of flattening the
/// roughness. `None` if `k U_el ≥ Δγ/2`.
///
/// Roughness makes the work of adhesion along a contact line random, with the standard deviation
/// `2 sqrt(Δγ U_el)`. The line is elastic, with a stiffness that decreases with the wavelength. Collective
/// pinning changes the apparent work of adhesion in proportion to the variance. An advancing contact has
/// `Δγ − k U_el`, a receding one `Δγ + k U_el`. The proportionality is from Sanner, Kumar, Dhinojwala, Jacobs
/// and Pastewka, Sci. Adv. 10:eadl1277 (2024). The prefactor is from our simulations: lines of 512 to 1024
/// points in weak fields, driven slowly, with H = 0.8, gave 1.2 to 1.5. One connected contact with weak
/// roughness is assumed.
#[must_use]
pub fn pinning_loss(material: &Material, elastic_energy_j_m2: f64, area_m2: f64) -> Option<f64> {
    let shift = PINNING * elastic_energy_j_m2;
    (shift < 0.5 * material.work_of_adhesion_j_m2).then_some(2.0 * shift * area_m2)
}

/// Wang and Müser's stickiness parameter `U_el/(2Δγ)`, from Persson and Tosatti's ratio `U_el/Δγ`.
///
/// Below 1 the pull-off force of a flat rough contact is high.
/// Wang and Müser, Front. Mech. Eng. 8:965584 (2022).
#[must_use]
pub fn sticky_line(persson_tosatti: f64) -> f64 {
    0.5 * persson_tosatti
}

/// Contact area over A0 without adhesion, `erf(√2 p/(E* h'_rms))`.
///
/// `load` is `p/E* = F/(E* A0) ≥ 0` and `rms_slope` the rms gradient `h'_rms` of the surface (both
/// dimensionless). Persson, J. Chem. Phys. 115:3840 (2001).
///
/// At full contact the pressure has the variance `E*²h'²_rms/4`, since a mode of amplitude c and wavevector k
/// is flattened by `(E*/2) k c`. In Persson's theory pressures spread by diffusion up to that variance with
/// an absorbing wall at zero. The remaining area in contact is `erf(p/(√2 E* h'_rms/2))`.
#[must_use]
pub fn adhesionless_area(load: f64, rms_slope: f64) -> f64 {
    libm::erf(std::f64::consts::SQRT_2 * load / rms_slope)
}

/// Contact area over A0 without adhesion at small loads, `κ p/(E* h'_rms)` with κ = 2.
///
/// The value of boundary-element solutions lies between `√(8/π)` of Persson's theory and `√(2π)` of
/// asperities without elastic interaction (Bush, Gibson and Thomas, Wear 35:87, 1975). Hyun, Pei, Molinari
/// and Robbins, Phys. Rev. E 70:026117 (2004).
#[must_use]
pub fn adhesionless_area_small(load: f64, rms_slope: f64) -> f64 {
    2.0 * load / rms_slope
}

/// Fuller–Tabor adhesion parameter `E* σ^(3/2)/(R^(1/2) Δγ)` (dimensionless).
///
/// σ \[m\] is the standard deviation of the summit heights and R \[m\] their mean radius. It is the ratio of
/// the compressive load of high asperities to the tensile load of low ones. Above about 10 adhesion vanishes.
/// Fuller and Tabor, Proc. R. Soc. A 345:327 (1975).
#[must_use]
pub fn fuller_tabor(material: &Material, height_sd_m: f64, mean_radius_m: f64) -> f64 {
    material.contact_modulus_pa * height_sd_m.powf(1.5)
        / (mean_radius_m.sqrt() * material.work_of_adhesion_j_m2)
}
