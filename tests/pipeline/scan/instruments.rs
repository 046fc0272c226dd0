//! Text as instruments and their programs export it.

use hysteron::store::scan::{Asked, Format, Scan, read};
use ndarray::{Array2, array, s};

use super::{refused, same, scan_of};

#[track_caller]
fn text(text: &str) -> Scan {
    scan_of(text.as_bytes(), Format::Text, None).unwrap()
}

fn asked(text: &str, asked: &Asked<'_>) -> Result<Scan, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.txt");
    std::fs::write(&path, text).unwrap();
    read(&path, Format::Text, asked).map_err(|error| error.to_string())
}

/// Heights of 6 by 4 places, along x and y, and their lines of x, y and z.
fn places() -> (Array2<f64>, Vec<String>) {
    let heights = Array2::from_shape_fn((6, 4), |(i, j)| (i * 10 + j) as f64);
    let lines = heights.indexed_iter().map(|((i, j), z)| format!("{}\t{}\t{z}", 0.5 * i as f64, 0.25 * j as f64)).collect();
    (heights, lines)
}

#[track_caller]
fn has_size(scan: &Scan, size: [f64; 2]) {
    let found = scan.size_m.expect("no size");
    // The unit and the number of points are multiplied in any order.
    assert!(found.iter().zip(size).all(|(found, size)| (found / size - 1.0).abs() < 1e-12), "{found:?} and {size:?}");
}

