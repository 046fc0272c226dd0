//! Several scans of one sample: files of a spec, containers, and their common spectrum.
//!
//! `tests/reference/container.zip` was written by SurfaceTopography 1.27 (`container.py` there): three maps of 8, 2 and 1 µm, the last
//! one in nanometres, and a line scan.

use crate::bench::{Bench, code, stderr, stdout};
use hysteron::schema::{CUTOFF, CYCLES, PANELS, REALIZATIONS, SCAN_SPECTRA, SCANS, SPECTRUM, Table};
use hysteron::spec::Spec;
use hysteron::store::Frame;
use hysteron::store::parquet::read_table;
use serde_json::Value;
use std::fs;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

fn container() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/container.zip")
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() <= tolerance, "{found} instead of {expected}");
}

/// The program in the folder of a bench.
fn hysteron(bench: &Bench, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
    command.args(arguments).current_dir(bench.folder.path()).output().unwrap()
}

/// A bench with the container in its folder.
fn bench() -> Bench {
    let bench = Bench::new("");
    fs::copy(container(), bench.folder.path().join("scans.zip")).unwrap();
    bench
}

/// Parts of the container by their names.
fn parts() -> Vec<(String, Vec<u8>)> {
    let mut archive = ZipArchive::new(Cursor::new(fs::read(container()).unwrap())).unwrap();
    let mut found = Vec::new();
    for place in 0..archive.len() {
        let mut part = archive.by_index(place).unwrap();
        let mut bytes = Vec::new();
        part.read_to_end(&mut bytes).unwrap();
        found.push((part.name().unwrap().into_owned(), bytes));
    }
    found
}

