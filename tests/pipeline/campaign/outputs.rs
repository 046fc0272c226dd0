//! Files of the user where commands write: replaced on request only, by a run never.

use super::SMALL;
use crate::bench::{Bench, code, files, stderr, stdout};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn program(bench: &Bench, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron")).current_dir(bench.folder.path()).args(arguments).output().unwrap()
}

/// A finished run in `out`, and the path of its first surface below the folder of the bench.
fn finished() -> (Bench, String) {
    let bench = Bench::new(&format!("{SMALL}[figures]\nformat = [\"svg\"]\n"));
    assert_eq!(code(&bench.verb("run", &["-q"])), 0);
    let surface = files(&bench.out()).into_keys().find(|path| path.extension().is_some_and(|end| end == "h5")).unwrap();
    (bench, format!("out/{}", surface.display()))
}

fn whole(bench: &Bench) -> bool {
    code(&bench.look("verify", &["--deep"])) == 0
}

#[test]
fn e2e_exports_ask_before_they_replace_a_file() {
    let (bench, surface) = finished();
    let path = |name: &str| bench.folder.path().join(name);
    let csv = path("tables/cases.csv");
    fs::create_dir(path("tables")).unwrap();
    let crate_file = path("out/ro-crate-metadata.json");
    let pages = path("man/hysteron-run.1");
    fs::create_dir_all(path("man")).unwrap();
    let schema = path("schemas/steps.v1.json");
    fs::create_dir(path("schemas")).unwrap();
    let outputs: [(&Path, Vec<&str>); 6] = [
        (&path("film.toml"), vec!["export", "netcdf", &surface, "--out", "film.toml"]),
        (&path("film.h5"), vec!["export", "tamaas", &surface, "--out", "film.h5"]),
        (&csv, vec!["export", "csv", "out", "--out", "tables"]),
        (&crate_file, vec!["export", "ro-crate", "out"]),
        (&pages, vec!["man", "--dir", "man"]),
        (&schema, vec!["schema", "--write"]),
    ];
    for (file, command) in outputs {
        fs::write(file, "mine").unwrap();
        let refused = program(&bench, &command);
        assert_eq!(code(&refused), 1, "{command:?}");
        let said = stderr(&refused);
        assert!(said.contains("the file exists") && said.contains("\nhelp: ") && said.contains("--force"), "{command:?}: {said}");
        assert_eq!(fs::read_to_string(file).unwrap(), "mine", "{command:?}");
        let forced = program(&bench, &[command.as_slice(), &["--force"]].concat());
        assert_eq!(code(&forced), 0, "{command:?}: {}", stderr(&forced));
        assert_ne!(fs::read(file).unwrap(), b"mine", "{command:?}");
    }
    // The same bytes once more are no question.
    for command in [["export", "csv", "out", "--out", "tables"].as_slice(), &["man", "--dir", "man"], &["schema", "--write"]] {
        assert_eq!(code(&program(&bench, command)), 0, "{command:?}");
    }
    fs::remove_file(crate_file).unwrap();
    assert!(whole(&bench));
}

#[cfg(unix)]
#[test]
fn e2e_nothing_is_exported_onto_its_source_or_into_a_run() {
    let (bench, surface) = finished();
    let before = files(&bench.out());
    let beside = Path::new(&surface).with_file_name("film.h5").display().to_string();
    let linked = bench.folder.path().join("link.h5");
    std::os::unix::fs::symlink(bench.folder.path().join(&surface), &linked).unwrap();
    for (command, wanted) in [
        (vec!["export", "tamaas", &surface, "--out", &surface], "it is the source itself"),
        (vec!["export", "netcdf", &surface, "--out", "link.h5"], "it is the source itself"),
        (vec!["export", "netcdf", "link.h5", "--out", &surface], "it is the source itself"),
        (vec!["export", "tamaas", &surface, "--out", &beside], "only `hysteron run` writes there"),
        (vec!["export", "csv", "out", "--out", "out/statistics"], "only `hysteron run` writes there"),
        (vec!["import", &surface, "--periodic", "--out", &beside], "only `hysteron run` writes there"),
    ] {
        let refused = program(&bench, &[command.as_slice(), &["--force"]].concat());
        assert_eq!(code(&refused), 1, "{command:?}");
        assert!(stderr(&refused).contains(wanted) && stderr(&refused).contains("\nhelp: use another --out"), "{}", stderr(&refused));
    }
    assert!(files(&bench.out()) == before);
}

