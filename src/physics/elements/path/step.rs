//! One step of a cycle: an equilibrium at a mean penetration near the one before, and the energy dissipated
//! in between.
//!
//! Between events the states are a continuous curve on which `F = dΠ/dΔ`, so that `∫F dΔ − ΔΠ` vanishes; in
//! an event the energy falls at one mean penetration, by the energy dissipated. The integral has errors of
//! both signs. An event is therefore counted where the sum of `∫F dΔ − ΔΠ` since the last one exceeds its
//! uncertainty, and an apparent gain is subtracted from the next event. A gain must not shorten the step:
//! repeating what comes out too small makes the sum too large.
//!
//! A step is halved where a jump of the load makes its integral uncertain by more than
//! [`Settings::jump_tolerance`]. It is also halved where the load may have passed through the maximum
//! tension, before a jump or, with attraction of a range, smoothly. The next steps are as short, until the
//! uncertainty is well below the limit.

use super::records::{Cycle, Event, Map, Step};
use crate::PhysicsError;
use crate::cycle::Done;
use crate::elements::equilibrium::Equilibrium;
use crate::elements::equilibrium::minimise::{ANY, Accuracy, Loads, Outcome};
use crate::elements::equilibrium::newton::Rate;
use crate::elements::equilibrium::patch::Patches;
use crate::elements::events::regions::{Labels, Region, change, label, regions};
use crate::elements::events::work::{OnLoop, Work, least_between, work_between};
use crate::elements::grid::sums::largest;
use crate::elements::problem::{Attraction, Nucleation, Problem, State};
use crate::memory::filled;
use serde::{Deserialize, Serialize};

/// Share of the machine's spring in the displacement from which on its stiffness is that of the spring.
const SOFT: f64 = 0.5;

/// Settings of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Loads at which the path reverses \[E* dx²\], ascending.
    pub max_loads: Vec<f64>,
    /// Step of the mean penetration \[dx\].
    pub step: f64,
    /// Largest error that a jump of the load may cause in the integral over a step, relative to the energy
    /// dissipated so far: longer steps are halved.
    pub jump_tolerance: f64,
    /// Most halvings of such a step.
    pub halvings: u32,
    /// Accuracy of an equilibrium.
    pub accuracy: Accuracy,
    /// True if the regions of every step are kept; else those of the maps.
    pub all_regions: bool,
    /// Grid points of the asperities, which are counted in each region.
    pub summits: Vec<usize>,
}

/// An unfinished cycle: all that is needed to continue in another process, to the same bytes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Checkpoint {
    pub(crate) cycle: Cycle,
    /// Branches that are done.
    pub(crate) done: Done,
    pub(crate) state: State,
    pub(crate) last: Step,
    /// Energy dissipated so far \[E* dx³\].
    pub(crate) dissipated: f64,
    /// Halvings of the next step.
    pub(crate) level: u32,
    /// Map and regions at the maximum tensile load of the branch so far.
    pub(crate) max_tension: Option<(f64, Map, Vec<Region>)>,
    /// Regions of contact of the state; computed again on resuming.
    #[serde(skip)]
    pub(crate) labels: Labels,
    /// The loading path where a search for a load reversal has left it.
    pub(crate) trunk: Option<Box<Trunk>>,
    /// Energy of events of such searches that the path has not dissipated yet \[E* dx³\].
    pub(crate) owed: f64,
}

/// A state of the loading path, to which it returns from a load reversal. Smaller loads of a spec do not
/// change the path to the larger ones.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Trunk {
    state: State,
    last: Step,
    dissipated: f64,
    level: u32,
    /// Steps and events before the search.
    steps: usize,
    events: usize,
    owed: f64,
}

/// An equilibrium that may become the next step.
pub(crate) struct Attempt {
    state: State,
    pub(crate) step: Step,
    /// Error of the integral of the load that a jump of it may cause.
    across: f64,
    rate: Rate,
}

/// A step as a point of the loop.
fn on_loop(step: &Step) -> OnLoop {
    OnLoop { mean_penetration: step.mean_penetration, load: step.totals.load, stiffness: step.stiffness }
}

/// An unfinished cycle with its problem and work space.
pub(crate) struct CycleRun<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) settings: &'a Settings,
    equilibrium: Equilibrium,
    pub(crate) at: Checkpoint,
    /// Rate of the state, once it has been needed.
    pub(crate) rate: Option<Rate>,
    /// Iterations since the last step, and points of transforms at its end.
    iterations: u64,
    counted: u64,
}

