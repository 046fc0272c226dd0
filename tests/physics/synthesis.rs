//! Heights from phases: the realised surface has the spectrum that it is made from, mode by mode.

use crate::support::{RMS, close, near, paper_spectrum, surface};
use hysteron::model::{Amplitudes, Normalization};
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{Surface, realization_seed, synthesize};
use rustfft::{FftPlanner, num_complex::Complex64};

/// The modes `c_k = (1/n²) Σ h exp(−i k·x)` of a surface, by columns and rows of a plain complex transform.
struct Modes {
    n: usize,
    values: Vec<Complex64>,
}

impl Modes {
    fn of(surface: &Surface) -> Self {
        let n = surface.heights_m.nrows();
        let transform = FftPlanner::<f64>::new().plan_fft_forward(n);
        let mut rows: Vec<Complex64> = surface.heights_m.iter().map(|h| Complex64::new(*h, 0.0)).collect();
        transform.process(&mut rows);
        let mut columns: Vec<Complex64> = (0..n * n).map(|k| rows[(k % n) * n + k / n]).collect();
        transform.process(&mut columns);
        let cells = (n * n) as f64;
        Self { n, values: columns.into_iter().map(|c| c / cells).collect() }
    }

    /// The mode of row number kx and column number ky.
    fn at(&self, kx: i64, ky: i64) -> Complex64 {
        let place = |k: i64| k.rem_euclid(self.n as i64) as usize;
        self.values[place(ky) * self.n + place(kx)]
    }

    /// Every (kx, ky) of the transform.
    fn all(&self) -> impl Iterator<Item = (i64, i64)> {
        let half = self.n as i64 / 2;
        (-half..half).flat_map(move |kx| (-half..half).map(move |ky| (kx, ky)))
    }
}

/// Half a plane of wavevectors below `zeta`: each mode once.
fn half_plane(zeta: i64) -> impl Iterator<Item = (i64, i64)> {
    (1 - zeta..zeta)
        .flat_map(move |kx| (0..zeta).map(move |ky| (kx, ky)))
        .filter(move |(kx, ky)| (*ky > 0 || *kx > 0) && kx * kx + ky * ky < zeta * zeta)
}

fn raw(zeta: u32) -> Spectrum {
    Spectrum { normalization: Normalization::Spectrum, ..paper_spectrum(0.8, zeta) }
}

#[test]
fn law_realised_rms_is_exact_and_the_mean_zero() {
    for (zeta, points, realization) in [(8, 2, 0), (8, 4, 1), (16, 8, 2), (64, 4, 3)] {
        for amplitudes in [Amplitudes::Fixed, Amplitudes::Gaussian] {
            let made = surface(&Spectrum { amplitudes, ..paper_spectrum(0.8, zeta) }, realization, points);
            let cells = made.heights_m.len() as f64;
            let square = made.heights_m.iter().map(|h| h * h).sum::<f64>() / cells;
            // Sums of some 1e4 to 1e5 squares, and the transform's own rounding.
            close("mean square", square, RMS * RMS, 1e-12);
            near("mean", made.heights_m.iter().sum::<f64>() / cells, 0.0, 1e-14 * RMS);
            close("its own moment", made.moments.rms_height_m(), RMS, 1e-14);
        }
    }
}

#[test]
fn law_every_mode_has_the_power_of_the_spectrum() {
    for points in [2, 4] {
        let spectrum = raw(9);
        let made = surface(&spectrum, 0, points);
        let modes = Modes::of(&made);
        let cell = spectrum.lowest_wavenumber().powi(2);
        let mut seen = 0;
        for (kx, ky) in modes.all() {
            let want = spectrum.density((kx * kx + ky * ky).unsigned_abs()) * cell;
            seen += usize::from(want > 0.0);
            // Rounding of heights of some RMS in each mode, which matters where the mode is weak. The line ky = 0 is in here, whose
            // modes (kx, 0) and (−kx, 0) have the full amplitude each: adding both halves of a real line makes them 2|cos φ| of it.
            near("|c|", modes.at(kx, ky).norm(), want.sqrt(), 1e-12 * want.sqrt() + 1e-15 * RMS);
        }
        assert_eq!(seen, 2 * half_plane(9).count(), "every mode below q1 fits on {points} points to the shortest wavelength");
        // The realised moments are those of the modes.
        close("m0", made.moments.m0_m2, modes.values.iter().map(|c| c.norm_sqr()).sum(), 1e-12);
        close("lattice", made.moments.m4_1_m2, spectrum.lattice_moments().m4_1_m2, 1e-12);
    }
}

