//! Python with what a test needs, and what other programs find in a run.

use crate::bench::{Bench, SPEC, code, skip, stderr};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, PoisonError};

static MAKING: Mutex<()> = Mutex::new(());

/// An environment of its own below the target directory with these packages of PyPI; nothing, and a line that says why, where it cannot be had.
pub fn environment(name: &str, packages: &[&str]) -> Option<PathBuf> {
    // Tests that run at once are not to fill one folder twice.
    let _alone = MAKING.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    // Written when all is there: what was begun and not ended is done again.
    let complete = folder.join(format!("complete-{}", blake3::hash(packages.join(" ").as_bytes()).to_hex().get(..8)?));
    if complete.is_file() {
        return Some(folder);
    }
    let skipped = |why: &str| {
        skip("python", &format!("{name}: {why}"));
        None
    };
    let ran = |command: &mut Command| -> Option<Output> { command.output().ok().filter(|output| output.status.success()) };
    if ran(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder)).is_none() {
        return skipped("there is no Python 3 with venv");
    }
    let filled = Command::new(folder.join("bin/pip")).args(["install", "-q"]).args(packages).output().ok()?;
    if !filled.status.success() {
        return skipped(&format!("{} cannot be installed: {}", packages.join(", "), stderr(&filled).trim()));
    }
    std::fs::write(&complete, "").ok()?;
    Some(folder)
}

/// Runs a script of the repository on the output of a run; what it says.
fn script(name: &str, bench: &Bench, more: &[&Path]) -> Option<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let packages = std::fs::read_to_string(root.join("tests/python/requirements.txt")).unwrap();
    let folder = environment("readers", &packages.lines().collect::<Vec<_>>())?;
    let output = Command::new(folder.join("bin/python")).arg(root.join(name)).arg(bench.out()).args(more).output().unwrap();
    assert!(output.status.success(), "{name}: {}", stderr(&output));
    Some(String::from_utf8(output.stdout).unwrap())
}

/// The first number of a text.
fn first_number(text: &str) -> usize {
    text.split_whitespace().find_map(|word| word.parse().ok()).unwrap()
}

/// Adhesion, a program of others, on the same surface with the same law: loads and areas of 19 of 20 steps of a loading are equal to 1 %. The script
/// compares them; the other steps are at an instability, which two programs do not pass at the same approach.
#[test]
fn val_adhesion_follows_the_same_loading() {
    let Some(folder) = environment("peers", &["Adhesion==0.93", "h5py==3.*", "numpy", "pyarrow"]) else { return };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/peers.py");
    let output =
        Command::new(folder.join("bin/python")).arg(script).args([env!("CARGO_BIN_EXE_hysteron"), "64", "0.0071"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", stderr(&output));
    assert!(said.contains(" steps are equal within 1 %"), "{said}");
}

#[test]
fn e2e_other_programs_read_the_same_values() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    if let Some(said) = script("tests/python/readers.py", &bench, &[]) {
        // Of each of the four cycles six tables, three of each surface, and ten over realizations.
        assert_eq!(first_number(&said), 4 * 6 + 4 * 3 + 10, "{said}");
    }
}

#[test]
fn e2e_plain_python_finds_the_same_means() {
    let bench = Bench::new(&SPEC.replace("realizations = 2", "realizations = 3"));
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    if let Some(said) = script("tests/python/aggregates.py", &bench, &[]) {
        // Five numbers of each of 12 rows, and four of the mean of each of these in 4 cases.
        assert_eq!(first_number(&said), 5 * 12 + 4 * 5 * 4, "{said}");
    }
}

#[test]
fn e2e_tables_join_and_their_description_is_valid() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    if let Some(said) = script("tests/python/joins.py", &bench, &[]) {
        // Two numbers of each of two magnifications and two realizations, by three joins.
        assert_eq!(first_number(&said), 2 * 4 * 3, "{said}");
    }
    if let Some(said) = script("tests/python/package.py", &bench, &[]) {
        assert_eq!(first_number(&said), 4 * 6 + 4 * 3 + 10, "{said}");
    }
}

#[test]
fn e2e_every_surface_begins_from_what_h5py_makes() {
    let bench = Bench::new(SPEC);
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    if script("tests/python/start.py", &bench, &[]).is_some() {
        assert_eq!(std::fs::read(bench.out()).unwrap(), std::fs::read(root.join("src/store/start.h5")).unwrap());
    }
}

#[test]
fn e2e_the_worked_example_ends_at_a_figure() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let figure = bench.folder.path().join("hysteresis.png");
    if let Some(said) = script("data/examples/hysteresis.py", &bench, &[&figure]) {
        assert!(said.contains("dissipated energy ") && said.trim_end().ends_with(" J"), "{said}");
        assert!(std::fs::read(figure).unwrap().starts_with(b"\x89PNG"));
    }
    let bench = Bench::new(&SPEC.replace("[cycle]", "[model]\nmethod = \"boundary_elements\"\n[cycle]"));
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let figure = bench.folder.path().join("loop.svg");
    if script("data/examples/loop.py", &bench, &[&figure]).is_some() {
        let drawn = std::fs::read_to_string(figure).unwrap();
        assert!(["pull-off force", "Θ", "maximum load"].iter().all(|words| drawn.contains(words)));
    }
}
