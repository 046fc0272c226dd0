//! The power spectrum and its moments: section 2 of the physics sheet.

use crate::reference::table;
use crate::support::{LENGTH, RMS, close, near, paper_spectrum};
use hysteron::model::Normalization;
use hysteron::physics::surface::spectrum::{Moments, Spectrum};
use std::f64::consts::PI;

#[test]
fn val_continuous_moments_agree_with_many_digits() {
    for row in table("moments").rows() {
        let spectrum = paper_spectrum(row.number("H"), row.number("zeta") as u32);
        let moments = spectrum.moments();
        // Differences of powers: a few roundings, and a few more at H = 0.95 where two powers nearly cancel.
        close("m0", moments.m0_m2, row.number("m0"), 1e-12);
        close("m2", moments.m2, row.number("m2"), 1e-12);
        close("m4", moments.m4_1_m2, row.number("m4"), 1e-12);
        close("slope", moments.rms_slope(), row.number("slope_rms"), 1e-12);
        close("laplacian", moments.rms_curvature_1_m(), row.number("laplacian_rms"), 1e-12);
        close("alpha", moments.nayak_parameter(), row.number("alpha"), 1e-12);
        close("eta", moments.summit_density_1_m2(), row.number("eta"), 1e-12);
        // The spectrum's integral is the mean square height.
        close("rms", moments.rms_height_m(), RMS, 1e-12);
    }
}

#[test]
fn val_the_printed_table_holds_to_four_digits() {
    let printed = [
        (0.8, 64, 0.1300, 2.371e4, 73.73, 763.8),
        (0.8, 128, 0.1535, 5.445e4, 200.4, 2892.0),
        (0.8, 256, 0.1798, 1.251e5, 561.1, 11115.0),
        (0.8, 512, 0.2096, 2.874e5, 1605.0, 43184.0),
        (0.45, 128, 0.4114, 1.976e5, 51.10, 5298.0),
        (0.65, 128, 0.2302, 9.588e4, 122.8, 3986.0),
        (0.95, 128, 0.1082, 3.063e4, 256.5, 1840.0),
    ];
    for (hurst, zeta, slope, laplacian, alpha, eta) in printed {
        let moments = paper_spectrum(hurst, zeta).moments();
        // Half a unit of the fourth digit is 5e-4 of the smallest mantissa.
        close("slope", moments.rms_slope(), slope, 5e-4);
        close("laplacian", moments.rms_curvature_1_m(), laplacian, 5e-4);
        close("alpha", moments.nayak_parameter(), alpha, 5e-4);
        close("eta", moments.summit_density_1_m2() * 1e-6, eta, 5e-4);
    }
}

#[test]
fn law_the_band_is_half_open() {
    let spectrum = paper_spectrum(0.8, 64);
    close("qL", spectrum.lowest_wavenumber(), 2.0 * PI / LENGTH, 1e-15);
    assert_eq!(spectrum.density(0).to_bits(), 0, "no mean");
    close("the shell qL is in", spectrum.density(1), spectrum.prefactor(), 1e-15);
    assert!(spectrum.density(64 * 64 - 1) > 0.0);
    assert_eq!(spectrum.density(64 * 64).to_bits(), 0, "the shell q1 is out");
    // Eq 10: C(2q) = 2^(−2(H+1)) C(q), wherever both lie in the band.
    for k2 in [1, 5, 100, 1000] {
        close("power law", spectrum.density(4 * k2), spectrum.density(k2) * 2f64.powf(-3.6), 1e-13);
    }
}

#[test]
fn law_the_prefactor_makes_the_integral_the_mean_square() {
    for (hurst, zeta) in [(0.3, 2), (0.8, 64), (1.0, 500)] {
        let spectrum = paper_spectrum(hurst, zeta);
        let ql = spectrum.lowest_wavenumber();
        // 2π∫qC dq in y = ln(q/qL): smooth, by Simpson's rule with 2000 intervals (error (ln ζ/2000)⁴, 1e-10 at most).
        let n = 2000;
        let h = f64::from(zeta).ln() / f64::from(n);
        let sum: f64 = (0..=n)
            .map(|k| {
                let weight = if k == 0 || k == n {
                    1.0
                } else if k % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                weight * (-2.0 * hurst * h * f64::from(k)).exp()
            })
            .sum();
        close("integral", 2.0 * PI * ql * ql * spectrum.prefactor() * sum * h / 3.0, RMS * RMS, 1e-8);
    }
}