impl<'a> CycleRun<'a> {
    /// A cycle from the beginning or from a checkpoint.
    pub(crate) fn new(
        problem: &'a Problem,
        settings: &'a Settings,
        checkpoint: Option<Checkpoint>,
    ) -> Result<Self, PhysicsError> {
        let start = match problem.attraction {
            Attraction::Bonded { nucleation, .. } => -nucleation,
            Attraction::Range => -problem.law.end_gap(),
            Attraction::None => 0.0,
        };
        let mut at = match checkpoint {
            Some(checkpoint) => checkpoint,
            None => Checkpoint {
                cycle: Cycle::default(),
                done: Done::default(),
                state: State { pressure: Vec::new(), ..problem.apart(start)? },
                last: Step { mean_penetration: start, ..Step::default() },
                dissipated: 0.0,
                level: 0,
                max_tension: None,
                labels: Labels::default(),
                trunk: None,
                owed: 0.0,
            },
        };
        at.labels = label(problem, &at.state);
        Ok(Self {
            problem,
            settings,
            equilibrium: Equilibrium::new(problem, Patches::new(problem)?)?,
            at,
            rate: None,
            iterations: 0,
            counted: 0,
        })
    }

    /// Regions of contact of the last state.
    pub(crate) fn regions(&self) -> Vec<Region> {
        regions(self.problem, &self.at.state, &self.at.labels, &self.settings.summits)
    }

    /// Equilibrium at a mean penetration, from the last state extrapolated, with all contacts that form
    /// there.
    pub(crate) fn attempt(
        &mut self,
        mean_penetration: f64,
        accuracy: Accuracy,
    ) -> Result<Attempt, PhysicsError> {
        let mut state = self.predict(mean_penetration)?;
        let outcome = self.relax(&mut state, accuracy, &ANY)?;
        self.conclude(state, outcome)
    }

    /// The last state extrapolated.
    fn predict(&mut self, mean_penetration: f64) -> Result<State, PhysicsError> {
        let mut state =
            State { pressure: filled(self.problem.half_space.points(), 0.0)?, ..self.at.state.clone() };
        let rate = match self.rate.take() {
            Some(rate) => rate,
            None => {
                // Not counted: another process may have computed it.
                let rate = self.equilibrium.rate(self.problem, &state)?;
                self.counted = self.equilibrium.transformed();
                rate
            }
        };
        let length = (mean_penetration - state.mean_penetration)
            * (self.problem.numerics.steps.max_rate / largest(&rate.displacement)).min(1.0);
        for (to, rate) in state.displacement.iter_mut().zip(&rate.displacement) {
            *to += length * f64::from(*rate);
        }
        self.rate = Some(rate);
        state.mean_penetration = mean_penetration;
        if self.problem.attraction == Attraction::Range {
            self.limit_overlap(&mut state);
        }
        Ok(state)
    }

    /// Raises the points that extrapolation has moved deeply into the wall.
    fn limit_overlap(&self, state: &mut State) {
        let deepest = self.problem.numerics.steps.extrapolated_overlap * self.problem.reach();
        for k in 0..state.displacement.len() {
            let least = self.problem.gap(&self.at.state, k).min(0.0) - deepest;
            state.displacement[k] += (least - self.problem.gap(state, k)).max(0.0);
        }
    }

    /// Moves a state to the equilibrium at its mean penetration, unless an event takes the load out of
    /// `loads`.
    fn relax(
        &mut self,
        state: &mut State,
        accuracy: Accuracy,
        loads: &Loads,
    ) -> Result<Outcome, PhysicsError> {
        loop {
            let outcome = self.equilibrium.find_within(self.problem, state, accuracy, loads)?;
            self.iterations += outcome.iterations as u64;
            if outcome.left || self.problem.update_bonds(state, Nucleation::Allowed).is_empty() {
                return Ok(outcome);
            }
        }
    }

    /// The step from the last state to an equilibrium.
    fn conclude(&mut self, mut state: State, outcome: Outcome) -> Result<Attempt, PhysicsError> {
        let totals = self.problem.totals(&state);
        self.problem.settle_bonds(&mut state);
        let rate = self.equilibrium.rate(self.problem, &state)?;
        let (from, limits) = (&self.at.last, &self.problem.numerics.steps);
        let reached = Step {
            mean_penetration: state.mean_penetration,
            totals,
            stiffness: rate.stiffness,
            ..Step::default()
        };
        let Work { bend, across, .. } = work_between(on_loop(from), on_loop(&reached));
        // The trapezoid of the contact has no part of the machine's spring, and the bend is the same for
        // both. A soft machine moves by much more than the contact, which its stiffness does not resolve.
        let is_soft = self.problem.machine_compliance * from.stiffness.max(reached.stiffness) > SOFT;
        let bend = if is_soft { 0.0 } else { bend };
        let moved = reached.penetration() - from.penetration();
        let work = 0.5 * (from.totals.load + totals.load) * moved + bend;
        let imbalance = work - (totals.energy - from.totals.energy);
        let step = Step {
            reversal: from.reversal,
            imbalance,
            uncertainty: limits.bend_uncertainty * bend.abs() + limits.jump_uncertainty * across,
            pending: from.pending + imbalance,
            work: from.work + work,
            residual: outcome.residual,
            converged: outcome.converged,
            ..reached
        };
        Ok(Attempt { state, step, across, rate })
    }