#[test]
fn law_real_lines_and_the_nyquist_lines() {
    let n = 2 * 9;
    let made = surface(&raw(9), 1, 2);
    let modes = Modes::of(&made);
    assert_eq!(made.heights_m.nrows(), n);
    for k in -9i64..9 {
        // The finest grid number is q1 itself: outside the band.
        near("Nyquist row", modes.at(-9, k).norm(), 0.0, 1e-15 * RMS);
        near("Nyquist column", modes.at(k, -9).norm(), 0.0, 1e-15 * RMS);
    }
    let mut phases = Vec::new();
    for k in 1..9 {
        for (kx, ky) in [(k, 0), (0, k)] {
            let (plus, minus) = (modes.at(kx, ky), modes.at(-kx, -ky));
            near("conjugate", (plus - minus.conj()).norm(), 0.0, 1e-15 * RMS);
            phases.push(plus.arg());
        }
    }
    // Real lines are no real modes: their phases are as free as any.
    assert!(phases.iter().filter(|p| p.sin().abs() > 0.1).count() > 8, "{phases:?}");
    near("mean mode", modes.at(0, 0).norm(), 0.0, 1e-15 * RMS);
}

#[test]
fn law_a_higher_magnification_keeps_the_modes_that_it_shares() {
    let (low, high) = (raw(32), raw(64));
    let (a, b) = (Modes::of(&surface(&low, 4, 2)), Modes::of(&surface(&high, 4, 2)));
    let unit = |spectrum: &Spectrum| spectrum.prefactor().sqrt();
    for (kx, ky) in half_plane(32) {
        let (p, q) = (a.at(kx, ky) / unit(&low), b.at(kx, ky) / unit(&high));
        // Rounding of the heights, relative to the weakest of the shared modes: 32^1.8 = 512 times below the first.
        near("mode", (p - q).norm(), 0.0, 1e-12 * p.norm());
    }
    // And beyond them only the rougher one has something.
    near("beyond", a.at(32, 0).norm(), 0.0, 1e-15 * RMS);
    assert!(b.at(32, 0).norm() > 1e-6 * RMS);
}

