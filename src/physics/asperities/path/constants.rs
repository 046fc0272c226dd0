//! Tolerances and limits of the path.

use super::accuracy::{CONVERGED, EVENT_TOLERANCE, EXACT_GRID, LEAST_SCALE, LOAD_TOLERANCE};
use super::apply::RETRY;
use super::avalanche::{LARGE, MOST_SOLVES};
use super::chatter::MOST_CHANGES;
use super::events::{MOST_TRIALS as MOST_LOCATIONS, TOUCH};
use super::neighbourhood::{SHELL, SPAN};
use super::propagation::NEGLIGIBLE;
use super::step_control::{ACCEPTS_RESIDUAL, FEW, MOST_HALVINGS, MOST_TRIALS};
use crate::asperities::contact::numerics::ACCURACY;
use crate::constants::Constant;

/// Constants of the path between its events.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "smallest path scale `d`",
        &[LEAST_SCALE],
        "`h_rms`",
        "Replaces the mean jump-off penetration `d` where adhesion is weaker.",
        "accuracy",
    ),
    Constant::new(
        "accuracy of the path",
        &[ACCURACY.0],
        "`d`",
        "The limits of the path in units of `d` are multiples of this number.",
        "accuracy",
    ),
    Constant::new(
        "longest path increment",
        &[ACCURACY.longest_increment(), ACCURACY.longest_increment_of_whole()],
        "`d`",
        "Rounded down to the grid of exact solves, or to a power of two of it. The second value holds where local problems have all contacts.",
        "step_control",
    ),
    Constant::new(
        "predictor residual, rms and maximum",
        &[ACCURACY.drift(), ACCURACY.worst_residual()],
        "`d`",
        "Larger ones before the corrector reject the increment.",
        "corrector",
    ),
    Constant::new(
        "delay of an event",
        &[ACCURACY.lateness()],
        "`d`",
        "An event that the corrector finds later than this rejects the increment.",
        "corrector",
    ),
    Constant::new(
        "pending displacement",
        &[ACCURACY.pending()],
        "`d`",
        "A contact with a larger one has a local solve of its own.",
        "pending",
    ),
    Constant::new(
        "pending displacement of members",
        &[NEGLIGIBLE],
        "of that limit",
        "Members of a local problem with a larger one take it up before the event.",
        "propagation",
    ),
    Constant::new(
        "residual of intermediate global solves",
        &[ACCURACY.sufficient()],
        "`d`",
        "For states that are not written.",
        "corrector",
    ),
    Constant::new(
        "grid of exact global solves",
        &[EXACT_GRID],
        "`h_rms`",
        "Mean penetrations at which the global problem is solved as exactly as at output steps.",
        "accuracy",
    ),
    Constant::new("residual of a converged step", &[CONVERGED], "`h_rms`", "A larger `residual_m` makes a step `unconverged`.", "accuracy"),
    Constant::new("position of an event", &[EVENT_TOLERANCE], "`h_rms`", "Where two events compete, and at a limit point.", "accuracy"),
    Constant::new(
        "force at load reversal",
        &[LOAD_TOLERANCE],
        "relative",
        "Also, in units of `h_rms`, the mean penetration of a load that jumps across the reversal.",
        "accuracy",
    ),
    Constant::new(
        "halvings of an increment",
        &[ACCEPTS_RESIDUAL as f64, MOST_HALVINGS as f64],
        "",
        "From the first number on, the predictor residual is accepted and contacts without equilibrium relax. After the second, all contacts relax.",
        "step_control",
    ),
    Constant::new(
        "trials of events in one increment",
        &[MOST_TRIALS as f64, FEW as f64],
        "",
        "With `N` asperities, at most the first number times `N` plus the second. Beyond it the cycle fails (`no stable state`).",
        "step_control",
    ),
    Constant::new(
        "trials to locate a touch",
        &[MOST_LOCATIONS as f64],
        "",
        "Maximum number of brackets of the touch of two contacts.",
        "events",
    ),
    Constant::new("overlap at merging", &[TOUCH], "of the distance", "Contacts that touch are located to this overlap.", "events"),
    Constant::new(
        "shell around a local problem",
        &[SHELL as f64],
        "",
        "Contacts of local problem and shell, over those of the local problem. Beyond the shell an event acts as a point force.",
        "neighbourhood",
    ),
    Constant::new("free asperities in the shell", &[SPAN], "`d`", "Distance from jump-in up to which they are followed.", "neighbourhood"),
    Constant::new(
        "local solves in an avalanche",
        &[MOST_SOLVES as f64],
        "",
        "At most this number, or the number of contacts divided by it if that is larger. Then the global problem is solved.",
        "avalanche",
    ),
    Constant::new(
        "changes of state in an avalanche",
        &[LARGE as f64],
        "",
        "From this number on the global problem is solved after the avalanche.",
        "avalanche",
    ),
    Constant::new(
        "changes of state of one asperity",
        &[MOST_CHANGES as f64],
        "",
        "Other than jump-off, within a longest increment. Then the asperity is frozen until the next one (`held_count`).",
        "chatter",
    ),
    Constant::new(
        "radius of a postponed release",
        &[RETRY],
        "of the radius",
        "A release that would be undone at the same penetration is tried again when the larger contact has shrunk to this.",
        "apply",
    ),
];
