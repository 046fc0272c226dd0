//! The command line: verbs, progress, and what is said at the end.

mod interrupt;
mod limits;
mod progress;
mod reference;
mod verbs;

pub use reference::{GUIDE, generated};

use crate::campaign::Shard;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Adhesive hysteresis of rough surfaces: from a self-affine surface to the energy that its contact loses, a table at every step.
#[derive(Debug, Parser)]
#[command(
    version,
    about,
    max_term_width = 100,
    after_help = "Exit codes: 0 done, 1 failed, 2 bad spec or usage, 3 finished with failed cases, \
                  130 interrupted: the same command goes on."
)]
pub struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Do all of a spec that is not done yet; the same command again goes on where it stopped
    Run {
        #[command(flatten)]
        campaign: CampaignArguments,
        /// Stop after this stage
        #[arg(long, value_enum, value_name = "STAGE", default_value = "report")]
        until: StageArgument,
    },
    /// Say what `run` would do, and why; writes nothing
    Plan {
        /// The spec, a TOML file
        spec: PathBuf,
        #[command(flatten)]
        output: OutputArguments,
    },
    /// Say what of a run is done
    Status {
        #[command(flatten)]
        folder: FolderArguments,
        /// Say it again every two seconds, until nothing is left to do
        #[arg(long)]
        watch: bool,
    },
    /// Explain why a task is pending, field by field
    Explain {
        #[command(flatten)]
        folder: FolderArguments,
        /// The task, as `status --json` and the file names have it; or `statistics`, or `report`
        id: String,
        /// The spec that names it [default: the one of the last run]
        #[arg(long)]
        spec: Option<PathBuf>,
    },
    /// Compare all files of a run with their receipts
    Verify {
        #[command(flatten)]
        folder: FolderArguments,
        /// Compare contents, and not lengths alone
        #[arg(long)]
        deep: bool,
    },
    /// Try failed cases again
    Retry {
        #[command(flatten)]
        folder: FolderArguments,
        /// Which ones [default: all]
        ids: Vec<String>,
        #[command(flatten)]
        jobs: JobsArguments,
    },
    /// List what no spec names any more, and take it away if told to
    Gc {
        #[command(flatten)]
        folder: FolderArguments,
        /// Further specs whose results are to stay, beside that of the last run
        #[arg(long, value_name = "SPEC")]
        keep: Vec<PathBuf>,
        /// Take it away
        #[arg(long)]
        delete: bool,
    },
    /// Take a measured surface: make it fit for the model, say what it is like, and write it
    ///
    /// Reads HDF5, NetCDF-3 as SurfaceTopography writes it, X3P (ISO 25178-72), NumPy's .npy, and text, a line for each row. Of an oblong field the middle square is
    /// taken. What is written here is named in a spec as surface.file; a spec may name the original as well, with the same choices.
    Import(ImportArguments),
    /// Make the surfaces
    Generate(CampaignArguments),
    /// Find the summits of the surfaces
    Extract(CampaignArguments),
    /// Load and unload every case
    Cycle(CampaignArguments),
    /// Average over realizations
    Aggregate {
        #[command(flatten)]
        campaign: CampaignArguments,
        /// Aggregate what is there, although cases are missing
        #[arg(long)]
        partial: bool,
    },
    /// Draw the figures and write the page; or compare finished campaigns
    Report {
        /// The spec, a TOML file
        #[arg(required_unless_present = "compare")]
        spec: Option<PathBuf>,
        /// Compare the campaigns in these output folders with the first one, instead [default --out: data/runs/comparison]
        #[arg(long, num_args = 2.., value_name = "DIR", conflicts_with = "spec")]
        compare: Vec<PathBuf>,
        #[command(flatten)]
        campaign: HowArguments,
    },
    /// Hand what is not done yet to a scheduler
    Submit {
        /// The spec, a TOML file
        spec: PathBuf,
        #[command(flatten)]
        output: OutputArguments,
        /// The scheduler
        #[arg(long, value_enum)]
        engine: EngineArgument,
        #[command(flatten)]
        shards: ShardsArguments,
        /// Threads of each task
        #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
        cpus: u16,
        /// A further line for the scheduler, as --option=--time=4:00:00; may be given several times
        #[arg(long, value_name = "LINE", allow_hyphen_values = true)]
        option: Vec<String>,
        /// Show the scripts and the commands, and do nothing
        #[arg(long)]
        dry_run: bool,
    },
    /// Write what other programs run or publish a campaign with
    Export {
        #[command(subcommand)]
        what: ExportVerb,
    },
    /// Print the schemas of the tables and of the spec
    ///
    /// Without FILE, all JSON schemas are printed. reference_spec.md and reference_cli.md are the reference pages of the guide.
    Schema {
        /// Print this file only, such as spec.v1.json or reference_spec.md
        #[arg(conflicts_with = "write")]
        file: Option<String>,
        /// Write schemas/ below the current directory, and the pages of src/guide if it exists
        #[arg(long)]
        write: bool,
    },
    /// Print what a shell completes the program's verbs and options with
    Completions {
        /// The shell
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
    /// Print the manual page, of the program or of one verb
    Man {
        /// The verb
        verb: Option<String>,
        /// Write the pages of the program and of every verb into this folder instead
        #[arg(long, value_name = "DIR", conflicts_with = "verb")]
        dir: Option<PathBuf>,
    },
}

