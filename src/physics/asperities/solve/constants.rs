//! Tolerances and limits of global and local problems.

use super::descent::{MAX_LINEAR_RESIDUAL, MAX_LINEAR_RESIDUAL_SUFFICIENT, MIN_LINEAR_RESIDUAL};
use super::global::{BLOCK, PRODUCTS, RATES, ROUGH_RATES};
use super::local::LOCAL_TOLERANCE;
use super::relaxation::STEPS;
use super::residual::STRIDE;
use super::schwarz::{GROUP, MOST_SOLUTIONS, SOLVED_TOGETHER};
use crate::constants::Constant;

/// Constants of the solvers.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new("residual of a local problem", &[LOCAL_TOLERANCE], "`h_rms`", "With contacts outside of it.", "local"),
    Constant::new(
        "change of a radius in one iteration",
        &[STRIDE],
        "of the radius",
        "Longer steps of Newton's method are shortened to it.",
        "residual",
    ),
    Constant::new(
        "linear systems of exact global solves",
        &[MIN_LINEAR_RESIDUAL, MAX_LINEAR_RESIDUAL],
        "relative residual",
        "Smallest and largest tolerance of GMRES.",
        "descent",
    ),
    Constant::new(
        "linear systems of intermediate solves",
        &[MAX_LINEAR_RESIDUAL_SUFFICIENT],
        "relative residual",
        "Largest tolerance of GMRES.",
        "descent",
    ),
    Constant::new("products of one linear system", &[PRODUCTS as f64], "", "Maximum number.", "global"),
    Constant::new("rates of the radii", &[RATES, ROUGH_RATES], "relative residual", "At output steps, and elsewhere.", "global"),
    Constant::new("evaluation of all free asperities", &[BLOCK], "`h_rms`", "Interval of the mean penetration.", "global"),
    Constant::new(
        "groups of the preconditioner",
        &[GROUP as f64, SOLVED_TOGETHER as f64, MOST_SOLUTIONS as f64],
        "",
        "Contacts in a group, contacts that are solved together for it, and solutions after which a group is factored again.",
        "schwarz",
    ),
    Constant::new("steps of a relaxation", &[STEPS as f64], "", "Maximum number after the last change of state.", "relaxation"),
];
