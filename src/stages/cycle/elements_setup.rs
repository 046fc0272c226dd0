//! Grid, law and settings of boundary elements from the parameters of a case.

use super::super::StageError;
use super::super::extract::read_summits;
use super::super::surface::scale;
use super::lattice::{checked_lattice, extent};
use crate::campaign::{Campaign, CycleUnit};
use crate::model::{KeptContacts, Material, Nucleation, Opening};
use crate::physics::PhysicsError;
use crate::physics::boundary_elements::contact::{Attraction as Rule, Problem};
use crate::physics::boundary_elements::cycle::Settings;
use crate::physics::boundary_elements::grid::HalfSpace;
use crate::physics::boundary_elements::law::Law;
use crate::physics::boundary_elements::minimise::Accuracy;
use crate::physics::boundary_elements::resample::resample_from;
use crate::physics::jkr::Asperity;
use crate::physics::surface::modes::mirrored;
use crate::physics::surface::summits::Summit;
use crate::physics::theory::flattening::measured_flattening;
use crate::spec::CaseParams;
use crate::store::hdf5::read_surface;
use ndarray::Array2;

/// Largest error that a jump of the load may cause in the integral over a step, relative to the energy dissipated so far.
pub(super) const LOCATED: f64 = 0.03;
/// Ratios `U_el/Δγ` of Persson and Tosatti from which on adhesion is weak, with the number of steps in one of `boundary_elements.approach_step` there, and
/// the factor by which `boundary_elements.precision` is smaller.
///
/// With weak adhesion the dissipated energy is a small part of the work of the load, and the sum of the events is as inexact as its integral.
pub(super) const WEAK: [(f64, f64, f64); 2] = [(150.0, 30.0, 10.0), (15.0, 6.0, 6.0)];
/// Largest residual over the rms residual of an equilibrium.
pub(super) const PEAK: f64 = 100.0;
/// Maximum number of iterations of one minimisation.
pub(super) const MOST_ITERATIONS: usize = 3000;
/// Points around a contact that are bonded.
pub(super) const MARGIN: usize = 2;
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
    /// True if the square is a surface with its three mirror images. Loads, areas and energies are then those of the surface: a quarter.
    pub is_mirrored: bool,
    /// Place of the first grid point along x and y, from the first point of the surface \[m\].
    pub first_m: f64,
}

impl Units {
    /// Grid spacing, the unit of length \[m\].
    #[must_use]
    pub fn spacing_m(&self) -> f64 {
        self.length_m / self.points as f64
    }

    /// Unit of the load of the square, as that of the surface \[N\].
    #[must_use]
    pub fn load_n(&self) -> f64 {
        self.point_load_n() * self.share()
    }

    /// Unit of the energy of the square, as that of the surface \[J\].
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        self.point_load_n() * self.spacing_m() * self.share()
    }

    /// Area of a point of the square, as that of the surface \[m²\].
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.spacing_m().powi(2) * self.share()
    }

    /// Unit of the load of a point \[N\].
    #[must_use]
    pub fn point_load_n(&self) -> f64 {
        self.modulus_pa * self.spacing_m().powi(2)
    }

    /// Share of the surface in the square.
    fn share(&self) -> f64 {
        if self.is_mirrored { 0.25 } else { 1.0 }
    }

    /// Grid points along a side of the surface.
    #[must_use]
    pub fn own_points(&self) -> usize {
        if self.is_mirrored { self.points / 2 } else { self.points }
    }

    /// Place of a grid point along x or y, from the first point of the surface \[m\].
    #[must_use]
    pub fn place_m(&self, point: f64) -> f64 {
        self.first_m + point * self.spacing_m()
    }

    /// Number of grid points: A0, and `E* A0` in the units of the solver.
    #[must_use]
    pub fn all(&self) -> f64 {
        (self.points * self.points) as f64
    }
}

/// A contact problem with its settings, units and the grid points of the asperities.
pub(super) struct Setup {
    pub(super) problem: Problem,
    pub(super) settings: Settings,
    pub(super) units: Units,
    pub(super) summits: Vec<usize>,
}

