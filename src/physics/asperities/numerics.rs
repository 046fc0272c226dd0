//! Numerical choices of the asperity model: tolerances, limits of effort and rules of the search.
//!
//! They are not part of the physical model; some change Θ by up to a few per cent, as stated.
//!
//! Each field states its effect as far as it was measured: means of Θ, F_po and the area at `Δγ = 0.07 J/m²`
//! (see `tests/benches/notes.md`).

/// Numerical choices of the asperity model.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Numerics {
    /// Increments of the path and its output.
    pub steps: Steps,
    /// Location of events and propagation of their effect.
    pub events: Events,
    /// Global and local problems.
    pub solver: Solver,
}

impl Numerics {
    /// The choices of the program.
    pub const DEFAULT: Self =
        Self { steps: Steps::DEFAULT, events: Events::DEFAULT, solver: Solver::DEFAULT };
}

/// Increments of the path, in units of the rms height `h_rms` and of the scale `d` of the path: the mean
/// jump-off penetration, rounded down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Accuracy of the path between exact global solves \[`d`\], from which the limits of its increments
    /// follow.
    ///
    /// At an eighth of it Θ changes by 3e-5 and F_po by 6e-4. Doubling the longest increment alone: up to a
    /// third fewer global solves, 19 to 54 % more iterations of local problems, no gain of time. Doubling the
    /// pending displacement alone: 19 % fewer iterations, Θ −0.2 %, −2 % with merging.
    pub accuracy: f64,
    /// Minimum scale `d` \[`h_rms`\], where adhesion is weaker. A larger one takes fewer increments, with
    /// larger errors at weak adhesion.
    pub min_scale: f64,
    /// Interval of the mean penetration between exact global solves \[`h_rms`\]. A larger one takes fewer
    /// exact solves.
    pub exact_grid: f64,
    /// Maximum number of halvings of an increment before all contacts relax. With a larger one shorter
    /// increments are tried first.
    pub max_halvings: u32,
    /// Number of halvings from which on the predictor residual is accepted. A larger one takes more attempts
    /// at the same place.
    pub strict_halvings: u32,
    /// Relative tolerance of the load at a reversal; and of its mean penetration \[`h_rms`\] where the load
    /// jumps across it.
    ///
    /// A larger one takes fewer excursions from the path.
    pub load_tolerance: f64,
    /// Number of asperities from which on a cycle has checkpoints. At a checkpoint the path restarts from the
    /// stored state, which changes last digits.
    pub checkpoints_from: usize,
    /// Interval of the mean penetration between checkpoints \[`h_rms`\]. A larger one loses more work with an
    /// interruption.
    pub checkpoint_interval: f64,
}

