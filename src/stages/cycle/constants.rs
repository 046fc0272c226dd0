//! Numerical choices of a cycle that depend on its case, and its checkpoints.

use super::KEPT_FOR;
use super::asperities::{MANY, REST_EVERY};
use super::asperity_tables::CONVERGED;
use super::boundary_elements::FREE_STEP;
use super::elements_setup::{LOCATED, MARGIN, MOST_ITERATIONS, PEAK, WEAK};
use crate::constants::Constant;
use crate::stages::step_count;

/// Effect of weak adhesion.
const WEAKER: &str = "From this `U_el/Δγ` on, the step is divided by the second number, and the precision by the third.";

/// Constants of cycles.
pub(in crate::stages) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "residual of a converged step",
        &[CONVERGED],
        "`h_rms`",
        "Asperity model. A larger `residual_m` makes a step `unconverged`.",
        "asperity_tables",
    ),
    Constant::new(
        "asperities of a cycle with checkpoints",
        &[MANY as f64],
        "",
        "Minimum number, asperity model. Boundary elements always have checkpoints.",
        "asperities",
    ),
    Constant::new("time between checkpoints", &[KEPT_FOR.as_secs() as f64], "s", "Minimum.", ""),
    Constant::new(
        "restarts of a path with checkpoints",
        &[REST_EVERY],
        "`h_rms`",
        "Interval of the mean penetration, so that a path from a checkpoint has the same bytes.",
        "asperities",
    ),
    Constant::new("weak adhesion, boundary elements", &[WEAK[1].0, WEAK[1].1, WEAK[1].2], "", WEAKER, "elements_setup"),
    Constant::new("very weak adhesion, boundary elements", &[WEAK[0].0, WEAK[0].1, WEAK[0].2], "", WEAKER, "elements_setup"),
    Constant::new(
        "error of a jump, boundary elements",
        &[LOCATED],
        "of `Θ` so far",
        "A step with a larger one is halved, up to `boundary_elements.halvings` times.",
        "elements_setup",
    ),
    Constant::new("largest residual, boundary elements", &[PEAK], "of the rms residual", "Of an equilibrium.", "elements_setup"),
    Constant::new(
        "iterations, boundary elements",
        &[MOST_ITERATIONS as f64],
        "",
        "Maximum of one minimization. Then Newton's method takes over.",
        "elements_setup",
    ),
    Constant::new("reach of bonds", &[MARGIN as f64], "`dx`", "Points this close to contact are bonded.", "elements_setup"),
    Constant::new(
        "steps without adhesion",
        &[FREE_STEP],
        "of the steps",
        "Steps of the table `adhesionless`, in those of the cycle.",
        "boundary_elements",
    ),
    Constant::new(
        "steps of a cycle",
        &[step_count::MOST as f64],
        "",
        "Maximum, asperity model. A cycle that needs more fails before it begins.",
        "",
    ),
];
