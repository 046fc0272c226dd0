//! Tables of statistics.

use std::path::{Path, PathBuf};

use hysteron::stats::{
    CaseInput, Planned, Point, STATIONS, Sample, Shown, StatsError, TENSION_STATIONS, Value, Walk, avalanches, cases, curves, planned,
    realizations, summary, t_quantile,
};
use hysteron::store::Frame;
use hysteron::store::parquet::{read_table, write_table};

use crate::steps::{Bench, ENERGY_J, Step, case, cycle, realistic, write, write_events};

/// Probability, degrees of freedom, quantile.
const KNOWN_T: [(f64, usize, f64); 9] = [
    (0.975, 1, 12.706_204_736_174_705),
    (0.975, 2, 4.302_652_729_749_464),
    (0.975, 5, 2.570_581_835_636_315_5),
    (0.975, 10, 2.228_138_851_986_275),
    (0.975, 30, 2.042_272_456_301_238),
    (0.975, 999, 1.962_341_461_133_45),
    (0.95, 5, 2.015_048_373_333_024),
    (0.995, 3, 5.840_909_309_733_357),
    (0.6, 4, 0.270_722_294_707_597_4),
];

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs().max(1e-300), "{a} is not {b}");
}

/// A cycle with two turning points and jumps on both branches, times a factor for its areas.
fn by_hand(path: &Path, factor: f64) {
    let steps: Vec<Step> = [
        ("loading", None, 0.0, 0.0, 0.0, 0.0),
        ("loading", None, -0.001, 0.02, 0.0, 0.0),
        ("loading", None, 0.001, 0.03, 0.2, 0.5e-9),
        ("loading", None, 0.0005, 0.05, 0.25, 0.6e-9),
        ("loading", None, 0.004 * (1.0 - 1e-10), 0.08, 0.6, 5e-9),
        ("loading", None, 0.0071, 0.12, 0.9, 9e-9),
        ("unloading", Some(0.0071), 0.003, 0.1, 0.7, -3e-9),
        ("unloading", Some(0.0071), -0.003, 0.04, 0.3, -2.5e-9),
        ("unloading", Some(0.0071), 0.0, 0.0, 0.0, -2e-9),
        ("unloading", Some(0.004), 0.002, 0.07, 0.5, -1e-9),
        ("unloading", Some(0.004), 0.0, 0.05, 0.4, -2.5e-9),
        ("unloading", Some(0.004), -0.002, 0.03, 0.2, -2.2e-9),
        ("unloading", Some(0.004), -0.001, 0.01, 0.1, -2.1e-9),
        ("unloading", Some(0.004), 0.0, 0.0, 0.0, -2e-9),
    ]
    .into_iter()
    .map(|(branch, max_load, load, area, depth, work)| (branch, max_load, load, area * factor, depth, work))
    .collect();
    write(path, &steps);
}

fn bench(factors: &[f64]) -> Bench {
    let directory = tempfile::tempdir().unwrap();
    let cases = vec![case("c1", "fig3", 0.8, 128.0, &[0.0071, 0.004]), case("c0", "fig4", 0.8, 64.0, &[0.0071])];
    let cycles = factors.iter().enumerate().map(|(at, factor)| {
        let path: PathBuf = directory.path().join(format!("{at}.parquet"));
        by_hand(&path, *factor);
        cycle("c1", at as i64, &path, 2e-8)
    });
    let cycles = cycles.collect();
    Bench { directory, cases, cycles }
}

fn row(frame: &Frame, name: &str, at: usize) -> Option<f64> {
    frame.f64_or_null(name).unwrap()[at]
}

#[test]
fn val_t_quantiles_agree_with_thirty_digit_ones() {
    // mpmath, regularized incomplete beta function at 30 digits.
    for (probability, freedom, known) in KNOWN_T {
        close(t_quantile(probability, freedom).unwrap(), known, 1e-12);
    }
}

