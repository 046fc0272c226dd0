//! Boundary elements: parameters, the grid that follows from them, and what they refuse.

use super::fault::Faults;
use super::keys::find;
use super::number::short;
use super::origin::{Origin, written};
use super::values::Values;
use crate::model::{Attraction, Boundary, CaseParams, Choice, ElementOptions, GeneratedSurface};
use crate::physics::elements::{PER_WAVELENGTH, points_for};
use crate::text::counted;
use std::ops::Range;

/// Maximum number of grid points of boundary elements along a side.
pub const MAX_ELEMENTS: u32 = 4096;
/// Minimum number of grid points per shortest wavelength.
pub const FEWEST_PER_WAVELENGTH: f64 = 4.0;
/// Maximum of `points_per_wavelength`.
pub const MOST_PER_WAVELENGTH: u32 = 256;
/// Maximum mesh number `½ sqrt(Δγ dx/E*)/ρ` of a law with a range ρ: above, the grid traps the contact edges.
pub const MOST_MESH_NUMBER: f64 = 0.7;
/// Minimum `Δγ/(E* dx)`: below it, the tension is lost in the rounding of the pressure.
pub const LEAST_WORK: f64 = 1e-10;
/// Steps of a cycle over the gaps at which a law with a range acts: above, a case is refused.
pub const MOST_RANGE_STEPS: f64 = 20_000.0;
/// Steps above which `plan` announces their number.
pub const MANY_RANGE_STEPS: f64 = 2_000.0;
/// Gap at which Morse's law ends, in ranges.
pub(super) const END: f64 = 15.0;
/// Automatic range over `sqrt(Δγ dx/E*)`.
pub(super) const RANGE: f64 = 0.8;

/// Mesh number `½ sqrt(a dx)/ρ` of a law with the range ρ, with `a = Δγ/E*` and the grid spacing dx \[m\].
#[must_use]
pub fn mesh_number(work_length_m: f64, spacing_m: f64, range_m: f64) -> f64 {
    0.5 * (work_length_m * spacing_m).sqrt() / range_m
}

/// Range ρ that follows the grid \[m\], with `Δγ/E*` and the grid spacing \[m\].
#[must_use]
pub fn automatic_range(work_length_m: f64, spacing_m: f64) -> f64 {
    RANGE * (work_length_m * spacing_m).sqrt()
}

impl ElementOptions {
    /// Grid points along the side of a square, whose side is given in shortest wavelengths.
    #[must_use]
    pub fn grid(&self, wavelengths: f64) -> u32 {
        let number = self.per_wavelength.map_or(PER_WAVELENGTH, f64::from);
        let points = points_for(number / PER_WAVELENGTH * wavelengths);
        let automatic = || u32::try_from(points).map_or(MAX_ELEMENTS, |points| points.min(MAX_ELEMENTS));
        self.points.unwrap_or_else(automatic)
    }

    /// The grid as text.
    #[must_use]
    pub fn grid_in_words(&self) -> String {
        let number = || self.per_wavelength.map_or(PER_WAVELENGTH, f64::from);
        self.points.map_or_else(
            || format!("{} points per shortest wavelength", number()),
            |points| format!("{points} points a side"),
        )
    }

    /// Range ρ of the Morse law \[m\], with `Δγ/E*` and the grid spacing \[m\]; nothing for the JKR limit.
    #[must_use]
    pub fn range(&self, work_length_m: f64, spacing_m: f64) -> Option<f64> {
        match self.attraction {
            Attraction::Bonded { .. } => None,
            Attraction::Range { range_m } => {
                Some(range_m.unwrap_or_else(|| automatic_range(work_length_m, spacing_m)))
            }
        }
    }

    /// Number of steps over the gaps at which a law of the range ρ \[m\] acts, in a cycle with `loads` loads
    /// and without halvings.
    #[must_use]
    pub fn range_steps(&self, range_m: f64, rms_height_m: f64, loads: usize) -> f64 {
        (loads + 1) as f64 * 2.0 * END * range_m / (self.approach_step * rms_height_m)
    }

    /// Why a range cannot be used on a surface, and what to do: it acts over many times the rms height, which
    /// the steps are a part of.
    #[must_use]
    pub fn refusal_of_range(
        &self,
        range_m: f64,
        rms_height_m: f64,
        loads: usize,
    ) -> Option<(String, String)> {
        let steps = self.range_steps(range_m, rms_height_m, loads);
        if steps <= MOST_RANGE_STEPS {
            return None;
        }
        // Rounded to two digits, it is below the limit.
        let shorter = 0.95 * range_m * MOST_RANGE_STEPS / steps;
        let problem = format!(
            "the attraction acts over 15 ρ = {:.2e} m, {:.0} times h_rms: about {steps:.0} steps, more than \
             {MOST_RANGE_STEPS}",
            END * range_m,
            END * range_m / rms_height_m
        );
        Some((
            problem,
            format!(
                "set boundary_elements.range_m to {shorter:.1e} or less, or increase \
                 boundary_elements.approach_step"
            ),
        ))
    }

