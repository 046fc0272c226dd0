//! Commands that show the state of a run: `plan` and `status`. They write nothing.

use super::causes::causes;
use super::ending::{failed_coarser_grids, failed_cycles};
use super::living::{Living, Units, left};
use super::place::{folder, open, open_dir, resuming};
use super::verdicts::outside_json;
use super::{Fault, failed, grids, probes, say, spectra, submit, verdicts};
use crate::campaign::{Campaign, CycleUnit, REPORT_PAGE, STATISTICS, Stage, Standing, Survey};
use crate::cli::{FolderArguments, OutputArguments};
use crate::engines::slurm::{Queue, Sent};
use crate::stages::{above_error, foreseen};
use crate::store::Check;
use crate::text::{counted, shown, visible};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::{IsTerminal, Write as _};
use std::path::Path;
use std::time::Duration;

/// Period of `status --watch`.
const EVERY: Duration = Duration::from_secs(2);

/// Observations of an empty queue after which `status --watch` ends.
const MOST_IDLE: usize = 2;

/// Tasks of Slurm that are listed.
const LISTED: usize = 10;

pub(super) fn plan(spec: &Path, output: &OutputArguments) -> Result<u8, Fault> {
    let campaign = open(spec, output)?;
    let units = units(&campaign, campaign.survey(Check::Sizes));
    let foreseen = foreseen(&campaign);
    let text = if output.json {
        let mut answer = answer(&campaign, &units);
        answer["outside_range"] = foreseen.warnings.iter().map(outside_json).collect();
        answer["cases"] = foreseen.verdicts.iter().map(verdicts::json).collect();
        format!("{answer:#}\n")
    } else {
        let reasons = |stage: Stage, units: &[(String, Standing)]| causes(&campaign, stage, units);
        describe(&campaign, &units, reasons)
            + &spectra::text(&campaign)
            + &probes::text(&campaign, &foreseen.verdicts)
            + &verdicts::plan_text(&foreseen)
            + &grids::text(&campaign)
            + &remaining(&units, &campaign, |open| {
                format!("`run` would compute {}.\n", counted(open, "task"))
            })
    };
    say(&text)?;
    Ok(0)
}

pub(super) fn status(asked: &FolderArguments, watch: bool) -> Result<u8, Fault> {
    let dir = folder(asked)?;
    let (mut idle, mut was_living) = (0, false);
    loop {
        let campaign = open_dir("show the state of", &dir)?;
        // Before the files: what ends in between is done.
        let living = Living::of(&campaign);
        let survey = campaign.survey(Check::Sizes);
        let slurm = Slurm::of(&campaign, &survey);
        let mut units = units(&campaign, survey);
        living.mark(&campaign, &mut units);
        let above = if asked.json { String::new() } else { grids::above(&campaign)? };
        let mut text = if asked.json {
            let mut answer = answer(&campaign, &units);
            answer["above_grid_error"] = above_json(&campaign)?;
            answer["processes"] = json!(living.alive);
            if let Some(of_slurm) = slurm.answer() {
                answer["slurm"] = of_slurm;
            }
            format!("{answer:#}\n")
        } else {
            let further = |stage: Stage| if stage == Stage::Cycle { above.as_str() } else { "" };
            describe(&campaign, &units, |stage, _| further(stage).to_owned() + &living.tasks(stage))
        };
        if !asked.json {
            if let Some(why) = campaign.spec_fault() {
                text += &format!(
                    "warning: {why}: the spec of this folder may differ from the one that was run\n"
                );
            }
            text += &slurm.lines();
            text += &living.lines();
            let pending = |open| {
                living
                    .pending(&units, &resuming(&campaign.dir))
                    .unwrap_or_else(|| slurm.pending(open, &campaign))
            };
            text += &remaining(&units, &campaign, pending);
        }
        if watch && !asked.json && std::io::stdout().is_terminal() {
            clear_screen();
        }
        let heard = say(&text)?;
        if !watch || !heard || left(&units) == 0 {
            return Ok(0);
        }
        // A file system of a network may show the last files late.
        was_living |= !living.alive.is_empty();
        let ended = was_living && matches!(slurm, Slurm::None);
        idle = if living.alive.is_empty() && (ended || slurm.is_idle()) { idle + 1 } else { 0 };
        if idle > MOST_IDLE {
            let what = if ended { "process computes them" } else { "job of the run is in the Slurm queue" };
            let action = if ended { "resume the run" } else { "submit them" };
            return Err(failed(format!(
                "tasks are pending, but no {what}\nhelp: {action} with the command above"
            )));
        }
        std::thread::sleep(EVERY);
    }
}

