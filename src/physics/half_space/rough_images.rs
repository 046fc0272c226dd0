//! Image sums with six digits: one polynomial for all pairs, vectorised.
//!
//! Spots outside a local problem are fixed while it is solved, so six digits of the image sums are enough there.
//! The exact sums, by cells or from a table, would need a slow memory access for each pair.

use super::ewald::{SERIES, chebyshev_coefficient, chebyshev_monomials, global};
use super::spot_field::LANES;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Degree in `x²` and `y²` together, of `S_0` and of `S_1`.
///
/// With `ξ = 8x² − 1` on the square, the nearest image is at an ellipse of 5.8, and `5.8^−8` is 8e-7.
/// The measured errors are 1.3e-6 of `S_0` and 2e-3 of `S_1`.
/// `S_1` contributes 1e-4 of `S_0`, and the higher orders are neglected.
const DEGREE: usize = 8;
const LOW_DEGREE: usize = 4;

/// Coefficients of `Σ c_mn s^m t^n` over `m + n ≤ DEGREE`, rows of m by falling m and falling n.
///
/// `s = 8x² − 1` and `t = 8y² − 1`.
#[derive(Debug)]
pub(super) struct Centre {
    first: [[f64; DEGREE + 1]; DEGREE + 1],
    second: [[f64; LOW_DEGREE + 1]; LOW_DEGREE + 1],
}

/// Polynomials shared by the process; they have no parameters.
pub(super) static CENTRE: LazyLock<Centre> = LazyLock::new(Centre::new);

impl Centre {
    fn new() -> Self {
        let nodes = DEGREE + 4;
        let place = |k: usize| 0.5 * (0.5 + 0.5 * (PI * (k as f64 + 0.5) / nodes as f64).cos()).sqrt();
        let samples: Vec<Vec<_>> = (0..nodes).map(|i| (0..nodes).map(|j| global(&SERIES, place(i), place(j))).collect()).collect();
        let (mut first, mut second) = ([[0.0; DEGREE + 1]; DEGREE + 1], [[0.0; LOW_DEGREE + 1]; LOW_DEGREE + 1]);
        let monomials = chebyshev_monomials(DEGREE + 1);
        for m in 0..=DEGREE {
            for n in 0..=DEGREE - m {
                let coefficient = chebyshev_coefficient(&samples, m, n);
                for (p, left) in monomials[m].iter().enumerate() {
                    for (q, right) in monomials[n].iter().enumerate() {
                        first[DEGREE - p][DEGREE - q] += coefficient[0] * left * right;
                        if m + n <= LOW_DEGREE {
                            second[LOW_DEGREE - p][LOW_DEGREE - q] += coefficient[1] * left * right;
                        }
                    }
                }
            }
        }
        Self { first, second }
    }

    /// `S_0` and `S_1` for pairs at these distances, in units of the side.
    ///
    /// Inlined into a vectorised loop.
    #[inline(always)]
    pub(super) fn sums(&self, x: &[f64; LANES], y: &[f64; LANES]) -> [[f64; LANES]; 2] {
        let square = |d: &[f64; LANES]| d.map(|d| (d * d).mul_add(8.0, -1.0));
        let (s, t) = (square(x), square(y));
        [polynomial(&self.first, &s, &t), polynomial(&self.second, &s, &t)]
    }
}

#[inline(always)]
fn polynomial<const N: usize>(rows: &[[f64; N]; N], s: &[f64; LANES], t: &[f64; LANES]) -> [f64; LANES] {
    let mut sum = [0.0_f64; LANES];
    for (m, row) in rows.iter().enumerate() {
        // In row m, which multiplies s^(N−1−m), terms above the degree are zero.
        let mut line = [0.0_f64; LANES];
        for term in &row[N - 1 - m..] {
            for k in 0..LANES {
                line[k] = line[k].mul_add(t[k], *term);
            }
        }
        for k in 0..LANES {
            sum[k] = sum[k].mul_add(s[k], line[k]);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::{CENTRE, LANES};
    use crate::physics::half_space::ewald::IMAGES;

    #[test]
    fn val_the_sums_have_the_digits_that_they_are_said_to_have() {
        let mut worst = [0.0f64; 2];
        for i in -20..=20 {
            for j in -20..=20 {
                let (x, y) = (0.025 * f64::from(i), 0.025 * f64::from(j));
                let exact = IMAGES.sums(x, y);
                let found = CENTRE.sums(&[x; LANES], &[y; LANES]);
                for (order, worst) in worst.iter_mut().enumerate() {
                    *worst = worst.max((found[order][0] / exact[order] - 1.0).abs());
                }
            }
        }
        assert!(worst[0] < 3e-6 && worst[1] < 4e-3, "{worst:?}");
    }
}
