//! Limits and checkpoints of cycles, and constants of the estimates before a run.

use super::KEPT_FOR;
use super::asperities::{MOST_STEPS, OF_ASPERITIES};
use super::elements::{LONG, OF_POINTS};
use crate::constants::Constant;
use crate::physics::asperities::numerics::Steps;

/// Constants of cycles.
pub(in crate::stages) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "asperities of a cycle with checkpoints",
        &[Steps::DEFAULT.checkpoints_from as f64],
        "",
        "Minimum number, asperity model. Boundary elements always have checkpoints.",
        "asperities",
    ),
    Constant::new("time between checkpoints", &[KEPT_FOR.as_secs() as f64], "s", "Minimum.", ""),
    Constant::new(
        "restarts of a path with checkpoints",
        &[Steps::DEFAULT.checkpoint_interval],
        "`h_rms`",
        "Interval of the mean penetration, so that a path from a checkpoint has the same bytes.",
        "asperities",
    ),
    Constant::new(
        "steps of a cycle",
        &[MOST_STEPS as f64],
        "",
        "Maximum, asperity model. A cycle that needs more fails before it begins.",
        "",
    ),
];

/// Constants of the estimates before a run.
pub(in crate::stages) const ESTIMATES: &[Constant] = &[
    Constant::new(
        "time of a loop on N x N points, `a`, `b`",
        &OF_POINTS,
        "s",
        "Boundary elements: `a N² + b N³`; accuracy: a factor of 3.",
        "",
    ),
    Constant::new(
        "time of a cycle of asperities, factor, exponent",
        &OF_ASPERITIES,
        "s",
        "With merging, at ζ/64 and `F_max/(E* A0)` = 0.0071.",
        "",
    ),
    Constant::new(
        "long loop",
        &[LONG],
        "s",
        "A longer loop by boundary elements is announced before it starts.",
        "",
    ),
];
