//! Loading and unloading under displacement control, by [steps](super::step) from first contact to the last
//! separation.

pub use super::records::{Cycle, Event, Map, Step, Turning};
use super::stations::{MAX_MAP_SIDE, of_loading, of_unloading};
use super::step::CycleRun;
pub use super::step::{Checkpoint, Settings};
use crate::cycle::soundness::LoopEnergy;
use crate::cycle::{BranchRun, Done, run_branches};
use crate::elements::events::regions::{Region, label};
use crate::elements::problem::{Attraction, Problem};
use crate::{LoopError, LoopPosition, PhysicsError};

/// Loads to the largest of the loads and unloads from each, from the beginning or from a checkpoint. After
/// each step `keep` is given what is needed to continue from there, and `progress` the position.
///
/// # Errors
/// Not enough memory; and if no load reversal has a result: a load that is not reached, full contact that
/// does not open, surfaces that do not separate, steps that do not resolve the dissipated energy.
pub fn run(
    problem: &Problem,
    settings: &Settings,
    checkpoint: Option<Checkpoint>,
    keep: &mut (dyn FnMut(&Checkpoint) + Send),
    progress: &(dyn Fn(LoopPosition) + Sync),
) -> Result<Cycle, PhysicsError> {
    // On a thread of the pool, so that the short parallel loops are not waited for from outside.
    rayon::scope(|_| {
        let mut run = CycleRun::new(problem, settings, checkpoint)?;
        let unreached = run_branches(&mut run, settings.max_loads.len(), &mut |run| keep(&run.at), progress)?;
        Ok(Cycle { unreached, ..run.at.cycle })
    })
}

/// Unloads from a state at a load reversal: the steps, events, regions and maps that [`run`] has from there,
/// numbered from 0, with that state as all load reversals.
///
/// # Errors
/// Not enough memory; surfaces that do not separate.
pub fn unload_from(
    problem: &Problem,
    settings: &Settings,
    reversal: usize,
    turning: &Turning,
) -> Result<Cycle, PhysicsError> {
    let count = settings.max_loads.len();
    if reversal >= count {
        return Err(PhysicsError::UnknownReversal { reversal, count });
    }
    rayon::scope(|_| {
        let mut run = CycleRun::new(problem, settings, None)?;
        run.at.cycle = Cycle { turning: vec![turning.clone(); reversal + 1], ..Cycle::default() };
        while !run.advance(Some(reversal), &|_| {})? {}
        Ok(run.at.cycle)
    })
}

impl BranchRun for CycleRun<'_> {
    fn done(&mut self) -> &mut Done {
        &mut self.at.done
    }

    fn reversals(&self) -> usize {
        self.at.cycle.turning.len()
    }

    fn advance(
        &mut self,
        reversal: Option<usize>,
        progress: &dyn Fn(LoopPosition),
    ) -> Result<bool, PhysicsError> {
        match reversal {
            None => self.load(progress),
            Some(reversal) => self.unload(reversal, progress),
        }
    }

    /// By the limits of the asperity model: the steps of such a loop are too long.
    fn check(&self, reversal: usize) -> Result<(), LoopError> {
        let cycle = &self.at.cycle;
        let energies = |step: &Step| (step.work, step.dissipated);
        let back = cycle.steps.iter().rev().filter(|step| step.reversal == Some(reversal));
        let energy = LoopEnergy::of(
            cycle.steps[..=cycle.turning[reversal].step].iter().map(energies),
            back.map(energies),
        );
        let LoopEnergy { loss_j, events_j, work_j } = energy;
        let max_load = self.settings.max_loads[reversal];
        if energy.is_sound() {
            Ok(())
        } else {
            Err(LoopError::UnresolvedLoop { max_load, loss_j, events_j, work_j })
        }
    }

    fn forget(&mut self, reversal: usize) {
        self.at.cycle.remove_unloading(reversal);
        self.at.max_tension = None;
    }
}

