//! Power spectral density of a self-affine surface (Eq 10) and its moments.

use super::pieces::Pieces;
use super::shape::Shape;
use crate::model::{Amplitudes, Normalization};
use std::f64::consts::PI;

/// Parameters of a synthetic surface, except its seed.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Side of the periodic square L \[m\].
    pub length_m: f64,
    /// Rms height \[m\] of the realisation or of the spectrum, as selected by `normalization`.
    pub rms_height_m: f64,
    /// Hurst exponent H, `0 < H ≤ 1`. A tabulated spectrum does not read it.
    pub hurst: f64,
    /// Magnification ζ = q1/qL: the side L over the shortest wavelength.
    pub magnification: u32,
    /// Quantity that `rms_height_m` refers to. A tabulated spectrum has its own.
    pub normalization: Normalization,
    /// Fixed or Rayleigh-distributed moduli.
    pub amplitudes: Amplitudes,
    /// Roll-off, longest wavelength, anisotropy, or a table. The default is Eq 10.
    pub shape: Shape,
}

impl Spectrum {
    /// Lowest wavenumber `qL = 2π/L` \[1/m\].
    #[must_use]
    pub fn lowest_wavenumber(&self) -> f64 {
        2.0 * PI / self.length_m
    }

    /// Wavenumbers of the band \[1/m\]: `2π/λ_long` (included) and `q1 = ζ qL` (excluded).
    #[must_use]
    pub fn band_1_m(&self) -> [f64; 2] {
        let ql = self.lowest_wavenumber();
        let longest = self.shape.longest_wavelength_m.map_or(ql, |longest| 2.0 * PI / longest);
        [longest.max(ql), f64::from(self.magnification) * ql]
    }

    /// Prefactor C0 of the power law `C0 (q/qL)^(−2(H+1))` \[m⁴\].
    ///
    /// The spectrum's integral over d²q is `h_rms²`. Without roll-off, from L to L/ζ,
    /// `C0 = h_rms² H / (π qL² (1 − ζ^(−2H)))`. A tabulated spectrum is used as it is: 1.
    #[must_use]
    pub fn prefactor(&self) -> f64 {
        if self.shape.table.is_some() {
            return 1.0;
        }
        let ql = self.lowest_wavenumber();
        if self.shape.is_plain() {
            let zeta = f64::from(self.magnification);
            return self.rms_height_m.powi(2) * self.hurst
                / (PI * ql * ql * (1.0 - zeta.powf(-2.0 * self.hurst)));
        }
        let whole = self.shape.integral(&self.shape.pieces(self.hurst, ql), 0.0, self.band_1_m());
        self.rms_height_m.powi(2) / whole
    }

    /// Density `C(q)` \[m⁴\] of the mode (k, 0), for an isotropic spectrum of all modes with the squared mode
    /// number `k² = (q/qL)²`. Eq 10: `C0 (q/qL)^(−2(H+1))` for `qL ≤ q < ζ qL`, else 0.
    ///
    /// In integers the band edges are exact. The band is half open: it includes the shell `q = qL` and
    /// excludes `q = q1`.
    #[must_use]
    pub fn density(&self, mode_squared: u64) -> f64 {
        let density = Density::of(self);
        density.isotropic(mode_squared, || (mode_squared as f64).sqrt() * self.lowest_wavenumber())
    }

    /// Density `C(q)` \[m⁴\] of the mode with the numbers `q/qL = (kx, ky)`.
    #[must_use]
    pub fn mode_density(&self, kx: i64, ky: i64) -> f64 {
        Density::of(self).at(kx, ky)
    }

    /// `∫ q^p C(q) d²q` over the wavevectors of the band with `low ≤ |q| < high` \[m^(2−p)\].
    #[must_use]
    pub fn integral(&self, p: f64, low: f64, high: f64) -> f64 {
        let [longest, shortest] = self.band_1_m();
        let pieces = self.shape.pieces(self.hurst, self.lowest_wavenumber());
        self.prefactor() * self.shape.integral(&pieces, p, [low.max(longest), high.min(shortest)])
    }

