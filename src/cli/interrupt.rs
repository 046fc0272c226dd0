//! Ctrl-C and SIGTERM: what is being written is finished, what is being computed is dropped, and it is said how to go on.

use super::progress::Teller;
use crate::stages::Watch as _;
use crate::store::{commit, hdf5};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Exit code of the contract.
const INTERRUPTED: i32 = 130;

/// From now on an interrupt ends the program between two files. All it costs are the units at hand, of which long ones are kept on their way.
///
/// Where hang-ups are ignored, as under `nohup`, they stay so. A limit on the size of files (`ulimit -f`) is no longer deadly: it is an error of the write
/// that meets it.
///
/// # Errors
/// If signals cannot be waited for.
pub(super) fn expect(teller: Arc<Teller>, dir: &Path) -> std::io::Result<()> {
    let hang_ups_are_ignored = std::fs::read_to_string("/proc/self/status").is_ok_and(|status| ignores_hang_up(&status));
    let mut waited = vec![SIGINT, SIGTERM];
    if !hang_ups_are_ignored {
        waited.push(SIGHUP);
    }
    signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
    let mut signals = Signals::new(waited)?;
    let dir = dir.display().to_string();
    let wait = move || {
        if signals.forever().next().is_none() {
            return;
        }
        let _still = commit::quiet();
        teller.clear();
        teller.notice(&format!(
            "interrupted: what was finished is kept, what was begun is dropped. The same command goes on, and so does \
             `hysteron run {dir}/campaign.toml --out {dir}`"
        ));
        hdf5::alone(|| std::process::exit(INTERRUPTED));
    };
    std::thread::Builder::new().name("signals".to_owned()).spawn(wait).map(drop)
}

/// Whether the system's words on this process say so.
fn ignores_hang_up(status: &str) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let bit = 1_u64 << (SIGHUP - 1);
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & bit != 0)
}
