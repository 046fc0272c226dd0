//! Boundary elements in the pipeline: tables, maps, states, statistics and both methods side by side.

use crate::bench::{Bench, code, files, stderr, stdout};
use hysteron::campaign::{Campaign, CycleUnit};
use hysteron::physics::RegionChange;
use hysteron::schema::{self, Table};
use hysteron::spec::Spec;
use hysteron::stages;
use hysteron::store::parquet::read_table;
use hysteron::store::{Frame, MAP_FIELDS};
use std::fs;
use std::process::Stdio;
use std::time::Instant;

/// Both methods on the same two surfaces of ζ = 4, on 64 x 64 points.
const SPEC: &str = r#"
name = "both"
seed = 7
realizations = 2
[surface]
magnification = 4
[boundary_elements]
precision = 1e-6
[cycle]
max_load = [0.002, 0.004]
approach_step = 0.05
[[sweep]]
name = "method"
model.method = ["asperities", "boundary_elements"]
"#;

const LOADS: [f64; 2] = [0.002, 0.004];

/// The same by boundary elements alone, on one surface.
fn alone() -> String {
    SPEC.replace("realizations = 2", "realizations = 1").replace("[\"asperities\", \"boundary_elements\"]", "\"boundary_elements\"")
}

pub fn campaign(bench: &Bench) -> Campaign {
    Campaign::new(Spec::read(bench.spec()).unwrap(), bench.out())
}

/// The cycles of boundary elements.
pub fn elements(campaign: &Campaign) -> Vec<CycleUnit> {
    campaign.distinct_cycles().into_iter().filter(|unit| campaign.cases[unit.case].case.params.elements().is_some()).collect()
}

pub fn table(campaign: &Campaign, unit: &CycleUnit, table: &'static Table) -> Frame {
    read_table(&campaign.cycle_dir(unit).join(format!("{}.parquet", table.name)), table).unwrap()
}

pub fn statistics(bench: &Bench, table: &'static Table) -> Frame {
    read_table(&bench.out().join(table.file), table).unwrap()
}

pub fn close(what: &str, got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance * want.abs(), "{what}: {got} is not {want}");
}

