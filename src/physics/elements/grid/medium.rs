//! The elastic medium: a half-space or a layer bonded to a rigid base, and the compliance in series with it.
//!
//! Under a pressure `p(q)` the surface of a layer of thickness h, bonded to a rigid base, has the
//! displacement
//!
//! `u(q) = (2/(E* q)) S(qh) p(q)`,
//! `S(s) = [(3 − 4ν) sinh 2s − 2s] / [(3 − 4ν) cosh 2s + 2s² + 5 − 12ν + 8ν²]`
//!
//! with Poisson's ratio ν and `E* = E/(1 − ν²)` (Johnson, Contact Mechanics, 1985, section 5.8). `S → 1` for
//! `qh → ∞` is the half-space. For `q → 0` the layer is compressed uniaxially:
//! `u = p h (1 − 2ν)/(E* (1 − ν)²)`, 0 for an incompressible one.
//!
//! A half-space has no displacement of `q = 0`: its mean displacement is fixed, or follows the mean pressure
//! by the compliance in series, of the machine and of the periodic cell.

/// A bonded layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Thickness h \[dx\].
    pub thickness: f64,
    /// Poisson's ratio ν, from 0 to 0.5.
    pub poisson_ratio: f64,
}

/// The medium below the surface. The default is a half-space of fixed mean displacement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Medium {
    /// The layer; none for a half-space.
    pub layer: Option<Layer>,
    /// Mean displacement per mean pressure in series with it \[dx/E*\], at least 0.
    pub series_compliance: f64,
    /// Compliance of a wall that is a part of the law \[dx/E*\]: subtracted at all wavenumbers but 0.
    pub wall_compliance: f64,
}

/// Minimum fraction of the compliance that is left where that of a wall is subtracted: reached by thin layers
/// at wavelengths beyond their thickness.
pub(crate) const LEFT_COMPLIANCE: f64 = 0.4;

/// Product of wavenumber and thickness from which on a layer is a half-space: `S − 1` is of the order
/// `s² e^(−2s)`, below 1e-15.
const DEEP: f64 = 22.0;

impl Layer {
    /// Displacement of the layer over that of a half-space, `S(qh)`, at `s = qh > 0`.
    #[must_use]
    pub fn share(&self, s: f64) -> f64 {
        if s > DEEP {
            return 1.0;
        }
        let nu = self.poisson_ratio;
        let k = 3.0 - 4.0 * nu;
        let numerator = (k - 1.0) * 2.0 * s + k * beyond_linear(2.0 * s);
        numerator / (k * (2.0 * s).cosh() + 2.0 * s * s + 5.0 - 12.0 * nu + 8.0 * nu * nu)
    }

    /// Displacement under a uniform unit pressure \[dx/E*\]: 0 if the layer is incompressible.
    #[must_use]
    pub fn compression(&self) -> f64 {
        let nu = self.poisson_ratio;
        self.thickness * (1.0 - 2.0 * nu) / (1.0 - nu).powi(2)
    }
}

/// `sinh x − x` without cancellation.
fn beyond_linear(x: f64) -> f64 {
    if x > 0.5 {
        return x.sinh() - x;
    }
    // Seven terms: the next is below 1e-17 of the sum.
    let (mut term, mut sum) = (x, 0.0);
    for k in 1..=7 {
        term *= x * x / f64::from(2 * k * (2 * k + 1));
        sum += term;
    }
    sum
}

impl Medium {
    /// Pressure per displacement at a wavenumber `q > 0` \[E*/dx\].
    #[must_use]
    pub fn stiffness(&self, q: f64) -> f64 {
        let share = self.layer.map_or(1.0, |layer| layer.share(q * layer.thickness));
        if self.wall_compliance == 0.0 {
            return 0.5 * q / share;
        }
        let compliance = 2.0 * share / q;
        (compliance - self.wall_compliance).max(LEFT_COMPLIANCE * compliance).recip()
    }

    /// Mean displacement per mean pressure \[dx/E*\]; 0 if the mean displacement is fixed.
    #[must_use]
    pub fn mean_compliance(&self) -> f64 {
        self.series_compliance + self.layer.map_or(0.0, |layer| layer.compression())
    }
}
