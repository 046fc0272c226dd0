//! Artefacts of scans: what is found and corrected, and surfaces in which nothing may be found.

use hysteron::model::{Amplitudes, FastAxis, Normalization};
use hysteron::physics::surface::artefacts::{Corrections, correct, noise_exponent, outlier_effect};
use hysteron::physics::surface::edges::Edges;
use hysteron::physics::surface::outliers::{find_outliers, replace_outliers};
use hysteron::physics::surface::periodogram::{periodogram, windowed_periodogram};
use hysteron::physics::surface::rows::{align, line_jump};
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::{Moments, Spectrum};
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use hysteron::physics::surface::tip::{curvature_ratio, reliability_cutoff};
use ndarray::{Array2, s};
use std::f64::consts::TAU;

/// Part of a self-affine surface of rms height 1 with `points` per shortest wavelength, which does not continue periodically.
fn rough(hurst: f64, (rows, columns): (usize, usize), points: usize, seed: u64) -> Array2<f64> {
    let magnification = rows.max(columns) / points + 8;
    let spectrum = Spectrum {
        length_m: 1.0,
        rms_height_m: 1.0,
        hurst,
        magnification: magnification as u32,
        normalization: Normalization::Sample,
        amplitudes: Amplitudes::Gaussian,
        shape: Shape::default(),
    };
    let surface = synthesize(&spectrum, &realization_seed(seed, 0), points * magnification).heights_m;
    surface.slice(s![..rows, ..columns]).to_owned()
}

/// Numbers of mean 0 and variance 1, always the same.
fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
}

fn rms(heights: &Array2<f64>) -> f64 {
    let mean = heights.mean().unwrap();
    heights.mapv(|h| (h - mean).powi(2)).mean().unwrap().sqrt()
}

const SHAPES: [(usize, usize); 3] = [(64, 64), (48, 96), (130, 70)];
const HURST: [f64; 4] = [0.1, 0.4, 0.7, 1.0];

/// Surfaces without artefacts, with a name each.
fn clean() -> Vec<(String, Array2<f64>)> {
    let mut all = Vec::new();
    for (k, shape) in SHAPES.into_iter().enumerate() {
        for hurst in HURST {
            for points in [4, 8, 16] {
                all.push((format!("H = {hurst}, {shape:?}, {points}"), rough(hurst, shape, points, k as u64)));
            }
        }
        let grid = |of: &dyn Fn(usize, usize) -> f64| Array2::from_shape_fn(shape, |(i, j)| of(i, j));
        for length in [8, 12, 30] {
            let wave = |k: usize| (TAU * k as f64 / f64::from(length)).sin();
            all.push((format!("sinusoid of {length} points, {shape:?}"), grid(&|i, j| wave(i) + wave(j))));
            all.push((format!("ridges of {length} points, {shape:?}"), grid(&|i, _| wave(i))));
        }
        for width in [4, 8, 16] {
            for amplitude in [0.0, 0.01, 0.05] {
                let grains = noise(shape.0 * shape.1, width as u64);
                let grain = |i: usize, j: usize| amplitude * grains[i * shape.1 + j];
                let from_centre = |k: usize| (k % (2 * width)) as f64 - width as f64 + 0.5;
                let pillar = |i: usize, j: usize| ((i / width % 2) * (j / width % 2)) as f64;
                let radius = |i: usize, j: usize| from_centre(i).hypot(from_centre(j)) / width as f64;
                all.push((format!("pillars of {width}, {amplitude}"), grid(&|i, j| pillar(i, j) + grain(i, j))));
                all.push((format!("grating of {width}, {amplitude}"), grid(&|i, j| (i / width % 2) as f64 + grain(i, j))));
                all.push((format!("discs of {width}, {amplitude}"), grid(&|i, j| f64::from(radius(i, j) < 0.6) + grain(i, j))));
                all.push((format!("cones of {width}, {amplitude}"), grid(&|i, j| (1.0 - radius(i, j)).max(0.0) + grain(i, j))));
                all.push((format!("domes of {width}, {amplitude}"), grid(&|i, j| (0.6 - radius(i, j).powi(2)).max(0.0) + grain(i, j))));
            }
        }
        let grains = noise(shape.0 * shape.1, 77);
        all.push((format!("quantized, {shape:?}"), grid(&|i, j| (0.5 * grains[i * shape.1 + j]).round())));
        all.push((format!("step, {shape:?}"), grid(&|i, j| f64::from(i > 30) + 0.02 * grains[i * shape.1 + j])));
    }
    all
}

