//! Changes of state that are due.

use super::conditions::Condition;
use super::predictor::Predictor;
use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::state::Status;
use crate::asperities::contact::transition::{Transition, absorbed_within};

/// Transition that is due, with its overshoot: dimensionless, 0 at the event and positive beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Trigger {
    pub(crate) transition: Transition,
    pub(crate) overshoot: f64,
}

impl Problem {
    /// Transitions that are due among contacts and absorbed asperities
    /// (`touched`) and free asperities (`free`), whose penetrations are known at the present mean
    /// penetration; but for merging and splitting.
    pub(crate) fn triggers(&self, predictor: &Predictor, touched: &[usize], free: &[usize]) -> Vec<Trigger> {
        let mut due = Vec::new();
        let mut add = |transition: Transition| due.extend(self.trigger(transition, predictor));
        let state = &predictor.state;
        let mut inside = Vec::new();
        for &j in touched {
            for i in predictor.covered_by(j) {
                add(Transition::uncover(i, j));
            }
            if state.status[j] != Status::Contact {
                continue;
            }
            add(Transition::jump_off(j));
            if self.covers() {
                self.neighbours.within(j, absorbed_within(state.radius[j]), |_, i| {
                    if self.can_be_covered(state, i) && state.radius[i] < state.radius[j] {
                        inside.push(i);
                        add(Transition::cover(i, j));
                    }
                });
            }
        }
        for &i in free {
            if state.status[i] == Status::Free && !state.barred[i] && !inside.contains(&i) {
                add(Transition::jump_in(i));
            }
        }
        due
    }

    /// Merging and splitting that are due among contacts (`touched`).
    pub(crate) fn coalescing(&self, predictor: &Predictor, touched: &[usize]) -> Vec<Trigger> {
        let state = &predictor.state;
        let mut due = Vec::new();
        if !self.merges() {
            return due;
        }
        let mut add = |transition: Transition| due.extend(self.trigger(transition, predictor));
        for &j in touched.iter().filter(|j| state.status[**j] == Status::Contact) {
            add(Transition::split(j));
            predictor.pairs(self, j, state.radius[j], |i, r| {
                if r <= state.radius[i] + state.radius[j] {
                    add(predictor.merging(i, j));
                }
            });
        }
        due
    }

    /// True if a transition that was due still is.
    pub(crate) fn is_due(&self, change: &Transition, predictor: &Predictor) -> bool {
        predictor.permits(change)
            && self.overshoot(change, predictor).is_some_and(|overshoot| overshoot >= 0.0)
    }

    /// A transition with its overshoot, if it is due.
    fn trigger(&self, transition: Transition, predictor: &Predictor) -> Option<Trigger> {
        let overshoot = self.overshoot(&transition, predictor)?;
        (overshoot >= 0.0).then_some(Trigger { transition, overshoot })
    }

    /// Overshoot of a state beyond a transition; negative before it, none if it is not possible or the
    /// penetration is unknown.
    fn overshoot(&self, change: &Transition, predictor: &Predictor) -> Option<f64> {
        let state = &predictor.state;
        Some(match self.condition(change, state)? {
            Condition::Penetration { asperity, value_m } => {
                (predictor.traces[asperity].penetration()? - value_m)
                    / self.asperities[asperity].jump_off_penetration().abs()
            }
            Condition::Shrinking { contact, value_m } => 1.0 - state.radius[contact] / value_m,
            Condition::Growing { contact, value_m } => state.radius[contact] / value_m - 1.0,
            Condition::Touching { pair } => self.meeting(pair, pair.map(|i| state.radius[i])),
        })
    }

    /// Lateness of a transition, as a penetration \[m\].
    pub(crate) fn lateness(&self, trigger: &Trigger, predictor: &Predictor) -> f64 {
        let state = &predictor.state;
        let between = |j: usize, radius: f64| {
            let asperity = &self.asperities[j];
            (asperity.penetration(state.radius[j]) - asperity.penetration(radius)).abs()
        };
        match self.condition(&trigger.transition, state) {
            Some(Condition::Penetration { asperity, .. }) => {
                trigger.overshoot * self.asperities[asperity].jump_off_penetration().abs()
            }
            Some(Condition::Shrinking { contact, value_m } | Condition::Growing { contact, value_m })
                if state.radius[contact] > 0.0 =>
            {
                between(contact, value_m)
            }
            Some(Condition::Touching { pair: [_, by] }) => {
                between(by, state.radius[by] * (1.0 - trigger.overshoot))
            }
            Some(Condition::Shrinking { .. } | Condition::Growing { .. }) | None => 0.0,
        }
    }
}
