//! Observation of a cycle: progress, checkpoints from which it resumes, and computational effort.
//!
//! `cargo run --no-default-features --example observe_path`

#![allow(clippy::print_stdout)]

use hysteron::model::{Amplitudes, Boundary, Coalescence, Interaction, JumpIn, KeptContacts, Material, Normalization, Slips};
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Checkpoint, Cycle, Settings};
use hysteron::physics::cycle::{Effort, Method};
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::summits::find_summits;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use hysteron::physics::{LoopPosition, PhysicsError};
use std::sync::{Mutex, PoisonError};

/// Grid points per shortest wavelength.
const POINTS: u32 = 8;

/// An observed cycle.
pub struct Observed {
    /// The cycle, and the same cycle resumed from its middle checkpoint.
    pub cycles: [Cycle; 2],
    /// Completed fraction at each report, from 0 to 1.
    pub progress: Vec<f64>,
    /// Number of checkpoints of both.
    pub checkpoints: [usize; 2],
    /// Effort of all steps.
    pub effort: Effort,
}

/// Runs a cycle of a generated surface, with a checkpoint every 0.2 h_rms, and resumes it from the middle one.
///
/// # Errors
/// The errors of [`Problem::new`] and [`run_from`].
pub fn run() -> Result<Observed, PhysicsError> {
    let (normalization, amplitudes) = (Normalization::Sample, Amplitudes::Fixed);
    let spectrum =
        Spectrum { length_m: 1e-3, rms_height_m: 5e-6, hurst: 0.8, magnification: 8, normalization, amplitudes, shape: Shape::default() };
    let surface = synthesize(&spectrum, &realization_seed(2021, 0), (POINTS * spectrum.magnification) as usize);
    let summits = find_summits(surface.heights_m.view(), spectrum.length_m, f64::from(POINTS))?.list;
    let material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
    let (interaction, boundary, coalescence) = (Interaction::Spots, Boundary::Periodic, Coalescence::Cover);
    let rules = Rules { interaction, boundary, coalescence, jump_in: JumpIn::Wu, allow_low_tabor: false, slips: Slips::NONE };
    let problem = Problem::new(&summits, spectrum.length_m, spectrum.rms_height_m, material, rules)?;
    let settings = Settings { max_loads: vec![0.004], approach_step: 0.04, contacts: KeptContacts::None, rest_every: Some(0.2) };

    let (progress, mut kept) = (Mutex::new(Vec::new()), Vec::new());
    let report = |at: LoopPosition| progress.lock().unwrap_or_else(PoisonError::into_inner).push(at.done);
    let method = Asperities { problem, settings };
    let first = method.run_from(None, &mut |checkpoint: &Checkpoint| kept.push(checkpoint.clone()), &report)?;
    let middle = kept.get(kept.len() / 2).cloned();
    let mut later = 0;
    let resumed = method.run_from(middle, &mut |_| later += 1, &|_| {})?;
    let effort = first.steps.iter().fold(Effort::default(), |mut sum, step| {
        sum += step.numerics.effort;
        sum
    });
    Ok(Observed { cycles: [first, resumed], progress: progress.into_inner().unwrap_or_default(), checkpoints: [kept.len(), later], effort })
}

fn main() -> Result<(), PhysicsError> {
    let Observed { cycles: [first, resumed], progress, checkpoints: [all, later], effort } = run()?;
    println!("steps                          {:>9}", first.steps.len());
    println!("events                         {:>9}", first.events.len());
    println!("reports of progress            {:>9}", progress.len());
    println!("checkpoints                    {all:>9}");
    println!("checkpoints after the resume   {later:>9}");
    println!("equal results after the resume {:>9}", first == resumed);
    println!("pair fields                    {:>9}", effort.pairs);
    println!("iterations                     {:>9}", effort.iterations);
    println!("tangent products               {:>9}", effort.products);
    Ok(())
}
