//! Fourier modes of a height field, its moments and its power spectral density.

use super::edges::Edges;
use super::psd_bin::Ring;
use super::s_filter::transmission;
use super::spectrum::Moments;
use crate::PhysicsError;
use crate::memory::{filled, zeros};
use ndarray::{Array2, ArrayView2};
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;
use std::f64::consts::TAU;

/// Number of rows transformed at a time.
const ROWS: usize = 256;
/// Rings per octave of wavenumber.
const RINGS: f64 = 4.0;

/// Modes `c_k` of `h(x) = Σ_k c_k exp(i k·x)` on a square grid.
///
/// It stores one half of them; the others are conjugates.
pub(crate) struct Field {
    /// Points along a side.
    n: usize,
    /// Lowest wavenumber, `2π/L` \[1/m\].
    lowest: f64,
    /// Modes times n², by columns of ky, kx running fastest.
    columns: Vec<Complex64>,
}

impl Field {
    /// Modes of a square field of side L \[m\] if it is periodic, else of its mirror extension of side 2 L.
    pub(crate) fn of(
        heights_m: ArrayView2<'_, f64>,
        length_m: f64,
        edges: Edges,
    ) -> Result<Self, PhysicsError> {
        match edges {
            Edges::Periodic => Self::periodic(heights_m, length_m),
            Edges::Open => Self::periodic(mirrored(heights_m)?.view(), 2.0 * length_m),
        }
    }

    fn periodic(heights_m: ArrayView2<'_, f64>, length_m: f64) -> Result<Self, PhysicsError> {
        let n = heights_m.nrows();
        let half = n / 2 + 1;
        let along_y = RealFftPlanner::<f64>::new().plan_fft_forward(n);
        let mut columns = filled(half * n, Complex64::ZERO)?;
        // Blocks of rows avoid a second field in memory.
        let mut rows = filled(half * ROWS.min(n), Complex64::ZERO)?;
        for first in (0..n).step_by(ROWS) {
            let count = ROWS.min(n - first);
            rows.par_chunks_mut(half).take(count).enumerate().for_each_init(
                || (along_y.make_input_vec(), along_y.make_scratch_vec()),
                |(row, scratch), (k, waves)| {
                    row.iter_mut().zip(heights_m.row(first + k)).for_each(|(to, from)| *to = *from);
                    let outcome = along_y.process_with_scratch(row, waves, scratch);
                    debug_assert!(outcome.is_ok(), "lengths are those of the plan");
                },
            );
            columns.par_chunks_mut(n).enumerate().for_each(|(ky, column)| {
                for (value, row) in column[first..first + count].iter_mut().zip(rows.chunks(half)) {
                    *value = row[ky];
                }
            });
        }
        let along_x = FftPlanner::<f64>::new().plan_fft_forward(n);
        columns.par_chunks_mut(n).for_each_init(
            || vec![Complex64::ZERO; along_x.get_inplace_scratch_len()],
            |scratch, column| along_x.process_with_scratch(column, scratch),
        );
        Ok(Self { n, lowest: TAU / length_m, columns })
    }

    /// Sums over the modes.
    ///
    /// Columns are added in order, so that the result is independent of the threads.
    ///
    /// `add` receives the sum so far, the squared mode number, the number of modes that this one represents,
    /// and `|c_k|²` \[m²\].
    fn sum<T: Clone + Send + Sync>(
        &self,
        zero: &T,
        add: impl Fn(&mut T, f64, f64, f64) + Sync,
        join: impl Fn(&mut T, &T),
    ) -> T {
        let n = self.n;
        let unit = 1.0 / (n as f64).powi(4);
        let sums: Vec<T> = self
            .columns
            .par_chunks(n)
            .enumerate()
            .map(|(ky, column)| {
                // A column also represents its mirror image, except the first and, for an even number of
                // points, the last.
                let times = if ky == 0 || 2 * ky == n { 1.0 } else { 2.0 };
                let mut sum = zero.clone();
                for (place, value) in column.iter().enumerate() {
                    let kx = place.min(n - place);
                    add(&mut sum, (kx * kx + ky * ky) as f64, times, unit * value.norm_sqr());
                }
                sum
            })
            .collect();
        let mut total = zero.clone();
        sums.iter().for_each(|sum| join(&mut total, sum));
        total
    }

