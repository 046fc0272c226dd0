//! Grids of boundary elements by their points per shortest wavelength.

use crate::model::{CaseParams, GeneratedSurface, MethodOptions, Probe};
use crate::physics::elements::PER_WAVELENGTH;
use std::f64::consts::PI;

/// Grid points per shortest wavelength of the automatic grid.
pub(super) const AUTOMATIC: u32 = PER_WAVELENGTH as u32;

/// Grid points of the automatic grid per JKR radius of a probe at zero penetration.
const POINTS_PER_RADIUS: f64 = 12.0;

/// Shortest lengths of a case along a side \[m\] with a number of shortest wavelengths: these, or those of
/// the probe, whose 12 points per JKR radius at zero penetration count as 16 per wavelength.
#[must_use]
pub fn shortest_lengths(params: &CaseParams, length_m: f64, wavelengths: f64) -> f64 {
    let radius_m = |probe: &Probe| (2.0 * PI).cbrt() * probe.jkr_radius_m(&params.material);
    let of_probe = params
        .probe
        .as_ref()
        .map_or(0.0, |probe| POINTS_PER_RADIUS / PER_WAVELENGTH * length_m / radius_m(probe));
    wavelengths.max(of_probe)
}

/// A case whose points per shortest wavelength are a number of points, so that both are one case: that of a
/// generated surface. A scan has a number per wavelength, unless it is the automatic one.
pub(super) fn with_points(mut params: CaseParams) -> CaseParams {
    let of = |surface: &GeneratedSurface| {
        shortest_lengths(&params, surface.length_m, f64::from(surface.magnification))
    };
    let wavelengths = params.surface.generated().map(of);
    if let MethodOptions::Elements(options) = &mut params.method
        && let Some(number) = options.per_wavelength
    {
        options.points = wavelengths.map(|wavelengths| options.grid(wavelengths));
        if options.points.is_some() || number == AUTOMATIC {
            options.per_wavelength = None;
        }
    }
    params
}
