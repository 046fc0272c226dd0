//! Text of x, y and z, line scans, and headings in German.

use hysteron::store::scan::{Format, Scan};
use ndarray::{Array2, array};

use super::{refused, same, scan_of};

#[track_caller]
fn text(text: &str) -> Scan {
    scan_of(text.as_bytes(), Format::Text, None).unwrap()
}

fn heights() -> Array2<f64> {
    Array2::from_shape_fn((5, 7), |(i, j)| (3 * i + j * j) as f64 / 7.0)
}

/// Lines of x, y and z, their order changed by a step that shares no factor with their number.
fn lines(heights: &Array2<f64>, [dx, dy]: [f64; 2], separator: &str, step: usize) -> Vec<String> {
    let all: Vec<String> = heights
        .indexed_iter()
        .map(|((i, j), h)| [-2.0 + dx * i as f64, 10.0 + dy * j as f64, *h].map(|value| value.to_string()).join(separator))
        .collect();
    (0..all.len()).map(|k| all[k * step % all.len()].clone()).collect()
}

#[test]
fn law_points_in_any_order_are_a_grid() {
    for separator in [" ", "\t", ",", ";"] {
        for step in [1, 2, 3, 34] {
            let scan = text(&lines(&heights(), [0.5, 0.25], separator, step).join("\n"));
            same(&scan.heights, &heights());
            assert_eq!((scan.size_m, scan.unit, scan.spacing), (None, None, Some([0.5, 0.25])));
        }
    }
    // With a line of words, and with a heading whose unit is that of all three.
    for words in ["x y z", "X,Y,Z", "\"x\";\"y\";\"z\""] {
        let small = array![[1.0, 2.0], [3.0, 4.0]];
        same(&text(&format!("{words}\n{}\n", lines(&small, [1.0, 1.0], " ", 3).join("\n"))).heights, &small);
    }
    let scan = text(&format!("# Value units: um\n{}", lines(&heights(), [0.5, 0.25], " ", 3).join("\n")));
    same(&scan.heights, &(heights() * 1e-6));
    assert_eq!(scan.size_m, Some([5.0 * 0.5 * 1e-6, 7.0 * 0.25 * 1e-6]));
    // Coordinates that are rounded to two digits, as instruments print them, and missing heights.
    let mut holed = heights();
    holed[[2, 3]] = f64::NAN;
    let rounded: Vec<String> = holed.indexed_iter().map(|((i, j), h)| format!("{:.2} {:.2} {h}", i as f64 / 3.0, j as f64 / 3.0)).collect();
    let scan = text(&rounded.join("\n"));
    same(&scan.heights, &holed);
    let [a, b] = scan.spacing.unwrap();
    // A third, to the last digit that is printed, over four and over six spacings.
    assert!((a - 1.33 / 4.0).abs() < 1e-12 && (b - 2.0 / 6.0).abs() < 1e-12, "{a} {b}");
}

#[test]
fn law_points_off_a_grid_are_told() {
    let good = lines(&heights(), [0.5, 0.25], " ", 1);
    let changed = |change: &dyn Fn(&mut Vec<String>)| {
        let mut lines = good.clone();
        change(&mut lines);
        lines.join("\n")
    };
    for (bad, parts) in [
        (changed(&|lines| lines[9] = lines[8].clone()), vec!["x = -1.5, y = 10.25 is there twice"]),
        (changed(&|lines| lines.push(lines[0].clone())), vec!["x = -2, y = 10 is there twice"]),
        (changed(&|lines| lines[14] = "-1.3 10 1".to_owned()), vec!["the 6 values of x are not evenly spaced"]),
        (changed(&|lines| lines[3] = "nan 10 1".to_owned()), vec!["a value of x is missing"]),
        ((0..40).map(|k| format!("{k} 1 {k}\n")).collect(), vec!["all values of y are 1"]),
        ((0..40).map(|k| format!("{} {} {k}\n", k * k, 7 * k % 40)).collect(), vec!["not evenly spaced"]),
        ((0..40).map(|k| format!("{k} {} {k}\n", 7 * k % 40)).collect(), vec!["40 by 40 places of a grid need 1600 lines, and it has 40"]),
        ((0..40).map(|k| format!("{k} {k}\n")).collect(), vec!["two columns are a line scan"]),
        ((0..40).map(|k| format!("{k}\n")).collect(), vec!["one column of 40 numbers"]),
    ] {
        refused(bad.as_bytes(), Format::Text, &[parts, vec!["\nhelp: "]].concat());
    }
}

#[test]
fn val_gwyddion_in_german() {
    let scan = text("# Kanal: Topographie\n# Breite: 10 µm\n# Höhe: 5.5 µm\n# Werteinheiten: nm\n1 2\n3 4\n");
    assert_eq!((scan.size_m, scan.unit.as_deref()), (Some([10.0 * 1e-6, 5.5 * 1e-6]), Some("nm")));
    let scan = scan_of(b"# Breite: 10 \xb5m\n# H\xf6he: 5.5 \xb5m\n1 2\n", Format::Text, None).unwrap();
    assert_eq!(scan.size_m, Some([10.0 * 1e-6, 5.5 * 1e-6]));
    refused("# Breite: 10,000 µm\n1 2\n".as_bytes(), Format::Text, &["\"Breite\"", "10,000 µm", "decimal comma", "\nhelp: "]);
}
