//! Johnson's adhesive sinusoid: a whole loop with an exact dissipated energy.

use hysteron::physics::boundary_elements::contact::{Attraction, Problem};
use hysteron::physics::boundary_elements::cycle::{Settings, run};
use hysteron::physics::boundary_elements::grid::HalfSpace;
use hysteron::physics::boundary_elements::law::Law;
use hysteron::physics::boundary_elements::minimise::Accuracy;
use std::f64::consts::{PI, TAU};

#[test]
fn look() {
    let alpha = 0.3;
    let height = 1.0 / 50.0; // h/λ
    for (n, margin, step) in [(32usize, 2, 0.04), (64, 2, 0.04), (128, 2, 0.04), (128, 3, 0.04), (256, 2, 0.04), (256, 2, 0.02)] {
        let h = height * n as f64;
        // alpha = (√2/π)(λ/h) sqrt(Δγ/(E* λ)), λ = n.
        let a = (alpha * PI / 2.0_f64.sqrt() * height).powi(2) * n as f64;
        let heights: Vec<f64> = (0..n).map(|k| h * ((TAU * k as f64 / n as f64).cos() - 1.0)).collect();
        let problem = Problem {
            half_space: HalfSpace::new(1, n).unwrap(),
            law: Law::crack(a),
            heights,
            attraction: Attraction::Bonded { margin, nucleation: 0.0 },
        };
        // Full contact at the mean pressure p_wfc = π E* h/λ.
        let full = PI * h / n as f64;
        let settings = Settings {
            max_loads: vec![0.2 * full * n as f64],
            step: step * h,
            halvings: 4,
            accuracy: Accuracy { rms: 1e-4, largest: 1e-2, iterations: 2000 },
            all_regions: false,
        };
        let start = std::time::Instant::now();
        let cycle = run(&problem, &settings, None, &mut |_| {}, &|_| {}).unwrap();
        let steps = &cycle.steps;
        let loss: f64 = steps.iter().map(|s| s.imbalance).sum();
        let least = steps.iter().map(|s| s.totals.load).fold(0.0, f64::min);
        let unit = full * n as f64; // p_wfc λ
        let last = steps.last().unwrap();
        println!(
            "n {n} margin {margin} step {step}: loss/exact {:.4} Pmin/exact {:.4} gap_off {:.4} (1.39171) steps {} iterations {} transforms {} unconverged {} {:?}",
            loss / (unit * h) / 0.033349,
            least / unit / -0.09594,
            1.0 - last.approach / h,
            steps.len(),
            steps.iter().map(|s| s.iterations as usize).sum::<usize>(),
            steps.iter().map(|s| s.transforms).sum::<u64>(),
            steps.iter().filter(|s| !s.converged).count(),
            start.elapsed()
        );
    }
}
