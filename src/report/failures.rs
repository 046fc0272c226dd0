//! Part of the report: failed cycles with their reasons and the next step.

use super::layout::{plain, prose};
use crate::text::counted;
use maud::{Markup, html};

/// Reasons that the banner lists.
const LISTED: usize = 5;

/// Failed cycles with one reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// Identifier of the first cycle.
    pub example: String,
    /// Number of cycles.
    pub count: usize,
    /// Problem.
    pub problem: String,
    /// Recommended action.
    pub help: String,
}

/// Red banner with the reasons of failed cycles; empty without one. `all` is the number of planned cycles.
pub(super) fn failures(failures: &[Failure], all: usize) -> Markup {
    let failed: usize = failures.iter().map(|of| of.count).sum();
    if failed == 0 {
        return Markup::default();
    }
    let verdict = if failed == all {
        format!(
            "No results: {} failed.",
            if all == 1 { "the cycle".to_owned() } else { format!("all {all} cycles") }
        )
    } else {
        format!("{} of {} failed.", failed, counted(all, "cycle"))
    };
    html! {
        div.banner.red role="alert" {
            p { b { (verdict) } }
            @for of in failures.iter().take(LISTED) {
                p {
                    @if of.count > 1 {
                        (counted(of.count, "cycle")) ", for example " (of.example) ": "
                    } @else {
                        (of.example) ": "
                    }
                    (plain(&of.problem)) "."
                }
                @if !of.help.is_empty() { p { b { "Next step: " } (prose(&of.help)) "." } }
            }
            @if failures.len() > LISTED {
                p {
                    "… and " (counted(failures.len() - LISTED, "other reason")) ": see "
                    code { "statistics/cycles.parquet" } "."
                }
            }
            p { "Change the spec and run it again: finished cycles are kept. Without a change, a cycle fails \
                 again." }
        }
        "\n"
    }
}