#[test]
fn e2e_a_comparison_replaces_only_comparisons_and_enters_no_run() {
    let (bench, _) = finished();
    let other = program(&bench, &["run", "spec.toml", "--set", "surface.hurst=0.7", "--out", "other", "-q"]);
    assert_eq!(code(&other), 0, "{}", stderr(&other));
    let before = files(&bench.out());
    for out in ["out", "out/figures", "out/cycles/new"] {
        let refused = program(&bench, &["compare", "out", "other", "--out", out, "--force"]);
        assert!(code(&refused) == 1 && stderr(&refused).contains("it belongs to the run"), "{out}: {}", stderr(&refused));
    }
    assert!(files(&bench.out()) == before);
    let place = |name: &str| bench.folder.path().join("c").join(name);
    for mine in ["comparison.html", "comparison.parquet", "figures/compare0_A.svg"] {
        fs::create_dir_all(place("figures")).unwrap();
        fs::write(place(mine), "mine").unwrap();
        let refused = program(&bench, &["compare", "out", "other", "--out", "c"]);
        assert!(code(&refused) == 1 && stderr(&refused).contains("--force"), "{mine}: {}", stderr(&refused));
        assert_eq!(files(&bench.folder.path().join("c")).len(), 1, "{mine}");
        fs::remove_dir_all(place("")).unwrap();
    }
    // Its own comparison it renews without a question, and takes away figures that it drew before; others stay.
    assert_eq!(code(&program(&bench, &["compare", "out", "other", "--out", "c"])), 0);
    assert_eq!(code(&program(&bench, &["compare", "out", "other", "--out", "c"])), 0);
    fs::write(place("figures/compare7_A.svg"), "mine").unwrap();
    assert_eq!(code(&program(&bench, &["compare", "out", "other", "--out", "c"])), 0);
    assert_eq!(fs::read_to_string(place("figures/compare7_A.svg")).unwrap(), "mine");
    // A page that was edited is one of the user.
    fs::write(place("comparison.html"), "edited").unwrap();
    assert_eq!(code(&program(&bench, &["compare", "out", "other", "--out", "c"])), 1);
    assert_eq!(fs::read_to_string(place("comparison.html")).unwrap(), "edited");
    let into = program(&bench, &["run", "spec.toml", "--out", "c", "-q"]);
    assert!(code(&into) == 1 && stderr(&into).contains("comparison.parquet was not written by a run"), "{}", stderr(&into));
}

#[test]
fn e2e_a_run_replaces_no_file_that_it_did_not_write() {
    for mine in ["report.html", "datapackage.json", "statistics/cases.parquet", "schemas/steps.json", "campaign.toml"] {
        let bench = Bench::new(SMALL);
        let place = bench.out().join(mine);
        fs::create_dir_all(place.parent().unwrap()).unwrap();
        fs::write(&place, "# mine").unwrap();
        let refused = bench.verb("run", &["-q"]);
        assert_eq!(code(&refused), 1, "{mine}");
        assert!(stderr(&refused).contains("was not written by a run\nhelp: choose another folder"), "{mine}: {}", stderr(&refused));
        assert_eq!(files(&bench.out()).into_values().collect::<Vec<_>>(), [b"# mine".to_vec()], "{mine}: nothing else was written");
        // What else is in the folder stays.
        fs::rename(&place, bench.out().join("kept.txt")).unwrap();
        fs::write(bench.out().join("progress.html"), "mine").unwrap();
        let run = bench.verb("run", &["-v"]);
        assert_eq!(code(&run), 0, "{mine}: {}", stderr(&run));
        assert!(stderr(&run).contains("was not written by a run and is kept"), "{}", stderr(&run));
        assert_eq!(fs::read_to_string(bench.out().join("progress.html")).unwrap(), "mine");
        assert!(!stderr(&run).contains("progress page: "), "{}", stderr(&run));
        assert!(bench.out().join("kept.txt").is_file() && whole(&bench));
    }
}

#[test]
fn e2e_a_report_replaces_no_figure_that_it_did_not_draw() {
    let (bench, _) = finished();
    let drawn: Vec<PathBuf> = files(&bench.out()).into_keys().filter(|path| path.starts_with("figures")).collect();
    let fresh = Bench::new(&fs::read_to_string(bench.spec()).unwrap());
    assert_eq!(code(&fresh.verb("run", &["-q", "--until", "aggregate"])), 0);
    let place = fresh.out().join(&drawn[0]);
    fs::write(&place, "mine").unwrap();
    let refused = fresh.verb("run", &["-q"]);
    assert_eq!(code(&refused), 1);
    assert!(stderr(&refused).contains("was not written by a run"), "{}", stderr(&refused));
    assert_eq!(fs::read_to_string(&place).unwrap(), "mine");
    fs::remove_file(&place).unwrap();
    assert_eq!(code(&fresh.verb("run", &["-q"])), 0);
    // A damaged figure of its own is repaired; and without the receipt of the report whole figures are no obstacle.
    fs::write(&place, "damaged").unwrap();
    assert_eq!(code(&fresh.verb("run", &["-q"])), 0);
    fs::remove_file(fresh.out().join("receipts/report/report.json")).unwrap();
    assert_eq!(code(&fresh.verb("run", &["-q"])), 0);
    assert!(files(&fresh.out()) == files(&bench.out()));
}

