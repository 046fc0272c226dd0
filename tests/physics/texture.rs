//! Texture of surfaces of known aspect ratios.

use hysteron::physics::surface::edges::Edges;
use hysteron::physics::surface::texture::Texture;
use ndarray::{Array2, s};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A sum of 400 plane waves with a Gaussian spectrum, stretched by `aspect` along a direction \[rad\]; periodic up to the rounding of wavevectors.
///
/// Its autocorrelation is `exp(−½ (u² + (v/aspect)²)/l²)`, so that Str and the slope ratio are known.
fn stretched(n: usize, aspect: f64, direction: f64, length: f64) -> Array2<f64> {
    let mut state = 17_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    };
    let (sin, cos) = direction.sin_cos();
    let waves: Vec<[f64; 3]> = (0..400)
        .map(|_| {
            let (radius, angle) = ((-2.0 * uniform().ln()).sqrt() / length, TAU * uniform());
            let (along, across) = (radius * angle.cos() / aspect, radius * angle.sin());
            let whole = |q: f64| (q * n as f64 / TAU).round() * TAU / n as f64;
            [whole(along * cos - across * sin), whole(along * sin + across * cos), TAU * uniform()]
        })
        .collect();
    Array2::from_shape_fn((n, n), |(i, j)| waves.iter().map(|[x, y, phase]| (x * i as f64 + y * j as f64 + phase).cos()).sum())
}

fn angle_between(a: f64, b: f64) -> f64 {
    let apart = (a - b).rem_euclid(PI);
    apart.min(PI - apart)
}

#[test]
fn val_both_ratios_are_those_of_a_stretched_surface() {
    for (aspect, direction) in [(1.0, 0.0), (2.0, 0.0), (3.0, FRAC_PI_2), (3.0, 0.6), (4.0, 2.3)] {
        let heights = stretched(256, aspect, direction, 4.0);
        for edges in [Edges::Periodic, Edges::Open] {
            let found = Texture::of(heights.view(), edges).unwrap().unwrap();
            // 400 waves: 7 % of a mean square, and of an isotropic field the larger over the smaller.
            assert!((found.slope_ratio / aspect).ln().abs() < 0.15, "{aspect} {direction}: {found:?}");
            assert!((found.aspect_ratio_str * aspect).ln().abs() < 0.35, "{aspect} {direction}: {found:?}");
            assert!(aspect < 1.5 || angle_between(found.direction_rad, direction) < 0.1, "{direction}: {found:?}");
            // exp(−½ (u/l)²) = 0.2. The correlation of 400 waves has an error of 0.05, a fifth of the decay length.
            assert!((found.decay_length * 256.0 / (4.0 * (2.0 * 5_f64.ln()).sqrt())).ln().abs() < 0.35, "{found:?}");
        }
    }
}

#[test]
fn lim_ridges_have_no_end() {
    // A grating along an oblique direction: the mirror images of a scan would have no mixed product of slopes.
    let grating = Array2::from_shape_fn((128, 128), |(i, j)| (TAU * (3.0 * i as f64 + 3.0 * j as f64) / 128.0).cos());
    for heights in [grating.view(), grating.slice(s![..100, ..100])] {
        let found = Texture::of(heights, Edges::Open).unwrap().unwrap();
        assert!(found.slope_ratio > 100.0 && found.aspect_ratio_str < 0.2 && found.aspect() > 100.0, "{found:?}");
        assert!(angle_between(found.direction_rad, 0.75 * PI) < 1e-3, "{found:?}");
    }
}

#[test]
fn law_long_waves_alone_decide_nothing() {
    // A self-affine surface without roll-off: its longest waves give any Str by chance, and do not count.
    let heights = Array2::from_shape_fn((128, 128), |(i, j)| {
        let (x, y) = (TAU * i as f64 / 128.0, TAU * j as f64 / 128.0);
        x.cos() + 0.1 * ((9.0 * x + 2.0).cos() + (9.0 * y + 1.0).cos()) + 0.3 * (y + 1.0).cos()
    });
    let found = Texture::of(heights.view(), Edges::Periodic).unwrap().unwrap();
    assert!(found.aspect_ratio_str < 0.5 && found.aspect() < 2.0, "{found:?}");
}

#[test]
fn law_units_do_not_matter() {
    let heights = stretched(96, 2.0, 0.4, 3.0);
    let [one, other] = [1.0, 1e-9].map(|unit| Texture::of(heights.mapv(|h| unit * h).view(), Edges::Open).unwrap().unwrap());
    // Rounding of the product with the unit.
    for (a, b) in [(one.slope_ratio, other.slope_ratio), (one.aspect_ratio_str, other.aspect_ratio_str)] {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}
