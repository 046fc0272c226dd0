//! Options of boundary elements.

use super::law::Front;
use super::numerics::Numerics;
use crate::model::{KeptContacts, Machine, Probe, Substrate};

/// Attraction between the surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Attraction {
    /// The JKR limit, a range of attraction of 0.
    Bonded {
        /// Gap at which a point outside bonds \[m\]; 0: where the surfaces touch.
        nucleation_m: f64,
        /// Tension over E\* at which contact opens inside: infinite where it opens from its edges only, 0
        /// where the law alone decides.
        strength: f64,
    },
    /// Morse's law of a range ρ.
    Range {
        /// Range ρ \[m\].
        range_m: f64,
    },
}

/// Options of a cycle by boundary elements. The defaults are those of the program, but for the opening of
/// contact: here from its edges only, in the program at the strength `Δγ/ε`.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Grid points along a side of the periodic square, mirror images included.
    ///
    /// 0: those of [`points_for`](super::points_for). Twice as many take 5 to 8 times as long; Θ changes by 9
    /// to 25 % from 8 to 16 per shortest wavelength.
    pub points: usize,
    /// Place of the first point along rows and columns, as a part of the grid spacing. It is read for
    /// periodic surfaces without a probe, of which another grid is another sample of the same surface.
    pub shift: f64,
    /// Attraction.
    pub attraction: Attraction,
    /// Corrections of the law of bonded attraction.
    pub law: Front,
    /// Sphere that carries the roughness; none for a flat surface. Its apex is in the middle of the square,
    /// which is then periodic.
    pub probe: Option<Probe>,
    /// Layer of the elastic material; none for a half-space.
    pub substrate: Option<Substrate>,
    /// The machine.
    pub machine: Machine,
    /// Step of mean penetration over the rms height; with a probe over its JKR length.
    pub approach_step: f64,
    /// Number of times that a step with a jump of the load is halved.
    pub halvings: u32,
    /// Rms residual of an equilibrium, relative to the maximum tension.
    pub precision: f64,
    /// Steps of which the regions of contact are kept.
    pub contacts: KeptContacts,
    /// Numerical choices.
    pub numerics: Numerics,
}

impl Options {
    /// True with bonded attraction, which has the law of the band-limited crack.
    pub(super) fn is_bonded(&self) -> bool {
        matches!(self.attraction, Attraction::Bonded { .. })
    }

    /// True if heights are divided by the spectrum of the kernel of the law.
    pub(super) fn emphasises(&self) -> bool {
        self.is_bonded() && self.law.is_emphasised
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            points: 0,
            shift: 0.0,
            attraction: Attraction::Bonded { nucleation_m: 0.0, strength: f64::INFINITY },
            law: Front::PLAIN,
            probe: None,
            substrate: None,
            machine: Machine::default(),
            approach_step: 0.03,
            halvings: 6,
            precision: 1e-4,
            contacts: KeptContacts::Turning,
            numerics: Numerics::default(),
        }
    }
}