#[test]
fn e2e_gc_deletes_only_what_the_program_wrote() {
    let (bench, surface) = finished();
    let cycle = fs::read_dir(bench.out().join("cycles")).unwrap().next().unwrap().unwrap().path();
    let mine = [
        bench.out().join("figures/mine_A.svg"),
        bench.out().join("surfaces/mine_r01-deadbeef.h5"),
        bench.out().join("asperities/mine_r01-deadbeef.parquet"),
        bench.out().join("cycles/mine_r01-deadbeef/notes.txt"),
        cycle.join("notes.txt"),
    ];
    fs::create_dir(bench.out().join("cycles/mine_r01-deadbeef")).unwrap();
    mine.iter().for_each(|path| fs::write(path, "mine").unwrap());
    // Another spec: what the first one wrote is left over.
    fs::write(bench.spec(), format!("{SMALL}[figures]\nformat = [\"svg\"]\n[[sweep]]\nname = \"b\"\nsurface.hurst = [0.7]\n")).unwrap();
    assert_eq!(code(&bench.verb("run", &["-q"])), 0);
    let listed = stdout(&bench.look("gc", &[]));
    assert!(listed.contains("figures/base_A.svg") && !listed.contains("mine"), "{listed}");
    assert_eq!(code(&bench.look("gc", &["--delete"])), 0);
    mine.iter().for_each(|path| assert_eq!(fs::read_to_string(path).unwrap(), "mine"));
    assert!(!bench.folder.path().join(surface).exists() && !bench.out().join("figures/base_A.svg").exists());
    assert_eq!(fs::read_dir(&cycle).unwrap().count(), 1, "the tables of the cycle are gone");
    assert!(stdout(&bench.look("gc", &[])).contains("Nothing is left over"));
}

/// Figures of an earlier report are faults, and the help names the command that removes them: `gc --delete`, and not `run`, which has nothing to do.
#[test]
fn e2e_the_help_of_a_fault_repairs_it() {
    let (bench, _) = finished();
    fs::write(bench.spec(), format!("{SMALL}[figures]\nformat = [\"svg\"]\n[[sweep]]\nname = \"b\"\nsurface.hurst = [0.7]\n")).unwrap();
    assert_eq!(code(&bench.verb("run", &["-q"])), 0);
    let words = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let verified = bench.look("verify", &[]);
    let said = words(stdout(&verified));
    let gc = format!("`hysteron gc {} --delete` deletes ", bench.out().display());
    assert!(code(&verified) == 1 && said.contains("figures/base_A.svg") && said.contains(&gc), "{said}");
    assert!(!said.contains("hysteron run") && !said.contains("other origin"), "{said}");
    assert!(stdout(&bench.verb("run", &[])).contains("Nothing to do"));
    let answer: serde_json::Value = serde_json::from_str(&stdout(&bench.look("verify", &["--json"]))).unwrap();
    assert_eq!(answer["left_over"], answer["unnamed"]);
    let crate_of = || program(&bench, &["export", "ro-crate", "out"]);
    assert!(stderr(&crate_of()).contains("`hysteron gc out --delete` deletes "), "{}", stderr(&crate_of()));
    // A file of the user is not deleted; a damaged file is repaired by the run.
    fs::write(bench.out().join("figures/mine_A.svg"), "mine").unwrap();
    fs::write(bench.out().join("statistics/cases.parquet"), "damaged").unwrap();
    let said = words(stdout(&bench.look("verify", &[])));
    assert!(said.contains("`hysteron run ") && said.contains(&gc) && said.contains("Move 1 file of other origin out"), "{said}");
    assert_eq!(code(&bench.verb("run", &["-q"])), 0);
    assert_eq!(code(&bench.look("gc", &["--delete"])), 0);
    let said = words(stdout(&bench.look("verify", &[])));
    assert!(said.contains("1 fault. Move 1 file of other origin out of the folder.") && !said.contains("hysteron "), "{said}");
    fs::remove_file(bench.out().join("figures/mine_A.svg")).unwrap();
    assert!(whole(&bench));
    assert_eq!(code(&crate_of()), 0);
}

#[test]
fn e2e_options_that_replace_the_job_are_refused() {
    let bench = Bench::new(SMALL);
    for option in ["--wrap=date", "--wrap date", "--wr=date", "--array=0-9", "--arr=0-9", "-a0-9", "-a 0-9"] {
        let refused = bench.verb("submit", &["--engine", "slurm", "--dry-run", &format!("--option={option}")]);
        assert_eq!(code(&refused), 2, "{option}");
        assert!(stderr(&refused).contains("would replace what `hysteron submit` sends\nhelp: "), "{option}: {}", stderr(&refused));
    }
    for option in ["--wait", "--wckey=mine", "--account=mine", "-A mine", "--time=1:00:00"] {
        let taken = bench.verb("submit", &["--engine", "slurm", "--dry-run", &format!("--option={option}")]);
        assert_eq!(code(&taken), 0, "{option}: {}", stderr(&taken));
    }
}
