//! Commands that compute: `run`, one for each stage, `retry`, `compare`.

use super::ending::{Ended, tally_json};
use super::place::{folder, folder_of, not_the_root, open, open_dir};
use super::verdicts::run_text;
use super::{BAD_SPEC, FAILED_CASES, Fault, failed, grids, probes, say, spectra, submit, viewer};
use crate::campaign::{Campaign, Shard, Stage, Standing};
use crate::cli::arguments::TalkArguments;
use crate::cli::progress::Teller;
use crate::cli::{FolderArguments, HowArguments, interrupt};
use crate::schema;
use crate::stages::{self, Comparison, StageError, Task, Watch as _, foreseen};
use crate::stats::{Shown, significant};
use crate::store::{Check, FrameError};
use crate::text::{shell_path, shown, visible, wrapped};
use serde_json::json;
use std::collections::HashSet;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Request of a command.
pub(super) struct Request {
    /// Stages, in their order.
    pub(super) stages: RangeInclusive<Stage>,
    /// True if tables may lack cycles.
    pub(super) partial: bool,
    /// True if the report is opened at the end.
    pub(super) open: bool,
}

impl Request {
    /// One stage, all of it.
    pub(super) fn one(stage: Stage) -> Self {
        Self { stages: stage..=stage, partial: false, open: false }
    }
}

pub(super) fn stages(spec: &Path, arguments: &HowArguments, request: Request) -> Result<u8, Fault> {
    let Request { stages, partial, open: view } = request;
    let (from, until) = stages.into_inner();
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
    let code = perform(
        campaign,
        &Task { shard, partial, check, ..Task::new(from, until) },
        arguments.output.json,
        arguments.talk,
    )?;
    if view {
        viewer::open(&report);
    }
    Ok(code)
}

/// `compare` and `report --compare`.
pub(super) fn compare(
    runs: &[PathBuf],
    out: Option<&Path>,
    force: bool,
    json: bool,
    view: bool,
) -> Result<u8, Fault> {
    if runs.len() < 2 {
        let text =
            "error: a comparison needs two runs\nhelp: `hysteron compare DIR DIR` compares the second run \
             with the first one"
                .to_owned();
        return Err(Fault { code: BAD_SPEC, text });
    }
    let folders = runs.iter().map(|run| folder_of(run)).collect::<Result<Vec<PathBuf>, Fault>>()?;
    let out = out.unwrap_or(Path::new("data/runs/comparison"));
    not_the_root(out)?;
    let compared = stages::compare(&folders, out, force).map_err(failed)?;
    let table = out.join(schema::COMPARISON.file);
    say(&if json {
        format!(
            "{:#}\n",
            json!({ "report": compared.page.display().to_string(), "table": table.display().to_string() })
        )
    } else {
        format!(
            "{}Report: {}\nTable: {}\n",
            differences(&compared).map_err(failed)?,
            shown(&compared.page),
            shown(&table)
        )
    })?;
    if view {
        viewer::open(&compared.page);
    }
    Ok(0)
}

/// Differences that are printed; the table has all.
const PRINTED: usize = 40;

/// The differences, case by case.
fn differences(compared: &Comparison) -> Result<String, FrameError> {
    let table = &compared.table;
    let (groups, runs, quantities) = (table.i64("group")?, table.text("campaign")?, table.text("quantity")?);
    let (means, references, differences) =
        (table.f64("mean")?, table.f64("reference_mean")?, table.f64("difference")?);
    let intervals = table.f64_or_null("difference_ci95")?;
    let mut text = String::new();
    for row in 0..table.row_count().min(PRINTED) {
        if row == 0 || groups[row] != groups[row - 1] || runs[row] != runs[row - 1] {
            let name = usize::try_from(groups[row])
                .ok()
                .and_then(|group| compared.names.get(group))
                .map_or("", String::as_str);
            let heading = format!("{name}: {} against {}", runs[row], table.text("reference")?[row]);
            text += &wrapped(&visible(&heading), "  ");
        }
        let number = |value: f64| significant(value, 3);
        let interval = intervals[row].map_or_else(String::new, |half| format!(" ± {}", number(half)));
        text += &format!(
            "  {:26} {:>10} {:>10}  {}{interval}\n",
            quantities[row],
            number(means[row]),
            number(references[row]),
            number(differences[row])
        );
    }
    if table.row_count() > PRINTED {
        text += &format!("… and {} more rows in the table\n", table.row_count() - PRINTED);
    }
    let legend = "Columns: quantity, mean of the run, mean of the reference, difference ± half-width of its \
         95 % confidence interval.";
    Ok(text + &wrapped(legend, ""))
}

