//! Loading–unloading cycles: one loading path, and an unloading path from every load reversal.
//!
//! The loop begins before the first jump-in and ends with the last separation.
//! Its area is therefore the total dissipated energy `Θ = ∮F dΔ`.

mod branches;
mod constants;
mod method;
mod record;
mod recorder;
mod reversal;
pub mod soundness;

use crate::contact::problem::Problem;
use crate::contact::state::State;
use crate::path::{EquilibriumPath, PathCheckpoint, is_multiple};
use crate::{LoopError, LoopPosition, PhysicsError};
pub(crate) use branches::{BranchRun, Done, run_branches};
pub(super) use constants::CONSTANTS;
pub use method::Method;
pub use record::{Branch, Contact, Cycle, Event, Map, MergedAt, RegionShape, Settings, Site, Step, StepCounts, StepNumerics};
use recorder::{Recorder, StepReason};
use reversal::retrace;
use serde::{Deserialize, Serialize};
use soundness::{check_area, check_energy};
use std::sync::Arc;

/// Branch in progress.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Leg {
    recorder: Recorder,
    carried: PathCheckpoint,
}

/// Checkpoint of a cycle, sufficient to continue in another process with identical results.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Checkpoint {
    cycle: Cycle,
    done: Done,
    leg: Option<Leg>,
}

/// Loads to the largest of the loads, and unloads from each.
///
/// `progress` receives the position that is reached. Loads that are not reached, and those whose unloading fails, are listed in the cycle.
///
/// # Errors
/// If no load has a result: a load that is not reached within 100 rms heights, or a mean penetration without an equilibrium.
pub fn run(problem: &Problem, settings: &Settings, progress: &dyn Fn(LoopPosition)) -> Result<Cycle, PhysicsError> {
    run_from(problem, settings, None, &mut |_| {}, progress)
}

/// Continues [`run`] from a checkpoint.
///
/// `keep` receives every new checkpoint.
///
/// # Errors
/// If no load has a result: a load that is not reached within 100 rms heights, or a mean penetration without an equilibrium.
pub fn run_from(
    problem: &Problem,
    settings: &Settings,
    checkpoint: Option<Checkpoint>,
    keep: &mut dyn FnMut(&Checkpoint),
    progress: &dyn Fn(LoopPosition),
) -> Result<Cycle, PhysicsError> {
    let mut run = AsperityRun { problem, settings, at: checkpoint.unwrap_or_default() };
    let unreached = run_branches(&mut run, settings.max_loads.len(), &mut |run| keep(&run.at), progress)?;
    Ok(Cycle { unreached, ..run.at.cycle })
}

/// An unfinished cycle with its problem.
struct AsperityRun<'a> {
    problem: &'a Problem,
    settings: &'a Settings,
    at: Checkpoint,
}

impl BranchRun for AsperityRun<'_> {
    fn done(&mut self) -> &mut Done {
        &mut self.at.done
    }

    fn reversals(&self) -> usize {
        self.at.cycle.turning.len()
    }

    fn advance(&mut self, reversal: Option<usize>, progress: &dyn Fn(LoopPosition)) -> Result<bool, PhysicsError> {
        let (problem, settings, Checkpoint { cycle, leg, .. }) = (self.problem, self.settings, &mut self.at);
        let Some(k) = reversal else {
            let begun = leg.take().unwrap_or_else(|| Leg::loading(problem, settings));
            *leg = load(problem, settings, begun, cycle, &|at| progress(LoopPosition { done: 0.5 * at.done, ..at }))?;
            return Ok(leg.is_none());
        };
        let (max_load, all) = (settings.max_loads[k], settings.max_loads.len());
        if problem.is_adhesionless() {
            retrace(cycle, k, Some(max_load), settings.contacts);
            return Ok(true);
        }
        let state = || cycle.turning[k].1.clone();
        let begun = leg.take().unwrap_or_else(|| Leg::unloading(problem, settings, Some(max_load), state()));
        *leg = unload(problem, settings, begun, cycle, &|at| {
            progress(LoopPosition { done: 0.5 + 0.5 * (k as f64 + at.done) / all as f64, ..at });
        })?;
        Ok(leg.is_none())
    }

    fn check(&self, reversal: usize) -> Result<(), LoopError> {
        check_energy(&self.at.cycle, reversal)
    }

    fn forget(&mut self, reversal: usize) {
        self.at.cycle.remove_unloading(self.settings.max_loads[reversal]);
    }
}

