//! The stages: read, compute, commit. This room alone joins the physics and the files, and it alone knows the order of the stages.

mod cycle;
mod report;
mod statistics;
mod surface;
mod trust;

pub use cycle::unload_again;

use crate::campaign::{Campaign, Stage, Standing};
use crate::physics::PhysicsError;
use crate::stats::StatsError;
use crate::store::{FrameError, StoreError, commit};
use rayon::prelude::*;
use serde_json::json;
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
    #[error("cannot make the folder {}: {source}; allowed: a folder that can be written to (--out DIR)", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A turning point that was not kept.
    #[error("cannot unload from F/(E* A0) = {max_load}: {} holds {kept}; allowed: one of these", path.display())]
    NoTurning {
        /// The load asked for.
        max_load: f64,
        /// The table.
        path: PathBuf,
        /// What it has.
        kept: String,
    },
    /// A stage lacks what an earlier one writes.
    #[error(
        "cannot {stage}: {missing} of {all} units of the stage before it are missing or damaged ({example}); run `hysteron run SPEC` or the stage before first"
    )]
    Incomplete {
        /// The stage.
        stage: &'static str,
        /// How many are missing.
        missing: usize,
        /// Of how many.
        all: usize,
        /// One of them.
        example: String,
    },
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

/// What became of a stage's units.
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

/// Runs the stages that are named, in order. Failed units do not stop the others.
///
/// # Errors
/// A folder or file that cannot be written; with `only` a single stage: what that stage reads is not there.
pub fn run(campaign: &Campaign, from: Stage, until: Stage, partial: bool, watch: &dyn Watch) -> Result<Vec<(Stage, Tally)>, StageError> {
    prepare(campaign)?;
    let mut tallies = Vec::new();
    for stage in Stage::ALL.into_iter().filter(|stage| (from..=until).contains(stage)) {
        let tally = match stage {
            Stage::Generate => generate(campaign, watch)?,
            Stage::Extract => extract(campaign, watch)?,
            Stage::Cycle => cycles(campaign, watch)?,
            Stage::Aggregate => statistics::run(campaign, partial || from != until, watch)?,
            Stage::Report => report::run(campaign, watch)?,
        };
        tallies.push((stage, tally));
    }
    Ok(tallies)
}

/// Makes the folders and writes the resolved spec.
fn prepare(campaign: &Campaign) -> Result<(), StageError> {
    for name in ["", "surfaces", "asperities", "cycles", "statistics", "figures"] {
        let path = if name.is_empty() { campaign.dir.clone() } else { campaign.dir.join(name) };
        std::fs::create_dir_all(&path).map_err(|source| StageError::Folder { path, source })?;
    }
    let path = campaign.dir.join("campaign.toml");
    let text = campaign.spec.to_toml();
    if std::fs::read_to_string(&path).is_ok_and(|present| present == text) {
        return Ok(());
    }
    Ok(commit::commit_bytes("write the resolved spec", &path, text.as_bytes())?)
}

/// The places of the units that are to be computed. Damaged and stale files are written anew, and it is said.
fn due<'a, T>(units: &'a [T], standing: impl Fn(&T) -> Standing + Sync, name: impl Fn(&T) -> String, watch: &dyn Watch) -> Vec<&'a T>
where
    T: Sync,
{
    let standings: Vec<Standing> = units.par_iter().map(&standing).collect();
    units
        .iter()
        .zip(standings)
        .filter_map(|(unit, standing)| {
            match &standing {
                Standing::Done => return None,
                Standing::Damaged(why) => watch.notice(&format!("{}: {why}; it is computed again", name(unit))),
                Standing::Stale => watch.notice(&format!("{} was written for other parameters; it is computed again", name(unit))),
                Standing::Failed(_) | Standing::Missing | Standing::Interrupted => {}
            }
            Some(unit)
        })
        .collect()
}

