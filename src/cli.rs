//! The command line: commands, options and their help.

mod arguments;
mod colour;
mod exit;
mod help;
mod interrupt;
mod limits;
mod progress;
mod reference;
mod reference_limits;
mod templates;
mod verbs;

pub use reference::{GUIDE, generated};
pub use reference_limits::constants;

use arguments::{
    CampaignArguments, CompareArguments, CsvArguments, ExportArguments, FindingsArguments, FolderArguments,
    HowArguments, ImportArguments, JobsArguments, OutputArguments, PsdArguments, ShardsArguments,
    TalkArguments,
};
use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Simulate adhesion hysteresis of rough surfaces: asperities, boundary elements
#[derive(Debug, Parser)]
#[command(
    version, term_width = 80, next_line_help = true, help_template = help::template(),
    after_help = help::EXIT_CODES
)]
pub struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Print a commented spec to start from
    Init {
        /// Name of a template, as --list shows
        #[arg(value_enum, default_value = "quickstart", hide_possible_values = true)]
        template: templates::Template,
        /// List the templates
        #[arg(long)]
        list: bool,
    },
    /// Run all pending tasks of a spec; rerun to resume
    #[command(after_help = help::RUN)]
    Run {
        #[command(flatten)]
        campaign: CampaignArguments,
        #[arg(
            long, value_enum, value_name = "STAGE", default_value = "report", hide_possible_values = true,
            help = help::UNTIL
        )]
        until: StageArgument,
        /// Count pending tasks without running them, as `plan` does
        #[arg(long, short = 'n')]
        dry_run: bool,
        /// Open report.html when the run has finished
        #[arg(long)]
        open: bool,
    },
    /// Count pending tasks by stage, with reasons; --json lists them
    Plan {
        /// Spec (TOML), or the output folder of a run
        spec: PathBuf,
        #[command(flatten)]
        output: OutputArguments,
    },
    /// Show the state of a run
    Status {
        #[command(flatten)]
        folder: FolderArguments,
        /// Repeat every two seconds until no task is pending, or no job is queued
        #[arg(long)]
        watch: bool,
    },
    /// Explain why a task is pending, parameter by parameter
    Explain {
        #[command(flatten)]
        folder: FolderArguments,
        /// Task id as in `status --json`, or `statistics`, or `report`
        id: String,
        /// Spec of the task [default: that of the last run]
        #[arg(long)]
        spec: Option<PathBuf>,
    },
    /// Check all files of a run against their records
    Verify {
        #[command(flatten)]
        folder: FolderArguments,
        /// Compare checksums of contents, not only sizes
        #[arg(long)]
        deep: bool,
    },
    /// Rerun failed cycles
    Retry {
        #[command(flatten)]
        folder: FolderArguments,
        /// Ids of failed tasks [default: all]
        ids: Vec<String>,
        #[command(flatten)]
        jobs: JobsArguments,
        #[command(flatten)]
        talk: TalkArguments,
    },
    /// List unreferenced files; delete them with --delete
    #[command(visible_alias = "clean")]
    Gc {
        #[command(flatten)]
        folder: FolderArguments,
        /// Further spec whose results are kept; may be repeated
        #[arg(long, value_name = "SPEC")]
        keep: Vec<PathBuf>,
        /// Delete the listed files
        #[arg(long)]
        delete: bool,
    },
    /// Preprocess a measured surface and report its statistics
    #[command(long_about = help::IMPORT)]
    Import(Box<ImportArguments>),
    /// Stage 1: generate or import the surfaces
    Generate(CampaignArguments),
    /// Stage 2: extract the asperities of the surfaces
    Extract(CampaignArguments),
    /// Stage 3: load and unload each case on each surface
    Cycle(CampaignArguments),
    /// Stage 4: write the tables of statistics
    Aggregate {
        #[command(flatten)]
        campaign: CampaignArguments,
        /// Aggregate finished cases although others are missing
        #[arg(long)]
        partial: bool,
    },
    /// Write figures and report.html (stage 5)
    Report {
        /// Spec (TOML), or the output folder of a run
        #[arg(required_unless_present = "compare")]
        spec: Option<PathBuf>,
        /// Compare these runs with SPEC or the first one, as `compare` does
        #[arg(long, num_args = 1.., value_name = "DIR", conflicts_with = "set")]
        compare: Vec<PathBuf>,
        /// Replace a comparison of other runs
        #[arg(long, requires = "compare")]
        force: bool,
        /// Open the report when it is written
        #[arg(long)]
        open: bool,
        #[command(flatten)]
        campaign: HowArguments,
    },
    /// Compare finished runs with the first one
    Compare(CompareArguments),
    /// Judge the findings of the paper by the cases of runs
    #[command(long_about = help::FINDINGS)]
    Findings(FindingsArguments),
    /// Print one case or task: parameters, results, warnings, files
    Show {
        #[command(flatten)]
        folder: FolderArguments,
        /// Id of a case, cycle or surface; or `statistics`, or `report`
        id: String,
    },
    /// Print what a publication of a run cites, in BibTeX
    Cite {
        #[command(flatten)]
        folder: FolderArguments,
    },
    /// Submit pending tasks to Slurm
    Submit {
        /// Spec (TOML), or the output folder of a run
        spec: PathBuf,
        #[command(flatten)]
        output: OutputArguments,
        /// Scheduler
        #[arg(long, value_enum)]
        engine: EngineArgument,
        #[command(flatten)]
        shards: ShardsArguments,
        /// Threads of each task
        #[arg(
            long, value_name = "N", default_value_t = 1,
            value_parser = clap::value_parser!(u16).range(1..=1024)
        )]
        cpus: u16,
        /// Further option of sbatch, e.g. --option=--time=4:00:00; repeatable
        #[arg(long, value_name = "LINE", allow_hyphen_values = true)]
        option: Vec<String>,
        /// Show the scripts and commands without submitting
        #[arg(long, short = 'n')]
        dry_run: bool,
    },
    /// Export tables, surfaces, workflows or metadata
    Export {
        #[command(subcommand)]
        what: ExportVerb,
    },
    /// Print the schemas of the tables and of the spec
    Schema {
        /// File to print, e.g. reference_cli.md [default: all *.json]
        #[arg(conflicts_with = "write")]
        file: Option<String>,
        /// Write schemas/, and in a clone the generated pages of src/guide
        #[arg(long)]
        write: bool,
        /// Replace other files of these names outside a clone
        #[arg(long, requires = "write")]
        force: bool,
    },
    /// Print the completion script of a shell
    Completions {
        /// Shell
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
    /// Print the manual page (roff) of the program or a command
    Man {
        /// Command
        verb: Option<String>,
        /// Write all pages into this folder instead
        #[arg(long, value_name = "DIR", conflicts_with = "verb")]
        dir: Option<PathBuf>,
        /// Replace other files of these names
        #[arg(long, requires = "dir")]
        force: bool,
    },
}