#[test]
fn e2e_both_methods_side_by_side() {
    let bench = Bench::new(SPEC);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let said = stdout(&run);
    assert!(said.contains("\nVerdict: ") && said.contains("\nTo open it: "), "{said}");
    let whole = stdout(&bench.verb("run", &["--verbose"]));
    assert!(whole.contains("Asperity model over boundary elements on the same surfaces"), "{whole}");
    assert!(said.contains("boundary_elements"), "{said}");
    assert!(said.lines().all(|line| line.chars().count() <= 80 || line.contains('/')), "{said}");
    // One row for each surface and load; ratios and their mean.
    let methods = statistics(&bench, &schema::METHODS);
    assert_eq!(methods.row_count(), 4);
    let realizations = statistics(&bench, &schema::REALIZATIONS);
    for name in ["area_at_max_load", "pull_off_load", "loss"] {
        let column = |end: &str| methods.f64(&format!("{name}_{end}")).unwrap();
        let (ratio, mean) = (column("ratio"), column("ratio_mean"));
        for ((ratio, asperities), elements) in ratio.iter().zip(column("asperities")).zip(column("elements")) {
            assert_eq!(*ratio, asperities / elements, "{name}");
        }
        close(name, mean[0], 0.5 * (ratio[0] + ratio[1]), 1e-14);
        assert!(column("ratio_sd")[0] > 0.0 && column("ratio_ci95_low")[0] < mean[0]);
        let all = realizations.f64(name).unwrap();
        assert!(column("elements").iter().all(|value| all.contains(value)), "{name}");
    }
    // The area of the asperity model is smaller near full contact.
    assert!(methods.f64("area_at_max_load_ratio").unwrap().iter().all(|ratio| *ratio < 1.0));
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    for part in ["Asperity model and boundary elements", "Adhesive boundary elements", "Interacting asperities"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("NaN") && !page.contains("inf"));
    let panels = statistics(&bench, &schema::PANELS);
    let of = panels.text("of").unwrap();
    for panel in ["A", "C"] {
        let here = |word: &str| (0..of.len()).any(|row| panels.text("panel").unwrap()[row] == panel && of[row].contains(word));
        assert!(here("asperities") && here("boundary_elements"), "panel {panel}");
    }
    // Boundary elements are the first single cycle; the asperity model follows.
    let section = page.split(">Single cycle</h2>").nth(1).unwrap();
    let places = ["by boundary elements with the largest mean", "by asperities with the largest mean"].map(|text| section.find(text));
    assert!(places[0].is_some() && places[0] < places[1], "{places:?}");
    // Done is done, and the files are those of their records.
    assert!(stdout(&bench.verb("run", &[])).contains("Nothing to do"));
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
    let gc = bench.look("gc", &["--dry-run"]);
    assert!(!stdout(&gc).contains("maps.h5") && !stdout(&gc).contains("turning.bin"), "{}", stdout(&gc));
    // The explorer shows the map of boundary elements beside the contact spots of the same surface.
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    let data = page.split("type=\"application/json\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let [first, second] = [&data["cycles"][0], &data["cycles"][1]];
    assert_eq!((&first["other"], second["loops"].as_array().unwrap().len()), (&serde_json::json!(1), 2));
    assert_eq!(second["other"], 0);
    // Events of all kinds have their place in the data.
    for change in RegionChange::ALL {
        assert!(data["names"].as_array().unwrap().iter().any(|name| name == change.name()), "{change:?}");
    }
    for of in second["loops"].as_array().unwrap() {
        let maps = of["maps"].as_array().unwrap();
        let reversal = maps.iter().find(|map| map["k"].as_u64() == Some(of["up"].as_u64().unwrap() - 1)).unwrap();
        let cells = reversal["pressure"].as_str().unwrap();
        // Letters beyond the middle one are compressive: about the contact area.
        let compressive = cells.chars().filter(|letter| "ghijklmnopqrstuvwxyz0123456789+/".contains(*letter) && *letter != 'g').count();
        let area = of["a"][of["up"].as_u64().unwrap() as usize - 1].as_f64().unwrap();
        assert!(cells.len() == 64 * 64 && (compressive as f64 / 4096.0 - area).abs() < 0.5 * area, "{compressive} of {area}");
    }
}

#[test]
fn e2e_the_explorer_pairs_cases_of_equal_parameters() {
    let spec = SPEC.replace("realizations = 2", "realizations = 1").replace("[0.002, 0.004]", "[0.002]");
    let bench = Bench::new(&(spec + "material.work_of_adhesion_j_m2 = [0.03, 0.07]\n"));
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    let data = page.split("type=\"application/json\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let cycles = data["cycles"].as_array().unwrap();
    assert_eq!(cycles.len(), 4);
    let name = |of: &serde_json::Value| of["name"].as_str().unwrap().replace("boundary_elements", "asperities");
    for (place, of) in cycles.iter().enumerate() {
        let other = of["other"].as_u64().unwrap() as usize;
        assert!(other != place && name(&cycles[other]) == name(of), "{} with {}", of["name"], cycles[other]["name"]);
    }
}

#[test]
fn law_tables_of_boundary_elements() {
    let bench = Bench::new(&alone());
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let campaign = campaign(&bench);
    let unit = &elements(&campaign)[0];
    let (steps, events, contacts) =
        (table(&campaign, unit, &schema::STEPS), table(&campaign, unit, &schema::EVENTS), table(&campaign, unit, &schema::CONTACTS));
    for frame in [&steps, &events, &contacts] {
        assert!(frame.row_count() > 0 && frame.text("method").unwrap().iter().all(|word| *word == "boundary_elements"));
    }
    for column in ["residual_m", "drift_m", "stability"] {
        assert!(steps.f64_or_null(column).unwrap().iter().all(Option::is_none), "{column}");
    }
    assert!(steps.f64("residual").unwrap().iter().all(|residual| *residual <= 1e-6));
    // Each load of the spec is reached, and the last state of each unloading is apart.
    let (load, of) = (steps.f64("load").unwrap(), steps.f64_or_null("max_load").unwrap());
    let (regions, area) = (steps.i64("contact_count").unwrap(), steps.f64("area_m2").unwrap());
    for max_load in LOADS {
        let reversal = steps.f64_or_null("reversal_load").unwrap().iter().position(|load| *load == Some(max_load)).unwrap();
        assert!(of[reversal].is_none() && (load[reversal] / max_load - 1.0).abs() < 2e-5, "{max_load}");
        let last = (0..load.len()).rfind(|k| of[*k] == Some(max_load)).unwrap();
        assert_eq!((regions[last], area[last]), (0, 0.0));
        // Bonds of points that have just separated may still have the tail of the law.
        assert!(load[last].abs() < 1e-5, "{}", load[last]);
    }
    // The regions of a step have its area, load and number.
    let of_step = contacts.i64("step").unwrap();
    let sum = |column: &str, step: i64| -> f64 {
        let values = contacts.f64(column).unwrap();
        (0..values.len()).filter(|row| of_step[*row] == step).map(|row| values[row]).sum()
    };
    let mut kept = of_step.clone();
    kept.dedup();
    assert_eq!(kept.len(), 4, "two load reversals and two maximum tensile loads");
    for step in kept {
        let k = step as usize;
        close("area", sum("area_m2", step), area[k], 1e-12);
        assert_eq!(of_step.iter().filter(|other| **other == step).count() as i64, regions[k]);
    }
    let radii = contacts.f64("contact_radius_m").unwrap();
    assert!(contacts.f64("area_m2").unwrap().iter().zip(&radii).all(|(area, a)| (std::f64::consts::PI * a * a / area - 1.0).abs() < 1e-12));
    assert!(contacts.i64("summit_count").unwrap().iter().sum::<i64>() > 0, "asperities inside regions");
    assert!(contacts.i64_or_null("asperity_id").unwrap().iter().all(Option::is_none));
    let kinds = ["formed", "lost", "joined", "parted", "grown", "shrunk"];
    assert!(events.text("kind").unwrap().iter().all(|kind| kinds.contains(kind)));
    let counted: i64 =
        ["jump_in", "jump_off", "snap", "merge", "split"].iter().flat_map(|kind| steps.i64(&format!("{kind}_count")).unwrap()).sum();
    assert_eq!(counted, events.row_count() as i64);
}

#[test]
fn law_the_energy_of_boundary_elements_is_that_of_their_events() {
    let bench = Bench::new(&alone());
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let frame = statistics(&bench, &schema::REALIZATIONS);
    let column = |name: &str| frame.f64(name).unwrap();
    let kinds = ["jump_in", "jump_off", "cover", "uncover", "snap", "merge", "split"];
    for row in 0..2 {
        close("events", column("dissipated_j")[row], column("loss_j")[row], 1e-3);
        let of_kinds: f64 = kinds.iter().map(|kind| column(&format!("dissipated_{kind}_j"))[row]).sum();
        close("kinds", of_kinds, column("dissipated_j")[row], 1e-9);
        close("branches", column("dissipated_loading_j")[row] + column("dissipated_unloading_j")[row], of_kinds, 1e-9);
        assert!(column("audit_gap")[row] < 0.01, "{}", column("audit_gap")[row]);
        assert!(column("pull_off_load")[row] > 0.0 && column("area_at_max_load")[row] < 1.0);
        assert_eq!(frame.f64_or_null("loss_touched").unwrap()[row], None);
        assert_eq!(column("elements_per_wavelength")[row], 16.0);
    }
    // Warnings of the asperity model are none of boundary elements.
    let cases = statistics(&bench, &schema::CASES);
    for codes in cases.text("caution").unwrap() {
        for code in ["sticky", "area", "conformed", "covered", "touching", "tabor", "few_contacts", "coarse"] {
            assert!(!codes.split('+').any(|known| known == code), "{codes}");
        }
    }
    assert_eq!((cases.text("method").unwrap()[0], cases.f64("element_points").unwrap()[0]), ("boundary_elements", 64.0));
    assert_eq!(cases.text_or_null("coalescence").unwrap()[0], None);
}

#[test]
fn e2e_threads_do_not_change_a_byte_of_boundary_elements() {
    let written = ["1", "2"].map(|threads| {
        let bench = Bench::new(&alone());
        assert_eq!(code(&bench.verb("run", &["--until", "aggregate", "--jobs", threads])), 0);
        files(&bench.out())
    });
    assert_eq!(written[0], written[1]);
}

/// With weak adhesion, where Θ is a small part of the work of the load, steps are a sixth or a thirtieth of the given one, and the residual is a sixth or a
/// tenth.
#[test]
fn e2e_weak_adhesion_has_shorter_steps() {
    let found = ["0.0001", "0.001", "0.07"].map(|work| {
        let adhesion = format!("[material]\nwork_of_adhesion_j_m2 = {work}\n[boundary_elements]\napproach_step = 0.04\nprecision = 1e-3");
        let bench = Bench::new(&alone().replace("[boundary_elements]\nprecision = 1e-6", &adhesion));
        assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
        let campaign = campaign(&bench);
        let steps = table(&campaign, &elements(&campaign)[0], &schema::STEPS);
        let loading = steps.text("branch").unwrap().iter().filter(|branch| **branch == "loading").count();
        let approach = &steps.f64("approach_m").unwrap()[..loading];
        let longest = approach.windows(2).map(|pair| (pair[1] - pair[0]) / 5e-6).fold(0.0, f64::max);
        (longest, steps.f64("residual").unwrap().iter().copied().fold(0.0, f64::max))
    });
    for ((longest, residual), (steps, precision)) in found.into_iter().zip([(30.0, 10.0), (6.0, 6.0), (1.0, 1.0)]) {
        // Rounding of the approach. The residual is that reached, at most the tolerance.
        assert!((longest - 0.04 / steps).abs() < 1e-9, "steps of {longest}, a part of {steps}");
        assert!(residual <= 1e-3 / precision, "residual of {residual}, a part of {precision}");
    }
    assert!(found[2].1 > 1e-3 / 6.0, "residual of {}", found[2].1);
}

/// Ciavarella's area from the adhesionless curve of the same surface, an independent solution that is exact for one family of contact shapes only: to 10 %
/// of that of boundary elements where adhesion is weak.
#[test]
fn val_area_from_the_adhesionless_curve() {
    let weak = alone().replace("[boundary_elements]", "[material]\nwork_of_adhesion_j_m2 = 0.002\n[boundary_elements]");
    let bench = Bench::new(&weak);
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let frame = statistics(&bench, &schema::REALIZATIONS);
    let [area, approximate] = ["area_at_max_load", "area_jkr_curve"].map(|name| frame.f64(name).unwrap());
    for row in 0..2 {
        close("area from the adhesionless curve", approximate[row], area[row], 0.1);
    }
    let campaign = campaign(&bench);
    let curve = table(&campaign, &elements(&campaign)[0], &schema::ADHESIONLESS);
    let (load, size) = (curve.f64("load_n").unwrap(), curve.f64("area_m2").unwrap());
    assert!(load.windows(2).chain(size.windows(2)).all(|pair| pair[0] <= pair[1]), "load and area grow without adhesion");
}

/// Each rule of attraction, nucleation and opening gives a whole loop. Contact without adhesion does not depend on them: the same digits.
#[test]
fn e2e_every_rule_of_boundary_elements_gives_a_loop() {
    let rules =
        ["nucleation = \"touch\"", "nucleation = \"wu\"", "opening = \"edges\"", "opening = \"anywhere\"", "attraction = \"range\""];
    let curves = rules.map(|rule| {
        let bench = Bench::new(&alone().replace("precision = 1e-6", rule));
        let run = bench.verb("run", &[]);
        assert_eq!(code(&run), 0, "{rule}: {}", stderr(&run));
        let loss = statistics(&bench, &schema::REALIZATIONS).f64("loss").unwrap();
        assert!(loss.len() == 2 && loss.iter().all(|loss| *loss > 0.0), "{rule}: {loss:?}");
        let campaign = campaign(&bench);
        let curve = table(&campaign, &elements(&campaign)[0], &schema::ADHESIONLESS);
        ["approach_m", "load_n", "area_m2"].map(|name| curve.f64(name).unwrap())
    });
    // A loop that goes farther has a longer curve.
    for (rule, curve) in rules.iter().zip(&curves) {
        let common = curve[0].len().min(curves[0][0].len());
        assert!(common > 20, "{rule}: {common} steps");
        for (one, other) in curve.iter().zip(&curves[0]) {
            assert_eq!(one[..common], other[..common], "{rule}");
        }
    }
}

/// With attraction of a range and strong adhesion the maximum tension is right after the load reversal, before a jump: whatever the step, it is found.
#[test]
fn val_a_tension_inside_the_first_step_is_found() {
    let spec = r#"
name = "po"
realizations = 1
surface.magnification = 4
material.work_of_adhesion_j_m2 = 0.5
model.method = "boundary_elements"
boundary_elements.points = 64
boundary_elements.attraction = "range"
cycle.max_load = [0.002]
[[sweep]]
name = "step"
boundary_elements.approach_step = [0.03, 0.2]
"#;
    let bench = Bench::new(spec);
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let pull_off = statistics(&bench, &schema::REALIZATIONS).f64("pull_off_load").unwrap();
    // Steps are halved until a hidden tension is below 2 %; the shorter one has half of that.
    close("F_po of long and short steps", pull_off[1], pull_off[0], 0.03);
}

/// A run that is killed at any of three times goes on to the same bytes, without repeating a finished task.
#[test]
fn e2e_killed_boundary_elements_go_on_to_the_same_bytes() {
    let undisturbed = Bench::new(&alone());
    let began = Instant::now();
    assert_eq!(code(&undisturbed.verb("run", &[])), 0);
    let long = began.elapsed();
    let whole = files(&undisturbed.out());
    for share in [0.25, 0.5, 0.75] {
        let bench = Bench::new(&alone());
        let mut child = bench.command("run").stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(long.mul_f64(share));
        child.kill().unwrap();
        child.wait().unwrap();
        let receipts = bench.receipts();
        let again = bench.verb("run", &[]);
        assert_eq!(code(&again), 0, "{}", stderr(&again));
        assert_eq!(code(&bench.look("gc", &["--delete"])), 0);
        assert!(files(&bench.out()) == whole, "killed after {share} of the time: other bytes");
        let after = bench.receipts();
        assert!(receipts.iter().all(|(path, bytes)| after[path] == *bytes), "a finished task was repeated");
    }
}

#[test]
fn e2e_a_state_in_a_file_is_enough_to_unload_by_boundary_elements() {
    let bench = Bench::new(&alone());
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
    // This is another process than the one that loaded.
    let campaign = campaign(&bench);
    let unit = &elements(&campaign)[0];
    let steps = table(&campaign, unit, &schema::STEPS);
    let of = steps.f64_or_null("max_load").unwrap();
    let column = |name: &str| steps.f64(name).unwrap();
    let (approach, load, area, work) = (column("approach_m"), column("load_n"), column("area_m2"), column("work_j"));
    for max_load in LOADS {
        let rows: Vec<usize> = (0..of.len()).filter(|k| of[*k] == Some(max_load)).collect();
        let again = stages::unload_again(&campaign, unit, max_load).unwrap();
        assert_eq!(again.steps.len(), rows.len());
        for (step, &k) in again.steps.iter().zip(&rows) {
            let got = [step.mean_penetration_m, step.load_n, step.area_m2, step.work_j];
            assert_eq!(got.map(f64::to_bits), [approach[k], load[k], area[k], work[k]].map(f64::to_bits), "step {k}");
        }
    }
    let error = stages::unload_again(&campaign, unit, 0.003).unwrap_err().to_string();
    assert!(error.contains("0.003") && error.contains("[0.002, 0.004]"), "{error}");
}

#[test]
fn e2e_boundary_elements_alone_have_figures_of_their_loop_and_contact() {
    let bench = Bench::new(&alone());
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    for stem in ["elements_loop", "elements_map", "elements_hysteresis", "elements_tension"] {
        let svg = fs::read_to_string(bench.out().join(format!("figures/{stem}.svg"))).unwrap();
        // A cell of the map is no element of its own: 64 x 64 points fit in far fewer elements and bytes.
        assert!(svg.len() < 200_000 && svg.matches('<').count() < 600, "{stem}: {} bytes", svg.len());
        assert!(page.contains(&svg[svg.find("<svg").unwrap()..]), "{stem} is not on the page");
        for format in ["png", "pdf"] {
            assert_eq!(bench.out().join(format!("figures/{stem}.{format}")).is_file(), cfg!(feature = "raster"), "{stem}.{format}");
        }
    }
    // The drawn loop is the table of steps, and its marked pull-off force that of the statistics.
    let panels = statistics(&bench, &schema::PANELS);
    let (names, curves, y) = (panels.text("panel").unwrap(), panels.text("name").unwrap(), panels.f64("y").unwrap());
    let of =
        |curve: &str| -> Vec<f64> { (0..y.len()).filter(|k| names[*k] == "elements_loop" && curves[*k] == curve).map(|k| y[k]).collect() };
    let campaign = campaign(&bench);
    let steps = table(&campaign, &elements(&campaign)[0], &schema::STEPS);
    let (loads, reversals) = (steps.f64("load").unwrap(), steps.f64_or_null("max_load").unwrap());
    let losses = statistics(&bench, &schema::CASES);
    let [of_load, loss] = ["max_load", "loss_mean"].map(|column| losses.f64(column).unwrap());
    let largest = if loss[1] > loss[0] { of_load[1] } else { of_load[0] };
    let unloading: Vec<f64> = (0..loads.len()).filter(|k| reversals[*k] == Some(largest)).map(|k| loads[k]).collect();
    // Both branches reach the reversal, at which unloading begins.
    let reversal = steps.f64_or_null("reversal_load").unwrap().iter().position(|load| *load == Some(largest)).unwrap();
    assert_eq!((of("unloading")[0], &of("unloading")[1..]), (loads[reversal], &unloading[..]));
    assert_eq!(of("loading").last(), Some(&loads[reversal]));
    let force = statistics(&bench, &schema::REALIZATIONS).f64("pull_off_load").unwrap();
    assert!(force.iter().any(|force| *force == -of("pull_off")[1]), "{force:?}");
    assert!(of("area").is_empty());
    // The integral of the difference of the branches is Θ of that load, but for the jumps inside steps.
    let x = panels.f64("x").unwrap();
    let difference: Vec<(f64, f64)> = (0..y.len()).filter(|k| names[*k] == "elements_hysteresis").map(|k| (x[k], y[k])).collect();
    let area: f64 = difference.windows(2).map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0)).sum();
    let lost = loss[0].max(loss[1]);
    assert!((area / lost - 1.0).abs() < 0.1, "{area} for {lost}");
    assert!((0..y.len()).filter(|k| names[*k] == "elements_tension").any(|k| y[k] == of("pull_off")[1]));
    // Nothing of asperities is said of such a run, neither as a warning nor in the page: the rest are names of models and of columns.
    let cautions = losses.text("caution").unwrap();
    assert!(
        losses.f64("summit_count_mean").unwrap().iter().all(|count| *count < 100.0) && !cautions[0].contains("asperities"),
        "{cautions:?}"
    );
    let parts = page.split("Spec with all defaults</h2>").next().unwrap().split("<script");
    let page: String = parts.map(|part| part.split("</script>").last().unwrap().to_lowercase()).collect();
    for text in ["asperity model", "contact spot", "contacting asperities", "asperities per surface", "absorption", "overlapping contacts"]
    {
        let at = page.find(text).map(|at| page[at..].chars().take(160).collect::<String>());
        assert_eq!(at, None, "{text}");
    }
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
}

