//! A rough rigid surface against an elastic half-space, its states and their energy.
//!
//! With the displacement `u`, the heights `z ≤ 0` from the highest point and the displacement `Δ` of the
//! rigid surface, 0 where the undeformed surfaces touch, the gap is `g = u − Δ − z` and the energy
//! `Π(u; Δ) = ½ u·K u + Σ V(g)`. The load is `F = dΠ/dΔ = −Σ V'(g)`.
//!
//! On a half-space `u` has zero mean, and `Δ` is the mean penetration. With a compliance
//! `c` in series, of the periodic cell, a layer or the machine, the mean of `u` is `cF`, the energy `½cF²` of
//! the spring is a part of Π, and
//! `Δ` is the displacement at the far end of the spring: the contact is at the mean penetration `Δ −
//! cF`, and events happen at fixed `Δ`.

use super::grid::half_space::{HalfSpace, Operator, Waves};
use super::grid::medium::Medium;
use super::grid::sums::{grain, sums};
pub use super::law::Bonding;
use super::law::{Bond, Law, Profile};
use super::line::{bend, line_tension};
use super::numerics::Numerics;
use crate::PhysicsError;
use crate::memory::filled;
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
    /// Compliance of the machine \[1/(E* dx)\], a part of that of the half-space: the displacement at its far
    /// end is the controlled one.
    pub machine_compliance: f64,
    /// Numerical choices.
    pub numerics: Numerics,
}

/// Points that attract.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Attraction {
    /// The JKR limit, a range of attraction of 0: contact forms where the surfaces touch. The law acts on
    /// points that have touched and those within `margin` points of contact. A point farther than `margin`
    /// from an open one opens only if its tension exceeds
    /// `strength`. A point without a bond touches below the gap `nucleation`.
    Bonded {
        /// Points around a contact that are bonded.
        margin: usize,
        /// Gap at which a point outside bonds \[dx\].
        nucleation: f64,
        /// Tension at which contact opens inside \[E*\]: infinite where it opens from its edges only, 0 where
        /// the law alone decides.
        strength: f64,
    },
    /// All points: the range of the law acts everywhere.
    Range,
    /// No point: contact without adhesion.
    None,
}

/// Changes of bonds away from the edges of contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nucleation {
    /// Contacts also form at free points that touch, and open inside where the strength is exceeded.
    Allowed,
    /// Bonds change at the edges of contacts only.
    Suppressed,
}

/// A state of the contact. Fields have one value per point, row by row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Displacement Δ of the rigid surface, 0 where the undeformed surfaces touch \[dx\]: the mean
    /// penetration if the mean of the displacement u is fixed.
    pub mean_penetration: f64,
    /// Displacement u \[dx\], with zero mean if that is fixed.
    pub displacement: Vec<f64>,
    /// Elastic pressure `K u` \[E*\]; empty in a state that is kept, since it follows from
    /// the displacement.
    #[serde(skip)]
    pub pressure: Vec<f64>,
    /// Bond of each point.
    pub bonds: Vec<Bonding>,
}

