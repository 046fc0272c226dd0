//! Checkpoints of a path, taken and resumed.

use super::arrival::Arrival;
use super::checkpoint::{Checkpoint, PathCheckpoint};
use super::energy::EnergyLedger;
use super::equilibrium_path::{EquilibriumPath, Frame};
use super::neighbourhood::Neighbourhood;
use super::predictor::Predictor;
use super::step_control::StepControl;
use crate::PhysicsError;
use crate::asperities::contact::Problem;
use crate::asperities::solve::precision::Precision;
use std::sync::Arc;

impl EquilibriumPath {
    /// Resumes a path. The state need not be an equilibrium: the difference of the potential is charged to
    /// the last event, and the initial residual is not recorded as predictor residual.
    pub(crate) fn resume(problem: Arc<Problem>, from: PathCheckpoint) -> Result<Self, PhysicsError> {
        let (mean_penetration, drift) = (from.state.mean_penetration_m, from.log.drift_m);
        let (longest, scale) = from.lengths;
        let parted = from.parted.unwrap_or_else(|| problem.touching(&from.state));
        let mut predictor = Predictor::new(&problem, from.state);
        predictor.parted = parted;
        predictor.expect_totals(from.totals);
        let steps = StepControl::new(problem.increments(), from.sense, longest, from.halvings);
        let mut path = Self::new(problem, predictor, Frame { sense: from.sense, scale }, steps);
        path.solver.effort = from.effort;
        path.energy = EnergyLedger::new(mean_penetration, from.events, from.balance);
        if from.events < from.log.events.len() {
            path.energy.charge_last_event();
        }
        (path.log, path.totals, path.chatter) = (from.log, from.totals, from.chatter);
        path.chatter.grow(path.problem().len());
        match path.correct(mean_penetration, Arrival::Jump, Precision::Exact) {
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
            parted: Some(self.predictor.parted),
            heights: self.solver.problem.merges().then(|| self.solver.problem.heights.clone()),
        }
    }

    /// The present state, at a global solve.
    pub(super) fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            problem: self.problem(),
            predictor: self.predictor.clone(),
            chatter: self.chatter.clone(),
            postponed: self.postponed.clone(),
            totals: self.totals,
            balance: self.energy.balance(),
            log: self.log.clone_without_events(),
            events: self.log.events.len(),
            segments: self.log.segments.len(),
        }
    }

    /// Goes back to a checkpoint.
    pub(super) fn restore(&mut self, checkpoint: &Checkpoint) {
        if !Arc::ptr_eq(&self.solver.problem, &checkpoint.problem) {
            // Merged contacts of the same numbers may have other places.
            self.solver.replace_problem(Arc::clone(&checkpoint.problem));
            self.neighbourhood = Neighbourhood::default();
        }
        self.predictor.clone_from(&checkpoint.predictor);
        self.chatter.clone_from(&checkpoint.chatter);
        self.postponed.clone_from(&checkpoint.postponed);
        self.totals = checkpoint.totals;
        self.log.restore(&checkpoint.log, checkpoint.events, checkpoint.segments);
        self.energy =
            EnergyLedger::new(self.state().mean_penetration_m, self.log.events.len(), checkpoint.balance);
        self.pending.clear();
    }
}
