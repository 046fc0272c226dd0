//! Parts of the report: energy budget, model validity and warnings.

use super::cases::Cases;
use super::layout::{heading, plain, prose, unbroken};
use super::numbers::{Shown, scaled, shown, with_aside};
use crate::model::{Choice as _, Method};
use crate::schema::EventKind;
use crate::stats::{LIMITS, Limit, Listed, StatsError, Warning, warnings};
use maud::{Markup, html};

/// The table of model validity: heading, the column that is compared with a limit, and the column shown in
/// parentheses.
const VALIDITY: [(&str, &str, Option<&str>, Shown); 10] = [
    ("Tabor parameter μ: minimum (mean)", "tabor_min_min", Some("tabor_mean_mean"), Shown::Plain),
    ("asperities with μ < 2", "low_tabor_share_mean", None, Shown::Percent),
    ("asperities per surface: mean (minimum)", "summit_count_mean", Some("summit_count_min"), Shown::Plain),
    (
        "contacts at F_{max}: mean (minimum)",
        "contact_count_at_max_load_mean",
        Some("contact_count_at_max_load_min"),
        Shown::Plain,
    ),
    (
        "overlapping contacts: pooled (maximum)",
        "touching_share_mean",
        Some("touching_share_max"),
        Shown::Percent,
    ),
    (
        "absorbed asperities: pooled (maximum)",
        "covered_share_mean",
        Some("covered_share_max"),
        Shown::Percent,
    ),
    ("texture aspect ratio: maximum (mean)", "texture_aspect_max", Some("texture_aspect_mean"), Shown::Plain),
    ("A/A_{0}", "area_at_max_load_mean", None, Shown::Percent),
    (
        "U_{el}/Δγ of the shortest octave: realised (target)",
        "conformity_realised_mean",
        Some("conformity_mean"),
        Shown::Plain,
    ),
    (
        "U_{el}/Δγ: realised (target)",
        "persson_tosatti_realised_mean",
        Some("persson_tosatti_mean"),
        Shown::Plain,
    ),
];

const BUDGET_NOTE: &str = "Θ is the area of the loop. The energies of all events sum to the same value if \
    the energy balance is exact; the energy-balance error is the difference over Θ. Both are over \
    E*A_{0}h_{rms}. The percentages are fractions of the sum over events: by branch, and by the kind of \
    event that triggers each relaxation.";

const ABSORPTION_NOTE: &str =
    " Absorption and release have no potential, so their fractions may be negative.";

/// The energy budget: fractions by branch and by kind of event. Kinds without dissipated energy in all cases
/// have no column.
pub(super) fn budget(cases: &Cases<'_>) -> Result<Markup, StatsError> {
    let mut kinds = Vec::new();
    for kind in EventKind::ALL {
        let all = cases.frame.f64_or_null(&format!("dissipated_{}_mean", kind.word()))?;
        if all.iter().flatten().any(|mean| *mean != 0.0) {
            kinds.push(kind);
        }
    }
    let factor = cases.scale("loss")?.head();
    let head = html! {
        (cases.name_heads())
        th { "Θ" (factor) }
        th { "sum over events" (factor) }
        th { "energy-balance error: maximum (mean)" (bound("audit_gap_max", Shown::Percent)) }
        th { "loading" }
        th { "unloading" }
        @for kind in &kinds { th { (kind.name()) } }
    };
    let rows = cases
        .rows()
        .iter()
        .map(|listed| Ok((listed.row, budget_row(cases, listed, &kinds)?)))
        .collect::<Result<Vec<_>, StatsError>>()?;
    Ok(html! {
        (heading("Energy budget"))
        p { (prose(BUDGET_NOTE)) @if cases.has_spots()? { (ABSORPTION_NOTE) } } "\n"
        (cases.wide("energy", &head, rows))
    })
}

fn budget_row(cases: &Cases<'_>, listed: &Listed, kinds: &[EventKind]) -> Result<Markup, StatsError> {
    let row = listed.row;
    let mean = |column: &str| cases.number(&format!("{column}_mean"), row);
    let (scale, loss, whole) = (cases.scale("loss")?, mean("loss")?, mean("dissipated")?);
    let gap = with_aside(cases.number("audit_gap_max", row)?, mean("audit_gap")?, Shown::Percent);
    let share = |part: &str| -> Result<Option<f64>, StatsError> {
        let part = mean(&format!("dissipated_{part}"))?;
        Ok(part.zip(whole.filter(|whole| *whole != 0.0)).map(|(part, whole)| part / whole))
    };
    let shares = ["loading", "unloading"]
        .into_iter()
        .chain(kinds.iter().map(|kind| kind.word()))
        .map(share)
        .collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        (cases.name(listed))
        td { (scaled(loss, scale)) }
        td { (scaled(whole, scale)) }
        (cell(cases, row, "audit_gap_max", &gap))
        @for share in shares { td { (shown(share, Shown::Percent)) } }
    })
}

