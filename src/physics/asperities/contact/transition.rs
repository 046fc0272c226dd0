//! Transitions of asperities: their kinds, the resulting status, and transitions during a relaxation.
//!
//! An asperity jumps into contact when its penetration reaches its jump-in penetration, and out of contact at
//! the end of its branch. It is absorbed when a larger spot reaches its centre, to [`ABSORPTION_DISTANCE`],
//! and released when that spot has withdrawn from it.
//!
//! Absorption removes a load and so moves the absorbing spot. If the load was tensile, the spot shrinks and
//! would release the asperity at once, which would enlarge the spot again, in an endless cycle. Therefore the
//! release radius is lowered to the radius of the spot after absorption, if that is smaller. A release that
//! would only lead to absorption again, or to an exchange of roles, is not applied. It is tried again after
//! the spot has shrunk by another 3 %. Neither rule depends on the step of mean penetration.

use super::problem::Problem;
use super::state::{State, Status};
use crate::event_kind::{EventKind, SpotStatus};
use crate::model::Coalescence;

/// Distance from the edge of a contact, over its radius, at which it absorbs an asperity.
///
/// The slope of its field is infinite at its edge. Nearer to it, Newton's method mostly does not find the
/// equilibrium of all contacts.
pub(super) const ABSORPTION_DISTANCE: f64 = 1e-4;

/// Radius \[m\] at which a contact absorbs an asperity at a distance \[m\].
pub(crate) fn absorbing_radius(distance: f64) -> f64 {
    distance / (1.0 + ABSORPTION_DISTANCE)
}

/// Distance \[m\] up to which a contact of a radius \[m\] absorbs asperities.
pub(crate) fn absorbed_within(radius: f64) -> f64 {
    radius * (1.0 + ABSORPTION_DISTANCE)
}

/// Change of one asperity's status.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Transition {
    pub(crate) kind: EventKind,
    pub(crate) asperity: usize,
    /// The absorbing asperity; the other contact of a pair that is to merge.
    pub(crate) by: Option<usize>,
}

impl Transition {
    /// A jump into contact.
    pub(crate) fn jump_in(asperity: usize) -> Self {
        Self { kind: EventKind::JumpIn, asperity, by: None }
    }

    /// A jump out of contact, at the end of a branch.
    pub(crate) fn jump_off(asperity: usize) -> Self {
        Self { kind: EventKind::JumpOff, asperity, by: None }
    }

    /// Absorption by another contact.
    pub(crate) fn cover(asperity: usize, by: usize) -> Self {
        Self { kind: EventKind::Cover, asperity, by: Some(by) }
    }

    /// Release by the absorbing contact.
    pub(crate) fn uncover(asperity: usize, by: usize) -> Self {
        Self { kind: EventKind::Uncover, asperity, by: Some(by) }
    }

    /// Snap-through.
    pub(crate) fn snap(asperity: usize) -> Self {
        Self { kind: EventKind::Snap, asperity, by: None }
    }

    /// Merging of a pair that is to become one contact.
    pub(crate) fn merge(asperity: usize, by: usize) -> Self {
        Self { kind: EventKind::Merge, asperity, by: Some(by) }
    }

    /// Merging that has created a contact.
    pub(crate) fn merged(asperity: usize) -> Self {
        Self { kind: EventKind::Merge, asperity, by: None }
    }

    /// Splitting of a merged contact.
    pub(crate) fn split(asperity: usize) -> Self {
        Self { kind: EventKind::Split, asperity, by: None }
    }

    /// True for a jump out of contact.
    pub(crate) fn ends_contact(&self) -> bool {
        self.kind == EventKind::JumpOff
    }

    /// True for a snap-through.
    pub(crate) fn keeps_contacts(&self) -> bool {
        self.kind == EventKind::Snap
    }

    /// True for merging.
    pub(crate) fn merges(&self) -> bool {
        self.kind == EventKind::Merge
    }

    /// Asperities whose numbers of changes limit it: both of a pair, none of a contact that ends.
    pub(crate) fn limited_by(&self) -> impl Iterator<Item = usize> {
        let other = self.by.filter(|_| self.merges());
        [Some(self.asperity), other].into_iter().flatten().filter(|_| !self.ends_contact())
    }

