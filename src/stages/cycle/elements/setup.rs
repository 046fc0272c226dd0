//! Grid, law and settings of boundary elements from the parameters of a case.

use super::super::super::StageError;
use super::super::super::extract::read_summits;
use super::super::super::surface::scale;
use super::ElementsCase;
use super::lattice::{Lattice, Square, checked_lattice};
use crate::campaign::{Campaign, CycleUnit};
use crate::model::{Attraction as Rule, FrontLaw, Material, Nucleation, Opening};
use crate::physics::PhysicsError;
use crate::physics::elements::law::Front;
use crate::physics::elements::{Attraction, Elements, Options};
use crate::physics::jkr::Asperity;
use crate::physics::surface::HeightMap;
use crate::physics::surface::summits::Summit;
use crate::spec::automatic_range;
use crate::store::hdf5::read_surface;

/// The surface of a cycle on the grid of its case.
pub(super) struct Setup {
    pub(super) method: Elements,
    pub(super) summits: Vec<Summit>,
    /// Grid points per cut-off wavelength.
    pub(super) per_wavelength: f64,
}

/// Reads the surface of a cycle and sets the method up.
pub(super) fn setup(
    campaign: &Campaign,
    unit: &CycleUnit,
    of: ElementsCase<'_>,
) -> Result<Setup, StageError> {
    let params = of.params;
    let surface = &campaign.surfaces[unit.surface];
    let (header, heights) = read_surface(&campaign.surface_path(surface))?;
    let summits = read_summits(&campaign.asperities_path(surface))?;
    let (length_m, wavelengths) = Square::of(params, &header).extent();
    let scale = scale(campaign, surface)?;
    let (rms_height_m, material) = (scale.rms_height_m, scale.material(&params.material));
    let lattice = checked_lattice(of, &header, rms_height_m)?;
    let attraction = match of.options.attraction {
        Rule::Bonded { nucleation, opening, .. } => bonded(&material, &summits, nucleation, opening)?,
        Rule::Range { range_m } => {
            let spacing_m = length_m / lattice.points as f64;
            let automatic = || automatic_range(material.adhesion_length_m(), spacing_m);
            Attraction::Range { range_m: range_m.unwrap_or_else(automatic) }
        }
    };
    let (elements, shortest_wavelength_m) = (of.options, length_m / wavelengths);
    let options = Options {
        points: lattice.points,
        shift: elements.shift,
        attraction,
        law: match of.options.attraction.law() {
            Some(FrontLaw::Corrected) => Front::CORRECTED,
            _ => Front::PLAIN,
        },
        probe: params.probe,
        substrate: params.substrate,
        machine: params.machine,
        approach_step: elements.approach_step,
        halvings: elements.halvings,
        precision: elements.precision,
        contacts: params.cycle.contacts,
        ..Options::default()
    };
    let (length_m, is_periodic) = (header.length_m, header.periodic);
    let map =
        HeightMap { heights_m: heights.view(), length_m, is_periodic, shortest_wavelength_m, rms_height_m };
    let method = Elements::new(&map, &material, &params.cycle.max_load, &options)?;
    let method = method.with_summits(summits.iter().map(|summit| [summit.x_m, summit.y_m]));
    let by_spectrum =
        params.surface.generated().map_or(lattice, |surface| Lattice::of_generated(of, surface));
    Ok(Setup { method, summits, per_wavelength: by_spectrum.per_wavelength })
}

/// The JKR limit of a case on a surface with these asperities.
fn bonded(
    material: &Material,
    list: &[Summit],
    nucleation: Nucleation,
    opening: Opening,
) -> Result<Attraction, StageError> {
    let nucleation_m = match nucleation {
        Nucleation::Touch => 0.0,
        Nucleation::Wu => wu_gap(material, list)?,
    };
    let strength = match opening {
        Opening::Strength => material.adhesion_length_m() / material.interaction_range_m,
        Opening::Edges => f64::INFINITY,
        Opening::Anywhere => 0.0,
    };
    Ok(Attraction::Bonded { nucleation_m, strength })
}

/// Wu's jump-in gap at the median radius of the asperities \[m\].
fn wu_gap(material: &Material, list: &[Summit]) -> Result<f64, PhysicsError> {
    let mut radii: Vec<f64> = list.iter().map(Summit::radius_m).collect();
    radii.sort_by(f64::total_cmp);
    let Some(median) = radii.get(radii.len() / 2) else { return Err(PhysicsError::NoSummit) };
    Ok((-Asperity::new(*median, material)?.wu_jump_in_penetration(material.interaction_range_m)).max(0.0))
}
