//! What depends on the reach of the near field alone: the splitting, the smooth field by radius, the mesh and its waves.

use super::ROOM;
use crate::model::Boundary;
use crate::physics::half_space::ewald::ORDERS;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::num_traits::Float;
use rustfft::{Fft, FftNum, FftPlanner};
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::sync::Arc;

/// What a mesh is made of: doubles where displacements are wanted, half as many digits where their derivatives are.
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

/// Points of the mesh on which a source is spread along each direction, the order of its B-spline: where displacements are wanted, and where their
/// derivatives are.
pub(super) const WIDTH: usize = 16;
pub(super) const ROUGH_WIDTH: usize = 8;

/// Orders of the far field that a mesh has of the derivatives, and their error, of the largest one: linear systems are solved no better.
pub(super) const ROUGH_ORDERS: usize = 2;
const ROUGH: f64 = 1e-5;

/// `[(2m − 1)!!]²`: `∇^2m (1/r)` is so much times `1/r^(2m+1)` in the plane.
pub(super) const LAPLACIANS: [f64; ORDERS] = [1.0, 1.0, 9.0, 225.0];

/// Pieces of the smooth field between its centre and its reach, and terms of each: the argument of the exponentials in it changes by 0.4 within a
/// piece, so that one term more is worth a factor of some 70.
const PIECES: usize = 64;
const TERMS: usize = 7;

/// What a tolerance asks of the splitting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Accuracy {
    /// Splitting parameter times reach, `α r_c`: beyond, `erfc(αr)` is no part of the field.
    edge: f64,
    /// Highest wave of the mesh over `2α`: where displacements are wanted, and where their derivatives are.
    waves: [f64; 2],
    /// Greatest radius of a spot over its reach, so that four orders of its far field are enough beyond.
    pub(super) girth: f64,
    /// Distance over radius from which on a spot's moments are its field.
    pub(super) aloof: f64,
}

impl Accuracy {
    /// For displacements that are right to `tolerance` times the largest of them.
    ///
    /// Beyond the reach `erfc(αr)` of a field is left out. A B-spline of order p takes a wave at the share t of the mesh's highest for its
    /// alias with the weight `(t/(2 − t))^p`, and `e^(−(q/2α)²)` of a wave is there to be taken. Beyond `r = r_c` the far field lacks
    /// `0.03 (a/r)⁸`. Each of the three is bound to a field at the reach, which is a small part of the greatest displacement: what comes of
    /// them is below a fifth of the tolerance in every case measured, and a thirtieth in most.
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
        // The field of one spot there is a fourth of the greatest displacement, and less.
        let aloof = (0.03 / (4.0 * tolerance)).powf(0.125).max(3.0);
        Self { edge, waves: [waves(WIDTH, tolerance).max(edge), waves(ROUGH_WIDTH, ROUGH.max(tolerance))], girth, aloof }
    }
}

/// `∇^2m(erf(αr)/r)/[(2m−1)!!]²` for m = 0 … 3 within a reach: what the mesh has of a source, to be taken off its near field.
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
                    .map(|k| smooth(alpha, reach * reach * (piece as f64 + 0.5 + 0.5 * angle(k).cos()) / PIECES as f64))
                    .collect();
                // A Chebyshev series, then powers by Clenshaw's rule on polynomials.
                let (mut next, mut after) = ([[0.0; ORDERS]; TERMS], [[0.0; ORDERS]; TERMS]);
                for n in (0..TERMS).rev() {
                    let scale = if n == 0 { 1.0 } else { 2.0 } / TERMS as f64;
                    let mut value = [[0.0; ORDERS]; TERMS];
                    for m in 0..ORDERS {
                        let sum: f64 = samples.iter().enumerate().map(|(k, s)| s[m] * (n as f64 * angle(k)).cos()).sum();
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

    /// At the square of the distance over that of the reach, below 1.
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

/// With `erf(αr)/r = (2α/√π) ∫₀¹ e^(−v t²) dt`, `v = α²r²`, and `∇^2m e^(−βr²) = (−4β)^m m! L_m(βr²) e^(−βr²)` in the plane.
fn smooth(alpha: f64, r2: f64) -> [f64; ORDERS] {
    /// Coefficients of `m! L_m`.
    const LAGUERRE: [[f64; ORDERS]; ORDERS] = [[1.0, 0.0, 0.0, 0.0], [1.0, -1.0, 0.0, 0.0], [2.0, -4.0, 1.0, 0.0], [6.0, -18.0, 9.0, -1.0]];
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

/// A near reach, and the meshes that do the rest. Lengths are in units of the side.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) reach: f64,
    pub(super) smooth: Smooth,
    /// For displacements, and for their derivatives.
    pub(super) fine: Arc<Mesh<f64>>,
    pub(super) rough: Arc<Mesh<f32>>,
}

/// A mesh and its waves.
pub(super) struct Mesh<T> {
    /// Points on a side.
    pub(super) size: usize,
    /// The smooth field's waves over the spread of a source, by ky then kx.
    pub(super) waves: Vec<T>,
    /// One over the transform of the B-spline, of k = 0 … N − 1; 0 at the highest wave, which has no sign.
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

/// Points that the finer mesh needs on a side for a reach.
pub(super) fn mesh_size(accuracy: Accuracy, reach: f64) -> usize {
    points(accuracy.edge / reach, accuracy.waves[0], WIDTH)
}

/// Points on a side for waves up to `waves` times 2α, and splines of so many points.
fn points(alpha: f64, waves: f64, width: usize) -> usize {
    // The highest wave is πN.
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
            rough: Arc::new(Mesh::new(size(accuracy.waves[1], ROUGH_WIDTH), alpha, ROUGH_WIDTH, boundary)),
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

/// The wave that a mesh of `n` points has at its k-th place.
fn wave(k: usize, n: usize) -> f64 {
    if 2 * k < n { k as f64 } else { k as f64 - n as f64 }
}

/// Of `erf(αr)/r` with all its images: `(2π/q) erfc(q/2α)`; at q = 0 what the near fields have of mean taken off. By ky, up to the highest, then kx.
fn waves_of_all(n: usize, alpha: f64) -> Vec<f64> {
    let at = |ky: usize, kx: usize| {
        let q = TAU * wave(kx, n).hypot(ky as f64);
        if q > 0.0 { TAU / q * libm::erfc(0.5 * q / alpha) } else { -2.0 * PI.sqrt() / alpha }
    };
    (0..=n / 2).flat_map(|ky| (0..n).map(move |kx| at(ky, kx))).collect()
}

/// The same of `erf(αr)/r` alone, as far as an isolated square needs it. From there on it falls off as `erfc(αx)` does, along both directions, so that
/// a mesh which has the one has the other; between two squares there is a reach for that, and one for the next image to rise.
fn waves_of_one(n: usize, alpha: f64) -> Vec<f64> {
    let middle = 0.5 * (1.0 / ROOM + 0.5);
    let along = |k: usize| wave(k, n).abs() / n as f64;
    let window: Vec<f64> = (0..n).map(|k| 0.5 * libm::erfc(alpha * (along(k) - middle))).collect();
    let kernel = |r: f64| if r > 0.0 { libm::erf(alpha * r) / r } else { 2.0 * alpha / PI.sqrt() };
    let point = |i: usize, j: usize| Complex::new(kernel(along(i).hypot(along(j))) * window[i] * window[j], 0.0);
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