/// Sums over a state.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Load \[E* dx²\], compression positive.
    pub load: f64,
    /// Energy Π \[E* dx³\], without that of the machine's spring.
    pub energy: f64,
    /// Displacement of the machine's spring, `cF` in equilibrium \[dx\].
    pub machine: f64,
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
        self.law.bond(bonding, gap)
    }

    /// Surface and half-space of this problem without attraction, moved without the machine's spring. The
    /// wall is the spring of the law of the band-limited crack for every law: the exponential repulsion of
    /// Morse's law overflows in iterations without a limit of their length.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn without_adhesion(self) -> Result<Self, PhysicsError> {
        let half_space = if self.machine_compliance == 0.0 {
            self.half_space
        } else {
            let machine = self.machine_compliance * self.half_space.points() as f64;
            let whole = *self.half_space.medium();
            let medium = Medium { series_compliance: whole.series_compliance - machine, ..whole };
            let whole = HalfSpace::of(&medium, self.half_space.rows(), self.half_space.columns())?;
            if self.half_space.is_mirrored() { whole.with_images() } else { whole }
        };
        let law = Law::crack(self.law.work());
        Ok(Self { half_space, attraction: Attraction::None, law, machine_compliance: 0.0, ..self })
    }

    /// Undeformed and out of contact at a mean penetration.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn apart(&self, mean_penetration: f64) -> Result<State, PhysicsError> {
        let points = self.half_space.points();
        Ok(State {
            mean_penetration,
            displacement: filled(points, 0.0)?,
            pressure: filled(points, 0.0)?,
            bonds: filled(
                points,
                if self.attraction == Attraction::Range { Bonding::Bonded } else { Bonding::Free },
            )?,
        })
    }

    /// Reference stress of the residual \[E*\]: the maximum tension; without adhesion, the range of the
    /// heights over the side.
    pub(super) fn stress(&self) -> f64 {
        match self.attraction {
            Attraction::None => self.range() / self.half_space.columns() as f64,
            _ => self.law.strength(),
        }
    }

    /// Largest change of the displacement in one iteration \[dx\]. Without adhesion the energy is convex, and
    /// there is no barrier to pass over.
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
        state.displacement[point] - state.mean_penetration - self.heights[point]
    }

    /// Step φ of the line at a point.
    fn profile(&self, state: &State, point: usize) -> Profile {
        self.law.profile(state.bonds[point], self.gap(state, point))
    }

    /// Tension of the line at a point \[E*\].
    pub(super) fn line_tension(&self, state: &State, point: usize) -> f64 {
        if !self.law.has_line() {
            return 0.0;
        }
        line_tension(&self.half_space, &self.law, point, |k| self.profile(state, k))
    }

    /// Step φ of the line at all points; none without a line.
    fn profiles(&self, state: &State) -> Vec<Profile> {
        let points = if self.law.has_line() { self.half_space.points() } else { 0 };
        (0..points).into_par_iter().with_min_len(grain(1)).map(|k| self.profile(state, k)).collect()
    }

    /// Tension of a point in equilibrium \[E*\].
    #[must_use]
    pub fn tension(&self, state: &State, point: usize) -> f64 {
        self.bond(state.bonds[point], self.gap(state, point)).tension + self.line_tension(state, point)
    }

    /// Distance of the surfaces at a point \[dx\]: the gap of the law, less the displacement of a wall that
    /// is a part of the operator.
    #[must_use]
    pub fn true_gap(&self, state: &State, point: usize) -> f64 {
        let wall = self.half_space.medium().wall_compliance;
        let gap = self.gap(state, point);
        if wall == 0.0 { gap } else { gap - wall * self.tension(state, point) }
    }

    /// Load, energy and area of a state.
    #[must_use]
    pub fn totals(&self, state: &State) -> Totals {
        let points = self.half_space.points();
        let (profiles, factor) = (self.profiles(state), self.law.line_factor());
        let bend = |k: usize| match profiles.get(k) {
            Some(here) if here.value != 0.0 || here.rate != 0.0 => {
                bend(&self.half_space, k, |k| profiles[k].value)
            }
            _ => 0.0,
        };
        let [load, elastic, adhesive, contact] = sums::<4>(points, |range, sum| {
            for k in range {
                let gap = self.gap(state, k);
                let bond = self.bond(state.bonds[k], gap);
                let (bend, of) = (bend(k), profiles.get(k).copied().unwrap_or_default());
                sum[0] -= bond.tension + factor * of.rate * bend;
                sum[1] += state.displacement[k] * state.pressure[k];
                sum[2] += bond.energy + 0.5 * factor * of.value * bend;
                sum[3] += f64::from(u8::from(self.touches(state.bonds[k], gap)));
            }
        });
        let machine = self.machine(state);
        let spring = if machine == 0.0 { 0.0 } else { 0.5 * machine * machine / self.machine_compliance };
        Totals { load, energy: 0.5 * elastic + adhesive - spring, machine, contact: contact as usize }
    }

    /// Displacement of the machine's spring: its share of the mean displacement.
    fn machine(&self, state: &State) -> f64 {
        if self.machine_compliance == 0.0 {
            return 0.0;
        }
        let [sum] = sums(state.displacement.len(), |range, sum| {
            sum[0] += state.displacement[range].iter().sum::<f64>();
        });
        sum * self.machine_compliance / self.half_space.medium().mean_compliance()
    }

    /// Pressure of the displacement, without the rounding of the increments.
    pub(super) fn refresh(&self, state: &mut State, waves: &mut Waves<f64>) {
        self.half_space.fix_mean(&mut state.displacement);
        self.half_space.apply(Operator::Stiffness, &state.displacement, &mut state.pressure, waves);
    }

    /// True if every change is made alike on a surface and its mirror images. On a soft machine the event of
    /// one image would unload the others, and only rounding would decide which one has it.
    pub(super) fn moves_images_alike(&self) -> bool {
        self.half_space.is_mirrored() && self.machine_compliance > 0.0
    }

    /// True if no point is bonded.
    pub(super) fn is_free(&self, state: &State) -> bool {
        state.bonds.iter().all(|bonding| *bonding == Bonding::Free)
    }

    /// Bonds the free points within the margin of a contact and opens the sealed ones within the margin of an
    /// open point.
    ///
    /// With [`Nucleation::Allowed`] free points that touch are a contact too, and sealed points whose tension
    /// exceeds the strength open. None of this raises the energy. Returns the points whose bond has changed.
    pub fn update_bonds(&self, state: &mut State, nucleation: Nucleation) -> Vec<usize> {
        let Attraction::Bonded { nucleation: nucleation_gap, strength, .. } = self.attraction else {
            return Vec::new();
        };
        let nucleate = nucleation == Nucleation::Allowed;
        let touching = self.map(state, |bonding, gap| match bonding {
            Bonding::Free => u8::from(nucleate && gap <= nucleation_gap),
            _ => u8::from(self.touches(bonding, gap)),
        });
        let mut torn = Vec::new();
        if nucleate && strength.is_finite() {
            let tears = |k: &usize| {
                state.bonds[*k] == Bonding::Sealed && self.law.sealed(self.gap(state, *k)).tension > strength
            };
            torn.par_extend((0..touching.len()).into_par_iter().with_min_len(grain(1)).filter(tears));
        }
        let spread = self.spread_bonds(&mut state.bonds, &touching, &mut vec![true; self.half_space.rows()]);
        let mut changed: Vec<usize> = spread.into_iter().map(|(point, _)| point).collect();
        for k in torn {
            if state.bonds[k] == Bonding::Sealed {
                state.bonds[k] = Bonding::Bonded;
                changed.push(k);
            }
        }
        changed
    }

    /// Bonds the free points within the margin of touching points and opens the sealed ones within the margin
    /// of an open point, in the rows around `stale` rows, which are then up to date. Returns the points whose
    /// bond has changed, with the bond before.
    pub(super) fn spread_bonds(
        &self,
        bonds: &mut [Bonding],
        touching: &[u8],
        stale: &mut [bool],
    ) -> Vec<(usize, Bonding)> {
        let Attraction::Bonded { margin, .. } = self.attraction else { return Vec::new() };
        if !stale.contains(&true) {
            return Vec::new();
        }
        let columns = self.half_space.columns();
        let near_stale = |row: usize| self.rows_around(row, margin).any(|row| stale[row]);
        let rows = bonds
            .par_chunks_mut(columns)
            .enumerate()
            .with_min_len(grain(columns))
            .filter(|(row, _)| near_stale(*row));
        let changed: Vec<Vec<(usize, Bonding)>> = rows
            .map(|(row, bonds)| {
                let (near, edge) = self.surroundings_in(row, touching, margin);
                let mut changed = Vec::new();
                for (k, bonding) in bonds.iter_mut().enumerate() {
                    let next = match *bonding {
                        Bonding::Free if near[k] == 1 => Bonding::Bonded,
                        Bonding::Sealed if edge[k] == 1 => Bonding::Bonded,
                        as_it_is => as_it_is,
                    };
                    if next != *bonding {
                        changed.push((row * columns + k, std::mem::replace(bonding, next)));
                    }
                }
                changed
            })
            .collect();
        stale.fill(false);
        changed.concat()
    }

    /// Ends the bonds of points that have separated, beyond the end of the law and of the margin, and seals
    /// those inside contacts at which the law is its spring. Neither changes the energy; with Morse's law, by
    /// less than 1e-6 Δγ per point. Full contact opens at its point of the largest tension, which is not
    /// sealed if the strength is finite.
    pub fn settle_bonds(&self, state: &mut State) {
        let Attraction::Bonded { margin, strength, .. } = self.attraction else { return };
        let touching = self.map(state, |bonding, gap| u8::from(self.touches(bonding, gap)));
        let (end, spring) = (self.law.end_gap(), self.law.spring_gap());
        let nucleus =
            if strength.is_finite() && !touching.contains(&0) { self.widest_gap(state) } else { None };
        let columns = self.half_space.columns();
        let mean_penetration = state.mean_penetration;
        let rows = (
            state.bonds.par_chunks_mut(columns),
            state.displacement.par_chunks(columns),
            self.heights.par_chunks(columns),
        );
        rows.into_par_iter().enumerate().with_min_len(grain(columns)).for_each(
            |(row, (bonds, displacement, heights))| {
                let (near, edge) = self.surroundings_in(row, &touching, margin);
                for (k, bonding) in bonds.iter_mut().enumerate() {
                    let gap = displacement[k] - mean_penetration - heights[k];
                    match *bonding {
                        Bonding::Bonded if near[k] == 0 && gap >= end => *bonding = Bonding::Free,
                        Bonding::Bonded if strength > 0.0 && edge[k] == 0 && gap <= spring => {
                            *bonding = Bonding::Sealed;
                        }
                        _ => {}
                    }
                }
            },
        );
        if let Some(point) = nucleus {
            state.bonds[point] = Bonding::Bonded;
        }
    }

    /// The point with the widest gap, the first of equal ones: in full contact that of the largest tension.
    fn widest_gap(&self, state: &State) -> Option<usize> {
        (0..self.half_space.points()).rev().max_by(|a, b| self.gap(state, *a).total_cmp(&self.gap(state, *b)))
    }

    fn map(&self, state: &State, value: impl Fn(Bonding, f64) -> u8 + Sync) -> Vec<u8> {
        (0..self.half_space.points())
            .into_par_iter()
            .with_min_len(grain(1))
            .map(|k| value(state.bonds[k], self.gap(state, k)))
            .collect()
    }

    /// Rows within the margin of a row: across the edges of a periodic grid, and not of a patch.
    fn rows_around(&self, row: usize, margin: usize) -> impl Iterator<Item = usize> + use<> {
        let (rows, periodic) = (self.half_space.rows(), !self.half_space.is_patch());
        let margin = margin.min(rows / 2);
        let first = row + rows - margin;
        (first..=first + 2 * margin)
            .filter(move |row| periodic || (rows..2 * rows).contains(row))
            .map(move |row| row % rows)
    }

    /// Points of a row within a square of half side `margin` around a touching point, and those around an
    /// open one.
    fn surroundings_in(&self, row: usize, touching: &[u8], margin: usize) -> (Vec<u8>, Vec<u8>) {
        let columns = self.half_space.columns();
        let (mut near, mut edge) = (vec![0; columns], vec![0; columns]);
        for row in self.rows_around(row, margin) {
            for ((near, edge), touches) in
                near.iter_mut().zip(&mut edge).zip(&touching[row * columns..][..columns])
            {
                *near |= touches;
                *edge |= 1 - touches;
            }
        }
        (self.widened(&near, margin), self.widened(&edge, margin))
    }

    /// Points of a row within `margin` of a marked one.
    fn widened(&self, marked: &[u8], margin: usize) -> Vec<u8> {
        let columns = marked.len();
        let mut wide = marked.to_vec();
        for shift in 1..=margin.min(columns - 1) {
            or(&mut wide[shift..], &marked[..columns - shift]);
            or(&mut wide[..columns - shift], &marked[shift..]);
            if !self.half_space.is_patch() {
                or(&mut wide[..shift], &marked[columns - shift..]);
                or(&mut wide[columns - shift..], &marked[..shift]);
            }
        }
        wide
    }
}

fn or(to: &mut [u8], from: &[u8]) {
    to.iter_mut().zip(from).for_each(|(a, b)| *a |= b);
}
