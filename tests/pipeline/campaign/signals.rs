//! Signals: interrupts, hang-ups that are ignored, and the limit on the size of files.
#![cfg(unix)]

use crate::bench::{Bench, SPEC, code, files, paths, stderr};
use std::process::{Child, Command, Stdio};

/// The program at work on the spec, started by a shell that sets something up before, as soon as it has written more files than there were.
fn at_work(bench: &Bench, setup: &str) -> Child {
    let count = || if bench.out().exists() { paths(&bench.out()).len() } else { 0 };
    let before = count();
    let mut command = Command::new("sh");
    command.args(["-c", &format!("{setup} \"$@\""), "sh", env!("CARGO_BIN_EXE_hysteron"), "run", "--jobs", "1", "--out"]);
    command.arg(bench.out()).arg(bench.spec());
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    while child.try_wait().unwrap().is_none() && count() <= before + 2 {
        std::thread::yield_now();
    }
    child
}

fn send(signal: &str, child: &Child) {
    Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
}

#[test]
fn e2e_an_interrupt_loses_no_file_and_the_same_command_goes_on() {
    let undisturbed = Bench::new(SPEC);
    assert_eq!(code(&undisturbed.verb("run", &[])), 0);
    let bench = Bench::new(SPEC);
    let mut interrupts = 0;
    for signal in ["-INT", "-TERM"] {
        let child = at_work(&bench, "exec");
        send(signal, &child);
        let ended = child.wait_with_output().unwrap();
        let said = stderr(&ended);
        if ended.status.code() == Some(130) {
            interrupts += 1;
            assert!(said.contains("interrupted: ") && said.contains("campaign.toml --out"), "{said}");
        } else {
            // It was done before the signal came.
            assert_eq!(code(&ended), 0, "{said}");
        }
        assert!(files(&bench.out()).keys().all(|path| !path.to_string_lossy().contains(".tmp")), "a temporary file was left");
    }
    assert!(interrupts > 0);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    assert!(files(&bench.out()) == files(&undisturbed.out()), "other bytes than without an interrupt");
}

#[test]
fn e2e_hang_ups_that_are_ignored_do_not_end_a_run() {
    let bench = Bench::new(SPEC);
    let child = at_work(&bench, "trap '' HUP; exec");
    send("-HUP", &child);
    let ended = child.wait_with_output().unwrap();
    assert_eq!(code(&ended), 0, "{}", stderr(&ended));
}

#[test]
fn e2e_a_limit_on_the_size_of_files_is_an_error_of_the_write() {
    let bench = Bench::new(SPEC);
    // 512 bytes each: less than any surface.
    let child = at_work(&bench, "ulimit -f 8; exec");
    let ended = child.wait_with_output().unwrap();
    let said = stderr(&ended);
    assert_eq!(code(&ended), 1, "{said}");
    assert!(said.contains("error: cannot write") && said.contains("File too large"), "{said}");
    assert_eq!(code(&bench.verb("run", &[])), 0);
}
