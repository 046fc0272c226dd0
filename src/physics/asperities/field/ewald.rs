//! Displacement of a half-space by a periodic lattice of point loads, without its mean.
//!
//! The mean is removed by a uniform background, so the load is self-balanced.
//!
//! In units `πE* = 1`, `L = 1`: `G(r) = Σ_R erfc(α|r+R|)/|r+R| + 2π Σ_{q≠0} erfc(q/2α) cos(q·r)/q − 2√π/α`,
//! for any `α > 0` (Ewald). A plain sum of 1/r tails does not converge to it: at the paper's load it is wrong
//! by more than the rms height.

use multiversion::multiversion;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Argument beyond which terms are below rounding: `erfc(6.2)` is 2e-18.
const NEGLIGIBLE_ARGUMENT: f64 = 6.2;

/// `G(x, y)` for `0 < x² + y²`, `|x|, |y| ≤ ½`, by Ewald's method with splitting parameter `alpha`.
#[must_use]
pub fn kernel(x: f64, y: f64, alpha: f64) -> f64 {
    let r = x.hypot(y);
    near_images(x, y, alpha) + libm::erfc(alpha * r) / r + far_waves(x, y, alpha)
}

/// `G(x, y) − 1/r`: displacement by the images and the background, smooth at `r = 0`.
#[must_use]
pub fn remainder(x: f64, y: f64, alpha: f64) -> f64 {
    let r = x.hypot(y);
    // −erf(αr)/r, whose limit is −2α/√π.
    let own = if r > 0.0 { -libm::erf(alpha * r) / r } else { -2.0 * alpha / PI.sqrt() };
    near_images(x, y, alpha) + own + far_waves(x, y, alpha)
}

