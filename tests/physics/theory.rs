//! Deng and Kesari's estimate: section 7 of the physics sheet.

use crate::reference::table;
use crate::support::{PAPER, close, near, paper_spectrum};
use hysteron::model::Material;
use hysteron::physics::PhysicsError;
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::spectrum::Moments;
use hysteron::physics::theory::{
    adhesionless_area, adhesionless_area_small, curvature_density, dalvi_loss, deng_kesari_loss, fuller_tabor, mean_loop_loss,
    pinning_loss, sticky_line,
};
use std::f64::consts::PI;

fn constant(name: &str) -> f64 {
    table("moments_constants").rows().find(|row| row.word("name") == name).unwrap().number("value")
}

/// `∫ f(|t|) p_k(t) dt`, Simpson in y = |t|^(1/3) with 4000 intervals up to |t| = 15, beyond which p_k is below 1e-21.
fn mean(f: impl Fn(f64) -> f64) -> f64 {
    let n = 4000;
    let h = 15f64.cbrt() / f64::from(n);
    let term = |k: i32| {
        let y = h * f64::from(k);
        if k == 0 { 0.0 } else { f(y.powi(3)) * curvature_density(-y.powi(3)) * 3.0 * y * y }
    };
    (0..=n).map(|k| if k == 0 || k == n { 1.0 } else if k % 2 == 1 { 4.0 } else { 2.0 } * term(k)).sum::<f64>() * h / 3.0
}

#[test]
fn val_the_density_of_curvature() {
    // Simpson's error is 1e-11 at this step: (15^⅓/4000)⁴ of derivatives below 1e3.
    near("integral", mean(|_| 1.0), 1.0, 1e-9);
    close("mean |t|", mean(|t| t), constant("mean_abs_t"), 1e-9);
    close("mean |t| in closed form", constant("mean_abs_t"), 8.0 / (3.0 * PI).sqrt(), 1e-15);
    close("mean |t|^(-4/3)", mean(|t| t.powf(-4.0 / 3.0)), constant("mean_abs_t_pow_minus_4_3"), 1e-9);
    // Only maxima: curvatures t ≥ 0 do not occur.
    assert_eq!(curvature_density(0.0).to_bits(), 0);
    assert_eq!(curvature_density(1.0).to_bits(), 0);
}

#[test]
fn law_the_density_does_not_cancel_near_zero() {
    // t² − 2 + 2e^(−t²/2) = t⁴/4 − t⁶/24 + t⁸/192 − …: at |t| = 0.01 the three terms are exact to 1e-14; the printed form has lost eight digits.
    for t in [1e-6, 1e-4, 1e-2] {
        let t2: f64 = t * t;
        let bracket = t2 * t2 * (0.25 - t2 / 24.0 + t2 * t2 / 192.0);
        close("series", curvature_density(-t), (3.0 / (4.0 * PI)).sqrt() * bracket * (-0.25 * t2).exp(), 1e-13);
    }
    // On both sides of wherever a program may change its formula, the density is the printed one as far as that has digits: 2ε/(t⁴/4).
    for k in 1..400 {
        let t = 0.01 * f64::from(k);
        let printed = (3.0 / (4.0 * PI)).sqrt() * (t * t - 2.0 + 2.0 * (-0.5 * t * t).exp()) * (-0.25 * t * t).exp();
        close("as printed", curvature_density(-t), printed, 1e-13 + 4e-15 / t.powi(4));
    }
}

#[test]
fn val_mean_loss_agrees_with_many_digits() {
    for row in table("moments").rows() {
        let spectrum = paper_spectrum(row.number("H"), row.number("zeta") as u32);
        let moments = spectrum.moments();
        let theta = mean_loop_loss(&moments, &PAPER, None).unwrap();
        // The quadrature's own error: five-point Gauss on 48 panels, below 1e-9 of the integral.
        close("<theta>", theta, row.number("theta_mean"), 1e-9);
        // With a tip the integrand bends at t = 1/(R_tip sqrt(m4/3)), down to |t| = 0.006 at ζ = 512 (y = 0.18, resolved by 48 panels of 0.05).
        close("<theta>, tip", mean_loop_loss(&moments, &PAPER, Some(1e-3)).unwrap(), row.number("theta_mean_tip"), 1e-7);
        let slope = moments.summit_density_1_m2() * theta / (PAPER.contact_modulus_pa * spectrum.rms_height_m);
        close("slope", slope, row.number("dk_slope"), 1e-9);
        let area = 0.3e-6;
        let loss = deng_kesari_loss(&moments, &PAPER, area).unwrap();
        close("Eq A4", loss, row.number("dk_slope") * area * PAPER.contact_modulus_pa * spectrum.rms_height_m, 1e-9);
    }
}

#[test]
fn val_the_printed_slopes_hold_to_four_digits() {
    let printed = [
        (0.8, 64, 2.630e-3),
        (0.8, 128, 3.286e-3),
        (0.8, 256, 4.168e-3),
        (0.8, 512, 5.342e-3),
        (0.45, 128, 1.080e-3),
        (0.65, 128, 2.130e-3),
        (0.95, 128, 4.504e-3),
    ];
    for (hurst, zeta, want) in printed {
        let spectrum = paper_spectrum(hurst, zeta);
        let unit = PAPER.contact_modulus_pa * spectrum.length_m.powi(2) * spectrum.rms_height_m;
        let loss = deng_kesari_loss(&spectrum.moments(), &PAPER, spectrum.length_m.powi(2)).unwrap();
        close("slope", loss / unit, want, 5e-4);
    }
}

