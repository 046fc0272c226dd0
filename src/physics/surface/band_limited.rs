//! Interpolation of heights and derivatives of a band-limited periodic surface.
//!
//! A surface of Eq 10 has no mode at or above `q1`, so a grid with more than two points per shortest
//! wavelength determines it. Any value between the points is a sum over the grid with the cardinal sine. A
//! Kaiser–Bessel window of half width `m` points makes the sum local. With `p` points per shortest wavelength
//! its relative error is about `exp(−πm(1 − 2/p))`. `m` is chosen so that this is below the rounding error of
//! the heights. Derivatives are those of this sum, with spectral accuracy and without a transform.

use multiversion::multiversion;
use ndarray::ArrayView2;
use std::f64::consts::PI;

/// Exponent at which the window's error is at rounding level: `exp(−34) = 1.7e-15`.
const DECAY: f64 = 34.0;

/// Height and derivatives at one point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Jet {
    /// Height h \[m\].
    pub height_m: f64,
    /// Gradient (∂h/∂x, ∂h/∂y).
    pub gradient: [f64; 2],
    /// ∂²h/∂x², ∂²h/∂x∂y, ∂²h/∂y² \[1/m\].
    pub hessian_1_m: [f64; 3],
}

/// Periodic grid of heights, interpreted as samples of a band-limited function.
#[derive(Debug, Clone)]
pub struct BandLimited<'a> {
    heights: ArrayView2<'a, f64>,
    spacing: f64,
    taps: Taps,
}

/// Maximum number of grid points in the sum along one direction.
///
/// The table is padded to whole vectors.
const MAX_TAPS: usize = 128;
const LANES: usize = 8;

/// Number of terms of the kernel polynomials.
///
/// The kernel within half a spacing of a point has frequencies below `2π`.
/// From the seventh term on, each term therefore reduces the error by a factor of at least ten.
const TERMS: usize = 24;

/// Kernel of each nearby grid point and its derivatives, as polynomials in the position between two points.
#[derive(Debug, Clone)]
struct Taps {
    half_width: i64,
    /// Coefficients of the kernel and of its first and second derivative.
    ///
    /// They are stored by power, highest first, each for all points.
    coefficients: [Vec<f64>; 3],
    /// Number of points, and the padded number.
    count: usize,
    padded: usize,
}

/// Value, first and second derivative of the kernel at each point.
struct Weights([[f64; MAX_TAPS]; 3]);

#[derive(Debug, Clone, Copy)]
struct Window {
    half_width: f64,
    beta: f64,
    norm: f64,
}

impl<'a> BandLimited<'a> {
    /// Heights \[m\] on a square grid of side `length_m` with `points_per_shortest_wavelength > 2`.
    ///
    /// Down to 2.5 points the error is below rounding. Closer to 2 it grows, since the sum has at most
    /// [`MAX_TAPS`] points.
    #[must_use]
    pub fn new(heights: ArrayView2<'a, f64>, length_m: f64, points_per_shortest_wavelength: f64) -> Self {
        let window = Window::new(points_per_shortest_wavelength);
        Self { heights, spacing: length_m / heights.nrows() as f64, taps: Taps::new(&window) }
    }

    /// Number of points on each side of a point that its derivatives depend on.
    pub(super) fn reach(points_per_shortest_wavelength: f64) -> usize {
        Window::new(points_per_shortest_wavelength).half_width as usize
    }

    /// Weights of the points around a grid point in its first and second derivative along a line, for a
    /// spacing of 1.
    pub(super) fn stencils(points_per_shortest_wavelength: f64) -> [Vec<f64>; 2] {
        let window = Window::new(points_per_shortest_wavelength);
        let reach = window.half_width as i32;
        [1, 2].map(|derivative| (-reach..=reach).map(|k| window.kernel(f64::from(-k))[derivative]).collect())
    }