    /// Status of its asperity in the state after it.
    pub(crate) fn status_after(&self, state: &State) -> SpotStatus {
        if self.kind == EventKind::Split { SpotStatus::Split } else { state.status[self.asperity].into() }
    }

    /// True if this would undo one of the changes `moved` of the same avalanche.
    pub(crate) fn returns(&self, moved: &[Self], state: &State) -> bool {
        let i = self.asperity;
        moved.iter().any(|earlier| match (self.kind, earlier.kind) {
            (EventKind::JumpIn, EventKind::JumpOff | EventKind::Uncover) => earlier.asperity == i,
            (EventKind::Cover, EventKind::Uncover) | (EventKind::Split, EventKind::Merge) => {
                earlier.asperity == i
            }
            // A release is allowed if the absorbing spot itself has left contact.
            (EventKind::Uncover, EventKind::Cover) => {
                earlier.asperity == i
                    && matches!(state.status[i], Status::Covered { by, .. } if state.radius[by] > 0.0)
            }
            _ => false,
        })
    }

    /// True if this undoes a release.
    ///
    /// It absorbs the released asperity, or the formerly absorbing spot into the released one.
    pub(crate) fn undoes(&self, uncovering: &Self) -> bool {
        let i = uncovering.asperity;
        self.kind == EventKind::Cover
            && (self.asperity == i || (Some(self.asperity) == uncovering.by && self.by == Some(i)))
    }

    /// Status of an asperity that this change removes from contact.
    pub(crate) fn status(&self, problem: &Problem) -> Status {
        match self.by.filter(|_| self.kind == EventKind::Cover) {
            Some(by) => Status::Covered { by, release_m: problem.absorbing_radius(self.asperity, by) },
            None => Status::Free,
        }
    }
}

/// Spot during a relaxation: asperity, contact radius \[m\] and residual \[m\].
pub(crate) type ContactView = (usize, f64, f64);

impl Problem {
    /// True if the model includes absorption.
    pub(crate) fn covers(&self) -> bool {
        self.rules.coalescence != Coalescence::None
    }

    /// Radius \[m\] at which contact `by` absorbs asperity `i`.
    pub(crate) fn absorbing_radius(&self, i: usize, by: usize) -> f64 {
        absorbing_radius(self.distance(i, by))
    }

    /// True if an asperity can be absorbed.
    ///
    /// It must not be absorbed already, part of a merged spot, or a merged spot that has split.
    pub(crate) fn can_be_covered(&self, state: &State, i: usize) -> bool {
        match state.status[i] {
            Status::Contact => true,
            Status::Free => i < self.summits(),
            Status::Covered { .. } | Status::Merged { .. } => false,
        }
    }

    /// Largest spot over the centre of asperity `i`, other than `but`, with the radius at which it absorbs
    /// it.
    pub(crate) fn covering(&self, state: &State, i: usize, but: Option<usize>) -> Option<(usize, f64)> {
        state
            .contacts
            .iter()
            .filter(|j| **j != i && Some(**j) != but)
            .map(|&j| (j, self.absorbing_radius(i, j)))
            .filter(|(j, r)| state.radius[*j] >= *r)
            .max_by(|(j, _), (k, _)| state.radius[*j].total_cmp(&state.radius[*k]).then(k.cmp(j)))
    }

    /// Transition due during a relaxation of `spots` (ascending), if any.
    ///
    /// First the spot furthest below the end of its branch that is still shrinking, else the spot furthest
    /// inside a larger one.
    pub(crate) fn overtaken(&self, spots: &[ContactView]) -> Option<Transition> {
        let mut found: Option<(f64, Transition)> = None;
        for &(i, a, residual) in spots {
            let overshoot = self.asperities[i].jump_off_radius() / a;
            if residual < 0.0 && overshoot > 1.0 && found.is_none_or(|(most, _)| overshoot > most) {
                found = Some((overshoot, Transition::jump_off(i)));
            }
        }
        if found.is_none() && self.covers() {
            for &(j, a, _) in spots {
                self.neighbours.within(j, absorbed_within(a), |r, i| {
                    let smaller = spots.binary_search_by_key(&i, |spot| spot.0).is_ok_and(|k| spots[k].1 < a);
                    if smaller && found.is_none_or(|(most, _)| a / r > most) {
                        found = Some((a / r, Transition::cover(i, j)));
                    }
                });
            }
        }
        found.map(|(_, change)| change)
    }
}
