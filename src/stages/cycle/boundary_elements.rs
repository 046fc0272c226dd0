//! A cycle by boundary elements: grid, law and settings from the parameters of a case; steps, regions, events and maps in SI units.

use super::super::done::Outcome;
use super::super::identity::Identity;
use super::super::surface::{read_summits, scale};
use super::super::{StageError, Watch};
use super::elements_tables::{contacts, events, steps};
use super::{Checkpoints, Progress};
use crate::campaign::{Campaign, CycleUnit};
use crate::model::{Attraction, KeptContacts, Material, Nucleation};
use crate::physics::PhysicsError;
use crate::physics::boundary_elements::contact::{Attraction as Rule, Problem};
use crate::physics::boundary_elements::cycle::{self, Cycle, Halfway, Settings, Turning};
use crate::physics::boundary_elements::grid::HalfSpace;
use crate::physics::boundary_elements::law::Law;
use crate::physics::boundary_elements::minimise::Accuracy;
use crate::physics::boundary_elements::regions::{Labels, label};
use crate::physics::boundary_elements::resample::resample;
use crate::physics::jkr::Asperity;
use crate::physics::measured::mirrored;
use crate::physics::memory;
use crate::physics::summits::Summit;
use crate::spec::CaseParams;
use crate::store::hdf5::read_surface;
use crate::store::{ContactMap, Frame, MapsHeader, parquet, read_halfway, write_maps, write_state};
use ndarray::Array2;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

/// Halvings of a step with a large event.
const HALVINGS: u32 = 3;
/// Largest residual over the rms residual of an equilibrium.
const PEAK: f64 = 100.0;
/// Maximum number of iterations of one minimisation.
const MOST_ITERATIONS: usize = 3000;
/// Points around a contact that are bonded.
const MARGIN: usize = 2;
/// Fields of numbers that the solver needs, and those of a load reversal with its maps and checkpoint.
const FIELDS: usize = 26;
const FIELDS_OF_REVERSAL: usize = 9;

/// Units of the solver in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Side of the periodic square \[m\]; twice that of a surface that is continued by mirror images.
    pub length_m: f64,
    /// Grid points along a side.
    pub points: usize,
    /// Reduced modulus \[Pa\].
    pub modulus_pa: f64,
    /// Rms height \[m\].
    pub rms_height_m: f64,
}

impl Units {
    /// Grid spacing, the unit of length \[m\].
    #[must_use]
    pub fn spacing_m(&self) -> f64 {
        self.length_m / self.points as f64
    }

    /// Unit of load \[N\].
    #[must_use]
    pub fn load_n(&self) -> f64 {
        self.modulus_pa * self.spacing_m().powi(2)
    }

    /// Unit of energy \[J\].
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        self.modulus_pa * self.spacing_m().powi(3)
    }

    /// Number of grid points: A0, and `E* A0` in the units of the solver.
    #[must_use]
    pub fn all(&self) -> f64 {
        (self.points * self.points) as f64
    }
}

/// A contact problem with its settings, units and the grid points of the asperities.
struct Setup {
    problem: Problem,
    settings: Settings,
    units: Units,
    summits: Vec<usize>,
}

pub(super) fn run(campaign: &Campaign, unit: &CycleUnit, watch: &dyn Watch) -> Result<Outcome, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let Setup { problem, settings, units, summits } = setup(campaign, unit)?;
    let dir = campaign.cycle_dir(unit);
    let progress = Progress::of(watch);
    let mut checkpoints = Checkpoints::of(campaign, unit, watch);
    let kept: Option<(Halfway, Counts)> = checkpoints.read();
    let (halfway, mut counts) = kept.map_or((None, Counts::new()), |(halfway, counts)| (Some(halfway), counts));
    let mut keep = |halfway: &Halfway| {
        counts.push((halfway.steps().len() - 1, summit_counts(&label(&problem, halfway.state()), &summits)));
        checkpoints.keep(&(halfway, &counts));
    };
    let outcome = cycle::run(&problem, &settings, halfway, &mut keep, &|done| progress.reached(done));
    progress.end();
    let cycle = outcome.map_err(|error| in_si(error, &units))?;
    let loads = &params.cycle.max_load;
    let of = Identity::of(campaign, unit);
    let keys = [("key", unit.key.clone())];
    let kept = if params.cycle.contacts == KeptContacts::None { &[][..] } else { &cycle.regions[..] };
    let tables =
        [contacts(of, (&cycle, kept), loads, &units, &counts)?, events(of, &cycle, loads, &units)?, steps(of, &cycle, loads, &units)?];
    let write = |frame: &Frame| Ok(parquet::write_table(&dir.join(format!("{}.parquet", frame.table().name)), frame, &keys)?);
    let mut files = tables.iter().map(write).collect::<Result<Vec<_>, StageError>>()?;
    let header = MapsHeader { key: &unit.key, cycle_id: &unit.id, length_m: units.length_m, points: units.points };
    files.push(write_maps(&dir.join("maps.h5"), &header, &maps(&cycle, loads, &units))?);
    files.push(write_state(&turning_path(&dir), &unit.key, &turning_bytes(&cycle)?)?);
    Ok(Outcome { files, effort: effort(&cycle, &problem) })
}

