//! Runs the tasks of one stage.

use super::done::{Clock, Outcome};
use super::error::incomplete;
use super::{StageError, Tally, Task, Watch, failure};
use crate::campaign::{Campaign, CycleUnit, Stage, Standing, Unit};
use crate::store::Check;
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::cmp::Reverse;

/// Run of a selection of tasks.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    pub(super) campaign: &'a Campaign,
    pub(super) task: &'a Task,
    pub(super) watch: &'a dyn Watch,
}

/// A stage with one task for each surface or cycle.
pub(super) trait Tasks: Sync {
    /// Surface or cycle of a task.
    type Of: Sync;

    /// The stage.
    const STAGE: Stage;

    /// The selected surfaces or cycles.
    fn selected(&self) -> Vec<&Self::Of>;

    /// Identity of a task.
    fn unit<'a>(&self, of: &'a Self::Of) -> Unit<'a>;

    /// Key inputs of a task and of the tasks that it depends on.
    fn key_inputs(&self, of: &Self::Of) -> Map<String, Value>;

    /// Status of a task.
    fn standing(&self, of: &Self::Of) -> Standing;

    /// True if a task that failed before, or at an earlier stage, is not tried.
    fn is_given_up(&self, of: &Self::Of, standing: &Standing) -> bool;

    /// Name and status of the input that an earlier stage writes.
    fn input(&self, of: &Self::Of) -> Option<(String, Standing)>;

    /// Rank of the duration of a task: the longest are started first, so that all threads end together.
    fn duration_rank(&self, _of: &Self::Of) -> (bool, u32) {
        (false, 0)
    }

    /// Computes a task and writes its files.
    ///
    /// # Errors
    /// Any error of the stage.
    fn compute(&self, of: &Self::Of) -> Result<Outcome, StageError>;

    /// Cycles that need a task.
    fn cycles<'a>(&'a self, of: &'a Self::Of) -> Vec<&'a CycleUnit>;

    /// Removes the files that a finished task makes obsolete.
    fn clean_up(&self, of: &Self::Of);
}

/// Computes the tasks of a stage that are not done, in parallel. Tasks that fail by an error of their own are
/// recorded and counted; another error ends the stage when all tasks have been tried.
pub(super) fn run_stage<T: Tasks>(tasks: &T, context: Context<'_>) -> Result<Tally, StageError> {
    let selected = tasks.selected();
    let planned = selected.len();
    let mut due = due(tasks, selected, context.watch);
    let all_due = due.len();
    due.retain(|(of, standing)| !tasks.is_given_up(of, standing));
    let given_up = all_due - due.len();
    let mut open: Vec<&T::Of> = due.into_iter().map(|(of, _)| of).collect();
    require(tasks, &open, context.campaign)?;
    open.sort_by_key(|of| Reverse(tasks.duration_rank(of)));
    let tally = compute(tasks, &open, context, planned - given_up)?;
    Ok(Tally { planned, failed: tally.failed + given_up, ..tally })
}

/// Tasks that are not done, with their status. Damaged and stale files are recomputed with a notice.
fn due<'a, T: Tasks>(tasks: &T, selected: Vec<&'a T::Of>, watch: &dyn Watch) -> Vec<(&'a T::Of, Standing)> {
    let standings: Vec<Standing> = selected.par_iter().map(|of| tasks.standing(of)).collect();
    let open = selected.into_iter().zip(standings).filter(|(_, standing)| *standing != Standing::Done);
    open.inspect(|(of, standing)| match standing {
        Standing::Missing(why) | Standing::Corrupt(why) => {
            watch.notice(&format!("{}: {why}; recomputing", tasks.unit(of).id));
        }
        Standing::Stale => watch.notice(&format!("{} has other parameters; recomputing", tasks.unit(of).id)),
        // The status of tasks in other processes is that of their files.
        Standing::Done
        | Standing::Running
        | Standing::Waiting
        | Standing::Planned
        | Standing::Interrupted
        | Standing::Failed(_) => {}
    })
    .collect()
}

/// Refuses to start if inputs of tasks are missing.
fn require<T: Tasks>(tasks: &T, open: &[&T::Of], campaign: &Campaign) -> Result<(), StageError> {
    let inputs: Vec<(String, Standing)> = open.par_iter().filter_map(|of| tasks.input(of)).collect();
    incomplete(campaign, T::STAGE, &inputs).map_or(Ok(()), Err)
}

/// Computes tasks in parallel, in their order, and writes the provenance record of each; `planned` includes
/// finished tasks.
fn compute<T: Tasks>(
    tasks: &T,
    open: &[&T::Of],
    context: Context<'_>,
    planned: usize,
) -> Result<Tally, StageError> {
    let Context { campaign, watch, .. } = context;
    let before = planned - open.len();
    watch.begin(T::STAGE, before, planned);
    let one = |of: &T::Of| -> Result<(), StageError> {
        let (clock, unit) = (Clock::start(), tasks.unit(of));
        watch.started(T::STAGE, unit.id);
        let outcome = failure::fenced(|| tasks.compute(of));
        if let Err(error) = &outcome {
            watch.failed(T::STAGE, unit.id);
            failure::report(campaign, unit.id, &tasks.cycles(of), T::STAGE, error, watch)?;
        }
        clock.receipt(campaign, &unit, tasks.key_inputs(of), &outcome?)?;
        tasks.clean_up(of);
        watch.finished(T::STAGE, unit.id);
        Ok(())
    };
    // A bridge distributes the tasks one by one, in their order; halves of a list would leave half of the
    // longest ones to the end.
    let outcomes: Vec<Result<(), StageError>> = open.iter().par_bridge().map(|of| one(of)).collect();
    watch.end(T::STAGE);
    let mut tally = Tally { planned, before, ..Tally::default() };
    for outcome in outcomes {
        match outcome {
            Ok(()) => tally.computed += 1,
            Err(error) if failure::is_of_a_case(&error) => tally.failed += 1,
            Err(other) => return Err(other),
        }
    }
    Ok(tally)
}

/// A stage of one task.
pub(super) struct Single<'a> {
    pub(super) unit: Unit<'a>,
    /// Name of the result in the progress.
    pub(super) name: &'static str,
    pub(super) clock: Clock,
}

/// Computes the task of a stage of one task, if it is not done. `ready` gives the error of missing
/// inputs, `compute` the written files and the key inputs.
pub(super) fn run_single(
    single: Single<'_>,
    context: Context<'_>,
    check: Check,
    ready: impl FnOnce() -> Option<StageError>,
    compute: impl FnOnce() -> Result<(Outcome, Map<String, Value>), StageError>,
) -> Result<Tally, StageError> {
    let (Context { campaign, watch, .. }, stage) = (context, single.unit.stage);
    let mut tally = Tally { planned: 1, ..Tally::default() };
    if campaign.standing(&single.unit, check) == Standing::Done {
        tally.before = 1;
        watch.begin(stage, 1, 1);
        watch.end(stage);
        return Ok(tally);
    }
    if let Some(error) = ready() {
        return Err(error);
    }
    watch.begin(stage, 0, 1);
    let (outcome, key_inputs) = compute()?;
    single.clock.receipt(campaign, &single.unit, key_inputs, &outcome)?;
    watch.progress(stage, 1.0);
    watch.finished(stage, single.name);
    watch.end(stage);
    tally.computed = 1;
    Ok(tally)
}
