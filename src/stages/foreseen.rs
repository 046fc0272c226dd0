//! Warnings that follow from a spec and its measured surfaces, before anything is computed.

use super::grid_size::slow_grids;
use super::measure::measure;
pub use super::outside::Outside;
use super::outside::interval;
use super::surface::target;
use crate::campaign::{Campaign, CaseUnit, SurfaceUnit};
use crate::formats::recognize;
use crate::physics::theory::flattening::{Flattening, flattening};
use crate::spec::MANY_RANGE_STEPS;
use crate::stats::{Limit, MANY_STEPS};
use crate::store::hdf5::{SurfaceHeader, read_header};
use std::path::Path;

/// Elastic energy over a work of adhesion \[J/m²\].
type Ratio = fn(&Flattening, f64) -> f64;

/// Warnings of the artefacts of measured surfaces.
pub const ARTEFACTS: [&str; 4] = ["outliers", "lines", "noise", "tip"];

/// Largest file of a measured surface that is read before a run \[bytes\].
const LARGEST_FILE: u64 = 1 << 28;

/// Warnings before any surface is made: `U_el/Δγ` and `U_1/Δγ` of the target spectra, grids of boundary elements, and the artefacts of measured surfaces.
/// Cases without adhesion have no `U_el/Δγ`.
#[must_use]
pub fn foreseen(campaign: &Campaign) -> Vec<Outside> {
    let ratios: [(&str, Ratio); 2] = [("sticky", Flattening::persson_tosatti), ("conformed", Flattening::conformity)];
    let value = |unit: &CaseUnit, ratio: fn(&Flattening, f64) -> f64| {
        // The limits are those of the asperity model.
        if unit.case.params.by_elements() {
            return None;
        }
        let (params, material) = (&unit.case.params, &unit.case.params.material);
        let asked = target(params).filter(|_| material.work_of_adhesion_j_m2 > 0.0)?;
        Some(ratio(&flattening(&asked, material.contact_modulus_pa), material.work_of_adhesion_j_m2))
    };
    let of = |(code, ratio): (&str, Ratio)| {
        Outside::of(code, campaign.cases.iter().filter_map(|unit| Some((unit.id.clone(), value(unit, ratio)?))))
    };
    ratios
        .into_iter()
        .filter_map(of)
        .chain(coarse(campaign))
        .chain(many_steps(campaign))
        .chain(slow_grids(campaign))
        .chain(artefacts(campaign))
        .collect()
}

/// Cases of boundary elements whose attraction acts over many steps.
fn many_steps(campaign: &Campaign) -> Option<Outside> {
    let (mut cases, mut values) = (Vec::new(), Vec::new());
    for unit in campaign.cases.iter().filter(|unit| unit.case.params.by_elements() && !unit.case.params.surface.is_measured()) {
        let params = &unit.case.params;
        let (surface, elements) = (&params.surface, &params.boundary_elements);
        let spacing = surface.length_m / f64::from(elements.grid(f64::from(surface.magnification)));
        let range = elements.range(params.material.adhesion_length_m(), spacing);
        let steps = elements.range_steps(range, surface.rms_height_m, params.cycle.max_load.len());
        if steps > MANY_RANGE_STEPS {
            cases.push(unit.id.clone());
            values.push(steps.round());
        }
    }
    let range = [values.iter().copied().reduce(f64::min)?, values.iter().copied().reduce(f64::max)?];
    let measured = format!("{} (limit ≤ {MANY_RANGE_STEPS})", MANY_STEPS.text.replace("{}", &interval(range)));
    Some(Outside { kind: MANY_STEPS, limit: MANY_RANGE_STEPS, range, measured, cases })
}

/// Cases of boundary elements with fewer grid points per shortest wavelength than recommended.
fn coarse(campaign: &Campaign) -> Option<Outside> {
    let value = |unit: &CaseUnit| {
        let wavelengths = f64::from(unit.case.params.surface.magnification);
        (unit.id.clone(), f64::from(unit.case.params.boundary_elements.grid(wavelengths)) / wavelengths)
    };
    let generated = campaign.cases.iter().filter(|unit| unit.case.params.by_elements() && !unit.case.params.surface.is_measured());
    Outside::of("coarse", generated.map(value))
}

/// Cases with artefacts of their measured surfaces.
fn artefacts(campaign: &Campaign) -> Vec<Outside> {
    let measured = campaign.surfaces.iter().enumerate().filter(|(_, surface)| surface.params.is_measured());
    let known: Vec<(usize, SurfaceHeader)> = measured.filter_map(|(k, surface)| Some((k, header(campaign, surface)?))).collect();
    let of = |code: &str| {
        let column = Limit::of(code)?.of_one();
        let number =
            |header: &SurfaceHeader| header.artefact_columns().into_iter().find(|(name, _)| *name == column).and_then(|(_, value)| value);
        let cases_of = |surface: usize| {
            let cycles = campaign.cycles.iter().filter(move |cycle| cycle.surface == surface);
            cycles.map(|cycle| campaign.cases[cycle.case].id.clone())
        };
        let values = known.iter().filter_map(|(surface, header)| Some((*surface, number(header)?)));
        Outside::of(code, values.flat_map(|(surface, value)| cases_of(surface).map(move |case| (case, value))))
    };
    ARTEFACTS.into_iter().filter_map(of).collect()
}

/// Header of a measured surface: of its file in the run, or of the scan itself. Large scans, and those that cannot be imported, have none.
fn header(campaign: &Campaign, surface: &SurfaceUnit) -> Option<SurfaceHeader> {
    let in_run = read_header(&campaign.surface_path(surface)).ok().filter(|header| header.key == surface.key);
    in_run.or_else(|| {
        let path = Path::new(&surface.params.file);
        let is_small = std::fs::metadata(path).is_ok_and(|about| about.is_file() && about.len() <= LARGEST_FILE);
        let is_known = is_small && matches!(recognize(path), Ok(Ok(_)));
        is_known.then(|| measure(&surface.params, "", "").ok()).flatten().map(|found| found.header)
    })
}
