//! Results in other forms: `compare`, `show`, `export csv`.

use super::SMALL;
use crate::bench::{Bench, SPEC, code, files, skip, stderr, stdout};
use crate::scan::import::{bytes, part};
use hysteron::schema::{self, Kind};
use hysteron::store::parquet::read_table;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn program(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron")).args(arguments).output().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn e2e_compare_is_the_option_of_report() {
    let (one, other) = (Bench::new(SMALL), Bench::new(&SMALL.replace("[cycle]", "[model]\ninteraction = \"none\"\n[cycle]")));
    for bench in [&one, &other] {
        assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    }
    let [own, option] = ["own", "option"].map(|name| one.folder.path().join(name));
    let (first, second) = (one.out(), other.out());
    let compared = program(&["compare", text(&first), text(&second), "--out", text(&own), "--json"]);
    assert_eq!(code(&compared), 0, "{}", stderr(&compared));
    let answer: serde_json::Value = serde_json::from_slice(&compared.stdout).unwrap();
    assert_eq!(answer["report"], text(&own.join("comparison.html")));
    let reported = program(&["report", "--compare", text(&first), text(&second), "--out", text(&option)]);
    assert_eq!(code(&reported), 0, "{}", stderr(&reported));
    assert_eq!(files(&own), files(&option));
    assert_eq!(code(&program(&["compare", text(&first)])), 2, "one run is not enough");
    assert_eq!(code(&program(&["report", "--compare", text(&first)])), 2, "one run is not enough");
    let mixed = one.folder.path().join("mixed");
    let reported = program(&["report", text(&first), "--compare", text(&second), "--out", text(&mixed)]);
    assert_eq!(code(&reported), 0, "{}", stderr(&reported));
    assert_eq!(files(&own), files(&mixed));
    let said = stdout(&reported);
    assert!(said.contains("loss ") && said.contains(" ± ") && said.contains(" against "), "{said}");
    // A comparison is not replaced by that of other runs, nor is a run compared with itself.
    let twice = program(&["compare", text(&first), text(&first), "--out", text(&own)]);
    assert!(code(&twice) == 1 && stderr(&twice).contains(" with itself\nhelp: "), "{}", stderr(&twice));
    let turned = |more: &[&str]| program(&[&["compare", text(&second), text(&first), "--out", text(&own)], more].concat());
    assert!(code(&turned(&[])) == 1 && stderr(&turned(&[])).contains(" holds the comparison of other runs\nhelp: "));
    assert_eq!(files(&own), files(&option));
    assert_eq!(code(&program(&["compare", text(&first), text(&second), "--out", text(&own)])), 0, "the same runs");
    assert_eq!(code(&turned(&["--force"])), 0);
    let exported = program(&["export", "csv", text(&own)]);
    assert_eq!(code(&exported), 0, "{}", stderr(&exported));
    let csv = fs::read_to_string(own.join("csv/comparison.csv")).unwrap();
    let heading = csv.lines().next().unwrap();
    assert!(heading.starts_with("group,campaign,") && heading.contains(",magnification,"), "{heading}");
    assert_eq!(code(&program(&["report", "--compare", text(&first), text(&second), "--set", "seed=1"])), 2);
}

/// The cells of a CSV file by RFC 4180: `None` where nothing stands between two commas.
fn cells(text: &str) -> Vec<Vec<Option<String>>> {
    let mut rows = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let mut row = Vec::new();
        loop {
            let (cell, after) = if let Some(quoted) = rest.strip_prefix('"') {
                let mut end = 0;
                while quoted[end..].starts_with("\"\"") || !quoted[end..].starts_with('"') {
                    end += if quoted[end..].starts_with('"') { 2 } else { quoted[end..].chars().next().unwrap().len_utf8() };
                }
                (Some(quoted[..end].replace("\"\"", "\"")), &quoted[end + 1..])
            } else {
                let end = rest.find([',', '\r']).unwrap();
                (Some(rest[..end].to_owned()).filter(|cell| !cell.is_empty()), &rest[end..])
            };
            row.push(cell);
            match after.strip_prefix(',') {
                Some(next) => rest = next,
                None => {
                    rest = after.strip_prefix("\r\n").unwrap();
                    break;
                }
            }
        }
        rows.push(row);
    }
    rows
}

