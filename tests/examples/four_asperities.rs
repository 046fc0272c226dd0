//! One loading–unloading cycle of four interacting asperities: table of steps.
//!
//! `cargo run --no-default-features --example four_asperities`

#![allow(clippy::print_stdout)]

use hysteron::model::{Boundary, Coalescence, Interaction, JumpIn, KeptContacts, Material, Slips};
use hysteron::physics::PhysicsError;
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Cycle, Settings};
use hysteron::physics::cycle::Method;
use hysteron::physics::surface::summits::Summit;

/// A soft gel: E* = 1 MPa, Δγ = 0.07 J/m², range of attraction 1 nm.
pub const MATERIAL: Material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
/// Side of the periodic square \[m\].
const SIDE_M: f64 = 1e-4;
/// Unit of the approach \[m\].
const UNIT_M: f64 = 1e-7;
/// Places x/L and y/L, heights \[m\], radii of curvature \[m\].
pub const ASPERITIES: [[f64; 4]; 4] = [[0.2, 0.3, 0.0, 2e-5], [0.6, 0.2, -2e-7, 1e-5], [0.4, 0.8, -5e-7, 3e-5], [0.8, 0.7, -1e-7, 1.5e-5]];

/// Loads the four asperities to 30 µN and unloads them to separation.
///
/// # Errors
/// The errors of [`Problem::new`] and [`cycle`].
pub fn run() -> Result<Cycle, PhysicsError> {
    let summits = ASPERITIES.map(|[x, y, height_m, radius_m]| {
        let k = 1.0 / radius_m;
        let (x_m, y_m) = (x * SIDE_M, y * SIDE_M);
        let (curvature_1_m, curvature_min_1_m, curvature_max_1_m) = (k, k, k);
        let (grid_row, grid_col, refined) = (0, 0, true);
        Summit { x_m, y_m, height_m, curvature_1_m, curvature_min_1_m, curvature_max_1_m, grid_row, grid_col, refined }
    });
    let rules = Rules {
        interaction: Interaction::Spots,
        boundary: Boundary::Periodic,
        coalescence: Coalescence::Cover,
        jump_in: JumpIn::Wu,
        allow_low_tabor: false,
        slips: Slips::NONE,
    };
    let problem = Problem::new(&summits, SIDE_M, UNIT_M, MATERIAL, rules)?;
    let max_loads = vec![3e-5 / problem.load_unit_n()];
    let settings = Settings { max_loads, approach_step: 2.0, contacts: KeptContacts::None, rest_every: None };
    Asperities { problem, settings }.run()
}

fn main() -> Result<(), PhysicsError> {
    let cycle = run()?;
    println!("{:<10} {:>8} {:>9} {:>9} {:>9} {:>7} {:>12}", "branch", "Δ [nm]", "F [µN]", "A [µm²]", "contacts", "events", "Θ [fJ]");
    for step in &cycle.steps {
        let events = step.counts.events.sum();
        println!(
            "{:<10} {:>8.1} {:>9.3} {:>9.2} {:>9} {:>7} {:>12.3}",
            step.branch.word(),
            step.mean_penetration_m * 1e9,
            step.load_n * 1e6,
            step.area_m2 * 1e12,
            step.counts.contacts,
            events,
            // The sum over no event is a negative zero.
            step.dissipated_j.abs() * 1e15
        );
    }
    Ok(())
}
