//! Shifted copies of the coarsest grid, and the scatter that they add to the grid error.

use crate::bench::{Bench, code, stderr, stdout};
use crate::elements::{campaign, close, statistics};
use crate::grids;
use hysteron::campaign::{Campaign, CycleUnit};
use hysteron::schema::{self, Table};
use hysteron::spec::Spec;
use hysteron::stages::cycle_results;
use hysteron::stats::Value;
use hysteron::store::Frame;
use std::collections::BTreeSet;
use std::fs;

/// The spec of coarser grids with one load.
fn plain() -> String {
    grids::SPEC.replace("[0.002, 0.004]", "[0.004]")
}

/// The same with two copies of the grid of 16 points.
fn spec() -> String {
    plain().replace("approach_step", "shifted_copies = 2\napproach_step")
}

const RESULTS: [(&str, &str); 3] = [("area_at_max_load", "area"), ("pull_off_load", "pull_off"), ("loss", "loss")];

/// Columns of a table without the grid errors, as text.
fn without_errors(frame: &Frame) -> Vec<String> {
    let others = frame.columns().filter(|(column, _)| !column.name.ends_with("_grid_error"));
    others.map(|(column, data)| format!("{} {data:?}", column.name)).collect()
}

/// A result of a finished cycle at its only load.
fn result(campaign: &Campaign, unit: &CycleUnit, name: &str) -> f64 {
    let of_loads = cycle_results(campaign, unit).unwrap();
    let found = of_loads[0].1.iter().find_map(|(column, value)| match value {
        Value::Real(value) if column == name => Some(*value),
        _ => None,
    });
    found.unwrap_or_else(|| panic!("{} lacks {name}", unit.id))
}

/// Twice the sample standard deviation, over the ratio of the spacings of 16 and 64 points.
fn scatter(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    2.0 * (squares / (values.len() - 1) as f64).sqrt() / 4.0
}

fn keys(of: &Campaign) -> BTreeSet<String> {
    of.cycles.iter().map(|unit| unit.key.clone()).collect()
}

