//! One function for each command.

mod about;
mod care;
mod causes;
mod csv;
mod ending;
mod export;
mod findings;
mod grids;
mod living;
mod measured;
mod outputs;
mod place;
mod probes;
mod psd;
mod show;
mod spectra;
mod submit;
mod survey;
mod verdicts;
mod viewer;
mod work;

pub(super) use measured::LIMITS as IMPORT;

use super::colour::painted;
use super::exit::{BAD_SPEC, FAILED, FAILED_CASES};
use super::limits;
use super::{CampaignArguments, EngineArgument, ExportVerb, JobsArguments, StageArgument, Verb};
use crate::campaign::Stage;
use crate::text::{printable, shown};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// An error with its exit code.
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
            let mut output = std::io::stderr().lock();
            let _ = writeln!(output, "{}", painted(printable(&fault.text), output.is_terminal()));
            ExitCode::from(fault.code)
        }
    }
}

/// The threads of a command that computes; nothing for one that does not.
fn jobs(verb: &Verb) -> Option<&JobsArguments> {
    match verb {
        Verb::Run { campaign, .. } | Verb::Aggregate { campaign, .. } => Some(&campaign.how.jobs),
        Verb::Generate(campaign) | Verb::Extract(campaign) | Verb::Cycle(campaign) => {
            Some(&campaign.how.jobs)
        }
        Verb::Report { campaign, .. } => Some(&campaign.jobs),
        Verb::Retry { jobs, .. } => Some(jobs),
        _ => None,
    }
}

/// Starts the threads, and checks the limits of the process for a command that computes.
fn started(verb: &Verb) -> Result<(), Fault> {
    let jobs = jobs(verb);
    if let Some(jobs) = jobs {
        limits::bound_polars(jobs.jobs);
        if let Some(why) = limits::too_little_space() {
            return Err(failed(why));
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(limits::threads(jobs.and_then(|jobs| jobs.jobs)));
    pool.build_global().map_err(|error| {
        failed(format!("cannot start the threads: {error}\nhelp: ask for fewer of them (--jobs N)"))
    })
}

fn performed(verb: &Verb) -> Result<u8, Fault> {
    match verb {
        Verb::Init { template, list } => about::init(*template, *list),
        Verb::Run { campaign, dry_run: true, .. } => survey::plan(&campaign.spec, &campaign.how.output),
        Verb::Run { campaign, until, open, .. } => {
            viewer::possible(*open, *until == StageArgument::Report)?;
            let stages = Stage::Generate..=stage(*until);
            work::stages(&campaign.spec, &campaign.how, work::Request { stages, partial: false, open: *open })
        }
        Verb::Generate(campaign) => of_spec(campaign, work::Request::one(Stage::Generate)),
        Verb::Extract(campaign) => of_spec(campaign, work::Request::one(Stage::Extract)),
        Verb::Cycle(campaign) => of_spec(campaign, work::Request::one(Stage::Cycle)),
        Verb::Aggregate { campaign, partial } => {
            of_spec(campaign, work::Request { partial: *partial, ..work::Request::one(Stage::Aggregate) })
        }
        Verb::Report { spec: Some(spec), compare, campaign, open, .. } if compare.is_empty() => {
            work::stages(spec, campaign, work::Request { open: *open, ..work::Request::one(Stage::Report) })
        }
        Verb::Report { spec, compare, force, campaign, open } => {
            let runs: Vec<PathBuf> = spec.iter().chain(compare).cloned().collect();
            work::compare(&runs, campaign.output.out.as_deref(), *force, campaign.output.json, *open)
        }
        Verb::Compare(asked) => {
            work::compare(&asked.runs, asked.out.as_deref(), asked.force, asked.json, asked.open)
        }
        Verb::Findings(asked) => findings::findings(&asked.runs, asked.json),
        Verb::Show { folder, id } => show::show(folder, id),
        Verb::Cite { folder } => show::cite(folder),
        Verb::Plan { spec, output } => survey::plan(spec, output),
        Verb::Status { folder, watch } => survey::status(folder, *watch),
        Verb::Explain { folder, id, spec } => care::explain(folder, id, spec.as_deref()),
        Verb::Verify { folder, deep } => care::verify(folder, *deep),
        Verb::Retry { folder, ids, talk, .. } => work::retry(folder, ids, *talk),
        Verb::Gc { folder, keep, delete } => care::gc(folder, keep, *delete),
        Verb::Submit { spec, output, engine: EngineArgument::Slurm, shards, cpus, option, dry_run } => {
            submit::slurm(spec, output, shards.shards, (*cpus, option), *dry_run)
        }
        Verb::Export { what: ExportVerb::Csv(asked) } => csv::export(asked),
        Verb::Export { what: ExportVerb::Snakemake { spec, output, shards, force } } => {
            export::snakemake(spec, output, shards.shards, *force)
        }
        Verb::Export { what: ExportVerb::RoCrate { folder, license, publisher, force } } => {
            export::ro_crate(folder, license.as_deref(), publisher.as_deref(), *force)
        }
        Verb::Export { what: ExportVerb::Psd(asked) } => psd::export(asked),
        Verb::Export { what: ExportVerb::Netcdf(asked) } => {
            measured::export(asked, &measured::Layout::NetCdf)
        }
        Verb::Export { what: ExportVerb::Tamaas(asked) } => {
            measured::export(asked, &measured::Layout::Tamaas)
        }
        Verb::Import(asked) => measured::import(asked),
        Verb::Schema { file, write, force } => about::schemas(file.as_deref(), *write, *force),
        Verb::Completions { shell } => about::completions(*shell),
        Verb::Man { verb, dir, force } => about::man(verb.as_deref(), dir.as_deref(), *force),
    }
}

fn of_spec(campaign: &CampaignArguments, request: work::Request) -> Result<u8, Fault> {
    work::stages(&campaign.spec, &campaign.how, request)
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

/// Prints to standard output, control characters as escapes. Returns whether the output is still read: a
/// closed pipe (`| head`) is no error.
fn say(text: &str) -> Result<bool, Fault> {
    let mut output = std::io::stdout().lock();
    let text = painted(printable(text), output.is_terminal());
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(failed(format!("cannot write to standard output: {error}"))),
    }
}

fn make_folder(folder: &Path) -> Result<(), Fault> {
    if folder.is_file() {
        let help = "name a folder, or remove the file";
        return Err(failed(format!("cannot make the folder {}: it is a file\nhelp: {help}", shown(folder))));
    }
    std::fs::create_dir_all(folder)
        .map_err(|error| failed(format!("cannot make the folder {}: {error}", shown(folder))))
}

/// The path of this program, for other programs that start it.
fn own_file() -> Result<PathBuf, Fault> {
    std::env::current_exe().map_err(|error| failed(format!("cannot find the program's own file: {error}")))
}
