//! Lost receipts and files that no receipt names in `verify`, and figures that `gc` removes.

use super::SMALL;
use crate::bench::{Bench, code, files, stderr, stdout};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

/// What an audit has found: tasks without a receipt, files that no receipt names, and whether the exit code says so.
fn audit(bench: &Bench) -> (Vec<String>, Vec<String>) {
    let verified = bench.look("verify", &["--json"]);
    let audit: Value = serde_json::from_str(&stdout(&verified)).unwrap();
    let list = |name: &str| audit[name].as_array().unwrap().iter().map(|text| text.as_str().unwrap().to_owned()).collect::<Vec<_>>();
    let (tasks, unnamed) = (list("unreceipted"), list("unnamed"));
    assert_eq!(audit["faults"], serde_json::json!([]));
    assert_eq!(code(&verified), i32::from(!(tasks.is_empty() && unnamed.is_empty())), "{audit:#}");
    (tasks, unnamed)
}

/// The receipts of a stage.
fn receipts(bench: &Bench, stage: &str) -> Vec<PathBuf> {
    let folder = format!("receipts/{stage}");
    bench.receipts().into_keys().filter(|path| path.parent().unwrap().ends_with(&folder)).collect()
}

#[test]
fn e2e_a_lost_receipt_is_a_fault() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let whole = files(&bench.out());
    assert_eq!(audit(&bench), (Vec::new(), Vec::new()));
    for stage in ["generate", "extract", "cycle", "aggregate", "report"] {
        let lost = &receipts(&bench, stage)[0];
        fs::remove_file(lost).unwrap();
        let task = format!("{stage} {}", lost.file_stem().unwrap().to_str().unwrap());
        assert_eq!(audit(&bench), (vec![task.clone()], Vec::new()));
        let said = stdout(&bench.look("verify", &["--deep"]));
        assert!(
            said.contains(&format!("1 task has results and no receipt:\n  {task}\n")) && said.contains(" compared, 1 fault."),
            "{said}"
        );
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_hysteron"));
        let refused = command.args(["export", "ro-crate"]).arg(bench.out()).output().unwrap();
        assert!(code(&refused) == 1 && stderr(&refused).contains(&format!("{task} has results and no receipt")), "{}", stderr(&refused));
        let again = bench.verb("run", &[]);
        assert_eq!(code(&again), 0, "{}", stderr(&again));
        assert!(files(&bench.out()) == whole);
    }
    assert_eq!(audit(&bench), (Vec::new(), Vec::new()));
    fs::remove_file(bench.out().join("receipts/campaign.json")).unwrap();
    assert_eq!(audit(&bench), (Vec::new(), vec!["campaign.toml".to_owned()]));
}

#[test]
fn e2e_lost_folders_are_missed_by_what_was_built_on_them() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let names = |stage: &str| {
        receipts(&bench, stage).iter().map(|path| format!("{stage} {}", path.file_stem().unwrap().to_str().unwrap())).collect()
    };
    let [surfaces, cycles]: [Vec<String>; 2] = ["generate", "cycle"].map(names);
    assert_eq!((surfaces.len(), cycles.len()), (2, 2));
    // Of the cycles nothing is left but the tables that were made of them.
    for folder in ["receipts/cycle", "cycles"] {
        fs::remove_dir_all(bench.out().join(folder)).unwrap();
    }
    assert_eq!(audit(&bench), (cycles, Vec::new()));
    assert_eq!(code(&bench.verb("run", &[])), 0);
    for folder in ["receipts/generate", "surfaces"] {
        fs::remove_dir_all(bench.out().join(folder)).unwrap();
    }
    let mut found = audit(&bench);
    found.0.sort();
    assert_eq!(found, (surfaces, Vec::new()));
    assert_eq!(code(&bench.verb("run", &[])), 0);
    assert_eq!(audit(&bench), (Vec::new(), Vec::new()));
}

#[test]
fn e2e_files_that_no_receipt_names_are_listed_up_to_twenty() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    // Files of no task, and files that need no receipt.
    fs::write(bench.out().join("notes.txt"), "mine").unwrap();
    fs::write(bench.out().join("surfaces/.hysteron-torn.tmp"), "torn").unwrap();
    assert_eq!(audit(&bench), (Vec::new(), Vec::new()));
    for number in 0..25 {
        fs::write(bench.out().join(format!("statistics/copy_{number:02}.parquet")), "copy").unwrap();
    }
    assert_eq!(audit(&bench).1.len(), 25);
    let said = stdout(&bench.look("verify", &[]));
    assert!(said.contains("25 files are named by no receipt:\n  statistics/copy_00.parquet\n"), "{said}");
    assert!(said.contains("  statistics/copy_19.parquet\n  … and 5 more\n") && said.contains("25 faults."), "{said}");
}

#[test]
fn e2e_gc_takes_figures_that_no_report_shows_in_every_format() {
    let swept = |name: &str| format!("{SMALL}[[sweep]]\nname = \"{name}\"\nsurface.hurst = [0.7, 0.8]\n");
    let bench = Bench::new(&swept("aa"));
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let of = |bench: &Bench, sweep: &str| {
        files(&bench.out())
            .keys()
            .filter(|path| path.starts_with("figures") && path.file_name().unwrap().to_str().unwrap().starts_with(sweep))
            .count()
    };
    let drawn = of(&bench, "aa_");
    let formats = if cfg!(feature = "raster") { 3 } else { 1 };
    assert!(drawn > 0 && drawn % formats == 0, "{drawn} files in {formats} formats");
    fs::write(bench.spec(), swept("bb")).unwrap();
    assert_eq!(code(&bench.verb("run", &[])), 0);
    // Figures of one's own.
    for name in ["poster.png", "draft_2.pdf", "aa_A.txt"] {
        fs::write(bench.out().join("figures").join(name), "mine").unwrap();
    }
    let gone = bench.look("gc", &["--delete"]);
    assert_eq!(code(&gone), 0, "{}", stderr(&gone));
    assert_eq!((of(&bench, "aa_"), of(&bench, "bb_")), (1, drawn), "aa_A.txt is no figure of the program");
    assert!(["poster.png", "draft_2.pdf"].iter().all(|name| bench.out().join("figures").join(name).is_file()));
}
