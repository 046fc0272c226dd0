//! Roughness and energy of flattening of all wavelengths from a cut-off up.
//!
//! The scales of roughness cost differently: the elastic energy of full contact is
//! `U_el = (E*/4) Σ_k k|c_k|²` over the modes `c_k` \[m\] of wavevector k \[1/m\], with the reduced
//! modulus E* \[Pa\]. Restricted to the wavelengths `2π/k ≥ λc` it is the energy `U_el(λ ≥ λc)` of a
//! contact that ignores all shorter ones.

use crate::PhysicsError;
use crate::surface::SquareMap;
use crate::surface::modes::Field;
use crate::surface::spectrum::Spectrum;
use crate::surface::synthesis::mode_bands;
use std::f64::consts::TAU;

/// Cut-off wavelengths per decade of [`cut_offs`].
pub const PER_DECADE: u32 = 8;

/// Relative distance of two wavelengths that are one.
const SAME: f64 = 1e-9;

/// Roughness of the wavelengths from a cut-off up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LongWaves {
    /// Cut-off wavelength λc \[m\].
    pub cut_off_m: f64,
    /// Rms height of the wavelengths `λ ≥ λc` \[m\].
    pub rms_height_m: f64,
    /// Their rms gradient.
    pub rms_slope: f64,
    /// Their flattening `U_el/E* = ¼ Σ k|c_k|²` \[m\].
    pub flattening_m: f64,
}

impl LongWaves {
    /// Elastic energy per nominal area `U_el(λ ≥ λc)` of full contact with these wavelengths \[J/m²\], with
    /// E* \[Pa\].
    #[must_use]
    pub fn energy_j_m2(&self, contact_modulus_pa: f64) -> f64 {
        contact_modulus_pa * self.flattening_m
    }

    /// From `Σ|c|²`, `Σ k|c|²` and `Σ k²|c|²`, with k in a unit \[1/m\].
    fn of_sums(cut_off_m: f64, [height, energy, slope]: [f64; 3], unit_1_m: f64) -> Self {
        Self {
            cut_off_m,
            rms_height_m: height.sqrt(),
            rms_slope: unit_1_m * slope.sqrt(),
            flattening_m: 0.25 * unit_1_m * energy,
        }
    }
}

/// Cut-off wavelengths from the longest to the shortest \[m\], both included, descending.
///
/// Between them are the powers `10^(j/8)` m, which surfaces of different sizes share. Nothing unless both are
/// positive and finite, and in this order.
#[must_use]
pub fn cut_offs(longest_m: f64, shortest_m: f64) -> Vec<f64> {
    if !(shortest_m > 0.0 && shortest_m <= longest_m && longest_m.is_finite()) {
        return Vec::new();
    }
    let density = f64::from(PER_DECADE);
    let [low, high] = [shortest_m * (1.0 + SAME), longest_m * (1.0 - SAME)];
    let [first, last] = [high, low].map(|wavelength| (density * wavelength.log10()).round() as i32);
    let nodes = (last..=first).rev().map(|k| 10f64.powf(f64::from(k) / density));
    let mut all = vec![longest_m];
    all.extend(nodes.filter(|node| *node > low && *node < high));
    if shortest_m < high {
        all.push(shortest_m);
    }
    all
}

/// Roughness from each cut-off wavelength up of the realised spectrum of a seed, in the order of the cut-offs
/// \[m\], which descend.
#[must_use]
pub fn realised_long_waves(spectrum: &Spectrum, seed: &[u8; 32], cut_offs_m: &[f64]) -> Vec<LongWaves> {
    let edge = |cut_off_m: &f64| (spectrum.length_m / cut_off_m).powi(2) * (1.0 + 2.0 * SAME);
    let edges: Vec<f64> = cut_offs_m.iter().map(edge).collect();
    cumulated(cut_offs_m, &mode_bands(spectrum, seed, &edges), spectrum.lowest_wavenumber())
}

/// Roughness from each cut-off wavelength up of heights on a square, likewise.
///
/// A field that is not periodic is extended by its mirror images.
///
/// # Errors
/// Too little memory.
pub fn measured_long_waves(map: SquareMap<'_>, cut_offs_m: &[f64]) -> Result<Vec<LongWaves>, PhysicsError> {
    let edges: Vec<f64> = cut_offs_m.iter().map(|cut_off_m| TAU / cut_off_m * (1.0 + SAME)).collect();
    let field = Field::of(map.heights_m, map.length_m, map.edges)?;
    Ok(cumulated(cut_offs_m, &field.bands(&edges), 1.0))
}

/// Roughness from each cut-off wavelength up of a continuous spectrum: a power law or a table.
///
/// `h_rms² = ∫C d²q`, `h'_rms² = ∫q²C d²q` and `U_el/E* = ¼∫qC d²q` over `q < 2π/λc`.
#[must_use]
pub fn continuous_long_waves(spectrum: &Spectrum, cut_offs_m: &[f64]) -> Vec<LongWaves> {
    let of = |cut_off_m: &f64| {
        let sums = [0.0, 1.0, 2.0].map(|p| spectrum.integral(p, 0.0, TAU / cut_off_m));
        LongWaves::of_sums(*cut_off_m, sums, 1.0)
    };
    cut_offs_m.iter().map(of).collect()
}

/// From sums over the bands between the cut-offs.
fn cumulated(cut_offs_m: &[f64], bands: &[[f64; 3]], unit_1_m: f64) -> Vec<LongWaves> {
    let mut sums = [0.0; 3];
    let of = |(cut_off_m, band): (&f64, &[f64; 3])| {
        sums.iter_mut().zip(band).for_each(|(sum, part)| *sum += part);
        LongWaves::of_sums(*cut_off_m, sums, unit_1_m)
    };
    cut_offs_m.iter().zip(bands).map(of).collect()
}
