//! What Python writes is read, and what is exported is read by Python.

use std::fs;
use std::path::Path;
use std::process::Command;

use hysteron::store::hdf5::write_tamaas;
use hysteron::store::scan::export::write_netcdf3;
use hysteron::store::scan::{Asked, Format, Found, detect, read};
use ndarray::Array2;

use super::same;
use crate::python::environment;

/// Runs the script; what it says, or nothing where there is no environment with the packages.
fn script(verb: &str, path: &Path) -> Option<String> {
    let folder = environment("scans", &["SurfaceTopography==1.27.*", "tamaas==2.9.*", "netCDF4", "h5py==3.*", "scipy", "numpy"])?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/scans.py");
    let output = Command::new(folder.join("bin/python")).arg(script).arg(verb).arg(path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}

fn doubles(path: &Path) -> Vec<f64> {
    fs::read(path).unwrap().chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect()
}

#[test]
fn e2e_files_of_python_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let Some(said) = script("make", folder.path()) else { return };
    let manifest = fs::read_to_string(folder.path().join("manifest.tsv")).unwrap();
    for line in manifest.lines() {
        let [name, kind, rows, columns, x, y, unit, periodic, exact] = line.split('\t').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let path = folder.path().join(name);
        let bytes = fs::read(&path).unwrap();
        let Some(Found::Scan(format)) = detect(&bytes[..bytes.len().min(512)]) else { panic!("{name}") };
        let expected = match kind {
            "npy" => Format::Npy,
            "nc" => Format::NetCdf3,
            "x3p" => Format::X3p,
            _ => Format::Text,
        };
        assert_eq!(format, expected, "{name}");
        let scan = read(&path, format, &Asked::default()).unwrap();
        let shape = (rows.parse().unwrap(), columns.parse().unwrap());
        let heights = Array2::from_shape_vec(shape, doubles(&folder.path().join(format!("{name}.f64")))).unwrap();
        eprintln!("{line}");
        if exact == "exact" {
            same(&scan.heights, &heights);
        } else {
            let scale = heights.iter().filter(|height| height.is_finite()).fold(0.0_f64, |most, height| most.max(height.abs()));
            for (left, right) in scan.heights.iter().zip(&heights) {
                assert!((left - right).abs() <= 1e-15 * scale || left.is_nan() && right.is_nan(), "{name}: {left} and {right}");
            }
        }
        let number = |word: &str| word.parse::<f64>().ok();
        match scan.size_m {
            Some(size) => assert_eq!([Some(size[0]), Some(size[1])], [number(x), number(y)], "{name}"),
            None => assert_eq!((x, y), ("-", "-"), "{name}"),
        }
        assert_eq!(scan.unit.as_deref().unwrap_or("-"), unit, "{name}");
        assert_eq!(scan.periodic.map_or("-", |periodic| if periodic { "1" } else { "0" }), periodic, "{name}");
    }
    assert_eq!(said.trim(), format!("{} files", manifest.lines().count()));
}

#[test]
fn e2e_surfacetopography_opens_what_is_exported() {
    let folder = tempfile::tempdir().unwrap();
    for (at, (rows, columns, size, periodic)) in [(6, 9, [1e-5, 3.3e-6], true), (64, 64, [2e-3, 2e-3], false)].into_iter().enumerate() {
        let heights = Array2::from_shape_fn((rows, columns), |(row, column)| ((row * 37 + column * 11) as f64).sin() * 1e-7);
        let path = folder.path().join(format!("{at}.nc"));
        write_netcdf3(&path, heights.view(), size, periodic).unwrap();
        let bytes: Vec<u8> = heights.iter().flat_map(|height| height.to_le_bytes()).collect();
        fs::write(folder.path().join(format!("{at}.nc.f64")), bytes).unwrap();
        let said = format!("{rows} {columns} {:e} {:e} {}", size[0], size[1], u8::from(periodic));
        fs::write(folder.path().join(format!("{at}.nc.tsv")), said).unwrap();
        if let Some(said) = script("check", &path) {
            assert!(said.contains("equal to the last bit"), "{said}");
        }
    }
}

#[test]
fn e2e_tamaas_opens_what_is_exported() {
    let folder = tempfile::tempdir().unwrap();
    let heights = Array2::from_shape_fn((8, 8), |(row, column)| ((row * 37 + column * 11) as f64).sin() * 1e-7);
    let path = folder.path().join("surface.h5");
    write_tamaas(&path, heights.view(), [2e-3, 2e-3]).unwrap();
    let bytes: Vec<u8> = heights.iter().flat_map(|height| height.to_le_bytes()).collect();
    fs::write(folder.path().join("surface.h5.f64"), bytes).unwrap();
    fs::write(folder.path().join("surface.h5.tsv"), "8 8 2e-3 2e-3").unwrap();
    if let Some(said) = script("tamaas", &path) {
        assert!(said.contains("equal to the last bit"), "{said}");
    }
}
