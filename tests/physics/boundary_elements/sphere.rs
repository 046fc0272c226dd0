//! One sphere in a periodic square against JKR, and without adhesion against Hertz.

use super::{BONDED, cycle, problem, sums};
use hysteron::physics::boundary_elements::law::Law;
use std::f64::consts::PI;

/// Mean displacement under the images of a periodic square with a self-balanced load, `Δ = δ − 3.900265 F/(πE*L)`.
const IMAGES: f64 = 3.900_265;
/// Energy of jump-in at δ = 0 and of the whole loop, in `2E*R³(πΔγ/(E*R))^(5/3)`.
const LOOP: f64 = 0.526_220_3;

/// Pull-off force over 1.5πΔγR and dissipated energy over that of JKR, for a sphere with the JKR radius `a0` at δ = 0 (in spacings).
fn sphere(n: usize, a0: f64) -> (f64, f64, f64) {
    // a0³ = 2πΔγR²/E*: with R = 12 a0, Δγ = a0³/(2πR²).
    let radius = 12.0 * a0;
    let work = a0.powi(3) / (2.0 * PI * radius * radius);
    let middle = (n / 2) as f64;
    let height = |row: usize, column: usize| {
        let r2 = (row as f64 - middle).powi(2) + (column as f64 - middle).powi(2);
        -0.5 * r2 / radius
    };
    let problem = problem(n, n, height, Law::crack(work), BONDED);
    let unit = (PI * PI * work * work * radius / 1.0_f64).cbrt(); // length of δ
    let cycle = cycle(&problem, 0.2 * 1.5 * PI * work * radius, 0.05 * unit, 4);
    let (_, _, tension) = sums(&cycle);
    // In control of Δ the images soften the sphere: δ = Δ + c F.
    let soft = IMAGES / (PI * n as f64);
    let loss: f64 = sums(&cycle).0;
    let exact = 2.0 * radius.powi(3) * (PI * work / radius).powf(5.0 / 3.0) * LOOP;
    (tension / (1.5 * PI * work * radius), loss / exact, soft)
}

/// Pull-off force and dissipated energy approach JKR from contacts of 6 to 16 points' radius; at 16 both are within 5 %.
#[test]
fn lim_sphere_approaches_jkr() {
    let [(force6, loss6, _), (force16, loss16, _)] = [sphere(64, 6.0), sphere(160, 16.0)];
    println!("6: {force6:.4} {loss6:.4}; 16: {force16:.4} {loss16:.4}");
    assert!((force16 - 1.0).abs() < (force6 - 1.0).abs() && (force16 - 1.0).abs() < 0.05, "force over JKR {force6}, {force16}");
    assert!((loss16 - 1.0).abs() < 0.1, "dissipated energy over JKR {loss6}, {loss16}");
}
