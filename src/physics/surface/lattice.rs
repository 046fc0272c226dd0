//! Sums of powers over the modes of a periodic square, `Σ (kx² + ky²)^(−s)` with `1 ≤ kx² + ky² < ζ²`.
//!
//! Modes with `max(|kx|, |ky|)` below [`DIRECT`] are added one by one. Those with `max(|kx|, |ky|) = a`
//! beyond it form four equal rows, and each row is a sum over b of `f(b) = (a² + b²)^(−s)` that the
//! Euler–Maclaurin formula replaces by an integral and derivatives at the last mode. The number of operations
//! is proportional to ζ, not to ζ².
//!
//! Error: f is analytic within a distance a of the real axis. The first omitted term is below
//! `a⁻⁶` and the exponential remainder of the formula below `e^(−2πa)`, relative to the row: 2e-13 and 0 at a
//! = 128. The edge of the band is exact: the last mode of each row follows from integers.

use super::spectrum::{Density, MomentSums, Moments, Spectrum};
use rayon::prelude::*;

/// Rows from which on the Euler–Maclaurin formula replaces the sum.
const DIRECT: u32 = 128;
/// Rows of a block.
const BLOCK: usize = 4096;

/// Nodes on (0, 1) and weights of Gauss's rule of ten points on (−1, 1), which is symmetric.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_3),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_1),
];

/// Four equal rows of modes, `(±a, b)` and `(b, ±a)` with `|b| ≤ last ≤ a`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Row {
    a: u64,
    last: u64,
}

/// Rows below ζ beyond the block of modes that are added one by one.
fn far_rows(magnification: u32) -> impl Iterator<Item = Row> {
    let edge = u64::from(magnification).pow(2);
    (u64::from(DIRECT)..u64::from(magnification))
        .map(move |a| Row { a, last: (edge - 1 - a * a).isqrt().min(a) })
}

/// Sums over the modes of a spectrum that is no power law, one by one.
fn direct(of: &Spectrum) -> MomentSums {
    let (density, reach) = (Density::of(of), i64::from(of.magnification) - 1);
    let row = |kx: i64| {
        let mut sums = MomentSums::default();
        (-reach..=reach).for_each(|ky| sums.add((kx * kx + ky * ky).unsigned_abs(), density.at(kx, ky)));
        sums
    };
    // Rows are computed in parallel and added in order.
    let rows: Vec<MomentSums> = (-reach..=reach).into_par_iter().map(row).collect();
    rows.into_iter().fold(MomentSums::default(), MomentSums::merge)
}

/// Sums over all modes of the power, `k²` and `k⁴` times the power.
pub(super) fn sums(of: &Spectrum) -> MomentSums {
    if !of.shape.is_plain() {
        return direct(of);
    }
    let mut sums = MomentSums::default();
    let density = Density::of(of);
    let reach = i64::from(of.magnification.min(DIRECT)) - 1;
    for kx in -reach..=reach {
        for ky in -reach..=reach {
            sums.add((kx * kx + ky * ky).unsigned_abs(), density.at(kx, ky));
        }
    }
    let exponents = [0.0, 1.0, 2.0].map(|p| of.hurst + 1.0 - p);
    let whole = exponents.map(|s| Shape::of(s, 1.0));
    let mut rows = far_rows(of.magnification).peekable();
    // Rows are added in blocks, so that rounding errors do not grow with their number.
    while rows.peek().is_some() {
        let mut block = [0.0; 3];
        for row in rows.by_ref().take(BLOCK) {
            for ((sum, s), whole) in block.iter_mut().zip(exponents).zip(&whole) {
                *sum += row.sum(s, whole);
            }
        }
        sums = sums.merge(MomentSums::of(block.map(|sum| sum * of.prefactor())));
    }
    sums
}

