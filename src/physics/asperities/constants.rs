//! Tolerances and limits of the asperity model.

use super::numerics::{Events, Solver, Steps};
use crate::constants::Constant;

const STEPS: Steps = Steps::DEFAULT;
const EVENTS: Events = Events::DEFAULT;
const SOLVER: Solver = Solver::DEFAULT;

/// Constants of the path between its events.
pub(crate) const PATH: &[Constant] = &[
    Constant::new(
        "smallest path scale `d`",
        &[STEPS.min_scale],
        "`h_rms`",
        "Replaces the mean jump-off penetration `d` where adhesion is weaker.",
        "numerics",
    ),
    Constant::new(
        "accuracy of the path",
        &[STEPS.accuracy],
        "`d`",
        "The limits of the path in units of `d` are multiples of this number.",
        "numerics",
    ),
    Constant::new(
        "longest path increment",
        &[STEPS.longest_increment(), STEPS.longest_increment_of_whole()],
        "`d`",
        "Rounded down to the grid of exact solves, or to a power of two of it. The second value holds where \
         local problems have all contacts.",
        "numerics",
    ),
    Constant::new(
        "predictor residual, rms and maximum",
        &[STEPS.drift(), STEPS.worst_residual()],
        "`d`",
        "Larger ones before the corrector reject the increment.",
        "numerics",
    ),
    Constant::new(
        "delay of an event",
        &[STEPS.lateness()],
        "`d`",
        "An event that the corrector finds later than this rejects the increment.",
        "numerics",
    ),
    Constant::new(
        "pending displacement",
        &[STEPS.pending()],
        "`d`",
        "A contact with a larger one has a local solve of its own.",
        "numerics",
    ),
    Constant::new(
        "pending displacement of members",
        &[EVENTS.negligible_pending],
        "of that limit",
        "Members of a local problem with a larger one take it up before the event.",
        "numerics",
    ),
    Constant::new(
        "residual of intermediate global solves",
        &[STEPS.sufficient()],
        "`d`",
        "For states that are not written.",
        "numerics",
    ),
    Constant::new(
        "grid of exact global solves",
        &[STEPS.exact_grid],
        "`h_rms`",
        "Mean penetrations at which the global problem is solved as exactly as at output steps.",
        "numerics",
    ),
    Constant::new(
        "residual of a converged step",
        &[SOLVER.converged_residual],
        "`h_rms`",
        "A larger `residual_m` makes a step `unconverged`.",
        "numerics",
    ),
    Constant::new(
        "position of an event",
        &[EVENTS.position_tolerance],
        "`h_rms`",
        "Where two events compete, and at a limit point.",
        "numerics",
    ),
    Constant::new(
        "force at load reversal",
        &[STEPS.load_tolerance],
        "relative",
        "Also, in units of `h_rms`, the mean penetration of a load that jumps across the reversal.",
        "numerics",
    ),
    Constant::new(
        "halvings of an increment",
        &[STEPS.strict_halvings as f64, STEPS.max_halvings as f64],
        "",
        "From the first number on, the predictor residual is accepted and contacts without equilibrium \
         relax. After the second, all contacts relax.",
        "numerics",
    ),
    Constant::new(
        "trials of events in one increment",
        &[EVENTS.trials_per_asperity as f64, EVENTS.trials_offset as f64],
        "",
        "With `N` asperities, at most the first number times `N` plus the second. Beyond it the cycle fails \
         (`no stable state`).",
        "numerics",
    ),
    Constant::new(
        "trials to locate a touch",
        &[EVENTS.merging_trials as f64],
        "",
        "Maximum number of brackets of the touch of two contacts.",
        "numerics",
    ),
    Constant::new(
        "overlap at merging",
        &[EVENTS.merging_overlap],
        "of the distance",
        "Contacts that touch are located to this overlap.",
        "numerics",
    ),
    Constant::new(
        "contacts in a local problem",
        &[EVENTS.local_contacts as f64],
        "",
        "Those closest to the event. All others act by their field and its rate.",
        "numerics",
    ),
    Constant::new(
        "shell around a local problem",
        &[EVENTS.shell_ratio as f64],
        "",
        "Contacts of local problem and shell, over those of the local problem. Beyond the shell an event \
         acts as a point force.",
        "numerics",
    ),
    Constant::new(
        "free asperities in the shell",
        &[EVENTS.jump_in_distance],
        "`d`",
        "Distance from jump-in up to which they are followed.",
        "numerics",
    ),
    Constant::new(
        "local solves in an avalanche",
        &[EVENTS.avalanche_solves as f64],
        "",
        "At most this number, or the number of contacts divided by it if that is larger. Then the global \
         problem is solved.",
        "numerics",
    ),
    Constant::new(
        "changes of state in an avalanche",
        &[EVENTS.large_avalanche as f64],
        "",
        "From this number on the global problem is solved after the avalanche.",
        "numerics",
    ),
    Constant::new(
        "changes of state of one asperity",
        &[EVENTS.changes_per_asperity as f64],
        "",
        "Other than jump-off, within a longest increment. Then the asperity is frozen until the next one \
         (`held_count`).",
        "numerics",
    ),
    Constant::new(
        "radius of a postponed release",
        &[EVENTS.retried_release],
        "of the radius",
        "A release that would be undone at the same penetration is tried again when the larger contact has \
         shrunk to this.",
        "numerics",
    ),
];

/// Constants of the solvers.
pub(crate) const SOLVERS: &[Constant] = &[
    Constant::new(
        "residual of a local problem",
        &[SOLVER.local_residual],
        "`h_rms`",
        "With contacts outside of it.",
        "numerics",
    ),
    Constant::new(
        "change of a radius in one iteration",
        &[SOLVER.radius_change],
        "of the radius",
        "Longer steps of Newton's method are shortened to it.",
        "numerics",
    ),
    Constant::new(
        "linear systems of exact global solves",
        &[SOLVER.linear_residual_min, SOLVER.linear_residual],
        "relative residual",
        "Smallest and largest tolerance of GMRES.",
        "numerics",
    ),
    Constant::new(
        "linear systems of intermediate solves",
        &[SOLVER.linear_residual_intermediate],
        "relative residual",
        "Largest tolerance of GMRES.",
        "numerics",
    ),
    Constant::new(
        "products of one linear system",
        &[SOLVER.products as f64],
        "",
        "Maximum number.",
        "numerics",
    ),
    Constant::new(
        "rates of the radii",
        &[SOLVER.rates_residual, SOLVER.rates_residual_intermediate],
        "relative residual",
        "At output steps, and elsewhere.",
        "numerics",
    ),
    Constant::new(
        "evaluation of all free asperities",
        &[SOLVER.free_interval],
        "`h_rms`",
        "Interval of the mean penetration.",
        "numerics",
    ),
    Constant::new(
        "groups of the preconditioner",
        &[
            SOLVER.groups.contacts as f64,
            SOLVER.groups.solved_together as f64,
            SOLVER.groups.solutions as f64,
        ],
        "",
        "Contacts in a group, contacts that are solved together for it, and solutions after which a group is \
         factored again.",
        "numerics",
    ),
    Constant::new(
        "steps of a relaxation",
        &[SOLVER.relaxation.steps as f64],
        "",
        "Maximum number after the last change of state.",
        "numerics",
    ),
];