#[test]
fn law_clean_surfaces_have_no_outliers_and_no_offsets() {
    for (name, heights) in clean() {
        assert_eq!(find_outliers(heights.view(), Edges::Open), [], "{name}");
        assert_eq!([line_jump(heights.view()), line_jump(heights.t())], [0.0; 2], "{name}");
    }
}

/// Places of spikes and dips: single points, pairs, three in a row, in a corner and along a diagonal, at edges and corners.
fn places((rows, columns): (usize, usize)) -> Vec<(usize, usize)> {
    let groups: [&[(usize, usize)]; 8] = [
        &[(10, 12)],
        &[(20, 30), (20, 31)],
        &[(30, 20), (31, 20), (32, 20)],
        &[(40, 40), (40, 41), (41, 40)],
        &[(12, 40), (13, 41)],
        &[(0, 0)],
        &[(0, columns / 2), (1, columns / 2)],
        &[(rows - 1, columns - 1), (rows / 2, 0), (rows - 1, 9)],
    ];
    let mut places = groups.concat();
    places.sort_unstable();
    places
}

#[test]
fn law_outliers_are_found_alone_and_in_groups() {
    for shape in SHAPES {
        for hurst in HURST {
            let clean = rough(hurst, shape, 8, 3);
            for height in [8.0, -8.0, 1e4] {
                let mut spoilt = clean.clone();
                places(shape).iter().for_each(|place| spoilt[*place] += height);
                assert_eq!(find_outliers(spoilt.view(), Edges::Open), places(shape), "H = {hurst}, {shape:?}, {height}");
                // The scale of the heights and an offset do not count.
                let scaled = spoilt.mapv(|h| 1e-9 * h + 1e-3);
                assert_eq!(find_outliers(scaled.view(), Edges::Open), places(shape));
                replace_outliers(&mut spoilt, &places(shape), Edges::Open);
                // The in-fill of a point is the mean of its neighbours, and 8 points resolve the shortest wavelength.
                assert!(rms(&(&spoilt - &clean)) < 0.02, "H = {hurst}: {}", rms(&(&spoilt - &clean)));
            }
        }
    }
}

#[test]
fn law_outliers_beside_missing_points_are_found_and_those_remain_missing() {
    for shape in SHAPES {
        let clean = rough(0.8, shape, 8, 4);
        let mut spoilt = clean.clone();
        spoilt.slice_mut(s![20..24, 20..26]).fill(f64::NAN);
        let found = [(19, 22), (22, 26), (23, 19)];
        found.iter().for_each(|place| spoilt[*place] += 9.0);
        assert_eq!(find_outliers(spoilt.view(), Edges::Open), found);
        replace_outliers(&mut spoilt, &found, Edges::Open);
        assert_eq!(spoilt.iter().filter(|h| h.is_nan()).count(), 24);
        // Beside a hole only three neighbours or fewer are known.
        found.iter().for_each(|place| assert!((spoilt[*place] - clean[*place]).abs() < 0.3));
    }
}

#[test]
fn lim_a_scan_without_variation_or_of_few_points_has_no_outliers() {
    assert_eq!(find_outliers(Array2::zeros((32, 32)).view(), Edges::Open), []);
    assert_eq!(find_outliers(Array2::from_elem((32, 32), f64::NAN).view(), Edges::Periodic), []);
    assert_eq!(find_outliers(rough(0.8, (64, 64), 8, 1).slice(s![..4, ..]), Edges::Open), []);
    // A spike on a plane.
    let mut plane = Array2::from_shape_fn((32, 40), |(i, j)| 0.1 * i as f64 - 0.02 * j as f64);
    plane[(7, 9)] += 50.0;
    assert_eq!(find_outliers(plane.view(), Edges::Open), [(7, 9)]);
}

