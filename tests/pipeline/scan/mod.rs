//! Scans: what other programs write is read to the bit, and whatever else a file holds, the answer is a sentence.

#[cfg(feature = "stats")]
mod artefacts;
mod attributes;
mod damage;
#[cfg(feature = "stats")]
mod filter;
#[cfg(feature = "stats")]
mod formats;
#[cfg(feature = "stats")]
pub mod import;
mod instruments;
#[cfg(feature = "stats")]
mod limits;
mod make;
mod netcdf;
mod npy;
#[cfg(feature = "stats")]
mod orders;
mod outside;
#[cfg(feature = "stats")]
mod periodic;
mod points;
#[cfg(feature = "stats")]
mod python;
#[cfg(feature = "stats")]
mod spectrum;
mod text;
mod x3p;

use std::fs;
use std::path::Path;

use hysteron::lengths::{LENGTHS, metres};
use hysteron::store::StoreError;
use hysteron::store::hdf5_scan::read_scan;
use hysteron::store::scan::{Asked, Format, Found, Scan, detect, read};
use ndarray::Array2;

/// Reads bytes as a file of this format; a failure as its sentence.
fn scan_of(bytes: &[u8], format: Format, variable: Option<&str>) -> Result<Scan, String> {
    let folder = tempfile::tempdir().unwrap();
    scan_at(&folder.path().join("scan"), bytes, format, variable)
}

/// As [`scan_of`], with a path at which they are to stand.
fn scan_at(path: &Path, bytes: &[u8], format: Format, variable: Option<&str>) -> Result<Scan, String> {
    fs::write(path, bytes).unwrap();
    read(path, format, &Asked { field: variable, ..Asked::default() }).map_err(|error| {
        let message = error.to_string();
        let begin = format!("cannot read the surface from {}: ", path.display());
        message.strip_prefix(&begin).unwrap_or_else(|| panic!("{message}")).to_owned()
    })
}

/// Heights in the order of a text or an array, whose lines run along x.
fn lines(scan: &Scan) -> Array2<f64> {
    scan.heights.t().as_standard_layout().into_owned()
}

/// Heights of a dataset of an HDF5 file.
pub fn read_heights(path: &Path, field: Option<&str>) -> Result<Array2<f64>, StoreError> {
    read_scan(path, &Asked { field, ..Asked::default() }).map(|scan| scan.heights)
}

/// Asserts that this is refused with a sentence that has these parts.
#[track_caller]
fn refused(bytes: &[u8], format: Format, parts: &[&str]) {
    let message = scan_of(bytes, format, None).unwrap_err();
    for part in parts {
        assert!(message.contains(part), "{message:?} lacks {part:?}");
    }
}

/// Asserts that two fields have the same bits, or both a missing point.
#[track_caller]
fn same(left: &Array2<f64>, right: &Array2<f64>) {
    assert_eq!(left.dim(), right.dim());
    for ((place, left), right) in left.indexed_iter().zip(right) {
        assert!(left.to_bits() == right.to_bits() || left.is_nan() && right.is_nan(), "{place:?}: {left} and {right}");
    }
}

/// Heights that are awkward to store.
fn awkward() -> Array2<f64> {
    let some = [0.0, -0.0, 1.0 / 3.0, -1.5e-300, 5e-324, f64::MAX, f64::MIN_POSITIVE, 7.1e-9];
    Array2::from_shape_fn((3, 5), |(row, column)| some[(row * 5 + column) % some.len()])
}

#[test]
fn law_first_bytes_tell_formats_apart() {
    for (bytes, found) in [
        (&b"\x93NUMPY\x01\x00"[..], Some(Found::Scan(Format::Npy))),
        (b"CDF\x01", Some(Found::Scan(Format::NetCdf3))),
        (b"CDF\x02\0\0", Some(Found::Scan(Format::NetCdf3))),
        (b"CDF\x05", Some(Found::Scan(Format::NetCdf3))),
        (b"CDF\x03", None),
        (b"PK\x03\x04", Some(Found::Scan(Format::X3p))),
        (b"\x89HDF\r\n\x1a\n", Some(Found::Hdf5)),
        (b"1.0 2.0\r\n", Some(Found::Scan(Format::Text))),
        ("# Width: 10 µm\n".as_bytes(), Some(Found::Scan(Format::Text))),
        (b"# Width: 10 \xb5m\n", Some(Found::Scan(Format::Text))),
        (b"1\0 \x002\0", None),
        (b"\x7fELF\x02\x01", None),
        (b"", None),
    ] {
        assert_eq!(detect(bytes), found, "{bytes:?}");
    }
    // UTF-16 is known, and not read.
    for bytes in [&b"\xff\xfe1\0 \x002\0"[..], b"\xfe\xff\x001"] {
        assert!(matches!(detect(bytes), Some(Found::Foreign(_))), "{bytes:?}");
    }
}

#[test]
fn val_units_of_length() {
    for (unit, value) in [
        ("m", 1.0),
        ("mm", 1e-3),
        ("µm", 1e-6),
        ("μm", 1e-6),
        ("um", 1e-6),
        (" nm ", 1e-9),
        ("pm", 1e-12),
        ("Å", 1e-10),
        ("\u{212b}", 1e-10),
        ("A\u{30a}", 1e-10),
        ("A", 1e-10),
        ("angstrom", 1e-10),
        ("Angstroms", 1e-10),
        ("km", 1e3),
        ("in", 0.0254),
        ("inches", 0.0254),
        ("mil", 2.54e-5),
        ("MicroMeters", 1e-6),
        ("nanometre", 1e-9),
    ] {
        assert_eq!(metres(unit), Some(value), "{unit}");
    }
    for unit in ["V", "s", "a.u.", "", "M", "MM", "Nm", "rad", "deg", "m/s", "microvolts", "1"] {
        assert_eq!(metres(unit), None, "{unit}");
    }
    for unit in LENGTHS.split(", ").flat_map(|unit| unit.split(" or ")) {
        assert!(metres(unit).is_some(), "{unit}");
    }
}

#[test]
fn law_only_netcdf_has_names() {
    for format in [Format::Npy, Format::X3p, Format::Text] {
        let message = scan_of(b"1 2\n3 4\n", format, Some("heights")).unwrap_err();
        assert!(message.contains("one unnamed field") && message.contains(format.name()), "{message}");
    }
}

#[test]
fn law_what_is_no_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for format in [Format::Npy, Format::NetCdf3, Format::X3p, Format::Text] {
        assert!(read(folder.path(), format, &Asked::default()).unwrap_err().to_string().contains("it is a directory"));
        assert!(read(&folder.path().join("none"), format, &Asked::default()).unwrap_err().to_string().contains("No such file"));
        #[cfg(unix)]
        assert!(read("/dev/zero".as_ref(), format, &Asked::default()).unwrap_err().to_string().contains("not a regular file"));
        assert!(scan_of(b"", format, None).is_err());
    }
}
