//! The displacement of a periodic lattice of point loads on a half-space, without its mean: the self-balanced load.
//!
//! In units `πE* = 1`, `L = 1`:
//! `G(r) = Σ_R erfc(α|r+R|)/|r+R| + 2π Σ_{q≠0} erfc(q/2α) cos(q·r)/q − 2√π/α`, for any `α > 0` (Ewald).
//! A plain sum of 1/r tails does not converge to it: at the paper's load it is wrong by more than the rms height.

use std::f64::consts::PI;

/// `erfc(6.2)` is 2e-18: beyond this argument a term is no part of a double.
const REACH: f64 = 6.2;

/// `G(x, y)` for `0 < x² + y²`, `|x|, |y| ≤ ½`, by Ewald's method with splitting parameter `alpha`.
#[must_use]
pub fn kernel(x: f64, y: f64, alpha: f64) -> f64 {
    let r = x.hypot(y);
    near_images(x, y, alpha) + libm::erfc(alpha * r) / r + far_waves(x, y, alpha)
}

/// `G(x, y) − 1/r`: the displacement of the images and the background at a distance from the load, smooth at `r = 0` too.
#[must_use]
pub fn remainder(x: f64, y: f64, alpha: f64) -> f64 {
    let r = x.hypot(y);
    // −erf(αr)/r, whose limit is −2α/√π.
    let own = if r > 0.0 { -libm::erf(alpha * r) / r } else { -2.0 * alpha / PI.sqrt() };
    near_images(x, y, alpha) + own + far_waves(x, y, alpha)
}

fn near_images(x: f64, y: f64, alpha: f64) -> f64 {
    let cells = (REACH / alpha + 0.5).ceil() as i32;
    let mut sum = 0.0;
    for i in -cells..=cells {
        for j in -cells..=cells {
            if (i, j) != (0, 0) {
                let r = (x + f64::from(i)).hypot(y + f64::from(j));
                sum += libm::erfc(alpha * r) / r;
            }
        }
    }
    sum
}

fn far_waves(x: f64, y: f64, alpha: f64) -> f64 {
    let waves = (REACH * alpha / PI).ceil() as i32;
    let mut sum = 0.0;
    for i in -waves..=waves {
        for j in -waves..=waves {
            if (i, j) != (0, 0) {
                let (qx, qy) = (2.0 * PI * f64::from(i), 2.0 * PI * f64::from(j));
                let q = qx.hypot(qy);
                sum += libm::erfc(q / (2.0 * alpha)) * (qx * x + qy * y).cos() / q;
            }
        }
    }
    2.0 * PI * sum - 2.0 * PI.sqrt() / alpha
}

/// Degree in `(2x)²` and `(2y)²` at which the series has fallen below rounding: the nearest image is a whole side away.
const DEGREE: usize = 22;

/// [`remainder`] as a Chebyshev series, fast enough to be taken for every pair.
#[derive(Debug, Clone)]
pub struct RemainderSeries {
    /// Coefficients of `T_m(ξ) T_n(η)`, `m + n ≤ DEGREE`, by rows of m.
    rows: Vec<Vec<f64>>,
}

impl RemainderSeries {
    /// The series of [`remainder`].
    #[must_use]
    pub fn new() -> Self {
        let nodes = DEGREE + 4;
        let angle = |k: usize| PI * (k as f64 + 0.5) / nodes as f64;
        // ξ = 8x² − 1 ∈ [−1, 1] for x ∈ [0, ½].
        let coordinate = |k: usize| ((angle(k).cos() + 1.0) / 8.0).sqrt();
        let samples: Vec<Vec<f64>> =
            (0..nodes).map(|i| (0..nodes).map(|j| remainder(coordinate(i), coordinate(j), 2.5)).collect()).collect();
        let rows = (0..=DEGREE)
            .map(|m| {
                (0..=DEGREE - m)
                    .map(|n| {
                        let mut sum = 0.0;
                        for (i, row) in samples.iter().enumerate() {
                            for (j, sample) in row.iter().enumerate() {
                                sum += sample * (m as f64 * angle(i)).cos() * (n as f64 * angle(j)).cos();
                            }
                        }
                        let halves = if m == 0 { 0.5 } else { 1.0 } * if n == 0 { 0.5 } else { 1.0 };
                        sum * halves * 4.0 / (nodes * nodes) as f64
                    })
                    .collect()
            })
            .collect();
        Self { rows }
    }

    /// `G(x, y) − 1/r` for `|x|, |y| ≤ ½`.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let xi = 8.0 * x * x - 1.0;
        let eta = 8.0 * y * y - 1.0;
        let (mut next, mut after) = (0.0, 0.0);
        for row in self.rows.iter().skip(1).rev() {
            let value = clenshaw(row, eta) + 2.0 * xi * next - after;
            (after, next) = (next, value);
        }
        self.rows.first().map_or(0.0, |row| clenshaw(row, eta)) + xi * next - after
    }
}

impl Default for RemainderSeries {
    fn default() -> Self {
        Self::new()
    }
}

fn clenshaw(coefficients: &[f64], t: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for coefficient in coefficients.iter().skip(1).rev() {
        let value = coefficient + 2.0 * t * next - after;
        (after, next) = (next, value);
    }
    coefficients.first().copied().unwrap_or(0.0) + t * next - after
}
