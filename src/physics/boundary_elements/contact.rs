//! A rough rigid surface against an elastic half-space, its states and their energy.
//!
//! With the displacement `u` (zero mean), the mean gap `D` and the heights `z`, the gap is `g = D + u − z` and the energy
//! `Π(u; D) = ½ u·K u + Σ V(g)`. The load is `F = dΠ/dΔ = −Σ V'(g)` at the approach `Δ = max z − D`.

use super::grid::remove_mean;
use super::grid::{HalfSpace, Operator, Waves};
use super::law::{Bond, Law};
use super::sums::{grain, sums};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A contact problem in units of the grid: lengths in spacings, stresses in E*.
pub struct Problem {
    /// Elastic half-space.
    pub half_space: HalfSpace,
    /// Traction–separation law.
    pub law: Law,
    /// Heights, at most 0: measured from the highest point.
    pub heights: Vec<f64>,
    /// Rule of attraction.
    pub attraction: Attraction,
}

/// Points that attract.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Attraction {
    /// The JKR limit, a range of attraction of 0: contact forms where the surfaces touch. The law acts on points that have touched and those within
    /// `margin` points of contact. A point farther than `margin` from an open one opens only if its tension exceeds `strength`. A point without a
    /// bond touches below the gap `nucleation`.
    Bonded {
        /// Points around a contact that are bonded.
        margin: usize,
        /// Gap at which a point outside bonds \[dx\].
        nucleation: f64,
        /// Tension at which contact opens inside \[E*\]: infinite where it opens from its edges only, 0 where the law alone decides.
        strength: f64,
    },
    /// All points: the range of the law acts everywhere.
    Range,
    /// No point: contact without adhesion.
    None,
}

/// A state of the contact. Fields have one value per point, row by row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Approach Δ, 0 where the undeformed surfaces touch \[dx\].
    pub approach: f64,
    /// Displacement u, with zero mean \[dx\].
    pub displacement: Vec<f64>,
    /// Elastic pressure `K u`, with zero mean \[E*\].
    pub pressure: Vec<f64>,
    /// Bond of each point.
    pub bonds: Vec<Bonding>,
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

/// Sums over a state.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Load \[E* dx²\], compression positive.
    pub load: f64,
    /// Energy Π \[E* dx³\].
    pub energy: f64,
    /// Points in contact.
    pub contact: usize,
}

impl Problem {
    /// True if a point is in contact at the gap.
    #[inline(always)]
    pub(super) fn touches(&self, bonding: Bonding, gap: f64) -> bool {
        match bonding {
            Bonding::Free => gap <= 0.0,
            Bonding::Bonded => gap < self.law.contact_gap(),
            Bonding::Sealed => true,
        }
    }

    /// Law at a point.
    #[inline(always)]
    pub(super) fn bond(&self, bonding: Bonding, gap: f64) -> Bond {
        match bonding {
            Bonding::Free => self.law.wall(gap),
            Bonding::Bonded => self.law.bonded(gap),
            Bonding::Sealed => self.law.sealed(gap),
        }
    }

