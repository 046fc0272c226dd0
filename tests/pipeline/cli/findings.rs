//! `findings`: the paper's findings, judged by reading.

use super::{SMALL, hysteron};
use crate::bench::{Bench, code, stderr, stdout};
use hysteron::schema::CASES;
use hysteron::store::parquet::read_table;
use serde_json::Value;

/// Two readings, each with three loads, three magnifications and two Hurst exponents.
const SPEC: &str = r#"
name = "readings"
seed = 7
realizations = 2
[surface]
magnification = 8
[cycle]
max_load = [0.002]
approach_step = 0.05
[[sweep]]
name = "load"
model.coalescence = ["cover", "none"]
model.interaction = "none"
cycle.max_load = [0.001, 0.002, 0.003]
[[sweep]]
name = "zeta"
model.coalescence = ["cover", "none"]
model.interaction = "none"
surface.magnification = [4, 6, 8]
[[sweep]]
name = "hurst"
model.coalescence = ["cover", "none"]
model.interaction = "none"
surface.hurst = [0.5, 0.8]
"#;

/// Numbers of a finding of a reading.
fn numbers(reading: &Value, finding: usize) -> Vec<f64> {
    reading["findings"][finding - 1]["numbers"].as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn near(what: &str, got: f64, want: f64) {
    // The same sums in another order.
    assert!((got - want).abs() <= 1e-12 * want.abs(), "{what}: {got} is not {want}");
}

#[test]
fn e2e_findings_are_judged_from_the_tables() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let asked = hysteron(&bench, &["findings", "out", "--json"]);
    assert_eq!(code(&asked), 0, "{}", stderr(&asked));
    let answer: Value = serde_json::from_slice(&asked.stdout).unwrap();
    let readings = answer["readings"].as_array().unwrap();
    assert_eq!((answer["findings"].as_array().unwrap().len(), readings.len()), (7, 2));
    let cases = read_table(&bench.out().join(CASES.file), &CASES).unwrap();
    let texts = |name: &str| cases.text(name).unwrap();
    let of = |name: &str| cases.f64(name).unwrap();
    let (rules, loads, zetas, hursts) = (texts("coalescence"), of("max_load"), of("magnification"), of("hurst"));
    let mean = |quantity: &str, rule: &str, [load, zeta, hurst]: [f64; 3]| {
        let row = (0..cases.row_count()).find(|k| rules[*k] == rule && [loads[*k], zetas[*k], hursts[*k]] == [load, zeta, hurst]);
        of(quantity)[row.unwrap()]
    };
    for (reading, rule) in readings.iter().zip(["cover", "none"]) {
        assert!(reading["name"].as_str().unwrap().contains(rule), "{reading}");
        let at = |quantity: &str, case: [f64; 3]| mean(quantity, rule, case);
        let forces = [0.001, 0.002, 0.003].map(|load| at("pull_off_load_mean", [load, 8.0, 0.8]));
        let (least, most) = (forces.iter().copied().fold(f64::MAX, f64::min), forces.iter().copied().fold(0.0, f64::max));
        near("spread", numbers(reading, 1)[0], 3.0 * (most - least) / forces.iter().sum::<f64>());
        let points = [0.001, 0.002, 0.003].map(|load| [at("area_at_max_load_mean", [load, 8.0, 0.8]), at("loss_mean", [load, 8.0, 0.8])]);
        // Three points: the residuals of the line of least squares are as x₃ − x₂ : x₃ − x₁ : x₂ − x₁, the middle one the largest.
        let [[x1, y1], [x2, y2], [x3, y3]] = points;
        let [u, v, w] = [x3 - x2, x3 - x1, x2 - x1];
        let middle = (y1 * u - y2 * v + y3 * w).abs() * v / (u * u + v * v + w * w);
        near("residual", numbers(reading, 2)[0], middle / y3);
        let ratio = |quantity: &str, a: [f64; 3], b: [f64; 3]| at(quantity, a) / at(quantity, b);
        let ([small, large], [rough, smooth]) = ([4.0, 8.0].map(|zeta| [0.002, zeta, 0.8]), [0.5, 0.8].map(|hurst| [0.002, 8.0, hurst]));
        let want = [ratio("area_at_max_load_mean", large, small), ratio("area_at_max_load_mean", smooth, rough)];
        numbers(reading, 4).into_iter().zip(want).for_each(|(got, want)| near("area", got, want));
        near("pull-off force over ζ", numbers(reading, 5)[0], ratio("pull_off_load_mean", large, small));
        near("dissipated energy over H", numbers(reading, 6)[1], ratio("loss_mean", smooth, rough));
        let [larger, all] = numbers(reading, 7)[..] else { panic!("two counts") };
        assert!(all == 6.0 && (0.0..=6.0).contains(&larger));
        assert_eq!((reading["failed_count"].as_i64(), reading["planned_count"].as_i64()), (Some(0), Some(10)));
    }
    let said = stdout(&hysteron(&bench, &["findings", "out"]));
    assert!(said.lines().all(|line| line.chars().count() <= 80) && said.contains("yes"), "{said}");
    // With two runs, the folder is part of the name.
    let both = stdout(&hysteron(&bench, &["findings", "out", "./out"]));
    assert!(both.contains("out: cover"), "{both}");
}

#[test]
fn e2e_a_run_without_series_has_no_findings() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "aggregate"])), 0);
    let asked = hysteron(&bench, &["findings", "out"]);
    assert_eq!(code(&asked), 1);
    assert!(
        stderr(&asked).contains("no two cases of out differ only in") && stderr(&asked).contains("\nhelp: sweep"),
        "{}",
        stderr(&asked)
    );
}
