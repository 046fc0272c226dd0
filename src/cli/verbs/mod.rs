//! One function for each verb.

mod about;
mod care;
mod export;
mod measured;
mod submit;
mod survey;
mod work;

use super::limits;
use super::reference::{BAD_SPEC, FAILED, FAILED_CASES};
use super::{CampaignArguments, EngineArgument, ExportVerb, JobsArguments, OutputArguments, StageArgument, Verb};
use crate::campaign::{Campaign, Stage};
use crate::spec::Spec;
use crate::stages;
use crate::text::{counted, printable, shell_path, shown};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What went wrong, with the exit code that says it.
struct Fault {
    code: u8,
    text: String,
}

fn failed(error: impl std::fmt::Display) -> Fault {
    Fault { code: FAILED, text: format!("error: {error}") }
}

pub(super) fn perform(verb: &Verb) -> ExitCode {
    match started(verb).and_then(|()| performed(verb)) {
        Ok(code) => ExitCode::from(code),
        Err(fault) => {
            let _ = writeln!(std::io::stderr().lock(), "{}", printable(&fault.text));
            ExitCode::from(fault.code)
        }
    }
}

/// The threads of a command that computes; nothing for one that does not.
fn jobs(verb: &Verb) -> Option<&JobsArguments> {
    match verb {
        Verb::Run { campaign, .. } | Verb::Aggregate { campaign, .. } => Some(&campaign.how.jobs),
        Verb::Generate(campaign) | Verb::Extract(campaign) | Verb::Cycle(campaign) => Some(&campaign.how.jobs),
        Verb::Report { campaign, .. } => Some(&campaign.jobs),
        Verb::Retry { jobs, .. } => Some(jobs),
        _ => None,
    }
}