/// Copies are further tasks beside those of the list. They change the grid errors by their scatter, and nothing else in the tables.
#[test]
fn e2e_shifted_copies_change_the_grid_errors_alone() {
    let bench = Bench::new(&plain());
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let tables: [&'static Table; 3] = [&schema::CASES, &schema::REALIZATIONS, &schema::GRIDS];
    let (before, without) = (tables.map(|table| statistics(&bench, table)), campaign(&bench));
    fs::write(bench.spec(), spec()).unwrap();
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    assert!(stdout(&run).contains("cycle     4 of 10 computed, 6 done before"), "{}", stdout(&run));
    assert!(stdout(&bench.verb("run", &[])).contains("Nothing to do"));
    let (after, with) = (tables.map(|table| statistics(&bench, table)), campaign(&bench));
    assert!(keys(&without).is_subset(&keys(&with)) && keys(&with).len() == 10);
    for (before, after) in before.iter().zip(&after) {
        assert_eq!(without_errors(before), without_errors(after));
    }
    // The coarsest grid and its copies, each with the two surfaces.
    let is_of_16 = |unit: &&CycleUnit| with.cases[unit.case].case.params.elements().unwrap().points == Some(16);
    let of_16: Vec<&CycleUnit> = with.cycles.iter().filter(is_of_16).collect();
    assert_eq!(of_16.len(), 6);
    for (column, stem) in RESULTS {
        let (error, of_surface) = (format!("{stem}_grid_error"), |number: u32| {
            let own = of_16.iter().filter(|unit| with.surfaces[unit.surface].realization == number);
            own.map(|unit| result(&with, unit, column)).collect::<Vec<_>>()
        });
        let expected = |plain: f64, copies: &[f64], value: f64| plain.hypot(scatter(copies) / value.abs());
        let [rows, values] = [&before[1], &after[1]].map(|frame| frame.f64(&error).unwrap());
        for (row, number) in after[1].i64("realization").unwrap().iter().enumerate() {
            let wanted = expected(rows[row], &of_surface(*number as u32), after[1].f64(column).unwrap()[row]);
            close(&error, values[row], wanted, 1e-12);
            assert!(values[row] > rows[row]);
        }
        let means: Vec<f64> = of_surface(0).iter().zip(of_surface(1)).map(|(a, b)| 0.5 * (a + b)).collect();
        let [of_mean, with_copies] = [&before[0], &after[0]].map(|frame| frame.f64(&error).unwrap()[0]);
        let finest = after[2].f64(&format!("{column}_mean")).unwrap()[2];
        close(&error, with_copies, expected(of_mean, &means, finest), 1e-12);
        // The last row of the table of grids is that of the case.
        assert_eq!(after[2].f64_or_null(&error).unwrap()[2], Some(with_copies));
    }
}

/// Copies are planned, counted, named and resumed as coarser grids, and are in no table of results. One that fails is a warning.
#[test]
fn e2e_shifted_copies_are_hidden_tasks() {
    let bench = Bench::new(&spec());
    let plan = stdout(&bench.verb("plan", &[]));
    assert!(plan.contains("1 case with 2 coarser grids and 2 shifted copies, 2 realizations\n"), "{plan}");
    assert!(plan.contains("cycle     10 planned"), "{plan}");
    let of = campaign(&bench);
    let copy = of.cycles.iter().find(|unit| of.cases[unit.case].case.is_shifted_copy()).unwrap();
    let in_the_way = bench.out().join("cycles").join(&copy.id).join("steps.parquet");
    fs::create_dir_all(&in_the_way).unwrap();
    assert_eq!(code(&bench.verb("run", &["--until", "cycle", "--shard", "1/2"])), 0);
    let status = stdout(&bench.look("status", &[]));
    assert!(status.contains("with 2 coarser grids and 2 shifted copies") && status.contains("cycle     5 done, 5 planned"), "{status}");
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    let named = format!("{} (shifted copy of 16 points a side)", copy.id);
    assert!(stderr(&run).contains(&format!("{named} failed: ")), "{}", stderr(&run));
    assert!(stdout(&run).contains("results are complete") && stdout(&run).contains(&named), "{}", stdout(&run));
    fs::remove_dir(&in_the_way).unwrap();
    let run = bench.verb("run", &[]);
    assert!(code(&run) == 0 && stdout(&run).contains("cycle     1 of 10 computed, 9 done before"), "{}", stdout(&run));
    let hidden: BTreeSet<&str> = of.cases.iter().filter(|unit| unit.case.is_coarser_grid()).map(|unit| unit.id.as_str()).collect();
    assert_eq!((of.cases.len(), hidden.len()), (5, 4));
    for table in [&schema::CASES, &schema::REALIZATIONS, &schema::CURVES, &schema::AVALANCHES, &schema::GRIDS] {
        let frame = statistics(&bench, table);
        assert!(!frame.text("case_id").unwrap().iter().any(|id| hidden.contains(id)), "{}", table.name);
    }
    let shown = stdout(&bench.look("show", &[&copy.id]));
    assert!(shown.contains("; shifted copy H") && shown.contains("\n  loss = ") && shown.contains("shift = "), "{shown}");
    let shown = stdout(&bench.look("show", &[&of.cases[copy.case].id]));
    assert!(shown.starts_with("shifted copy "), "{shown}");
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
    // The shift is an input of the copies alone.
    for unit in &of.cycles {
        let shift = of.cycle_preimages(unit)["cycle"].pointer("/reads/boundary_elements/shift").cloned();
        assert_eq!(shift.is_some(), of.cases[unit.case].case.is_shifted_copy(), "{shift:?}");
    }
}

/// Finer grids for a required error keep the copies of the coarsest one, with the same tasks.
#[test]
fn law_refined_cases_keep_their_shifted_copies() {
    let text = spec().replace("points = [16, 32, 64]", "error = 0.1");
    let first = Spec::parse(&text, "x.toml").unwrap();
    let finer = first.refined(&[0]);
    let copies = |spec: &Spec| spec.cases.iter().filter(|case| case.is_shifted_copy()).cloned().collect::<Vec<_>>();
    assert_eq!((first.cases.len(), finer.cases.len(), copies(&first).len()), (5, 6, 2));
    assert_eq!(copies(&first), copies(&finer));
    let family = finer.cases[0].params.on_any_grid();
    assert!(finer.cases.iter().all(|case| case.params.on_any_grid() == family));
}