#[test]
fn e2e_csv_holds_the_tables_to_the_last_bit() {
    // A failed case has nulls; as_printed has an empty text and one with a plus.
    let spec = SPEC.replace("surface.magnification = [6, 8]", "surface.magnification = 6\nmaterial.interaction_range_m = [1e-9, 1e-6]");
    let bench = Bench::new(&spec);
    assert_eq!(code(&bench.verb("run", &[])), 3);
    let exported = program(&["export", "csv", text(&bench.out())]);
    assert_eq!(code(&exported), 0, "{}", stderr(&exported));
    let mut missing = 0;
    for table in schema::TABLES.iter().filter(|table| table.file.starts_with("statistics/")) {
        // Tables of measured loops and of several scans are in runs that have some.
        if table.name.starts_with("measured_") || ["scans", "scan_spectra", "spectrum"].contains(&table.name) {
            continue;
        }
        let frame = read_table(&bench.out().join(table.file), table).unwrap();
        let csv = fs::read_to_string(bench.out().join(table.file.replace("statistics/", "csv/").replace(".parquet", ".csv"))).unwrap();
        let rows = cells(&csv);
        assert_eq!(rows.len(), frame.row_count() + 1, "{}", table.name);
        let names: Vec<&str> = rows[0].iter().map(|cell| cell.as_deref().unwrap()).collect();
        assert_eq!(names, table.columns.iter().map(|column| column.name).collect::<Vec<_>>());
        for (at, column) in table.columns.iter().enumerate() {
            let cell = |row: usize| rows[row + 1][at].as_deref();
            for row in 0..frame.row_count() {
                missing += usize::from(cell(row).is_none());
                match column.kind {
                    Kind::F64 => {
                        let read = cell(row).map(|cell| cell.parse::<f64>().unwrap().to_bits());
                        assert_eq!(read, frame.f64_or_null(column.name).unwrap()[row].map(f64::to_bits), "{}", column.name);
                    }
                    Kind::I64 => assert_eq!(cell(row).map(|cell| cell.parse().unwrap()), frame.i64_or_null(column.name).unwrap()[row]),
                    Kind::Bool => assert_eq!(cell(row).map(|cell| cell == "TRUE"), frame.bool_or_null(column.name).unwrap()[row]),
                    Kind::Text => assert_eq!(cell(row), frame.text_or_null(column.name).unwrap()[row].as_deref(), "{}", column.name),
                }
            }
        }
    }
    assert!(missing > 10, "{missing}");
    // The files are no part of the run: they are no fault, and are not deleted.
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
    assert!(stdout(&bench.look("clean", &[])).contains("Nothing is left over"));
    let none = program(&["export", "csv", text(bench.folder.path())]);
    assert_eq!(code(&none), 1);
    assert!(stderr(&none).contains("help: run `hysteron run SPEC` first"), "{}", stderr(&none));
    in_r(&bench);
}

/// Base R reads the same numbers.
fn in_r(bench: &Bench) {
    let script = "x <- read.csv('csv/cases.csv'); \
                  stopifnot(is.numeric(x$loss_mean), is.character(x$case_id), any(is.na(x$loss_mean)), ncol(x) > 100); \
                  cat(nrow(x), format(sum(x$loss_mean, na.rm = TRUE), digits = 15))";
    let Ok(ran) = Command::new("Rscript").args(["-e", script]).current_dir(bench.out()).output() else {
        return skip("R", "there is no Rscript");
    };
    assert!(ran.status.success(), "{}", stderr(&ran));
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    let sum: f64 = cases.f64_or_null("loss_mean").unwrap().iter().flatten().sum();
    let said = stdout(&ran);
    let (rows, read) = said.split_once(' ').unwrap();
    assert_eq!(rows.parse::<usize>().unwrap(), cases.row_count());
    // Fifteen digits are printed.
    assert!((read.parse::<f64>().unwrap() / sum - 1.0).abs() < 1e-13, "{read} is not {sum}");
}

#[test]
fn e2e_csv_of_cycles_holds_the_tables_of_each_cycle() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let exported = program(&["export", "csv", "--cycles", text(&bench.out())]);
    assert_eq!(code(&exported), 0, "{}", stderr(&exported));
    let mut count = 0;
    for entry in fs::read_dir(bench.out().join("cycles")).unwrap() {
        let id = entry.unwrap().file_name().into_string().unwrap();
        for table in schema::TABLES {
            let Some(name) = table.file.strip_prefix("cycles/<id>/") else { continue };
            let path = format!("cycles/{id}/{name}");
            if !bench.out().join(&path).is_file() {
                continue;
            }
            let frame = read_table(&bench.out().join(&path), table).unwrap();
            let csv = fs::read_to_string(bench.out().join("csv").join(Path::new(&path).with_extension("csv"))).unwrap();
            assert_eq!(cells(&csv).len(), frame.row_count() + 1, "{path}");
            count += 1;
        }
    }
    assert!(count >= 8, "{count}");
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
}