/// A surface with an offset of this rms value to each row.
fn with_offsets(heights: &Array2<f64>, amplitude: f64, seed: u64) -> Array2<f64> {
    let offsets = noise(heights.nrows(), seed);
    Array2::from_shape_fn(heights.dim(), |(i, j)| heights[(i, j)] + amplitude * offsets[i])
}

#[test]
fn law_offsets_of_lines_are_found_and_removed_along_both_directions() {
    for (shape, seed) in SHAPES.into_iter().zip(1..) {
        for hurst in HURST {
            let clean = rough(hurst, shape, 8, seed);
            let bend = |heights: &Array2<f64>| {
                let last = heights.nrows() - 1;
                rms(&(&heights.slice(s![..last - 1, ..]) + &heights.slice(s![2.., ..]) - 2.0 * &heights.slice(s![1..last, ..])))
            };
            for amplitude in [0.1, 0.4, 2.0] {
                let mut spoilt = with_offsets(&clean, amplitude, seed);
                // The standard deviation of 48 to 130 offsets of normal distribution is known to 20 %, and offsets are clipped at 4 of them.
                let found = line_jump(spoilt.view());
                assert!((0.7..1.3).contains(&(found / amplitude)), "H = {hurst}, {shape:?}, {amplitude}: {found}");
                assert_eq!(line_jump(spoilt.t()), 0.0);
                let mut turned = spoilt.t().as_standard_layout().into_owned();
                let aligned = align(&mut spoilt, FastAxis::Auto);
                // Medians of differences are inexact by the roughness of the lines over the root of their length.
                assert!(aligned.axis == FastAxis::Rows && line_jump(spoilt.view()) < 0.01, "{}", line_jump(spoilt.view()));
                // Offsets bend the surface across the lines. The bend of the surface itself is left.
                assert!((bend(&spoilt) / bend(&clean) - 1.0).abs() < 0.06, "H = {hurst}: {} {}", bend(&spoilt), bend(&clean));
                let other = align(&mut turned, FastAxis::Auto);
                assert_eq!((other.axis, other.offset), (FastAxis::Columns, aligned.offset));
                assert_eq!(turned.t(), spoilt);
            }
        }
    }
}

#[test]
fn law_single_displaced_lines_are_found() {
    for shape in SHAPES {
        let clean = rough(0.6, shape, 8, 9);
        let mut spoilt = clean.clone();
        [11, 29, 40].into_iter().for_each(|row| spoilt.row_mut(row).mapv_inplace(|h| h + 1.5));
        let expected = 1.5 * (3.0 / shape.0 as f64).sqrt();
        assert!((line_jump(spoilt.view()) / expected - 1.0).abs() < 0.1, "{shape:?}: {}", line_jump(spoilt.view()));
        align(&mut spoilt, FastAxis::Rows);
        assert!(line_jump(spoilt.view()) < 0.01);
    }
}

#[test]
fn law_alignment_keeps_the_slope_and_missing_points() {
    let mut plane = Array2::from_shape_fn((40, 64), |(i, j)| 0.3 * i as f64 + 0.1 * j as f64);
    plane[(5, 5)] = f64::NAN;
    plane.row_mut(20).fill(f64::NAN);
    let before = plane.clone();
    let aligned = align(&mut plane, FastAxis::Rows);
    // A line that is missing as a whole has no offset: the lines after it keep theirs.
    assert!(aligned.offset < 0.3 && plane.iter().filter(|h| h.is_nan()).count() == 65);
    let mut whole = Array2::from_shape_fn((40, 64), |(i, j)| 0.3 * i as f64 + 0.1 * j as f64);
    let aligned = align(&mut whole, FastAxis::Columns);
    assert!(aligned.offset < 1e-13);
    assert!(whole.iter().zip(&before).all(|(a, b)| b.is_nan() || (a - b).abs() < 1e-12));
}