/// Columns of the asperity model.
const OF_SPOTS: [&str; 5] = [
    "tabor_min_min",
    "low_tabor_share_mean",
    "summit_count_mean",
    "touching_share_mean",
    "covered_share_mean",
];

const RANGE_NOTE: &str = "An asperity model is outside its range where contacts coalesce: it then \
    underestimates the contact area of a boundary-element solution by a third, even without adhesion.";

const VALIDITY_NOTE: &str = "Numbers beyond their limit are bold. U_{el} is the elastic energy per area \
    that flattens the roughness, Δγ the work of adhesion: for the realised spectrum of the surfaces, and in \
    brackets for the target spectrum.";

/// The indicators of model validity with their limits, and the warnings.
pub(super) fn validity(cases: &Cases<'_>) -> Result<Markup, StatsError> {
    let has_spots = cases.has_spots()?;
    let columns =
        || VALIDITY.into_iter().filter(move |(_, column, ..)| has_spots || !OF_SPOTS.contains(column));
    let head = html! {
        (cases.name_heads())
        @for (heading, column, _, format) in columns() { th { (prose(heading)) (bound(column, format)) } }
    };
    let methods = cases.frame.text("method")?;
    let is_of_spots = |row: usize| methods[row] == Method::Asperities.word();
    let row = |listed: &Listed| -> Result<(usize, Markup), StatsError> {
        let mut cells = Vec::new();
        for (_, column, aside, format) in columns() {
            if OF_SPOTS.contains(&column) && !is_of_spots(listed.row) {
                cells.push(html! { td { "–" } });
                continue;
            }
            let aside = aside.map(|column| cases.number(column, listed.row)).transpose()?.flatten();
            cells.push(cell(
                cases,
                listed.row,
                column,
                &with_aside(cases.number(column, listed.row)?, aside, format),
            ));
        }
        Ok((listed.row, html! { (cases.name(listed)) @for cell in cells { (cell) } }))
    };
    let rows = cases.rows().iter().map(row).collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        (heading("Model validity"))
        p { @if has_spots { (prose(RANGE_NOTE)) " " } (prose(VALIDITY_NOTE)) } "\n"
        (cases.wide("validity", &head, rows))
        (warning_table(cases)?)
    })
}

/// Every warning with its measured values, consequence, action and rows.
fn warning_table(cases: &Cases<'_>) -> Result<Markup, StatsError> {
    let found = warnings(cases.frame)?;
    Ok(html! {
        (heading("Warnings"))
        @if found.is_empty() {
            p { "None." } "\n"
        } @else {
            div.scroll role="region" aria-label="Table of warnings" tabindex="0" { table {
                "\n"
                thead {
                    tr {
                        th { "warning (code)" } th { "measured" } th { "consequence and action" }
                        th { "cases, at " (prose(cases.load_symbol())) }
                    }
                } "\n"
                tbody {
                @for Warning { kind, measured, rows } in &found {
                    tr {
                        td { (kind.label) " (" (kind.code) ")" }
                        td { (plain(measured)) }
                        td { (plain(kind.consequence)) " " (plain(kind.action)) }
                        td { (places(cases, rows)) }
                    }
                    "\n"
                }
                }
            } }
            "\n"
        }
    })
}

/// Cases that a warning lists; of more, it states the number.
const MOST_PLACES: usize = 6;

/// The rows of a warning.
fn places(cases: &Cases<'_>, rows: &[usize]) -> Markup {
    if rows.len() == cases.rows().len() {
        return html! { "all" };
    }
    // The loads of one label together.
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    for listed in cases.rows().iter().filter(|listed| rows.contains(&listed.row)) {
        match groups.iter_mut().find(|(label, _)| *label == listed.label) {
            Some((_, loads)) => loads.push(cases.load(listed.row)),
            None => groups.push((&listed.label, vec![cases.load(listed.row)])),
        }
    }
    let list = html! {
        @for (place, (label, loads)) in groups.iter().enumerate() {
            @if place > 0 { br; } (unbroken(label)) " at\u{a0}" (unbroken(&loads.join(", ")))
        }
    };
    html! {
        @if groups.len() > MOST_PLACES {
            details { summary { (rows.len()) " of " (cases.rows().len()) " rows" } (list) }
        } @else {
            (list)
        }
    }
}

/// A cell, marked where the number of this column is beyond its limit.
fn cell(cases: &Cases<'_>, row: usize, column: &str, content: &Markup) -> Markup {
    // The warning decides, not the number: the limit of the Tabor parameter applies to one criterion only.
    let beyond = limit_of(column).is_some_and(|limit| cases.has(row, limit.caution));
    html! { td class=[beyond.then_some("beyond")] { (content) } }
}

fn limit_of(column: &str) -> Option<&'static Limit> {
    LIMITS.iter().find(|limit| limit.column == column)
}

/// The limit of a column, below its heading; empty without a limit.
fn bound(column: &str, format: Shown) -> Markup {
    html! {
        @if let Some(limit) = limit_of(column) {
            br;
            (if limit.at_least { "≥\u{a0}" } else { "≤\u{a0}" }) (shown(Some(limit.bound), format))
        }
    }
}
