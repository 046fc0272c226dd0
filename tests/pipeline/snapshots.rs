//! Printed texts and the contract of the tables, compared with `tests/pipeline/snapshots`. `cargo bless` writes these files.

use std::fmt::Write as _;

use hysteron::schema::{Column, TABLES, Table};
use insta::assert_snapshot;

use crate::bench::{Bench, code, stderr, stdout};
use crate::cli::{SMALL, hysteron};

/// A text with `KEY` in place of each key of a task, which depends on the versions of the stages.
fn without_keys(text: &str) -> String {
    let is_key = |part: &str| {
        let digits = part.chars().take_while(char::is_ascii_hexdigit).count();
        digits == 8 && !part[digits..].starts_with(|c: char| c.is_alphanumeric() || c == '-')
    };
    let replaced = |part: &str| if is_key(part) { format!("-KEY{}", &part[8..]) } else { format!("-{part}") };
    let mut parts = text.split('-');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + &replaced(part))
}

/// Commands in the folder of a bench, with exit codes and everything that they print.
fn session(bench: &Bench, commands: &[&str]) -> String {
    let mut text = String::new();
    for command in commands {
        let output = hysteron(bench, &command.split_whitespace().collect::<Vec<_>>());
        writeln!(text, "$ hysteron {command}\n{}{}[exit code {}]\n", stdout(&output), stderr(&output), code(&output)).unwrap();
    }
    without_keys(&text)
}

#[test]
fn reg_plan_and_status() {
    let bench = Bench::new(&(SMALL.to_owned() + "[[sweep]]\nname = \"modulus\"\nmaterial.contact_modulus_pa = [1e6, 1e9]\n"));
    assert_snapshot!("plan", session(&bench, &["plan spec.toml --out out", "status spec.toml --out out"]));
    assert_eq!(code(&bench.verb("run", &["--until", "extract"])), 0);
    assert_snapshot!("status_of_surfaces", session(&bench, &["status out", "plan out --set cycle.approach_step=0.1"]));
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
    assert_snapshot!("status_of_cycles", session(&bench, &["status out", "plan out", "clean out", "explain out statistics"]));
}

#[test]
fn reg_error_messages() {
    let bench = Bench::new(SMALL);
    let faults = "nme = \"x\"\n[surface]\nhurts = 0.8\nhurst = 2\nmagnification = 7.5\n[model]\ninteraction = \"spot\"\n";
    std::fs::write(bench.folder.path().join("faults.toml"), faults).unwrap();
    let commands = [
        "plan faults.toml",
        "plan missing.toml",
        "plan spec.toml --set surface.hurst=7",
        "status spec.toml",
        "cycle spec.toml --out out",
        "aggregate spec.toml --out out",
        "show out report",
        "frobnicate",
        "run spec.toml --until nothing",
        "run spec.toml --shard 1/1",
        "export csv out",
        "compare out",
    ];
    assert_snapshot!("errors", session(&bench, &commands));
}

/// A line for each column: name, kind, unit, and `null` where a value may be missing.
fn columns(table: &Table) -> String {
    let line = |c: &Column| {
        let unit = if c.unit.is_empty() { "-" } else { c.unit };
        format!("{} {} {unit}{}\n", c.name, c.kind.word(), if c.nullable { " null" } else { "" })
    };
    format!("{}, version {}\n\n{}", table.file, table.version, table.columns.iter().map(line).collect::<String>())
}

/// Names, kinds and units stand in published files: add columns freely, and raise the version of a table with every other change.
#[test]
fn reg_columns_are_those_of_the_contract() {
    for table in TABLES {
        assert_snapshot!(format!("table_{}", table.name), columns(table));
    }
}