#[test]
fn law_corrections_are_made_only_if_asked_for() {
    let mut spoilt = with_offsets(&rough(0.8, (64, 80), 8, 2), 0.3, 5);
    spoilt[(30, 30)] += 20.0;
    let before = spoilt.clone();
    let none = Corrections { outliers: false, align: None, periodic: false };
    let kept = correct(&mut spoilt, &none);
    assert_eq!(spoilt, before);
    assert_eq!((kept.outlier_count, kept.outlier_left_count, kept.aligned, kept.jump_axis), (0, 1, None, FastAxis::Rows));
    let both = correct(&mut spoilt, &Corrections { outliers: true, align: Some(FastAxis::Auto), periodic: false });
    assert_eq!((both.outlier_count, both.outlier_left_count), (1, 0));
    assert!(both.line_jump_m < 0.01);
    assert!((both.aligned.unwrap().offset / 0.3 - 1.0).abs() < 0.5);
}

#[test]
fn law_outliers_matter_by_their_height_curvature_or_number() {
    let moments = Moments::of_rms(1.0, 0.1, 0.02);
    let none = Corrections { outliers: false, align: None, periodic: false };
    let effect = |heights: &[f64], points: f64| {
        let mut flat = Array2::from_shape_fn((64, 64), |(i, j)| 1e-3 * ((i * 31 + j * 17) % 13) as f64);
        heights.iter().enumerate().for_each(|(k, height)| flat[(8 + 10 * (k / 5), 8 + 10 * (k % 5))] += height);
        let found = correct(&mut flat, &none);
        assert_eq!(found.outlier_left_count, heights.len());
        outlier_effect(&found, &moments, points, points)
    };
    // Height 1/2 of 64 points: 0.5 π/64 of 0.1 h_rms. Curvature: (2π/8)² of that over 0.01.
    let height = 0.5 * std::f64::consts::PI / 64.0;
    let expected = (height * (TAU / 8.0).powi(2) / 0.01).max(height / 0.1);
    // The base of the flat scan has a range of 0.012.
    assert!((effect(&[0.5], 8.0) / expected - 1.0).abs() < 0.03);
    assert!((effect(&[-5.0], 8.0) / effect(&[0.5], 8.0) - 10.0).abs() < 0.3);
    assert!(effect(&[0.5], 32.0) < 0.5 && effect(&[0.5; 20], 32.0) > 1.0);
    assert_eq!(effect(&[], 8.0), 0.0);
}

/// Surface as a parabolic tip of this radius traces it, periodically: `max over x' of h(x') − (x − x')²/2R`.
fn traced(heights: &Array2<f64>, radius: f64) -> Array2<f64> {
    let n = heights.nrows();
    let range = heights.iter().fold(0.0_f64, |most, h| most.max(h.abs())) * 2.0;
    let reach = ((2.0 * radius * range).sqrt().ceil() as isize).min(n as isize / 2);
    let parabola = |line: &[f64]| -> Vec<f64> {
        let at = |k: isize| line[k.rem_euclid(n as isize) as usize];
        let of = |x: isize| (-reach..=reach).map(|d| at(x + d) - (d * d) as f64 / (2.0 * radius)).fold(f64::MIN, f64::max);
        (0..n as isize).map(of).collect()
    };
    let mut result = heights.clone();
    for mut row in result.rows_mut() {
        let line = parabola(&row.to_vec());
        row.iter_mut().zip(line).for_each(|(h, new)| *h = new);
    }
    for mut column in result.columns_mut() {
        let line = parabola(&column.to_vec());
        column.iter_mut().zip(line).for_each(|(h, new)| *h = new);
    }
    result
}

