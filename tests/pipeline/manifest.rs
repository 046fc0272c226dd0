//! All result files of two tiny runs: both methods on a generated surface, and both on a scan.
//!
//! With `HYSTERON_DIGESTS=1` and `--nocapture` the test prints the BLAKE3 digest of every file, to compare two builds on one machine byte by byte.

use crate::bench::{Bench, code, files, stderr};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fs;
use std::path::PathBuf;

const GENERATED: &str = "name = \"generated\"\nseed = 7\nrealizations = 1\n[surface]\nmagnification = 6\n[cycle]\nmax_load = [0.001, 0.002]\n\
    approach_step = 0.05\n[[sweep]]\nname = \"both\"\nmodel.method = [\"asperities\", \"boundary_elements\"]\n";

/// A scan that is not periodic, in nanometres.
const SCAN: &str = "name = \"scan\"\n[surface]\nfile = \"scan.txt\"\npixel_m = 1e-6\nunit = \"nm\"\npoints_per_shortest_wavelength = 8\n\
    [model]\nboundary = \"isolated\"\n[material]\nwork_of_adhesion_j_m2 = 0.0005\n[cycle]\nmax_load = [0.002]\napproach_step = 0.05\n[[sweep]]\nname = \"both\"\n\
    model.method = [\"asperities\", \"boundary_elements\"]\n";

/// Heights of the scan: five waves.
fn heights() -> String {
    let waves = [(1.0, 0.3, 0.4, 60.0), (0.2, 1.1, 1.9, 50.0), (2.1, 1.0, 3.0, 25.0), (1.0, -2.9, 5.1, 18.0), (3.2, 2.0, 0.2, 12.0)];
    let at = |x: f64, y: f64| waves.iter().map(|(kx, ky, phase, height)| height * (TAU * (kx * x + ky * y) + phase).cos()).sum::<f64>();
    let row = |i: usize| (0..32_usize).map(|j| format!("{:.6}", at(i as f64 / 32.0, j as f64 / 32.0))).collect::<Vec<_>>().join("\t");
    (0..32).map(|i| row(i) + "\n").collect()
}

/// Place and digest of the surfaces, tables, maps and states of a run.
fn manifest(spec: &str, jobs: &str) -> BTreeMap<PathBuf, String> {
    let bench = Bench::new(spec);
    fs::write(bench.folder.path().join("scan.txt"), heights()).unwrap();
    let output = bench.verb("run", &["--jobs", jobs]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let is_result = |path: &PathBuf| path.extension().is_some_and(|of| ["parquet", "h5", "bin", "svg"].iter().any(|known| of == *known));
    let all = files(&bench.out()).into_iter().filter(|(path, _)| is_result(path));
    all.map(|(path, bytes)| (path, blake3::hash(&bytes).to_hex().to_string())).collect()
}

#[test]
fn law_all_files_of_two_runs_are_the_same() {
    for spec in [GENERATED, SCAN] {
        let found = manifest(spec, "1");
        if std::env::var_os("HYSTERON_DIGESTS").is_some() {
            found.iter().for_each(|(path, digest)| eprintln!("{digest} {}", path.display()));
            continue;
        }
        for name in ["steps", "contacts", "events", "adhesionless", "estimates", "turning", "merged", "cases", "realizations"] {
            let name = format!("{name}.parquet");
            assert!(found.keys().any(|path| path.file_name().is_some_and(|of| of == name.as_str())), "no {name}");
        }
        assert_eq!(manifest(spec, "2"), found, "a second run with two tasks at once");
    }
}
