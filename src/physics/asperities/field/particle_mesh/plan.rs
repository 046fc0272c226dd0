//! Plans: the part of the fast sum that depends only on the near-field cutoff.
//!
//! A plan holds the Ewald splitting, the smooth field by radius, and the meshes with their Fourier modes.

use super::ROOM;
use crate::asperities::field::ewald::ORDERS;
use crate::model::Boundary;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::num_traits::Float;
use rustfft::{Fft, FftNum, FftPlanner};
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::sync::Arc;

/// Number type of a mesh: double precision for displacements, single for derivatives.
pub(super) trait Real: FftNum + Float + Default {
    fn of(value: f64) -> Self;
    fn long(self) -> f64;
}

impl Real for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn long(self) -> f64 {
        self
    }
}

impl Real for f32 {
    fn of(value: f64) -> Self {
        value as Self
    }

    fn long(self) -> f64 {
        Self::into(self)
    }
}

/// Order of the B-splines for displacements and for derivatives.
///
/// It is the number of mesh points per direction over which a source is spread.
pub(super) const WIDTH: usize = 12;
pub(super) const INTERMEDIATE_WIDTH: usize = 8;

/// Orders of the far field on the mesh of derivatives, and its error relative to the largest derivative.
///
/// Linear systems are solved no more accurately than this.
pub(super) const INTERMEDIATE_ORDERS: usize = 2;
const DERIVATIVE_TOLERANCE: f64 = 1e-4;

/// `[(2m − 1)!!]²`: `∇^2m (1/r)` is this factor times `1/r^(2m+1)` in the plane.
pub(super) const LAPLACIANS: [f64; ORDERS] = [1.0, 1.0, 9.0, 225.0];

/// Pieces of the smooth field between its centre and the cutoff, and terms of each.
///
/// The argument of the exponentials changes by 0.4 within a piece, so one more term reduces the error by a
/// factor of about 70.
const PIECES: usize = 64;
const TERMS: usize = 7;

/// Splitting parameters that meet a tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Accuracy {
    /// Splitting parameter times cutoff, `α r_c`: beyond, `erfc(αr)` is neglected.
    edge: f64,
    /// Highest wavenumber of the mesh over `2α`, for displacements and for derivatives.
    waves: [f64; 2],
    /// Maximum contact radius over cutoff for which four orders of the far field are enough beyond the
    /// cutoff.
    pub(super) girth: f64,
    /// Distance over radius from which the moments represent a spot's field.
    pub(super) aloof: f64,
}

impl Accuracy {
    /// Parameters for displacements with errors up to `tolerance` times the largest one.
    ///
    /// Three errors contribute. Beyond the cutoff, `erfc(αr)` of a field is neglected. A B-spline of order p
    /// aliases a mode at the fraction t of the mesh's highest wavenumber with the weight `(t/(2 − t))^p`. The
    /// mode itself has the amplitude `e^(−(q/2α)²)`. Beyond `r = r_c` the far field lacks `0.03 (a/r)⁸`. Each
    /// error is relative to a field at the cutoff, which is a small part of the largest displacement. The
    /// measured total is below the tolerance in every case (3e-9 at 1e-8).
    pub(super) fn of(tolerance: f64) -> Self {
        let tolerance = tolerance.clamp(1e-13, 1e-2);
        let mut edge = 1.0;
        while libm::erfc(edge) > 0.3 * tolerance {
            edge += 0.02;
        }
        let waves = |width: usize, tolerance: f64| {
            let alias = |waves: f64| {
                let share = |t: f64| (t / (2.0 - t)).powi(width as i32) * (-(waves * t).powi(2)).exp();
                (1..=100).map(|k| share(0.01 * f64::from(k))).fold(0.0, f64::max)
            };
            let mut waves = 1.0;
            while alias(waves) > tolerance || (-waves * waves).exp() > tolerance {
                waves += 0.02;
            }
            waves
        };
        let girth = (10.0 * tolerance).powf(0.125).min(0.2);
        // The field of one spot there is at most a fourth of the largest displacement.
        let aloof = (0.03 / (4.0 * tolerance)).powf(0.125).max(3.0);
        Self {
            edge,
            waves: [
                waves(WIDTH, tolerance).max(edge),
                waves(INTERMEDIATE_WIDTH, DERIVATIVE_TOLERANCE.max(tolerance)),
            ],
            girth,
            aloof,
        }
    }
}

/// Mesh field within a cutoff, which is subtracted from the near field.
///
/// It is `∇^2m(erf(αr)/r)/[(2m−1)!!]²` for m = 0 … 3.
#[derive(Debug, Clone)]
pub(super) struct Smooth {
    /// Polynomials in `2·fraction − 1`, highest power first, by pieces of equal `r²`.
    pieces: Vec<[[f64; ORDERS]; TERMS]>,
}

