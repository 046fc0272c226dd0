//! Spectra with a roll-off, a long cut-off, anisotropy or a table, against closed forms and direct sums.

use crate::support::{close, paper_spectrum};
use hysteron::model::{Amplitudes, Normalization};
use hysteron::physics::surface::periodogram::periodogram;
use hysteron::physics::surface::psd_table::{MAX_GAP, PsdTable};
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{mode_sums, realization_seed, synthesize};
use hysteron::physics::theory::flattening::{flattening, realised_flattening};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

const LENGTH: f64 = 2e-5;

/// The surface of the closed forms: 20 µm, 40 nm, H = 0.8, shortest wavelength L/32.
fn rough(shape: Shape) -> Spectrum {
    Spectrum {
        length_m: LENGTH,
        rms_height_m: 4e-8,
        hurst: 0.8,
        magnification: 32,
        normalization: Normalization::Spectrum,
        amplitudes: Amplitudes::Fixed,
        shape,
    }
}

fn rolled(roll_off_m: f64) -> Shape {
    Shape { roll_off_m: Some(roll_off_m), ..Shape::default() }
}

/// `∫ x^p dx` from a to b.
fn power(p: f64, a: f64, b: f64) -> f64 {
    if p == -1.0 { (b / a).ln() } else { (b.powf(p + 1.0) - a.powf(p + 1.0)) / (p + 1.0) }
}

#[test]
fn val_moments_of_a_roll_off_are_its_closed_forms() {
    let (roll_off, hurst, rms) = (LENGTH / 4.0, 0.8, 4e-8_f64);
    let spectrum = rough(rolled(roll_off));
    let (ql, qr) = (TAU / LENGTH, TAU / roll_off);
    let q1 = 32.0 * ql;
    // C = 1 up to qr and (q/qr)^(-2(H+1)) beyond, in units of the plateau.
    let moment = |p: f64| TAU * (power(p + 1.0, ql, qr) + qr.powf(2.0 * (hurst + 1.0)) * power(p + 1.0 - 2.0 * (hurst + 1.0), qr, q1));
    let plateau = rms * rms / moment(0.0);
    let found = spectrum.moments();
    // Both are closed forms: rounding alone.
    close("rms height", found.rms_height_m(), rms, 1e-12);
    close("rms slope", found.rms_slope(), (plateau * moment(2.0)).sqrt(), 1e-12);
    close("rms Laplacian", found.rms_curvature_1_m(), (plateau * moment(4.0)).sqrt(), 1e-12);
    let energy = flattening(&spectrum, 3e6);
    close("energy", energy.whole_j_m2, 0.25 * 3e6 * plateau * moment(1.0), 1e-12);
    let octave = TAU * qr.powf(3.6) * power(2.0 - 3.6, 0.5 * q1, q1);
    close("energy of the octave", energy.octave_j_m2, 0.25 * 3e6 * plateau * octave, 1e-12);
    close("plateau", spectrum.density(1), plateau, 1e-12);
    close("plateau at 3", spectrum.density(9), plateau, 1e-12);
    close("power law at 8", spectrum.density(64), plateau * 2f64.powf(-3.6), 1e-12);
    close("part", spectrum.integral(0.0, 0.0, qr), plateau * TAU * power(1.0, ql, qr), 1e-12);
}

/// SurfaceTopography 1.27.1, by hand, with `L = 2e-5`:
/// `m = Models.SelfAffine.SelfAffine(cr=1e-29, rolloff_wavelength=L/4, hurst_exponent=0.8, longcut_wavelength=L,`
/// `shortcut_wavelength=L/32)`, then `m.rms_height()`, `sqrt` of `m.variance_derivative(1)` and `(2)`, and
/// `m.variance_derivative(0.5)`, of which E*/4 is the energy of flattening.
#[test]
fn val_moments_of_a_roll_off_are_those_of_surface_topography() {
    let spectrum = Spectrum { rms_height_m: 1.6408860329853951e-9, ..rough(rolled(LENGTH / 4.0)) };
    let moments = spectrum.moments();
    // Its C is 4π² times ours.
    close("plateau", spectrum.density(1), 1e-29 / (4.0 * PI * PI), 1e-12);
    close("slope", moments.rms_slope(), 0.003723050671495667, 1e-12);
    close("Laplacian", moments.rms_curvature_1_m(), 19554.82571912983, 1e-12);
    close("energy", flattening(&spectrum, 4.0).whole_j_m2, 4.788471030694994e-12, 1e-12);
}

