//! Synthesis of surfaces: inverse real Fourier transform of the modes of Eq 10 with random phases.
//!
//! The phase of a mode is a function of (seed, kx, ky) alone, by a counter-based generator.
//! A finer grid therefore samples the same continuous surface.
//! Another magnification or Hurst exponent keeps the phases of all common modes.

use super::spectrum::{Density, MomentSums, Moments, Spectrum};
use crate::model::Amplitudes;
use ndarray::Array2;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::{FftPlanner, num_complex::Complex64};
use std::f64::consts::TAU;

/// Realised surface: heights relative to its mean plane, and the moments of its realised spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Side of the periodic square L \[m\].
    pub length_m: f64,
    /// Heights \[m\], N × N; the row index is x.
    pub heights_m: Array2<f64>,
    /// Moments of the realised modes.
    pub moments: Moments,
}

/// Seed of a realisation: a hash of the campaign's seed and the realisation's number.
///
/// It does not depend on any position in a list.
#[must_use]
pub fn realization_seed(campaign_seed: u64, realization: u64) -> [u8; 32] {
    let mut bytes = [0u8; 16];
    bytes[..8].copy_from_slice(&campaign_seed.to_le_bytes());
    bytes[8..].copy_from_slice(&realization.to_le_bytes());
    blake3::derive_key("hysteron 2026 surface phases", &bytes)
}

/// Random numbers of one row of wavevectors (fixed kx), addressed by ky.
struct Phases(ChaCha8Rng);

impl Phases {
    fn of_row(seed: &[u8; 32], kx: i64) -> Self {
        let mut generator = ChaCha8Rng::from_seed(*seed);
        // Maps 0, −1, 1, −2, 2 … to 0, 1, 2, 3, 4 …: each row of wavevectors has its own stream.
        generator.set_stream(((kx << 1) ^ (kx >> 63)).unsigned_abs());
        Self(generator)
    }

    /// Phase in `[0, 2π)`, and an exponential variate of mean one for the mode's power.
    ///
    /// Each mode has four words of its stream.
    fn draw(&mut self, ky: u64) -> (f64, f64) {
        self.0.set_word_pos(u128::from(ky) * 4);
        let unit = |word: u64| (word >> 11) as f64 / (1u64 << 53) as f64;
        let phase = TAU * unit(self.0.next_u64());
        (phase, -(-unit(self.0.next_u64())).ln_1p())
    }
}

/// Complex amplitude of mode (kx, ky) before normalisation, for `ky > 0`, or `ky = 0` and `kx > 0`.
fn mode(
    density: &Density<'_>,
    amplitudes: Amplitudes,
    phases: &mut Phases,
    (kx, ky): (i64, u64),
) -> (Complex64, u64, f64) {
    let mode_squared = kx.unsigned_abs().pow(2) + ky * ky;
    let mut power = density.at(kx, ky as i64);
    if power > 0.0 {
        let (phase, exponential) = phases.draw(ky);
        if amplitudes == Amplitudes::Gaussian {
            power *= exponential;
        }
        return (Complex64::from_polar(power.sqrt() * density.lowest(), phase), mode_squared, power);
    }
    (Complex64::ZERO, mode_squared, 0.0)
}

/// Surface of a spectrum and a seed on `n × n` points: `h(x) = Σ_k c_k exp(i k·x)`, `|c_k|² = C(k) qL²`.
///
/// Hermitian symmetry is exact: only a half plane of wavevectors is drawn, and on the line `ky = 0` the mode
/// `−kx` is the conjugate of `kx`. All modes lie below the grid's Nyquist wavenumber (`2ζ ≤ n`), so the
/// Nyquist lines are zero.
///
/// Peak memory is 1.25 times the field at 8 points per shortest wavelength.
#[must_use]
pub fn synthesize(spectrum: &Spectrum, seed: &[u8; 32], n: usize) -> Surface {
    let zeta = (spectrum.magnification as usize).min(n.div_ceil(2));
    let (mut columns, sums) = draw_columns(spectrum, seed, n, zeta);
    let scale = sums.scale(spectrum);
    let along_x = FftPlanner::<f64>::new().plan_fft_inverse(n);
    columns.par_chunks_mut(n).for_each_init(
        || vec![Complex64::ZERO; along_x.get_inplace_scratch_len()],
        |scratch, column| {
            column.iter_mut().for_each(|c| *c *= scale);
            along_x.process_with_scratch(column, scratch);
        },
    );
    let along_y = RealFftPlanner::<f64>::new().plan_fft_inverse(n);
    let mut heights = Array2::<f64>::zeros((n, n));
    if let Some(field) = heights.as_slice_mut() {
        field.par_chunks_mut(n).enumerate().for_each_init(
            || (along_y.make_input_vec(), along_y.make_scratch_vec()),
            |(half, scratch), (x, row)| {
                half.fill(Complex64::ZERO);
                for (ky, value) in half.iter_mut().enumerate().take(zeta) {
                    *value = columns[ky * n + x];
                }
                // The mean and Nyquist lines of a real transform are real: the first up to rounding, the
                // second is 0.
                half[0].im = 0.0;
                let outcome = along_y.process_with_scratch(half, row, scratch);
                debug_assert!(outcome.is_ok(), "lengths and the real lines are set above");
            },
        );
    }
    Surface { length_m: spectrum.length_m, heights_m: heights, moments: sums.moments(spectrum) }
}