/// Location of events and propagation of their effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Events {
    /// Tolerance of the mean penetration of an event \[`h_rms`\]: the order of two events, and the step over
    /// a limit point.
    ///
    /// A larger one takes fewer local solves, and may exchange two events.
    pub position_tolerance: f64,
    /// Number of contacts in the local problem of an event, those nearest to it. All others respond to first
    /// order.
    ///
    /// With `usize::MAX` every event is solved globally. With 16 or 32 instead of 24 Θ changes by −0.1 and
    /// +0.05 %, iterations by +5 and −4 %, pairs by −19 and +26 %; 32 take longer.
    pub local_contacts: usize,
    /// Number of contacts of local problem and shell, over that of the local problem; beyond the shell an
    /// event acts as a point force.
    ///
    /// With 3 instead of 5 Θ changes by −0.05 %, the area by −0.2 %, iterations by +3 %, the time not.
    pub shell_ratio: usize,
    /// Distance before jump-in up to which free asperities next to an event are followed \[`d`\]; an event
    /// moves them by several jump-off penetrations.
    ///
    /// With 5 instead of 3 a cycle takes 3 % longer, with merging 11 %.
    pub jump_in_distance: f64,
    /// Pending displacement up to which a member of a local problem need not take it up before, over the
    /// limit of the path. A larger one is less exact.
    pub negligible_pending: f64,
    /// Maximum number of local solves in an avalanche, or the number of contacts divided by it if that is
    /// larger; then the global problem is solved.
    ///
    /// With at most 32 or 64 instead of a 16th of the contacts, global evaluations increase by 1 to 48 % (ζ =
    /// 256).
    pub avalanche_solves: usize,
    /// Number of changes of state in an avalanche from which on the global problem is solved after it: far
    /// contacts are moved by more than its point force.
    ///
    /// Without such solves five times as many increments are rejected because of avalanches (ζ = 256).
    pub large_avalanche: usize,
    /// Distance to the end of a branch, over the way that is left, within which the end is looked for: near a
    /// limit point the penetration varies as a square root, so that linear extrapolation overestimates the
    /// distance by about 2.
    ///
    /// With 1.1 instead of 2.2 results are the same, and iterations increase by 5 % (ζ = 64).
    pub branch_end_distance: f64,
    /// Radius over distance from which on two contacts are near a common limit point, since the field of each
    /// is steep there.
    ///
    /// Without that search Θ rises by 1.0 % (ζ = 16) and F_po by 1.4 % (ζ = 128).
    pub common_fold_distance: f64,
    /// Radius of a neighbour at the end of an increment, over its present one, up to which a merging is
    /// looked for. A larger one takes longer.
    pub neighbour_growth: f64,
    /// Largest change of the penetration of a free asperity over that of the mean penetration. A larger one
    /// evaluates more free asperities.
    pub penetration_rate: f64,
    /// Number of changes of state of one asperity, other than jumps out of contact, within a longest
    /// increment. Then it is frozen.
    ///
    /// With a larger one pairs without a stable state are followed for longer.
    pub changes_per_asperity: u8,
    /// Maximum number of trials of events in one increment, per asperity. Beyond it the cycle fails; a larger
    /// one takes longer to do so.
    pub trials_per_asperity: usize,
    /// Number of asperities that is added for that maximum.
    pub trials_offset: usize,
    /// Overlap of two contacts at merging, over their distance: the tolerance of its location. A larger one
    /// takes fewer local solves.
    pub merging_overlap: f64,
    /// Maximum number of local solves that locate a merging: a limit of the effort where the overlap jumps.
    pub merging_trials: usize,
    /// Relative change of a radius by which a contact is moved over a limit point. A larger one begins
    /// farther from the equilibrium that has ended.
    pub fold_step: f64,
    /// Radius of the larger contact, over the present one, at which a release that would be undone at once is
    /// tried again. Nearer to 1, it is tried more often.
    pub retried_release: f64,
    /// Relative change of a radius that an equilibrium does not resolve. With a smaller one rounding decides
    /// on releases and splittings.
    pub radius_resolution: f64,
}

/// Global and local problems.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solver {
    /// Residual of a converged step \[`h_rms`\]; a larger one is reported.
    pub converged_residual: f64,
    /// Residual of a local problem with contacts outside \[`h_rms`\].
    ///
    /// With 1e-10 instead of 1e-7 iterations increase by 8 to 11 %. With 1e-5 events repeat without end.
    pub local_residual: f64,
    /// Largest relative change of a radius in one iteration. A larger one leaves the branch of an equilibrium
    /// more often.
    pub radius_change: f64,
    /// Smallest relative residual of the linear systems of exact global solves. A smaller one takes more
    /// products in the last iteration.
    pub linear_residual_min: f64,
    /// Largest relative residual of these systems. With 1e-3 instead of 3e-3 products increase by 1 to 4 %
    /// and the time by up to 2 %.
    pub linear_residual: f64,
    /// Largest relative residual of the linear systems of intermediate global solves. A larger one takes
    /// fewer products and more evaluations.
    pub linear_residual_intermediate: f64,
    /// Maximum number of products of one linear system. A smaller one gives a less exact iteration where the
    /// preconditioner is poor.
    pub products: usize,
    /// Relative residual of the rates of the radii at exact solutions. With 1e-6 instead of 1e-4 a cycle
    /// takes 1 to 2 % longer, and Θ changes by 2e-5.
    pub rates_residual: f64,
    /// Relative residual of these rates at intermediate solutions. A larger one takes fewer products, with
    /// less exact predictors.
    pub rates_residual_intermediate: f64,
    /// Interval of the mean penetration between evaluations of all free asperities \[`h_rms`\]. With 0.05
    /// instead of 0.2 a cycle takes 2 to 3 % longer.
    pub free_interval: f64,
    /// Maximum number of points of the solution curve of a local problem.
    pub curve_points: usize,
    /// Groups of contacts of the preconditioner.
    pub groups: Groups,
    /// Relaxation where Newton's method finds no equilibrium.
    pub relaxation: Relaxation,
}