pub(super) fn retry(asked: &FolderArguments, ids: &[String], talk: TalkArguments) -> Result<u8, Fault> {
    let dir = folder(asked)?;
    let campaign = open_dir("retry the failed cycles of", &dir)?;
    if let Some(why) = campaign.spec_fault() {
        let dir = shown(&dir);
        return Err(failed(format!(
            "cannot retry the failed cycles of {dir}: {why}\nhelp: run `hysteron run SPEC` first"
        )));
    }
    let standings = campaign.cycle_standings(Check::Sizes);
    let units = campaign.cycles.iter().zip(standings);
    let failures: HashSet<String> =
        units.filter(|(_, s)| matches!(s, Standing::Failed(_))).map(|(unit, _)| unit.id.clone()).collect();
    if let Some(strange) = ids.iter().find(|id| !failures.contains(*id)) {
        let mut known: Vec<&str> = failures.iter().map(String::as_str).collect();
        known.sort_unstable();
        let known = if known.is_empty() {
            "no cycle has failed".to_owned()
        } else {
            format!("failed are: {}", known.join(", "))
        };
        return Err(failed(format!(
            "cannot retry {strange}: it has not failed in {}\nhelp: {known}",
            shown(&dir)
        )));
    }
    if failures.is_empty() {
        say("Nothing to retry: no cycle has failed.\n")?;
        return Ok(0);
    }
    let retried = if ids.is_empty() { failures } else { ids.iter().cloned().collect() };
    let task = Task { retried, shard: Shard::default(), ..Task::new(Stage::Generate, Stage::Report) };
    perform(campaign, &task, asked.json, talk)
}

fn perform(campaign: Campaign, task: &Task, json: bool, talk: TalkArguments) -> Result<u8, Fault> {
    let teller = Arc::new(Teller::new(talk));
    interrupt::expect(teller.clone(), &campaign.dir).map_err(failed)?;
    let dir = campaign.dir.clone();
    let has_cycles = (task.from..=task.until).contains(&Stage::Cycle);
    let is_open = |standing: &Standing| !standing.is_settled();
    if has_cycles && !talk.quiet && campaign.cycle_standings(Check::Sizes).iter().any(is_open) {
        let foreseen = foreseen(&campaign);
        let before = spectra::text(&campaign) + &probes::text(&campaign, &foreseen.verdicts);
        let unread = grids::text(&campaign);
        let unread = if unread.is_empty() { unread } else { format!("\n{}", unread.trim_end()) };
        teller.notice(&(before + &run_text(&foreseen) + &unread));
    }
    let jobs = submit::sent(&campaign).unwrap_or_default();
    let again = submit::again(&campaign, &jobs);
    let (campaign, tallies) =
        rayon::scope(|_| stages::run(campaign, task, &*teller)).map_err(|error| match &error {
            StageError::Incomplete { .. } if !jobs.is_empty() => {
                let text = error.to_string();
                let problem = text.split_once("\nhelp:").map_or(text.as_str(), |(problem, _)| problem);
                let help = if submit::is_queued(&jobs) {
                    format!(
                        "jobs of the run are in the Slurm queue; wait until they have ended (`hysteron \
                     status {}`)",
                        shell_path(&dir)
                    )
                } else {
                    format!("submit them with `{again}`")
                };
                failed(format!("{problem}\nhelp: {help}"))
            }
            _ => failed(error),
        })?;
    let ended = Ended::of(&campaign, task.shard, &tallies, teller.elapsed());
    if json {
        say(&tally_json(&ended))?;
    } else if !talk.quiet {
        say(&ended.conclusion(task.until, if talk.verbose { Shown::All } else { Shown::Few })?)?;
    } else {
        let warnings = ended.warnings(task.until)?;
        if !warnings.is_empty() {
            teller.notice(&warnings);
        }
    }
    Ok(if ended.lacks_results() { FAILED_CASES } else { 0 })
}