fn near_images(x: f64, y: f64, alpha: f64) -> f64 {
    let cells = (NEGLIGIBLE_ARGUMENT / alpha + 0.5).ceil() as i32;
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
    let waves = (NEGLIGIBLE_ARGUMENT * alpha / PI).ceil() as i32;
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

/// Number of orders of [`image_sums`].
pub const ORDERS: usize = 4;

/// `Γ(m + ½)` for m = 0 … 4.
const GAMMA: [f64; ORDERS + 1] = {
    const ROOT_PI: f64 = 1.772_453_850_905_516;
    [ROOT_PI, 0.5 * ROOT_PI, 0.75 * ROOT_PI, 1.875 * ROOT_PI, 6.5625 * ROOT_PI]
};

/// Image sums `S_m(x, y) = Σ_{R≠0} 1/|r + R|^(2m+1)`, m = 0 … 3, for `|x|, |y| ≤ ½`.
///
/// They are the field of the images of a source with the field `1/r^(2m+1)`, in units of the side.
/// The sum for `S_0` diverges; it is replaced by the [`remainder`], the sum without its mean.
///
/// Ewald's method for powers, with `s = m + ½` and the incomplete gamma functions `Γ(s, v) + γ(s, v) = Γ(s)`:
/// `S_m = Σ_{R≠0} Γ(s, α²|r+R|²)/(Γ(s)|r+R|^2s) − γ(s, α²r²)/(Γ(s) r^2s) + π/Γ(s)·[Σ_{q≠0} (q/2)^(2s−2)
/// Γ(1−s, q²/4α²) cos(q·r) + α^(2s−2)/(s−1)]` (Nijboer & de Wette, Physica 23:309, 1957).
#[must_use]
pub fn image_sums(x: f64, y: f64, alpha: f64) -> [f64; ORDERS] {
    let mut sums = [0.0; ORDERS];
    let cells = (NEGLIGIBLE_ARGUMENT / alpha + 0.5).ceil() as i32;
    for i in -cells..=cells {
        for j in -cells..=cells {
            if (i, j) != (0, 0) {
                let r = (x + f64::from(i)).hypot(y + f64::from(j));
                let v = (alpha * r).powi(2);
                let decay = (-v).exp();
                let (mut share, mut power) = (libm::erfc(alpha * r), alpha * r);
                let mut inverse = 1.0 / r;
                for (m, sum) in sums.iter_mut().enumerate() {
                    *sum += share * inverse;
                    // Γ(s + 1, v) = s Γ(s, v) + v^s e^(−v).
                    share += power * decay / GAMMA[m + 1];
                    power *= v;
                    inverse /= r * r;
                }
            }
        }
    }
    let v = alpha * alpha * (x * x + y * y);
    for (m, sum) in sums.iter_mut().enumerate() {
        // γ(s, v)/v^s = e^(−v) Σ_k v^k/(s(s + 1) … (s + k)): all terms positive, and right at r = 0.
        let (mut term, mut series, mut k) = (1.0, 0.0, m as f64 + 0.5);
        while term > 1e-18 * series {
            series += term;
            k += 1.0;
            term *= v / k;
        }
        *sum -= alpha.powi(2 * m as i32 + 1) * (-v).exp() * series / GAMMA[m + 1];
    }
    let waves = (NEGLIGIBLE_ARGUMENT * alpha / PI).ceil() as i32;
    for i in -waves..=waves {
        for j in -waves..=waves {
            let (qx, qy) = (2.0 * PI * f64::from(i), 2.0 * PI * f64::from(j));
            let (half, phase) = (0.5 * qx.hypot(qy), (qx * x + qy * y).cos());
            let (mut tail, mut power) = (PI.sqrt() * libm::erfc(half / alpha), half / alpha);
            let decay = (-power * power).exp();
            let square = power * power;
            for (m, sum) in sums.iter_mut().enumerate() {
                let order = m as i32;
                if (i, j) == (0, 0) {
                    *sum += PI / GAMMA[m] * alpha.powi(2 * order - 1) / (m as f64 - 0.5);
                    continue;
                }
                *sum += PI / GAMMA[m] * half.powi(2 * order - 1) * tail * phase;
                // Γ(c + 1, w) = c Γ(c, w) + w^c e^(−w), downwards.
                power /= square;
                tail = (tail - power * decay) / (-0.5 - m as f64);
            }
        }
    }
    sums
}

/// Degree in `(2x)²` and `(2y)²` at which the series is below rounding.
///
/// The nearest image is a whole side away.
const DEGREE: usize = 24;

/// Cells on half a side for `S_0`, and terms along each direction.
///
/// Half a cell is 1/80 and the nearest image at least ½ away: `80⁻⁸` is 6e-16.
const CELLS: usize = 20;
const TERMS: usize = 8;

/// Cells and terms for the higher orders, of which seven digits are enough.
///
/// These contribute 1e-4 of a displacement or less.
/// The table is small because loading the coefficients from memory dominates the cost of a pair.
const COARSE_CELLS: usize = 14;
const COARSE_TERMS: usize = 6;
const COARSE_ALL: usize = COARSE_TERMS * (COARSE_TERMS + 1) / 2;

/// [`image_sums`] as polynomials on small cells, fast enough for every pair.
#[derive(Debug, Clone)]
pub struct RemainderSeries {
    /// Coefficients of `S_0`, of `t^q s^p` by falling q, then falling p, by cells of `0 ≤ y ≤ x ≤ ½`.
    /// s and t run from −1 to 1 through a cell.
    fine: Vec<[[f64; TERMS]; TERMS]>,
    /// Coefficients of all orders, of `s^p t^q`, `p + q ≤ 5`, by falling p, then falling q.
    coarse: Vec<[[f32; ORDERS]; COARSE_ALL]>,
}

/// Chebyshev series on the whole square, from which all polynomials are derived.
pub(super) static SERIES: LazyLock<Vec<Vec<[f64; ORDERS]>>> = LazyLock::new(global_series);

/// Table shared by the process; it has no parameters.
pub(crate) static IMAGES: LazyLock<RemainderSeries> = LazyLock::new(RemainderSeries::new);

impl RemainderSeries {
    /// Polynomials through [`image_sums`], derived from one Chebyshev series for the whole square.
    #[must_use]
    pub fn new() -> Self {
        let rows = &SERIES;
        Self {
            fine: fit::<TERMS>(rows, CELLS).iter().map(|cell| cell.map(|row| row.map(|c| c[0]))).collect(),
            coarse: fit::<COARSE_TERMS>(rows, COARSE_CELLS).iter().map(shorten).collect(),
        }
    }

    /// `G(x, y) − 1/r` for `|x|, |y| ≤ ½`.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> f64 {
        remainder_at(self, x, y)
    }

    /// [`image_sums`] for `|x|, |y| ≤ ½`.
    ///
    /// The relative error is 1e-6 for the orders above the first.
    #[must_use]
    pub fn sums(&self, x: f64, y: f64) -> [f64; ORDERS] {
        sums_at(self, x, y)
    }

    /// All orders at several points, for inlining into a loop compiled for the machine's vectors.
    ///
    /// The tabulated coefficients of each point are evaluated in vectors across orders, the remaining steps
    /// across points.
    #[inline(always)]
    pub(crate) fn local<const L: usize>(&self, x: &[f64; L], y: &[f64; L]) -> [[f64; ORDERS]; L] {
        let mut sums = [[0.0; ORDERS]; L];
        for k in 0..L {
            let (number, s, t) = cell_of::<COARSE_CELLS>(x[k], y[k]);
            let cell = &self.coarse[number];
            let (a, b, c) = (row::<0>(cell, t), row::<1>(cell, t), row::<2>(cell, t));
            let (d, e, f) = (row::<3>(cell, t), row::<4>(cell, t), row::<5>(cell, t));
            let square = s * s;
            sums[k] = step(step(step(a, s, b), square, step(c, s, d)), square, step(e, s, f));
        }
        let first = self.first(x, y);
        for k in 0..L {
            sums[k][0] = first[k];
        }
        sums
    }

    /// `S_0` at several points, for inlining into a vectorised loop.
    #[inline(always)]
    fn first<const L: usize>(&self, x: &[f64; L], y: &[f64; L]) -> [f64; L] {
        let mut lanes = [[0.0; TERMS]; L];
        let mut places = [0.0; L];
        for k in 0..L {
            let (number, s, t) = cell_of::<CELLS>(x[k], y[k]);
            let cell = &self.fine[number];
            let mut sum = cell[0];
            for row in &cell[1..] {
                for p in 0..TERMS {
                    sum[p] = sum[p].mul_add(t, row[p]);
                }
            }
            (lanes[k], places[k]) = (sum, s);
        }
        let mut first = [0.0; L];
        for k in 0..L {
            for lane in lanes[k] {
                first[k] = places[k].mul_add(first[k], lane);
            }
        }
        first
    }
}

