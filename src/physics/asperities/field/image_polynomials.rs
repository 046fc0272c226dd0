//! Image sums by one polynomial for all pairs, vectorised.
//!
//! The exact sums, by cells or from a table, need a slow memory access for each pair. Spots outside a local
//! problem are fixed while it is solved, so six digits of the image sums are enough there. The field of the
//! images of one spot is a polynomial with nine digits; its coefficients contain the moments of the spot.

use super::ewald::{ORDERS, SERIES, chebyshev_coefficient, chebyshev_monomials, global};
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

/// Degree of [`ImageField`]; the measured error of the field of a spot of a tenth of the side is 7e-10.
const FIELD_DEGREE: usize = 14;

/// Coefficients of a polynomial in s and t, see [`Centre`].
type Coefficients<const N: usize> = [[f64; N]; N];

/// Coefficients of `Σ c_mn s^m t^n` over `m + n ≤ DEGREE`, rows of m by falling m and falling n.
///
/// `s = 8x² − 1` and `t = 8y² − 1`.
#[derive(Debug)]
pub(super) struct Centre {
    first: Coefficients<{ DEGREE + 1 }>,
    second: Coefficients<{ LOW_DEGREE + 1 }>,
}

/// Polynomials shared by the process; they have no parameters.
pub(super) static CENTRE: LazyLock<Centre> = LazyLock::new(Centre::new);

impl Centre {
    fn new() -> Self {
        Self { first: fit()[0], second: fit()[1] }
    }

    /// `S_0` and `S_1` for pairs at these distances, in units of the side.
    ///
    /// Inlined into a vectorised loop.
    #[inline(always)]
    pub(super) fn sums(&self, x: &[f64; LANES], y: &[f64; LANES]) -> [[f64; LANES]; 2] {
        let (s, t) = (squares(x), squares(y));
        [polynomial(&self.first, &s, &t), polynomial(&self.second, &s, &t)]
    }

    /// `S_0` alone.
    #[inline(always)]
    pub(super) fn first(&self, x: &[f64; LANES], y: &[f64; LANES]) -> [f64; LANES] {
        polynomial(&self.first, &squares(x), &squares(y))
    }
}

/// Coefficients of the image sums of all orders, shared by the process.
static ALL_ORDERS: LazyLock<[Coefficients<{ FIELD_DEGREE + 1 }>; ORDERS]> = LazyLock::new(fit);

/// Field of all images but the nearest of one spot.
#[derive(Debug)]
pub(super) struct ImageField(Coefficients<{ FIELD_DEGREE + 1 }>);

impl ImageField {
    /// Field of a spot with these moments \[m\].
    pub(super) fn of(moments: &[f64; ORDERS]) -> Self {
        let mut sum = [[0.0; FIELD_DEGREE + 1]; FIELD_DEGREE + 1];
        for (moment, order) in moments.iter().zip(ALL_ORDERS.iter()) {
            for (sum, term) in sum.iter_mut().flatten().zip(order.iter().flatten()) {
                *sum = moment.mul_add(*term, *sum);
            }
        }
        Self(sum)
    }

    /// Displacements \[m\] at these distances, in units of the side.
    ///
    /// Inlined into a vectorised loop.
    #[inline(always)]
    pub(super) fn at(&self, x: &[f64; LANES], y: &[f64; LANES]) -> [f64; LANES] {
        polynomial(&self.0, &squares(x), &squares(y))
    }
}

/// Chebyshev approximations of the image sums of all orders.
fn fit<const N: usize>() -> [Coefficients<N>; ORDERS] {
    let (degree, nodes) = (N - 1, N + 3);
    let place = |k: usize| 0.5 * (0.5 + 0.5 * (PI * (k as f64 + 0.5) / nodes as f64).cos()).sqrt();
    let samples: Vec<Vec<_>> =
        (0..nodes).map(|i| (0..nodes).map(|j| global(&SERIES, place(i), place(j))).collect()).collect();
    let monomials = chebyshev_monomials(N);
    let mut found = [[[0.0; N]; N]; ORDERS];
    for m in 0..N {
        for n in 0..N - m {
            for (found, coefficient) in found.iter_mut().zip(chebyshev_coefficient(&samples, m, n)) {
                for (p, left) in monomials[m].iter().enumerate() {
                    for (q, right) in monomials[n].iter().enumerate() {
                        found[degree - p][degree - q] += coefficient * left * right;
                    }
                }
            }
        }
    }
    found
}

/// `8d² − 1` of each distance.
#[inline(always)]
fn squares(d: &[f64; LANES]) -> [f64; LANES] {
    d.map(|d| (d * d).mul_add(8.0, -1.0))
}

#[inline(always)]
fn polynomial<const N: usize>(rows: &Coefficients<N>, s: &[f64; LANES], t: &[f64; LANES]) -> [f64; LANES] {
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
    use super::{CENTRE, ImageField, LANES};
    use crate::asperities::field::ewald::{IMAGES, image_sums};

    #[test]
    fn val_the_sums_have_the_digits_that_they_are_said_to_have() {
        let mut worst = [0.0f64; 2];
        let mut worst_field = 0.0f64;
        // A large spot: a tenth of the side.
        let field = ImageField::of(&std::array::from_fn(|order| 0.01f64.powi(order as i32)));
        for i in -20..=20 {
            for j in -20..=20 {
                let (x, y) = (0.025 * f64::from(i), 0.025 * f64::from(j));
                let exact = IMAGES.sums(x, y);
                let found = CENTRE.sums(&[x; LANES], &[y; LANES]);
                for (order, worst) in worst.iter_mut().enumerate() {
                    *worst = worst.max((found[order][0] / exact[order] - 1.0).abs());
                }
                let exact: f64 =
                    image_sums(x, y, 2.5).iter().rev().fold(0.0, |sum, order| 0.01f64.mul_add(sum, *order));
                worst_field = worst_field.max((field.at(&[x; LANES], &[y; LANES])[0] / exact - 1.0).abs());
            }
        }
        assert!(worst[0] < 3e-6 && worst[1] < 4e-3, "{worst:?}");
        assert!(worst_field < 2e-9, "{worst_field:e}");
    }
}
