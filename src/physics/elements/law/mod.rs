//! Traction–separation laws of adhesion.
//!
//! # Law of the band-limited crack
//! The front of a crack between a rigid flat and a half-space, at the energy release rate Δγ, has the
//! near-tip field of Irwin (J. Appl. Mech. 24:361, 1957): the gap `g(x) = 4 sqrt(Δγ x/(πE*))` on the open
//! side (`x > 0`) and the tension `σ(x) = sqrt(E*Δγ/(π|x|))` on the closed side. Convolve both with one even
//! kernel `W`: the operator `E*|q|/2` is diagonal in the wavevector, so the convolved fields satisfy it too.
//! If the spectrum of `W` vanishes above the Nyquist wavenumber of a grid, their values at the grid points
//! satisfy the equations of the grid exactly, at every position of the front between two points and at every
//! orientation. Eliminating `x` gives a law `σ(g)` under which a straight front has a continuous family of
//! equilibria: no lattice trapping. By the J integral `∫σ dg = Δγ`.
//!
//! `W` is a Gaussian of width `s = 0.6` grid spacings. Its spectrum is not 0 but 0.17 at the Nyquist
//! wavenumber, so the last two statements hold approximately: the trapping that is left is below 1e-3 of Δγ
//! (measured in the tests). In units of `ℓ = sqrt(Δγ dx/E*)` for gaps and `E* ℓ/dx` for stresses the law does
//! not depend on the material. Its tension rises from 0 at `g = 0` with an infinite slope; that start is
//! replaced by the spring `σ = k g` with `k = 4 E*/dx`, which is the stiffness of the wall for `g < 0` as
//! well, and the tension beyond is scaled by a factor near 1 so that `∫σ dg = Δγ` exactly.
//!
//! # Morse
//! `V(g) = Δγ (e^(−2g/ρ) − 2e^(−g/ρ))`: attraction of a range ρ, for finite Tabor parameters and comparison
//! with other programs.

mod crack;
mod front;
pub(crate) mod morse;
mod table;

pub use crack::{Crack, Profile};
pub use front::Front;
use morse::Smooth;
use serde::{Deserialize, Serialize};

/// Width of the Gaussian kernel, in grid spacings.
pub(super) const KERNEL_WIDTH: f64 = 0.6;
/// Stiffness of the spring at small and negative gaps, in E*/dx.
pub(super) const WALL_STIFFNESS: f64 = 4.0;
/// Overlap in ranges beyond which the repulsion of Morse's law is linear.
pub(super) const MAX_OVERLAP: f64 = 6.0;
/// Gap in ranges beyond which Morse's law is not evaluated: its tension is 1e-12 of the maximum.
pub(super) const NEGLIGIBLE_GAP: f64 = 30.0;

/// A law in the pieces that a pass over many points distinguishes, for a free, a bonded and a sealed point
/// \[dx\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Pieces {
    /// Stiffness of the spring \[E*/dx\].
    pub(super) stiffness: f32,
    /// Gap below which the spring acts. Above it the tension vanishes, but for the gaps of `curved`.
    pub(super) spring: [f32; 3],
    /// First and last gap at which the law itself has to be evaluated.
    pub(super) curved: [[f32; 2]; 3],
    /// Gap below which a point is in contact.
    pub(super) contact: [f32; 3],
    /// Morse's law, by which most bonded points are evaluated at once.
    pub(super) smooth: Option<Smooth>,
}

/// Energy, tension and its slope at a gap: `V` in E* dx, `V' = σ` in E*, `V'' = dσ/dg` in E*/dx.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bond {
    /// Energy per area, −Δγ at zero gap and 0 when separated.
    pub energy: f64,
    /// Tension, negative for pressure.
    pub tension: f64,
    /// Slope of the tension.
    pub slope: f64,
}

/// Bond of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Bonding {
    /// None: the wall alone acts.
    Free,
    /// The law acts.
    Bonded,
    /// The law acts without a limit of strength: the point is inside a contact, away from its edges.
    Sealed,
}

