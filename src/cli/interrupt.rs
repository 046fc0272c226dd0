//! Ctrl-C and SIGTERM: what is being written is finished, what is being computed is dropped, and it is said how to go on.

use super::progress::Teller;
use crate::stages::Watch as _;
use crate::store::{commit, hdf5};
use std::path::Path;
use std::sync::Arc;

/// Exit code of the contract.
const INTERRUPTED: i32 = 130;

/// SIGHUP in the mask of ignored signals.
const HANG_UP: u64 = 1;

/// From now on an interrupt ends the program between two files. All it costs are the units at hand, of which long ones are kept on their way.
///
/// Where hang-ups are ignored, as under `nohup`, signals are left as they are: a handler would be called for that one too. Another one then ends the program
/// at once, which loses no more.
///
/// # Errors
/// If signals cannot be waited for.
pub(super) fn expect(teller: Arc<Teller>, dir: &Path) -> Result<(), ctrlc::Error> {
    if std::fs::read_to_string("/proc/self/status").is_ok_and(|status| ignores_hang_up(&status)) {
        return Ok(());
    }
    let dir = dir.display().to_string();
    ctrlc::set_handler(move || {
        let _still = commit::quiet();
        teller.clear();
        teller.notice(&format!(
            "interrupted: what was finished is kept, what was begun is dropped. The same command goes on, and so does \
             `hysteron run {dir}/campaign.toml --out {dir}`"
        ));
        hdf5::alone(|| std::process::exit(INTERRUPTED));
    })
}

/// Whether the system's words on this process say so.
fn ignores_hang_up(status: &str) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & HANG_UP != 0)
}
