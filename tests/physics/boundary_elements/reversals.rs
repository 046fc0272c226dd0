//! Several load reversals of one path: they do not change one another, full contact is one of them, and a load that has no result leaves the others.

use super::{BONDED, problem, settings};
use hysteron::model::{Control, Machine, Material};
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::path::cycle::{Cycle, Step, run};
use hysteron::physics::elements::problem::{Attraction, Problem};
use hysteron::physics::elements::{Elements, Options};
use hysteron::physics::surface::HeightMap;
use hysteron::physics::{LoopError, PhysicsError};
use ndarray::Array2;
use std::f64::consts::TAU;

const N: usize = 32;

/// Waves along both directions with unequal phases and heights, in spacings.
fn wavy(height: f64) -> impl Fn(usize, usize) -> f64 {
    let unit = TAU / N as f64;
    move |row, column| {
        let [x, y] = [unit * row as f64, unit * column as f64];
        height * ((x + 0.4).cos() + (y + 1.9).cos() + 0.5 * (2.0 * x + y + 3.0).cos() + 0.3 * (x - 3.0 * y + 5.1).cos())
    }
}

/// Loads as means over the square.
fn loop_to(problem: &Problem, loads: &[f64], step: f64) -> Result<Cycle, PhysicsError> {
    let loads = loads.iter().map(|load| load * (N * N) as f64).collect();
    run(problem, &settings(loads, step), None, &mut |_| {}, &|_| {})
}

/// Unloading from a reversal: approach, load, energy and dissipated energy of each step.
fn unloading(cycle: &Cycle, reversal: usize) -> Vec<[f64; 4]> {
    let of = |step: &&Step| step.reversal == Some(reversal);
    cycle.steps.iter().filter(of).map(|s| [s.mean_penetration, s.totals.load, s.totals.energy, s.dissipated]).collect()
}

/// The search for a load leaves the path: the unloading from each load is, to the last bit, that of a run to this load alone, and of one to this load and
/// smaller ones. Events of the loading are counted once.
#[test]
fn law_smaller_loads_do_not_change_larger_ones() {
    let all = [0.003, 0.0031, 0.008, 0.02];
    for law in [0.004, 0.03] {
        let problem = problem(N, N, wavy(1.0), Law::crack(law), BONDED);
        let together = loop_to(&problem, &all, 0.08).unwrap();
        for (k, load) in all.iter().enumerate() {
            let alone = loop_to(&problem, &[*load], 0.08).unwrap();
            assert!(!unloading(&alone, 0).is_empty());
            assert_eq!(unloading(&together, k), unloading(&alone, 0), "load {load}");
            assert_eq!(together.turning[k].state, alone.turning[0].state, "load {load}");
            let lost = |cycle: &Cycle, at: usize| cycle.steps[..=at].iter().map(|step| step.dissipated).sum::<f64>();
            let [one, other] = [lost(&together, together.turning[k].step), lost(&alone, alone.turning[0].step)];
            // What a search has dissipated and the path has not yet: below the resolution of an event, 5 % of the integral of a step.
            assert!((one - other).abs() < 1e-2 * other.abs(), "load {load}: {one} and {other} dissipated on loading");
        }
        let events: f64 = together.events.iter().map(|event| event.dissipated).sum();
        let steps: f64 = together.steps.iter().map(|step| step.dissipated).sum();
        assert!((events - steps).abs() <= 1e-12 * steps && together.events.iter().all(|event| event.dissipated > 0.0));
    }
}

/// The search for a load that is not reached dissipates energy that the path never does. The unloading from a smaller load does not have to pay for it.
#[test]
fn reg_a_search_in_vain_leaves_no_debt() {
    let edges = Attraction::Bonded { margin: 2, nucleation: 0.0, strength: f64::INFINITY };
    let problem = problem(N, N, wavy(1.0), Law::crack(0.03), edges);
    let together = loop_to(&problem, &[0.003, 0.3, 0.4], 0.08).unwrap();
    assert_eq!(together.unreached.len(), 2);
    assert_eq!(unloading(&together, 0), unloading(&loop_to(&problem, &[0.003], 0.08).unwrap(), 0));
}

