//! Figures.

use std::path::Path;

use hysteron::figures::{FigureError, Panel, Stroke, Tables, Units, panels, table};
use hysteron::figures::{described, plot_xy};
use hysteron::stats::{CaseInput, cases, curves, realizations};
use hysteron::store::Frame;

use crate::steps::{case, cycle, realistic};

/// What a synthetic case comes to: area, pull-off, loss and depth at the greatest load, dimensionless.
pub type Result = (f64, f64, f64, f64);

/// The tables `cases`, `curves` and `realizations`.
pub type Made = (Frame, Frame, Frame);

pub fn panels_of((cases, curves, realizations): &Made, sweep: &str) -> std::result::Result<Vec<Panel>, FigureError> {
    panels(&Tables { cases, curves, realizations, avalanches: None, all_loads: false }, sweep, Units::Dimensionless)
}

pub fn tables(inputs: &[(CaseInput, Result)], realization_count: i32) -> Made {
    let directory = tempfile::tempdir().unwrap();
    let mut cycles = Vec::new();
    for (at, (input, (area, pull_off, loss, depth))) in inputs.iter().enumerate() {
        for realization in 0..realization_count {
            let path = directory.path().join(format!("{at}-{realization}.parquet"));
            let angle = 2.1 * f64::from(realization) + at as f64;
            let factor = |spread: f64, phase: f64| 1.0 + spread * (angle + phase).cos();
            realistic(
                &path,
                &input.max_loads,
                area * factor(0.2, 0.0),
                pull_off * factor(0.5, 0.3),
                loss * factor(0.3, 0.1),
                depth * factor(0.1, 1.0),
            );
            cycles.push(cycle(&input.case_id, i64::from(realization), &path, 1.8e-8));
        }
    }
    let inputs: Vec<CaseInput> = inputs.iter().map(|(input, _)| input.clone()).collect();
    let rows = realizations(&inputs, &cycles).unwrap();
    (cases(&rows, &inputs).unwrap(), curves(&inputs, &cycles).unwrap(), rows)
}

/// Panels of a sweep, each checked to be well formed, and left where a person can look at them.
fn draw(tables: &Made, sweep: &str) -> Vec<(String, String)> {
    let drawn: Vec<(String, String)> = panels_of(tables, sweep).unwrap().into_iter().map(|panel| (panel.stem, panel.svg)).collect();
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("figures");
    std::fs::create_dir_all(&directory).unwrap();
    for (stem, svg) in &drawn {
        well_formed(svg);
        std::fs::write(directory.join(format!("{stem}.svg")), svg).unwrap();
    }
    drawn
}

/// Every tag is closed in order, every attribute is quoted, every identifier occurs once.
pub fn well_formed(svg: &str) {
    let mut open = Vec::new();
    for piece in svg.split('<').skip(1) {
        let (tag, text) = piece.split_once('>').expect("a tag ends");
        assert!(!text.contains('>'), "stray > after {tag}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "{tag}");
        } else if !tag.starts_with('!') {
            assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
            if !tag.ends_with('/') {
                open.push(tag.split_whitespace().next().unwrap());
            }
        }
    }
    assert!(open.is_empty(), "{open:?}");
    assert!(svg.starts_with("<svg") && !svg.contains("NaN") && !svg.contains("kuva-clip"));
    let ids: Vec<&str> = svg.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!((1..ids.len()).all(|at| !ids[..at].contains(&ids[at])), "{ids:?}");
}

/// The text that a reader sees, markup and spans removed.
pub fn read(svg: &str) -> String {
    svg.split('<').filter_map(|piece| piece.split_once('>')).map(|(_, text)| text).collect()
}

/// Curves of a stroke; samples in the key are lines, not paths.
fn paths(svg: &str, dashes: Option<&str>) -> usize {
    let curves = svg.split("<path").skip(1).filter_map(|piece| piece.split_once('>')).map(|(tag, _)| tag);
    curves
        .filter(|tag| {
            tag.contains("stroke-width=\"2")
                && dashes.map_or(!tag.contains("dasharray"), |dashes| tag.contains(&format!("dasharray=\"{dashes}\"")))
        })
        .count()
}

