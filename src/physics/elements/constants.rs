//! Tolerances and limits of boundary elements.

use super::equilibrium::minimise::{BOND_UPDATE_RESIDUAL, EVERYWHERE};
use super::equilibrium::newton::RATE;
use super::equilibrium::patch::{PARTS, PLACES};
use super::equilibrium::places::SMALLEST;
use super::events::work::JUMP;
use super::law::{DEEPEST, NEGLIGIBLE, SPRING, WIDTH};
use super::path::cycle::FARTHEST;
use super::path::reversal::{JUMP_ACCURACY, LOAD_ACCURACY, SEARCHED, SHARPER};
use super::path::stations::{MOST_ALONG, STATIONS};
use super::path::step::{BEND, EVENT, EXCESS, HALVED, HIDDEN, JUMP_PART, MAX_RATE, OVERLAP, WELL_BELOW};
use crate::constants::Constant;

/// Constants of the solver on a grid.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new("width of the kernel of the law", &[WIDTH], "`dx`", "Gaussian `W` of the bonded attraction.", "law"),
    Constant::new("stiffness of the wall", &[SPRING], "`E*/dx`", "Spring at small gaps and in compression, bonded attraction.", "law"),
    Constant::new("overlap with linear repulsion", &[DEEPEST], "`ρ`", "Beyond it Morse's law goes on linearly.", "law"),
    Constant::new("gap without attraction", &[NEGLIGIBLE], "`ρ`", "Beyond it Morse's law is not evaluated.", "law"),
    Constant::new(
        "residual at which bonds change",
        &[BOND_UPDATE_RESIDUAL],
        "maximum tension",
        "Largest residual of a state in which contact may form or open.",
        "minimise",
    ),
    Constant::new(
        "iterations before the first patch",
        &[EVERYWHERE as f64],
        "",
        "On the whole grid, at the beginning of a step.",
        "minimise",
    ),
    Constant::new(
        "maps between the ends of a branch",
        &[STATIONS[0] as f64, (STATIONS[1] + STATIONS[2]) as f64],
        "",
        "Maximum, on loading and on each unloading.",
        "stations",
    ),
    Constant::new("side of such maps", &[MOST_ALONG as f64], "points", "Maximum. Of larger grids they have every n-th point.", "stations"),
    Constant::new("places on patches", &[PLACES as f64], "", "Maximum number of places of an event that are relaxed apart.", "patch"),
    Constant::new("side of a patch", &[SMALLEST as f64, 1.0 / PARTS as f64], "points; of the grid", "Minimum, and maximum.", "patch"),
    Constant::new(
        "force at load reversal",
        &[LOAD_ACCURACY, JUMP_ACCURACY],
        "relative",
        "Where the load is reached, and where it jumps across the reversal.",
        "reversal",
    ),
    Constant::new(
        "equilibria near the load reversal",
        &[SHARPER, SEARCHED as f64],
        "",
        "Their tolerance relative to `boundary_elements.precision`, and the maximum number of equilibria of a search.",
        "reversal",
    ),
    Constant::new("smallest event", &[EVENT], "dissipated energy", "Relative to the energy dissipated so far.", "step"),
    Constant::new(
        "uncertainty of a step",
        &[BEND, JUMP_PART],
        "",
        "Fractions of the last term of the integral and of the error of a jump. An event exceeds them.",
        "step",
    ),
    Constant::new(
        "discontinuous force",
        &[JUMP],
        "of the change of slope",
        "Where the force differs from the mean of both tangents by more, the last term is omitted.",
        "work",
    ),
    Constant::new("error that lengthens a step", &[WELL_BELOW], "of the limit", "Below it the next step may be twice as long.", "step"),
    Constant::new("error that ends a step early", &[EXCESS], "of the limit", "A step is halved before it is in equilibrium.", "step"),
    Constant::new(
        "hidden maximum tension",
        &[HIDDEN],
        "relative",
        "A step of unloading that may have passed a larger tension is halved.",
        "step",
    ),
    Constant::new("rate of extrapolation `du/dΔ`", &[MAX_RATE], "", "Larger rates are scaled to it.", "step"),
    Constant::new(
        "extrapolated overlap",
        &[OVERLAP],
        "`ρ`",
        "Points that extrapolation moves deeper into the wall are raised, with a range of attraction.",
        "step",
    ),
    Constant::new("rate and stiffness of an equilibrium", &[RATE], "relative residual", "Tolerance of conjugate gradients.", "newton"),
    Constant::new(
        "farthest mean penetration",
        &[FARTHEST],
        "range of the heights",
        "Beyond it a load is not reached, or the surfaces do not separate.",
        "cycle",
    ),
    Constant::new(
        "steps that may be halved",
        &[HALVED as f64],
        "",
        "With a range of attraction: after this number of steps of a cycle none is halved.",
        "step",
    ),
];
