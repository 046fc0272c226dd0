//! One step of a cycle: an equilibrium at an approach near the one before, and the energy dissipated in between.
//!
//! Between events the states are a continuous curve on which `F = dΠ/dΔ`, so that `∫F dΔ − ΔΠ` vanishes; in an event the energy falls at one approach, by
//! the energy dissipated. The integral has errors of both signs. An event is therefore counted where the sum of `∫F dΔ − ΔΠ` since the last one exceeds its
//! uncertainty, and an apparent gain is subtracted from the next event. Gains alone must not lead to shorter steps: repeating what comes out too small makes
//! the sum too large.
//!
//! A step that dissipates more than [`LARGE`] of the energy dissipated so far is halved: [`Settings::halvings`] times, and further while the error of the
//! integral falls. So is one in which a jump of the load makes the integral uncertain by more than [`LOCATED`].

use super::contact::{Attraction, Problem, State};
use super::equilibrium::Equilibrium;
use super::minimise::Accuracy;
use super::newton::Rate;
use super::patch::Patches;
use super::records::{Cycle, Event, Map, Step};
use super::regions::{Labels, Region, change, label, regions};
use super::work::{OnLoop, Work, work_between};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use serde::{Deserialize, Serialize};

/// Least imbalance of an event, relative to the energy dissipated so far.
const EVENT: f64 = 1e-5;
/// Error of the integral of the load, relative to the part of it that comes from the slopes of the load.
const BEND: f64 = 0.05;
/// Imbalance from which on a step is halved, relative to the same.
const LARGE: f64 = 3e-3;
/// Part of the error that a jump of the load may cause in its integral that counts as its uncertainty.
const JUMP_PART: f64 = 0.3;
/// Largest of these errors in a step that is not halved, relative to the energy dissipated so far.
const LOCATED: f64 = 2e-2;
/// Most halvings of a step, as long as each reduces the error of the integral of the load.
const DEEPEST: u32 = 6;
/// Relative accuracy of the load at a reversal.
const LOAD_ACCURACY: f64 = 1e-5;
/// Tolerance of the equilibria in the search for that load, relative to that elsewhere.
const SHARPER: f64 = 0.02;
/// Most equilibria of a search.
const SEARCHED: u32 = 40;
/// Where the load jumps across that of a reversal: the bracket of the approach, in steps, at which the search ends, and the relative jump that counts as
/// reached.
const CLOSED: f64 = 1e-6;
const JUMP: f64 = 1e-3;

/// Settings of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Loads at which the path reverses \[E* dx²\], ascending.
    pub max_loads: Vec<f64>,
    /// Step of the approach \[dx\].
    pub step: f64,
    /// Maximum number of halvings of a step with a large event.
    pub halvings: u32,
    /// Accuracy of an equilibrium.
    pub accuracy: Accuracy,
    /// True if the regions of every step are kept; else those of the maps.
    pub all_regions: bool,
}

/// An unfinished cycle: all that is needed to continue in another process, to the same bytes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Halfway {
    pub(super) cycle: Cycle,
    /// Branches that are complete.
    pub(super) branches: usize,
    pub(super) state: State,
    pub(super) last: Step,
    /// Energy dissipated so far \[E* dx³\].
    pub(super) dissipated: f64,
    /// Halvings of the next step.
    pub(super) level: u32,
    /// Map and regions at the maximum tensile load of the branch so far.
    pub(super) tensest: Option<(f64, Map, Vec<Region>)>,
    /// Regions of contact of the state; computed again on resuming.
    #[serde(skip)]
    pub(super) labels: Labels,
}

impl Halfway {
    /// Steps so far.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        &self.cycle.steps
    }

    /// Regions of contact of the last step.
    #[must_use]
    pub fn labels(&self) -> &Labels {
        &self.labels
    }
}