    /// Flattening of the wavelengths of a table below the shortest one, `¼ ∫ q C(q) d²q` over `|q| ≥ q1`
    /// \[m\].
    ///
    /// Times E* it is their elastic energy per area. A power law has no wavelengths below its shortest: 0.
    #[must_use]
    pub fn left_out_m(&self) -> f64 {
        if self.shape.table.is_none() {
            return 0.0;
        }
        let pieces = self.shape.pieces(self.hurst, self.lowest_wavenumber());
        0.25 * self.shape.integral(&pieces, 1.0, [self.band_1_m()[1], f64::INFINITY])
    }

    /// Moments of the continuous spectrum: `m0 = 2π∫qC dq`, `m2 = π∫q³C dq`, `m4 = (3π/4)∫q⁵C dq`.
    ///
    /// Those of an anisotropic spectrum have the same rms height, gradient and Laplacian:
    /// `m0 = ∫C d²q`, `m2 = ½∫q²C d²q`, `m4 = ⅜∫q⁴C d²q`.
    #[must_use]
    pub fn moments(&self) -> Moments {
        if !self.shape.is_plain() {
            let [m0, slope, laplacian] = [0.0, 2.0, 4.0].map(|p| self.integral(p, 0.0, f64::INFINITY));
            return Moments { m0_m2: m0, m2: 0.5 * slope, m4_1_m2: 0.375 * laplacian };
        }
        let zeta = f64::from(self.magnification);
        let ql = self.lowest_wavenumber();
        // ∫ q^p (q/qL)^(−2H−2) dq over the band, in units of qL^(p+1).
        let band = |p: f64| {
            let exponent = p - 2.0 * self.hurst - 1.0;
            if exponent.abs() < 1e-12 { zeta.ln() } else { (zeta.powf(exponent) - 1.0) / exponent }
        };
        let c0 = self.prefactor();
        Moments {
            m0_m2: 2.0 * PI * c0 * ql.powi(2) * band(1.0),
            m2: PI * c0 * ql.powi(4) * band(3.0),
            m4_1_m2: 0.75 * PI * c0 * ql.powi(6) * band(5.0),
        }
    }
}

/// Density of a spectrum at all modes, with the parts that they share.
pub(crate) struct Density<'a> {
    spectrum: &'a Spectrum,
    prefactor: f64,
    lowest: f64,
    /// Smallest squared mode number of the band.
    first: f64,
    /// Power laws of a spectrum that is not plain.
    pieces: Option<Pieces>,
}

/// Relative error of the first squared mode number, so that a shell at the longest wavelength is in the band.
const ROUNDING: f64 = 1e-12;

impl<'a> Density<'a> {
    pub(crate) fn of(spectrum: &'a Spectrum) -> Self {
        let lowest = spectrum.lowest_wavenumber();
        let shape = &spectrum.shape;
        let first = (spectrum.band_1_m()[0] / lowest).powi(2) * (1.0 - ROUNDING);
        let pieces = (!shape.is_plain()).then(|| shape.pieces(spectrum.hurst, lowest));
        Self { spectrum, prefactor: spectrum.prefactor(), lowest, first, pieces }
    }

    /// Lowest wavenumber \[1/m\].
    pub(crate) fn lowest(&self) -> f64 {
        self.lowest
    }

    /// Density of the mode (kx, ky) \[m⁴\].
    pub(crate) fn at(&self, kx: i64, ky: i64) -> f64 {
        let mode_squared = kx.unsigned_abs().pow(2) + ky.unsigned_abs().pow(2);
        self.isotropic(mode_squared, || {
            self.lowest * self.spectrum.shape.stretched([kx as f64, ky as f64]).sqrt()
        })
    }

    /// Density of a mode in the band, with the wavenumber of the isotropic spectrum.
    fn isotropic(&self, mode_squared: u64, wavenumber: impl Fn() -> f64) -> f64 {
        let zeta = u64::from(self.spectrum.magnification);
        if mode_squared < 1 || mode_squared >= zeta * zeta {
            return 0.0;
        }
        match &self.pieces {
            None => self.prefactor * (mode_squared as f64).powf(-(self.spectrum.hurst + 1.0)),
            Some(_) if (mode_squared as f64) < self.first => 0.0,
            Some(pieces) => self.prefactor * pieces.at(wavenumber()),
        }
    }
}