/// Jobs that were submitted for a campaign.
enum Slurm {
    /// None.
    None,
    /// The list of them cannot be read: why.
    Unreadable(String),
    /// With the queue, if it answers, and with tasks that have left it with work undone.
    Sent { jobs: Vec<Sent>, queue: Option<Queue>, ended: Vec<submit::Ended> },
}

impl Slurm {
    fn of(campaign: &Campaign, survey: &Survey) -> Self {
        let jobs = match submit::sent(campaign) {
            Ok(jobs) if jobs.is_empty() => return Self::None,
            Ok(jobs) => jobs,
            Err(fault) => return Self::Unreadable(fault.text),
        };
        let queue = submit::queue(&jobs);
        let ended =
            queue.as_ref().map(|queue| submit::ended(campaign, &jobs, queue, survey)).unwrap_or_default();
        Self::Sent { jobs, queue, ended }
    }

    /// True if the queue answers that it has none of the jobs.
    fn is_idle(&self) -> bool {
        matches!(self, Self::Sent { queue: Some(queue), .. } if queue.jobs.is_empty())
    }

    /// Jobs and tasks by state, and tasks that have ended with work undone. Finished tasks are known by their
    /// files.
    fn lines(&self) -> String {
        let (jobs, queue, ended) = match self {
            Self::None => return String::new(),
            Self::Unreadable(why) => return format!("slurm     {why}\n"),
            Self::Sent { jobs, queue, ended } => (jobs, queue, ended),
        };
        let Some(queue) = queue else {
            return format!(
                "slurm     {} submitted; the queue cannot be asked here\n",
                counted(jobs.len(), "job")
            );
        };
        let mut states: Vec<String> =
            queue.states.iter().map(|(state, count)| format!("{count} {state}")).collect();
        if queue.restarts > 0 {
            states.push(counted(queue.restarts, "restart"));
        }
        let mut text = format!(
            "slurm     {}\n",
            if states.is_empty() { "nothing in the queue".to_owned() } else { states.join(", ") }
        );
        for task in ended.iter().take(LISTED) {
            let state = task.state.as_deref().unwrap_or("has ended");
            text += &format!("  {} job {} {state}, log {}\n", task.stage, task.name, shown(&task.log));
        }
        if ended.len() > LISTED {
            text += &format!("  … and {} more\n", ended.len() - LISTED);
        }
        text
    }

    /// The number of pending tasks, and how to continue.
    fn pending(&self, open: usize, campaign: &Campaign) -> String {
        let open = counted(open, "task");
        match self {
            Self::Sent { queue: Some(queue), .. } if !queue.jobs.is_empty() => {
                format!("{open} pending; jobs of the run are in the Slurm queue.\n")
            }
            Self::Sent { jobs, .. } => {
                format!("{open} pending; submit with\n  {}\n", submit::again(campaign, jobs))
            }
            Self::None | Self::Unreadable(_) => {
                format!("{open} pending; resume with `{}`.\n", resuming(&campaign.dir))
            }
        }
    }

