//! What a finished run shows: pictures in every format, a closer look at one cycle, and campaigns side by side.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::bench::{Bench, SPEC, code, files, stderr, stdout};
use hysteron::schema;
use hysteron::stats::{Sample, t_quantile};
use hysteron::store::Frame;
use hysteron::store::parquet::read_table;
use std::process::Command;

/// Width and height of a PNG.
fn dots(bytes: &[u8]) -> (u32, u32) {
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    (number(16), number(20))
}

/// A number that an attribute of the first tag of an SVG has.
fn stated(svg: &str, name: &str) -> f64 {
    let tag = svg.split('>').next().unwrap();
    tag.split_once(&format!(" {name}=\"")).unwrap().1.split_once('"').unwrap().0.parse().unwrap()
}

#[test]
fn e2e_every_figure_is_there_in_three_formats() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let folder = bench.out().join("figures");
    let stems: BTreeSet<String> =
        fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    let closer = ["avalanches", "events", "loads", "loop", "map", "radii", "spectrum", "summits"].map(|name| format!("closer_{name}"));
    let wanted: BTreeSet<String> = closer.into_iter().chain(["A", "B", "C", "D", "E"].map(|panel| format!("zeta_{panel}"))).collect();
    assert_eq!(stems, wanted);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    for stem in &stems {
        let svg = fs::read_to_string(folder.join(format!("{stem}.svg"))).unwrap();
        let (width, height) = dots(&fs::read(folder.join(format!("{stem}.png"))).unwrap());
        assert_eq!(
            (f64::from(width), f64::from(height)),
            ((3.0 * stated(&svg, "width")).ceil(), (3.0 * stated(&svg, "height")).ceil()),
            "{stem}"
        );
        let pdf = fs::read(folder.join(format!("{stem}.pdf"))).unwrap();
        assert!(pdf.starts_with(b"%PDF-") && pdf.len() > 2000, "{stem}");
        assert!(page.contains(&svg[svg.find("<svg").unwrap()..]), "{stem} is not on the page");
    }
    // Every identifier stands once on the whole page.
    let ids: Vec<&str> = page.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len(), "{ids:?}");
    assert!(
        !page.contains("http:") || page.matches("http:").count() == page.matches("http://www.w3.org/").count(),
        "the page asks for the network"
    );
}

#[test]
fn e2e_the_closer_look_is_in_the_table_of_panels() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let panels = read_table(&bench.out().join("statistics/panels.parquet"), &schema::PANELS).unwrap();
    let (sweeps, names, curves) = (panels.text("sweep").unwrap(), panels.text("panel").unwrap(), panels.text("name").unwrap());
    let (x, y) = (panels.f64("x").unwrap(), panels.f64("y").unwrap());
    let of = |panel: &str, curve: &str| -> Vec<(f64, f64)> {
        (0..x.len()).filter(|k| sweeps[*k].is_empty() && names[*k] == panel && curves[*k] == curve).map(|k| (x[k], y[k])).collect()
    };
    // The loop is closed at its turning point, from where the load falls below none.
    let (up, down) = (of("loop", "loading"), of("loop", "unloading"));
    assert!(up.len() > 5 && down.len() > 5 && down.iter().any(|point| point.1 < 0.0));
    let turning = up.last().unwrap();
    assert!((turning.1 - 0.001).abs() < 1e-9 && down[0].0 <= turning.0, "{turning:?} {:?}", down[0]);
    // The spectrum of the surface is the one that was asked for, but for the rings' scatter: fixed amplitudes, scaled to the rms height.
    let (found, asked) = (of("spectrum", "found"), of("spectrum", "asked for"));
    assert!(found.len() > 4 && asked.len() > 50);
    // What the sum over so few modes is more than the integral of Eq 10 is taken off all of them.
    let share = |point: &(f64, f64)| point.1 / (asked[0].1 * point.0.powf(-3.6));
    for point in found.iter().filter(|point| point.0 < 4.0) {
        let against_first = share(point) / share(&found[0]);
        assert!((against_first - 1.0).abs() < 0.15, "{against_first} at {}", point.0);
    }
    // The density of curvatures is one: that of the histogram, and Nayak's.
    let bars = of("summits", "found");
    let whole: f64 = bars.chunks(2).map(|bar| (bar[1].0 - bar[0].0) * bar[0].1).sum();
    assert!((whole - 1.0).abs() < 1e-12, "{whole}");
    // Distributions rise from 0 to 1.
    for panel in ["radii", "loads"] {
        for curve in ["at F_{max}", "at the pull-off"] {
            let points = of(panel, curve);
            assert!(points.len() > 3, "{panel}, {curve}");
            assert!(points.windows(2).all(|pair| pair[0].0 <= pair[1].0 && pair[0].1 < pair[1].1), "{panel}, {curve}");
            assert!(points[0].1 > 0.0 && points.last().unwrap().1 < 1.0);
        }
    }
    // Every avalanche of the loop is counted: at its least size, all of them.
    assert!(of("avalanches", "loading")[0].1 > 5.0);
    let lost = of("events", "unloading");
    assert!(!lost.is_empty() && lost.iter().all(|(_, energy)| *energy > 0.0));
}

