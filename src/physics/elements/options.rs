//! Options of boundary elements, and the numerical choices behind them.

use crate::constants::Constant;
use crate::model::KeptContacts;

/// Attraction between the surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Attraction {
    /// The JKR limit, a range of attraction of 0.
    Bonded {
        /// Gap at which a point outside bonds \[m\]; 0: where the surfaces touch.
        nucleation_m: f64,
        /// Tension over E\* at which contact opens inside: infinite where it opens from its edges only, 0 where the law alone decides.
        strength: f64,
    },
    /// Morse's law of a range ρ.
    Range {
        /// Range ρ \[m\].
        range_m: f64,
    },
}

/// Options of a cycle by boundary elements, with those of the program as default.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Grid points along a side of the periodic square, mirror images included.
    ///
    /// 0: those of [`points_for`](super::points_for). Twice as many take 5 to 8 times as long; Θ changes by 9 to 25 % from 8 to 16 per shortest wavelength.
    pub points: usize,
    /// Attraction.
    pub attraction: Attraction,
    /// Step of mean penetration over the rms height.
    pub approach_step: f64,
    /// Number of times that a step with a jump of the load is halved.
    pub halvings: u32,
    /// Rms residual of an equilibrium, relative to the maximum tension.
    pub precision: f64,
    /// Steps of which the regions of contact are kept.
    pub contacts: KeptContacts,
    /// Numerical choices.
    pub numerics: Numerics,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            points: 0,
            attraction: Attraction::Bonded { nucleation_m: 0.0, strength: f64::INFINITY },
            approach_step: 0.03,
            halvings: 6,
            precision: 1e-4,
            contacts: KeptContacts::Turning,
            numerics: Numerics::default(),
        }
    }
}

/// Shorter steps and a smaller residual where adhesion is weak.
///
/// The dissipated energy is then a small part of the work of the load, and the sum of the events is as inexact as its integral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weak {
    /// Ratio `U_el/Δγ` of Persson and Tosatti from which on adhesion is that weak.
    pub ratio: f64,
    /// Number of steps in one of [`Options::approach_step`].
    pub steps: f64,
    /// Factor by which [`Options::precision`] is smaller.
    pub precision: f64,
}

/// Numerical choices that no key of a spec changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Numerics {
    /// Largest error that a jump of the load may cause in the integral over a step, relative to the energy dissipated so far.
    pub jump_tolerance: f64,
    /// Largest residual over the rms residual of an equilibrium.
    pub largest_residual: f64,
    /// Maximum number of iterations of one minimisation; then Newton's method takes over.
    pub iterations: usize,
    /// Points around a contact that are bonded.
    pub margin: usize,
    /// Step of loading without adhesion, in steps of the cycle.
    pub free_step: f64,
    /// Weak adhesion, the weakest first.
    pub weak: [Weak; 2],
}

/// The choices of the program.
const NUMERICS: Numerics = Numerics {
    jump_tolerance: 0.03,
    largest_residual: 100.0,
    iterations: 3000,
    margin: 2,
    free_step: 2.0,
    weak: [Weak { ratio: 150.0, steps: 30.0, precision: 10.0 }, Weak { ratio: 15.0, steps: 6.0, precision: 6.0 }],
};

impl Default for Numerics {
    fn default() -> Self {
        NUMERICS
    }
}

impl Numerics {
    /// Number of steps in one of [`Options::approach_step`], and the factor by which [`Options::precision`] is smaller, at a ratio `U_el/Δγ`.
    #[must_use]
    pub fn refinement(&self, ratio: f64) -> (f64, f64) {
        self.weak.iter().find(|weak| ratio > weak.ratio).map_or((1.0, 1.0), |weak| (weak.steps, weak.precision))
    }
}

/// Effect of weak adhesion.
const WEAKER: &str = "From this `U_el/Δγ` on, the step is divided by the second number, and the precision by the third.";

const fn weak(at: usize) -> [f64; 3] {
    let Weak { ratio, steps, precision } = NUMERICS.weak[at];
    [ratio, steps, precision]
}

/// Numerical choices of a cycle by boundary elements.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new("weak adhesion, boundary elements", &weak(1), "", WEAKER, "options"),
    Constant::new("very weak adhesion, boundary elements", &weak(0), "", WEAKER, "options"),
    Constant::new(
        "error of a jump, boundary elements",
        &[NUMERICS.jump_tolerance],
        "of `Θ` so far",
        "A step with a larger one is halved, up to `boundary_elements.halvings` times.",
        "options",
    ),
    Constant::new(
        "largest residual, boundary elements",
        &[NUMERICS.largest_residual],
        "of the rms residual",
        "Of an equilibrium.",
        "options",
    ),
    Constant::new(
        "iterations, boundary elements",
        &[NUMERICS.iterations as f64],
        "",
        "Maximum of one minimization. Then Newton's method takes over.",
        "options",
    ),
    Constant::new(
        "steps without adhesion",
        &[NUMERICS.free_step],
        "of the steps",
        "Steps of the table `adhesionless`, in those of the cycle.",
        "options",
    ),
    Constant::new("reach of bonds", &[NUMERICS.margin as f64], "`dx`", "Points this close to contact are bonded.", "options"),
];
