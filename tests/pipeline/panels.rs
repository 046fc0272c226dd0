//! Panels: marks of single points, error bars, labels and captions.

use hysteron::figures::{Axis, Curve, KeyEntry, Panel, Stroke, XyPlot, plot_xy};
use hysteron::store::{ColumnData, Frame};

use crate::figures::{panels_of, read, tables, well_formed};
use crate::steps::case;

/// The curves of a panel by name.
fn named<'a>(panel: &'a Panel, name: &str) -> Vec<&'a Curve> {
    panel.plot.curves.iter().filter(|curve| curve.name == name).collect()
}

#[test]
fn law_a_line_of_one_point_is_a_mark_in_the_panel_and_in_the_key() {
    let drawn = panels_of(&tables(&[(case("a", "one", 0.8, 128.0, &[0.0071]), (0.133, 5e-4, 4.9e-4, 2.5))], 1), "one").unwrap();
    let losses = &drawn[3];
    for (name, text) in [("loss_dk", "Deng–Kesari, target spectrum"), ("loss_dk_realised", "Deng–Kesari, realised spectrum")] {
        assert_eq!(named(losses, name)[0].points.len(), 1);
        assert!(losses.plot.key.iter().any(|entry| entry.text == text && entry.marked), "{text} has no mark in the key");
    }
    // A picture without the points lacks their marks: a square for the dashed line, a diamond for the dotted one.
    let mut without = losses.plot.clone();
    without.curves.iter_mut().filter(|curve| curve.name.starts_with("loss_dk")).for_each(|curve| curve.points.clear());
    let marks = |svg: &str| svg.matches("<rect").count() + svg.matches("<path").count();
    assert_eq!(marks(&losses.svg), marks(&plot_xy(&without)) + 2);
}

#[test]
fn law_few_surfaces_are_crosses_and_many_have_bars() {
    let input = || (case("a", "one", 0.8, 128.0, &[0.0071]), (0.133, 5e-4, 4.9e-4, 2.5));
    for (count, few) in [(2, true), (4, true), (5, false)] {
        let made = tables(&[input()], count);
        let drawn = panels_of(&made, "one").unwrap();
        let crosses = named(&drawn[1], "pull_off_load_single");
        let bars = named(&drawn[1], "pull_off_load")[0].errors.iter().flatten().count();
        assert_eq!((crosses.len(), bars), (usize::from(few), usize::from(!few)), "{count} surfaces");
        if few {
            let single: Vec<f64> = crosses[0].points.iter().map(|point| point.1).collect();
            assert_eq!(single, made.2.f64("pull_off_load").unwrap());
            assert!(read(&drawn[1].svg).contains("single surfaces") && !read(&drawn[1].svg).contains("standard deviation"));
            assert!(drawn[1].caption.contains("crosses"), "{}", drawn[1].caption);
        }
    }
}

/// A panel of one curve whose second point scatters by more than its mean.
fn wide(positive: bool, band: bool) -> XyPlot {
    let curve = Curve {
        name: "area".to_owned(),
        of: String::new(),
        points: vec![(1.0, 0.8), (2.0, 0.5)],
        errors: vec![Some(0.1), Some(0.9)],
        band,
        positive,
        colour: "#cc3311".to_owned(),
        mark_colours: Vec::new(),
        stroke: Stroke::Solid,
        joined: true,
        marked: true,
    };
    let key =
        vec![KeyEntry { text: "area".to_owned(), colour: "#cc3311".to_owned(), stroke: Some(Stroke::Solid), marked: true, joined: true }];
    let (x, y) = (Axis::holding("x", [1.0, 2.0], false), Axis::holding("y", [-1.0, 1.5], true));
    XyPlot { stem: "wide".to_owned(), letter: 'A', title: String::new(), x, y, curves: vec![curve], key, notes: Vec::new(), margin: 0.0 }
}

