//! Commands that show the state of a run: `plan` and `status`. They write nothing.

use super::causes::causes;
use super::ending::failed_cases;
use super::place::{folder, open, open_dir, resuming};
use super::{Fault, say, submit};
use crate::campaign::{Campaign, REPORT_PAGE, STATISTICS, Stage, Standing};
use crate::cli::{FolderArguments, OutputArguments};
use crate::stages::{Outside, foreseen};
use crate::stats::{Caution, significant};
use crate::store::Check;
use crate::text::{counted, shown, visible, wrapped};
use serde_json::{Value, json};
use std::io::{IsTerminal, Write as _};
use std::path::Path;
use std::time::Duration;

/// Period of `status --watch`.
const EVERY: Duration = Duration::from_secs(2);

/// The state of every task of a campaign, by stage.
type Units = Vec<(Stage, Vec<(String, Standing)>)>;

pub(super) fn plan(spec: &Path, output: &OutputArguments) -> Result<u8, Fault> {
    let campaign = open(spec, output)?;
    let units = units(&campaign);
    let outside = foreseen(&campaign);
    let text = if output.json {
        let mut answer = answer(&campaign, &units);
        answer["outside_range"] = outside.iter().map(outside_json).collect();
        format!("{answer:#}\n")
    } else {
        let reasons = |stage: Stage, units: &[(String, Standing)]| causes(&campaign, stage, units);
        let warnings: String = outside.iter().map(|of| outside_text(of, campaign.cases.len())).collect();
        describe(&campaign, &units, reasons)
            + &warnings
            + &remaining(&units, &campaign, |open| format!("`run` would compute {}.\n", counted(open, "task")))
    };
    say(&text)?;
    Ok(0)
}

/// Cases outside the range of the asperity model, by the target spectrum of the spec.
fn outside_json(of: &Outside) -> Value {
    json!({ "code": of.kind.code, "min": of.range[0], "max": of.range[1], "limit": of.limit, "cases": of.cases })
}

/// The same as text of at most 80 columns.
fn outside_text(of: &Outside, all: usize) -> String {
    let [low, high] = of.range.map(|value| significant(value, 3));
    let range = if low == high { low } else { format!("{low} to {high}") };
    let measured = of.kind.text.replace("{}", &range);
    let Caution { code, label, consequence, action, .. } = of.kind;
    let cases = format!("{} of {}", of.cases.len(), counted(all, "case"));
    let text = format!("warning[{code}]: {label}: {measured} (target spectrum; limit ≥ {}) for {cases}. {consequence} {action}", of.limit);
    wrapped(&text, "  ")
}

pub(super) fn status(asked: &FolderArguments, watch: bool) -> Result<u8, Fault> {
    let dir = folder(asked)?;
    loop {
        let campaign = open_dir("show the state of", &dir)?;
        let units = units(&campaign);
        let mut text = if asked.json {
            format!("{:#}\n", queued(answer(&campaign, &units), &campaign))
        } else {
            describe(&campaign, &units, |_, _| String::new())
        };
        if !asked.json {
            if let Some(why) = campaign.spec_fault() {
                text += &format!("warning: {why}: the spec of this folder may differ from the one that was run\n");
            }
            text += &in_queue(&campaign);
            let does = |open| format!("{} pending; resume with `{}`.\n", counted(open, "task"), resuming(&campaign.dir));
            text += &remaining(&units, &campaign, does);
        }
        if watch && !asked.json && std::io::stdout().is_terminal() {
            clear_screen();
        }
        let heard = say(&text)?;
        if !watch || !heard || left(&units) == 0 {
            return Ok(0);
        }
        std::thread::sleep(EVERY);
    }
}

/// Pending tasks in a sentence, and failed ones.
fn remaining(units: &Units, campaign: &Campaign, does: impl Fn(usize) -> String) -> String {
    // Where a surface failed, its cycles did too.
    let of_stage = |units: &[(String, Standing)]| units.iter().filter(|(_, s)| matches!(s, Standing::Failed(_))).count();
    let failed = units.iter().map(|(_, units)| of_stage(units)).max().unwrap_or(0);
    match (left(units), failed) {
        (0, 0) => "Nothing is left to do.\n".to_owned(),
        (0, failed) => format!("All other tasks are done. {}", failed_cases(failed, &campaign.dir)),
        (open, 0) => does(open),
        (open, failed) => does(open) + &failed_cases(failed, &campaign.dir),
    }
}

