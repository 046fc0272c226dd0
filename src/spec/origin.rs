//! Origins of the values of a spec: written at a place, or defaults.

use std::ops::Range;

/// Origin of a value of the base.
#[derive(Clone)]
pub(super) enum Origin {
    /// The spec does not say it.
    Default,
    /// It is written here.
    Written(Range<usize>),
    /// The written value has a fault of its own, so that nothing follows from it.
    Faulty,
}

/// Place of a value in the text, if it is written.
pub(super) fn written(key: Option<usize>, origins: &[Origin]) -> Option<Range<usize>> {
    match &origins[key?] {
        Origin::Written(span) => Some(span.clone()),
        Origin::Default | Origin::Faulty => None,
    }
}