/// Starts the threads, and looks at the limits of the process where it is to compute.
fn started(verb: &Verb) -> Result<(), Fault> {
    let jobs = jobs(verb);
    if let Some(jobs) = jobs {
        limits::bound_polars(jobs.jobs);
        if let Some(why) = limits::too_little_space() {
            return Err(failed(why));
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(limits::threads(jobs.and_then(|jobs| jobs.jobs)));
    pool.build_global().map_err(|error| failed(format!("cannot start the threads: {error}\nhelp: ask for fewer of them (--jobs N)")))
}

fn performed(verb: &Verb) -> Result<u8, Fault> {
    match verb {
        Verb::Run { campaign, until } => of_spec(campaign, (Stage::Generate, stage(*until)), false),
        Verb::Generate(campaign) => of_spec(campaign, (Stage::Generate, Stage::Generate), false),
        Verb::Extract(campaign) => of_spec(campaign, (Stage::Extract, Stage::Extract), false),
        Verb::Cycle(campaign) => of_spec(campaign, (Stage::Cycle, Stage::Cycle), false),
        Verb::Aggregate { campaign, partial } => of_spec(campaign, (Stage::Aggregate, Stage::Aggregate), *partial),
        Verb::Report { spec: Some(spec), campaign, .. } => work::stages(spec, campaign, (Stage::Report, Stage::Report), false),
        Verb::Report { compare, campaign, .. } => work::compare(compare, campaign),
        Verb::Plan { spec, output } => survey::plan(spec, output),
        Verb::Status { folder, watch } => survey::status(folder, *watch),
        Verb::Explain { folder, id, spec } => care::explain(folder, id, spec.as_deref()),
        Verb::Verify { folder, deep } => care::verify(folder, *deep),
        Verb::Retry { folder, ids, .. } => work::retry(folder, ids),
        Verb::Gc { folder, keep, delete } => care::gc(folder, keep, *delete),
        Verb::Submit { spec, output, engine: EngineArgument::Slurm, shards, cpus, option, dry_run } => {
            submit::slurm(spec, output, shards.shards, (*cpus, option), *dry_run)
        }
        Verb::Export { what: ExportVerb::Snakemake { spec, output, shards } } => export::snakemake(spec, output, shards.shards),
        Verb::Export { what: ExportVerb::RoCrate { folder, license } } => export::ro_crate(folder, license.as_deref()),
        Verb::Export { what: ExportVerb::Netcdf(asked) } => measured::export(asked, &measured::Layout::NetCdf),
        Verb::Export { what: ExportVerb::Tamaas(asked) } => measured::export(asked, &measured::Layout::Tamaas),
        Verb::Import(asked) => measured::import(asked),
        Verb::Schema { file, write } => about::schemas(file.as_deref(), *write),
        Verb::Completions { shell } => about::completions(*shell),
        Verb::Man { verb, dir } => about::man(verb.as_deref(), dir.as_deref()),
    }
}

fn of_spec(campaign: &CampaignArguments, stages: (Stage, Stage), partial: bool) -> Result<u8, Fault> {
    work::stages(&campaign.spec, &campaign.how, stages, partial)
}

/// A sentence on cases that failed, and the command that runs them again.
fn failed_cases(failures: usize, dir: &Path) -> String {
    let them = if failures == 1 { "it" } else { "them" };
    format!("{} failed; `hysteron retry {}` tries {them} again.\n", counted(failures, "case"), shell_path(dir))
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

/// Prints to standard output, control characters as escapes, and says whether somebody reads it: one who has gone away (`| head`) is no fault.
fn say(text: &str) -> Result<bool, Fault> {
    let mut output = std::io::stdout().lock();
    match output.write_all(printable(text).as_bytes()).and_then(|()| output.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(failed(format!("cannot write to standard output: {error}"))),
    }
}

fn open(spec: &Path, output: &OutputArguments) -> Result<Campaign, Fault> {
    let spec = Spec::read(spec).map_err(|errors| Fault { code: BAD_SPEC, text: errors.to_string() })?;
    let dir = output.out.clone().unwrap_or_else(|| PathBuf::from("data/runs").join(&spec.name));
    not_the_root(&dir)?;
    stages::sampled(Campaign::new(spec, dir)).map_err(failed)
}

/// Refuses the root folder, which is nobody's output folder.
fn not_the_root(dir: &Path) -> Result<(), Fault> {
    match dir.canonicalize() {
        Ok(found) if found.parent().is_none() => {
            let text =
                format!("error: the output folder cannot be {}, the root folder\nhelp: name a folder of its own (--out DIR)", shown(dir));
            Err(Fault { code: BAD_SPEC, text })
        }
        _ => Ok(()),
    }
}

/// A folder by its whole name, as other programs are to be told of it: they read it as text.
fn told(dir: &Path) -> Result<PathBuf, Fault> {
    let refused = |why: String| failed(format!("cannot tell other programs of {}: {why}", shown(dir)));
    let dir = std::path::absolute(dir).map_err(|error| refused(error.to_string()))?;
    let strange = |c: char| c.is_control() || matches!(c, '{' | '}' | '%' | '"' | '\\');
    match dir.to_str().map(|name| name.chars().find(|c| strange(*c))) {
        Some(None) => Ok(dir),
        Some(Some(c)) => Err(refused(format!("its name has {c:?}; allowed: no control characters, and none of {{ }} % \" \\"))),
        None => Err(refused("its name is no Unicode; allowed: a name that is".to_owned())),
    }
}

fn make_folder(folder: &Path) -> Result<(), Fault> {
    std::fs::create_dir_all(folder).map_err(|error| failed(format!("cannot make the folder {}: {error}", shown(folder))))
}

/// The program itself, as another one is to start it.
fn own_file() -> Result<PathBuf, Fault> {
    std::env::current_exe().map_err(|error| failed(format!("cannot find the program's own file: {error}")))
}

/// The campaign whose results a folder holds.
fn open_dir(action: &str, dir: &Path) -> Result<Campaign, Fault> {
    let path = dir.join("campaign.toml");
    if !path.is_file() {
        let dir = shown(dir);
        return Err(failed(format!("cannot {action} {dir}: it has no campaign.toml; allowed: the output folder of a run")));
    }
    open(&path, &OutputArguments { out: Some(dir.to_owned()), json: false })
}
