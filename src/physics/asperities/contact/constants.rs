//! Constants of contacts and of the rules for contacts that meet.

use super::merging::MAX_TENSILE_LOAD;
use super::problem::MAX_WU_JUMP_IN;
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
];
