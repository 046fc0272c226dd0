//! Coverage of the estimated discretization error by loops with exact results.

use super::{BONDED, johnson, probe, sphere};
use hysteron::physics::theory::grid_convergence::grid_error;

/// Numbers of grid points, and the pull-off force and dissipated energy on these grids over their exact values.
type Series = Vec<(f64, [f64; 2])>;

/// Number of intervals, and those that do not hold the exact value: of both results of every choice of grids.
fn coverage(series: &Series, choices: &[&[usize]]) -> (usize, Vec<String>) {
    let mut outside = Vec::new();
    for choice in choices {
        let points: Vec<f64> = choice.iter().map(|k| series[*k].0).collect();
        for place in [0, 1] {
            let values: Vec<f64> = choice.iter().map(|k| series[*k].1[place]).collect();
            let error = grid_error(&points, &values).unwrap();
            if (values[values.len() - 1] - 1.0).abs() > error.absolute {
                outside.push(format!("{points:?}: {values:?} ± {}", error.absolute));
            }
        }
    }
    (2 * choices.len(), outside)
}

/// Fails unless the intervals hold at least 90 % of the exact values, of at least so many.
#[track_caller]
fn assert_covers(found: impl Iterator<Item = (usize, Vec<String>)>, least: usize) {
    let (counts, outside): (Vec<usize>, Vec<Vec<String>>) = found.unzip();
    let (all, outside) = (counts.iter().sum::<usize>(), outside.concat());
    assert!(all >= least && 10 * outside.len() <= all, "outside, of {all} exact values: {outside:#?}");
}

/// Johnson's sinusoid at 17 adhesion numbers with 16 to 128 points: 34 loops as the finest of three grids, and as of two.
#[test]
fn val_grid_error_of_johnson() {
    let of = |k: i32| {
        let alpha = 0.1 + 0.025 * f64::from(k);
        let on_grid = |n: usize| {
            let [loss, force, ..] = johnson::computed(alpha, n, BONDED, None);
            (n as f64, [force, loss])
        };
        coverage(&[16, 32, 64, 128].map(on_grid).to_vec(), &[&[0, 1, 2], &[1, 2, 3], &[1, 2], &[2, 3]])
    };
    assert_covers((0..17).map(of), 2 * 68);
}

/// JKR spheres in cells of 7 to 9 a0 with 4 to 12 points per a0: 6 loops as the finest of three grids, and as of two.
#[test]
fn val_grid_error_of_spheres() {
    let of = |cell: i32| {
        let on_grid = |a0: f64| {
            let (force, loss) = sphere::sphere((f64::from(cell) * a0) as usize, a0);
            (a0, [force, loss])
        };
        let series = [4.0, 6.0, 8.0, 12.0].map(on_grid).to_vec();
        coverage(&series, &[&[0, 1, 2], &[0, 2, 3], &[1, 2, 3], &[0, 2], &[1, 3]])
    };
    assert_covers((7..=9).map(of), 2 * 15);
}

/// Probes with concentric waves at four amplitudes with 6 to 12 points per a0, which is 3 to 6 points per wave: 4 loops.
#[test]
fn val_grid_error_of_probes_with_waves() {
    let of = |alpha: f64| {
        let on_grid = |per: f64| {
            let (force, loss) = probe::wavy(alpha, per);
            (per, [force, loss])
        };
        coverage(&[6.0, 9.0, 12.0].map(on_grid).to_vec(), &[&[0, 1, 2], &[0, 2]])
    };
    assert_covers([1.0, 1.5, 2.0, 3.0].map(of).into_iter(), 16);
}
