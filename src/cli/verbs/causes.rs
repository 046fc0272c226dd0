//! Reasons of pending tasks: the parameters in which they differ from the nearest finished task.

use crate::campaign::{Campaign, Difference, Stage, Standing};
use crate::text::{counted, visible, wrapped};
use serde_json::Value;
use std::collections::BTreeMap;

/// Tasks of a stage that are compared with finished ones.
const COMPARED: usize = 10;

/// Records that are read at most for the tasks of a stage: each task is compared with all finished ones.
const READ: usize = 20_000;

/// A line for each set of parameters in which pending tasks of a stage differ from finished ones of another spec; nothing where no task is finished.
pub(super) fn causes(campaign: &Campaign, stage: Stage, units: &[(String, Standing)]) -> String {
    let finished = std::fs::read_dir(campaign.receipts_dir(stage)).map_or(0, Iterator::count);
    let pending = || units.iter().filter(|(_, standing)| matches!(standing, Standing::Planned | Standing::Stale));
    if finished == 0 || !matches!(stage, Stage::Generate | Stage::Extract | Stage::Cycle) {
        return String::new();
    }
    let compared = COMPARED.min(READ / finished).max(1);
    let mut causes: BTreeMap<String, usize> = BTreeMap::new();
    for (id, _) in pending().take(compared) {
        let explained = campaign.explain(id).into_iter().find(|explanation| explanation.stage == stage.word());
        let cause = match explained {
            Some(explanation) if !explanation.differences.is_empty() => {
                explanation.differences.iter().map(change).collect::<Vec<_>>().join(", ")
            }
            Some(explanation) if explanation.nearest.is_none() => "not computed yet".to_owned(),
            _ => continue,
        };
        *causes.entry(cause).or_default() += 1;
    }
    let all = pending().count();
    let first = if all > compared { format!(" of the first {compared}") } else { String::new() };
    let line =
        |(cause, count): (&String, &usize)| wrapped(&format!("  {}{first}: {}", counted(*count, "pending task"), visible(cause)), "    ");
    causes.iter().map(line).collect()
}

/// A difference as existing and requested value.
fn change(difference: &Difference) -> String {
    let value = |value: &Option<Value>| value.as_ref().map_or_else(|| "none".to_owned(), ToString::to_string);
    format!("{} {} → {}", difference.field, value(&difference.there), value(&difference.here))
}
