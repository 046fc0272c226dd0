//! Grid, heights, medium, law and settings of boundary elements, from quantities in SI units.

use super::equilibrium::minimise::Accuracy;
use super::grid::half_space::HalfSpace;
use super::grid::medium::{Layer, Medium};
use super::grid::resample::resample_from;
use super::law::{Front, Law};
use super::path::cycle::Settings;
use super::problem::{Attraction as Rule, Problem};
use super::{Attraction, Options, Units, points_for, probe};
use crate::PhysicsError;
use crate::model::{CELL_CONSTANT, Control, FarField, KeptContacts, Material};
use crate::surface::HeightMap;
use crate::surface::modes::mirrored;
use ndarray::{Array2, ArrayView2};
use std::f64::consts::{PI, TAU};

/// Compliance of the spring of load control, in `1/(E*L)`. That of a contact is `1/(2E*a)`, so that the load
/// changes by less than 1 % of a jump's own force in a jump of a contact of radius `a > L/16`.
const SOFT_MACHINE: f64 = 1000.0;
/// Shortest wavelength of which heights are divided by the spectrum of the kernel \[dx\]: on coarser grids
/// the factor would exceed 1.6.
pub(super) const SHORTEST_EMPHASISED: f64 = 4.0;

/// Units of a surface. With mirror images the grid is symmetric about the edges of the surface, half a pixel
/// outside its first and last points. A probe needs no mirror images.
pub(super) fn units(map: &HeightMap<'_>, material: &Material, options: &Options) -> Units {
    let is_mirrored = !map.is_periodic && options.probe.is_none();
    let length_m = if is_mirrored { 2.0 * map.length_m } else { map.length_m };
    let points =
        if options.points == 0 { points_for(length_m / map.shortest_wavelength_m) } else { options.points };
    let (spacing, pixel) = (length_m / points as f64, map.length_m / map.heights_m.nrows() as f64);
    let first_m = match options.probe {
        _ if is_mirrored => 0.5 * (spacing - pixel),
        None => options.shift * spacing,
        Some(_) => 0.0,
    };
    let mut units = Units {
        length_m,
        points,
        modulus_pa: material.contact_modulus_pa,
        rms_height_m: map.rms_height_m,
        step_unit_m: options.probe.map_or(map.rms_height_m, |probe| probe.jkr_length_m(material)),
        is_mirrored,
        first_m,
        machine_compliance: 0.0,
        is_load_controlled: options.machine.control == Control::Load,
    };
    units.machine_compliance = if units.is_load_controlled {
        SOFT_MACHINE / points as f64
    } else {
        options.machine.compliance_m_n * units.load_n() / spacing
    };
    units
}

/// Heights \[m\] of the surface, with its mirror images or on its probe, at the points of the grid.
pub(super) fn heights(
    map: &HeightMap<'_>,
    units: &Units,
    options: &Options,
) -> Result<Array2<f64>, PhysicsError> {
    let pixel_m = map.length_m / map.heights_m.nrows() as f64;
    let first = units.first_m / pixel_m;
    let resampled = |heights: ArrayView2<'_, f64>| {
        let resampled = resample_from(heights, units.points, first)?;
        let shortest = map.shortest_wavelength_m / units.spacing_m();
        if options.emphasises() { emphasised(resampled, &options.law, shortest) } else { Ok(resampled) }
    };
    if units.is_mirrored {
        return resampled(mirrored(map.heights_m)?.view());
    }
    let Some(sphere) = options.probe else { return resampled(map.heights_m) };
    let mut rough = map.heights_m.to_owned();
    if !map.is_periodic {
        let points = rough.nrows();
        rough.indexed_iter_mut().for_each(|((row, column), z)| {
            *z *= probe::weight(probe::distance(row, column, points));
        });
    }
    let mut heights = resampled(rough.view())?;
    let unit_m = units.length_m.powi(2) / sphere.radius_m;
    heights.indexed_iter_mut().for_each(|((row, column), z)| {
        *z += unit_m * probe::height(probe::distance(row, column, units.points));
    });
    Ok(heights)
}