/// Numbers of asperities in the regions of the steps.
pub(super) type Counts = Vec<(usize, Vec<u32>)>;

/// The problem of a cycle on the grid of its case.
fn setup(campaign: &Campaign, unit: &CycleUnit) -> Result<Setup, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let surface = &campaign.surfaces[unit.surface];
    let (header, heights) = read_surface(&campaign.surface_path(surface))?;
    let list = read_summits(&campaign.asperities_path(surface))?;
    let shortest = match &header.measured {
        // Without a cut-off the shortest wavelength is two pixels.
        Some(measured) => measured.shortest_wavelength_m.max(2.0 * header.length_m / heights.nrows() as f64),
        None => header.length_m / f64::from(params.surface.magnification),
    };
    let images = if header.periodic { 1 } else { 2 };
    let length_m = f64::from(images) * header.length_m;
    let (material, elements) = (&params.material, &params.boundary_elements);
    if let Some((problem, help)) =
        elements.refusal(length_m, length_m / shortest, material.work_of_adhesion_j_m2 / material.contact_modulus_pa)
    {
        return Err(PhysicsError::Surface { problem, help }.into());
    }
    let points = elements.grid(length_m / shortest) as usize;
    enough_memory(points, params.cycle.max_load.len())?;
    let rms_height_m = scale(campaign, surface)?.rms_height_m;
    let units = Units { length_m, points, modulus_pa: material.contact_modulus_pa, rms_height_m };
    let side = heights.nrows();
    let whole = if images == 2 { mirrored(heights.view())? } else { heights };
    let problem = problem(params, &units, resample(whole.view(), points)?, &list)?;
    let summits = summit_points(&list, (header.length_m, side), images == 2, &units);
    Ok(Setup { settings: settings(params, &units), problem, units, summits })
}

/// The contact problem of heights \[m\] on the grid.
fn problem(params: &CaseParams, units: &Units, heights_m: Array2<f64>, list: &[Summit]) -> Result<Problem, StageError> {
    let (material, elements, spacing) = (&params.material, &params.boundary_elements, units.spacing_m());
    let work_length = material.work_of_adhesion_j_m2 / material.contact_modulus_pa;
    let top = heights_m.iter().copied().fold(f64::MIN, f64::max);
    let (mut heights, _) = heights_m.into_raw_vec_and_offset();
    heights.iter_mut().for_each(|z| *z = (*z - top) / spacing);
    let work = work_length / spacing;
    let (law, attraction) = match elements.attraction {
        Attraction::Range => (Law::morse(work, elements.range(work_length, spacing) / spacing), Rule::Range),
        Attraction::Bonded => {
            let nucleation = match elements.nucleation {
                Nucleation::Touch => 0.0,
                Nucleation::Wu => wu_gap(material, list)? / spacing,
            };
            (Law::crack(work), Rule::Bonded { margin: MARGIN, nucleation })
        }
    };
    Ok(Problem { half_space: HalfSpace::new(units.points, units.points)?, law, heights, attraction })
}

/// Wu's jump-in gap at the median radius of the asperities \[m\].
fn wu_gap(material: &Material, list: &[Summit]) -> Result<f64, PhysicsError> {
    let mut radii: Vec<f64> = list.iter().map(Summit::radius_m).collect();
    radii.sort_by(f64::total_cmp);
    let Some(median) = radii.get(radii.len() / 2) else { return Err(PhysicsError::NoSummit) };
    Ok((-Asperity::new(*median, material)?.wu_jump_in_penetration(material.interaction_range_m)).max(0.0))
}

fn settings(params: &CaseParams, units: &Units) -> Settings {
    let elements = &params.boundary_elements;
    Settings {
        max_loads: params.cycle.max_load.iter().map(|load| load * units.all()).collect(),
        step: elements.approach_step * units.rms_height_m / units.spacing_m(),
        halvings: HALVINGS,
        accuracy: Accuracy { rms: elements.precision, largest: PEAK * elements.precision, iterations: MOST_ITERATIONS },
        all_regions: params.cycle.contacts == KeptContacts::All,
    }
}

/// Refuses a grid for which there is not enough memory.
fn enough_memory(points: usize, loads: usize) -> Result<(), PhysicsError> {
    let bytes = points * points * size_of::<f64>() * (FIELDS + FIELDS_OF_REVERSAL * loads);
    memory::check(bytes).map_err(|_| PhysicsError::Surface {
        problem: format!("boundary elements on {points} x {points} points need {:.2} GB of memory, which are not free", bytes as f64 / 1e9),
        help: "use fewer boundary_elements.points, fewer loads, or fewer tasks at once (--jobs 1)",
    })
}

