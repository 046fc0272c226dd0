//! The verbs that compute: `run`, one for each stage, and `retry`.

use super::{BAD_SPEC, FAILED_CASES, Fault, failed, failed_cases, not_the_root, open, open_dir, say};
use crate::campaign::{Campaign, Shard, Stage, Standing};
use crate::cli::progress::Teller;
use crate::cli::{FolderArguments, HowArguments, interrupt};
use crate::schema;
use crate::stages::{self, Tally, Task};
use crate::stats::summary;
use crate::store::{Check, parquet};
use crate::text::shown;
use serde_json::json;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(super) fn stages(spec: &Path, arguments: &HowArguments, (from, until): (Stage, Stage), partial: bool) -> Result<u8, Fault> {
    let campaign = open(spec, &arguments.output)?;
    let shard = arguments.shard.unwrap_or_default();
    if !shard.is_whole() && until > Stage::Cycle {
        let stage = until.word();
        return Err(Fault {
            code: BAD_SPEC,
            ..failed(format!("cannot {stage} a part of {}: that takes all of it; allowed: --until cycle with --shard", campaign.spec.name))
        });
    }
    let check = if arguments.quick { Check::Sizes } else { Check::Contents };
    perform(campaign, &Task { shard, partial, check, ..Task::new(from, until) }, arguments.output.json)
}

/// `report --compare`.
pub(super) fn compare(folders: &[PathBuf], arguments: &HowArguments) -> Result<u8, Fault> {
    let out = arguments.output.out.clone().unwrap_or_else(|| PathBuf::from("data/runs/comparison"));
    not_the_root(&out)?;
    let page = stages::compare(folders, &out).map_err(failed)?;
    say(&if arguments.output.json {
        format!("{:#}\n", json!({ "report": page.display().to_string(), "table": out.join(schema::COMPARISON.file).display().to_string() }))
    } else {
        format!("Report: {}\nTable: {}\n", shown(&page), shown(&out.join(schema::COMPARISON.file)))
    })?;
    Ok(0)
}

pub(super) fn retry(folder: &FolderArguments, ids: &[String]) -> Result<u8, Fault> {
    let campaign = open_dir("retry the failed cases of", &folder.dir)?;
    if let Some(why) = campaign.spec_fault() {
        let dir = shown(&folder.dir);
        return Err(failed(format!("cannot retry the failed cases of {dir}: {why}; allowed: after a `hysteron run` of the spec")));
    }
    let standings = campaign.cycle_standings(Check::Sizes);
    let units = campaign.cycles.iter().zip(standings);
    let failures: HashSet<String> = units.filter(|(_, s)| matches!(s, Standing::Failed(_))).map(|(unit, _)| unit.id.clone()).collect();
    if let Some(strange) = ids.iter().find(|id| !failures.contains(*id)) {
        let mut known: Vec<&str> = failures.iter().map(String::as_str).collect();
        known.sort_unstable();
        let known = if known.is_empty() { "none, since no case has failed".to_owned() } else { known.join(", ") };
        return Err(failed(format!("cannot retry {strange}: it is no failed case of {}; allowed: {known}", shown(&folder.dir))));
    }
    if failures.is_empty() {
        say("Nothing to retry: no case has failed.\n")?;
        return Ok(0);
    }
    let retried = if ids.is_empty() { failures } else { ids.iter().cloned().collect() };
    let task = Task { retried, shard: Shard::default(), ..Task::new(Stage::Generate, Stage::Report) };
    perform(campaign, &task, folder.json)
}

fn perform(campaign: Campaign, task: &Task, json: bool) -> Result<u8, Fault> {
    let teller = Arc::new(Teller::new());
    interrupt::expect(teller.clone(), &campaign.dir).map_err(failed)?;
    let (campaign, tallies) = rayon::scope(|_| stages::run(campaign, task, &*teller)).map_err(failed)?;
    let failures = failures(&tallies);
    if json {
        say(&tally_json(&campaign, &tallies))?;
    } else {
        say(&conclusion(&campaign, &tallies, task.until)?)?;
    }
    Ok(if failures > 0 { FAILED_CASES } else { 0 })
}

/// Cases that failed: where a surface did, its cycles did too.
fn failures(tallies: &[(Stage, Tally)]) -> usize {
    tallies.iter().map(|(_, tally)| tally.failed).max().unwrap_or(0)
}

fn tally_json(campaign: &Campaign, tallies: &[(Stage, Tally)]) -> String {
    let stages: Vec<_> = tallies
        .iter()
        .map(|(stage, t)| {
            json!({ "stage": stage.word(), "planned_count": t.planned, "done_before_count": t.before, "computed_count": t.computed, "failed_count": t.failed })
        })
        .collect();
    format!("{:#}\n", json!({ "name": campaign.spec.name, "dir": campaign.dir.display().to_string(), "stages": stages }))
}

/// What is said at the end: the table of cases, what failed, and where the results are.
fn conclusion(campaign: &Campaign, tallies: &[(Stage, Tally)], until: Stage) -> Result<String, Fault> {
    let mut text = String::new();
    let computed: usize = tallies.iter().map(|(_, t)| t.computed).sum();
    let failures = failures(tallies);
    if until >= Stage::Aggregate {
        let cases = parquet::read_table(&campaign.statistics_path("cases"), &schema::CASES).map_err(failed)?;
        text += &summary(&cases).map_err(failed)?;
        text += "\n";
    }
    if computed == 0 && failures == 0 {
        text += "Nothing to do: everything was done before.\n";
    } else {
        for (stage, t) in tallies {
            let lost = if t.failed > 0 { format!(", {} failed", t.failed) } else { String::new() };
            text += &format!("{:9} {} of {} computed, {} done before{lost}\n", stage.word(), t.computed, t.planned, t.before);
        }
    }
    let dir = shown(&campaign.dir);
    if failures > 0 {
        text += &failed_cases(failures, &campaign.dir);
        text += &format!("Reasons: {dir}/cycles/*/failed.json\n");
    }
    text += &match until {
        Stage::Report => format!("Report: {dir}/report.html\nTables: {dir}/statistics/*.parquet\n"),
        _ => format!("Output: {dir}\n"),
    };
    Ok(text)
}
