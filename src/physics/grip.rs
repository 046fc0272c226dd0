//! What it takes that spots change one another's grip ([`super::interaction::Mutual`]): on their traces, and around a neighbourhood.

use super::interaction::Effort;
use super::jkr::Asperity;
use super::patch::{Patch, Place, STEEPEST, Trace};
use super::state::Problem;

impl Trace {
    /// The rate without what the grip does to it, of a spot of radius `a` \[m\].
    pub(crate) fn rate_by_radius(&self, asperity: &Asperity, a: f64) -> f64 {
        self.rate - asperity.penetration_by_grip(a) * self.grip_rate
    }

    /// The grip expected there; no faster than the penetration goes on.
    pub(crate) fn grip_ahead(&self, approach: f64) -> f64 {
        if self.grip_rate == 0.0 {
            return self.grip;
        }
        let share = (STEEPEST / self.rate.abs()).min(1.0);
        (self.grip + share * self.grip_rate * (approach - self.at)).clamp(0.5 * self.grip, 2.0 * self.grip)
    }

    /// The radius expected there \[m\].
    pub(crate) fn radius_ahead(&self, asperity: &Asperity, approach: f64) -> f64 {
        asperity.gripping(self.grip_ahead(approach)).radius_ahead(self.ahead(approach))
    }
}

impl Place {
    /// What the loads outside do to a spot of radius `a` \[m\] as to a punch goes with its area, `¼ a² S/a`, S of [`super::interaction::Mutual`] \[m\].
    pub(crate) fn yielding(&self, a: f64) -> f64 {
        0.25 * self.outer * a * a
    }

    /// The part of the potential that has it from there, `∫½ F_H S da` \[J\].
    pub(crate) fn yielding_energy(&self, problem: &Problem, a: f64) -> f64 {
        2.0 / 15.0 * problem.material.contact_modulus_pa * self.outer * a.powi(5) / problem.asperities[self.asperity].radius_m()
    }
}

impl Patch {
    /// Where spots change one another's grip, those outside do from here on what makes the grips of the members these.
    pub(crate) fn hold_grips(&mut self, problem: &Problem, grips: &[f64], effort: &mut Effort) {
        let Some(mutual) = self.spots.mutual.clone() else { return };
        let spots = self.members.iter().zip(&self.radius).zip(grips);
        let loads: Vec<f64> = spots.map(|((m, a), grip)| problem.asperities[m.asperity].gripping(*grip).load(*a)).collect();
        for (k, (member, grip)) in self.members.iter_mut().zip(grips).enumerate() {
            member.outer = mutual.outer(k, *grip, &loads);
        }
        self.evaluate(problem, effort);
    }

    /// A member's asperity, with the grip that it was evaluated with last.
    pub(crate) fn asperity(&self, problem: &Problem, k: usize) -> Asperity {
        problem.asperities[self.members[k].asperity].gripping(self.grip_of(k))
    }

    /// That grip.
    pub(crate) fn grip_of(&self, k: usize) -> f64 {
        self.grip.get(k).copied().unwrap_or(1.0)
    }

    /// How the grips of the members change as their radii do; nothing where they are all 1.
    pub(crate) fn grip_rates(&self, rates: &[f64]) -> Vec<f64> {
        self.spots.mutual.as_ref().map_or(Vec::new(), |mutual| mutual.grip_rates(rates))
    }
}
