//! Adhesive contact from adhesionless curves, where the approximation is exact.

use hysteron::physics::theory::approximate_jkr::{CurvePoint, adhesive_curve, curve_loop};
use std::f64::consts::PI;

/// From the Hertz curve of a sphere follow JKR's penetration, load, pull-off force 1.5πΔγR and dissipated energy. Differences of 2000 points are good to 1e-4.
#[test]
fn lim_a_sphere_gives_jkr() {
    let (radius, work) = (1e-4_f64, 1e-8_f64);
    let point = |k: u32| {
        let delta = 1e-5 * f64::from(k) / 2000.0;
        CurvePoint { penetration_m: delta, load_m2: 4.0 / 3.0 * radius.sqrt() * delta.powf(1.5), area_m2: PI * radius * delta }
    };
    let hertz: Vec<CurvePoint> = (0..=2000).map(point).collect();
    let curve = adhesive_curve(&hertz, work);
    for point in &curve[100..1900] {
        let a = (point.area_m2 / PI).sqrt();
        let penetration = a * a / radius - (2.0 * PI * a * work).sqrt();
        let load = 4.0 / 3.0 * a.powi(3) / radius - (8.0 * PI * work * a.powi(3)).sqrt();
        assert!((point.penetration_m - penetration).abs() < 1e-4 * a * a / radius, "{} and {penetration}", point.penetration_m);
        assert!((point.load_m2 - load).abs() < 1e-3 * a.powi(3) / radius, "{} and {load}", point.load_m2);
    }
    let found = curve_loop(&curve, 1e-10).unwrap();
    assert!((found.pull_off_m2 / (1.5 * PI * work * radius) - 1.0).abs() < 1e-3);
    // The loop from the touch at δ = 0: 0.52622 · 2E*R³(πΔγ/(E*R))^(5/3).
    let loss = 0.526_220_3 * 2.0 * radius.powi(3) * (PI * work / radius).powf(5.0 / 3.0);
    assert!((found.loss_m3 / loss - 1.0).abs() < 3e-3, "{} and {loss}", found.loss_m3);
}

/// From the adhesionless curve of a sinusoid follows Johnson's solution `P = sin²πa − α sqrt(tan πa)`, `ḡ = cos²πa + 2P ln sin πa`,
/// a the half-width of contact.
#[test]
fn lim_a_sinusoid_gives_johnson() {
    let (alpha, h) = (0.3_f64, 0.02_f64);
    // A wavelength of 1: load in πE*h, gaps in h, and α² = 2Δγ/(π²E*h²).
    let work = 0.5 * (alpha * PI * h).powi(2);
    let exact = |adhesion: f64, a: f64| {
        let load = (PI * a).sin().powi(2) - adhesion * (PI * a).tan().sqrt();
        let gap = (PI * a).cos().powi(2) + 2.0 * load * (PI * a).sin().ln();
        CurvePoint { penetration_m: h * (1.0 - gap), load_m2: PI * h * load, area_m2: 2.0 * a }
    };
    let free: Vec<CurvePoint> = (1..2000).map(|k| exact(0.0, 0.0002 * f64::from(k))).collect();
    for point in &adhesive_curve(&free, work)[100..1900] {
        let want = exact(alpha, 0.5 * point.area_m2);
        assert!((point.penetration_m - want.penetration_m).abs() < 1e-4 * h, "{point:?} and {want:?}");
        assert!((point.load_m2 - want.load_m2).abs() < 1e-3 * PI * h, "{point:?} and {want:?}");
    }
}

/// Nothing comes of too few points, of a load beyond the curve, and of a contact that does not stiffen as it grows.
#[test]
fn reg_curves_that_give_nothing() {
    let line = |k: u32| CurvePoint { penetration_m: f64::from(k), load_m2: f64::from(k), area_m2: f64::from(k) };
    let straight: Vec<CurvePoint> = (0..20).map(line).collect();
    assert!(adhesive_curve(&straight, 0.1).is_empty());
    assert!(adhesive_curve(&straight[..3], 0.1).is_empty());
    assert_eq!(curve_loop(&straight, 100.0), None);
    assert_eq!(curve_loop(&[], 1.0), None);
}