impl Default for RemainderSeries {
    fn default() -> Self {
        Self::new()
    }
}

/// Cell of a point, and the point's coordinates in it.
#[inline(always)]
fn cell_of<const N: usize>(x: f64, y: f64) -> (usize, f64, f64) {
    let (x, y) = (x.abs(), y.abs());
    let (u, v) = (x.max(y) * (2 * N) as f64, x.min(y) * (2 * N) as f64);
    let i = (u as usize).min(N - 1);
    let j = (v as usize).min(i);
    (i * (i + 1) / 2 + j, 2.0 * (u - i as f64) - 1.0, 2.0 * (v - j as f64) - 1.0)
}

/// `high·t + low`, for all orders.
#[inline(always)]
fn step(high: [f64; ORDERS], t: f64, low: [f64; ORDERS]) -> [f64; ORDERS] {
    [
        high[0].mul_add(t, low[0]),
        high[1].mul_add(t, low[1]),
        high[2].mul_add(t, low[2]),
        high[3].mul_add(t, low[3]),
    ]
}

/// Polynomial in t that multiplies `s^(5−R)`.
///
/// The rows are independent of one another.
#[inline(always)]
fn row<const R: usize>(cell: &[[f32; ORDERS]; COARSE_ALL], t: f64) -> [f64; ORDERS] {
    let from = R * (R + 1) / 2;
    let mut sum = long(&cell[from]);
    for q in 1..=R {
        sum = step(sum, t, long(&cell[from + q]));
    }
    sum
}

#[inline(always)]
fn long(short: &[f32; ORDERS]) -> [f64; ORDERS] {
    [f64::from(short[0]), f64::from(short[1]), f64::from(short[2]), f64::from(short[3])]
}

