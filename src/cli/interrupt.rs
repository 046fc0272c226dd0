//! Ctrl-C and SIGTERM: what is being written is finished, what is being computed is dropped, and it is said how to go on.

use super::progress::Teller;
use crate::stages::Watch as _;
use crate::store::{commit, hdf5};
use std::path::Path;
use std::sync::Arc;

/// Exit code of the contract.
const INTERRUPTED: i32 = 130;

/// From now on an interrupt ends the program between two files. All it costs are the units at hand, of which long ones are kept on their way.
///
/// # Errors
/// If signals cannot be waited for.
pub(super) fn expect(teller: Arc<Teller>, dir: &Path) -> Result<(), ctrlc::Error> {
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
