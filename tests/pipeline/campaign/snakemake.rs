//! Snakemake on the Snakefile of `export snakemake`: lost results, edited specs, interruptions and relative paths.

use super::SMALL;
use crate::bench::{Bench, SPEC, code, files, stderr, stdout};
use crate::python;
use hysteron::schema::CASES;
use hysteron::store::parquet::read_table;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Snakemake: of the path, or of an environment of its own.
fn snakemake() -> Option<PathBuf> {
    let on_path = Command::new("snakemake").arg("--version").output().is_ok_and(|said| said.status.success());
    if on_path {
        Some("snakemake".into())
    } else {
        python::environment("snakemake", &["snakemake==9.*"]).map(|of| of.join("bin/snakemake"))
    }
}

/// Writes the Snakefile of a spec with so many shards.
fn export(bench: &Bench, spec: &str, shards: &str) {
    fs::write(bench.spec(), spec).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
    let written = command.args(["export", "snakemake", "--shards", shards, "--out"]).arg(bench.out()).arg(bench.spec()).output().unwrap();
    assert_eq!(code(&written), 0, "{}", stderr(&written));
}

/// Runs Snakemake in a folder, to the end or to some targets: all that it says.
fn flow(program: &Path, bench: &Bench, place: &Path, targets: &[&str]) -> String {
    let mut command = Command::new(program);
    command.arg("--snakefile").arg(bench.out().join("snakemake/Snakefile")).args(["--cores", "2"]).current_dir(place);
    command.args(targets.iter().map(|name| bench.out().join("snakemake").join(name)));
    // Its jobs start it again by its name.
    let own = program.parent().map(|folder| folder.display().to_string()).filter(|folder| !folder.is_empty());
    let path = own.into_iter().chain(std::env::var("PATH")).collect::<Vec<_>>().join(":");
    let ran = command.env("PATH", path).output().unwrap();
    assert!(ran.status.success(), "{}{}", stdout(&ran), stderr(&ran));
    stderr(&ran) + &stdout(&ran)
}

const IDLE: &str = "Nothing to be done";

#[test]
fn e2e_snakemake_does_what_run_does() {
    let Some(program) = snakemake() else { return };
    let alone = Bench::new(SPEC);
    assert_eq!(code(&alone.verb("run", &[])), 0);
    let bench = Bench::new(SPEC);
    export(&bench, SPEC, "3");
    let here = bench.folder.path();
    flow(&program, &bench, here, &[]);
    let results = |bench: &Bench| files(&bench.out()).into_iter().filter(|(path, _)| !path.starts_with("snakemake")).collect::<Vec<_>>();
    let same = |what: &str| assert!(results(&bench) == results(&alone), "{what}: other bytes than of a run");
    same("first");
    assert!(flow(&program, &bench, here, &[]).contains(IDLE));
    // What is lost is computed again, and nothing else.
    for lost in ["cycles", "statistics", "receipts/report", "surfaces", "report.html"] {
        let path = bench.out().join(lost);
        if path.is_dir() {
            fs::remove_dir_all(&path).unwrap();
        } else {
            fs::remove_file(&path).unwrap();
        }
        assert!(!flow(&program, &bench, here, &[]).contains(IDLE), "{lost}");
        same(lost);
        assert!(flow(&program, &bench, here, &[]).contains(IDLE), "{lost}");
    }
}

#[test]
fn e2e_snakemake_follows_an_edited_spec_and_an_interruption() {
    let Some(program) = snakemake() else { return };
    let bench = Bench::new(SPEC);
    let (here, elsewhere) = (bench.folder.path(), tempfile::tempdir().unwrap());
    let loads = || {
        let cases = read_table(&bench.out().join("statistics/cases.parquet"), &CASES).unwrap();
        let mut loads = cases.f64("max_load").unwrap();
        loads.sort_by(f64::total_cmp);
        loads.dedup();
        loads
    };
    let one = SPEC.replace("[0.001, 0.002]", "[0.001]");
    export(&bench, &one, "2");
    flow(&program, &bench, here, &[]);
    assert_eq!(loads(), [0.001]);
    // Edited, without a new export.
    fs::write(bench.spec(), SPEC).unwrap();
    flow(&program, &bench, here, &[]);
    assert_eq!(loads(), [0.001, 0.002]);
    // Another export, interrupted after the cycles.
    export(&bench, &one.replace("0.001", "0.0015"), "2");
    flow(&program, &bench, elsewhere.path(), &["cycle-0.done", "cycle-1.done"]);
    flow(&program, &bench, elsewhere.path(), &[]);
    assert_eq!(loads(), [0.0015]);
    let status = stdout(&bench.look("status", &[]));
    assert!(status.contains("Nothing is left to do."), "{status}");
    assert!(flow(&program, &bench, elsewhere.path(), &[]).contains(IDLE));
}

