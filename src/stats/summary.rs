//! The table of results at the end of a run.

use super::StatsError;
use super::digits::{labels, significant};
use super::listed::{Listed, listing, listing_of, sweeps};
use super::warnings::warnings;
use crate::store::Frame;

/// Widths of the columns: case, maximum load, realizations, and four results; 80 columns together.
const WIDTHS: [usize; 7] = [14, 8, 6, 12, 14, 14, 12];

/// Columns that a caption or a long label may take.
const LINE: usize = 79;

/// Rows that a warning names; of more, it gives the number.
const MOST_NAMED: usize = 2;

const HEADER: &str = "\
Mean ± standard deviation over realizations; n: finished/planned.
F_max: maximum load, F_po: pull-off force, both over E* A0.
A: contact area at F_max over A0. Θ: dissipated energy over E* A0 h_rms.
Θ_DK: estimate of Θ by Deng and Kesari.";

const EXPONENTS: &str = "Numbers with an exponent are not scaled by the factor of their column.";

const REFERENCE: &str = "*: reference case. change: relative to it, where all realizations finished.";

/// Heading, column of the table `cases` without its ending, and the scale.
const RESULTS: [(&str, &str, f64); 4] =
    [("A", "area_at_max_load", 1.0), ("F_po [10⁻³]", "pull_off_load", 1e-3), ("Θ [10⁻³]", "loss", 1e-3), ("Θ/Θ_DK", "loss_ratio_dk", 1.0)];

/// The results of every case as lines of at most 80 columns. Each sweep lists all of its cases: the reference case first, the others in the order of the spec.
///
/// # Errors
/// If the table lacks one of its columns.
pub fn summary(cases: &Frame) -> Result<String, StatsError> {
    let mut lines = Vec::new();
    let mut compared = false;
    for name in sweeps(cases)? {
        lines.push(String::new());
        let title = if name.is_empty() { "case".to_owned() } else { name.clone() };
        let headings = RESULTS.map(|(heading, ..)| heading.to_owned());
        lines.extend(labelled(&title, ["F_max".to_owned(), "n".to_owned()], headings));
        for listed in listing_of(cases, &name)? {
            compared |= listed.is_reference;
            lines.extend(case_lines(cases, &listed)?);
        }
    }
    let mut head = vec![HEADER];
    head.extend(lines.iter().any(|line| has_exponent(line)).then_some(EXPONENTS));
    head.extend(compared.then_some(REFERENCE));
    lines.extend(warning_lines(cases)?);
    lines.push(String::new());
    Ok(format!("{}\n{}", head.join("\n"), lines.join("\n")))
}

/// Whether a line of results has a number that [`fitting`] has written with an exponent.
fn has_exponent(line: &str) -> bool {
    line.split_whitespace().any(|cell| cell.split('±').all(|number| number.contains('e') && number.parse::<f64>().is_ok()))
}

fn case_lines(cases: &Frame, listed: &Listed) -> Result<Vec<String>, StatsError> {
    let value = |name: String, row: usize| -> Result<Option<f64>, StatsError> { Ok(cases.f64_or_null(&name)?.get(row).copied().flatten()) };
    let mean = |name: &str, row: usize| value(format!("{name}_mean"), row);
    let count = |name: &str, row: usize| -> Result<i64, StatsError> { Ok(cases.i64(name)?.get(row).copied().unwrap_or_default()) };
    let counts = |row: usize| -> Result<[i64; 2], StatsError> { Ok([count("done_count", row)?, count("planned_count", row)?]) };
    let load = value("max_load".to_owned(), listed.row)?.map_or_else(String::new, |load| significant(load, 4));
    let [done, planned] = counts(listed.row)?;
    // Means of different surfaces differ by the surfaces too.
    let reference = match listed.reference {
        Some(row) if counts(row)? == [done; 2] && done == planned => Some(row),
        _ => None,
    };
    let (mut results, mut changes) = (Vec::new(), Vec::new());
    for ((_, name, scale), width) in RESULTS.into_iter().zip(&WIDTHS[3..]) {
        let own = mean(name, listed.row)?;
        results.push(mean_and_sd(own, value(format!("{name}_sd"), listed.row)?, scale, width - 1));
        let other = reference.map(|row| mean(name, row)).transpose()?.flatten();
        changes.push(own.zip(other).and_then(|(own, other)| change(own, other)));
    }
    let label = listed.label.replace(" = ", "=") + if listed.is_reference { "*" } else { "" };
    let mut lines = labelled(&label, [load, format!("{done}/{planned}")], four(results));
    if changes.iter().any(Option::is_some) {
        let cells = changes.into_iter().map(|change| change.unwrap_or_else(|| "-".to_owned())).collect();
        lines.extend(labelled("  change [%]", [String::new(), String::new()], four(cells)));
    }
    Ok(lines)
}

fn four(cells: Vec<String>) -> [String; 4] {
    cells.try_into().unwrap_or_default()
}