#[test]
fn law_t_quantile_is_odd_about_a_half_and_refuses_what_has_none() {
    close(t_quantile(0.025, 7).unwrap(), -t_quantile(0.975, 7).unwrap(), 1e-12);
    assert!(t_quantile(0.5, 3).unwrap().abs() < 1e-12);
    for (probability, freedom) in [(0.975, 0), (0.0, 3), (1.0, 3), (f64::NAN, 3)] {
        assert_eq!(t_quantile(probability, freedom), None);
    }
}

#[test]
fn val_sample_by_hand() {
    let sample = Sample::of(&[1.0, 2.0, 3.0, 6.0]);
    close(sample.mean.unwrap(), 3.0, 1e-15);
    close(sample.sd.unwrap(), (14.0_f64 / 3.0).sqrt(), 1e-15);
    close(sample.ci95.unwrap(), 3.182_446_305_284_263 * (14.0_f64 / 12.0).sqrt(), 1e-12);
    assert_eq!(Sample::of(&[4.0]), Sample { count: 1, mean: Some(4.0), sd: None, ci95: None });
    assert_eq!(Sample::of(&[]), Sample { count: 0, mean: None, sd: None, ci95: None });
}

#[test]
fn val_walk_takes_the_first_crossing_from_the_turning_point() {
    let walk = Walk(
        [(4.0, 8.0), (0.5, 5.0), (1.0, 3.0), (-1.0, 2.0), (0.0, 0.0)]
            .map(|(load, area)| Point { load, area, penetration: 2.0 * area })
            .to_vec(),
    );
    close(walk.at(0.8).unwrap().area, 8.0 - 3.0 * 3.2 / 3.5, 1e-15);
    close(walk.at(0.8).unwrap().penetration, 16.0 - 6.0 * 3.2 / 3.5, 1e-15);
    close(walk.at(0.0).unwrap().area, 2.5, 1e-15);
    close(walk.at(4.0).unwrap().area, 8.0, 0.0);
    close(walk.at(-1.0).unwrap().area, 2.0, 0.0);
    assert_eq!((walk.at(4.1), walk.at(-1.1)), (None, None));
    close(walk.greatest_tension(), -1.0, 0.0);
    let stations = walk.stations(4.0);
    assert_eq!(stations.len(), STATIONS);
    assert!(stations.iter().all(Option::is_some));
    close(stations[STATIONS - 1].unwrap().load, -1.0, 0.0);
}

#[test]
fn val_realization_from_work_and_loads() {
    let bench = bench(&[1.0]);
    let frame = realizations(&bench.cases, &bench.cycles).unwrap();
    assert_eq!(frame.f64("max_load").unwrap(), [0.004, 0.0071]);
    close(row(&frame, "loss_j", 0).unwrap(), 3e-9, 1e-12);
    close(row(&frame, "loss_j", 1).unwrap(), 7e-9, 1e-12);
    close(row(&frame, "loss", 0).unwrap(), 3e-9 / ENERGY_J, 1e-12);
    close(row(&frame, "pull_off_load", 0).unwrap(), 0.002, 1e-15);
    close(row(&frame, "pull_off_load_n", 1).unwrap(), 0.003, 1e-15);
    close(row(&frame, "area_at_max_load", 0).unwrap(), 0.08, 1e-15);
    close(row(&frame, "area_union_at_max_load", 0).unwrap(), 0.072, 1e-12);
    close(row(&frame, "penetration_at_max_load", 1).unwrap(), 0.9, 1e-15);
    close(row(&frame, "loss_dk", 0).unwrap(), 2e-8 * 0.08 / ENERGY_J, 1e-12);
    close(row(&frame, "loss_ratio_dk", 0).unwrap(), 3e-9 / (2e-8 * 0.08), 1e-12);
    close(row(&frame, "dissipated_j", 0).unwrap(), 5.0 * 1e-10 + 5.0 * 2e-10, 1e-12);
    close(row(&frame, "audit_gap", 0).unwrap(), 0.5, 1e-12);
    close(row(&frame, "covered_share", 0).unwrap(), 0.05, 1e-12);
    close(row(&frame, "touching_share", 0).unwrap(), 1.0 / 19.0, 1e-12);
    assert_eq!(frame.i64("held_count").unwrap()[0], 1);
    assert_eq!(frame.i64("step_count").unwrap(), [10, 9]);
    assert_eq!(frame.i64("unconverged_count").unwrap(), [1, 1]);
    assert_eq!(frame.text("sweep").unwrap(), ["fig3", "fig3"]);
}

