//! Arrays of NumPy.
// One macro reads every kind of number, and of some a cast loses nothing.
#![allow(clippy::cast_lossless)]

use hysteron::store::scan::{Format, MOST_POINTS};
use ndarray::{Array2, ShapeBuilder, array};

use super::make::{little, npy, npy_line};
use super::{awkward, lines, refused, same, scan_of};

#[test]
fn law_every_version_and_order_is_read_to_the_bit() {
    let heights = awkward();
    for version in [1, 2, 3] {
        let bytes = npy(version, &npy_line("<f8", "False", "(3, 5)"), &little(&heights));
        let scan = scan_of(&bytes, Format::Npy, None).unwrap();
        same(&lines(&scan), &heights);
        assert_eq!((scan.size_m, scan.unit, scan.periodic), (None, None, None));
        assert!(scan.heights.is_standard_layout());
        let bytes = npy(version, &npy_line("<f8", "True", "(3, 5)"), &little(heights.t()));
        let scan = scan_of(&bytes, Format::Npy, None).unwrap();
        same(&lines(&scan), &heights);
        assert!(scan.heights.is_standard_layout());
    }
}

#[test]
fn law_fields_larger_than_a_part_are_whole() {
    let heights = Array2::from_shape_fn((191, 203), |(row, column)| (row * 1000 + column) as f64);
    for (fortran, data) in [("False", little(&heights)), ("True", little(heights.t()))] {
        let scan = scan_of(&npy(1, &npy_line("<f8", fortran, "(191, 203)"), &data), Format::Npy, None).unwrap();
        same(&lines(&scan), &heights);
    }
}

#[test]
fn val_every_kind_of_number() {
    macro_rules! kinds {
        ($($word:literal $kind:ty: $($value:expr),+;)+) => {$(
            let values: Vec<$kind> = vec![$($value),+];
            let expected = Array2::from_shape_vec((1, values.len()), values.iter().map(|value| *value as f64).collect()).unwrap();
            let shape = format!("(1, {})", values.len());
            for sign in if $word.ends_with('1') { vec!["|", "<", ">"] } else { vec!["<", ">"] } {
                let bytes: Vec<u8> = values.iter().flat_map(|value| if sign == ">" { value.to_be_bytes() } else { value.to_le_bytes() }).collect();
                let file = npy(1, &npy_line(&format!("{sign}{}", $word), "False", &shape), &bytes);
                same(&lines(&scan_of(&file, Format::Npy, None).unwrap()), &expected);
            }
        )+};
    }
    kinds! {
        "f8" f64: 1.5, -0.0, f64::NAN, f64::INFINITY, 5e-324;
        "f4" f32: 1.5, -0.0, f32::NAN, f32::INFINITY, 1e-45, 0.1;
        "i1" i8: -128, -1, 0, 127;
        "i2" i16: i16::MIN, -2, 258, i16::MAX;
        "i4" i32: i32::MIN, -3, 66051, i32::MAX;
        "i8" i64: i64::MIN, -4, 1 << 40, i64::MAX;
        "u1" u8: 0, 1, 255;
        "u2" u16: 0, 258, u16::MAX;
        "u4" u32: 0, 66051, u32::MAX;
        "u8" u64: 0, 1 << 40, u64::MAX;
    }
}

#[test]
fn law_lines_are_read_however_python_writes_them() {
    let heights = array![[1.0, 2.0], [3.0, 4.0]];
    for line in [
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2)}",
        "{\"shape\": (2,2,), \"fortran_order\":False,\"descr\":\"<f8\"}\n",
        "  { 'shape' : ( 2L , 2L ) , 'descr' : '<f8' , 'fortran_order' : False , }  \n",
    ] {
        same(&lines(&scan_of(&npy(1, line, &little(&heights)), Format::Npy, None).unwrap()), &heights);
    }
}

