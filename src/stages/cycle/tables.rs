//! Tables of a cycle, of any method: steps, contacts and events.

use super::super::StageError;
use super::super::identity::Identity;
use super::Computed;
use crate::physics::SpotStatus;
use crate::physics::cycle::{Contact, Event, Step};
use crate::schema;
use crate::store::Frame;
use std::iter::repeat_n;

/// A cycle whose tables are made.
#[derive(Clone, Copy)]
pub(super) struct Tables<'a> {
    pub(super) of: Identity<'a>,
    pub(super) computed: &'a Computed,
    /// Loads `F/(E* A0)` at the load reversals.
    pub(super) max_loads: &'a [f64],
}

impl<'a> Tables<'a> {
    fn step(self, at: usize) -> &'a Step {
        &self.computed.cycle.steps[at]
    }

    fn method(self, rows: usize) -> impl Iterator<Item = &'static str> {
        repeat_n(self.computed.method, rows)
    }

    pub(super) fn steps(self) -> Result<Frame, StageError> {
        let cycle = &self.computed.cycle;
        let steps = &cycle.steps;
        let (load_unit_n, area_unit_m2, rms_height_m) =
            (self.computed.load_unit_n, self.computed.area_m2, self.computed.rms_height_m);
        let each = |value: fn(&Step) -> f64| steps.iter().map(value);
        let some = |value: fn(&Step) -> Option<f64>| steps.iter().map(value);
        let count = |value: fn(&Step) -> usize| steps.iter().map(value);
        let effort = |value: fn(&Step) -> u64| steps.iter().map(move |step| value(step) as usize);
        let mut reversals = vec![None; steps.len()];
        for ((step, ()), load) in cycle.turning.iter().zip(self.max_loads) {
            reversals[*step] = Some(*load);
        }
        let stiffness_unit_n_m = load_unit_n / rms_height_m;
        Ok(self
            .of
            .begin(&schema::STEPS, steps.len())
            .i64("step", (0..steps.len()).map(|k| k as i64))
            .text("branch", steps.iter().map(|s| s.branch.word()))
            .f64("max_load", some(|s| s.max_load))
            .f64("approach_m", each(|s| s.mean_penetration_m))
            .f64("load_n", each(|s| s.load_n))
            .f64("least_load_n", each(|s| s.least_load_n))
            .f64("area_m2", each(|s| s.area_m2))
            .f64("area_union_m2", each(|s| s.area_union_m2))
            .count("contact_count", count(|s| s.counts.contacts))
            .count("covered_count", count(|s| s.counts.covered))
            .counts(steps.iter().map(|s| s.counts.events))
            .count("held_count", count(|s| s.counts.held))
            .count("touching_count", count(|s| s.counts.touching))
            .f64("dissipated_j", each(|s| s.dissipated_j))
            .f64("work_j", each(|s| s.work_j))
            .f64("residual_m", some(|s| s.numerics.residual_m))
            .f64("drift_m", some(|s| s.numerics.drift_m))
            .f64("stability", some(|s| s.numerics.stability))
            .bool("converged", steps.iter().map(|s| s.numerics.is_converged))
            .count("iteration_count", effort(|s| s.numerics.effort.iterations))
            .count("pair_evaluation_count", effort(|s| s.numerics.effort.pairs))
            .count("product_count", effort(|s| s.numerics.effort.products))
            .count("transform_count", effort(|s| s.numerics.effort.transforms))
            .f64("load", steps.iter().map(|s| s.load_n / load_unit_n))
            .f64("area", steps.iter().map(|s| s.area_m2 / area_unit_m2))
            .f64("penetration", steps.iter().map(|s| s.mean_penetration_m / rms_height_m))
            .text("method", self.method(steps.len()))
            .f64("residual", some(|s| s.numerics.relative_residual))
            .f64("stiffness_n_m", some(|s| s.numerics.stiffness_n_m))
            .f64(
                "stiffness",
                steps
                    .iter()
                    .map(|s| s.numerics.stiffness_n_m.map(|stiffness| stiffness / stiffness_unit_n_m)),
            )
            .f64("reversal_load", reversals)
            .f64("machine_displacement_m", some(|s| s.machine_displacement_m))
            .build()?)
    }

    pub(super) fn contacts(self) -> Result<Frame, StageError> {
        let spots = &self.computed.cycle.contacts;
        let each = |value: fn(&Contact) -> Option<f64>| spots.iter().map(value);
        let centre = |axis: usize| spots.iter().map(move |s| s.centroid_m.map(|centre| centre[axis]));
        Ok(self
            .of
            .begin(&schema::CONTACTS, spots.len())
            .i64("step", spots.iter().map(|s| s.step as i64))
            .text("branch", spots.iter().map(|s| self.step(s.step).branch.word()))
            .f64("max_load", spots.iter().map(|s| self.step(s.step).max_load))
            .i64("asperity_id", spots.iter().map(|s| s.asperity.map(|asperity| asperity as i64)))
            .text(
                "state",
                spots
                    .iter()
                    .map(|s| if s.covered { SpotStatus::Covered } else { SpotStatus::Contact }.word()),
            )
            .f64("contact_radius_m", spots.iter().map(|s| s.contact_radius_m))
            .f64("load_n", spots.iter().map(|s| s.load_n))
            .f64("penetration_m", each(|s| s.penetration_m))
            .f64("interaction_m", each(|s| s.interaction_m))
            .text("method", self.method(spots.len()))
            .f64("centroid_x_m", centre(0))
            .f64("centroid_y_m", centre(1))
            .f64("area_m2", each(|s| s.region.map(|region| region.area_m2)))
            .f64("perimeter_m", each(|s| s.region.map(|region| region.perimeter_m)))
            .i64("summit_count", spots.iter().map(|s| s.region.map(|region| i64::from(region.summits))))
            .build()?)
    }

    pub(super) fn events(self) -> Result<Frame, StageError> {
        let events = &self.computed.cycle.events;
        let each = |value: fn(&Event) -> f64| events.iter().map(value);
        Ok(self
            .of
            .begin(&schema::EVENTS, events.len())
            .i64("step", events.iter().map(|e| e.step as i64))
            .text("branch", events.iter().map(|e| self.step(e.step).branch.word()))
            .f64("max_load", events.iter().map(|e| self.step(e.step).max_load))
            .text("kind", events.iter().map(|e| e.word()))
            .i64("asperity_id", events.iter().map(|e| e.asperity().map(|asperity| asperity as i64)))
            .f64("approach_m", each(|e| e.mean_penetration_m))
            .i64("avalanche_id", self.avalanches())
            .f64("load_before_n", each(|e| e.before.load_n))
            .f64("load_after_n", each(|e| e.after.load_n))
            .f64("area_before_m2", each(|e| e.before.area_m2))
            .f64("area_after_m2", each(|e| e.after.area_m2))
            .f64("energy_lost_j", each(|e| e.energy_lost_j))
            .text("method", self.method(events.len()))
            .text_or_null("status", events.iter().map(|e| e.status.map(SpotStatus::word)))
            .text("cause", events.iter().map(|e| e.cause_word()))
            .build()?)
    }

    /// Numbers of the avalanches along the whole path; those of the events are counted along each branch.
    fn avalanches(self) -> Vec<i64> {
        let mut number: i64 = -1;
        let mut last = None;
        let number_of = |event: &Event| {
            let step = self.step(event.step);
            let identity = (step.branch, step.max_load.map(f64::to_bits), event.avalanche);
            if last.replace(identity) != Some(identity) {
                number += 1;
            }
            number
        };
        self.computed.cycle.events.iter().map(number_of).collect()
    }
}
