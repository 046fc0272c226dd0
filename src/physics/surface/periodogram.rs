//! Power spectral density of a surface, averaged over directions.

use super::edges::Edges;
use super::modes::Field;
pub use super::psd_bin::{Estimate, Ring};
use crate::PhysicsError;
use crate::memory::zeros;
use ndarray::{Array1, Array2, ArrayView2};
use std::f64::consts::{PI, SQRT_2, TAU};

/// Power spectral density `C(q) = |c_k|²/qL²` of a periodic surface, in rings of wavevectors.
///
/// `c_k` are the modes of `h(x) = Σ_k c_k exp(i k·x)` on a square of side L \[m\], and `qL = 2π/L`. As for
/// [`super::spectrum::Spectrum::density`] (Eq 10), `Σ_k C(k) qL² = h_rms²`. There are four rings per octave,
/// from the lowest wavenumber to the grid's Nyquist wavenumber. Rings without modes are omitted.
///
/// The field is taken as periodic. A mismatch at the edges of a non-periodic field leaks into a
/// `q⁻²` spectrum. For such fields see [`windowed_periodogram`].
///
/// # Errors
/// Too little memory.
pub fn periodogram(heights_m: ArrayView2<'_, f64>, length_m: f64) -> Result<Vec<Ring>, PhysicsError> {
    let (n, across) = heights_m.dim();
    if n == 0 || n != across {
        Ok(Vec::new())
    } else {
        Ok(Field::of(heights_m, length_m, Edges::Periodic)?.rings())
    }
}

/// Power spectral density of a non-periodic surface under a Hann window.
///
/// The window is `w = (1 − cos 2πx/L)(1 − cos 2πy/L)`.
///
/// Division by the mean of w² makes the sum equal to h_rms² on average (Jacobs, Junge and Pastewka, Surf.
/// Topogr. 5:013001, 2017). The window spreads each mode over its neighbours, and the lowest wavenumbers
/// contribute to the mean.
///
/// # Errors
/// Too little memory.
pub fn windowed_periodogram(
    heights_m: ArrayView2<'_, f64>,
    length_m: f64,
) -> Result<Vec<Ring>, PhysicsError> {
    periodogram(windowed(heights_m)?.view(), length_m)
}

/// Heights times the Hann window, scaled such that the mean square stays the same on average.
///
/// # Errors
/// Too little memory.
pub(crate) fn windowed(heights_m: ArrayView2<'_, f64>) -> Result<Array2<f64>, PhysicsError> {
    let n = heights_m.nrows();
    let window = Array1::from_shape_fn(n, |k| 1.0 - (TAU * (k as f64 + 0.5) / n as f64).cos());
    // The mean square of the window along one direction is 3/2.
    let of_mean = window.iter().map(|w| w * w).sum::<f64>() / n as f64;
    let mut under = zeros(heights_m.dim())?;
    under.assign(&heights_m);
    under.indexed_iter_mut().for_each(|((i, j), h)| *h *= window[i] * window[j] / of_mean);
    Ok(under)
}

/// Power spectral density of a non-periodic surface under two sine tapers along each direction, averaged over
/// the four pairs.
///
/// The tapers are `√2 sin(πjx/L)`, j = 1, 2 (Riedel and Sidorenko, IEEE Trans. Signal Process. 43:188, 1995).
/// The variance of a ring is 0.41 of that under a Hann window. Leakage from long wavelengths falls with `q⁻⁴`
/// along the axes.
///
/// # Errors
/// Too little memory.
pub(crate) fn tapered_periodogram(
    heights_m: ArrayView2<'_, f64>,
    length_m: f64,
) -> Result<Vec<Ring>, PhysicsError> {
    let n = heights_m.nrows();
    let taper = |order: usize| {
        Array1::from_shape_fn(n, |k| SQRT_2 * (PI * order as f64 * (k as f64 + 0.5) / n as f64).sin())
    };
    let tapers = [taper(1), taper(2)];
    let mut under = zeros(heights_m.dim())?;
    let mut mean: Vec<Ring> = Vec::new();
    for (along_x, along_y) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        under.assign(&heights_m);
        under.indexed_iter_mut().for_each(|((i, j), h)| *h *= tapers[along_x][i] * tapers[along_y][j]);
        let rings = periodogram(under.view(), length_m)?;
        if mean.is_empty() {
            mean = rings.iter().map(|ring| Ring { density_m4: 0.0, ..*ring }).collect();
        }
        mean.iter_mut().zip(&rings).for_each(|(sum, ring)| sum.density_m4 += 0.25 * ring.density_m4);
    }
    Ok(mean)
}

/// True if heights continue periodically, so that their spectrum needs no taper.
///
/// Opposite edges differ by no more than neighbouring lines of points do, times [`SEAM`].
pub(crate) fn continues(heights_m: ArrayView2<'_, f64>) -> bool {
    let across = |heights: ArrayView2<'_, f64>| {
        let n = heights.nrows();
        let square = |k: usize| {
            let (line, next) = (heights.row(k), heights.row((k + 1) % n));
            line.iter().zip(next).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
        };
        let inside = (0..n - 1).map(square).sum::<f64>() / (n - 1) as f64;
        square(n - 1) <= SEAM * SEAM * inside
    };
    heights_m.nrows() > 1 && across(heights_m) && across(heights_m.t())
}

/// Largest rms difference of opposite edges over that of neighbouring lines of a field that continues
/// periodically.
const SEAM: f64 = 1.5;
