//! Output of a finished run: figures in all formats, a single cycle, and a comparison of runs.

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
fn e2e_every_figure_is_there_in_the_formats_of_the_build() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let folder = bench.out().join("figures");
    let stems: BTreeSet<String> =
        fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    let closer = ["avalanches", "events", "hysteresis", "loads", "loop", "map", "radii", "spectrum", "summits", "tension"]
        .map(|name| format!("closer_{name}"));
    let panels = ["A", "B", "C", "D", "E", "F"].into_iter().flat_map(|panel| [format!("zeta_{panel}"), format!("zeta_{panel}_SI")]);
    let wanted = closer.into_iter().chain(panels);
    let wanted: BTreeSet<String> = wanted.chain(["works_1", "works_2"].map(str::to_owned)).collect();
    assert_eq!(stems, wanted);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    for stem in &stems {
        let svg = fs::read_to_string(folder.join(format!("{stem}.svg"))).unwrap();
        assert!(page.contains(&svg[svg.find("<svg").unwrap()..]), "{stem} is not on the page");
        if !cfg!(feature = "raster") {
            assert!(!["png", "pdf"].iter().any(|format| folder.join(format!("{stem}.{format}")).exists()), "{stem}");
            continue;
        }
        let (width, height) = dots(&fs::read(folder.join(format!("{stem}.png"))).unwrap());
        assert_eq!(
            (f64::from(width), f64::from(height)),
            ((3.0 * stated(&svg, "width")).ceil(), (3.0 * stated(&svg, "height")).ceil()),
            "{stem}"
        );
        let pdf = fs::read(folder.join(format!("{stem}.pdf"))).unwrap();
        assert!(pdf.starts_with(b"%PDF-") && pdf.len() > 2000, "{stem}");
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
    // The case with the largest mean loss, and its parameters.
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    let losses = cases.f64("loss_mean").unwrap();
    let largest = (0..losses.len()).max_by(|u, v| losses[*u].total_cmp(&losses[*v])).unwrap();
    let (zeta, max_load) = (cases.f64("magnification").unwrap()[largest], cases.f64("max_load").unwrap()[largest]);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    let section = page.split(">Single cycle</h2>").nth(1).unwrap().split("<h2").next().unwrap();
    let parameters = format!("ζ = {zeta}, H = 0.8, h<sub>rms</sub> = 5 µm, L = 1 mm, E* = 1 MPa, Δγ = 0.07 J/m²");
    assert!(
        section.contains(&format!("the load reversal and back, for {parameters}"))
            && section.starts_with("\n<p>The case with the largest mean Θ")
    );
    assert!(section.matches(&format!("F<sub>max</sub>/(E*A<sub>0</sub>) = {max_load}")).count() == 3, "{zeta} {max_load}");
    // The loop is closed at its turning point, from where the load falls below none.
    let (up, down) = (of("loop", "loading"), of("loop", "unloading"));
    assert!(up.len() > 5 && down.len() > 5 && down.iter().any(|point| point.1 < 0.0));
    let turning = up.last().unwrap();
    assert!((turning.1 - max_load).abs() < 1e-9 && down[0].0 <= turning.0, "{turning:?} {:?}", down[0]);
    // Fixed amplitudes: the points follow the target at the realised rms height up to the last one. Within a ring, the mean of a power law is not its value at the
    // mean wavenumber: 2 % where rings have many modes, 12 % for the few modes of the longest waves.
    let (found, asked) = (of("spectrum", "realised"), of("spectrum", "target"));
    assert!(found.len() > 4 && asked.len() > 50);
    for point in &found {
        let share = point.1 / (asked[0].1 * point.0.powf(-3.6));
        assert!((share - 1.0).abs() < if point.0 < 4.0 { 0.12 } else { 0.05 }, "{share} at {}", point.0);
    }
    let factor: f64 = page.split("target: ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    // Eq 10 at qL, for H = 0.8: C0 qL²/h_rms² = H/(π (1 − ζ^(−2H))).
    let zeta = asked.last().unwrap().0;
    let eq10 = 0.8 / (std::f64::consts::PI * (1.0 - zeta.powf(-1.6)));
    assert!((asked[0].1 / eq10 - factor).abs() < 0.001, "{} for {factor}", asked[0].1 / eq10);
    assert!(page.contains(&format!("The realised density therefore follows {factor} times Eq 10")));
    // The density of curvatures is one: that of the histogram, and Nayak's.
    let bars = of("summits", "realised");
    let whole: f64 = bars.chunks(2).map(|bar| (bar[1].0 - bar[0].0) * bar[0].1).sum();
    assert!((whole - 1.0).abs() < 1e-12, "{whole}");
    // Distributions rise from 0 to 1.
    for panel in ["radii", "loads"] {
        for curve in ["at F_{max}", "at pull-off"] {
            let points = of(panel, curve);
            assert!(points.len() > 3, "{panel}, {curve}");
            // Steps: up at each value, level between two.
            assert!(points.chunks(2).all(|step| step[0].0 == step[1].0 && step[0].1 < step[1].1), "{panel}, {curve}");
            assert!(points[1..points.len() - 1].chunks(2).all(|flat| flat[0].0 <= flat[1].0 && flat[0].1 == flat[1].1), "{panel}, {curve}");
            assert!((points[0].1, points.last().unwrap().1) == (0.0, 1.0));
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
    assert!(written.contains_key(Path::new("figures/closer_events.svg")) && !written.contains_key(Path::new("figures/closer_map.svg")));
    // Nothing is done: rows, no means, no closer look.
    let nothing = Bench::new(SPEC);
    assert_eq!(code(&nothing.verb("run", &["--until", "extract"])), 0);
    let partial = nothing.verb("aggregate", &["--partial"]);
    assert_eq!(code(&partial), 0, "{}", stderr(&partial));
    let report = nothing.verb("report", &[]);
    assert_eq!(code(&report), 0, "{}", stderr(&report));
    let page = fs::read_to_string(nothing.out().join("report.html")).unwrap();
    assert!(page.contains("0 of 2") && !page.contains(">Single cycle</h2>"));
    assert!(page.contains("No results: no surface finished.") && !page.contains("validated range") && !page.contains("<svg"));
}

/// The snippet of the page: both tables have the same columns only where they are joined.
#[test]
fn law_the_snippet_of_the_page_drops_every_other_shared_column() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    let dropped = page.split("cycles.parquet&quot;).drop(").nth(1).and_then(|rest| rest.split(')').next()).unwrap().replace("&quot;", "");
    let mut dropped: Vec<&str> = dropped.split(", ").collect();
    let names = |table: &schema::Table| table.columns.iter().map(|column| column.name).collect::<Vec<_>>();
    let events = names(&schema::EVENTS);
    let mut shared: Vec<&str> = names(&schema::CYCLES).into_iter().filter(|name| events.contains(name) && *name != "cycle_id").collect();
    shared.sort_unstable();
    dropped.sort_unstable();
    assert_eq!(dropped, shared);
}

/// The cells of the table after a heading, row by row, without tags.
fn cells(page: &str, heading: &str) -> Vec<Vec<String>> {
    let table = page.split(heading).nth(1).unwrap().split("</table>").next().unwrap();
    let text = |cell: &str| cell.split('<').map(|piece| piece.split_once('>').map_or(piece, |(_, text)| text)).collect::<String>();
    let row =
        |row: &str| row.split("<td").skip(1).map(|cell| text(cell.split_once('>').unwrap().1.split("</td>").next().unwrap())).collect();
    table.split("<tr>").skip(2).map(row).collect()
}

const SHARED: &str = r#"
name = "shared"
seed = 7
realizations = 3
[surface]
magnification = 8
[cycle]
max_load = [0.001]
approach_step = 0.05
[[sweep]]
name = "zeta"
surface.magnification = [6, 8]
[[sweep]]
name = "range"
material.interaction_range_m = [1e-9, 2e-9]
"#;

#[test]
fn e2e_tables_of_the_report_name_cases_by_what_varies() {
    let bench = Bench::new(SHARED);
    let ended = bench.verb("run", &[]);
    assert_eq!(code(&ended), 0, "{}", stderr(&ended));
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    for heading in [">Results</h2>", ">Comparison with analytical models</h2>", ">Energy budget</h2>", ">Model validity</h2>"] {
        let names: Vec<String> = cells(&page, heading).into_iter().map(|row| row[0].replace('\u{a0}', " ")).collect();
        assert_eq!(names, ["reference", "ζ = 6", "ε = 2 nm"], "{heading}");
    }
    assert!(page.contains("Reference case: ζ = 8, ε = 1 nm."), "the reference case is not defined");
    let table = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
    let body = page.split(">Data</h2>").next().unwrap().split("</style>").nth(1).unwrap();
    let hidden = body.split(">Single cycle</h2>").next().unwrap();
    for id in table.text("case_id").unwrap() {
        assert!(
            !hidden.contains(id) && !page.split(">Comparison with analytical models</h2>").nth(1).unwrap().contains(id),
            "{id} names a row"
        );
    }
    // Differences: of the losses, surface by surface.
    let changes = cells(&page, ">Differences from the reference case</h2>");
    let (ids, zetas, ranges) =
        (table.text("case_id").unwrap(), table.f64("magnification").unwrap(), table.f64("interaction_range_m").unwrap());
    let case = |zeta: f64, range: f64| ids[(0..ids.len()).find(|k| zetas[*k] == zeta && ranges[*k] == range).unwrap()];
    let (mine, base) = (losses(&bench, case(6.0, 1e-9), 0.001), losses(&bench, case(8.0, 1e-9), 0.001));
    let wanted = 100.0 * (mine.iter().sum::<f64>() / base.iter().sum::<f64>() - 1.0);
    let shown: f64 = changes[0][5].split('\u{a0}').next().unwrap().replace('−', "-").parse().unwrap();
    assert!((shown - wanted).abs() < 0.06, "{shown} for {wanted}");
    let terminal = stdout(&ended);
    assert!(terminal.contains(&format!("{wanted:+.1}")) && terminal.contains("ζ=8*") && terminal.contains("ε=1 nm*"), "{terminal}");
}

#[test]
fn e2e_few_surfaces_are_listed_and_no_interval_of_a_positive_quantity_is_negative() {
    for (count, listed) in [(3, true), (5, false)] {
        // Weak adhesion: the pull-off forces scatter by as much as their mean.
        let weak = SHARED.replace("[cycle]", "[material]\nwork_of_adhesion_j_m2 = 0.01\n[cycle]");
        let bench = Bench::new(&weak.replace("realizations = 3", &format!("realizations = {count}")));
        assert_eq!(code(&bench.verb("run", &[])), 0);
        let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
        let table = read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap();
        let (lows, means) = (table.f64("pull_off_load_ci95_low").unwrap(), table.f64("pull_off_load_mean").unwrap());
        assert!(means.iter().all(|mean| *mean > 0.0));
        let negative = lows.iter().filter(|low| **low < 0.0).count();
        let rows = cells(&page, ">Results</h2>");
        for row in &rows {
            assert_eq!(row[5].matches(';').count(), if listed { count - 1 } else { 0 }, "{row:?}");
            // A/A0, F_po, Θ, Θ_DK and Θ/Θ_DK.
            assert!([3, 5, 6, 7, 8].iter().all(|k| !row[*k].contains("[−") && !row[*k].starts_with('−')), "{row:?}");
        }
        assert_eq!(rows.iter().filter(|row| row[5].contains("[0†")).count(), if listed { 0 } else { negative });
        assert!(negative > 0, "no interval reaches below zero: this shows nothing");
    }
}

fn compare(folders: &[&Bench], out: &Path) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
    command.args(["report", "--force", "--compare"]).args(folders.iter().map(|bench| bench.out())).arg("--out").arg(out);
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
        assert_eq!(table.text("interaction").unwrap()[k], "none", "parameters of the compared case");
        let (mine, other) = (losses(&alone, ids[k], loads[k]), losses(&spots, others[k], loads[k]));
        let each: Vec<f64> = mine.iter().zip(&other).map(|(a, b)| a - b).collect();
        let sample = Sample::of(&each);
        assert!((difference[k] - sample.mean.unwrap()).abs() < 1e-15 && (half[k].unwrap() - sample.ci95.unwrap()).abs() < 1e-15);
    }
    // Cases are in the order of their parameters.
    let zeta = table.f64_or_null("magnification").unwrap();
    let order: Vec<(f64, f64)> = rows(&table, "loss").into_iter().map(|k| (zeta[k].unwrap(), loads[k])).collect();
    assert_eq!(order, [(6.0, 0.001), (6.0, 0.002), (8.0, 0.001), (8.0, 0.002)]);
    let page = fs::read_to_string(out.join("comparison.html")).unwrap();
    assert!(page.contains("differ in interaction") && page.contains("3 pairs") && !page.contains("NaN"));
    assert!(page.contains("<figcaption>") && !page.contains("panels.parquet"), "a comparison has no table of panels");
    assert!(out.join("figures/compare0_A.svg").is_file() && out.join("figures/compare3_E.svg").is_file());

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
    assert!(fs::read_to_string(out.join("comparison.html")).unwrap().contains("the realizations only"));

    // What cannot be compared is refused with a sentence.
    let none = Bench::new(&spec(7, "spots").replace("max_load = [0.001, 0.002]", "max_load = [0.003]"));
    assert_eq!(code(&none.verb("run", &["--until", "aggregate"])), 0);
    let said = stderr(&compare(&[&spots, &none], &out));
    assert!(said.contains("no case with otherwise equal parameters is in all runs"), "{said}");
    let said = stderr(&compare(&[&spots, &Bench::new(SPEC)], &out));
    assert!(said.starts_with("error: cannot") && said.contains("statistics/cases.parquet"), "{said}");
}

