//! Grids of boundary elements before a run.

use crate::campaign::Campaign;
use crate::text::wrapped;

/// A warning if a spec without boundary elements lists grids; empty otherwise.
pub(super) fn text(campaign: &Campaign) -> String {
    let [_, by_elements] = campaign.case_counts();
    if campaign.spec.coarser_points.is_empty() || by_elements > 0 {
        return String::new();
    }
    let text = "warning: no case uses boundary elements: the list `boundary_elements.points` has no effect. \
         Set `model.method` to `\"boundary_elements\"`, or remove the list.";
    wrapped(text, "  ")
}