/// A zip archive of these parts, compressed.
fn packed(path: &Path, parts: &[(String, Vec<u8>)]) {
    let mut archive = ZipWriter::new(fs::File::create(path).unwrap());
    for (name, bytes) in parts {
        archive.start_file(name.as_str(), SimpleFileOptions::default()).unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap();
}

fn json(output: &Output) -> Value {
    serde_json::from_str(&stdout(output)).unwrap_or_else(|error| panic!("{error}: {}{}", stdout(output), stderr(output)))
}

fn table(bench: &Bench, table: &'static Table) -> Frame {
    read_table(&bench.folder.path().join("out").join(table.file), table).unwrap()
}

/// A spec of these files.
fn spec(files: &str) -> String {
    format!(
        "name = \"several\"\n[surface]\nfiles = [{files}]\n[material]\ncontact_modulus_pa = 2e9\nwork_of_adhesion_j_m2 = 0.05\n\
         [model]\nboundary = \"isolated\"\njump_in = \"jkr\"\n[cycle]\nmax_load = [0.004]\napproach_step = 0.05\n"
    )
}

#[test]
fn val_spectra_of_a_container_are_those_of_numpy() {
    let found = json(&hysteron(&bench(), &["import", "scans.zip", "-n", "--json"]));
    let scans = found["scans"].as_array().unwrap();
    assert_eq!(scans.len(), 3);
    // By numpy from the container as SurfaceTopography reads it: plane removed, Hann window, rings of modes k with round(4 log2 k) equal.
    let rings = [
        [(7, 3.830_758_33e6, 2.092_336_07e-30, 28), (10, 6.399_593_02e6, 5.773_375_91e-31, 64)],
        [(7, 1.532_303_33e7, 2.014_799_57e-32, 28), (10, 2.559_837_21e7, 2.799_653_92e-33, 64)],
        [(7, 3.064_606_66e7, 2.815_263_94e-33, 28), (10, 5.119_674_42e7, 6.548_223_87e-34, 64)],
    ];
    // Slopes in the same bands by SurfaceTopography's power_spectrum_from_area (window "hann", over 4π²), in bins of its own.
    let slopes = [0.079_88, 0.096_84, 0.115_32];
    for ((scan, rings), slope) in scans.iter().zip(rings).zip(slopes) {
        for (place, wavenumber, density, count) in rings {
            let ring = &scan["spectrum"][place];
            // Nine digits of the numbers above.
            close(ring["wavenumber_1_m"].as_f64().unwrap(), wavenumber, 3e-9);
            close(ring["density_m4"].as_f64().unwrap(), density, 3e-9);
            assert_eq!(ring["mode_count"], count);
        }
        let [low, high] = ["lowest_1_m", "highest_1_m"].map(|name| scan["reliable"][name].as_f64().unwrap());
        assert_eq!((&scan["reliable"]["lowest_cause"], &scan["reliable"]["highest_cause"]), (&"window".into(), &"grid".into()));
        let points: Vec<(f64, f64)> = scan["spectrum"]
            .as_array()
            .unwrap()
            .iter()
            .map(|ring| (ring["wavenumber_1_m"].as_f64().unwrap().ln(), ring["density_m4"].as_f64().unwrap().ln()))
            .collect();
        let density = |x: f64| {
            let after = points.partition_point(|point| point.0 < x);
            let ((a, c), (b, d)) = (points[after - 1], points[after]);
            (c + (d - c) * (x - a) / (b - a)).exp()
        };
        // The sum over 1000 steps of ln q; the bins of SurfaceTopography differ by 2 % in the slope.
        let step = (high / low).ln() / 1000.0;
        let square: f64 = (0..1000).map(|k| low.ln() + (f64::from(k) + 0.5) * step).map(|x| (4.0 * x).exp() * density(x) * step).sum();
        close((std::f64::consts::TAU * square).sqrt(), slope, 0.02);
    }
    // The common spectrum by numpy, at 10^6.4, 10^7.3 (two scans) and 10^7.7.
    let rows = found["common_spectrum"].as_array().unwrap();
    assert_eq!(rows.len(), 13);
    for (place, density, count) in [(0, 1.928_363_561_134_661e-29, 1), (8, 9.900_779_861_676_843e-33, 2), (12, 6.565_806_447_000_63e-34, 1)]
    {
        close(rows[place]["density_m4"].as_f64().unwrap(), density, 1e-12);
        assert_eq!(rows[place]["scan_count"], count);
    }
    close(rows[8]["scatter_decades"].as_f64().unwrap(), 0.138_655_392_548_445_1, 1e-11);
    // Moments and U_el/E* by the trapezoidal rule in numpy, with 20 001 points in each interval: 1e-9.
    for (name, value) in [
        ("rms_height_m", 2.022_153_757_8e-8),
        ("rms_slope", 0.159_012_913_717),
        ("rms_curvature_1_m", 4_174_102.190_1),
        ("flattening_m", 5.804_268_933e-10),
    ] {
        close(found["common"][name].as_f64().unwrap(), value, 1e-9);
    }
    let left = &found["left_out"];
    assert!(left[0]["name"].as_str().unwrap().ends_with("line 4 um") && left[0]["failed"] == false && left.as_array().unwrap().len() == 1);
    // The 2 µm map begins where the 8 µm map ends.
    assert!(found["warnings"].as_array().unwrap().iter().any(|text| text.as_str().unwrap().starts_with("gap: ")));
}

#[test]
fn e2e_from_a_container_to_a_report_and_back_to_surfaces() {
    let bench = bench();
    let imported = hysteron(&bench, &["import", "scans.zip", "--points", "4", "--out", "scans"]);
    let text = stdout(&imported);
    assert_eq!(code(&imported), 0, "{}", stderr(&imported));
    assert!(text.contains("3 scans imported, 1 left out") && text.contains("line scan: left out"), "{text}");
    let at = |name: &str| bench.folder.path().join(name);
    for name in ["map_8_um.h5", "map_2_um.h5", "map_1000_nm.h5", "scans.parquet", "psd.csv"] {
        assert!(at("scans").join(name).is_file(), "{name}");
    }
    // The printed spec runs.
    let printed = &text[text.find("name = \"of_scans\"").unwrap()..text.find("\nThe common spectrum").unwrap()];
    fs::write(at("spec.toml"), printed).unwrap();
    let run = hysteron(&bench, &["run", "spec.toml", "--out", "out"]);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    let rows = table(&bench, &REALIZATIONS);
    assert_eq!(rows.i64("realization").unwrap(), [0, 1, 2]);
    let files = ["map_8_um.h5", "map_2_um.h5", "map_1000_nm.h5"].map(|name| Some(name.to_owned()));
    assert_eq!(rows.text_or_null("surface_file").unwrap(), files);
    assert_eq!(table(&bench, &CYCLES).text_or_null("surface_file").unwrap(), files);
    for (length, expected) in rows.f64("length_m").unwrap().iter().zip([8e-6, 2e-6, 1e-6]) {
        close(*length, expected, 1e-12);
    }
    // The file of the import has passed the S-filter, which the run undoes: up to 11 % differ on 32 to 40 points, from the edges of the filter.
    let scans = table(&bench, &SCANS);
    assert_eq!(scans.row_count(), 4);
    assert_eq!(scans.i64_or_null("realization").unwrap()[3], None);
    let common = table(&bench, &SPECTRUM);
    let csv = fs::read_to_string(at("scans/psd.csv")).unwrap();
    let of_import: Vec<[f64; 2]> =
        csv.lines().skip(1).map(|line| line.split_once(',').map(|(q, c)| [q.parse().unwrap(), c.parse().unwrap()]).unwrap()).collect();
    for (q, density) in common.f64("wavenumber_1_m").unwrap().iter().zip(common.f64("density_m4").unwrap()) {
        let same = of_import.iter().find(|row| (row[0] / q - 1.0).abs() < 1e-5).unwrap();
        close(density, same[1], 0.15);
    }
    assert!(table(&bench, &SCAN_SPECTRA).bool("reliable").unwrap().iter().any(|reliable| !reliable));
    let page = fs::read_to_string(at("out/report.html")).unwrap();
    assert!(page.contains(">Common spectrum</h2>") && at("out/figures/spectrum.svg").is_file());
    // The common spectrum as a table for generated surfaces.
    let exported = hysteron(&bench, &["export", "psd", "out", "--out", "psd.csv"]);
    assert_eq!(code(&exported), 0, "{}", stderr(&exported));
    let generated =
        "name = \"g\"\n[surface]\nspectrum = \"psd.csv\"\nspectrum_convention = \"plain\"\nlength_m = 2.4e-6\nmagnification = 14\n";
    fs::write(at("g.toml"), generated).unwrap();
    let spec = Spec::read(at("g.toml")).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(spec.cases[0].params.surface.generated().unwrap().tabulated.table.is_some());
    // A second import does not overwrite.
    let again = hysteron(&bench, &["import", "scans.zip", "--points", "4", "--out", "scans"]);
    assert!(code(&again) == 1 && stderr(&again).contains("the file exists"), "{}", stderr(&again));
}

#[test]
fn e2e_scans_keep_their_results_in_any_list() {
    let bench = bench();
    let at = |name: &str| bench.folder.path().join(name);
    assert_eq!(code(&hysteron(&bench, &["import", "scans.zip", "--points", "4", "--out", "s"])), 0);
    let of = |text: String| {
        fs::write(at("spec.toml"), text).unwrap();
        let output = hysteron(&bench, &["run", "spec.toml", "--out", "out"]);
        (code(&output), stdout(&output) + &stderr(&output))
    };
    let one = spec("").replace("files = []", "file = \"s/map_2_um.h5\"");
    assert_eq!(of(one).0, 0);
    // Two scans of a list: one is computed already, as the surface of a single file.
    let (status, text) = of(spec("\"s/map_8_um.h5\", \"s/map_2_um.h5\""));
    assert!(status == 0 && text.contains("cycle     1 of 2 computed, 1 done before"), "{text}");
    let steps = |place: usize| {
        let cycles = table(&bench, &REALIZATIONS);
        let id = cycles.text("cycle_id").unwrap()[place].to_owned();
        fs::read(at("out/cycles").join(id).join("steps.parquet")).unwrap()
    };
    let before = steps(1);
    // Another order, and one more: the rest is kept.
    let (status, text) = of(spec("\"s/map_2_um.h5\", \"s/map_1000_nm.h5\", \"s/map_8_um.h5\""));
    assert!(status == 0 && text.contains("cycle     1 of 3 computed, 2 done before"), "{text}");
    assert!(before == steps(0));
    let shards: Vec<Output> = (0..2)
        .map(|part| hysteron(&bench, &["run", "spec.toml", "--out", "parts", "--until", "cycle", "--shard", &format!("{part}/2")]))
        .collect();
    assert!(shards.iter().all(|shard| code(shard) == 0), "{}", stderr(&shards[0]));
    let whole = hysteron(&bench, &["run", "spec.toml", "--out", "parts"]);
    assert!(stdout(&whole).contains("cycle     0 of 3 computed, 3 done before"), "{}", stdout(&whole));
    let statistics = |name: &str| fs::read(at(name).join("statistics/realizations.parquet")).unwrap();
    assert!(statistics("out") == statistics("parts"));
    // A scan that changed is read again; one that is gone is named.
    fs::copy(at("s/map_8_um.h5"), at("s/map_1000_nm.h5")).unwrap();
    let (status, text) = of(spec("\"s/map_2_um.h5\", \"s/map_1000_nm.h5\", \"s/map_8_um.h5\""));
    assert!(status == 2 && text.contains("\"s/map_8_um.h5\" has the same content as \"s/map_1000_nm.h5\""), "{text}");
    fs::remove_file(at("s/map_1000_nm.h5")).unwrap();
    let (status, text) = of(spec("\"s/map_2_um.h5\", \"s/map_1000_nm.h5\""));
    assert!(status == 2 && text.contains("the measured surface \"s/map_1000_nm.h5\" cannot be read"), "{text}");
}

#[test]
fn e2e_a_scan_that_cannot_be_imported_leaves_the_others() {
    let bench = bench();
    let at = |name: &str| bench.folder.path().join(name);
    assert_eq!(code(&hysteron(&bench, &["import", "scans.zip", "--points", "4", "--out", "s"])), 0);
    fs::write(at("bad.txt"), "1 2 3\n4 5 6\n").unwrap();
    fs::write(at("spec.toml"), spec("\"s/map_2_um.h5\", \"bad.txt\", \"s/map_8_um.h5\"")).unwrap();
    let run = hysteron(&bench, &["run", "spec.toml", "--out", "out"]);
    assert_eq!(code(&run), 3, "{}{}", stdout(&run), stderr(&run));
    assert!(stdout(&run).contains("bad.txt") && table(&bench, &REALIZATIONS).i64("realization").unwrap() == [0, 2]);
    assert_eq!(table(&bench, &SCANS).row_count(), 3);
    let imported = hysteron(&bench, &["import", "bad.txt", "s/map_2_um.h5", "s/map_2_um.h5", "--out", "t"]);
    let text = stdout(&imported).split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(code(&imported), 3, "{}", stderr(&imported));
    assert!(text.contains("1 scan imported, 2 left out") && text.contains("same content as s/map_2_um.h5"), "{text}");
    assert!(text.contains("warning: bad.txt: no unit of the heights in the file, and no pixel size"), "{text}");
}

#[test]
fn e2e_other_and_damaged_archives() {
    let bench = bench();
    let at = |name: &str| bench.folder.path().join(name);
    let run = |name: &str| {
        let output = hysteron(&bench, &["import", name, "-n"]);
        (code(&output), stdout(&output) + &stderr(&output))
    };
    let parts = parts();
    let without =
        |names: &[&str]| -> Vec<(String, Vec<u8>)> { parts.iter().filter(|(name, _)| !names.contains(&name.as_str())).cloned().collect() };
    // meta.yml alone, and no metadata: the names of the parts, and the line scan by its contents.
    for names in [&["index.json"][..], &["index.json", "meta.yml"]] {
        packed(&at("old.zip"), &without(names));
        let (status, text) = run("old.zip");
        assert!(status == 0 && text.contains("3 scans imported, 1 left out") && text.contains("old.zip: topography0.nc"), "{text}");
        assert_eq!(text.contains("meta.yml is not read"), names.len() == 1, "{text}");
    }
    // One damaged measurement among good ones.
    let cut: Vec<(String, Vec<u8>)> = parts
        .iter()
        .map(|(name, bytes)| (name.clone(), if name == "topography1.nc" { bytes[..bytes.len() / 2].to_vec() } else { bytes.clone() }))
        .collect();
    packed(&at("cut.zip"), &cut);
    let (status, text) = run("cut.zip");
    assert!(status == 3 && text.contains("2 scans imported, 2 left out"), "{text}");
    assert!(text.contains("map 2 um: cannot read") && !text.contains("/tmp/"), "{text}");
    // A size in the metadata that differs from that of the file: the file counts, and both are named.
    let doubled = |(name, bytes): &(String, Vec<u8>)| {
        let mut bytes = bytes.clone();
        if name == "index.json" {
            let mut index: Value = serde_json::from_slice(&bytes).unwrap();
            let size = &mut index["surfaces"][0]["topographies"][0]["size"][0];
            *size = (2.0 * size.as_f64().unwrap()).into();
            bytes = index.to_string().into_bytes();
        }
        (name.clone(), bytes)
    };
    assert!(!run("scans.zip").1.contains("in index.json"));
    packed(&at("size.zip"), &parts.iter().map(doubled).collect::<Vec<_>>());
    let (status, text) = run("size.zip");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(status == 0 && words.contains("a size of 1.6000e-5 m x 8.0000e-6 m in index.json, of 8.0000e-6 m x"), "{text}");
    // A missing data file, an index that is no JSON, an archive without surfaces, one that was cut off.
    packed(&at("lost.zip"), &without(&["topography0.nc"]));
    assert!(run("lost.zip").1.contains("has no data file in the archive"));
    packed(&at("odd.zip"), &[vec![("index.json".to_owned(), b"{".to_vec())], without(&["index.json"])].concat());
    let (status, text) = run("odd.zip");
    assert!(status == 1 && text.contains("index.json is damaged") && text.contains("\nhelp: download or export"), "{text}");
    packed(&at("empty.zip"), &without(&["topography0.nc", "topography1.nc", "topography2.nc", "topography3.nc"]));
    let (status, text) = run("empty.zip");
    assert!(status == 1 && text.contains("no scan was read"), "{text}");
    assert!(text.contains("\nhelp: export the container again with its data files") && text.matches("help: ").count() == 1, "{text}");
    let whole = fs::read(container()).unwrap();
    fs::write(at("short.zip"), &whole[..whole.len() / 2]).unwrap();
    let (status, text) = run("short.zip");
    assert!(status == 1 && text.contains("damaged zip archive") && text.contains("help: "), "{text}");
    packed(&at("text.zip"), &[("README.txt".to_owned(), b"x".to_vec())]);
    assert_eq!(run("text.zip").0, 1);
}

#[test]
fn reg_options_of_import_are_refused_with_help() {
    let bench = bench();
    let text = |arguments: &[&str]| {
        let output = hysteron(&bench, arguments);
        (code(&output), stderr(&output))
    };
    let names: Vec<String> = (0..40).map(|k| format!("{k},{k},{k}\n")).collect();
    fs::write(bench.folder.path().join("twice.csv"), format!("force (nN),force (nN),displacement (nm)\n{}", names.concat())).unwrap();
    for (arguments, problem) in [
        (&["import", "scans.zip", "--pixel-m", "-1"][..], "--pixel-m is -1"),
        (&["import", "scans.zip", "--size", "-1"], "--size is \"-1\""),
        (&["import", "scans.zip", "--tip-radius", "-1e-8"], "--tip-radius is -0.00000001"),
        (&["import", "twice.csv", "--loop", "--probe-radius", "20"], "--probe-radius is \"20\", read as 2e1 m"),
        (&["import", "twice.csv", "--loop", "--modulus", "-5"], "--modulus is -5"),
        (&["import", "twice.csv", "--loop"], "two columns are named"),
    ] {
        let (status, found) = text(arguments);
        assert!(status == 1 && found.contains(problem) && found.contains("\nhelp: "), "{arguments:?}\n{found}");
    }
    assert_eq!(code(&hysteron(&bench, &["import", "scans.zip", "--out", "s"])), 0);
    let (status, found) = text(&["import", "s/map_8_um.h5", "--out", "none/a.h5"]);
    assert!(status == 1 && found.contains("the folder none does not exist\nhelp: create the folder (mkdir -p none)"), "{found}");
    let (status, found) = text(&["export", "psd", "s", "--out", "p.csv"]);
    assert!(status == 1 && found.contains("help: a run of a spec with surface.files"), "{found}");
}

/// Options of a section of the help of `import`, by its heading.
fn options(help: &str, heading: &str) -> Vec<String> {
    let lines = help.lines().skip_while(|line| *line != heading).skip(1).take_while(|line| line.is_empty() || line.starts_with(' '));
    let names = lines.filter_map(|line| line.split_whitespace().find(|word| word.starts_with("--") && line.trim_start().starts_with('-')));
    names.map(|name| name.trim_end_matches(',').to_owned()).collect()
}

/// Options of scans.
const OF_SCANS: [&[&str]; 16] = [
    &["--dataset", "z"],
    &["--pixel-m", "1e-9"],
    &["--size", "5um"],
    &["--unit", "nm"],
    &["--skip-lines", "1"],
    &["--width", "4"],
    &["--transpose"],
    &["--fill"],
    &["--detrend", "plane"],
    &["--outliers"],
    &["--align-rows"],
    &["--fast-axis", "rows", "--align-rows"],
    &["--tip-radius", "1e-8"],
    &["--periodic"],
    &["--filter", "gaussian"],
    &["--points", "8"],
];

/// Options of measured loops.
const OF_LOOPS: [&[&str]; 12] = [
    &["--loop"],
    &["--force-column", "1"],
    &["--force-unit", "nN"],
    &["--displacement-column", "2"],
    &["--displacement-unit", "um"],
    &["--radius-column", "a"],
    &["--radius-unit", "um"],
    &["--compression", "auto"],
    &["--baseline", "line"],
    &["--probe-radius", "20um"],
    &["--modulus", "1e6"],
    &["--machine-stiffness", "30"],
];

/// An option of measured loops with a scan or a container, and one of scans with a loop, is an error that names it. The lists have every option of the help.
#[test]
fn reg_options_of_the_other_kind_are_refused() {
    let bench = bench();
    let at = |name: &str| bench.folder.path().join(name);
    let line = |x: usize| (0..48).map(|y| format!("{} ", (7 * x + y * y) % 11)).collect::<String>() + "\n";
    fs::write(at("scan.txt"), (0..48).map(line).collect::<String>()).unwrap();
    fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("data/examples/probe_loop.csv"), at("loop.csv")).unwrap();
    let names = |of: &[&[&str]]| -> Vec<String> { of.iter().map(|option| option[0].to_owned()).collect() };
    let help = stdout(&hysteron(&bench, &["import", "--help"]));
    assert_eq!(options(&help, "Options for measured loops:"), names(&OF_LOOPS));
    let others: Vec<String> = options(&help, "Options:");
    let of_output = ["--out", "--dry-run", "--force", "--json", "--help"];
    let read: Vec<String> = others.into_iter().filter(|name| !of_output.contains(&name.as_str())).collect();
    assert_eq!(read, names(&OF_SCANS));
    let scan = ["scan.txt", "--size", "40um", "--unit", "nm"];
    let refused = |file: &[&str], option: &[&str], words: &str| {
        let output = hysteron(&bench, &[&["import", "-n"], file, option].concat());
        let said = stderr(&output);
        assert!(code(&output) == 2 && stdout(&output).is_empty(), "{option:?}: {said}");
        assert!(said.starts_with(&format!("error: cannot import {} as a {words}: ", file[0])), "{said}");
        assert!(said.contains(option[0]) && said.contains("\nhelp: leave them out"), "{said}");
    };
    for option in OF_SCANS {
        refused(&["loop.csv"], option, "measured loop: options of scans");
    }
    for option in OF_LOOPS {
        // The first names and the columns make any text a loop.
        let is_loop = ["--loop", "--force-column", "--displacement-column"].contains(&option[0]);
        if !is_loop {
            refused(&scan, option, "scan: options of measured loops");
        }
        refused(&["scans.zip"], option, "scan: options of measured loops");
    }
    assert_eq!(code(&hysteron(&bench, &[&["import", "-n"], &scan[..]].concat())), 0);
    let all = ["import", "-n", "scan.txt", "--size", "40um", "--unit", "nm", "--probe-radius", "20um", "--modulus", "1e6"];
    assert!(stderr(&hysteron(&bench, &all)).contains(": --probe-radius, --modulus\n"));
}