    /// `Σ w(q)|c|²` over all modes but the mean, with weights as functions of the wavenumber q \[1/m\].
    pub(crate) fn weighted<const N: usize>(&self, weights: impl Fn(f64) -> [f64; N] + Sync) -> [f64; N] {
        let add = |sums: &mut [f64; N], squared: f64, times: f64, power: f64| {
            let of_mode = weights(self.lowest * squared.sqrt());
            sums.iter_mut().zip(of_mode).for_each(|(sum, weight)| *sum += times * power * weight);
        };
        self.sum(&[0.0; N], add, |total, sum| total.iter_mut().zip(sum).for_each(|(t, s)| *t += s))
    }

    /// Sums `Σ|c|²`, `Σ q|c|²` and `Σ q²|c|²` over bands of wavenumbers \[1/m\] without the mean.
    ///
    /// The upper edges of the bands ascend and are included; the first band begins at 0.
    pub(crate) fn bands(&self, edges_1_m: &[f64]) -> Vec<[f64; 3]> {
        let add = |bands: &mut Vec<[f64; 3]>, squared: f64, times: f64, power: f64| {
            let q = self.lowest * squared.sqrt();
            let place = edges_1_m.partition_point(|edge| *edge < q);
            if let Some(band) = bands.get_mut(place).filter(|_| q > 0.0) {
                let weights = [1.0, q, q * q];
                band.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += times * power * weight);
            }
        };
        self.sum(&vec![[0.0; 3]; edges_1_m.len()], add, |total, sum| {
            for (to, from) in total.iter_mut().zip(sum) {
                to.iter_mut().zip(from).for_each(|(t, s)| *t += s);
            }
        })
    }

    /// Moments without the mean: `m0 = Σ|c|²`, `m2 = ½ Σ q²|c|²`, `m4 = ⅜ Σ q⁴|c|²`.
    pub(crate) fn moments(&self) -> Moments {
        let [m0, slope, laplacian] = self.weighted(|q| [if q > 0.0 { 1.0 } else { 0.0 }, q * q, q.powi(4)]);
        Moments { m0_m2: m0, m2: 0.5 * slope, m4_1_m2: 0.375 * laplacian }
    }

    /// Power spectral density in rings of wavevectors.
    ///
    /// See [`super::periodogram::periodogram`].
    pub(crate) fn rings(&self) -> Vec<Ring> {
        let reach = self.n as f64 / 2.0;
        let count = (RINGS * reach.log2()).round() as usize + 1;
        let add = |rings: &mut Vec<(f64, f64, f64)>, squared: f64, times: f64, power: f64| {
            let mode = squared.sqrt();
            // Wavevectors in a disc: rings in the corners of the grid are incomplete.
            if mode > 0.0 && mode < reach {
                let ring = &mut rings[(RINGS * mode.log2()).round() as usize];
                *ring = (ring.0 + times * mode, ring.1 + times * power, ring.2 + times);
            }
        };
        let join = |total: &mut Vec<(f64, f64, f64)>, sum: &Vec<(f64, f64, f64)>| {
            total.iter_mut().zip(sum).for_each(|(t, s)| *t = (t.0 + s.0, t.1 + s.1, t.2 + s.2));
        };
        let rings = self.sum(&vec![(0.0, 0.0, 0.0); count], add, join);
        let mean = |(modes, power, count): (f64, f64, f64)| Ring {
            wavenumber_1_m: self.lowest * modes / count,
            density_m4: power / (count * self.lowest * self.lowest),
            mode_count: count as u64,
        };
        rings.into_iter().filter(|ring| ring.2 > 0.0).map(mean).collect()
    }

    /// Removes the mean and all wavelengths of up to `points` points.
    pub(crate) fn cut(&mut self, points: f64) {
        let n = self.n;
        let most = n as f64 / points;
        self.columns.par_chunks_mut(n).enumerate().for_each(|(ky, column)| {
            for (place, value) in column.iter_mut().enumerate() {
                let kx = place.min(n - place);
                let squared = (kx * kx + ky * ky) as f64;
                if squared == 0.0 || squared >= most * most {
                    *value = Complex64::ZERO;
                }
            }
        });
    }

    /// Mean product of the heights at all lags \[m²\].
    pub(crate) fn autocorrelation(mut self) -> Result<Array2<f64>, PhysicsError> {
        let n = self.n;
        let unit = 1.0 / (n as f64 * n as f64);
        self.columns.par_iter_mut().for_each(|value| *value = Complex64::new(unit * value.norm_sqr(), 0.0));
        self.heights(n)
    }

    /// Removes the mean and applies the Gaussian filter with a cut-off wavelength of `points` points.
    pub(crate) fn smooth(&mut self, points: f64) {
        let n = self.n;
        let of_mode: Vec<f64> =
            (0..n).map(|mode| transmission(points, mode.min(n - mode) as f64 / n as f64)).collect();
        self.columns.par_chunks_mut(n).enumerate().for_each(|(ky, column)| {
            column.iter_mut().zip(&of_mode).for_each(|(value, along_x)| *value *= along_x * of_mode[ky]);
        });
        self.columns[0] = Complex64::ZERO;
    }

    /// Heights \[m\] of the first `side` points along each direction, without the mirror images.
    pub(crate) fn heights(mut self, side: usize) -> Result<Array2<f64>, PhysicsError> {
        let n = self.n;
        let mut heights = zeros((side, side))?;
        let along_x = FftPlanner::<f64>::new().plan_fft_inverse(n);
        self.columns.par_chunks_mut(n).for_each_init(
            || vec![Complex64::ZERO; along_x.get_inplace_scratch_len()],
            |scratch, column| along_x.process_with_scratch(column, scratch),
        );
        let along_y = RealFftPlanner::<f64>::new().plan_fft_inverse(n);
        let unit = 1.0 / (n as f64 * n as f64);
        let columns = &self.columns;
        let Some(field) = heights.as_slice_mut() else { return Ok(heights) };
        field.par_chunks_mut(side).enumerate().for_each_init(
            || (along_y.make_input_vec(), along_y.make_output_vec(), along_y.make_scratch_vec()),
            |(half, line, scratch), (x, row)| {
                half.iter_mut().enumerate().for_each(|(ky, value)| *value = columns[ky * n + x]);
                // The first and, for an even number, the last line of a real field are real, up to rounding.
                half[0].im = 0.0;
                if n.is_multiple_of(2) {
                    half[n / 2].im = 0.0;
                }
                let outcome = along_y.process_with_scratch(half, line, scratch);
                debug_assert!(outcome.is_ok(), "lengths and the real lines are set above");
                row.iter_mut().zip(line.iter()).for_each(|(to, from)| *to = unit * from);
            },
        );
        Ok(heights)
    }
}

/// Mirror extension of a field: twice the side, and periodic.
///
/// # Errors
/// Too little memory.
pub fn mirrored(heights: ArrayView2<'_, f64>) -> Result<Array2<f64>, PhysicsError> {
    let n = heights.nrows();
    let fold = |k: usize| if k < n { k } else { 2 * n - 1 - k };
    let mut whole = zeros((2 * n, 2 * n))?;
    whole.indexed_iter_mut().for_each(|((i, j), h)| *h = heights[[fold(i), fold(j)]]);
    Ok(whole)
}
