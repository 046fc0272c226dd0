//! One sphere in a periodic square against JKR, and without adhesion against Hertz.

use super::{BONDED, cycle, problem, sums};
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::problem::Attraction;
use std::f64::consts::PI;

/// Mean displacement under the images of a periodic square with a self-balanced load, `Δ = δ − 3.900265 F/(πE*L)`.
const IMAGES: f64 = 3.900_265;
/// Dissipated energy of the loop from the touch at δ = 0, in `2E*R³(πΔγ/(E*R))^(5/3)`.
const LOOP: f64 = 0.526_220_3;

/// Pull-off force and dissipated energy in control of the mean approach in a square of side `side`, by quadrature of the JKR branch:
/// `δ = a²/R − sqrt(2πΔγa/E*)`, `F = 4E*a³/(3R) − sqrt(8πΔγE*a³)`, touch at Δ = 0 and separation where Δ turns.
fn jkr(radius: f64, work: f64, side: f64) -> (f64, f64) {
    let branch = |a: f64| {
        let force = 4.0 / 3.0 * a.powi(3) / radius - (8.0 * PI * work * a.powi(3)).sqrt();
        (a * a / radius - (2.0 * PI * work * a).sqrt() - IMAGES * force / (PI * side), force)
    };
    let widest = 2.0 * (2.0 * PI * work * radius * radius).cbrt();
    let points: Vec<(f64, f64)> = (1..100_000).map(|k| branch(widest * f64::from(k) / 1e5)).collect();
    let off = (0..points.len()).min_by(|a, b| points[*a].0.total_cmp(&points[*b].0)).unwrap();
    let mut loss = 0.0;
    for pair in points[off..].windows(2) {
        let ((d0, f0), (d1, f1)) = (pair[0], pair[1]);
        if d0 >= 0.0 {
            break;
        }
        loss -= 0.5 * (f0 + f1) * (d1.min(0.0) - d0);
    }
    (-points[off..].iter().map(|(_, f)| *f).fold(0.0, f64::min), loss)
}

/// Without images the pull-off force is 1.5πΔγR and the dissipated energy `2E*R³(πΔγ/(E*R))^(5/3) × 0.52622` (Johnson, Kendall and Roberts).
#[test]
fn val_reference_of_the_sphere() {
    let (radius, work) = (200.0, 0.01);
    let (force, loss) = jkr(radius, work, 1e9);
    assert!((force / (1.5 * PI * work * radius) - 1.0).abs() < 1e-6);
    assert!((loss / (2.0 * radius.powi(3) * (PI * work / radius).powf(5.0 / 3.0) * LOOP) - 1.0).abs() < 1e-4);
}

/// Pull-off force and dissipated energy over those of JKR, for a sphere with the JKR radius `a0` at δ = 0 (in spacings).
pub(super) fn sphere(n: usize, a0: f64) -> (f64, f64) {
    // a0³ = 2πΔγR²/E*.
    let radius = 12.0 * a0;
    let work = a0.powi(3) / (2.0 * PI * radius * radius);
    let middle = (n / 2) as f64;
    let height = |row: usize, column: usize| -0.5 * ((row as f64 - middle).powi(2) + (column as f64 - middle).powi(2)) / radius;
    let problem = problem(n, n, height, Law::crack(work), BONDED);
    let unit = (PI * PI * work * work * radius).cbrt();
    let cycle = cycle(&problem, 0.2 * 1.5 * PI * work * radius, 0.02 * unit, 1e-3);
    let (loss, _, tension) = sums(&cycle);
    let (force, exact) = jkr(radius, work, n as f64);
    (tension / force, loss / exact)
}

/// Pull-off force and dissipated energy approach JKR as the contact has more points: 4 % at a radius of 16 (energy: 8 %), less than at 6.
#[test]
fn lim_sphere_approaches_jkr() {
    let [(coarse_force, coarse_loss), (force, loss)] = [sphere(60, 6.0), sphere(160, 16.0)];
    assert!((force - 1.0).abs() < 0.04 && (force - 1.0).abs() < (coarse_force - 1.0).abs(), "force over JKR {coarse_force}, {force}");
    assert!(
        (loss - 1.0).abs() < 0.08 && (loss - 1.0).abs() < (coarse_loss - 1.0).abs(),
        "dissipated energy over JKR {coarse_loss}, {loss}"
    );
}

/// Extrapolated in the reciprocal of the radius of contact from 12 and 24 points, the pull-off force is that of JKR to 1 % and the dissipated energy to 3 %.
#[test]
fn lim_sphere_extrapolates_to_jkr() {
    let [(coarse_force, coarse_loss), (force, loss)] = [sphere(120, 12.0), sphere(240, 24.0)];
    let [force, loss] = [2.0 * force - coarse_force, 2.0 * loss - coarse_loss];
    assert!((force - 1.0).abs() < 0.01, "force over JKR {force}");
    assert!((loss - 1.0).abs() < 0.03, "dissipated energy over JKR {loss}");
}

/// Without adhesion the force of a sphere at a given approach is that of Hertz, with the displacement by its images, and a penetration that is less by
/// `1/(2πa)` of itself: the wall of stiffness 4 E*/dx gives way by p dx/(4E*). With it the force agrees to 0.2 % at a radius of 20 points.
#[test]
fn val_hertz() {
    let (n, radius) = (128, 400.0);
    let middle = (n / 2) as f64;
    let height = |row: usize, column: usize| -0.5 * ((row as f64 - middle).powi(2) + (column as f64 - middle).powi(2)) / radius;
    let problem = problem(n, n, height, Law::crack(0.0), Attraction::None);
    // Force at a² = Rδ, a = 20.
    let force = 4.0 / 3.0 * 20.0_f64.powi(3) / radius;
    let cycle = cycle(&problem, force, 0.1, f64::INFINITY);
    let last = cycle.turning[0].last;
    let own = (last.mean_penetration + IMAGES * force / (PI * n as f64)) * (1.0 - 1.0 / (2.0 * PI * 20.0));
    let hertz = 4.0 / 3.0 * radius.sqrt() * own.powf(1.5);
    assert!((hertz / last.totals.load - 1.0).abs() < 2e-3, "load {} and Hertz {hertz}", last.totals.load);
    assert!((PI * radius * own / last.totals.contact as f64 - 1.0).abs() < 0.05, "area {}", last.totals.contact);
    // Unloading is loading reversed.
    let dissipated: f64 = cycle.steps.iter().map(|s| s.imbalance).sum();
    let work: f64 = cycle.steps.iter().filter(|s| s.reversal.is_none()).map(|s| s.imbalance.abs()).sum();
    assert!(
        dissipated.abs() < 1e-2 * last.totals.energy && work < 0.01 * last.totals.energy,
        "{dissipated}, {work}, {}",
        last.totals.energy
    );
}
