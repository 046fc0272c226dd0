//! Summits: exact between the grid's points, and as many as Nayak's statistics say.

use crate::support::{Dice, LENGTH, RMS, close, near, paper_spectrum, surface};
use hysteron::physics::PhysicsError;
use hysteron::physics::surface::band_limited::BandLimited;
use hysteron::physics::surface::summits::{Summits, find_summits};
use ndarray::Array2;
use std::f64::consts::TAU;

/// A sum of cosines: amplitude, mode numbers, phase.
struct Waves(Vec<(f64, i32, i32, f64)>);

impl Waves {
    /// Heights on an n × n grid.
    fn grid(&self, n: usize) -> Array2<f64> {
        Array2::from_shape_fn((n, n), |(i, j)| self.jet(LENGTH * i as f64 / n as f64, LENGTH * j as f64 / n as f64)[0])
    }

    /// h, ∂x, ∂y, ∂xx, ∂xy, ∂yy by the direct sum.
    fn jet(&self, x: f64, y: f64) -> [f64; 6] {
        let mut jet = [0.0; 6];
        for (amplitude, kx, ky, phase) in &self.0 {
            let [qx, qy] = [kx, ky].map(|k| TAU * f64::from(*k) / LENGTH);
            let (sine, cosine) = (qx * x + qy * y + phase).sin_cos();
            let terms = [cosine, -qx * sine, -qy * sine, -qx * qx * cosine, -qx * qy * cosine, -qy * qy * cosine];
            for (value, term) in jet.iter_mut().zip(terms) {
                *value += amplitude * term;
            }
        }
        jet
    }

    /// Waves that all crest at (x, y).
    fn crest(x: f64, y: f64, waves: &[(f64, i32, i32)]) -> Self {
        Self(waves.iter().map(|(a, kx, ky)| (*a, *kx, *ky, -TAU / LENGTH * (f64::from(*kx) * x + f64::from(*ky) * y))).collect())
    }
}

fn find(heights: &Array2<f64>, points: f64) -> Summits {
    find_summits(heights.view(), LENGTH, points).unwrap()
}