/// An equilibrium that may become the next step.
pub(super) struct Attempt {
    state: State,
    pub(super) step: Step,
    /// Error of the integral of the load that a jump of it may cause.
    across: f64,
    rate: Rate,
}

/// An unfinished cycle with its problem and work space.
pub(super) struct Walk<'a> {
    pub(super) problem: &'a Problem,
    pub(super) settings: &'a Settings,
    equilibrium: Equilibrium,
    pub(super) at: Halfway,
    /// Rate of the state, once it has been needed.
    pub(super) rate: Option<Rate>,
}

impl<'a> Walk<'a> {
    /// A cycle from the beginning or from `halfway`.
    pub(super) fn begin(problem: &'a Problem, settings: &'a Settings, halfway: Option<Halfway>) -> Result<Self, PhysicsError> {
        let start = match problem.attraction {
            Attraction::Bonded { nucleation, .. } => -nucleation,
            Attraction::Range => -problem.law.end_gap(),
            Attraction::None => 0.0,
        };
        let mut at = match halfway {
            Some(halfway) => halfway,
            None => Halfway {
                cycle: Cycle::default(),
                branches: 0,
                state: State { pressure: Vec::new(), ..problem.apart(start)? },
                last: Step { approach: start, ..Step::default() },
                dissipated: 0.0,
                level: 0,
                tensest: None,
                labels: Labels::default(),
            },
        };
        at.labels = label(problem, &at.state);
        Ok(Self { problem, settings, equilibrium: Equilibrium::new(problem, Patches::new(problem)?)?, at, rate: None })
    }

    /// Regions of contact of the last state.
    pub(super) fn regions(&self) -> Vec<Region> {
        regions(self.problem, &self.at.state, &self.at.labels)
    }

    /// Equilibrium at an approach, from the last state extrapolated, with all contacts that form there.
    pub(super) fn attempt(&mut self, approach: f64, accuracy: Accuracy) -> Result<Attempt, PhysicsError> {
        let mut state = State { pressure: filled(self.problem.half_space.points(), 0.0)?, ..self.at.state.clone() };
        let rate = match self.rate.take() {
            Some(rate) => rate,
            None => self.equilibrium.rate(self.problem, &state)?,
        };
        let before = self.equilibrium.transformed();
        let length = approach - state.approach;
        for (to, rate) in state.displacement.iter_mut().zip(&rate.displacement) {
            *to += length * f64::from(*rate);
        }
        state.approach = approach;
        let mut iterations = 0;
        let outcome = loop {
            let outcome = self.equilibrium.find(self.problem, &mut state, accuracy)?;
            iterations += outcome.iterations as u64;
            if self.problem.update_bonds(&mut state, true).is_empty() {
                break outcome;
            }
        };
        let totals = self.problem.totals(&state);
        self.problem.settle_bonds(&mut state);
        let next = self.equilibrium.rate(self.problem, &state)?;
        let from = &self.at.last;
        let on = |step: &Step, rate: &Rate| OnLoop { approach: step.approach, load: step.totals.load, stiffness: rate.stiffness };
        let end = OnLoop { approach, load: totals.load, stiffness: next.stiffness };
        let Work { straight, bend, across } = work_between(on(from, &rate), end);
        let work = straight + bend;
        let change = totals.energy - from.totals.energy;
        self.rate = Some(rate);
        let step = Step {
            reversal: from.reversal,
            approach,
            totals,
            stiffness: next.stiffness,
            regions: 0,
            dissipated: 0.0,
            imbalance: work - change,
            uncertainty: BEND * bend.abs() + JUMP_PART * across,
            pending: from.pending + work - change,
            work: from.work + work,
            iterations,
            transforms: self.equilibrium.transforms(before),
            residual: outcome.residual,
            converged: outcome.converged,
        };
        Ok(Attempt { state, step, across, rate: next })
    }

    /// Imbalance up to which a step has no event, with the uncertainty of its integral \[E* dx³\].
    fn resolution(&self, uncertainty: f64) -> f64 {
        uncertainty.max(EVENT * self.at.dissipated)
    }

