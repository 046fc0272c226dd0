//! Estimated discretization error of values on several grids.

use crate::support::{Dice, close};
use hysteron::physics::theory::grid_convergence::grid_error;

/// `1 + C h^p` on grids of points `n`, h = 1/N.
fn series(points: &[f64], order: f64, factor: f64) -> Vec<f64> {
    points.iter().map(|n| 1.0 + factor * n.powf(-order)).collect()
}

/// A power of the spacing is extrapolated to its limit, with its order, at any ratios of the grids; 60 bisections and rounding leave 1e-9.
#[test]
fn law_regular_series_has_its_order_and_limit() {
    let mut dice = Dice(7);
    for order in [0.65, 1.0, 4.0 / 3.0, 2.0, 2.15] {
        for factor in [-3.0, 2.0] {
            let n = 20.0 + 40.0 * dice.roll();
            let points = [n, n * (1.3 + dice.roll()), 5.0 * n];
            let values = series(&points, order, factor);
            let found = grid_error(&points, &values).unwrap();
            close("order", found.order.unwrap(), order, 1e-7);
            close("limit", found.extrapolated.unwrap(), 1.0, 1e-9);
            let rest = 1.25 * (values[2] - 1.0).abs();
            close("error", found.absolute, rest.max(0.005 * values[2]), 1e-6);
        }
    }
}

/// With two grids of order 1 the interval is twice the distance to the limit.
#[test]
fn law_two_grids_take_the_first_order() {
    for points in [[64.0, 128.0], [30.0, 90.0], [64.0, 96.0]] {
        let values = series(&points, 1.0, 5.0);
        let found = grid_error(&points, &values).unwrap();
        close("error", found.absolute, 2.0 * (values[1] - 1.0), 1e-12);
        close("relative error", found.relative, found.absolute / values[1], 1e-12);
        assert_eq!((found.order, found.extrapolated), (None, None));
    }
}

/// Only ratios of points matter, and the error has the unit of the value: powers of two change no digit.
#[test]
fn law_grid_error_is_homogeneous() {
    let mut dice = Dice(3);
    for count in [2, 3, 4] {
        for _ in 0..200 {
            let points: Vec<f64> = (0..count).map(|k| 16.0 * 2f64.powi(k) * (1.0 + 0.5 * dice.roll())).collect();
            let values: Vec<f64> = points.iter().map(|n| dice.roll() + 10.0 / n).collect();
            let found = grid_error(&points, &values).unwrap();
            let scaled = |by: f64, all: &[f64]| all.iter().map(|one| by * one).collect::<Vec<_>>();
            let finer = grid_error(&scaled(4.0, &points), &values).unwrap();
            assert_eq!(finer, found);
            let other = grid_error(&points, &scaled(-0.125, &values)).unwrap();
            assert_eq!((other.relative, other.order), (found.relative, found.order));
            assert_eq!((other.absolute, other.extrapolated), (0.125 * found.absolute, found.extrapolated.map(|v| -0.125 * v)));
        }
    }
}

/// The scatter of shifted copies is twice their sample standard deviation over the ratio of the spacings, added in squares. Copies without
/// scatter, and a single value, change no digit.
#[test]
fn law_scatter_of_shifted_copies_is_added_in_squares() {
    let found = grid_error(&[16.0, 32.0, 64.0], &[2.4, 2.2, 2.1]).unwrap();
    for same in [&[][..], &[2.5], &[2.5, 2.5, 2.5]] {
        assert_eq!(found.with_scatter(same, 4.0), found);
        assert_eq!(found.with_scatter(same, f64::NAN), found);
    }
    // Deviations -0.1, 0 and 0.1 of three values: s = 0.1.
    let with = found.with_scatter(&[2.4, 2.5, 2.6], 4.0);
    close("absolute error", with.absolute, found.absolute.hypot(2.0 * 0.1 / 4.0), 1e-12);
    close("relative error", with.relative, with.absolute / 2.1, 1e-12);
    assert_eq!((with.order, with.extrapolated), (found.order, found.extrapolated));
}

/// Series that are not monotone, or have an order below 0.6, have 1.25 times their range as error, and no limit; of grids that differ
/// little, that of the smallest order.
#[test]
fn reg_irregular_series() {
    let points = [64.0, 128.0, 256.0];
    for (values, range) in [([1.0, 1.3, 1.2], 0.3), ([1.0, 1.1, 1.3], 0.3), ([1.3, 1.0, 1.1], 0.3), ([1.0, 1.0, 1.2], 0.2)] {
        let found = grid_error(&points, &values).unwrap();
        close("error", found.absolute, 1.25 * range, 1e-12);
        assert_eq!((found.order, found.extrapolated), (None, None));
    }
    // Only the three finest grids decide.
    let found = grid_error(&[32.0, 64.0, 128.0, 256.0], &[90.0, 1.0, 1.3, 1.2]).unwrap();
    close("error", found.absolute, 0.375, 1e-12);
    let found = grid_error(&[64.0, 96.0, 128.0], &[1.0, 1.3, 1.2]).unwrap();
    close("error", found.absolute, 0.375 / (2f64.powf(0.6) - 1.0), 1e-12);
}

/// Monotone series with an order above 2.2 are taken as of the first order between the outer grids.
#[test]
fn reg_fast_series() {
    for (values, range) in [([1.0, 1.4, 1.41], 0.41), ([1.4, 1.2, 1.2], 0.2), ([1.0, 1.2, 1.2], 0.2)] {
        let found = grid_error(&[64.0, 128.0, 256.0], &values).unwrap();
        close("error", found.absolute, 1.25 * range / 3.0, 1e-12);
        assert_eq!((found.order, found.extrapolated), (None, None));
    }
}

/// The relative error is at least 0.5 %, also of values that do not change; a value of 0 on the finest grid alone has no relative error.
#[test]
fn lim_floor_of_the_grid_error() {
    for values in [[2.0, 2.0], [0.0, 0.0]] {
        let found = grid_error(&[64.0, 128.0], &values).unwrap();
        assert_eq!((found.relative, found.absolute), (0.005, 0.005 * values[1]));
    }
    let found = grid_error(&[64.0, 128.0], &[1.0, 0.0]).unwrap();
    assert_eq!((found.relative, found.absolute), (f64::INFINITY, 2.0));
}

#[test]
fn reg_refused_series() {
    let cases: [(&[f64], &[f64], &str); 6] = [
        (&[64.0], &[1.0], "the number of grids is 1"),
        (&[64.0, 128.0], &[1.0], "the number of values is 1"),
        (&[128.0, 64.0], &[1.0, 1.0], "the number of grid points is 64"),
        (&[64.0, 64.0], &[1.0, 1.0], "the number of grid points is 64"),
        (&[0.0, 64.0], &[1.0, 1.0], "the number of grid points is 0"),
        (&[64.0, 128.0], &[1.0, f64::NAN], "a value is NaN"),
    ];
    for (points, values, problem) in cases {
        let error = grid_error(points, values).unwrap_err().to_string();
        assert!(error.contains(problem), "{error}");
    }
}
