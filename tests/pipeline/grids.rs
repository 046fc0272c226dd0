//! Loops by boundary elements on coarser grids, and the discretization errors that follow from them.

use crate::bench::{Bench, code, stderr, stdout};
use crate::elements::{campaign, statistics};
use hysteron::physics::theory::grid_convergence::grid_error;
use hysteron::schema;
use hysteron::store::Frame;
use std::fs;

/// Two surfaces of ζ = 4 on three grids: some seconds.
pub const SPEC: &str = r#"
name = "grids"
seed = 7
realizations = 2
[surface]
magnification = 4
[model]
method = "boundary_elements"
[boundary_elements]
points = [16, 32, 64]
approach_step = 0.1
[cycle]
max_load = [0.002, 0.004]
"#;

/// The same grids as cases of a sweep.
fn swept() -> String {
    SPEC.replace("points = [16, 32, 64]\n", "") + "[[sweep]]\nname = \"N\"\nboundary_elements.points = [16, 32, 64]\n"
}

const ERRORS: [&str; 5] = ["area", "pull_off", "loss", "loading", "unloading"];
const COLUMNS: [&str; 5] = ["area_at_max_load", "pull_off_load", "loss", "dissipated_loading", "dissipated_unloading"];

fn column(frame: &Frame, name: &str) -> Vec<Option<f64>> {
    frame.f64_or_null(name).unwrap().to_vec()
}

/// Runs a spec to its end.
fn finished(spec: &str) -> (Bench, String) {
    let bench = Bench::new(spec);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    let said = stdout(&run);
    (bench, said)
}

/// A list of grids and a sweep over them compute the same cycles, and the finest case has the same errors. Those of single surfaces and of
/// means are the estimate from the values in the tables.
#[test]
fn e2e_errors_of_a_list_are_those_of_a_sweep() {
    let (list, said) = finished(SPEC);
    let (sweep, of_sweep) = finished(&swept());
    let [ours, theirs] = [&list, &sweep].map(|bench| statistics(bench, &schema::REALIZATIONS));
    assert_eq!((ours.row_count(), theirs.row_count()), (4, 12));
    let finest: Vec<usize> = (0..12).filter(|row| column(&theirs, "element_points")[*row] == Some(64.0)).collect();
    let keys = |bench: &Bench| {
        let mut keys: Vec<String> = campaign(bench).distinct_cycles().into_iter().map(|unit| unit.key).collect();
        keys.sort();
        keys
    };
    assert_eq!(keys(&list), keys(&sweep));
    for (error, result) in ERRORS.iter().zip(COLUMNS) {
        let error = format!("{error}_grid_error");
        let (of_list, of_sweep) = (column(&ours, &error), column(&theirs, &error));
        let values = theirs.f64(result).unwrap();
        for (row, place) in finest.iter().enumerate() {
            assert_eq!(of_list[row], of_sweep[*place], "{error}");
            // Rows are sorted by case, load and realization: the other grids of one loop are those of equal load and realization.
            let same = |other: &usize| {
                let [loads, realizations] = ["max_load", "elements_per_wavelength"].map(|name| theirs.f64(name).unwrap());
                let numbers = theirs.i64("realization").unwrap();
                (loads[*other] == loads[*place] && numbers[*other] == numbers[*place]).then(|| (realizations[*other], values[*other]))
            };
            let mut series: Vec<(f64, f64)> = (0..12).filter_map(|other| same(&other)).collect();
            series.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (points, values): (Vec<f64>, Vec<f64>) = series.into_iter().unzip();
            assert_eq!(points, [4.0, 8.0, 16.0]);
            assert_eq!(of_list[row], Some(grid_error(&points, &values).unwrap().relative), "{error}");
        }
    }
    // A case on the coarsest grid has no error, and on the second one that of two grids.
    for (row, points) in column(&theirs, "element_points").iter().enumerate() {
        assert_eq!(column(&theirs, "loss_grid_error")[row].is_none(), *points == Some(16.0));
    }
    let [cases, swept_cases, grids] =
        [(&list, &schema::CASES), (&sweep, &schema::CASES), (&list, &schema::GRIDS)].map(|(bench, table)| statistics(bench, table));
    assert_eq!((cases.row_count(), swept_cases.row_count(), grids.row_count()), (2, 6, 6));
    for (error, result) in ERRORS.iter().zip(COLUMNS) {
        let means = grids.f64(&format!("{result}_mean")).unwrap();
        let of_cases = column(&cases, &format!("{error}_grid_error"));
        assert_eq!(of_cases, column(&swept_cases, &format!("{error}_grid_error"))[4..], "{error}");
        for load in [0, 1] {
            let of = grid_error(&[4.0, 8.0, 16.0], &means[3 * load..3 * load + 3]).unwrap();
            assert_eq!(of_cases[load], Some(of.relative), "{error}");
            assert_eq!(column(&grids, &format!("{error}_extrapolated"))[3 * load + 2], of.extrapolated, "{error}");
        }
    }
    for (text, rows) in [(&said, 2), (&of_sweep, 4)] {
        assert_eq!(text.matches("% (grid) ±").count(), rows, "{text}");
        assert!(text.contains("(two surfaces)") && text.lines().all(|line| line.chars().count() <= 80 || line.contains('/')), "{text}");
    }
    // The coarsest grid of the sweep has none to be compared with.
    assert!(!said.contains("grid error unknown") && of_sweep.matches("grid error unknown").count() == 2, "{said}{of_sweep}");
    assert!(said.matches("  A ± ").count() == 2 && said.matches(" %, F_po ± ").count() == 2, "{said}");
}

