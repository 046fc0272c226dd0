//! Checkpoints of a path: in memory, to repeat an increment, and as a record that another process resumes.

use super::chatter::ChatterGuard;
use super::event_log::EventLog;
use super::predictor::Predictor;
use crate::asperities::contact::merged_spot::TouchingPairs;
use crate::asperities::contact::{Problem, State};
use crate::cycle::{Effort, Totals};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A path at a global solve, to go back to.
pub(crate) struct Checkpoint {
    /// The problem with its merged contacts.
    pub(super) problem: Arc<Problem>,
    pub(super) predictor: Predictor,
    pub(super) chatter: ChatterGuard,
    pub(super) postponed: Vec<usize>,
    pub(super) totals: Totals,
    /// `Π − work` \[J\].
    pub(super) balance: f64,
    /// The log without its events and load segments, and their numbers.
    pub(super) log: EventLog,
    pub(super) events: usize,
    pub(super) segments: usize,
}

impl Checkpoint {
    /// State of the contact.
    pub(super) fn state(&self) -> &State {
        &self.predictor.state
    }
}

/// A path between two problems or processes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PathCheckpoint {
    pub(crate) state: State,
    pub(super) sense: f64,
    /// Longest increment and length scale \[m\].
    pub(super) lengths: (f64, f64),
    pub(crate) log: EventLog,
    /// Load and area at the last global solve.
    pub(crate) totals: Totals,
    /// `Π − work` there \[J\], and the number of events.
    pub(super) balance: f64,
    pub(super) events: usize,
    pub(super) halvings: u32,
    pub(super) chatter: ChatterGuard,
    pub(super) effort: Effort,
    /// Pairs that overlap and do not merge before they have been apart; at the beginning of a path, the pairs
    /// that overlap there.
    pub(super) parted: Option<TouchingPairs>,
    /// Heights with the difference fields of merged contacts \[m\]; at the beginning of a path, nothing: they
    /// follow from the state.
    pub(crate) heights: Option<Vec<f64>>,
}

impl PathCheckpoint {
    /// The beginning of a path.
    pub(crate) fn begin(problem: &Problem, state: State, sense: f64) -> Self {
        let (summits, steps) = (problem.asperities.base(), &problem.numerics.steps);
        let off = summits.iter().map(|a| a.jump_off_penetration().abs()).sum::<f64>() / summits.len() as f64;
        // Where adhesion is weak, the roughness sets the scale.
        let off = off.max(steps.min_scale * problem.unit_m);
        // A power of two of the grid, so that round output steps end increments.
        let unit = steps.exact_grid * problem.unit_m;
        let share = if problem.solves_whole() {
            steps.longest_increment_of_whole()
        } else {
            steps.longest_increment()
        };
        let longest = unit * (share * off / unit).log2().floor().exp2();
        Self {
            state,
            sense,
            lengths: (problem.increment_growth() * longest, longest / share),
            log: EventLog::default(),
            totals: Totals::default(),
            balance: 0.0,
            events: 0,
            halvings: problem.increments().max_halvings - steps.max_halvings,
            chatter: ChatterGuard::default(),
            effort: Effort::default(),
            parted: None,
            heights: None,
        }
    }
}