#[test]
fn e2e_a_page_without_spots_or_results_is_still_a_page() {
    let without = SPEC.replace("[cycle]", "[cycle]\ncontacts = \"none\"");
    let bench = Bench::new(&without);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let written = files(&bench.out());
    assert!(written.contains_key(Path::new("figures/closer_events.png")) && !written.contains_key(Path::new("figures/closer_map.png")));
    // Nothing is done: rows, no means, no closer look.
    let nothing = Bench::new(SPEC);
    assert_eq!(code(&nothing.verb("run", &["--until", "extract"])), 0);
    let partial = nothing.verb("aggregate", &["--partial"]);
    assert_eq!(code(&partial), 0, "{}", stderr(&partial));
    let report = nothing.verb("report", &[]);
    assert_eq!(code(&report), 0, "{}", stderr(&report));
    let page = fs::read_to_string(nothing.out().join("report.html")).unwrap();
    assert!(page.contains("0 of 2") && !page.contains("A closer look"));
    assert!(page.contains("no surface finished"));
}

fn compare(folders: &[&Bench], out: &Path) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
    command.args(["report", "--compare"]).args(folders.iter().map(|bench| bench.out())).arg("--out").arg(out);
    command.output().unwrap()
}

/// The losses of a case at a load, by realization.
fn losses(bench: &Bench, case: &str, load: f64) -> Vec<f64> {
    let table = read_table(&bench.out().join("statistics/realizations.parquet"), &schema::REALIZATIONS).unwrap();
    let (ids, loads, losses) = (table.text("case_id").unwrap(), table.f64("max_load").unwrap(), table.f64("loss").unwrap());
    (0..ids.len()).filter(|k| ids[*k] == case && loads[*k] == load).map(|k| losses[k]).collect()
}

fn rows(table: &Frame, quantity: &str) -> Vec<usize> {
    let quantities = table.text("quantity").unwrap();
    (0..quantities.len()).filter(|k| quantities[*k] == quantity).collect()
}

