//! Another program on the same problem: Adhesion, with plain attraction. Its loads and areas are in tests/reference/adhesion.csv.

use super::{accuracy, problem};
use crate::reference::table;
use hysteron::physics::elements::equilibrium::minimise::Minimiser;
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::problem::Attraction;
use std::f64::consts::TAU;

/// The heights of tests/reference/adhesion.py.
fn wavy(n: usize, row: usize, column: usize) -> f64 {
    let waves = [(1.0, 0.0, 0.4, 1.6), (0.0, 1.0, 1.9, 1.4), (2.0, 1.0, 3.0, 0.7), (1.0, -3.0, 5.1, 0.45), (3.0, 2.0, 0.2, 0.4)];
    let unit = TAU / n as f64;
    waves.iter().map(|(kx, ky, phase, height)| height * (unit * (kx * row as f64 + ky * column as f64) + phase).cos()).sum()
}

/// Loading by Morse's law of a given range: 21 states with the same points in contact, and loads that differ by less than 1e-6 of the largest, ten times the
/// tolerance of either program.
#[test]
fn val_adhesion_finds_the_same_states() {
    let table = table("adhesion");
    let rows: Vec<_> = table.rows().collect();
    let problem = problem(32, 32, |row, column| wavy(32, row, column), Law::morse(0.02, 0.12), Attraction::Range);
    let mut minimiser = Minimiser::new(&problem).unwrap();
    let mut state = problem.apart(0.0).unwrap();
    let largest = rows.iter().map(|row| row.number("load")).fold(0.0, f64::max);
    assert!(rows.len() == 21 && largest > 50.0);
    for row in rows {
        let [approach, load, contact] = ["approach", "load", "contact_points"].map(|name| row.number(name));
        state.mean_penetration = approach;
        assert!(minimiser.minimise(&problem, &mut state, accuracy(1e-7)).converged);
        let totals = problem.totals(&state);
        assert!((totals.load - load).abs() < 1e-6 * largest, "load {} at {approach}, Adhesion has {load}", totals.load);
        assert_eq!(totals.contact as f64, contact, "points in contact at {approach}");
    }
}
