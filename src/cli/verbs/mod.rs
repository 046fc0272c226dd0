//! One function for each verb.

mod about;
mod care;
mod export;
mod measured;
mod submit;
mod survey;
mod work;

use super::{CampaignArguments, EngineArgument, ExportVerb, OutputArguments, StageArgument, Verb};
use crate::campaign::{Campaign, Stage};
use crate::schema;
use crate::spec::Spec;
use crate::stages;
use crate::store::commit;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

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
    match threads(jobs(verb)).and_then(|()| performed(verb)) {
        Ok(code) => ExitCode::from(code),
        Err(fault) => {
            let _ = writeln!(std::io::stderr().lock(), "{}", fault.text);
            ExitCode::from(fault.code)
        }
    }
}

/// How many threads are asked for.
fn jobs(verb: &Verb) -> Option<u16> {
    match verb {
        Verb::Run { campaign, .. } | Verb::Aggregate { campaign, .. } => campaign.how.jobs.jobs,
        Verb::Generate(campaign) | Verb::Extract(campaign) | Verb::Cycle(campaign) => campaign.how.jobs.jobs,
        Verb::Report { campaign, .. } => campaign.jobs.jobs,
        Verb::Retry { jobs, .. } => jobs.jobs,
        _ => None,
    }
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
        Verb::Schema { write } => schemas(*write),
        Verb::Completions { shell } => about::completions(*shell),
        Verb::Man { verb, dir } => about::man(verb.as_deref(), dir.as_deref()),
    }
}

fn of_spec(campaign: &CampaignArguments, stages: (Stage, Stage), partial: bool) -> Result<u8, Fault> {
    work::stages(&campaign.spec, &campaign.how, stages, partial)
}

/// How many cases failed, and what they are called after that.
fn counted(failures: usize) -> (String, &'static str) {
    if failures == 1 { ("1 case".to_owned(), "it") } else { (format!("{failures} cases"), "them") }
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

/// Prints to standard output, and says whether somebody reads it: one who has gone away (`| head`) is no fault.
fn say(text: &str) -> Result<bool, Fault> {
    let mut output = std::io::stdout().lock();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(failed(format!("cannot write to standard output: {error}"))),
    }
}

/// The threads of everything that follows: as many as there are cores, unless it is said.
fn threads(count: Option<u16>) -> Result<(), Fault> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count.map_or(0, usize::from));
    pool.build_global().map_err(|error| failed(format!("cannot start the threads: {error}; allowed: fewer of them (--jobs N)")))
}

fn open(spec: &Path, output: &OutputArguments) -> Result<Campaign, Fault> {
    let spec = Spec::read(spec).map_err(|errors| Fault { code: BAD_SPEC, text: errors.to_string() })?;
    let dir = output.out.clone().unwrap_or_else(|| PathBuf::from("data/runs").join(&spec.name));
    stages::sampled(Campaign::new(spec, dir)).map_err(failed)
}

/// A folder by its whole name, as other programs are to be told of it: they read it as text.
fn told(dir: &Path) -> Result<PathBuf, Fault> {
    let refused = |why: String| failed(format!("cannot tell other programs of {}: {why}", dir.display()));
    let dir = std::path::absolute(dir).map_err(|error| refused(error.to_string()))?;
    let strange = |c: char| c.is_control() || matches!(c, '{' | '}' | '%' | '"' | '\\');
    match dir.to_str().map(|name| name.chars().find(|c| strange(*c))) {
        Some(None) => Ok(dir),
        Some(Some(c)) => Err(refused(format!("its name has {c:?}; allowed: no control characters, and none of {{ }} % \" \\"))),
        None => Err(refused("its name is no Unicode; allowed: a name that is".to_owned())),
    }
}

fn make_folder(folder: &Path) -> Result<(), Fault> {
    std::fs::create_dir_all(folder).map_err(|error| failed(format!("cannot make the folder {}: {error}", folder.display())))
}

/// The program itself, as another one is to start it.
fn own_file() -> Result<PathBuf, Fault> {
    std::env::current_exe().map_err(|error| failed(format!("cannot find the program's own file: {error}")))
}

/// The campaign whose results a folder holds.
fn open_dir(action: &str, dir: &Path) -> Result<Campaign, Fault> {
    let path = dir.join("campaign.toml");
    if !path.is_file() {
        let dir = dir.display();
        return Err(failed(format!("cannot {action} {dir}: it has no campaign.toml; allowed: the output folder of a run")));
    }
    open(&path, &OutputArguments { out: Some(dir.to_owned()), json: false })
}

fn schemas(write: bool) -> Result<u8, Fault> {
    let folder = Path::new(schema::DIRECTORY);
    if write {
        make_folder(folder)?;
    }
    for file in schema::files() {
        if write {
            commit::commit_bytes("write a schema", &folder.join(&file.name), file.content.as_bytes()).map_err(failed)?;
        } else if file.name.ends_with(".json") {
            say(&file.content)?;
            say("\n")?;
        }
    }
    Ok(0)
}