    /// Undeformed and out of contact at an approach.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn apart(&self, approach: f64) -> Result<State, PhysicsError> {
        let points = self.half_space.points();
        Ok(State {
            approach,
            displacement: filled(points, 0.0)?,
            pressure: filled(points, 0.0)?,
            bonds: filled(points, if self.attraction == Attraction::Range { Bonding::Bonded } else { Bonding::Free })?,
        })
    }

    /// Reference stress of the residual \[E*\]: the maximum tension; without adhesion, the range of the heights over the side.
    pub(super) fn stress(&self) -> f64 {
        match self.attraction {
            Attraction::None => self.range() / self.half_space.columns() as f64,
            _ => self.law.strength(),
        }
    }

    /// Largest change of the displacement in one iteration \[dx\]. Without adhesion the energy is convex, and there is no barrier to pass over.
    pub(super) fn reach(&self) -> f64 {
        match self.attraction {
            Attraction::None => self.range(),
            _ => self.law.reach(),
        }
    }

    /// Range of the heights \[dx\].
    pub(super) fn range(&self) -> f64 {
        self.heights.iter().fold(0.0, |most: f64, z| most.max(-z))
    }

    /// Gap at a point.
    #[inline(always)]
    pub(super) fn gap(&self, state: &State, point: usize) -> f64 {
        state.displacement[point] - state.approach - self.heights[point]
    }

    /// Load, energy and area of a state.
    #[must_use]
    pub fn totals(&self, state: &State) -> Totals {
        let [load, elastic, adhesive, contact] = sums::<4>(self.half_space.points(), |range, sum| {
            for k in range {
                let gap = self.gap(state, k);
                let bond = self.bond(state.bonds[k], gap);
                sum[0] -= bond.tension;
                sum[1] += state.displacement[k] * state.pressure[k];
                sum[2] += bond.energy;
                sum[3] += f64::from(u8::from(self.touches(state.bonds[k], gap)));
            }
        });
        Totals { load, energy: 0.5 * elastic + adhesive, contact: contact as usize }
    }

    /// Pressure of the displacement, without the rounding of the increments.
    pub(super) fn refresh(&self, state: &mut State, waves: &mut Waves<f64>) {
        remove_mean(&mut state.displacement);
        self.half_space.apply(Operator::Stiffness, &state.displacement, &mut state.pressure, waves);
    }

    /// True if no point is bonded.
    pub(super) fn is_free(&self, state: &State) -> bool {
        state.bonds.iter().all(|bonding| *bonding == Bonding::Free)
    }

    /// Bonds the free points within the margin of a contact and opens the sealed ones within the margin of an open point; with `nucleate` free points
    /// that touch are a contact too, and sealed points whose tension exceeds the strength open. None of this raises the energy. The points whose bond has
    /// changed.
    pub fn update_bonds(&self, state: &mut State, nucleate: bool) -> Vec<usize> {
        let Attraction::Bonded { margin, nucleation, strength } = self.attraction else { return Vec::new() };
        let touching = self.map(state, |bonding, gap| match bonding {
            Bonding::Free => u8::from(nucleate && gap <= nucleation),
            _ => u8::from(self.touches(bonding, gap)),
        });
        let (near, edge) = self.surroundings(&touching, margin);
        let torn = |gap: f64| nucleate && self.law.sealed(gap).tension > strength;
        let mut changed = Vec::new();
        for (k, (near, edge)) in near.iter().zip(&edge).enumerate() {
            let next = match state.bonds[k] {
                Bonding::Free if *near == 1 => Bonding::Bonded,
                Bonding::Sealed if *edge == 1 || torn(self.gap(state, k)) => Bonding::Bonded,
                as_it_is => as_it_is,
            };
            if next != state.bonds[k] {
                changed.push(k);
            }
            state.bonds[k] = next;
        }
        changed
    }

    /// Ends the bonds of points that have separated, beyond the end of the law and of the margin, and seals those inside contacts at which the law is
    /// its spring. Neither changes the energy; with Morse's law, by less than 1e-6 Δγ per point.
    pub fn settle_bonds(&self, state: &mut State) {
        let Attraction::Bonded { margin, strength, .. } = self.attraction else { return };
        let touching = self.map(state, |bonding, gap| u8::from(self.touches(bonding, gap)));
        let (near, edge) = self.surroundings(&touching, margin);
        let (end, spring) = (self.law.end_gap(), self.law.spring_gap());
        for k in 0..near.len() {
            let gap = self.gap(state, k);
            match state.bonds[k] {
                Bonding::Bonded if near[k] == 0 && gap >= end => state.bonds[k] = Bonding::Free,
                Bonding::Bonded if strength > 0.0 && edge[k] == 0 && gap <= spring => state.bonds[k] = Bonding::Sealed,
                _ => {}
            }
        }
    }

    fn map(&self, state: &State, value: impl Fn(Bonding, f64) -> u8 + Sync) -> Vec<u8> {
        (0..self.half_space.points()).into_par_iter().with_min_len(grain(1)).map(|k| value(state.bonds[k], self.gap(state, k))).collect()
    }

    /// Points within the margin of a touching point, and those within the margin of an open one.
    fn surroundings(&self, touching: &[u8], margin: usize) -> (Vec<u8>, Vec<u8>) {
        let open: Vec<u8> = touching.par_iter().with_min_len(grain(1)).map(|t| 1 - t).collect();
        (self.within(touching, margin), self.within(&open, margin))
    }

    /// Points in a square of half side `margin` around marked points: across the edges of a periodic grid, and not of a patch.
    fn within(&self, marked: &[u8], margin: usize) -> Vec<u8> {
        let (rows, columns) = (self.half_space.rows(), self.half_space.columns());
        let periodic = !self.half_space.is_patch();
        let mut along = vec![0; marked.len()];
        along.par_chunks_mut(columns).zip(marked.par_chunks(columns)).with_min_len(grain(columns)).for_each(|(to, from)| {
            for shift in 0..=margin.min(columns - 1) {
                or(&mut to[shift..], &from[..columns - shift]);
                or(&mut to[..columns - shift], &from[shift..]);
                if periodic {
                    or(&mut to[..shift], &from[columns - shift..]);
                    or(&mut to[columns - shift..], &from[..shift]);
                }
            }
        });
        let mut near = vec![0; marked.len()];
        near.par_chunks_mut(columns).enumerate().with_min_len(grain(columns)).for_each(|(row, to)| {
            for shift in 0..=2 * margin.min(rows / 2) {
                let from = row + rows + shift - margin.min(rows / 2);
                if periodic || (rows..2 * rows).contains(&from) {
                    or(to, &along[from % rows * columns..][..columns]);
                }
            }
        });
        near
    }
}

fn or(to: &mut [u8], from: &[u8]) {
    to.iter_mut().zip(from).for_each(|(a, b)| *a |= b);
}
