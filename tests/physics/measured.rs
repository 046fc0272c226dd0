//! Measured surfaces: what is done to them, and what is told of them.

use crate::support::square;
use hysteron::model::{Amplitudes, Detrend, Filter, Missing, Normalization};
use hysteron::physics::PhysicsError;
use hysteron::physics::surface::edges::Edges;
use hysteron::physics::surface::measured::{Prepared, Treatment, find_measured, prepare, square_side};
use hysteron::physics::surface::periodogram::{Estimate, periodogram, windowed_periodogram};
use hysteron::physics::surface::self_affine::fit_self_affine;
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::summits::find_summits;
use hysteron::physics::surface::synthesis::{Surface, realization_seed, synthesize};
use ndarray::{Array2, s};
use std::f64::consts::{PI, TAU};

const PLAIN: Treatment = Treatment {
    missing: Missing::Refuse,
    detrend: Detrend::Mean,
    periodic: false,
    filter: Filter::Sharp,
    points_per_shortest_wavelength: 8.0,
};

fn generated(magnification: u32, hurst: f64, realization: u64) -> Surface {
    let spectrum = Spectrum {
        length_m: 1e-3,
        rms_height_m: 5e-6,
        hurst,
        magnification,
        normalization: Normalization::Spectrum,
        amplitudes: Amplitudes::Fixed,
        shape: Shape::default(),
    };
    synthesize(&spectrum, &realization_seed(11, realization), 8 * magnification as usize)
}

/// Points of unit distance.
fn unit(heights: &Array2<f64>, treatment: &Treatment) -> Prepared {
    prepare(heights.clone(), [1.0, 1.0], treatment).unwrap()
}

fn most(heights: &Array2<f64>) -> f64 {
    heights.iter().fold(0.0, |most, h| most.max(h.abs()))
}

#[test]
fn law_a_band_limited_periodic_surface_is_left_as_it_is() {
    let surface = generated(16, 0.8, 0);
    let n = surface.heights_m.nrows();
    let spacing = surface.length_m / n as f64;
    let treatment = Treatment { periodic: true, ..PLAIN };
    let prepared = prepare(surface.heights_m.clone(), [spacing; 2], &treatment).unwrap();
    // Rounding of two transforms.
    assert!(most(&(&prepared.heights_m - &surface.heights_m)) < 1e-12 * most(&surface.heights_m));
    let [mine, theirs] = [prepared.moments, surface.moments];
    for (a, b) in [(mine.m0_m2, theirs.m0_m2), (mine.m2, theirs.m2), (mine.m4_1_m2, theirs.m4_1_m2)] {
        assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
    }
    assert!(prepared.noise_m < 1e-6 * theirs.rms_height_m());
    let (found, edge) = find_measured(square(&prepared, Edges::Periodic), 8.0).unwrap();
    let plain = find_summits(surface.heights_m.view(), surface.length_m, 8.0).unwrap();
    assert_eq!((found.list.len(), edge), (plain.list.len(), 0));
}

#[test]
fn law_short_waves_are_taken_off_and_counted() {
    let n = 64;
    let wave = |modes: f64, amplitude: f64| Array2::from_shape_fn((n, n), |(i, _)| amplitude * (TAU * modes * i as f64 / n as f64).cos());
    // Waves of 16 points stay, those of 8 and of 4 go.
    let heights = wave(4.0, 1.0) + wave(8.0, 0.5) + wave(16.0, 0.25);
    let prepared = unit(&heights, &Treatment { periodic: true, ..PLAIN });
    assert!(most(&(&prepared.heights_m - &wave(4.0, 1.0))) < 1e-12);
    let noise = (0.5f64 * (0.25 + 0.0625)).sqrt();
    assert!((prepared.noise_m - noise).abs() < 1e-9, "{} {noise}", prepared.noise_m);
}

