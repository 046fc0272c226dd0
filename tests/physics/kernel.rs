//! The periodic point-load kernel.

use crate::reference::table;
use crate::support::{Dice, close, near, random};
use hysteron::physics::asperities::field::ewald::{ORDERS, RemainderSeries, image_sums, kernel, remainder};
use proptest::prelude::*;
use std::f64::consts::PI;

/// `4 ζ(½) β(½)`: own images and background.
const SELF_TERM: f64 = -3.900_264_920_001_956;

#[test]
fn val_kernel_agrees_with_many_digits() {
    for row in table("kernel").rows() {
        let (x, y) = (row.number("x"), row.number("y"));
        let rest = row.number("G_minus_1_over_r");
        // Sums of some hundred terms below 4, cancelling to values below 4.
        near("G - 1/r", remainder(x, y, 2.5), rest, 1e-13);
        if x.hypot(y) > 0.0 {
            close("G", kernel(x, y, 2.5), row.number("G"), 1e-12 * (4.0 / row.number("G").abs()).max(1.0));
        }
    }
}

proptest! {
    #![proptest_config(random(40))]

    #[test]
    fn law_the_splitting_parameter_is_arbitrary(x in -0.5..0.5f64, y in -0.5..0.5f64, alpha in 1.1..4.0f64) {
        let (want, near_pole) = (kernel(x, y, PI.sqrt()), 1.0 / x.hypot(y));
        // The terms are below 2√π/α and 1/r: rounding only.
        near("G", kernel(x, y, alpha), want, 1e-12 * near_pole.max(1.0));
        near("G - 1/r", remainder(x, y, alpha), want - near_pole, 1e-12 * near_pole.max(1.0));
    }

    #[test]
    fn law_the_kernel_has_the_symmetry_of_the_square(x in 0.0..0.5f64, y in 0.0..0.5f64) {
        let series = RemainderSeries::new();
        for (u, v) in [(-x, y), (x, -y), (-x, -y), (y, x), (-y, x)] {
            near("remainder", remainder(u, v, 2.0), remainder(x, y, 2.0), 1e-13);
            near("series", series.at(u, v), series.at(x, y), 1e-13);
        }
        // The same place in the next cell: the kernel is periodic, the remainder is not.
        near("period", kernel(x - 1.0, y, 2.0), kernel(x, y, 2.0), 1e-12 / x.hypot(y));
    }
}

#[test]
fn val_the_self_term_is_a_madelung_constant() {
    for alpha in [1.1, PI.sqrt(), 2.5, 4.0] {
        near("self term", remainder(0.0, 0.0, alpha), SELF_TERM, 1e-13);
    }
    near("series", RemainderSeries::default().at(0.0, 0.0), SELF_TERM, 1e-13);
}

#[test]
fn law_the_series_is_the_remainder() {
    let series = RemainderSeries::new();
    let mut dice = Dice(2);
    let mut places: Vec<(f64, f64)> = (0..200).map(|_| (dice.roll() - 0.5, dice.roll() - 0.5)).collect();
    places.extend([(0.5, 0.5), (0.5, 0.0), (0.0, 0.5), (-0.5, 0.5), (1e-9, -1e-9)]);
    for (x, y) in places {
        // Truncated where it falls below rounding of the values, which are below 4.
        near("series", series.at(x, y), remainder(x, y, 2.5), 1e-13);
    }
}

#[test]
fn law_the_kernel_has_no_mean() {
    // Three-point Gauss on 16 × 16 panels of the quadrant: error (1/32)⁶ of derivatives below 1e3.
    let offset = 0.5 * 0.6f64.sqrt();
    let nodes = [(0.5 - offset, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + offset, 5.0 / 18.0)];
    let points: Vec<(f64, f64)> = (0..16).flat_map(|k| nodes.map(|(t, w)| ((f64::from(k) + t) / 32.0, w / 16.0))).collect();
    let mean: f64 = points.iter().flat_map(|(x, wx)| points.iter().map(move |(y, wy)| wx * wy * remainder(*x, *y, 2.5))).sum();
    // The mean of 1/r over the square is 4 ln(1 + √2).
    near("mean of G", mean + 4.0 * (1.0 + 2f64.sqrt()).ln(), 0.0, 1e-8);
}

#[test]
fn law_a_finer_lattice_of_loads_is_a_smaller_cell() {
    // n² equal loads on the cell are the lattice of side 1/n, whose kernel is n G(n r).
    for n in [2, 3] {
        let side = f64::from(n);
        let (x, y) = (0.11 / side, -0.37 / side);
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let wrap = |d: f64| d - d.round();
                sum += kernel(wrap(x + f64::from(i) / side), wrap(y + f64::from(j) / side), 2.0);
            }
        }
        close("lattice", sum, side * kernel(side * x, side * y, 2.0), 1e-11);
    }
}

#[test]
fn law_sums_of_higher_powers_do_not_depend_on_the_splitting() {
    let mut dice = Dice(4);
    let mut places: Vec<(f64, f64)> = (0..20).map(|_| (dice.roll() - 0.5, dice.roll() - 0.5)).collect();
    places.extend([(0.0, 0.0), (0.5, 0.5)]);
    for (x, y) in places {
        let want = image_sums(x, y, 2.0);
        near("S_0", want[0], remainder(x, y, 2.5), 2e-13);
        let series = RemainderSeries::new().sums(x, y);
        for alpha in [1.1, 2.5, 3.0] {
            let got = image_sums(x, y, alpha);
            for m in 0..ORDERS {
                // The terms that cancel grow as α^(2m+1), below 1e3 at α = 3.
                close("S_m", got[m], want[m], 1e-12 * alpha.powi(2 * m as i32));
            }
        }
        for m in 1..ORDERS {
            // Worth 1e-4 of a displacement and less, and fitted to that.
            close("table", series[m], want[m], 1e-6);
        }
    }
}

#[test]
fn val_sums_of_higher_powers_are_lattice_sums() {
    // 4 ζ(s) β(s) at the origin, s = 3/2, 5/2, 7/2 (Glasser, J. Math. Phys. 14:409, 1973); and plain sums elsewhere, whose tail beyond the
    // square of half-side N + ½ is that of an integral, ∫∫ 1/r^p = 4·2·∫₀^{π/4} cos^(p−2) / ((p − 2)(N + ½)^(p−2)), relative error (1/N)².
    let own = image_sums(0.0, 0.0, 2.5);
    close("S_1", own[1], 9.033_621_683_100_95, 1e-13);
    close("S_2", own[2], 5.090_258_233_665_483, 1e-13);
    close("S_3", own[3], 4.423_117_787_678_166, 1e-13);
    let (x, y) = (0.31, -0.44);
    let sums = image_sums(x, y, 2.5);
    for (m, power) in [(2, 5), (3, 7)] {
        let mut plain = 0.0;
        for i in -60..=60 {
            for j in -60..=60 {
                if (i, j) != (0, 0) {
                    plain += (x + f64::from(i)).hypot(y + f64::from(j)).powi(-power);
                }
            }
        }
        close("S_m", sums[m], plain, 1e-5);
    }
}
