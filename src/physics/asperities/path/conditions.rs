//! Condition of each kind of event: what reaches which value. Whether it is due, how late it is and where it
//! is located follow from it.

use super::predictor::Predictor;
use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::state::{State, Status};
use crate::asperities::contact::transition::Transition;
use crate::event_kind::EventKind;

/// Quantity that reaches a value at an event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Condition {
    /// The penetration of an asperity out of contact, \[m\].
    Penetration { asperity: usize, value_m: f64 },
    /// The radius of a contact that shrinks, \[m\].
    Shrinking { contact: usize, value_m: f64 },
    /// The radius of a contact that grows, \[m\].
    Growing { contact: usize, value_m: f64 },
    /// Two contacts touch.
    Touching { pair: [usize; 2] },
}

impl Problem {
    /// Condition of a transition; none if the status of its asperity does not permit it.
    pub(crate) fn condition(&self, change: &Transition, state: &State) -> Option<Condition> {
        let i = change.asperity;
        match (change.kind, state.status[i], change.by) {
            (EventKind::JumpIn, Status::Free, _) => {
                Some(Condition::Penetration { asperity: i, value_m: self.jump_in[i] })
            }
            (EventKind::JumpOff, Status::Contact, _) => {
                Some(Condition::Shrinking { contact: i, value_m: self.asperities[i].jump_off_radius() })
            }
            (EventKind::Cover, Status::Free | Status::Contact, Some(by)) => {
                Some(Condition::Growing { contact: by, value_m: self.absorbing_radius(i, by) })
            }
            // The footprint of a part of a merged contact stays covered until it splits.
            (EventKind::Uncover, Status::Covered { by, .. }, _)
                if matches!(state.status[by], Status::Merged { .. }) =>
            {
                None
            }
            (EventKind::Uncover, Status::Covered { by, release_m }, _) => {
                Some(Condition::Shrinking { contact: by, value_m: release_m })
            }
            (EventKind::Merge, _, Some(by)) => Some(Condition::Touching { pair: [i, by] }),
            (EventKind::Split, Status::Contact, _) => {
                state.release_of_merged(self, i).map(|value_m| Condition::Shrinking { contact: i, value_m })
            }
            (
                EventKind::JumpIn
                | EventKind::JumpOff
                | EventKind::Cover
                | EventKind::Uncover
                | EventKind::Snap
                | EventKind::Merge
                | EventKind::Split,
                ..,
            ) => None,
        }
    }
}

impl Predictor {
    /// True if a transition that was due is still possible.
    pub(crate) fn permits(&self, change: &Transition) -> bool {
        let (i, state) = (change.asperity, &self.state);
        match (change.kind, state.status[i], change.by) {
            (EventKind::JumpIn, ..) => !state.barred[i],
            (EventKind::Uncover, Status::Covered { by, .. }, _) => Some(by) == change.by,
            (EventKind::Cover, _, Some(by)) => state.radius[i] < state.radius[by],
            (EventKind::Merge, _, Some(by)) => self.may_merge(i, by),
            (EventKind::Uncover, ..) => false,
            (
                EventKind::JumpOff | EventKind::Cover | EventKind::Snap | EventKind::Merge | EventKind::Split,
                ..,
            ) => true,
        }
    }
}
