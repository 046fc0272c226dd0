//! Changes of state: what triggers them, and how they are applied.
//!
//! An asperity jumps in where its penetration reaches its jump-in distance; it jumps off where its own branch ends; it is covered where
//! a greater spot reaches its centre, and uncovered where that spot has withdrawn from it.
//!
//! Covering takes a load away, so it moves the covering spot: if the load was tensile, the spot shrinks and would release the asperity at
//! once, which would draw the spot out again, for ever. So the radius that the spot has after covering is the one below which it
//! releases; and where uncovering would only end in being covered again, or in the two changing parts, it is not done, and tried
//! again when the spot has shrunk by another 3 %. Neither depends on the step of the approach.

use super::state::{Problem, State, Status};
use crate::model::Coalescence;

/// A kind of event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
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
}

impl Kind {
    /// The word in the tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::JumpIn => "jump_in",
            Self::JumpOff => "jump_off",
            Self::Cover => "cover",
            Self::Uncover => "uncover",
            Self::Snap => "snap",
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
    /// Whether this would undo one of the changes that have `moved` in the same avalanche.
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

    /// Whether this covers an asperity that was uncovered, or covers the spot that it was uncovered from by its own.
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

impl Problem {
    /// All changes that are due in an equilibrium. `free` holds the penetrations of the free asperities; if it is empty, jump-ins are
    /// not looked for.
    pub(crate) fn triggers(&self, state: &State, free: &[f64]) -> Vec<Trigger> {
        let mut due = Vec::new();
        let mut add = |change: Change| {
            let overshoot = self.overshoot(&change, state, free);
            if overshoot >= 0.0 {
                due.push(Trigger { change, overshoot });
            }
        };
        for &i in &state.contacts {
            add(Change { kind: Kind::JumpOff, asperity: i, by: None });
        }
        let covering = self.rules.coalescence == Coalescence::Cover;
        let mut inside = vec![false; if covering { self.len() } else { 0 }];
        if covering {
            for &j in &state.contacts {
                self.neighbours.within(&self.positions, j, state.radius[j], |_, i| {
                    if matches!(state.status[i], Status::Covered { .. }) || state.radius[i] >= state.radius[j] {
                        return;
                    }
                    inside[i] = true;
                    add(Change { kind: Kind::Cover, asperity: i, by: Some(j) });
                });
            }
        }
        for (i, status) in state.status.iter().enumerate() {
            match *status {
                Status::Free if !free.is_empty() && !inside.get(i).copied().unwrap_or(false) && !state.barred[i] => {
                    add(Change { kind: Kind::JumpIn, asperity: i, by: None });
                }
                Status::Covered { by, .. } => add(Change { kind: Kind::Uncover, asperity: i, by: Some(by) }),
                _ => {}
            }
        }
        due
    }

    /// How far a state is beyond a change: negative before it.
    pub(crate) fn overshoot(&self, change: &Change, state: &State, free: &[f64]) -> f64 {
        let i = change.asperity;
        match (change.kind, change.by) {
            (Kind::JumpOff, _) => 1.0 - state.radius[i] / self.asperities[i].jump_off_radius(),
            (Kind::JumpIn, _) => {
                (free.get(i).copied().unwrap_or(f64::NAN) - self.jump_in[i]) / self.asperities[i].jump_off_penetration().abs()
            }
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

    /// The greatest spot over the centre of asperity `i`, with its distance.
    pub(crate) fn covering(&self, state: &State, i: usize) -> Option<(usize, f64)> {
        state
            .contacts
            .iter()
            .filter(|j| **j != i)
            .map(|&j| (j, self.neighbours.distance(&self.positions[i], &self.positions[j])))
            .filter(|(j, r)| state.radius[*j] >= *r)
            .max_by(|(j, _), (k, _)| state.radius[*j].total_cmp(&state.radius[*k]).then(k.cmp(j)))
    }
}
