//! Measured loops: files of instruments, bad input, and a spec with `[experiment]`.

use crate::bench::{code, stderr, stdout};
use hysteron::model::{Choice as _, Compression, LoopOptions};
use hysteron::schema::{MEASURED_LOOPS, MEASURED_STEPS};
use hysteron::spec::Spec;
use hysteron::store::force_curve::{is_force_curve, read_force_curve};
use hysteron::store::parquet::{read_metadata, read_table};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The invented loop of the repository: R = 20 µm, E* = 1 MPa, 20 and 45 mJ/m², 30 N/m.
fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/examples/probe_loop.csv")
}

fn hysteron(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron")).args(arguments).current_dir(folder).output().unwrap()
}

/// Points of a triangular loop without noise: displacement \[µm\], force \[nN\]; 1 nN of tension on retraction.
fn points() -> Vec<[f64; 2]> {
    let force = |way: f64, back: bool| match (way > 0.0, back && way > -0.5) {
        (true, _) => 10.0 * way - if back { 1.0 } else { 0.0 },
        (false, true) => -1.0,
        (false, false) => 0.0,
    };
    let at = |k: i32| -2.0 + 0.05 * f64::from(k);
    let approach = (0..=60).map(|k| [at(k), force(at(k), false)]);
    approach.chain((0..60).rev().map(|k| [at(k), force(at(k), true)])).collect()
}

/// A text with this heading and one line for each point.
fn text(heading: &str, line: impl Fn([f64; 2]) -> String) -> String {
    let mut text = format!("{heading}\n");
    for point in points() {
        writeln!(text, "{}", line(point)).unwrap();
    }
    text
}

fn comma(value: f64) -> String {
    format!("{value:.4}").replace('.', ",")
}

/// Forms of instruments and spreadsheets, all of the same loop.
fn forms() -> Vec<(&'static str, String)> {
    vec![
        ("csv", text("force_nN,displacement_um", |[way, force]| format!("{force:.4},{way:.4}"))),
        ("brackets", text("Time [s];F [nN];Displacement [µm]", |[way, force]| format!("0;{force:.4};{way:.4}"))),
        ("decimal commas", text("Kraft [nN];Weg [um]", |[way, force]| format!("{};{}", comma(force), comma(way)))),
        (
            "preamble, tabs, nanoindenter",
            text(
                "Date\t1 May\nk (N/m)\t0.5\n\nTime (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary",
                |[way, force]| format!("0.1\t{:.7}\t{:.1}\t0\t0\t0", 1e-3 * force, 1e3 * way),
            ),
        ),
        ("units in a line", text("Time,Load,Extension\n(s),(N),(mm)", |[way, force]| format!("1,{:e},{:.7}", 1e-9 * force, 1e-3 * way))),
        (
            // The height of the piezo falls on approach.
            "JPK",
            text("# segment: extend\n# columns: height vDeflection\n# units: m N", |[way, force]| {
                format!("{:e} {:e}", -1e-6 * way, 1e-9 * force)
            }),
        ),
        (
            "depth and load",
            text("Number of Points = 121\nDepth (nm)\tLoad (uN)\tTime (s)", |[way, force]| {
                format!("{:.1}\t{:.7}\t0", 1e3 * way, 1e-3 * force)
            }),
        ),
        ("trailing separator", text("\"force_nN\";\"displacement_um\";", |[way, force]| format!("{force:.4};{way:.4};"))),
    ]
}

