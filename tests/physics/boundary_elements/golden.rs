//! Whole cycles of boundary elements, pinned on two grids: a change of the solver that moves a result shows here first.
//!
//! With `HYSTERON_DIGESTS=1` and `--nocapture` the test prints the results and the BLAKE3 digest of every cycle instead, to compare two builds on one machine
//! byte by byte.

use super::{BONDED, problem, settings, sums};
use crate::support::close;
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::path::cycle::{Cycle, run};
use hysteron::physics::elements::problem::{Attraction, Problem};
use std::f64::consts::TAU;

/// Five waves with fixed phases, heights and places in sides of the square.
fn waves(x: f64, y: f64) -> f64 {
    let waves = [(1.0, 0.0, 0.4, 1.6), (0.0, 1.0, 1.9, 1.4), (2.0, 1.0, 3.0, 0.7), (1.0, -3.0, 5.1, 0.45), (3.0, 2.0, 0.2, 0.4)];
    waves.iter().map(|(kx, ky, phase, height)| 0.06 * height * (TAU * (kx * x + ky * y) + phase).cos()).sum()
}

/// Heights of a square of `n` points in spacings, or of a quarter of them with their mirror images.
fn surface(n: usize, is_mirrored: bool, law: Law, attraction: Attraction) -> Problem {
    let side = n as f64;
    let fold = |k: usize| if is_mirrored { 0.7 * (k.min(n - 1 - k) as f64 + 0.5) } else { k as f64 };
    let mut problem = problem(n, n, |row, column| side * waves(fold(row) / side, fold(column) / side), law, attraction);
    if is_mirrored {
        problem.half_space = problem.half_space.with_images();
    }
    problem
}

/// Name, problem, and what is pinned: events, share in contact and approach over the side at the first reversal, F_po/(E* A0) and Θ/(E* A0 L).
fn cases() -> Vec<(String, Problem, [f64; 5])> {
    let work = 0.0012;
    let anywhere = Attraction::Bonded { margin: 2, nucleation: 0.0, strength: 0.0 };
    let mut cases = Vec::new();
    for (n, pinned) in PINNED {
        let law = || Law::crack(work * n as f64);
        let problems = [
            ("bonded, opens from edges", surface(n, false, law(), BONDED)),
            ("bonded, opens anywhere", surface(n, false, law(), anywhere)),
            ("range", surface(n, false, Law::morse(2.5 * work * n as f64, 0.004 * n as f64), Attraction::Range)),
            ("mirror images", surface(n, true, law(), anywhere)),
        ];
        cases.extend(problems.into_iter().zip(pinned).map(|((name, problem), pinned)| (format!("{name}, {n} points"), problem, pinned)));
    }
    cases
}

const PINNED: [(usize, [[f64; 5]; 4]); 2] = [
    (
        32,
        [
            [12.0, 4.589843750e-2, 7.757780163e-2, 3.734346677e-4, 5.706610076e-6],
            [12.0, 4.589843750e-2, 7.757780163e-2, 3.734346672e-4, 5.706609800e-6],
            [175.0, 5.566406250e-2, 7.920531034e-2, 1.807254514e-3, 6.068135566e-5],
            [10.0, 8.203125000e-2, 4.687934868e-2, 1.869058877e-3, 2.643720429e-5],
        ],
    ),
    (
        48,
        [
            [27.0, 4.470486111e-2, 7.851819729e-2, 4.421680246e-4, 5.901503346e-6],
            [27.0, 4.470486111e-2, 7.851819729e-2, 4.421680250e-4, 5.901503647e-6],
            [105.0, 5.425347222e-2, 8.106232703e-2, 1.008593005e-3, 1.347415134e-5],
            [5.0, 8.333333333e-2, 4.712201324e-2, 1.628073442e-3, 2.039528488e-5],
        ],
    ),
];

fn results(problem: &Problem, cycle: &Cycle) -> [f64; 5] {
    let points = problem.heights.len() as f64;
    let (side, turn) = (points.sqrt(), &cycle.turning[0].last);
    let (area, _, tension) = sums(cycle);
    [cycle.events.len() as f64, turn.totals.contact as f64 / points, turn.mean_penetration / side, tension / points, area / points / side]
}

/// The pinned results as a text, which a [version](crate::versions) of the method has.
pub fn pinned() -> String {
    format!("{PINNED:?}")
}

/// Two load reversals; results of the first and of both loops.
#[test]
fn reg_whole_cycles_by_boundary_elements() {
    for (what, problem, pinned) in cases() {
        let points = problem.heights.len() as f64;
        let settings = settings([0.01, 0.02].map(|load| load * points).to_vec(), 0.1);
        let cycle = run(&problem, &settings, None, &mut |_| {}, &|_| {}).unwrap();
        let found = results(&problem, &cycle);
        if std::env::var_os("HYSTERON_DIGESTS").is_some() {
            let digest = blake3::hash(&postcard::to_stdvec(&cycle).unwrap()).to_hex();
            eprintln!("{what}: [{}] {digest}", found.map(|value| format!("{value:.9e}")).join(", "));
            continue;
        }
        // The order of sums differs between processors in the last digits only; a change of one event moves Θ by more than 1e-4.
        let names = ["events", "area", "approach", "pull-off force", "dissipated energy"];
        for ((name, found), pinned) in names.iter().zip(found).zip(pinned) {
            close(&format!("{what}: {name}"), found, pinned, 1e-6);
        }
    }
}
