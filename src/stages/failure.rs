//! What failed: a record in the place of the cycle that is not there, and what is not tried again for it.

use super::StageError;
use crate::campaign::{Campaign, CycleUnit, Stage};
use crate::store::commit;
use serde_json::json;
use std::collections::{HashMap, HashSet};

/// Whether an error is one case's own: the others go on.
pub(super) fn is_of_a_case(error: &StageError) -> bool {
    matches!(error, StageError::Physics(_) | StageError::Measured { .. } | StageError::Scan(_))
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

/// The cycles of each surface, by its id.
pub(super) fn by_surface(campaign: &Campaign) -> HashMap<&str, Vec<&CycleUnit>> {
    let mut found: HashMap<&str, Vec<&CycleUnit>> = HashMap::new();
    for cycle in &campaign.cycles {
        found.entry(&campaign.surfaces[cycle.surface].id).or_default().push(cycle);
    }
    found
}

/// Whether a stage is not tried for a surface: for all of its `cycles` it failed before and is not to be `retried`, or an earlier one did.
pub(super) fn given_up(campaign: &Campaign, cycles: &[&CycleUnit], stage: Stage, retried: &HashSet<String>) -> bool {
    let failed = |cycle: &&CycleUnit| match campaign.failed_at(cycle) {
        Some(at) if at == stage => !retried.contains(&cycle.id),
        Some(at) => at < stage,
        None => false,
    };
    !cycles.is_empty() && cycles.iter().all(failed)
}

/// What is recorded of a failure at a stage that has been done since is taken away.
pub(super) fn forget(campaign: &Campaign, cycles: &[&CycleUnit], stage: Stage) {
    for cycle in cycles.iter().filter(|cycle| campaign.failed_at(cycle) == Some(stage)) {
        let _ = std::fs::remove_file(campaign.failure_path(cycle));
    }
}