#[test]
fn law_mirror_images_continue_a_surface_without_a_jump() {
    let n = 96;
    // Cosines of whole half waves are their own mirror images.
    let (a, b) = (3.0, 4.0);
    let at = |k: usize| PI * (k as f64 + 0.5) / n as f64;
    let heights = Array2::from_shape_fn((n, n), |(i, j)| (a * at(i)).cos() * (b * at(j)).cos());
    let prepared = unit(&heights, &PLAIN);
    assert!(most(&(&prepared.heights_m - &heights)) < 1e-12);
    let q2 = (a * a + b * b) * (PI / n as f64).powi(2);
    let moments = prepared.moments;
    // Slopes and Laplacians are means over the points farther than 4 points from the edges: here that changes them by 1 % and 15 %.
    for (found, expected, allowed) in
        [(moments.m0_m2, 0.25, 1e-10), (moments.m2, 0.125 * q2, 0.02), (moments.m4_1_m2, 0.375 * 0.25 * q2 * q2, 0.2)]
    {
        assert!((found / expected - 1.0).abs() < allowed, "{found} {expected}");
    }
    // Summits where both cosines are 1 or both are −1. The point reflection at the edges makes no maxima there.
    let (found, edge) = find_measured(square(&prepared, Edges::Open), 8.0).unwrap();
    let mut inside: Vec<[f64; 2]> = Vec::new();
    for i in 1..3 {
        for j in 1..4 {
            if (i + j) % 2 == 0 {
                inside.push([f64::from(i) / a * n as f64 - 0.5, f64::from(j) / b * n as f64 - 0.5]);
            }
        }
    }
    assert_eq!(found.list.len(), inside.len());
    for (summit, expected) in found.list.iter().zip(&inside) {
        assert!((summit.x_m - expected[0]).abs() < 1e-6 && (summit.y_m - expected[1]).abs() < 1e-6, "{summit:?} {expected:?}");
        assert!((summit.height_m - 1.0).abs() < 1e-10);
        assert!((summit.curvature_1_m / (0.5 * q2) - 1.0).abs() < 1e-9);
    }
    assert_eq!(edge, 0);
}

#[test]
fn law_a_trend_goes_and_nothing_else() {
    let n = 80;
    let at = |k: usize| (2 * k + 1) as f64 / n as f64 - 1.0;
    // A product of cosines over whole half waves, even ones, which no plane has a part of.
    let rough = Array2::from_shape_fn((n, n), |(i, j)| (4.0 * PI * at(i)).cos() * (3.0 * PI * at(j)).cos());
    let plane = Array2::from_shape_fn((n, n), |(i, j)| 7.0 + 3.0 * at(i) - 2.0 * at(j));
    let bow = Array2::from_shape_fn((n, n), |(i, j)| at(i) * at(i) - 0.5 * at(i) * at(j));
    let tilted = unit(&(&rough + &plane), &Treatment { detrend: Detrend::Plane, ..PLAIN });
    let bowed = unit(&(&rough + &plane + &bow), &Treatment { detrend: Detrend::Quadratic, ..PLAIN });
    let alone = unit(&rough, &PLAIN);
    assert!(most(&(&tilted.heights_m - &alone.heights_m)) < 1e-11);
    let curved = unit(&rough, &Treatment { detrend: Detrend::Quadratic, ..PLAIN });
    assert!(most(&(&bowed.heights_m - &curved.heights_m)) < 1e-11);
    let rms = |field: Array2<f64>| {
        let mean = field.mean().unwrap();
        field.mapv(|h| (h - mean).powi(2)).mean().unwrap().sqrt()
    };
    assert!((tilted.trend_m / rms(plane) - 1.0).abs() < 1e-10);
    assert_eq!(alone.trend_m, 0.0);
}

#[test]
fn law_missing_points_continue_what_is_around_them() {
    let n = 48;
    // Without a discrete Laplacian, so that the membrane is this very field.
    let heights = Array2::from_shape_fn((n, n), |(i, j)| {
        let (x, y) = (i as f64 - 20.0, j as f64 - 25.0);
        x * x - y * y + 3.0 * x * y
    });
    let mut holed = heights.clone();
    holed.slice_mut(s![10..22, 15..23]).fill(f64::NAN);
    holed[[30, 40]] = f64::NAN;
    let treatment = Treatment { missing: Missing::Fill, points_per_shortest_wavelength: 2.0, ..PLAIN };
    let (filled, whole) = (unit(&holed, &treatment), unit(&heights, &treatment));
    assert_eq!(filled.missing_count, 12 * 8 + 1);
    // It stops where nothing moves by a millionth of the range; what is left to move is a few times that.
    let range = 2.0 * most(&heights);
    assert!(most(&(&filled.heights_m - &whole.heights_m)) < 1e-4 * range);
    let refused = prepare(holed, [1.0; 2], &PLAIN);
    assert!(matches!(&refused, Err(PhysicsError::Domain { quantity: "the number of missing points", .. })), "{refused:?}");
}