/// Grid points nearest to the asperities and, on a surface that is continued by mirror images, to their images.
fn summit_points(list: &[Summit], (length_m, side): (f64, usize), is_mirrored: bool, units: &Units) -> Vec<usize> {
    let n = units.points;
    let at = |place: f64| (place / units.spacing_m()).round() as usize % n;
    // Row k of the surface has its image in row 2 N - 1 - k.
    let image = |place: f64| 2.0 * length_m - length_m / side as f64 - place;
    let places = |place: f64| if is_mirrored { vec![at(place), at(image(place))] } else { vec![at(place)] };
    let all = |summit: &Summit| {
        let columns = places(summit.y_m);
        places(summit.x_m).into_iter().flat_map(move |row| columns.clone().into_iter().map(move |column| row * n + column))
    };
    list.iter().flat_map(all).collect()
}

/// Number of asperities in each region.
fn summit_counts(labels: &Labels, summits: &[usize]) -> Vec<u32> {
    let mut counts = vec![0; labels.count];
    for label in summits.iter().filter_map(|point| labels.of.get(*point)).filter(|label| **label > 0) {
        counts[*label as usize - 1] += 1;
    }
    counts
}

/// An error of the solver with its lengths and loads as those of the tables.
fn in_si(error: PhysicsError, units: &Units) -> PhysicsError {
    let spacing = units.spacing_m();
    match error {
        PhysicsError::LoadNotReached { wanted, reached, approach_m } => {
            PhysicsError::LoadNotReached { wanted: wanted / units.all(), reached: reached / units.all(), approach_m: approach_m * spacing }
        }
        PhysicsError::Closed { approach_m } => PhysicsError::Closed { approach_m: approach_m * spacing },
        other => other,
    }
}

/// Maps in SI units, in the order of the steps.
fn maps(cycle: &Cycle, loads: &[f64], units: &Units) -> Vec<ContactMap> {
    let (length, stress) = (units.spacing_m(), units.modulus_pa);
    let mut maps: Vec<ContactMap> = cycle
        .maps
        .iter()
        .map(|map| {
            let step = &cycle.steps[map.step];
            let reversal = step.reversal.or_else(|| cycle.turning.iter().position(|turning| turning.step == map.step));
            ContactMap {
                step: map.step as i64,
                branch: if step.reversal.is_some() { "unloading" } else { "loading" },
                max_load: reversal.and_then(|at| loads.get(at)).copied().unwrap_or_default(),
                approach_m: step.approach * length,
                load_n: step.totals.load * units.load_n(),
                gap_m: map.gap.iter().map(|gap| (f64::from(*gap) * length) as f32).collect(),
                pressure_pa: map.pressure.iter().map(|pressure| (f64::from(*pressure) * stress) as f32).collect(),
            }
        })
        .collect();
    maps.sort_by_key(|map| map.step);
    maps
}

/// File of the states at the load reversals.
fn turning_path(dir: &Path) -> PathBuf {
    dir.join("turning.bin")
}

/// States at the load reversals. The pressure follows from the displacement.
fn turning_bytes(cycle: &Cycle) -> Result<Vec<u8>, StageError> {
    let mut states = cycle.turning.clone();
    states.iter_mut().for_each(|turning| turning.state.pressure = Vec::new());
    postcard::to_stdvec(&states).map_err(|error| StageError::State { what: error.to_string() })
}

/// Unloads by boundary elements from a load reversal of a finished cycle: the cycle in the units of the solver, and these units.
///
/// # Errors
/// The files of the cycle and of its surface must be complete, and contain that load.
pub fn unload_elements_again(campaign: &Campaign, unit: &CycleUnit, max_load: f64) -> Result<(Cycle, Units), StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let Setup { problem, settings, units, .. } = setup(campaign, unit)?;
    let path = turning_path(&campaign.cycle_dir(unit));
    let states: Option<Vec<Turning>> = read_halfway(&path, &unit.key).and_then(|bytes| postcard::from_bytes(&bytes).ok());
    let reversal = params.cycle.max_load.iter().position(|load| *load == max_load);
    let kept = || format!("the loads {:?}", params.cycle.max_load);
    let lacking = || StageError::NoTurning { max_load, path: path.clone(), kept: kept() };
    let reversal = reversal.ok_or_else(lacking)?;
    let mut turning = states.and_then(|mut all| (reversal < all.len()).then(|| all.swap_remove(reversal))).ok_or_else(lacking)?;
    if turning.state.displacement.len() != problem.half_space.points() {
        return Err(lacking());
    }
    turning.state.pressure = vec![0.0; problem.half_space.points()];
    let cycle = cycle::unload_from(&problem, &settings, reversal, &turning).map_err(|error| in_si(error, &units))?;
    Ok((cycle, units))
}

/// Effort of a cycle, for its provenance record.
fn effort(cycle: &Cycle, problem: &Problem) -> Map<String, Value> {
    let sum = |value: fn(&cycle::Step) -> u64| cycle.steps.iter().map(value).sum::<u64>();
    let counts = [
        ("point_count", problem.half_space.points() as u64),
        ("step_count", cycle.steps.len() as u64),
        ("event_count", cycle.events.len() as u64),
        ("iteration_count", sum(|step| step.iterations)),
        ("transform_count", sum(|step| step.transforms)),
    ];
    counts.into_iter().map(|(name, count)| (name.to_owned(), count.into())).collect()
}
