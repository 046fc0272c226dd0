//! Matrices of text.

use hysteron::store::scan::{Format, Scan};
use ndarray::{Array2, array};

use super::{awkward, lines, refused, same, scan_of};

#[track_caller]
fn text(text: &str) -> Scan {
    scan_of(text.as_bytes(), Format::Text, None).unwrap()
}

const NAN: f64 = f64::NAN;

#[test]
fn law_every_separator_and_line_end_is_read() {
    let heights = awkward();
    for separator in [" ", "\t", ",", ";", ", ", " ; ", "   ", " \t "] {
        for end in ["\n", "\r\n"] {
            for last in ["", end, "\n \n\n"] {
                let rows: Vec<_> = heights
                    .rows()
                    .into_iter()
                    .map(|row| row.iter().map(|h| format!("{h:e}")).collect::<Vec<_>>().join(separator))
                    .collect();
                let scan = text(&format!("{}{last}", rows.join(end)));
                same(&lines(&scan), &heights);
                assert_eq!((scan.size_m, scan.unit, scan.periodic), (None, None, None));
            }
        }
    }
}

#[test]
fn val_missing_points() {
    same(&lines(&text("1 nan 2\nNaN -- 3\nBAD 4 -nan\n")), &array![[1.0, NAN, 2.0], [NAN, NAN, 3.0], [NAN, 4.0, NAN]]);
    same(&lines(&text("1,,2\n,3,nan\n")), &array![[1.0, NAN, 2.0], [NAN, 3.0, NAN]]);
    same(&lines(&text("1;;2\n;;\n 3 ; ;4\n")), &array![[1.0, NAN, 2.0], [NAN, NAN, NAN], [3.0, NAN, 4.0]]);
    same(&lines(&text("1\t\t2\n\t\t\n3\t4\t5\n")), &array![[1.0, NAN, 2.0], [NAN, NAN, NAN], [3.0, 4.0, 5.0]]);
    same(&lines(&text("\t\t\n3\t4\t5\n")), &array![[NAN, NAN, NAN], [3.0, 4.0, 5.0]]);
    same(&lines(&text("inf 1\n2 -inf\n")), &array![[NAN, 1.0], [2.0, NAN]]);
}

#[test]
fn law_separators_behind_every_line_are_no_column() {
    for separator in ["\t", ",", ";"] {
        let rows = ["1", "2", "3", "4"].map(|number| format!("{number}{separator}"));
        same(&lines(&text(&format!("{0}{1}\n{2}{3} \n", rows[0], rows[1], rows[2], rows[3]))), &array![[1.0, 2.0], [3.0, 4.0]]);
    }
    // Behind one only, it is a point that is missing.
    same(&lines(&text("1;2;\n3;4;5\n")), &array![[1.0, 2.0, NAN], [3.0, 4.0, 5.0]]);
}

#[test]
fn law_comments_are_passed_over() {
    let scan = text("\u{feff}# a: b\n% c\n// d\n   # e\n1 2\n# between\n3 4\n// behind");
    same(&lines(&scan), &array![[1.0, 2.0], [3.0, 4.0]]);
    same(&lines(&text("title: something\nh=2 w=2\n1 2\n3 4\n")), &array![[1.0, 2.0], [3.0, 4.0]]);
}

