//! Grid of boundary elements, and its memory.

use super::super::super::StageError;
use super::ElementsCase;
use crate::model::GeneratedSurface;
use crate::physics::PhysicsError;
use crate::physics::elements::memory_bytes;
use crate::physics::memory;
use crate::spec::{CaseParams, probe_refusal, shortest_lengths};
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
    /// True if the surface is continued by mirror images: it is not periodic, and not on a probe.
    pub(in crate::stages) is_mirrored: bool,
}

impl Square {
    /// Square of a surface of a case with this header.
    pub(in crate::stages) fn of(params: &CaseParams, header: &SurfaceHeader) -> Self {
        let of_generated = |surface: &GeneratedSurface| header.length_m / f64::from(surface.magnification);
        let of_measured =
            || header.measured.as_ref().map_or(header.length_m, |measured| measured.shortest_wavelength_m);
        let shortest_wavelength_m = params.surface.generated().map_or_else(of_measured, of_generated);
        let is_mirrored = !header.periodic && params.probe.is_none();
        Self { length_m: header.length_m, shortest_wavelength_m, is_mirrored }
    }

    /// Side of the periodic square \[m\] and its number of shortest wavelengths.
    pub(super) fn extent(self) -> (f64, f64) {
        let length_m = if self.is_mirrored { 2.0 * self.length_m } else { self.length_m };
        (length_m, length_m / self.shortest_wavelength_m)
    }
}

impl Lattice {
    /// The grid of a case on a square of a side \[m\] with a number of shortest wavelengths.
    fn of(of: ElementsCase<'_>, length_m: f64, wavelengths: f64) -> Self {
        let wavelengths = shortest_lengths(of.params, length_m, wavelengths);
        let points = of.options.grid(wavelengths);
        let spacing_m = length_m / f64::from(points);
        Self {
            points: points as usize,
            per_wavelength: f64::from(points) / wavelengths,
            range_m: of.options.range(of.params.material.adhesion_length_m(), spacing_m),
            is_mirrored: of.params.has_images(),
        }
    }

    /// The grid of a case on its generated surface.
    pub(super) fn of_generated(of: ElementsCase<'_>, surface: &GeneratedSurface) -> Self {
        Self::of(of, surface.length_m, f64::from(surface.magnification))
    }

    /// The grid of a case on a measured surface.
    pub(super) fn of_measured(of: ElementsCase<'_>, square: Square) -> Self {
        let (length_m, wavelengths) = square.extent();
        Self::of(of, length_m, wavelengths)
    }
}

impl ElementsCase<'_> {
    /// Why layer and machine of the case cannot be used on a square of a side \[m\] with `points` grid points
    /// along it, and what to do.
    pub(super) fn refusal_of_medium(self, length_m: f64, points: usize) -> Option<(String, String)> {
        let spacing_m = length_m / points as f64;
        if let Some(layer) = self.params.substrate
            && layer.thickness_m < THINNEST_LAYER * spacing_m
        {
            let problem = format!(
                "the layer of {} m is thinner than {THINNEST_LAYER} grid spacings of {spacing_m:.2e} m: the \
                 law of adhesion is that of an edge on a half-space",
                layer.thickness_m
            );
            return Some((problem, "use more boundary_elements.points, or a thicker layer".to_owned()));
        }
        let softest_m_n = SOFTEST_MACHINE / (self.params.material.contact_modulus_pa * length_m);
        let compliance_m_n = self.params.machine.compliance_m_n;
        (compliance_m_n > softest_m_n).then(|| {
            let problem = format!(
                "the compliance of the machine, {compliance_m_n:.2e} m/N, is above \
                 {SOFTEST_MACHINE}/(E* L) = {softest_m_n:.2e} m/N: its energy hides that of the contact"
            );
            (problem, "write machine.control = \"load\", or use a stiffer machine".to_owned())
        })
    }
}

/// Thickness of a layer in grid spacings, at least: at 4 the layer is a half-space for waves of 4 spacings,
/// on which the law acts, to 2 %.
const THINNEST_LAYER: f64 = 4.0;
/// Compliance of a machine in 1/(E* L), at most: its spring has 100 times the energy of the contact.
const SOFTEST_MACHINE: f64 = 2000.0;

/// The grid of a case on a surface with this header and rms height \[m\], checked.
pub(super) fn checked_lattice(
    of: ElementsCase<'_>,
    header: &SurfaceHeader,
    rms_height_m: f64,
) -> Result<Lattice, StageError> {
    let (length_m, wavelengths) = Square::of(of.params, header).extent();
    let (elements, loads) = (of.options, of.params.cycle.max_load.len());
    let CaseParams { probe, material, cycle, .. } = of.params;
    let load_n = cycle.largest_load() * material.contact_modulus_pa * length_m * length_m;
    if let Some((problem, help)) = probe.and_then(|probe| probe_refusal(&probe, material, length_m, load_n)) {
        return Err(StageError::Range { problem, help });
    }
    if let Some((problem, help)) =
        elements.refusal(length_m, wavelengths, of.params.material.adhesion_length_m())
    {
        return Err(PhysicsError::Surface { problem, help }.into());
    }
    let lattice = Lattice::of(of, length_m, wavelengths);
    enough_memory(lattice.points, loads)?;
    if let Some((problem, help)) = of.refusal_of_medium(length_m, lattice.points) {
        return Err(StageError::Range { problem, help });
    }
    let refused = lattice.range_m.and_then(|range_m| elements.refusal_of_range(range_m, rms_height_m, loads));
    if let Some((problem, help)) = refused {
        return Err(StageError::Range { problem, help });
    }
    if lattice.is_mirrored && lattice.points % 2 == 1 {
        let problem = format!(
            "a scan that is not periodic is continued by mirror images: {} grid points are an odd number",
            lattice.points
        );
        return Err(PhysicsError::Surface {
            problem,
            help: "use an even number of boundary_elements.points",
        }
        .into());
    }
    Ok(lattice)
}

/// Refuses a grid for which there is not enough memory.
pub(super) fn enough_memory(points: usize, loads: usize) -> Result<(), PhysicsError> {
    let bytes = memory_bytes(points, loads);
    memory::check(bytes).map_err(|_| PhysicsError::Surface {
        problem: format!(
            "boundary elements on {points} x {points} points need {:.2} GB of memory, which are not free",
            bytes as f64 / 1e9
        ),
        help: "use fewer boundary_elements.points, fewer loads, or fewer tasks at once (--jobs 1)",
    })
}