/// The function `φ(t) = (1 + t²)^(−s)` at the end t of a row: its integral from 0, its value, first and third
/// derivative.
#[derive(Debug, Clone, Copy)]
struct Shape {
    integral: f64,
    value: f64,
    first: f64,
    third: f64,
}

impl Shape {
    fn of(s: f64, t: f64) -> Self {
        let one = 1.0 + t * t;
        let value = one.powf(-s);
        // Two panels: the poles at ±i are at least eight half-widths away, and the error is below 1e-18.
        let half = 0.25 * t;
        let panel = |centre: f64| -> f64 {
            let at = |u: f64| (1.0 + u * u).powf(-s);
            GAUSS
                .iter()
                .map(|(node, weight)| weight * (at(centre - half * node) + at(centre + half * node)))
                .sum::<f64>()
                * half
        };
        let integral = panel(half) + panel(3.0 * half);
        let first = -2.0 * s * t * value / one;
        let third = 4.0 * s * (s + 1.0) * t * value / (one * one) * (3.0 - 2.0 * (s + 2.0) * t * t / one);
        Self { integral, value, first, third }
    }
}

impl Row {
    /// Sum over the modes of the four rows; `whole` is the shape of a row that ends at `b = a`.
    fn sum(self, s: f64, whole: &Shape) -> f64 {
        let a = self.a as f64;
        let ends_at_corner = self.last == self.a;
        let shape = if ends_at_corner { *whole } else { Shape::of(s, self.last as f64 / a) };
        let end = shape.value + shape.first / (6.0 * a) - shape.third / (360.0 * a.powi(3));
        // A corner (±a, ±a) is the end of two rows.
        let corners = if ends_at_corner { 4.0 * shape.value } else { 0.0 };
        a.powf(-2.0 * s) * (4.0 * (2.0 * a * shape.integral + end) - corners)
    }
}

impl Spectrum {
    /// Moments of the discrete modes of a periodic square.
    ///
    /// The amplitudes are fixed, with the chosen normalisation.
    ///
    /// They are sums in place of the integrals of [`Self::moments`]. The time is proportional to ζ for Eq
    /// 10, and
    /// to ζ² for other shapes.
    #[must_use]
    pub fn lattice_moments(&self) -> Moments {
        sums(self).moments(self)
    }
}

#[cfg(test)]
mod tests {
    use super::{DIRECT, Row, Shape, far_rows};

    /// Rows, and with them the effort, grow with ζ and not with its square.
    #[test]
    fn law_the_number_of_rows_is_that_of_the_magnification() {
        assert_eq!(far_rows(DIRECT).count(), 0);
        assert_eq!(far_rows(1 << 20).count(), (1 << 20) - DIRECT as usize);
        assert_eq!(far_rows(200).next(), Some(Row { a: 128, last: 128 }));
        // 195² + 44² < 200² ≤ 195² + 45²
        assert_eq!(far_rows(200).nth(195 - 128), Some(Row { a: 195, last: 44 }));
    }

    #[test]
    fn law_a_row_is_the_sum_over_its_modes() {
        for (a, last) in [(128, 128), (128, 127), (500, 500), (500, 3), (500, 0), (4000, 2500)] {
            for s in [1.999, 1.8, 1.0, 0.8, 0.05, 0.0, -0.2, -0.999] {
                let mode = |b: f64| ((a * a) as f64 + b * b).powf(-s);
                let line: f64 = (1..=last).map(|b| 2.0 * mode(b as f64)).sum::<f64>() + mode(0.0);
                let corners = if last == a { 4.0 * mode(a as f64) } else { 0.0 };
                let expected = 4.0 * line - corners;
                let found = Row { a, last }.sum(s, &Shape::of(s, 1.0));
                // The first omitted term (2e-13), and rounding of up to 4000 additions.
                assert!(
                    (found / expected - 1.0).abs() < 1e-12,
                    "a = {a}, last = {last}, s = {s}: {found} {expected}"
                );
            }
        }
    }
}