    /// Jobs in JSON: numbers of tasks are null if the queue cannot be read.
    fn answer(&self) -> Option<Value> {
        let Self::Sent { jobs, queue, ended } = self else { return None };
        let ended: Vec<Value> = ended
            .iter()
            .map(|task| {
                json!({
                    "job": task.name, "stage": task.stage, "state": task.state,
                    "log": task.log.display().to_string(),
                })
            })
            .collect();
        Some(json!({
            "job_count": jobs.len(),
            "tasks": queue.as_ref().map(|queue| &queue.states),
            "restart_count": queue.as_ref().map(|queue| queue.restarts),
            "ended": ended,
        }))
    }
}

/// Cases whose grid error remains above the required one, in JSON.
fn above_json(campaign: &Campaign) -> Result<Value, Fault> {
    let of_cases = above_error(campaign).map_err(failed)?;
    Ok(of_cases.iter().map(|of| json!({ "case": of.case_id, "grid": of.grid, "error": of.error })).collect())
}

/// Pending tasks in a sentence, and failed ones.
fn remaining(units: &Units, campaign: &Campaign, does: impl Fn(usize) -> String) -> String {
    let coarser = coarser_names(campaign);
    let is_failed = |(_, standing): &&(String, Standing)| matches!(standing, Standing::Failed(_));
    let is_coarser = |(id, _): &&(String, Standing)| coarser.contains_key(id.as_str());
    // Where a surface failed, its cycles did too.
    let of_stage = |units: &[(String, Standing)]| {
        units.iter().filter(is_failed).filter(|unit| !is_coarser(unit)).count()
    };
    let failed = units.iter().map(|(_, units)| of_stage(units)).max().unwrap_or(0);
    let all = units.iter().flat_map(|(_, units)| units);
    let failed_coarser = match all.filter(is_failed).filter(is_coarser).count() {
        0 => String::new(),
        count => failed_coarser_grids(count),
    };
    let text = match (left(units), failed) {
        (0, 0) if failed_coarser.is_empty() => "Nothing is left to do.\n".to_owned(),
        (0, 0) => "All other tasks are done.\n".to_owned(),
        (0, failed) => format!("All other tasks are done. {}", failed_cycles(failed, &campaign.dir)),
        (open, 0) => does(open),
        (open, failed) => does(open) + &failed_cycles(failed, &campaign.dir),
    };
    failed_coarser + &text
}

/// Names of the cycles on coarser grids, by their ids.
fn coarser_names(campaign: &Campaign) -> HashMap<String, String> {
    let coarser = campaign.distinct_cycles().into_iter().filter(|unit| campaign.is_coarser_grid(unit));
    coarser.map(|unit| (unit.id.clone(), campaign.name_of(&unit))).collect()
}

/// Clears the terminal.
fn clear_screen() {
    let _ = std::io::stdout().lock().write_all(b"\x1b[H\x1b[2J");
}

fn units(campaign: &Campaign, survey: Survey) -> Units {
    let ids = || campaign.surfaces.iter().map(|unit| unit.id.clone());
    vec![
        (Stage::Generate, ids().zip(survey.surfaces).collect()),
        (Stage::Extract, ids().zip(survey.asperities).collect()),
        (
            Stage::Cycle,
            survey
                .cycles
                .into_iter()
                .map(|(place, standing)| (campaign.cycles[place].id.clone(), standing))
                .collect(),
        ),
        (Stage::Aggregate, vec![(STATISTICS.to_owned(), survey.statistics)]),
        (Stage::Report, vec![(REPORT_PAGE.to_owned(), survey.report)]),
    ]
}

/// Reason why the tables or the report are stale.
fn stale(campaign: &Campaign, stage: Stage) -> Option<String> {
    (stage > Stage::Cycle).then(|| campaign.staleness(stage, &campaign.cycle_standings(Check::Sizes)))?
}

/// Reason of a state, empty for a finished task.
fn reason(standing: &Standing) -> &str {
    standing.why().unwrap_or(match standing {
        Standing::Running => "a process computes it",
        Standing::Waiting => "a process will compute it",
        Standing::Planned => "not computed yet",
        Standing::Interrupted => "continues from its last checkpoint, or starts again",
        Standing::Stale => "computed from other parameters or by another stage version",
        Standing::Done | Standing::Failed(_) | Standing::Missing(_) | Standing::Corrupt(_) => "",
    })
}

