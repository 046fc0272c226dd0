//! Corrections of the law of the band-limited crack.

use super::johnson::{SLOPE, loop_over_exact};
use super::probe::{HALF_SPACE, MATERIAL, RADIUS, SMOOTH, a0, exact, load, loop_of, results, run_by, smooth, waves};
use super::trapping::trapped_by;
use super::{BONDED, problem};
use hysteron::physics::elements::grid::half_space::HalfSpace;
use hysteron::physics::elements::grid::medium::Medium;
use hysteron::physics::elements::law::{Front, Law};
use hysteron::physics::cycle::Method;
use hysteron::physics::elements::{Elements, Options};
use hysteron::physics::model::{Amplitudes, Material, Normalization};
use hysteron::physics::surface::HeightMap;
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use std::f64::consts::{PI, TAU};

fn front() -> Front {
    let text = std::env::var("FRONT").unwrap_or_default();
    let v: Vec<f64> = text.split(',').map(|x| x.parse().unwrap()).collect();
    Front { width: v[0], flatness: v[1], is_hard: v[2] > 0.0, ends_at_front: v[3] > 0.0, line: v[4], line_reach: v[5], is_emphasised: v[6] > 0.0 }
}

#[test]
#[ignore = "exploration"]
fn explore() {
    let front = front();
    let what = std::env::var("WHAT").unwrap_or_default();
    eprintln!("{front:?} c1 {}", front.curvature_coefficient());
    if what.contains('t') {
        for n in [64, 128] {
            eprintln!("trapped {n}: {:.2e}", trapped_by(n, |work| Law::front(work, &front), front.wall_compliance()));
        }
    }
    if what.contains('j') {
        for (alpha, n) in [(0.1, 128), (0.5, 128), (0.3, 32), (0.3, 64), (0.3, 128), (0.3, 256)] {
            let work = (alpha * PI / 2.0_f64.sqrt() * SLOPE).powi(2) * n as f64;
            let h = SLOPE * n as f64;
            let mut problem = problem(1, n, |_, k| h * (TAU * k as f64 / n as f64).cos(), Law::front(work, &front), BONDED);
            problem.half_space = HalfSpace::of(&Medium { wall_compliance: front.wall_compliance(), ..Medium::default() }, 1, n).unwrap();
            let ([a, b, c, d], t) = loop_over_exact(alpha, &problem);
            eprintln!("johnson {alpha} {n}: Θ {:+.2} F {:+.2} gap {:+.2} % balance {d:.1e} transforms {t}", 100.0 * (a - 1.0), 100.0 * (b - 1.0), 100.0 * (c - 1.0));
        }
    }
    let jkr = loop_of(&smooth(), load(), 0.0);
    for (key, per) in [('6', 6.0), ('2', 12.0), ('4', 24.0)] {
        if what.contains('s') && what.contains(key) {
            let cycle = run_by(front, 8.0, per, SMOOTH, load(), HALF_SPACE);
            let bad = cycle.steps.iter().filter(|s| !s.numerics.is_converged).count();
            let transforms: u64 = cycle.steps.iter().map(|s| s.numerics.effort.transforms).sum();
            let found = if bad == 0 { results(&cycle) } else { Default::default() };
            // Radii of steps over those of JKR at the same load.
            let dx = a0() / per;
            let branch: Vec<f64> = (1..=40_000).map(|i| 4.0 * a0() * f64::from(i) / 40_000.0).collect();
            let forces = smooth();
            let mut off = Vec::new();
            for step in cycle.steps.iter().filter(|s| s.area_m2 > 0.5 * PI * a0() * a0()) {
                let Some(k) = (0..forces.len()).rev().find(|k| forces[*k][1] <= step.load_n) else { continue };
                off.push(((step.area_m2 / PI).sqrt() - branch[k]) / dx);
            }
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            eprintln!(
                "sphere {per}: F {:+.2} Θ {:+.2} % radius {mean:+.3} dx transforms {transforms} steps {} unconverged {bad}",
                100.0 * (found.pull_off_n / jkr.pull_off_n - 1.0),
                100.0 * (found.loss_j / jkr.loss_j - 1.0),
                cycle.steps.len()
            );
        }
        if what.contains('g') && what.contains(key) {
            let [amplitude, wavelength] = waves(2.0);
            let max_load = 0.6 * load();
            let cycle = run_by(front, 6.5, 2.0 * per, [amplitude, wavelength], max_load, HALF_SPACE);
            let bad = cycle.steps.iter().filter(|s| !s.numerics.is_converged).count();
            let transforms: u64 = cycle.steps.iter().map(|s| s.numerics.effort.transforms).sum();
            let found = if bad == 0 { results(&cycle) } else { Default::default() };
            let exact = loop_of(&exact(amplitude, wavelength, 4.0 * a0()), max_load, 0.0);
            eprintln!(
                "guduru {per}: F {:+.2} Θ {:+.2} % transforms {transforms} unconverged {bad}",
                100.0 * (found.pull_off_n / exact.pull_off_n - 1.0),
                100.0 * (found.loss_j / exact.loss_j - 1.0)
            );
        }
    }
    if what.contains('r') {
        let number = |name: &str, otherwise: f64| std::env::var(name).map_or(otherwise, |text| text.parse().unwrap());
        let (seed, points, work, hurst) = (number("SEED", 71.0) as u64, number("POINTS", 64.0) as usize, number("WORK", 0.07), number("HURST", 0.8));
        let spectrum = Spectrum {
            length_m: 1e-3,
            rms_height_m: 5e-6,
            hurst,
            magnification: 8,
            normalization: Normalization::Spectrum,
            amplitudes: Amplitudes::Fixed,
            shape: Shape::default(),
        };
        let surface = synthesize(&spectrum, &realization_seed(seed, 0), 64);
        let map = HeightMap { heights_m: surface.heights_m.view(), length_m: 1e-3, is_periodic: true, shortest_wavelength_m: 1e-3 / 8.0, rms_height_m: 5e-6 };
        let material = Material { work_of_adhesion_j_m2: work, ..Material::default() };
        let mut options = Options { points, law: front, ..Options::default() };
        options.numerics.equilibrium.bond_margin = number("MARGIN", 2.0) as usize;
        let cycle = Elements::new(&map, &material, &[0.0071], &options).unwrap().run().unwrap();
        let bad = cycle.steps.iter().filter(|s| !s.numerics.is_converged).count();
        let transforms: u64 = cycle.steps.iter().map(|s| s.numerics.effort.transforms).sum();
        let turn = &cycle.steps[cycle.turning[0].0];
        let loss = turn.work_j + cycle.steps.last().unwrap().work_j;
        let events: f64 = cycle.events.iter().map(|event| event.energy_lost_j).sum();
        let pull = cycle.steps.iter().map(|step| -step.least_load_n).fold(0.0, f64::max);
        eprintln!(
            "rough {seed} {work} {hurst} {points}: A {:.4} F {:.4e} Θ {:.5e} events {:.5e} transforms {transforms} steps {} unconverged {bad}",
            turn.area_m2 / 1e-6,
            pull / 1.0,
            loss / (1.0 * 5e-6),
            events / 5e-6,
            cycle.steps.len()
        );
    }
    let _ = (MATERIAL, RADIUS);
}