#[test]
fn val_forms_of_instruments_are_one_loop() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in forms() {
        let path = folder.path().join("loop.txt");
        fs::write(&path, text).unwrap();
        assert!(is_force_curve(&path), "{name}");
        let found = read_force_curve(&path, &LoopOptions::default()).unwrap_or_else(|why| panic!("{name}: {why}"));
        assert_eq!(found.force_n.len(), points().len(), "{name}");
        let sign = if name == "JPK" { -1.0 } else { 1.0 };
        for (k, [way, force]) in points().into_iter().enumerate() {
            // Texts have four digits behind the point, or more.
            assert!((found.force_n[k] - 1e-9 * force).abs() < 1e-13, "{name}, point {k}");
            assert!((sign * found.displacement_m[k] - 1e-6 * way).abs() < 1e-10, "{name}, point {k}");
        }
        let output = hysteron(folder.path(), &["import", "loop.txt", "--json", "-n"]);
        assert_eq!(code(&output), 0, "{name}: {}", stderr(&output));
        let answer: Value = serde_json::from_str(&stdout(&output)).unwrap();
        // Between 0 and 1 µm the branches are 1 nN apart, and to −0.5 µm; the two jumps are within a step each.
        let loss = answer["loss_j"].as_f64().unwrap();
        assert!((loss / 1.475e-15 - 1.0).abs() < 0.04, "{name}: {loss}");
        assert!((answer["pull_off_load_n"].as_f64().unwrap() / 1e-9 - 1.0).abs() < 1e-3, "{name}");
    }
    for path in ["Cargo.toml", "README.md"] {
        assert!(!is_force_curve(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path)), "{path}");
    }
}

