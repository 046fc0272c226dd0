//! Errors of the stages.

use crate::campaign::{Campaign, Stage, Standing};
use crate::physics::{LoopError, PhysicsError};
use crate::stats::StatsError;
use crate::store::{FrameError, StoreError};
use crate::text::{counted, shell_path, shown};
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
    #[error("{_0}{}", help(_0))]
    Physics(#[from] PhysicsError),
    /// Aggregation.
    #[error(transparent)]
    Stats(#[from] StatsError),
    /// A figure.
    #[error(transparent)]
    Figure(#[from] crate::figures::FigureError),
    /// The output folder.
    #[error(
        "cannot create the directory {}: {source}\nhelp: give a writable directory with --out DIR",
        shown(path)
    )]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Error of the system.
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
    /// A measured loop.
    #[error("cannot import the loop {}: {why}", shown(path))]
    Loop {
        /// File.
        path: PathBuf,
        /// Why, and what is allowed.
        why: String,
    },
    /// The file of a measured surface, which is not in the form that it seems to be in.
    #[error(transparent)]
    Scan(StoreError),
    /// A measured surface that changed after the spec was read. It is no failure of a case, whose keys refer
    /// to the file as it was read.
    #[error("cannot import the surface {}: {why}", shown(path))]
    Changed {
        /// File.
        path: PathBuf,
        /// Why, and what is allowed.
        why: String,
    },
    /// The file of a measured surface is in none of the places to which its name in the spec leads.
    #[error(
        "cannot import the surface {}: no such file\nhelp: it was looked for at {}; put it there, or run the \
         spec with its new place (--out DIR)",
        shown(path),
        listed(places)
    )]
    Lost {
        /// File.
        path: PathBuf,
        /// Absolute paths.
        places: Vec<PathBuf>,
    },
    /// A folder in the place of a file that a task writes, or a file in the place of its folder.
    #[error(
        "cannot write {}: {what} of this name exists\nhelp: remove or rename it; the next run computes the \
         task",
        shown(path)
    )]
    InTheWay {
        /// The place.
        path: PathBuf,
        /// Kind of the entry.
        what: &'static str,
    },
    /// Steps that would fill the memory.
    #[error(
        "cycle.approach_step = {approach_step:?} makes at least {steps:.0} steps of loading and unloading \
         (limit {limit})\n\
         help: use a larger approach_step (default 0.01); it does not change results, which are located \
         between the steps"
    )]
    TooManySteps {
        /// Step of the approach, in rms heights.
        approach_step: f64,
        /// Steps of all branches, estimated from below.
        steps: f64,
        /// Limit.
        limit: u64,
    },
    /// A range of attraction that takes too many steps on a surface.
    #[error("{problem}\nhelp: {help}")]
    Range {
        /// Range, rms height and number of steps.
        problem: String,
        /// Recommended action.
        help: String,
    },
    /// A load reversal that was not kept.
    #[error("no load reversal at F/(E* A0) = {max_load} in {}\nhelp: use one of {kept}", shown(path))]
    NoTurning {
        /// The requested load.
        max_load: f64,
        /// The table.
        path: PathBuf,
        /// Stored load reversals.
        kept: String,
    },
    /// A state at a load reversal that cannot be stored.
    #[error("cannot store the state at a load reversal: {what}\nhelp: report this")]
    State {
        /// Why.
        what: String,
    },
    /// A defect of the program, by which one task ended.
    #[error("internal error: {what}\nhelp: report this with the spec; the other tasks go on")]
    Defect {
        /// The message of the panic.
        what: String,
    },
    /// A campaign that is to be compared with itself.
    #[error("cannot compare {} with itself\nhelp: name each run once", shown(path))]
    ComparedTwice {
        /// Its folder.
        path: PathBuf,
    },
    /// A comparison of other campaigns in the place of a new one.
    #[error(
        "{} holds the comparison of other runs\nhelp: write to another folder with --out DIR, or replace it \
         with --force",
        shown(path)
    )]
    OtherComparison {
        /// Its folder.
        path: PathBuf,
    },
    /// A comparison that would be mixed with a run.
    #[error(
        "cannot write the comparison to {}: it belongs to the run {}\nhelp: write to another folder with \
         --out DIR",
        shown(path),
        shown(run)
    )]
    IntoRun {
        /// Folder of the comparison.
        path: PathBuf,
        /// Output folder of the run.
        run: PathBuf,
    },
    /// A file that no comparison wrote, in the place of one of a comparison.
    #[error(
        "cannot write the comparison: {} exists and is not as `hysteron compare` wrote it\nhelp: write to \
         another folder with --out DIR, or replace it with --force",
        shown(path)
    )]
    ForeignComparison {
        /// The file.
        path: PathBuf,
    },
    /// A file that no run wrote, in the place of one of a run.
    #[error(
        "cannot run in this folder: {} was not written by a run\nhelp: choose another folder with --out DIR, \
         or move the file",
        shown(path)
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// A file that is not as it was written.
    #[error(
        "cannot use the results in {}: {why}\nhelp: `hysteron verify {} --deep` lists all faults, `hysteron \
         run {}` repairs them",
        shown(dir),
        shell_path(dir),
        shell_path(dir)
    )]
    Damaged {
        /// Folder of the results.
        dir: PathBuf,
        /// The file and its fault.
        why: String,
    },
    /// Campaigns without a case in common.
    #[error(
        "cannot compare {folders}: no case with otherwise equal parameters is in all runs\nhelp: compare \
         runs that differ in one parameter"
    )]
    NothingInCommon {
        /// Their folders.
        folders: String,
    },
    /// A stage lacks what an earlier one writes.
    #[error(
        "cannot run the stage {stage} in {}: of {} of the previous stage, {}; for example {example}\n\
         help: {}",
        shown(path), counted(*all, "task"), lacks(*missing, *damaged), incomplete_help(stage)
    )]
    Incomplete {
        /// The stage.
        stage: &'static str,
        /// The output folder.
        path: PathBuf,
        /// Number of tasks that are not computed.
        missing: usize,
        /// Number of tasks that are stale, or have missing or changed files.
        damaged: usize,
        /// Of how many.
        all: usize,
        /// One of them.
        example: String,
    },
    /// A single stage in a folder without a run.
    #[error(
        "cannot run the stage {stage}: {} has no campaign.toml\nhelp: run the previous stages first, or name \
         the output folder of the run with --out",
        shown(path)
    )]
    NoRun {
        /// The stage.
        stage: &'static str,
        /// The folder.
        path: PathBuf,
    },
}