#[test]
fn law_every_bad_header_has_its_sentence() {
    let data = little(&array![[1.0, 2.0], [3.0, 4.0]]);
    let most = MOST_POINTS + 1;
    for (line, parts) in [
        (npy_line("<f8", "False", "(2, 2, 1)"), vec!["3 dimensions instead of 2"]),
        (npy_line("<f8", "False", "(4,)"), vec!["1 dimension instead of 2"]),
        (npy_line("<f8", "False", "()"), vec!["0 dimensions instead of 2"]),
        (npy_line("<f8", "False", "(2, 3)"), vec!["2 by 3 numbers", "bytes"]),
        (npy_line("<f8", "False", "(1, 2)"), vec!["1 by 2 numbers"]),
        (npy_line("<f8", "False", "(0, 2)"), vec!["0 by 2 points", "no surface"]),
        (npy_line("<f8", "False", &format!("(1, {most})")), vec!["268435457", "268435456"]),
        (npy_line("<f8", "False", "(4294967296, 4294967296)"), vec!["a surface may have"]),
        (npy_line("<f8", "False", "(18446744073709551616, 1)"), vec!["18446744073709551616"]),
        (npy_line("<f8", "False", "(-2, 2)"), vec!["shape"]),
        (npy_line("<f8", "False", "(2, 2"), vec!["damaged"]),
        (npy_line("<f8", "0", "(2, 2)"), vec!["neither True nor False"]),
        (npy_line("<c16", "False", "(2, 2)"), vec!["<c16", "use one of f4, f8"]),
        (npy_line("|b1", "False", "(2, 2)"), vec!["|b1"]),
        (npy_line("|f8", "False", "(2, 2)"), vec!["|f8"]),
        (npy_line("=f8", "False", "(2, 2)"), vec!["=f8"]),
        (npy_line("", "False", "(2, 2)"), vec!["help: use one of"]),
        (npy_line("µ", "False", "(2, 2)"), vec!["help: use one of"]),
        ("{'descr': [('h', '<f8')], 'fortran_order': False, 'shape': (2, 2), }".to_owned(), vec!["structured array with named fields"]),
        ("{'descr': '<f8', 'shape': (2, 2), }".to_owned(), vec!["lacks one of"]),
        ("{'order': 'C', }".to_owned(), vec!["unknown entry \"order\" in the header\nhelp: expected descr, fortran_order, shape"]),
        ("{'descr': '<f8".to_owned(), vec!["has no end"]),
        (format!("{} x", npy_line("<f8", "False", "(2, 2)")), vec!["unexpected text after the dictionary"]),
        (String::new(), vec!["'{' is missing"]),
    ] {
        refused(&npy(1, &line, &data), Format::Npy, &parts);
        refused(&npy(3, &line, &data), Format::Npy, &parts);
    }
    let good = npy_line("<f8", "False", "(2, 2)");
    refused(&npy(4, &good, &data), Format::Npy, &["version 4", "use version 1, 2 or 3"]);
    refused(&npy(1, &good, &[data.as_slice(), &[0]].concat()), Format::Npy, &["need 112"]);
    // The length of the header is a lie.
    let mut bytes = npy(2, &good, &data);
    bytes[8..12].copy_from_slice(&u32::MAX.to_le_bytes());
    refused(&bytes, Format::Npy, &["ends within the header of 4294967295 bytes"]);
    let long = npy(2, &format!("{good}{}", " ".repeat(1 << 16)), &data);
    refused(&long, Format::Npy, &["limit 65536"]);
    let mut bytes = npy(1, &good, &data);
    bytes[20] = 0xff;
    refused(&bytes, Format::Npy, &["not UTF-8 text"]);
}

#[test]
fn law_columns_of_fortran_are_the_same_as_of_ndarray() {
    let values: Vec<f64> = (0..12).map(f64::from).collect();
    let expected = Array2::from_shape_vec((3, 4).f(), values.clone()).unwrap();
    let scan = scan_of(&npy(1, &npy_line("<f8", "True", "(3, 4)"), &little(&values)), Format::Npy, None).unwrap();
    same(&lines(&scan), &expected.as_standard_layout().into_owned());
}
