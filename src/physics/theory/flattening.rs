//! Elastic energy of flattening the roughness, and range of the asperity model.
//!
//! If flattening costs less than adhesion gains, the half-space conforms to the roughness and contact spots
//! are no longer separate.

use crate::PhysicsError;
use crate::surface::SquareMap;
use crate::surface::continuation::laplacian;
use crate::surface::edges::Edges;
use crate::surface::measured::MIN_CURVATURE_SHARE;
use crate::surface::modes::Field;
use crate::surface::periodogram::windowed;
use crate::surface::spectrum::Spectrum;
use crate::surface::synthesis::mode_sums;
use std::f64::consts::{PI, TAU};

/// Elastic energy per nominal area of flattening the roughness of a surface completely.
///
/// A mode of wavevector k and amplitude `c_k` is flattened by a pressure of amplitude `(E*/2) k c_k`. The
/// stored energy is half of pressure times displacement: `U/A0 = (E*/4) Σ_k k|c_k|²` over all modes of both
/// signs, or `(E*/4) ∫ q C(q) d²q` of a spectrum. With the reduced modulus `E*` \[Pa\], `k` and `q` \[1/m\],
/// `c_k` \[m\], `C` \[m⁴\]. Persson & Tosatti, J. Chem. Phys. 115, 5597 (2001).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flattening {
    /// Energy of all the roughness, `qL ≤ q < q1` \[J/m²\].
    pub whole_j_m2: f64,
    /// Energy of its shortest octave, `q1/2 ≤ q < q1` \[J/m²\].
    pub octave_j_m2: f64,
}

impl Flattening {
    /// Persson and Tosatti's ratio `U_el/Δγ`, with the work of adhesion Δγ \[J/m²\].
    ///
    /// Below 1 full contact costs less than adhesion gains, and the surface is sticky.
    #[must_use]
    pub fn persson_tosatti(&self, work_of_adhesion_j_m2: f64) -> f64 {
        self.whole_j_m2 / work_of_adhesion_j_m2
    }

    /// Ratio `U_el/Δγ` of the shortest octave alone.
    ///
    /// Below 1 the half-space conforms to the asperities and does not bridge them.
    #[must_use]
    pub fn conformity(&self, work_of_adhesion_j_m2: f64) -> f64 {
        self.octave_j_m2 / work_of_adhesion_j_m2
    }
}

/// Flattening energies of the continuous spectrum (Eq 10), with E* \[Pa\].
///
/// `(E*/4) ∫ q C d²q = (π/2) E* C0 qL³ ∫ x^(−2H) dx` with `x = q/qL`, from 1 or from ζ/2 to ζ.
/// At `H = 1/2` the integral is a logarithm. A spectrum with another shape has its integral over the
/// wavevectors
/// of its band.
#[must_use]
pub fn flattening(spectrum: &Spectrum, contact_modulus_pa: f64) -> Flattening {
    if !spectrum.shape.is_plain() {
        let shortest = spectrum.band_1_m()[1];
        let beyond = |low: f64| 0.25 * contact_modulus_pa * spectrum.integral(1.0, low, shortest);
        return Flattening { whole_j_m2: beyond(0.0), octave_j_m2: beyond(0.5 * shortest) };
    }
    let zeta = f64::from(spectrum.magnification);
    let prefactor =
        0.5 * PI * contact_modulus_pa * spectrum.prefactor() * spectrum.lowest_wavenumber().powi(3);
    let exponent = 1.0 - 2.0 * spectrum.hurst;
    let band = |from: f64| {
        let span = (zeta / from).ln();
        // `(ζ^e − x^e)/e` without cancellation near e = 0.
        from.powf(exponent) * if exponent == 0.0 { span } else { (exponent * span).exp_m1() / exponent }
    };
    Flattening { whole_j_m2: prefactor * band(1.0), octave_j_m2: prefactor * band((0.5 * zeta).max(1.0)) }
}

/// Flattening of a realised surface without its material: a wavenumber, and sums over its modes.
///
/// `U/A0 = E* q_u S` with `S = ¼ Σ_k (k/q_u)|c_k|²`. The unit of wavenumbers q_u is kept apart, since
/// mode numbers are integers on a generated surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativeFlattening {
    /// Unit of wavenumbers q_u \[1/m\].
    pub wavenumber_1_m: f64,
    /// Sum S of all the roughness \[m²\].
    pub whole_m2: f64,
    /// Sum S of its shortest octave \[m²\].
    pub octave_m2: f64,
}

