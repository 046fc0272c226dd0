//! The power spectral density that a surface has, averaged over directions.

use super::modes::Field;
pub use super::psd_bin::Ring;
use crate::physics::PhysicsError;
use crate::physics::memory::zeros;
use ndarray::{Array1, ArrayView2};
use std::f64::consts::TAU;

/// `C(q) = |c_k|²/qL²` of the modes `h(x) = Σ_k c_k exp(i k·x)` of a square of side L \[m\], `qL = 2π/L`, as [`super::spectrum::Spectrum::density`] has it (Eq 10):
/// `Σ_k C(k) qL² = h_rms²`. Averaged over rings of wavevectors, four to a doubling, from the longest waves to half the grid's shortest ones; rings without modes
/// are left out.
///
/// The field is taken as periodic: of one that is not, slopes at its edges leak into a `q⁻²` of the spectrum; see [`windowed_periodogram`].
///
/// # Errors
/// Too little memory.
pub fn periodogram(heights_m: ArrayView2<'_, f64>, length_m: f64) -> Result<Vec<Ring>, PhysicsError> {
    let (n, across) = heights_m.dim();
    if n == 0 || n != across { Ok(Vec::new()) } else { Ok(Field::of(heights_m, length_m, true)?.rings()) }
}

/// The same of a field that does not continue periodically: under a Hann window `w = (1 − cos 2πx/L)(1 − cos 2πy/L)`, and over the mean of w², so that
/// the sum is h_rms² on average (Jacobs, Junge and Pastewka, Surf. Topogr. 5:013001, 2017). The window spreads each mode over its neighbours, and the longest waves have a part
/// in the mean.
///
/// # Errors
/// Too little memory.
pub fn windowed_periodogram(heights_m: ArrayView2<'_, f64>, length_m: f64) -> Result<Vec<Ring>, PhysicsError> {
    let n = heights_m.nrows();
    let window = Array1::from_shape_fn(n, |k| 1.0 - (TAU * (k as f64 + 0.5) / n as f64).cos());
    // Its mean square along one direction is 3/2.
    let of_mean = window.iter().map(|w| w * w).sum::<f64>() / n as f64;
    let mut under = zeros(heights_m.dim())?;
    under.assign(&heights_m);
    under.indexed_iter_mut().for_each(|((i, j), h)| *h *= window[i] * window[j] / of_mean);
    periodogram(under.view(), length_m)
}