#[derive(Debug, Subcommand)]
enum ExportVerb {
    /// Tables of a run or comparison as CSV; with --cycles, of cycles too
    Csv(CsvArguments),
    /// Common spectrum of the scans of a run, for surface.spectrum
    Psd(PsdArguments),
    /// A surface as NetCDF-3, for SurfaceTopography
    Netcdf(ExportArguments),
    /// A surface as HDF5 in the layout of Tamaas' H5Dumper
    Tamaas(ExportArguments),
    /// A Snakefile with one rule for each stage
    Snakemake {
        /// Spec (TOML), or the output folder of a run
        spec: PathBuf,
        #[command(flatten)]
        output: OutputArguments,
        #[command(flatten)]
        shards: ShardsArguments,
        /// Replace a Snakefile that was not exported
        #[arg(long)]
        force: bool,
    },
    /// Metadata of a finished run for a data repository (RO-Crate 1.2)
    RoCrate {
        #[command(flatten)]
        folder: FolderArguments,
        /// Licence of the data: SPDX identifier (CC-BY-4.0) or http(s) address
        #[arg(long, value_name = "LICENCE")]
        license: Option<String>,
        /// Publishing organization: name, or address such as a ROR identifier
        #[arg(long, value_name = "NAME")]
        publisher: Option<String>,
        /// Replace existing metadata
        #[arg(long)]
        force: bool,
    },
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum EngineArgument {
    Slurm,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum StageArgument {
    Generate,
    Extract,
    Cycle,
    Aggregate,
    Report,
}

/// Runs the command and prints its outcome.
#[must_use]
pub fn perform(arguments: &Arguments) -> ExitCode {
    verbs::perform(&arguments.verb)
}