/// Peak memory of [`synthesize`] on a grid of `n × n` points \[bytes\].
#[must_use]
pub fn synthesis_bytes(spectrum: &Spectrum, n: usize) -> usize {
    let zeta = (spectrum.magnification as usize).min(n.div_ceil(2));
    let columns = n.saturating_mul(zeta).saturating_mul(size_of::<Complex64>());
    let rows = (2 * zeta).saturating_mul(zeta).saturating_mul(size_of::<Complex64>());
    let heights = n.saturating_mul(n).saturating_mul(size_of::<f64>());
    columns.saturating_add(rows.max(heights))
}

/// Weighted sums `Σ_k w(k²)|c_k|²` \[m²\] over all modes of the surface of [`synthesize`].
///
/// `k²` is the squared mode number. The weight 1 gives `h_rms²`.
#[must_use]
pub fn mode_sums<const N: usize>(
    spectrum: &Spectrum,
    seed: &[u8; 32],
    weights: impl Fn(u64) -> [f64; N],
) -> [f64; N] {
    let mut totals = [0.0; N];
    let unit = visit_modes(spectrum, seed, |mode_squared, power| {
        for (total, weight) in totals.iter_mut().zip(weights(mode_squared)) {
            *total += power * weight;
        }
    });
    totals.map(|total| total * unit)
}

/// Sums `Σ|c|²`, `Σ k|c|²` and `Σ k²|c|²` \[m²\] over the modes of [`synthesize`] in bands of mode numbers.
///
/// The squared upper edges of the bands ascend and are included; the first band begins at 0.
#[must_use]
pub(crate) fn mode_bands(spectrum: &Spectrum, seed: &[u8; 32], edges_squared: &[f64]) -> Vec<[f64; 3]> {
    let mut bands = vec![[0.0; 3]; edges_squared.len()];
    let unit = visit_modes(spectrum, seed, |mode_squared, power| {
        let squared = mode_squared as f64;
        if let Some(band) = bands.get_mut(edges_squared.partition_point(|edge| *edge < squared)) {
            let weights = [1.0, squared.sqrt(), squared];
            band.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += power * weight);
        }
    });
    bands.iter().map(|sums| sums.map(|sum| sum * unit)).collect()
}

/// Visits the modes of one half plane of wavevectors. Returns the unit of their powers.
///
/// `visit` receives the squared mode number and the power of the mode and its conjugate at −k; the power
/// times the unit is `2|c_k|²` \[m²\].
fn visit_modes(spectrum: &Spectrum, seed: &[u8; 32], mut visit: impl FnMut(u64, f64)) -> f64 {
    let reach = i64::from(spectrum.magnification) - 1;
    let density = Density::of(spectrum);
    let mut moments = MomentSums::default();
    for kx in -reach..=reach {
        let mut phases = Phases::of_row(seed, kx);
        for ky in u64::from(kx <= 0)..=reach.unsigned_abs() {
            let (_, mode_squared, power) = mode(&density, spectrum.amplitudes, &mut phases, (kx, ky));
            moments.add(mode_squared, 2.0 * power);
            visit(mode_squared, 2.0 * power);
        }
    }
    (spectrum.lowest_wavenumber() * moments.scale(spectrum)).powi(2)
}

/// Modes by columns of fixed ky, kx running fastest in transform order, and the sums of their powers.
fn draw_columns(spectrum: &Spectrum, seed: &[u8; 32], n: usize, zeta: usize) -> (Vec<Complex64>, MomentSums) {
    let mut columns = vec![Complex64::ZERO; n * zeta];
    let reach = zeta as i64 - 1;
    let density = Density::of(spectrum);
    // Rows are computed in parallel and added in order, so that the sums are independent of the threads.
    let rows: Vec<(Vec<Complex64>, MomentSums)> = (-reach..=reach)
        .into_par_iter()
        .map(|kx| {
            let mut phases = Phases::of_row(seed, kx);
            let mut sums = MomentSums::default();
            let first = u64::from(kx <= 0);
            let mut row = vec![Complex64::ZERO; zeta];
            for ky in first..zeta as u64 {
                let (amplitude, mode_squared, power) =
                    mode(&density, spectrum.amplitudes, &mut phases, (kx, ky));
                row[ky as usize] = amplitude;
                // The mode and its conjugate at −k.
                sums.add(mode_squared, 2.0 * power);
            }
            (row, sums)
        })
        .collect();
    let mut sums = MomentSums::default();
    for (kx, (row, row_sums)) in (-reach..=reach).zip(rows) {
        sums = sums.merge(row_sums);
        let place = kx.rem_euclid(n as i64) as usize;
        for (ky, amplitude) in row.into_iter().enumerate() {
            if ky == 0 {
                if kx > 0 {
                    columns[place] = amplitude;
                    columns[n - place] = amplitude.conj();
                }
            } else {
                columns[ky * n + place] = amplitude;
            }
        }
    }
    (columns, sums)
}