/// A missing file has one message in every format and among several; what is not a file has another one.
#[test]
fn reg_missing_files_have_one_message() {
    let bench = bench();
    for ending in ["x3p", "zip", "h5", "nc", "npy", "txt", "csv", "sur"] {
        let name = format!("none.{ending}");
        let wanted = format!("error: cannot read {name}: no such file\nhelp: check the path\n");
        for more in [&[][..], &["--loop"]] {
            let output = hysteron(&bench, &[&["import", &name], more].concat());
            assert_eq!((code(&output), stderr(&output)), (1, wanted.clone()));
        }
    }
    fs::create_dir(bench.folder.path().join("folder")).unwrap();
    let folder = hysteron(&bench, &["import", "folder"]);
    assert!(stderr(&folder).starts_with("error: cannot read folder: not a regular file\nhelp: "), "{}", stderr(&folder));
    let with = hysteron(&bench, &["import", "scans.zip", "none.x3p", "-n"]);
    assert!(code(&with) == 3 && stdout(&with).contains("none.x3p: no such file"), "{}{}", stdout(&with), stderr(&with));
    let none = hysteron(&bench, &["import", "none.x3p", "none.npy"]);
    assert!(code(&none) == 1 && stderr(&none).contains("none.npy: no such file\nhelp: check the path"), "{}", stderr(&none));
}