    /// Why a grid cannot be used, and what to do: too few points per shortest wavelength, negligible
    /// adhesion, or a range that traps contact edges on it.
    ///
    /// `length_m` is the side of the square, `wavelengths` its shortest wavelengths, and
    /// `work_length_m` is `Δγ/E*` \[m\].
    #[must_use]
    pub fn refusal(
        &self,
        length_m: f64,
        wavelengths: f64,
        work_length_m: f64,
    ) -> Option<(String, &'static str)> {
        let grid = self.grid(wavelengths);
        let per_wavelength = f64::from(grid) / wavelengths;
        if per_wavelength < FEWEST_PER_WAVELENGTH {
            return Some((
                format!(
                    "a grid of {grid} x {grid} points has {} per shortest wavelength: at least 4 are needed",
                    short_points(per_wavelength)
                ),
                if grid < MAX_ELEMENTS {
                    "increase boundary_elements.points (at most 4096), or use a smaller ζ or a larger cut-off"
                } else {
                    "use a smaller ζ or a larger cut-off"
                },
            ));
        }
        let spacing = length_m / f64::from(grid);
        let weakness = work_length_m / spacing;
        if weakness > 0.0 && weakness < LEAST_WORK {
            return Some((
                format!(
                    "Δγ/(E* dx) is {weakness:.1e} on this grid, below {}: adhesion is negligible",
                    short(LEAST_WORK)
                ),
                "increase material.work_of_adhesion_j_m2, or use 0 with model.method = \"asperities\"",
            ));
        }
        let range = self.range(work_length_m, spacing)?;
        let mesh = mesh_number(work_length_m, spacing, range);
        if mesh > MOST_MESH_NUMBER {
            return Some((
                format!(
                    "the mesh number sqrt(Δγ dx/E*)/(2ρ) is {mesh:.2}, above {MOST_MESH_NUMBER}: the grid \
                     traps contact edges (ρ = {} m, dx = {} m)",
                    short(range),
                    short(spacing)
                ),
                "increase boundary_elements.range_m or boundary_elements.points, or use attraction = \
                 \"bonded\"",
            ));
        }
        None
    }
}

/// Points per wavelength as a sentence has them.
fn short_points(points: f64) -> String {
    if points.fract() == 0.0 { counted(points as usize, "point") } else { format!("{points:.2} points") }
}

/// Checks the requirements of boundary elements on the other values of their case. The grid of a measured
/// surface is checked when its file has been read.
pub(super) fn check_elements(
    case: &CaseParams,
    elements: &ElementOptions,
    values: &Values,
    origins: &[Origin],
    faults: &mut Faults<'_>,
) {
    if case.material.work_of_adhesion_j_m2 == 0.0
        && let Some(span) = latest(&["material.work_of_adhesion_j_m2", "model.method"], origins)
    {
        let message = "boundary elements need adhesion: `material.work_of_adhesion_j_m2` is 0, and their law \
             of attraction then has no range";
        faults.add(
            &span,
            message.to_owned(),
            "use a positive work of adhesion, or method = \"asperities\"".to_owned(),
        );
        return;
    }
    let boundary = values.asperities.boundary;
    if boundary == Boundary::Isolated
        && case.surface.is_periodic()
        && let Some(span) = latest(&["model.boundary", "model.method"], origins)
    {
        let message =
            format!("`model.boundary` is \"{}\", and boundary elements are periodic", boundary.word());
        faults.add(&span, message, "write boundary = \"periodic\", or method = \"asperities\"".to_owned());
    }
    if let Some(surface) = case.surface.generated() {
        check_range(case, (elements, surface), origins, faults);
        check_grid(case, (elements, surface), origins, faults);
    }
}

/// Boundary elements on a generated surface.
type OnGenerated<'a> = (&'a ElementOptions, &'a GeneratedSurface);

/// Refuses a grid that cannot be used on a generated surface.
fn check_grid(
    case: &CaseParams,
    (elements, surface): OnGenerated<'_>,
    origins: &[Origin],
    faults: &mut Faults<'_>,
) {
    let wavelengths = f64::from(surface.magnification);
    let keys = [
        "boundary_elements.points",
        "boundary_elements.points_per_wavelength",
        "boundary_elements.error",
        "boundary_elements.range_m",
        "boundary_elements.attraction",
        "material.work_of_adhesion_j_m2",
        "surface.magnification",
        "model.method",
    ];
    if let Some((message, help)) =
        elements.refusal(surface.length_m, wavelengths, case.material.adhesion_length_m())
        && let Some(span) = latest(&keys, origins)
    {
        faults.add(&span, message, help.to_owned());
    }
}

/// Refuses a range that takes too many steps on a generated surface.
fn check_range(
    case: &CaseParams,
    (elements, surface): OnGenerated<'_>,
    origins: &[Origin],
    faults: &mut Faults<'_>,
) {
    let spacing = surface.length_m / f64::from(elements.grid(f64::from(surface.magnification)));
    let Some(range) = elements.range(case.material.adhesion_length_m(), spacing) else { return };
    let keys = [
        "boundary_elements.range_m",
        "boundary_elements.attraction",
        "boundary_elements.approach_step",
        "surface.rms_height_m",
    ];
    if let Some((message, help)) =
        elements.refusal_of_range(range, surface.rms_height_m, case.cycle.max_load.len())
        && let Some(span) = latest(&keys, origins)
    {
        faults.add(&span, message, help);
    }
}

/// The later written of some values; nothing if one of them is not known.
pub(super) fn latest(paths: &[&str], origins: &[Origin]) -> Option<Range<usize>> {
    let places: Vec<usize> = paths
        .iter()
        .filter_map(|path| path.split_once('.').and_then(|(table, name)| find(table, name)))
        .collect();
    if places.iter().any(|place| matches!(origins[*place], Origin::Faulty)) {
        return None;
    }
    places.into_iter().filter_map(|place| written(Some(place), origins)).max_by_key(|span| span.start)
}
