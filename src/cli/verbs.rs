//! One function for each verb.

use super::interrupt;
use super::progress::Teller;
use super::{CampaignArguments, OutputArguments, StageArgument, Verb};
use crate::campaign::{Campaign, Stage, Standing};
use crate::schema;
use crate::spec::Spec;
use crate::stages::{self, Tally};
use crate::stats::summary;
use crate::store::{commit, parquet};
use serde_json::json;
use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

/// Exit codes of the contract.
const FAILED: u8 = 1;
const BAD_SPEC: u8 = 2;
const FAILED_CASES: u8 = 3;

/// What went wrong, with the exit code that says it.
struct Fault {
    code: u8,
    text: String,
}

fn failed(error: impl std::fmt::Display) -> Fault {
    Fault { code: FAILED, text: format!("error: {error}") }
}

pub(super) fn perform(verb: &Verb) -> ExitCode {
    let outcome = match verb {
        Verb::Run { campaign, until } => stages_of(campaign, Stage::Generate, stage(*until), false),
        Verb::Generate(campaign) => stages_of(campaign, Stage::Generate, Stage::Generate, false),
        Verb::Extract(campaign) => stages_of(campaign, Stage::Extract, Stage::Extract, false),
        Verb::Cycle(campaign) => stages_of(campaign, Stage::Cycle, Stage::Cycle, false),
        Verb::Aggregate { campaign, partial } => stages_of(campaign, Stage::Aggregate, Stage::Aggregate, *partial),
        Verb::Report(campaign) => stages_of(campaign, Stage::Report, Stage::Report, false),
        Verb::Plan { spec, output } => plan(spec, output),
        Verb::Status { dir, json } => status(dir, *json),
        Verb::Schema { write } => schemas(*write),
    };
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(fault) => {
            let _ = writeln!(std::io::stderr().lock(), "{}", fault.text);
            ExitCode::from(fault.code)
        }
    }
}

fn stage(argument: StageArgument) -> Stage {
    match argument {
        StageArgument::Generate => Stage::Generate,
        StageArgument::Extract => Stage::Extract,
        StageArgument::Cycle => Stage::Cycle,
        StageArgument::Aggregate => Stage::Aggregate,
        StageArgument::Report => Stage::Report,
    }
}

/// Prints to standard output; a reader that has gone away (`| head`) is no fault.
fn say(text: &str) {
    let _ = std::io::stdout().lock().write_all(text.as_bytes());
}

fn open(spec: &Path, output: &OutputArguments) -> Result<Campaign, Fault> {
    let spec = Spec::read(spec).map_err(|errors| Fault { code: BAD_SPEC, text: errors.to_string() })?;
    let dir = output.out.clone().unwrap_or_else(|| PathBuf::from("data/runs").join(&spec.name));
    Ok(Campaign::new(spec, dir))
}

fn stages_of(arguments: &CampaignArguments, from: Stage, until: Stage, partial: bool) -> Result<u8, Fault> {
    let campaign = open(&arguments.spec, &arguments.output)?;
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(jobs) = arguments.jobs {
        pool = pool.num_threads(usize::from(jobs));
    }
    let pool = pool.build().map_err(failed)?;
    let teller = Arc::new(Teller::new());
    interrupt::expect(teller.clone(), &campaign.dir).map_err(failed)?;
    let tallies = pool.install(|| stages::run(&campaign, from, until, partial, &*teller)).map_err(failed)?;
    let failures: usize = tallies.iter().map(|(_, tally)| tally.failed).sum();
    if arguments.output.json {
        say(&tally_json(&campaign, &tallies));
    } else {
        say(&conclusion(&campaign, &tallies, until)?);
    }
    Ok(if failures > 0 { FAILED_CASES } else { 0 })
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
    let failures: usize = tallies.iter().map(|(_, t)| t.failed).sum();
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
    let dir = campaign.dir.display();
    if failures > 0 {
        text += &format!("{failures} cases failed; why is in {dir}/cycles/*/failed.json. The same command tries them again.\n");
    }
    text += &match until {
        Stage::Report => format!("Report: {dir}/report.html\nTables: {dir}/statistics/*.parquet\n"),
        _ => format!("Output: {dir}\n"),
    };
    Ok(text)
}

