//! Works of adhesion and those of models for the report.

use super::StageError;
use crate::campaign::Campaign;
use crate::figures::{SimulatedWorks, works_over_cut_off};
use crate::report::{Works, simulated_works};
use crate::schema::CUTOFF;
use crate::stats::{listing, loads};
use crate::store::Frame;
use crate::store::parquet::read_table;

/// Cases with a figure, at most.
const MOST_PANELS: usize = 4;

/// The table `cutoff` with a figure of each of the first cases with a model, at its largest load; nothing if
/// an earlier version of the program wrote the statistics, or without a case.
pub(super) fn works(campaign: &Campaign, cases: &Frame) -> Result<Option<Works>, StageError> {
    let path = campaign.statistics_path(CUTOFF.name);
    if !path.is_file() {
        return Ok(None);
    }
    let cutoff = read_table(&path, &CUTOFF)?;
    if cutoff.row_count() == 0 {
        return Ok(None);
    }
    let (ids, loads, done) = (cases.text("case_id")?, loads(cases)?, cases.i64("done_count")?);
    let labels = loads.all_labels();
    let radii = cases.f64_or_null("probe_radius_m")?;
    let mut chosen: Vec<SimulatedWorks> = Vec::new();
    for listed in listing(cases)?.rows {
        let row = listed.row;
        // The loads of a case ascend.
        let is_last = ids.iter().rposition(|id| *id == ids[row]) == Some(row);
        if !is_last || done[row] == 0 {
            continue;
        }
        let names = if radii[row].is_some() { ["approach", "retraction"] } else { ["closing", "opening"] };
        let symbol = loads.symbol.replace(['{', '}'], "");
        chosen.push(SimulatedWorks {
            case_id: ids[row].to_owned(),
            label: format!("{}, {symbol} = {}", named(&listed.label), labels[row]),
            names,
            works_j_m2: simulated_works(cases, row)?,
        });
    }
    let mut panels = Vec::new();
    for of in &chosen {
        if panels.len() < MOST_PANELS {
            panels.extend(works_over_cut_off(&cutoff, of, panels.len() + 1)?);
        }
    }
    Ok(Some(Works { cutoff, panels }))
}

/// Label of a case in a caption.
pub(super) fn named(label: &str) -> &str {
    if label == "reference" { "the reference case" } else { label }
}
