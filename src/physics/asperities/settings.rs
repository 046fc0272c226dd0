//! Settings and records of a cycle of the asperity model.

use super::contact::{Problem, State};
use super::path::{EquilibriumPath, is_multiple};
use crate::model::KeptContacts;

/// Results of a cycle of the asperity model, with the states at its load reversals.
pub type Cycle = crate::cycle::Cycle<State>;

/// Settings of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Loads `F/(E* A0)` at the load reversals, ascending.
    pub max_loads: Vec<f64>,
    /// Step of mean penetration over the rms height, or over the JKR length of a probe.
    pub approach_step: f64,
    /// Selection of the steps at which spots are stored.
    pub contacts: KeptContacts,
    /// Interval of mean penetration, in rms heights, between checkpoints.
    ///
    /// `None` for a run without checkpoints. At a checkpoint the path restarts from the stored state, so that
    /// another process can continue it.
    pub rest_every: Option<f64>,
}

impl Settings {
    /// Spacing of the grid of mean penetrations, or of displacements of a machine \[m\], common to both
    /// senses and all load reversals.
    pub(super) fn grid(&self, problem: &Problem) -> f64 {
        self.approach_step * problem.output_unit_m()
    }

    /// True if the path has reached a checkpoint position other than `from` \[m\].
    pub(super) fn rests(&self, path: &EquilibriumPath, from: f64) -> bool {
        let at = path.state().mean_penetration_m;
        self.rest_every.is_some_and(|every| {
            path.is_exact() && at != from && is_multiple(at, every * path.problem().unit_m)
        })
    }
}
