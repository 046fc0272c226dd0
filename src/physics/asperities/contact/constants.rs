//! Constants of contacts and of the rules for contacts that meet.

use super::merging::MAX_TENSILE_LOAD;
use super::problem::MAX_WU_JUMP_IN;
use super::spring::{INCREMENTS, LOAD_OF_ONE, LONGEST_SPRING, OUTPUT_STEPS, SOFT_MACHINE};
use super::transition::ABSORPTION_DISTANCE;
use crate::constants::Constant;

/// Constants of contacts.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "distance of absorption",
        &[ABSORPTION_DISTANCE],
        "of the radius",
        "A contact absorbs an asperity at this distance from its edge, where the slope of its field is still \
         finite.",
        "transition",
    ),
    Constant::new(
        "tensile force of a merged contact",
        &[MAX_TENSILE_LOAD],
        "`sqrt(8πE*Δγa³)`",
        "A pair with a larger tensile force does not merge. The branch of the merged contact ends at 5/6.",
        "merging",
    ),
    Constant::new(
        "largest magnitude of Wu's `δ_in`",
        &[MAX_WU_JUMP_IN],
        "`δ_off`",
        "Wu's criterion is not used beyond this penetration.",
        "problem",
    ),
    Constant::new(
        "compliance of load control",
        &[SOFT_MACHINE, LOAD_OF_ONE],
        "`1/(E*a_i)`, `R_iΔγ`",
        "Means of the asperities, `a_i = (R_i²Δγ/E*)^⅓`, divided by the number of asperities with the second \
         load at the largest one. In a jump the load changes by the jump over the compliance.",
        "spring",
    ),
    Constant::new(
        "longest spring of load control",
        &[LONGEST_SPRING],
        "`h_rms`",
        "At the largest load. A softer spring would exceed the precision of an equilibrium.",
        "spring",
    ),
    Constant::new(
        "parts of the length of a spring",
        &[INCREMENTS, OUTPUT_STEPS],
        "",
        "At the largest load: longest increments, and output steps of relative length 1.",
        "spring",
    ),
];
