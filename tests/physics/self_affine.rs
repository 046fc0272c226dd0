//! Fit of a self-affine spectrum: bands without data, roll-off, filters, noise, and both ways to continue a scan.

use hysteron::model::{Detrend, Filter, Missing, SpectrumEnd};
use hysteron::physics::surface::measured::{Treatment, prepare};
use hysteron::physics::surface::self_affine::SelfAffine;
use ndarray::{Array2, s};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;
use std::f64::consts::{LN_2, TAU};

/// Generator of numbers without a library: PCG's linear congruence, its upper bits.
struct Numbers(u64);

impl Numbers {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// A normal variate (Box and Muller).
    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// A periodic Gaussian surface of unit side and unit rms height on n² points, with the spectral density of a mode number.
fn surface(n: usize, seed: u64, density: &dyn Fn(f64) -> f64) -> Array2<f64> {
    let mut numbers = Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let mut field = Array2::from_shape_simple_fn((n, n), || Complex64::new(numbers.normal(), 0.0));
    let mut planner = FftPlanner::new();
    let transform = |field: &mut Array2<Complex64>, plan: &std::sync::Arc<dyn rustfft::Fft<f64>>| {
        for _ in 0..2 {
            let mut lines: Vec<Complex64> = field.iter().copied().collect();
            lines.chunks_mut(n).for_each(|line| plan.process(line));
            *field = Array2::from_shape_vec((n, n), lines).unwrap().reversed_axes().as_standard_layout().to_owned();
        }
    };
    transform(&mut field, &planner.plan_fft_forward(n));
    let wave = |k: usize| k.min(n - k) as f64;
    field.indexed_iter_mut().for_each(|((i, j), value)| {
        let mode = wave(i).hypot(wave(j));
        *value *= if mode > 0.0 { density(mode).sqrt() } else { 0.0 };
    });
    transform(&mut field, &planner.plan_fft_inverse(n));
    let heights = field.mapv(|value| value.re);
    let rms = heights.mapv(|h| h * h).mean().unwrap().sqrt();
    heights / rms
}

fn fit(heights: Array2<f64>, periodic: bool, points: f64) -> SelfAffine {
    let spacing = 1.0 / heights.nrows() as f64;
    let detrend = if periodic { Detrend::Mean } else { Detrend::Plane };
    let treatment =
        Treatment { missing: Missing::Refuse, detrend, periodic, filter: Filter::Gaussian, points_per_shortest_wavelength: points };
    prepare(heights, [spacing; 2], &treatment).unwrap().fit.unwrap()
}

/// The upper left quarter, which does not continue periodically; its mode numbers are half of those of the whole.
fn quarter(heights: &Array2<f64>) -> Array2<f64> {
    let n = heights.nrows() / 2;
    heights.slice(s![..n, ..n]).to_owned()
}

const HURST: [f64; 4] = [0.3, 0.5, 0.8, 1.0];

fn power(hurst: f64, mode: f64) -> f64 {
    mode.powf(-2.0 * (hurst + 1.0))
}

/// Long and short cut as mode numbers.
fn cuts(fit: &SelfAffine) -> (Option<f64>, Option<(f64, SpectrumEnd)>) {
    (fit.long_cut_1_m.map(|q| q / TAU), fit.short_cut.map(|cut| (cut.wavenumber_1_m / TAU, cut.cause)))
}

fn near(value: f64, wanted: f64, tolerance: f64) -> bool {
    (value / wanted).ln().abs() < tolerance
}

/// The mean of H over four surfaces is within 0.05, and each within 0.15: the standard deviation of one is 0.02 to 0.05, by the number of its modes.
fn holds(hurst: f64, fits: &[SelfAffine]) {
    let mean = fits.iter().map(|fit| fit.hurst).sum::<f64>() / fits.len() as f64;
    assert!((mean - hurst).abs() < 0.05, "{hurst}: {mean}, {fits:?}");
    assert!(fits.iter().all(|fit| (fit.hurst - hurst).abs() < 0.15), "{hurst}: {fits:?}");
}

const SEEDS: std::ops::Range<u64> = 1..5;

#[test]
fn val_wavelengths_that_a_sharp_filter_removed_are_no_data() {
    // Modes 8 to 64 of 256: two thirds of the rings are at rounding level.
    for hurst in HURST {
        let band = |mode: f64| if (8.0..64.0).contains(&mode) { power(hurst, mode) } else { 0.0 };
        let fits: Vec<SelfAffine> = SEEDS.map(|seed| fit(surface(256, seed, &band), true, 8.0)).collect();
        holds(hurst, &fits);
        for fit in &fits {
            let (long, short) = cuts(fit);
            assert!(long.is_some_and(|mode| near(mode, 8.0, 0.1)), "{fit:?}");
            assert!(short.is_some_and(|(mode, cause)| near(mode, 64.0, 0.06) && cause == SpectrumEnd::Empty), "{fit:?}");
        }
    }
}

#[test]
fn val_a_cut_off_beyond_the_end_of_the_spectrum_changes_nothing() {
    let band = |mode: f64| if mode < 32.0 { power(0.8, mode) } else { 0.0 };
    let heights = surface(256, 2, &band);
    let found: Vec<SelfAffine> = [16.0, 8.0, 4.0, 3.0].map(|points| fit(heights.clone(), true, points)).into();
    assert!(found.iter().all(|fit| *fit == found[0]));
    assert!((found[0].hurst - 0.8).abs() < 0.15 && found[0].long_cut_1_m.is_none(), "{found:?}");
    assert!(cuts(&found[0]).1.is_some_and(|(mode, _)| near(mode, 32.0, 0.06)), "{found:?}");
}

#[test]
fn val_a_scan_is_fitted_between_its_own_cuts() {
    for hurst in HURST {
        let band = |mode: f64| if (16.0..128.0).contains(&mode) { power(hurst, mode) } else { 0.0 };
        let fits: Vec<SelfAffine> = SEEDS.map(|seed| fit(quarter(&surface(512, seed, &band)), false, 8.0)).collect();
        holds(hurst, &fits);
        for fit in &fits {
            let (long, short) = cuts(fit);
            // Leakage of the tapers moves a cut by a mode.
            assert!(long.is_some_and(|mode| near(mode, 8.0, 0.2)), "{fit:?}");
            assert!(short.is_some_and(|(mode, _)| near(mode, 64.0, 0.06)), "{fit:?}");
        }
    }
}

#[test]
fn val_a_roll_off_is_found() {
    for hurst in HURST {
        let sharp = |mode: f64| power(hurst, mode.max(16.0));
        let smooth = |mode: f64| if mode < 128.0 { (1.0 + (mode / 16.0).powi(2)).powf(-1.0 - hurst) } else { 0.0 };
        let sharp: [Vec<SelfAffine>; 2] = [
            SEEDS.map(|seed| fit(surface(256, seed, &sharp), true, 8.0)).collect(),
            SEEDS.map(|seed| fit(quarter(&surface(512, seed, &sharp)), false, 8.0)).collect(),
        ];
        for (fits, mode) in sharp.iter().zip([16.0, 8.0]) {
            holds(hurst, fits);
            assert!(fits.iter().all(|fit| fit.rolls_off && near(fit.roll_off_1_m / TAU, mode, 0.25)), "{fits:?}");
        }
        let smooth: Vec<SelfAffine> = SEEDS.map(|seed| fit(quarter(&surface(512, seed, &smooth)), false, 8.0)).collect();
        let mean = smooth.iter().map(|fit| fit.hurst).sum::<f64>() / smooth.len() as f64;
        // Near the corner a sharp roll-off fits too, with a smaller exponent.
        assert!((mean - hurst).abs() < 0.08, "{hurst}: {smooth:?}");
        // A Gaussian L-filter has a similar spectrum.
        let found = smooth.iter().filter(|fit| fit.rolls_off && near(fit.roll_off_1_m / TAU, 8.0, 0.3)).count();
        assert!(found >= 3, "{smooth:?}");
    }
}

#[test]
fn val_a_gaussian_filter_is_corrected() {
    // ISO 16610-61: half of the amplitude at the cut-off, a quarter of the power.
    for hurst in HURST {
        let short = |mode: f64| power(hurst, mode) * (-2.0 * LN_2 * (mode / 32.0).powi(2)).exp();
        let fits: Vec<SelfAffine> = SEEDS.map(|seed| fit(surface(256, seed, &short), true, 8.0)).collect();
        holds(hurst, &fits);
        for fit in &fits {
            assert!(cuts(fit).1.is_some_and(|(mode, cause)| near(mode, 32.0, 0.1) && cause == SpectrumEnd::GaussianFilter), "{fit:?}");
        }
        let long = |mode: f64| power(hurst, mode) * (-(-LN_2 * (mode / 8.0).powi(2)).exp_m1()).powi(2);
        let fits: Vec<SelfAffine> = SEEDS.map(|seed| fit(surface(256, seed, &long), true, 8.0)).collect();
        holds(hurst, &fits);
        assert!(fits.iter().all(|fit| cuts(fit).0.is_some_and(|mode| near(mode, 8.0, 0.1))), "{fits:?}");
    }
}

#[test]
fn val_white_noise_is_no_roughness() {
    for hurst in [0.5, 0.8, 1.0] {
        let noisy = |seed: u64| {
            let mut numbers = Numbers(1000 + seed);
            surface(512, seed, &|mode| power(hurst, mode)).mapv(|h| h + 0.03 * numbers.normal())
        };
        let scans: Vec<SelfAffine> = SEEDS.map(|seed| fit(quarter(&noisy(seed)), false, 8.0)).collect();
        holds(hurst, &scans);
        let noise = |fit: &SelfAffine| fit.short_cut.is_some_and(|cut| cut.cause == SpectrumEnd::WhiteNoise);
        // At H = 0.5 the spectrum ends above the noise.
        assert!(hurst < 0.6 || scans.iter().all(noise), "{scans:?}");
    }
}

#[test]
fn val_a_periodic_field_that_is_not_declared_as_such_needs_no_taper() {
    // Modes 2 to 16 of 64: a taper would leave seven rings.
    for hurst in HURST {
        let band = |mode: f64| if (2.0..16.0).contains(&mode) { power(hurst, mode) } else { 0.0 };
        let heights = surface(64, 5, &band);
        let [declared, not] = [true, false].map(|periodic| fit(heights.clone(), periodic, 8.0));
        assert!((declared.hurst - not.hurst).abs() < 1e-6, "{declared:?} {not:?}");
    }
}

#[test]
fn law_noise_alone_is_not_self_affine() {
    let mut numbers = Numbers(7);
    let noise = Array2::from_shape_simple_fn((128, 128), || numbers.normal());
    assert!(fit(noise, false, 8.0).hurst < -0.5);
}