#[test]
fn val_the_reliability_cutoff_of_a_power_law() {
    // A sinusoid of amplitude a along x has the rms mean curvature ½ a q²/√2 in its own ring, and none below.
    let n = 128;
    let (modes, amplitude) = (16.0, 0.3);
    let heights = Array2::from_shape_fn((n, n), |(i, _)| amplitude * (TAU * modes * i as f64 / n as f64).sin());
    let rings = periodogram(heights.view(), n as f64).unwrap();
    let q = TAU * modes / n as f64;
    let curvature = 0.5 * amplitude * q * q / 2.0_f64.sqrt();
    assert_eq!(reliability_cutoff(&rings, n as f64, 0.9 / curvature), None);
    // A ring has a width of a quarter of an octave.
    let cutoff = reliability_cutoff(&rings, n as f64, 1.1 / curvature).unwrap();
    assert!((cutoff * q / TAU).log2().abs() < 0.26, "{cutoff}");
    for hurst in [0.3, 0.8] {
        let surface = rough(hurst, (256, 256), 8, 6);
        let rings = windowed_periodogram(surface.view(), 256.0).unwrap();
        let cutoffs = [30.0, 100.0, 300.0].map(|radius| reliability_cutoff(&rings, 256.0, radius).unwrap_or(0.0));
        assert!(cutoffs[0] <= cutoffs[1] && cutoffs[1] < cutoffs[2], "{cutoffs:?}");
    }
}

#[test]
fn law_a_blunt_tip_is_seen_by_its_rounded_summits_and_sharp_valleys() {
    for (hurst, seed) in [(0.5, 1), (0.8, 2), (1.0, 3)] {
        let spectrum = Spectrum {
            length_m: 1.0,
            rms_height_m: 1.0,
            hurst,
            magnification: 24,
            normalization: Normalization::Sample,
            amplitudes: Amplitudes::Gaussian,
            shape: Shape::default(),
        };
        let heights = synthesize(&spectrum, &realization_seed(seed, 0), 192).heights_m;
        assert_eq!(curvature_ratio(heights.view(), [1.0; 2], 2), None, "H = {hurst}");
        for radius in [60.0, 200.0] {
            let ratio = curvature_ratio(traced(&heights, radius).view(), [1.0; 2], 2);
            assert!(ratio.is_some_and(|ratio| ratio < 0.33), "H = {hurst}, R = {radius}: {ratio:?}");
        }
    }
}

#[test]
fn law_periodic_surfaces_have_no_outliers_at_their_edges() {
    for (hurst, seed) in HURST.into_iter().zip(1..) {
        for magnification in [8, 12] {
            let spectrum = Spectrum {
                length_m: 1.0,
                rms_height_m: 1.0,
                hurst,
                magnification,
                normalization: Normalization::Sample,
                amplitudes: Amplitudes::Fixed,
                shape: Shape::default(),
            };
            let mut heights = synthesize(&spectrum, &realization_seed(seed, 0), 8 * magnification as usize).heights_m;
            assert_eq!(find_outliers(heights.view(), Edges::Periodic), []);
            heights[(0, 0)] += 9.0;
            assert_eq!(find_outliers(heights.view(), Edges::Periodic), [(0, 0)]);
        }
    }
}

#[test]
fn law_only_blunt_tips_have_rounded_summits() {
    for (name, heights) in clean().into_iter().filter(|(name, _)| !name.starts_with("domes")) {
        let ratio = curvature_ratio(heights.view(), [1.0; 2], 2);
        assert!(ratio.is_none_or(|ratio| ratio >= 0.33), "{name}: {ratio:?}");
    }
}

#[test]
fn law_short_wavelengths_are_noise_only_if_their_spectrum_is_flat() {
    for (name, heights) in clean().into_iter().filter(|(name, _)| name.starts_with("H = ")) {
        let side = heights.nrows().min(heights.ncols());
        let square = heights.slice(s![..side, ..side]);
        let rings = windowed_periodogram(square, side as f64).unwrap();
        let exponent = noise_exponent(&rings, 8.0);
        assert!(exponent.is_none_or(|exponent| exponent < -1.5), "{name}: {exponent:?}");
        let grains = noise(side * side, 8);
        let noisy = Array2::from_shape_fn((side, side), |(i, j)| square[(i, j)] + 1.5 * grains[i * side + j]);
        let rings = windowed_periodogram(noisy.view(), side as f64).unwrap();
        let exponent = noise_exponent(&rings, 8.0).unwrap();
        assert!(exponent > -1.0, "{name}: {exponent}");
    }
}
