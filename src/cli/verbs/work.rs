//! Commands that compute: `run`, one for each stage, `retry`, `compare`.

use super::ending::{Ended, tally_json};
use super::place::{folder, folder_of, not_the_root, open, open_dir};
use super::{BAD_SPEC, FAILED_CASES, Fault, failed, say, viewer};
use crate::campaign::{Campaign, Shard, Stage, Standing};
use crate::cli::arguments::TalkArguments;
use crate::cli::progress::Teller;
use crate::cli::{FolderArguments, HowArguments, interrupt};
use crate::schema;
use crate::stages::{self, Task};
use crate::store::Check;
use crate::text::shown;
use serde_json::json;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(super) fn stages(
    spec: &Path,
    arguments: &HowArguments,
    (from, until): (Stage, Stage),
    (partial, view): (bool, bool),
) -> Result<u8, Fault> {
    let campaign = open(spec, &arguments.output)?;
    let shard = arguments.shard.unwrap_or_default();
    if !shard.is_whole() && until > Stage::Cycle {
        let stage = until.word();
        return Err(Fault {
            code: BAD_SPEC,
            ..failed(format!(
                "--shard: the stage {stage} needs all surfaces of {}\nhelp: use --until cycle with --shard",
                campaign.spec.name
            ))
        });
    }
    let check = if arguments.quick { Check::Sizes } else { Check::Contents };
    let report = campaign.dir.join("report.html");
    let code = perform(campaign, &Task { shard, partial, check, ..Task::new(from, until) }, arguments.output.json, arguments.talk)?;
    if view {
        viewer::open(&report);
    }
    Ok(code)
}

/// `compare` and `report --compare`.
pub(super) fn compare(runs: &[PathBuf], out: Option<&Path>, json: bool, view: bool) -> Result<u8, Fault> {
    let folders = runs.iter().map(|run| folder_of(run)).collect::<Result<Vec<PathBuf>, Fault>>()?;
    let out = out.unwrap_or(Path::new("data/runs/comparison"));
    not_the_root(out)?;
    let page = stages::compare(&folders, out).map_err(failed)?;
    let table = out.join(schema::COMPARISON.file);
    say(&if json {
        format!("{:#}\n", json!({ "report": page.display().to_string(), "table": table.display().to_string() }))
    } else {
        format!("Report: {}\nTable: {}\n", shown(&page), shown(&table))
    })?;
    if view {
        viewer::open(&page);
    }
    Ok(0)
}

pub(super) fn retry(asked: &FolderArguments, ids: &[String], talk: TalkArguments) -> Result<u8, Fault> {
    let dir = folder(asked)?;
    let campaign = open_dir("retry the failed cases of", &dir)?;
    if let Some(why) = campaign.spec_fault() {
        let dir = shown(&dir);
        return Err(failed(format!("cannot retry the failed cases of {dir}: {why}\nhelp: run `hysteron run SPEC` first")));
    }
    let standings = campaign.cycle_standings(Check::Sizes);
    let units = campaign.cycles.iter().zip(standings);
    let failures: HashSet<String> = units.filter(|(_, s)| matches!(s, Standing::Failed(_))).map(|(unit, _)| unit.id.clone()).collect();
    if let Some(strange) = ids.iter().find(|id| !failures.contains(*id)) {
        let mut known: Vec<&str> = failures.iter().map(String::as_str).collect();
        known.sort_unstable();
        let known = if known.is_empty() { "no case has failed".to_owned() } else { format!("failed are: {}", known.join(", ")) };
        return Err(failed(format!("cannot retry {strange}: it has not failed in {}\nhelp: {known}", shown(&dir))));
    }
    if failures.is_empty() {
        say("Nothing to retry: no case has failed.\n")?;
        return Ok(0);
    }
    let retried = if ids.is_empty() { failures } else { ids.iter().cloned().collect() };
    let task = Task { retried, shard: Shard::default(), ..Task::new(Stage::Generate, Stage::Report) };
    perform(campaign, &task, asked.json, talk)
}

fn perform(campaign: Campaign, task: &Task, json: bool, talk: TalkArguments) -> Result<u8, Fault> {
    let teller = Arc::new(Teller::new(talk));
    interrupt::expect(teller.clone(), &campaign.dir).map_err(failed)?;
    let (campaign, tallies) = rayon::scope(|_| stages::run(campaign, task, &*teller)).map_err(failed)?;
    let ended = Ended::of(&campaign, &tallies, teller.elapsed());
    if json {
        say(&tally_json(&ended))?;
    } else if !talk.quiet {
        say(&ended.conclusion(task.until)?)?;
    }
    Ok(if ended.failed_count > 0 { FAILED_CASES } else { 0 })
}