/// A traction–separation law. Gaps in grid spacings, energies per area in E* dx.
#[derive(Debug, Clone)]
pub enum Law {
    /// Band-limited crack.
    Crack(Crack),
    /// Morse.
    Morse(Morse),
}

/// Morse's law.
#[derive(Debug, Clone, Copy)]
pub struct Morse {
    work: f64,
    range: f64,
}

impl Morse {
    /// Below [`MAX_OVERLAP`] ranges of overlap the pressure continues along its tangent. No equilibrium is
    /// there, but an iteration may be, and the exponential would overflow.
    #[inline(always)]
    fn at(&self, gap: f64) -> Bond {
        let inside = gap.max(-MAX_OVERLAP * self.range);
        let beyond = gap - inside;
        let e = (-inside / self.range).exp();
        let unit = self.work / self.range;
        let tension = 2.0 * unit * e * (1.0 - e);
        let slope = 2.0 * unit / self.range * e * (2.0 * e - 1.0);
        Bond {
            energy: self.work * e * (e - 2.0) + beyond * (tension + 0.5 * slope * beyond),
            tension: tension + slope * beyond,
            slope,
        }
    }
}

impl Law {
    /// Law of the band-limited crack for the work of adhesion `work` \[E* dx\]. With 0 only [`Self::wall`] is
    /// defined.
    #[must_use]
    pub fn crack(work: f64) -> Self {
        Self::front(work, &Front::PLAIN)
    }

    /// As [`Self::crack`], with corrections. The half-space has their [wall](Front::wall_compliance).
    #[must_use]
    pub fn front(work: f64, front: &Front) -> Self {
        Self::Crack(Crack::new(work, front))
    }

    /// True if fronts have a line tension.
    #[must_use]
    pub fn has_line(&self) -> bool {
        matches!(self, Self::Crack(law) if law.table.line.is_some())
    }

    /// Factor `2λΔγ` of the tension by the curvature of the front \[E* dx\].
    pub(super) fn line_factor(&self) -> f64 {
        match self {
            Self::Crack(law) => law.line_factor(),
            Self::Morse(_) => 0.0,
        }
    }

    /// Step φ of a front at a point.
    #[inline(always)]
    pub(super) fn profile(&self, bonding: Bonding, gap: f64) -> Profile {
        match (self, bonding) {
            (Self::Crack(law), Bonding::Bonded) => law.profile(gap),
            (Self::Crack(_), Bonding::Sealed) => Profile::INSIDE,
            _ => Profile::default(),
        }
    }

    /// Morse's law of the work of adhesion `work` \[E* dx\] and the range ρ \[dx\], both positive.
    #[must_use]
    pub fn morse(work: f64, range: f64) -> Self {
        Self::Morse(Morse { work, range })
    }

    /// Energy, tension and slope at a point.
    #[must_use]
    #[inline(always)]
    pub fn bond(&self, bonding: Bonding, gap: f64) -> Bond {
        match bonding {
            Bonding::Free => self.wall(gap),
            Bonding::Bonded => self.bonded(gap),
            Bonding::Sealed => self.sealed(gap),
        }
    }

    /// Energy, tension and slope at a gap of a bonded point.
    #[must_use]
    #[inline(always)]
    pub fn bonded(&self, gap: f64) -> Bond {
        match self {
            Self::Crack(law) => law.at(gap),
            Self::Morse(law) => law.at(gap),
        }
    }

    /// Energy, tension and slope of a point inside a contact, which does not open: the spring of small gaps,
    /// continued.
    #[must_use]
    #[inline(always)]
    pub fn sealed(&self, gap: f64) -> Bond {
        match self {
            Self::Crack(law) => Bond {
                energy: 0.5 * WALL_STIFFNESS * gap * gap - law.unit * law.unit * law.table.depth,
                tension: WALL_STIFFNESS * gap,
                slope: WALL_STIFFNESS,
            },
            Self::Morse(law) => {
                let slope = 2.0 * law.work / (law.range * law.range);
                if gap <= 0.0 {
                    law.at(gap)
                } else {
                    Bond { energy: 0.5 * slope * gap * gap - law.work, tension: slope * gap, slope }
                }
            }
        }
    }