/// Loops on coarser grids are tasks: planned, counted and resumed. They are in no table of results, no figure and no explorer.
#[test]
fn e2e_coarser_grids_are_tasks_and_no_cases() {
    let bench = Bench::new(SPEC);
    let plan = stdout(&bench.verb("plan", &[]));
    assert!(plan.contains("1 case with 2 coarser grids, 2 realizations\n") && plan.contains("cycle     6 planned"), "{plan}");
    assert!(plan.contains("grid 16 to 64 points a side"), "{plan}");
    assert!(!plan.contains("warning[coarse]"), "{plan}");
    // One of two shards has one surface with all of its grids.
    assert_eq!(code(&bench.verb("cycle", &["--shard", "1/2"])), 1, "surfaces are missing");
    assert_eq!(code(&bench.verb("run", &["--until", "cycle", "--shard", "1/2"])), 0);
    let status = stdout(&bench.look("status", &[]));
    assert!(status.contains("cycle     3 done, 3 planned"), "{status}");
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    assert!(stdout(&run).contains("cycle     3 of 6 computed, 3 done before"), "{}", stdout(&run));
    assert!(stdout(&bench.verb("run", &[])).contains("Nothing to do"));
    let hidden: Vec<String> = campaign(&bench).cases.into_iter().filter(|unit| unit.case.is_coarser_grid()).map(|unit| unit.id).collect();
    assert_eq!(hidden.len(), 2);
    for table in [&schema::CASES, &schema::REALIZATIONS, &schema::CURVES, &schema::AVALANCHES, &schema::CUTOFF, &schema::GRIDS] {
        let frame = statistics(&bench, table);
        assert!(frame.text("case_id").unwrap().iter().all(|id| !hidden.iter().any(|of| of == id)), "{}", table.name);
    }
    // The table of cycles has all tasks, those of coarser grids in a sweep of that name.
    let cycles = statistics(&bench, &schema::CYCLES);
    assert_eq!(cycles.text("sweep").unwrap().iter().filter(|sweep| **sweep == "coarser grids").count(), 4);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(page.contains(">Grid error</h2>") && bench.out().join("figures/grids_1.svg").is_file());
    assert!(!page.contains("NaN") && !page.contains("Sweep coarser") && page.contains("1 case, 2 realizations each"), "page");
    assert!(hidden.iter().all(|id| !page.contains(id)));
    let case = campaign(&bench).cases[0].id.clone();
    let shown = stdout(&bench.look("show", &[&case]));
    assert!(shown.contains("\nVerdict\n  Θ = ") && shown.contains("% (grid) ±"), "{shown}");
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
}

/// Without coarser grids the error is unknown, which the end of a run says once.
#[test]
fn e2e_without_coarser_grids_the_error_is_unknown() {
    let spec = SPEC.replace("[16, 32, 64]", "32").replace("[0.002, 0.004]", "[0.004]").replace("realizations = 2", "realizations = 1");
    let (bench, said) = finished(&spec);
    assert_eq!(said.matches("help: grid error unknown; boundary_elements.points = [16, 32] estimates it").count(), 1, "{said}");
    assert_eq!(statistics(&bench, &schema::GRIDS).row_count(), 0);
    // A coarser grid of 8 points would have fewer than 4 on the shortest wavelength.
    let (_, said) = finished(&spec.replace("points = 32", "points = 16"));
    assert!(said.contains("help: grid error unknown; boundary_elements.points = [16, 32] estimates it"), "{said}");
    // Of asperities nothing is said.
    let (_, said) = finished(&spec.replace("\"boundary_elements\"", "\"asperities\""));
    assert!(!said.contains("grid error"), "{said}");
}

