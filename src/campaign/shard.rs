//! A part of a campaign that is done by itself: every n-th surface, and all that is done with it.

use std::str::FromStr;

/// Parts at most.
const MOST: usize = 1_000_000;

/// The part `index` of `count`, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Default for Shard {
    /// All of it.
    fn default() -> Self {
        Self { index: 0, count: 1 }
    }
}

impl Shard {
    /// True if the surface at this place of [`super::Campaign::surfaces`] belongs to it.
    #[must_use]
    pub fn holds(self, surface: usize) -> bool {
        surface % self.count == self.index
    }

    /// The part `index` of `count`; nothing if there is no such part.
    #[must_use]
    pub fn of([index, count]: [usize; 2]) -> Option<Self> {
        (index < count && count <= MOST).then_some(Self { index, count })
    }

    /// Number of the part, and number of parts.
    #[must_use]
    pub fn parts(self) -> [usize; 2] {
        [self.index, self.count]
    }

    /// True if it is all of a campaign.
    #[must_use]
    pub fn is_whole(self) -> bool {
        self.count == 1
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts =
            text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match parts.and_then(|(index, count)| Self::of([index, count])) {
            Some(shard) => Ok(shard),
            None => Err(format!("expected K/N, two integers with 0 <= K < N <= {MOST}, for example 0/4")),
        }
    }
}