/// The problem of a cycle on the grid of its case.
pub(super) fn setup(campaign: &Campaign, unit: &CycleUnit) -> Result<Setup, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let surface = &campaign.surfaces[unit.surface];
    let (header, heights) = read_surface(&campaign.surface_path(surface))?;
    let list = read_summits(&campaign.asperities_path(surface))?;
    let (length_m, wavelengths) = extent(&header, params);
    let material = &params.material;
    let rms_height_m = scale(campaign, surface)?.rms_height_m;
    let lattice = checked_lattice(params, &header, rms_height_m)?;
    let (points, is_mirrored) = (lattice.points, lattice.is_mirrored);
    // With mirror images the grid is symmetric about the edges of the surface, half a pixel outside its first and last points.
    let (spacing, pixel) = (length_m / points as f64, header.length_m / heights.nrows() as f64);
    let first_m = if is_mirrored { 0.5 * (spacing - pixel) } else { 0.0 };
    let units = Units { length_m, points, modulus_pa: material.contact_modulus_pa, rms_height_m, is_mirrored, first_m };
    let flattening =
        measured_flattening(heights.view(), (header.length_m, header.periodic), length_m / wavelengths, material.contact_modulus_pa)?;
    let ratio = flattening.persson_tosatti(material.work_of_adhesion_j_m2);
    let whole = if header.periodic { heights } else { mirrored(heights.view())? };
    let problem = problem(params, (&units, lattice.range_m), resample_from(whole.view(), points, first_m / pixel)?, &list)?;
    let summits = summit_points(&list, &units);
    Ok(Setup { settings: settings(params, &units, ratio), problem, units, summits })
}

/// The contact problem of heights \[m\] on the grid, with the range of the Morse law \[m\] if there is one.
fn problem(
    params: &CaseParams,
    (units, range_m): (&Units, Option<f64>),
    heights_m: Array2<f64>,
    list: &[Summit],
) -> Result<Problem, StageError> {
    let (material, elements, spacing) = (&params.material, &params.boundary_elements, units.spacing_m());
    let work_length = material.adhesion_length_m();
    let top = heights_m.iter().copied().fold(f64::MIN, f64::max);
    let (mut heights, _) = heights_m.into_raw_vec_and_offset();
    heights.iter_mut().for_each(|z| *z = (*z - top) / spacing);
    let work = work_length / spacing;
    let (law, attraction) = match range_m {
        Some(range_m) => (Law::morse(work, range_m / spacing), Rule::Range),
        None => {
            let nucleation = match elements.nucleation {
                Nucleation::Touch => 0.0,
                Nucleation::Wu => wu_gap(material, list)? / spacing,
            };
            let strength = match elements.opening {
                Opening::Strength => work_length / material.interaction_range_m,
                Opening::Edges => f64::INFINITY,
                Opening::Anywhere => 0.0,
            };
            (Law::crack(work), Rule::Bonded { margin: MARGIN, nucleation, strength })
        }
    };
    let half_space = HalfSpace::new(units.points, units.points)?;
    let half_space = if units.is_mirrored { half_space.with_images() } else { half_space };
    Ok(Problem { half_space, law, heights, attraction })
}

/// Wu's jump-in gap at the median radius of the asperities \[m\].
fn wu_gap(material: &Material, list: &[Summit]) -> Result<f64, PhysicsError> {
    let mut radii: Vec<f64> = list.iter().map(Summit::radius_m).collect();
    radii.sort_by(f64::total_cmp);
    let Some(median) = radii.get(radii.len() / 2) else { return Err(PhysicsError::NoSummit) };
    Ok((-Asperity::new(*median, material)?.wu_jump_in_penetration(material.interaction_range_m)).max(0.0))
}

/// Settings at a ratio `U_el/Δγ`.
fn settings(params: &CaseParams, units: &Units, ratio: f64) -> Settings {
    let elements = &params.boundary_elements;
    let (_, steps, precision) = WEAK.into_iter().find(|(from, ..)| ratio > *from).unwrap_or((0.0, 1.0, 1.0));
    let residual = elements.precision / precision;
    Settings {
        max_loads: params.cycle.max_load.iter().map(|load| load * units.all()).collect(),
        step: elements.approach_step * units.rms_height_m / units.spacing_m() / steps,
        located: LOCATED,
        halvings: elements.halvings,
        accuracy: Accuracy { rms: residual, largest: PEAK * residual, iterations: MOST_ITERATIONS },
        all_regions: params.cycle.contacts == KeptContacts::All,
    }
}

/// Number of steps in one of `boundary_elements.approach_step` at a ratio `U_el/Δγ`.
pub(in crate::stages) fn refinement_of_steps(ratio: f64) -> f64 {
    WEAK.into_iter().find(|(from, ..)| ratio > *from).map_or(1.0, |(_, steps, _)| steps)
}

/// Grid points nearest to the asperities.
fn summit_points(list: &[Summit], units: &Units) -> Vec<usize> {
    let (n, own) = (units.points, units.own_points());
    let at = |place: f64| {
        let nearest = ((place - units.first_m) / units.spacing_m()).round() as usize;
        if units.is_mirrored { nearest.min(own - 1) } else { nearest % n }
    };
    list.iter().map(|summit| at(summit.x_m) * n + at(summit.y_m)).collect()
}