#[test]
fn law_a_load_that_jumps_over_its_turning_point_turns_where_it_jumps() {
    // From 0.0039 the load jumps to 0.0041; unloading begins there, and no loading step has 0.004.
    let bench = bench(&[1.0]);
    let path = bench.directory.path().join("jump.parquet");
    let up = |load: f64, area: f64, penetration: f64| ("loading", None, load, area, penetration, 1e-9);
    let down = |load: f64, area: f64, penetration: f64| ("unloading", Some(0.004), load, area, penetration, -5e-10);
    write(
        &path,
        &[
            up(0.0, 0.0, 0.0),
            up(0.0039, 0.04, 0.6),
            up(0.0041, 0.06, 0.6),
            down(0.0041, 0.06, 0.6),
            down(0.001, 0.02, 0.2),
            down(0.0, 0.0, -0.1),
        ],
    );
    let jump = [case("c0", "jump", 0.8, 64.0, &[0.004])];
    let frame = realizations(&jump, &[cycle("c0", 0, &path, 2e-8)]).unwrap();
    close(row(&frame, "area_at_max_load", 0).unwrap(), 0.06, 1e-15);
    close(row(&frame, "loss_j", 0).unwrap(), 5e-10, 1e-12);
}

#[test]
fn val_case_means_by_hand() {
    let bench = bench(&[1.0, 2.0, 1.5]);
    let frame = cases(&realizations(&bench.cases, &bench.cycles).unwrap(), &bench.cases).unwrap();
    assert_eq!(frame.text("case_id").unwrap(), ["c1", "c1", "c0"]);
    close(row(&frame, "area_at_max_load_mean", 1).unwrap(), 0.18, 1e-14);
    close(row(&frame, "area_at_max_load_sd", 1).unwrap(), 0.06, 1e-14);
    let half = 4.302_652_729_749_46 * 0.06 / 3.0_f64.sqrt();
    close(row(&frame, "area_at_max_load_ci95_low", 1).unwrap(), 0.18 - half, 1e-9);
    close(row(&frame, "area_at_max_load_ci95_high", 1).unwrap(), 0.18 + half, 1e-9);
    assert_eq!(frame.i64("done_count").unwrap(), [3, 3, 0]);
    assert_eq!(frame.i64("planned_count").unwrap(), [6, 6, 6]);
    // At the larger load events and loop differ by more than half of Θ, which is then not resolved.
    assert_eq!(frame.text("caution").unwrap(), ["incomplete+unconverged+audit", "incomplete+unconverged+unresolved+audit", "incomplete"]);
}

#[test]
fn law_one_realization_has_no_spread() {
    let bench = bench(&[1.0]);
    let frame = cases(&realizations(&bench.cases, &bench.cycles).unwrap(), &bench.cases).unwrap();
    close(row(&frame, "loss_mean", 0).unwrap(), 3e-9 / ENERGY_J, 1e-12);
    assert_eq!((row(&frame, "loss_sd", 0), row(&frame, "loss_ci95_low", 0)), (None, None));
    let paths = curves(&bench.cases, &bench.cycles).unwrap();
    assert!(paths.f64_or_null("area_sd").unwrap().iter().all(Option::is_none));
}

