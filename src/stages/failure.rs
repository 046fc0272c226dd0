//! Failures: a record in the folder of the missing cycle, and tasks that are not tried again.

use super::estimates::of_failed;
use super::{StageError, Watch};
use crate::campaign::{Campaign, CycleUnit, Stage, Unit};
use crate::store::{caught, commit};
use crate::text::shell_path;
use serde_json::{Value, json};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// True if an error is one case's own: the others go on. What the system says of a file (a full disk) is not.
pub(super) fn is_of_a_case(error: &StageError) -> bool {
    matches!(
        error,
        StageError::Physics(_)
            | StageError::Measured { .. }
            | StageError::Scan(_)
            | StageError::Frame(_)
            | StageError::InTheWay { .. }
            | StageError::TooManySteps { .. }
            | StageError::Range { .. }
            | StageError::Defect { .. }
    )
}

/// Runs a task and gives a panic as its error: a defect ends one task, not the run.
pub(super) fn fenced<T>(task: impl FnOnce() -> Result<T, StageError>) -> Result<T, StageError> {
    caught(task, |panic| StageError::Defect { what: panic.to_owned() })
}

/// Refuses a task whose files cannot be put in place, before it is computed: a folder has the name of one, or
/// a file that of their folder.
pub(super) fn in_the_way(campaign: &Campaign, task: &Unit<'_>) -> Result<(), StageError> {
    let file = |folder: &str, ending: &str| campaign.dir.join(folder).join(format!("{}.{ending}", task.id));
    let mut files = vec![campaign.receipt_path(task)];
    match task.stage {
        Stage::Generate => files.push(file("surfaces", "h5")),
        Stage::Extract => {
            files.extend(["asperities", "estimates", "spectra"].map(|folder| file(folder, "parquet")));
        }
        Stage::Cycle => {
            let folder = campaign.dir.join("cycles").join(task.id);
            if std::fs::symlink_metadata(&folder).is_ok() && !folder.is_dir() {
                return Err(StageError::InTheWay { path: folder, what: "a file" });
            }
            let inside = std::fs::read_dir(&folder)
                .map(|all| all.flatten().map(|entry| entry.path()).collect::<Vec<PathBuf>>());
            files.extend(
                inside.unwrap_or_default().into_iter().filter(|path| {
                    path.extension().is_some_and(|e| e == "parquet" || e == "h5" || e == "bin")
                }),
            );
        }
        Stage::Aggregate | Stage::Report => {}
    }
    match files.into_iter().find(|path| path.is_dir()) {
        Some(path) => Err(StageError::InTheWay { path, what: "a folder" }),
        None => Ok(()),
    }
}

/// Prints and records that a task failed by an error of its own, in the place of every cycle that needs it.
pub(super) fn report(
    campaign: &Campaign,
    id: &str,
    cycles: &[&CycleUnit],
    stage: Stage,
    error: &StageError,
    watch: &dyn Watch,
) -> Result<(), StageError> {
    if !is_of_a_case(error) {
        return Ok(());
    }
    let own = cycles.iter().find(|cycle| cycle.id == id);
    let name = own.map_or_else(|| id.to_owned(), |cycle| campaign.name_of(cycle));
    watch.notice(&format!("{name} failed: {error}"));
    for cycle in cycles {
        match record(campaign, cycle, stage, error) {
            Err(why @ StageError::InTheWay { .. }) => {
                watch.notice(&format!("{}: cannot record the failure: {why}", cycle.id));
            }
            recorded => recorded?,
        }
    }
    Ok(())
}

/// Records that a cycle failed, at which stage and why, with the estimates of its surface and material. Of a
/// folder in the way it also records the place, since without the folder nothing has failed.
fn record(campaign: &Campaign, unit: &CycleUnit, stage: Stage, error: &StageError) -> Result<(), StageError> {
    in_the_way(campaign, &unit.cycle()).or_else(|why| match &why {
        StageError::InTheWay { path, .. } if *path != campaign.cycle_dir(unit) => Ok(()),
        _ => Err(why),
    })?;
    let file = campaign.failure_path(unit);
    if file.is_dir() {
        return Err(StageError::InTheWay { path: file, what: "a folder" });
    }
    let again = format!("hysteron retry {} {}", shell_path(&campaign.dir), unit.id);
    let mut record =
        json!({ "key": unit.key, "stage": stage.word(), "error": error.to_string(), "again": again });
    // As text, which is read without rounding.
    record["estimates"] = of_failed(campaign, unit)
        .into_iter()
        .map(|(name, value)| (name.to_owned(), Value::from(value.to_string())))
        .collect();
    if let StageError::InTheWay { path, .. } = error {
        let place: &Path = path.strip_prefix(&campaign.dir).unwrap_or(path);
        record["in_the_way"] = place.to_string_lossy().into();
    }
    let path = campaign.cycle_dir(unit);
    std::fs::create_dir_all(&path).map_err(|source| StageError::Folder { path, source })?;
    commit::commit_bytes("record a failed case", &file, format!("{record:#}\n").as_bytes())?;
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

/// True if a stage is not tried for a surface: for all of its
/// `cycles` it failed before and is not to be `retried`, or an earlier one did.
pub(super) fn given_up(
    campaign: &Campaign,
    cycles: &[&CycleUnit],
    stage: Stage,
    retried: &HashSet<String>,
) -> bool {
    let failed = |cycle: &&CycleUnit| match campaign.failed_at(cycle) {
        Some(at) if at == stage => !retried.contains(&cycle.id),
        Some(at) => at < stage,
        None => false,
    };
    !cycles.is_empty() && cycles.iter().all(failed)
}

/// Removes the record of a failure at a stage that has been done since.
pub(super) fn forget(campaign: &Campaign, cycles: &[&CycleUnit], stage: Stage) {
    for cycle in cycles.iter().filter(|cycle| campaign.failed_at(cycle) == Some(stage)) {
        let _ = std::fs::remove_file(campaign.failure_path(cycle));
    }
}

#[cfg(test)]
mod tests {
    use super::{StageError, fenced, is_of_a_case};

    #[test]
    fn val_a_panic_is_the_error_of_its_task() {
        let outcome = fenced(|| -> Result<(), StageError> { panic!("no such column {}", 3) });
        assert!(outcome.as_ref().is_err_and(is_of_a_case));
        let text = outcome.map_err(|error| error.to_string());
        assert_eq!(
            text,
            Err("internal error: no such column 3\nhelp: report this with the spec; the other tasks go on"
                .to_owned())
        );
        assert!(fenced(|| Ok(2)).is_ok_and(|value| value == 2));
    }
}
