//! Tolerances and limits of boundary elements.

use super::equilibrium::places::SMALLEST_SIDE;
use super::events::work::DISCONTINUITY;
use super::grid::medium::LEFT_COMPLIANCE;
use super::law::{Front, KERNEL_WIDTH, MAX_OVERLAP, NEGLIGIBLE_GAP, WALL_STIFFNESS};
use super::numerics::{Minimization, PatchLimits, Reversal, Steps, Weak};
use super::path::stations::{MAP_STATIONS, MAX_MAP_SIDE};
use super::setup::SHORTEST_EMPHASISED;
use crate::constants::Constant;

const STEPS: Steps = Steps::DEFAULT;
const REVERSAL: Reversal = Reversal::DEFAULT;
const EQUILIBRIUM: Minimization = Minimization::DEFAULT;
const PATCHES: PatchLimits = PatchLimits::DEFAULT;

/// Effect of weak adhesion.
const WEAKER: &str =
    "From this `U_el/Δγ` on, the step is divided by the second number, and the precision by the third.";

const fn weak(at: usize) -> [f64; 3] {
    let Weak { ratio, steps, precision } = STEPS.weak[at];
    [ratio, steps, precision]
}

/// Constants of the solver on a grid.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "width of the kernel of the law",
        &[KERNEL_WIDTH],
        "`dx`",
        "Gaussian `W` of the bonded attraction.",
        "law",
    ),
    Constant::new(
        "stiffness of the wall",
        &[WALL_STIFFNESS],
        "`E*/dx`",
        "Spring at small gaps and in compression, bonded attraction.",
        "law",
    ),
    Constant::new(
        "half width and middle of the step of the line tension",
        &[Front::CORRECTED.line_reach, Front::CORRECTED.line_place],
        "`dx`",
        "Corrected law: function φ of the place, ahead of the front.",
        "law/front",
    ),
    Constant::new(
        "shortest wavelength that is raised",
        &[SHORTEST_EMPHASISED],
        "`dx`",
        "Corrected law: pre-emphasis of the heights.",
        "setup",
    ),
    Constant::new(
        "compliance that is left",
        &[LEFT_COMPLIANCE],
        "of its own",
        "Corrected law on a layer, where the compliance of the wall is subtracted.",
        "grid/medium",
    ),
    Constant::new(
        "overlap with linear repulsion",
        &[MAX_OVERLAP],
        "`ρ`",
        "Beyond it Morse's law goes on linearly.",
        "law",
    ),
    Constant::new(
        "gap without attraction",
        &[NEGLIGIBLE_GAP],
        "`ρ`",
        "Beyond it Morse's law is not evaluated.",
        "law",
    ),
    Constant::new(
        "residual at which bonds change",
        &[EQUILIBRIUM.bond_update_residual],
        "maximum tension",
        "Largest residual of a state in which contact may form or open.",
        "numerics",
    ),
    Constant::new(
        "iterations before the first patch",
        &[EQUILIBRIUM.whole_iterations as f64],
        "",
        "On the whole grid, at the beginning of a step.",
        "numerics",
    ),
    Constant::new(
        "maps between the ends of a branch",
        &[MAP_STATIONS[0] as f64, (MAP_STATIONS[1] + MAP_STATIONS[2]) as f64],
        "",
        "Maximum, on loading and on each unloading.",
        "path/stations",
    ),
    Constant::new(
        "side of such maps",
        &[MAX_MAP_SIDE as f64],
        "points",
        "Maximum. Of larger grids they have every n-th point.",
        "path/stations",
    ),
    Constant::new(
        "places on patches",
        &[PATCHES.places as f64],
        "",
        "Maximum number of places of an event that are relaxed apart.",
        "numerics",
    ),
    Constant::new(
        "side of a patch",
        &[SMALLEST_SIDE as f64, 1.0 / PATCHES.sides_of_grid as f64],
        "points; of the grid",
        "Minimum, and maximum.",
        "numerics",
    ),
    Constant::new(
        "force at load reversal",
        &[REVERSAL.load_tolerance, REVERSAL.jump_tolerance],
        "relative",
        "Where the load is reached, and where it jumps across the reversal.",
        "numerics",
    ),
    Constant::new(
        "equilibria near the load reversal",
        &[REVERSAL.precision, REVERSAL.equilibria as f64],
        "",
        "Their tolerance relative to `boundary_elements.precision`, and the maximum number of equilibria of \
         a search.",
        "numerics",
    ),
    Constant::new(
        "smallest event",
        &[STEPS.event_fraction],
        "dissipated energy",
        "Relative to the energy dissipated so far.",
        "numerics",
    ),
    Constant::new(
        "uncertainty of a step",
        &[STEPS.bend_uncertainty, STEPS.jump_uncertainty],
        "",
        "Fractions of the last term of the integral and of the error of a jump. An event exceeds them.",
        "numerics",
    ),
    Constant::new(
        "discontinuous force",
        &[DISCONTINUITY],
        "of the change of slope",
        "Where the force differs from the mean of both tangents by more, the last term is omitted.",
        "events/work",
    ),
    Constant::new(
        "error that lengthens a step",
        &[STEPS.lengthening_error],
        "of the limit",
        "Below it the next step may be twice as long.",
        "numerics",
    ),
    Constant::new(
        "error that ends a step early",
        &[STEPS.early_end_error],
        "of the limit",
        "A step is halved before it is in equilibrium.",
        "numerics",
    ),
    Constant::new(
        "hidden maximum tension",
        &[STEPS.hidden_tension],
        "relative",
        "A step of unloading that may have passed a larger tension is halved.",
        "numerics",
    ),
    Constant::new(
        "rate of extrapolation `du/dΔ`",
        &[STEPS.max_rate],
        "",
        "Larger rates are scaled to it.",
        "numerics",
    ),
    Constant::new(
        "extrapolated overlap",
        &[STEPS.extrapolated_overlap],
        "`ρ`",
        "Points that extrapolation moves deeper into the wall are raised, with a range of attraction.",
        "numerics",
    ),
    Constant::new(
        "rate and stiffness of an equilibrium",
        &[EQUILIBRIUM.rate_residual],
        "relative residual",
        "Tolerance of conjugate gradients.",
        "numerics",
    ),
    Constant::new(
        "farthest mean penetration",
        &[STEPS.farthest],
        "range of the heights",
        "Beyond it a load is not reached, or the surfaces do not separate.",
        "numerics",
    ),
    Constant::new(
        "steps that may be halved",
        &[STEPS.halved_steps as f64],
        "",
        "With a range of attraction: after this number of steps of a cycle none is halved.",
        "numerics",
    ),
    Constant::new("weak adhesion", &weak(1), "", WEAKER, "numerics"),
    Constant::new("very weak adhesion", &weak(0), "", WEAKER, "numerics"),
    Constant::new(
        "error of a jump",
        &[STEPS.jump_tolerance],
        "of `Θ` so far",
        "A step with a larger one is halved, up to `boundary_elements.halvings` times.",
        "numerics",
    ),
    Constant::new(
        "largest residual",
        &[EQUILIBRIUM.largest_residual],
        "of the rms residual",
        "Of an equilibrium.",
        "numerics",
    ),
    Constant::new(
        "iterations",
        &[EQUILIBRIUM.iterations as f64],
        "",
        "Maximum of one minimization. Then Newton's method takes over.",
        "numerics",
    ),
    Constant::new(
        "steps without adhesion",
        &[STEPS.free_step],
        "of the steps",
        "Steps of the table `adhesionless`, in those of the cycle.",
        "numerics",
    ),
    Constant::new(
        "reach of bonds",
        &[EQUILIBRIUM.bond_margin as f64],
        "`dx`",
        "Points this close to contact are bonded.",
        "numerics",
    ),
];
