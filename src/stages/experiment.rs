//! Measured loops of a spec for the report, with a simulated loop.

use super::StageError;
use super::single_cycle::{Chosen, choose};
use crate::campaign::{Campaign, Standing};
use crate::figures::{Simulated, measured_loops};
use crate::model::Method;
use crate::report::MeasuredLoops;
use crate::schema;
use crate::store::Frame;
use crate::store::parquet::read_table;

/// The tables of the measured loops with their figure; nothing without `[experiment]`. The simulated loop is
/// that of the section of single cycles: by boundary elements, or else of the asperity model.
pub(super) fn beside(
    campaign: &Campaign,
    standings: &[Standing],
    cases: &Frame,
) -> Result<Option<MeasuredLoops>, StageError> {
    if campaign.spec.experiment.is_none() {
        return Ok(None);
    }
    let read = |table: &'static schema::Table| read_table(&campaign.statistics_path(table.name), table);
    let (loops, points) = (read(&schema::MEASURED_LOOPS)?, read(&schema::MEASURED_STEPS)?);
    let chosen = |method| choose(campaign, standings, cases, method, |_| true);
    let of = match chosen(Method::BoundaryElements)? {
        Some(found) => Some(found),
        None => chosen(Method::Asperities)?,
    };
    let Some(Chosen { unit, max_load, parameters, .. }) = of else {
        return Ok(Some(MeasuredLoops { panel: measured_loops(&points, None)?, loops }));
    };
    let steps = read_table(&campaign.cycle_dir(unit).join("steps.parquet"), &schema::STEPS)?;
    let simulated = Simulated { max_load, parameters: &parameters, steps: &steps };
    Ok(Some(MeasuredLoops { panel: measured_loops(&points, Some(&simulated))?, loops }))
}