/// The relative difference of a mean from that of the reference case, in percent; nothing where the latter is zero.
fn change(own: f64, reference: f64) -> Option<String> {
    let percent = 100.0 * (own - reference) / reference.abs();
    let text = if percent.abs() < 1e4 { format!("{percent:+.1}") } else { format!("{percent:+.1e}") };
    percent.is_finite().then(|| if text == "-0.0" || text == "+0.0" { "0.0".to_owned() } else { text })
}

/// One paragraph per warning, with its rows.
fn warning_lines(cases: &Frame) -> Result<Vec<String>, StatsError> {
    let (all, loads) = (listing(cases)?.rows, labels(&cases.f64("max_load")?));
    let mut lines = Vec::new();
    for warning in warnings(cases)? {
        let place = if warning.rows.len() == all.len() {
            String::new()
        } else if warning.rows.len() <= MOST_NAMED {
            let named = all.iter().filter(|listed| warning.rows.contains(&listed.row));
            let names: Vec<String> =
                named.map(|listed| format!("{}, F_max = {}", listed.label, loads[listed.row]).replace(" = ", "\u{a0}=\u{a0}")).collect();
            format!(" ({})", names.join("; "))
        } else {
            format!(" ({} of {} rows)", warning.rows.len(), all.len())
        };
        lines.extend(wrapped(&format!("warning[{}]: {}{place}: {}", warning.kind.code, warning.kind.label, warning.measured)));
    }
    if !lines.is_empty() {
        lines.insert(0, String::new());
        lines.push("Consequence and action of each warning: report.html, \"Model validity\".".to_owned());
    }
    Ok(lines)
}

/// A paragraph as lines; the second and later ones are indented. No-break spaces keep a number with its unit.
fn wrapped(paragraph: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in paragraph.split(' ') {
        match lines.last_mut().filter(|line| line.chars().count() + 1 + word.chars().count() <= LINE) {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(format!("{}{word}", if lines.is_empty() { "" } else { "  " })),
        }
    }
    lines.into_iter().map(|line| cut(&line.replace('\u{a0}', " "), LINE)).collect()
}

/// A mean with its standard deviation over a scale, in so many columns. Numbers that the scale cannot show are written with exponents, and without the scale.
fn mean_and_sd(mean: Option<f64>, sd: Option<f64>, scale: f64, width: usize) -> String {
    let Some(mean) = mean else {
        return "-".to_owned();
    };
    let largest = mean.abs().max(sd.unwrap_or_default().abs());
    let digits = match largest / scale {
        0.0 => 0,
        _ if mean != 0.0 && mean.abs() < 5e-4 * scale => return fitting(mean, sd, width),
        size if size < 0.01 => return fitting(mean, sd, width),
        size if size < 10.0 => 3,
        size if size < 100.0 => 2,
        size if size < 1000.0 => 1,
        _ => return fitting(mean, sd, width),
    };
    match sd {
        Some(sd) => format!("{:.digits$}±{:.digits$}", mean / scale, sd / scale),
        None => format!("{:.digits$}", mean / scale),
    }
}

/// A mean with its standard deviation, with exponents of their own and as many digits, two at most, as fit.
fn fitting(mean: f64, sd: Option<f64>, width: usize) -> String {
    let Some(sd) = sd else {
        return format!("{mean:.2e}");
    };
    let texts = [(1, 1), (1, 0), (0, 0)].map(|(a, b)| format!("{mean:.a$e}±{sd:.b$e}"));
    let [.., shortest] = &texts;
    texts.iter().find(|text| text.chars().count() <= width).unwrap_or(shortest).clone()
}

/// Cells below the headings, after a label; a label that is too long for its column has lines of its own.
fn labelled(label: &str, [load, count]: [String; 2], [area, pull_off, loss, ratio]: [String; 4]) -> Vec<String> {
    let cells = |label: String| line([label, load, count, area, pull_off, loss, ratio]);
    if label.chars().count() < WIDTHS[0] {
        return vec![cells(label.to_owned())];
    }
    let mut lines: Vec<String> = Vec::new();
    for word in label.split_inclusive(", ") {
        match lines.last_mut().filter(|line| line.chars().count() + word.chars().count() <= LINE) {
            Some(line) => line.push_str(word),
            None => lines.push(word.to_owned()),
        }
    }
    let mut lines: Vec<String> = lines.into_iter().map(|line| cut(line.trim_end(), LINE)).collect();
    lines.push(cells(String::new()));
    lines
}

fn line(cells: [String; 7]) -> String {
    let mut text = String::new();
    for (at, (cell, width)) in cells.iter().zip(WIDTHS).enumerate() {
        let cell = cut(cell, width - 1);
        let gap = " ".repeat(width - cell.chars().count());
        // Words stand at the left of their column, numbers at the right.
        let parts = if at == 0 { [cell, gap] } else { [gap, cell] };
        text.extend(parts);
    }
    text.trim_end().to_owned()
}

fn cut(text: &str, width: usize) -> String {
    if text.chars().count() <= width { text.to_owned() } else { text.chars().take(width.saturating_sub(1)).chain(['…']).collect() }
}
