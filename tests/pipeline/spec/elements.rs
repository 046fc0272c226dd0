//! Boundary elements in a spec: what they refuse, and which values make cases of their own.

use super::refused;
use hysteron::model::{Attraction, ElementOptions};
use hysteron::spec::{Spec, mesh_number};

/// A case of boundary elements of ζ = 8, with further lines.
fn spec(lines: &str) -> String {
    format!("name = \"x\"\nsurface.magnification = 8\nmodel.method = \"boundary_elements\"\n{lines}\n")
}

#[test]
fn val_refusals_of_boundary_elements() {
    // Lines, and parts of the error.
    let bad: [(&str, &[&str]); 6] = [
        ("material.work_of_adhesion_j_m2 = 0", &["boundary elements need adhesion", "positive work of adhesion", "x.toml:4:"]),
        ("model.boundary = \"isolated\"", &["boundary elements are periodic", "boundary = \"periodic\""]),
        (
            "boundary_elements.points = 31",
            &["31 x 31 points has 3.88 points per shortest wavelength: at least 4", "boundary_elements.points"],
        ),
        ("boundary_elements.points = 8", &["has 1 point per shortest wavelength"]),
        (
            "boundary_elements.attraction = \"range\"\nboundary_elements.range_m = 2e-7",
            &["mesh number", "above 0.7", "traps contact edges", "boundary_elements.range_m"],
        ),
        ("boundary_elements.nucleation = \"jkr\"", &["unknown value \"jkr\" of `boundary_elements.nucleation`", "\"touch\", \"wu\""]),
    ];
    for (lines, parts) in bad {
        let rendered = refused(&spec(lines));
        for part in parts {
            assert!(rendered.contains(part), "{lines}: lacks `{part}`:\n{rendered}");
        }
    }
    // Of the asperity model none of them is one.
    for (lines, _) in &bad[..5] {
        let text = spec(lines).replace("\"boundary_elements\"", "\"asperities\"");
        assert!(Spec::parse(&text, "x.toml").is_ok(), "{text}");
    }
}

#[test]
fn reg_a_setting_replaces_a_list_of_grids() {
    let text = spec("boundary_elements.points = [32, 64, 128]");
    for (setting, coarser, cases) in [("64", vec![], 1), ("[48, 96]", vec![48], 2)] {
        let setting = format!("boundary_elements.points={setting}");
        let spec = Spec::parse_with(&text, "x.toml", &[setting]).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!((spec.coarser_points, spec.cases.len()), (coarser, cases));
    }
}

#[test]
fn val_too_large_a_magnification_for_the_largest_grid() {
    let text = "name = \"x\"\n[surface]\nmagnification = 2048\n[model]\nmethod = \"boundary_elements\"\n";
    let rendered = refused(text);
    assert!(rendered.contains("4096 x 4096 points has 2 points per shortest wavelength"), "{rendered}");
}

#[test]
fn val_the_automatic_grid_is_a_power_of_two_with_sixteen_points() {
    let elements = ElementOptions::default();
    for (wavelengths, grid) in [(2.0, 32), (4.0, 64), (8.0, 128), (9.0, 256), (128.0, 2048), (256.0, 4096), (500.0, 4096), (1e9, 4096)] {
        assert_eq!(elements.grid(wavelengths), grid, "{wavelengths}");
    }
    assert_eq!(ElementOptions { points: Some(96), ..elements }.grid(8.0), 96);
}

#[test]
fn law_the_automatic_range_has_the_same_mesh_number_on_every_grid() {
    let elements = ElementOptions { attraction: Attraction::Range { range_m: None }, ..ElementOptions::default() };
    for (work_length, spacing) in [(7e-8, 7.8e-6), (1e-10, 1e-9), (1.0, 1e-3)] {
        let mesh = mesh_number(work_length, spacing, elements.range(work_length, spacing).unwrap());
        assert!((mesh - 0.625).abs() < 1e-12, "{mesh}");
    }
}

#[test]
fn law_values_that_a_method_does_not_read_make_no_case() {
    let sweep = |lines: &str| format!("name = \"x\"\nsurface.magnification = 8\n[[sweep]]\nname = \"s\"\n{lines}\n");
    // Lines, cases.
    let sweeps = [
        ("model.method = [\"asperities\", \"boundary_elements\"]", 2),
        ("model.method = [\"asperities\", \"boundary_elements\"]\nmodel.coalescence = [\"cover\", \"merge\", \"none\"]", 4),
        ("model.method = [\"asperities\", \"boundary_elements\"]\nboundary_elements.points = [64, 128]", 3),
        ("model.method = [\"asperities\", \"boundary_elements\"]\ncycle.approach_step = [0.01, 0.02]", 3),
        ("model.method = \"boundary_elements\"\nboundary_elements.nucleation = [\"touch\", \"wu\"]", 2),
        ("model.method = \"boundary_elements\"\nmodel.as_printed = [[], [\"eq8\"], [\"a2\"]]", 2),
    ];
    for (lines, count) in sweeps {
        let spec = Spec::parse(&sweep(lines), "x.toml").unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(spec.cases.len(), count, "{lines}");
        assert_eq!(Spec::parse(&spec.to_toml(), "x.toml").unwrap(), spec, "{lines}");
    }
}