#[test]
fn law_a_summit_off_the_grid_is_found_exactly() {
    let shapes = [(3e-6, 1, 0), (2e-6, 0, 1), (1e-6, 2, -1), (0.7e-6, 3, 2), (0.2e-6, -1, 4)];
    // In the middle of cells, across the edges of the square, and on a grid point.
    for (x, y) in [(0.3137e-3, 0.7071e-3), (0.99999e-3, 0.00002e-3), (0.25e-3, 0.5e-3), (0.0041e-3, 0.996e-3)] {
        let waves = Waves::crest(x, y, &shapes);
        let n = 40;
        let found = find(&waves.grid(n), 8.0);
        let top = found.list.iter().max_by(|a, b| a.height_m.total_cmp(&b.height_m)).unwrap();
        let [h, gx, gy, xx, xy, yy] = waves.jet(x, y);
        near("the crest is stationary", gx.hypot(gy), 0.0, 1e-15);
        // The interpolation is good to 1e-15 of the heights, second derivatives to that over the squared spacing; Newton's own
        // tolerance is 1e-10 of the spacing.
        let spacing = LENGTH / n as f64;
        let wrapped = |d: f64| d - LENGTH * (d / LENGTH).round();
        near("x", wrapped(top.x_m - x), 0.0, 1e-10 * spacing);
        near("y", wrapped(top.y_m - y), 0.0, 1e-10 * spacing);
        close("height", top.height_m, h, 1e-13);
        let (mean, deviator) = (-0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
        close("curvature", top.curvature_1_m, mean, 1e-11);
        close("smaller", top.curvature_min_1_m, mean - deviator, 1e-10);
        close("greater", top.curvature_max_1_m, mean + deviator, 1e-10);
        close("radius", top.radius_m(), 1.0 / mean, 1e-11);
        assert!(top.refined && (0.0..LENGTH).contains(&top.x_m) && (0.0..LENGTH).contains(&top.y_m));
        let from_grid = [top.grid_row as f64 * spacing - x, top.grid_col as f64 * spacing - y].map(|d| wrapped(d).abs());
        assert!(from_grid[0] <= spacing && from_grid[1] <= spacing, "{from_grid:?}");
    }
}

#[test]
fn law_a_moved_surface_has_moved_summits() {
    let shapes = [(3e-6, 1, 0), (2e-6, 0, 1), (1e-6, 2, -1), (0.7e-6, 3, 2)];
    let of = |dx: f64, dy: f64| find(&Waves::crest(0.3e-3 + dx, 0.4e-3 + dy, &shapes).grid(64), 16.0).list;
    let (here, there) = (of(0.0, 0.0), of(0.4321e-3, 0.7777e-3));
    assert_eq!(here.len(), there.len());
    let sorted = |list: &[hysteron::physics::surface::summits::Summit]| {
        let mut pairs: Vec<(f64, f64)> = list.iter().map(|s| (s.height_m, s.curvature_1_m)).collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        pairs
    };
    for ((h, k), (g, l)) in sorted(&here).into_iter().zip(sorted(&there)) {
        near("height", h, g, 1e-13 * 7e-6);
        close("curvature", k, l, 1e-9);
    }
}

#[test]
fn law_an_apex_within_a_spacing_is_found() {
    // Nine points to the shortest wavelength; two of the three summits are long ridges (curvatures 60 and 344 per metre).
    let shapes = [(3e-6, 1, 0), (2e-6, 0, 1), (1e-6, 2, -1), (0.7e-6, 3, 2)];
    let spacing = LENGTH / 32.0;
    let apexes = find(&Waves::crest(0.3e-3, 0.4e-3, &shapes).grid(64), 16.0).list;
    let mut dice = Dice(10);
    for _ in 0..40 {
        let (dx, dy) = (dice.roll() * LENGTH, dice.roll() * LENGTH);
        let found = find(&Waves::crest(0.3e-3 + dx, 0.4e-3 + dy, &shapes).grid(32), 8.0);
        for summit in found.list.iter().filter(|s| !s.refined) {
            let far = |apex: &hysteron::physics::surface::summits::Summit| {
                let [x, y] = [summit.x_m - apex.x_m - dx, summit.y_m - apex.y_m - dy].map(|d| d - LENGTH * (d / LENGTH).round());
                x.abs().max(y.abs())
            };
            let nearest = apexes.iter().map(far).fold(f64::INFINITY, f64::min);
            assert!(nearest > spacing, "shift {dx:e} {dy:e}: unrefined at {:.3} spacings from its apex", nearest / spacing);
        }
    }
}

/// A grid of zeros with level tops at the given points.
fn tops(points: &[(usize, usize)]) -> Array2<f64> {
    let mut heights = Array2::zeros((16, 16));
    points.iter().for_each(|p| heights[*p] = 1e-6);
    heights
}

#[test]
fn reg_a_plateau_is_one_summit_and_a_flat_surface_none() {
    // Neighbours along a row, a column and both diagonals, in fours, and across the edges.
    let plateaus: [&[(usize, usize)]; 8] = [
        &[(5, 5)],
        &[(5, 5), (5, 6)],
        &[(5, 5), (6, 5)],
        &[(5, 5), (6, 6)],
        &[(5, 6), (6, 5)],
        &[(5, 5), (5, 6), (6, 5), (6, 6)],
        &[(7, 15), (7, 0)],
        &[(15, 3), (0, 3)],
    ];
    for plateau in plateaus {
        let found = find(&tops(plateau), 8.0);
        assert_eq!(found.list.len() + found.rejected, 1, "{plateau:?}");
        // The first in grid order, across an edge the one from which the plateau goes on.
        assert!(found.list.iter().all(|s| (s.grid_row, s.grid_col) == plateau[0]), "{plateau:?}: {:?}", found.list);
    }
    for level in [0.0, 3e-6] {
        let flat = find(&Array2::from_elem((16, 16), level), 8.0);
        assert_eq!((flat.list.len(), flat.rejected, flat.unrefined), (0, 0, 0));
    }
    // A ridge has no summit: every point of it has an equal before it.
    let ridge = Array2::from_shape_fn((16, 16), |(i, _)| (TAU * i as f64 / 16.0).cos() * 1e-6);
    assert_eq!(find(&ridge, 8.0).list.len(), 0);
    // Two tops are two summits.
    assert_eq!(find(&tops(&[(3, 3), (10, 12)]), 8.0).list.len(), 2);
}

#[test]
fn reg_two_points_to_a_wavelength_are_too_few() {
    for points in [2.0, 1.0, f64::NAN, f64::INFINITY] {
        let refused = find_summits(tops(&[(5, 5)]).view(), LENGTH, points);
        assert!(matches!(refused, Err(PhysicsError::Domain { .. })), "{points}");
    }
}

#[test]
fn val_interpolation_is_the_trigonometric_sum() {
    let mut dice = Dice(9);
    let zeta = 8;
    let mut waves = Vec::new();
    for kx in -zeta..=zeta {
        for ky in 0..=zeta {
            let k2 = f64::from(kx * kx + ky * ky);
            if (ky > 0 || kx > 0) && k2 < f64::from(zeta * zeta) {
                waves.push((2e-6 * k2.powf(-0.9), kx, ky, TAU * dice.roll()));
            }
        }
    }
    let waves = Waves(waves);
    let top = TAU * f64::from(zeta) / LENGTH;
    for (points, n) in [(3.0, 24), (4.0, 32), (8.0, 64), (16.0, 128)] {
        let heights = waves.grid(n);
        let surface = BandLimited::new(heights.view(), LENGTH, points);
        for _ in 0..30 {
            // Anywhere in the periodic plane.
            let (x, y) = ((3.0 * dice.roll() - 1.0) * LENGTH, (3.0 * dice.roll() - 1.0) * LENGTH);
            let jet = surface.jet(x, y);
            let want = waves.jet(x, y);
            let got = [jet.height_m, jet.gradient[0], jet.gradient[1], jet.hessian_1_m[0], jet.hessian_1_m[1], jet.hessian_1_m[2]];
            // The window's error is exp(−34), 1.7e-15, of the heights (rms 3e-6, up to 1e-5), with a factor of the kernel's own sum for
            // rounding; each derivative multiplies it by the grid's wavenumber, points/2 times the shortest mode's at most.
            let rate = top * (0.5 * points).max(1.0);
            let scales = [1.0, rate, rate, rate * rate, rate * rate, rate * rate];
            for ((g, w), scale) in got.into_iter().zip(want).zip(scales) {
                near("jet", g, w, 2e-14 * 1e-5 * scale * 3.0);
            }
        }
    }
}

#[test]
fn val_as_many_summits_as_nayak_says() {
    let spectrum = paper_spectrum(0.8, 64);
    let expected = spectrum.lattice_moments().summit_density_1_m2() * LENGTH * LENGTH;
    for (points, share) in [(4, 0.84), (8, 0.96), (16, 0.99)] {
        let counts: Vec<f64> =
            (0..4).map(|r| find(&surface(&spectrum, r, points).heights_m, points as f64).list.len() as f64 / expected).collect();
        let n = counts.len() as f64;
        let mean = counts.iter().sum::<f64>() / n;
        // Some 700 summits, which repel one another: below Poisson's 1/√(700·4) = 0.019 for the mean of four, of which this is 1.3; the
        // sheet's shares are rounded to 0.005.
        near("found/eta", mean, share, 0.025);
    }
}

#[test]
fn law_rough_summits_are_maxima_of_the_surface() {
    let made = surface(&paper_spectrum(0.8, 16), 1, 8);
    let found = find(&made.heights_m, 8.0);
    assert!(found.list.len() > 20);
    assert_eq!(found.unrefined, found.list.iter().filter(|s| !s.refined).count());
    let band = BandLimited::new(made.heights_m.view(), LENGTH, 8.0);
    for summit in &found.list {
        assert!(summit.curvature_1_m > 0.0);
        let grid = made.heights_m[[summit.grid_row, summit.grid_col]];
        assert!(summit.height_m >= grid - 1e-14 * RMS, "an apex lies no lower than its grid point");
        if summit.refined {
            let jet = band.jet(summit.x_m, summit.y_m);
            // Newton's tolerance is 1e-10 of a spacing (7.8e-6 m); the gradient there is that times a curvature.
            near("gradient", jet.gradient[0].hypot(jet.gradient[1]), 0.0, 1e-15 * summit.curvature_max_1_m + 1e-13);
            assert!(summit.curvature_min_1_m > 0.0, "a maximum curves down both ways");
        }
        // Twice the mean is the sum of the principal ones.
        close("mean", 0.5 * (summit.curvature_min_1_m + summit.curvature_max_1_m), summit.curvature_1_m, 1e-14);
    }
}