/// Scans of different size: figures in SI units have the columns of the tables, those without a common scale are left out, and so is the table over the cut-off
/// wavelength. A size that contradicts the file is an error, and so is one force on scans of two sizes.
#[test]
fn reg_scans_of_different_size_in_si_units() {
    let bench = bench();
    let at = |name: &str| bench.folder.path().join(name);
    assert_eq!(code(&hysteron(&bench, &["import", "scans.zip", "--points", "4", "--out", "s"])), 0);
    let files = "\"s/map_8_um.h5\", \"s/map_2_um.h5\"";
    let probe = "[probe]\nradius_m = 1e-6\n[cycle]";
    fs::write(at("spec.toml"), spec(files).replace("[cycle]", probe)).unwrap();
    let run = hysteron(&bench, &["run", "spec.toml", "--out", "out"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let (drawn, results) = (table(&bench, &PANELS), table(&bench, &REALIZATIONS));
    let (panels, names, y) = (drawn.text("panel").unwrap(), drawn.text("name").unwrap(), drawn.f64("y").unwrap());
    let of = |panel: &str, name: &str| -> Vec<f64> {
        (0..panels.len()).filter(|row| panels[*row] == panel && names[*row] == name).map(|row| y[row]).collect()
    };
    let singles = |column: &str| -> Vec<f64> { results.f64_or_null(column).unwrap().iter().flatten().copied().collect() };
    assert_eq!(of("B_SI", "pull_off_load_single"), singles("pull_off_load_n"));
    assert_eq!(of("D_SI", "loss_single"), singles("loss_j"));
    assert!(!panels.iter().any(|panel| ["A_SI", "C_SI"].contains(panel)) && panels.contains(&"A"));
    assert_eq!(table(&bench, &CUTOFF).row_count(), 0);
    for (keys, words) in [
        ("size_m = 5e-6", ["surface.size_m is 5.0000e-6 m", "remove surface.size_m"]),
        ("unit = \"nm\"", ["heights in metres", "remove surface.unit"]),
    ] {
        fs::write(at("spec.toml"), spec(files).replace("[material]", &format!("{keys}\n[material]"))).unwrap();
        let plan = stdout(&hysteron(&bench, &["plan", "spec.toml"])).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.iter().all(|word| plan.contains(word)), "{keys}: {plan}");
    }
    let force = spec(files).replace("[cycle]\nmax_load = [0.004]", "[cycle]\nmax_force_n = [1e-6]");
    fs::write(at("spec.toml"), force).unwrap();
    let refused = hysteron(&bench, &["plan", "spec.toml"]);
    assert!(code(&refused) == 2 && stderr(&refused).contains("one force is two loads F/(E* A0)"), "{}", stderr(&refused));
}
