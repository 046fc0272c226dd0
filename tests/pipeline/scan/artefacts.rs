//! Spikes, offsets of scan lines and blunt tips, from the file of a scan to the tables and warnings.

use super::import::{bytes, cut, import};
use crate::bench::{Bench, code, stderr, stdout};
use hysteron::schema;
use hysteron::store::hdf5::{Quality, read_header};
use hysteron::store::parquet::read_table;
use ndarray::Array2;
use serde_json::Value;
use std::fs;
use std::path::Path;

const TOLD: [&str; 4] = ["--pixel-m", "12.5e-9", "--unit", "nm"];

fn clean() -> Array2<f64> {
    cut(16, 64)
}

fn spikes() -> Array2<f64> {
    let mut heights = clean();
    [(20, 30), (50, 11), (51, 11), (0, 67)].into_iter().for_each(|place| heights[place] += 4000.0);
    heights
}

/// Offsets of half the rms height that are no two alike.
fn offsets(along_columns: bool) -> Array2<f64> {
    let of = |k: usize| 24.0 * ((k * k * 7919 + k * 104_729) as f64 * 0.618_033_988_7).fract() - 12.0;
    let mut heights = clean();
    heights.indexed_iter_mut().for_each(|((i, j), h)| *h += of(if along_columns { j } else { i }));
    heights
}

/// The answer of `import` on heights in nanometres.
fn answer(folder: &Path, heights: &Array2<f64>, options: &[&str]) -> Value {
    fs::write(folder.join("scan.npy"), bytes(heights)).unwrap();
    let output = import(folder, &[&["scan.npy", "--json", "--force"], &TOLD[..], options].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

/// Codes of the warnings of an answer.
fn codes(answer: &Value) -> Vec<&str> {
    let texts = answer["cautions"].as_array().unwrap().iter().filter_map(Value::as_str);
    texts
        .filter_map(|text| text.split_once(':'))
        .map(|(code, _)| code)
        .filter(|code| ["outliers", "lines", "noise", "tip"].contains(code))
        .collect()
}

fn quality(folder: &Path) -> Quality {
    read_header(&folder.join("scan.h5")).unwrap().measured.unwrap().quality.unwrap()
}

#[test]
fn e2e_import_warns_of_artefacts_and_corrects_them() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let right = answer(folder, &clean(), &[]);
    assert_eq!(codes(&right), [""; 0]);
    assert_eq!((&right["outlier_left_count"], &right["line_offset_m"], &right["line_jump_m"]), (&0.into(), &Value::Null, &0.0.into()));
    let rms = |answer: &Value, name: &str| answer[name].as_f64().unwrap() / right[name].as_f64().unwrap();

    let spoilt = answer(folder, &spikes(), &[]);
    assert!(codes(&spoilt).contains(&"outliers"), "{spoilt:#}");
    assert!(rms(&spoilt, "rms_height_m") > 2.0);
    assert_eq!((quality(folder).outlier_count, quality(folder).outlier_left_count), (0, 4));
    let mended = answer(folder, &spikes(), &["--outliers"]);
    assert_eq!((codes(&mended), &mended["outlier_count"]), (vec![], &4.into()));
    // Four points of 4352 are interpolated.
    assert!((rms(&mended, "rms_height_m") - 1.0).abs() < 1e-3 && (rms(&mended, "rms_curvature_1_m") - 1.0).abs() < 0.02);
    assert_eq!((quality(folder).outlier_count, quality(folder).outlier_left_count), (4, 0));

    for (along_columns, axis) in [(false, "rows"), (true, "columns")] {
        let spoilt = answer(folder, &offsets(along_columns), &[]);
        assert!(codes(&spoilt).contains(&"lines"), "{spoilt:#}");
        assert_eq!(spoilt["line_axis"], axis);
        let mended = answer(folder, &offsets(along_columns), &["--align-rows"]);
        assert_eq!((codes(&mended), &mended["line_axis"]), (vec![], &axis.into()));
        // Offsets have a rms value of 24/sqrt(12) nm, and the alignment removes roughness across the lines too.
        assert!((mended["line_offset_m"].as_f64().unwrap() / 6.9e-9 - 1.0).abs() < 0.8, "{}", mended["line_offset_m"]);
        assert!((rms(&mended, "rms_curvature_1_m") - 1.0).abs() < 0.05, "{}", rms(&mended, "rms_curvature_1_m"));
        let fixed = answer(folder, &offsets(along_columns), &["--align-rows", "--fast-axis", axis]);
        assert_eq!(fixed["line_offset_m"], mended["line_offset_m"]);
    }
}

#[test]
fn e2e_a_tip_radius_raises_the_cutoff() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let right = answer(folder, &clean(), &[]);
    let curvature = 0.5 * right["rms_laplacian_1_m"].as_f64().unwrap();
    let shortest = right["shortest_wavelength_m"].as_f64().unwrap();
    // A sharp tip changes nothing.
    let sharp = answer(folder, &clean(), &["--tip-radius", &format!("{:e}", 0.1 / curvature)]);
    assert_eq!((&sharp["shortest_wavelength_m"], &sharp["tip_cutoff_m"]), (&right["shortest_wavelength_m"], &Value::Null));
    let blunt = answer(folder, &clean(), &["--tip-radius", &format!("{:e}", 3.0 / curvature)]);
    let cutoff = blunt["tip_cutoff_m"].as_f64().unwrap();
    assert!(cutoff > 1.2 * shortest && (blunt["shortest_wavelength_m"].as_f64().unwrap() / cutoff - 1.0).abs() < 1e-9);
    // What remains has the curvature of the tip, up to the width of the rings and the window of the spectrum.
    let left = 0.5 * blunt["rms_laplacian_1_m"].as_f64().unwrap() * 3.0 / curvature;
    assert!((0.7..1.2).contains(&left), "{left}");
    // The decimal numbers of the JSON text and of the file may differ in the last digit.
    assert!((quality(folder).tip_cutoff_m.unwrap() / cutoff - 1.0).abs() < 1e-14);
    let refused = import(folder, &[&["scan.npy", "--force", "--tip-radius", "1"], &TOLD[..]].concat());
    assert_eq!(code(&refused), 1);
    assert!(
        stderr(&refused).contains("--tip-radius") && stderr(&refused).contains("quarter") || stderr(&refused).contains("larger scan"),
        "{}",
        stderr(&refused)
    );
    for radius in ["0", "-1e-9", "nan", "inf"] {
        let refused = import(folder, &[&["scan.npy", "--force", "--tip-radius", radius], &TOLD[..]].concat());
        assert_ne!(code(&refused), 0, "{radius}");
        assert!(stderr(&refused).contains("help:") || stderr(&refused).contains("--help"), "{}", stderr(&refused));
    }
    let own = import(folder, &["scan.h5", "--dry-run", "--outliers"]);
    assert_eq!(code(&own), 1);
    assert!(stderr(&own).contains("surface.outliers") && stderr(&own).contains("help:"), "{}", stderr(&own));
}