    /// Imbalance up to which a step has no event, with the uncertainty of its integral \[E* dx³\].
    fn resolution(&self, uncertainty: f64) -> f64 {
        uncertainty.max(self.problem.numerics.steps.event_fraction * self.at.dissipated)
    }

    pub(crate) fn accept(&mut self, Attempt { state, mut step, rate, .. }: Attempt) {
        let labels = label(self.problem, &state);
        (step.regions, step.iterations) = (labels.count, std::mem::take(&mut self.iterations));
        step.transforms = self.equilibrium.transforms(self.counted);
        self.counted = self.equilibrium.transformed();
        if step.pending > self.resolution(step.uncertainty) {
            let found = std::mem::take(&mut step.pending);
            self.at.dissipated += found;
            step.dissipated = self.not_yet_counted(found);
        }
        if step.dissipated > 0.0 {
            self.at.cycle.events.push(Event {
                step: self.at.cycle.steps.len(),
                kind: change(&self.at.labels, &labels),
                before: self.at.last.totals,
                after: step.totals,
                dissipated: step.dissipated,
            });
        }
        self.at.labels = labels;
        self.at.state = State { pressure: Vec::new(), ..state };
        self.rate = Some(rate);
        self.at.last = step;
        if self.settings.all_regions {
            let (step, found) = (self.at.cycle.steps.len(), self.regions());
            self.at.cycle.keep_regions(step, found);
        }
        self.at.cycle.steps.push(step);
    }

    /// Part of a dissipated energy that no step of the table has. A search for a load reversal is in the
    /// table between two steps of the path, and what it has dissipated is a part of what the path dissipates
    /// there.
    fn not_yet_counted(&mut self, found: f64) -> f64 {
        if self.at.trunk.is_some() {
            self.at.owed += found;
            return found;
        }
        let owed = self.at.owed;
        self.at.owed = (owed - found).max(0.0);
        (found - owed).max(0.0)
    }

    /// Notes the state of the loading path before the search for the reversal at a load, unless the path ends
    /// there.
    fn leave_path(&mut self, max_load: f64) {
        if self.settings.max_loads.last().is_none_or(|last| *last <= max_load) {
            return;
        }
        let Checkpoint { cycle, state, last, dissipated, level, owed, .. } = &self.at;
        let (steps, events) = (cycle.steps.len(), cycle.events.len());
        let trunk = Trunk {
            state: state.clone(),
            last: *last,
            dissipated: *dissipated,
            level: *level,
            steps,
            events,
            owed: *owed,
        };
        self.at.trunk = Some(Box::new(trunk));
    }

    /// Returns to the loading path after the search for a load reversal.
    pub(crate) fn return_to_path(&mut self) {
        let Some(trunk) = self.at.trunk.take() else { return };
        (self.at.state, self.at.last, self.at.dissipated, self.at.level) =
            (trunk.state, trunk.last, trunk.dissipated, trunk.level);
        self.at.labels = label(self.problem, &self.at.state);
        self.rate = None;
    }

    /// Discards the steps of a search that has not found the load: the reversal is then the attempt `beyond`
    /// the jump of the load.
    fn reverse_beyond(&mut self, mut beyond: Attempt, max_load: f64) {
        let Some(trunk) = self.at.trunk.clone() else { return };
        let (steps, events, owed) = (trunk.steps, trunk.events, trunk.owed);
        self.return_to_path();
        self.at.trunk = Some(trunk);
        self.at.cycle.steps.truncate(steps);
        self.at.cycle.events.truncate(events);
        self.at.cycle.regions.retain(|(step, _)| *step < steps);
        self.at.owed = owed;
        beyond.step.converged &= self.exceeds_by_a_jump(beyond.step.totals.load, max_load);
        self.accept(beyond);
    }

