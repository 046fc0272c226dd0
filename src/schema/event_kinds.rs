//! Kinds of events as tables and report show them: the only list of kinds outside the physics.

use super::{Column, count};
use crate::physics::{EventKind, RegionChange};

/// Every kind of event of the tables `events`, in the column order of the tables over realizations.
pub const EVENT_KINDS: [&str; EventKind::ALL.len()] = EventKind::WORDS;

/// The kind of event of a word in the tables; of a word of boundary elements the kind that corresponds to it.
#[must_use]
pub fn event_kind(word: &str) -> Option<EventKind> {
    let of_region =
        || RegionChange::ALL.into_iter().find(|change| change.word() == word).map(RegionChange::kind);
    EventKind::ALL.into_iter().find(|kind| kind.word() == word).or_else(of_region)
}

/// Calls a macro with a row of each kind, in the order of [`EventKind::ALL`]: word, remark in the table of
/// events, colour, and descriptions of its columns in the tables of steps, of avalanches, and over
/// realizations.
macro_rules! event_kinds {
    ($columns:ident) => {
        $columns! {
            "jump_in", "", "in",
                "Asperities that jumped into contact, or regions formed, since the previous step",
                "Asperities that jumped into contact",
                "of jumps into contact, including the relaxation that follows";
            "jump_off", " (out of contact)", "out",
                "Asperities that jumped out of contact, or regions lost, since the previous step",
                "Asperities that jumped out of contact",
                "of jumps out of contact, including the relaxation that follows";
            "cover", " (absorption)", "other",
                "Asperities absorbed since the previous step",
                "Asperities absorbed by a larger contact",
                "of absorption, including the relaxation that follows; may be negative, since absorption has \
no potential";
            "uncover", " (release)", "in",
                "Asperities released from absorption since the previous step",
                "Asperities released from absorption",
                "of release from absorption, including the relaxation that follows; may be negative, since \
absorption has no potential";
            "snap", " (snap-through: same contacts, new equilibrium)", "other",
                "Snap-through events since the previous step: transitions to another equilibrium with the \
same contacts; regions grown or shrunk of boundary elements",
                "Snap-through events: transitions to another equilibrium with the same contacts",
                "of snap-through events: transitions to another equilibrium with the same contacts";
            "merge", "", "other",
                "Pairs of contacts merged, or regions joined, since the previous step",
                "Pairs of contacts merged",
                "of merging contacts, including the relaxation that follows";
            "split", "", "other",
                "Merged contacts split, or regions parted, since the previous step",
                "Merged contacts split",
                "of splitting contacts, including the relaxation that follows";
        }
    };
}
pub(super) use event_kinds;

macro_rules! counts {
    ($($word:literal, $remark:literal, $colour:literal, $step:literal, $avalanche:literal,
        $realization:literal;)+) => {
        /// Words of the colours of the kinds in the loop explorer.
        pub const EVENT_COLOURS: [&str; EventKind::ALL.len()] = [$($colour),+];
        pub(super) const OF_STEPS: [Column; EventKind::ALL.len()] =
            [$(count(concat!($word, "_count"), $step)),+];
        pub(super) const OF_AVALANCHES: [Column; EventKind::ALL.len()] =
            [$(count(concat!($word, "_count"), $avalanche)),+];
        pub(super) const KINDS_DOC: &str = concat!(
            "Kind of event: ",
            $("\"", $word, "\"", $remark, ", ",)+
            "and of boundary elements the change of the region whose area changed most: \"formed\", \
             \"lost\", \"joined\", \"parted\", \"grown\" or \"shrunk\""
        );
    };
}

event_kinds!(counts);

#[cfg(test)]
mod tests {
    use super::{EVENT_KINDS, OF_AVALANCHES, OF_STEPS};

    #[test]
    fn law_columns_of_counts_have_the_words_and_the_order_of_the_kinds() {
        let names = EVENT_KINDS.map(|word| format!("{word}_count"));
        for columns in [OF_STEPS, OF_AVALANCHES] {
            assert_eq!(columns.map(|column| column.name.to_owned()), names);
        }
    }
}
