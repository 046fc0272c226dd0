//! The S-filter of measured surfaces: option, key, warning and columns.

use crate::bench::{Bench, code, paths, stderr, stdout};
use hysteron::schema;
use hysteron::store::hdf5::read_header;
use hysteron::store::parquet::read_table;
use ndarray::Array2;
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;

use super::import::{bytes, import};

/// Pillars of 1 µm with flat tops, 16 points wide, with 10 nm of roughness: heights in nanometres.
fn pillars() -> Array2<f64> {
    let rough = |i: usize, j: usize| 10.0 * ((7 * i * i + 3 * j) as f64).sin() + 5.0 * ((5 * i + 11 * j * j) as f64).cos();
    Array2::from_shape_fn((32, 32), |(i, j)| rough(i, j) + if i < 16 && j < 16 { 1000.0 } else { 0.0 })
}

fn sinusoid(periods: f64) -> Array2<f64> {
    let q = TAU * periods / 64.0;
    Array2::from_shape_fn((64, 64), |(i, j)| 500.0 * ((q * i as f64).cos() + (q * j as f64).cos()))
}

const MICROMETRE: [&str; 4] = ["--pixel-m", "1e-6", "--unit", "nm"];

#[test]
fn e2e_import_states_the_filter_and_what_it_raises() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pillars.npy"), bytes(&pillars())).unwrap();
    let answer = |filter: &[&str]| -> Value {
        let output = import(folder.path(), &[&["pillars.npy", "--json", "--periodic", "--force"], &MICROMETRE[..], filter].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        serde_json::from_str(&stdout(&output)).unwrap()
    };
    let warned =
        |answer: &Value| answer["cautions"].as_array().unwrap().iter().any(|text| text.as_str().unwrap().starts_with("overshoot: "));
    let sharp = answer(&["--filter", "sharp"]);
    assert_eq!(sharp["filter"], "sharp");
    assert!(warned(&sharp) && sharp["overshoot_m"].as_f64().unwrap() > 5e-8, "{sharp}");
    let gaussian = answer(&[]);
    assert_eq!((&gaussian["filter"], gaussian["overshoot_m"].as_f64()), (&Value::from("gaussian"), Some(0.0)));
    assert!(!warned(&gaussian));
    let header = read_header(&folder.path().join("pillars.h5")).unwrap();
    assert_eq!(header.measured.unwrap().filter, hysteron::model::Filter::Gaussian);
    let told = stdout(&import(folder.path(), &[&["pillars.npy", "-n", "--periodic"], &MICROMETRE[..]].concat()));
    assert!(told.contains("(Gaussian filter)"), "{told}");
    assert_eq!(code(&import(folder.path(), &[&["pillars.npy", "-n", "--filter", "box"], &MICROMETRE[..]].concat())), 2);
}

