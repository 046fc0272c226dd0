//! Constants of direct and fast sums.

use super::choose::{
    DIRECT_TOLERANCE, FAST_FROM_ISOLATED, FAST_FROM_PERIODIC, FAST_FROM_TABLE, INTERMEDIATE_TOLERANCE,
    MIN_ASPERITIES, TOLERANCE,
};
use super::direct::TABLE_LIMIT;
use crate::constants::Constant;

/// Constants of the sums over contacts.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "residual of an equilibrium at output steps",
        &[TOLERANCE, DIRECT_TOLERANCE],
        "`h_rms`",
        "The second value holds where all sums are direct. The same on the grid of exact global solves.",
        "choose",
    ),
    Constant::new(
        "error of fast sums",
        &[TOLERANCE, INTERMEDIATE_TOLERANCE],
        "largest displacement",
        "At output steps, and elsewhere.",
        "choose",
    ),
    Constant::new(
        "asperities with fast sums",
        &[MIN_ASPERITIES as f64],
        "",
        "With fewer, all sums are direct.",
        "choose",
    ),
    Constant::new(
        "contacts with fast sums",
        &[FAST_FROM_PERIODIC as f64, FAST_FROM_TABLE as f64, FAST_FROM_ISOLATED as f64],
        "",
        "Fewer are summed directly. The second number holds with a table of image sums, the third with \
         `boundary = \"isolated\"`.",
        "choose",
    ),
    Constant::new(
        "asperities with a table of image sums",
        &[TABLE_LIMIT as f64],
        "",
        "Maximum number; without merging.",
        "direct",
    ),
];