/// Groups of contacts of the preconditioner. They decide on the number of products alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Groups {
    /// Maximum number of contacts in a group.
    pub contacts: usize,
    /// Number of contacts that are solved together for it. A larger one takes fewer products, each of which
    /// costs more.
    pub solved_together: usize,
    /// Solutions after which a group is factored again if no contact next to it has come or gone. With 16
    /// instead of 8 the time is the same.
    pub solutions: usize,
    /// Factor by which the number of contacts may change before they are divided again.
    pub count_ratio: f64,
    /// Distance over radius beyond which a contact acts by its load alone: the rest is 2 % there, and less
    /// beyond. Also in local problems.
    pub point_load_distance: f64,
}

/// Relaxation in pseudo-time, whose unit is that of the flow `da_i/dt = residual_i`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    /// Maximum number of steps after the last change of state. Beyond it there is no equilibrium.
    pub steps: usize,
    /// Pseudo-time after which Newton's method may finish. A shorter one may end at another equilibrium than
    /// the flow.
    pub finish: f64,
    /// Factor by which that is extended if Newton's method fails. A larger one tries it less often.
    pub finish_growth: f64,
    /// Longest step of the pseudo-time: longer ones are those of Newton's method to rounding.
    pub longest_step: f64,
    /// Growth of the steps. With 10 instead of 3 Θ rises by 4 % and the area falls by 0.1 to 0.5 %.
    pub step_growth: f64,
    /// Maximum number of attempts at a step, each a quarter as long as the last.
    pub attempts: usize,
}

impl Steps {
    /// The choices of the program.
    pub const DEFAULT: Self = Self {
        accuracy: 1e-2,
        min_scale: 0.02,
        exact_grid: 0.01,
        max_halvings: 14,
        strict_halvings: 6,
        load_tolerance: 1e-9,
        checkpoints_from: 20_000,
        checkpoint_interval: 0.1,
    };

    /// Longest increment \[`d`\].
    pub(crate) const fn longest_increment(&self) -> f64 {
        5.0 * self.accuracy
    }

    /// Longest increment where local problems hold all contacts \[`d`\]: nothing is neglected then, and the
    /// work is to be as exact as the events.
    pub(crate) const fn longest_increment_of_whole(&self) -> f64 {
        5.0 * self.accuracy / 8.0
    }

    /// Maximum root-mean-square predictor residual at the end of an increment \[`d`\].
    pub(crate) const fn drift(&self) -> f64 {
        self.accuracy
    }

    /// Maximum predictor residual of one contact there \[`d`\].
    pub(crate) const fn worst_residual(&self) -> f64 {
        10.0 * self.accuracy
    }

    /// Maximum lateness of a transition that is found there \[`d`\].
    pub(crate) const fn lateness(&self) -> f64 {
        2.0 * self.accuracy
    }

    /// Maximum pending displacement of a contact \[`d`\].
    pub(crate) const fn pending(&self) -> f64 {
        self.accuracy
    }

    /// Residual of a global solve whose state is not written down \[`d`\].
    pub(crate) const fn sufficient(&self) -> f64 {
        self.accuracy / 500.0
    }
}

impl Events {
    /// The choices of the program.
    pub const DEFAULT: Self = Self {
        position_tolerance: 1e-6,
        local_contacts: 24,
        shell_ratio: 5,
        jump_in_distance: 3.0,
        negligible_pending: 0.1,
        avalanche_solves: 16,
        large_avalanche: 13,
        branch_end_distance: 2.2,
        common_fold_distance: 0.95,
        neighbour_growth: 1.2,
        penetration_rate: 3.0,
        changes_per_asperity: 3,
        trials_per_asperity: 100,
        trials_offset: 100,
        merging_overlap: 1e-6,
        merging_trials: 40,
        fold_step: 1e-3,
        retried_release: 0.97,
        radius_resolution: 1e-8,
    };
}

impl Solver {
    /// The choices of the program.
    pub const DEFAULT: Self = Self {
        converged_residual: 1e-8,
        local_residual: 1e-7,
        radius_change: 0.2,
        linear_residual_min: 1e-4,
        linear_residual: 3e-3,
        linear_residual_intermediate: 3e-2,
        products: 120,
        rates_residual: 1e-4,
        rates_residual_intermediate: 3e-4,
        free_interval: 0.2,
        curve_points: 50,
        groups: Groups {
            contacts: 24,
            solved_together: 44,
            solutions: 8,
            count_ratio: 1.3,
            point_load_distance: 2.0,
        },
        relaxation: Relaxation {
            steps: 1000,
            finish: 100.0,
            finish_growth: 1e3,
            longest_step: 1e9,
            step_growth: 3.0,
            attempts: 24,
        },
    };
}

impl Default for Steps {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Default for Events {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self::DEFAULT
    }
}