#[derive(Debug, Args)]
struct CampaignArguments {
    /// The spec, a TOML file
    spec: PathBuf,
    #[command(flatten)]
    how: HowArguments,
}

#[derive(Debug, Args)]
struct HowArguments {
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    jobs: JobsArguments,
    /// Only part K of N of the surfaces, and what is done with them (K from 0, N up to 1000000)
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Take what is done for whole if its files are as long as they were, and do not compare contents
    #[arg(long)]
    quick: bool,
}

#[derive(Debug, Args)]
struct JobsArguments {
    /// Threads [default: as many as there are cores]
    #[arg(long, short = 'j', value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

#[derive(Debug, Args)]
struct FolderArguments {
    /// The output folder of a run
    dir: PathBuf,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct OutputArguments {
    /// The output folder [default: data/runs/<name of the spec>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum ExportVerb {
    /// A surface as NetCDF-3, to be opened with SurfaceTopography
    Netcdf(ExportArguments),
    /// A surface as HDF5 in the layout of Tamaas' H5Dumper
    Tamaas(ExportArguments),
    /// A Snakefile with one rule for each stage
    Snakemake {
        /// The spec, a TOML file
        spec: PathBuf,
        #[command(flatten)]
        output: OutputArguments,
        #[command(flatten)]
        shards: ShardsArguments,
    },
    /// The description of a finished run for a repository of research data (RO-Crate 1.2)
    RoCrate {
        #[command(flatten)]
        folder: FolderArguments,
        /// The licence of the data: an SPDX identifier such as CC-BY-4.0, or the http(s) address of its text
        #[arg(long, value_name = "LICENCE")]
        license: Option<String>,
    },
}

#[derive(Debug, Args)]
struct ExportArguments {
    /// The surface: surfaces/<id>.h5 of a run, or what `import` has written
    surface: PathBuf,
    /// The file to be written
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

#[derive(Debug, Args)]
struct ImportArguments {
    /// The measured surface
    file: PathBuf,
    /// The file to be written [default: <name of FILE>.h5 in the present folder]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Which field of the file it is, where it has several: a dataset of HDF5, a variable of NetCDF
    #[arg(long, value_name = "NAME")]
    dataset: Option<String>,
    /// Distance of its points in metres, where the file does not tell it: the size of the scan over its number of points
    #[arg(long, value_name = "METRES")]
    pixel_m: Option<f64>,
    /// Unit of its heights, where the file does not tell it, such as nm
    #[arg(long)]
    unit: Option<String>,
    /// Fill missing points in as a membrane would, instead of refusing them
    #[arg(long)]
    fill: bool,
    /// Shape removed from the heights by least squares [default: plane, or mean with --periodic]
    #[arg(long, value_name = "SHAPE", value_parser = ["mean", "plane", "quadratic"])]
    detrend: Option<String>,
    /// It continues periodically
    #[arg(long)]
    periodic: bool,
    /// Take off waves shorter than so many points, the noise of the instrument among them
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u8).range(4..=64))]
    points: u8,
    /// Say what it is like, and write nothing
    #[arg(long)]
    dry_run: bool,
    /// Write over a file that is there
    #[arg(long)]
    force: bool,
    /// Answer in JSON, with the spectrum
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct ShardsArguments {
    /// Parts that are run by themselves [default: one for each surface, up to 1000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    shards: Option<u32>,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum EngineArgument {
    Slurm,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum StageArgument {
    Generate,
    Extract,
    Cycle,
    Aggregate,
    Report,
}

/// Does what was asked for, and says how it went.
#[must_use]
pub fn perform(arguments: &Arguments) -> ExitCode {
    verbs::perform(&arguments.verb)
}
