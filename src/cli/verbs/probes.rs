//! Probe, machine and layer before a run: the smooth sphere by JKR, over the grid spacing and the side.

use super::verdicts::range;
use crate::campaign::Campaign;
use crate::model::{CaseParams, Choice as _, FarField, Machine, Material, Probe, SPHERE_SHARE};
use crate::spec::contact_radius_m;
use crate::stages::Verdict;
use crate::text::wrapped;
use std::f64::consts::PI;

/// Paragraphs on probe, machine and layer; empty for flat surfaces on a stiff machine. `verdicts` are those
/// of the cases, in their order.
pub(super) fn text(campaign: &Campaign, verdicts: &[Verdict]) -> String {
    let cases: Vec<(&CaseParams, &Verdict)> =
        campaign.cases.iter().map(|unit| &unit.case.params).zip(verdicts).collect();
    let paragraphs = [("probe", probe(&cases)), ("machine", machine(&cases)), ("layer", layer(&cases))];
    let lines = paragraphs
        .into_iter()
        .filter_map(|(name, text)| Some(wrapped(&format!("{name:10}{}", text?), "          ")));
    lines.collect()
}

/// JKR radius of contact of the smooth sphere at zero penetration, `(2πΔγR²/E*)^⅓` \[m\].
fn at_touch_m(probe: &Probe, material: &Material) -> f64 {
    (2.0 * PI).cbrt() * probe.jkr_radius_m(material)
}

/// The probe: its radius, and the smooth sphere by JKR.
fn probe(cases: &[(&CaseParams, &Verdict)]) -> Option<String> {
    let with = || cases.iter().filter_map(|(params, of)| Some((*params, *of, params.probe?)));
    let radius = range(with().map(|(.., probe)| probe.radius_m), 4)?;
    let mut text = format!("R = {radius} m. A smooth sphere has by JKR");
    let adhesive = || with().filter(|(params, ..)| params.material.work_of_adhesion_j_m2 > 0.0);
    if let Some(force) = range(
        adhesive()
            .map(|(params, _, probe)| 1.5 * PI * params.material.work_of_adhesion_j_m2 * probe.radius_m),
        3,
    ) {
        let touch = range(adhesive().map(|(params, _, probe)| at_touch_m(&probe, &params.material)), 3)?;
        text += &format!(" a contact radius of {touch} m at touch");
        let of_grid = adhesive().filter_map(|(params, of, probe)| {
            let spacing_m = of.length_m? / of.cost?.points as f64;
            Some(at_touch_m(&probe, &params.material) / spacing_m)
        });
        text += &range(of_grid, 2).map_or_else(String::new, |points| format!(" ({points} grid points)"));
        text += &format!(", F_po = {force} N,");
    }
    let turning = with().filter_map(|(params, of, probe)| {
        let (length_m, modulus_pa) = (of.length_m?, params.material.contact_modulus_pa);
        let load_n = params.cycle.largest_load() * modulus_pa * length_m.powi(2);
        Some((contact_radius_m(&probe, &params.material, load_n)?, length_m))
    });
    match range(turning.clone().map(|(radius_m, _)| radius_m), 3)
        .zip(range(turning.map(|(radius_m, length_m)| radius_m / length_m), 2))
    {
        Some((radius, share)) => {
            text += &format!(
                " a contact radius of {radius} m at the maximum load, {share} of the side (limit \
                 {SPHERE_SHARE})."
            );
        }
        None => text += " a contact that is known after the scan is read.",
    }
    Some(text)
}

/// The machine of cases with a probe, and of others where it is not stiff.
fn machine(cases: &[(&CaseParams, &Verdict)]) -> Option<String> {
    let stiff = Machine::default();
    let shown = || cases.iter().filter(|(of, _)| of.probe.is_some() || of.machine != stiff);
    let words = |word: fn(&Machine) -> &'static str| {
        let mut all: Vec<&str> = shown().map(|(of, _)| word(&of.machine)).collect();
        all.dedup();
        all.sort_unstable();
        all.dedup();
        all.join(" and ")
    };
    let compliance = range(shown().map(|(of, _)| of.machine.compliance_m_n), 4)?;
    let far_field = words(|machine| match machine.far_field {
        FarField::Cell => "periodic cell",
        FarField::HalfSpace => "half-space",
    });
    let control = words(|machine| machine.control.word());
    Some(format!("{far_field}; compliance {compliance} m/N; control of the {control}."))
}

/// The layer.
fn layer(cases: &[(&CaseParams, &Verdict)]) -> Option<String> {
    let with = || cases.iter().filter_map(|(params, _)| Some((*params, params.substrate?)));
    let thickness = range(with().map(|(_, layer)| layer.thickness_m), 4)?;
    let poisson_ratio = range(with().map(|(_, layer)| layer.poisson_ratio), 3)?;
    let over = with().filter_map(|(params, layer)| {
        let touch_m = at_touch_m(&params.probe?, &params.material);
        (touch_m > 0.0).then_some(layer.thickness_m / touch_m)
    });
    let radii = range(over, 2)
        .map_or_else(String::new, |radii| format!(", {radii} contact radii of the sphere at touch"));
    Some(format!("thickness {thickness} m{radii}; Poisson's ratio {poisson_ratio}; rigid base."))
}
