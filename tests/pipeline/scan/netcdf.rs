//! Classic NetCDF, and what is exported as such.

use hysteron::store::scan::Format;
use hysteron::store::scan::export::write_netcdf3;
use ndarray::{Array2, array, s};

use super::make::{Cdf, Said, Variable, big};
use super::{awkward, refused, same, scan_of};

/// A file as SurfaceTopography writes it, in micrometres.
pub fn surface(version: u8) -> Cdf {
    let axis = |name, place, length: f64, points: usize| Variable {
        name,
        dimensions: vec![place],
        attributes: vec![
            ("length", Said::Double(length)),
            ("periodic", Said::Int(1)),
            ("unit", Said::Text("um")),
            ("_FillValue", Said::Int(999_999)),
        ],
        kind: 6,
        data: big(&vec![0.0; points]),
    };
    let heights = heights();
    Cdf {
        version,
        records: 0,
        dimensions: vec![("x", 2), ("y", 3)],
        variables: vec![
            axis("y", 1, 6.0, 3),
            Variable {
                name: "heights",
                dimensions: vec![0, 1],
                attributes: vec![("missing_value", Said::Int(999_999)), ("_FillValue", Said::Int(999_999)), ("unit", Said::Text("um"))],
                kind: 6,
                data: big(&heights),
            },
            axis("x", 0, 4.0, 2),
        ],
    }
}

fn heights() -> Array2<f64> {
    array![[1.0, -2.0, 0.1], [999_999.0, f64::NAN, 9.969_209_968_386_869e36]]
}

fn at<'a>(cdf: &'a mut Cdf, name: &str) -> &'a mut Variable {
    cdf.variables.iter_mut().find(|variable| variable.name == name).unwrap()
}

#[test]
fn law_every_version_is_read() {
    for version in [1, 2, 5] {
        let scan = scan_of(&surface(version).bytes(), Format::NetCdf3, None).unwrap();
        same(&scan.heights, &array![[1e-6, -2e-6, 0.1 * 1e-6], [f64::NAN, f64::NAN, 9.969_209_968_386_869e36 * 1e-6]]);
        assert_eq!(scan.size_m, Some([4.0 * 1e-6, 6.0 * 1e-6]));
        assert_eq!(scan.unit.as_deref(), Some("um"));
        assert_eq!(scan.periodic, Some(true));
    }
}

#[test]
fn law_what_is_not_said_is_not_known() {
    let mut cdf = surface(2);
    at(&mut cdf, "x").attributes.clear();
    at(&mut cdf, "y").attributes.clear();
    at(&mut cdf, "heights").attributes.clear();
    let scan = scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap();
    assert_eq!((scan.size_m, scan.unit, scan.periodic), (None, None, None));
    assert_eq!(scan.heights[[1, 0]], 999_999.0);
    // NetCDF's own value for what was never written.
    assert!(scan.heights[[1, 2]].is_nan());
    cdf.variables.retain(|variable| variable.name == "heights");
    same(&scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap().heights, &scan.heights);
    // A length without any unit is no size.
    let mut cdf = surface(2);
    for variable in &mut cdf.variables {
        variable.attributes.retain(|(name, _)| *name != "unit");
    }
    let scan = scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap();
    assert_eq!((scan.size_m, scan.unit, scan.periodic), (None, None, Some(true)));
}

#[test]
fn law_units_hold_where_they_are_said() {
    let mut cdf = surface(2);
    at(&mut cdf, "heights").attributes = vec![("unit", Said::Text("nm"))];
    let scan = scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap();
    assert_eq!((scan.heights[[0, 0]], scan.size_m), (1e-9, Some([4.0 * 1e-6, 6.0 * 1e-6])));
    // Heights without a unit have that of x, as SurfaceTopography has it.
    at(&mut cdf, "heights").attributes.clear();
    assert_eq!(scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap().heights[[0, 0]], 1e-6);
    at(&mut cdf, "heights").attributes = vec![("unit", Said::Text("V"))];
    refused(&cdf.bytes(), Format::NetCdf3, &["the heights are in \"V\"", "use one of km, m"]);
    let mut cdf = surface(2);
    at(&mut cdf, "y").attributes = vec![("length", Said::Double(1.0)), ("unit", Said::Text("s"))];
    refused(&cdf.bytes(), Format::NetCdf3, &["the size along \"y\" is in \"s\""]);
    at(&mut cdf, "y").attributes = vec![("length", Said::Double(-1.0)), ("periodic", Said::Int(0))];
    refused(&cdf.bytes(), Format::NetCdf3, &["-1 um, and must be positive"]);
    at(&mut cdf, "y").attributes[0].1 = Said::Double(1.0);
    assert_eq!(scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap().periodic, Some(false));
}

