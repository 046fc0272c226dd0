//! Numerical choices of a cycle that depend on its case, and its checkpoints.

use super::KEPT_FOR;
use crate::constants::Constant;
use crate::physics::asperities::numerics::Steps;
use crate::stages::step_count;

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
        &[step_count::MOST as f64],
        "",
        "Maximum, asperity model. A cycle that needs more fails before it begins.",
        "",
    ),
];