fn answer(campaign: &Campaign, units: &Units) -> Value {
    let surfaces: HashMap<&str, &str> = campaign
        .cycles
        .iter()
        .map(|cycle| (cycle.id.as_str(), campaign.surfaces[cycle.surface].id.as_str()))
        .collect();
    let unit = |stage: Stage, (id, standing): &(String, Standing)| {
        let stale = if *standing == Standing::Stale { stale(campaign, stage) } else { None };
        let mut unit = json!({
            "id": id, "state": standing.word(), "why": stale.as_deref().unwrap_or_else(|| reason(standing)),
        });
        if let Some(surface) = surfaces.get(id.as_str()).filter(|_| stage == Stage::Cycle) {
            unit["surface"] = (*surface).into();
        }
        unit
    };
    let stages: Vec<_> = units
        .iter()
        .map(|(stage, units)| {
            json!({
                "stage": stage.word(), "units": units.iter().map(|of| unit(*stage, of)).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({ "name": campaign.spec.name, "dir": campaign.dir.display().to_string(), "stages": stages })
}

/// The number of tasks in each state by stage, with failed and damaged ones, and further lines on the tasks
/// of a stage.
fn describe(
    campaign: &Campaign,
    units: &Units,
    further: impl Fn(Stage, &[(String, Standing)]) -> String,
) -> String {
    let (name, dir) = (&campaign.spec.name, shown(&campaign.dir));
    let mut text = format!(
        "{name} in {dir}: {}{}, {}\n",
        counted(campaign.shown_cases().count(), "case"),
        coarser_grids(campaign),
        campaign.realizations_in_words()
    );
    let coarser = coarser_names(campaign);
    for (stage, units) in units {
        let counted: Vec<String> = Standing::WORDS
            .iter()
            .map(|state| (state, units.iter().filter(|(_, s)| s.word() == *state).count()))
            .filter(|(_, count)| *count > 0)
            .map(|(state, count)| format!("{count} {state}"))
            .collect();
        text += &format!("{:9} {}\n", stage.word(), counted.join(", "));
        for (id, standing) in units.iter().filter(|(_, s)| s.why().is_some() || *s == Standing::Stale) {
            let why = standing.why().map(str::to_owned).or_else(|| stale(campaign, *stage));
            let why = why.map_or_else(String::new, |why| format!(": {}", visible(&why.replace('\n', "; "))));
            let verb = if matches!(standing, Standing::Failed(_)) {
                "failed"
            } else {
                &format!("is {}", standing.word())
            };
            let name = coarser.get(id.as_str()).unwrap_or(id);
            text += &format!("  {name} {verb}{why}\n");
        }
        if *stage == Stage::Cycle {
            text += &not_reached(campaign);
        }
        text += &further(*stage, units);
    }
    text
}

/// Number of coarser grids of the cases and of their shifted copies, as in " with 4 coarser grids"; empty
/// without any.
fn coarser_grids(campaign: &Campaign) -> String {
    let copies = campaign.cases.iter().filter(|unit| unit.case.is_shifted_copy()).count();
    let grids = campaign.cases.len() - campaign.shown_cases().count() - copies;
    let of_copies = match copies {
        0 => String::new(),
        1 => " and 1 shifted copy".to_owned(),
        count => format!(" and {count} shifted copies"),
    };
    if grids + copies == 0 {
        String::new()
    } else {
        format!(" with {}{of_copies}", counted(grids, "coarser grid"))
    }
}

/// Loads of finished cycles that have no result, one line for each cycle.
fn not_reached(campaign: &Campaign) -> String {
    let of = |unit: &CycleUnit| {
        campaign
            .not_reached_in_tables(unit)
            .map(|why| format!("  {}: {}\n", campaign.name_of(unit), visible(&why)))
    };
    campaign.distinct_cycles().iter().filter_map(of).collect()
}
