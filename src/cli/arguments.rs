//! Arguments that several commands share, and those of the larger commands.

use super::help;
use crate::campaign::Shard;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct CampaignArguments {
    /// Spec (TOML), or the output folder of a run
    pub(super) spec: PathBuf,
    #[command(flatten)]
    pub(super) how: HowArguments,
}

#[derive(Debug, Args)]
pub(super) struct HowArguments {
    #[command(flatten)]
    pub(super) output: OutputArguments,
    #[command(flatten)]
    pub(super) jobs: JobsArguments,
    /// Process every N-th surface, starting at K (0-based), e.g. 0/4
    #[arg(long, value_name = "K/N")]
    pub(super) shard: Option<Shard>,
    /// Check sizes of finished files only, not checksums
    #[arg(long)]
    pub(super) quick: bool,
    #[command(flatten)]
    pub(super) talk: TalkArguments,
}

#[derive(Debug, Args)]
pub(super) struct JobsArguments {
    /// Number of threads [default: number of cores]
    #[arg(long, short = 'j', value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) jobs: Option<u16>,
}

#[derive(Debug, Clone, Copy, Args)]
pub(super) struct TalkArguments {
    /// Print warnings and errors only
    #[arg(long, short = 'q', conflicts_with = "verbose")]
    pub(super) quiet: bool,
    /// Print each finished task with its time, and all warnings at the end
    #[arg(long, short = 'v')]
    pub(super) verbose: bool,
}

#[derive(Debug, Args)]
pub(super) struct FolderArguments {
    /// Output folder of a run, or its spec
    pub(super) dir: PathBuf,
    /// Output folder of the spec [default: data/runs/<name of the spec>]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct OutputArguments {
    /// Output folder [default: data/runs/<name of the spec>]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Override a value of the spec, e.g. surface.hurst=0.7; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Output folders of the runs, or their specs
    #[arg(num_args = 2.., required = true, value_name = "DIR")]
    pub(super) runs: Vec<PathBuf>,
    /// Folder of the comparison [default: data/runs/comparison]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
    /// Replace a comparison of other runs, and other files of these names
    #[arg(long)]
    pub(super) force: bool,
    /// Open comparison.html when it is written
    #[arg(long)]
    pub(super) open: bool,
}