#[test]
fn law_bars_and_bands_of_positive_quantities_end_at_zero() {
    for band in [false, true] {
        let (cut, whole) = (plot_xy(&wide(true, band)), plot_xy(&wide(false, band)));
        assert!(cut != whole, "band: {band}");
        well_formed(&cut);
    }
    // With six surfaces that scatter by more than their mean, the axis has no room below zero.
    let (cases, curves, realizations) = tables(&[(case("a", "one", 0.8, 128.0, &[0.0071]), (0.133, 5e-4, 4.9e-4, 2.5))], 6);
    let mean = cases.f64_or_null("pull_off_load_mean").unwrap()[0].unwrap();
    let made = (replaced(&cases, "pull_off_load_sd", 0, 3.0 * mean), curves, realizations);
    let drawn = panels_of(&made, "one").unwrap();
    let range = drawn[1].plot.y.drawn_range();
    assert!(range.0 > -0.1 * range.1, "{range:?}");
    assert!(read(&drawn[1].svg).contains("bars end at 0") && drawn[1].caption.contains("ending at 0"));
}

#[test]
fn law_bands_are_inside_their_panel() {
    let drawn = panels_of(&tables(&[(case("a", "one", 0.8, 128.0, &[0.0071]), (0.133, 5e-4, 4.9e-4, 2.5))], 6), "one").unwrap();
    for panel in [&drawn[0], &drawn[2]] {
        let (low, high) = panel.plot.y.drawn_range();
        for curve in &panel.plot.curves {
            assert!(curve.band && curve.errors.iter().flatten().any(|error| *error > 0.0));
            for ((_, y), error) in curve.points.iter().zip(&curve.errors) {
                let top = panel.plot.y.drawn(y + error.unwrap());
                assert!((low..=high).contains(&top), "{top} is not within {low} and {high}");
            }
        }
    }
}

#[test]
fn val_a_range_within_a_decade_has_ticks_at_doublings() {
    let ticks = |low: f64, high: f64| {
        let axis = Axis::of_decades("x", [low, high]);
        axis.ticks().into_iter().map(|tick| axis.tick_label(tick)).collect::<Vec<_>>()
    };
    assert_eq!(ticks(0.24, 0.9), ["0.25", "0.5", "1"]);
    assert_eq!(ticks(1.0, 8.0), ["1", "2", "4", "8"]);
    assert_eq!(ticks(0.5, 30.0), ["10^{0}", "10^{1}"]);
}

#[test]
fn law_the_power_of_ten_of_an_axis_joins_its_unit() {
    let label = |label: &str, most: f64| Axis::holding(label, [0.0, most], true).full_label();
    assert_eq!(label("Δγ [J/m^{2}]", 0.07), "Δγ [10^{−3} J/m^{2}]");
    assert_eq!(label("A/A_{0}", 0.07), "A/A_{0}  [10^{−3}]");
    assert_eq!(label("ε [m]", 5.0), "ε [m]");
}

/// The table with another number in one row of a column.
pub fn replaced(frame: &Frame, name: &str, row: usize, value: f64) -> Frame {
    let mut builder = Frame::of(frame.table());
    for column in frame.table().columns {
        let mut data = frame.column(column.name).unwrap().clone();
        match &mut data {
            ColumnData::F64(values) if column.name == name => values[row] = Some(value),
            ColumnData::I64(values) if column.name == name => values[row] = Some(value as i64),
            _ => {}
        }
        builder = builder.with(column.name, data);
    }
    builder.build().unwrap()
}

#[test]
fn law_labels_of_a_sweep_have_no_float_noise() {
    // numpy.linspace(0.01, 0.1, 3), and ranges of adhesion in nanometres.
    let inputs: Vec<_> = [(0.01, 5e-10), (0.05500000000000001, 1e-9), (0.1, 3.0e-9 * 1.000_000_000_000_1)]
        .iter()
        .enumerate()
        .map(|(at, (adhesion, range))| {
            let mut input = case(&format!("c{at}"), "dg", 0.8, 128.0, &[0.0071]);
            for (name, value) in &mut input.parameters {
                match name.as_str() {
                    "work_of_adhesion_j_m2" => *value = (*adhesion).into(),
                    "interaction_range_m" => *value = (*range).into(),
                    _ => {}
                }
            }
            (input, (0.13, 5e-4, 5e-4, 2.5))
        })
        .collect();
    let drawn = panels_of(&tables(&inputs, 2), "dg").unwrap();
    let of: Vec<&str> = drawn[0].plot.curves.iter().map(|curve| curve.of.as_str()).collect();
    for label in ["Δγ = 0.01 J/m², ε = 0.5 nm", "Δγ = 0.055 J/m², ε = 1 nm", "Δγ = 0.1 J/m², ε = 3 nm"] {
        assert!(of.contains(&label), "{label} is not in {of:?}");
    }
    assert!(drawn[0].caption.contains("for Δγ = 0.01, 0.055, 0.1 J/m² with ε = 0.5, 1, 3 nm; mean of 2 surfaces"), "{}", drawn[0].caption);
}