#[test]
fn law_the_mean_is_a_mean_over_asperities() {
    let moments = paper_spectrum(0.8, 128).moments();
    for tip in [None, Some(1e-3), Some(1e-5)] {
        let curvature = |t: f64| tip.map_or(0.0, |r: f64| 1.0 / r) + (moments.m4_1_m2 / 3.0).sqrt() * t;
        let direct = mean(|t| Asperity::new(1.0 / curvature(t), &PAPER).unwrap().loop_loss());
        close("mean", mean_loop_loss(&moments, &PAPER, tip).unwrap(), direct, 1e-8);
    }
}

#[test]
fn lim_a_sharp_tip_decides_alone_and_a_flat_one_does_not() {
    let moments = paper_spectrum(0.8, 64).moments();
    let loss = |tip| mean_loop_loss(&moments, &PAPER, tip).unwrap();
    // R_tip far below the summits' radii (1e-4 m): every asperity is the tip, up to (4/3)·⟨|t|⟩·R_tip·sqrt(m4/3) of it, 3e-5 at 1e-9 m.
    close("sharp", loss(Some(1e-9)), Asperity::new(1e-9, &PAPER).unwrap().loop_loss(), 5e-5);
    // A tip of a kilometre bends nothing: 1/(R_tip sqrt(m4/3)) is 1e-7, and small |t| are rare.
    close("flat", loss(Some(1e3)), loss(None), 1e-6);
}

#[test]
fn reg_the_mean_loss_refuses_what_it_cannot_use() {
    let moments = |m4_1_m2| Moments { m0_m2: 1e-11, m2: 1e-2, m4_1_m2 };
    let good: Material = PAPER;
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(mean_loop_loss(&moments(bad), &good, None), Err(PhysicsError::Domain { .. })), "m4 {bad}");
        assert!(matches!(deng_kesari_loss(&moments(bad), &good, 1e-6), Err(PhysicsError::Domain { .. })), "m4 {bad}");
        assert!(matches!(mean_loop_loss(&moments(1e8), &good, Some(bad)), Err(PhysicsError::Domain { .. })), "tip {bad}");
    }
}

#[test]
fn lim_the_area_without_adhesion_is_linear_at_small_loads_and_whole_at_great_ones() {
    let slope = 0.3;
    for load in [1e-6, 1e-4] {
        // erf(x) = 2x/√π (1 − x²/3 …): at these loads the next term is below 1e-6.
        let persson = adhesionless_area(load, slope);
        close("Persson", persson, (8.0 / PI).sqrt() * load / slope, 1e-6);
        assert!(persson < adhesionless_area_small(load, slope) && adhesionless_area_small(load, slope) < (2.0 * PI).sqrt() * load / slope);
    }
    // mpmath: erf(sqrt(2) 0.05/0.3) and erf(sqrt(2)).
    close("in between", adhesionless_area(0.05, 0.3), 0.261_117_319_636_473, 1e-14);
    close("at once the slope", adhesionless_area(0.3, 0.3), 0.954_499_736_103_641_6, 1e-14);
    close("great", adhesionless_area(3.0, 0.3), 1.0, 1e-15);
}

#[test]
fn lim_persson_s_area_is_that_of_a_wall_at_zero_pressure() {
    // The distribution of pressures at full contact, Gaussian around p with the variance (E* h'/2)², less its mirror image: what is left of it is in contact.
    let (pressure, slope, modulus) = (0.7e4, 0.05, 1e6);
    let sd = 0.5 * modulus * slope;
    let gauss = |x: f64| (-0.5 * (x / sd).powi(2)).exp() / (sd * (2.0 * PI).sqrt());
    let (count, most) = (200_000, 12.0 * sd);
    let step = most / f64::from(count);
    let left: f64 = (0..count).map(|k| (f64::from(k) + 0.5) * step).map(|x| (gauss(x - pressure) - gauss(x + pressure)) * step).sum();
    // The midpoint rule on a smooth function: far below 1e-8.
    close("area", adhesionless_area(pressure / modulus, slope), left, 1e-8);
}

#[test]
fn val_dalvi_and_fuller_and_tabor_by_hand() {
    close("full contact", dalvi_loss(&PAPER, 1e-6), 0.07 * 1e-6, 1e-15);
    // 1e6 (4e-6)^1.5/(1e-4^0.5 0.07) = 1e6 · 8e-9/(1e-2 · 0.07).
    close("Fuller and Tabor", fuller_tabor(&PAPER, 4e-6, 1e-4), 8e-3 / 7e-4, 1e-14);
}

#[test]
fn val_pinning_and_the_sticky_line_by_hand() {
    // 2 · 1.35 · 0.01 · 1e-6.
    close("pinning", pinning_loss(&PAPER, 0.01, 1e-6).unwrap(), 2.7e-8, 1e-14);
    // k U_el = Δγ/2 at U_el = 0.035/1.35 = 0.0259.
    assert!(pinning_loss(&PAPER, 0.0258, 1e-6).is_some() && pinning_loss(&PAPER, 0.0260, 1e-6).is_none());
    close("sticky line", sticky_line(3.0), 1.5, 1e-15);
}
