//! Discretization errors: the rule of an estimate, and for the report the table of grids and its figures.

use super::StageError;
use super::cycle_input::cycle_input;
use super::works::named;
use crate::campaign::{Campaign, CycleUnit};
use crate::figures::{OfGrids, over_grids};
use crate::physics::theory::grid_convergence::grid_error;
use crate::report::{Failure, Grids};
use crate::schema::GRIDS;
use crate::stats::{Given, GridEstimate, GridSeries, listing, loads, results};
use crate::store::Frame;
use crate::store::parquet::read_table;

/// Cases with a figure.
const MOST_PANELS: usize = 4;

/// Discretization error of the value on the finest of several grids, with the scatter of shifted copies.
pub(super) fn grid_rule(of: &GridSeries<'_>) -> Option<GridEstimate> {
    let found = grid_error(of.points, of.values).ok()?.with_scatter(of.copies, of.refinement);
    Some(GridEstimate { relative: found.relative, extrapolated: found.extrapolated })
}

/// Results of a finished cycle at each of its load reversals, with the load. Tables of results lack those of
/// coarser grids.
///
/// # Errors
/// If the tables of the cycle cannot be read.
pub fn cycle_results(campaign: &Campaign, unit: &CycleUnit) -> Result<Vec<(f64, Given)>, StageError> {
    Ok(results(&cycle_input(campaign, unit)?)?)
}

/// The table `grids` with a figure of each of the first cases, at its largest load; nothing if an earlier
/// version of the program wrote the statistics.
pub(super) fn grids(
    campaign: &Campaign,
    cases: &Frame,
    failures: Vec<Failure>,
) -> Result<Option<Grids>, StageError> {
    let path = campaign.statistics_path(GRIDS.name);
    if !path.is_file() {
        return Ok(None);
    }
    let table = read_table(&path, &GRIDS)?;
    let (ids, max_loads, loads) = (cases.text("case_id")?, cases.f64("max_load")?, loads(cases)?);
    let labels = loads.all_labels();
    let mut panels = Vec::new();
    for listed in listing(cases)?.rows {
        let row = listed.row;
        // The loads of a case ascend.
        let is_last = ids.iter().rposition(|id| *id == ids[row]) == Some(row);
        if !is_last || panels.len() == MOST_PANELS {
            continue;
        }
        let symbol = loads.symbol.replace(['{', '}'], "");
        let label = format!("{}, {symbol} = {}", named(&listed.label), labels[row]);
        let of = OfGrids { case_id: ids[row], max_load: max_loads[row], label: &label };
        panels.extend(over_grids(&table, &of, panels.len() + 1)?);
    }
    Ok(Some(Grids { table, panels, shifted_copies: campaign.spec.base.goal.shifted_copies, failures }))
}
