//! Part of the report: results with confidence intervals, and differences from the reference case.

use super::cases::Cases;
use super::layout::{heading, prose};
use super::numbers::{Scale, Shown, scaled, shown};
use crate::stats::{Difference, FEW, Listed, StatsError, difference_of, fewer_surfaces, singles};
use maud::{Markup, html};

/// Heading, column of the table `cases` without its ending, and true if the quantity cannot be negative.
type Quantity = (&'static str, &'static str, bool);

const RESULTS: [Quantity; 7] = [
    ("A/A_{0}", "area_at_max_load", true),
    ("Δ/h_{rms}", "penetration_at_max_load", false),
    ("F_{po}/(E*A_{0})", "pull_off_load", true),
    ("Θ/(E*A_{0}h_{rms})", "loss", true),
    ("Θ_{DK}, target spectrum", "loss_dk", true),
    ("Θ/Θ_{DK}", "loss_ratio_dk", true),
    ("Θ_{DK}, realised spectrum", "loss_dk_realised", true),
];

/// Results in SI units.
const IN_SI: [Quantity; 6] = [
    ("F_{po} [N]", "pull_off_load_n", true),
    ("F_{po}/A_{0} [Pa]", "pull_off_pressure_pa", true),
    ("Θ/A_{0} [J/m²]", "loss_j_m2", true),
    ("Θ/(A_{0}Δγ)", "loss_over_adhesion", true),
    ("w_{closing} [J/m²]", "work_closing_j_m2", false),
    ("w_{opening} [J/m²]", "work_opening_j_m2", true),
];

/// Results of a probe.
const OF_PROBE: [Quantity; 6] = [
    ("F_{po} [N]", "pull_off_load_n", true),
    ("Θ [J]", "loss_j", true),
    ("w_{approach} [J/m²]", "work_approach_j_m2", true),
    ("w_{retraction} [J/m²]", "work_retraction_j_m2", true),
    ("w(F_{po}) [J/m²]", "work_pull_off_j_m2", true),
    ("w(Θ) [J/m²]", "work_loss_j_m2", true),
];

const OF_PROBE_NOTE: &str = "Apparent works of adhesion of a smooth sphere of the radius of the probe: \
    w_{approach} and w_{retraction} by JKR fits of the radius √(A/π) against load on both branches, \
    w(F_{po}) from the pull-off force F_{po}/(1.5πR), w(Θ) from the dissipated energy. The residuals of the \
    fits are in the table `realizations`.";

const IN_SI_NOTE: &str = "Per nominal area A_{0}. Work of adhesion of closing w_{closing}: energy that the \
    surfaces give from separation, by way of the load reversal, to zero load on the unloading path. Work of \
    adhesion of opening w_{opening}: work from there to separation. w_{opening} − w_{closing} = Θ/A_{0}.";

/// Quantities compared with the reference case.
const CHANGES: [(&str, &str); 5] = [
    ("A/A_{0}", "area_at_max_load"),
    ("Δ/h_{rms}", "penetration_at_max_load"),
    ("F_{po}", "pull_off_load"),
    ("Θ", "loss"),
    ("Θ/Θ_{DK}", "loss_ratio_dk"),
];

/// The results with confidence intervals or values of single surfaces, and the number of realizations.
pub(super) fn results(cases: &Cases<'_>) -> Result<Markup, StatsError> {
    Ok(html! {
        (heading("Results"))
        p { (note(cases)?) } "\n"
        div.dimensionless { (table(cases, "results", &without_units(cases)?)?) }
        p { (prose(IN_SI_NOTE)) @if !spread(cases)?.is_empty() { " Confidence intervals and single values as \
            above." } } "\n"
        (table(cases, "results-si", &IN_SI)?)
        @if cases.has_probe()? {
            p { (prose(OF_PROBE_NOTE)) } "\n"
            (table(cases, "results-probe", &OF_PROBE)?)
        }
    })
}

/// Results without units: of probes alone with their own estimate of Deng and Kesari.
fn without_units(cases: &Cases<'_>) -> Result<[Quantity; 7], StatsError> {
    let mut quantities = RESULTS;
    if is_of_probes(cases)? {
        quantities[4] = ("Θ_{DK}, R_{tip} = R, target spectrum", "loss_dk_probe", true);
        quantities[6] = ("Θ_{DK}, R_{tip} = R, realised spectrum", "loss_dk_probe_realised", true);
    }
    Ok(quantities)
}

/// True if all cases have a probe.
fn is_of_probes(cases: &Cases<'_>) -> Result<bool, StatsError> {
    Ok(cases.frame.f64_or_null("probe_radius_m")?.iter().all(Option::is_some))
}

/// A table of results, one row for each case and load.
fn table(cases: &Cases<'_>, name: &str, quantities: &[Quantity]) -> Result<Markup, StatsError> {
    let scales =
        quantities.iter().map(|(_, column, _)| cases.scale(column)).collect::<Result<Vec<_>, _>>()?;
    let head = html! {
        (cases.name_heads())
        th { "finished of planned" }
        @for ((heading, ..), scale) in quantities.iter().zip(&scales) {
            th { (prose(heading)) (scale.head()) }
        }
    };
    let row = |listed: &Listed| Ok((listed.row, row(cases, listed, quantities, &scales)?));
    let rows = cases.rows().iter().map(row).collect::<Result<Vec<_>, StatsError>>()?;
    Ok(cases.wide(name, &head, rows))
}

