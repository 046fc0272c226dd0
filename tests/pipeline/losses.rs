//! Where the loss goes: avalanches, and the parts of the loss by branch and by kind of event.

use std::path::{Path, PathBuf};

use hysteron::schema::{AVALANCHES, EVENT_KINDS, POOLED_EVENTS};
use hysteron::stats::{StatsError, avalanches, cases, pooled_events, realizations};
use hysteron::store::Frame;
use hysteron::store::parquet::{read_table, write_parts, write_table};

use crate::steps::{Bench, ENERGY_J, Event, Step, case, cycle, events_path, write, write_events};

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b.abs().max(1e-30), "{a} is not {b}");
}

/// A loading path that turns at its steps 2 and 3, and the two ways back.
const STEPS: [Step; 8] = [
    ("loading", None, 0.0, 0.0, 0.0, 0.0),
    ("loading", None, 0.001, 0.03, 0.2, 0.5e-9),
    ("loading", None, 0.004, 0.08, 0.6, 5e-9),
    ("loading", None, 0.0071, 0.12, 0.9, 9e-9),
    ("unloading", Some(0.0071), 0.003, 0.1, 0.7, -3e-9),
    ("unloading", Some(0.0071), 0.0, 0.0, 0.0, -2e-9),
    ("unloading", Some(0.004), 0.002, 0.07, 0.5, -1e-9),
    ("unloading", Some(0.004), 0.0, 0.0, 0.0, -2e-9),
];

/// Seven avalanches of one cycle. The first spans three kinds, the second ends at the first turning step, the third lies beyond it.
const EVENTS: [Event; 11] = [
    (1, "loading", None, "jump_in", 0, [0.10, 0.07, 1.0e-9, 1.5e-9, 3e-12]),
    (1, "loading", None, "cover", 0, [0.07, 0.08, 1.5e-9, 1.4e-9, -1e-12]),
    (1, "loading", None, "merge", 0, [0.08, 0.06, 1.4e-9, 1.8e-9, 0.5e-12]),
    (2, "loading", None, "snap", 1, [0.30, 0.29, 3.0e-9, 3.1e-9, 2e-12]),
    (3, "loading", None, "jump_in", 2, [0.60, 0.55, 6.0e-9, 6.5e-9, 8e-12]),
    (4, "unloading", Some(0.0071), "jump_off", 3, [0.20, 0.22, 4.0e-9, 3.5e-9, 5e-12]),
    (4, "unloading", Some(0.0071), "split", 3, [0.22, 0.21, 3.5e-9, 3.2e-9, 0.25e-12]),
    (4, "unloading", Some(0.0071), "uncover", 3, [0.21, 0.23, 3.2e-9, 3.0e-9, -0.5e-12]),
    (5, "unloading", Some(0.0071), "jump_off", 4, [-0.05, 0.0, 1.0e-9, 0.0, 4e-12]),
    (6, "unloading", Some(0.004), "jump_off", 5, [0.10, 0.12, 2.0e-9, 1.5e-9, 6e-12]),
    (7, "unloading", Some(0.004), "jump_off", 6, [-0.02, 0.0, 0.5e-9, 0.0, 1e-12]),
];

/// One cycle per factor, by which the energies of its events are multiplied.
fn bench(factors: &[f64]) -> Bench {
    let directory = tempfile::tempdir().unwrap();
    let mut cycles = Vec::new();
    for (at, factor) in factors.iter().enumerate() {
        let path: PathBuf = directory.path().join(format!("{at}.parquet"));
        write(&path, &STEPS);
        let mut events = EVENTS;
        events.iter_mut().for_each(|event| event.5[4] *= factor);
        write_events(&path, &events);
        cycles.push(cycle("c1", at as i64, &path, 2e-8));
    }
    Bench { directory, cases: vec![case("c1", "fig3", 0.8, 128.0, &[0.004, 0.0071])], cycles }
}

fn row(frame: &Frame, name: &str, at: usize) -> Option<f64> {
    frame.f64_or_null(name).unwrap()[at]
}

