//! Selection of tasks, their progress and their outcome.

use crate::campaign::{Shard, Stage};
use crate::physics::LoopPosition;
use crate::store::Check;
use std::collections::HashSet;
use std::path::Path;

/// Receiver of the progress of stages.
pub trait Watch: Sync {
    /// A stage begins: how many of its units are done already, and how many there are.
    fn begin(&self, stage: Stage, done: usize, all: usize);
    /// A task has begun.
    fn started(&self, _stage: Stage, _id: &str) {}
    /// A task has failed.
    fn failed(&self, _stage: Stage, _id: &str) {}
    /// A part of a unit is done: the parts of a unit add up to 1.
    fn progress(&self, stage: Stage, part: f64);
    /// A running cycle has reached a position on its loop.
    fn position(&self, _id: &str, _at: &LoopPosition) {}
    /// A unit is done.
    fn finished(&self, stage: Stage, id: &str);
    /// Something to be seen: a damaged file, a failed case.
    fn notice(&self, text: &str);
    /// The page of progress is written at this path from now on.
    fn page(&self, _path: &Path) {}
    /// A file at this path is removed at the end of the run, also where the run ends without its destructors.
    fn temporary(&self, _path: &Path) {}
    /// A stage ends.
    fn end(&self, stage: Stage);
}

/// Outcome of the tasks of a stage.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Units of the stage.
    pub planned: usize,
    /// Done before.
    pub before: usize,
    /// Computed now.
    pub computed: usize,
    /// Failed.
    pub failed: usize,
}

impl Tally {
    /// Adds the outcome after more tasks were added: those computed now were not done before.
    pub(super) fn go_on(&mut self, next: Self) {
        self.planned = next.planned;
        self.computed += next.computed;
        self.failed = self.failed.max(next.failed);
    }
}

/// Selection of the tasks of a campaign.
#[derive(Debug, Clone)]
pub struct Task {
    /// The first stage.
    pub from: Stage,
    /// The last one.
    pub until: Stage,
    /// Which part of the surfaces, and what is done with them.
    pub shard: Shard,
    /// Aggregate what is there, although cases are missing.
    pub partial: bool,
    /// Check of finished files: a changed file is computed again.
    pub check: Check,
    /// Cycles that have failed and are tried again.
    pub retried: HashSet<String>,
}

impl Task {
    /// These stages, of everything.
    #[must_use]
    pub fn new(from: Stage, until: Stage) -> Self {
        Self {
            from,
            until,
            shard: Shard::default(),
            partial: false,
            check: Check::Contents,
            retried: HashSet::new(),
        }
    }
}
