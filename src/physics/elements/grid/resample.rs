//! Band-limited heights on the grid of the elements.

use crate::PhysicsError;
use crate::memory::filled;
use ndarray::{Array2, ArrayView2};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;
use std::f64::consts::TAU;

/// Heights of a periodic square field on `n × n` points of the same square, in the same unit: Fourier
/// interpolation with the wavevectors below both Nyquist wavenumbers. The first point is the first one of the
/// field.
///
/// # Errors
/// Not enough memory.
pub fn resample(heights: ArrayView2<'_, f64>, n: usize) -> Result<Array2<f64>, PhysicsError> {
    resample_from(heights, n, 0.0)
}

/// As [`resample`], with the first point at the place `first` along rows and columns, in spacings of the
/// field.
///
/// # Errors
/// Not enough memory.
pub fn resample_from(
    heights: ArrayView2<'_, f64>,
    n: usize,
    first: f64,
) -> Result<Array2<f64>, PhysicsError> {
    let from = heights.nrows();
    if from == n && first == 0.0 {
        return Ok(heights.to_owned());
    }
    // Rows are resampled, then columns: the transform of a square field is separable.
    let half = resample_rows(heights, n, first)?;
    Ok(resample_rows(half.t(), n, first)?.reversed_axes().as_standard_layout().to_owned())
}

fn resample_rows(heights: ArrayView2<'_, f64>, n: usize, first: f64) -> Result<Array2<f64>, PhysicsError> {
    let (rows, from) = heights.dim();
    let mut planner = FftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(from), planner.plan_fft_inverse(n));
    let mut result = filled(rows * n, 0.0)?;
    let mut old = filled(from, Complex64::ZERO)?;
    let mut new = filled(n, Complex64::ZERO)?;
    // Modes below both Nyquist wavenumbers.
    let kept = from.min(n).div_ceil(2);
    for (row, values) in result.chunks_mut(n).enumerate() {
        old.iter_mut().zip(heights.row(row)).for_each(|(to, height)| *to = Complex64::new(*height, 0.0));
        forward.process(&mut old);
        new.fill(Complex64::ZERO);
        new[..kept].copy_from_slice(&old[..kept]);
        for k in 1..kept {
            new[n - k] = old[from - k];
        }
        if first != 0.0 {
            for k in 1..kept {
                let shift = Complex64::cis(TAU * k as f64 * first / from as f64);
                new[k] *= shift;
                new[n - k] *= shift.conj();
            }
        }
        inverse.process(&mut new);
        values.iter_mut().zip(&new).for_each(|(to, value)| *to = value.re / from as f64);
    }
    Array2::from_shape_vec((rows, n), result)
        .map_err(|error| PhysicsError::Surface { problem: error.to_string(), help: "report this" })
}