#[test]
fn val_headings_of_gwyddion() {
    for unit in ["µm", "μm", "um"] {
        let heading = format!("# Channel: Main\n# Width: 10 {unit}\n# Height: 5.5 {unit}\n# Value units: nm\n");
        let scan = text(&format!("{heading}1 2\n3 4\n5 6\n"));
        same(&lines(&scan), &(array![[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]] * 1e-9));
        assert_eq!(scan.size_m, Some([10.0 * 1e-6, 5.5 * 1e-6]));
        assert_eq!(scan.unit.as_deref(), Some("nm"));
    }
    // Latin-1.
    let scan = scan_of(b"# Width: 1 \xb5m\n# Height: 2 \xb5m\n1 2\n", Format::Text, None).unwrap();
    assert_eq!((scan.size_m, scan.unit), (Some([1e-6, 2e-6]), None));
    // Without a unit of its own, a size has that of the heights; without any, it is not known.
    assert_eq!(text("# Width: 1\n# Height: 2\n# Value units: m\n1 2\n").size_m, Some([1.0, 2.0]));
    assert_eq!(text("# Width: 1\n# Height: 2\n1 2\n").size_m, None);
    assert_eq!(text("# x-length = 10\n# y-length = 20\n# x-unit = nm\n# z-unit = [m]\n1 2\n").size_m, Some([10.0 * 1e-9, 20.0 * 1e-9]));
    // A remark is none.
    assert_eq!(text("# Width: as drawn\n# Height: see above\n1 2\n").size_m, None);
}

#[test]
fn val_headings_with_pixels_and_factors() {
    let heading = "h=3 w=2\npixel size=3.69862e-007 m\ndata unit=rad\nheight conversion factor (-> m)=2.91818e-008\n";
    let scan = text(&format!("{heading}1 2 \n3 4 \n5 6 \n"));
    same(&lines(&scan), &(array![[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]] * 2.91818e-8));
    assert_eq!(scan.size_m, Some([3.69862e-7 * 2.0, 3.69862e-7 * 3.0]));
    assert_eq!(scan.unit.as_deref(), Some("m"));
    let scan = text("# height conversion factor (-> A) = 2\n1 2\n");
    same(&lines(&scan), &(array![[1.0, 2.0]] * (1e-10 * 2.0)));
}

#[test]
fn law_every_bad_text_has_its_sentence() {
    for (text, parts) in [
        ("1 2\n3\n", vec!["its line 2: 1 numbers, but the previous lines have 2"]),
        ("1 2\n\n# x\n3 4 5\n", vec!["its line 4: 3 numbers"]),
        ("1 2\n3 x\n", vec!["its line 2: column 2: \"x\" is not a number", "help: write numbers, and nan"]),
        ("x y h\n1 2 3\n", vec!["all values of x are 1"]),
        ("1 x\n2 3\n", vec!["its line 1: column 2: \"x\" is not a number"]),
        ("1e999 2\n", vec!["\"1e999\" is not a finite number"]),
        ("1 2\r3 4\r", vec!["CR only"]),
        ("# nothing\n\n", vec!["no line of numbers"]),
        ("# Value units: V\n1 2\n", vec!["its heights are in \"V\", not a known unit of length", "use one of km, m, mm, µm or um, nm"]),
        ("# Value units: a.u.\n1 2\n", vec!["\"a.u.\""]),
        ("# Width: 10 s\n# Height: 10 s\n1 2\n", vec!["its size is in \"s\""]),
        ("# Width: 0 m\n# Height: 1 m\n1 2\n", vec!["a size of 0 m, which must be positive"]),
        ("h=3 w=2\n1 2\n3 4\n", vec!["its heading says that it has 3 lines, and it has 2"]),
        ("h=2 w=3\n1 2\n3 4\n", vec!["it has 3 values in a line, and it has 2"]),
        ("# Channel: A\n1 2\n# Channel: B\n3 4\n", vec!["its line 3: \"Channel\" is said twice"]),
        ("# height conversion factor (-> V)=2\n1 2\n", vec!["its heights are in \"V\""]),
        ("# height conversion factor (-> m)=0\n1 2\n", vec!["multiplied by 0"]),
    ] {
        refused(text.as_bytes(), Format::Text, &parts);
    }
    refused(&[0xff; 50], Format::Text, &["no line of numbers"]);
}

#[test]
fn law_long_files_are_whole() {
    let heights = Array2::from_shape_fn((401, 307), |(row, column)| (row * 1000 + column) as f64 / 7.0);
    let rows: Vec<_> = heights.rows().into_iter().map(|row| row.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")).collect();
    same(&lines(&text(&rows.join("\n"))), &heights);
}