#[test]
fn val_a_long_cut_off_begins_at_its_wavelength() {
    let shape = Shape { longest_wavelength_m: Some(LENGTH / 4.0), ..Shape::default() };
    let spectrum = rough(shape);
    assert_eq!(spectrum.density(15), 0.0);
    assert!(spectrum.density(16) > 0.0, "the shell at the longest wavelength is in");
    assert_eq!(spectrum.density(32 * 32), 0.0);
    // A square of the longest wavelength with the same shortest one has the same spectrum.
    let small = Spectrum { length_m: LENGTH / 4.0, magnification: 8, ..rough(Shape::default()) };
    close("density", spectrum.density(16 * 9), small.density(9), 1e-12);
    let [a, b] = [spectrum.moments(), small.moments()];
    close("slope", a.rms_slope(), b.rms_slope(), 1e-12);
    close("energy", flattening(&spectrum, 1.0).whole_j_m2, flattening(&small, 1.0).whole_j_m2, 1e-12);
    assert_eq!(spectrum.band_1_m(), [TAU / (LENGTH / 4.0), 32.0 * TAU / LENGTH]);
}

/// Density of the rule in the guide, written out independently.
fn rule(spectrum: &Spectrum, kx: i64, ky: i64) -> f64 {
    let (hurst, qr) = (spectrum.hurst, TAU / spectrum.shape.roll_off_m.unwrap());
    let ql = TAU / spectrum.length_m;
    let (sin, cos) = spectrum.shape.angle_rad.sin_cos();
    let (x, y) = (ql * kx as f64, ql * ky as f64);
    let (along, across) = (x * cos + y * sin, y * cos - x * sin);
    let r = spectrum.shape.aspect_ratio;
    let q = (r * along * along + across * across / r).sqrt();
    q.max(qr).powf(-2.0 * (hurst + 1.0))
}

#[test]
fn val_heights_are_a_direct_sum_of_modes_of_the_rule() {
    for (aspect_ratio, angle_rad) in [(1.0, 0.0), (3.0, 0.4)] {
        let shape = Shape { aspect_ratio, angle_rad, ..rolled(LENGTH / 3.0) };
        let spectrum = Spectrum { magnification: 8, normalization: Normalization::Sample, ..rough(shape) };
        let plain = Spectrum { shape: Shape::default(), ..spectrum.clone() };
        let n = 32;
        let seed = realization_seed(2021, 3);
        let [made, other] = [&spectrum, &plain].map(|of| synthesize(of, &seed, n).heights_m);
        let mode = |heights: &ndarray::Array2<f64>, kx: i64, ky: i64| {
            let mut sum = [0.0, 0.0];
            for ((i, j), h) in heights.indexed_iter() {
                let (sin, cos) = (-TAU * (kx * i as i64 + ky * j as i64) as f64 / n as f64).sin_cos();
                sum = [sum[0] + h * cos, sum[1] + h * sin];
            }
            sum.map(|part| part / (n * n) as f64)
        };
        let modes: Vec<(i64, i64)> =
            (-7..=7).flat_map(|kx| (-7..=7).map(move |ky| (kx, ky))).filter(|(kx, ky)| (1..64).contains(&(kx * kx + ky * ky))).collect();
        let whole: f64 = modes.iter().map(|(kx, ky)| rule(&spectrum, *kx, *ky)).sum();
        for (kx, ky) in modes {
            let [re, im] = mode(&made, kx, ky);
            let expected = spectrum.rms_height_m * (rule(&spectrum, kx, ky) / whole).sqrt();
            // Sums of 1024 heights of 40 nm, and modes down to a hundredth of them.
            close("modulus", (re * re + im * im).sqrt(), expected, 1e-12);
            let [x, y] = mode(&other, kx, ky);
            let turn = (re * y - im * x) / ((re * re + im * im).sqrt() * (x * x + y * y).sqrt());
            assert!(turn.abs() < 1e-11, "the phases belong to the wavevectors: {turn}");
        }
    }
}