/// Unloads from a stored state at a load reversal, where `max_load` is its `F/(E* A0)`.
///
/// The steps are identical to those of [`run`] from there.
///
/// # Errors
/// A mean penetration without an equilibrium.
pub fn unload_from(problem: &Problem, settings: &Settings, max_load: f64, state: State) -> Result<Cycle, PhysicsError> {
    let mut cycle = Cycle::default();
    if problem.is_adhesionless() {
        // The state at the reversal does not hold the loading path, which the unloading repeats.
        let settings = Settings { max_loads: vec![max_load], ..settings.clone() };
        return Ok(run(problem, &settings, &|_| {})?.unloading_alone());
    }
    unload_through(problem, settings, Some(max_load), state, &mut cycle)?;
    Ok(cycle)
}

/// Loads to the mean penetration `turn` \[m\] and unloads from there, under displacement control alone.
///
/// The load at the reversal may be tensile. `max_loads` of the settings is not used, and the unloading steps have none.
///
/// # Errors
/// A mean penetration without an equilibrium.
pub fn run_to(problem: &Problem, settings: &Settings, turn: f64) -> Result<Cycle, PhysicsError> {
    let mut cycle = Cycle::default();
    let Leg { mut recorder, carried } = Leg::loading(problem, settings);
    travel(problem, carried, Some(turn), &mut |path| {
        recorder.grid_points(settings, path, &mut cycle)?;
        if path.state().approach_m < turn {
            return Ok(Next::On);
        }
        recorder.turn(settings, path, None, &mut cycle)?;
        Ok(Next::End)
    })?;
    if problem.is_adhesionless() {
        retrace(&mut cycle, 0, None, settings.contacts);
        return Ok(cycle);
    }
    let state = cycle.turning[0].1.clone();
    unload_through(problem, settings, None, state, &mut cycle)?;
    Ok(cycle)
}

/// Unloads from a load reversal to the last separation, continuing after every checkpoint.
fn unload_through(
    problem: &Problem,
    settings: &Settings,
    max_load: Option<f64>,
    state: State,
    cycle: &mut Cycle,
) -> Result<(), PhysicsError> {
    let mut leg = Some(Leg::unloading(problem, settings, max_load, state));
    while let Some(rests) = leg {
        leg = unload(problem, settings, rests, cycle, &|_| {})?;
    }
    Ok(())
}

impl Settings {
    /// Spacing of the grid of mean penetrations \[m\], common to both senses and all load reversals.
    pub(crate) fn grid(&self, problem: &Problem) -> f64 {
        self.approach_step * problem.rms_height_m
    }

    /// True if the path has reached a checkpoint position other than `from` \[m\].
    fn rests(&self, path: &EquilibriumPath, from: f64) -> bool {
        let at = path.state().approach_m;
        self.rest_every.is_some_and(|every| path.is_exact() && at != from && is_multiple(at, every * path.problem().rms_height_m))
    }
}

impl Leg {
    /// Loading branch from a grid point before the first jump-in.
    fn loading(problem: &Problem, settings: &Settings) -> Self {
        let spacing = settings.grid(problem);
        let number = (problem.first_contact_m() / spacing).floor() - 1.0;
        let state = State::free(problem, number * spacing);
        Self { recorder: Recorder::new(Branch::Loading, None, number, 0), carried: PathCheckpoint::begin(problem, state, 1.0) }
    }

    /// Unloading branch from a state at a load reversal, which is sufficient.
    fn unloading(problem: &Problem, settings: &Settings, max_load: Option<f64>, state: State) -> Self {
        let number = -(state.approach_m / settings.grid(problem)).ceil();
        let recorder = Recorder::new(Branch::Unloading, max_load, number, state.merged.len());
        Self { recorder, carried: PathCheckpoint::begin(problem, state, -1.0) }
    }
}