#[test]
fn e2e_a_run_states_the_filter_in_spec_tables_and_report() {
    let bench = Bench::new("");
    let scan = bench.folder.path().join("pillars.npy");
    fs::write(&scan, bytes(&pillars())).unwrap();
    let text = format!(
        "name = \"pillars\"\n[surface]\nfile = {:?}\npixel_m = 1e-6\nunit = \"nm\"\nperiodic = true\n[model]\njump_in = \"jkr\"\n\
         [material]\nwork_of_adhesion_j_m2 = 1e-6\n[cycle]\nmax_load = [0.0002]\napproach_step = 0.05\n\
         [[sweep]]\nname = \"filter\"\nsurface.filter = [\"gaussian\", \"sharp\"]\n",
        scan.to_str().unwrap()
    );
    fs::write(bench.spec(), text).unwrap();
    let output = bench.verb("run", &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let resolved = fs::read_to_string(bench.out().join("campaign.toml")).unwrap();
    assert!(resolved.contains("\nfilter = \"gaussian\"\n"), "{resolved}");
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    assert_eq!(cases.text_or_null("filter").unwrap(), [Some("gaussian".to_owned()), Some("sharp".to_owned())]);
    let cautions = cases.text("caution").unwrap();
    let overshoot: Vec<bool> = cautions.iter().map(|codes| codes.split('+').any(|code| code == "overshoot")).collect();
    assert_eq!(overshoot, [false, true], "{cautions:?}");
    let ratio = cases.f64_or_null("filter_overshoot_max").unwrap();
    assert!(ratio[0] == Some(0.0) && ratio[1].unwrap() > 0.01, "{ratio:?}");
    let report = fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(report.contains("filter overshoot") && report.contains("<td>gaussian</td>"));
    // No asperity of the Gaussian filter is above the highest measured point: 1014.9 nm at most, less the mean.
    let mean = pillars().mean().unwrap();
    let highest = pillars().iter().copied().fold(f64::MIN, f64::max);
    let mut tops: Vec<f64> = paths(&bench.out().join("asperities"))
        .iter()
        .filter(|path| path.extension().is_some_and(|ending| ending == "parquet"))
        .map(|path| read_table(path, &schema::ASPERITIES).unwrap().f64("height_m").unwrap().iter().copied().fold(f64::MIN, f64::max))
        .collect();
    tops.sort_by(f64::total_cmp);
    assert!(tops[0] < 1e-9 * (highest - mean) && tops[1] > 1e-9 * (highest - mean + 50.0), "{tops:?}");
}

#[test]
fn e2e_indicators_of_the_shortest_octave_refer_to_waves_that_are_there() {
    let folder = tempfile::tempdir().unwrap();
    for (periods, filter) in [(1.0, "gaussian"), (1.0, "sharp"), (2.0, "gaussian"), (1.3, "gaussian")] {
        fs::write(folder.path().join("s.npy"), bytes(&sinusoid(periods))).unwrap();
        let periodic: &[&str] = if periods == 1.3 { &["--detrend", "mean"] } else { &["--periodic"] };
        let output = import(folder.path(), &[&["s.npy", "--json", "-n", "--filter", filter], &MICROMETRE[..], periodic].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let answer: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let number = |name: &str| answer[name].as_f64().unwrap();
        // The limit of U_el alone: 2 Δγ. Under the Hann window a part of a sinusoid has a fifth of its energy elsewhere.
        let least = number("least_modulus_over_adhesion_1_m") * number("flattening_m");
        assert!((least - 2.0).abs() < 1e-9, "{periods} {filter}: {least} {answer}");
        assert!(number("flattening_octave_shortest_wavelength_m") >= 2.0 * number("shortest_wavelength_m"));
    }
}

#[test]
fn e2e_a_sinusoid_has_no_warning_of_the_cut_off() {
    let bench = Bench::new("");
    let scan = bench.folder.path().join("sinusoid.npy");
    fs::write(&scan, bytes(&sinusoid(1.0))).unwrap();
    let text = format!(
        "name = \"sinusoid\"\n[surface]\nfile = {:?}\npixel_m = 1e-6\nunit = \"nm\"\nperiodic = true\n[material]\nwork_of_adhesion_j_m2 = 1e-4\n\
         [model]\njump_in = \"jkr\"\n[cycle]\nmax_load = [0.0005]\napproach_step = 0.05\n",
        scan.to_str().unwrap()
    );
    fs::write(bench.spec(), text).unwrap();
    let output = bench.verb("run", &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    let codes = cases.text("caution").unwrap()[0];
    assert!(!codes.split('+').any(|code| ["conformed", "sticky", "coarse"].contains(&code)), "{codes}");
    let [octave, whole] =
        ["conformity_realised_mean", "persson_tosatti_realised_mean"].map(|name| cases.f64_or_null(name).unwrap()[0].unwrap());
    assert!((octave / whole - 1.0).abs() < 1e-12, "{octave} {whole}");
}