/// Surfaces that are added for the confidence interval have no coarser grids: the error is that of the first ones, and the sentence says so.
#[test]
fn e2e_errors_of_fewer_surfaces_say_so() {
    let sampled = "realizations = { until_relative_ci = 1e-3, min = 2, max = 3 }";
    let spec = SPEC.replace("realizations = 2", sampled).replace("[16, 32, 64]", "[16, 32]").replace("[0.002, 0.004]", "[0.004]");
    let (bench, said) = finished(&spec);
    let cases = statistics(&bench, &schema::CASES);
    assert_eq!((cases.i64("done_count").unwrap()[0], cases.i64_or_null("grid_surface_count").unwrap()[0]), (3, Some(2)));
    let words = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("% (grid, two surfaces) ±") && words.contains("% (three surfaces)"), "{said}");
}

/// A failed loop on a coarser grid leaves the results intact: exit code 0, a warning with the grid, and no failed cycle of the case.
#[test]
fn e2e_a_failed_coarser_grid_is_a_warning() {
    let spec = SPEC.replace("realizations = 2", "realizations = 1").replace("[0.002, 0.004]", "[0.004]");
    let bench = Bench::new(&spec);
    let coarser = |bench: &Bench| {
        let of = campaign(bench);
        of.cycles.iter().find(|unit| of.is_coarser_grid(unit)).map(|unit| unit.id.clone()).unwrap()
    };
    let id = coarser(&bench);
    let in_the_way = bench.out().join("cycles").join(&id).join("steps.parquet");
    fs::create_dir_all(&in_the_way).unwrap();
    let run = bench.verb("run", &[]);
    let said = stdout(&run);
    assert_eq!(code(&run), 0, "{said}{}", stderr(&run));
    let named = format!("{id} (coarser grid of 16 points a side)");
    assert!(stderr(&run).contains(&format!("{named} failed: ")), "{}", stderr(&run));
    assert!(said.contains("warning: 1 cycle on coarser grids failed: results are complete") && said.contains(&named), "{said}");
    assert!(!said.contains("1 cycle failed.") && said.contains("% (grid)"), "{said}");
    let status = stdout(&bench.look("status", &[]));
    assert!(status.contains(&format!("{named} failed")) && status.contains("All other tasks are done.\n"), "{status}");
    assert!(status.contains("warning: 1 cycle on coarser grids failed") && !status.contains("1 cycle failed."), "{status}");
    assert_eq!(statistics(&bench, &schema::CASES).i64("failed_count").unwrap()[0], 0);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(page.contains("1 cycle on coarser grids failed") && page.contains(&named) && !page.contains("banner red"), "page");
    let json: serde_json::Value = serde_json::from_str(&stdout(&bench.verb("run", &["--json"]))).unwrap();
    assert_eq!((&json["failures"][0]["coarser_grid"], &json["failures"][0]["id"]), (&true.into(), &id.clone().into()));
    // Without the folder in the way it is computed, and shown as what it is.
    fs::remove_dir(&in_the_way).unwrap();
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let shown = stdout(&bench.look("show", &[&id]));
    assert!(shown.contains("; coarser grid H") && shown.contains("\n  loss = ") && shown.contains("pull_off_load = "), "{shown}");
    let of = campaign(&bench);
    let hidden: Vec<&str> = of.cases.iter().filter(|unit| unit.case.is_coarser_grid()).map(|unit| unit.id.as_str()).collect();
    let shown = stdout(&bench.look("show", &[hidden[1]]));
    let words = shown.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains(&format!("for the grid error of case {}", of.cases[0].id)) && shown.starts_with("coarser grid "), "{shown}");
    assert!(shown.contains("\n  loss = ") && shown.contains("\n  loss_grid_error = "), "{shown}");
    let case = stdout(&bench.look("show", &[&of.cases[0].id]));
    for error in ERRORS {
        let line = case.lines().find(|line| line.starts_with(&format!("  {error}_grid_error = "))).unwrap_or_else(|| panic!("{case}"));
        assert!(line.ends_with(" %"), "{line}");
    }
}

/// A list of grids that no case reads is announced.
#[test]
fn e2e_a_list_of_grids_without_boundary_elements_has_no_effect() {
    let bench = Bench::new(&SPEC.replace("\"boundary_elements\"\n", "\"asperities\"\n"));
    for said in [stdout(&bench.verb("plan", &[])), stderr(&bench.verb("run", &["--until", "cycle"]))] {
        assert!(said.contains("warning: no case uses boundary elements: a list of grids"), "{said}");
    }
    assert!(!stdout(&Bench::new(SPEC).verb("plan", &[])).contains("has no effect"));
}