fn fig4() -> Made {
    let result = [(0.186, 6.7e-4, 6.9e-4, 2.6), (0.133, 5.0e-4, 4.9e-4, 2.5), (0.098, 3.9e-4, 3.7e-4, 2.45), (0.071, 3.2e-4, 2.9e-4, 2.4)];
    let zetas = [64.0, 128.0, 256.0, 512.0];
    let inputs: Vec<_> =
        zetas.iter().zip(result).map(|(zeta, result)| (case(&format!("z{zeta}"), "fig4", 0.8, *zeta, &[0.0071]), result)).collect();
    tables(&inputs, 6)
}

#[test]
fn e2e_every_panel_is_drawn_again_from_its_table() {
    let tables = fig4();
    let drawn: Vec<_> = panels_of(&tables, "fig4").unwrap().into_iter().map(|panel| ("fig4".to_owned(), panel)).collect();
    let frame = table(&drawn).unwrap();
    let (letters, curves) = (frame.text("panel").unwrap(), frame.i64("curve").unwrap());
    let (x, y, spread) = (frame.f64("x").unwrap(), frame.f64("y").unwrap(), frame.f64_or_null("y_sd").unwrap());
    for (_, panel) in &drawn {
        let mut plot = panel.plot.clone();
        let caption = panel.caption.split(" Data: ").next().unwrap();
        for (number, curve) in plot.curves.iter_mut().enumerate() {
            let rows: Vec<usize> =
                (0..frame.row_count()).filter(|k| letters[*k] == panel.plot.letter.to_string() && curves[*k] == number as i64).collect();
            curve.points = rows.iter().map(|k| (x[*k], y[*k])).collect();
            curve.errors = rows.iter().map(|k| spread[*k]).collect();
        }
        for (curve, drawn) in plot.curves.iter().zip(&panel.plot.curves) {
            assert_eq!((&curve.points, &curve.name), (&drawn.points, &drawn.name), "{}", panel.stem);
            let bars = |errors: &[Option<f64>]| errors.iter().flatten().copied().collect::<Vec<f64>>();
            assert_eq!(bars(&curve.errors), bars(&drawn.errors), "{}", panel.stem);
        }
        assert!(described(&plot_xy(&panel.plot), caption) == panel.svg, "{} is another picture when it is drawn twice", panel.stem);
        assert!(plot.curves.iter().any(|curve| curve.points.len() > 1), "{}", panel.stem);
        assert!(described(&plot_xy(&plot), caption) == panel.svg, "{} is another picture", panel.stem);
    }
    let names: std::collections::BTreeSet<&str> = frame.text("name").unwrap().into_iter().collect();
    assert_eq!(
        names.into_iter().collect::<Vec<_>>(),
        ["dissipated_loading", "dissipated_unloading", "loading", "loss", "loss_dk", "loss_dk_realised", "pull_off_load", "unloading"]
    );
}

#[test]
fn e2e_magnification_sweep_has_five_panels() {
    let drawn = draw(&fig4(), "fig4");
    let stems: Vec<&str> = drawn.iter().map(|(stem, _)| stem.as_str()).collect();
    assert_eq!(stems, ["fig4_A", "fig4_B", "fig4_C", "fig4_D", "fig4_E"]);
    for (at, label) in [(0, "A/A0"), (1, "Fpo/(E*A0)"), (2, "Δ/hrms"), (3, "Θ/(E*A0hrms)")] {
        let text = read(&drawn[at].1);
        assert!(text.contains(label) && drawn[at].1.contains("mean of 6 surfaces"), "{text}");
    }
    for panel in [0, 2] {
        assert_eq!((paths(&drawn[panel].1, Some("7 4")), paths(&drawn[panel].1, None)), (4, 4));
        let text = read(&drawn[panel].1);
        assert!(
            ["ζ = 64", "ζ = 128", "ζ = 256", "ζ = 512", "F/(E*A0)", "loading", "unloading"].iter().all(|label| text.contains(label)),
            "{text}"
        );
    }
    // One computed line, and in panel D one dashed and one dotted prediction.
    assert_eq!((paths(&drawn[1].1, Some("7 4")), paths(&drawn[1].1, None)), (0, 1));
    assert_eq!((paths(&drawn[3].1, Some("7 4")), paths(&drawn[3].1, Some("1.5 3.5")), paths(&drawn[3].1, None)), (1, 1, 1));
    assert!(read(&drawn[3].1).contains("Deng–Kesari") && read(&drawn[1].1).contains("magnification ζ"));
}