#[test]
fn law_maps_hold_the_gap_and_the_load() {
    let bench = Bench::new(&alone());
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
    let campaign = campaign(&bench);
    let unit = &elements(&campaign)[0];
    let steps = table(&campaign, unit, &schema::STEPS);
    let file = hdf5_metno::File::open(campaign.cycle_dir(unit).join("maps.h5")).unwrap();
    let length: f64 = file.attr("length_m").unwrap().read_scalar().unwrap();
    let mut names = file.member_names().unwrap();
    names.sort();
    // Reversals, pull-off, and up to nine steps of loading and ten of each unloading.
    assert!((16..=4 + 9 + 20).contains(&names.len()), "{names:?}");
    // Each of the maps of loading is at a higher tenth of the largest load than the one before.
    let at = |name: &String| file.group(name).unwrap().attr("step").unwrap().read_scalar::<i64>().unwrap() as usize;
    let is_between = |name: &&String| file.group(name).unwrap().attr("max_load").unwrap().read_scalar::<f64>().unwrap().is_nan();
    let tenths: Vec<u32> =
        names.iter().filter(is_between).map(|name| (10.0 * steps.f64("load").unwrap()[at(name)] / LOADS[1]) as u32).collect();
    assert!(tenths.len() >= 4 && tenths.windows(2).all(|pair| pair[0] < pair[1]), "{tenths:?}");
    for name in names {
        let group = file.group(&name).unwrap();
        let number = |name: &str| group.attr(name).unwrap().read_scalar::<f64>().unwrap();
        let step = group.attr("step").unwrap().read_scalar::<i64>().unwrap() as usize;
        assert_eq!(number("approach_m"), steps.f64("approach_m").unwrap()[step]);
        let is_loading = steps.text("branch").unwrap()[step] == "loading";
        assert!(LOADS.contains(&number("max_load")) || (is_loading && number("max_load").is_nan()));
        let [gap, pressure] = MAP_FIELDS.map(|(field, _)| group.dataset(field).unwrap().read_raw::<f32>().unwrap());
        let unit_of = |field: &str| group.dataset(field).unwrap().attr("unit").is_ok();
        assert!(unit_of("gap_m") && unit_of("pressure_pa"));
        let points = (gap.len() as f64).sqrt();
        let load = pressure.iter().map(|p| f64::from(*p)).sum::<f64>() * (length / points).powi(2);
        // Compression and tension cancel, and values have 10 bits: far fewer than 1e-4 of their sum without signs.
        let whole = pressure.iter().map(|p| f64::from(p.abs())).sum::<f64>() * (length / points).powi(2);
        assert!((load - number("load_n")).abs() <= 1e-4 * whole, "{name}: {load} is not {}", number("load_n"));
        // The gap is the mean gap plus a displacement without a mean; its mean falls as the surfaces approach.
        let mean = gap.iter().map(|g| f64::from(*g)).sum::<f64>() / gap.len() as f64;
        assert!(mean > 0.0 && gap.iter().all(|g| g.is_finite()));
    }
}