/// Under load control the displacement of a scan is, to the last bit, that of its mirror images.
#[test]
fn law_mirror_images_under_load_control_move_alike() {
    let n = N / 2;
    let wave = |x: f64, y: f64| 1e-6 * ((7.0 * x + 0.3).sin() + (9.0 * y + 2.0).cos() + 0.7 * (11.0 * x - 6.0 * y).sin() + x * y);
    let heights = Array2::from_shape_fn((n, n), |(i, j)| wave(i as f64 / n as f64, j as f64 / n as f64));
    let map =
        HeightMap { heights_m: heights.view(), length_m: 6.4e-5, is_periodic: false, shortest_wavelength_m: 3.2e-5, rms_height_m: 1e-6 };
    let material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.03, interaction_range_m: 1e-9 };
    let machine = Machine { control: Control::Load, ..Machine::default() };
    let options = Options { points: N, machine, approach_step: 0.1, ..Options::default() };
    let elements = Elements::new(&map, &material, &[0.004], &options).unwrap();
    let cycle = run(&elements.problem, &elements.settings, None, &mut |_| {}, &|_| {}).unwrap();
    let state = &cycle.turning[0].state;
    for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
        let at = |row: usize, column: usize| (state.displacement[row * N + column].to_bits(), state.bonds[row * N + column]);
        let images = [at(N - 1 - row, column), at(row, N - 1 - column), at(N - 1 - row, N - 1 - column)];
        assert_eq!(images, [at(row, column); 3], "row {row}, column {column}");
    }
    assert!(state.displacement.iter().any(|moved| *moved != 0.0));
}

/// Two sinusoids pressed flat: the load at which the tension in the middle of the valleys is the strength follows from the pressure of full contact,
/// `½ q h cos(q x)/(1 + q/8)` for each, with the wall of 4 E*/dx in series.
#[test]
fn val_full_contact_opens_at_its_strength() {
    let (height, q) = (0.3, TAU / N as f64);
    for strength in [0.5, 2.0] {
        let attraction = Attraction::Bonded { margin: 2, nucleation: 0.0, strength };
        let of = |row: usize, column: usize| height * ((q * row as f64).cos() + (q * column as f64).cos());
        let problem = problem(N, N, of, Law::crack(0.02), attraction);
        let load = 0.1;
        let cycle = loop_to(&problem, &[load], 0.02).unwrap();
        assert_eq!(cycle.turning[0].last.totals.contact, N * N, "A = A0");
        let first = cycle.turning[0].step + 1;
        let tension = q * height / (1.0 + q / 8.0);
        // The equilibria have a residual of 1e-4 of the maximum tension.
        let expected = tension - strength;
        assert!((cycle.least_load(first) / (N * N) as f64 - expected).abs() < 1e-3, "{}", cycle.least_load(first) / (N * N) as f64);
        let last = cycle.steps.last().unwrap();
        assert!(last.totals.contact == 0 && last.totals.load.abs() < 1e-9, "apart at the end");
        // The grid opens at its own strength of 0.69 sqrt(Δγ/(E* dx)), whatever the load before.
        let least = cycle.steps.iter().map(|step| step.totals.load).fold(0.0, f64::min) / (N * N) as f64;
        assert!(least < 0.0 && least > tension - 1.5 * problem.law.strength(), "{least}");
        let work = cycle.steps.last().unwrap().work + cycle.steps[cycle.turning[0].step].work;
        assert!(work > 0.0, "Θ = {work}");
    }
}

/// The dissipated energy of a full contact does not depend on the strength beyond that of the grid: F falls at one mean penetration, without work.
#[test]
fn law_the_strength_of_full_contact_does_no_work() {
    let loss = |strength: f64| {
        let problem = problem(N, N, wavy(0.1), Law::crack(0.02), Attraction::Bonded { margin: 2, nucleation: 0.0, strength });
        let cycle = loop_to(&problem, &[0.1], 0.02).unwrap();
        assert_eq!(cycle.turning[0].last.totals.contact, N * N);
        cycle.steps.last().unwrap().work + cycle.steps[cycle.turning[0].step].work
    };
    let [weak, strong] = [1.0, 50.0].map(loss);
    assert!((strong / weak - 1.0).abs() < 0.1, "Θ = {weak} and {strong}");
}

/// Full contact that opens at edges only has no result, and the loads before it have theirs.
#[test]
fn reg_a_load_without_result_leaves_the_others() {
    let problem = problem(N, N, wavy(0.1), Law::crack(1e-4), BONDED);
    let all = loop_to(&problem, &[0.002, 0.2, 0.21], 0.01).unwrap();
    assert!(matches!(all.unreached[..], [(1, LoopError::Closed { .. }), (2, LoopError::Closed { .. })]), "{:?}", all.unreached);
    let alone = loop_to(&problem, &[0.002], 0.01).unwrap();
    assert_eq!(unloading(&all, 0), unloading(&alone, 0));
    assert!(all.steps.iter().all(|step| step.reversal.is_none_or(|reversal| reversal == 0)));
    let error = loop_to(&problem, &[0.2], 0.01).unwrap_err();
    assert!(matches!(error, PhysicsError::Loop(LoopError::Closed { .. })), "{error}");
}
