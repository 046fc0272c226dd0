//! Periodic surfaces: what is removed from them, and files that say whether they are.

use crate::bench::{Bench, code, paths, stderr, stdout};
use hysteron::model::Detrend;
use hysteron::spec::Spec;
use hysteron::store::hdf5::{read_header, read_surface};
use hysteron::store::scan::export::write_netcdf3;
use ndarray::Array2;
use serde_json::Value;
use std::fs;

use super::import::import;

const SPEC: &str = "name = \"x\"\nrealizations = 1\n[surface]\nmagnification = 16\n";

/// A generated surface that is exported and imported again is the same surface.
#[test]
fn e2e_a_periodic_surface_survives_export_and_import() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("generate", &[])), 0);
    let own = paths(&bench.out().join("surfaces")).remove(0);
    let folder = bench.folder.path();
    let exported = std::process::Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .args(["export", "netcdf"])
        .arg(&own)
        .args(["--out", "s.nc"])
        .current_dir(folder)
        .output()
        .unwrap();
    assert_eq!(code(&exported), 0, "{}", stderr(&exported));
    let output = import(folder, &["s.nc", "--periodic", "--json", "--filter", "sharp"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let told: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let ((was, heights), (is, again)) = (read_surface(&own).unwrap(), read_surface(&folder.join("s.h5")).unwrap());
    assert_eq!(is.measured.as_ref().unwrap().detrend, Detrend::Mean);
    // Rounding of two transforms of 128² points; a plane would change the slope by a quarter.
    for (name, was, is) in [
        ("rms height", was.rms_height_m, is.rms_height_m),
        ("slope", was.rms_slope, is.rms_slope),
        ("curvature", was.rms_curvature_1_m, is.rms_curvature_1_m),
        ("Nayak", was.nayak_parameter, is.nayak_parameter),
        ("JSON", was.rms_slope, told["rms_slope"].as_f64().unwrap()),
    ] {
        assert!((is / was - 1.0).abs() < 1e-10, "{name}: {was} and {is}");
    }
    let most = (&again - &heights).iter().fold(0.0_f64, |most, h| most.max(h.abs()));
    assert!(most < 1e-11 * was.rms_height_m, "{most}");
    // What is not periodic is not removed from it, and the file's own word counts.
    let refused = import(folder, &["s.nc", "--periodic", "--detrend", "plane", "--dry-run"]);
    assert_eq!(code(&refused), 2);
    assert!(
        stderr(&refused).starts_with("error: --detrend plane with --periodic") && stderr(&refused).contains("\nhelp: "),
        "{}",
        stderr(&refused)
    );
    assert_eq!(code(&import(folder, &["s.nc", "--periodic", "--detrend", "mean", "--dry-run"])), 0);
    for file in ["s.nc", own.to_str().unwrap()] {
        let refused = import(folder, &[file, "--dry-run"]);
        let said = stderr(&refused);
        assert!(
            code(&refused) == 1 && said.contains("the file says that the surface is periodic") && said.contains("\nhelp: set"),
            "{said}"
        );
    }
}

#[test]
fn e2e_a_file_that_is_not_periodic_is_not_taken_for_periodic() {
    let folder = tempfile::tempdir().unwrap();
    let heights = Array2::from_shape_fn((32, 32), |(i, j)| 1e-7 * ((0.7 * i as f64).sin() + (0.4 * j as f64).cos()));
    write_netcdf3(&folder.path().join("s.nc"), heights.view(), [1e-5; 2], false).unwrap();
    let refused = import(folder.path(), &["s.nc", "--periodic"]);
    assert!(code(&refused) == 1 && stderr(&refused).contains("the file says that the surface is not periodic"), "{}", stderr(&refused));
    let taken = import(folder.path(), &["s.nc"]);
    assert_eq!(code(&taken), 0, "{}", stderr(&taken));
    assert_eq!(read_header(&folder.path().join("s.h5")).unwrap().measured.unwrap().detrend, Detrend::Plane);
}

#[test]
fn law_the_default_of_detrend_follows_periodic() {
    let text = |surface: &str, rest: &str| {
        format!("name = \"x\"\n[surface]\nfile = \"a.npy\"\n{surface}\n[model]\nboundary = \"isolated\"\n{rest}")
    };
    let parsed = |text: &str| Spec::parse(text, "x.toml").unwrap_or_else(|errors| panic!("{errors}"));
    let shapes = |text: &str| {
        let spec = parsed(text);
        // What is written out reads back as the same spec.
        assert_eq!(parsed(&spec.to_toml()), spec, "{}", spec.to_toml());
        spec.cases.iter().map(|case| case.params.surface.measured().unwrap().detrend).collect::<Vec<_>>()
    };
    use Detrend::{Mean, Plane, Quadratic};
    assert_eq!(shapes(&text("", "")), [Plane]);
    assert_eq!(shapes(&text("periodic = true", "")), [Mean]);
    assert_eq!(shapes(&text("periodic = true\ndetrend = \"mean\"", "")), [Mean]);
    assert_eq!(shapes(&text("detrend = \"quadratic\"", "")), [Quadratic]);
    let both = "[[sweep]]\nname = \"p\"\nsurface.periodic = [true, false]\n";
    assert_eq!(shapes(&text("", both)), [Mean, Plane]);
    assert_eq!(shapes(&text("periodic = true", both)), [Mean, Plane]);
    assert_eq!(shapes(&text("periodic = true\ndetrend = \"mean\"", both)), [Mean, Mean]);
    let more = "[[sweep]]\nname = \"d\"\nsurface.detrend = [\"mean\", \"plane\"]\n";
    assert_eq!(shapes(&text("", &format!("{both}{more}"))), [Mean, Plane, Mean]);
    for shape in ["plane", "quadratic"] {
        let errors = Spec::parse(&text(&format!("periodic = true\ndetrend = \"{shape}\""), ""), "x.toml").unwrap_err().to_string();
        for words in ["`surface.periodic` is true", "--> x.toml:5:11", "^^^^", "write detrend = \"mean\""] {
            assert!(errors.contains(words), "{errors}");
        }
    }
    assert!(Spec::parse(&text("detrend = \"plane\"", both), "x.toml").is_err());
    assert_eq!(fs::metadata("a.npy").map_err(|error| error.kind()).unwrap_err(), std::io::ErrorKind::NotFound, "parsing reads no file");
}