    /// Advances by one step, which is halved where a jump of the load is not located, and ends at `max_load`
    /// if it would cross it. True if it ends there.
    pub(crate) fn advance_step(&mut self, sense: f64, max_load: Option<f64>) -> Result<bool, PhysicsError> {
        loop {
            let halvings = self.halvings();
            self.at.level = self.at.level.min(halvings);
            let length = sense * self.step_of_machine() / f64::from(1_u32 << self.at.level);
            let limit = self.settings.jump_tolerance * self.at.dissipated;
            let mut state = self.predict(self.at.state.mean_penetration + length)?;
            let outcome =
                self.relax(&mut state, self.settings.accuracy, &self.loads_within_tolerance(length, limit))?;
            if outcome.left {
                self.at.level += 1;
                continue;
            }
            let attempt = self.conclude(state, outcome)?;
            let hides = self.may_hide_pull_off(&attempt) || self.may_pass_pull_off(&attempt);
            if (attempt.across > limit || hides) && self.at.level < halvings {
                self.at.level += 1;
                continue;
            }
            if let Some(max_load) = max_load.filter(|most| attempt.step.totals.load > *most) {
                self.leave_path(max_load);
                match self.reach(max_load, attempt.step)? {
                    Some(found) => self.accept(found),
                    None if self.at.trunk.is_some() => self.reverse_beyond(attempt, max_load),
                    None => return Ok(false),
                }
                return Ok(true);
            }
            if attempt.across <= self.problem.numerics.steps.lengthening_error * limit {
                self.at.level = self.at.level.saturating_sub(1);
            }
            self.accept(attempt);
            return Ok(false);
        }
    }

    /// Step of the machine in which the contact moves by one step, as long as it is as stiff as between the
    /// last two states of the branch.
    fn step_of_machine(&self) -> f64 {
        let compliance = self.problem.machine_compliance;
        let [.., from, to] = self.at.cycle.steps.as_slice() else { return self.settings.step };
        if compliance == 0.0 || from.reversal != to.reversal {
            return self.settings.step;
        }
        let load = to.totals.load - from.totals.load;
        let contact = to.penetration() - from.penetration();
        let stiffness = if load * contact > 0.0 { load / contact } else { 0.0 };
        self.settings.step * (1.0 + compliance * stiffness)
    }

    /// Most halvings of the next step.
    fn halvings(&self) -> u32 {
        let is_spent = self.problem.attraction == Attraction::Range
            && self.at.cycle.steps.len() > self.problem.numerics.steps.halved_steps;
        if is_spent { 0 } else { self.settings.halvings }
    }

    /// Loads after a step of a length that need not be halved. Beyond them, the error of a jump exceeds the
    /// limit so far that the rest of the event does not matter, and the load has changed by more than its
    /// slope can do in this step; or it has jumped up from a maximum tension. All loads as long as nothing
    /// has been dissipated.
    fn loads_within_tolerance(&self, length: f64, limit: f64) -> Loads {
        if self.at.level == self.halvings() || limit == 0.0 {
            return ANY;
        }
        let from = self.at.last.totals.load;
        let expected = self.extrapolated_load(length);
        let room = (2.0 * self.problem.numerics.steps.early_end_error * limit / length.abs())
            .max((expected - from).abs());
        let most = if self.exceeds_max_tension(expected) { from } else { f64::INFINITY };
        expected - room..(expected + room).min(most)
    }

    /// True if the load of an unloading step has jumped up after it may have passed a tension larger than
    /// that of all steps so far.
    fn may_hide_pull_off(&self, attempt: &Attempt) -> bool {
        let (from, to) = (&self.at.last, &attempt.step);
        let before_jump = self.extrapolated_load(to.mean_penetration - from.mean_penetration);
        attempt.across > 0.0 && to.totals.load > from.totals.load && self.exceeds_max_tension(before_jump)
    }

    /// True if an unloading step may have passed a larger tension than that of all steps so far: by the cubic
    /// through loads and slopes at both ends (Hermite), or before an event by the slope at its beginning.
    ///
    /// This is for attraction of a range, under which the load is smooth up to an event. With bonds the slope
    /// diverges at a limit point.
    fn may_pass_pull_off(&self, attempt: &Attempt) -> bool {
        let (from, to) = (&self.at.last, &attempt.step);
        if self.problem.attraction != Attraction::Range || from.reversal.is_none() {
            return false;
        }
        let known = self
            .at
            .max_tension
            .as_ref()
            .map_or(0.0, |(known, ..)| *known)
            .min(from.totals.load)
            .min(to.totals.load);
        // An event after the maximum tension may look like a gain of energy, since the integral misses that.
        let has_event = to.imbalance.abs() > self.resolution(to.uncertainty);
        let least = if has_event {
            self.extrapolated_load(to.mean_penetration - from.mean_penetration)
        } else {
            least_between(on_loop(from), on_loop(to))
        };
        known < 0.0 && least < (1.0 + self.problem.numerics.steps.hidden_tension) * known
    }

    /// Load after a step of a length without an event, by the stiffness at its beginning \[E* dx²\].
    fn extrapolated_load(&self, length: f64) -> f64 {
        self.at.last.totals.load + self.at.last.stiffness * length
    }

    /// True if a load is a tension that exceeds that of all steps so far by more than a fraction.
    fn exceeds_max_tension(&self, load: f64) -> bool {
        self.at.max_tension.as_ref().is_some_and(|(known, ..)| {
            *known < 0.0 && load < (1.0 + self.problem.numerics.steps.hidden_tension) * known
        })
    }
}
