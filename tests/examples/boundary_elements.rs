//! One loading–unloading cycle of a rough patch by boundary elements, on a grid of 64 × 64 points.
//!
//! `cargo run --no-default-features --example boundary_elements`

#![allow(clippy::print_stdout)]

use hysteron::model::{Amplitudes, Material, Normalization};
use hysteron::physics::PhysicsError;
use hysteron::physics::boundary_elements::cycle::Cycle;
use hysteron::physics::elements::{Elements, HeightMap, Options, Units};
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};

/// Grid points per side.
pub const POINTS: usize = 64;
/// Maximum load F/(E* A0).
pub const MAX_LOAD: f64 = 0.0071;

/// Loads a surface with wavelengths from L to L/8 to [`MAX_LOAD`] and unloads it to separation.
///
/// # Errors
/// The errors of [`Elements::new`] and [`Elements::run`].
pub fn run() -> Result<(Cycle, Units), PhysicsError> {
    let (normalization, amplitudes) = (Normalization::Spectrum, Amplitudes::Fixed);
    let spectrum = Spectrum { length_m: 1e-3, rms_height_m: 5e-6, hurst: 0.8, magnification: 8, normalization, amplitudes };
    let surface = synthesize(&spectrum, &realization_seed(2021, 3), POINTS);
    let map = HeightMap {
        heights_m: surface.heights_m.view(),
        length_m: spectrum.length_m,
        is_periodic: true,
        shortest_wavelength_m: spectrum.length_m / f64::from(spectrum.magnification),
        rms_height_m: spectrum.rms_height_m,
    };
    let options = Options { points: POINTS, ..Options::default() };
    let elements = Elements::new(&map, &Material::default(), &[MAX_LOAD], &options)?;
    Ok((elements.run()?, elements.units))
}

fn main() -> Result<(), PhysicsError> {
    let (cycle, units) = run()?;
    println!("{:<10} {:>7} {:>10} {:>6} {:>8} {:>10}", "branch", "Δ [µm]", "F [mN]", "A/A₀", "regions", "transforms");
    for step in cycle.steps.iter().step_by(4) {
        let branch = if step.reversal.is_some() { "unloading" } else { "loading" };
        let (penetration_um, load_mn) = (1e6 * step.approach * units.spacing_m(), 1e3 * step.totals.load * units.load_n());
        let area = step.totals.contact as f64 / units.all();
        println!("{branch:<10} {penetration_um:>7.3} {load_mn:>10.3} {area:>6.3} {:>8} {:>10}", step.regions, step.transforms);
    }
    let dissipated_j = cycle.steps.iter().map(|step| step.dissipated).sum::<f64>() * units.energy_j();
    println!("{} events dissipate Θ = {dissipated_j:.4e} J", cycle.events.len());
    Ok(())
}