#[test]
fn law_the_middle_of_an_oblong_field_is_taken() {
    let oblong = Array2::from_shape_fn((40, 60), |(i, j)| (0.3 * i as f64).sin() + (0.2 * j as f64).cos());
    let prepared = unit(&oblong, &PLAIN);
    assert_eq!(prepared.length_m, 40.0);
    let middle = unit(&oblong.slice(s![.., 10..50]).to_owned(), &PLAIN);
    assert_eq!(prepared.heights_m, middle.heights_m);
}

#[test]
fn val_points_that_lie_farther_apart_one_way_are_interpolated() {
    // Waves of some twenty of the coarser points.
    let height = |x: f64, y: f64| (0.11 * x + 0.3).sin() * (0.09 * y).cos() + 0.5 * (0.07 * (x - y)).sin();
    let square = Array2::from_shape_fn((160, 160), |(i, j)| height(i as f64, j as f64));
    let whole = unit(&square, &PLAIN);
    for coarse in [2.0, 2.5] {
        let count = (160.0 / coarse) as usize + 8;
        let oblong = Array2::from_shape_fn((160, count), |(i, j)| height(i as f64, coarse * j as f64));
        for field in [oblong.clone(), oblong.t().to_owned()] {
            let spacing = if field.nrows() == 160 { [1.0, coarse] } else { [coarse, 1.0] };
            let prepared = prepare(field, spacing, &PLAIN).unwrap();
            assert_eq!((prepared.heights_m.dim(), prepared.length_m), ((160, 160), 160.0));
            assert_eq!(prepared.shortest_wavelength_m, 8.0 * coarse);
            // The middle of the longer side is taken, some points on; its rms slope is the same but for that.
            let ratio = prepared.moments.rms_slope() / whole.moments.rms_slope();
            assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
        }
    }
    // In whatever order the heights lie in memory, short waves go: a wave of four points is all that they have here.
    let short = Array2::from_shape_fn((80, 400), |(_, j)| (TAU * j as f64 / 4.0).cos())
        + Array2::from_shape_fn((80, 400), |(i, _)| (0.1 * i as f64).sin());
    for (field, spacing) in
        [(short.clone(), [2.0, 1.0]), (short.t().to_owned(), [1.0, 2.0]), (short.t().reversed_axes().to_owned(), [2.0, 1.0])]
    {
        let prepared = prepare(field, spacing, &PLAIN).unwrap();
        assert!((prepared.noise_m - 0.5f64.sqrt()).abs() < 0.01, "{}", prepared.noise_m);
        let rms = prepared.heights_m.mapv(|h| h * h).mean().unwrap().sqrt();
        assert!((rms / prepared.moments.rms_height_m() - 1.0).abs() < 1e-9, "what is told is what is left");
    }
    // Where both squares begin at one place, the heights are the same but for the interpolation: (2π/20)⁶/924 of them, and what the cut-off makes of it.
    let oblong = Array2::from_shape_fn((160, 80), |(i, j)| height(i as f64, 2.0 * j as f64));
    let prepared = prepare(oblong, [1.0, 2.0], &PLAIN).unwrap();
    let part = unit(&square.slice(s![..159, ..159]).to_owned(), &Treatment { points_per_shortest_wavelength: 16.0, ..PLAIN });
    assert_eq!(prepared.heights_m.dim(), (159, 159));
    assert!(most(&(&prepared.heights_m - &part.heights_m)) < 1e-3, "{}", most(&(&prepared.heights_m - &part.heights_m)));
}

/// The side known from counts and spacings is that of the prepared square, to the last bit.
#[test]
fn law_the_side_of_the_square_is_known_before() {
    let height = |i: usize, j: usize| (0.11 * i as f64).sin() + (0.09 * j as f64).cos();
    for (counts, spacing) in [
        ([40, 60], [0.1, 0.1]),
        ([61, 40], [0.1, 0.10009]),
        ([60, 40], [0.1, 0.1002]),
        ([50, 64], [0.3, 0.1]),
        ([64, 33], [1.7e-8, 5.1e-8]),
        ([33, 90], [2.5e-7, 1e-7]),
    ] {
        let prepared = prepare(Array2::from_shape_fn((counts[0], counts[1]), |(i, j)| height(i, j)), spacing, &PLAIN).unwrap();
        assert_eq!(square_side(counts, spacing), prepared.length_m, "{counts:?} {spacing:?}");
    }
}