impl RelativeFlattening {
    /// Flattening of the realised spectrum of a seed, with q_u = 2π/L.
    ///
    /// Sums in place of the integrals of [`flattening`], with the amplitudes and normalisation of the
    /// spectrum.
    #[must_use]
    pub fn realised(spectrum: &Spectrum, seed: &[u8; 32]) -> Self {
        let edge = u64::from(spectrum.magnification).pow(2);
        let [whole, octave] = mode_sums(spectrum, seed, |mode_squared| {
            let wavenumber = (mode_squared as f64).sqrt();
            // In integers the edge of the octave is exact, as is that of the band.
            [wavenumber, if 4 * mode_squared >= edge { wavenumber } else { 0.0 }]
        });
        Self {
            wavenumber_1_m: spectrum.lowest_wavenumber(),
            whole_m2: 0.25 * whole,
            octave_m2: 0.25 * octave,
        }
    }

    /// Flattening of heights on a square with the shortest wavelength \[m\], with q_u = 1/m.
    ///
    /// The shortest octave has all wavelengths of less than two shortest ones.
    /// A field that is not periodic is extended by its mirror images for all of its roughness.
    /// The slopes of their kinks would add to the shortest octave, for which a Hann window is used.
    ///
    /// # Errors
    /// Too little memory.
    pub fn measured(map: SquareMap<'_>, shortest_wavelength_m: f64) -> Result<Self, PhysicsError> {
        let SquareMap { heights_m, length_m, edges } = map;
        let edge = TAU / shortest_wavelength_m;
        let sums = |field: &Field| field.weighted(|q| [q, if 2.0 * q >= edge { q } else { 0.0 }]);
        let [whole, mut octave] = sums(&Field::of(heights_m, length_m, edges)?);
        if edges == Edges::Open {
            octave = whole.min(sums(&Field::of(windowed(heights_m)?.view(), length_m, Edges::Periodic)?)[1]);
        }
        Ok(Self { wavenumber_1_m: 1.0, whole_m2: 0.25 * whole, octave_m2: 0.25 * octave })
    }

    /// Flattening energies with E* \[Pa\].
    #[must_use]
    pub fn energies(&self, contact_modulus_pa: f64) -> Flattening {
        let unit = contact_modulus_pa * self.wavenumber_1_m;
        Flattening { whole_j_m2: unit * self.whole_m2, octave_j_m2: unit * self.octave_m2 }
    }
}

/// Flattening energies of the realised spectrum of a seed, with E* \[Pa\]. See
/// [`RelativeFlattening::realised`].
#[must_use]
pub fn realised_flattening(spectrum: &Spectrum, seed: &[u8; 32], contact_modulus_pa: f64) -> Flattening {
    RelativeFlattening::realised(spectrum, seed).energies(contact_modulus_pa)
}

/// Shortest wavelength of heights on a square after a low-pass filter with a cut-off \[m\].
///
/// It is the cut-off if the octave above it, with everything below, holds [`MIN_CURVATURE_SHARE`] of the mean
/// square Laplacian. A field without such short waves has one that is longer by a power of two. For a field
/// that is not periodic the spectrum is that of the Laplacian under a Hann window.
///
/// # Errors
/// Too little memory.
pub fn shortest_wavelength(map: SquareMap<'_>, cut_off_m: f64) -> Result<f64, PhysicsError> {
    let SquareMap { heights_m, length_m, edges } = map;
    if !(cut_off_m > 0.0 && cut_off_m.is_finite()) {
        return Ok(cut_off_m);
    }
    let n = heights_m.nrows() as f64;
    // Under the window the leakage of long wavelengths is not multiplied by q⁴.
    let points = (cut_off_m * n / length_m).max(MIN_POINTS);
    let (field, exponent) = match edges {
        Edges::Periodic => (Field::of(heights_m, length_m, Edges::Periodic)?, 4),
        Edges::Open => {
            (Field::of(windowed(laplacian(heights_m, points)?.view())?.view(), length_m, Edges::Periodic)?, 0)
        }
    };
    let mut shortest = cut_off_m;
    while 2.0 * shortest < length_m {
        let edge = TAU / shortest;
        let [octave, whole] =
            field.weighted(|q| [if 2.0 * q >= edge { q.powi(exponent) } else { 0.0 }, q.powi(exponent)]);
        if octave >= MIN_CURVATURE_SHARE * whole {
            break;
        }
        shortest *= 2.0;
    }
    Ok(shortest)
}

/// Points per cut-off wavelength for which derivatives are defined.
const MIN_POINTS: f64 = 2.5;

/// Flattening energies of heights on a square, with the shortest wavelength and E* \[Pa\]. See
/// [`RelativeFlattening::measured`].
///
/// # Errors
/// Too little memory.
pub fn measured_flattening(
    map: SquareMap<'_>,
    shortest_wavelength_m: f64,
    contact_modulus_pa: f64,
) -> Result<Flattening, PhysicsError> {
    Ok(RelativeFlattening::measured(map, shortest_wavelength_m)?.energies(contact_modulus_pa))
}