#[test]
fn law_masks_and_scales_hold() {
    let mut cdf = surface(2);
    at(&mut cdf, "heights").attributes = vec![("scale_factor", Said::Double(2.0)), ("add_offset", Said::Double(1.0))];
    cdf.variables.push(Variable { name: "mask", dimensions: vec![0, 1], attributes: vec![], kind: 1, data: vec![0, 1, 0, 0, 0, 255] });
    let scan = scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap();
    same(&scan.heights, &array![[3.0 * 1e-6, f64::NAN, 1.2 * 1e-6], [1_999_999.0 * 1e-6, f64::NAN, f64::NAN]]);
    at(&mut cdf, "mask").dimensions = vec![0];
    refused(&cdf.bytes(), Format::NetCdf3, &["\"mask\" has other dimensions"]);
    at(&mut cdf, "mask").dimensions = vec![0, 1];
    at(&mut cdf, "mask").kind = 2;
    refused(&cdf.bytes(), Format::NetCdf3, &["\"mask\" is text"]);
}

#[test]
fn law_any_variable_can_be_asked_for() {
    let mut cdf = surface(5);
    for (name, kind, data, expected) in [
        ("bytes", 1, vec![255, 2, 3, 4, 5, 6], -1.0),
        ("shorts", 3, vec![255; 12], -1.0),
        ("ints", 4, vec![255; 24], -1.0),
        ("floats", 5, [0.5_f32.to_be_bytes(); 6].concat(), 0.5),
        ("ubytes", 7, vec![255; 6], 255.0),
        ("ushorts", 8, vec![254; 12], 65278.0),
        ("uints", 9, vec![254; 24], 4_278_124_286.0),
        ("longs", 10, vec![255; 48], -1.0),
        ("ulongs", 11, vec![254; 48], 18_374_403_900_871_474_942.0),
    ] {
        cdf.variables.push(Variable { name, dimensions: vec![0, 1], attributes: vec![("unit", Said::Text("m"))], kind, data });
        let scan = scan_of(&cdf.bytes(), Format::NetCdf3, Some(name)).unwrap();
        assert_eq!((scan.heights.dim(), scan.heights[[0, 0]]), ((2, 3), expected), "{name}");
        assert_eq!(scan.size_m, Some([4.0 * 1e-6, 6.0 * 1e-6]));
    }
    let message = scan_of(&cdf.bytes(), Format::NetCdf3, Some("height")).unwrap_err();
    assert!(message.contains("no variable \"height\"\nhelp: use one of \"heights\", \"bytes\""), "{message}");
    let message = scan_of(&cdf.bytes(), Format::NetCdf3, Some("x")).unwrap_err();
    assert!(message.contains("\"x\" has 1 dimensions instead of 2"), "{message}");
    at(&mut cdf, "heights").name = "z";
    refused(&cdf.bytes(), Format::NetCdf3, &["no variable \"heights\"", "\"z\""]);
}

#[test]
fn law_records_are_read_with_and_without_others() {
    for version in [1, 2, 5] {
        let heights = awkward().slice(s![.., ..3]).to_owned();
        let mut cdf = surface(version);
        (cdf.records, cdf.dimensions[0].1) = (3, 0);
        cdf.variables.retain(|variable| variable.name != "x");
        at(&mut cdf, "heights").data = big(&heights);
        at(&mut cdf, "heights").attributes.clear();
        at(&mut cdf, "y").attributes.clear();
        same(&scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap().heights, &heights);
        // Between the parts of the heights stands something of five bytes, and three to fill up.
        cdf.dimensions.push(("five", 5));
        cdf.variables.push(Variable { name: "other", dimensions: vec![0, 2], attributes: vec![], kind: 1, data: vec![9; 15] });
        same(&scan_of(&cdf.bytes(), Format::NetCdf3, None).unwrap().heights, &heights);
        let scan = scan_of(&cdf.bytes(), Format::NetCdf3, Some("other")).unwrap();
        assert!(scan.heights.dim() == (3, 5) && scan.heights.iter().all(|value| *value == 9.0));
        cdf.records = 0;
        refused(&cdf.bytes(), Format::NetCdf3, &["0 by 3 points"]);
    }
}