#[test]
fn law_lattice_sums_realised_sums_and_surfaces_agree() {
    let shape = Shape { aspect_ratio: 2.5, angle_rad: 1.1, ..rolled(LENGTH / 5.0) };
    for normalization in [Normalization::Sample, Normalization::Spectrum] {
        let spectrum = Spectrum { normalization, magnification: 16, ..rough(shape.clone()) };
        let seed = realization_seed(7, 0);
        let made = synthesize(&spectrum, &seed, 64);
        let lattice = spectrum.lattice_moments();
        close("m0", made.moments.m0_m2, lattice.m0_m2, 1e-12);
        close("m4", made.moments.m4_1_m2, lattice.m4_1_m2, 1e-12);
        let mean_square = made.heights_m.iter().map(|h| h * h).sum::<f64>() / 4096.0;
        close("heights", mean_square, lattice.m0_m2, 1e-12);
        let [sum] = mode_sums(&spectrum, &seed, |_| [1.0]);
        close("modes", sum, lattice.m0_m2, 1e-12);
        let direct: f64 = (-15..=15i64)
            .flat_map(|kx| (-15..=15i64).map(move |ky| (kx, ky)))
            .map(|(kx, ky)| spectrum.mode_density(kx, ky) * ((kx * kx + ky * ky) as f64).sqrt())
            .sum();
        if normalization == Normalization::Spectrum {
            let expected = 0.25 * direct * (TAU / LENGTH).powi(3);
            close("energy", realised_flattening(&spectrum, &seed, 1.0).whole_j_m2, expected, 1e-12);
        }
    }
}

#[test]
fn val_the_rms_height_of_an_anisotropic_spectrum_is_that_of_its_key() {
    // The integral over a fine polar grid, with the stretch written out.
    let (r, roll_off) = (4.0, LENGTH / 4.0);
    let spectrum = rough(Shape { aspect_ratio: r, angle_rad: 0.3, ..rolled(roll_off) });
    let (ql, qr) = (TAU / LENGTH, TAU / roll_off);
    let (angles, rings) = (2000, 4000);
    let mut sums = [0.0; 3];
    for i in 0..angles {
        let (sin, cos) = (TAU * (f64::from(i) + 0.5) / f64::from(angles)).sin_cos();
        let f = (r * cos * cos + sin * sin / r).sqrt();
        for j in 0..rings {
            let q = ql * 32f64.powf((f64::from(j) + 0.5) / f64::from(rings));
            let c = (q * f).max(qr).powf(-3.6) * q * q * 32f64.ln() / f64::from(rings) * TAU / f64::from(angles);
            sums = [sums[0] + c, sums[1] + c * q, sums[2] + c * q * q];
        }
    }
    let moments = spectrum.moments();
    close("rms height", moments.rms_height_m(), 4e-8, 1e-12);
    // The midpoint rule over kinks at 4000 radii.
    close("rms slope", moments.rms_slope(), 4e-8 * (sums[2] / sums[0]).sqrt(), 2e-6);
    close("energy", flattening(&spectrum, 1.0).whole_j_m2, 0.25 * 1.6e-15 * sums[1] / sums[0], 2e-6);
    // The lay is along its angle: slopes across it are steeper.
    let made = synthesize(&spectrum, &realization_seed(1, 0), 256).heights_m;
    let difference =
        |dx: usize, dy: usize| -> f64 { made.indexed_iter().map(|((i, j), h)| (made[[(i + dx) % 256, (j + dy) % 256]] - h).powi(2)).sum() };
    assert!(difference(1, 0) < difference(0, 1), "the lay at 0.3 rad is near the x axis");
}

/// Rows of a power law.
fn law(exponent: f64, from: f64, to: f64, count: usize) -> Vec<[f64; 2]> {
    (0..count).map(|k| from * (to / from).powf(k as f64 / (count - 1) as f64)).map(|q| [q, q.powf(-exponent)]).collect()
}

fn tabulated(rows: &[[f64; 2]]) -> Shape {
    Shape { table: Some(Arc::new(PsdTable::of(rows).unwrap())), ..Shape::default() }
}

