//! State of a path, and its increments.

use super::arrival::Arrival;
use super::chatter::ChatterGuard;
use super::checkpoint::Checkpoint;
use super::energy::EnergyLedger;
use super::event_log::EventLog;
use super::neighbourhood::{Neighbourhood, Surroundings};
use super::pending::PendingField;
use super::predictor::Predictor;
use super::rejection::Rejection;
use super::step_control::{StepControl, is_multiple};
use crate::asperities::contact::transition::Transition;
use crate::asperities::contact::{Event, Problem, State};
use crate::asperities::numerics::{Numerics, Steps};
use crate::asperities::solve::global::GlobalSolver;
use crate::asperities::solve::precision::Precision;
use crate::asperities::solve::residual::NotConverged;
use crate::cycle::{Effort, Totals};
use crate::{LoopError, PhysicsError, Reason};
use std::sync::Arc;

/// A contact along one branch; see [`super`].
pub(crate) struct EquilibriumPath {
    pub(super) solver: GlobalSolver,
    /// The contact as it is known between two global solves.
    pub(super) predictor: Predictor,
    /// Displacements that are not yet in the predictor.
    pub(super) pending: PendingField,
    /// Local problem of the present event.
    pub(super) neighbourhood: Neighbourhood,
    pub(super) energy: EnergyLedger,
    pub(super) steps: StepControl,
    pub(super) chatter: ChatterGuard,
    /// Asperities with a transition that is due and waits for the path to continue: found again, it is not
    /// late.
    pub(super) postponed: Vec<usize>,
    pub(super) log: EventLog,
    /// Load and area at the last global solve.
    pub(super) totals: Totals,
    /// Precision of the last global solve.
    pub(super) precision: Precision,
    /// Sense of the path, 1 loading or −1 unloading, and its length scale, the mean jump-off penetration
    /// rounded down \[m\].
    pub(super) frame: Frame,
    /// The state before the last increment.
    pub(super) checkpoint: Option<Box<Checkpoint>>,
}

/// Sense and length scale of a path.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    /// 1 loading, −1 unloading.
    pub(super) sense: f64,
    /// Mean jump-off penetration, rounded down \[m\].
    pub(super) scale: f64,
}

impl EquilibriumPath {
    /// A path without a history.
    pub(super) fn new(problem: Arc<Problem>, predictor: Predictor, frame: Frame, steps: StepControl) -> Self {
        let (n, mean_penetration) = (problem.len(), predictor.state.mean_penetration_m);
        let mut chatter = ChatterGuard::default();
        chatter.grow(n);
        Self {
            solver: GlobalSolver::new(problem),
            predictor,
            pending: PendingField::new(n),
            neighbourhood: Neighbourhood::default(),
            energy: EnergyLedger::new(mean_penetration, 0, 0.0),
            steps,
            chatter,
            postponed: Vec::new(),
            log: EventLog::default(),
            totals: Totals::default(),
            precision: Precision::Exact,
            frame,
            checkpoint: None,
        }
    }

    /// The problem with the merged contacts so far.
    pub(crate) fn problem(&self) -> Arc<Problem> {
        Arc::clone(&self.solver.problem)
    }

    pub(crate) fn state(&self) -> &State {
        &self.predictor.state
    }

    /// Load and area at the last global solve.
    pub(crate) fn totals(&self) -> Totals {
        self.totals
    }

    /// Sense of the path: 1 loading, −1 unloading.
    pub(crate) fn sense(&self) -> f64 {
        self.frame.sense
    }

    pub(crate) fn log(&self) -> &EventLog {
        &self.log
    }

    pub(crate) fn effort(&self) -> Effort {
        self.solver.effort
    }

    /// True if the state is exact and may be written down.
    pub(crate) fn is_exact(&self) -> bool {
        self.precision == Precision::Exact
    }

    /// Number of asperities that were frozen since the last record.
    pub(crate) fn frozen_count(&self) -> usize {
        self.chatter.frozen_count()
    }

    /// Begins a record: predictor residual and frozen asperities are counted from here.
    pub(crate) fn begin_record(&mut self) {
        self.log.drift_m = 0.0;
        self.chatter.clear_frozen();
    }

    /// Numerical choices.
    pub(super) fn numerics(&self) -> &Numerics {
        &self.solver.problem.numerics
    }

    /// Accuracy between exact global solves.
    pub(super) fn accuracy(&self) -> &Steps {
        &self.numerics().steps
    }

    /// Maximum pending displacement of a contact \[m\].
    pub(super) fn pending_limit(&self) -> f64 {
        self.accuracy().pending() * self.frame.scale
    }

    /// Distance of a free asperity from its jump-in beyond which it stays farther than the scale from it
    /// while the mean penetration changes by `way`; both \[m\].
    pub(super) fn out_of_reach(&self, way: f64) -> f64 {
        self.numerics().events.penetration_rate * way.abs() + self.frame.scale
    }