#[test]
fn law_lattice_moments_are_sums_over_the_modes() {
    for (hurst, zeta, normalization) in [
        (0.8, 64, Normalization::Spectrum),
        (0.8, 64, Normalization::Sample),
        (0.45, 17, Normalization::Spectrum),
        (1.0, 9, Normalization::Sample),
        // Beyond 128 by rows.
        (0.8, 300, Normalization::Spectrum),
        (0.3, 599, Normalization::Spectrum),
    ] {
        let spectrum = Spectrum { normalization, ..paper_spectrum(hurst, zeta) };
        let ql = 2.0 * PI / LENGTH;
        let edge = f64::from(zeta);
        let (mut s0, mut s2, mut s4) = (0.0, 0.0, 0.0);
        for kx in -600i32..=600 {
            for ky in -600i32..=600 {
                if kx.abs() > zeta as i32 || ky.abs() > zeta as i32 {
                    continue;
                }
                let k = f64::from(kx).hypot(f64::from(ky));
                // In whole numbers the edge is exact; hypot rounds correctly there too.
                if k >= 1.0 && k < edge {
                    let power = spectrum.prefactor() * k.powf(-2.0 * (hurst + 1.0)) * ql * ql;
                    s0 += power;
                    // Of an isotropic surface m2 is the mean of qx², ½⟨q²⟩, and m4 that of qx⁴, ⅜⟨q⁴⟩.
                    s2 += 0.5 * power * (k * ql).powi(2);
                    s4 += 0.375 * power * (k * ql).powi(4);
                }
            }
        }
        let scale = if normalization == Normalization::Sample { RMS * RMS / s0 } else { 1.0 };
        let moments = spectrum.lattice_moments();
        // Sums of up to a million positive terms in another order.
        close("m0", moments.m0_m2, s0 * scale, 1e-12);
        close("m2", moments.m2, s2 * scale, 1e-12);
        close("m4", moments.m4_1_m2, s4 * scale, 1e-12);
    }
}

#[test]
fn val_a_lattice_weighs_the_first_shells_more() {
    let realised = |normalization| Spectrum { normalization, ..paper_spectrum(0.8, 64) }.lattice_moments();
    // About 30 %, as the sheet says.
    near("realised rms", realised(Normalization::Spectrum).rms_height_m() / RMS, 1.3, 0.05);
    close("sample", realised(Normalization::Sample).rms_height_m(), RMS, 1e-14);
    // The sheet's 735 per mm², to its last digit.
    near("eta of the lattice", realised(Normalization::Sample).summit_density_1_m2() * 1e-6, 735.0, 0.5);
}

#[test]
fn law_moments_follow_from_rms_values() {
    let moments = paper_spectrum(0.8, 64).moments();
    let found = Moments::of_rms(moments.rms_height_m(), moments.rms_slope(), moments.rms_curvature_1_m());
    // Squares of square roots.
    close("m0", found.m0_m2, moments.m0_m2, 1e-15);
    close("m2", found.m2, moments.m2, 1e-15);
    close("m4", found.m4_1_m2, moments.m4_1_m2, 1e-15);
    close("unit of curvature", moments.curvature_unit_1_m().powi(2), moments.m4_1_m2 / 3.0, 1e-15);
}

#[test]
fn lim_the_logarithm_at_hurst_one_is_a_limit() {
    let moments = |hurst| paper_spectrum(hurst, 128).moments();
    // dm2/dH over m2 is of order ln ζ = 4.9: a step of 1e-7 moves it by 5e-7; 1e-9 moves it by 5e-9.
    close("m2", moments(1.0).m2, moments(1.0 - 1e-7).m2, 2e-6);
    close("m2 nearer", moments(1.0).m2, moments(1.0 - 1e-9).m2, 1e-6);
    let spectrum = paper_spectrum(1.0, 128);
    let exact = PI * spectrum.prefactor() * spectrum.lowest_wavenumber().powi(4) * 128f64.ln();
    close("m2 = pi C0 qL^4 ln(zeta)", moments(1.0).m2, exact, 1e-14);
}
