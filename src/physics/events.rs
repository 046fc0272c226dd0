//! Changes of state: what triggers them, and how they are applied.
//!
//! An asperity jumps in where its penetration reaches its jump-in distance; it jumps off where its own branch ends; it is covered where
//! a greater spot reaches its centre, and uncovered where that spot has withdrawn from it.
//!
//! Covering takes a load away, so it moves the covering spot: if the load was tensile, the spot shrinks and would release the asperity at
//! once, which would draw the spot out again, for ever. So the radius that the spot has after covering is the one below which it
//! releases; and where uncovering would only end in being covered again, or in the two changing parts, it is not done, and tried
//! again when the spot has shrunk by another 3 %. Neither depends on the step of the approach.

use super::front::Front;
use super::state::{Problem, State, Status};
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
pub(crate) struct Change {
    pub(crate) kind: Kind,
    pub(crate) asperity: usize,
    /// The covering asperity.
    pub(crate) by: Option<usize>,
}

impl Change {
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

/// A change that is due, and by how much: a dimensionless measure that is 0 at the event and positive beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Trigger {
    pub(crate) change: Change,
    pub(crate) overshoot: f64,
}

/// A spot as a relaxation has it: its asperity, its radius \[m\] and its residual \[m\].
pub(crate) type Moving = (usize, f64, f64);

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

    /// All changes that are due among these asperities: of spots and of what they cover (`touched`), and of free ones (`free`), whose
    /// penetrations are known at the present approach.
    pub(crate) fn triggers(&self, front: &Front, touched: &[usize], free: &[usize]) -> Vec<Trigger> {
        let mut due = Vec::new();
        let mut add = |change: Change| {
            let overshoot = self.overshoot(&change, front);
            if overshoot >= 0.0 {
                due.push(Trigger { change, overshoot });
            }
        };
        let state = &front.state;
        let mut inside = Vec::new();
        for &j in touched {
            for i in front.riders(j) {
                add(Change { kind: Kind::Uncover, asperity: i, by: Some(j) });
            }
            if state.status[j] != Status::Contact {
                continue;
            }
            add(Change { kind: Kind::JumpOff, asperity: j, by: None });
            if self.covers() {
                self.neighbours.within(j, state.radius[j], |_, i| {
                    if self.can_be_covered(state, i) && state.radius[i] < state.radius[j] {
                        inside.push(i);
                        add(Change { kind: Kind::Cover, asperity: i, by: Some(j) });
                    }
                });
            }
        }
        for &i in free {
            if state.status[i] == Status::Free && !state.barred[i] && !inside.contains(&i) {
                add(Change { kind: Kind::JumpIn, asperity: i, by: None });
            }
        }
        due
    }

    /// True if a change that was due still is.
    pub(crate) fn is_due(&self, change: &Change, front: &Front) -> bool {
        let (i, state) = (change.asperity, &front.state);
        let possible = match (change.kind, state.status[i], change.by) {
            (Kind::JumpIn, Status::Free, _) => !state.barred[i],
            (Kind::JumpOff, Status::Contact, _) => true,
            (Kind::Uncover, Status::Covered { by, .. }, _) => Some(by) == change.by,
            (Kind::Cover, Status::Free | Status::Contact, Some(by)) => state.radius[i] < state.radius[by],
            _ => false,
        };
        possible && self.overshoot(change, front) >= 0.0
    }

    /// How far a state is beyond a change: negative before it.
    pub(crate) fn overshoot(&self, change: &Change, front: &Front) -> f64 {
        let (i, state) = (change.asperity, &front.state);
        match (change.kind, change.by) {
            (Kind::JumpOff, _) => 1.0 - state.radius[i] / self.asperities[i].jump_off_radius(),
            (Kind::JumpIn, _) => (front.traces[i].value - self.jump_in[i]) / self.asperities[i].jump_off_penetration().abs(),
            (Kind::Cover, Some(by)) => {
                let distance = self.neighbours.distance(&self.positions[i], &self.positions[by]);
                state.radius[by] / distance - 1.0
            }
            (Kind::Uncover, _) => match state.status[i] {
                // A covering asperity that is itself no spot any more covers nothing.
                Status::Covered { by, release_m } => 1.0 - state.radius[by] / release_m,
                _ => f64::NAN,
            },
            _ => f64::NAN,
        }
    }

    /// How late a change is, as a penetration \[m\].
    pub(crate) fn lateness(&self, trigger: &Trigger, front: &Front) -> f64 {
        let (i, state) = (trigger.change.asperity, &front.state);
        let between = |j: usize, radius: f64| {
            let asperity = &self.asperities[j];
            (asperity.penetration(state.radius[j]) - asperity.penetration(radius)).abs()
        };
        match (trigger.change.kind, trigger.change.by, state.status[i]) {
            (Kind::JumpOff, ..) => between(i, self.asperities[i].jump_off_radius()),
            (Kind::Cover, Some(by), _) => between(by, self.neighbours.distance(&self.positions[i], &self.positions[by])),
            (Kind::Uncover, _, Status::Covered { by, release_m }) if state.radius[by] > 0.0 => between(by, release_m),
            (Kind::JumpIn, ..) => trigger.overshoot * self.asperities[i].jump_off_penetration().abs(),
            _ => 0.0,
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
    pub(crate) fn overtaken(&self, spots: &[Moving]) -> Option<Change> {
        let mut found: Option<(f64, Change)> = None;
        for &(i, a, residual) in spots {
            let overshoot = self.asperities[i].jump_off_radius() / a;
            if residual < 0.0 && overshoot > 1.0 && found.is_none_or(|(most, _)| overshoot > most) {
                found = Some((overshoot, Change { kind: Kind::JumpOff, asperity: i, by: None }));
            }
        }
        if found.is_none() && self.covers() {
            for &(j, a, _) in spots {
                self.neighbours.within(j, a, |r, i| {
                    let smaller = spots.binary_search_by_key(&i, |spot| spot.0).is_ok_and(|k| spots[k].1 < a);
                    if smaller && found.is_none_or(|(most, _)| a / r > most) {
                        found = Some((a / r, Change { kind: Kind::Cover, asperity: i, by: Some(j) }));
                    }
                });
            }
        }
        found.map(|(_, change)| change)
    }

    /// Where a relaxation finds no rest because a spot is at the edge of a greater one, and the field jumps in slope there: the smaller of the two
    /// is covered. `restless` is the asperity with the worst residual.
    pub(crate) fn at_edge(&self, spots: &[Moving], restless: usize) -> Option<Change> {
        let mut found: Option<(f64, Change)> = None;
        let mut offer = |i: usize, j: usize, a: f64, r: f64| {
            let off = (a / r - 1.0).abs();
            if off < EDGE && found.is_none_or(|(least, _)| off < least) {
                found = Some((off, Change { kind: Kind::Cover, asperity: i, by: Some(j) }));
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