/// Clears the terminal.
fn clear_screen() {
    let _ = std::io::stdout().lock().write_all(b"\x1b[H\x1b[2J");
}

fn units(campaign: &Campaign) -> Units {
    let survey = campaign.survey(Check::Sizes);
    let ids = || campaign.surfaces.iter().map(|unit| unit.id.clone());
    vec![
        (Stage::Generate, ids().zip(survey.surfaces).collect()),
        (Stage::Extract, ids().zip(survey.asperities).collect()),
        (Stage::Cycle, survey.cycles.into_iter().map(|(place, standing)| (campaign.cycles[place].id.clone(), standing)).collect()),
        (Stage::Aggregate, vec![(STATISTICS.to_owned(), survey.statistics)]),
        (Stage::Report, vec![(REPORT_PAGE.to_owned(), survey.report)]),
    ]
}

/// The state of submitted jobs in Slurm's queue. Finished tasks are known by their files.
fn in_queue(campaign: &Campaign) -> String {
    let sent = match submit::sent(campaign) {
        Ok(sent) if sent.is_empty() => return String::new(),
        Ok(sent) => sent,
        Err(fault) => return format!("slurm     {}\n", fault.text),
    };
    let Some(queue) = submit::queue(&sent) else {
        return format!("slurm     {} submitted; the queue cannot be asked here\n", counted(sent.len(), "job"));
    };
    let counted: Vec<String> = queue.states.iter().map(|(state, count)| format!("{count} {state}")).collect();
    format!("slurm     {}\n", if counted.is_empty() { "nothing in the queue".to_owned() } else { counted.join(", ") })
}

/// The number of pending tasks.
fn left(units: &Units) -> usize {
    units.iter().flat_map(|(_, units)| units).filter(|(_, standing)| !matches!(standing, Standing::Done | Standing::Failed(_))).count()
}

fn answer(campaign: &Campaign, units: &Units) -> Value {
    let stages: Vec<_> = units
        .iter()
        .map(|(stage, units)| {
            let units: Vec<_> =
                units.iter().map(|(id, s)| json!({ "id": id, "state": s.word(), "why": s.why().unwrap_or_default() })).collect();
            json!({ "stage": stage.word(), "units": units })
        })
        .collect();
    json!({ "name": campaign.spec.name, "dir": campaign.dir.display().to_string(), "stages": stages })
}

/// The same with the jobs that were submitted, if any: the number of tasks in each state, or null where the queue cannot be asked.
fn queued(mut answer: Value, campaign: &Campaign) -> Value {
    if let Ok(sent) = submit::sent(campaign)
        && !sent.is_empty()
    {
        let states = submit::queue(&sent).map(|queue| queue.states);
        answer["slurm"] = json!({ "job_count": sent.len(), "tasks": states });
    }
    answer
}

/// The number of tasks in each state by stage, with failed and damaged ones, and further lines on the tasks of a stage.
fn describe(campaign: &Campaign, units: &Units, further: impl Fn(Stage, &[(String, Standing)]) -> String) -> String {
    let (name, dir) = (&campaign.spec.name, shown(&campaign.dir));
    let mut text = format!("{name} in {dir}: {}, {}\n", counted(campaign.cases.len(), "case"), campaign.realizations_in_words());
    for (stage, units) in units {
        let counted: Vec<String> = Standing::WORDS
            .iter()
            .map(|state| (state, units.iter().filter(|(_, s)| s.word() == *state).count()))
            .filter(|(_, count)| *count > 0)
            .map(|(state, count)| format!("{count} {state}"))
            .collect();
        text += &format!("{:9} {}\n", stage.word(), counted.join(", "));
        for (id, standing) in units.iter().filter(|(_, s)| s.why().is_some() || *s == Standing::Stale) {
            let why = standing.why().map_or_else(String::new, |why| format!(": {}", visible(&why.replace('\n', "; "))));
            let verb = if matches!(standing, Standing::Failed(_)) { "failed" } else { &format!("is {}", standing.word()) };
            text += &format!("  {id} {verb}{why}\n");
        }
        text += &further(*stage, units);
    }
    text
}