#[test]
fn e2e_campaigns_are_compared_case_by_case() {
    let spec = |seed: u64, interaction: &str| {
        SPEC.replace("seed = 7", &format!("seed = {seed}")).replace("realizations = 2", "realizations = 3")
            + &format!("[model]\ninteraction = \"{interaction}\"\n")
    };
    let spec = |seed: u64, interaction: &str| {
        // A table after an array of tables would belong to it.
        let whole = spec(seed, interaction);
        let (before, model) = whole.split_once("[model]").unwrap();
        before.replace("[[sweep]]", &format!("[model]{model}[[sweep]]"))
    };
    let (spots, alone, elsewhere) = (Bench::new(&spec(7, "spots")), Bench::new(&spec(7, "none")), Bench::new(&spec(8, "spots")));
    for bench in [&spots, &alone, &elsewhere] {
        let ended = bench.verb("run", &["--until", "aggregate"]);
        assert_eq!(code(&ended), 0, "{}", stderr(&ended));
    }
    let out = spots.folder.path().join("compared");
    let ended = compare(&[&spots, &alone], &out);
    assert_eq!(code(&ended), 0, "{}", stderr(&ended));
    assert!(stdout(&ended).contains("comparison.html"));
    let table = read_table(&out.join("comparison.parquet"), &schema::COMPARISON).unwrap();
    let rows_of = rows(&table, "loss");
    assert_eq!(rows_of.len(), 4, "two magnifications at two loads");
    let (loads, paired) = (table.f64("max_load").unwrap(), table.bool("paired").unwrap());
    let (ids, others) = (table.text("case_id").unwrap(), table.text("reference_case_id").unwrap());
    let (difference, half) = (table.f64("difference").unwrap(), table.f64_or_null("difference_ci95").unwrap());
    for k in rows_of {
        assert!(paired[k], "both have the surfaces of one seed");
        let (mine, other) = (losses(&alone, ids[k], loads[k]), losses(&spots, others[k], loads[k]));
        let each: Vec<f64> = mine.iter().zip(&other).map(|(a, b)| a - b).collect();
        let sample = Sample::of(&each);
        assert!((difference[k] - sample.mean.unwrap()).abs() < 1e-15 && (half[k].unwrap() - sample.ci95.unwrap()).abs() < 1e-15);
    }
    let page = fs::read_to_string(out.join("comparison.html")).unwrap();
    assert!(page.contains("differ in interaction") && page.contains("3 pairs") && !page.contains("NaN"));
    assert!(out.join("figures/compare0_A.png").is_file() && out.join("figures/compare3_E.pdf").is_file());

    // Other surfaces: two independent means.
    let ended = compare(&[&spots, &elsewhere], &out);
    assert_eq!(code(&ended), 0, "{}", stderr(&ended));
    let table = read_table(&out.join("comparison.parquet"), &schema::COMPARISON).unwrap();
    let k = rows(&table, "loss")[0];
    let id = table.text("case_id").unwrap()[k].to_owned();
    let load = table.f64("max_load").unwrap()[k];
    let (a, b) = (Sample::of(&losses(&elsewhere, &id, load)), Sample::of(&losses(&spots, &id, load)));
    let parts = [a, b].map(|sample| sample.sd.unwrap().powi(2) / 3.0);
    let freedom = (parts[0] + parts[1]).powi(2) / (parts[0].powi(2) / 2.0 + parts[1].powi(2) / 2.0);
    let wanted = t_quantile(0.975, freedom.floor() as usize).unwrap() * (parts[0] + parts[1]).sqrt();
    let found = table.f64_or_null("difference_ci95").unwrap()[k].unwrap();
    assert!(!table.bool("paired").unwrap()[k] && (found - wanted).abs() < 1e-12 * wanted, "{found} for {wanted}");
    assert!(fs::read_to_string(out.join("comparison.html")).unwrap().contains("nothing but their realizations"));

    // What cannot be compared is refused with a sentence.
    let none = Bench::new(&spec(7, "spots").replace("max_load = [0.001, 0.002]", "max_load = [0.003]"));
    assert_eq!(code(&none.verb("run", &["--until", "aggregate"])), 0);
    let said = stderr(&compare(&[&spots, &none], &out));
    assert!(said.contains("no case is in all of them"), "{said}");
    let said = stderr(&compare(&[&spots, &Bench::new(SPEC)], &out));
    assert!(said.starts_with("error: cannot") && said.contains("statistics/cases.parquet"), "{said}");
}
