//! Limits of a valid cycle.

use super::soundness::{LARGEST_IMBALANCE, LARGEST_VIOLATION, RESOLUTION};
use crate::constants::Constant;

/// Limits of both methods.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "numerical resolution of `Θ`",
        &[RESOLUTION],
        "`W`",
        "`W` is the largest magnitude of `∫F dΔ` along the loop. Column `loss_uncertainty`.",
        "soundness",
    ),
    Constant::new(
        "energy-balance error",
        &[LARGEST_IMBALANCE],
        "`Θ`",
        "A cycle with a larger one fails, if it also exceeds the next limit.",
        "soundness",
    ),
    Constant::new(
        "violation of sign or energy balance",
        &[LARGEST_VIOLATION],
        "`W`",
        "A cycle with a larger one fails. With a smaller one it has the warning `unresolved`.",
        "soundness",
    ),
];
