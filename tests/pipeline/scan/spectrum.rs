//! What `import` prints of the spectrum and of the texture of a scan.

use crate::bench::{Bench, code, stderr, stdout};
use hysteron::schema;
use hysteron::store::hdf5::read_header;
use hysteron::store::parquet::read_table;
use ndarray::Array2;
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use super::import::{bytes, import};

const TOLD: [&str; 4] = ["--pixel-m", "1e-8", "--unit", "nm"];

/// A periodic field of modes `low ≤ |k| < high` of n points with amplitudes of H = 0.8; the mode numbers along y are divided by `stretch`.
fn field(n: usize, [low, high]: [f64; 2], stretch: f64) -> Array2<f64> {
    let reach = high as i64;
    let mut state = 3_u64;
    let mut waves = Vec::new();
    for kx in 0..=reach {
        for ky in -reach..=reach {
            let mode = (kx as f64).hypot(ky as f64);
            if (low..high).contains(&mode) && (kx > 0 || ky > 0) {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let phase = TAU * (state >> 11) as f64 / (1_u64 << 53) as f64;
                waves.push([kx as f64, (ky as f64 / stretch).round(), phase, mode.powf(-1.8)]);
            }
        }
    }
    let unit = TAU / n as f64;
    Array2::from_shape_fn((n, n), |(i, j)| {
        waves.iter().map(|[kx, ky, phase, amplitude]| 10.0 * amplitude * (unit * (kx * i as f64 + ky * j as f64) + phase).cos()).sum()
    })
}

fn json(folder: &Path, more: &[&str]) -> Value {
    let output = import(folder, &[&["scan.npy", "--dry-run", "--json"], &TOLD[..], more].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

#[test]
fn e2e_a_scan_without_long_waves_has_its_hurst_exponent_and_both_cuts() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scan.npy"), bytes(&field(64, [2.0, 16.0], 1.0))).unwrap();
    // Periodic and not, and with cut-offs within and beyond the band.
    for more in [&["--periodic"][..], &[], &["--periodic", "--points", "4"], &["--points", "12"]] {
        let answer = json(folder.path(), more);
        let fit = &answer["self_affine"];
        let number = |name: &str| fit[name].as_f64().unwrap_or(f64::NAN);
        assert!((number("hurst") - 0.8).abs() < 0.05, "{more:?}: {fit}");
        // The side is 640 nm; a cut is between two rings of modes, 19 % apart.
        assert!((number("long_cut_m") / 320e-9).ln().abs() < 0.1, "{fit}");
        assert!((number("short_cut_m") / 40e-9).ln().abs() < 0.06 && fit["short_cut_cause"] == "empty", "{fit}");
        assert!(
            fit["roll_off_m"].is_null()
                && answer["cautions"].as_array().unwrap().iter().all(|text| !text.as_str().unwrap().starts_with("fit"))
        );
        assert!(answer["density_convention"].as_str().unwrap().contains("39.48"));
    }
    let words = stdout(&import(folder.path(), &[&["scan.npy", "--dry-run"], &TOLD[..]].concat()));
    for line in
        ["  long cut      no data above 3", "  short cut     no data below 3", "  roll-off      none within the scan", "39.48 times C"]
    {
        assert!(words.contains(line), "{line}: {words}");
    }
    assert!(words.lines().all(|line| line.chars().count() <= 80), "{words}");
}

#[test]
fn e2e_ridges_have_a_warning_and_no_expected_ratios() {
    let folder = tempfile::tempdir().unwrap();
    let ridges = field(96, [2.0, 12.0], 4.0);
    fs::write(folder.path().join("scan.npy"), bytes(&ridges)).unwrap();
    let output = import(folder.path(), &[&["scan.npy", "--periodic"], &TOLD[..]].concat());
    let words = stdout(&output);
    assert!(words.contains("\nwarning: texture: aspect ratio ") && words.contains("(limit 2)"), "{words}");
    // The first index of the file is y, so the ridges are along x. These waves behind the Gaussian filter have the principal axes 3.0006 and
    // 178.36°: from their modes, by an independent program. Differences of the fourth order are low by 0.1 % at eight points per wave.
    assert!(words.contains("smallest at 178° from x to y"), "{words}");
    assert!(words.lines().all(|line| line.chars().count() <= 80), "{words}");
    let stored = read_header(&folder.path().join("scan.h5")).unwrap().measured.unwrap().texture.unwrap();
    assert!((stored.slope_ratio - 3.0006).abs() < 0.005 && stored.aspect_ratio_str < 0.5, "{stored:?}");
    assert!((stored.direction_rad.to_degrees() - 178.358).abs() < 0.02, "{stored:?}");
    let isotropic = {
        fs::write(folder.path().join("scan.npy"), bytes(&field(96, [2.0, 12.0], 1.0))).unwrap();
        json(folder.path(), &["--periodic"])
    };
    assert!(isotropic["texture_aspect"].as_f64().unwrap() < 1.3, "{isotropic}");
    // In a run: columns, a warning, and no expected ratio.
    let spec = format!(
        "name = \"ridges\"\n[surface]\nfile = {:?}\nperiodic = true\n[material]\ncontact_modulus_pa = 5e9\nwork_of_adhesion_j_m2 = 0.05\n\
         [model]\njump_in = \"jkr\"\n[cycle]\nmax_load = [0.002]\napproach_step = 0.1\n",
        folder.path().join("scan.h5").display().to_string()
    );
    let bench = Bench::new(&spec);
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert!(run.status.success(), "{}", stderr(&run));
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    assert!(cases.text("caution").unwrap()[0].contains("texture"), "{}", stdout(&run));
    assert!(cases.f64_or_null("texture_aspect_max").unwrap()[0].is_some_and(|aspect| aspect > 2.5));
    assert!(cases.f64_or_null("persson_tosatti_realised_mean").unwrap()[0].is_some_and(|ratio| (1.0..600.0).contains(&ratio)));
    assert_eq!(cases.f64_or_null("area_model_ratio").unwrap()[0], None);
    assert!(!stdout(&run).contains("Expected ratio"), "{}", stdout(&run));
}
