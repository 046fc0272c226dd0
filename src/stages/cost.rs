//! Memory and time of a cycle, estimated before it begins.

use crate::constants::Constant;
use crate::model::{Attraction, Coalescence};
use crate::physics::elements::{Numerics, memory_bytes};
use crate::spec::CaseParams;

/// Memory and time of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Grid points along a side: of the surface for the asperity model, of the periodic square for boundary elements.
    pub points: u64,
    /// Grid points per shortest wavelength.
    pub per_wavelength: f64,
    /// True if the square is a surface with its mirror images.
    pub is_mirrored: bool,
    /// Memory \[bytes\].
    pub memory_bytes: f64,
    /// Time of one cycle \[s\].
    pub seconds: f64,
}

/// Time of one loop by boundary elements, `a N² + b N³` for a grid of N x N points \[s\].
const OF_POINTS: [f64; 2] = [6e-5, 3e-7];
/// Time of one cycle of the asperity model with merging at ζ = 64 and `F_max/(E* A0)` = 0.0071 \[s\], and its exponent in ζ.
const OF_ASPERITIES: [f64; 2] = [1.4, 2.7];
/// Number of contact spots of such a cycle, and its exponent in ζ.
const CONTACTS: [f64; 2] = [335.0, 1.63];
/// Memory of a contact spot, of a grid point of a surface, and of the program \[bytes\].
const BYTES: [f64; 3] = [75e3, 11.2, 8e7];
/// Exponent of the number of steps: quiet steps are cheaper than those with events. Measured: 3.0 and 12 times the transforms with 6 and 30 times the steps.
const OF_STEPS: f64 = 0.7;
/// Steps of a loop by boundary elements without weak adhesion, in the mean.
const STEPS: f64 = 170.0;
/// Time of a loop that is announced before it starts \[s\].
pub(super) const LONG: f64 = 600.0;

/// Constants of the estimates.
pub(super) const CONSTANTS: &[Constant] = &[
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
    Constant::new("long loop", &[LONG], "s", "A longer loop by boundary elements is announced before it starts.", ""),
];

/// Memory and time of a loop by boundary elements at a ratio `U_el/Δγ`, with the range of attraction and the rms height \[m\] if they are known.
pub(super) fn of_elements(params: &CaseParams, points: usize, ratio: Option<f64>, (range_m, rms_height_m): (Option<f64>, f64)) -> Cost {
    let (elements, loads) = (&params.boundary_elements, params.cycle.max_load.len());
    let n = points as f64;
    let [square, cube] = OF_POINTS;
    let plain = square * n.powi(2) + cube * n.powi(3);
    let of_range = match elements.attraction {
        Attraction::Bonded => 0.0,
        Attraction::Range => range_m.map_or(0.0, |range_m| elements.range_steps(range_m, rms_height_m, loads)),
    };
    let steps = Numerics::default().refinement(ratio.unwrap_or_default()).0.powf(OF_STEPS) + of_range / STEPS;
    Cost {
        points: points as u64,
        per_wavelength: 0.0,
        is_mirrored: false,
        memory_bytes: memory_bytes(points, loads) as f64,
        seconds: 0.5 * (1 + loads) as f64 * steps * plain,
    }
}

/// Memory and time of a cycle of the asperity model; `points` and `wavelengths` are the grid points and the
/// shortest wavelengths along a side.
pub(super) fn of_asperities(params: &CaseParams, points: f64, wavelengths: f64) -> Cost {
    let load = params.cycle.largest_load() / 0.0071;
    let of_zeta = |[factor, exponent]: [f64; 2]| factor * (wavelengths / 64.0).powf(exponent) * load;
    let faster = if params.model.coalescence == Coalescence::Merge { 1.0 } else { 2.0 };
    let [spot, point, program] = BYTES;
    Cost {
        points: points as u64,
        per_wavelength: points / wavelengths,
        is_mirrored: false,
        memory_bytes: program + point * points * points + spot * of_zeta(CONTACTS),
        seconds: of_zeta(OF_ASPERITIES) / faster,
    }
}
