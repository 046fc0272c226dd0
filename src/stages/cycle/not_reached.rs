//! Load reversals of a finished cycle that have no result: `not_reached.json` in the folder of the cycle.

use super::super::{StageError, Watch};
use crate::campaign::{Campaign, CycleUnit};
use crate::store::commit::{Written, commit_bytes};
use serde_json::json;

/// Records loads without a result, with their errors, and prints them; nothing where all loads have one.
pub(super) fn record(
    campaign: &Campaign,
    unit: &CycleUnit,
    unreached: &[(f64, String)],
    watch: &dyn Watch,
) -> Result<Option<Written>, StageError> {
    if unreached.is_empty() {
        return Ok(None);
    }
    for (max_load, error) in unreached {
        watch.notice(&format!("{}: no result at F_max/(E* A0) = {max_load}: {error}", unit.id));
    }
    let loads: Vec<_> =
        unreached.iter().map(|(max_load, error)| json!({ "max_load": max_load, "error": error })).collect();
    let record = json!({ "key": unit.key, "status": "not reached", "loads": loads });
    let path = campaign.not_reached_path(unit);
    Ok(Some(commit_bytes(
        "record the loads that are not reached",
        &path,
        format!("{record:#}\n").as_bytes(),
    )?))
}
