//! `--open`: shows a report in the program that the system uses for it.

use super::{BAD_SPEC, Fault};
use crate::text::shown;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The program that opens a file.
const VIEWER: &str = if cfg!(target_os = "macos") {
    "open"
} else if cfg!(windows) {
    "explorer"
} else {
    "xdg-open"
};

/// Time in which a viewer that cannot open the file ends.
const PATIENCE: Duration = Duration::from_secs(2);
const EVERY: Duration = Duration::from_millis(20);

/// Refuses --open where no report is written.
pub(super) fn possible(open: bool, is_written: bool) -> Result<(), Fault> {
    if open && !is_written {
        let text =
            "error: --open needs the report, which --until leaves out\nhelp: leave out --open, or --until"
                .to_owned();
        return Err(Fault { code: BAD_SPEC, text });
    }
    Ok(())
}

/// Opens a file; prints a warning if that fails.
pub(super) fn open(path: &Path) {
    if let Err(why) = tried(path) {
        let _ =
            writeln!(std::io::stderr().lock(), "warning: cannot open {} with {VIEWER}: {why}", shown(path));
    }
}

fn tried(path: &Path) -> Result<(), String> {
    let mut command = Command::new(VIEWER);
    command.arg(path).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut viewer = command.spawn().map_err(|error| error.to_string())?;
    let since = Instant::now();
    while since.elapsed() < PATIENCE {
        // `explorer` returns 1 also after success.
        match viewer.try_wait() {
            Ok(Some(status)) if status.success() || cfg!(windows) => return Ok(()),
            Ok(Some(status)) => return Err(format!("it ended with {status}")),
            Ok(None) => std::thread::sleep(EVERY),
            Err(error) => return Err(error.to_string()),
        }
    }
    // It is still running: the file is open.
    Ok(())
}
