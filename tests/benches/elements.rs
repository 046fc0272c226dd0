//! A whole loop by boundary elements at ζ = 8, in bare Fourier transforms of its grid. `cargo bench -- elements 512 1024` names the grids.

use crate::paper::{MATERIAL, spectrum};
use crate::watch::{heading, line, once, plain};
use hysteron::model::Normalization;
use hysteron::physics::boundary_elements::contact::{Attraction, Problem};
use hysteron::physics::boundary_elements::cycle::{Settings, run as cycle};
use hysteron::physics::boundary_elements::grid::{HalfSpace, Operator};
use hysteron::physics::boundary_elements::law::Law;
use hysteron::physics::boundary_elements::minimise::Accuracy;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};

/// Maximum load over E* A0.
const LOAD: f64 = 0.0071;

pub fn run() {
    let named: Vec<usize> = std::env::args().filter_map(|word| word.parse().ok()).collect();
    let grids = if named.is_empty() { vec![64, 128, 256] } else { named };
    heading("boundary elements: zeta = 8 to 0.0071, 0.03 h_rms a step", "in bare transforms");
    for n in grids {
        one(n);
    }
}

fn one(n: usize) {
    let spectrum = Spectrum { normalization: Normalization::Spectrum, ..spectrum(8) };
    let surface = synthesize(&spectrum, &realization_seed(2021, 3), n);
    let spacing = spectrum.length_m / n as f64;
    let top = surface.heights_m.iter().copied().fold(f64::MIN, f64::max);
    let problem = Problem {
        half_space: HalfSpace::new(n, n).unwrap(),
        law: Law::crack(MATERIAL.work_of_adhesion_j_m2 / (MATERIAL.contact_modulus_pa * spacing)),
        heights: surface.heights_m.iter().map(|height| (height - top) / spacing).collect(),
        attraction: Attraction::Bonded { margin: 2, nucleation: 0.0, strength: f64::INFINITY },
    };
    let (points, rms) = ((n * n) as f64, spectrum.rms_height_m / spacing);
    let mut waves = problem.half_space.waves::<f64>().unwrap();
    let mut pressure = vec![0.0; n * n];
    // One application of the operator is two transforms.
    let mut apply = || problem.half_space.apply(Operator::Stiffness, &problem.heights, &mut pressure, &mut waves);
    let bare = 0.5 * (0..20).map(|_| once(&mut apply)).fold(f64::INFINITY, f64::min);
    let settings = Settings {
        max_loads: vec![LOAD * points],
        step: 0.03 * rms,
        halvings: 1,
        accuracy: Accuracy { rms: 1e-4, largest: 1e-2, iterations: 3000 },
        all_regions: false,
    };
    let mut done = None;
    let whole = once(|| done = Some(cycle(&problem, &settings, None, &mut |_| {}, &|_| {}).unwrap()));
    let steps = done.unwrap().steps;
    let transforms: u64 = steps.iter().map(|step| step.transforms).sum();
    plain(&format!("{n} x {n}, one transform"), bare);
    line(&format!("{} steps, {transforms} transforms", steps.len()), whole, whole / bare);
    let loss: f64 = steps.iter().map(|step| step.dissipated).sum::<f64>() / (points * rms);
    let pull_off = -steps.iter().map(|step| step.totals.load).fold(0.0, f64::min) / points;
    let area = steps.iter().rfind(|step| step.reversal.is_none()).map_or(0.0, |step| step.totals.contact as f64 / points);
    println!("{:>36}  A/A0 {area:.4}, F_po/(E* A0) {pull_off:.4e}, loss/(E* A0 h_rms) {loss:.4e}", "");
}
