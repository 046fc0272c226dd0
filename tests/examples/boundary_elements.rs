//! One loading–unloading cycle of a rough patch by boundary elements, on a grid of 64 × 64 points.
//!
//! `cargo run --no-default-features --example boundary_elements`

#![allow(clippy::print_stdout)]

use hysteron::model::{Amplitudes, Material, Normalization};
use hysteron::physics::PhysicsError;
use hysteron::physics::cycle::{Cycle, Method};
use hysteron::physics::elements::path::cycle::Turning;
use hysteron::physics::elements::{Elements, Options};
use hysteron::physics::surface::HeightMap;
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};

/// Grid points per side.
pub const POINTS: usize = 64;
/// Maximum load F/(E* A0).
pub const MAX_LOAD: f64 = 0.0071;

/// Loads a surface with wavelengths from L to L/8 to [`MAX_LOAD`] and unloads it to separation.
///
/// # Errors
/// The errors of [`Elements::new`] and [`Method::run`].
pub fn run() -> Result<Cycle<Turning>, PhysicsError> {
    let (normalization, amplitudes) = (Normalization::Spectrum, Amplitudes::Fixed);
    let spectrum =
        Spectrum { length_m: 1e-3, rms_height_m: 5e-6, hurst: 0.8, magnification: 8, normalization, amplitudes, shape: Shape::default() };
    let surface = synthesize(&spectrum, &realization_seed(2021, 3), POINTS);
    let map = HeightMap {
        heights_m: surface.heights_m.view(),
        length_m: spectrum.length_m,
        is_periodic: true,
        shortest_wavelength_m: spectrum.length_m / f64::from(spectrum.magnification),
        rms_height_m: spectrum.rms_height_m,
    };
    let options = Options { points: POINTS, ..Options::default() };
    Elements::new(&map, &Material::default(), &[MAX_LOAD], &options)?.run()
}

fn main() -> Result<(), PhysicsError> {
    let cycle = run()?;
    println!("{:<10} {:>7} {:>10} {:>8} {:>8} {:>10}", "branch", "Δ [µm]", "F [mN]", "A [mm²]", "regions", "transforms");
    for step in cycle.steps.iter().step_by(4) {
        let (penetration_um, load_mn, area_mm2) = (1e6 * step.mean_penetration_m, 1e3 * step.load_n, 1e6 * step.area_m2);
        let (branch, regions, transforms) = (step.branch.word(), step.counts.contacts, step.numerics.effort.transforms);
        println!("{branch:<10} {penetration_um:>7.3} {load_mn:>10.3} {area_mm2:>8.4} {regions:>8} {transforms:>10}");
    }
    let dissipated_j = cycle.events.iter().map(|event| event.energy_lost_j).sum::<f64>();
    println!("{} events dissipate Θ = {dissipated_j:.4e} J", cycle.events.len());
    Ok(())
}
