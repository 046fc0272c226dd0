//! Contact maps of both methods on one surface, for the report.

use super::StageError;
use crate::campaign::{Campaign, CycleUnit, Standing};
use crate::figures::{Both, Drawing, both};
use crate::model::Boundary;
use crate::schema;
use crate::stats::load_in_words;
use crate::store::hdf5::read_surface;
use crate::store::parquet::read_table;
use crate::store::{Frame, read_loop_maps};

/// The contact of the pair of cycles with the largest Θ by boundary elements on a periodic surface, at that
/// load reversal; nothing without one, and where its contacts or maps are not kept.
pub(super) fn contact_maps(
    campaign: &Campaign,
    standings: &[Standing],
    methods: &Frame,
) -> Result<Option<Drawing>, StageError> {
    let (first, second, surfaces) =
        (methods.text("asperities_case_id")?, methods.text("elements_case_id")?, methods.text("surface_id")?);
    let (loads, losses) = (methods.f64("max_load")?, methods.f64_or_null("loss_elements")?);
    let areas = [methods.f64("area_at_max_load_asperities")?, methods.f64("area_at_max_load_elements")?];
    let Some(row) = (0..methods.row_count())
        .rev()
        .max_by(|a, b| losses[*a].unwrap_or(f64::MIN).total_cmp(&losses[*b].unwrap_or(f64::MIN)))
    else {
        return Ok(None);
    };
    let done = |case: &str| {
        let is = |unit: &CycleUnit| {
            campaign.cases[unit.case].id == case && campaign.surfaces[unit.surface].id == surfaces[row]
        };
        campaign
            .cycles
            .iter()
            .zip(standings)
            .find(|(unit, standing)| **standing == Standing::Done && is(unit))
            .map(|(unit, _)| unit)
    };
    let (Some(asperities), Some(elements)) = (done(first[row]), done(second[row])) else { return Ok(None) };
    let surface = &campaign.surfaces[asperities.surface];
    let (header, heights) = read_surface(&campaign.surface_path(surface))?;
    let map = read_loop_maps(&campaign.cycle_dir(elements).join("maps.h5"), loads[row])?;
    let Some(map) = map.filter(|_| header.periodic) else { return Ok(None) };
    let table = |table: &'static schema::Table| {
        read_table(&campaign.cycle_dir(asperities).join(format!("{}.parquet", table.name)), table)
    };
    let (steps, contacts) = (table(&schema::STEPS)?, table(&schema::CONTACTS)?);
    let reversal = steps.f64_or_null("reversal_load")?.iter().position(|load| *load == Some(loads[row]));
    let kept = contacts.i64("step")?;
    let Some(step) = reversal.map(|step| step as i64).filter(|step| kept.contains(step)) else {
        return Ok(None);
    };
    let params = &campaign.cases[asperities.case].case.params;
    let (unit, modulus_pa) = (campaign.spec.load_unit(), params.material.contact_modulus_pa);
    let caption = format!(
        "Contact of surface {} at {}. Left: contact spots of the asperity model. Right: grid \
         points of boundary elements. Table realizations: area_at_max_load; maps.h5: pressure_pa.",
        surfaces[row],
        load_in_words(loads[row], unit, modulus_pa, Some(header.length_m))
    );
    let content = Both {
        heights_m: heights.view(),
        length_m: header.length_m,
        periodic: params.boundary() == Boundary::Periodic,
        contacts: &contacts,
        step,
        areas: areas.map(|areas| areas[row]),
        elements: &map,
    };
    Ok(Some(both(&content, caption)?))
}