#[test]
fn val_a_table_of_a_roll_off_is_the_roll_off() {
    let spectrum = rough(rolled(LENGTH / 4.0));
    let ql = TAU / LENGTH;
    // Rows at the corner and at both ends: power laws between rows are exact.
    let rows: Vec<[f64; 2]> =
        [1.0, 2.0, 4.0, 9.0, 30.0, 32.0].map(|k: f64| [ql * k, spectrum.density(16) * (k.max(4.0) / 4.0).powf(-3.6)]).to_vec();
    // Neither the rms height nor the Hurst exponent beside a table is read.
    let table = Spectrum { rms_height_m: 1.0, hurst: 0.3, normalization: Normalization::Sample, ..rough(tabulated(&rows)) };
    for k in [1, 2, 5, 16, 17, 100, 1000] {
        close("density", table.density(k), spectrum.density(k), 1e-12);
    }
    let [a, b] = [table.moments(), spectrum.moments()];
    close("rms height", a.rms_height_m(), b.rms_height_m(), 1e-12);
    close("Laplacian", a.rms_curvature_1_m(), b.rms_curvature_1_m(), 1e-12);
    let seed = realization_seed(5, 5);
    let [a, b] = [&table, &spectrum].map(|of| synthesize(of, &seed, 128).heights_m);
    let worst = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-12 * 4e-8, "the same heights: {worst}");
    let known = PsdTable::of(&rows).unwrap();
    assert_eq!(known.range_1_m(), [ql, 32.0 * ql]);
    assert_eq!(known.density_m4(0.9 * ql), 0.0, "zero below the table");
    assert_eq!(known.density_m4(33.0 * ql), 0.0, "zero beyond it");
    close("at the last row", known.density_m4(32.0 * ql), rows[5][1], 1e-12);
    assert_eq!(known.rows().count(), 6);
    // A band that ends at 16: the rest of the table is left out.
    let part = Spectrum { magnification: 16, ..table.clone() };
    let whole = |of: &Spectrum| flattening(of, 1.0).whole_j_m2;
    close("left out", part.left_out_m(), whole(&table) - whole(&part), 1e-12);
    assert_eq!(spectrum.left_out_m(), 0.0, "a power law ends at its shortest wavelength");
}

#[test]
fn val_a_tabulated_spectrum_is_the_mean_of_its_realizations() {
    let ql = TAU / LENGTH;
    let rows: Vec<[f64; 2]> =
        (0..=12).map(|k| ql * 0.9 * 2f64.powf(0.5 * f64::from(k))).map(|q| [q, 1e-31 / (1.0 + (q / (5.0 * ql)).powi(4))]).collect();
    let spectrum = Spectrum { amplitudes: Amplitudes::Gaussian, ..rough(tabulated(&rows)) };
    let count = 48;
    let found: Vec<Vec<_>> = (0..count)
        .map(|k| {
            let made = synthesize(&spectrum, &realization_seed(99, k), 64);
            periodogram(made.heights_m.view(), LENGTH).unwrap()
        })
        .collect();
    let mut ratios = 0.0;
    let mut rings = 0.0;
    for (ring, first) in found[0].iter().enumerate() {
        // Whole rings below the band's edge at mode 32.
        if first.wavenumber_1_m > 26.0 * ql {
            continue;
        }
        let (mut expected, mut modes) = (0.0, 0.0);
        for kx in -40i64..=40 {
            for ky in -40i64..=40 {
                let mode = ((kx * kx + ky * ky) as f64).sqrt();
                if mode > 0.0 && (4.0 * mode.log2()).round() == (4.0 * (first.wavenumber_1_m / ql).log2()).round() {
                    let q = ql * mode;
                    let at = rows.windows(2).find(|pair| q < pair[1][0]).unwrap();
                    let slope = (at[1][1] / at[0][1]).ln() / (at[1][0] / at[0][0]).ln();
                    expected += at[0][1] * (q / at[0][0]).powf(slope);
                    modes += 1.0;
                }
            }
        }
        assert_eq!(modes as u64, first.mode_count);
        let mean = found.iter().map(|rings| rings[ring].density_m4).sum::<f64>() / count as f64;
        // Powers are exponential variates, of which half the modes are independent; rings of a steep spectrum have
        // somewhat more scatter.
        let error = (2.0 / (modes * count as f64)).sqrt() * 1.1;
        let ratio = mean * modes / expected;
        assert!((ratio - 1.0).abs() < 4.0 * error, "ring {ring}: {ratio} ± {error}");
        ratios += ((ratio - 1.0) / error).powi(2);
        rings += 1.0;
    }
    // Chi squared over about 19 rings: its mean is 1 with a standard deviation of 0.33.
    assert!((0.3..2.3).contains(&(ratios / rings)), "{}", ratios / rings);
}

