//! Numerical choices of boundary elements: tolerances, limits of effort and rules of the search.
//!
//! They are not part of the physical model; some change Θ by up to a few per cent, as stated.
//!
//! Each field states its effect as far as it was measured, at `Δγ = 0.07 J/m²` (see
//! `tests/benches/notes.md`).

/// Numerical choices of a cycle by boundary elements.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Numerics {
    /// Steps and events of the path.
    pub steps: Steps,
    /// Search for a load reversal.
    pub reversal: Reversal,
    /// Minimization of the energy.
    pub equilibrium: Minimization,
    /// Patches of the grid on which events are relaxed.
    pub patches: PatchLimits,
}

/// Shorter steps and a smaller residual where adhesion is weak.
///
/// The dissipated energy is then a small part of the work of the load, and the sum of the events is as
/// inexact as its integral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weak {
    /// Ratio `U_el/Δγ` of Persson and Tosatti from which on adhesion is that weak.
    pub ratio: f64,
    /// Number of steps in one of the options.
    pub steps: f64,
    /// Factor by which the precision of the options is smaller.
    pub precision: f64,
}

/// Steps and events of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Largest error that a jump of the load may cause in the integral over a step, relative to the energy
    /// dissipated so far.
    ///
    /// With 0.06 instead of 0.02 transforms decrease by 19 %, and Θ rises by 3 % (steps of 0.1 `h_rms`, ζ =
    /// 32).
    pub jump_tolerance: f64,
    /// Weak adhesion, the weakest first.
    pub weak: [Weak; 2],
    /// Step of loading without adhesion, in steps of the cycle. A larger one takes fewer equilibria, of which
    /// the analytical estimates are interpolated.
    pub free_step: f64,
    /// Smallest event, relative to the energy dissipated so far. Smaller ones are added to the next event.
    pub event_fraction: f64,
    /// Fraction of the part of the integral that comes from the slopes of the load that counts as its
    /// uncertainty. An event exceeds it: with a larger one small events are added to later ones.
    pub bend_uncertainty: f64,
    /// Fraction of the error that a jump of the load may cause in the integral that counts as its
    /// uncertainty. An event exceeds it as well.
    pub jump_uncertainty: f64,
    /// Error of a jump, relative to the limit, below which the next step may be twice as long. With a larger
    /// one more steps are halved again.
    pub lengthening_error: f64,
    /// Relative increase of the maximum tension that a step may pass unresolved: the error of F_po.
    pub hidden_tension: f64,
    /// Error of a jump, relative to the limit, from which on a step is halved before it is in equilibrium.
    ///
    /// With 4 instead of 2 transforms increase by 1 %. With 1 they decrease by 7 %, and the error of F_po
    /// rises from 1.6 to 9.3 % (ζ = 8).
    pub early_end_error: f64,
    /// Largest `|du/dΔ|` by which displacements are extrapolated. Near a limit point, where it diverges, the
    /// extrapolated state would be far from equilibrium.
    pub max_rate: f64,
    /// Largest extrapolated overlap beyond that of the last state with attraction of a range, in ranges: the
    /// repulsion rises exponentially.
    ///
    /// Without a limit a loop takes 1.6 times as long (256² points).
    pub extrapolated_overlap: f64,
    /// Number of steps of a cycle after which none is halved with attraction of a range. With very weak
    /// adhesion no event gives a measure of what a jump of the load may cost, and every step would be halved
    /// as often as allowed.
    pub halved_steps: usize,
    /// Magnitude of the mean penetration beyond which a load counts as not reached and, while unloading, the
    /// surfaces as inseparable, in ranges of the heights.
    ///
    /// A larger one takes longer to fail.
    pub farthest: f64,
}

/// Search for the mean penetration of a load at which the path reverses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reversal {
    /// Relative accuracy of the load. A larger one takes fewer equilibria.
    pub load_tolerance: f64,
    /// Relative accuracy of the load where it jumps across that of the reversal. Beyond it the step counts as
    /// not converged.
    pub jump_tolerance: f64,
    /// Tolerance of the equilibria near the load, relative to that elsewhere. A larger one does not resolve
    /// the load.
    pub precision: f64,
    /// Relative difference of the load below which that tolerance holds. With a larger one more equilibria
    /// are that exact.
    pub precise_within: f64,
    /// Bracket of the mean penetration at which the load jumps, in steps. A larger one takes fewer equilibria
    /// of such a search.
    pub bracket: f64,
    /// Maximum number of equilibria of a search. Beyond it the step counts as not converged.
    pub equilibria: u32,
}