/// Paths in a sentence.
fn listed(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| shown(path)).collect::<Vec<_>>().join(" and ")
}

/// Numbers of tasks that a stage lacks.
fn lacks(missing: usize, damaged: usize) -> String {
    let parts = [(missing, "not computed"), (damaged, "stale or damaged")];
    let parts: Vec<String> =
        parts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
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
pub(super) fn incomplete(
    campaign: &Campaign,
    stage: Stage,
    inputs: &[(String, Standing)],
) -> Option<StageError> {
    let lacking = || inputs.iter().filter(|(_, standing)| *standing != Standing::Done);
    let (id, standing) = lacking().next()?;
    let missing = lacking()
        .filter(|(_, standing)| {
            matches!(standing, Standing::Planned | Standing::Interrupted | Standing::Failed(_))
        })
        .count();
    Some(StageError::Incomplete {
        stage: stage.word(),
        path: campaign.dir.clone(),
        missing,
        damaged: lacking().count() - missing,
        all: inputs.len(),
        example: standing.why().map_or_else(|| id.clone(), |why| format!("{id}: {why}")),
    })
}

impl From<LoopError> for StageError {
    fn from(error: LoopError) -> Self {
        Self::Physics(error.into())
    }
}

/// Change of a spec that avoids an error, for errors without a help of their own.
fn help(error: &PhysicsError) -> String {
    let text = match error {
        PhysicsError::LowTabor { .. } => {
            "reduce material.interaction_range_m, set model.jump_in = \"jkr\", or set model.allow_low_tabor \
             = true for a result with a warning"
        }
        PhysicsError::Loop(error) => help_of_loop(error),
        _ => return String::new(),
    };
    format!("\nhelp: {text}")
}

fn help_of_loop(error: &LoopError) -> &'static str {
    match error {
        LoopError::NoEquilibrium { .. } => {
            "contacts that grow together may have none: reduce cycle.max_load; with model.coalescence = \
             \"merge\" or \"none\", try \"cover\""
        }
        LoopError::EndlessAvalanche { .. } => {
            "reduce cycle.max_load; with model.coalescence = \"cover\" or \"merge\", try \"none\""
        }
        LoopError::Closed { .. } => {
            "set boundary_elements.opening = \"strength\", or reduce cycle.max_load if adhesion alone does \
             not close the contact"
        }
        LoopError::Inseparable { .. } => {
            "set boundary_elements.opening = \"anywhere\", or reduce the work of adhesion"
        }
        LoopError::ExcessArea { load_before_n, .. } if *load_before_n > 0.0 => {
            "reduce cycle.max_load, or set model.method = \"boundary_elements\", which reaches full contact"
        }
        LoopError::ExcessArea { .. } => {
            "adhesion alone closes the contact, so a smaller cycle.max_load has no effect: set model.method \
             = \"boundary_elements\", which reaches full contact"
        }
        LoopError::NegativeDissipation { .. } | LoopError::EnergyImbalance { .. } => {
            "reduce cycle.max_load, or set model.method = \"boundary_elements\", which has the energy of \
             weak adhesion as well"
        }
        LoopError::UnresolvedLoop { .. } => {
            "reduce boundary_elements.approach_step, or boundary_elements.precision"
        }
        LoopError::LoadNotReached { .. } => {
            "reduce cycle.max_load; near full contact the load stays tensile: set model.method = \
             \"boundary_elements\""
        }
    }
}
