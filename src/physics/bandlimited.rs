//! Heights and derivatives of a band-limited periodic surface between its grid points.
//!
//! A surface of Eq 10 has no mode at or above `q1`, so a grid of more than two points per shortest wavelength holds all of it, and any
//! value between the points is a sum over the grid with the cardinal sine. Cut off by a Kaiser–Bessel window of half width `m` points,
//! the sum is local; where the grid has `p` points per shortest wavelength its relative error is about `exp(−πm(1 − 2/p))`, and `m` is
//! chosen so that this is below the rounding of the heights. Derivatives are those of the same sum: spectral ones, without a transform.

use ndarray::ArrayView2;
use std::f64::consts::PI;

/// Decay that makes the window's error vanish beside rounding: `exp(−34) = 1.7e-15`.
const DECAY: f64 = 34.0;

/// Height and derivatives at one place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Jet {
    /// Height h \[m\].
    pub height_m: f64,
    /// Gradient (∂h/∂x, ∂h/∂y).
    pub gradient: [f64; 2],
    /// ∂²h/∂x², ∂²h/∂x∂y, ∂²h/∂y² \[1/m\].
    pub hessian_1_m: [f64; 3],
}

/// A periodic grid of heights, read as the band-limited function that it samples.
#[derive(Debug, Clone, Copy)]
pub struct BandLimited<'a> {
    heights: ArrayView2<'a, f64>,
    spacing: f64,
    half_width: usize,
    window: Window,
}

#[derive(Debug, Clone, Copy)]
struct Window {
    half_width: f64,
    beta: f64,
    norm: f64,
}

impl<'a> BandLimited<'a> {
    /// Heights \[m\] on a square grid of side `length_m` with `points_per_shortest_wavelength > 2`.
    #[must_use]
    pub fn new(heights: ArrayView2<'a, f64>, length_m: f64, points_per_shortest_wavelength: f64) -> Self {
        let headroom = PI * (1.0 - 2.0 / points_per_shortest_wavelength);
        let half_width = (DECAY / headroom).ceil();
        let beta = half_width * headroom;
        Self {
            heights,
            spacing: length_m / heights.nrows() as f64,
            half_width: half_width as usize,
            window: Window { half_width, beta, norm: 1.0 / bessel_i(beta, 0) },
        }
    }

    /// The jet at (x, y) \[m\], anywhere in the periodic plane.
    #[must_use]
    pub fn jet(&self, x: f64, y: f64) -> Jet {
        let (rows, across) = self.weights(x);
        let (columns, along) = self.weights(y);
        let mut jet = Jet::default();
        for (row, wx) in rows.iter().zip(&across) {
            let line = self.heights.row(*row);
            let mut sums = [0.0; 3];
            for (column, wy) in columns.iter().zip(&along) {
                let h = line[*column];
                for (sum, weight) in sums.iter_mut().zip(wy) {
                    *sum += h * weight;
                }
            }
            jet.height_m += wx[0] * sums[0];
            jet.gradient[0] += wx[1] * sums[0];
            jet.gradient[1] += wx[0] * sums[1];
            jet.hessian_1_m[0] += wx[2] * sums[0];
            jet.hessian_1_m[1] += wx[1] * sums[1];
            jet.hessian_1_m[2] += wx[0] * sums[2];
        }
        jet
    }

    /// Grid indices around a coordinate, and the weights of value, first and second derivative.
    fn weights(&self, coordinate: f64) -> (Vec<usize>, Vec<[f64; 3]>) {
        let n = self.heights.nrows() as i64;
        let place = coordinate / self.spacing;
        let base = place.floor();
        let reach = self.half_width as i64;
        ((1 - reach)..=reach)
            .map(|offset| {
                let [value, first, second] = self.window.kernel(place - base - offset as f64);
                let index = (base as i64 + offset).rem_euclid(n) as usize;
                (index, [value, first / self.spacing, second / (self.spacing * self.spacing)])
            })
            .unzip()
    }
}

impl Window {
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
        [self.norm * s0 * w0, self.norm * (s1 * w0 + s0 * w1), self.norm * (s2 * w0 + 2.0 * s1 * w1 + s0 * w2)]
    }
}

/// `sin(πt)/(πt)` with its first and second derivative.
fn cardinal_sine(t: f64) -> [f64; 3] {
    let u = PI * t;
    if u.abs() < 0.5 {
        // Σ (−1)^k u^2k/(2k+1)!: the quotients below cancel near 0.
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

/// `I_order(z)/z^order`, the modified Bessel function of the first kind, by its everywhere convergent series of positive terms.
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