    /// Gathers the neighbourhood of a transition at a mean penetration \[m\] or where its contacts were known
    /// last.
    pub(super) fn gather(&mut self, transition: &Transition, mean_penetration: Option<f64>) {
        let interval = self.numerics().solver.free_interval * self.solver.problem.unit_m;
        let within = Surroundings {
            problem: &self.solver.problem,
            predictor: &self.predictor,
            pending: &self.pending,
            sense: self.frame.sense,
            scale: self.frame.scale,
            displaced: self.out_of_reach(interval + self.steps.longest()),
        };
        self.neighbourhood.gather(&within, transition, mean_penetration, &mut self.solver.effort);
    }

    /// Advances by one increment, not beyond `bound` \[m\].
    pub(crate) fn step(&mut self, bound: Option<f64>) -> Result<(), PhysicsError> {
        let checkpoint = self.checkpoint();
        loop {
            self.steps.begin_attempt();
            let here = self.state().mean_penetration_m;
            let target = self.steps.target(here, bound);
            let attempt =
                self.run_and_correct(target, bound).and_then(|()| self.check_numbers(checkpoint.events));
            let rejection = match attempt {
                Ok(()) => {
                    if self.steps.accept(target) {
                        self.chatter.restart();
                    }
                    break;
                }
                Err(Rejection::Failed(error)) => return Err(error),
                Err(rejection) => rejection,
            };
            self.restore(&checkpoint);
            if !self.steps.halve(here) {
                let relaxed =
                    self.relax_globally(target).and_then(|()| self.check_numbers(checkpoint.events));
                match relaxed {
                    Ok(()) => break,
                    Err(Rejection::Failed(error)) => return Err(error),
                    Err(_) => return Err(self.no_equilibrium(rejection)),
                }
            }
        }
        self.checkpoint = Some(Box::new(checkpoint));
        Ok(())
    }

    /// Runs the events before `target` and solves the global problem there; in between too, after events that
    /// move all of the contact.
    fn run_and_correct(&mut self, target: f64, bound: Option<f64>) -> Result<(), Rejection> {
        let (strict, precision) = (self.steps.is_strict(), self.precision_at(target, bound));
        while let Some(mean_penetration) = self.run_events(target)? {
            let there = mean_penetration == target;
            self.correct(
                mean_penetration,
                Arrival::Jump,
                if there { precision } else { self.precision_between() },
            )?;
            if there {
                return Ok(());
            }
        }
        self.correct(target, if strict { Arrival::CheckedIncrement } else { Arrival::Increment }, precision)
    }

    /// Precision where the state is not written down: that of the events, where local problems hold all
    /// contacts.
    fn precision_between(&self) -> Precision {
        if self.problem().solves_whole() { Precision::Exact } else { Precision::Sufficient }
    }

    /// Precision at the end of an increment: exact on a grid, where most states are written down, and at a
    /// bound.
    fn precision_at(&self, target: f64, bound: Option<f64>) -> Precision {
        let exact =
            bound == Some(target) || is_multiple(target, self.accuracy().exact_grid * self.problem().unit_m);
        if exact { Precision::Exact } else { self.precision_between() }
    }

    /// Rejects loads and energies that are not numbers.
    fn check_numbers(&self, events: usize) -> Result<(), Rejection> {
        let energy = |event: &Event| event.energy_lost_j + event.before.load_n + event.after.load_n;
        if self.log.work_j.is_finite()
            && self.totals.load_n.is_finite()
            && self.log.events[events..].iter().map(energy).all(f64::is_finite)
        {
            return Ok(());
        }
        let asperity = self.state().contacts.first().copied().unwrap_or(0);
        Err(NotConverged::because(Reason::NotANumber, asperity).into())
    }

    /// Counts the trial of a transition, and ends an increment whose trials go on without end.
    pub(super) fn count_trial(
        &mut self,
        mean_penetration_m: f64,
        asperity: usize,
    ) -> Result<(), PhysicsError> {
        let problem = &*self.problem();
        let limits = &problem.numerics.events;
        let most = limits.trials_per_asperity * (problem.len() + limits.trials_offset);
        self.steps.count_trial(most, mean_penetration_m, problem.number(asperity))
    }

    /// The error of an increment that was rejected for good.
    pub(super) fn no_equilibrium(&self, rejection: Rejection) -> PhysicsError {
        let reason = match rejection {
            Rejection::Failed(error) => return error,
            Rejection::NotConverged(reason) => reason,
        };
        LoopError::NoEquilibrium {
            mean_penetration_m: self.state().mean_penetration_m,
            reason: reason.reason,
            residual_m: reason.residual_m,
            asperity: self.problem().number(reason.asperity),
            iterations: self.solver.effort.iterations,
        }
        .into()
    }
}
