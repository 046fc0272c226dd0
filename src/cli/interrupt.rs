//! Ctrl-C and SIGTERM: files that are being written are finished, running tasks are dropped, and the command
//! that continues is printed.

use super::progress::Teller;
use crate::stages::Watch as _;
use crate::store::{commit, hdf5};
use crate::text::{counted, shell_path};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;
use signal_hook::low_level;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// Exit code of the contract.
const INTERRUPTED: i32 = super::exit::INTERRUPTED as i32;

/// Time that an interrupt waits for files that are being written; a stuck read or write (a dead network disk)
/// never ends.
const PATIENCE: Duration = Duration::from_secs(5);
/// Interval of the checks for a second signal.
const EVERY: Duration = Duration::from_millis(50);

/// From now on an interrupt ends the program between two files, at a second signal or after [`PATIENCE`] at
/// once. All it costs are the running tasks, of which long ones are checkpointed.
///
/// Ignored hang-ups, as under `nohup`, stay ignored. A limit on the size of files (`ulimit -f`) is no longer
/// deadly: it is an error of the write that meets it.
///
/// # Errors
/// If signals cannot be waited for.
pub(super) fn expect(teller: Arc<Teller>, dir: &Path) -> std::io::Result<()> {
    let hang_ups_are_ignored =
        std::fs::read_to_string("/proc/self/status").is_ok_and(|status| ignores_hang_up(&status));
    let mut waited = vec![SIGINT, SIGTERM];
    if !hang_ups_are_ignored {
        waited.push(SIGHUP);
    }
    signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
    let mut signals = Signals::new(waited)?;
    let dir = dir.to_owned();
    let wait = move || {
        if signals.forever().next().is_none() {
            return;
        }
        let ending = std::thread::Builder::new().name("ending".to_owned()).spawn(move || end(&teller, &dir));
        let since = Instant::now();
        while ending.is_ok() && since.elapsed() < PATIENCE && signals.pending().next().is_none() {
            std::thread::sleep(EVERY);
        }
        // Whatever is stuck may hold any lock: nothing is printed, no exit handler runs. Files are put in
        // place whole, so that none is lost.
        low_level::exit(INTERRUPTED);
    };
    std::thread::Builder::new().name("signals".to_owned()).spawn(wait).map(drop)
}

/// Outcome of running cycles with and without a checkpoint.
fn running([with, without]: [usize; 2]) -> String {
    let tasks = |count: usize, [one, many]: [&str; 2]| {
        format!("{} {}", counted(count, "running task"), if count == 1 { one } else { many })
    };
    let going_on = ["continues from its last checkpoint", "continue from their last checkpoints"];
    match (with, without) {
        (0, 0) => String::new(),
        (0, without) => format!(", {} without a checkpoint", tasks(without, ["restarts", "restart"])),
        (with, 0) => format!(", {}", tasks(with, going_on)),
        (with, without) => format!(
            ", {}, {} without a checkpoint",
            tasks(with, going_on),
            tasks(without, ["restarts", "restart"])
        ),
    }
}

/// Recommended action after an interrupt.
fn next_step(dir: &Path) -> String {
    if std::env::var_os("SLURM_JOB_ID").is_some() && dir.join("slurm/jobs.json").is_file() {
        return format!(
            "`hysteron status {}` shows the state and the command that submits pending tasks",
            shell_path(dir)
        );
    }
    let [spec, dir] = [&dir.join("campaign.toml"), dir].map(shell_path);
    format!("resume with the same command, or with `hysteron run {spec} --out {dir}`")
}

/// Ends the program as soon as no file is being read or written.
fn end(teller: &Teller, dir: &Path) {
    teller.clear();
    teller.notice(&format!(
        "interrupted: finished tasks are kept{}\nhelp: {}",
        running(teller.checkpointed(dir)),
        next_step(dir)
    ));
    let _still = commit::quiet();
    teller.remove_temporary();
    hdf5::alone(|| std::process::exit(INTERRUPTED));
}

/// True if the system's words on this process say so.
fn ignores_hang_up(status: &str) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let bit = 1_u64 << (SIGHUP - 1);
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & bit != 0)
}