/// Minimization of the energy at a fixed mean penetration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimization {
    /// Largest residual over the rms residual of an equilibrium. With a smaller one single points decide on
    /// the number of iterations.
    pub largest_residual: f64,
    /// Maximum number of iterations of one minimization; then Newton's method takes over.
    pub iterations: usize,
    /// Points around a contact that are bonded \[`dx`\]. With a larger one attraction reaches farther than
    /// the front of a crack does.
    pub bond_margin: usize,
    /// Change of the displacement between two updates of the bonds, relative to the reach of the law. A
    /// larger one takes fewer updates, which come later.
    pub bond_update_change: f64,
    /// Largest residual at which bonds are updated, relative to the maximum tension. Far from equilibrium,
    /// edges of contact are where no equilibrium has them.
    ///
    /// With 0.8 instead of 0.4 transforms increase by 13 % (ζ = 32), with 0.2 by 19 % (ζ = 16). Θ changes by
    /// −3 and 0 %.
    pub bond_update_residual: f64,
    /// Iterations on the whole grid before the first patch: they follow the mean penetration everywhere. With
    /// 4 instead of 8 transforms increase by 23 %.
    pub whole_iterations: usize,
    /// Residual, relative to that at the last rebase, at which the pressure is computed from the
    /// displacement: single precision has seven digits.
    ///
    /// A larger one takes more transforms in double precision.
    pub renewed_residual: f64,
    /// Maximum number of shortenings of a step that would raise the energy. After it the energy falls by less
    /// than its rounding.
    pub shortenings: u32,
    /// Maximum number of iterations of conjugate gradients in a step of Newton's method, and for a rate. A
    /// smaller one gives a less exact step.
    pub inner_iterations: usize,
    /// Relative residual at which conjugate gradients end. A larger one takes more steps of Newton's method.
    pub inner_residual: f64,
    /// Relative residual of the rate and of the stiffness of an equilibrium. Its iterations are 5 % of all;
    /// the stiffness has the square of the error.
    pub rate_residual: f64,
}

/// Patches of the grid on which events are relaxed. They decide on the cost, since the whole grid is relaxed
/// after them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchLimits {
    /// Minimum side of the grid, in sides of a patch. With 2 instead of 4 a loop takes 12 times as long.
    pub sides_of_grid: usize,
    /// Maximum number of places of an event. With 32 instead of 8 transforms decrease by 2 to 5 %. With 1
    /// they increase by 26 % (ζ = 32), or not (ζ = 16).
    pub places: usize,
    /// Side of a patch over the width of its border. Where bonds change in the border, a larger patch
    /// replaces it.
    pub borders_of_side: usize,
    /// Largest residual of a relaxed patch, relative to that of an equilibrium. With a larger one the whole
    /// grid has more of the way.
    pub residual: f64,
    /// Maximum number of iterations on a patch. The whole grid has the rest.
    pub iterations: usize,
    /// Points of the grid over those of the patches of one side: a smaller number takes more memory.
    pub points_of_grid: usize,
    /// Side up to which there is a patch for each place on every grid \[points\]. A larger one takes more
    /// memory on small grids.
    pub always_side: usize,
    /// Distance from its first point up to which points belong to a place \[points\]. A larger one has fewer
    /// and larger patches.
    pub place_radius: usize,
    /// Side of a patch at first, over the extent of the changed bonds. A larger one costs more for each
    /// iteration, a smaller one is replaced more often.
    pub side_ratio: usize,
    /// Points that are added to that side.
    pub side_offset: usize,
}

impl Numerics {
    /// The choices of the program.
    pub const DEFAULT: Self = Self {
        steps: Steps::DEFAULT,
        reversal: Reversal::DEFAULT,
        equilibrium: Minimization::DEFAULT,
        patches: PatchLimits::DEFAULT,
    };

    /// Number of steps in one of the options, and the factor by which their precision is smaller, at a ratio
    /// `U_el/Δγ`.
    #[must_use]
    pub fn refinement(&self, ratio: f64) -> (f64, f64) {
        self.steps
            .weak
            .iter()
            .find(|weak| ratio > weak.ratio)
            .map_or((1.0, 1.0), |weak| (weak.steps, weak.precision))
    }
}

impl Steps {
    /// The choices of the program.
    pub const DEFAULT: Self = Self {
        jump_tolerance: 0.03,
        weak: [
            Weak { ratio: 150.0, steps: 30.0, precision: 10.0 },
            Weak { ratio: 15.0, steps: 6.0, precision: 6.0 },
        ],
        free_step: 2.0,
        event_fraction: 1e-5,
        bend_uncertainty: 0.05,
        jump_uncertainty: 0.3,
        lengthening_error: 1.0 / 6.0,
        hidden_tension: 0.02,
        early_end_error: 2.0,
        max_rate: 10.0,
        extrapolated_overlap: 0.5,
        halved_steps: 20_000,
        farthest: 20.0,
    };
}

impl Reversal {
    /// The choices of the program.
    pub const DEFAULT: Self = Self {
        load_tolerance: 1e-5,
        jump_tolerance: 1e-3,
        precision: 0.02,
        precise_within: 0.02,
        bracket: 1e-5,
        equilibria: 40,
    };
}

impl Minimization {
    /// The choices of the program.
    pub const DEFAULT: Self = Self {
        largest_residual: 100.0,
        iterations: 3000,
        bond_margin: 2,
        bond_update_change: 0.02,
        bond_update_residual: 0.4,
        whole_iterations: 8,
        renewed_residual: 1e-3,
        shortenings: 30,
        inner_iterations: 80,
        inner_residual: 0.05,
        rate_residual: 0.01,
    };
}

impl PatchLimits {
    /// The choices of the program.
    pub const DEFAULT: Self = Self {
        sides_of_grid: 4,
        places: 8,
        borders_of_side: 8,
        residual: 3.0,
        iterations: 600,
        points_of_grid: 16,
        always_side: 128,
        place_radius: 12,
        side_ratio: 2,
        side_offset: 8,
    };
}

impl Default for Steps {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Default for Reversal {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Default for Minimization {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Default for PatchLimits {
    fn default() -> Self {
        Self::DEFAULT
    }
}