#[test]
fn val_abels_inversion_restores_the_spectrum_of_a_profile() {
    // C = (q² + a²)^(−s): C1(p) = ∫ C dq_y over all q_y = √π Γ(s − ½)/Γ(s) (p² + a²)^(½ − s). With s = 2, Γ(3/2) = √π/2.
    let (a, s) = (3e6_f64, 2.0);
    let rows: Vec<[f64; 2]> = law(0.0, 1e5, 1e9, 400).into_iter().map(|[p, _]| [p, 0.5 * PI * (p * p + a * a).powf(0.5 - s)]).collect();
    let table = PsdTable::of_profile(&rows).unwrap();
    for [q, density] in table.rows() {
        // Power laws between rows a fortieth of a decade apart.
        close("density", density, (q * q + a * a).powf(-s), 2e-3);
    }
    // A power law is restored to rounding of the quadrature: C1 = √π Γ(H + ½)/Γ(H + 1) q^(−1−2H) for H = ½: 2 q^(−2).
    let table = PsdTable::of_profile(&law(2.0, 1e5, 1e8, 20)).unwrap();
    for [q, density] in table.rows() {
        close("power law", density, 0.5 * q.powi(-3), 1e-9);
    }
}

#[test]
fn law_a_bad_table_is_refused_at_its_row() {
    let good = [[1e6, 1e-30], [2e6, 1e-31], [4e6, 1e-32]];
    let with = |row: usize, values: [f64; 2]| {
        let mut rows = good;
        rows[row] = values;
        PsdTable::of(&rows).unwrap_err()
    };
    let cases = [
        (with(1, [2e6, -1e-31]), 1, "C is"),
        (with(1, [2e6, 0.0]), 1, "C is"),
        (with(0, [f64::NAN, 1e-30]), 0, "q is NaN"),
        (with(2, [4e6, f64::NAN]), 2, "C is NaN"),
        (with(2, [4e6, f64::INFINITY]), 2, "C is inf"),
        (with(1, [1e6, 1e-31]), 1, "twice"),
        (with(2, [1.5e6, 1e-32]), 2, "ascend"),
        (with(2, [2e6 * MAX_GAP * 1.001, 1e-32]), 2, "gap"),
        (PsdTable::of(&good[..1]).unwrap_err(), 1, "at least two"),
        (PsdTable::of_profile(&[[1e6, 1e-20], [2e6, 2e-20]]).unwrap_err(), 1, "does not decrease"),
        (PsdTable::of_profile(&[[1e6, 1e-24], [2e6, 9e-20], [4e6, 8e-20]]).unwrap_err(), 0, "not positive"),
    ];
    for (fault, row, word) in cases {
        assert_eq!(fault.row, row, "{fault:?}");
        assert!(fault.problem.contains(word), "{fault:?} for {word}");
    }
    assert!(PsdTable::of(&good).is_ok());
}

#[test]
fn law_the_default_shape_is_eq_10() {
    let spectrum = paper_spectrum(0.8, 64);
    assert!(spectrum.shape.is_plain() && spectrum.shape.is_isotropic());
    assert!(!rolled(1e-6).is_plain());
    // A roll-off at L has no plateau: the general formulas give Eq 10.
    let general = Spectrum { shape: rolled(spectrum.length_m), ..spectrum };
    close("prefactor", general.prefactor(), spectrum.prefactor(), 1e-12);
    close("density", general.mode_density(3, -4), spectrum.density(25), 1e-12);
    close("slope", general.moments().rms_slope(), spectrum.moments().rms_slope(), 1e-12);
    close("lattice", general.lattice_moments().m4_1_m2, spectrum.lattice_moments().m4_1_m2, 1e-12);
    let energy = |of: &Spectrum| flattening(of, 1e6).octave_j_m2;
    close("octave", energy(&general), energy(&spectrum), 1e-12);
}