#[test]
fn e2e_the_spec_chooses_the_files_of_the_figures() {
    let chosen =
        SPEC.replace("seed = 7", "seed = 7\nfigures = { format = [\"svg\", \"png\"], width_mm = 120, font = \"Latin Modern Sans\" }");
    let bench = Bench::new(&chosen);
    let ended = bench.verb("run", &[]);
    assert_eq!(code(&ended), 0, "{}", stderr(&ended));
    let said = stdout(&ended);
    assert_eq!(said.contains("\nFigures: SVG; PNG needs"), !cfg!(feature = "raster"), "{said}");
    let written = files(&bench.out());
    assert!(
        written.contains_key(Path::new("figures/zeta_A.png")) == cfg!(feature = "raster")
            && !written.keys().any(|path| path.extension().is_some_and(|of| of == "pdf"))
    );
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert_eq!(page.contains("href=\"figures/zeta_A.png\""), cfg!(feature = "raster"));
    assert!(page.contains("href=\"figures/zeta_A.svg\"") && !page.contains(".pdf\""));
    let svg = fs::read_to_string(bench.out().join("figures/zeta_A.svg")).unwrap();
    assert!(svg.contains("font-family=\"Latin Modern Sans, DejaVu Sans, "));
    if !cfg!(feature = "raster") {
        return;
    }
    // Dots per metre: three to a pixel, 480 pixels on 120 mm.
    let png = fs::read(bench.out().join("figures/zeta_A.png")).unwrap();
    let at = png.windows(4).position(|four| four == b"pHYs").unwrap() + 4;
    assert_eq!(u32::from_be_bytes(png[at..at + 4].try_into().unwrap()), 12_000);
}

#[test]
fn e2e_a_page_of_progress_is_there_until_the_run_ends() {
    let bench = Bench::new(SPEC);
    let page = bench.out().join("progress.html");
    let mut child = bench.command("run").stderr(std::process::Stdio::null()).stdout(std::process::Stdio::null()).spawn().unwrap();
    let mut seen = String::new();
    while child.try_wait().unwrap().is_none() {
        seen = fs::read_to_string(&page).unwrap_or(seen);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(child.wait().unwrap().success());
    assert!(seen.contains("<meta http-equiv=\"refresh\" content=\"5\">") && seen.contains("<td>generate</td><td>"), "{seen}");
    assert!(!page.exists() && bench.out().join("report.html").is_file());
    // A power cut leaves an empty page, which the next run removes.
    fs::write(&page, "").unwrap();
    assert!(code(&bench.verb("run", &[])) == 0 && !page.exists());
}
