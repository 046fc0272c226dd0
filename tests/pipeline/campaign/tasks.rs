//! Tasks that fail by themselves: what is in the way of their files, heights that are no numbers, more steps than memory holds.

use super::SMALL;
use crate::bench::{Bench, SPEC, code, files, paths, stderr, stdout};
use hysteron::campaign::{Campaign, Stage};
use hysteron::model::SurfaceSource;
use hysteron::spec::Spec;
use hysteron::stages::{Task, Watch, run};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

/// One file of a finished campaign of each stage that has several tasks.
fn victims(bench: &Bench) -> Vec<PathBuf> {
    let all = paths(&bench.out());
    let first = |folder: &str, ending: &str| {
        let fits =
            |path: &&PathBuf| path.strip_prefix(bench.out()).unwrap().starts_with(folder) && path.to_string_lossy().ends_with(ending);
        all.iter().filter(fits).min().unwrap().clone()
    };
    let files = [("surfaces", ".h5"), ("asperities", ".parquet"), ("cycles", "steps.parquet"), ("estimates", ".parquet")]
        .map(|(folder, ending)| first(folder, ending));
    files.into_iter().chain(["generate", "extract", "cycle"].map(|stage| first(&format!("receipts/{stage}"), ".json"))).collect()
}

#[test]
fn e2e_a_folder_in_the_place_of_a_file_fails_its_task_alone() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let whole = files(&bench.out());
    for victim in victims(&bench) {
        let name = victim.strip_prefix(bench.out()).unwrap().display().to_string();
        // The campaign is begun with the folder there, and goes on with it.
        for fresh in [true, false] {
            if fresh {
                fs::remove_dir_all(bench.out()).unwrap();
            } else {
                fs::remove_file(&victim).unwrap();
            }
            fs::create_dir_all(victim.join("inside")).unwrap();
            let run = bench.verb("run", &[]);
            assert_eq!(code(&run), 3, "{name}, fresh {fresh}: {}", stderr(&run));
            assert!(stderr(&run).contains("a folder of this name exists\nhelp: remove or rename it"), "{name}: {}", stderr(&run));
            assert!(stdout(&run).contains("1 cycle failed. "), "{name}: {}", stdout(&run));
            assert!(bench.out().join("report.html").is_file(), "{name}: the others went on");
            assert_eq!(code(&bench.verb("run", &[])), 3, "{name}: it stays failed");
            fs::remove_dir_all(&victim).unwrap();
            let again = bench.verb("run", &[]);
            assert_eq!(code(&again), 0, "{name}, fresh {fresh}: {}{}", stdout(&again), stderr(&again));
            assert_eq!(code(&bench.look("gc", &["--delete"])), 0);
            assert!(files(&bench.out()) == whole, "{name}, fresh {fresh}: other bytes");
        }
    }
}

#[cfg(unix)]
#[test]
fn e2e_pipes_and_dangling_links_are_replaced_and_nothing_waits_for_them() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let whole = files(&bench.out());
    let folder = victims(&bench)[2].parent().unwrap().to_owned();
    // Checkpoints and records of failures are read at every run.
    for kept in ["failed.json", "halfway.bin"] {
        assert!(Command::new("mkfifo").arg(folder.join(kept)).status().unwrap().success());
    }
    fs::remove_file(folder.join("steps.parquet")).unwrap();
    for victim in victims(&bench).iter().filter(|path| path.is_file()).chain([&bench.out().join("campaign.toml")]) {
        for kind in ["pipe", "link"] {
            fs::remove_file(victim).unwrap();
            match kind {
                "pipe" => assert!(Command::new("mkfifo").arg(victim).status().unwrap().success()),
                _ => std::os::unix::fs::symlink("/nowhere/at/all", victim).unwrap(),
            }
            // Whoever waits for a pipe is ended by the limit, with 124.
            let mut command = Command::new("timeout");
            command.args(["60", env!("CARGO_BIN_EXE_hysteron"), "run"]).arg(bench.spec()).arg("--out").arg(bench.out());
            let run = command.output().unwrap();
            assert_eq!(code(&run), 0, "{} is a {kind}: {}", victim.display(), stderr(&run));
            assert!(victim.symlink_metadata().unwrap().is_file(), "{}", victim.display());
        }
    }
    let ended = |verb: &str| Command::new("timeout").args(["60", env!("CARGO_BIN_EXE_hysteron"), verb]).arg(bench.out()).output().unwrap();
    assert_eq!((code(&ended("status")), code(&ended("gc"))), (0, 0));
    for kept in ["failed.json", "halfway.bin"] {
        let _ = fs::remove_file(folder.join(kept));
    }
    assert!(files(&bench.out()) == whole);
}

