//! Reasons of pending tasks as text.

use crate::campaign::{Campaign, Reasons, Stage, Standing};
use crate::text::{visible, wrapped};

/// A line for each reason why tasks of a stage are pending; nothing where no task is finished.
pub(super) fn causes(campaign: &Campaign, stage: Stage, units: &[(String, Standing)]) -> String {
    let is_pending = |standing: &Standing| matches!(standing, Standing::Planned | Standing::Stale);
    let pending: Vec<&str> =
        units.iter().filter(|(_, standing)| is_pending(standing)).map(|(id, _)| id.as_str()).collect();
    let Reasons { reasons, compared } = campaign.reasons(stage, &pending);
    let first = if pending.len() > compared { format!(" of the first {compared}") } else { String::new() };
    let line = |(reason, count): &(String, usize)| {
        wrapped(&format!("  {count} to run{first}: {}", visible(reason)), "    ")
    };
    reasons.iter().map(line).collect()
}
