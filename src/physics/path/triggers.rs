//! Conditions under which a change of state is due.

use super::predictor::Predictor;
use crate::physics::contact::problem::Problem;
use crate::physics::contact::state::Status;
use crate::physics::contact::transition::{Kind, Transition};

/// Transition that is due, with its overshoot: dimensionless, 0 at the event and positive beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Trigger {
    pub(crate) transition: Transition,
    pub(crate) overshoot: f64,
}

impl Problem {
    /// All transitions that are due among contacts and absorbed asperities (`touched`) and free asperities (`free`), whose penetrations are
    /// known at the present mean penetration.
    pub(crate) fn triggers(&self, predictor: &Predictor, touched: &[usize], free: &[usize]) -> Vec<Trigger> {
        let mut due = Vec::new();
        let mut add = |change: Transition| {
            let overshoot = self.overshoot(&change, predictor);
            if overshoot >= 0.0 {
                due.push(Trigger { transition: change, overshoot });
            }
        };
        let state = &predictor.state;
        let mut inside = Vec::new();
        for &j in touched {
            for i in predictor.covered_by(j) {
                add(Transition { kind: Kind::Uncover, asperity: i, by: Some(j) });
            }
            if state.status[j] != Status::Contact {
                continue;
            }
            add(Transition { kind: Kind::JumpOff, asperity: j, by: None });
            if self.merges() {
                add(Transition { kind: Kind::Split, asperity: j, by: None });
                predictor.pairs(self, j, state.radius[j], |i, r| {
                    if r <= state.radius[i] + state.radius[j] {
                        add(predictor.merging(i, j));
                    }
                });
            }
            if self.covers() {
                self.neighbours.within(j, state.radius[j], |_, i| {
                    if self.can_be_covered(state, i) && state.radius[i] < state.radius[j] {
                        inside.push(i);
                        add(Transition { kind: Kind::Cover, asperity: i, by: Some(j) });
                    }
                });
            }
        }
        for &i in free {
            if state.status[i] == Status::Free && !state.barred[i] && !inside.contains(&i) {
                add(Transition { kind: Kind::JumpIn, asperity: i, by: None });
            }
        }
        due
    }

    /// True if a transition that was due still is.
    pub(crate) fn is_due(&self, change: &Transition, predictor: &Predictor) -> bool {
        let (i, state) = (change.asperity, &predictor.state);
        let possible = match (change.kind, state.status[i], change.by) {
            (Kind::JumpIn, Status::Free, _) => !state.barred[i],
            (Kind::JumpOff, Status::Contact, _) => true,
            (Kind::Uncover, Status::Covered { by, .. }, _) => Some(by) == change.by,
            (Kind::Cover, Status::Free | Status::Contact, Some(by)) => state.radius[i] < state.radius[by],
            (Kind::Merge, _, Some(by)) => predictor.may_merge(i, by),
            (Kind::Split, Status::Contact, _) => true,
            _ => false,
        };
        possible && self.overshoot(change, predictor) >= 0.0
    }

    /// Overshoot of a state beyond a transition; negative before it.
    pub(crate) fn overshoot(&self, change: &Transition, predictor: &Predictor) -> f64 {
        let (i, state) = (change.asperity, &predictor.state);
        match (change.kind, change.by) {
            (Kind::JumpOff, _) => 1.0 - state.radius[i] / self.asperities[i].jump_off_radius(),
            (Kind::JumpIn, _) => (predictor.traces[i].value - self.jump_in[i]) / self.asperities[i].jump_off_penetration().abs(),
            (Kind::Cover, Some(by)) => {
                let distance = self.distance(i, by);
                state.radius[by] / distance - 1.0
            }
            (Kind::Merge, Some(by)) => self.meeting([i, by], [state.radius[i], state.radius[by]]),
            (Kind::Split, _) => state.release_of_merged(self, i).map_or(f64::NAN, |release_m| 1.0 - state.radius[i] / release_m),
            (Kind::Uncover, _) => match state.status[i] {
                // The footprint of a part of a merged contact stays covered until it splits.
                Status::Covered { by, .. } if matches!(state.status[by], Status::Merged { .. }) => f64::NAN,
                // An asperity that is not in contact absorbs none.
                Status::Covered { by, release_m } => 1.0 - state.radius[by] / release_m,
                _ => f64::NAN,
            },
            _ => f64::NAN,
        }
    }

    /// Lateness of a transition, as a penetration \[m\].
    pub(crate) fn lateness(&self, trigger: &Trigger, predictor: &Predictor) -> f64 {
        let (i, state) = (trigger.transition.asperity, &predictor.state);
        let between = |j: usize, radius: f64| {
            let asperity = &self.asperities[j];
            (asperity.penetration(state.radius[j]) - asperity.penetration(radius)).abs()
        };
        match (trigger.transition.kind, trigger.transition.by, state.status[i]) {
            (Kind::JumpOff, ..) => between(i, self.asperities[i].jump_off_radius()),
            (Kind::Cover, Some(by), _) => between(by, self.distance(i, by)),
            (Kind::Uncover, _, Status::Covered { by, release_m }) if state.radius[by] > 0.0 => between(by, release_m),
            (Kind::JumpIn, ..) => trigger.overshoot * self.asperities[i].jump_off_penetration().abs(),
            (Kind::Merge, Some(by), _) => between(by, state.radius[by] * (1.0 - trigger.overshoot)),
            (Kind::Split, ..) => between(i, state.radius[i] / (1.0 - trigger.overshoot)),
            _ => 0.0,
        }
    }
}
