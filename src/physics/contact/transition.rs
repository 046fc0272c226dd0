//! Changes of state: what triggers them, and how they are applied.
//!
//! An asperity jumps in where its penetration reaches its jump-in distance; it jumps off where its own branch ends; it is covered where
//! a greater spot reaches its centre, and uncovered where that spot has withdrawn from it.
//!
//! Covering takes a load away, so it moves the covering spot: if the load was tensile, the spot shrinks and would release the asperity at
//! once, which would draw the spot out again, for ever. So the radius that the spot has after covering is the one below which it
//! releases; and where uncovering would only end in being covered again, or in the two changing parts, it is not done, and tried
//! again when the spot has shrunk by another 3 %. Neither depends on the step of the approach.

use super::problem::Problem;
use super::state::{State, Status};
use crate::model::Coalescence;
use serde::{Deserialize, Serialize};

/// A kind of event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Kind {
    /// A free asperity jumps into contact.
    JumpIn,
    /// A spot's branch ends, and it leaves.
    JumpOff,
    /// A greater spot reaches an asperity's centre.
    Cover,
    /// The covering spot has withdrawn.
    Uncover,
    /// The coupled state has a fold, and moves to another equilibrium with the same spots.
    Snap,
    /// Two spots that touch become one.
    Merge,
    /// They part again.
    Split,
}

impl Kind {
    /// Every kind, in the order in which they are counted.
    pub const ALL: [Self; 7] = [Self::JumpIn, Self::JumpOff, Self::Cover, Self::Uncover, Self::Snap, Self::Merge, Self::Split];

    /// The word in the tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::JumpIn => "jump_in",
            Self::JumpOff => "jump_off",
            Self::Cover => "cover",
            Self::Uncover => "uncover",
            Self::Snap => "snap",
            Self::Merge => "merge",
            Self::Split => "split",
        }
    }
}

/// A change of one asperity's state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Transition {
    pub(crate) kind: Kind,
    pub(crate) asperity: usize,
    /// The covering asperity.
    pub(crate) by: Option<usize>,
}

impl Transition {
    /// True if this would undo one of the changes that have `moved` in the same avalanche.
    pub(crate) fn returns(&self, moved: &[Self], state: &State) -> bool {
        let i = self.asperity;
        moved.iter().any(|earlier| match (self.kind, earlier.kind) {
            (Kind::JumpIn, Kind::JumpOff | Kind::Uncover) => earlier.asperity == i,
            (Kind::Cover, Kind::Uncover) => earlier.asperity == i,
            // Where the covering spot has gone altogether, nothing is left to ride with.
            (Kind::Uncover, Kind::Cover) => {
                earlier.asperity == i && matches!(state.status[i], Status::Covered { by, .. } if state.radius[by] > 0.0)
            }
            _ => false,
        })
    }

    /// True if this covers an asperity that was uncovered, or covers the spot that it was uncovered from by its own.
    pub(crate) fn undoes(&self, uncovering: &Self) -> bool {
        let i = uncovering.asperity;
        self.kind == Kind::Cover && (self.asperity == i || (Some(self.asperity) == uncovering.by && self.by == Some(i)))
    }

    /// The status of an asperity that this change takes out of contact.
    pub(crate) fn status(&self, problem: &Problem) -> Status {
        match (self.kind, self.by) {
            (Kind::Cover, Some(by)) => {
                let release_m = problem.neighbours.distance(&problem.positions[self.asperity], &problem.positions[by]);
                Status::Covered { by, release_m }
            }
            _ => Status::Free,
        }
    }
}

/// A spot as a relaxation has it: its asperity, its radius \[m\] and its residual \[m\].
pub(crate) type ContactView = (usize, f64, f64);

impl Problem {
    /// True if spots cover asperities.
    pub(crate) fn covers(&self) -> bool {
        self.rules.coalescence != Coalescence::None
    }

    /// True if an asperity is there to be covered: it is not yet, nor a part of a merged spot, nor one that has parted.
    pub(crate) fn can_be_covered(&self, state: &State, i: usize) -> bool {
        match state.status[i] {
            Status::Contact => true,
            Status::Free => i < self.summits,
            Status::Covered { .. } | Status::Merged { .. } => false,
        }
    }

    /// Largest spot over the centre of asperity `i` other than `but`, with its distance.
    pub(crate) fn covering(&self, state: &State, i: usize, but: Option<usize>) -> Option<(usize, f64)> {
        state
            .contacts
            .iter()
            .filter(|j| **j != i && Some(**j) != but)
            .map(|&j| (j, self.neighbours.distance(&self.positions[i], &self.positions[j])))
            .filter(|(j, r)| state.radius[*j] >= *r)
            .max_by(|(j, _), (k, _)| state.radius[*j].total_cmp(&state.radius[*k]).then(k.cmp(j)))
    }

    /// Who leaves or is covered at this point of a relaxation of `spots` (ascending): the spot furthest below the end of its branch and
    /// still shrinking, else the spot furthest under a greater one.
    pub(crate) fn overtaken(&self, spots: &[ContactView]) -> Option<Transition> {
        let mut found: Option<(f64, Transition)> = None;
        for &(i, a, residual) in spots {
            let overshoot = self.asperities[i].jump_off_radius() / a;
            if residual < 0.0 && overshoot > 1.0 && found.is_none_or(|(most, _)| overshoot > most) {
                found = Some((overshoot, Transition { kind: Kind::JumpOff, asperity: i, by: None }));
            }
        }
        if found.is_none() && self.covers() {
            for &(j, a, _) in spots {
                self.neighbours.within(j, a, |r, i| {
                    let smaller = spots.binary_search_by_key(&i, |spot| spot.0).is_ok_and(|k| spots[k].1 < a);
                    if smaller && found.is_none_or(|(most, _)| a / r > most) {
                        found = Some((a / r, Transition { kind: Kind::Cover, asperity: i, by: Some(j) }));
                    }
                });
            }
        }
        found.map(|(_, change)| change)
    }

    /// Where a relaxation finds no rest because a spot is at the edge of a greater one, and the field jumps in slope there: the smaller of the two
    /// is covered. `restless` is the asperity with the worst residual.
    pub(crate) fn at_edge(&self, spots: &[ContactView], restless: usize) -> Option<Transition> {
        let mut found: Option<(f64, Transition)> = None;
        let mut offer = |i: usize, j: usize, a: f64, r: f64| {
            let off = (a / r - 1.0).abs();
            if off < EDGE && found.is_none_or(|(least, _)| off < least) {
                found = Some((off, Transition { kind: Kind::Cover, asperity: i, by: Some(j) }));
            }
        };
        if !self.covers() {
            return None;
        }
        let radius = |i: usize| spots.binary_search_by_key(&i, |spot| spot.0).ok().map(|k| spots[k].1);
        let mine = radius(restless)?;
        let greatest = spots.iter().map(|spot| spot.1).fold(0.0, f64::max);
        self.neighbours.within(restless, 1.1 * greatest, |r, other| match radius(other) {
            Some(a) if a > mine => offer(restless, other, a, r),
            Some(a) if a < mine => offer(other, restless, mine, r),
            _ => {}
        });
        found.map(|(_, change)| change)
    }
}

/// How near the edge of a spot counts as at it, of the distance.
const EDGE: f64 = 0.02;
