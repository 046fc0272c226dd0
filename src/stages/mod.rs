//! The stages: read, compute, commit. This room alone joins the physics and the files, and it alone knows the order of the stages.

mod compare;
mod contact_maps;
mod cycle;
mod datapackage;
mod done;
mod failure;
mod foreseen;
mod identity;
mod measure;
mod report;
mod sampling;
mod single_cycle;
mod statistics;
mod step_count;
mod surface;

pub use compare::{Comparison, compare};
pub use cycle::{Units, unload_again, unload_elements_again};
pub use foreseen::{Outside, foreseen};
pub use measure::{Imported, measure};
pub use sampling::sampled;

use crate::campaign::{Campaign, CycleUnit, Shard, Stage, Standing, SurfaceUnit, Unit};
use crate::physics::PhysicsError;
use crate::stats::StatsError;
use crate::store::{Check, FrameError, StoreError, commit};
use crate::text::{counted, shown};
use done::{Clock, Outcome};
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::collections::HashSet;
use std::path::PathBuf;
use thiserror::Error;

/// Why a stage ended without its result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StageError {
    /// A file.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A table's columns.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The physics.
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// Aggregation.
    #[error(transparent)]
    Stats(#[from] StatsError),
    /// A figure.
    #[error(transparent)]
    Figure(#[from] crate::figures::FigureError),
    /// The output folder.
    #[error("cannot create the directory {}: {source}\nhelp: give a writable directory with --out DIR", shown(path))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A measured surface.
    #[error("cannot import the surface {}: {why}", shown(path))]
    Measured {
        /// File.
        path: PathBuf,
        /// Why, and what is allowed.
        why: String,
    },
    /// The file of a measured surface, which is not in the form that it seems to be in.
    #[error(transparent)]
    Scan(StoreError),
    /// A measured surface that changed after the spec was read. It is no failure of a case, whose keys refer to the former file.
    #[error("cannot import the surface {}: {why}", shown(path))]
    Changed {
        /// File.
        path: PathBuf,
        /// Why, and what is allowed.
        why: String,
    },
    /// A folder in the place of a file that a task writes, or a file in the place of its folder.
    #[error("cannot write {}: {what} of this name exists\nhelp: remove or rename it; the next run computes the task", shown(path))]
    InTheWay {
        /// The place.
        path: PathBuf,
        /// What is there.
        what: &'static str,
    },
    /// Steps that would fill the memory.
    #[error(
        "cycle.approach_step = {approach_step:?} makes at least {steps:.0} steps of loading and unloading (limit {limit})\n\
         help: use a larger approach_step (default 0.01); it does not change results, which are located between the steps"
    )]
    TooManySteps {
        /// Step of the approach, in rms heights.
        approach_step: f64,
        /// Steps of all branches, estimated from below.
        steps: f64,
        /// How many are allowed.
        limit: u64,
    },
    /// A turning point that was not kept.
    #[error("no load reversal at F/(E* A0) = {max_load} in {}\nhelp: use one of {kept}", shown(path))]
    NoTurning {
        /// The load asked for.
        max_load: f64,
        /// The table.
        path: PathBuf,
        /// What it has.
        kept: String,
    },
    /// A state at a load reversal that cannot be stored.
    #[error("cannot store the state at a load reversal: {what}\nhelp: report this")]
    State {
        /// Why.
        what: String,
    },
    /// A campaign that is to be compared with itself.
    #[error("cannot compare {} with itself\nhelp: name each run once", shown(path))]
    ComparedTwice {
        /// Its folder.
        path: PathBuf,
    },
    /// A comparison of other campaigns in the place of a new one.
    #[error("{} holds the comparison of other runs\nhelp: write to another folder with --out DIR, or replace it with --force", shown(path))]
    OtherComparison {
        /// Its folder.
        path: PathBuf,
    },
    /// Campaigns without a case in common.
    #[error(
        "cannot compare {folders}: no case with otherwise equal parameters is in all runs\nhelp: compare runs that differ in one parameter"
    )]
    NothingInCommon {
        /// Their folders.
        folders: String,
    },
    /// A stage lacks what an earlier one writes.
    #[error(
        "cannot run the stage {stage} in {}: of {} of the previous stage, {}; for example {example}\nhelp: {}",
        shown(path), counted(*all, "task"), lacks(*missing, *damaged), incomplete_help(stage)
    )]
    Incomplete {
        /// The stage.
        stage: &'static str,
        /// The output folder.
        path: PathBuf,
        /// How many are not computed.
        missing: usize,
        /// How many are stale, or have missing or changed files.
        damaged: usize,
        /// Of how many.
        all: usize,
        /// One of them.
        example: String,
    },
    /// A single stage in a folder without a run.
    #[error(
        "cannot run the stage {stage}: {} has no campaign.toml\nhelp: run the previous stages first, or name the output folder of the run with --out",
        shown(path)
    )]
    NoRun {
        /// The stage.
        stage: &'static str,
        /// The folder.
        path: PathBuf,
    },
}