/// Panels in SI units have the dimensionless columns times E* = 1e6 Pa in kPa, and times E* h_rms = 5 J/m² in mJ/m², to rounding.
#[test]
fn val_panels_in_si_units() {
    let (cases, curves, realizations) = fig4();
    let tables = Tables { cases: &cases, curves: &curves, realizations: &realizations, avalanches: None, all_loads: false };
    let panels = panels(&tables, "fig4", Units::Si).unwrap();
    let sorted = |mut numbers: Vec<f64>| {
        numbers.sort_by(f64::total_cmp);
        numbers
    };
    for (letter, curve, column, unit) in [("B_SI", "pull_off_load", "pull_off_load_mean", 1e3), ("D_SI", "loss", "loss_mean", 5e3)] {
        let panel = panels.iter().find(|panel| panel.name == letter).unwrap();
        let drawn = panel.plot.curves.iter().filter(|of| of.name == curve).flat_map(|of| of.points.iter().map(|point| point.1));
        let wanted = cases.f64_or_null(column).unwrap().iter().map(|value| unit * value.unwrap());
        let (drawn, wanted) = (sorted(drawn.collect()), sorted(wanted.collect()));
        assert_eq!(drawn.len(), wanted.len(), "{letter}");
        assert!(drawn.iter().zip(&wanted).all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{letter}: {drawn:?}, {wanted:?}");
    }
    assert!(read(&panels[0].svg).contains("F/A0 [kPa]") && read(&panels[3].svg).contains("Θ/A0 [mJ/m²]"));
}

#[test]
fn e2e_load_sweep_stands_over_area() {
    let one = case("f3", "fig3+other", 0.8, 128.0, &[0.004, 0.0071, 0.012, 0.015]);
    let tables = tables(&[(one, (0.25, 5.2e-4, 1.1e-3, 3.2))], 6);
    let drawn = draw(&tables, "fig3");
    assert_eq!((paths(&drawn[0].1, Some("7 4")), paths(&drawn[0].1, None)), (1, 4));
    let text = read(&drawn[0].1);
    assert!(["0.004", "0.0071", "0.012", "0.015", "Fmax/(E*A0)"].iter().all(|label| text.contains(label)), "{text}");
    assert!(read(&drawn[3].1).contains("A/A0"));
    assert_eq!(panels_of(&tables, "other").unwrap().len(), 5);
}

#[test]
fn e2e_hurst_sweep() {
    let result = [(0.047, 2.3e-5, 1.3e-4, 2.2), (0.09, 2.0e-4, 3.0e-4, 2.35), (0.133, 5.0e-4, 4.9e-4, 2.5), (0.217, 9.7e-4, 8.8e-4, 2.8)];
    let inputs: Vec<_> = [0.45, 0.65, 0.8, 0.95]
        .iter()
        .zip(result)
        .map(|(hurst, result)| (case(&format!("h{hurst}"), "fig5", *hurst, 128.0, &[0.0071]), result))
        .collect();
    let drawn = draw(&tables(&inputs, 6), "fig5");
    assert!(read(&drawn[1].1).contains("Hurst exponent H"));
    assert!(read(&drawn[0].1).contains("H = 0.95"));
}

#[test]
fn e2e_one_case_one_surface() {
    let drawn = draw(&tables(&[(case("a", "", 0.8, 128.0, &[0.0071]), (0.133, 5e-4, 4.9e-4, 2.5))], 1), "");
    assert_eq!(drawn[0].0, "run_A");
    assert_eq!((paths(&drawn[0].1, Some("7 4")), paths(&drawn[0].1, None)), (1, 1));
    assert!(drawn[0].1.contains("one surface"));
}

/// A grid of Hurst exponents and magnifications, two loads.
fn grid(hursts: &[f64], zetas: &[f64]) -> Made {
    let mut inputs = Vec::new();
    for hurst in hursts {
        for zeta in zetas {
            let result = (0.25 * hurst * (64.0_f64 / zeta).sqrt(), 6e-4 * hurst, 6e-4 * hurst, 2.5);
            inputs.push((case(&format!("{hurst}-{zeta}"), "grid", *hurst, *zeta, &[0.004, 0.0071]), result));
        }
    }
    tables(&inputs, 2)
}

/// The parameter with most values is the axis, the other one the colour; paths have a panel for each value of the axis, at the largest load.
#[test]
fn e2e_two_parameters_are_axis_and_colour() {
    let made = grid(&[0.8, 0.6, 0.45], &[64.0, 128.0]);
    let drawn = draw(&made, "grid");
    let stems: Vec<&str> = drawn.iter().map(|(stem, _)| stem.as_str()).collect();
    assert_eq!(stems, ["grid_A", "grid_A2", "grid_A3", "grid_B", "grid_C", "grid_C2", "grid_C3", "grid_D", "grid_E"]);
    let text = read(&drawn[3].1);
    assert!(text.contains("Hurst exponent H") && text.contains("ζ = 128"), "{text}");
    assert_eq!(paths(&drawn[3].1, None), 2);
    assert_eq!((paths(&drawn[0].1, Some("7 4")), paths(&drawn[0].1, None)), (2, 2), "two series at the largest load");
    assert!(read(&drawn[0].1).contains("H = 0.45") && read(&drawn[2].1).contains("H = 0.8"));
    let panels = panels_of(&made, "grid").unwrap();
    // The caption of a panel of one value has the cases of this value alone.
    assert!(panels[3].caption.contains("against Hurst exponent H, for H = 0.45, 0.6, 0.8; ζ = 64, 128"), "{}", panels[3].caption);
    assert!(panels[2].caption.contains("for H = 0.8; ζ = 64, 128; mean"), "{}", panels[2].caption);
    assert_eq!(panels[0].cases.iter().map(|(label, _)| label.as_str()).collect::<Vec<_>>(), ["ζ = 64", "ζ = 128"]);
    // A colour is one series in every panel.
    for panel in &panels {
        for curve in panel.plot.curves.iter().filter(|curve| !curve.points.is_empty()) {
            assert!(panel.cases.iter().any(|(label, colour)| *colour == curve.colour && curve.of.contains(label.as_str())), "{}", curve.of);
        }
    }
}

/// A case without a result has neither a place on the axis nor a colour.
#[test]
fn e2e_failed_cases_leave_no_empty_axis() {
    let result = (0.1, 5e-4, 5e-4, 2.0);
    let inputs: Vec<_> = [0.6, 0.7, 0.8].map(|hurst| (case(&hurst.to_string(), "h", hurst, 64.0, &[0.004]), result)).into();
    let all = tables(&inputs, 2);
    let finished = tables(&inputs[..2], 2);
    // The third case is planned and has no cycle.
    let planned: Vec<CaseInput> = inputs.iter().map(|(input, _)| input.clone()).collect();
    let mut made = finished.clone();
    made.0 = cases(&made.2, &planned).unwrap();
    let [drawn, wanted] = [&made, &finished].map(|tables| panels_of(tables, "h").unwrap());
    assert_eq!(drawn[1].plot.x, wanted[1].plot.x);
    assert_eq!(drawn[1].cases, wanted[1].cases);
    assert_ne!(panels_of(&all, "h").unwrap()[1].plot.x, wanted[1].plot.x);
}

/// Many curves have no bands, a scale of colours, and labels inside the picture; at most six values of the axis have a panel of paths.
#[test]
fn e2e_a_large_grid_is_readable() {
    let made = grid(&[0.4, 0.5, 0.6, 0.7, 0.8], &[8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0]);
    let panels = panels_of(&made, "grid").unwrap();
    let paths: Vec<&Panel> = panels.iter().filter(|panel| panel.name.starts_with('A')).collect();
    assert_eq!(paths.iter().map(|panel| panel.name.as_str()).collect::<Vec<_>>(), ["A", "A2", "A3", "A4", "A5", "A6"]);
    assert!(paths[0].caption.contains("6 of 7 values have a panel"), "{}", paths[0].caption);
    assert!(paths.iter().all(|panel| panel.plot.curves.len() == 10 && panel.plot.curves.iter().all(|curve| !curve.band)));
    assert_eq!(
        panels[0].cases.iter().map(|(label, _)| label.as_str()).collect::<Vec<_>>(),
        ["H = 0.4", "H = 0.5", "H = 0.6", "H = 0.7", "H = 0.8"]
    );
    for panel in &panels {
        let height: f64 = panel.svg.split(" height=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        let texts = panel.svg.split("<text ").skip(1).filter_map(|tag| tag.split(" y=\"").nth(1)?.split('"').next()?.parse::<f64>().ok());
        assert!(texts.into_iter().all(|y| (0.0..height).contains(&y)), "{}", panel.stem);
    }
}

