//! Pairs of overlapping contact spots, which merge with coalescence `merge`.

use std::collections::BTreeSet;

/// Set of pairs of overlapping spots, as [`pair_of`].
pub(crate) type TouchingPairs = BTreeSet<(usize, usize)>;

/// A pair of spots, the lower number first.
pub(crate) fn pair_of(i: usize, j: usize) -> (usize, usize) {
    (i.min(j), i.max(j))
}