#[derive(Debug, Args)]
pub(super) struct FindingsArguments {
    /// Output folders of runs, or their specs
    #[arg(required = true, value_name = "DIR")]
    pub(super) runs: Vec<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct CsvArguments {
    /// Output folder of a run, or its spec
    pub(super) dir: PathBuf,
    /// Also export the tables of each cycle: steps, events, contacts, ...
    #[arg(long)]
    pub(super) cycles: bool,
    /// Folder of the CSV files [default: csv/ in the output folder]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Replace existing files with another content
    #[arg(long)]
    pub(super) force: bool,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct PsdArguments {
    /// Output folder of a run with surface.files
    pub(super) dir: PathBuf,
    /// Case with the scans, where a run has several
    #[arg(long, value_name = "ID")]
    pub(super) case: Option<String>,
    /// File to write (CSV)
    #[arg(long, value_name = "FILE")]
    pub(super) out: PathBuf,
    /// Overwrite an existing file
    #[arg(long)]
    pub(super) force: bool,
}

#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    /// Surface: surfaces/<id>.h5 of a run, or an output of `import`
    pub(super) surface: PathBuf,
    /// File to write
    #[arg(long, value_name = "FILE")]
    pub(super) out: PathBuf,
    /// Overwrite an existing file
    #[arg(long)]
    pub(super) force: bool,
}

#[derive(Debug, Args)]
pub(super) struct ImportArguments {
    /// Measured surface or loop; several scans or a zip container: one sample
    #[arg(required = true, value_name = "FILE")]
    pub(super) files: Vec<PathBuf>,
    /// File to write [default: <name of FILE>.h5]; of several files a folder
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// Dataset (HDF5) or variable (NetCDF) of a file with several
    #[arg(long, value_name = "NAME")]
    pub(super) dataset: Option<String>,
    /// Pixel size in metres, if it is not stored in the file
    #[arg(long, value_name = "METRES", conflicts_with = "size", allow_hyphen_values = true)]
    pub(super) pixel_m: Option<f64>,
    /// Size of the scan along x, or x by y: 5um, 5e-6, "5um x 3um"
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true)]
    pub(super) size: Option<String>,
    /// Unit of the heights (e.g. nm), if it is not stored in the file
    #[arg(long)]
    pub(super) unit: Option<String>,
    /// Skip the first N lines of a text
    #[arg(long, value_name = "N")]
    pub(super) skip_lines: Option<u32>,
    /// Points per scan line of a text with one column
    #[arg(
        long, value_name = "N", visible_alias = "columns",
        value_parser = clap::value_parser!(u32).range(1..)
    )]
    pub(super) width: Option<u32>,
    /// Exchange x and y, for files with the other order of indices
    #[arg(long)]
    pub(super) transpose: bool,
    /// Interpolate missing points (harmonic in-fill) instead of failing
    #[arg(long)]
    pub(super) fill: bool,
    #[arg(
        long, value_name = "FORM", value_parser = ["mean", "plane", "quadratic"],
        hide_possible_values = true, help = help::DETREND
    )]
    pub(super) detrend: Option<String>,
    /// Replace outliers: spikes beyond 6 robust standard deviations
    #[arg(long)]
    pub(super) outliers: bool,
    /// Remove the offsets of scan lines (median of differences)
    #[arg(long)]
    pub(super) align_rows: bool,
    #[arg(
        long, value_name = "AXIS", requires = "align_rows", value_parser = ["auto", "rows", "columns"],
        hide_possible_values = true, help = help::FAST_AXIS
    )]
    pub(super) fast_axis: Option<String>,
    /// Tip radius in metres; removes wavelengths that it cannot trace
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub(super) tip_radius: Option<f64>,
    /// The surface is periodic
    #[arg(long)]
    pub(super) periodic: bool,
    /// S-filter: gaussian (ISO 16610-61) or sharp [default: gaussian]
    #[arg(
        long, value_name = "FILTER", value_parser = ["gaussian", "sharp"], hide_possible_values = true
    )]
    pub(super) filter: Option<String>,
    /// Low-pass (S-filter) cut-off wavelength in pixels [default: 8]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(4..=64))]
    pub(super) points: Option<u8>,
    /// Report the statistics without writing a file
    #[arg(long, short = 'n')]
    pub(super) dry_run: bool,
    /// Overwrite an existing file
    #[arg(long)]
    pub(super) force: bool,
    /// Print JSON, with the power spectrum
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) of_loop: LoopArguments,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Options for measured loops")]
pub(super) struct LoopArguments {
    /// Read the file as a loop [default: by its heading]
    #[arg(long = "loop")]
    pub(super) is_loop: bool,
    /// Column of the force
    #[arg(long, value_name = "COLUMN")]
    pub(super) force_column: Option<String>,
    /// Unit of the force, e.g. nN
    #[arg(long, value_name = "UNIT")]
    pub(super) force_unit: Option<String>,
    /// Column of the displacement or penetration
    #[arg(long, value_name = "COLUMN")]
    pub(super) displacement_column: Option<String>,
    /// Unit of the displacement, e.g. um
    #[arg(long, value_name = "UNIT")]
    pub(super) displacement_unit: Option<String>,
    /// Column of the contact radius or contact area
    #[arg(long, value_name = "COLUMN")]
    pub(super) radius_column: Option<String>,
    /// Unit of the contact radius or area, e.g. um or um2
    #[arg(long, value_name = "UNIT")]
    pub(super) radius_unit: Option<String>,
    #[arg(
        long, value_name = "SIGN", value_parser = ["auto", "positive", "negative"],
        hide_possible_values = true, help = help::COMPRESSION
    )]
    pub(super) compression: Option<String>,
    #[arg(
        long, value_name = "KIND", value_parser = ["line", "offset", "none"],
        hide_possible_values = true, help = help::BASELINE
    )]
    pub(super) baseline: Option<String>,
    /// Radius of the spherical probe: 20um, or 2e-5 in metres
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub(super) probe_radius: Option<String>,
    /// Reduced modulus in pascals [default: fitted]
    #[arg(long, value_name = "PASCALS", allow_hyphen_values = true)]
    pub(super) modulus: Option<f64>,
    /// Stiffness of the machine in N/m; subtracts F/k from the displacement
    #[arg(long, value_name = "N/M", allow_hyphen_values = true)]
    pub(super) machine_stiffness: Option<f64>,
}

#[derive(Debug, Args)]
pub(super) struct ShardsArguments {
    /// Number of parts, at most 10^6 [default: one per surface, up to 1000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) shards: Option<u32>,
}