/// How many units of each stage stand how.
fn survey(campaign: &Campaign) -> Vec<(Stage, Vec<(String, Standing)>)> {
    let surfaces = campaign.surfaces.iter().map(|unit| (unit.id.clone(), campaign.surface_standing(unit))).collect();
    let asperities = campaign.surfaces.iter().map(|unit| (unit.id.clone(), campaign.asperities_standing(unit))).collect();
    let cycles: Vec<(String, Standing)> =
        campaign.distinct_cycles().into_iter().map(|unit| (unit.id.clone(), campaign.cycle_standing(&unit))).collect();
    let done: HashSet<&str> = cycles.iter().filter(|(_, standing)| *standing == Standing::Done).map(|(id, _)| id.as_str()).collect();
    let finished: Vec<bool> = campaign.cycles.iter().map(|unit| done.contains(unit.id.as_str())).collect();
    let statistics = campaign.statistics_key(&finished);
    let report = campaign.report_standing(&campaign.report_key(&statistics));
    vec![
        (Stage::Generate, surfaces),
        (Stage::Extract, asperities),
        (Stage::Cycle, cycles),
        (Stage::Aggregate, vec![("statistics".to_owned(), campaign.statistics_standing(&statistics))]),
        (Stage::Report, vec![("report.html".to_owned(), report)]),
    ]
}

fn word(standing: &Standing) -> &'static str {
    match standing {
        Standing::Done => "done",
        Standing::Missing => "planned",
        Standing::Stale => "stale",
        Standing::Damaged(_) => "corrupt",
        Standing::Failed(_) => "failed",
        Standing::Interrupted => "interrupted",
    }
}

fn why(standing: &Standing) -> String {
    match standing {
        Standing::Damaged(why) | Standing::Failed(why) => format!(": {why}"),
        _ => String::new(),
    }
}

fn describe(campaign: &Campaign, json: bool, verb: &str) -> String {
    let survey = survey(campaign);
    if json {
        let stages: Vec<_> = survey
            .iter()
            .map(|(stage, units)| {
                let units: Vec<_> =
                    units.iter().map(|(id, s)| json!({ "id": id, "state": word(s), "why": why(s).trim_start_matches(": ") })).collect();
                json!({ "stage": stage.word(), "units": units })
            })
            .collect();
        return format!("{:#}\n", json!({ "name": campaign.spec.name, "dir": campaign.dir.display().to_string(), "stages": stages }));
    }
    let mut text = format!(
        "{} in {}: {} cases, {} realizations\n",
        campaign.spec.name,
        campaign.dir.display(),
        campaign.cases.len(),
        campaign.spec.realizations
    );
    for (stage, units) in &survey {
        let counted: Vec<String> = ["done", "planned", "interrupted", "stale", "corrupt", "failed"]
            .iter()
            .map(|state| (state, units.iter().filter(|(_, s)| word(s) == *state).count()))
            .filter(|(_, count)| *count > 0)
            .map(|(state, count)| format!("{count} {state}"))
            .collect();
        text += &format!("{:9} {}\n", stage.word(), counted.join(", "));
        for (id, standing) in units.iter().filter(|(_, s)| matches!(s, Standing::Damaged(_) | Standing::Failed(_) | Standing::Stale)) {
            text += &format!("  {id} is {}{}\n", word(standing), why(standing));
        }
    }
    let open = survey.iter().flat_map(|(_, units)| units).filter(|(_, s)| *s != Standing::Done).count();
    text += &match (verb, open) {
        (_, 0) => "Nothing is left to do.\n".to_owned(),
        ("plan", _) => format!("`run` would compute {open} units.\n"),
        _ => format!(
            "{open} units are left; `hysteron run {}/campaign.toml --out {}` does them.\n",
            campaign.dir.display(),
            campaign.dir.display()
        ),
    };
    text
}

fn plan(spec: &Path, output: &OutputArguments) -> Result<u8, Fault> {
    let campaign = open(spec, output)?;
    say(&describe(&campaign, output.json, "plan"));
    Ok(0)
}

fn status(dir: &Path, json: bool) -> Result<u8, Fault> {
    let path = dir.join("campaign.toml");
    if !path.is_file() {
        let text = format!("cannot tell the status of {}: it has no campaign.toml; allowed: the output folder of a run", dir.display());
        return Err(failed(text));
    }
    let output = OutputArguments { out: Some(dir.to_owned()), json };
    let campaign = open(&path, &output)?;
    say(&describe(&campaign, json, "status"));
    Ok(0)
}

fn schemas(write: bool) -> Result<u8, Fault> {
    let folder = Path::new(schema::DIRECTORY);
    if write {
        std::fs::create_dir_all(folder).map_err(|source| failed(format!("cannot make the folder {}: {source}", folder.display())))?;
    }
    for file in schema::files() {
        if write {
            commit::commit_bytes("write a schema", &folder.join(&file.name), file.content.as_bytes()).map_err(failed)?;
        } else if file.name.ends_with(".json") {
            say(&file.content);
            say("\n");
        }
    }
    Ok(0)
}