    /// Height and derivatives at (x, y) \[m\], anywhere in the periodic plane.
    #[must_use]
    pub fn jet(&self, x: f64, y: f64) -> Jet {
        let (row, across) = self.weights(x);
        let (column, along) = self.weights(y);
        let n = self.heights.nrows();
        let count = self.taps.count;
        // Sum over the rows first, for all columns at once.
        let mut sums = [[0.0; MAX_TAPS]; 3];
        let mut line = [0.0; MAX_TAPS];
        for k in 0..count {
            let heights = self.heights.row((row + k) % n);
            match heights.as_slice().and_then(|line| line.get(column..column + self.taps.padded)) {
                Some(near) => gather(near, across.of(k), &mut sums),
                // Across the edge of the square.
                None => {
                    for (place, at) in line.iter_mut().zip(column..column + count) {
                        *place = heights[at % n];
                    }
                    gather(&line[..self.taps.padded], across.of(k), &mut sums);
                }
            }
        }
        let [scale, twice] = [1.0 / self.spacing, 1.0 / (self.spacing * self.spacing)];
        let of = |down: usize, right: usize| {
            sums[down][..count].iter().zip(&along.0[right]).map(|(s, w)| s * w).sum::<f64>()
        };
        Jet {
            height_m: of(0, 0),
            gradient: [scale * of(1, 0), scale * of(0, 1)],
            hessian_1_m: [twice * of(2, 0), twice * of(1, 1), twice * of(0, 2)],
        }
    }

    /// First grid index of the sum, and the weights of value and derivatives.
    ///
    /// The weights of the first and second derivative are in units of the spacing.
    fn weights(&self, coordinate: f64) -> (usize, Weights) {
        let n = self.heights.nrows() as i64;
        let place = coordinate / self.spacing;
        let base = place.floor();
        let mut weights = Weights([[0.0; MAX_TAPS]; 3]);
        self.taps.evaluate(place - base - 0.5, &mut weights);
        ((base as i64 + 1 - self.taps.half_width).rem_euclid(n) as usize, weights)
    }
}

impl Weights {
    fn of(&self, k: usize) -> [f64; 3] {
        [self.0[0][k], self.0[1][k], self.0[2][k]]
    }
}

/// Adds a line of heights, multiplied by each of three weights.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn gather(line: &[f64], weights: [f64; 3], sums: &mut [[f64; MAX_TAPS]; 3]) {
    let [first, second, third] = sums;
    for (((h, s0), s1), s2) in line.iter().zip(first).zip(second).zip(third) {
        *s0 = h.mul_add(weights[0], *s0);
        *s1 = h.mul_add(weights[1], *s1);
        *s2 = h.mul_add(weights[2], *s2);
    }
}

impl Taps {
    fn new(window: &Window) -> Self {
        let half_width = window.half_width as i64;
        let count = 2 * half_width as usize;
        let padded = count.next_multiple_of(LANES);
        let mut coefficients: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; TERMS * padded]);
        for k in 0..count {
            // The interpolation point lies between points `half_width − 1` and `half_width`.
            let offset = (half_width - 1 - k as i64) as f64 + 0.5;
            for (derivative, column) in coefficients.iter_mut().enumerate() {
                let polynomial = interpolate(|x| window.kernel(offset + 0.5 * x)[derivative]);
                for (power, coefficient) in polynomial.into_iter().enumerate() {
                    column[(TERMS - 1 - power) * padded + k] = coefficient;
                }
            }
        }
        Self { half_width, coefficients, count, padded }
    }

    /// Evaluates the weights at the distance `share`, in spacings, from the midpoint between two grid points.
    fn evaluate(&self, share: f64, weights: &mut Weights) {
        for (coefficients, out) in self.coefficients.iter().zip(&mut weights.0) {
            horner(coefficients, self.padded, 2.0 * share, out);
        }
    }
}

/// Evaluates all polynomials at once.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn horner(coefficients: &[f64], padded: usize, x: f64, out: &mut [f64; MAX_TAPS]) {
    for first in (0..padded).step_by(LANES) {
        let mut value = [0.0f64; LANES];
        for power in coefficients.chunks_exact(padded) {
            for (v, c) in value.iter_mut().zip(&power[first..first + LANES]) {
                *v = v.mul_add(x, *c);
            }
        }
        out[first..first + LANES].copy_from_slice(&value);
    }
}

