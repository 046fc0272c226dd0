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

pub(crate) mod morse;

use morse::Smooth;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Width of the Gaussian kernel, in grid spacings.
pub(super) const KERNEL_WIDTH: f64 = 0.6;
/// Stiffness of the spring at small and negative gaps, in E*/dx.
pub(super) const WALL_STIFFNESS: f64 = 4.0;
/// Spacing of the table, in ℓ.
const TABLE_SPACING: f64 = 1.0 / NODES_PER_UNIT;
const NODES_PER_UNIT: f64 = 100.0;
/// Overlap in ranges beyond which the repulsion of Morse's law is linear.
pub(super) const MAX_OVERLAP: f64 = 6.0;
/// Gap in ranges beyond which Morse's law is not evaluated: its tension is 1e-12 of the maximum.
pub(super) const NEGLIGIBLE_GAP: f64 = 30.0;
/// Tension at which the table ends, in E*ℓ/dx.
const END_TENSION: f64 = 1e-7;

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

/// Law of the band-limited crack for one work of adhesion.
#[derive(Debug, Clone)]
pub struct Crack {
    /// Unit of the gap, ℓ/dx, and dx/ℓ.
    unit: f64,
    inverse_unit: f64,
    /// Gap from which on the table is valid, in ℓ.
    onset: f64,
    /// Gap of the maximum tension, in ℓ.
    peak: f64,
    /// Tension, its slope and the energy at the nodes `onset + k TABLE_SPACING`, dimensionless.
    nodes: Vec<[f64; 3]>,
}

/// Morse's law.
#[derive(Debug, Clone, Copy)]
pub struct Morse {
    work: f64,
    range: f64,
}

/// Convolutions of the Gaussian `W` with the fields of the front at the distance `x`: of `√y`, of `1/√y`, and
/// the derivative of the latter to `x`. With `y = t²` they are `∫₀^∞ 2t² W dt`, `∫₀^∞ 2 W dt` and
/// `∫₀^∞ 2 W' dt`, where `W = W(x − t²)`.
fn edge(x: f64) -> [f64; 3] {
    // The integrand is even and entire in t, so that the trapezoid rule converges exponentially.
    let end = (x.max(0.0) + 9.0 * KERNEL_WIDTH).sqrt();
    let count = 400;
    let step = end / f64::from(count);
    let mut sum = [0.0; 3];
    for k in 0..=count {
        let t = f64::from(k) * step;
        let off = (x - t * t) / KERNEL_WIDTH;
        let weight = if k == 0 || k == count { 1.0 } else { 2.0 } * step * (-0.5 * off * off).exp()
            / (KERNEL_WIDTH * (2.0 * PI).sqrt());
        sum[0] += weight * t * t;
        sum[1] += weight;
        sum[2] -= weight * off / KERNEL_WIDTH;
    }
    sum
}

/// Gap, tension and the slope `dσ/dg` of the convolved front at the distance `x` (grid spacings) from its
/// edge, in ℓ and E*ℓ/dx.
fn front(x: f64) -> [f64; 3] {
    let (ahead, behind) = (edge(x), edge(-x));
    let root = PI.sqrt();
    let (gap, gap_slope) = (4.0 / root * ahead[0], 2.0 / root * ahead[1]);
    [gap, behind[1] / root, -behind[2] / root / gap_slope]
}

impl Crack {
    /// Law for the work of adhesion `work` in E* dx.
    fn new(work: f64) -> Self {
        let mut factor = 1.0;
        let mut law = Self::scaled(factor);
        // A fixed point: the energy is nearly linear in the factor.
        for _ in 0..40 {
            let energy = -law.nodes[0][2] + 0.5 * WALL_STIFFNESS * law.onset * law.onset;
            if (energy - 1.0_f64).abs() < 1e-13 {
                break;
            }
            factor /= energy;
            law = Self::scaled(factor);
        }
        let depth = -(law.nodes[0][2] - 0.5 * WALL_STIFFNESS * law.onset * law.onset);
        debug_assert!((depth - 1.0).abs() < 1e-12, "work of adhesion of the law");
        law.unit = work.sqrt();
        law.inverse_unit = 1.0 / law.unit;
        law
    }

