//! Page of a comparison of finished runs.

use super::layout::{Numbers, document, grid, heading, legend, prose, wide};
use super::numbers::{Shown, shown};
use crate::figures::Panel;
use crate::spec::FORMATS;
use crate::stats::{Matched, Side, StatsError};
use crate::store::Frame;
use maud::{Markup, html};

/// Content of the page of a comparison.
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// The runs; the first is the reference.
    pub sides: &'a [Side],
    /// The cases that all runs have.
    pub matched: &'a Matched,
    /// Names of the groups of cases.
    pub names: &'a [String],
    /// Panels of each group.
    pub drawings: &'a [(String, Vec<Panel>)],
    /// The table of the comparison.
    pub table: &'a Frame,
}

/// The page as HTML.
///
/// # Errors
/// If the table lacks a column.
pub fn comparison_page(of: &Compared<'_>) -> Result<String, StatsError> {
    let labels: Vec<&str> = of.sides.iter().map(|side| side.label.as_str()).collect();
    let title = format!("Comparison of {}", labels.join(", "));
    let reference = labels.first().copied().unwrap_or_default();
    let head = html! {
        th { "case" } th { "quantity" } th { "run" } th { "mean" } th { "mean of " (reference) }
        th { "difference" } th { "relative difference" } th { "realizations" }
    };
    let numbers = Numbers::of(&FORMATS);
    let body = html! {
        h1 { (title) } "\n"
        p { (note(of, &labels)) } "\n"
        (wide("comparison", &head, &rows(of)?))
        p { (prose("Differences larger than their half-width are bold. Data: `comparison.parquet`.")) } "\n"
        @for (name, panels) in of.drawings {
            (heading(name))
            section { (legend(panels.first().map_or(&[], |panel| &panel.cases))) (grid(&numbers, panels)) }
        }
    };
    Ok(document(&title, None, &body))
}

fn note(of: &Compared<'_>, labels: &[&str]) -> Markup {
    let differing = if of.matched.differing.is_empty() {
        "the realizations only".to_owned()
    } else {
        of.matched.differing.join(", ")
    };
    let left = labels.iter().zip(&of.matched.left_over).filter(|(_, count)| **count > 0);
    let left: Vec<String> = left.map(|(label, count)| format!("{count} of {label}")).collect();
    html! {
        "The runs differ in " (differing) ". Reference: " (labels.first().copied().unwrap_or_default())
        ". Cases with otherwise equal parameters are compared."
        @if !left.is_empty() { " Cases without a counterpart are omitted: " (left.join(", ")) "." }
        " Quantities are means over realizations. Parentheses: half-width of the 95 % confidence interval of \
         the difference, surface by surface where both runs have the same surfaces, otherwise of two \
         independent means (Welch)."
    }
}

fn rows(of: &Compared<'_>) -> Result<Vec<Markup>, StatsError> {
    let table = of.table;
    let (groups, campaigns, quantities) =
        (table.i64("group")?, table.text("campaign")?, table.text("quantity")?);
    let (means, references, differences) =
        (table.f64("mean")?, table.f64("reference_mean")?, table.f64("difference")?);
    let (intervals, shares) =
        (table.f64_or_null("difference_ci95")?, table.f64_or_null("relative_difference")?);
    let (paired, counts, others) =
        (table.bool("paired")?, table.i64("realization_count")?, table.i64("reference_realization_count")?);
    let number = |value: f64| shown(Some(value), Shown::Plain);
    let row = |row: usize| {
        // Significant at the 95 % level.
        let clear = intervals[row].is_some_and(|half| differences[row].abs() > half);
        html! {
            td { (of.names[groups[row] as usize]) }
            td { (quantity(quantities[row])) }
            td { (campaigns[row]) }
            td { (number(means[row])) }
            td { (number(references[row])) }
            td class=[clear.then_some("clear")] {
                (number(differences[row])) @if let Some(half) = intervals[row] { " (±" (number(half)) ")" }
            }
            td { (shown(shares[row], Shown::Percent)) }
            td { (counts[row]) @if paired[row] { " pairs" } @else { " and " (others[row]) } }
        }
    };
    Ok((0..table.row_count()).map(row).collect())
}

/// Symbol and column of a compared quantity.
fn quantity(column: &str) -> Markup {
    let symbol = match column {
        "area_at_max_load" => "A/A_{0}",
        "penetration_at_max_load" => "Δ/h_{rms}",
        "pull_off_load" => "F_{po}/(E*A_{0})",
        "loss" => "Θ/(E*A_{0}h_{rms})",
        "loss_ratio_dk" => "Θ/Θ_{DK}",
        _ => return html! { (column) },
    };
    html! { (prose(symbol)) " (" code { (column) } ")" }
}