/// Loads to the next checkpoint, or to the largest load and returns `None`.
fn load(
    problem: &Problem,
    settings: &Settings,
    leg: Leg,
    cycle: &mut Cycle,
    progress: &dyn Fn(LoopPosition),
) -> Result<Option<Leg>, PhysicsError> {
    let Leg { mut recorder, carried } = leg;
    let from = carried.state.approach_m;
    let last = settings.max_loads.last().copied().unwrap_or(0.0);
    let left = travel(problem, carried, None, &mut |path| {
        while let Some(max_load) = settings.max_loads.get(cycle.turning.len()) {
            let Some(turning) = path.turning(*max_load * problem.load_unit_n())? else { break };
            recorder.turn(settings, path, Some(&turning), cycle)?;
        }
        let Some(max_load) = settings.max_loads.get(cycle.turning.len()) else { return Ok(Next::End) };
        recorder.grid_points(settings, path, cycle)?;
        let (reached, approach_m) = (path.totals().load_n / problem.load_unit_n(), path.state().approach_m);
        if approach_m > 100.0 * problem.rms_height_m {
            return Err(LoopError::LoadNotReached { wanted: *max_load, reached, approach_m }.into());
        }
        progress(LoopPosition { done: (reached / last).clamp(0.0, 1.0), steps: cycle.steps.len(), unloading: false, load: reached });
        Ok(if settings.rests(path, from) { Next::Rest } else { Next::On })
    })?;
    Ok(left.map(|carried| Leg { recorder, carried }))
}

/// Unloads to the next checkpoint, or to the last separation and returns `None`.
fn unload(
    problem: &Problem,
    settings: &Settings,
    leg: Leg,
    cycle: &mut Cycle,
    progress: &dyn Fn(LoopPosition),
) -> Result<Option<Leg>, PhysicsError> {
    let Leg { mut recorder, carried } = leg;
    let from = carried.state.approach_m;
    let mut full = None;
    let left = travel(problem, carried, None, &mut |path| {
        let full = *full.get_or_insert(path.totals().area_m2);
        recorder.grid_points(settings, path, cycle)?;
        let load = path.totals().load_n / problem.load_unit_n();
        progress(LoopPosition { done: 1.0 - path.totals().area_m2 / full, steps: cycle.steps.len(), unloading: true, load });
        if path.state().contacts.is_empty() {
            if recorder.lacks_events(path) {
                // The last spot has left contact between two grid points.
                recorder.record(settings, path, None, cycle, StepReason::GridPoint);
            }
            return Ok(Next::End);
        }
        Ok(if settings.rests(path, from) { Next::Rest } else { Next::On })
    })?;
    match left {
        Some(carried) => Ok(Some(Leg { recorder, carried })),
        None => {
            recorder.end(cycle);
            Ok(None)
        }
    }
}

/// Action after a visit of the path.
enum Next {
    On,
    /// Stop at a checkpoint and resume from it.
    Rest,
    End,
}

/// Follows a branch from a checkpoint, at most to `bound` \[m\].
///
/// `visit` is called with the path at the beginning and after every increment.
/// It returns the next action. The checkpoint is returned if the action is [`Next::Rest`].
fn travel(
    problem: &Problem,
    mut carried: PathCheckpoint,
    bound: Option<f64>,
    visit: &mut dyn FnMut(&mut EquilibriumPath) -> Result<Next, PhysicsError>,
) -> Result<Option<PathCheckpoint>, PhysicsError> {
    let grown = problem.grown(&carried.state, carried.heights.take())?;
    let mut path = EquilibriumPath::resume(Arc::new(grown), carried)?;
    loop {
        match visit(&mut path)? {
            Next::On => {}
            Next::Rest => return Ok(Some(path.into_checkpoint())),
            Next::End => return Ok(None),
        }
        let before = path.totals().load_n;
        path.step(bound)?;
        check_area(&path, before)?;
    }
}
