//! Relative paths: a run whose commands are given elsewhere, and runs and projects that are moved or copied.

use crate::bench::{Bench, code, files, stderr, stdout};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A rough measured surface as text.
fn scan(seed: u32) -> String {
    let height = |row: u32, column: u32| f64::from((row * 7919 + column * 104_729 + row * column * 31 + seed) % 97);
    (0..48).map(|row| (0..48).map(|column| height(row, column).to_string()).collect::<Vec<_>>().join(" ") + "\n").collect()
}

const SCAN: &str = "name = \"scan\"\n[surface]\nfile = \"scans/a.txt\"\npixel_m = 1e-6\nunit = \"nm\"\n[material]\n\
                    contact_modulus_pa = 1e9\nwork_of_adhesion_j_m2 = 1e-3\n\
                    [model]\nboundary = \"isolated\"\nallow_low_tabor = true\n[cycle]\nmax_load = [0.0005]\napproach_step = 0.05\n";

/// A project: `project/spec.toml` and `project/scans/a.txt`.
fn project() -> (Bench, PathBuf) {
    let bench = Bench::new("");
    let project = bench.folder.path().join("project");
    fs::create_dir_all(project.join("scans")).unwrap();
    fs::write(project.join("spec.toml"), SCAN).unwrap();
    fs::write(project.join("scans/a.txt"), scan(1)).unwrap();
    (bench, project)
}

fn hysteron(place: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron")).current_dir(place).args(arguments).output().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn e2e_a_prepared_run_goes_on_from_any_folder() {
    let (bench, project) = project();
    let prepared = hysteron(&project, &["export", "snakemake", "spec.toml", "--out", "run", "--shards", "1"]);
    assert_eq!(code(&prepared), 0, "{}", stderr(&prepared));
    let run = project.join("run");
    let spec = fs::read_to_string(run.join("campaign.toml")).unwrap();
    assert!(spec.contains("file = \"../scans/a.txt\"\n") && spec.contains("\n[files]\n\"../scans/a.txt\" = \""), "{spec}");
    for (place, named) in [(Path::new("/"), text(&run)), (bench.folder.path(), "project/run"), (&run, ".")] {
        let _ = fs::remove_dir_all(run.join("surfaces"));
        let _ = fs::remove_dir_all(run.join("receipts/generate"));
        let made = hysteron(place, &["run", named, "--until", "generate"]);
        assert_eq!(code(&made), 0, "{}: {}", place.display(), stderr(&made));
        let resolved = format!("{named}/campaign.toml");
        let made = hysteron(place, &["run", &resolved, "--out", named, "--until", "generate"]);
        assert!(code(&made) == 0 && stdout(&made).contains("Nothing to do"), "{}: {}", place.display(), stderr(&made));
        assert_eq!(fs::read_to_string(run.join("campaign.toml")).unwrap(), spec, "the same text from any folder");
    }
}

#[test]
fn e2e_no_byte_depends_on_the_folder_of_the_command() {
    let ((_one, first), (_two, second)) = (project(), project());
    assert_eq!(code(&hysteron(&first, &["run", "spec.toml", "--out", "run"])), 0);
    let elsewhere = hysteron(Path::new("/"), &["run", text(&second.join("spec.toml")), "--out", text(&second.join("run"))]);
    assert_eq!(code(&elsewhere), 0, "{}", stderr(&elsewhere));
    assert!(files(&first.join("run")) == files(&second.join("run")));
    let page = fs::read_to_string(first.join("run/report.html")).unwrap();
    assert!(page.contains("a.txt") && !page.contains("../scans"), "the report has the label of the file");
}