    /// Table with the tension of the front times `factor`.
    fn scaled(factor: f64) -> Self {
        // The spring ends where the tension of the front falls below it.
        let excess = |x: f64| {
            let [gap, tension, _] = front(x);
            factor * tension - WALL_STIFFNESS * gap
        };
        let (mut low, mut high) = (-4.0 * KERNEL_WIDTH, 4.0 * KERNEL_WIDTH);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 { low = middle } else { high = middle }
        }
        let start = 0.5 * (low + high);
        let onset = front(start)[0];
        let mut nodes = Vec::new();
        let mut x = start;
        loop {
            let gap = onset + TABLE_SPACING * nodes.len() as f64;
            // Newton for the place with this gap.
            for _ in 0..50 {
                let ahead = edge(x);
                let off = 4.0 / PI.sqrt() * ahead[0] - gap;
                x -= off / (2.0 / PI.sqrt() * ahead[1]);
                if off.abs() < 1e-14 * gap {
                    break;
                }
            }
            let [_, tension, slope] = front(x);
            nodes.push([factor * tension, factor * slope, 0.0]);
            if factor * tension < END_TENSION {
                break;
            }
        }
        if let Some(last) = nodes.last_mut() {
            *last = [0.0; 3];
        }
        for k in (0..nodes.len() - 1).rev() {
            let ([s0, d0, _], [s1, d1, v1]) = (nodes[k], nodes[k + 1]);
            nodes[k][2] = v1 - TABLE_SPACING * (0.5 * (s0 + s1) + TABLE_SPACING * (d0 - d1) / 12.0);
        }
        let most = (0..nodes.len()).max_by(|a, b| nodes[*a][0].total_cmp(&nodes[*b][0])).unwrap_or(0);
        Self { unit: 0.0, inverse_unit: 0.0, onset, peak: onset + TABLE_SPACING * most as f64, nodes }
    }

    #[inline(always)]
    fn at(&self, gap: f64) -> Bond {
        let unit = self.unit;
        let g = gap * self.inverse_unit;
        if g < self.onset {
            return Bond {
                energy: unit * unit * (0.5 * WALL_STIFFNESS * g * g - 1.0),
                tension: WALL_STIFFNESS * gap,
                slope: WALL_STIFFNESS,
            };
        }
        let place = (g - self.onset) * NODES_PER_UNIT;
        let k = place as usize;
        if k >= self.nodes.len() - 1 {
            return Bond::default();
        }
        let t = place - k as f64;
        let ([s0, d0, v0], [s1, d1, _]) = (self.nodes[k], self.nodes[k + 1]);
        let (d0, d1) = (d0 * TABLE_SPACING, d1 * TABLE_SPACING);
        // Hermite's cubic s0 + d0 t + b t² + c t³ and its integral.
        let (b, c) = (3.0 * (s1 - s0) - 2.0 * d0 - d1, 2.0 * (s0 - s1) + d0 + d1);
        Bond {
            energy: unit
                * unit
                * (v0 + TABLE_SPACING * t * (s0 + t * (0.5 * d0 + t * (b / 3.0 + t * 0.25 * c)))),
            tension: unit * (s0 + t * (d0 + t * (b + t * c))),
            slope: (d0 + t * (2.0 * b + t * 3.0 * c)) * NODES_PER_UNIT,
        }
    }
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
        Self::Crack(Crack::new(work))
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
                energy: 0.5 * WALL_STIFFNESS * gap * gap - law.unit * law.unit,
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
            Self::Crack(law) => law.onset * law.unit,
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

    /// Gap of the maximum tension \[dx\]: a point is in contact below it.
    #[must_use]
    pub fn contact_gap(&self) -> f64 {
        match self {
            Self::Crack(law) => law.peak * law.unit,
            Self::Morse(law) => law.range * std::f64::consts::LN_2,
        }
    }

    /// Maximum tension \[E*\].
    #[must_use]
    pub fn strength(&self) -> f64 {
        self.bonded(self.contact_gap()).tension
    }

    /// Gap beyond which the tension vanishes, to 1e-6 of the strength \[dx\].
    #[must_use]
    pub fn end_gap(&self) -> f64 {
        match self {
            Self::Crack(law) => (law.onset + TABLE_SPACING * (law.nodes.len() - 1) as f64) * law.unit,
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
