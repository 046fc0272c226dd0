//! The Python, SQL and R blocks of the guide, run on the run that the tutorial makes.

use super::blocks::{Page, pages};
use crate::bench::{skip, stderr};
use crate::python::environment;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// Packages that the environment of this test does not have: the tests of the Python package run `hysteron`, the others are large.
const MISSING: [&str; 3] = ["hysteron", "SurfaceTopography", "tamaas"];

/// Runs that pages name; this test has the tutorial's in their place.
const OTHER_RUNS: [&str; 4] = ["quickstart", "paper", "sens", "mine"];

fn hysteron(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron")).args(arguments).current_dir(folder).output().unwrap()
}

/// The run of the tutorial with its change and its sweep, and a measured surface.
fn tutorial() -> TempDir {
    let folder = TempDir::new().unwrap();
    let page = pages().into_iter().find(|page| page.name == "tutorial.md").unwrap();
    let [spec, change, sweep] = page.code("toml").collect::<Vec<_>>()[..] else { panic!("the tutorial has other blocks") };
    let old = spec.lines().find(|line| line.starts_with("max_load")).unwrap();
    std::fs::write(folder.path().join("gel.toml"), format!("{}\n{sweep}", spec.replace(old, change.trim()))).unwrap();
    let ran = hysteron(folder.path(), &["run", "gel.toml", "--until", "aggregate"]);
    assert!(ran.status.success(), "{}", stderr(&ran));
    let exported = hysteron(folder.path(), &["export", "csv", "data/runs/gel"]);
    assert!(exported.status.success(), "{}", stderr(&exported));
    let mut heights = String::new();
    for row in 0..64 {
        let line: Vec<String> =
            (0..64).map(|column| format!("{:.6}", (0.3 * f64::from(row)).cos() * (0.25 * f64::from(column)).sin())).collect();
        writeln!(heights, "{}", line.join(" ")).unwrap();
    }
    std::fs::write(folder.path().join("my_scan.txt"), heights).unwrap();
    let taken = hysteron(folder.path(), &["import", "my_scan.txt", "--pixel-m", "1e-8", "--unit", "nm"]);
    assert!(taken.status.success(), "{}", stderr(&taken));
    folder
}

/// The script of a page, and the number of its blocks.
fn script(page: &Page) -> (String, usize) {
    let mut script = String::new();
    let mut count = 0;
    for block in &page.blocks {
        let is_missing = |line: &str| {
            let module = line.strip_prefix("import ").or(line.strip_prefix("from ")).unwrap_or_default();
            MISSING.iter().any(|name| module.split([' ', '.', ',']).any(|word| word == *name))
        };
        match block.language.as_str() {
            "python" if block.code.lines().any(is_missing) => continue,
            "python" => script += &block.code,
            "sql" => script += &format!("import duckdb\nprint(duckdb.sql(\"\"\"{}\"\"\"))\n", block.code.trim().trim_end_matches(';')),
            _ => continue,
        }
        count += 1;
    }
    if page.name == "howto_data.md" {
        // The text states this range.
        script += "assert 0.9965 < sums['events_over_loss'].min() and sums['events_over_loss'].max() < 1.0015 and len(sums) == 16\n";
    }
    if page.name == "tutorial.md" {
        script += "assert f'n = {np.mean(fits):.3f} ± {np.std(fits, ddof=1):.3f}' == 'n = 1.717 ± 0.002'\n";
    }
    (with_own_run(&script), count)
}

fn with_own_run(code: &str) -> String {
    OTHER_RUNS.iter().fold(code.to_owned(), |code, run| code.replace(&format!("data/runs/{run}"), "data/runs/gel"))
}

#[test]
fn e2e_snippets_of_the_guide_run() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let packages = std::fs::read_to_string(root.join("tests/python/requirements.txt")).unwrap();
    let Some(environment) = environment("readers", &packages.lines().collect::<Vec<_>>()) else { return };
    let folder = tutorial();
    let mut total = 0;
    for page in pages() {
        let (script, count) = script(&page);
        total += count;
        std::fs::write(folder.path().join("page.py"), &script).unwrap();
        let python =
            Command::new(environment.join("bin/python")).arg("page.py").env("MPLBACKEND", "Agg").current_dir(folder.path()).output();
        let ran = python.unwrap();
        assert!(ran.status.success(), "{}: {}", page.name, stderr(&ran));
    }
    assert!(total >= 10, "{total}");
    assert!(std::fs::read(folder.path().join("gel.png")).unwrap().starts_with(b"\x89PNG"));
    for page in pages() {
        for block in page.code("r") {
            std::fs::write(folder.path().join("block.R"), with_own_run(block)).unwrap();
            match Command::new("Rscript").arg("block.R").current_dir(folder.path()).output() {
                Ok(ran) => assert!(ran.status.success(), "{}: {}", page.name, stderr(&ran)),
                Err(error) => skip("R", &format!("Rscript: {error}")),
            }
        }
    }
}
