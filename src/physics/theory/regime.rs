//! Regime of a rough adhesive contact, from the elastic energy that flattens its roughness.

use super::flattening::Flattening;
use crate::model::Method;
use std::f64::consts::SQRT_2;

/// Ratio `U_el/Δγ` of all roughness from which on contact spots are separate.
pub const SEPARATE: f64 = 2.0;
/// Ratio `U_1/Δγ` of the shortest octave from which on the half-space does not conform to single asperities.
pub const BRIDGED: f64 = 1.0;
/// Ratio `U_el/Δγ` below which adhesion alone flattens the surface.
pub const FLATTENED: f64 = 0.5;

/// Contact area over A0 beyond which contact spots grow together.
pub const LARGE_AREA: f64 = 0.3;

/// Contact area over A0 without adhesion at a load: `A/A0 = erf(√2 F/(E* A0 h'))`.
///
/// With the load over `E* A0` and the rms gradient `h'`. Persson, J. Chem. Phys. 115, 3840 (2001). Adhesion
/// enlarges it.
#[must_use]
pub fn loaded_area(load: f64, rms_slope: f64) -> f64 {
    if rms_slope > 0.0 { libm::erf(SQRT_2 * load / rms_slope) } else { 1.0 }
}

/// Regime of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Regime {
    /// Adhesion alone brings nine tenths of the surface or more into contact: `U_el/Δγ` < [`FLATTENED`].
    Flattened,
    /// Contact spots grow together, or the half-space conforms to single asperities.
    NearFullContact,
    /// Contact spots are separate: `U_el/Δγ` ≥ [`SEPARATE`] and `U_1/Δγ` ≥ [`BRIDGED`].
    Separate,
}

impl Regime {
    /// Regime at the ratios `U_el/Δγ` of all roughness and `U_1/Δγ` of the shortest octave, both infinite
    /// without adhesion.
    ///
    /// A measured surface without short wavelengths has a second ratio of 0, which says nothing.
    #[must_use]
    pub fn of(persson_tosatti: f64, conformity: f64) -> Self {
        if persson_tosatti < FLATTENED {
            Self::Flattened
        } else if persson_tosatti < SEPARATE || (conformity > 0.0 && conformity < BRIDGED) {
            Self::NearFullContact
        } else {
            Self::Separate
        }
    }

    /// Regime expected of a surface before its contact is computed, at a work of adhesion \[J/m²\] and a load
    /// over `E* A0`.
    ///
    /// It follows from the energies of flattening, and from the area without adhesion at the rms gradient
    /// `h'`, [`loaded_area`].
    #[must_use]
    pub fn expected(energies: &Flattening, work_of_adhesion_j_m2: f64, load: f64, rms_slope: f64) -> Self {
        let of_adhesion = if work_of_adhesion_j_m2 > 0.0 {
            Self::of(
                energies.persson_tosatti(work_of_adhesion_j_m2),
                energies.conformity(work_of_adhesion_j_m2),
            )
        } else {
            Self::Separate
        };
        of_adhesion.with_area(loaded_area(load, rms_slope))
    }

    /// The regime at a contact area over A0: near full contact beyond [`LARGE_AREA`], whatever the adhesion.
    #[must_use]
    pub fn with_area(self, share: f64) -> Self {
        if share > LARGE_AREA { self.min(Self::NearFullContact) } else { self }
    }

    /// Name of the regime.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flattened => "flattened",
            Self::NearFullContact => "near full contact",
            Self::Separate => "separate contacts",
        }
    }

    /// Recommended method: that of `method = "auto"`.
    #[must_use]
    pub fn method(self) -> Method {
        match self {
            Self::Separate => Method::Asperities,
            Self::Flattened | Self::NearFullContact => Method::BoundaryElements,
        }
    }

    /// Expected behaviour of the contact, and the method to use instead of a given one outside its range, as
    /// a sentence without its full stop.
    #[must_use]
    pub fn expectation(self, method: Method) -> &'static str {
        match (self, method) {
            (Self::Separate, Method::Asperities) => {
                "Separate contact spots, within the range of the asperity model"
            }
            (Self::Separate, _) => "Separate contact spots; asperities are a faster alternative",
            (Self::NearFullContact, Method::Asperities) => {
                "Spots grow together: the asperity model lacks area; use boundary elements"
            }
            (Self::NearFullContact, _) => "Spots grow together; boundary elements resolve them",
            (Self::Flattened, Method::Asperities) => {
                "Adhesion alone closes the contact: the asperity model fails; use boundary elements"
            }
            (Self::Flattened, _) => {
                "Adhesion alone flattens the roughness: boundary elements reach full contact, with a probe \
                 inside its contact"
            }
        }
    }
}

/// Effective work of adhesion of a flattened surface \[J/m²\]: `Δγ (1 + h'²/2) − U_el`; nothing unless
/// `U_el < Δγ`.
///
/// With the work of adhesion Δγ, the rms gradient `h'` and the elastic energy per area `U_el` of flattening
/// all roughness \[J/m²\]. The true area exceeds the nominal one by the fraction `h'²/2`. Persson & Tosatti,
/// J. Chem. Phys. 115, 5597 (2001).
#[must_use]
pub fn effective_adhesion(work_of_adhesion_j_m2: f64, rms_slope: f64, flattening_j_m2: f64) -> Option<f64> {
    let effective = work_of_adhesion_j_m2 * (1.0 + 0.5 * rms_slope * rms_slope) - flattening_j_m2;
    (flattening_j_m2 < work_of_adhesion_j_m2).then_some(effective)
}