#[test]
fn e2e_the_example_gives_its_parameters_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = example();
    let arguments = ["import", file.to_str().unwrap(), "--probe-radius", "20um", "--machine-stiffness", "30"];
    let output = hysteron(folder.path(), &[&arguments[..], &["--json"]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let answer: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let within = |name: &str, truth: f64| {
        let [value, high] = [name.to_owned(), format!("{name}_ci95_high")].map(|name| answer[name].as_f64().unwrap());
        let width = high - value;
        assert!((value - truth).abs() <= width && width < 0.05 * truth, "{name}: {value} ± {width}, true {truth}");
    };
    within("work_approach_j_m2", 0.02);
    within("work_retraction_j_m2", 0.045);
    within("work_pull_off_j_m2", 0.045);
    within("contact_modulus_fit_pa", 1e6);
    // Written as a table, which says that it is measured, with the name of its source alone.
    let path = folder.path().join("probe_loop_loop.parquet");
    let steps = read_table(&path, &MEASURED_STEPS).unwrap();
    assert_eq!(steps.row_count(), 599);
    assert_eq!(steps.text("source").unwrap()[0], "probe_loop.csv");
    let said = |name: &str| read_metadata(&path, name).unwrap().unwrap();
    assert_eq!((said("measured").as_str(), said("source").as_str()), ("true", "probe_loop.csv"));
    // A second import does not replace it; the text fits into 80 columns.
    let again = hysteron(folder.path(), &arguments);
    assert!(code(&again) == 1 && stderr(&again).contains("the file exists"), "{}", stderr(&again));
    let shown = stdout(&hysteron(folder.path(), &[&arguments[..], &["-n"]].concat()));
    assert!(shown.contains("w, retraction 0.045") && shown.contains("No file was written"), "{shown}");
    // The name of the file is printed as it was given.
    assert!(shown.lines().skip(1).all(|line| line.chars().count() <= 80), "{shown}");
}

/// Several loops in one command: a table each, in the folder of `--out`. One that fails is named, and other files are refused.
#[test]
fn e2e_several_loops_are_imported_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let good = text("force_nN,displacement_um", |[way, force]| format!("{force:.4},{way:.4}"));
    fs::write(at("a.csv"), &good).unwrap();
    fs::write(at("b.csv"), good.replace("force_nN", "force_uN")).unwrap();
    fs::write(at("bad.csv"), good.lines().take(62).collect::<Vec<_>>().join("\n")).unwrap();
    fs::write(at("scan.txt"), "1 2 3\n4 5 6\n").unwrap();
    fs::create_dir(at("more")).unwrap();
    fs::copy(at("a.csv"), at("more/a.csv")).unwrap();
    let run = hysteron(folder.path(), &["import", "a.csv", "b.csv", "--out", "loops", "--json"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let answer: Value = serde_json::from_str(&stdout(&run)).unwrap();
    let force = |place: usize| answer["loops"][place]["pull_off_load_n"].as_f64().unwrap();
    // The same numbers in other units.
    assert!((force(1) / force(0) - 1e3).abs() < 1e-6 && answer["left_out"].as_array().unwrap().is_empty(), "{answer:#}");
    for name in ["a", "b"] {
        assert_eq!(read_table(&at(&format!("loops/{name}_loop.parquet")), &MEASURED_STEPS).unwrap().row_count(), 121);
    }
    let some = hysteron(folder.path(), &["import", "a.csv", "bad.csv", "-n"]);
    assert_eq!(code(&some), 3, "{}", stderr(&some));
    assert!(
        stdout(&some).contains("a.csv\n") && stdout(&some).contains("warning: left out: ") && stdout(&some).contains("no load reversal")
    );
    for (files, words) in [
        (&["bad.csv", "bad.csv"][..], "two loops"),
        (&["a.csv", "more/a.csv"], "has the name of an earlier file"),
        (&["a.csv", "scan.txt"], "scan.txt has no force and displacement"),
        (&["scan.txt", "bad.csv", "--loop"], "none of 2 loops was imported"),
    ] {
        let output = hysteron(folder.path(), &[&["import"], files].concat());
        assert!(code(&output) == 1 && stderr(&output).contains(words) && stderr(&output).contains("\nhelp: "), "{}", stderr(&output));
    }
}

#[test]
fn e2e_init_loop_writes_its_example() {
    let folder = tempfile::tempdir().unwrap();
    let made = hysteron(folder.path(), &["init", "loop"]);
    assert_eq!((code(&made), stderr(&made).trim()), (0, "Written: loop.csv"));
    fs::write(folder.path().join("mine.toml"), stdout(&made)).unwrap();
    let run = hysteron(folder.path(), &["run", "mine.toml", "--out", "out"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let loops = read_table(&folder.path().join("out/statistics/measured_loops.parquet"), &MEASURED_LOOPS).unwrap();
    assert_eq!(loops.row_count(), 1);
}

#[test]
fn reg_bad_loops_are_refused_with_help() {
    let folder = tempfile::tempdir().unwrap();
    let good = text("force_nN,displacement_um", |[way, force]| format!("{force:.4},{way:.4}"));
    let lines: Vec<&str> = good.lines().collect();
    let with = |place: usize, line: &str| {
        let mut lines = lines.clone();
        lines[place] = line;
        lines.join("\n")
    };
    let zigzag = text("force_nN,displacement_um", |[way, force]| format!("{force:.4},{:.4}", (20.0 * way).sin()));
    let cases: [(&str, String, &[&str], &str); 18] = [
        ("units missing", with(0, "force,displacement"), &[], "has no unit"),
        ("unit unknown", with(0, "force_V,displacement_um"), &[], "which is not read"),
        ("deflection", with(0, "Deflection (nm),displacement_um"), &[], "--machine-stiffness"),
        ("unit twice", good.clone(), &["--force-unit", "N"], "remove --force-unit"),
        ("no heading", lines[1..].join("\n"), &["--loop"], "no heading"),
        ("no such column", good.clone(), &["--force-column", "F2"], "no column \"F2\""),
        ("no displacement", with(0, "force_nN,other"), &["--loop"], "no column of the displacement"),
        ("a row of NaN", with(31, "nan,0.5"), &[], "line 32: no number in the column \"force_nN\""),
        ("a word", with(31, "1.0,abc"), &[], "line 32: \"abc\" is not a number"),
        ("a short row", with(31, "1.0"), &[], "line 32: 1 numbers"),
        ("one branch", lines[..62].join("\n"), &[], "no load reversal"),
        ("open", lines[..70].join("\n"), &[], "does not close"),
        ("few points", lines[..20].join("\n"), &[], "19 points"),
        ("zigzag", zigzag, &["--compression", "positive"], "goes back"),
        ("no numbers", "force_nN,displacement_um\n".to_owned(), &[], "no line of numbers"),
        ("stiffness", good.clone(), &["--machine-stiffness=-1"], "--machine-stiffness"),
        ("radius", good.clone(), &["--probe-radius", "20 miles"], "--probe-radius"),
        ("modulus alone", good.clone(), &["--modulus", "1e6"], "without a probe"),
    ];
    for (name, text, more, words) in cases {
        fs::write(folder.path().join("loop.csv"), text).unwrap();
        let output = hysteron(folder.path(), &[&["import", "loop.csv"], more].concat());
        let errors = stderr(&output);
        assert!(code(&output) == 1 && errors.contains(words), "{name}: {errors}");
        assert!(errors.starts_with("error: cannot import") && errors.contains("help: "), "{name}: {errors}");
        let left: Vec<_> = fs::read_dir(folder.path()).unwrap().collect();
        assert_eq!(left.len(), 1, "{name}: nothing is written");
    }
    // A sign that is stated wrongly has no tension but "compression" at its ends; a drift is a warning.
    let drift = text("force_nN,displacement_um", |[way, force]| format!("{:.4},{way:.4}", force + 0.2 * (way + 2.0)));
    fs::write(folder.path().join("loop.csv"), drift).unwrap();
    let shown = stdout(&hysteron(folder.path(), &["import", "loop.csv", "-n", "--baseline", "offset"]));
    assert!(shown.contains("baseline"), "{shown}");
    assert_eq!(Compression::from_word("auto"), Some(Compression::Auto));
}

/// A small spec with a measured loop.
fn spec(experiment: &str) -> String {
    format!(
        "name = \"mine\"\nseed = 1\nrealizations = 1\n[surface]\nlength_m = 2e-5\nrms_height_m = 1e-7\nmagnification = 4\n\
         [material]\nwork_of_adhesion_j_m2 = 0.001\n[model]\nmethod = \"boundary_elements\"\n[cycle]\nmax_load = [0.01]\n{experiment}"
    )
}

const EXPERIMENT: &str = "[experiment]\nloops = [\"probe_loop.csv\"]\nprobe_radius_m = 2e-5\nmachine_stiffness_n_m = 30.0\n";

#[test]
fn e2e_measured_and_simulated_loops_are_beside_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::copy(example(), at("probe_loop.csv")).unwrap();
    fs::write(at("mine.toml"), spec(EXPERIMENT)).unwrap();
    let run = || hysteron(folder.path(), &["run", "mine.toml", "--out", "out"]);
    let output = run();
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let loops = read_table(&at("out/statistics/measured_loops.parquet"), &MEASURED_LOOPS).unwrap();
    assert_eq!((loops.row_count(), loops.text("source").unwrap()[0]), (1, "probe_loop.csv"));
    // The modulus of the fits is that of the material.
    assert_eq!(loops.first_f64("contact_modulus_pa").unwrap(), 1e6);
    let work = loops.first_f64("work_retraction_j_m2").unwrap();
    assert!((work - 0.045).abs() < 5e-4, "{work}");
    assert_eq!(read_table(&at("out/statistics/measured_steps.parquet"), &MEASURED_STEPS).unwrap().row_count(), 599);
    let page = fs::read_to_string(at("out/report.html")).unwrap();
    assert!(page.contains(">Measured loops</h2>") && at("out/figures/measured_loops.svg").is_file());
    let package = fs::read_to_string(at("out/datapackage.json")).unwrap();
    assert!(package.contains("statistics/measured_loops.parquet"));
    // Read back, the resolved spec is the same; and nothing is computed twice.
    let resolved = fs::read_to_string(at("out/campaign.toml")).unwrap();
    assert!(resolved.contains("loops = [\"../probe_loop.csv\"]") && Spec::parse(&resolved, "x").is_ok(), "{resolved}");
    assert!(stderr(&run()).contains("1 done before"));
    // Another content is another key.
    let text = fs::read_to_string(example()).unwrap();
    fs::write(at("probe_loop.csv"), text.replacen("0.00,-2.0000,20.0,", "0.00,-2.0000,20.1,", 1)).unwrap();
    let planned = stdout(&hysteron(folder.path(), &["plan", "mine.toml", "--out", "out"]));
    assert!(planned.contains("aggregate") && !planned.contains("nothing to do"), "{planned}");
    assert_eq!(code(&run()), 0);
    // Without the table there are no such files.
    fs::write(at("plain.toml"), spec("")).unwrap();
    let plain = hysteron(folder.path(), &["run", "plain.toml", "--out", "plain"]);
    assert!(code(&plain) == 0 && !at("plain/statistics/measured_loops.parquet").exists(), "{}", stderr(&plain));
    assert!(!fs::read_to_string(at("plain/datapackage.json")).unwrap().contains("measured_"));
    // Tables and figure of the loops that the spec no longer has are left over.
    fs::write(at("mine.toml"), spec("")).unwrap();
    assert_eq!(code(&run()), 0);
    let verified = stdout(&hysteron(folder.path(), &["verify", "out"]));
    assert!(verified.contains("3 faults.\n`hysteron gc out --delete` deletes 3 files"), "{verified}");
    let tables = [&MEASURED_LOOPS, &MEASURED_STEPS].map(|table| at("out").join(table.file));
    let mine = at("out/statistics/mine.parquet");
    fs::write(&mine, "mine").unwrap();
    assert!(tables.iter().all(|path| path.is_file()));
    assert_eq!(code(&hysteron(folder.path(), &["gc", "out", "--delete"])), 0);
    assert!(!tables.iter().any(|path| path.exists()) && mine.is_file() && !at("out/figures/measured_loops.svg").exists());
    fs::remove_file(&mine).unwrap();
    assert_eq!(code(&hysteron(folder.path(), &["verify", "out", "--deep"])), 0);
    assert!(stdout(&run()).contains("Nothing to do"));
}

#[test]
fn reg_bad_loops_of_a_spec_are_refused_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::copy(example(), at("probe_loop.csv")).unwrap();
    let text = fs::read_to_string(example()).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    fs::write(at("open.csv"), lines[..320].join("\n")).unwrap();
    fs::write(at("word.csv"), text.replacen("0.01,", "abc,", 1)).unwrap();
    let with = |line: &str| format!("[experiment]\n{line}\n");
    for (experiment, words) in [
        (with("loops = []"), "names no file"),
        (with("loops = [\"none.csv\"]"), "cannot be read"),
        (with("loops = [\"open.csv\"]"), "does not close"),
        (with("loops = [\"word.csv\"]"), "line 6: \"abc\" is not a number"),
        (with("loops = [\"probe_loop.csv\", \"probe_loop.csv\"]"), "listed twice"),
        (with("loops = [\"probe_loop.csv\"]\nprobe_radius_m = 20"), "20"),
        (with("loops = [\"probe_loop.csv\"]\nbaseline = \"cubic\""), "use one of"),
        (with("loops = [\"probe_loop.csv\"]\nradiuss = \"a\""), "did you mean `radius`"),
        (with("loops = [\"probe_loop.csv\"]\nforce = \"F9\""), "no column \"F9\""),
        (with("loops = 1"), "must be an array"),
        ("experiment = 1\n".to_owned(), "experiment"),
    ] {
        fs::write(at("mine.toml"), spec(&experiment)).unwrap();
        let output = hysteron(folder.path(), &["plan", "mine.toml"]);
        let errors = stderr(&output);
        assert!(code(&output) == 2 && errors.contains(words), "{experiment}: {errors}");
        assert!(errors.contains("help: ") && errors.contains("mine.toml:"), "{experiment}: {errors}");
    }
    assert!(!at("data").exists());
}
