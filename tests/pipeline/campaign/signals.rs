//! Signals: interrupts, hang-ups that are ignored, and the limit on the size of files.
#![cfg(unix)]

use crate::bench::{Bench, SPEC, code, files, paths, skip, stderr};
#[cfg(target_os = "linux")]
use std::io::Read as _;
#[cfg(target_os = "linux")]
use std::path::Path;
use std::process::{Child, Command, Stdio};
#[cfg(target_os = "linux")]
use std::time::{Duration, Instant};

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
        assert!(!bench.out().join("progress.html").exists(), "the page of progress was left");
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

/// The small campaign in a write that never returns, which holds the locks that an interrupt waits for.
#[cfg(target_os = "linux")]
fn stuck(bench: &Bench, shim: &Path) -> Child {
    let mark = bench.folder.path().join("stuck");
    let mut command = bench.command("run");
    command.args(["--jobs", "1"]).env("LD_PRELOAD", shim).env("FAULT_AT", "60").env("FAULT_KIND", "-1").env("FAULT_COUNT", &mark);
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let began = Instant::now();
    while !mark.exists() {
        assert!(began.elapsed() < Duration::from_secs(60), "it was never stuck");
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

/// How a process ends; nothing after a minute.
#[cfg(target_os = "linux")]
fn ended(child: &mut Child) -> Option<i32> {
    let began = Instant::now();
    while began.elapsed() < Duration::from_secs(60) {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status.code().unwrap_or(-1));
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().unwrap();
    None
}

#[cfg(target_os = "linux")]
#[test]
fn e2e_an_interrupt_ends_a_run_whose_write_is_stuck() {
    let Some(shim) = super::faults::shim("signals") else {
        return skip("cc", "there is no C compiler to build tests/pipeline/campaign/shim.c with");
    };
    let undisturbed = Bench::new(super::SMALL);
    assert_eq!(code(&undisturbed.verb("run", &[])), 0);
    // One signal, whose patience ends; or a second one, of the other kind.
    for signals in [&["-TERM"][..], &["-INT", "-TERM"]] {
        let bench = Bench::new(super::SMALL);
        let mut child = stuck(&bench, &shim);
        let mut output = child.stderr.take().unwrap();
        let mut said = Vec::new();
        for signal in signals {
            send(signal, &child);
            // The next one comes when this one was heard.
            while !String::from_utf8_lossy(&said).contains("interrupted: ") {
                let mut byte = [0];
                assert_eq!(output.read(&mut byte).unwrap(), 1, "{signals:?}: {}", String::from_utf8_lossy(&said));
                said.push(byte[0]);
            }
        }
        assert_eq!(ended(&mut child), Some(130), "{signals:?}");
        assert_eq!(code(&bench.verb("run", &[])), 0);
        assert_eq!(code(&bench.look("gc", &["--delete"])), 0);
        assert!(files(&bench.out()) == files(&undisturbed.out()), "other bytes than without an interrupt");
    }
    std::fs::remove_file(shim).unwrap();
}