#[test]
fn law_nothing_finished_is_still_a_table() {
    let bench = bench(&[]);
    let rows = realizations(&bench.cases, &bench.cycles).unwrap();
    assert_eq!(rows.row_count(), 0);
    let frame = cases(&rows, &bench.cases).unwrap();
    assert_eq!((frame.row_count(), row(&frame, "loss_mean", 0)), (3, None));
    assert_eq!(curves(&bench.cases, &bench.cycles).unwrap().row_count(), 0);
    assert!(summary(&frame, None, None, Shown::All).unwrap().contains("0/6"));
}

#[test]
fn law_order_of_inputs_changes_nothing() {
    let mut bench = bench(&[1.0, 1.1, 0.7, 1.3]);
    let all = |bench: &Bench| {
        let rows = realizations(&bench.cases, &bench.cycles).unwrap();
        (cases(&rows, &bench.cases).unwrap(), curves(&bench.cases, &bench.cycles).unwrap(), rows)
    };
    let before = all(&bench);
    bench.cycles.rotate_left(1);
    bench.cycles.swap(0, 2);
    assert_eq!(before, all(&bench));
    // The order of the cases is that of the spec, which the table `cases` keeps; the other tables are ordered by the ids.
    assert_eq!(before.0.text("case_id").unwrap(), ["c1", "c1", "c0"]);
    assert_eq!(before.0.f64("max_load").unwrap(), [0.004, 0.0071, 0.0071]);
    bench.cases.reverse();
    let reversed = all(&bench);
    assert_eq!(reversed.0.text("case_id").unwrap(), ["c0", "c1", "c1"]);
    assert_eq!((&before.1, &before.2), (&reversed.1, &reversed.2));
    assert!(bench.directory.path().exists());
}

#[test]
fn val_curves_read_jumps_from_the_turning_point() {
    let bench = bench(&[1.0, 3.0]);
    let frame = curves(&bench.cases, &bench.cycles).unwrap();
    let branches = frame.text("branch").unwrap();
    let max_loads = frame.f64_or_null("max_load").unwrap();
    let loads = frame.f64("load").unwrap();
    let picked = |branch: &str, max_load: Option<f64>| -> Vec<usize> {
        (0..frame.row_count()).filter(|at| branches[*at] == branch && max_loads[*at] == max_load).collect()
    };
    let loading = picked("loading", None);
    assert_eq!(loading.len(), STATIONS);
    assert!(loading.windows(2).all(|pair| loads[pair[0]] < loads[pair[1]]));
    close(loads[loading[0]], -0.001, 0.0);
    close(loads[loading[STATIONS - 1]], 0.0071, 0.0);
    // At zero load the last crossing is the jump into contact at step 1 to 2; areas 0.025 and three times that.
    close(row(&frame, "area_mean", loading[50]).unwrap(), 0.05, 1e-12);
    close(row(&frame, "area_sd", loading[50]).unwrap(), 0.05 / 2.0_f64.sqrt(), 1e-12);
    let unloading = picked("unloading", Some(0.004));
    close(row(&frame, "area_mean", unloading[0]).unwrap(), 0.16, 1e-12);
    close(row(&frame, "area_mean", unloading[75]).unwrap(), 0.14, 1e-12);
    close(row(&frame, "penetration_mean", unloading[150]).unwrap(), 0.4, 1e-12);
    close(loads[unloading[STATIONS - 1]], -0.002, 0.0);
    assert!(frame.i64("realization_count").unwrap().iter().all(|count| *count == 2));
}

