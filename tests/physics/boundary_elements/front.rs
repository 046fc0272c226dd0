//! A contact front on a weakly rough surface: its shape against first-order perturbation of the stress intensity factor.
//!
//! Heights `ε cos qz` that vary along a straight front change its stress intensity factor by `(E*/√2) sqrt(q) ε cos qz`. A front that is displaced by `b cos qz` changes it by
//! `½ q b K0 cos qz` (Rice 1985), and by the growth κ b of the straight contact, with κ between `½ d ln K0/da`, one edge alone, and `d ln K0/da`, both edges together. With
//! `K0 = sqrt(2E*Δγ)` equilibrium has `b (½ q + κ) = ½ ε sqrt(q E*/Δγ)`.

use super::{BONDED, accuracy, problem, settle};
use hysteron::physics::elements::equilibrium::minimise::Minimiser;
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::problem::{Problem, State};
use std::f64::consts::{PI, TAU};

const COLUMNS: usize = 512;
const ALPHA: f64 = 0.3;
/// Amplitude of the base, a sinusoid of Johnson's, over its wavelength.
const SLOPE: f64 = 1.0 / 50.0;

/// Gap of the law's front at the distance `x` (spacings) from its edge, over `sqrt(Δγ dx/E*)`: `4 sqrt(x/π)` convolved with a Gaussian of width 0.6.
fn opening(x: f64) -> f64 {
    let at = |k: u32| {
        let t = 0.005 * f64::from(k);
        t * t * (-0.5 * ((x - t * t) / 0.6).powi(2)).exp()
    };
    8.0 / PI.sqrt() * 0.005 * (1..1000).map(at).sum::<f64>() / (0.6 * TAU.sqrt())
}

/// Half-width of contact in a row: mean distance of its edges from the middle, from the gap of the first open point on either side.
fn half_width(problem: &Problem, state: &State, row: usize) -> f64 {
    let middle = COLUMNS / 2;
    let unit = problem.law.work().sqrt();
    let edge = |sense: isize| {
        let gap = |step: isize| {
            let point = row * COLUMNS + (middle as isize + sense * step) as usize;
            state.displacement[point] - state.mean_penetration - problem.heights[point]
        };
        let first = (0..middle as isize - 1).find(|step| gap(*step) > problem.law.contact_gap()).unwrap();
        let (mut low, mut high) = (-3.0, 6.0);
        for _ in 0..50 {
            let x = 0.5 * (low + high);
            if opening(x) * unit < gap(first) { low = x } else { high = x }
        }
        first as f64 - low
    };
    0.5 * (edge(1) + edge(-1))
}

/// `d ln K0/da` of Johnson's contact of half-width `a` (in wavelengths) at a fixed mean gap, per wavelength: K is proportional to `(sin²πa − P)/sqrt(tan πa)`.
fn growth(a: f64) -> f64 {
    let load = (PI * a).sin().powi(2) - ALPHA * (PI * a).tan().sqrt();
    let gap = (PI * a).cos().powi(2) + 2.0 * load * (PI * a).sin().ln();
    let intensity = |a: f64| {
        let load = (gap - (PI * a).cos().powi(2)) / (2.0 * (PI * a).sin().ln());
        (((PI * a).sin().powi(2) - load) / (PI * a).tan().sqrt()).ln()
    };
    (intensity(a + 1e-5) - intensity(a - 1e-5)) / 2e-5
}

/// Amplitude of the front on a surface with one wave of `rows` points along it, and its bounds by perturbation.
fn amplitude(rows: usize) -> (f64, [f64; 2]) {
    let n = COLUMNS as f64;
    let h = SLOPE * n;
    let work = (ALPHA * PI / 2.0_f64.sqrt() * SLOPE).powi(2) * n;
    let q = TAU / rows as f64;
    let height = 0.4 * (q * work).sqrt();
    let surface = |row: usize, column: usize| -h * (TAU * column as f64 / n).cos() + height * (q * row as f64).cos();
    let problem = problem(rows, COLUMNS, surface, Law::crack(work), BONDED);
    let mut minimiser = Minimiser::new(&problem).unwrap();
    let mut state = problem.apart(0.0).unwrap();
    for step in 0..=6 {
        state.mean_penetration = height + 0.05 * h * f64::from(step);
        settle(&problem, &mut state, |state| minimiser.minimise(&problem, state, accuracy(1e-6)));
    }
    let widths: Vec<f64> = (0..rows).map(|row| half_width(&problem, &state, row)).collect();
    let mean = widths.iter().sum::<f64>() / rows as f64;
    assert!((60.0..120.0).contains(&mean), "half-width of the contact {mean}");
    let found = 2.0 / rows as f64 * widths.iter().enumerate().map(|(row, width)| width * (q * row as f64).cos()).sum::<f64>();
    (found, [1.0, 0.5].map(|part| 0.5 * height * (q / work).sqrt() / (0.5 * q + part * growth(mean / n) / n)))
}

/// The amplitude of the front lies between the bounds of the perturbation, which are 13 and 24 % apart.
#[test]
fn val_front_on_a_weak_sinusoid() {
    for rows in [32, 64] {
        let (found, [low, high]) = amplitude(rows);
        assert!(low < found && found < high, "amplitude of the front {found}, by perturbation {low} to {high}, {rows} points to a wave");
    }
}
