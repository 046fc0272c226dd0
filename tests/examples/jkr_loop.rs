//! JKR loop of one asperity, compared with the closed form.
//!
//! `cargo run --no-default-features --example jkr_loop`

#![allow(clippy::print_stdout)]

use hysteron::model::{Boundary, Coalescence, Interaction, JumpIn, KeptContacts, Material, Slips};
use hysteron::physics::PhysicsError;
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Settings};
use hysteron::physics::cycle::Method;
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::summits::Summit;

/// A soft gel: E* = 1 MPa, Δγ = 0.07 J/m².
const MATERIAL: Material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
/// Radius of curvature R \[m\].
const RADIUS_M: f64 = 3e-5;
/// Side of the square \[m\] and unit of the approach \[m\].
const SIDE_M: f64 = 1e-3;
const UNIT_M: f64 = 1e-7;

/// A quantity of the computed loop and its closed form.
pub struct Row {
    /// Name and unit.
    pub quantity: &'static str,
    /// Value of the computed loop.
    pub computed: f64,
    /// Closed form.
    pub exact: f64,
}

/// Loads one asperity to 20 µN, unloads it and compares the loop with JKR theory.
///
/// # Errors
/// The errors of [`Problem::new`] and [`cycle`].
pub fn run() -> Result<Vec<Row>, PhysicsError> {
    let k = 1.0 / RADIUS_M;
    let (x_m, y_m, height_m) = (0.5 * SIDE_M, 0.5 * SIDE_M, 0.0);
    let (curvature_1_m, curvature_min_1_m, curvature_max_1_m) = (k, k, k);
    let (grid_row, grid_col, refined) = (0, 0, true);
    let summit = Summit { x_m, y_m, height_m, curvature_1_m, curvature_min_1_m, curvature_max_1_m, grid_row, grid_col, refined };
    let rules = Rules {
        interaction: Interaction::None,
        boundary: Boundary::Isolated,
        coalescence: Coalescence::None,
        jump_in: JumpIn::Jkr,
        allow_low_tabor: false,
        slips: Slips::NONE,
    };
    let problem = Problem::new(&[summit], SIDE_M, UNIT_M, MATERIAL, rules)?;
    let max_loads = vec![2e-5 / problem.load_unit_n()];
    let settings = Settings { max_loads, approach_step: 0.25, contacts: KeptContacts::None, rest_every: None };
    let cycle = Asperities { problem, settings }.run()?;

    let jkr = Asperity::new(RADIUS_M, &MATERIAL)?;
    let (turn, last) = (&cycle.steps[cycle.turning[0].0], &cycle.steps[cycle.steps.len() - 1]);
    let pull_off = cycle.steps.iter().map(|step| step.least_load_n).fold(0.0, f64::min);
    let jump_off = cycle.events.last().map_or(f64::NAN, |event| event.mean_penetration_m);
    let radius = jkr.radius_at_penetration(turn.mean_penetration_m).unwrap_or(f64::NAN);
    Ok(vec![
        Row { quantity: "load at the reversal F [N]", computed: turn.load_n, exact: jkr.load(radius) },
        Row { quantity: "minimum load, -F_po [N]", computed: pull_off, exact: jkr.pull_off_load() },
        Row { quantity: "penetration at jump-off [m]", computed: jump_off, exact: jkr.jump_off_penetration() },
        Row { quantity: "loop area, Θ [J]", computed: turn.work_j + last.work_j, exact: jkr.loop_loss() },
    ])
}

fn main() -> Result<(), PhysicsError> {
    println!("{:<28} {:>14} {:>14} {:>9}", "quantity", "computed", "closed form", "error");
    for Row { quantity, computed, exact } in run()? {
        println!("{quantity:<28} {computed:>14.6e} {exact:>14.6e} {:>9.1e}", computed / exact - 1.0);
    }
    Ok(())
}
