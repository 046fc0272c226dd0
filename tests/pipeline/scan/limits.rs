//! Values and sizes at their limits: heights that no surface has, crops, and little memory.

use crate::bench::{code, stderr, stdout};
use ndarray::{Array2, s};
use serde_json::Value;
use std::fs;
use std::path::Path;

use super::import::{bytes, cut, import};
use super::make::{npy, npy_line};

const TOLD: [&str; 5] = ["--pixel-m", "12.5e-9", "--unit", "nm", "--dry-run"];

fn imported(folder: &Path, heights: &Array2<f64>, more: &[&str]) -> std::process::Output {
    fs::write(folder.join("scan.npy"), bytes(heights)).unwrap();
    import(folder, &[&["scan.npy"], more].concat())
}

#[test]
fn e2e_heights_that_are_too_large_are_told_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let heights = cut(8, 48).mapv(|h| h / 40.0);
    for (factor, unit) in [(1e200, "m"), (1e307, "m"), (1e307, "km"), (1e12, "m")] {
        let output = imported(folder.path(), &heights.mapv(|h| factor * h), &["--pixel-m", "1e-6", "--unit", unit]);
        let said = stderr(&output);
        assert!(code(&output) == 1 && said.contains("heights too large") && said.contains("help: check the unit"), "{factor}: {said}");
        assert!(!said.contains("constant"), "{said}");
    }
}

#[test]
fn e2e_a_crop_and_a_bad_fit_are_cautions() {
    let folder = tempfile::tempdir().unwrap();
    let cautions = |heights: &Array2<f64>| {
        let output = imported(folder.path(), heights, &[&TOLD[..], &["--json"]].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let told: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let cautions: Vec<String> = told["cautions"].as_array().unwrap().iter().map(|text| text.as_str().unwrap().to_owned()).collect();
        (cautions, told["self_affine"].clone())
    };
    let whole = cut(64, 304);
    // 304 by 308 points lose 1.3 %.
    let (found, fit) = cautions(&whole);
    assert!(found.is_empty() && (0.0..=1.0).contains(&fit["hurst"].as_f64().unwrap()), "{found:?} {fit}");
    let (found, _) = cautions(&whole.slice(s![..270, ..]).to_owned());
    assert!(
        found.iter().any(|text| text.starts_with("crop: 12 % of the scan (308 x 270 points, 3.850e-6 m x 3.375e-6 m)")
            && text.contains("270 x 270 points remain")),
        "{found:?}"
    );
    // In words too, in eighty columns.
    let output = imported(folder.path(), &whole.slice(s![..100, ..]).to_owned(), &TOLD);
    let words = stdout(&output);
    assert!(words.contains("warning: crop: 68 % of the scan") && words.contains("points along x and y"), "{words}");
    assert!(words.lines().all(|line| line.chars().count() <= 80), "{words}");
    // White noise has C(q) constant: H = -1.
    let mut state = 1_u64;
    let noise = Array2::from_shape_simple_fn((128, 128), || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    });
    let (found, fit) = cautions(&noise);
    assert!(fit["hurst"].as_f64().unwrap() < 0.0, "{fit}");
    assert!(found.iter().any(|text| text.starts_with("fit: H = -") && text.contains("not self-affine")), "{found:?}");
    // Too few wavelengths for a fit: one, of 16 points.
    let wave = |k: usize| (std::f64::consts::PI / 8.0 * k as f64).sin();
    let (found, fit) = cautions(&Array2::from_shape_fn((64, 64), |(i, j)| wave(i) * wave(j)));
    assert!(fit.is_null() && found.iter().any(|text| text.starts_with("fit: too few wavelengths")), "{found:?} {fit}");
}

/// Fields that do not fit into the memory that the program may have.
#[cfg(target_os = "linux")]
#[test]
fn e2e_little_memory_is_a_sentence() {
    use std::process::Command;
    let folder = tempfile::tempdir().unwrap();
    // 6144 points a side, of one byte each in the file: 300 MB of heights, 1.2 GB with the mirror images, and as much again of modes.
    let side = 6144;
    let row: Vec<u8> = (0..side).map(|k| (k * k % 251) as u8).collect();
    let data: Vec<u8> = (0..side).flat_map(|k| row.iter().map(move |byte| byte.wrapping_add((k % 7) as u8))).collect();
    fs::write(folder.path().join("large.npy"), npy(1, &npy_line("|u1", "False", &format!("({side}, {side})")), &data)).unwrap();
    fs::write(
        folder.path().join("large.toml"),
        "name = \"x\"\nrealizations = 1\n[surface]\nmagnification = 1024\npoints_per_shortest_wavelength = 8\n",
    )
    .unwrap();
    let limited = |kilobytes: u32, arguments: &[&str]| {
        let script = format!("ulimit -v {kilobytes}; exec \"$0\" \"$@\"");
        let output = Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_hysteron")])
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap();
        (output.status.code(), stderr(&output))
    };
    let import = ["import", "large.npy", "--pixel-m", "1e-9", "--unit", "nm", "--dry-run"];
    // The heights themselves, their window, their mirror images, their modes: each has too little in its turn.
    for kilobytes in [500_000, 900_000, 1_400_000, 2_400_000] {
        let (code, said) = limited(kilobytes, &import);
        assert!(code == Some(1) && said.contains("memory"), "{kilobytes}: {code:?} {said}");
    }
    let (code, said) = limited(800_000, &["generate", "large.toml", "--jobs", "1"]);
    assert!(code == Some(3) && said.contains("GB of memory"), "{code:?} {said}");
}
