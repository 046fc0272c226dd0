//! Shape of a spectrum: roll-off, longest wavelength, anisotropy, or a table.
//!
//! An isotropic spectrum is a sequence of power laws, for which all integrals over wavenumbers are closed
//! forms. A power law is one piece, a plateau with a power law beyond it is two, and a table has a piece
//! between each two of its rows.

use super::pieces::{Piece, Pieces};
use super::psd_table::PsdTable;
use std::f64::consts::PI;
use std::sync::Arc;

/// Directions of a quadrant over which an anisotropic spectrum is averaged.
///
/// The integrand has kinks where a corner of the spectrum crosses the edge of the band: the midpoint rule
/// has an error of the order `1/DIRECTIONS²`.
const DIRECTIONS: u32 = 4096;

/// Shape of a spectrum. The default is a power law from L to L/ζ, equal in all directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Longest wavelength of the roughness \[m\]; nothing for the side L of the square.
    pub longest_wavelength_m: Option<f64>,
    /// Roll-off wavelength λ_r \[m\]: `C(q) = C(2π/λ_r)` for `q < 2π/λ_r`; nothing for a power law up to the
    /// longest wavelength.
    pub roll_off_m: Option<f64>,
    /// Aspect ratio r of the roughness: wavelengths along the direction of the lay over those across it.
    ///
    /// `C(q) = C_iso(q')` with `q'² = r q_∥² + q_⊥²/r`. Areas of the plane of wavevectors are kept.
    pub aspect_ratio: f64,
    /// Direction of the lay: angle from the x axis towards the y axis \[rad\].
    pub angle_rad: f64,
    /// Tabulated spectrum in place of the power law.
    pub table: Option<Arc<PsdTable>>,
}

impl Default for Shape {
    fn default() -> Self {
        Self { longest_wavelength_m: None, roll_off_m: None, aspect_ratio: 1.0, angle_rad: 0.0, table: None }
    }
}

impl Shape {
    /// True for the power law of Eq 10 from L to L/ζ.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        *self == Self::default()
    }

    /// True if the spectrum is equal in all directions.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        self.aspect_ratio == 1.0
    }

    /// Power laws of the isotropic spectrum with the value 1 of the power law at `unit` \[1/m\]; those of a
    /// table in m⁴.
    pub(crate) fn pieces(&self, hurst: f64, unit: f64) -> Pieces {
        if let Some(table) = &self.table {
            return Pieces(table.pieces());
        }
        let exponent = 2.0 * (hurst + 1.0);
        let law =
            |from: f64| Piece { from, to: f64::INFINITY, level: (from / unit).powf(-exponent), exponent };
        let Some(roll_off_m) = self.roll_off_m else {
            // A power law has no first wavenumber: it begins below any stretched band.
            return Pieces(vec![law(1e-6 * unit)]);
        };
        let beyond = law(2.0 * PI / roll_off_m);
        let plateau = Piece { from: 0.0, to: beyond.from, level: beyond.level, exponent: 0.0 };
        Pieces(vec![plateau, beyond])
    }

    /// Wavenumber of the isotropic spectrum over that of a wavevector at an angle from the lay.
    fn stretch(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = angle_rad.sin_cos();
        (self.aspect_ratio * cos * cos + sin * sin / self.aspect_ratio).sqrt()
    }

    /// Squared wavenumber of the isotropic spectrum for a wavevector.
    pub(crate) fn stretched(&self, [x, y]: [f64; 2]) -> f64 {
        if self.is_isotropic() {
            return x * x + y * y;
        }
        let (sin, cos) = self.angle_rad.sin_cos();
        let (along, across) = (cos * x + sin * y, cos * y - sin * x);
        self.aspect_ratio * along * along + across * across / self.aspect_ratio
    }

    /// `∫ q^p C(q) d²q` over all wavevectors with `low ≤ |q| < high`.
    pub(crate) fn integral(&self, pieces: &Pieces, p: f64, [low, high]: [f64; 2]) -> f64 {
        let along = |f: f64| f.powf(-(p + 2.0)) * pieces.integral(p + 1.0, low * f, high * f);
        if self.is_isotropic() {
            return 2.0 * PI * along(1.0);
        }
        let step = 0.5 * PI / f64::from(DIRECTIONS);
        let angles = (0..DIRECTIONS).map(|k| (f64::from(k) + 0.5) * step);
        4.0 * step * angles.map(|angle| along(self.stretch(angle))).sum::<f64>()
    }
}
