//! A full disk, a broken one, and writes that take half: at every call in turn.
#![cfg(target_os = "linux")]

use super::SMALL;
use crate::bench::{Bench, code, files, skip, stderr};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// What the system says of a broken disk and of a full one; and a short write.
const KINDS: [(i32, &str); 3] = [(5, "Input/output error"), (28, "No space left on device"), (0, "")];

/// The library that stands between the program and the system; nothing where there is no compiler.
pub fn shim(name: &str) -> Option<PathBuf> {
    let library = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("shim-{name}-{}.so", std::process::id()));
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pipeline/campaign/shim.c");
    let built = Command::new("cc").args(["-shared", "-fPIC", "-O1", "-o"]).arg(&library).arg(source).arg("-ldl").output();
    built.ok().filter(|output| output.status.success()).map(|_| library)
}

/// Runs the small campaign on one thread, with the fault at a call.
fn run(bench: &Bench, shim: &Path, at: u64, kind: i32) -> (Output, u64) {
    let count = bench.folder.path().join("count");
    let mut command = bench.command("run");
    command.args(["--jobs", "1"]).env("LD_PRELOAD", shim).env("FAULT_AT", at.to_string()).env("FAULT_KIND", kind.to_string());
    let output = command.env("FAULT_COUNT", &count).output().unwrap();
    let calls = std::fs::read_to_string(count).unwrap_or_default().parse().unwrap_or(0);
    (output, calls)
}

#[test]
fn e2e_a_disk_that_fails_at_any_call_tears_nothing() {
    let Some(shim) = shim("faults") else {
        return skip("cc", "there is no C compiler to build tests/pipeline/campaign/shim.c with");
    };
    let undisturbed = Bench::new(SMALL);
    let (output, calls) = run(&undisturbed, &shim, 0, 0);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let whole = files(&undisturbed.out());
    assert!(calls > 150, "{calls} calls were seen: the program is linked in another way");
    // All of them with HYSTERON_FAULTS=all; otherwise some, spread evenly.
    let step = if std::env::var("HYSTERON_FAULTS").is_ok_and(|asked| asked == "all") { 1 } else { calls / 8 + 1 };
    let mut failed = 0;
    for (kind, word) in KINDS {
        for at in (1 + u64::from(kind.unsigned_abs()) % step..=calls).step_by(usize::try_from(step).unwrap()) {
            let bench = Bench::new(SMALL);
            let (output, _) = run(&bench, &shim, at, kind);
            let said = stderr(&output);
            if kind == 0 {
                assert_eq!(code(&output), 0, "call {at} short: {said}");
            } else if code(&output) != 0 {
                failed += 1;
                assert_eq!(code(&output), 1, "call {at}: {said}");
                let last = said.lines().rfind(|line| line.starts_with("error: ")).unwrap_or_default();
                assert!(last.starts_with("error: cannot ") && last.contains(bench.out().to_str().unwrap()), "call {at}: {said}");
                assert!(last.contains(word), "call {at}: {said}");
            }
            // What has a receipt is whole, whatever happened.
            let campaign = bench.out().join("campaign.toml").is_file();
            if campaign {
                let verified = bench.look("verify", &["--deep", "--json"]);
                let audit: serde_json::Value = serde_json::from_slice(&verified.stdout).unwrap();
                // The files of the task at which it ended have no receipt yet.
                assert_eq!(audit["faults"], serde_json::json!([]), "call {at}: {audit:#}");
            }
            let again = bench.verb("run", &["--jobs", "1"]);
            assert_eq!(code(&again), 0, "call {at}: {}", stderr(&again));
            assert!(files(&bench.out()) == whole, "call {at} of kind {kind}: other bytes");
        }
    }
    eprintln!("{calls} calls; {failed} runs failed");
    assert!(failed > 10, "{failed}");
    std::fs::remove_file(shim).unwrap();
}

#[test]
fn e2e_a_power_cut_loses_nothing_that_has_a_receipt() {
    let bench = Bench::new(SMALL);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/disk/power_cut.sh");
    let count = std::env::var("HYSTERON_CUTS").unwrap_or_else(|_| "5".to_owned());
    let folder = bench.folder.path().join("disk");
    std::fs::create_dir(&folder).unwrap();
    let tried = Command::new(script).arg(env!("CARGO_BIN_EXE_hysteron")).arg(bench.spec()).arg(folder).arg(count).output().unwrap();
    if tried.status.code() == Some(77) {
        return skip("disk", stderr(&tried).trim());
    }
    let said = String::from_utf8_lossy(&tried.stdout);
    assert!(tried.status.success(), "{said}{}", stderr(&tried));
    assert!(!said.trim_end().ends_with(" 0 receipts"), "{said}");
    eprintln!("{}", said.lines().last().unwrap_or_default());
}