#[test]
fn e2e_show_lists_the_keys_of_the_kind_of_surface() {
    let spec = "name = \"measured\"\nsurface.file = \"scan.npy\"\nsurface.pixel_m = 12.5e-9\nsurface.unit = \"nm\"\nmodel.boundary = \"isolated\"\n\
                model.jump_in = \"jkr\"\ncycle.max_load = [0.001]\n";
    let bench = Bench::new(spec);
    fs::write(bench.folder.path().join("scan.npy"), bytes(&part())).unwrap();
    let run = bench.verb("run", &["--until", "extract"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let plan: serde_json::Value = serde_json::from_slice(&bench.verb("plan", &["--json"]).stdout).unwrap();
    for stage in [0, 2] {
        let shown = stdout(&bench.look("show", &[plan["stages"][stage]["units"][0]["id"].as_str().unwrap()]));
        for part in ["surface.file = ", "surface.unit = ", "surface.points_per_shortest_wavelength = "] {
            assert!(shown.contains(part), "{part} is missing in {shown}");
        }
        for part in [
            "surface.magnification",
            "surface.hurst",
            "surface.length_m",
            "surface.rms_height_m",
            "surface.normalization",
            "surface.amplitudes",
        ] {
            assert!(!shown.contains(part), "{part} is in {shown}");
        }
    }
    let generated = Bench::new(SMALL);
    let plan: serde_json::Value = serde_json::from_slice(&generated.verb("plan", &["--json"]).stdout).unwrap();
    assert_eq!(code(&generated.verb("run", &["--until", "generate"])), 0);
    let shown = stdout(&generated.look("show", &[plan["stages"][0]["units"][0]["id"].as_str().unwrap()]));
    assert!(shown.contains("surface.hurst = ") && !shown.contains("surface.unit") && !shown.contains("surface.detrend"), "{shown}");
}

/// Boundary elements read no `model.boundary`: `show` leaves it out, with the others, and states how a scan is continued.
#[test]
fn e2e_show_lists_the_keys_of_the_method() {
    let spec = |probe: &str| {
        format!(
            "name = \"measured\"\nsurface.file = \"scan.npy\"\nsurface.pixel_m = 12.5e-9\nsurface.unit = \"nm\"\nmodel.boundary = \"isolated\"\n\
             model.method = \"boundary_elements\"\nboundary_elements.points = 256\ncycle.max_load = [0.001]\n{probe}"
        )
    };
    let of_cycle = |spec: &str| {
        let bench = Bench::new(spec);
        fs::write(bench.folder.path().join("scan.npy"), bytes(&part())).unwrap();
        let run = bench.verb("run", &["--until", "extract"]);
        assert_eq!(code(&run), 0, "{}", stderr(&run));
        let plan: serde_json::Value = serde_json::from_slice(&bench.verb("plan", &["--json"]).stdout).unwrap();
        let id = plan["stages"][2]["units"][0]["id"].as_str().unwrap().to_owned();
        let answer: serde_json::Value = serde_json::from_slice(&bench.look("show", &[&id, "--json"]).stdout).unwrap();
        (stdout(&bench.look("show", &[&id])), answer)
    };
    let (shown, answer) = of_cycle(&spec(""));
    assert!(!shown.contains("model.boundary = ") && shown.contains("model.method = \"boundary_elements\""), "{shown}");
    assert!(shown.contains("boundary_elements.points = 256") && shown.contains("its mirror images continue it"), "{shown}");
    assert!(shown.contains("Not read by boundary elements: model.interaction, model.boundary,"), "{shown}");
    assert!(answer["parameters"].get("model.boundary").is_none() && answer["notes"].as_array().unwrap().len() == 2, "{answer:#}");
    let (on_probe, _) = of_cycle(&spec("probe.radius_m = 1e-6\n"));
    assert!(on_probe.contains("on a probe it is not mirrored"), "{on_probe}");
    let asperities = spec("model.jump_in = \"jkr\"\n").replace("\"boundary_elements\"", "\"asperities\"");
    let (shown, answer) = of_cycle(&asperities);
    assert!(shown.contains("model.boundary = \"isolated\"") && !shown.contains("boundary_elements."), "{shown}");
    assert!(answer["notes"].as_array().unwrap().is_empty());
}

#[test]
fn e2e_show_prints_cases_and_tasks() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "extract"])), 0);
    let plan: serde_json::Value = serde_json::from_slice(&bench.verb("plan", &["--json"]).stdout).unwrap();
    let id = |stage: usize| plan["stages"][stage]["units"][0]["id"].as_str().unwrap().to_owned();
    let planned = stdout(&bench.look("show", &[&id(2)]));
    assert!(planned.starts_with(&format!("cycle {}: planned; case ", id(2))) && !planned.contains("Results"), "{planned}");
    assert_eq!(code(&bench.verb("run", &[])), 0);

    let cycle = stdout(&bench.look("show", &[&id(2)]));
    assert!(cycle.starts_with(&format!("cycle {}: done; case ", id(2))), "{cycle}");
    for part in ["surface.magnification = 6", "Results at F_max/(E* A0) = 0.001", "  loss = ", "/steps.parquet ("] {
        assert!(cycle.contains(part), "{part} is missing in {cycle}");
    }
    let frame = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    let case_id = frame.text("case_id").unwrap()[0].to_owned();
    let case = stdout(&bench.look("show", &[&case_id]));
    assert!(case.contains("2 of 2 cycles done") && case.contains("  loss = ") && case.contains(" ± ") && case.contains(&id(2)), "{case}");
    let carried = !frame.text("caution").unwrap()[0].is_empty();
    assert_eq!(case.contains("\nWarnings\n"), carried, "{case}");
    assert!(case.lines().all(|line| line.chars().count() <= 80), "{case}");

    let answer: serde_json::Value = serde_json::from_slice(&bench.look("show", &[&case_id, "--json"]).stdout).unwrap();
    // The reader of JSON may take the next double.
    let (read, wanted) = (answer["results"][0]["loss_mean"].as_f64().unwrap(), frame.f64("loss_mean").unwrap()[0]);
    assert!((read / wanted - 1.0).abs() < 1e-15, "{read} is not {wanted}");
    assert_eq!(answer["parameters"]["cycle.approach_step"], 0.05);
    let surface = stdout(&bench.look("show", &[&id(0)]));
    assert!(surface.contains("generate done, extract done") && surface.contains("asperities/"), "{surface}");
    assert!(stdout(&bench.look("show", &["report"])).contains("report.html ("));
    let unknown = bench.look("show", &["H0.80_z6-00000000"]);
    assert_eq!(code(&unknown), 1);
    assert!(stderr(&unknown).contains("\nhelp: "), "{}", stderr(&unknown));
}

