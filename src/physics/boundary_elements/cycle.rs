//! Loading and unloading under displacement control, with the energy dissipated in every step.
//!
//! A step is an equilibrium at an approach near the one before. Between events the states are a continuous curve on which `F = dΠ/dΔ`, so that
//! `∫F dΔ − ΔΠ` vanishes; in an event the energy falls at one approach, by the energy dissipated. A step that dissipates more than [`LARGE`] of the energy
//! dissipated so far is halved until the event is located.

use super::contact::{Attraction, Problem, State, Totals};
use super::minimise::{Accuracy, Minimiser};
use super::regions::{Change, Labels, Region, change, label, regions};
use super::work::{work_after, work_between};
use crate::physics::PhysicsError;
use serde::{Deserialize, Serialize};

/// Dissipated energy of an event, and of one that is located by halving the step, of the energy dissipated so far.
const EVENT: f64 = 3e-5;
const LARGE: f64 = 3e-3;
/// Halvings of a step at most, as long as they reduce the error of the integral of the load.
const DEEPEST: u32 = 5;
/// Relative accuracy of the load at a reversal, how much more exact than elsewhere the equilibria in its search are, and how many there are at most.
const LOAD_ACCURACY: f64 = 1e-5;
const SHARPER: f64 = 0.02;
const SEARCHED: u32 = 40;
/// Approach at which a load counts as not reached and, behind the origin, the surfaces as inseparable, in ranges of the heights.
const FARTHEST: f64 = 20.0;

/// Settings of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Loads at which the path reverses \[E* dx²\], ascending.
    pub max_loads: Vec<f64>,
    /// Step of the approach \[dx\].
    pub step: f64,
    /// How often a step with a large event is halved.
    pub halvings: u32,
    /// Accuracy of an equilibrium.
    pub accuracy: Accuracy,
    /// Whether the regions of every step are kept; else those of the maps.
    pub all_regions: bool,
}

/// An equilibrium on the path and the energy dissipated since the one before.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Step {
    /// Load reversal from which the step unloads; none while loading.
    pub reversal: Option<usize>,
    /// Approach Δ \[dx\].
    pub approach: f64,
    /// Load, energy and area.
    pub totals: Totals,
    /// Connected regions of contact.
    pub regions: usize,
    /// Energy dissipated in events since the step before \[E* dx³\]: `∫F dΔ − ΔΠ` if that exceeds the error of the integral.
    pub dissipated: f64,
    /// `∫F dΔ − ΔΠ` since the step before \[E* dx³\], its error included.
    pub imbalance: f64,
    /// Estimated error of that integral, a third of the difference of parabola and trapezoid \[E* dx³\]; 0 without an estimate, after an event.
    pub uncertainty: f64,
    /// Work since the branch began \[E* dx³\]: the change of the energy, and `∫F dΔ` over steps with an event.
    pub work: f64,
    /// Iterations and transforms, those of halved steps included.
    pub iterations: u64,
    /// Transforms of the grid; those of patches count by their points.
    pub transforms: u64,
    /// Root mean square of the residual, of the maximum tension.
    pub residual: f64,
    /// Whether the accuracy was reached.
    pub converged: bool,
}

/// A sudden change of the contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Number of the step at whose approach the event is over.
    pub step: usize,
    /// What happened to the region whose area changed most.
    pub kind: Change,
    /// State before and after.
    pub before: Totals,
    /// State after.
    pub after: Totals,
    /// Dissipated energy \[E* dx³\].
    pub dissipated: f64,
}

/// Gap and pressure at a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Number of the step.
    pub step: usize,
    /// Gap \[dx\].
    pub gap: Vec<f32>,
    /// Pressure, compression positive \[E*\].
    pub pressure: Vec<f32>,
}

/// A state at a load reversal, from which another process unloads to the same bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Turning {
    /// Number of its step.
    pub step: usize,
    /// The state.
    pub state: State,
    /// Its step.
    pub last: Step,
    /// Energy dissipated so far \[E* dx³\].
    pub dissipated: f64,
}

/// A cycle: every step, the events, regions and maps.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Steps; the number of a step is its place.
    pub steps: Vec<Step>,
    /// Events.
    pub events: Vec<Event>,
    /// Regions of the kept steps, with the number of the step.
    pub regions: Vec<(usize, Region)>,
    /// Maps at the load reversals and at the maximum tensile load of each unloading.
    pub maps: Vec<Map>,
    /// States at the load reversals.
    pub turning: Vec<Turning>,
}

impl Cycle {
    /// The load reversal at a step.
    #[must_use]
    pub fn reversal_at(&self, step: usize) -> Option<usize> {
        self.turning.iter().position(|turning| turning.step == step)
    }