#[test]
fn law_another_exponent_keeps_the_phases() {
    let make = |hurst, amplitudes| Modes::of(&surface(&Spectrum { amplitudes, ..paper_spectrum(hurst, 16) }, 5, 2));
    let modes = [make(0.8, Amplitudes::Fixed), make(0.45, Amplitudes::Fixed), make(0.95, Amplitudes::Gaussian)];
    let mut compared = 0;
    for (kx, ky) in half_plane(16) {
        let [p, q, r] = [0, 1, 2].map(|k| modes[k].at(kx, ky));
        near("phase", (p / p.norm() - q / q.norm()).norm(), 0.0, 1e-11);
        // A Rayleigh modulus may be as small as it likes, and its phase as ill determined.
        if r.norm() > 1e-5 * RMS {
            near("phase, Gaussian", (p / p.norm() - r / r.norm()).norm(), 0.0, 1e-9);
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}

#[test]
fn law_two_grids_sample_one_surface() {
    let coarse = surface(&paper_spectrum(0.8, 16), 6, 8);
    for (points, stride) in [(16, 2), (24, 3)] {
        let fine = surface(&paper_spectrum(0.8, 16), 6, points);
        for ((i, j), h) in coarse.heights_m.indexed_iter() {
            // Two transforms of different lengths: log2(n) roundings of the rms height.
            near("height", fine.heights_m[[stride * i, stride * j]], *h, 2e-14 * RMS);
        }
    }
}

/// |mean of exp(iφ)| over N independent uniform phases is below 4/√N but once in 1e7.
fn incoherent(what: &str, phasors: &[Complex64]) {
    let mean = phasors.iter().sum::<Complex64>() / phasors.len() as f64;
    assert!(mean.norm() < 4.0 / (phasors.len() as f64).sqrt(), "{what}: {mean}");
}

#[test]
fn law_phases_are_uniform_and_independent() {
    let [a, b] = [7, 8].map(|r| Modes::of(&surface(&raw(32), r, 2)));
    let unit = |modes: &Modes, kx, ky| modes.at(kx, ky) / modes.at(kx, ky).norm();
    let over = |f: &dyn Fn(i64, i64) -> Complex64| half_plane(31).map(|(kx, ky)| f(kx, ky)).collect::<Vec<_>>();
    incoherent("phases", &over(&|x, y| unit(&a, x, y)));
    incoherent("twice the phases", &over(&|x, y| unit(&a, x, y).powi(2)));
    incoherent("two realisations", &over(&|x, y| unit(&a, x, y) * unit(&b, x, y).conj()));
    // Two rows of wavevectors with one stream would show here; and ±kx, whose streams lie next to each other.
    let inner = |f: &dyn Fn(i64, i64) -> Complex64| {
        half_plane(31).filter(|(x, y)| x * x + (y + 1) * (y + 1) < 900 && *y > 0).map(|(x, y)| f(x, y)).collect::<Vec<_>>()
    };
    incoherent("neighbours along ky", &inner(&|x, y| unit(&a, x, y) * unit(&a, x, y + 1).conj()));
    incoherent("neighbours along kx", &inner(&|x, y| unit(&a, x, y) * unit(&a, if x > 0 { x - 1 } else { x + 1 }, y).conj()));
    let mirrored: Vec<Complex64> =
        half_plane(31).filter(|(x, y)| *x > 0 && *y > 0).map(|(x, y)| unit(&a, x, y) * unit(&a, -x, y).conj()).collect();
    incoherent("mirrored wavevectors", &mirrored);
    let swapped: Vec<Complex64> =
        half_plane(31).filter(|(x, y)| x > y && *y > 0).map(|(x, y)| unit(&a, x, y) * unit(&a, y, x).conj()).collect();
    incoherent("kx and ky exchanged", &swapped);
}

#[test]
fn law_gaussian_amplitudes_are_rayleigh() {
    let spectrum = Spectrum { amplitudes: Amplitudes::Gaussian, ..raw(32) };
    let cell = spectrum.lowest_wavenumber().powi(2);
    let mut ratios = Vec::new();
    for realization in 0..3 {
        let modes = Modes::of(&surface(&spectrum, realization, 2));
        ratios.extend(
            half_plane(32).map(|(kx, ky)| modes.at(kx, ky).norm_sqr() / (cell * spectrum.density((kx * kx + ky * ky).unsigned_abs()))),
        );
    }
    let n = ratios.len() as f64;
    let mean = |f: &dyn Fn(f64) -> f64| ratios.iter().map(|r| f(*r)).sum::<f64>() / n;
    // The power of a Rayleigh modulus is exponential: mean 1 and variance 1, mean square 2 with variance 4! − 4, and e^(−t) lies above t.
    // Four standard errors each.
    near("mean", mean(&|r| r), 1.0, 4.0 / n.sqrt());
    near("mean square", mean(&|r| r * r), 2.0, 4.0 * (20.0 / n).sqrt());
    for t in [0.1f64, 1.0, 3.0] {
        let p = (-t).exp();
        near("tail", mean(&|r| f64::from(u8::from(r > t))), p, 4.0 * (p * (1.0 - p) / n).sqrt());
    }
}

#[test]
fn reg_seeds_of_realisations() {
    let seeds: Vec<[u8; 32]> = [(2021, 0), (2021, 1), (2022, 0), (0, 2021)].map(|(c, r)| realization_seed(c, r)).to_vec();
    for (i, a) in seeds.iter().enumerate() {
        assert!(seeds.iter().skip(i + 1).all(|b| a != b), "{i}");
    }
    // A surface is a function of its seed: the same twice, and of another seed another.
    let make = |seed: &[u8; 32]| synthesize(&raw(8), seed, 16);
    assert_eq!(make(&seeds[0]), make(&seeds[0]));
    assert_ne!(make(&seeds[0]).heights_m, make(&seeds[1]).heights_m);
}
