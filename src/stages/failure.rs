//! What failed: a record in the place of the cycle that is not there, and what is not tried again for it.

use super::StageError;
use crate::campaign::{Campaign, CycleUnit, Stage, SurfaceUnit};
use crate::store::commit;
use serde_json::json;
use std::collections::{HashMap, HashSet};

/// Whether an error is one case's own: the others go on.
pub(super) fn is_of_a_case(error: &StageError) -> bool {
    matches!(error, StageError::Physics(_) | StageError::Measured { .. })
}

/// Records that a cycle failed, at which stage and why.
pub(super) fn record(campaign: &Campaign, unit: &CycleUnit, stage: Stage, error: &StageError) -> Result<(), StageError> {
    let again = format!("hysteron retry {} {}", campaign.dir.display(), unit.id);
    let record = json!({ "key": unit.key, "stage": stage.word(), "error": error.to_string(), "again": again });
    let path = campaign.cycle_dir(unit);
    std::fs::create_dir_all(&path).map_err(|source| StageError::Folder { path, source })?;
    commit::commit_bytes("record a failed case", &campaign.failure_path(unit), format!("{record:#}\n").as_bytes())?;
    Ok(())
}

/// The cycles of a surface.
pub(super) fn cycles_of<'a>(campaign: &'a Campaign, surface: &'a SurfaceUnit) -> impl Iterator<Item = &'a CycleUnit> {
    campaign.cycles.iter().filter(|cycle| campaign.surfaces[cycle.surface].id == surface.id)
}

/// Which of these surfaces are not tried again: what should have been made of each failed before its cycles, and none of them is to be `retried`.
pub(super) fn given_up(campaign: &Campaign, surfaces: &[&SurfaceUnit], retried: &HashSet<String>) -> HashSet<String> {
    let mut failed: HashMap<&str, Option<bool>> = surfaces.iter().map(|surface| (surface.id.as_str(), None)).collect();
    for cycle in &campaign.cycles {
        let Some(all) = failed.get_mut(campaign.surfaces[cycle.surface].id.as_str()) else { continue };
        if *all != Some(false) {
            let before = campaign.failed_at(cycle).is_some_and(|stage| stage < Stage::Cycle);
            *all = Some(before && !retried.contains(&cycle.id));
        }
    }
    failed.into_iter().filter(|(_, all)| *all == Some(true)).map(|(id, _)| id.to_owned()).collect()
}
