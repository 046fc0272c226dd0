//! Loading and unloading under displacement control, by [steps](super::step) from first contact to the last separation.

use super::contact::{Attraction, Problem};
pub use super::records::{Cycle, Event, Map, Step, Turning};
use super::regions::{Region, label};
use super::step::Walk;
pub use super::step::{Halfway, Settings};
use crate::physics::PhysicsError;

/// Magnitude of the approach, in ranges of the heights, beyond which a load counts as not reached and, at negative approach, the surfaces as inseparable.
pub(super) const FARTHEST: f64 = 20.0;

/// Loads to the largest of the loads and unloads from each, from the beginning or from `halfway`. After each step `keep` is given what is needed to
/// continue from there, and `progress` the completed fraction.
///
/// # Errors
/// Not enough memory; a load that is not reached; full contact at a reversal; surfaces that do not separate.
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
/// Not enough memory; surfaces that do not separate.
pub fn unload_from(problem: &Problem, settings: &Settings, reversal: usize, turning: &Turning) -> Result<Cycle, PhysicsError> {
    rayon::scope(|_| {
        let mut walk = Walk::begin(problem, settings, None)?;
        walk.at.cycle = Cycle { turning: vec![turning.clone(); reversal + 1], ..Cycle::default() };
        walk.unload(reversal, &mut |_| {}, &|_| {})?;
        Ok(Cycle { turning: Vec::new(), ..walk.at.cycle })
    })
}

impl Walk<'_> {
    /// Loads to the largest of the loads.
    fn load(&mut self, keep: &mut dyn FnMut(&Halfway), progress: &dyn Fn(f64)) -> Result<(), PhysicsError> {
        if self.at.cycle.steps.is_empty() {
            let first = self.attempt(self.at.state.approach, self.settings.accuracy)?;
            self.accept(first);
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

    /// Magnitude of the approach beyond which the search for a load or for the last separation ends \[dx\]: attraction of a range begins and ends at the
    /// end of its law.
    fn farthest(&self) -> f64 {
        let acts = if self.problem.attraction == Attraction::Range { self.problem.law.end_gap() } else { 0.0 };
        FARTHEST * self.problem.range() + 2.0 * acts
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
            (self.rate, self.at.level, self.at.tensest) = (None, 0, None);
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
}
