//! Contact problem: the data that are constant along the path.

use super::neighbours::Neighbours;
use super::numbering::Places;
use crate::PhysicsError;
use crate::asperities::field::spot_field::{Spot, spot_field_as_printed};
use crate::asperities::field::{FieldSum, Spots, choose};
use crate::asperities::numerics::{Events, Numerics};
use crate::jkr::{Asperity, MIN_TABOR};
use crate::math::grown::Grown;
use crate::model::{Boundary, Coalescence, Interaction as Kind, JumpIn, Material, Slips};
use crate::surface::summits::Summit;
use std::f64::consts::PI;
use std::sync::Arc;

/// Options of the contact model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Elastic interaction between contacts.
    pub interaction: Kind,
    /// Boundary condition of the square.
    pub boundary: Boundary,
    /// Rule for an asperity under a larger contact.
    pub coalescence: Coalescence,
    /// Jump-in criterion of a free asperity.
    pub jump_in: JumpIn,
    /// Allows Tabor parameters below 2 with Wu's rule.
    pub allow_low_tabor: bool,
    /// Errata of the paper to apply: equations as printed.
    pub slips: Slips,
}

/// The program's defaults.
impl Default for Rules {
    fn default() -> Self {
        Self {
            interaction: Kind::Spots,
            boundary: Boundary::Periodic,
            coalescence: Coalescence::Merge,
            jump_in: JumpIn::Wu,
            allow_low_tabor: false,
            slips: Slips::NONE,
        }
    }
}

/// Asperities over a half-space: the data that are constant along the path, except for merged spots.
///
/// Module `contact::merging` adds and describes the merged spots.
#[derive(Clone)]
pub struct Problem {
    pub(crate) asperities: Grown<Asperity>,
    /// Caller's numbers and positions.
    pub(crate) places: Arc<Places>,
    /// Heights relative to the highest asperity \[m\]: zero or negative; lowered by the difference fields of
    /// merged contacts.
    pub(crate) heights: Vec<f64>,
    /// Jump-in penetrations \[m\]: zero or negative, never below the end of the branch.
    ///
    /// Without adhesion they are slightly positive.
    pub(crate) jump_in: Grown<f64>,
    /// Constants of the potentials of merged contacts, 0 for the asperities of the surface \[J\].
    pub(crate) potential_offset: Grown<f64>,
    pub(crate) material: Material,
    pub(crate) rules: Rules,
    pub(crate) field: FieldSum,
    pub(crate) neighbours: Neighbours,
    pub(crate) numerics: Numerics,
    /// Side of the square L \[m\].
    pub length_m: f64,
    /// Rms height of the surface \[m\].
    pub rms_height_m: f64,
    /// Unit of the mean penetration, in which steps, tolerances and limits are given \[m\]: the rms height,
    /// or the JKR length of a probe.
    pub unit_m: f64,
    /// Springs in series with the contact.
    pub(crate) spring: Spring,
}

/// Springs in series with a contact, see [`super::spring`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Spring {
    /// Compliance of the machine \[m/N\], the part that is not a part of the mean penetration.
    pub(crate) machine_m_n: f64,
    /// True under load control.
    pub(crate) holds_load: bool,
    /// True if all contacts are solved together.
    pub(crate) moves_as_one: bool,
    /// Number of doublings by which increments may be longer.
    pub(super) doublings: u32,
    /// Addition to the unit of the output steps of D \[m\].
    pub(super) output_m: f64,
}

/// Lower limit of Wu's jump-in penetration, as a fraction of the jump-off penetration.
///
/// Wu's criterion (Eq 3) is beyond the end of the JKR branch at Tabor parameters from 0.2 to 1. An asperity
/// that formed a contact there would leave at once. At its lower bound, μ = 2, the criterion gives 0.79.
pub(super) const MAX_WU_JUMP_IN: f64 = 0.95;

impl Problem {
    /// Sets the numerical choices.
    #[must_use]
    pub fn with_numerics(self, numerics: Numerics) -> Self {
        let events = Events { local_contacts: numerics.events.local_contacts.max(1), ..numerics.events };
        Self { numerics: Numerics { events, ..numerics }, ..self }
    }

