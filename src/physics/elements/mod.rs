//! Boundary elements of a height map, in SI units: grid, law and settings from a surface, a material and
//! options.
//!
//! [`Elements::new`] sets grid, law and accuracy; [`Elements::run`] loads and unloads. The solver is in the
//! modules of this folder. Its unit of length is the grid spacing `dx`, of stress E\*, of energy `E* dx³`;
//! [`Units`] converts them to SI units.

mod constants;
pub mod equilibrium;
pub mod events;
mod free;
pub mod grid;
pub mod law;
pub(crate) mod line;
pub mod numerics;
mod options;
pub mod path;
pub mod probe;
pub mod problem;
mod record;
mod setup;
mod units;

pub use free::FreeStep;
pub use numerics::Numerics;
pub use options::{Attraction, Options};
pub use units::Units;

pub(crate) use constants::CONSTANTS;

use crate::cycle::{Cycle, Method};
use crate::model::{KeptContacts, Material};
use crate::surface::HeightMap;
use crate::theory::flattening::measured_flattening;
use crate::{LoopPosition, PhysicsError};
use path::cycle::{self as solver, Checkpoint, Settings, Turning};
use problem::Problem;

/// Grid points per shortest wavelength, at least, if [`Options::points`] is 0.
pub const PER_WAVELENGTH: f64 = 16.0;
/// Maximum number of points along a side of such a grid.
const MAX_POINTS: f64 = 65_536.0;
/// Fields of numbers that the solver needs, its patches included, and those of a load reversal with its maps
/// and checkpoint.
const FIELDS: usize = 21;
const FIELDS_OF_REVERSAL: usize = 8;

/// Memory of a cycle \[bytes\] on a grid of `points` points along a side, with `loads` loads.
#[must_use]
pub fn memory_bytes(points: usize, loads: usize) -> usize {
    points * points * size_of::<f64>() * (FIELDS + FIELDS_OF_REVERSAL * loads)
}

/// Points along a side of `wavelengths` shortest wavelengths: a power of two with at least 16 per wavelength.
#[must_use]
pub fn points_for(wavelengths: f64) -> usize {
    ((PER_WAVELENGTH * wavelengths).ceil().clamp(1.0, MAX_POINTS) as usize).next_power_of_two()
}

/// Versions of cycles by boundary elements.
const VERSIONS: &[(u32, &str)] = &[
    (10, "steps are halved for jumps and for the maximum tension alone"),
    (
        11,
        "loads are searched off the path and do not change one another; area of the scan without its mirror \
         images. One load on a periodic surface: as 10",
    ),
    (12, "step of the line tension ahead of the front. Plain law: as 11"),
    (
        13,
        "mirror images of a scan move alike on a soft machine and under load control. All else: as 10 to 12",
    ),
];

/// A surface that boundary elements load and unload.
pub struct Elements {
    /// Problem, in the units of the solver.
    pub problem: Problem,
    /// Settings, in these units.
    pub settings: Settings,
    /// The units.
    pub units: Units,
    /// Loads `F/(E* A0)` at the load reversals.
    max_loads: Vec<f64>,
    contacts: KeptContacts,
}

impl Elements {
    /// Grid, law and settings of a surface, with loads `F/(E* A0)` at the load reversals, ascending.
    ///
    /// # Errors
    /// [`PhysicsError::Surface`] for heights or a grid that cannot be used.
    pub fn new(
        map: &HeightMap<'_>,
        material: &Material,
        max_loads: &[f64],
        options: &Options,
    ) -> Result<Self, PhysicsError> {
        let units = setup::units(map, material, options);
        let flattening =
            measured_flattening(map.square(), map.shortest_wavelength_m, material.contact_modulus_pa)?;
        let ratio = flattening.persson_tosatti(material.work_of_adhesion_j_m2);
        let problem = setup::problem(&units, material, setup::heights(map, &units, options)?, options)?;
        Ok(Self {
            problem,
            settings: setup::settings(&units, max_loads, options, ratio),
            units,
            max_loads: max_loads.to_vec(),
            contacts: options.contacts,
        })
    }

    /// Counts asperities at these places along x and y \[m\] in the regions of contact.
    #[must_use]
    pub fn with_summits(mut self, places_m: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let Units { points, is_mirrored, .. } = self.units;
        let own = self.units.own_points();
        let at = |place: f64| {
            let nearest = ((place - self.units.first_m) / self.units.spacing_m()).round();
            // Before the first point of a shifted grid is the last one.
            let periodic = || nearest.rem_euclid(points as f64) as usize;
            if is_mirrored { (nearest as usize).min(own - 1) } else { periodic() }
        };
        self.settings.summits = places_m.into_iter().map(|[x, y]| at(x) * points + at(y)).collect();
        self
    }

    fn record(&self, cycle: solver::Cycle) -> Cycle<Turning> {
        let mut record = record::in_si(cycle, &self.max_loads, &self.units);
        if self.contacts == KeptContacts::None {
            record.contacts.clear();
        }
        record
    }
}

impl Method for Elements {
    type Checkpoint = Checkpoint;
    type State = Turning;

    const NAME: &'static str = "boundary_elements";
    const VERSIONS: &'static [(u32, &'static str)] = VERSIONS;

    fn run_from(
        &self,
        checkpoint: Option<Checkpoint>,
        keep: &mut (dyn FnMut(&Checkpoint) + Send),
        progress: &(dyn Fn(LoopPosition) + Sync),
    ) -> Result<Cycle<Turning>, PhysicsError> {
        let outcome = solver::run(&self.problem, &self.settings, checkpoint, keep, progress);
        Ok(self.record(outcome.map_err(|error| self.units.end(error))?))
    }

    fn unload_from(&self, reversal: usize, state: Turning) -> Result<Cycle<Turning>, PhysicsError> {
        let cycle = solver::unload_from(&self.problem, &self.settings, reversal, &state)
            .map_err(|error| self.units.end(error))?;
        Ok(Cycle { turning: Vec::new(), ..self.record(cycle) })
    }

    fn size(&self) -> (&'static str, u64) {
        ("point_count", self.problem.half_space.points() as u64)
    }
}
