//! X3P.

use hysteron::store::scan::Format;
use ndarray::{Array2, array};
use zip::CompressionMethod::{Deflated, Stored};

use super::make::{archive, little, main_xml};
use super::{awkward, refused, same, scan_of};

const DOUBLE: &str = "<DataType>D</DataType>";

/// A file with this description and these numbers.
fn x3p(xml: &str, data: &[u8]) -> Vec<u8> {
    archive(&[("bindata/data.bin", data), ("main.xml", xml.as_bytes())], Deflated)
}

#[test]
fn law_lines_along_x_become_columns() {
    let heights = awkward();
    let xml = main_xml(["3", "5", "1"], DOUBLE, "");
    for method in [Stored, Deflated] {
        let bytes = archive(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", &little(heights.t()))], method);
        let scan = scan_of(&bytes, Format::X3p, None).unwrap();
        same(&scan.heights, &heights);
        assert_eq!(scan.size_m, Some([3.0 * 1.25e-7, 5.0 * 2.5e-7]));
        assert_eq!((scan.unit.as_deref(), scan.periodic), (Some("m"), None));
    }
}

#[test]
fn val_every_kind_of_number() {
    let size = ["1", "3", "1"];
    let short: Vec<u8> = [-32768_i16, 5, 32767].iter().flat_map(|value| value.to_le_bytes()).collect();
    let long: Vec<u8> = [i32::MIN, 5, i32::MAX].iter().flat_map(|value| value.to_le_bytes()).collect();
    let float: Vec<u8> = [0.1_f32, f32::NAN, -5.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let heights = |kind: &str, more: &str, data: &[u8]| {
        let xml = main_xml(size, &format!("<DataType>{kind}</DataType>{more}"), "");
        scan_of(&x3p(&xml, data), Format::X3p, None).unwrap().heights
    };
    same(&heights("I", "", &short), &array![[-32768.0, 5.0, 32767.0]]);
    same(&heights("I", "<Increment>0.5</Increment><Offset>2</Offset>", &short), &array![[-16382.0, 4.5, 16385.5]]);
    same(&heights("L", "<Increment>2</Increment>", &long), &array![[-4_294_967_296.0, 10.0, 4_294_967_294.0]]);
    same(&heights("F", "", &float), &array![[f64::from(0.1_f32), f64::NAN, -5.0]]);
    same(&heights("D", "<Offset> 1e-6 </Offset>", &little(&[0.0, f64::NAN, 1.0])), &array![[1e-6, f64::NAN, 1.000_001]]);
}

#[test]
fn law_points_that_are_not_valid_are_missing() {
    let heights = Array2::from_shape_fn((3, 4), |(row, column)| (10 * row + column) as f64);
    // The points 0, 4 and 9, along x first.
    let bits = [0b1110_1110_u8, 0b1111_1101];
    let xml = main_xml(["3", "4", "1"], DOUBLE, "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>");
    let parts = |bits: &[u8]| {
        let data = little(heights.t());
        archive(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", &data), ("bindata/valid.bin", bits)], Deflated)
    };
    let mut expected = heights.clone();
    for place in [0, 4, 9] {
        expected[[place % 3, place / 3]] = f64::NAN;
    }
    same(&scan_of(&parts(&bits), Format::X3p, None).unwrap().heights, &expected);
    refused(&parts(&bits[..1]), Format::X3p, &["\"bindata/valid.bin\" has 1 bytes instead of 2"]);
    refused(&x3p(&xml, &little(heights.t())), Format::X3p, &["names \"bindata/valid.bin\", which is missing"]);
}

#[test]
fn law_what_is_not_needed_may_lack_or_differ() {
    let heights = array![[1.0, 2.0], [3.0, 4.0]];
    let good = main_xml(["2", "2", "1"], DOUBLE, "");
    for xml in [
        good.replace("p:", ""),
        good.replace("xmlns:p", "xmlns:iso").replace("p:ISO", "iso:ISO"),
        good.replace("<ISO5436_2 ", "<ISO5436_2 xmlns=\"http://x.org\" "),
        good.replace("<AxisType>A</AxisType>", ""),
        good.replace("<Revision>ISO5436 - 2000</Revision>", ""),
        good.replace("bindata/data.bin", "./bindata/data.bin"),
        good.replace("bindata/data.bin", "\\bindata\\data.bin"),
        good.replace("<SizeX>2<", "<SizeX>\n 2 <"),
        format!("\u{feff}{good}"),
    ] {
        same(&scan_of(&x3p(&xml, &little(heights.t())), Format::X3p, None).unwrap().heights, &heights);
    }
    let unsized_ = good.replace("<Increment>2.5E-7</Increment>", "");
    assert_eq!(scan_of(&x3p(&unsized_, &little(heights.t())), Format::X3p, None).unwrap().size_m, None);
}

#[test]
fn law_every_bad_description_has_its_sentence() {
    let data = little(&[1.0, 2.0, 3.0, 4.0]);
    let good = main_xml(["2", "2", "1"], DOUBLE, "");
    for (from, to, parts) in [
        ("<SizeZ>1<", "<SizeZ>2<", vec!["2 layers instead of 1"]),
        ("<SizeX>2<", "<SizeX>3<", vec!["has 32 bytes instead of 48 as in main.xml"]),
        ("<SizeX>2<", "<SizeX>0<", vec!["0 by 2 points"]),
        ("<SizeX>2<", "<SizeX>-2<", vec!["SizeX is \"-2\""]),
        ("<SizeX>2<", "<SizeX>1000000000<", vec!["1000000000 by 2 points"]),
        ("<SizeX>2<", "<SizeX>18446744073709551615<", vec!["a surface may have 268435456"]),
        ("<SizeX>2<", "<SizeX>99999999999999999999<", vec!["instead of a number of points"]),
        ("<SizeX>2</SizeX>", "", vec!["main.xml has no SizeX"]),
        ("MatrixDimension", "ListDimension", vec!["no matrix in "]),
        ("DataLink>", "DataList>", vec!["heights stored in XML are not supported"]),
        ("bindata/data.bin", "bindata/other.bin", vec!["\"bindata/other.bin\", which is missing"]),
        ("bindata/data.bin", "", vec!["has no link to the heights"]),
        (">D<", ">X<", vec!["data type \"X\" of the heights\nhelp: expected I, L, F or D"]),
        ("<DataType>D</DataType>", "", vec!["expected I, L, F or D"]),
        ("<CX><AxisType>I<", "<CX><AxisType>A<", vec!["axis CX are not evenly spaced"]),
        ("<CX><AxisType>I<", "<CX><AxisType>Q<", vec!["type \"Q\" of axis CX\nhelp: expected I"]),
        ("1.25e-007", "0", vec!["axis CX are 0 m apart"]),
        ("1.25e-007", "1,25e-7", vec!["Increment of CX is \"1,25e-7\""]),
        ("CZ>", "CW>", vec!["no axis CZ"]),
        ("CY>", "CW>", vec!["no axis CY"]),
        ("Axes>", "Axis>", vec!["describes no axes"]),
        ("</Record3>", "", vec!["main.xml is damaged"]),
    ] {
        assert!(good.contains(from), "{from}");
        refused(&x3p(&good.replace(from, to), &data), Format::X3p, &parts);
    }
    refused(&archive(&[("heights.npy", &data)], Stored), Format::X3p, &["zip archive without main.xml"]);
    refused(&archive(&[("main.xml", b"\xff\xfe")], Stored), Format::X3p, &["not in UTF-8"]);
    refused(b"PK\x03\x04 and nothing", Format::X3p, &["damaged zip archive"]);
    let entity = good.replace("<p:ISO", "<!DOCTYPE a [<!ENTITY b \"c\">]><p:ISO");
    refused(&x3p(&entity, &data), Format::X3p, &["main.xml is damaged"]);
}

#[test]
fn law_bombs_do_not_go_off() {
    // A description of 32 MiB, one of many elements, one of many remarks, and some that are deep.
    let described = |xml: &str| archive(&[("main.xml", xml.as_bytes())], Deflated);
    refused(&described(&" ".repeat(1 << 25)), Format::X3p, &["main.xml has more than 16777216 bytes"]);
    refused(&described(&format!("<a>{}</a>", "<b/>".repeat(1 << 20))), Format::X3p, &["more than 256 elements"]);
    refused(&described(&format!("<a>{}</a>", "<!---->".repeat(1 << 20))), Format::X3p, &["main.xml is damaged: nodes limit reached"]);
    let deep = |depth: usize| described(&format!("{}{}", "<a>".repeat(depth), "</a>".repeat(depth)));
    refused(&deep(1 << 20), Format::X3p, &["more than 256 elements"]);
    refused(&deep(256), Format::X3p, &["describes no axes"]);
    // Numbers of which the archive says that there are more than what takes their place can make.
    let xml = main_xml(["16384", "16384", "1"], DOUBLE, "");
    let mut bytes = archive(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", &[0; 32])], Deflated);
    refused(&bytes, Format::X3p, &["has 32 bytes instead of 2147483648 as in main.xml"]);
    // The size stands in the directory at the end.
    let place = bytes.windows(4).rposition(|window| window == b"PK\x01\x02").unwrap() + 24;
    assert_eq!(bytes[place], 32);
    bytes[place..place + 4].copy_from_slice(&0x8000_0000_u32.to_le_bytes());
    refused(&bytes, Format::X3p, &["claims 2147483648 bytes, which a file of its size cannot hold"]);
    // And of which it says that there are fewer.
    let xml = main_xml(["2", "2", "1"], DOUBLE, "");
    let mut bytes = archive(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", &[0; 40])], Deflated);
    let place = bytes.windows(4).rposition(|window| window == b"PK\x01\x02").unwrap() + 24;
    bytes[place] = 32;
    refused(&bytes, Format::X3p, &["\"bindata/data.bin\""]);
}

#[test]
fn law_one_top_folder_is_read() {
    let heights = array![[1.0, 2.0], [3.0, 4.0]];
    let (xml, data) = (main_xml(["2", "2", "1"], DOUBLE, ""), little(heights.t()));
    for folder in ["logo/", "./logo/", "a b/", "logo\\"] {
        let [main, numbers, other] = ["main.xml", "bindata/data.bin", "md5checksum.hex"].map(|name| format!("{folder}{name}"));
        let parts: [(&str, &[u8]); 4] = [(folder.trim_end_matches('\\'), b""), (&numbers, &data), (&main, xml.as_bytes()), (&other, b"0")];
        same(&scan_of(&archive(&parts, Deflated), Format::X3p, None).unwrap().heights, &heights);
    }
    // What macOS puts beside it, and a description deeper down, are none.
    let parts: [(&str, &[u8]); 4] =
        [("__MACOSX/main.xml", b"x"), ("logo/main.xml", xml.as_bytes()), ("logo/bindata/data.bin", &data), ("logo/old/main.xml", b"x")];
    same(&scan_of(&archive(&parts, Stored), Format::X3p, None).unwrap().heights, &heights);
    // The root comes before a folder; two folders are two surfaces; a part of another folder is not there.
    let parts: [(&str, &[u8]); 3] = [("main.xml", xml.as_bytes()), ("bindata/data.bin", &data), ("b/main.xml", b"x")];
    same(&scan_of(&archive(&parts, Stored), Format::X3p, None).unwrap().heights, &heights);
    let two: [(&str, &[u8]); 2] = [("a/main.xml", xml.as_bytes()), ("b/main.xml", xml.as_bytes())];
    refused(&archive(&two, Stored), Format::X3p, &["2 X3P folders instead of one"]);
    let apart: [(&str, &[u8]); 2] = [("a/main.xml", xml.as_bytes()), ("bindata/data.bin", &data)];
    refused(&archive(&apart, Stored), Format::X3p, &["\"bindata/data.bin\", which is missing"]);
    refused(&archive(&[("a/b/main.xml", xml.as_bytes())], Stored), Format::X3p, &["zip archive without main.xml"]);
}

#[test]
fn law_parts_of_one_name_are_refused() {
    let (xml, data) = (main_xml(["2", "2", "1"], DOUBLE, ""), little(&[1.0, 2.0, 3.0, 4.0]));
    let other = little(&[4.0, 3.0, 2.0, 1.0]);
    // The writer refuses equal names, so that they are made equal afterwards, in the local headers and in the directory.
    let parts: [(&str, &[u8]); 3] = [("main.xml", xml.as_bytes()), ("bindata/data.bin", &data), ("bindata/datb.bin", &other)];
    let mut bytes = archive(&parts, Stored);
    while let Some(place) = bytes.windows(16).position(|window| window == b"bindata/datb.bin") {
        bytes[place + 11] = b'a';
    }
    refused(&bytes, Format::X3p, &["two parts"]);
    // Names that are the same path count as equal too.
    let parts: [(&str, &[u8]); 3] = [("main.xml", xml.as_bytes()), ("bindata/data.bin", &data), ("./bindata/data.bin", &other)];
    refused(&archive(&parts, Stored), Format::X3p, &["two parts named \"bindata/data.bin\""]);
}

/// The parser compares the attributes of an element with one another: these would take it hours.
#[test]
fn law_many_attributes_are_refused_before_parsing() {
    for count in [1025, 200_000, 1_000_000] {
        let mut xml = "<a".to_owned();
        (0..count).for_each(|k| xml += &format!(" a{k} =\n'>'"));
        refused(&archive(&[("main.xml", format!("{xml}/>").as_bytes())], Deflated), Format::X3p, &["more than 1024 attributes"]);
    }
    // Signs of equality in texts are none.
    let text = main_xml(["1", "1", "1"], DOUBLE, "").replace("<FeatureType>", &format!("<!-- {} --><FeatureType>", "= ".repeat(5000)));
    assert!(scan_of(&x3p(&text, &little(&[1.0])), Format::X3p, None).is_ok());
}