impl Smooth {
    fn new(alpha: f64, reach: f64) -> Self {
        let angle = |k: usize| PI * (k as f64 + 0.5) / TERMS as f64;
        let pieces = (0..PIECES)
            .map(|piece| {
                let samples: Vec<_> = (0..TERMS)
                    .map(|k| {
                        smooth(
                            alpha,
                            reach * reach * (piece as f64 + 0.5 + 0.5 * angle(k).cos()) / PIECES as f64,
                        )
                    })
                    .collect();
                // Chebyshev series, converted to powers by Clenshaw's recurrence on polynomials.
                let (mut next, mut after) = ([[0.0; ORDERS]; TERMS], [[0.0; ORDERS]; TERMS]);
                for n in (0..TERMS).rev() {
                    let scale = if n == 0 { 1.0 } else { 2.0 } / TERMS as f64;
                    let mut value = [[0.0; ORDERS]; TERMS];
                    for m in 0..ORDERS {
                        let sum: f64 =
                            samples.iter().enumerate().map(|(k, s)| s[m] * (n as f64 * angle(k)).cos()).sum();
                        value[0][m] = scale * sum;
                        let factor = if n == 0 { 1.0 } else { 2.0 };
                        for p in 0..TERMS {
                            let shifted = if p > 0 { next[p - 1][m] } else { 0.0 };
                            value[p][m] += factor * shifted - after[p][m];
                        }
                    }
                    (after, next) = (next, value);
                }
                next.reverse();
                next
            })
            .collect();
        Self { pieces }
    }

    /// Value at `share`, the square of the distance over the cutoff, below 1.
    #[inline(always)]
    pub(super) fn at(&self, share: f64) -> [f64; ORDERS] {
        let place = share * PIECES as f64;
        let number = (place as usize).min(PIECES - 1);
        let t = 2.0 * (place - number as f64) - 1.0;
        let piece = &self.pieces[number];
        let mut sums = [0.0_f64; ORDERS];
        for term in piece {
            for m in 0..ORDERS {
                sums[m] = sums[m].mul_add(t, term[m]);
            }
        }
        sums
    }
}

/// Smooth field and its Laplacians, by `erf(αr)/r = (2α/√π) ∫₀¹ e^(−v t²) dt`, `v = α²r²`.
///
/// Uses `∇^2m e^(−βr²) = (−4β)^m m! L_m(βr²) e^(−βr²)` in the plane.
fn smooth(alpha: f64, r2: f64) -> [f64; ORDERS] {
    /// Coefficients of `m! L_m`.
    const LAGUERRE: [[f64; ORDERS]; ORDERS] =
        [[1.0, 0.0, 0.0, 0.0], [1.0, -1.0, 0.0, 0.0], [2.0, -4.0, 1.0, 0.0], [6.0, -18.0, 9.0, -1.0]];
    let v = alpha * alpha * r2;
    // ∫₀¹ t^2p e^(−v t²) dt = ½ e^(−v) Σ_k v^k/((p+½)(p+3/2) … (p+½+k)): all terms positive.
    let integral = |p: usize| {
        let mut k = p as f64 + 0.5;
        let (mut term, mut sum) = (0.5 / k, 0.0);
        while term > 1e-18 * sum {
            sum += term;
            k += 1.0;
            term *= v / k;
        }
        sum * (-v).exp()
    };
    [0, 1, 2, 3].map(|m: usize| {
        let sum: f64 = (0..=m).map(|i| LAGUERRE[m][i] * v.powi(i as i32) * integral(m + i)).sum();
        2.0 * alpha / PI.sqrt() * (-4.0 * alpha * alpha).powi(m as i32) / LAPLACIANS[m] * sum
    })
}

/// A near-field cutoff and the meshes of the far field.
///
/// Lengths are in units of the side.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) reach: f64,
    pub(super) smooth: Smooth,
    /// Meshes for displacements and for derivatives.
    pub(super) fine: Arc<Mesh<f64>>,
    pub(super) rough: Arc<Mesh<f32>>,
}

/// A mesh and its Fourier modes.
pub(super) struct Mesh<T> {
    /// Points on a side.
    pub(super) size: usize,
    /// Fourier modes of the smooth field divided by those of the spline, by ky then kx.
    pub(super) waves: Vec<T>,
    /// Inverse Fourier transform factors of the B-spline, k = 0 … N − 1.
    ///
    /// It is 0 at the Nyquist mode, which has no sign.
    pub(super) sharpen: Vec<T>,
    pub(super) rows: Arc<dyn RealToComplex<T>>,
    pub(super) rows_back: Arc<dyn ComplexToReal<T>>,
    pub(super) columns: Arc<dyn Fft<T>>,
    pub(super) columns_back: Arc<dyn Fft<T>>,
}

impl<T> fmt::Debug for Mesh<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Mesh").field("size", &self.size).finish_non_exhaustive()
    }
}

/// Points on a side of the finer mesh for a cutoff.
pub(super) fn mesh_size(accuracy: Accuracy, reach: f64) -> usize {
    points(accuracy.edge / reach, accuracy.waves[0], WIDTH)
}