#[test]
fn law_every_bad_header_has_its_sentence() {
    let mut cdf = surface(2);
    cdf.dimensions[0].1 = 1 << 29;
    refused(&cdf.bytes(), Format::NetCdf3, &["536870912 by 3 points"]);
    cdf.dimensions[0].1 = 1 << 26;
    refused(&cdf.bytes(), Format::NetCdf3, &["claims 67108864 by 3 values"]);
    cdf.dimensions[0].1 = 3;
    refused(&cdf.bytes(), Format::NetCdf3, &["claims 3 by 3 values"]);
    let mut cdf = surface(2);
    cdf.dimensions[1].1 = 0;
    refused(&cdf.bytes(), Format::NetCdf3, &["2 by 0 points"]);
    let mut cdf = surface(2);
    at(&mut cdf, "heights").kind = 12;
    refused(&cdf.bytes(), Format::NetCdf3, &["unknown number type 12"]);
    at(&mut cdf, "heights").kind = 2;
    refused(&cdf.bytes(), Format::NetCdf3, &["\"heights\" is text"]);
    let mut cdf = surface(2);
    at(&mut cdf, "heights").dimensions = vec![0, 7];
    refused(&cdf.bytes(), Format::NetCdf3, &["dimension 7 of 2"]);
    at(&mut cdf, "heights").dimensions = vec![0; 2000];
    refused(&cdf.bytes(), Format::NetCdf3, &["2000 dimensions (limit 1024)"]);
    let mut bytes = surface(2).bytes();
    bytes[4..8].fill(0xff);
    refused(&bytes, Format::NetCdf3, &["was not closed"]);
    bytes[4..8].fill(0);
    bytes[8] = 7;
    refused(&bytes, Format::NetCdf3, &["the header is damaged: no list of dimensions"]);
    bytes[8] = 0;
    bytes[12..16].fill(0xff);
    refused(&bytes, Format::NetCdf3, &["4294967295 dimensions"]);
    refused(b"CDF\x04\0\0\0\0", Format::NetCdf3, &["does not begin as"]);
    refused(b"CDF\x01\0\0\0\0", Format::NetCdf3, &["ends within the header"]);
}

#[test]
fn law_what_is_exported_is_read_back_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("surface.nc");
    for heights in [awkward(), array![[7.0]], Array2::from_shape_fn((1, 3), |(_, column)| column as f64)] {
        for periodic in [true, false] {
            write_netcdf3(&path, heights.view(), [1e-5, 2.5e-6], periodic).unwrap();
            let bytes = std::fs::read(&path).unwrap();
            let scan = scan_of(&bytes, Format::NetCdf3, None).unwrap();
            same(&scan.heights, &heights);
            assert_eq!(scan.size_m, Some([1e-5, 2.5e-6]));
            assert_eq!((scan.unit.as_deref(), scan.periodic), (Some("m"), Some(periodic)));
        }
    }
    // A view that is not contiguous is written as it looks.
    let heights = awkward();
    write_netcdf3(&path, heights.t(), [1.0, 2.0], false).unwrap();
    same(&scan_of(&std::fs::read(&path).unwrap(), Format::NetCdf3, None).unwrap().heights, &heights.t().to_owned());
}

#[test]
fn law_what_cannot_be_exported_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("surface.nc");
    std::fs::write(&path, "before").unwrap();
    for (heights, size, part) in [
        (array![[1.0, f64::NAN]], [1.0, 1.0], "row 0, column 1 is NaN, and must be finite"),
        (array![[1.0]], [0.0, 1.0], "its size is 0 m, and must be positive"),
        (array![[1.0]], [1.0, f64::INFINITY], "inf m"),
        (Array2::zeros((0, 3)), [1.0, 1.0], "0 by 3 points"),
    ] {
        let message = write_netcdf3(&path, heights.view(), size, true).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
        assert_eq!(std::fs::read(&path).unwrap(), b"before");
    }
}
