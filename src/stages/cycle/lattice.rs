//! Grid of boundary elements, and its memory.

use super::super::StageError;
use crate::model::Attraction;
use crate::physics::PhysicsError;
use crate::physics::elements::memory_bytes;
use crate::physics::memory;
use crate::spec::CaseParams;
use crate::store::hdf5::SurfaceHeader;

/// Grid of a case on one surface.
#[derive(Debug, Clone, Copy)]
pub(in crate::stages) struct Lattice {
    /// Grid points along a side.
    pub(in crate::stages) points: usize,
    /// Grid points per shortest wavelength.
    pub(in crate::stages) per_wavelength: f64,
    /// Range of the Morse law \[m\]; nothing for the JKR limit.
    pub(in crate::stages) range_m: Option<f64>,
    /// True if the square is a surface with its mirror images.
    pub(in crate::stages) is_mirrored: bool,
}

/// Square of a surface with its shortest wavelength.
#[derive(Debug, Clone, Copy)]
pub(in crate::stages) struct Square {
    /// Side \[m\].
    pub(in crate::stages) length_m: f64,
    /// Shortest wavelength; of a measured surface the cut-off \[m\].
    pub(in crate::stages) shortest_wavelength_m: f64,
    /// True if the surface continues periodically.
    pub(in crate::stages) is_periodic: bool,
}

impl Square {
    /// Square of a surface of a case with this header.
    pub(in crate::stages) fn of(params: &CaseParams, header: &SurfaceHeader) -> Self {
        let of_spectrum = || header.length_m / f64::from(params.surface.magnification);
        let shortest_wavelength_m = header.measured.as_ref().map_or_else(of_spectrum, |measured| measured.shortest_wavelength_m);
        Self { length_m: header.length_m, shortest_wavelength_m, is_periodic: header.periodic }
    }

    /// Side of the periodic square \[m\] and its number of shortest wavelengths. A surface that is not periodic is continued by mirror images.
    pub(super) fn extent(self) -> (f64, f64) {
        let length_m = if self.is_periodic { self.length_m } else { 2.0 * self.length_m };
        (length_m, length_m / self.shortest_wavelength_m)
    }
}

impl Lattice {
    /// The grid of a case on a square of a side \[m\] with a number of shortest wavelengths.
    fn of(params: &CaseParams, (length_m, wavelengths): (f64, f64)) -> Self {
        let elements = &params.boundary_elements;
        let points = elements.grid(wavelengths);
        let range = || elements.range(params.material.adhesion_length_m(), length_m / f64::from(points));
        Self {
            points: points as usize,
            per_wavelength: f64::from(points) / wavelengths,
            range_m: (elements.attraction == Attraction::Range).then(range),
            is_mirrored: params.surface.is_measured() && !params.surface.periodic,
        }
    }

    /// The grid of a case on its generated surface.
    pub(in crate::stages) fn of_generated(params: &CaseParams) -> Self {
        Self::of(params, (params.surface.length_m, f64::from(params.surface.magnification)))
    }

    /// The grid of a case on a measured surface.
    pub(in crate::stages) fn of_measured(params: &CaseParams, square: Square) -> Self {
        Self::of(params, square.extent())
    }
}

/// The grid of a case on a surface with this header and rms height \[m\], checked.
pub(in crate::stages) fn checked_lattice(params: &CaseParams, header: &SurfaceHeader, rms_height_m: f64) -> Result<Lattice, StageError> {
    let (length_m, wavelengths) = Square::of(params, header).extent();
    let (elements, loads) = (&params.boundary_elements, params.cycle.max_load.len());
    if let Some((problem, help)) = elements.refusal(length_m, wavelengths, params.material.adhesion_length_m()) {
        return Err(PhysicsError::Surface { problem, help }.into());
    }
    let lattice = Lattice::of(params, (length_m, wavelengths));
    enough_memory(lattice.points, loads)?;
    if let Some((problem, help)) = lattice.range_m.and_then(|range_m| elements.refusal_of_range(range_m, rms_height_m, loads)) {
        return Err(StageError::Range { problem, help });
    }
    if lattice.is_mirrored && lattice.points % 2 == 1 {
        let problem =
            format!("a scan that is not periodic is continued by mirror images: {} grid points are an odd number", lattice.points);
        return Err(PhysicsError::Surface { problem, help: "use an even number of boundary_elements.points" }.into());
    }
    Ok(lattice)
}

/// Refuses a grid for which there is not enough memory.
pub(in crate::stages) fn enough_memory(points: usize, loads: usize) -> Result<(), PhysicsError> {
    let bytes = memory_bytes(points, loads);
    memory::check(bytes).map_err(|_| PhysicsError::Surface {
        problem: format!("boundary elements on {points} x {points} points need {:.2} GB of memory, which are not free", bytes as f64 / 1e9),
        help: "use fewer boundary_elements.points, fewer loads, or fewer tasks at once (--jobs 1)",
    })
}
