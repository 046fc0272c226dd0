//! A whole loop by boundary elements, in bare Fourier transforms of its grid. `cargo bench -- elements 512 1024` names the grids, `16:256` a magnification
//! other than 8 too; with `range`, attraction has a range, as in other programs.

use crate::paper::{MATERIAL, spectrum};
use crate::watch::{heading, line, once, plain};
use hysteron::model::{Attraction as Rule, ElementOptions, Normalization};
use hysteron::physics::elements::Numerics;
use hysteron::physics::elements::equilibrium::minimise::Accuracy;
use hysteron::physics::elements::grid::half_space::{HalfSpace, Operator};
use hysteron::physics::elements::law::Law;
use hysteron::physics::elements::path::cycle::{Settings, run as cycle};
use hysteron::physics::elements::problem::{Attraction, Problem};
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};

/// Maximum load over E* A0.
const LOAD: f64 = 0.0071;

pub fn run() {
    let case = |word: String| match word.split_once(':') {
        Some((zeta, grid)) => Some((zeta.parse().ok()?, grid.parse().ok()?)),
        None => Some((8, word.parse().ok()?)),
    };
    let named: Vec<(u32, usize)> = std::env::args().filter_map(case).collect();
    heading("boundary elements: loop to 0.0071, 0.03 h_rms a step", "in bare transforms");
    let range = std::env::args().any(|word| word == "range");
    for (zeta, n) in if named.is_empty() { vec![(8, 64), (8, 128), (8, 256)] } else { named } {
        one(zeta, n, range);
    }
}

fn one(zeta: u32, n: usize, range: bool) {
    let spectrum = Spectrum { normalization: Normalization::Spectrum, ..spectrum(zeta) };
    let surface = synthesize(&spectrum, &realization_seed(2021, 3), n);
    let spacing = spectrum.length_m / n as f64;
    let top = surface.heights_m.iter().copied().fold(f64::MIN, f64::max);
    let work_length = MATERIAL.adhesion_length_m();
    let work = work_length / spacing;
    let bonded = Attraction::Bonded { margin: 2, nucleation: 0.0, strength: f64::INFINITY };
    let (law, attraction) = if range {
        let automatic = ElementOptions { attraction: Rule::Range { range_m: None }, ..ElementOptions::default() };
        (Law::morse(work, automatic.range(work_length, spacing).unwrap() / spacing), Attraction::Range)
    } else {
        (Law::crack(work), bonded)
    };
    let problem = Problem {
        half_space: HalfSpace::new(n, n).unwrap(),
        law,
        heights: surface.heights_m.iter().map(|height| (height - top) / spacing).collect(),
        machine_compliance: 0.0,
        attraction,
        numerics: Numerics::DEFAULT,
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
        jump_tolerance: 0.03,
        accuracy: Accuracy { rms: 1e-4, largest: 1e-2, iterations: 3000 },
        halvings: 6,
        all_regions: false,
        summits: Vec::new(),
    };
    let mut done = None;
    let whole = once(|| done = Some(cycle(&problem, &settings, None, &mut |_| {}, &|_| {}).unwrap()));
    let steps = done.unwrap().steps;
    let transforms: u64 = steps.iter().map(|step| step.transforms).sum();
    plain(&format!("zeta = {zeta}, {n} x {n}, one transform"), bare);
    line(&format!("{} steps, {transforms} transforms", steps.len()), whole, whole / bare);
    let loss: f64 = steps.iter().map(|step| step.dissipated).sum::<f64>() / (points * rms);
    let pull_off = -steps.iter().map(|step| step.totals.load).fold(0.0, f64::min) / points;
    let area = steps.iter().rfind(|step| step.reversal.is_none()).map_or(0.0, |step| step.totals.contact as f64 / points);
    println!("{:>36}  A/A0 {area:.4}, F_po/(E* A0) {pull_off:.4e}, loss/(E* A0 h_rms) {loss:.4e}", "");
}
