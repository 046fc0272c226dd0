//! Specs and output folders in place of one another, and paths in a spec.

use super::{SMALL, hysteron};
use crate::bench::{Bench, code, files, stderr, stdout};
use hysteron::spec::Spec;
use std::fs;
use std::path::Path;

#[test]
fn e2e_a_folder_stands_for_its_spec_and_a_spec_for_its_folder() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&hysteron(&bench, &["run", "spec.toml", "--until", "extract"])), 0);
    let dir = "data/runs/small";
    let same = |command: &str, more: &[&str]| {
        let [of_spec, of_dir] = ["spec.toml", dir].map(|place| hysteron(&bench, &[&[command, place], more].concat()));
        assert_eq!(code(&of_spec), 0, "{command}: {}", stderr(&of_spec));
        assert_eq!((code(&of_dir), stdout(&of_dir)), (0, stdout(&of_spec)), "{command}");
        stdout(&of_spec)
    };
    for (command, more) in
        [("plan", &["--json"][..]), ("status", &["--json"]), ("verify", &["--deep"]), ("explain", &["statistics"]), ("clean", &[])]
    {
        same(command, more);
    }
    let status = same("status", &[]);
    assert!(status.contains("small in data/runs/small") && status.contains("resume with `hysteron run data/runs/small`"), "{status}");
    // The folder is run where it is, and not in the default folder of its name.
    fs::rename(bench.folder.path().join(dir), bench.out()).unwrap();
    assert_eq!(code(&hysteron(&bench, &["run", "out", "--until", "cycle"])), 0);
    assert!(!bench.folder.path().join(dir).exists());
    let elsewhere = hysteron(&bench, &["status", "spec.toml", "--out", "out", "--json"]);
    assert_eq!(stdout(&elsewhere), stdout(&hysteron(&bench, &["status", "out", "--json"])));
    // Neither a run nor a spec.
    fs::create_dir(bench.folder.path().join("empty")).unwrap();
    for (arguments, wanted) in [(["run", "empty"], 2), (["status", "empty"], 1), (["status", "spec.toml"], 1)] {
        let refused = hysteron(&bench, &arguments);
        assert_eq!(code(&refused), wanted, "{arguments:?}");
        assert!(stderr(&refused).contains("campaign.toml\nhelp: name "), "{arguments:?}: {}", stderr(&refused));
    }
    assert_eq!(code(&hysteron(&bench, &["status", "empty", "--out", "out"])), 2);
}

/// A rough measured surface as text.
fn scan(seed: u32) -> String {
    let height = |row: u32, column: u32| f64::from((row * 7919 + column * 104_729 + row * column * 31 + seed) % 97);
    (0..48).map(|row| (0..48).map(|column| height(row, column).to_string()).collect::<Vec<_>>().join(" ") + "\n").collect()
}

const SCAN: &str = "name = \"scan\"\n[surface]\nfile = \"scan.txt\"\npixel_m = 1e-6\nunit = \"nm\"\n[model]\nboundary = \"isolated\"\n";

#[test]
fn e2e_a_path_in_a_spec_is_found_from_its_folder() {
    let bench = Bench::new("");
    let at = |name: &str| bench.folder.path().join(name);
    fs::create_dir(at("specs")).unwrap();
    fs::write(at("specs/x.toml"), SCAN).unwrap();
    let neither = hysteron(&bench, &["plan", "specs/x.toml"]);
    assert_eq!(code(&neither), 2);
    assert!(
        stderr(&neither).contains("x.toml:3:") && stderr(&neither).contains(" and in specs (folder of the spec)"),
        "{}",
        stderr(&neither)
    );

    fs::write(at("specs/scan.txt"), scan(1)).unwrap();
    let run = hysteron(&bench, &["run", "specs/x.toml", "--until", "generate", "--out", "out"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let beside = fs::read_to_string(bench.out().join("campaign.toml")).unwrap();
    assert!(beside.contains("file = \"../specs/scan.txt\"\n") && beside.contains("\n[files]\n\"../specs/scan.txt\" = \""), "{beside}");
    // The run goes on from its own spec, and from the folder of the spec.
    let state = |place: &Path, arguments: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_hysteron"));
        let answer = command.current_dir(place).args(arguments).arg("--json").output().unwrap();
        let answer: serde_json::Value = serde_json::from_slice(&answer.stdout).unwrap();
        answer["stages"][0]["units"][0]["state"].as_str().unwrap().to_owned()
    };
    assert_eq!(state(bench.folder.path(), &["plan", "out"]), "done");
    assert_eq!(state(&at("specs"), &["plan", "x.toml", "--out", "../out"]), "done", "a name is no part of a key");

    // The same file in both places is no question; two different ones are.
    fs::write(at("scan.txt"), scan(1)).unwrap();
    assert_eq!(state(bench.folder.path(), &["plan", "specs/x.toml", "--out", "out"]), "done");
    fs::write(at("scan.txt"), scan(2)).unwrap();
    let both = hysteron(&bench, &["plan", "specs/x.toml", "--out", "out"]);
    assert_eq!(code(&both), 2);
    assert!(stderr(&both).contains("two different files") && stderr(&both).contains("write specs/scan.txt"), "{}", stderr(&both));
    // What the help says to write is taken.
    fs::write(at("specs/x.toml"), SCAN.replace("scan.txt", "specs/scan.txt")).unwrap();
    assert_eq!(state(bench.folder.path(), &["plan", "specs/x.toml", "--out", "out"]), "done");
    let whole = SCAN.replace("scan.txt", at("scan.txt").to_str().unwrap());
    fs::write(at("specs/x.toml"), whole).unwrap();
    assert_eq!(state(bench.folder.path(), &["plan", "specs/x.toml", "--out", "out"]), "planned", "the other file");
}

#[test]
fn e2e_a_sweep_over_files_is_found_too() {
    let bench = Bench::new("");
    let at = |name: &str| bench.folder.path().join(name);
    fs::create_dir(at("specs")).unwrap();
    let text = SCAN.replace("file = \"scan.txt\"\n", "") + "[[sweep]]\nname = \"scans\"\nsurface.file = [\"a.txt\", \"b.txt\"]\n";
    fs::write(at("specs/x.toml"), text).unwrap();
    fs::write(at("specs/a.txt"), scan(1)).unwrap();
    fs::write(at("b.txt"), scan(2)).unwrap();
    let run = hysteron(&bench, &["run", "specs/x.toml", "--until", "generate", "--out", "out"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let resolved = fs::read_to_string(bench.out().join("campaign.toml")).unwrap();
    assert!(resolved.contains("surface.file = [\"../specs/a.txt\", \"../b.txt\"]"), "{resolved}");
    assert_eq!(files(&bench.out().join("surfaces")).len(), 2);
    // The resolved spec has the hashes: it is read without looking at the files.
    fs::remove_file(at("specs/a.txt")).unwrap();
    let spec = Spec::read(bench.out().join("campaign.toml")).unwrap();
    let names = ["specs/a.txt", "b.txt"].map(|name| bench.folder.path().canonicalize().unwrap().join(name).display().to_string());
    assert_eq!(spec.cases.iter().map(|case| case.params.surface.measured().unwrap().file.clone()).collect::<Vec<_>>(), names);
}