    /// Sets the unit of the mean penetration \[m\], for a surface whose rms height does not set the scale.
    #[must_use]
    pub fn with_unit(self, unit_m: f64) -> Self {
        Self { unit_m, ..self }
    }

    /// Sets the number of spots from which fast sums are used.
    ///
    /// With `usize::MAX` all sums are direct.
    /// It has no effect on a problem of few asperities, which has no fast sums.
    #[must_use]
    pub fn with_fast_sums_from(self, spots: usize) -> Self {
        Self { field: self.field.fast_from(spots), ..self }
    }

    /// Contact problem of the given summits.
    ///
    /// Asperities are numbered internally from the highest down. Positions are relative to the highest one
    /// and rounded to 2⁻⁴⁰ of the side. The results therefore do not depend on the caller's order or on the
    /// origin of the square. [`Self::number`] returns the caller's number.
    ///
    /// # Errors
    /// There must be a summit. Radii and material must be positive.
    /// With Wu's rule all Tabor parameters must be at least 2 unless allowed.
    pub fn new(
        summits: &[Summit],
        length_m: f64,
        rms_height_m: f64,
        material: Material,
        rules: Rules,
    ) -> Result<Self, PhysicsError> {
        let places = Places::new(summits, length_m, rules.boundary)?;
        let highest = summits[places.numbers[0]].height_m;
        let summits: Vec<Summit> = places.numbers.iter().map(|i| summits[*i]).collect();
        let of = |s: &Summit| Asperity::as_printed(s.radius_m(), &material, rules.slips);
        let asperities: Vec<Asperity> = summits.iter().map(of).collect::<Result<_, _>>()?;
        let range = material.interaction_range_m;
        let tabor: Vec<f64> = asperities.iter().map(|a| a.tabor(range)).collect();
        let below = tabor.iter().filter(|mu| **mu < MIN_TABOR).count();
        let adhesive = material.work_of_adhesion_j_m2 > 0.0;
        if adhesive && rules.jump_in == JumpIn::Wu && below > 0 && !rules.allow_low_tabor {
            let smallest = tabor.iter().copied().fold(f64::INFINITY, f64::min);
            return Err(PhysicsError::LowTabor { smallest, below, all: tabor.len() });
        }
        let jump_in: Vec<f64> = asperities
            .iter()
            .map(|a| match rules.jump_in {
                // Without adhesion there is no jump: contact begins above the penetration at which it ends,
                // beyond rounding.
                _ if !adhesive => 4.0 * a.jump_off_penetration(),
                JumpIn::Jkr => 0.0,
                JumpIn::Wu => {
                    a.wu_jump_in_penetration(range).min(0.0).max(MAX_WU_JUMP_IN * a.jump_off_penetration())
                }
            })
            .collect();
        let positions: Vec<[f64; 2]> = summits.iter().map(|s| places.inward([s.x_m, s.y_m])).collect();
        let field =
            choose(positions.clone(), length_m, &material, rules.interaction, rules.boundary, rules.slips);
        Ok(Self {
            heights: summits.iter().map(|s| s.height_m - highest).collect(),
            potential_offset: vec![0.0; jump_in.len()].into(),
            jump_in: jump_in.into(),
            field: if rules.coalescence == Coalescence::Merge { field } else { field.with_table() },
            neighbours: Neighbours::new(positions, length_m, rules.boundary),
            numerics: Numerics::default(),
            places: Arc::new(places),
            asperities: asperities.into(),
            material,
            rules,
            length_m,
            rms_height_m,
            unit_m: rms_height_m,
            spring: Spring::default(),
        })
    }

    /// True if there is no adhesion: the contact is elastic and has no hysteresis.
    #[must_use]
    pub fn is_adhesionless(&self) -> bool {
        self.material.work_of_adhesion_j_m2 == 0.0
    }

    /// True if local problems contain all asperities of the surface.
    pub(crate) fn solves_whole(&self) -> bool {
        self.numerics.events.local_contacts >= self.summits()
    }

    /// Mean penetration beyond which the load is not looked for \[m\]: 100 units, below the lowest asperity
    /// of a probe.
    pub(crate) fn farthest_m(&self) -> f64 {
        let lowest = if self.unit_m == self.rms_height_m {
            0.0
        } else {
            self.heights[..self.summits()].iter().copied().fold(0.0, f64::min)
        };
        100.0 * self.unit_m - lowest
    }

