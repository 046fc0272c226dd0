//! How far an asperity model holds: section 6 ("Validity") and section 10 of the physics sheet.

use crate::reference::table;
use crate::support::{LENGTH, PAPER, RMS, close, near, paper_spectrum, surface};
use hysteron::model::{Amplitudes, Normalization};
use hysteron::physics::surface::SquareMap;
use hysteron::physics::surface::edges::Edges;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{mode_sums, realization_seed, synthesize};
use hysteron::physics::theory::flattening::{Flattening, flattening, measured_flattening, realised_flattening, shortest_wavelength};
use ndarray::Array2;
use std::f64::consts::{PI, TAU};

const MODULUS: f64 = PAPER.contact_modulus_pa;
const ADHESION: f64 = PAPER.work_of_adhesion_j_m2;

#[test]
fn val_energies_of_flattening_agree_with_many_digits() {
    for row in table("flattening").rows() {
        let found = flattening(&paper_spectrum(row.number("H"), row.number("zeta") as u32), MODULUS);
        // A few powers and one difference, which expm1 keeps from cancelling.
        close("whole", found.whole_j_m2, row.number("whole"), 1e-13);
        close("octave", found.octave_j_m2, row.number("octave"), 1e-13);
        close("Persson-Tosatti", found.persson_tosatti(ADHESION), row.number("persson_tosatti"), 1e-13);
        close("conformity", found.conformity(ADHESION), row.number("conformity"), 1e-13);
    }
}

#[test]
fn val_the_printed_energies_hold_to_their_digits() {
    // The sheet: 0.0045 J/m² for the shortest octave at ζ = 64, U_el/Δγ = 1.4 of the spectrum and 1.02 of the realised surface.
    let spectrum = paper_spectrum(0.8, 64);
    let found = flattening(&spectrum, MODULUS);
    near("octave", found.octave_j_m2, 0.0045, 5e-5);
    near("U_el/dgamma", found.persson_tosatti(ADHESION), 1.4, 0.05);
    let realised = realised_flattening(&spectrum, &realization_seed(1, 0), MODULUS);
    near("U_el/dgamma, realised", realised.persson_tosatti(ADHESION), 1.02, 0.005);
}

#[test]
fn law_energies_of_heights_are_those_of_the_modes_that_made_them() {
    let spectrum = paper_spectrum(0.8, 32);
    let seed = realization_seed(5, 1);
    let heights = synthesize(&spectrum, &seed, 256).heights_m;
    let wanted = realised_flattening(&spectrum, &seed, MODULUS);
    let square = SquareMap { heights_m: heights.view(), length_m: LENGTH, edges: Edges::Periodic };
    // Eight points to the shortest wave. A little below the edge, so that no rounding puts the first modes of the octave out of it.
    let found = measured_flattening(square, LENGTH / 32.0 * (1.0 + 1e-12), MODULUS).unwrap();
    close("whole", found.whole_j_m2, wanted.whole_j_m2, 1e-10);
    close("octave", found.octave_j_m2, wanted.octave_j_m2, 1e-10);
}

#[test]
fn law_realised_energies_are_sums_over_the_modes() {
    for (hurst, zeta, normalization) in
        [(0.8, 64, Normalization::Sample), (0.45, 17, Normalization::Spectrum), (1.0, 2, Normalization::Sample)]
    {
        let spectrum = Spectrum { normalization, ..paper_spectrum(hurst, zeta) };
        let ql = 2.0 * PI / LENGTH;
        let (mut mean_square, mut whole, mut octave) = (0.0, 0.0, 0.0);
        for kx in -70i32..=70 {
            for ky in -70i32..=70 {
                let k = f64::from(kx).hypot(f64::from(ky));
                if k >= 1.0 && k < f64::from(zeta) {
                    let power = spectrum.prefactor() * k.powf(-2.0 * (hurst + 1.0)) * ql * ql;
                    mean_square += power;
                    whole += 0.25 * MODULUS * k * ql * power;
                    octave += if k >= 0.5 * f64::from(zeta) { 0.25 * MODULUS * k * ql * power } else { 0.0 };
                }
            }
        }
        let scale = if normalization == Normalization::Sample { RMS * RMS / mean_square } else { 1.0 };
        // With fixed amplitudes the seed, which draws the phases, does not matter. Up to 13 000 positive terms in another order.
        for seed in [1, 2] {
            let found = realised_flattening(&spectrum, &realization_seed(seed, 3), MODULUS);
            close("whole", found.whole_j_m2, whole * scale, 1e-12);
            close("octave", found.octave_j_m2, octave * scale, 1e-12);
        }
    }
}

#[test]
fn law_the_modes_are_those_of_the_surface() {
    // Rayleigh moduli are drawn: only the same modes have the same moments, up to the order of the sums.
    for amplitudes in [Amplitudes::Fixed, Amplitudes::Gaussian] {
        let spectrum = Spectrum { amplitudes, normalization: Normalization::Spectrum, ..paper_spectrum(0.8, 16) };
        let ql = spectrum.lowest_wavenumber();
        for realization in 0..3 {
            let moments = surface(&spectrum, realization, 4).moments;
            let weights = |k2: u64| [1.0, 0.5 * ql * ql * k2 as f64, 0.375 * ql.powi(4) * (k2 * k2) as f64];
            let [m0, m2, m4] = mode_sums(&spectrum, &realization_seed(2021, realization), weights);
            close("m0", m0, moments.m0_m2, 1e-12);
            close("m2", m2, moments.m2, 1e-12);
            close("m4", m4, moments.m4_1_m2, 1e-12);
        }
    }
}