/// Heights over the spectrum of the kernel of the law, with a shortest wavelength \[dx\]: up to its
/// wavenumber, or that of [`SHORTEST_EMPHASISED`]. Beyond, the factor is that of this wavenumber.
fn emphasised(heights: Array2<f64>, law: &Front, shortest: f64) -> Result<Array2<f64>, PhysicsError> {
    let highest = TAU / shortest.max(SHORTEST_EMPHASISED);
    let shape = heights.dim();
    let (heights, _) = heights.into_raw_vec_and_offset();
    let filtered = HalfSpace::filter(&heights, shape.1, |q| law.spectrum(q.min(highest)).recip())?;
    Array2::from_shape_vec(shape, filtered)
        .map_err(|error| PhysicsError::Surface { problem: error.to_string(), help: "report this" })
}

/// Half-space or layer, with the compliances in series with it.
fn medium(units: &Units, options: &Options) -> Medium {
    let points = units.points as f64;
    // The image displacement of a periodic square, and a compliance of the whole square per mean pressure.
    let cell =
        if options.machine.far_field == FarField::HalfSpace { CELL_CONSTANT / PI * points } else { 0.0 };
    let layer = options.substrate.map(|substrate| Layer {
        thickness: substrate.thickness_m / units.spacing_m(),
        poisson_ratio: substrate.poisson_ratio,
    });
    Medium {
        layer,
        series_compliance: cell + units.machine_compliance * points * points,
        wall_compliance: if options.is_bonded() { options.law.wall_compliance() } else { 0.0 },
    }
}

/// The contact problem of heights \[m\] on the grid.
pub(super) fn problem(
    units: &Units,
    material: &Material,
    heights_m: Array2<f64>,
    options: &Options,
) -> Result<Problem, PhysicsError> {
    let spacing = units.spacing_m();
    let work = material.adhesion_length_m() / spacing;
    let top = heights_m.iter().copied().fold(f64::MIN, f64::max);
    let (mut heights, _) = heights_m.into_raw_vec_and_offset();
    heights.iter_mut().for_each(|z| *z = (*z - top) / spacing);
    let (law, attraction) = match options.attraction {
        Attraction::Range { range_m } => (Law::morse(work, range_m / spacing), Rule::Range),
        Attraction::Bonded { nucleation_m, strength } => (
            Law::front(work, &options.law),
            Rule::Bonded {
                margin: options.numerics.equilibrium.bond_margin,
                nucleation: nucleation_m / spacing,
                strength,
            },
        ),
    };
    let half_space = HalfSpace::of(&medium(units, options), units.points, units.points)?;
    let half_space = if units.is_mirrored { half_space.with_images() } else { half_space };
    let mut problem = Problem {
        half_space,
        law,
        heights,
        attraction,
        machine_compliance: units.machine_compliance,
        numerics: options.numerics,
    };
    if problem.moves_images_alike() {
        problem.half_space.mirror(&mut problem.heights);
    }
    Ok(problem)
}

/// Settings at a ratio `U_el/Δγ`.
pub(super) fn settings(units: &Units, max_loads: &[f64], options: &Options, ratio: f64) -> Settings {
    let numerics = &options.numerics;
    let (steps, precision) = numerics.refinement(ratio);
    let residual = options.precision / precision;
    Settings {
        max_loads: max_loads.iter().map(|load| load * units.all()).collect(),
        step: options.approach_step * units.step_unit_m / units.spacing_m() / steps,
        jump_tolerance: numerics.steps.jump_tolerance,
        halvings: options.halvings,
        accuracy: Accuracy {
            rms: residual,
            largest: numerics.equilibrium.largest_residual * residual,
            iterations: numerics.equilibrium.iterations,
        },
        all_regions: options.contacts == KeptContacts::All,
        summits: Vec::new(),
    }
}