/// Three unloading branches of which one ends without tension: each is read at fractions of its own maximum tensile load.
#[test]
fn val_curves_below_zero_load_are_read_at_fractions_of_each_own_tension() {
    let directory = tempfile::tempdir().unwrap();
    let tensions = [0.001, 0.004, 0.0];
    let cycles = tensions.iter().enumerate().map(|(at, tension)| {
        let path = directory.path().join(format!("{at}.parquet"));
        let steps: [Step; 4] = [
            ("loading", None, 0.0, 0.0, 0.0, 0.0),
            ("loading", None, 0.002, 0.1, 1.0, 1e-9),
            ("unloading", Some(0.002), 0.0, 0.06, 0.5, -1e-9),
            ("unloading", Some(0.002), -tension, 0.02, 0.1, -1e-9),
        ];
        write(&path, if *tension > 0.0 { &steps } else { &steps[..3] });
        cycle("c1", at as i64, &path, 2e-8)
    });
    let frame = curves(&[case("c1", "", 0.8, 128.0, &[0.002])], &cycles.collect::<Vec<_>>()).unwrap();
    let unloading = frame.row_count() - STATIONS..frame.row_count();
    let rules = frame.text("station").unwrap();
    for at in unloading.clone() {
        let fraction = row(&frame, "tension_fraction", at);
        assert_eq!(rules[at], if fraction.is_some() { "tension_fraction" } else { "load" });
        let load = row(&frame, "load", at).unwrap();
        match fraction {
            None => assert!(load >= 0.0),
            // The mean of the three own loads, and of the areas at these; the one without tension stays at its area of zero load.
            Some(fraction) => {
                close(load, -fraction * 0.005 / 3.0, 1e-12);
                close(row(&frame, "area_mean", at).unwrap(), (2.0 * (0.06 - 0.04 * fraction) + 0.06) / 3.0, 1e-12);
            }
        }
    }
    let fractions = rules[unloading.clone()].iter().filter(|rule| **rule == "tension_fraction").count();
    assert_eq!(fractions, TENSION_STATIONS);
    close(row(&frame, "tension_fraction", unloading.end - 1).unwrap(), 1.0, 0.0);
    assert!(frame.i64("realization_count").unwrap().iter().all(|count| *count == 3));
    // While loading there is no tension, and thus no such station.
    assert!((0..unloading.start).all(|at| rules[at] == "load"));
}

#[test]
fn law_cycles_are_joined_to_their_cases() {
    let bench = bench(&[1.0, 3.0]);
    let row = |case_id: &str, realization: i64, status: &'static str, failure: Option<&str>| Planned {
        case_id: case_id.to_owned(),
        realization,
        cycle_id: format!("cycle-{case_id}-{realization}"),
        surface_id: format!("surface-{realization}"),
        status,
        failure: failure.map(str::to_owned),
        own: Vec::new(),
    };
    let rows = [row("c1", 1, "failed", Some("no equilibrium")), row("c0", 0, "planned", None), row("c1", 0, "done", None)];
    let table = planned(&bench.cases, &rows).unwrap();
    assert_eq!(table.text("cycle_id").unwrap(), ["cycle-c0-0", "cycle-c1-0", "cycle-c1-1"]);
    assert_eq!(table.text("surface_id").unwrap(), table.text("asperities_id").unwrap());
    assert_eq!(table.text("status").unwrap(), ["planned", "done", "failed"]);
    assert_eq!(table.text_or_null("failure").unwrap(), [None, None, Some("no equilibrium".to_owned())]);
    assert_eq!(table.f64("magnification").unwrap(), [64.0, 128.0, 128.0]);
    assert_eq!(table.text("sweep").unwrap(), ["fig4", "fig3", "fig3"]);
    let unknown = planned(&bench.cases, &[row("c2", 0, "done", None)]).unwrap_err();
    assert!(matches!(unknown, StatsError::UnknownCase { case_id, realization: 0 } if case_id == "c2"));

    write_events(&bench.cycles[0].steps, &[(1, "loading", None, "jump_in", 0, [0.0, -1e-3, 0.0, 1e-8, 1e-12])]);
    for table in [realizations(&bench.cases, &bench.cycles).unwrap(), avalanches(&bench.cases, &bench.cycles).unwrap()] {
        assert!(table.row_count() > 0);
        let (cycles, surfaces) = (table.text("cycle_id").unwrap(), table.text("surface_id").unwrap());
        for (at, realization) in table.i64("realization").unwrap().into_iter().enumerate() {
            assert_eq!(
                (cycles[at].to_owned(), surfaces[at].to_owned()),
                (format!("c1-cycle-{realization}"), format!("surface-{realization}"))
            );
        }
        assert_eq!(surfaces, table.text("asperities_id").unwrap());
    }
}

