//! Temporary study.
use hysteron::model::{Amplitudes, Normalization};
use hysteron::physics::boundary_elements::contact::{Attraction, Problem};
use hysteron::physics::boundary_elements::cycle::{Settings, run};
use hysteron::physics::boundary_elements::grid::HalfSpace;
use hysteron::physics::boundary_elements::law::Law;
use hysteron::physics::boundary_elements::minimise::Accuracy;
use hysteron::physics::spectrum::Spectrum;
use hysteron::physics::synthesis::{realization_seed, synthesize};

fn env(name: &str, default: f64) -> f64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

#[test]
fn rough() {
    let Ok(grids) = std::env::var("HB_N") else { return };
    for n in grids.split(',').map(|n| n.parse::<usize>().unwrap()) {
        let spectrum = Spectrum {
            length_m: 1e-3,
            rms_height_m: 5e-6,
            hurst: env("HB_H", 0.8),
            magnification: env("HB_ZETA", 8.0) as u32,
            normalization: Normalization::Spectrum,
            amplitudes: Amplitudes::Fixed,
        };
        let surface = synthesize(&spectrum, &realization_seed(2021, env("HB_SEED", 1.0) as u64), n);
        let dx = 1e-3 / n as f64;
        let top = surface.heights_m.iter().copied().fold(f64::MIN, f64::max);
        let heights: Vec<f64> = surface.heights_m.iter().map(|z| (z - top) / dx).collect();
        let work = env("HB_G", 0.07) / (1e6 * dx);
        let problem = Problem {
            half_space: HalfSpace::new(n, n).unwrap(),
            law: Law::crack(work),
            heights,
            attraction: Attraction::Bonded { margin: env("HB_D", 2.0) as usize, nucleation: 0.0 },
        };
        let points = (n * n) as f64;
        let h = 5e-6 / dx;
        let settings = Settings {
            max_loads: vec![env("HB_F", 0.0071) * points],
            step: env("HB_STEP", 0.03) * h,
            halvings: env("HB_HALF", 3.0) as u32,
            accuracy: Accuracy { rms: env("HB_TOL", 1e-4), largest: 100.0 * env("HB_TOL", 1e-4), iterations: 3000 },
            all_regions: false,
        };
        let start = std::time::Instant::now();
        let cycle = run(&problem, &settings, None, &mut |_| {}, &|_| {}).unwrap();
        let steps = &cycle.steps;
        let loss: f64 = steps.iter().map(|s| s.imbalance).sum();
        let total = loss / (points * h);
        let quiet: f64 = steps.iter().filter(|s| s.imbalance < 1e-3 * loss).map(|s| s.imbalance).sum::<f64>() / loss;
        let least = steps.iter().map(|s| s.totals.load).fold(0.0, f64::min) / points;
        let turn = steps.iter().rfind(|s| s.reversal.is_none()).unwrap();
        let load_loss: f64 = steps.iter().filter(|s| s.reversal.is_none()).map(|s| s.imbalance).sum::<f64>() / (points * h);
        println!(
            "n {n}: A {:.4} F {:.5} Fpo {:.4} Theta {:.4} (loading {:.4}) quiet {quiet:.4} steps {} iter/step {:.0} fft/step {:.0} unconv {} {:.1?}",
            turn.totals.contact as f64 / points,
            turn.totals.load / points,
            least * 1e3,
            total * 1e3,
            load_loss * 1e3,
            steps.len(),
            steps.iter().map(|s| s.iterations as usize).sum::<usize>() as f64 / steps.len() as f64,
            steps.iter().map(|s| s.transforms).sum::<u64>() as f64 / steps.len() as f64,
            steps.iter().filter(|s| !s.converged).count(),
            start.elapsed()
        );
        if env("HB_PRINT", 0.0) > 0.0 {
            for s in steps {
                if s.imbalance > 0.005 * loss {
                    println!("   {} D/h {:.4} F {:.3} A {:.4} E {:.4}", s.reversal.map_or("load", |_| "unload"), s.approach / h, s.totals.load / points * 1e3, s.totals.contact as f64 / points, s.imbalance / (points * h) * 1e3);
                }
            }
        }
    }
}