/// Numbers of tasks that a stage lacks.
fn lacks(missing: usize, damaged: usize) -> String {
    let parts = [(missing, "not computed"), (damaged, "stale or damaged")];
    let parts: Vec<String> = parts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    parts.join(" and ")
}

fn incomplete_help(stage: &str) -> &'static str {
    if stage == Stage::Aggregate.word() {
        "compute them with `hysteron run SPEC`, or aggregate the finished ones with --partial"
    } else {
        "run `hysteron run SPEC`, or the previous stage"
    }
}

/// The error of a stage whose inputs have these states; `None` if all are done.
fn incomplete(campaign: &Campaign, stage: Stage, inputs: &[(String, Standing)]) -> Option<StageError> {
    let lacking = || inputs.iter().filter(|(_, standing)| *standing != Standing::Done);
    let (id, standing) = lacking().next()?;
    let missing =
        lacking().filter(|(_, standing)| matches!(standing, Standing::Planned | Standing::Interrupted | Standing::Failed(_))).count();
    Some(StageError::Incomplete {
        stage: stage.word(),
        path: campaign.dir.clone(),
        missing,
        damaged: lacking().count() - missing,
        all: inputs.len(),
        example: standing.why().map_or_else(|| id.clone(), |why| format!("{id}: {why}")),
    })
}

/// Who is told of the progress.
pub trait Watch: Sync {
    /// A stage begins: how many of its units are done already, and how many there are.
    fn begin(&self, stage: Stage, done: usize, all: usize);
    /// A part of a unit is done: the parts of a unit add up to 1.
    fn progress(&self, stage: Stage, part: f64);
    /// A unit is done.
    fn finished(&self, stage: Stage, id: &str);
    /// Something to be seen: a damaged file, a failed case.
    fn notice(&self, text: &str);
    /// A stage ends.
    fn end(&self, stage: Stage);
}

/// Outcome of the tasks of a stage.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Units of the stage.
    pub planned: usize,
    /// Done before.
    pub before: usize,
    /// Computed now.
    pub computed: usize,
    /// Failed.
    pub failed: usize,
}

impl Tally {
    /// After more units were added: those that were done now were not done before.
    fn go_on(&mut self, next: Self) {
        self.planned = next.planned;
        self.computed += next.computed;
        self.failed = self.failed.max(next.failed);
    }
}

/// Selection of the tasks of a campaign.
#[derive(Debug, Clone)]
pub struct Task {
    /// The first stage.
    pub from: Stage,
    /// The last one.
    pub until: Stage,
    /// Which part of the surfaces, and what is done with them.
    pub shard: Shard,
    /// Aggregate what is there, although cases are missing.
    pub partial: bool,
    /// Check of finished files: a changed file is computed again.
    pub check: Check,
    /// Cycles that have failed and are tried again.
    pub retried: HashSet<String>,
}

