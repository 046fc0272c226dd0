//! Warnings that follow from a spec alone.

use super::surface::target;
use crate::campaign::{Campaign, CaseUnit};
use crate::physics::theory::flattening::{Flattening, flattening};
use crate::spec::MANY_RANGE_STEPS;
use crate::stats::{CAUTIONS, Caution, Limit, MANY_STEPS};

/// Elastic energy over a work of adhesion \[J/m²\].
type Ratio = fn(&Flattening, f64) -> f64;

/// Cases whose target spectrum is outside the range of the asperity model.
#[derive(Debug, Clone, PartialEq)]
pub struct Outside {
    /// The warning.
    pub kind: Caution,
    /// Its limit.
    pub limit: f64,
    /// Smallest and largest value over these cases.
    pub range: [f64; 2],
    /// Ids of the cases.
    pub cases: Vec<String>,
}

/// Warnings that follow from the spec alone, before any surface is made: `U_el/Δγ` and `U_1/Δγ` of the target spectra. Measured surfaces and cases
/// without adhesion have none.
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
        let (limit, kind) = (Limit::of(code)?, CAUTIONS.into_iter().find(|kind| kind.code == code)?);
        let known = campaign.cases.iter().filter_map(|unit| Some((unit.id.clone(), value(unit, ratio)?)));
        let (cases, values): (Vec<String>, Vec<f64>) = known.filter(|(_, value)| limit.is_passed(Some(*value))).unzip();
        let range = [values.iter().copied().reduce(f64::min)?, values.iter().copied().reduce(f64::max)?];
        Some(Outside { kind, limit: limit.bound, range, cases })
    };
    ratios.into_iter().filter_map(of).chain(coarse(campaign)).chain(many_steps(campaign)).collect()
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
    Some(Outside { kind: MANY_STEPS, limit: MANY_RANGE_STEPS, range, cases })
}

/// Cases of boundary elements with fewer grid points per shortest wavelength than recommended.
fn coarse(campaign: &Campaign) -> Option<Outside> {
    let (limit, kind) = (Limit::of("coarse")?, CAUTIONS.into_iter().find(|kind| kind.code == "coarse")?);
    let (mut cases, mut values) = (Vec::new(), Vec::new());
    for unit in campaign.cases.iter().filter(|unit| unit.case.params.by_elements() && !unit.case.params.surface.is_measured()) {
        let wavelengths = f64::from(unit.case.params.surface.magnification);
        let value = f64::from(unit.case.params.boundary_elements.grid(wavelengths)) / wavelengths;
        if limit.is_passed(Some(value)) {
            cases.push(unit.id.clone());
            values.push(value);
        }
    }
    let range = [values.iter().copied().reduce(f64::min)?, values.iter().copied().reduce(f64::max)?];
    Some(Outside { kind, limit: limit.bound, range, cases })
}