#[test]
fn law_a_line_of_a_matrix_runs_along_x() {
    let scan = text("# Width: 3 um\n# Height: 2 um\n1 2 3\n4 5 6\n");
    same(&scan.heights, &array![[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]);
    has_size(&scan, [3e-6, 2e-6]);
}

#[test]
fn law_places_without_a_line_are_missing_points() {
    let (heights, lines) = places();
    // A point, a corner, some points of a line of the grid, and a whole line of it.
    for gone in [vec![9], vec![0], vec![4, 5, 7, 23], vec![8, 9, 10, 11], vec![2, 6, 10, 14, 18, 22]] {
        let kept: Vec<&str> = lines.iter().enumerate().filter(|(at, _)| !gone.contains(at)).map(|(_, line)| line.as_str()).collect();
        let mut expected = heights.clone();
        for place in &gone {
            expected[[place / 4, place % 4]] = f64::NAN;
        }
        let scan = text(&kept.join("\n"));
        same(&scan.heights, &expected);
        assert_eq!(scan.spacing, Some([0.5, 0.25]), "{gone:?}");
        let count = if gone.len() == 1 { "1 point".to_owned() } else { format!("{} points", gone.len()) };
        assert_eq!(scan.notes, [format!("{count} of the grid without a line, taken as missing")]);
    }
    // Coordinates that are rounded, a tenth of them gone.
    let fine = |i: usize| format!("{:.3}", i as f64 * 0.0195);
    let rounded: Vec<String> = (0..40 * 40).filter(|at| at % 10 != 3).map(|at| format!("{} {} 1", fine(at / 40), fine(at % 40))).collect();
    assert_eq!(text(&rounded.join("\n")).heights.dim(), (40, 40));
    // Where more than half of the places are empty, the points are scattered.
    let few: Vec<&str> = lines.iter().step_by(5).chain(&lines[1..13]).map(String::as_str).take(16).collect();
    assert!(few.len() == 16);
    let scattered: Vec<String> = (0..40).map(|k| format!("{k} {} {k}", 7 * k % 40)).collect();
    refused(scattered.join("\n").as_bytes(), Format::Text, &["40 by 40 places of a grid need 1600 lines, and it has 40"]);
}

#[test]
fn val_headings_of_columns_name_them_and_their_units() {
    let (heights, lines) = places();
    for heading in [
        "X [um]\tY [um]\tZ [nm]",
        "X [um] Y [um] Z [nm]",
        "x(um);y(um);Height(nm)",
        "# x/um y/um z/nm",
        "\"X (\u{b5}m)\",\"Y (\u{b5}m)\",\"Height (nm)\"",
        "X\tY\tZ\num\tum\tnm",
        "Exported by a program\n\nX position [um]\tY position [um]\tTopography [nm]",
    ] {
        let scan = text(&format!("{heading}\n{}\n", lines.join("\n")));
        same(&scan.heights, &(&heights * 1e-9));
        has_size(&scan, [3e-6, 1e-6]);
        assert_eq!(scan.unit.as_deref(), Some("nm"), "{heading}");
    }
    // Other columns, in another order.
    let rows: Vec<String> = heights.indexed_iter().map(|((i, j), z)| format!("{z};7;{};{}", 0.25 * j as f64, 0.5 * i as f64)).collect();
    let scan = text(&format!("z [nm];Intensity;y [um];x [um]\n{}\n", rows.join("\n")));
    same(&scan.heights, &(&heights * 1e-9));
    has_size(&scan, [3e-6, 1e-6]);
}

#[test]
fn val_one_column_has_a_stated_width() {
    let numbers: Vec<String> = (0..24).map(|at| format!("{at}.5")).collect();
    let expected = Array2::from_shape_fn((4, 6), |(x, y)| (y * 4 + x) as f64 + 0.5);
    let of_four = Asked { width: Some(4), ..Asked::default() };
    for (heading, separator) in [("Height_Sensor(nm)\n", "\n"), ("Height (nm)\r\n", "\r\n"), ("# Value units: nm\n", "\n\n")] {
        let scan = asked(&format!("{heading}{}\n", numbers.join(separator)), &of_four).unwrap();
        same(&scan.heights, &(&expected * 1e-9));
    }
    // Decimal commas, lines of other lengths, and a width in the heading.
    same(&asked(&numbers.join("\n").replace('.', ","), &of_four).unwrap().heights, &expected);
    same(&asked(&format!("{}\n{}\n", numbers[..10].join(" "), numbers[10..].join(" ")), &of_four).unwrap().heights, &expected);
    same(&text(&format!("x-pixels = 4\ny-pixels = 6\n{}\n", numbers.join("\n"))).heights, &expected);
    let message = asked(&numbers.join("\n"), &Asked { width: Some(5), ..Asked::default() }).unwrap_err();
    assert!(message.contains("24 numbers are no whole number of lines of 5 points\nhelp: "), "{message}");
    let square = (0..25).map(|at| at.to_string()).collect::<Vec<_>>().join("\n");
    refused(square.as_bytes(), Format::Text, &["one column of 25 numbers", "(--width); 25 = 5 x 5"]);
}

#[test]
fn val_decimal_commas_are_read() {
    let expected = array![[1.5, -3.0], [2.25, 40.0]];
    for lines in [
        "1,5;2,25\n-3,0;4,0e1\n",
        "1,5\t2,25\n-3\t40\n",
        "1,5 2,25\n-3,0 40,0\n",
        "\"1,5\",\"2,25\"\n\"-3,0\",\"40\"\n",
        "1,5;2,25;\n-3,0;40,0;\n",
    ] {
        let scan = text(lines);
        same(&scan.heights, &expected);
        assert_eq!(scan.notes, ["decimal commas"], "{lines}");
    }
    same(&text("1,5;;nan\n2,5;--;3,5\n").heights, &array![[1.5, 2.5], [f64::NAN, f64::NAN], [f64::NAN, 3.5]]);
    has_size(&text("# Breite: 10,00 \u{b5}m\n# H\u{f6}he: 5,5 \u{b5}m\n1,5;2\n"), [1e-5, 5.5e-6]);
    for bad in ["1,5;2.5\n", "1.5;2\n3,5;4\n", "1.234,5;2\n", "1,234.5;2\n", "1,2,3;4\n"] {
        refused(bad.as_bytes(), Format::Text, &["\nhelp: "]);
    }
    refused(b"# Width: 1,000 um\n1 2\n", Format::Text, &["may be a decimal comma or separate thousands"]);
}

#[test]
fn val_exports_of_profilers_are_read() {
    let expected = array![[1.5, 4.0], [2.5, f64::NAN], [3.5, 6.0]] * 1e-9;
    let rows = "\"1.5\",\"2.5\",\"3.5\"\n\"4\",\"\",\"6\"\n";
    for heading in [
        "\"Measurement Data Type\",\"Height\"\n\"Pitch X\",\"500\",\"nm\"\n\"Size\",\"3\",\"2\"\n\"Unit\",\"nm\"\n",
        "\"Date\",\"2026/11/28 10:00\"\n\"XY Calibration\",\"0.5\",\"um\"\n\"Horizontal\",\"3\"\n\"Vertical\",\"2\"\n\"Unit\",\"nm\"\n",
        "Pixel Size,0.5,um\nZ Unit,nm\n",
        "X Pitch;500;nm\nY Pitch;500;nm\nHeight Unit;nm\n",
    ] {
        let scan = text(&format!("{heading}{rows}"));
        same(&scan.heights, &expected);
        has_size(&scan, [1.5e-6, 1e-6]);
    }
    refused(format!("\"Size\",\"3\",\"4\"\n{rows}").as_bytes(), Format::Text, &["says that it has 4 lines, and it has 2"]);
}

#[test]
fn law_lines_before_the_numbers_are_skipped_or_told() {
    let skipping = |skip_lines| Asked { skip_lines, ..Asked::default() };
    let file = "512 points of a program\n17 4\n1 2 3\n4 5 6\n";
    same(&asked(file, &skipping(2)).unwrap().heights, &array![[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]);
    let message = asked(file, &skipping(0)).unwrap_err();
    assert!(message.contains("\"points\" is not a number\nhelp: ") && message.contains("--skip-lines"), "{message}");
    let message = asked(file, &skipping(1)).unwrap_err();
    assert!(message.contains("3 numbers, but the previous lines have 2\nhelp: ") && message.contains("--skip-lines"), "{message}");
    assert!(asked(file, &skipping(9)).unwrap_err().contains("no line of numbers"));
    assert_eq!(text("A program\nVersion 3\n1 2 3\n4 5 6\n").notes, ["2 lines before the numbers, read as a heading"]);
}

#[test]
fn law_spectra_and_line_scans_are_named() {
    let spectrum = |columns: usize| -> String {
        let row = |k: f64| [format!("{:e}", 1e5 * k), format!("{:e}", 1e-20 / k.powi(3)), "1e-22".to_owned()][..columns].join(" ");
        (1..40).map(|k| row(f64::from(k)) + "\n").collect()
    };
    for file in
        [spectrum(2), format!("q (1/m),C (m^4)\n{}", spectrum(2).replace(' ', ",")), format!("# wavevector PSD error\n{}", spectrum(3))]
    {
        refused(file.as_bytes(), Format::Text, &["looks like a power spectral density", "\nhelp: "]);
    }
    let scan: String = (0..40).map(|k| format!("{k} {}\n", k * k % 7)).collect();
    refused(scan.as_bytes(), Format::Text, &["two columns are a line scan", "\nhelp: "]);
}

/// A heading is read by a loop: its length does not count on the stack, of which a thread of a run has 2 MiB.
#[test]
fn law_a_long_heading_is_read() {
    let file = format!("# {}\n1 2\n3 4\n", "h=1 w=".repeat(200_000));
    let thread = std::thread::Builder::new()
        .stack_size(1 << 18)
        .spawn(move || scan_of(file.as_bytes(), Format::Text, None).map(|scan| scan.heights.dim()));
    let answer = thread.unwrap().join().expect("the stack is exhausted");
    assert!(answer.unwrap_err().contains("says that it has 1 lines"));
    let blanks = format!("# {}\n1 2\n3 4\n", "h= w= x: ".repeat(100_000));
    assert_eq!(text(&blanks).heights.slice(s![0, ..]).to_vec(), [1.0, 3.0]);
}