/// Of a grid of more than 256 points along a side, maps between the ends of the branches have every second point.
#[test]
fn law_maps_of_a_large_grid_have_fewer_points() {
    let spec = "name = \"large\"\nseed = 7\nrealizations = 1\nmodel.method = \"boundary_elements\"\nsurface.magnification = 2\n\
                boundary_elements = { precision = 1e-3, points = 270, halvings = 0 }\nmaterial.work_of_adhesion_j_m2 = 0.01\n\
                cycle = { max_load = [0.001], approach_step = 1.0 }\n";
    let bench = Bench::new(spec);
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
    let campaign = campaign(&bench);
    let file = hdf5_metno::File::open(campaign.cycle_dir(&elements(&campaign)[0]).join("maps.h5")).unwrap();
    let length: f64 = file.attr("length_m").unwrap().read_scalar().unwrap();
    let mut counts = [0; 2];
    for group in file.groups().unwrap() {
        let stride = group.attr("stride").unwrap().read_scalar::<u64>().unwrap() as usize;
        let pressure = group.dataset("pressure_pa").unwrap().read_2d::<f32>().unwrap();
        assert_eq!(pressure.dim(), (270 / stride, 270 / stride));
        counts[stride - 1] += 1;
        // A smooth field has about its mean on every second point: 1 % of the sum without signs.
        let [mean, whole] =
            [|p: f64| p, f64::abs].map(|of| pressure.iter().map(|p| of(f64::from(*p))).sum::<f64>() / pressure.len() as f64);
        let load = group.attr("load_n").unwrap().read_scalar::<f64>().unwrap() / length.powi(2);
        assert!((mean - load).abs() < 0.01 * whole, "{mean} is not {load}");
    }
    assert!(counts[0] == 2 && counts[1] > 5, "{counts:?}");
}

#[test]
fn val_grids_and_warnings_of_boundary_elements() {
    // Eight points per shortest wavelength: a warning before and after the run.
    let spec = alone().replace("precision = 1e-6", "precision = 1e-6\npoints = 32").replace("[0.002, 0.004]", "[0.002]");
    let bench = Bench::new(&spec);
    let plan = stdout(&bench.verb("plan", &[]));
    assert!(plan.contains("warning[coarse]") && !plan.contains("warning[sticky]"), "{plan}");
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let cases = statistics(&bench, &schema::CASES);
    assert!(cases.text("caution").unwrap()[0].split('+').any(|code| code == "coarse"));
    assert_eq!(cases.f64("elements_per_wavelength_min").unwrap(), [8.0]);
}