    fn keep(&mut self, map: Map, found: Vec<Region>) {
        self.keep_regions(map.step, found);
        self.maps.push(map);
    }

    fn keep_regions(&mut self, step: usize, found: Vec<Region>) {
        self.regions.extend(found.into_iter().map(|region| (step, region)));
    }
}

/// An unfinished cycle: all that is needed to continue in another process, to the same bytes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Halfway {
    cycle: Cycle,
    /// Branches that are complete.
    branches: usize,
    state: State,
    /// The state one step before, if no event lies between.
    before: Option<Before>,
    last: Step,
    dissipated: f64,
    level: u32,
    /// Map and regions at the maximum tensile load of the branch so far.
    tensest: Option<(f64, Map, Vec<Region>)>,
    /// Contact of the state, from which it follows.
    #[serde(skip)]
    labels: Labels,
}

/// A state one step before.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Before {
    approach: f64,
    load: f64,
    displacement: Vec<f64>,
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

struct Walk<'a> {
    problem: &'a Problem,
    settings: &'a Settings,
    minimiser: Minimiser,
    at: Halfway,
}

/// Loads to the largest of the loads and unloads from each, from the beginning or from `halfway`. After each step `keep` is given what is needed to
/// continue from there, and `progress` the completed fraction.
///
/// # Errors
/// Not enough memory; a load that is not reached; full contact at a reversal.
pub fn run(
    problem: &Problem,
    settings: &Settings,
    halfway: Option<Halfway>,
    keep: &mut (dyn FnMut(&Halfway) + Send),
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Cycle, PhysicsError> {
    // On a thread of the pool, so that the short parallel loops are not waited for from outside.
    rayon::scope(|_| {
        let mut walk = Walk::begin(problem, settings, halfway)?;
        let branches = settings.max_loads.len() + 1;
        while walk.at.branches < branches {
            let done = walk.at.branches;
            if done == 0 {
                walk.load(keep, progress)?;
            } else {
                walk.unload(done - 1, keep, progress)?;
            }
            walk.at.branches += 1;
        }
        Ok(walk.at.cycle)
    })
}

/// Unloads from a state at a load reversal: the steps, events, regions and maps that [`run`] has from there, numbered from 0.
///
/// # Errors
/// Not enough memory.
pub fn unload_from(problem: &Problem, settings: &Settings, reversal: usize, turning: &Turning) -> Result<Cycle, PhysicsError> {
    rayon::scope(|_| {
        let mut walk = Walk::begin(problem, settings, None)?;
        walk.at.cycle = Cycle { turning: vec![turning.clone(); reversal + 1], ..Cycle::default() };
        walk.unload(reversal, &mut |_| {}, &|_| {})?;
        Ok(Cycle { turning: Vec::new(), ..walk.at.cycle })
    })
}

impl<'a> Walk<'a> {
    fn begin(problem: &'a Problem, settings: &'a Settings, halfway: Option<Halfway>) -> Result<Self, PhysicsError> {
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
                state: problem.apart(start)?,
                before: None,
                last: Step { approach: start, ..Step::default() },
                dissipated: 0.0,
                level: 0,
                tensest: None,
                labels: Labels::default(),
            },
        };
        at.labels = label(problem, &at.state);
        Ok(Self { problem, settings, minimiser: Minimiser::new(problem)?, at })
    }

    /// Loads to the largest of the loads.
    fn load(&mut self, keep: &mut dyn FnMut(&Halfway), progress: &dyn Fn(f64)) -> Result<(), PhysicsError> {
        if self.at.cycle.steps.is_empty() {
            let (state, step) = self.attempt(self.at.state.approach, self.settings.accuracy)?;
            self.accept(state, step);
        }
        let farthest = self.farthest();
        let last = self.settings.max_loads.last().copied().unwrap_or(0.0);
        while let Some(max_load) = self.settings.max_loads.get(self.at.cycle.turning.len()).copied() {
            let reached = self.advance(1.0, Some(max_load))?;
            let (load, approach) = (self.at.last.totals.load, self.at.last.approach);
            if reached {
                self.turn()?;
            } else if approach > farthest {
                return Err(PhysicsError::LoadNotReached { wanted: max_load, reached: load, approach_m: approach });
            }
            progress((0.5 * load / last).clamp(0.0, 0.5));
            keep(&self.at);
        }
        Ok(())
    }

    /// Approach beyond which no load is reached and, behind the origin, nothing holds \[dx\].
    fn farthest(&self) -> f64 {
        FARTHEST * self.problem.range()
    }

    /// Keeps the state at a load reversal.
    fn turn(&mut self) -> Result<(), PhysicsError> {
        let (points, contact) = (self.problem.half_space.points(), self.at.last.totals.contact);
        if contact == points && matches!(self.problem.attraction, Attraction::Bonded { .. }) {
            return Err(PhysicsError::Closed { approach_m: self.at.last.approach });
        }
        let step = self.at.cycle.steps.len() - 1;
        let (map, found) = self.landmark(step);
        self.at.cycle.keep(map, found);
        let (state, last, dissipated) = (self.at.state.clone(), self.at.last, self.at.dissipated);
        self.at.cycle.turning.push(Turning { step, state, last, dissipated });
        Ok(())
    }

    /// Unloads from a reversal to the last separation.
    fn unload(&mut self, reversal: usize, keep: &mut dyn FnMut(&Halfway), progress: &dyn Fn(f64)) -> Result<(), PhysicsError> {
        let begins = self.at.cycle.steps.last().is_none_or(|step| step.reversal != Some(reversal));
        let turning = &self.at.cycle.turning[reversal];
        let full = turning.last.totals.contact.max(1) as f64;
        if begins {
            self.at.state = turning.state.clone();
            self.at.last = Step { reversal: Some(reversal), work: 0.0, ..turning.last };
            self.at.dissipated = turning.dissipated;
            (self.at.before, self.at.level, self.at.tensest) = (None, 0, None);
            self.at.labels = label(self.problem, &self.at.state);
        }
        let branches = self.settings.max_loads.len() as f64;
        while !self.is_apart() {
            if self.at.state.approach < -self.farthest() {
                return Err(PhysicsError::Closed { approach_m: self.at.state.approach });
            }
            self.advance(-1.0, None)?;
            self.keep_tensest();
            progress(0.5 + 0.5 * (reversal as f64 + 1.0 - (self.at.last.totals.contact as f64 / full).min(1.0)) / branches);
            keep(&self.at);
        }
        if let Some((_, map, found)) = self.at.tensest.take() {
            self.at.cycle.keep(map, found);
        }
        Ok(())
    }

    /// Keeps the map at the maximum tensile load so far.
    fn keep_tensest(&mut self) {
        let load = self.at.last.totals.load;
        if self.at.tensest.as_ref().is_none_or(|(least, ..)| load < *least) {
            let step = self.at.cycle.steps.len() - 1;
            let (map, found) = self.landmark(step);
            self.at.tensest = Some((load, map, found));
        }
    }

    /// Map of the last step and its regions, if those of every step are not kept anyway.
    fn landmark(&self, step: usize) -> (Map, Vec<Region>) {
        (self.map(step), if self.settings.all_regions { Vec::new() } else { self.regions() })
    }

    fn regions(&self) -> Vec<Region> {
        regions(self.problem, &self.at.state, &self.at.labels)
    }

    fn map(&self, step: usize) -> Map {
        let state = &self.at.state;
        let gap = (0..self.problem.half_space.points()).map(|k| self.problem.gap(state, k) as f32).collect();
        let tension = |k| self.problem.bond(state.bonds[k], self.problem.gap(state, k)).tension;
        Map { step, gap, pressure: (0..self.problem.half_space.points()).map(|k| -tension(k) as f32).collect() }
    }

    fn is_apart(&self) -> bool {
        let range = self.problem.attraction == Attraction::Range;
        // Bonds end beyond the end of the law, where the load vanishes.
        let ended = if range { self.at.state.approach <= -self.problem.law.end_gap() } else { self.problem.is_free(&self.at.state) };
        self.at.last.totals.contact == 0 && ended
    }

    /// Equilibrium at an approach, from the last state extrapolated, with all contacts that form there.
    fn attempt(&mut self, approach: f64, accuracy: Accuracy) -> Result<(State, Step), PhysicsError> {
        let mut state = self.at.state.clone();
        if let Some(before) = &self.at.before {
            let ratio = (approach - state.approach) / (state.approach - before.approach);
            for (to, from) in state.displacement.iter_mut().zip(&before.displacement) {
                *to += ratio * (*to - from);
            }
        }
        state.approach = approach;
        let before = self.minimiser.transformed();
        let mut iterations = 0;
        let outcome = loop {
            let outcome = self.minimiser.equilibrium(self.problem, &mut state, accuracy)?;
            iterations += outcome.iterations as u64;
            if self.problem.update_bonds(&mut state, true).is_empty() {
                break outcome;
            }
        };
        let totals = self.problem.totals(&state);
        self.problem.settle_bonds(&mut state);
        let from = &self.at.last;
        let (start, end) = ((from.approach, from.totals.load), (approach, totals.load));
        let change = totals.energy - from.totals.energy;
        let quiet = self.at.before.as_ref().map(|before| work_after((before.approach, before.load), start, end));
        // Where the load jumps, the points before do not tell how it goes on.
        let uncertainty = quiet.map_or(0.0, |quiet| (quiet - work_between(start, end)).abs() / 3.0);
        let work = quiet.filter(|work| (work - change).abs() <= self.resolution(uncertainty)).unwrap_or_else(|| work_between(start, end));
        let step = Step {
            reversal: from.reversal,
            approach,
            totals,
            regions: 0,
            dissipated: 0.0,
            imbalance: work - change,
            uncertainty,
            work: from.work + work,
            iterations,
            transforms: self.minimiser.transforms(before),
            residual: outcome.residual,
            converged: outcome.converged,
        };
        Ok((state, step))
    }

    /// Imbalance up to which a step has no event, with the uncertainty of its integral \[E* dx³\].
    fn resolution(&self, uncertainty: f64) -> f64 {
        uncertainty.max(EVENT * self.at.dissipated)
    }

    fn accept(&mut self, state: State, mut step: Step) {
        let event = step.imbalance > self.resolution(step.uncertainty);
        let labels = label(self.problem, &state);
        step.regions = labels.count;
        // Without an event the work is the change of the energy, exactly; the load is integrated for comparison only.
        if !event {
            step.work = self.at.last.work + step.totals.energy - self.at.last.totals.energy;
        } else {
            step.dissipated = step.imbalance;
            self.at.dissipated += step.imbalance;
            self.at.cycle.events.push(Event {
                step: self.at.cycle.steps.len(),
                kind: change(&self.at.labels, &labels),
                before: self.at.last.totals,
                after: step.totals,
                dissipated: step.imbalance,
            });
        }
        self.at.labels = labels;
        let old = std::mem::replace(&mut self.at.state, state);
        let load = self.at.last.totals.load;
        let follows = !event && old.approach != self.at.state.approach;
        self.at.before = follows.then_some(Before { approach: old.approach, load, displacement: old.displacement });
        self.at.last = step;
        if self.settings.all_regions {
            let (step, found) = (self.at.cycle.steps.len(), self.regions());
            self.at.cycle.keep_regions(step, found);
        }
        self.at.cycle.steps.push(step);
    }

    /// One step along the path; one with a large event is halved, one across `max_load` ends there: whether it does.
    fn advance(&mut self, sense: f64, max_load: Option<f64>) -> Result<bool, PhysicsError> {
        let (mut iterations, mut transforms) = (0, 0);
        let mut coarser = f64::INFINITY;
        loop {
            let length = sense * self.settings.step / f64::from(1_u32 << self.at.level);
            let (mut state, mut step) = self.attempt(self.at.state.approach + length, self.settings.accuracy)?;
            let large = step.imbalance.abs() > LARGE * self.at.dissipated;
            // The error of the integral falls by halving the step, an event does not.
            let falls = step.imbalance.abs() < 0.25 * coarser && self.at.level < DEEPEST;
            if large && (self.at.level < self.settings.halvings || falls) {
                coarser = step.imbalance.abs();
                (iterations, transforms) = (iterations + step.iterations, transforms + step.transforms);
                self.at.level += 1;
                continue;
            }
            let across = max_load.filter(|most| step.totals.load > *most);
            if let Some(max_load) = across {
                (iterations, transforms) = (iterations + step.iterations, transforms + step.transforms);
                (state, step) = self.reach(max_load, step)?;
            } else {
                let small = step.imbalance.abs() < LARGE / 8.0 * self.at.dissipated;
                self.at.level = match (large, small) {
                    (true, _) => self.settings.halvings.min(1),
                    (false, true) => self.at.level.saturating_sub(1),
                    (false, false) => self.at.level,
                };
            }
            step.iterations += iterations;
            step.transforms += transforms;
            self.accept(state, step);
            return Ok(across.is_some());
        }
    }

    /// The equilibrium at `max_load` between the last state and a step beyond it, to the accuracy of the load or of the search.
    fn reach(&mut self, max_load: f64, beyond: Step) -> Result<(State, Step), PhysicsError> {
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
            let (state, mut step) = self.attempt(approach, accuracy)?;
            (iterations, transforms) = (iterations + step.iterations, transforms + step.transforms);
            let load = step.totals.load;
            let reached = (load / max_load - 1.0).abs() < LOAD_ACCURACY;
            if reached || searched == SEARCHED {
                step.converged &= reached;
                (step.iterations, step.transforms) = (iterations, transforms);
                return Ok((state, step));
            }
            if load > max_load { high = (approach, load) } else { low = (approach, load) }
        }
    }
}
