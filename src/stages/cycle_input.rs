//! Input of the aggregation: the rows of estimates of a cycle and its surface.

use super::StageError;
use super::extent::own_columns;
use super::surface_row::SurfaceRow;
use crate::campaign::{Campaign, CycleUnit};
use crate::schema::{
    Column, DENG_KESARI, DENG_KESARI_PROBE, DENG_KESARI_PROBE_REALISED, DENG_KESARI_REALISED, ESTIMATES,
    OF_CYCLE, OF_LOAD, OF_SURFACE,
};
use crate::stats::{CycleInput, Given, Value};
use crate::store::{ColumnData, Frame, FrameError, parquet};

/// Columns of a failed cycle that depend on its surface alone.
const OF_FAILED: [&str; 6] = [
    "summit_count",
    "filter_overshoot",
    "outlier_share",
    "line_jump_share",
    "noise_share",
    "curvature_ratio",
];

/// Columns of a failed cycle that depend on its surface and the material alone: those of its failure record,
/// and those of its surface if that could be made.
pub(super) fn of_failed(campaign: &Campaign, unit: &CycleUnit) -> Given {
    let mut columns: Given =
        campaign.failure_estimates(unit).into_iter().map(|(name, value)| (name, value.into())).collect();
    let row = SurfaceRow::read(campaign, &campaign.surfaces[unit.surface]).ok();
    let of_surface = row.and_then(|row| given(&row.0, OF_SURFACE, 0).ok()).unwrap_or_default();
    columns.extend(of_surface.into_iter().filter(|(name, _)| OF_FAILED.contains(&name.as_str())));
    columns
}

/// Input of the aggregation from a finished cycle.
pub(super) fn cycle_input(campaign: &Campaign, unit: &CycleUnit) -> Result<CycleInput, StageError> {
    let (case, surface) = (&campaign.cases[unit.case], &campaign.surfaces[unit.surface]);
    let folder = campaign.cycle_dir(unit);
    let estimates = parquet::read_table(&folder.join("estimates.parquet"), &ESTIMATES)?;
    let slips = case.case.params.slips();
    let errata = usize::from(slips.a2) + 2 * usize::from(slips.a3);
    let deng_kesari = |columns: &[Column; 4]| {
        estimates.f64_or_null(columns[errata].name).map(|values| values.first().copied().flatten())
    };
    let loads = estimates.f64("max_load")?;
    let at_load = |(row, load): (usize, &f64)| {
        let mut columns = given(&estimates, OF_LOAD, row)?;
        columns.push(("resolution_j".to_owned(), estimates.f64_or_null("resolution_j")?[row].into()));
        Ok((*load, columns))
    };
    let mut of_surface = given(&estimates, OF_CYCLE, 0)?;
    of_surface.extend(given(&SurfaceRow::read(campaign, surface)?.0, OF_SURFACE, 0)?);
    of_surface.extend(own_columns(campaign, unit)?);
    Ok(CycleInput {
        case_id: case.id.clone(),
        realization: i64::from(unit.realization),
        cycle_id: unit.id.clone(),
        surface_id: surface.id.clone(),
        steps: folder.join("steps.parquet"),
        events: folder.join("events.parquet"),
        energy_scale_j: estimates.first_f64("energy_scale_j")?,
        loss_dk_per_area_j: deng_kesari(&DENG_KESARI)?,
        loss_dk_realised_per_area_j: deng_kesari(&DENG_KESARI_REALISED)?,
        loss_dk_probe_per_area_j: deng_kesari(&DENG_KESARI_PROBE)?,
        loss_dk_probe_realised_per_area_j: deng_kesari(&DENG_KESARI_PROBE_REALISED)?,
        loss_dalvi_per_area_j: estimates.first_f64("loss_dalvi_nominal_j")?,
        loss_pinning_per_area_j: estimates.f64_or_null("loss_pinning_nominal_j")?.first().copied().flatten(),
        at_max_load: loads.iter().enumerate().map(at_load).collect::<Result<_, FrameError>>()?,
        surface: of_surface,
    })
}

/// Values of columns in a row.
fn given(frame: &Frame, columns: &[Column], row: usize) -> Result<Given, FrameError> {
    let value = |column: &Column| {
        let value: Value = match frame.column(column.name)? {
            ColumnData::F64(values) => values.get(row).copied().flatten().into(),
            ColumnData::I64(values) => values.get(row).copied().flatten().into(),
            ColumnData::Text(_) | ColumnData::Bool(_) => Value::Missing,
        };
        Ok((column.name.to_owned(), value))
    };
    columns.iter().map(value).collect()
}
