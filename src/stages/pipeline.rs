//! Order of the stages, and the loop over realizations.

use super::done::{Clock, Outcome};
use super::extract::Extract;
use super::generate::Generate;
use super::live::Live;
use super::runner::{Context, run_stage};
use super::surface::Surfaces;
use super::{StageError, Tally, Task, Watch, aggregate, cycle, report, sampled};
use crate::campaign::{Campaign, Stage};
use crate::store::{Check, commit};
use crate::text::counted;

/// Tallies of the stages, in their order.
type Tallies = Vec<(Stage, Tally)>;

/// Runs the stages of a task, in order. Failed units do not stop the others. If the spec requests a
/// precision, grids and realizations are added until it is reached; the returned campaign has all of them.
///
/// # Errors
/// A folder or file that cannot be written; for a single stage: missing inputs of that stage.
pub fn run(campaign: Campaign, task: &Task, watch: &dyn Watch) -> Result<(Campaign, Tallies), StageError> {
    if task.from > Stage::Generate && !campaign.dir.join("campaign.toml").is_file() {
        return Err(StageError::NoRun { stage: task.from.word(), path: campaign.dir });
    }
    prepare(&campaign)?;
    let watch: &dyn Watch = &Live::of(&campaign, task, watch);
    let mut campaign = campaign;
    let mut tallies = Tallies::new();
    loop {
        compute(Context { campaign: &campaign, task, watch }, &mut tallies)?;
        let (before, grids) = (campaign.counts.clone(), campaign.cases.len());
        if task.from == Stage::Generate && task.until >= Stage::Cycle && task.shard.is_whole() {
            campaign = sampled(campaign)?;
        }
        if campaign.counts == before {
            break;
        }
        let finer = campaign.cases.len() - grids;
        if finer > 0 {
            watch.notice(&format!("grid error larger than requested: {}", counted(finer, "finer grid")));
            continue;
        }
        let more: u32 = campaign.counts.iter().zip(&before).map(|(now, before)| now - before).sum();
        watch.notice(&format!("confidence interval wider than requested: {more} more realizations"));
    }
    evaluate(Context { campaign: &campaign, task, watch }, &mut tallies)?;
    Ok((campaign, tallies))
}

/// Selected stages, in order.
fn wanted(task: &Task, stages: &[Stage]) -> Vec<Stage> {
    stages.iter().copied().filter(|stage| (task.from..=task.until).contains(stage)).collect()
}

/// Surfaces, asperities and cycles.
fn compute(context: Context<'_>, tallies: &mut Tallies) -> Result<(), StageError> {
    for stage in wanted(context.task, &[Stage::Generate, Stage::Extract, Stage::Cycle]) {
        let tally = match stage {
            Stage::Generate => run_stage(&Surfaces::<Generate>::of(context), context)?,
            Stage::Extract => run_stage(&Surfaces::<Extract>::of(context), context)?,
            _ => run_stage(&cycle::Cycles::of(context), context)?,
        };
        match tallies.iter_mut().find(|(known, _)| *known == stage) {
            Some((_, known)) => known.go_on(tally),
            None => tallies.push((stage, tally)),
        }
    }
    Ok(())
}

/// Tables over realizations, and the report.
fn evaluate(context: Context<'_>, tallies: &mut Tallies) -> Result<(), StageError> {
    let task = context.task;
    // An earlier stage of this run has already read the files of the cycles.
    let cycles_check = if task.from <= Stage::Cycle { Check::Sizes } else { task.check };
    for stage in wanted(task, &[Stage::Aggregate, Stage::Report]) {
        let tally = if stage == Stage::Aggregate {
            aggregate::run(context, cycles_check)?
        } else {
            report::run(context, cycles_check)?
        };
        tallies.push((stage, tally));
    }
    Ok(())
}

/// Makes the folders and writes the resolved spec.
///
/// # Errors
/// A folder or file that cannot be written; a file of the user with the name of a file of the run.
pub fn prepare(campaign: &Campaign) -> Result<(), StageError> {
    if let Some(path) = campaign.foreign_file() {
        return Err(StageError::Foreign { path });
    }
    let folders = ["", "surfaces", "asperities", "estimates", "spectra", "cycles", "statistics", "figures"]
        .map(|name| campaign.dir.join(name));
    for path in folders.into_iter().chain(Stage::ALL.map(|stage| campaign.receipts_dir(stage))) {
        std::fs::create_dir_all(&path).map_err(|source| StageError::Folder { path, source })?;
    }
    let path = campaign.dir.join("campaign.toml");
    let text = campaign.resolved_toml();
    // A pipe in its place would be waited for.
    let is_current = path.is_file() && std::fs::read_to_string(&path).is_ok_and(|present| present == text);
    if is_current && campaign.spec_fault().is_none() && campaign.has_recorded_files() {
        return Ok(());
    }
    let clock = Clock::start();
    let written = commit::commit_bytes("write the resolved spec", &path, text.as_bytes())?;
    clock.spec_receipt(campaign, &Outcome::of(vec![written]))
}