#[test]
fn e2e_moved_runs_and_projects_find_their_scans() {
    let (bench, project) = project();
    assert_eq!(code(&hysteron(&project, &["run", "spec.toml", "--out", "run"])), 0);
    let at = |name: &str| bench.folder.path().join(name);
    let surface_again = |run: &Path| {
        fs::remove_dir_all(run.join("surfaces")).unwrap();
        let again = hysteron(Path::new("/"), &["run", text(run)]);
        assert_eq!(code(&again), 0, "{}: {}", run.display(), stderr(&again));
        assert!(stdout(&again).contains("generate  1 of 1 computed") && stdout(&again).contains("cycle     0 of 1 computed"));
        assert!(stdout(&again).contains("1 done before"), "the results hold: {}", stdout(&again));
    };
    // The run alone: by the recorded place of the scan.
    fs::create_dir_all(at("archive/deep")).unwrap();
    fs::rename(project.join("run"), at("archive/deep/run")).unwrap();
    surface_again(&at("archive/deep/run"));
    let spec = fs::read_to_string(at("archive/deep/run/campaign.toml")).unwrap();
    assert!(spec.contains("file = \"../../../project/scans/a.txt\"\n"), "{spec}");
    fs::rename(at("archive/deep/run"), project.join("run")).unwrap();
    surface_again(&project.join("run"));
    // The whole project: by the relative name.
    fs::rename(&project, at("moved")).unwrap();
    surface_again(&at("moved/run"));
    let verified = hysteron(Path::new("/"), &["verify", text(&at("moved/run")), "--deep"]);
    assert_eq!(code(&verified), 0, "{}", stdout(&verified));
}

#[test]
fn e2e_a_lost_scan_is_named_with_every_place() {
    let (bench, project) = project();
    assert_eq!(code(&hysteron(&project, &["run", "spec.toml", "--out", "run"])), 0);
    fs::rename(project.join("scans"), project.join("elsewhere")).unwrap();
    // What is finished needs no scan.
    let status = hysteron(Path::new("/"), &["status", text(&project.join("run"))]);
    assert!(stdout(&status).contains("Nothing is left to do."), "{}", stdout(&status));
    fs::remove_dir_all(project.join("run/surfaces")).unwrap();
    fs::rename(project.join("run"), bench.folder.path().join("run")).unwrap();
    let lost = hysteron(&project, &["run", "../run"]);
    assert_eq!(code(&lost), 1, "{}", stderr(&lost));
    let whole = bench.folder.path().canonicalize().unwrap();
    for place in ["scans/a.txt", "project/scans/a.txt"] {
        assert!(stderr(&lost).contains(text(&whole.join(place))), "{place}: {}", stderr(&lost));
    }
    assert!(stderr(&lost).contains("no such file\nhelp: it was looked for at "), "{}", stderr(&lost));
}

#[test]
fn e2e_absolute_names_and_old_names_are_kept() {
    let (bench, project) = project();
    let scan = project.join("scans/a.txt");
    fs::write(project.join("spec.toml"), SCAN.replace("scans/a.txt", text(&scan))).unwrap();
    assert_eq!(code(&hysteron(&project, &["run", "spec.toml", "--out", "run", "--until", "generate"])), 0);
    let path = project.join("run/campaign.toml");
    let spec = fs::read_to_string(&path).unwrap();
    assert!(spec.contains(&format!("file = {:?}\n", text(&scan))), "{spec}");
    // Names from the working directory, as versions before had them.
    fs::write(&path, spec.replace(text(&scan), "scans/a.txt")).unwrap();
    fs::remove_dir_all(project.join("run/surfaces")).unwrap();
    let run = hysteron(&project, &["run", "run/campaign.toml", "--out", "run", "--until", "generate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let kept = fs::read_to_string(&path).unwrap();
    assert!(kept.contains("file = \"../scans/a.txt\"\n"), "{kept}");
    drop(bench);
}

#[test]
fn e2e_failures_of_scans_have_one_key_in_every_folder() {
    let ((_one, first), (_two, second)) = (project(), project());
    for project in [&first, &second] {
        fs::write(project.join("scans/a.txt"), "1 2 x\n3 4 5\n").unwrap();
    }
    assert_eq!(code(&hysteron(&first, &["run", "spec.toml", "--out", "run"])), 3);
    let named = text(&second.join("spec.toml")).to_owned();
    assert_eq!(code(&hysteron(Path::new("/"), &["run", &named, "--out", text(&second.join("run"))])), 3);
    for file in ["statistics/cycles.parquet", "report.html"] {
        assert!(fs::read(first.join("run").join(file)).unwrap() == fs::read(second.join("run").join(file)).unwrap(), "{file}");
    }
    let moved = first.with_file_name("moved");
    fs::rename(&first, &moved).unwrap();
    let status = stdout(&hysteron(Path::new("/"), &["status", text(&moved.join("run"))]));
    assert!(!status.contains("stale"), "{status}");
}