/// Terms of the lowest degrees, in single precision.
fn shorten(cell: &[[[f64; ORDERS]; COARSE_TERMS]; COARSE_TERMS]) -> [[f32; ORDERS]; COARSE_ALL] {
    let mut short = [[0.0; ORDERS]; COARSE_ALL];
    for row in 0..COARSE_TERMS {
        for q in 0..=row {
            // By falling q, then falling p, where p = 5 − row.
            short[row * (row + 1) / 2 + row - q] = cell[COARSE_TERMS - 1 - q][row].map(|c| c as f32);
        }
    }
    short
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn remainder_at(series: &RemainderSeries, x: f64, y: f64) -> f64 {
    series.first(&[x], &[y])[0]
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn sums_at(series: &RemainderSeries, x: f64, y: f64) -> [f64; ORDERS] {
    series.local(&[x], &[y])[0]
}

/// Coefficients of `t^q s^p`, by falling q, then falling p, on every cell.
///
/// The polynomials have `N` terms per direction.
fn fit<const N: usize>(rows: &[Vec<[f64; ORDERS]>], cells: usize) -> Vec<[[[f64; ORDERS]; N]; N]> {
    let angle = |k: usize| PI * (k as f64 + 0.5) / N as f64;
    let monomials = chebyshev_monomials(N);
    let half = 0.25 / cells as f64;
    let place = |cell: usize, k: usize| (2 * cell + 1) as f64 * half + half * angle(k).cos();
    let mut all = Vec::with_capacity(cells * (cells + 1) / 2);
    for i in 0..cells {
        for j in 0..=i {
            let samples: Vec<Vec<_>> =
                (0..N).map(|k| (0..N).map(|l| global(rows, place(i, k), place(j, l))).collect()).collect();
            let mut cell = [[[0.0; ORDERS]; N]; N];
            for m in 0..N {
                for n in 0..N {
                    let coefficient = chebyshev_coefficient(&samples, m, n);
                    // T_m(s) T_n(t) in powers of s and t.
                    for (p, left) in monomials[m].iter().enumerate() {
                        for (q, right) in monomials[n].iter().enumerate() {
                            let term = &mut cell[N - 1 - q][N - 1 - p];
                            *term = step(coefficient, left * right, *term);
                        }
                    }
                }
            }
            all.push(cell);
        }
    }
    all
}

/// `T_0 … T_(n−1)` in powers of their argument.
pub(super) fn chebyshev_monomials(n: usize) -> Vec<Vec<f64>> {
    let mut all = vec![vec![1.0], vec![0.0, 1.0]];
    for m in 2..n {
        let mut next = vec![0.0; m + 1];
        for (p, c) in all[m - 1].iter().enumerate() {
            next[p + 1] += 2.0 * c;
        }
        for (p, c) in all[m - 2].iter().enumerate() {
            next[p] -= c;
        }
        all.push(next);
    }
    all
}

/// Coefficient of `T_m T_n` of a function sampled at the Chebyshev nodes.
pub(super) fn chebyshev_coefficient(samples: &[Vec<[f64; ORDERS]>], m: usize, n: usize) -> [f64; ORDERS] {
    let nodes = samples.len();
    let angle = |k: usize| PI * (k as f64 + 0.5) / nodes as f64;
    let halves = if m == 0 { 0.5 } else { 1.0 } * if n == 0 { 0.5 } else { 1.0 };
    let scale = halves * 4.0 / (nodes * nodes) as f64;
    let mut sum = [0.0; ORDERS];
    for (i, row) in samples.iter().enumerate() {
        let left = (m as f64 * angle(i)).cos();
        for (j, sample) in row.iter().enumerate() {
            let weight = scale * left * (n as f64 * angle(j)).cos();
            for (s, value) in sum.iter_mut().zip(sample) {
                *s += weight * value;
            }
        }
    }
    sum
}

/// Coefficients of `T_m(ξ) T_n(η)`, `m + n ≤ DEGREE`, of [`image_sums`] by rows of m.
fn global_series() -> Vec<Vec<[f64; ORDERS]>> {
    let nodes = DEGREE + 4;
    let angle = |k: usize| PI * (k as f64 + 0.5) / nodes as f64;
    // ξ = 8x² − 1 ∈ [−1, 1] for x ∈ [0, ½].
    let coordinate = |k: usize| ((angle(k).cos() + 1.0) / 8.0).sqrt();
    let samples: Vec<Vec<_>> = (0..nodes)
        .map(|i| (0..nodes).map(|j| image_sums(coordinate(i), coordinate(j), 2.5)).collect())
        .collect();
    (0..=DEGREE).map(|m| (0..=DEGREE - m).map(|n| chebyshev_coefficient(&samples, m, n)).collect()).collect()
}

pub(super) fn global(rows: &[Vec<[f64; ORDERS]>], x: f64, y: f64) -> [f64; ORDERS] {
    let xi = 8.0 * x * x - 1.0;
    let eta = 8.0 * y * y - 1.0;
    let (mut next, mut after) = ([0.0; ORDERS], [0.0; ORDERS]);
    for row in rows.iter().rev() {
        let line = clenshaw(row, eta);
        let value = [0, 1, 2, 3].map(|k| line[k] + 2.0 * xi * next[k] - after[k]);
        (after, next) = (next, value);
    }
    // The last step of the Clenshaw recurrence uses the argument once, not twice.
    [0, 1, 2, 3].map(|k| next[k] - xi * after[k])
}

fn clenshaw(coefficients: &[[f64; ORDERS]], t: f64) -> [f64; ORDERS] {
    let (mut next, mut after) = ([0.0; ORDERS], [0.0; ORDERS]);
    for coefficient in coefficients.iter().rev() {
        let value = [0, 1, 2, 3].map(|k| coefficient[k] + 2.0 * t * next[k] - after[k]);
        (after, next) = (next, value);
    }
    [0, 1, 2, 3].map(|k| next[k] - t * after[k])
}
