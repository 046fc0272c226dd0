//! Loading and unloading under displacement control, from checkpoint to checkpoint.

use super::Asperities;
use super::contact::{Problem, State};
use super::path::{EquilibriumPath, PathCheckpoint};
use super::recorder::{Recorder, StepReason};
use super::retrace::retrace;
use super::settings::{Cycle, Settings};
use crate::cycle::soundness::check_energy;
use crate::cycle::{Branch, BranchRun, Done, run_branches};
use crate::{LoopError, LoopPosition, PhysicsError};
use serde::{Deserialize, Serialize};
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

/// An unfinished cycle with its problem.
pub(super) struct AsperityRun<'a> {
    problem: &'a Problem,
    settings: &'a Settings,
    at: Checkpoint,
}

impl<'a> AsperityRun<'a> {
    /// A cycle from the beginning or from a checkpoint.
    pub(super) fn new(problem: &'a Problem, settings: &'a Settings, checkpoint: Option<Checkpoint>) -> Self {
        Self { problem, settings, at: checkpoint.unwrap_or_default() }
    }

    /// Follows all branches that are left. `keep` receives every new checkpoint, `progress` the position that
    /// is reached.
    ///
    /// # Errors
    /// If no load has a result: a load that is not reached within 100 rms heights, or a mean penetration
    /// without an equilibrium.
    pub(super) fn follow(
        mut self,
        keep: &mut dyn FnMut(&Checkpoint),
        progress: &dyn Fn(LoopPosition),
    ) -> Result<Cycle, PhysicsError> {
        let loads = self.settings.max_loads.len();
        let unreached = run_branches(&mut self, loads, &mut |run| keep(&run.at), progress)?;
        Ok(Cycle { unreached, ..self.at.cycle })
    }
}

impl BranchRun for AsperityRun<'_> {
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
        let (problem, settings, Checkpoint { cycle, leg, .. }) = (self.problem, self.settings, &mut self.at);
        let Some(k) = reversal else {
            let begun = leg.take().unwrap_or_else(|| Leg::loading(problem, settings));
            *leg = load(problem, settings, begun, cycle, &|at| {
                progress(LoopPosition { done: 0.5 * at.done, ..at });
            })?;
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

impl Asperities {
    /// Loads to the mean penetration `turn` \[m\], or to this displacement of a machine, and unloads from
    /// there, under displacement control alone.
    ///
    /// The load at the reversal may be tensile. `max_loads` of the settings is not used, and the unloading
    /// steps have none.
    ///
    /// # Errors
    /// A mean penetration without an equilibrium.
    pub fn run_to(&self, turn: f64) -> Result<Cycle, PhysicsError> {
        let (problem, settings, mut cycle) = (&self.problem, &self.settings, Cycle::default());
        let Leg { mut recorder, carried } = Leg::loading(problem, settings);
        travel(problem, carried, Some(turn), &mut |path| {
            recorder.grid_points(settings, path, &mut cycle)?;
            if path.state().mean_penetration_m < turn {
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
}

/// Unloads from a load reversal to the last separation, continuing after every checkpoint.
pub(super) fn unload_through(
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

impl Leg {
    /// Loading branch from a grid point before the first jump-in.
    fn loading(problem: &Problem, settings: &Settings) -> Self {
        let spacing = settings.grid(problem);
        let number = (problem.first_contact_m() / spacing).floor() - 1.0;
        let state = State::free(problem, number * spacing);
        Self {
            recorder: Recorder::new(Branch::Loading, None, number, 0),
            carried: PathCheckpoint::begin(problem, state, 1.0),
        }
    }

    /// Unloading branch from a state at a load reversal, which is sufficient.
    fn unloading(problem: &Problem, settings: &Settings, max_load: Option<f64>, state: State) -> Self {
        let number = -(state.mean_penetration_m / settings.grid(problem)).ceil();
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
    let from = carried.state.mean_penetration_m;
    let last = settings.max_loads.last().copied().unwrap_or(0.0);
    let left = travel(problem, carried, None, &mut |path| {
        while let Some(max_load) = settings.max_loads.get(cycle.turning.len()) {
            let Some(turning) = path.turning(*max_load * problem.load_unit_n())? else { break };
            recorder.turn(settings, path, Some(&turning), cycle)?;
        }
        let Some(max_load) = settings.max_loads.get(cycle.turning.len()) else { return Ok(Next::End) };
        recorder.grid_points(settings, path, cycle)?;
        let load_n = path.totals().load_n;
        let reached = load_n / problem.load_unit_n();
        let mean_penetration_m = problem.mean_penetration_m(path.state().mean_penetration_m, load_n);
        if mean_penetration_m > problem.farthest_m() {
            return Err(LoopError::LoadNotReached { wanted: *max_load, reached, mean_penetration_m }.into());
        }
        progress(LoopPosition {
            done: (reached / last).clamp(0.0, 1.0),
            steps: cycle.steps.len(),
            unloading: false,
            load: reached,
        });
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
    let from = carried.state.mean_penetration_m;
    let mut full = None;
    let left = travel(problem, carried, None, &mut |path| {
        let full = *full.get_or_insert(path.totals().area_m2);
        if problem.spring.holds_load {
            recorder.pull_off(settings, path, cycle)?;
        }
        recorder.grid_points(settings, path, cycle)?;
        let load = path.totals().load_n / problem.load_unit_n();
        progress(LoopPosition {
            done: 1.0 - path.totals().area_m2 / full,
            steps: cycle.steps.len(),
            unloading: true,
            load,
        });
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

/// Refuses a state whose contact area Σπa² exceeds the nominal area A0, or whose largest contact spans the
/// square.
///
/// The area of the union of the contacts is smaller than that sum. `load_before_n` is the load \[N\] of the
/// increment before, for the error: that of the refused state is meaningless.
///
/// # Errors
/// [`LoopError::ExcessArea`].
fn check_area(path: &EquilibriumPath, load_before_n: f64) -> Result<(), LoopError> {
    let side = path.problem().length_m;
    let share = path.totals().area_m2 / (side * side);
    // NaN is refused as well.
    if share <= 1.0 && path.state().largest_radius() < 0.5 * side {
        return Ok(());
    }
    // Not −0.
    Err(LoopError::ExcessArea {
        mean_penetration_m: path.state().mean_penetration_m + 0.0,
        share,
        load_before_n,
    })
}
