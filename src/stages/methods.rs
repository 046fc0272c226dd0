//! Part of the report: both methods on the same surfaces.

use super::StageError;
use super::page::escape;
use super::trust::{Cases, ENERGIES, Shown, scaled, shown};
use crate::campaign::{Campaign, CycleUnit, Standing};
use crate::figures::{Both, Panel, SpotTables, both};
use crate::model::Boundary;
use crate::schema;
use crate::stats::{labels, method_pairs, names_of_pairs, significant};
use crate::store::hdf5::read_surface;
use crate::store::parquet::read_table;
use crate::store::{Frame, read_reversal_map};
use std::fmt::Write as _;

/// Heading and column of the compared quantities, in the order of [`method_pairs`].
const QUANTITIES: [(&str, &str); 3] = [
    ("A/A<sub>0</sub>", "area_at_max_load"),
    ("F<sub>po</sub>/(E*A<sub>0</sub>)", "pull_off_load"),
    ("Θ/(E*A<sub>0</sub>h<sub>rms</sub>)", "loss"),
];

/// Contact of both methods on one surface.
pub(super) struct Maps {
    pub(super) svg: String,
    caption: String,
}

/// The contact of the pair of cycles with the largest Θ by boundary elements on a periodic surface, at that load reversal; nothing without one, and where its contacts
/// or maps are not kept.
pub(super) fn contact_maps(campaign: &Campaign, standings: &[Standing], methods: &Frame) -> Result<Option<Maps>, StageError> {
    let (first, second, surfaces) = (methods.text("asperities_case_id")?, methods.text("elements_case_id")?, methods.text("surface_id")?);
    let (loads, losses) = (methods.f64("max_load")?, methods.f64("loss_elements")?);
    let areas = [methods.f64("area_at_max_load_asperities")?, methods.f64("area_at_max_load_elements")?];
    let Some(row) = (0..methods.row_count()).rev().max_by(|a, b| losses[*a].total_cmp(&losses[*b])) else { return Ok(None) };
    let done = |case: &str| {
        let is = |unit: &CycleUnit| campaign.cases[unit.case].id == case && campaign.surfaces[unit.surface].id == surfaces[row];
        campaign.cycles.iter().zip(standings).find(|(unit, standing)| **standing == Standing::Done && is(unit)).map(|(unit, _)| unit)
    };
    let (Some(asperities), Some(elements)) = (done(first[row]), done(second[row])) else { return Ok(None) };
    let surface = &campaign.surfaces[asperities.surface];
    let (header, heights) = read_surface(&campaign.surface_path(surface))?;
    let map = read_reversal_map(&campaign.cycle_dir(elements).join("maps.h5"), loads[row])?;
    let Some(map) = map.filter(|_| header.periodic) else { return Ok(None) };
    let table = |table: &'static schema::Table| read_table(&campaign.cycle_dir(asperities).join(format!("{}.parquet", table.name)), table);
    let (steps, contacts, merged) = (table(&schema::STEPS)?, table(&schema::CONTACTS)?, table(&schema::MERGED)?);
    let summits = read_table(&campaign.asperities_path(surface), &schema::ASPERITIES)?;
    let (branches, load) = (steps.text("branch")?, steps.f64("load")?);
    let off = |step: &usize| (load[*step] - loads[row]).abs();
    let reversal = (0..load.len()).filter(|step| branches[*step] == "loading").min_by(|a, b| off(a).total_cmp(&off(b)));
    let kept = contacts.i64("step")?;
    let Some(step) = reversal.map(|step| step as i64).filter(|step| kept.contains(step)) else { return Ok(None) };
    let params = &campaign.cases[asperities.case].case.params;
    let svg = both(&Both {
        heights_m: heights.view(),
        length_m: header.length_m,
        periodic: params.model.boundary == Boundary::Periodic,
        spots: SpotTables { contacts: &contacts, asperities: &summits, merged: &merged },
        step,
        areas: areas.map(|areas| areas[row]),
        elements: &map,
    })?;
    let caption = format!(
        "Contact of surface {} at F_max/(E*A₀) = {}. Left: contact spots of the asperity model. Right: grid points of boundary elements. Table realizations: \
         area_at_max_load; maps.h5: pressure_pa.",
        surfaces[row],
        significant(loads[row], 4)
    );
    Ok(Some(Maps { svg, caption }))
}

/// Figures of both methods: ratios over U_el/Δγ, and contact on one surface.
pub(super) struct BothFigures {
    pub(super) ratios: Option<Panel>,
    pub(super) maps: Option<Maps>,
}

/// A table of the means of both methods and their ratios; empty without cases of the same surfaces by both methods.
pub(super) fn side_by_side(html: &mut String, cases: &Cases<'_>, methods: &Frame, figures: &BothFigures) -> Result<(), StageError> {
    let pairs = method_pairs(methods)?;
    if pairs.is_empty() {
        return Ok(());
    }
    // Writing to a string cannot fail.
    let _ = write!(
        html,
        "<h2>Asperity model and boundary elements</h2>\n<p>Means over the surfaces that both methods have finished, and the ratio of the asperity model to \
         boundary elements on the same surface: mean ± standard deviation. The table <code>statistics/methods.parquet</code> holds each surface and the 95 % \
         confidence intervals.</p>\n<div class=\"wide\"><table>\n<tr><th>case</th><th>F<sub>max</sub>/(E*A<sub>0</sub>)</th><th>surfaces</th>"
    );
    let mut scales = Vec::new();
    for (heading, column) in QUANTITIES {
        let scale = if ENERGIES.contains(&column) { cases.scale(&ENERGIES)? } else { cases.scale(&[column])? };
        let head = scale.head();
        let _ = write!(html, "<th>{heading}{head}, asperities</th><th>{heading}{head}, boundary elements</th><th>ratio</th>");
        scales.push(scale);
    }
    html.push_str("</tr>\n");
    let names = names_of_pairs(cases.frame, &pairs)?;
    let loads = labels(&pairs.iter().map(|pair| pair.max_load).collect::<Vec<f64>>());
    for ((pair, name), load) in pairs.iter().zip(&names).zip(&loads) {
        let _ = write!(html, "<tr><td>{}</td><td>{load}</td><td>{}</td>", escape(name), pair.count);
        for ([asperities, elements, ratio, sd], scale) in pair.quantities.into_iter().zip(&scales) {
            let sd = sd.map(|sd| format!(" ± {}", shown(Some(sd), Shown::Plain))).unwrap_or_default();
            let _ = write!(
                html,
                "<td>{}</td><td>{}</td><td>{}{sd}</td>",
                scaled(asperities, *scale),
                scaled(elements, *scale),
                shown(ratio, Shown::Plain)
            );
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    let ratios = figures.ratios.as_ref().map(|panel| (panel.stem.as_str(), &panel.svg, &panel.caption));
    let maps = figures.maps.as_ref().map(|maps| ("contact_maps", &maps.svg, &maps.caption));
    for (stem, svg, caption) in ratios.into_iter().chain(maps) {
        let links = ["SVG", "PNG", "PDF"].map(|format| format!("<a href=\"figures/{stem}.{}\">{format}</a>", format.to_lowercase()));
        let _ = writeln!(html, "<figure class=\"map\">{svg}<figcaption>{} {}</figcaption></figure>", escape(caption), links.join(" · "));
    }
    Ok(())
}
