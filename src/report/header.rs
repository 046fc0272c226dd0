//! Head of the report: parameters, model validity and contents.

use super::layout::{plain, prose};
use crate::model::{Choice as _, Method};
use crate::schema::{Parameter, parameters_by_rank};
use crate::stats::{
    LIMITS, StatsError, Values, Varying, expected_ratios, grid_percent, loads, significant,
    verdicts_of_sweeps, warnings, warnings_of,
};
use crate::store::{ColumnData, Frame};
use crate::text::with_one_unit;
use maud::{Markup, PreEscaped, html};

/// Values of a parameter that the table lists; of more, it states the range.
const MOST_VALUES: usize = 6;

/// Warnings whose measured values decide whether results are inside the validated range of the asperity
/// model.
const DECIDING: [&str; 2] = ["sticky", "touching"];

/// Warnings of the range of the asperity model.
const OF_RANGE: [&str; 7] = ["sticky", "area", "conformed", "covered", "absorption", "touching", "tabor"];

/// Parameters with their values, and the version of the program.
pub(super) fn facts(cases: &Frame, seed: u64, realizations: &str) -> Result<Markup, StatsError> {
    let mut facts = Vec::new();
    for parameter in parameters_by_rank() {
        // Values have their units.
        let label = match parameter.label.split_once(" [") {
            Some(("c", _)) => "machine compliance c",
            Some((label, _)) => label,
            None => parameter.label,
        };
        facts.extend(values(cases, parameter)?.map(|values| (label.replace("^{*}", "*"), values)));
    }
    let loads = loads(cases)?;
    facts.push((loads.symbol.to_owned(), listed(loads.all_labels())));
    facts.push((
        "realizations".to_owned(),
        realizations.trim_end_matches(" realizations").trim_end_matches(" realization").to_owned(),
    ));
    facts.push(("seed".to_owned(), seed.to_string()));
    facts.push(("hysteron".to_owned(), env!("CARGO_PKG_VERSION").to_owned()));
    Ok(html! {
        dl.facts {
            "\n" @for (name, values) in &facts { div { dt { (prose(name)) } dd { (values) } } "\n" }
        } "\n"
    })
}

/// The values of a parameter in all cases; nothing where no case has it.
fn values(cases: &Frame, parameter: &'static Parameter) -> Result<Option<String>, StatsError> {
    let values = match cases.column(parameter.column.name)? {
        ColumnData::F64(all) => {
            let mut known: Vec<f64> = all.iter().flatten().copied().collect();
            known.sort_by(f64::total_cmp);
            Values::Numbers(known.into_iter().map(Some).collect())
        }
        ColumnData::Text(all) => {
            Values::Words(all.iter().flatten().filter(|word| !word.is_empty()).cloned().collect())
        }
        ColumnData::I64(_) | ColumnData::Bool(_) => return Ok(None),
    };
    let count = match &values {
        Values::Numbers(numbers) => numbers.len(),
        Values::Words(words) => words.len(),
    };
    let varying = Varying::new(parameter, values);
    let texts: Vec<String> = (0..count).map(|row| varying.text(row).to_owned()).collect();
    Ok(Some(listed(texts)).filter(|text| !text.is_empty()))
}

/// Different values in their order; of many, the first and the last.
fn listed(texts: Vec<String>) -> String {
    let mut different: Vec<String> = Vec::new();
    for text in texts {
        if !different.contains(&text) {
            different.push(text);
        }
    }
    match different.as_slice() {
        [first, .., last] if different.len() > MOST_VALUES => {
            format!("{first} … {last} ({} values)", different.len())
        }
        all => with_one_unit(&all.iter().map(String::as_str).collect::<Vec<_>>()),
    }
}

/// Grid error of Θ above which the banner is not green.
const LARGE_GRID_ERROR: f64 = 0.1;

