//! Power spectral density of a self-affine surface (Eq 10) and its moments.

use crate::model::{Amplitudes, Normalization};
use std::f64::consts::PI;

/// Parameters of a synthetic surface, except its seed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Side of the periodic square L \[m\].
    pub length_m: f64,
    /// Rms height \[m\] of the realisation or of the spectrum, as selected by `normalization`.
    pub rms_height_m: f64,
    /// Hurst exponent H, `0 < H ≤ 1`.
    pub hurst: f64,
    /// Magnification ζ = q1/qL.
    pub magnification: u32,
    /// Quantity that `rms_height_m` refers to.
    pub normalization: Normalization,
    /// Fixed or Rayleigh-distributed moduli.
    pub amplitudes: Amplitudes,
}

impl Spectrum {
    /// Lowest wavenumber `qL = 2π/L` \[1/m\].
    #[must_use]
    pub fn lowest_wavenumber(&self) -> f64 {
        2.0 * PI / self.length_m
    }

    /// Prefactor `C0 = h_rms² H / (π qL² (1 − ζ^(−2H)))` \[m⁴\].
    ///
    /// The spectrum's integral over d²q is `h_rms²`.
    #[must_use]
    pub fn prefactor(&self) -> f64 {
        let zeta = f64::from(self.magnification);
        let ql = self.lowest_wavenumber();
        self.rms_height_m.powi(2) * self.hurst / (PI * ql * ql * (1.0 - zeta.powf(-2.0 * self.hurst)))
    }

    /// Density `C(q) = C0 (q/qL)^(−2(H+1))` \[m⁴\] for `qL ≤ q < ζ qL`, else 0. Eq 10.
    ///
    /// The argument is the squared mode number `k² = (q/qL)²`; in integers the band edges are exact.
    /// The band is half open: it includes the shell `q = qL` and excludes `q = q1`.
    #[must_use]
    pub fn density(&self, mode_squared: u64) -> f64 {
        let zeta = u64::from(self.magnification);
        if mode_squared < 1 || mode_squared >= zeta * zeta {
            return 0.0;
        }
        self.prefactor() * (mode_squared as f64).powf(-(self.hurst + 1.0))
    }

    /// Moments of the continuous spectrum: `m0 = 2π∫qC dq`, `m2 = π∫q³C dq`, `m4 = (3π/4)∫q⁵C dq`.
    #[must_use]
    pub fn moments(&self) -> Moments {
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