#[test]
fn e2e_tables_go_through_the_one_writer() {
    let bench = bench(&[1.0, 1.2]);
    let rows = realizations(&bench.cases, &bench.cycles).unwrap();
    let means = cases(&rows, &bench.cases).unwrap();
    let paths = curves(&bench.cases, &bench.cycles).unwrap();
    for frame in [rows, means, paths] {
        let path = bench.directory.path().join("table.parquet");
        write_table(&path, &frame, &[]).unwrap();
        assert_eq!(read_table(&path, frame.table()).unwrap(), frame);
    }
}

#[test]
fn law_a_damaged_table_is_a_sentence() {
    let mut bench = bench(&[1.0]);
    let whole = std::fs::read(&bench.cycles[0].steps).unwrap();
    let path = bench.directory.path().join("damaged.parquet");
    bench.cycles[0].steps = path.clone();
    for bytes in [&whole[..0], &whole[..whole.len() / 2], b"not a table at all"] {
        std::fs::write(&path, bytes).unwrap();
        let fault = realizations(&bench.cases, &bench.cycles).unwrap_err().to_string();
        assert!(fault.contains("damaged.parquet"), "{fault}");
    }
}

#[test]
fn law_faults_are_sentences() {
    let mut bench = bench(&[1.0]);
    bench.cycles[0].surface.clear();
    let lacking = realizations(&bench.cases, &bench.cycles).unwrap_err().to_string();
    assert!(lacking.contains("realizations") && lacking.contains("summit_count"), "{lacking}");
    bench.cycles[0].case_id = "c9".to_owned();
    assert!(matches!(realizations(&bench.cases, &bench.cycles), Err(StatsError::UnknownCase { .. })));
    bench.cycles[0].case_id = "c1".to_owned();
    bench.cycles[0].steps = bench.directory.path().join("absent.parquet");
    let absent = curves(&bench.cases, &bench.cycles).unwrap_err().to_string();
    assert!(absent.contains("absent.parquet"), "{absent}");
    let path = bench.directory.path().join("turn.parquet");
    write(&path, &[("loading", None, 0.003, 0.1, 0.1, 0.0), ("unloading", Some(0.004), 0.0, 0.0, 0.0, 0.0)]);
    bench.cycles[0].steps = path;
    let unturned = realizations(&bench.cases, &bench.cycles).unwrap_err().to_string();
    assert!(unturned.contains("no loading step at the turning point 0.004"), "{unturned}");
}

#[test]
fn e2e_summary_fits_a_terminal() {
    let directory = tempfile::tempdir().unwrap();
    let inputs: Vec<CaseInput> =
        [64.0, 512.0, 128.0, 256.0].iter().map(|zeta| case(&format!("id{zeta}"), "fig4", 0.8, *zeta, &[0.0071])).collect();
    let mut cycles = Vec::new();
    for input in inputs.iter().take(3) {
        for realization in 0..3_i32 {
            let path = directory.path().join(format!("{}-{realization}.parquet", input.case_id));
            let factor = 1.0 + 0.1 * f64::from(realization);
            realistic(&path, &[0.0071], 0.13 * factor, 5e-4 * factor, 4.9e-4 * factor, 2.5);
            cycles.push(cycle(&input.case_id, i64::from(realization), &path, 2e-8));
        }
    }
    let text = summary(&cases(&realizations(&inputs, &cycles).unwrap(), &inputs).unwrap(), None, None, Shown::All).unwrap();
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    // As the sweep has them.
    let places: Vec<_> = ["ζ=64", "ζ=512", "ζ=128", "ζ=256"].iter().map(|label| text.find(label).unwrap()).collect();
    assert!(places.is_sorted(), "{text}");
    assert!(text.contains("0.143±0.013") && text.contains("0.539±0.049"), "{text}");
    assert_eq!(Value::from(None::<f64>), Value::Missing);
}