/// Sums over modes of `|c|²`, `k²|c|²` and `k⁴|c|²`.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct MomentSums([f64; 3]);

impl MomentSums {
    /// Adds modes of squared mode number `k²` with the power `C` \[m⁴\].
    pub(crate) fn add(&mut self, mode_squared: u64, power: f64) {
        let k2 = mode_squared as f64;
        self.0[0] += power;
        self.0[1] += power * k2;
        self.0[2] += power * k2 * k2;
    }

    /// Of the three sums.
    pub(super) fn of(sums: [f64; 3]) -> Self {
        Self(sums)
    }

    pub(crate) fn merge(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1], self.0[2] + other.0[2]])
    }

    /// Factor on the heights that yields the rms height selected by the normalisation.
    pub(crate) fn scale(&self, spectrum: &Spectrum) -> f64 {
        let cell = spectrum.lowest_wavenumber().powi(2);
        match spectrum.normalization {
            _ if spectrum.shape.table.is_some() => 1.0,
            Normalization::Spectrum => 1.0,
            Normalization::Sample => spectrum.rms_height_m / (self.0[0] * cell).sqrt(),
        }
    }

    pub(crate) fn moments(&self, spectrum: &Spectrum) -> Moments {
        let ql = spectrum.lowest_wavenumber();
        let cell = ql * ql * self.scale(spectrum).powi(2);
        Moments {
            m0_m2: cell * self.0[0],
            m2: 0.5 * cell * ql.powi(2) * self.0[1],
            m4_1_m2: 0.375 * cell * ql.powi(4) * self.0[2],
        }
    }
}

/// Spectral moments of an isotropic surface: mean squares of height, slope and curvature of a profile through
/// it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// m0 \[m²\].
    pub m0_m2: f64,
    /// m2 (dimensionless).
    pub m2: f64,
    /// m4 \[1/m²\].
    pub m4_1_m2: f64,
}

impl Moments {
    /// Moments of an isotropic surface, from its rms height \[m\], rms slope and rms Laplacian \[1/m\]:
    /// `m0 = h_rms²`, `m2 = h'_rms²/2`, `m4 = 3 h''_rms²/8`.
    #[must_use]
    pub fn of_rms(height_m: f64, slope: f64, laplacian_1_m: f64) -> Self {
        Self { m0_m2: height_m.powi(2), m2: 0.5 * slope.powi(2), m4_1_m2: 0.375 * laplacian_1_m.powi(2) }
    }

    /// `h_rms = sqrt(m0)` \[m\].
    #[must_use]
    pub fn rms_height_m(&self) -> f64 {
        self.m0_m2.sqrt()
    }

    /// `h'_rms = sqrt(2 m2)`, the rms modulus of the gradient.
    #[must_use]
    pub fn rms_slope(&self) -> f64 {
        (2.0 * self.m2).sqrt()
    }

    /// `h''_rms = sqrt(8 m4/3)` \[1/m\], the rms of the Laplacian.
    #[must_use]
    pub fn rms_curvature_1_m(&self) -> f64 {
        (8.0 * self.m4_1_m2 / 3.0).sqrt()
    }

    /// Nayak's bandwidth parameter `α = m0 m4/m2²`.
    #[must_use]
    pub fn nayak_parameter(&self) -> f64 {
        self.m0_m2 * self.m4_1_m2 / (self.m2 * self.m2)
    }

    /// Nayak's density of summits of a Gaussian surface `η = m4/(6π√3 m2)` \[1/m²\]. Below Eq A4.
    #[must_use]
    pub fn summit_density_1_m2(&self) -> f64 {
        self.m4_1_m2 / (6.0 * PI * 3f64.sqrt() * self.m2)
    }

    /// Unit of summit curvatures in Nayak's distribution, `sqrt(m4/3)` \[1/m\]. Below Eq A3.
    #[must_use]
    pub fn curvature_unit_1_m(&self) -> f64 {
        (self.m4_1_m2 / 3.0).sqrt()
    }
}