impl Task {
    /// These stages, of everything.
    #[must_use]
    pub fn new(from: Stage, until: Stage) -> Self {
        Self { from, until, shard: Shard::default(), partial: false, check: Check::Contents, retried: HashSet::new() }
    }
}

/// A unit at work: what it is known by, and what that is made of.
struct Job<'a, T> {
    of: &'a T,
    unit: Unit<'a>,
    preimages: Box<dyn Fn() -> Map<String, Value> + Send + Sync + 'a>,
}

/// Runs the stages of a task, in order. Failed units do not stop the others. Where the spec asks for a precision, realizations are added until it is reached;
/// what is returned has all of them.
///
/// # Errors
/// A folder or file that cannot be written; for a single stage: what that stage reads is not there.
pub fn run(campaign: Campaign, task: &Task, watch: &dyn Watch) -> Result<(Campaign, Vec<(Stage, Tally)>), StageError> {
    if task.from > Stage::Generate && !campaign.dir.join("campaign.toml").is_file() {
        return Err(StageError::NoRun { stage: task.from.word(), path: campaign.dir });
    }
    prepare(&campaign)?;
    let mut campaign = campaign;
    // What an earlier stage of this run has looked at is not read again.
    let cycles_check = if task.from <= Stage::Cycle { Check::Sizes } else { task.check };
    let mut tallies: Vec<(Stage, Tally)> = Vec::new();
    let wanted = |stages: &[Stage]| stages.iter().copied().filter(|stage| (task.from..=task.until).contains(stage)).collect::<Vec<_>>();
    loop {
        for stage in wanted(&[Stage::Generate, Stage::Extract, Stage::Cycle]) {
            let tally = if stage == Stage::Cycle { cycles(&campaign, task, watch)? } else { surfaces(&campaign, task, stage, watch)? };
            match tallies.iter_mut().find(|(known, _)| *known == stage) {
                Some((_, known)) => known.go_on(tally),
                None => tallies.push((stage, tally)),
            }
        }
        let before = campaign.counts.clone();
        if task.from == Stage::Generate && task.until >= Stage::Cycle && task.shard.is_whole() {
            campaign = sampled(campaign)?;
        }
        if campaign.counts == before {
            break;
        }
        let more: u32 = campaign.counts.iter().zip(&before).map(|(now, before)| now - before).sum();
        watch.notice(&format!("confidence interval wider than requested: {more} more realizations"));
    }
    for stage in wanted(&[Stage::Aggregate, Stage::Report]) {
        let tally = if stage == Stage::Aggregate {
            statistics::run(&campaign, task.partial || task.from != task.until, (cycles_check, task.check), watch)?
        } else {
            report::run(&campaign, (cycles_check, task.check), watch)?
        };
        tallies.push((stage, tally));
    }
    Ok((campaign, tallies))
}

/// Makes the folders and writes the resolved spec.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn prepare(campaign: &Campaign) -> Result<(), StageError> {
    let folders = ["", "surfaces", "asperities", "cycles", "statistics", "figures"].map(|name| campaign.dir.join(name));
    for path in folders.into_iter().chain(Stage::ALL.map(|stage| campaign.receipts_dir(stage))) {
        std::fs::create_dir_all(&path).map_err(|source| StageError::Folder { path, source })?;
    }
    let path = campaign.dir.join("campaign.toml");
    let text = campaign.spec.to_toml();
    // A pipe in its place would be waited for.
    if path.is_file() && std::fs::read_to_string(&path).is_ok_and(|present| present == text) && campaign.spec_fault().is_none() {
        return Ok(());
    }
    let clock = Clock::start();
    let written = commit::commit_bytes("write the resolved spec", &path, text.as_bytes())?;
    clock.spec_receipt(campaign, &Outcome::of(vec![written]))
}