#[test]
fn law_what_is_no_surface_is_refused_with_a_sentence() {
    let fine = Array2::from_shape_fn((32, 32), |(i, j)| (0.3 * i as f64).sin() + (0.2 * j as f64).cos());
    let nan = |h: f64| if h > 0.0 { f64::NAN } else { h };
    let cases: [(Array2<f64>, [f64; 2], Treatment, &str); 8] = [
        (Array2::zeros((1, 500)), [1.0; 2], PLAIN, "16 or more"),
        (Array2::zeros((0, 0)), [1.0; 2], PLAIN, "16 or more"),
        (Array2::from_elem((32, 32), 5e-6), [1.0; 2], PLAIN, "constant"),
        (fine.clone(), [1.0, 20.0], PLAIN, "up to 16"),
        (fine.clone(), [1.0, 1.1], Treatment { periodic: true, ..PLAIN }, "1 for a periodic surface"),
        (fine.clone(), [0.0, 0.0], PLAIN, "positive"),
        (fine.slice(s![.., 2..]).to_owned(), [1.0; 2], Treatment { periodic: true, ..PLAIN }, "number of columns"),
        (fine.mapv(nan), [1.0; 2], Treatment { missing: Missing::Fill, ..PLAIN }, "half"),
    ];
    for (heights, spacing, treatment, words) in cases {
        let told = prepare(heights, spacing, &treatment).unwrap_err().to_string();
        assert!(told.contains(words), "{told}");
    }
    // A plane without anything on it is flat once its tilt is gone.
    let tilted = Array2::from_shape_fn((32, 32), |(i, j)| 1e-6 * (i as f64 + 2.0 * j as f64));
    let told = prepare(tilted, [1e-6; 2], &Treatment { detrend: Detrend::Plane, ..PLAIN }).unwrap_err().to_string();
    assert!(told.contains("flat to rounding: nothing is left after levelling") && told.contains("\nhelp: "), "{told}");
}

/// Heights whose squares are no numbers are told by their values, and not as constant.
#[test]
fn law_heights_beyond_numbers_are_told_as_what_they_are() {
    let wave = Array2::from_shape_fn((32, 32), |(i, j)| (0.3 * i as f64).sin() + (0.2 * j as f64).cos());
    let told = |heights: Array2<f64>, treatment: Treatment| prepare(heights, [1.0; 2], &treatment).unwrap_err().to_string();
    for factor in [1e10, 1e150, 1e200, 1e307] {
        let told = told(wave.mapv(|h| factor * h), PLAIN);
        assert!(told.contains("heights too large: up to ") && told.contains("check the unit"), "{told}");
    }
    assert!(told(wave.mapv(|h| 1e-170 * h), PLAIN).contains("height range too small"));
    // Heights that can be squared, and those whose mean is far larger than they are, are fine.
    for (factor, mean) in [(1e8, 0.0), (1e-50, 0.0), (1e-9, 1.0)] {
        let prepared = unit(&wave.mapv(|h| factor * h + mean), &PLAIN);
        let plain = unit(&wave, &PLAIN);
        // The mean takes digits: 1e-16 of 1 m is 1e-7 of 1 nm.
        assert!((prepared.moments.rms_height_m() / (factor * plain.moments.rms_height_m()) - 1.0).abs() < 1e-6, "{factor}");
    }
    // A plane with an offset, and what has short wavelengths only.
    let plane = Array2::from_shape_fn((64, 64), |(i, j)| 1.0 + 1e-6 * (i as f64 - 3.0 * j as f64));
    assert!(told(plane, Treatment { detrend: Detrend::Plane, ..PLAIN }).contains("flat to rounding"));
    let short = Array2::from_shape_fn((64, 64), |(i, _)| (TAU * i as f64 / 4.0).cos());
    assert!(told(short, Treatment { periodic: true, ..PLAIN }).contains("above the S-filter cut-off, 8.000e0 m"));
}

