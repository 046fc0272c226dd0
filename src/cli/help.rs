//! Help texts that are not attached to one command or option. Lines have at most 80 columns: clap does not
//! wrap them.

use super::Verb;
use clap::{Command, Subcommand as _};

/// Exit codes, below the list of commands.
pub(super) const EXIT_CODES: &str = "\
Exit codes:
  0    done
  1    failed: the message has the reason
  2    invalid spec or arguments
  3    finished, but some cycles failed (`hysteron status`)
  130  interrupted; the same command resumes

Help on a command: hysteron help <COMMAND>";

/// Below the options of `run`.
pub(super) const RUN: &str = "\
Exit codes: 0 done, 1 failed, 2 invalid spec or arguments,
            3 finished with failed cycles, 130 interrupted (rerun to resume)

--set takes TOML values; quotes around a word may be omitted. Values that a
[[sweep]] of the spec sets override those of --set. A relative path in
surface.file is looked for in the working directory, then in the folder of the
spec; in campaign.toml of a run it starts at the folder of campaign.toml.

Environment:
  NO_COLOR                    if set, output is not coloured
  HYSTERON_PROGRESS_SECONDS   seconds between progress lines if standard error
                              is not a terminal; default 30";

/// `--until` of `run`.
pub(super) const UNTIL: &str = "\
Last stage to run:
generate, extract, cycle, aggregate or report";

/// `--detrend` of `import`.
pub(super) const DETREND: &str = "\
Form removed by a fit: mean, plane or quadratic
[default: plane, or mean with --periodic]";

/// `--fast-axis` of `import`.
pub(super) const FAST_AXIS: &str = "\
Direction of the scan lines: rows or columns of the file
[default: auto, the one with the larger offsets]";

/// `--compression` of `import`.
pub(super) const COMPRESSION: &str = "\
Sign of a compressive force: positive or negative
[default: auto, the sign at the load reversal]";

/// `--baseline` of `import`.
pub(super) const BASELINE: &str = "\
Baseline fitted to the points without contact: line, offset or none
[default: line, with offset, slope and drift]";

/// The description of `import`.
pub(super) const IMPORT: &str = "\
Preprocess a measured surface, or evaluate a measured loop

Formats: HDF5, NetCDF, X3P (ISO 25178-72), NumPy .npy, and text: a matrix with
one line for each scan line, columns x, y, z, or one column. A scan that is not
square is cropped to its central square. Name the output as surface.file in a
spec. A spec may also name the original file, with the same options as keys.

A text with columns of force and displacement is a loop: its pull-off force,
dissipated energy, works of adhesion and modulus are printed with intervals,
and its points are written as <name of FILE>_loop.parquet. Several loops give
one such table each, in the folder of --out.";

/// The description of `findings`.
pub(super) const FINDINGS: &str = "\
Judge the findings of the paper by the cases of runs

The paper is Violano & Afferrante, Lubricants 9:7 (2021). Cases that differ only
in maximum load, magnification and Hurst exponent form a reading. Each reading
has a verdict on each finding, with the numbers behind it.";

/// The commands by task, in the order of the help.
const GROUPS: [(&str, &[&str]); 6] = [
    ("Simulate", &["init", "run", "plan", "status", "retry", "submit"]),
    ("Results", &["report", "compare", "findings", "show", "cite", "export"]),
    ("Measurements", &["import"]),
    ("Maintenance", &["verify", "explain", "gc"]),
    ("Single stages", &["generate", "extract", "cycle", "aggregate"]),
    ("Other", &["schema", "completions", "man"]),
];

/// The help of the program: commands in groups.
pub(super) fn template() -> String {
    let commands = Verb::augment_subcommands(Command::new("hysteron"));
    let mut text = "{about-with-newline}\n{usage-heading} {usage}\n\
                    Start: hysteron init > my.toml && hysteron run my.toml\n"
        .to_owned();
    for (heading, names) in GROUPS {
        text += &format!("\n{heading}:\n");
        for command in names.iter().filter_map(|name| commands.find_subcommand(name)) {
            let aliases = command.get_visible_aliases().map(|alias| format!(", {alias}")).collect::<String>();
            let about = command.get_about().map(ToString::to_string).unwrap_or_default();
            text += &format!("  {:12} {about}\n", format!("{}{aliases}", command.get_name()));
        }
    }
    text + "\nOptions:\n{options}{after-help}"
}