impl CycleRun<'_> {
    /// Loads by one step; true at the largest of the loads.
    fn load(&mut self, progress: &dyn Fn(LoopPosition)) -> Result<bool, PhysicsError> {
        if self.at.cycle.steps.is_empty() {
            let first = self.attempt(self.at.state.mean_penetration, self.settings.accuracy)?;
            self.accept(first);
            progress(self.position(0.0));
            return Ok(false);
        }
        let last = self.settings.max_loads.last().copied().unwrap_or(0.0);
        let Some(wanted) = self.settings.max_loads.get(self.at.cycle.turning.len()).copied() else {
            return Ok(true);
        };
        self.return_to_path();
        let is_reached = self.advance_step(1.0, Some(wanted))?;
        let (reached, mean_penetration_m) = (self.at.last.totals.load, self.at.last.penetration());
        if is_reached {
            if self.is_closed() {
                return Err(LoopError::Closed { mean_penetration_m }.into());
            }
            self.turn();
        } else {
            self.keep_between();
            if mean_penetration_m > self.farthest() {
                return Err(LoopError::LoadNotReached { wanted, reached, mean_penetration_m }.into());
            }
        }
        // Adhesion pulls first: the load falls before it rises.
        let lowest = self.at.cycle.steps.iter().map(|step| step.totals.load).fold(0.0, f64::min);
        progress(self.position((0.5 * (reached - lowest) / (last - lowest)).clamp(0.0, 0.5)));
        Ok(false)
    }

    /// Position on the loop, of which a fraction is done.
    fn position(&self, done: f64) -> LoopPosition {
        let load = self.at.last.totals.load / self.problem.half_space.points() as f64;
        LoopPosition {
            done,
            steps: self.at.cycle.steps.len(),
            unloading: self.at.last.reversal.is_some(),
            load,
        }
    }

    /// Magnitude of the mean penetration beyond which the search for a load or for the last separation ends
    /// \[dx\]: attraction of a range begins and ends at the end of its law.
    fn farthest(&self) -> f64 {
        let acts =
            if self.problem.attraction == Attraction::Range { self.problem.law.end_gap() } else { 0.0 };
        self.problem.numerics.steps.farthest * self.problem.range() + 2.0 * acts
    }

    /// True in full contact.
    fn is_full(&self) -> bool {
        self.at.last.totals.contact == self.problem.half_space.points()
    }

    /// True in full contact that does not open, since contact opens at edges only.
    fn is_closed(&self) -> bool {
        self.is_full()
            && matches!(self.problem.attraction, Attraction::Bonded { strength: f64::INFINITY, .. })
    }

    /// Load of full contact at which the largest tension is the strength \[E* dx²\]; none elsewhere, and
    /// where the law alone decides.
    ///
    /// In full contact the mean gap is constant and tension is added uniformly, until a nucleus opens at the
    /// place of the largest tension. The grid resolves a nucleus from its own strength on only, so that the
    /// load before is computed here and is no equilibrium on it.
    fn opening_load(&self) -> Option<f64> {
        let Attraction::Bonded { strength, .. } = self.problem.attraction else { return None };
        if !self.is_full() || strength <= 0.0 || strength.is_infinite() {
            return None;
        }
        let points = self.problem.half_space.points();
        let tension = |k: usize| self.problem.tension(&self.at.state, k);
        let largest = (0..points).map(tension).fold(f64::NEG_INFINITY, f64::max);
        Some(self.at.last.totals.load - points as f64 * (strength - largest).max(0.0))
    }

    /// Keeps the state at a load reversal.
    fn turn(&mut self) {
        let step = self.at.cycle.steps.len() - 1;
        let (map, found) = self.landmark(step);
        self.at.cycle.keep(map, found);
        let (state, last, dissipated) = (self.at.state.clone(), self.at.last, self.at.dissipated);
        self.at.cycle.turning.push(Turning { step, state, last, dissipated });
    }

    /// Unloads from a reversal by one step; true at the last separation.
    fn unload(&mut self, reversal: usize, progress: &dyn Fn(LoopPosition)) -> Result<bool, PhysicsError> {
        let full = self.at.cycle.turning[reversal].last.totals.contact.max(1) as f64;
        if self.at.cycle.steps.last().is_none_or(|step| step.reversal != Some(reversal)) {
            self.begin_unloading(reversal);
        }
        if self.is_apart() {
            if let Some((_, map, found)) = self.at.max_tension.take() {
                self.at.cycle.keep(map, found);
            }
            return Ok(true);
        }
        let mean_penetration_m = self.at.last.penetration();
        if mean_penetration_m < -self.farthest() {
            return Err(LoopError::Inseparable { mean_penetration_m }.into());
        }
        self.advance_step(-1.0, None)?;
        self.keep_max_tension();
        self.keep_between();
        let branches = self.settings.max_loads.len() as f64;
        let done = 0.5
            + 0.5 * (reversal as f64 + 1.0 - (self.at.last.totals.contact as f64 / full).min(1.0)) / branches;
        progress(self.position(done));
        Ok(false)
    }

    /// Returns to the state at a reversal.
    fn begin_unloading(&mut self, reversal: usize) {
        let turning = &self.at.cycle.turning[reversal];
        self.at.state = turning.state.clone();
        self.at.last = Step { reversal: Some(reversal), work: 0.0, ..turning.last };
        // A search for a load that was not reached may have left a debt.
        (self.at.dissipated, self.at.owed) = (turning.dissipated, 0.0);
        (self.rate, self.at.level, self.at.max_tension, self.at.trunk) = (None, 0, None, None);
        self.at.labels = label(self.problem, &self.at.state);
        let next = self.at.cycle.steps.len();
        self.at.cycle.least_loads.extend(self.opening_load().map(|load| (next, load)));
    }

    /// Keeps the map at the maximum tensile load so far.
    fn keep_max_tension(&mut self) {
        let load = self.at.last.totals.load;
        if self.at.max_tension.as_ref().is_none_or(|(least, ..)| load < *least) {
            let step = self.at.cycle.steps.len() - 1;
            let (map, found) = self.landmark(step);
            self.at.max_tension = Some((load, map, found));
        }
    }

    /// Keeps the map of the last step where it is the first to pass a [station](super::stations).
    fn keep_between(&mut self) {
        let (cycle, loads) = (&self.at.cycle, &self.settings.max_loads);
        let Some(last) = cycle.steps.last().filter(|step| step.totals.contact > 0) else { return };
        let is_first = match last.reversal {
            None => {
                let passed = |step: &Step| of_loading(step.totals.load, loads.last().copied().unwrap_or(0.0));
                let kept = cycle
                    .between
                    .iter()
                    .map(|map| &cycle.steps[map.step])
                    .filter(|step| step.reversal.is_none())
                    .map(passed);
                passed(last) > kept.max().unwrap_or(0)
            }
            Some(reversal) => {
                let branch = cycle.steps.iter().filter(|step| step.reversal == Some(reversal));
                let passed = of_unloading(branch, loads.get(reversal).copied().unwrap_or(0.0));
                let before = passed.len().checked_sub(2).map_or(0, |k| passed[k]);
                passed.last().is_some_and(|now| *now > before)
            }
        };
        if is_first {
            let half_space = &self.problem.half_space;
            let stride = half_space.rows().max(half_space.columns()).div_ceil(MAX_MAP_SIDE);
            let map = self.map(cycle.steps.len() - 1, stride);
            self.at.cycle.between.push(map);
        }
    }

    /// Map of the last step and its regions, if those of every step are not kept anyway.
    fn landmark(&self, step: usize) -> (Map, Vec<Region>) {
        (self.map(step, 1), if self.settings.all_regions { Vec::new() } else { self.regions() })
    }

    /// Map of every `stride`-th point along both sides.
    fn map(&self, step: usize, stride: usize) -> Map {
        let (state, half_space) = (&self.at.state, &self.problem.half_space);
        let (rows, columns) = (half_space.rows(), half_space.columns());
        let points = || {
            (0..rows).step_by(stride).flat_map(|i| (0..columns).step_by(stride).map(move |j| i * columns + j))
        };
        let gap = points().map(|k| self.problem.true_gap(state, k) as f32).collect();
        let pressure = points().map(|k| -self.problem.tension(state, k) as f32).collect();
        Map { step, stride, gap, pressure }
    }

    fn is_apart(&self) -> bool {
        let range = self.problem.attraction == Attraction::Range;
        // Bonds end beyond the end of the law, where the load vanishes.
        let ended = if range {
            self.at.state.mean_penetration <= -self.problem.law.end_gap()
        } else {
            self.problem.is_free(&self.at.state)
        };
        self.at.last.totals.contact == 0 && ended
    }
}
