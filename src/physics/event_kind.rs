//! Kinds of events of a loop, for both methods: word, name, group and inverse of each in one table.
//!
//! A further kind takes a variant with its row here. In the physics the compiler names the other places: its
//! condition (`path::conditions`), its application (`path::apply`) and the status that it enters
//! (`path::propagation`), see [`crate::asperities::path`]. Outside it takes one row in
//! `schema::event_kinds`, with its columns and its colour: tables, statistics, report and explorer follow
//! from it.

use serde::{Deserialize, Serialize};
use std::ops::Index;

/// Kind of event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum EventKind {
    /// A free asperity jumps into contact.
    JumpIn,
    /// A spot reaches the end of its branch and leaves contact.
    JumpOff,
    /// A larger spot reaches an asperity's centre and absorbs it.
    Cover,
    /// The absorbing spot has withdrawn, and the asperity is released.
    Uncover,
    /// Snap-through at a limit point of the coupled state: same contacts, new equilibrium. In the code also a
    /// change of a local problem without a change of status, such as the response to a pending displacement.
    Snap,
    /// Two overlapping spots merge.
    Merge,
    /// A merged spot splits into its parts.
    Split,
}

/// Common property of the kinds of a group. The second kind of a group is the inverse of the first one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventGroup {
    /// Jumps into and out of contact.
    Jump,
    /// Absorption and release: a contact and its load vanish in a larger one.
    Absorption,
    /// Snap-through: the contacts remain the same.
    Snap,
    /// Merging and splitting: contacts and their potentials are exchanged for that of another contact.
    Merging,
}

impl EventGroup {
    /// True for the groups of coalescence.
    #[must_use]
    pub fn is_coalescence(self) -> bool {
        matches!(self, Self::Absorption | Self::Merging)
    }
}

impl EventKind {
    /// All kinds, in the order of the tables.
    pub const ALL: [Self; 7] =
        [Self::JumpIn, Self::JumpOff, Self::Cover, Self::Uncover, Self::Snap, Self::Merge, Self::Split];

    /// Words of all kinds, in that order.
    pub const WORDS: [&'static str; Self::ALL.len()] = {
        let (mut words, mut at) = ([""; Self::ALL.len()], 0);
        while at < words.len() {
            words[at] = Self::ALL[at].row().0;
            at += 1;
        }
        words
    };

    /// Word, name, group and inverse.
    const fn row(self) -> (&'static str, &'static str, EventGroup, Self) {
        match self {
            Self::JumpIn => ("jump_in", "jump into contact", EventGroup::Jump, Self::JumpOff),
            Self::JumpOff => ("jump_off", "jump out of contact", EventGroup::Jump, Self::JumpIn),
            Self::Cover => ("cover", "absorption", EventGroup::Absorption, Self::Uncover),
            Self::Uncover => ("uncover", "release", EventGroup::Absorption, Self::Cover),
            Self::Snap => ("snap", "snap-through", EventGroup::Snap, Self::Snap),
            Self::Merge => ("merge", "merging", EventGroup::Merging, Self::Split),
            Self::Split => ("split", "splitting", EventGroup::Merging, Self::Merge),
        }
    }

    /// Word in the tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        self.row().0
    }

    /// Name in texts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().1
    }

    /// Group.
    #[must_use]
    pub const fn group(self) -> EventGroup {
        self.row().2
    }

    /// The kind that undoes it.
    #[must_use]
    pub const fn reversed(self) -> Self {
        self.row().3
    }

    /// True for a jump of a free asperity into contact.
    #[must_use]
    pub fn begins_contact(self) -> bool {
        self == Self::JumpIn
    }

    /// True for merging and splitting.
    pub(crate) fn is_merging(self) -> bool {
        self.group() == EventGroup::Merging
    }
}

/// Status of a contact spot after an event and the relaxation with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SpotStatus {
    /// Out of contact. The parts of a merged contact are out of contact with it.
    Free,
    /// In contact. The parts of a merged contact have no load of their own.
    Contact,
    /// Absorbed by a larger contact.
    Covered,
    /// Part of a merged contact.
    Merged,
    /// A merged contact in whose place its two parts are in contact.
    Split,
}

impl SpotStatus {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Free, Self::Contact, Self::Covered, Self::Merged, Self::Split];

    /// Word in the tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Contact => "contact",
            Self::Covered => "covered",
            Self::Merged => "merged",
            Self::Split => "split",
        }
    }
}

/// Change of the region of contact whose area changes most in an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RegionChange {
    /// A new region.
    Formed,
    /// A region separated.
    Lost,
    /// Regions joined.
    Joined,
    /// A region parted.
    Parted,
    /// A region grew without a change of topology.
    Grown,
    /// A region shrank without a change of topology.
    Shrunk,
}

impl RegionChange {
    /// All kinds.
    pub const ALL: [Self; 6] =
        [Self::Formed, Self::Lost, Self::Joined, Self::Parted, Self::Grown, Self::Shrunk];

    /// Word in the tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Formed => "formed",
            Self::Lost => "lost",
            Self::Joined => "joined",
            Self::Parted => "parted",
            Self::Grown => "grown",
            Self::Shrunk => "shrunk",
        }
    }

    /// Name in texts.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Formed => "region formed",
            Self::Lost => "region lost",
            Self::Joined => "regions joined",
            Self::Parted => "region parted",
            Self::Grown => "region grown",
            Self::Shrunk => "region shrunk",
        }
    }

    /// Kind of event of the asperity model that corresponds to it.
    #[must_use]
    pub fn kind(self) -> EventKind {
        match self {
            Self::Formed => EventKind::JumpIn,
            Self::Lost => EventKind::JumpOff,
            Self::Joined => EventKind::Merge,
            Self::Parted => EventKind::Split,
            Self::Grown | Self::Shrunk => EventKind::Snap,
        }
    }
}

/// Numbers of events by kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct EventCounts([usize; EventKind::ALL.len()]);

impl EventCounts {
    /// Number of all events.
    #[must_use]
    pub fn sum(&self) -> usize {
        self.0.iter().sum()
    }
}

impl Index<EventKind> for EventCounts {
    type Output = usize;

    fn index(&self, kind: EventKind) -> &usize {
        &self.0[kind as usize]
    }
}

impl Extend<EventKind> for EventCounts {
    fn extend<I: IntoIterator<Item = EventKind>>(&mut self, kinds: I) {
        kinds.into_iter().for_each(|kind| self.0[kind as usize] += 1);
    }
}

impl FromIterator<EventKind> for EventCounts {
    fn from_iter<I: IntoIterator<Item = EventKind>>(kinds: I) -> Self {
        let mut counts = Self::default();
        counts.extend(kinds);
        counts
    }
}

#[cfg(test)]
mod tests {
    use crate::event_kind::{EventCounts, EventKind};

    #[test]
    fn law_counts_are_those_of_their_kind() {
        assert!(EventKind::ALL.iter().enumerate().all(|(place, kind)| *kind as usize == place));
        let counts: EventCounts = EventKind::ALL.into_iter().chain([EventKind::Snap]).collect();
        assert!(
            EventKind::ALL.iter().all(|kind| counts[*kind] == if *kind == EventKind::Snap { 2 } else { 1 })
        );
        assert_eq!(counts.sum(), EventKind::ALL.len() + 1);
    }
}