/// The jobs that are to be done, with how they stand. Damaged and stale files are written anew, and it is said.
fn due<'a, T: Sync>(
    jobs: Vec<Job<'a, T>>,
    standing: impl Fn(&Job<'a, T>) -> Standing + Sync,
    watch: &dyn Watch,
) -> Vec<(Job<'a, T>, Standing)> {
    let standings: Vec<Standing> = jobs.par_iter().map(&standing).collect();
    let open = jobs.into_iter().zip(standings).filter(|(_, standing)| *standing != Standing::Done);
    open.inspect(|(job, standing)| match standing {
        Standing::Missing(why) | Standing::Corrupt(why) => watch.notice(&format!("{}: {why}; recomputing", job.unit.id)),
        Standing::Stale => watch.notice(&format!("{} has other parameters; recomputing", job.unit.id)),
        Standing::Done | Standing::Planned | Standing::Interrupted | Standing::Failed(_) => {}
    })
    .collect()
}

fn surface_jobs<'a>(campaign: &'a Campaign, task: &Task, stage: Stage) -> Vec<Job<'a, SurfaceUnit>> {
    let held = campaign.surfaces.iter().enumerate().filter(|(place, _)| task.shard.holds(*place));
    held.map(|(_, of)| Job {
        of,
        unit: if stage == Stage::Generate { of.surface() } else { of.asperities() },
        preimages: Box::new(move || campaign.surface_preimages(of, stage)),
    })
    .collect()
}

/// What a stage does with a surface.
type OfSurface = fn(&Campaign, &SurfaceUnit) -> Result<Outcome, StageError>;

/// generate and extract: one unit for each surface.
fn surfaces(campaign: &Campaign, task: &Task, stage: Stage, watch: &dyn Watch) -> Result<Tally, StageError> {
    let work: OfSurface = if stage == Stage::Generate { surface::generate } else { surface::extract };
    let jobs = surface_jobs(campaign, task, stage);
    let planned = jobs.len();
    let mut wanted = due(jobs, |job| campaign.standing(&job.unit, task.check), watch);
    let cycles = failure::by_surface(campaign);
    let cycles_of = |unit: &SurfaceUnit| cycles.get(unit.id.as_str()).map_or(&[][..], Vec::as_slice);
    let open = wanted.len();
    wanted.retain(|(job, _)| !failure::given_up(campaign, cycles_of(job.of), stage, &task.retried));
    let given_up = open - wanted.len();
    if stage == Stage::Extract {
        require((campaign, stage), &wanted, |unit| campaign.standing(&unit.surface(), task.check), |unit| unit.id.clone())?;
    }
    let work = |unit: &SurfaceUnit| {
        let task = if stage == Stage::Generate { unit.surface() } else { unit.asperities() };
        let outcome = failure::in_the_way(campaign, &task).and_then(|()| work(campaign, unit));
        watch.progress(stage, 1.0);
        if let Err(error) = &outcome {
            failure::report(campaign, (&unit.id, cycles_of(unit)), stage, error, watch)?;
        }
        outcome
    };
    let then = |unit: &SurfaceUnit| failure::forget(campaign, cycles_of(unit), stage);
    let mut tally = each(campaign, (stage, planned - given_up), &wanted, watch, work, then)?;
    tally.planned = planned;
    tally.failed += given_up;
    Ok(tally)
}