    /// The law in pieces.
    pub(super) fn pieces(&self) -> Pieces {
        let (never, always) = (f32::NEG_INFINITY, f32::INFINITY);
        let contact = [f32::MIN_POSITIVE, self.contact_gap() as f32, always];
        match self {
            Self::Crack(_) => Pieces {
                stiffness: WALL_STIFFNESS as f32,
                spring: [0.0, self.spring_gap() as f32, always],
                curved: [[always, never], [self.spring_gap() as f32, self.end_gap() as f32], [always, never]],
                contact,
                smooth: None,
            },
            Self::Morse(law) => Pieces {
                stiffness: 0.0,
                spring: [never; 3],
                curved: [[never, 0.0], [never, (NEGLIGIBLE_GAP * law.range) as f32], [never, always]],
                contact,
                smooth: Some(Smooth { work: law.work as f32, inverse_range: (1.0 / law.range) as f32 }),
            },
        }
    }

    /// Gap up to which the law is its spring \[dx\].
    #[must_use]
    pub fn spring_gap(&self) -> f64 {
        match self {
            Self::Crack(law) => law.table.onset * law.unit,
            Self::Morse(_) => 0.0,
        }
    }

    /// Energy, tension and slope of a point that is not bonded: the wall alone, without its energy of
    /// adhesion.
    #[must_use]
    #[inline(always)]
    pub fn wall(&self, gap: f64) -> Bond {
        if gap >= 0.0 {
            return Bond::default();
        }
        match self {
            Self::Crack(_) => Bond {
                energy: 0.5 * WALL_STIFFNESS * gap * gap,
                tension: WALL_STIFFNESS * gap,
                slope: WALL_STIFFNESS,
            },
            Self::Morse(law) => {
                let bond = law.at(gap);
                Bond { energy: bond.energy + law.work, ..bond }
            }
        }
    }

    /// Work of adhesion \[E* dx\].
    #[must_use]
    pub fn work(&self) -> f64 {
        match self {
            Self::Crack(law) => law.unit * law.unit,
            Self::Morse(law) => law.work,
        }
    }

    /// Gap below which a point is in contact \[dx\]: that of the maximum tension, or of the place of the
    /// front.
    #[must_use]
    pub fn contact_gap(&self) -> f64 {
        match self {
            Self::Crack(law) => law.table.edge * law.unit,
            Self::Morse(law) => law.range * std::f64::consts::LN_2,
        }
    }

    /// Gap between the surfaces below which a bonded point is in contact \[dx\]: [`Self::contact_gap`] less
    /// the displacement of a wall that is a part of the operator.
    #[must_use]
    pub fn true_contact_gap(&self) -> f64 {
        match self {
            Self::Crack(law) => law.table.true_edge * law.unit,
            Self::Morse(_) => self.contact_gap(),
        }
    }

    /// Maximum tension \[E*\].
    #[must_use]
    pub fn strength(&self) -> f64 {
        match self {
            Self::Crack(law) => law.strength(),
            Self::Morse(_) => self.bonded(self.contact_gap()).tension,
        }
    }

    /// Gap beyond which the tension vanishes, to 1e-6 of the strength \[dx\].
    #[must_use]
    pub fn end_gap(&self) -> f64 {
        match self {
            Self::Crack(law) => law.table.end * law.unit,
            Self::Morse(law) => 15.0 * law.range,
        }
    }

    /// Length over which a solution may change in one iteration \[dx\], so that no energy barrier is passed
    /// over.
    #[must_use]
    pub fn reach(&self) -> f64 {
        match self {
            Self::Crack(law) => 0.8 * law.unit,
            Self::Morse(law) => law.range,
        }
    }
}
