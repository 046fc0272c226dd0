//! Part of the report: a single cycle of each method.

use super::layout::{Numbers, figure, grid, heading, plain, prose};
use crate::figures::{Drawing, Panel};
use maud::{Markup, html};

/// Figures of one cycle.
#[derive(Debug, Clone)]
pub struct SingleCycle {
    /// Identifier of the cycle.
    pub id: String,
    /// Number of its surface.
    pub realization: u32,
    /// The case among others, as in "The case with the largest mean".
    pub choice: String,
    /// Files of the cycle, as a sentence.
    pub files: &'static str,
    /// Parameters of the case, with the load reversal.
    pub parameters: String,
    /// Panels.
    pub panels: Vec<Panel>,
    /// Maps of the contact, if these are stored.
    pub map: Option<Drawing>,
}

/// The section of the report.
pub(super) fn section(numbers: &Numbers<'_>, cycles: &[SingleCycle]) -> Markup {
    html! {
        (heading("Single cycle"))
        @for cycle in cycles {
            p {
                (prose(&cycle.choice)) ": " (plain(&cycle.parameters)) ". Cycle " (cycle.id) ", realization "
                (cycle.realization)
                ". " (prose(cycle.files))
            }
            "\n"
            (grid(numbers, &cycle.panels))
            @if let Some(map) = &cycle.map { (figure(numbers, map)) }
        }
    }
}
