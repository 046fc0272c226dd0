//! Lattice trapping: a straight front that moves on and back loses no energy.

use super::{BONDED, problem, settle};
use hysteron::physics::elements::equilibrium::minimise::{Accuracy, Minimiser};
use hysteron::physics::elements::grid::half_space::HalfSpace;
use hysteron::physics::elements::grid::medium::Medium;
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::problem::{Problem, State};
use std::f64::consts::{PI, TAU};

const ALPHA: f64 = 0.3;

fn advance(problem: &Problem, minimiser: &mut Minimiser, state: &mut State, approach: f64) -> f64 {
    state.mean_penetration = approach;
    let accuracy = Accuracy { rms: 1e-7, largest: 1e-5, iterations: 20_000 };
    settle(problem, state, |state| minimiser.minimise(problem, state, accuracy)).load
}

/// Energy lost over a sub-cycle on the stable branch, over Δγ and the area that the two fronts sweep.
fn trapped(n: usize, law: impl Fn(f64) -> Law) -> f64 {
    trapped_by(n, law, 0.0)
}

/// As [`trapped`], with the compliance of a wall that is a part of the operator.
pub(super) fn trapped_by(n: usize, law: impl Fn(f64) -> Law, wall_compliance: f64) -> f64 {
    let h = n as f64 / 50.0;
    let work = (ALPHA * PI / 2.0_f64.sqrt() / 50.0).powi(2) * n as f64;
    let mut problem = problem(1, n, |_, k| h * (TAU * k as f64 / n as f64).cos(), law(work), BONDED);
    if wall_compliance > 0.0 {
        problem.half_space = HalfSpace::of(&Medium { wall_compliance, ..Medium::default() }, 1, n).unwrap();
    }
    let mut minimiser = Minimiser::new(&problem).unwrap();
    let mut state = problem.apart(0.0).unwrap();
    // To the stable branch, then to and fro by 0.2 h, once before the measured cycle.
    let (low, high, steps) = (0.05 * h, 0.25 * h, 60);
    advance(&problem, &mut minimiser, &mut state, 0.0);
    let mut lost = 0.0;
    let mut swept = 0.0;
    for round in 0..2 {
        let mut path = Vec::new();
        for k in (0..=steps).chain((0..steps).rev()) {
            let approach = low + (high - low) * f64::from(k) / f64::from(steps);
            path.push((approach, advance(&problem, &mut minimiser, &mut state, approach)));
            if k == steps && round == 1 {
                swept += problem.totals(&state).contact as f64;
            }
        }
        if round == 1 {
            swept -= problem.totals(&state).contact as f64;
            lost = path.windows(2).map(|w| 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0)).sum();
        }
    }
    assert!(swept >= 4.0, "the fronts have moved by {swept} points");
    lost / (work * swept)
}

/// Below 1e-3 Δγ for the law of the crack, whatever part of a spacing the front moves; above 0.1 for Morse's law of half the permitted range.
#[test]
fn val_lattice_trapping() {
    for n in [64, 128] {
        let crack = trapped(n, Law::crack);
        assert!(crack.abs() < 1e-3, "trapped {crack:e} Δγ at {n} points");
    }
    let short = trapped(128, |work| Law::morse(work, 0.5 * work.sqrt()));
    assert!(short > 0.1, "trapped {short} Δγ with a range that is too short");
}
