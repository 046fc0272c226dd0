//! Grids of boundary elements before a run and in its status.

use super::{Fault, failed};
use crate::campaign::Campaign;
use crate::spec::GridGoal;
use crate::stages::above_error;
use crate::stats::{grid_percent, significant};
use crate::text::wrapped;

/// The rule for grids with a required grid error, or a warning if a spec without boundary elements has one or
/// lists grids; empty otherwise.
pub(super) fn text(campaign: &Campaign) -> String {
    let [_, by_elements] = campaign.case_counts();
    let (spec, GridGoal { error, max_points, .. }) = (&campaign.spec, campaign.spec.base.goal);
    let key = match error {
        Some(_) => "boundary_elements.error",
        None if spec.coarser_points.is_empty() => return String::new(),
        None => "a list of grids in [boundary_elements]",
    };
    if by_elements == 0 {
        let text = format!(
            "warning: no case uses boundary elements: {key} has no effect. Set `model.method` to \
             `\"boundary_elements\"`, or remove it."
        );
        return wrapped(&text, "  ");
    }
    error.map_or_else(String::new, |error| {
        let text = format!(
            "{:10}doubled for each case until the grid error of Θ is at most {}, up to {max_points} points a \
             side",
            "grids",
            percent(error)
        );
        wrapped(&text, "          ")
    })
}

/// Cases whose grid error remains above the required one, one line for each.
pub(super) fn above(campaign: &Campaign) -> Result<String, Fault> {
    let Some(wanted) = campaign.spec.base.goal.error else { return Ok(String::new()) };
    let of_cases = above_error(campaign).map_err(failed)?;
    let line = |of: &crate::stages::AboveError| {
        let error = of.error.map_or_else(|| "unknown".to_owned(), grid_percent);
        let text = format!(
            "  {}: grid error of Θ {error} on {}, above the requested {}",
            of.case_id,
            of.grid,
            percent(wanted)
        );
        wrapped(&text, "    ")
    };
    Ok(of_cases.iter().map(line).collect())
}

fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 2))
}