fn note(cases: &Cases<'_>) -> Result<Markup, StatsError> {
    let tip = if is_of_probes(cases)? { ", R_{tip} = R" } else { "" };
    let text = format!(
        "Means over realizations: contact area A and mean penetration Δ at load reversal, pull-off force \
         F_{{po}} (maximum tensile load during unloading), dissipated energy Θ (area of the loop), and its \
         estimate Θ_{{DK}} by Deng and Kesari (target spectrum{tip}).{} A power of ten in a column head is \
         the unit of its numbers.",
        spread(cases)?
    );
    Ok(html! {
        (prose(&text))
        @if let Some(of) = cases.reference() {
            " Reference case: " (of) ". It belongs to the most sweeps; the other cases are named by the \
                 parameters that differ from it."
        }
    })
}

/// Meaning of the brackets and braces that the tables have.
fn spread(cases: &Cases<'_>) -> Result<String, StatsError> {
    let few = FEW as i64;
    let done = cases.frame.i64("done_count")?;
    let mut text = String::new();
    if done.iter().any(|count| *count >= few) {
        text += " Brackets: 95 % confidence interval of the mean (Student). A lower limit below 0 of a \
                 quantity that cannot be negative is replaced by 0 and marked with †.";
    }
    if done.iter().any(|count| (2..few).contains(count)) {
        text += &format!(" Braces: values of the single surfaces, for fewer than {FEW}.");
    }
    Ok(text)
}

fn row(
    cases: &Cases<'_>,
    listed: &Listed,
    quantities: &[Quantity],
    scales: &[Scale],
) -> Result<Markup, StatsError> {
    let row = listed.row;
    let count = |name: &str| -> Result<i64, StatsError> {
        Ok(cases.frame.i64(name)?.get(row).copied().unwrap_or_default())
    };
    let (done, planned, failed) = (count("done_count")?, count("planned_count")?, count("failed_count")?);
    let mut cells = Vec::new();
    for ((_, column, positive), scale) in quantities.iter().zip(scales) {
        cells.push(result(cases, row, column, *scale, *positive)?);
    }
    Ok(html! {
        (cases.name(listed))
        td { (done) " of " (planned) @if failed > 0 { ", " (failed) " failed" } }
        @for cell in cells { td { (cell) } }
    })
}

/// A mean with its confidence interval, or with the values of the single surfaces.
fn result(
    cases: &Cases<'_>,
    row: usize,
    column: &str,
    scale: Scale,
    positive: bool,
) -> Result<Markup, StatsError> {
    let number = |end: &str| cases.number(&format!("{column}_{end}"), row);
    let (mean, low, high) = (number("mean")?, number("ci95_low")?, number("ci95_high")?);
    let text = |number: f64| scaled(Some(number), scale);
    let values = singles(cases.frame, cases.realizations, row, column)?;
    let is_cut = |low: f64| positive && low < 0.0 && mean.is_some_and(|mean| mean >= 0.0);
    Ok(html! {
        (scaled(mean, scale))
        @match (low, high) {
            (Some(_), Some(_)) if values.len() < FEW => {
                " " small {
                    "{"
                    @for (place, value) in values.iter().enumerate() { @if place > 0 { "; " } (text(*value)) }
                    "}"
                }
            }
            (Some(low), Some(high)) => {
                " " small { "[" @if is_cut(low) { "0†" } @else { (text(low)) } ", " (text(high)) "]" }
            }
            _ => {}
        }
        @if let Some([count, done]) = fewer_surfaces(cases.frame, column, row)? {
            " " small { (count) " of " (done) " surfaces" }
        }
    })
}

const CHANGES_NOTE: &str = "Difference of the means from the reference case at the same load, as a fraction \
    of its mean, with the half-width of the 95 % confidence interval: surface by surface where both cases \
    have the same surfaces, otherwise of two independent means (Welch). Differences larger than their \
    half-width are bold.";

/// Differences of the means of each case from those of the reference case at the same load; empty without
/// such a case.
pub(super) fn changes(cases: &Cases<'_>) -> Result<Markup, StatsError> {
    let compared =
        cases.rows().iter().filter_map(|listed| listed.reference.map(|reference| (listed, reference)));
    let mut rows = Vec::new();
    for (listed, reference) in compared {
        let mut cells = Vec::new();
        for (_, column) in CHANGES {
            cells.push(change(difference_of(
                cases.frame,
                cases.realizations,
                [listed.row, reference],
                column,
            )?));
        }
        rows.push((listed.row, html! { (cases.name(listed)) @for cell in cells { (cell) } }));
    }
    if rows.is_empty() {
        return Ok(Markup::default());
    }
    let head = html! { (cases.name_heads()) @for (heading, _) in CHANGES { th { (prose(heading)) } } };
    Ok(html! {
        (heading("Differences from the reference case")) p { (CHANGES_NOTE) } "\n"
        (cases.wide("differences", &head, rows))
    })
}

/// A relative difference with the half-width of its interval; bold if it is larger than that.
fn change(found: Option<Difference>) -> Markup {
    let clear = found.is_some_and(|found| found.ci95.is_some_and(|half| found.of.abs() > half));
    let share =
        |found: Difference, part: f64| Some(part / found.means[1].abs()).filter(|share| share.is_finite());
    let change = found.and_then(|found| share(found, found.of));
    let half = found.and_then(|found| found.ci95.and_then(|half| share(found, half)));
    html! {
        td class=[clear.then_some("clear")] {
            (shown(change, Shown::Percent))
            @if half.is_some() { " (±\u{a0}" (shown(half, Shown::Percent)) ")" }
        }
    }
}