/// Points on a side for wavenumbers up to `waves` times 2α, and splines of `width` points.
fn points(alpha: f64, waves: f64, width: usize) -> usize {
    // The highest wavenumber is πN.
    let least = (2.0 * alpha * waves / PI).ceil() as usize;
    let smooth = |n: usize| {
        let mut left = n;
        for prime in [2, 3, 5] {
            while left.is_multiple_of(prime) {
                left /= prime;
            }
        }
        n.is_multiple_of(4) && left == 1
    };
    (least.max(2 * width)..).find(|n| smooth(*n)).unwrap_or(least)
}

impl Plan {
    pub(super) fn new(accuracy: Accuracy, reach: f64, boundary: Boundary) -> Self {
        let alpha = accuracy.edge / reach;
        let size = |waves: f64, width: usize| points(alpha, waves, width);
        Self {
            reach,
            smooth: Smooth::new(alpha, reach),
            fine: Arc::new(Mesh::new(size(accuracy.waves[0], WIDTH), alpha, WIDTH, boundary)),
            rough: Arc::new(Mesh::new(
                size(accuracy.waves[1], INTERMEDIATE_WIDTH),
                alpha,
                INTERMEDIATE_WIDTH,
                boundary,
            )),
        }
    }
}

impl<T: Real> Mesh<T> {
    fn new(n: usize, alpha: f64, width: usize, boundary: Boundary) -> Self {
        let sharpen: Vec<f64> = (0..n)
            .map(|k| {
                let angle = PI * wave(k, n) / n as f64;
                if 2 * k == n {
                    0.0
                } else if k == 0 {
                    1.0
                } else {
                    (angle / angle.sin()).powi(width as i32)
                }
            })
            .collect();
        let mut waves = match boundary {
            Boundary::Periodic => waves_of_all(n, alpha),
            Boundary::Isolated => waves_of_one(n, alpha),
        };
        for (ky, waves) in waves.chunks_mut(n).enumerate() {
            for (far, across) in waves.iter_mut().zip(&sharpen) {
                *far *= sharpen[ky] * across;
            }
        }
        let (mut real, mut complex) = (RealFftPlanner::<T>::new(), FftPlanner::<T>::new());
        let short = |values: Vec<f64>| values.into_iter().map(T::of).collect();
        Self {
            size: n,
            waves: short(waves),
            sharpen: short(sharpen),
            rows: real.plan_fft_forward(n),
            rows_back: real.plan_fft_inverse(n),
            columns: complex.plan_fft_forward(n),
            columns_back: complex.plan_fft_inverse(n),
        }
    }
}

/// Signed mode number at index `k` of a mesh of `n` points.
fn wave(k: usize, n: usize) -> f64 {
    if 2 * k < n { k as f64 } else { k as f64 - n as f64 }
}

/// Fourier modes of `erf(αr)/r` with all its images: `(2π/q) erfc(q/2α)`.
///
/// At q = 0 the mode is minus the mean of the near fields. By ky, up to the highest, then kx.
fn waves_of_all(n: usize, alpha: f64) -> Vec<f64> {
    let at = |ky: usize, kx: usize| {
        let q = TAU * wave(kx, n).hypot(ky as f64);
        if q > 0.0 { TAU / q * libm::erfc(0.5 * q / alpha) } else { -2.0 * PI.sqrt() / alpha }
    };
    (0..=n / 2).flat_map(|ky| (0..n).map(move |kx| at(ky, kx))).collect()
}

/// Fourier modes of `erf(αr)/r` alone, windowed beyond the range that an isolated square needs.
///
/// The window falls off as `erfc(αx)` along both directions, so a mesh that resolves the field resolves the
/// window. The gap between two squares leaves one cutoff for the window to fall and one for the next image to
/// rise.
fn waves_of_one(n: usize, alpha: f64) -> Vec<f64> {
    let middle = 0.5 * (1.0 / ROOM + 0.5);
    let along = |k: usize| wave(k, n).abs() / n as f64;
    let window: Vec<f64> = (0..n).map(|k| 0.5 * libm::erfc(alpha * (along(k) - middle))).collect();
    let kernel = |r: f64| if r > 0.0 { libm::erf(alpha * r) / r } else { 2.0 * alpha / PI.sqrt() };
    let point =
        |i: usize, j: usize| Complex::new(kernel(along(i).hypot(along(j))) * window[i] * window[j], 0.0);
    let mut points: Vec<Complex<f64>> = (0..n * n).map(|k| point(k / n, k % n)).collect();
    let lines = FftPlanner::new().plan_fft_forward(n);
    lines.process(&mut points);
    for i in 0..n {
        for j in 0..i {
            points.swap(i * n + j, j * n + i);
        }
    }
    lines.process(&mut points);
    points[..(n / 2 + 1) * n].iter().map(|value| value.re / (n * n) as f64).collect()
}
