//! The power spectral density that a surface has, averaged over directions.

use ndarray::ArrayView2;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;
use std::f64::consts::TAU;

/// Rings to a doubling of the wavenumber.
const RINGS: f64 = 4.0;

/// What the modes of a ring of wavevectors have on average.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Mean wavenumber q \[1/m\].
    pub wavenumber_1_m: f64,
    /// Mean power spectral density C(q) \[m⁴\].
    pub density_m4: f64,
    /// How many modes there are.
    pub mode_count: u64,
}

/// `C(q) = |c_k|²/qL²` of the modes `h(x) = Σ_k c_k exp(i k·x)` of a square of side L \[m\], `qL = 2π/L`, as [`super::spectrum::Spectrum::density`] has it (Eq 10):
/// `Σ_k C(k) qL² = h_rms²`. Averaged over rings of wavevectors, four to a doubling, from the longest waves to half the grid's shortest ones; rings without modes
/// are left out.
///
/// The field is taken as periodic: of one that is not, slopes at its edges leak into a `q⁻²` of the spectrum.
#[must_use]
pub fn periodogram(heights_m: ArrayView2<'_, f64>, length_m: f64) -> Vec<Ring> {
    let (n, across) = heights_m.dim();
    if n == 0 || n != across {
        return Vec::new();
    }
    let half = n / 2 + 1;
    let along_y = RealFftPlanner::<f64>::new().plan_fft_forward(n);
    let mut columns = vec![Complex64::ZERO; half * n];
    let rows: Vec<Vec<Complex64>> = (0..n)
        .into_par_iter()
        .map_init(
            || (along_y.make_input_vec(), along_y.make_scratch_vec()),
            |(row, scratch), x| {
                row.iter_mut().zip(heights_m.row(x)).for_each(|(to, from)| *to = *from);
                let mut waves = along_y.make_output_vec();
                let outcome = along_y.process_with_scratch(row, &mut waves, scratch);
                debug_assert!(outcome.is_ok(), "lengths are those of the plan");
                waves
            },
        )
        .collect();
    columns.par_chunks_mut(n).enumerate().for_each(|(ky, column)| {
        for (value, row) in column.iter_mut().zip(&rows) {
            *value = row[ky];
        }
    });
    drop(rows);
    let along_x = FftPlanner::<f64>::new().plan_fft_forward(n);
    let lowest = TAU / length_m;
    // |c_k|² = |ĥ_k|²/n⁴.
    let unit = 1.0 / ((n as f64).powi(4) * lowest * lowest);
    let count = (RINGS * (n as f64 / 2.0).log2()).round() as usize + 1;
    let sums: Vec<Vec<(f64, f64, u64)>> = columns
        .par_chunks_mut(n)
        .enumerate()
        .map_init(
            || vec![Complex64::ZERO; along_x.get_inplace_scratch_len()],
            |scratch, (ky, column)| {
                along_x.process_with_scratch(column, scratch);
                let mut rings = vec![(0.0, 0.0, 0); count];
                for (place, value) in column.iter().enumerate() {
                    let kx = if place <= n / 2 { place } else { n - place };
                    let mode = (kx as f64).hypot(ky as f64);
                    // The wavevectors of a disc: corners of the grid have no whole rings.
                    if mode > 0.0 && mode < n as f64 / 2.0 {
                        let ring = &mut rings[(RINGS * mode.log2()).round() as usize];
                        // Every column but the first stands for its mirror image too.
                        let times = if ky == 0 { 1 } else { 2 };
                        ring.0 += times as f64 * mode;
                        ring.1 += times as f64 * value.norm_sqr();
                        ring.2 += times;
                    }
                }
                rings
            },
        )
        .collect();
    // Added up in their order, so that the sums do not depend on the threads.
    let mut rings = vec![(0.0, 0.0, 0_u64); count];
    for column in &sums {
        for (ring, more) in rings.iter_mut().zip(column) {
            *ring = (ring.0 + more.0, ring.1 + more.1, ring.2 + more.2);
        }
    }
    let mean = |(modes, power, count): (f64, f64, u64)| Ring {
        wavenumber_1_m: lowest * modes / count as f64,
        density_m4: unit * power / count as f64,
        mode_count: count,
    };
    rings.into_iter().filter(|ring| ring.2 > 0).map(mean).collect()
}