#[test]
fn e2e_snakemake_finds_relative_scans_and_goes_on_after_failures() {
    let Some(program) = snakemake() else { return };
    let bench = Bench::new("");
    let (here, elsewhere) = (bench.folder.path(), tempfile::tempdir().unwrap());
    fs::create_dir(here.join("scans")).unwrap();
    let height = |i: u32, j: u32| 1000.0 * (0.5 * f64::from(i)).sin() * (0.4 * f64::from(j)).cos();
    let rows: Vec<String> = (0..48).map(|i| (0..48).map(|j| format!("{:.3}", height(i, j))).collect::<Vec<_>>().join(" ")).collect();
    fs::write(here.join("scans/a.txt"), rows.join("\n")).unwrap();
    fs::write(here.join("scans/bad.txt"), "1 2 x\n3 4 5\n").unwrap();
    let spec = "name = \"scans\"\n[surface]\npixel_m = 1e-6\nunit = \"nm\"\n[material]\ncontact_modulus_pa = 1e9\nwork_of_adhesion_j_m2 = 1e-3\n[model]\n\
                boundary = \"isolated\"\nallow_low_tabor = true\n[cycle]\nmax_load = [0.0005]\napproach_step = 0.05\n[[sweep]]\nname = \"all\"\n\
                surface.file = [\"scans/a.txt\", \"scans/bad.txt\"]\n";
    fs::write(bench.spec(), spec).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
    let written = command.args(["export", "snakemake", "spec.toml", "--out", "out"]).current_dir(here).output().unwrap();
    assert_eq!(code(&written), 0, "{}", stderr(&written));
    flow(&program, &bench, elsewhere.path(), &[]);
    let status = stdout(&bench.look("status", &[]));
    assert!(status.contains("cycle     1 done, 1 failed\n") && status.contains("All other tasks are done."), "{status}");
    assert!(flow(&program, &bench, elsewhere.path(), &[]).contains(IDLE), "a failed task is not repeated");
}

#[test]
fn law_rules_have_the_spec_and_pending_tasks_as_inputs() {
    let bench = Bench::new(SMALL);
    fs::create_dir(bench.out()).unwrap();
    export(&bench, SMALL, "2");
    let text = fs::read_to_string(bench.out().join("snakemake/Snakefile")).unwrap();
    let absolute = |path: &Path| serde_json::to_string(path.to_str().unwrap()).unwrap();
    assert!(text.contains(&format!("\nSPEC = {}\n", absolute(&bench.spec()))), "{text}");
    assert!(text.contains(&format!("\nDIR = {}\nSHARDS = 2\n", absolute(&bench.out()))), "{text}");
    for (rule, before) in [("generate", ""), ("extract", "generate"), ("cycle", "extract"), ("report", "cycle")] {
        let body = text.split(&format!("\nrule {rule}:\n")).nth(1).and_then(|rest| rest.split("\nrule ").next()).unwrap();
        let input = body.lines().find(|line| line.trim_start().starts_with("input:")).unwrap();
        assert!(input.contains("spec=SPEC") && input.contains("pending=f\"{DIR}/snakemake/"), "{rule}: {input}");
        assert!(before.is_empty() || input.contains(&format!("{before}-{{{{shard}}}}.done")), "{rule}: {input}");
        assert!(body.contains("cd {params.folder:q} && {params.program:q} "), "{rule}: {body}");
    }
}
