//! Adhesive boundary elements: operators, exact solutions, energy balance and the independence of the path from grid, step and threads.

mod corrected;
mod front;
pub mod golden;
mod grid_error;
mod johnson;
mod operator;
mod peer;
mod probe;
mod reversals;
mod rough;
mod shifted;
mod sphere;
mod trapping;

use hysteron::physics::elements::Numerics;
use hysteron::physics::elements::equilibrium::minimise::{Accuracy, Outcome};
use hysteron::physics::elements::grid::half_space::HalfSpace;
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::path::cycle::{Cycle, Settings, run};
use hysteron::physics::elements::problem::{Attraction, Nucleation, Problem, State, Totals};

/// The JKR limit: bonds within two points of contact, formed by touch.
const BONDED: Attraction = Attraction::Bonded { margin: 2, nucleation: 0.0, strength: f64::INFINITY };

fn accuracy(rms: f64) -> Accuracy {
    Accuracy { rms, largest: 100.0 * rms, iterations: 3000 }
}

/// A problem on `rows × columns` points from heights \[dx\], measured from their highest.
fn problem(rows: usize, columns: usize, heights: impl Fn(usize, usize) -> f64, law: Law, attraction: Attraction) -> Problem {
    let mut heights: Vec<f64> = (0..rows * columns).map(|k| heights(k / columns, k % columns)).collect();
    let top = heights.iter().copied().fold(f64::MIN, f64::max);
    heights.iter_mut().for_each(|z| *z -= top);
    Problem {
        half_space: HalfSpace::new(rows, columns).unwrap(),
        law,
        heights,
        attraction,
        machine_compliance: 0.0,
        numerics: Numerics::DEFAULT,
    }
}

/// The equilibrium that `find` leads to, with all contacts that form there.
fn settle(problem: &Problem, state: &mut State, mut find: impl FnMut(&mut State) -> Outcome) -> Totals {
    loop {
        assert!(find(state).converged);
        if problem.update_bonds(state, Nucleation::Allowed).is_empty() {
            break;
        }
    }
    problem.settle_bonds(state);
    problem.totals(state)
}

/// Settings of a path with its steps halved as by default.
fn settings(max_loads: Vec<f64>, step: f64) -> Settings {
    Settings { max_loads, step, jump_tolerance: 0.03, halvings: 6, accuracy: accuracy(1e-4), all_regions: false, summits: Vec::new() }
}

fn cycle(problem: &Problem, max_load: f64, step: f64, jump_tolerance: f64) -> Cycle {
    let settings = Settings { jump_tolerance, ..settings(vec![max_load], step) };
    run(problem, &settings, None, &mut |_| {}, &|_| {}).unwrap()
}

/// `∮F dΔ`, energy dissipated in events, and maximum tensile load.
fn sums(cycle: &Cycle) -> (f64, f64, f64) {
    let steps = &cycle.steps;
    (
        steps.iter().map(|s| s.imbalance).sum(),
        steps.iter().map(|s| s.dissipated).sum(),
        -steps.iter().map(|s| s.totals.load).fold(0.0, f64::min),
    )
}