/// A spec that names scans directly.
fn spec(files: &str, options: &str) -> String {
    format!(
        "name = \"artefacts\"\n[surface]\npixel_m = 12.5e-9\nunit = \"nm\"\n{options}[model]\nboundary = \"isolated\"\njump_in = \"jkr\"\n\
         [material]\ncontact_modulus_pa = 1e9\nwork_of_adhesion_j_m2 = 0.02\n[cycle]\nmax_load = [0.002]\napproach_step = 0.05\n[[sweep]]\nname = \"scan\"\nsurface.file = [{files}]\n"
    )
}

#[test]
fn val_corrected_scans_have_the_area_and_pull_off_force_of_the_clean_one() {
    let files = "\"clean.npy\", \"spikes.npy\", \"offsets.npy\"";
    let run = |options: &str| {
        let bench = Bench::new(&spec(files, options));
        for (name, heights) in [("clean", clean()), ("spikes", spikes()), ("offsets", offsets(false))] {
            fs::write(bench.folder.path().join(name).with_extension("npy"), bytes(&heights)).unwrap();
        }
        let [plan, output] = ["plan", "run"].map(|command| bench.verb(command, &[]));
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
        (stdout(&plan), stdout(&output), cases, fs::read_to_string(bench.out().join("report.html")).unwrap())
    };
    let (plan, said, raw, page) = run("");
    let cautions = raw.text("caution").unwrap();
    let has = |text: &str, code: &str| text.split('+').any(|word| word == code);
    for (row, codes) in [(0, [false, false]), (1, [true, false]), (2, [false, true])] {
        assert_eq!(["outliers", "lines"].map(|code| has(cautions[row], code)), codes, "{}", cautions[row]);
        assert!(!has(cautions[row], "tip"));
    }
    for text in [&plan, &said] {
        assert!(text.contains("[outliers]") && text.contains("[lines]"), "{text}");
    }
    assert!(plan.contains("--align-rows"), "{plan}");
    assert!(page.contains("outliers of the scan (outliers)") && page.contains("line offsets removed / left"));
    let (plan, said, mended, _) = run("outliers = true\nalign_rows = true\n");
    for text in [&plan, &said] {
        assert!(!text.contains("[outliers]") && !text.contains("[lines]"), "{text}");
    }
    let of = |table: &hysteron::store::Frame, name: &str| {
        table.f64_or_null(name).unwrap().iter().map(|value| value.unwrap()).collect::<Vec<_>>()
    };
    for name in ["area_at_max_load_mean", "pull_off_load_mean"] {
        let (spoilt, mended) = (of(&raw, name), of(&mended, name));
        // Alignment removes roughness across the lines from all three scans. It is exact for offsets, and four points are interpolated.
        for (row, value) in mended.iter().enumerate() {
            assert!((value / mended[0] - 1.0).abs() < 0.02, "{name} of {row}: {mended:?}");
        }
        assert!((spoilt[1] / spoilt[0] - 1.0).abs() > 0.5, "{name}: {spoilt:?}");
    }
}