/// Cycles all cases. One that the physics refuses is recorded as failed, and the others go on; it is not tried again unless that is asked for, since it would
/// fail again.
fn cycles(campaign: &Campaign, task: &Task, watch: &dyn Watch) -> Result<Tally, StageError> {
    let units = campaign.distinct_cycles();
    let jobs: Vec<Job<'_, CycleUnit>> = units
        .iter()
        .filter(|unit| task.shard.holds(unit.surface))
        .map(|of| Job { of, unit: of.cycle(), preimages: Box::new(move || campaign.cycle_preimages(of)) })
        .collect();
    let planned = jobs.len();
    let mut wanted = due(jobs, |job| campaign.cycle_standing(job.of, task.check), watch);
    let before = wanted.len();
    let again = |unit: &CycleUnit| task.retried.contains(&unit.id) && campaign.failed_at(unit).is_none_or(|stage| stage == Stage::Cycle);
    wanted.retain(|(job, standing)| !matches!(standing, Standing::Failed(_)) || again(job.of));
    let failed = before - wanted.len();
    let surface = |unit: &CycleUnit| &campaign.surfaces[unit.surface];
    let asperities = |unit: &CycleUnit| campaign.standing(&surface(unit).asperities(), task.check);
    require((campaign, Stage::Cycle), &wanted, asperities, |unit| surface(unit).id.clone())?;
    // The longest first, so that the threads end together.
    let by_elements = |unit: &CycleUnit| campaign.cases[unit.case].case.params.by_elements();
    wanted.sort_by_key(|(job, _)| std::cmp::Reverse((by_elements(job.of), surface(job.of).params.magnification)));
    let mut tally = each(
        campaign,
        (Stage::Cycle, planned - failed),
        &wanted,
        watch,
        |unit| {
            let outcome = failure::in_the_way(campaign, &unit.cycle()).and_then(|()| cycle::run(campaign, unit, watch));
            if let Err(error) = &outcome {
                failure::report(campaign, (&unit.id, &[unit]), Stage::Cycle, error, watch)?;
            }
            outcome
        },
        |unit| {
            for left in [campaign.failure_path(unit), campaign.halfway_path(unit)] {
                let _ = std::fs::remove_file(left);
            }
        },
    )?;
    tally.planned = planned;
    tally.failed += failed;
    Ok(tally)
}

/// Refuses to begin where units lack what they read.
fn require<T: Sync>(
    (campaign, stage): (&Campaign, Stage),
    units: &[(Job<'_, T>, Standing)],
    standing: impl Fn(&T) -> Standing + Sync,
    name: impl Fn(&T) -> String,
) -> Result<(), StageError> {
    let standings: Vec<Standing> = units.par_iter().map(|(job, _)| standing(job.of)).collect();
    let inputs: Vec<(String, Standing)> = units.iter().map(|(job, _)| name(job.of)).zip(standings).collect();
    incomplete(campaign, stage, &inputs).map_or(Ok(()), Err)
}

/// Runs units in parallel, in their order, and writes the receipt of each; `then` is what is left to do. Failures of one case are counted; another error ends
/// the stage when all have been tried.
fn each<T: Sync>(
    campaign: &Campaign,
    (stage, planned): (Stage, usize),
    jobs: &[(Job<'_, T>, Standing)],
    watch: &dyn Watch,
    work: impl Fn(&T) -> Result<Outcome, StageError> + Sync,
    then: impl Fn(&T) + Sync,
) -> Result<Tally, StageError> {
    watch.begin(stage, planned - jobs.len(), planned);
    // A bridge hands them out one by one, in their order; halves of a list would leave half of the longest ones to the end.
    let outcomes: Vec<Result<(), StageError>> = jobs
        .iter()
        .par_bridge()
        .map(|(job, _)| {
            let clock = Clock::start();
            let outcome = work(job.of)?;
            clock.receipt(campaign, &job.unit, (job.preimages)(), &outcome)?;
            then(job.of);
            watch.finished(stage, job.unit.id);
            Ok(())
        })
        .collect();
    watch.end(stage);
    let mut tally = Tally { planned, before: planned - jobs.len(), ..Tally::default() };
    for outcome in outcomes {
        match outcome {
            Ok(()) => tally.computed += 1,
            Err(error) if failure::is_of_a_case(&error) => tally.failed += 1,
            Err(other) => return Err(other),
        }
    }
    Ok(tally)
}
