//! Limits of the process: threads, also those of Polars, and address space.

use std::thread::available_parallelism;

/// Threads at most: as many as `--jobs` takes.
const MOST_THREADS: usize = 1024;

/// Environment variable from which Polars reads its number of threads, once.
#[cfg(unix)]
const OF_POLARS: &str = "POLARS_MAX_THREADS";

/// Address space without which a computation ends in the middle of an allocation \[bytes\].
const LEAST_SPACE: u64 = 384 << 20;

/// A number of threads from the environment; nothing where none is set. One that is not within 1 to
/// [`MOST_THREADS`] is the number of cores.
fn of_environment(name: &str) -> Option<usize> {
    let text = std::env::var_os(name)?;
    let count = text
        .to_str()
        .and_then(|text| text.trim().parse().ok())
        .filter(|count| (1..=MOST_THREADS).contains(count));
    Some(count.unwrap_or_else(cores))
}

fn cores() -> usize {
    available_parallelism().map_or(1, usize::from).min(MOST_THREADS)
}

/// Number of threads: `--jobs`, else `RAYON_NUM_THREADS`, else one for each core.
pub(super) fn threads(jobs: Option<u16>) -> usize {
    jobs.map(usize::from).or_else(|| of_environment("RAYON_NUM_THREADS")).unwrap_or_else(cores)
}

/// Sets the number of Polars threads to `--jobs`, limited to a number that can be started.
///
/// Polars reads the number from the environment only. A process cannot change its own environment safely, so
/// the program is started again in the same process.
#[cfg(unix)]
pub(super) fn bound_polars(jobs: Option<u16>) {
    use std::os::unix::process::CommandExt as _;
    let Some(wanted) = jobs.map(usize::from).or_else(|| of_environment(OF_POLARS)) else { return };
    if std::env::var(OF_POLARS).is_ok_and(|text| text == wanted.to_string()) {
        return;
    }
    let mut arguments = std::env::args_os();
    let (name, Ok(program)) = (arguments.next().unwrap_or_default(), std::env::current_exe()) else { return };
    // Where it returns it has failed: then Polars takes what it finds.
    let _ = std::process::Command::new(program)
        .arg0(name)
        .args(arguments)
        .env(OF_POLARS, wanted.to_string())
        .exec();
}

#[cfg(not(unix))]
pub(super) fn bound_polars(_: Option<u16>) {}

/// Fault of the limit on address space (`ulimit -v`), if any: problem and help.
pub(super) fn too_little_space() -> Option<String> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let bytes: u64 = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?
        .split_whitespace()
        .next()?
        .parse()
        .ok()?;
    (bytes < LEAST_SPACE).then(|| {
        format!(
            "the address space is limited to {} MB, and a computation needs about 500 MB\nhelp: raise the \
             limit (`ulimit -v`, h_vmem of the scheduler)",
            bytes / 1_000_000
        )
    })
}