#[test]
fn val_avalanches_by_hand() {
    let bench = bench(&[1.0]);
    let frame = avalanches(&bench.cases, &bench.cycles).unwrap();
    assert_eq!(frame.row_count(), 7);
    assert_eq!(frame.text("case_id").unwrap(), ["c1"; 7]);
    assert_eq!(frame.text("sweep").unwrap(), ["fig3"; 7]);
    assert_eq!(frame.i64("realization").unwrap(), [0; 7]);
    assert_eq!(frame.i64("avalanche_id").unwrap(), [0, 1, 2, 3, 4, 5, 6]);
    assert_eq!(frame.i64("step").unwrap(), [1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(frame.i64("event_count").unwrap(), [3, 1, 1, 3, 1, 1, 1]);
    let words = frame.text("branch").unwrap();
    assert_eq!(words, ["loading", "loading", "loading", "unloading", "unloading", "unloading", "unloading"]);
    let max_loads = frame.f64_or_null("max_load").unwrap();
    assert_eq!(max_loads, [None, None, None, Some(0.0071), Some(0.0071), Some(0.004), Some(0.004)]);
    for (kind, counts) in [
        ("jump_in", [1, 0, 1, 0, 0, 0, 0]),
        ("jump_off", [0, 0, 0, 1, 1, 1, 1]),
        ("cover", [1, 0, 0, 0, 0, 0, 0]),
        ("uncover", [0, 0, 0, 1, 0, 0, 0]),
        ("snap", [0, 1, 0, 0, 0, 0, 0]),
        ("merge", [1, 0, 0, 0, 0, 0, 0]),
        ("split", [0, 0, 0, 1, 0, 0, 0]),
    ] {
        assert_eq!(frame.i64(&format!("{kind}_count")).unwrap(), counts, "{kind}");
    }
    // The one of three kinds: from before its first event to after its last.
    close(row(&frame, "energy_lost_j", 0).unwrap(), 2.5e-12);
    close(row(&frame, "energy_lost", 0).unwrap(), 2.5e-12 / ENERGY_J);
    close(row(&frame, "load_drop_n", 0).unwrap(), 0.04);
    close(row(&frame, "area_change_m2", 0).unwrap(), 0.8e-9);
    close(row(&frame, "approach_m", 0).unwrap(), 1e-8);
    // One that raises the load and gives area away.
    close(row(&frame, "load_drop_n", 3).unwrap(), -0.03);
    close(row(&frame, "area_change_m2", 3).unwrap(), -1e-9);
}

#[test]
fn law_avalanches_hold_every_event_once_in_any_order_of_the_inputs() {
    let mut bench = bench(&[1.0, 0.5, 2.0]);
    let before = avalanches(&bench.cases, &bench.cycles).unwrap();
    let sum = |name: &str| before.f64(name).unwrap().iter().sum::<f64>();
    close(sum("energy_lost_j"), 3.5 * EVENTS.iter().map(|event| event.5[4]).sum::<f64>());
    assert_eq!(before.i64("event_count").unwrap().iter().sum::<i64>(), 33);
    let by_kind: i64 = EVENT_KINDS.iter().flat_map(|kind| before.i64(&format!("{kind}_count")).unwrap()).sum();
    assert_eq!(by_kind, 33);
    bench.cycles.rotate_left(1);
    assert_eq!(avalanches(&bench.cases, &bench.cycles).unwrap(), before);
    let path = bench.directory.path().join("avalanches.parquet");
    write_table(&path, &before, &[]).unwrap();
    assert_eq!(read_table(&path, &AVALANCHES).unwrap(), before);
}

#[test]
fn law_the_pooled_events_are_those_of_the_avalanches() {
    let mut bench = bench(&[1.0, 0.5, 2.0]);
    let (path, keys) = (bench.directory.path().join("pooled.parquet"), []);
    let written = |bench: &Bench| {
        write_parts(&path, &POOLED_EVENTS, pooled_events(&bench.cases, &bench.cycles).unwrap(), &keys).unwrap();
        read_table(&path, &POOLED_EVENTS).unwrap()
    };
    let events = written(&bench);
    assert_eq!(events.row_count(), 33);
    // Sizes of the avalanches, from the events.
    let avalanches = avalanches(&bench.cases, &bench.cycles).unwrap();
    let key = |frame: &Frame, row: usize| (frame.text("cycle_id").unwrap()[row].to_owned(), frame.i64("avalanche_id").unwrap()[row]);
    for at in 0..avalanches.row_count() {
        let rows: Vec<usize> = (0..events.row_count()).filter(|row| key(&events, *row) == key(&avalanches, at)).collect();
        assert_eq!(rows.len() as i64, avalanches.i64("event_count").unwrap()[at]);
        for name in ["energy_lost_j", "energy_lost"] {
            let sum: f64 = rows.iter().map(|row| events.f64(name).unwrap()[*row]).sum();
            close(sum, avalanches.f64(name).unwrap()[at]);
        }
        assert!(rows.iter().all(|row| events.text("branch").unwrap()[*row] == avalanches.text("branch").unwrap()[at]));
    }
    // In any order of the inputs, the same bytes.
    let bytes = std::fs::read(&path).unwrap();
    bench.cycles.rotate_left(1);
    assert_eq!(written(&bench), events);
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
}

#[test]
fn val_the_loss_in_parts_by_hand() {
    let bench = bench(&[1.0]);
    let frame = realizations(&bench.cases, &bench.cycles).unwrap();
    assert_eq!(frame.f64("max_load").unwrap(), [0.004, 0.0071]);
    // Loading, unloading, then the kinds; the jump at step 3 is beyond the turning point 0.004 and in the loop to 0.0071 only.
    let parts = ["loading", "unloading", "jump_in", "jump_off", "cover", "uncover", "snap", "merge", "split"];
    let to_0_004 = [4.5e-12, 7e-12, 3e-12, 7e-12, -1e-12, 0.0, 2e-12, 0.5e-12, 0.0];
    let to_0_0071 = [12.5e-12, 8.75e-12, 11e-12, 9e-12, -1e-12, -0.5e-12, 2e-12, 0.5e-12, 0.25e-12];
    for (at, wanted) in [to_0_004, to_0_0071].iter().enumerate() {
        for (part, wanted) in parts.iter().zip(wanted) {
            close(row(&frame, &format!("dissipated_{part}_j"), at).unwrap(), *wanted);
            close(row(&frame, &format!("dissipated_{part}"), at).unwrap(), wanted / ENERGY_J);
        }
    }
    // The steps' own account of the events, in both units.
    close(row(&frame, "dissipated_j", 0).unwrap(), 3.0 * 1e-10 + 2.0 * 2e-10);
    close(row(&frame, "dissipated", 0).unwrap(), 7e-10 / ENERGY_J);
}

#[test]
fn law_branches_and_kinds_add_up_to_the_same() {
    let bench = bench(&[1.0, 0.3]);
    let frame = realizations(&bench.cases, &bench.cycles).unwrap();
    for at in 0..frame.row_count() {
        let part = |name: &str| row(&frame, &format!("dissipated_{name}_j"), at).unwrap();
        close(EVENT_KINDS.iter().map(|kind| part(kind)).sum(), part("loading") + part("unloading"));
    }
}

#[test]
fn val_the_parts_of_a_case_by_hand() {
    let bench = bench(&[1.0, 2.0, 1.5]);
    let frame = cases(&realizations(&bench.cases, &bench.cycles).unwrap(), &bench.cases).unwrap();
    // Of 1, 2 and 1.5 the mean is 1.5 and the deviation 0.5; t(0.975, 2) = 4.3027.
    let half = 4.302_652_729_749_464 * 0.5 / 3.0_f64.sqrt();
    for (name, unit) in
        [("dissipated_jump_off_j", 7e-12), ("dissipated_jump_off", 7e-12 / ENERGY_J), ("dissipated_cover", -1e-12 / ENERGY_J)]
    {
        let stat = |end: &str| row(&frame, &format!("{name}_{end}"), 0).unwrap();
        close(stat("mean"), 1.5 * unit);
        close(stat("sd"), 0.5 * unit.abs());
        close(stat("ci95_low"), 1.5 * unit - half * unit.abs());
        close(stat("ci95_high"), 1.5 * unit + half * unit.abs());
    }
    close(row(&frame, "dissipated_j_mean", 0).unwrap(), 7e-10);
    // |3e-9 - 7e-10| / 3e-9, the same in each realization.
    close(row(&frame, "audit_gap_mean", 0).unwrap(), 2.3 / 3.0);
    close(row(&frame, "audit_gap_max", 0).unwrap(), 2.3 / 3.0);
}

#[test]
fn lim_a_cycle_without_events_loses_nothing_in_them() {
    let bench = bench(&[1.0]);
    write_events(&bench.cycles[0].steps, &[]);
    let none = avalanches(&bench.cases, &bench.cycles).unwrap();
    assert_eq!(none.row_count(), 0);
    let path = bench.directory.path().join("avalanches.parquet");
    write_table(&path, &none, &[]).unwrap();
    assert_eq!(read_table(&path, &AVALANCHES).unwrap(), none);
    let rows = realizations(&bench.cases, &bench.cycles).unwrap();
    let means = cases(&rows, &bench.cases).unwrap();
    for part in ["loading", "unloading", "jump_in", "split"] {
        // Nothing lost is known to be nothing: 0, without a sign, and not missing.
        assert_eq!(row(&rows, &format!("dissipated_{part}_j"), 0).map(f64::to_bits), Some(0));
        assert_eq!(row(&means, &format!("dissipated_{part}_mean"), 0), Some(0.0));
        assert_eq!(row(&means, &format!("dissipated_{part}_sd"), 0), None);
    }
    assert_eq!(avalanches(&bench.cases, &[]).unwrap().row_count(), 0);
}

#[test]
fn law_faults_of_events_are_sentences() {
    let mut bench = bench(&[1.0]);
    let steps = bench.cycles[0].steps.clone();
    let both = |bench: &Bench| {
        let one = avalanches(&bench.cases, &bench.cycles).unwrap_err().to_string();
        assert_eq!(realizations(&bench.cases, &bench.cycles).unwrap_err().to_string(), one);
        one
    };
    write_events(&steps, &[(1, "loading", None, "vanish", 0, [0.0; 5])]);
    let unknown = both(&bench);
    assert!(unknown.contains("0.events.parquet") && unknown.contains("\"vanish\"") && unknown.contains("jump_off"), "{unknown}");
    write_events(&steps, &[(1, "loading", Some(0.004), "jump_in", 0, [0.0; 5])]);
    assert!(both(&bench).contains("loading has none, unloading has one"));
    bench.cycles[0].events = Path::new("absent.parquet").to_owned();
    assert!(both(&bench).contains("absent.parquet"));
    let damaged = events_path(&steps);
    let whole = std::fs::read(&damaged).unwrap();
    std::fs::write(&damaged, &whole[..whole.len() / 2]).unwrap();
    bench.cycles[0].events = damaged;
    assert!(both(&bench).contains("0.events.parquet"));
    bench.cycles[0].case_id = "c9".to_owned();
    assert!(matches!(avalanches(&bench.cases, &bench.cycles), Err(StatsError::UnknownCase { .. })));
}

/// Two contacts merge and part again. In one loop the splitting has its energy; in the other one contacts jump off on the way to the equilibrium after it, and
/// the first of these has the energy, caused by the splitting.
#[test]
fn val_energies_of_merging_and_splitting_cancel_whoever_is_booked() {
    let merge: Event = (1, "loading", None, "merge", 0, [0.1, 0.1, 1e-9, 1e-9, -70e-12]);
    let jump: Event = (1, "loading", None, "jump_in", 1, [0.1, 0.1, 1e-9, 1e-9, 3e-12]);
    let back = |kind, energy| -> Event { (4, "unloading", Some(0.0071), kind, 2, [0.1, 0.1, 1e-9, 1e-9, energy]) };
    let own = [merge, jump, back("split", 69.5e-12)];
    let other = [merge, jump, back("split", 0.0), back("jump_off by split", 69.5e-12), back("jump_off", 0.0), back("cover", 1e-12)];
    for (events, coalescence, jumps) in [(&own[..], -0.5e-12, 0.0), (&other, 0.5e-12, 0.0)] {
        let bench = bench(&[1.0]);
        write_events(&bench.cycles[0].steps, events);
        let frame = realizations(&bench.cases, &bench.cycles).unwrap();
        let at = |name: &str| row(&frame, name, 1).unwrap();
        // Not to the last digit: -70 + 69.5 cancels.
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-24, "{a} is not {b}");
        near(at("dissipated_split_j"), 69.5e-12);
        near(at("dissipated_jump_off_j"), jumps);
        near(at("absorption_share") * at("loss_j"), f64::abs(coalescence));
        assert!(at("absorption_share") < 1.0);
    }
}