#[test]
fn lim_the_lattice_becomes_the_integral_in_the_shortest_octave() {
    // Without the first shells, which a lattice weighs more, sum and integral differ by the edge's granularity, below 1 % from ζ = 64 on.
    let spectrum = Spectrum { normalization: Normalization::Spectrum, ..paper_spectrum(0.8, 128) };
    let realised = realised_flattening(&spectrum, &realization_seed(1, 0), MODULUS);
    close("octave", realised.octave_j_m2, flattening(&spectrum, MODULUS).octave_j_m2, 0.01);
}

#[test]
fn lim_the_logarithm_at_hurst_one_half_is_a_limit() {
    let at = |hurst| flattening(&paper_spectrum(hurst, 128), MODULUS);
    // dU/dH over U is of order ln ζ = 4.9: a step of 1e-9 moves it by 5e-9.
    close("whole", at(0.5).whole_j_m2, at(0.5 + 1e-9).whole_j_m2, 1e-8);
    close("octave", at(0.5).octave_j_m2, at(0.5 - 1e-9).octave_j_m2, 1e-8);
    let spectrum = paper_spectrum(0.5, 128);
    let unit = 0.5 * PI * MODULUS * spectrum.prefactor() * spectrum.lowest_wavenumber().powi(3);
    close("pi/2 E C0 qL^3 ln(zeta)", at(0.5).whole_j_m2, unit * 128f64.ln(), 1e-13);
    close("pi/2 E C0 qL^3 ln 2", at(0.5).octave_j_m2, unit * 2f64.ln(), 1e-13);
}

#[test]
fn law_octaves_add_up_and_two_wavelengths_are_one_octave() {
    // The octave of magnification ζ, in one and the same spectrum, is what the band up to ζ has more than that up to ζ/2.
    let whole = |zeta: u32| {
        let spectrum = paper_spectrum(0.7, zeta);
        flattening(&spectrum, MODULUS).whole_j_m2 / spectrum.prefactor()
    };
    let spectrum = paper_spectrum(0.7, 64);
    close("octave", flattening(&spectrum, MODULUS).octave_j_m2 / spectrum.prefactor(), whole(64) - whole(32), 1e-12);
    let two = flattening(&paper_spectrum(0.7, 2), MODULUS);
    assert_eq!(two.whole_j_m2.to_bits(), two.octave_j_m2.to_bits());
}

#[test]
fn law_energies_of_flattening_scale() {
    // J/m² is force over length: with lengths λ and forces φ times greater the energy per area is φ/λ times greater.
    for (length, force) in [(3.7, 0.013), (2.1e-4, 5e3)] {
        let spectrum = paper_spectrum(0.8, 32);
        let scaled = Spectrum { length_m: length * LENGTH, rms_height_m: length * RMS, ..spectrum.clone() };
        let modulus = MODULUS * force / (length * length);
        let seed = realization_seed(5, 0);
        let pairs = [
            (flattening(&scaled, modulus), flattening(&spectrum, MODULUS)),
            (realised_flattening(&scaled, &seed, modulus), realised_flattening(&spectrum, &seed, MODULUS)),
        ];
        for (got, want) in pairs {
            close("whole", got.whole_j_m2, want.whole_j_m2 * force / length, 1e-13);
            close("octave", got.octave_j_m2, want.octave_j_m2 * force / length, 1e-13);
            let adhesion = ADHESION * force / length;
            close("ratio", got.persson_tosatti(adhesion), want.persson_tosatti(ADHESION), 1e-13);
            close("ratio", got.conformity(adhesion), want.conformity(ADHESION), 1e-13);
        }
    }
    let plain = Flattening { whole_j_m2: 6.0, octave_j_m2: 0.5 };
    near("whole", plain.persson_tosatti(2.0), 3.0, 0.0);
    near("octave", plain.conformity(2.0), 0.25, 0.0);
}

#[test]
fn val_the_shortest_wavelength_is_that_of_the_octave_with_curvature() {
    // Waves with 5 and 15 periods on a side of 1 m, and a cut-off of 1/16 m.
    let waves = |of_15: f64| {
        Array2::from_shape_fn((64, 64), |(i, _)| {
            let x = TAU * i as f64 / 64.0;
            (5.0 * x).cos() + of_15 * (15.0 * x).cos()
        })
    };
    let shortest = |of_15: f64| {
        let heights = waves(of_15);
        shortest_wavelength(SquareMap { heights_m: heights.view(), length_m: 1.0, edges: Edges::Periodic }, 1.0 / 16.0).unwrap()
    };
    // Shares of the wave with 15 periods in the mean square Laplacian: 0, 81 a²/(1 + 81 a²) = 0.99 and 0.05; the limit is 0.1.
    assert_eq!(shortest(0.0), 1.0 / 8.0);
    assert_eq!(shortest(1.0), 1.0 / 16.0);
    assert_eq!(shortest(0.025), 1.0 / 8.0);
}