/// Polynomial that interpolates `f` at the Chebyshev nodes of `[−1, 1]`, lowest power first.
fn interpolate(f: impl Fn(f64) -> f64) -> [f64; TERMS] {
    let angle = |k: usize| PI * (k as f64 + 0.5) / TERMS as f64;
    let samples: [f64; TERMS] = std::array::from_fn(|k| f(angle(k).cos()));
    // Powers of the Chebyshev polynomials, by recurrence.
    let (mut before, mut now) = ([0.0; TERMS], [0.0; TERMS]);
    let mut sum = [0.0; TERMS];
    now[0] = 1.0;
    for order in 0..TERMS {
        let weight = if order == 0 { 1.0 } else { 2.0 } / TERMS as f64;
        let share = weight
            * samples
                .iter()
                .enumerate()
                .map(|(k, sample)| sample * (order as f64 * angle(k)).cos())
                .sum::<f64>();
        for (s, c) in sum.iter_mut().zip(&now) {
            *s += share * c;
        }
        let mut next = before.map(|c| -c);
        for power in 1..TERMS {
            next[power] += if order == 0 { 1.0 } else { 2.0 } * now[power - 1];
        }
        if order == 0 {
            next = [0.0; TERMS];
            next[1] = 1.0;
        }
        (before, now) = (now, next);
    }
    sum
}

impl Window {
    fn new(points_per_shortest_wavelength: f64) -> Self {
        let headroom = PI * (1.0 - 2.0 / points_per_shortest_wavelength);
        let half_width = (DECAY / headroom).ceil().min(0.5 * MAX_TAPS as f64);
        let beta = half_width * headroom;
        Self { half_width, beta, norm: 1.0 / bessel_i(beta, 0) }
    }

    /// The windowed cardinal sine at `t` grid spacings, with its first and second derivative.
    fn kernel(&self, t: f64) -> [f64; 3] {
        let inside = 1.0 - (t / self.half_width).powi(2);
        if inside <= 0.0 {
            return [0.0; 3];
        }
        let z = self.beta * inside.sqrt();
        let rate = (self.beta / self.half_width).powi(2);
        let w0 = bessel_i(z, 0);
        // d/dt of I0(z) and of I1(z)/z, through dz/dt = −rate·t/z.
        let w1 = -rate * t * bessel_i(z, 1);
        let w2 = -rate * bessel_i(z, 1) + (rate * t).powi(2) * bessel_i(z, 2);
        let [s0, s1, s2] = cardinal_sine(t);
        [
            self.norm * s0 * w0,
            self.norm * (s1 * w0 + s0 * w1),
            self.norm * (s2 * w0 + 2.0 * s1 * w1 + s0 * w2),
        ]
    }
}

/// `sin(πt)/(πt)` with its first and second derivative.
fn cardinal_sine(t: f64) -> [f64; 3] {
    let u = PI * t;
    if u.abs() < 0.5 {
        // Σ (−1)^k u^2k/(2k+1)!: the quotients below suffer from cancellation near 0.
        let (mut s0, mut s1, mut s2) = (0.0, 0.0, 0.0);
        let mut coefficient = 1.0;
        for k in 0..10 {
            let order = f64::from(2 * k);
            s0 += coefficient * u.powi(2 * k);
            if k > 0 {
                s1 += coefficient * order * u.powi(2 * k - 1);
                s2 += coefficient * order * (order - 1.0) * u.powi(2 * k - 2);
            }
            coefficient /= -(order + 2.0) * (order + 3.0);
        }
        return [s0, PI * s1, PI * PI * s2];
    }
    let s0 = u.sin() / u;
    let s1 = (u.cos() - s0) / t;
    [s0, s1, -PI * PI * s0 - 2.0 * s1 / t]
}

/// `I_order(z)/z^order`, with `I` the modified Bessel function of the first kind.
///
/// Evaluated by its power series, which converges everywhere and has positive terms.
fn bessel_i(z: f64, order: u32) -> f64 {
    let quarter = 0.25 * z * z;
    let mut term = 0.5f64.powi(order as i32) / (1..=order).map(f64::from).product::<f64>();
    let mut sum = term;
    let mut k = 1.0;
    while term > 1e-18 * sum {
        term *= quarter / (k * (k + f64::from(order)));
        sum += term;
        k += 1.0;
    }
    sum
}
