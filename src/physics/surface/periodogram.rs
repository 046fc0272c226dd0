//! Power spectral density of a surface, averaged over directions.

use super::modes::Field;
pub use super::psd_bin::Ring;
use crate::physics::PhysicsError;
use crate::physics::memory::zeros;
use ndarray::{Array1, ArrayView2};
use std::f64::consts::TAU;

/// Power spectral density `C(q) = |c_k|²/qL²` of a periodic surface, in rings of wavevectors.
///
/// `c_k` are the modes of `h(x) = Σ_k c_k exp(i k·x)` on a square of side L \[m\], and `qL = 2π/L`.
/// As for [`super::spectrum::Spectrum::density`] (Eq 10), `Σ_k C(k) qL² = h_rms²`.
/// There are four rings per octave, from the lowest wavenumber to the grid's Nyquist wavenumber. Rings without modes are omitted.
///
/// The field is taken as periodic. A mismatch at the edges of a non-periodic field leaks into a `q⁻²` spectrum.
/// For such fields see [`windowed_periodogram`].
///
/// # Errors
/// Too little memory.
pub fn periodogram(heights_m: ArrayView2<'_, f64>, length_m: f64) -> Result<Vec<Ring>, PhysicsError> {
    let (n, across) = heights_m.dim();
    if n == 0 || n != across { Ok(Vec::new()) } else { Ok(Field::of(heights_m, length_m, true)?.rings()) }
}

/// Power spectral density of a non-periodic surface under a Hann window.
///
/// The window is `w = (1 − cos 2πx/L)(1 − cos 2πy/L)`.
///
/// Division by the mean of w² makes the sum equal to h_rms² on average (Jacobs, Junge and Pastewka, Surf. Topogr. 5:013001, 2017).
/// The window spreads each mode over its neighbours, and the lowest wavenumbers contribute to the mean.
///
/// # Errors
/// Too little memory.
pub fn windowed_periodogram(heights_m: ArrayView2<'_, f64>, length_m: f64) -> Result<Vec<Ring>, PhysicsError> {
    let n = heights_m.nrows();
    let window = Array1::from_shape_fn(n, |k| 1.0 - (TAU * (k as f64 + 0.5) / n as f64).cos());
    // The mean square of the window along one direction is 3/2.
    let of_mean = window.iter().map(|w| w * w).sum::<f64>() / n as f64;
    let mut under = zeros(heights_m.dim())?;
    under.assign(&heights_m);
    under.indexed_iter_mut().for_each(|((i, j), h)| *h *= window[i] * window[j] / of_mean);
    periodogram(under.view(), length_m)
}