    /// Residual below which a state is an equilibrium \[m\]: `1e-8` units, the error of fast sums, or
    /// `1e-10` units with fewer than 300 asperities or without interaction, where sums are direct.
    #[must_use]
    pub fn tolerance_m(&self) -> f64 {
        self.field.precision() * self.unit_m
    }

    /// Mean penetration at which the first asperity jumps into contact \[m\]: below zero with Wu's rule.
    #[must_use]
    pub fn first_contact_m(&self) -> f64 {
        self.jump_in.iter().zip(self.heights.iter()).map(|(jump, z)| jump - z).fold(f64::INFINITY, f64::min)
    }

    /// Number of asperities, including merged spots.
    #[must_use]
    pub fn len(&self) -> usize {
        self.heights.len()
    }

    /// True if there are no asperities; [`Self::new`] refuses this.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.heights.is_empty()
    }

    /// The caller's number of an asperity.
    ///
    /// Merged spots have the same number internally and externally.
    #[must_use]
    pub fn number(&self, i: usize) -> usize {
        self.places.numbers.get(i).copied().unwrap_or(i)
    }

    /// Tabor parameters of the asperities, from the highest down.
    #[must_use]
    pub fn tabor(&self) -> Vec<f64> {
        self.asperities.iter().map(|asperity| asperity.tabor(self.material.interaction_range_m)).collect()
    }

    /// Number of asperities of the surface; merged contacts have higher numbers.
    pub(crate) fn summits(&self) -> usize {
        self.places.numbers.len()
    }

    /// Unit of load, `E* A0` \[N\].
    #[must_use]
    pub fn load_unit_n(&self) -> f64 {
        self.material.contact_modulus_pa * self.length_m * self.length_m
    }

    /// Position of an asperity \[m\].
    pub(crate) fn place(&self, i: usize) -> &[f64; 2] {
        self.neighbours.place(i)
    }

    /// Distance of two asperities \[m\], of their nearest images if the square is periodic.
    pub(crate) fn distance(&self, i: usize, j: usize) -> f64 {
        self.neighbours.distance(self.place(i), self.place(j))
    }

    /// Source columns of asperities, ascending, with their contact radii \[m\].
    pub(crate) fn columns(&self, of: impl Iterator<Item = (usize, f64)> + Clone, spots: &mut Spots) {
        spots.index.clear();
        spots.index.extend(of.clone().map(|(i, _)| i));
        spots.columns.set(of.map(|(i, a)| self.spot(i, a)));
    }

    /// A contact of radius `a` \[m\] as a source.
    pub(crate) fn spot(&self, i: usize, a: f64) -> Spot {
        let asperity = &self.asperities[i];
        let [x, y] = *self.place(i);
        Spot {
            x,
            y,
            a,
            radius: asperity.radius_m(),
            load: asperity.load(a),
            load_slope: asperity.load_slope(a),
        }
    }

    /// Potential of a contact of radius `a` \[m\] on its branch, without its interaction \[J\]:
    /// `U(δ(a), a) − Δγπa²`.
    pub(crate) fn self_potential(&self, i: usize, a: f64) -> f64 {
        let asperity = &self.asperities[i];
        let adhesion = self.material.work_of_adhesion_j_m2 * PI * a * a;
        asperity.stored_energy(asperity.penetration(a), a) - adhesion + self.potential_offset[i]
    }

    /// Displacement \[m\] at distance r \[m\] from a spot of radius `a` \[m\], and its derivative to `a`.
    ///
    /// The size of a contact at the target does not enter.
    pub(crate) fn spot_field(&self, asperity: &Asperity, r: f64, a: f64) -> (f64, f64) {
        if self.rules.interaction == Kind::Point {
            let unit = 1.0 / (PI * self.material.contact_modulus_pa * r);
            return (asperity.load(a) * unit, asperity.load_slope(a) * unit);
        }
        spot_field_as_printed(r, a, asperity.radius_m(), asperity.pull_sqrt_m(), self.rules.slips)
    }
}