/// Verdict on model validity: measured values beyond their limits, or the two deciding numbers.
pub(super) fn banner(cases: &Frame, methods: &Frame) -> Result<Markup, StatsError> {
    let sentences = verdicts_of_sweeps(cases, Some(methods))?;
    let found = warnings(cases)?;
    let (words, done) = (cases.text("method")?, cases.i64("done_count")?);
    // Rows without a result are neither inside nor outside, and the range is that of the asperity model.
    let judged: Vec<usize> = (0..cases.row_count())
        .filter(|row| done[*row] > 0 && words[*row] == Method::Asperities.word())
        .collect();
    let all = judged.len();
    let mut outside: Vec<usize> =
        found.iter().filter(|of| OF_RANGE.contains(&of.kind.code)).flat_map(|of| of.rows.clone()).collect();
    outside.retain(|row| judged.contains(row));
    outside.sort_unstable();
    outside.dedup();
    let error = grid_error(cases)?;
    let (colour, verdict) = match (outside.len(), found.is_empty()) {
        (0, true) if error.is_some_and(|error| error > LARGE_GRID_ERROR) => {
            ("amber", "No warnings, but a large grid error.".to_owned())
        }
        (0, true) if all == 0 => ("green", "No warnings.".to_owned()),
        (0, false) if all == 0 => ("amber", "With warnings.".to_owned()),
        (0, true) => ("green", "No warnings: all rows are inside the validated range.".to_owned()),
        (0, false) => ("amber", "Inside the validated range, with warnings.".to_owned()),
        (count, _) => {
            let (colour, rows) = match (count, all) {
                (1, 1) => ("red", "The result is".to_owned()),
                _ if count == all => ("red", "All rows are".to_owned()),
                (1, _) => ("amber", format!("1 of {all} rows is")),
                _ => ("amber", format!("{count} of {all} rows are")),
            };
            (colour, format!("{rows} outside the validated range of the asperity model."))
        }
    };
    let numbers = numbers(cases, &judged, &outside)?;
    let labels: Vec<&str> = found.iter().map(|of| of.kind.label).collect();
    Ok(html! {
        div class={ "banner " (colour) } role="note" {
            p {
                b { @if done.contains(&0) { "Finished rows: " } (verdict) } " " (plain(&numbers.join("; ")))
                @if !numbers.is_empty() { "." }
            }
            @for sentence in &sentences { p { (sentence) } }
            @if !labels.is_empty() {
                p { "Warnings: " (labels.join(", ")) ". " a href="#model-validity" { "Model validity" } }
            }
            @if let Some(error) = error {
                p { "Grid error of Θ: " @if done.len() > 1 { "up to " } (grid_percent(error)) ". "
                    a href="#grid-error" { "Grid error" } }
            }
            @if let Some(ratios) = expected_ratios(cases)? { p { (plain(&ratios)) } }
        }
        "\n"
    })
}

/// Measured values of the rows outside the range, or of all judged ones.
fn numbers(cases: &Frame, judged: &[usize], outside: &[usize]) -> Result<Vec<String>, StatsError> {
    let mut numbers = Vec::new();
    if outside.is_empty() {
        for code in DECIDING {
            numbers.extend(deciding(cases, judged, code)?);
        }
        return Ok(numbers);
    }
    let found = warnings_of(cases, outside)?;
    Ok(found.into_iter().filter(|of| OF_RANGE.contains(&of.kind.code)).map(|of| of.measured).collect())
}

/// Largest known grid error of Θ.
fn grid_error(cases: &Frame) -> Result<Option<f64>, StatsError> {
    Ok(cases.f64_or_null("loss_grid_error")?.iter().flatten().copied().reduce(f64::max))
}

/// The range of the number that a warning compares with its limit, over these rows.
fn deciding(cases: &Frame, rows: &[usize], code: &str) -> Result<Option<String>, StatsError> {
    let Some(limit) = LIMITS.iter().find(|limit| limit.caution == code) else { return Ok(None) };
    let column = cases.f64_or_null(limit.column)?;
    let values: Vec<f64> = rows.iter().filter_map(|row| column[*row]).collect();
    let [low, high] =
        [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick));
    let Some((low, high)) = low.zip(high) else { return Ok(None) };
    let number =
        |value: f64| if limit.at_least { significant(value, 3) } else { significant(100.0 * value, 2) };
    let range = if number(low) == number(high) {
        number(low)
    } else {
        format!("{} to {}", number(low), number(high))
    };
    Ok(Some(if limit.at_least {
        format!("U_el/Δγ = {range} (limit ≥ {})", limit.bound)
    } else {
        format!(
            "{range} % of contact spots overlap a neighbour (limit {} %)",
            significant(100.0 * limit.bound, 2)
        )
    }))
}

/// Links to the sections of the page.
pub(super) fn contents(body: &str) -> Markup {
    let section = |piece: &str| -> Option<(String, String)> {
        let (id, rest) = piece.split_once("\">")?;
        Some((id.to_owned(), rest.split_once("</h2>")?.0.to_owned()))
    };
    let sections: Vec<(String, String)> = body.split("<h2 id=\"").skip(1).filter_map(section).collect();
    html! {
        nav aria-label="Contents" {
            ul {
                "\n" @for (id, title) in &sections { li { a href={ "#" (id) } { (PreEscaped(title)) } } "\n" }
            }
        } "\n"
    }
}