fn generate(campaign: &Campaign, watch: &dyn Watch) -> Result<Tally, StageError> {
    let wanted = due(&campaign.surfaces, |unit| campaign.surface_standing(unit), |unit| unit.id.clone(), watch);
    each(Stage::Generate, campaign.surfaces.len(), &wanted, watch, |unit| {
        surface::generate(campaign, unit)?;
        watch.progress(Stage::Generate, 1.0);
        Ok(unit.id.clone())
    })
}

fn extract(campaign: &Campaign, watch: &dyn Watch) -> Result<Tally, StageError> {
    let wanted = due(&campaign.surfaces, |unit| campaign.asperities_standing(unit), |unit| unit.id.clone(), watch);
    require(Stage::Extract, &wanted, |unit| campaign.surface_standing(unit), |unit| unit.id.clone())?;
    each(Stage::Extract, campaign.surfaces.len(), &wanted, watch, |unit| {
        surface::extract(campaign, unit)?;
        watch.progress(Stage::Extract, 1.0);
        Ok(unit.id.clone())
    })
}

/// Cycles all cases. One that the physics refuses is recorded as failed, and the others go on.
fn cycles(campaign: &Campaign, watch: &dyn Watch) -> Result<Tally, StageError> {
    let units = campaign.distinct_cycles();
    let mut wanted = due(&units, |unit| campaign.cycle_standing(unit), |unit| unit.id.clone(), watch);
    let surface = |unit: &&crate::campaign::CycleUnit| campaign.asperities_standing(&campaign.surfaces[unit.surface]);
    require(Stage::Cycle, &wanted, |unit| surface(&unit), |unit| campaign.surfaces[unit.surface].id.clone())?;
    // The longest first, so that the threads end together.
    wanted.sort_by_key(|unit| std::cmp::Reverse(campaign.surfaces[unit.surface].params.magnification));
    each(Stage::Cycle, units.len(), &wanted, watch, |unit| match cycle::run(campaign, unit, watch) {
        Err(StageError::Physics(error)) => {
            let record = json!({ "key": unit.key, "error": error.to_string() });
            let text = format!("{record:#}\n");
            commit::commit_bytes("record a failed case", &campaign.failure_path(unit), text.as_bytes())?;
            watch.notice(&format!("{} failed: {error}", unit.id));
            Err(StageError::Physics(error))
        }
        Err(error) => Err(error),
        Ok(()) => {
            for left in [campaign.failure_path(unit), campaign.halfway_path(unit)] {
                let _ = std::fs::remove_file(left);
            }
            Ok(unit.id.clone())
        }
    })
}

/// Refuses to begin where units lack what they read.
fn require<T>(stage: Stage, units: &[&T], standing: impl Fn(&T) -> Standing, name: impl Fn(&T) -> String) -> Result<(), StageError> {
    let lacking: Vec<String> = units
        .iter()
        .filter_map(|unit| match standing(unit) {
            Standing::Done => None,
            Standing::Damaged(why) => Some(why),
            _ => Some(name(unit)),
        })
        .collect();
    match lacking.first() {
        None => Ok(()),
        Some(example) => {
            Err(StageError::Incomplete { stage: stage.word(), missing: lacking.len(), all: units.len(), example: example.clone() })
        }
    }
}

/// Runs units in parallel. Failures of the physics are counted; the first other error ends the stage when all have been tried.
fn each<T: Sync>(
    stage: Stage,
    planned: usize,
    units: &[&T],
    watch: &dyn Watch,
    work: impl Fn(&T) -> Result<String, StageError> + Sync,
) -> Result<Tally, StageError> {
    watch.begin(stage, planned - units.len(), planned);
    let outcomes: Vec<Result<(), StageError>> = units
        .par_iter()
        .with_max_len(1)
        .map(|unit| {
            let id = work(unit)?;
            watch.finished(stage, &id);
            Ok(())
        })
        .collect();
    watch.end(stage);
    let mut tally = Tally { planned, before: planned - units.len(), ..Tally::default() };
    for outcome in outcomes {
        match outcome {
            Ok(()) => tally.computed += 1,
            Err(StageError::Physics(_)) => tally.failed += 1,
            Err(other) => return Err(other),
        }
    }
    Ok(tally)
}