#[test]
fn law_counts_of_surfaces_are_sentences() {
    let inputs = [64.0, 128.0].map(|zeta| (case(&format!("z{zeta}"), "s", 0.8, zeta, &[0.0071]), (0.1, 1e-4, 1e-4, 2.0)));
    let (cases, curves, realizations) = tables(&inputs, 2);
    let captions = |counts: [i64; 2]| {
        let cases = replaced(&replaced(&cases, "done_count", 0, counts[0] as f64), "done_count", 1, counts[1] as f64);
        panels_of(&(cases, curves.clone(), realizations.clone()), "s").unwrap()[0].caption.clone()
    };
    assert!(captions([0, 1]).contains("; at most one surface"));
    assert!(captions([0, 6]).contains("; mean of up to 6 surfaces"));
    assert!(captions([1, 1]).contains("; one surface"));
    assert!(captions([1, 3]).contains("; mean of 1 to 3 surfaces"));
}

#[test]
fn law_parameters_that_advance_together_are_one_axis() {
    let of = (0.13, 5e-4, 5e-4, 2.5);
    let inputs: Vec<_> = [(0.6, 64.0), (0.7, 128.0), (0.8, 256.0)]
        .into_iter()
        .map(|(hurst, zeta)| (case(&format!("z{zeta}"), "zip", hurst, zeta, &[0.0071]), of))
        .collect();
    let drawn = panels_of(&tables(&inputs, 2), "zip").unwrap();
    let line = named(&drawn[1], "pull_off_load");
    assert_eq!((line.len(), line[0].points.len()), (1, 3), "one line joins the three cases");
    assert!(drawn[1].caption.contains(", for ζ = 64, 128, 256 with H = 0.6, 0.7, 0.8;"), "{}", drawn[1].caption);
}

#[test]
fn law_several_sweeps_have_common_panels() {
    let of = (0.13, 5e-4, 5e-4, 2.5);
    let with = |sweep: &str, hurst: f64, zeta: f64| (case(&format!("{sweep}{zeta}"), sweep, hurst, zeta, &[0.0071]), of);
    let made = tables(&[with("a", 0.8, 64.0), with("a", 0.8, 128.0), with("b", 0.7, 128.0), with("b", 0.7, 256.0)], 2);
    let drawn = panels_of(&made, "a+b").unwrap();
    let lines = named(drawn.iter().find(|panel| panel.name == "B").unwrap(), "pull_off_load");
    let places: Vec<Vec<f64>> = lines.iter().map(|line| line.points.iter().map(|point| point.0).collect()).collect();
    assert_eq!(places, [vec![128.0, 256.0], vec![64.0, 128.0]]);
    assert!(drawn.iter().all(|panel| panel.stem.starts_with("a-b_") && panel.caption.contains(" Sweeps a, b.")));
    assert!(panels_of(&made, "a+c").unwrap_err().to_string().contains("\"c\""));
}

#[test]
fn law_a_caption_counts_the_cases_without_a_result() {
    let of = (0.13, 5e-4, 5e-4, 2.5);
    let (cases, curves, realizations) =
        tables(&[0.6, 0.7, 0.8].map(|hurst| (case(&format!("h{hurst}"), "h", hurst, 64.0, &[0.0071]), of)), 2);
    let without = replaced(&replaced(&cases, "done_count", 0, 0.0), "failed_count", 0, 2.0);
    let drawn = panels_of(&(without, curves, realizations), "h").unwrap();
    assert!(drawn.iter().all(|panel| panel.caption.contains(" 1 of 3 cases failed: not drawn.")), "{}", drawn[0].caption);
    assert_eq!(drawn[0].cases.len(), 2);
}
