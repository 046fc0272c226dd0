//! One loading–unloading cycle of a rough patch by boundary elements, on a grid of 64 × 64 points.
//!
//! `cargo run --no-default-features --example boundary_elements`

#![allow(clippy::print_stdout)]

use hysteron::model::{Amplitudes, Material, Normalization};
use hysteron::physics::PhysicsError;
use hysteron::physics::boundary_elements::contact::{Attraction, Problem};
use hysteron::physics::boundary_elements::cycle::{Cycle, Settings, run as cycle};
use hysteron::physics::boundary_elements::grid::HalfSpace;
use hysteron::physics::boundary_elements::law::Law;
use hysteron::physics::boundary_elements::minimise::Accuracy;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};

/// Grid points per side.
pub const POINTS: usize = 64;
/// Maximum load F/(E* A0).
pub const MAX_LOAD: f64 = 0.0071;

/// Loads a surface with wavelengths from L to L/8 to [`MAX_LOAD`] and unloads it to separation.
///
/// # Errors
/// The errors of [`HalfSpace::new`] and [`cycle`].
pub fn run() -> Result<Cycle, PhysicsError> {
    let (normalization, amplitudes) = (Normalization::Spectrum, Amplitudes::Fixed);
    let spectrum = Spectrum { length_m: 1e-3, rms_height_m: 5e-6, hurst: 0.8, magnification: 8, normalization, amplitudes };
    let material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
    let surface = synthesize(&spectrum, &realization_seed(2021, 3), POINTS);
    // Lengths in grid spacings, stresses in E*.
    let spacing = spectrum.length_m / POINTS as f64;
    let top = surface.heights_m.iter().copied().fold(f64::MIN, f64::max);
    let problem = Problem {
        half_space: HalfSpace::new(POINTS, POINTS)?,
        law: Law::crack(material.work_of_adhesion_j_m2 / (material.contact_modulus_pa * spacing)),
        heights: surface.heights_m.iter().map(|height| (height - top) / spacing).collect(),
        attraction: Attraction::Bonded { margin: 2, nucleation: 0.0, strength: f64::INFINITY },
    };
    let settings = Settings {
        max_loads: vec![MAX_LOAD * (POINTS * POINTS) as f64],
        step: 0.1 * spectrum.rms_height_m / spacing,
        located: 0.03,
        accuracy: Accuracy { rms: 1e-4, largest: 1e-2, iterations: 3000 },
        halvings: 6,
        all_regions: false,
    };
    cycle(&problem, &settings, None, &mut |_| {}, &|_| {})
}

fn main() -> Result<(), PhysicsError> {
    let cycle = run()?;
    let points = (POINTS * POINTS) as f64;
    println!("{:<10} {:>7} {:>14} {:>6} {:>8} {:>10}", "branch", "Δ/dx", "F/(E*A₀) [10⁻³]", "A/A₀", "regions", "transforms");
    for step in cycle.steps.iter().step_by(4) {
        let branch = if step.reversal.is_some() { "unloading" } else { "loading" };
        let (load, area) = (1e3 * step.totals.load / points, step.totals.contact as f64 / points);
        println!("{branch:<10} {:>7.4} {load:>15.3} {area:>6.3} {:>8} {:>10}", step.approach, step.regions, step.transforms);
    }
    let dissipated: f64 = cycle.steps.iter().map(|step| step.dissipated).sum();
    println!("{} events dissipate Θ = {dissipated:.4e} E* dx³", cycle.events.len());
    Ok(())
}
