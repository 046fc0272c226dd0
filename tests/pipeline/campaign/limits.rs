//! The environment: threads, address space, names that a terminal or a shell would take for something else.
#![cfg(unix)]

use super::SMALL;
use crate::bench::{Bench, code, files, stderr, stdout};
use std::fs;
use std::process::{Command, Output};

/// A command by a shell that sets a limit or a variable before, at most two minutes.
fn shell(bench: &Bench, before: &str, verb: &str) -> Output {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("{before} exec timeout 120 \"$@\""), "sh", env!("CARGO_BIN_EXE_hysteron"), verb]);
    command.arg(bench.spec()).arg("--out").arg(bench.out()).output().unwrap()
}

#[test]
fn e2e_any_number_of_threads_in_the_environment_is_taken() {
    let plain = Bench::new(SMALL);
    assert_eq!(code(&plain.verb("run", &[])), 0);
    for variables in [
        "POLARS_MAX_THREADS=0",
        "RAYON_NUM_THREADS=0",
        "POLARS_MAX_THREADS=99999999 RAYON_NUM_THREADS=99999999",
        "POLARS_MAX_THREADS=-1 RAYON_NUM_THREADS=no",
    ] {
        let bench = Bench::new(SMALL);
        let run = shell(&bench, &format!("export {variables};"), "run");
        assert_eq!(code(&run), 0, "{variables}: {}", stderr(&run));
        assert!(!stderr(&run).contains("panicked"), "{variables}: {}", stderr(&run));
        assert!(files(&bench.out()) == files(&plain.out()), "{variables}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn e2e_too_little_address_space_is_one_sentence() {
    let bench = Bench::new(SMALL);
    let run = shell(&bench, "ulimit -v 300000;", "run");
    assert_eq!(code(&run), 1, "{}", stderr(&run));
    assert!(
        stderr(&run).starts_with("error: the address space is limited to 307 MB, and a computation needs about 500 MB\nhelp: "),
        "{}",
        stderr(&run)
    );
    assert_eq!(stderr(&run).lines().count(), 2, "{}", stderr(&run));
    assert!(!bench.out().exists());
}

#[test]
fn e2e_the_root_folder_is_no_output_folder() {
    let bench = Bench::new(SMALL);
    for out in ["/", "//", "/usr/..", "/./"] {
        // The plan writes nothing, whatever the program does of this test.
        let plan = Command::new(env!("CARGO_BIN_EXE_hysteron")).arg("plan").arg(bench.spec()).args(["--out", out]).output().unwrap();
        assert_eq!(code(&plan), 2, "{out}: {}", stdout(&plan));
        assert!(stderr(&plan).contains("the root folder\nhelp: "), "{}", stderr(&plan));
    }
}

#[test]
fn e2e_names_cannot_move_a_cursor_nor_run_a_command() {
    let bench = Bench::new(SMALL);
    let name = "a\u{1b}[31m\n\u{9b}2J$(touch pwned) it's";
    let out = bench.folder.path().join(name);
    let at = |verb: &str, more: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_hysteron")).arg(verb).args(more).current_dir(bench.folder.path()).output().unwrap()
    };
    let spec = bench.spec().display().to_string();
    let folder = out.display().to_string();
    let mut said = String::new();
    let run = at("run", &[&spec, "--out", &folder, "--until", "extract"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let outputs = [
        run,
        at("status", &[&folder]),
        at("verify", &[&folder]),
        at("gc", &[&folder]),
        at("plan", &[&spec, "--out", &folder]),
        at("import", &[name]),
        at("run", &[name]),
    ];
    for output in &outputs {
        said += &(stdout(output) + &stderr(output));
    }
    assert!(said.contains("\\u001b[31m") && said.contains("\\u009b2J"), "{said}");
    assert!(said.chars().all(|c| c == '\n' || !c.is_control()), "{said:?}");
    // The command that `status` prints is pasted.
    let status = stdout(&outputs[1]);
    let command = status.split('`').nth(1).unwrap().replacen("hysteron", env!("CARGO_BIN_EXE_hysteron"), 1);
    if Command::new("bash").arg("-c").arg("true").status().is_ok_and(|status| status.success()) {
        let pasted = Command::new("bash").args(["-c", &command]).current_dir(bench.folder.path()).output().unwrap();
        assert_eq!(code(&pasted), 0, "{command}: {}", stderr(&pasted));
        assert!(out.join("report.html").is_file() && !bench.folder.path().join("pwned").exists(), "{command}");
    }
    let json: serde_json::Value = serde_json::from_str(&stdout(&at("status", &[&folder, "--json"]))).unwrap();
    assert_eq!(json["dir"], folder.as_str(), "machines get the name itself");
    fs::remove_dir_all(out).unwrap();
}