#[cfg(unix)]
#[test]
fn e2e_a_file_in_the_place_of_a_cycles_folder_fails_it_alone() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let whole = files(&bench.out());
    let folder = victims(&bench)[2].parent().unwrap().to_owned();
    fs::remove_dir_all(&folder).unwrap();
    assert!(Command::new("mkfifo").arg(&folder).status().unwrap().success());
    let run = Command::new("timeout")
        .args(["60", env!("CARGO_BIN_EXE_hysteron"), "run"])
        .arg(bench.spec())
        .arg("--out")
        .arg(bench.out())
        .output()
        .unwrap();
    assert_eq!(code(&run), 3, "{}", stderr(&run));
    assert!(stderr(&run).contains("a file of this name exists"), "{}", stderr(&run));
    assert!(stderr(&run).contains("cannot record the failure"), "{}", stderr(&run));
    fs::remove_file(&folder).unwrap();
    assert_eq!(code(&bench.verb("run", &[])), 0);
    assert!(files(&bench.out()) == whole);
}

/// Keeps what is said.
#[derive(Default)]
struct Heard(Mutex<Vec<String>>);

impl Watch for Heard {
    fn begin(&self, _: Stage, _: usize, _: usize) {}
    fn progress(&self, _: Stage, _: f64) {}
    fn finished(&self, _: Stage, _: &str) {}
    fn notice(&self, text: &str) {
        self.0.lock().unwrap().push(text.to_owned());
    }
    fn end(&self, _: Stage) {}
}

#[test]
fn e2e_heights_that_are_no_numbers_fail_their_surface_alone() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("{}[[sweep]]\nname = \"s\"\nsurface.hurst = [0.7, 0.8]\n", SMALL.replace("realizations = 2", "realizations = 1"));
    let mut spec = Spec::parse(&text, "x.toml").unwrap();
    // What a spec refuses: the spectrum of so small an exponent has no finite moments.
    let SurfaceSource::Generated(surface) = &mut spec.cases[0].params.surface else { panic!("a generated surface") };
    surface.hurst = 1e-300;
    let watch = Heard::default();
    let (_, tallies) = run(Campaign::new(spec, folder.path().join("out")), &Task::new(Stage::Generate, Stage::Cycle), &watch).unwrap();
    let heard = watch.0.lock().unwrap().join("\n");
    assert!(heard.contains("failed: ") && heard.contains("a height [m] is NaN\nhelp: expected finite heights"), "{heard}");
    let counts: Vec<_> = tallies.iter().map(|(stage, tally)| (*stage, tally.computed, tally.failed)).collect();
    assert_eq!(counts, [(Stage::Generate, 1, 1), (Stage::Extract, 1, 1), (Stage::Cycle, 1, 1)]);
}

#[test]
fn e2e_more_steps_than_memory_holds_fail_the_case_before_it_begins() {
    // Loading and 64 times unloading, 1e-5 rms heights a step: some hundred rms heights in all.
    let loads: Vec<String> = (1..=64).map(|k| format!("{}", 0.003 * f64::from(k))).collect();
    let text = SMALL.replace("realizations = 2", "realizations = 1").replace("[0.001]", &format!("[{}]", loads.join(", ")));
    let bench = Bench::new(&text.replace("approach_step = 0.05", "approach_step = 1e-5"));
    let run = Command::new("timeout")
        .args(["120", env!("CARGO_BIN_EXE_hysteron"), "run"])
        .arg(bench.spec())
        .arg("--out")
        .arg(bench.out())
        .output()
        .unwrap();
    assert_eq!(code(&run), 3, "{}", stderr(&run));
    assert!(
        stderr(&run).contains("cycle.approach_step = 1e-5 makes at least ") && stderr(&run).contains("(limit 2000000)\nhelp: "),
        "{}",
        stderr(&run)
    );
    assert!(!files(&bench.out()).keys().any(|path| path.ends_with(Path::new("steps.parquet"))));
}