#[test]
fn val_the_window_shows_the_spectrum_of_a_part_of_a_surface() {
    // A quarter of a periodic surface does not continue periodically: without a window the slopes at its edges make a spectrum of their own.
    let surface = generated(64, 0.8, 3);
    let n = surface.heights_m.nrows();
    let part = surface.heights_m.slice(s![..n / 2, ..n / 2]).to_owned();
    let length = 0.5 * surface.length_m;
    let whole = periodogram(surface.heights_m.view(), surface.length_m).unwrap();
    let mean = part.mean().unwrap();
    let part = part.mapv(|h| h - mean);
    let [windowed, bare] = [windowed_periodogram(part.view(), length).unwrap(), periodogram(part.view(), length).unwrap()];
    let (low, high) = (8.0 * TAU / surface.length_m, 48.0 * TAU / surface.length_m);
    let far = |rings: &[hysteron::physics::surface::periodogram::Ring]| -> f64 {
        let inside = rings.iter().filter(|ring| (low..high).contains(&ring.wavenumber_1_m));
        let near = |q: f64| whole.iter().min_by(|a, b| (a.wavenumber_1_m - q).abs().total_cmp(&(b.wavenumber_1_m - q).abs())).unwrap();
        let off = inside.map(|ring| {
            let known = near(ring.wavenumber_1_m);
            // At the same wavenumber, by the slope of the spectrum.
            let density = known.density_m4 * (ring.wavenumber_1_m / known.wavenumber_1_m).powf(-3.6);
            (ring.density_m4 / density).ln().abs()
        });
        off.fold(0.0, f64::max)
    };
    // A ring of m modes under a window that makes some two of them one scatters by sqrt(2/m): at 8 modes, 0.3.
    assert!(far(&windowed) < 0.5, "{}", far(&windowed));
    assert!(far(&bare) > 1.5 * far(&windowed), "{} {}", far(&bare), far(&windowed));
}

/// Finding of a user: with an S-filter cut-off below the shortest wavelength of the surface, a fit across the end of
/// the spectrum gave H = 17.8.
#[test]
fn reg_the_fit_ends_where_the_spectrum_ends() {
    for (hurst, roll_off, periodic) in [(0.3, 4.0, true), (0.8, 8.0, true), (0.8, 8.0, false), (0.5, 4.0, false)] {
        let shape = Shape { roll_off_m: Some(1e-3 / roll_off), ..Shape::default() };
        let spectrum = Spectrum {
            length_m: 1e-3,
            rms_height_m: 5e-6,
            hurst,
            magnification: 32,
            normalization: Normalization::Sample,
            amplitudes: Amplitudes::Fixed,
            shape,
        };
        // Sixteen points per shortest wavelength, and cut-offs of 4, 8 and 16 points.
        let heights = synthesize(&spectrum, &realization_seed(11, 0), 512).heights_m;
        for points in [4.0, 8.0, 16.0] {
            let treatment = Treatment {
                periodic,
                detrend: if periodic { Detrend::Mean } else { Detrend::Plane },
                points_per_shortest_wavelength: points,
                ..PLAIN
            };
            let fit = prepare(heights.clone(), [1e-3 / 512.0; 2], &treatment).unwrap().fit.unwrap();
            // Three octaves of power law or fewer: the roll-off and H are known to a tenth.
            assert!((fit.hurst - hurst).abs() < 0.1, "{points}: {fit:?}");
            assert!(fit.rolls_off, "{points}: {fit:?}");
            assert!((fit.roll_off_1_m / (roll_off * TAU / 1e-3)).ln().abs() < 0.1, "{points}: {fit:?}");
            let end = fit.short_cut.unwrap().wavenumber_1_m;
            assert!((end / (32.0 * TAU / 1e-3)).ln().abs() < 0.1, "{points}: {fit:?}");
        }
    }
}

#[test]
fn val_the_fit_finds_the_spectrum_that_a_surface_was_made_from() {
    for (hurst, realization) in [(0.5, 0), (0.8, 1)] {
        let surface = generated(64, hurst, realization);
        let rings = periodogram(surface.heights_m.view(), surface.length_m).unwrap();
        // With fixed amplitudes the rings are Eq 10 but for how wavenumbers lie in them: the widest, of few modes, are some per cent off.
        let fit = fit_self_affine(&rings, surface.length_m, Estimate::Periodogram).unwrap();
        assert!((fit.hurst - hurst).abs() < 0.03, "{fit:?}");
        assert!(!fit.rolls_off && fit.scatter < 0.05, "{fit:?}");
        // A roll-off at eight times the longest waves' wavenumber.
        let from = 8.0 * TAU / surface.length_m;
        let plateau = rings.iter().find(|ring| ring.wavenumber_1_m >= from).unwrap().density_m4;
        let rolled: Vec<_> = rings
            .iter()
            .map(|ring| hysteron::physics::surface::periodogram::Ring {
                density_m4: if ring.wavenumber_1_m < from { plateau } else { ring.density_m4 },
                ..*ring
            })
            .collect();
        let fit = fit_self_affine(&rolled, surface.length_m, Estimate::Periodogram).unwrap();
        assert!(fit.rolls_off && (fit.hurst - hurst).abs() < 0.05, "{fit:?}");
        assert!((fit.roll_off_1_m / from).ln().abs() < 0.2, "{fit:?}");
        assert!((fit.plateau_m4 / plateau).ln().abs() < 0.1, "{fit:?}");
    }
}