    pub(super) fn accept(&mut self, Attempt { state, mut step, rate, .. }: Attempt) {
        let labels = label(self.problem, &state);
        step.regions = labels.count;
        if step.pending > self.resolution(step.uncertainty) {
            step.dissipated = std::mem::take(&mut step.pending);
            self.at.dissipated += step.dissipated;
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

    /// Advances by one step, which is halved for a large event and ends at `max_load` if it would cross it. True if it ends there.
    pub(super) fn advance(&mut self, sense: f64, max_load: Option<f64>) -> Result<bool, PhysicsError> {
        let (mut iterations, mut transforms) = (0, 0);
        let mut coarser = f64::INFINITY;
        loop {
            let length = sense * self.settings.step / f64::from(1_u32 << self.at.level);
            let mut attempt = self.attempt(self.at.state.approach + length, self.settings.accuracy)?;
            let step = attempt.step;
            let large = step.imbalance.abs() > LARGE * self.at.dissipated;
            // The error of the integral falls by halving the step, an event does not.
            let falls = step.imbalance.abs() < 0.25 * coarser && self.at.level < DEEPEST;
            let unsure = attempt.across > LOCATED * self.at.dissipated && self.at.level < DEEPEST;
            if unsure || large && (self.at.level < self.settings.halvings || falls) {
                coarser = step.imbalance.abs();
                (iterations, transforms) = (iterations + step.iterations, transforms + step.transforms);
                self.at.level += 1;
                continue;
            }
            let across = max_load.filter(|most| step.totals.load > *most);
            if let Some(max_load) = across {
                (iterations, transforms) = (iterations + step.iterations, transforms + step.transforms);
                attempt = self.reach(max_load, step)?;
            } else {
                let small = step.imbalance.abs() < LARGE / 8.0 * self.at.dissipated;
                self.at.level = match (large, small) {
                    (true, _) => self.settings.halvings.min(1),
                    (false, true) => self.at.level.saturating_sub(1),
                    (false, false) => self.at.level,
                };
            }
            attempt.step.iterations += iterations;
            attempt.step.transforms += transforms;
            self.accept(attempt);
            return Ok(across.is_some());
        }
    }

    /// The equilibrium at `max_load` between the last state and a step beyond it, to the accuracy of the load or of the search.
    fn reach(&mut self, max_load: f64, beyond: Step) -> Result<Attempt, PhysicsError> {
        let (mut low, mut high) = ((self.at.last.approach, self.at.last.totals.load), (beyond.approach, beyond.totals.load));
        let (mut iterations, mut transforms) = (0, 0);
        let Accuracy { rms, largest, iterations: most } = self.settings.accuracy;
        let accuracy = Accuracy { rms: SHARPER * rms, largest: SHARPER * largest, iterations: most };
        let mut searched = 0_u32;
        loop {
            searched += 1;
            // The secant, and bisection where that does not help.
            let secant = ((max_load - low.1) / (high.1 - low.1)).clamp(0.02, 0.98);
            let part = if searched.is_multiple_of(3) { 0.5 } else { secant };
            let approach = low.0 + part * (high.0 - low.0);
            let mut attempt = self.attempt(approach, accuracy)?;
            let step = &mut attempt.step;
            (iterations, transforms) = (iterations + step.iterations, transforms + step.transforms);
            let load = step.totals.load;
            if load > max_load {
                high = (approach, load);
            } else {
                low = (approach, load);
            }
            let error = (load / max_load - 1.0).abs();
            let jumps = high.0 - low.0 < CLOSED * self.settings.step && error < JUMP;
            let reached = error < LOAD_ACCURACY || jumps;
            if reached || searched == SEARCHED {
                step.converged &= reached;
                (step.iterations, step.transforms) = (iterations, transforms);
                return Ok(attempt);
            }
        }
    }
}