/// What the spec alone decides is said before anything is computed.
#[test]
fn e2e_plan_warns_of_cases_outside_the_range() {
    let spec = SMALL.to_owned() + "[[sweep]]\nname = \"modulus\"\nmaterial.contact_modulus_pa = [1e6, 1e9]\n";
    let bench = Bench::new(&spec);
    let planned = bench.verb("plan", &[]);
    assert_eq!(code(&planned), 0, "{}", stderr(&planned));
    let text = stdout(&planned);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    for code in ["sticky", "conformed"] {
        assert!(text.contains(&format!("warning[{code}]: ")), "{text}");
    }
    assert_eq!(text.split_whitespace().collect::<Vec<_>>().join(" ").matches("for 1 of 2 cases.").count(), 2, "{text}");
    let answer: serde_json::Value = serde_json::from_str(&stdout(&bench.verb("plan", &["--json"]))).unwrap();
    let outside = answer["outside_range"].as_array().unwrap();
    assert_eq!((outside.len(), &outside[0]["code"], outside[0]["cases"].as_array().unwrap().len()), (2, &"sticky".into(), 1));
    let value = outside[0]["max"].as_f64().unwrap();
    assert!(value > 0.0 && value < outside[0]["limit"].as_f64().unwrap());
    assert!(!bench.out().exists(), "plan writes nothing");
    // The same number as after the run.
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    assert!((cases.f64("persson_tosatti_mean").unwrap()[0] / value - 1.0).abs() < 1e-12);
    let stiff = Bench::new(&spec.replace("[1e6, 1e9]", "1e9"));
    assert!(!stdout(&stiff.verb("plan", &[])).contains("warning["));
}
