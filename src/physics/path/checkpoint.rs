//! Checkpoints of a path: in memory, to repeat an increment, and as a record that another process resumes.

use super::accuracy::{EXACT_GRID, FINE_INCREMENT, LEAST_SCALE, LONGEST_INCREMENT, Precision};
use super::chatter::ChatterGuard;
use super::energy::EnergyLedger;
use super::equilibrium_path::{EquilibriumPath, Frame};
use super::event_log::EventLog;
use super::predictor::Predictor;
use super::step_control::StepControl;
use crate::physics::PhysicsError;
use crate::physics::contact::merged_spot::TouchingPairs;
use crate::physics::contact::{Event, Problem, State, Totals};
use crate::physics::half_space::Effort;
use serde::{Deserialize, Serialize};

/// A path at a global solve, to go back to.
pub(crate) struct Checkpoint {
    predictor: Predictor,
    chatter: ChatterGuard,
    totals: Totals,
    /// `Π − work` \[J\].
    balance: f64,
    /// The log without its events and load segments, and their numbers.
    log: EventLog,
    events: usize,
    segments: usize,
}

impl Checkpoint {
    /// Number of events.
    pub(super) fn events(&self) -> usize {
        self.events
    }

    /// Number of load segments.
    pub(super) fn segments(&self) -> usize {
        self.segments
    }

    /// State of the contact.
    pub(super) fn state(&self) -> &State {
        &self.predictor.state
    }

    /// Load and area.
    pub(super) fn totals(&self) -> Totals {
        self.totals
    }
}

/// A path between two problems or processes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PathCheckpoint {
    pub(crate) state: State,
    sense: f64,
    /// Longest increment and length scale \[m\].
    lengths: (f64, f64),
    pub(crate) log: EventLog,
    /// Load and area at the last global solve.
    pub(crate) totals: Totals,
    /// `Π − work` there \[J\], and the number of events.
    balance: f64,
    events: usize,
    halvings: u32,
    chatter: ChatterGuard,
    effort: Effort,
    /// Touching pairs that do not merge, where a cycle was interrupted.
    pub(crate) known: Option<TouchingPairs>,
}

impl PathCheckpoint {
    /// The beginning of a path.
    pub(crate) fn begin(problem: &Problem, state: State, sense: f64) -> Self {
        let summits = &problem.asperities[..problem.summits];
        let off = summits.iter().map(|a| a.jump_off_penetration().abs()).sum::<f64>() / summits.len() as f64;
        // Where adhesion is weak, the roughness sets the scale.
        let off = off.max(LEAST_SCALE * problem.rms_height_m);
        // A power of two of the grid, so that round output steps end increments.
        let unit = EXACT_GRID * problem.rms_height_m;
        let share = if problem.solves_whole() { FINE_INCREMENT } else { LONGEST_INCREMENT };
        let longest = unit * (share * off / unit).log2().floor().exp2();
        Self {
            state,
            sense,
            lengths: (longest, longest / share),
            log: EventLog::default(),
            totals: Totals::default(),
            balance: 0.0,
            events: 0,
            halvings: 0,
            chatter: ChatterGuard::default(),
            effort: Effort::default(),
            known: None,
        }
    }
}

impl<'p> EquilibriumPath<'p> {
    /// Resumes a path. The state need not be an equilibrium: the difference of the potential is charged to the last event, and the initial residual is not
    /// recorded as predictor residual.
    pub(crate) fn resume(problem: &'p Problem, from: PathCheckpoint) -> Result<Self, PhysicsError> {
        let (approach, drift) = (from.state.approach_m, from.log.drift_m);
        let (longest, scale) = from.lengths;
        let mut predictor = Predictor::new(problem, from.state);
        predictor.expect_totals(from.totals);
        let steps = StepControl::new(from.sense, longest, from.halvings);
        let mut path = Self::new(problem, predictor, Frame { sense: from.sense, scale }, steps);
        path.solver.effort = from.effort;
        path.energy = EnergyLedger::new(approach, from.events, from.balance).open(from.events < from.log.events.len());
        (path.log, path.totals, path.chatter) = (from.log, from.totals, from.chatter);
        path.chatter.grow(problem.len());
        path.steps.limit_events(path.log.events.len(), problem.len());
        match path.correct(approach, false, true, Precision::Exact) {
            Ok(()) => {
                path.log.drift_m = drift;
                Ok(path)
            }
            Err(rejection) => Err(path.no_equilibrium(rejection)),
        }
    }

    /// Ends here, at a global solve.
    pub(crate) fn into_checkpoint(self) -> PathCheckpoint {
        PathCheckpoint {
            state: self.predictor.state,
            sense: self.frame.sense,
            lengths: (self.steps.longest(), self.frame.scale),
            events: self.log.events.len(),
            log: self.log,
            totals: self.totals,
            balance: self.energy.balance(),
            halvings: self.steps.halvings(),
            chatter: self.chatter,
            effort: self.solver.effort,
            known: None,
        }
    }

    /// The present state, at a global solve.
    pub(super) fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            predictor: self.predictor.clone(),
            chatter: self.chatter.clone(),
            totals: self.totals,
            balance: self.energy.balance(),
            log: self.log.clone_without_events(),
            events: self.log.events.len(),
            segments: self.log.segments.len(),
        }
    }

    /// Goes back to a checkpoint.
    pub(super) fn restore(&mut self, checkpoint: &Checkpoint) {
        self.predictor.clone_from(&checkpoint.predictor);
        self.chatter.clone_from(&checkpoint.chatter);
        self.totals = checkpoint.totals;
        self.log.restore(&checkpoint.log, checkpoint.events, checkpoint.segments);
        self.energy = EnergyLedger::new(self.state().approach_m, self.log.events.len(), checkpoint.balance);
        self.pending.clear();
    }

    /// The state before the last increment.
    pub(crate) fn previous_state(&self) -> Option<&State> {
        self.checkpoint.as_deref().map(Checkpoint::state)
    }

    /// Events of the last increment.
    pub(crate) fn recent_events(&self) -> &[Event] {
        &self.log.events[self.checkpoint.as_deref().map_or(0, Checkpoint::events)..]
    }

    /// Undoes the last increment.
    pub(crate) fn undo_step(&mut self) {
        if let Some(checkpoint) = self.checkpoint.take() {
            self.restore(&checkpoint);
        }
    }
}