#[test]
fn e2e_words_stand_on_an_axis() {
    let inputs: Vec<_> = ["spots", "point", "none"]
        .iter()
        .enumerate()
        .map(|(at, word)| {
            let mut input = case(word, "models", 0.8, 128.0, &[0.0071]);
            input.parameters.iter_mut().filter(|(name, _)| name == "interaction").for_each(|(_, value)| *value = (*word).into());
            (input, (0.13 + 0.02 * at as f64, 5e-4, 5e-4, 2.5))
        })
        .collect();
    let made = tables(&inputs, 3);
    let text = read(&draw(&made, "models")[1].1);
    assert!(["spots", "point", "none"].iter().all(|word| text.contains(word)), "{text}");
    // No line joins categories.
    let made = panels_of(&made, "models").unwrap();
    assert!(made[1].plot.curves.iter().all(|curve| !curve.joined || curve.stroke == Stroke::Crosses));
}

#[test]
fn law_the_colour_is_the_case_and_the_dash_is_the_branch() {
    let drawn = panels_of(&fig4(), "fig4").unwrap();
    let cases = &drawn[0].cases;
    assert_eq!(cases.iter().map(|(label, _)| label.as_str()).collect::<Vec<_>>(), ["ζ = 64", "ζ = 128", "ζ = 256", "ζ = 512"]);
    let colours: std::collections::BTreeSet<&str> = cases.iter().map(|(_, colour)| colour.as_str()).collect();
    assert_eq!(colours.len(), 4);
    for panel in [&drawn[0], &drawn[2]] {
        for curve in &panel.plot.curves {
            assert_eq!(curve.stroke, if curve.name == "loading" { Stroke::Dashed } else { Stroke::Solid });
            assert!(cases.contains(&(curve.of.clone(), curve.colour.clone())), "{} is {}", curve.of, curve.colour);
        }
    }
    let own: Vec<&str> = cases.iter().map(|(_, colour)| colour.as_str()).collect();
    assert_eq!(drawn[1].plot.curves[0].mark_colours, own);
    // Panels that stand side by side have one size, and a description.
    let size = |svg: &str| svg.split(" width=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    assert!(drawn.iter().all(|panel| size(&panel.svg) == size(&drawn[0].svg) && panel.svg.contains("role=\"img\" aria-label=\"")));
}

#[test]
fn law_nothing_finished_draws_no_panel() {
    let input = case("a", "empty", 0.8, 128.0, &[0.0071]);
    let drawn = draw(&tables(&[(input, (0.1, 1e-4, 1e-4, 2.0))], 0), "empty");
    assert!(drawn.is_empty());
}

#[test]
fn law_unknown_sweep_is_a_sentence() {
    let tables = fig4();
    let error = panels_of(&tables, "fig9").unwrap_err();
    assert!(matches!(error, FigureError::UnknownSweep { .. }) && error.to_string().contains("fig4"));
}
