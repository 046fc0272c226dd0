//! The table of results at the end of a run.

use super::StatsError;
use super::cases::fewer_surfaces;
use super::digits::{column_exponent, decimals, power_of_ten, significant};
use super::grid_verdict::{self, grid_help};
use super::listed::{Listed, listing, listing_of, sweeps};
use super::loads::{FORCE, OVER_MODULUS, loads};
use super::model_error::{COLUMNS, outdated};
use super::models;
use super::verdict::{IN_A_VERDICT, verdicts};
use super::warnings::{Warning, warnings};
use crate::store::Frame;
use crate::text::counted;

/// Widths of the columns: case, maximum load, realizations, and four results; 80 columns together.
const WIDTHS: [usize; 7] = [14, 8, 6, 12, 14, 14, 12];

/// Columns that a caption or a long label may take.
const LINE: usize = 79;

/// Rows that a warning names; of more, it gives the number.
const MOST_NAMED: usize = 2;

const MEANS: &str = "Mean ± standard deviation over realizations; n: finished/planned.";
const LOADS: &str = "F_max: maximum load, F_po: pull-off force, both over E* A0.";
const LOADS_IN_SI: &str = "F_max: maximum load, F_po: pull-off force over E* A0.";
const PRESSURES: &str = "F_max: maximum nominal pressure, F_po: pull-off force over E* A0.";
const HEADER: &str = "\
A: contact area at F_max over A0. Θ: dissipated energy over E* A0 h_rms.
Θ_DK: estimate of Θ by Deng and Kesari";
const OF_FLAT: &str = ".";
const OF_TIP: &str = ", of a probe with R_tip = R.";

const REFERENCE: &str = "*: reference case. change: relative to it, where all realizations finished.";

const ERRORS: &str = "\
By boundary elements: Θ ± estimated error of the grid, and ± half-width of the
95 % confidence interval of the mean over surfaces; A, F_po ± those of the grid.";

/// Four results of a row: heading, column of the table `cases` without its ending, and factor to the unit of
/// the heading.
type Results = [(&'static str, &'static str, f64); 4];

/// Results without units.
const RESULTS: Results = [
    ("A", "area_at_max_load", 1.0),
    ("F_po", "pull_off_load", 1.0),
    ("Θ", "loss", 1.0),
    ("Θ/Θ_DK", "loss_ratio_dk", 1.0),
];

/// Results per nominal area, in the units of experiments: kPa and mJ/m².
const PER_AREA: Results = [
    ("F_po", "pull_off_pressure_pa", 1e-3),
    ("Θ", "loss_j_m2", 1e3),
    ("w_closing", "work_closing_j_m2", 1e3),
    ("w_opening", "work_opening_j_m2", 1e3),
];

/// Results of a probe, in newtons, joules and mJ/m².
const OF_PROBE: Results = [
    ("F_po", "pull_off_load_n", 1.0),
    ("Θ", "loss_j", 1.0),
    ("w_approach", "work_approach_j_m2", 1e3),
    ("w_retract", "work_retraction_j_m2", 1e3),
];

const OF_PROBE_HEADER: &str = "\
Probe: F_po [N], Θ [J]; w_approach and w_retract [mJ/m²], apparent works of
adhesion of JKR fits of the contact radius against load.";

/// Label of the line of numbers of surfaces, and its meaning.
const SURFACES: &str = "  surfaces";
const SURFACES_NOTE: &str = "surfaces: those in the mean, of the finished ones; the others have no fit.";

const PER_AREA_HEADER: &str = "\
Per nominal area: F_po [kPa]; Θ, w_closing and w_opening [mJ/m²], the works of
adhesion from separation to zero load and back, w_opening - w_closing = Θ.";

/// Magnitude from which numbers are not written in full.
const LONG: f64 = 1e5;

/// A mean with its standard deviation.
type MeanSd = (Option<f64>, Option<f64>);

/// Notation of all numbers of a column.
#[derive(Debug, Clone, Copy)]
enum Notation {
    /// Over a power of ten, which the head of the column states.
    Over(i32),
    /// Each with its own exponent, where no common power of ten is readable.
    Exponents,
}

impl Notation {
    fn of(heading: &str, cells: &[MeanSd], width: usize) -> Self {
        let exponent = column_exponent(cells.iter().filter_map(|(mean, _)| *mean));
        let over = Self::Over(exponent);
        let is_readable = over.heading(heading).chars().count() <= width
            && cells.iter().all(|cell| fixed(*cell, exponent, width).is_some());
        if is_readable { over } else { Self::Exponents }
    }

    fn heading(self, heading: &str) -> String {
        match self {
            Self::Over(exponent) if exponent != 0 => format!("{heading} [{}]", power_of_ten(exponent)),
            _ => heading.to_owned(),
        }
    }

    fn cell(self, cell: MeanSd, width: usize) -> String {
        match (self, cell) {
            (_, (None, _)) => "-".to_owned(),
            (Self::Over(exponent), _) => fixed(cell, exponent, width).unwrap_or_default(),
            (Self::Exponents, (Some(mean), sd)) => fitting(mean, sd, width),
        }
    }
}

/// Warnings that a summary has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// At most three lines: what the verdicts do not say, the most severe first; the report has the others.
    Few,
    /// All, with measured values, limits and rows.
    All,
}

/// The results of every case as lines of at most 80 columns. Each sweep lists all of its cases, the reference
/// case first, the others in the order of the spec, and its verdict. `methods` is the table of both methods
/// on the same surfaces, `cutoff` that of models over the cut-off wavelength.
///
/// # Errors
/// If a table lacks one of its columns.
pub fn summary(
    cases: &Frame,
    methods: Option<&Frame>,
    cutoff: Option<&Frame>,
    shown: Shown,
) -> Result<String, StatsError> {
    let mut lines = Vec::new();
    let (mut compared, mut has_errors) = (false, false);
    let loads = loads(cases)?.all_labels();
    for name in sweeps(cases)? {
        lines.push(String::new());
        let title = if name.is_empty() { "case".to_owned() } else { name.clone() };
        let rows = listing_of(cases, &name)?;
        compared |= rows.iter().any(|listed| listed.is_reference);
        lines.extend(table(cases, &rows.iter().collect::<Vec<_>>(), &title, &RESULTS)?);
        let with_errors = grid_verdict::lines(cases, &rows, &loads)?;
        has_errors |= !with_errors.is_empty();
        lines.extend(with_errors.iter().flat_map(|sentence| wrapped(sentence)));
        let rows: Vec<usize> = rows.iter().map(|listed| listed.row).collect();
        lines.extend(
            verdicts(cases, methods, &rows)?
                .iter()
                .flat_map(|sentence| wrapped(&format!("Verdict: {sentence}"))),
        );
    }
    let all: Vec<usize> = (0..cases.row_count()).collect();
    lines.extend(grid_help(cases, &all)?.map(|help| format!("help: {help}")));
    lines.extend(in_si(cases, cutoff)?);
    let mut head = vec![MEANS.to_owned(), loads_head(cases)?.to_owned(), results_head(cases)?];
    head.extend(compared.then(|| REFERENCE.to_owned()));
    head.extend(has_errors.then(|| ERRORS.to_owned()));
    lines.extend(match shown {
        Shown::Few => few_warnings(cases)?,
        Shown::All => warning_lines(cases)?,
    });
    lines.push(String::new());
    Ok(format!("{}\n{}", head.join("\n"), lines.join("\n")))
}

/// Meaning of the loads.
fn loads_head(cases: &Frame) -> Result<&'static str, StatsError> {
    Ok(match loads(cases)?.symbol {
        OVER_MODULUS => LOADS,
        FORCE => LOADS_IN_SI,
        _ => PRESSURES,
    })
}

/// Meaning of the results without units.
fn results_head(cases: &Frame) -> Result<String, StatsError> {
    let has_probe = cases.f64_or_null("probe_radius_m")?.iter().any(Option::is_some);
    Ok(format!("{HEADER}{}", if has_probe { OF_TIP } else { OF_FLAT }))
}

/// The results of all sweeps in SI units: per nominal area, and of probes.
fn in_si(cases: &Frame, cutoff: Option<&Frame>) -> Result<Vec<String>, StatsError> {
    let radii = cases.f64_or_null("probe_radius_m")?;
    let mut lines = Vec::new();
    for (is_probe, header, results) in
        [(false, PER_AREA_HEADER, &PER_AREA), (true, OF_PROBE_HEADER, &OF_PROBE)]
    {
        let mut tables = Vec::new();
        for name in sweeps(cases)? {
            let title = if name.is_empty() { "case".to_owned() } else { name.clone() };
            let rows = listing_of(cases, &name)?;
            let of: Vec<&Listed> =
                rows.iter().filter(|listed| radii[listed.row].is_some() == is_probe).collect();
            if !of.is_empty() {
                tables.extend(table(cases, &of, &title, results)?);
            }
        }
        if !tables.is_empty() {
            lines.push(String::new());
            lines.extend(header.lines().map(str::to_owned));
            let has_fewer = tables.iter().any(|line| line.starts_with(SURFACES));
            lines.extend(tables);
            lines.extend(has_fewer.then(|| SURFACES_NOTE.to_owned()));
            if let Some(cutoff) = cutoff {
                lines.extend(persson_tosatti(cases, cutoff, |row| radii[row].is_some() == is_probe)?);
            }
        }
    }
    Ok(lines)
}

/// Persson and Tosatti's work of adhesion of the rows that are shown, as lines; nothing where U_el ≥ Δγ.
fn persson_tosatti(
    cases: &Frame,
    cutoff: &Frame,
    is_shown: impl Fn(usize) -> bool,
) -> Result<Vec<String>, StatsError> {
    let (works, done) = (models::persson_tosatti(cases, cutoff)?, cases.i64("done_count")?);
    let is_finished = |row: &usize| is_shown(*row) && done[*row] > 0;
    let shown: Vec<Option<f64>> = (0..works.len()).filter(is_finished).map(|row| works[row]).collect();
    let known = || shown.iter().flatten().copied();
    let [low, high] = [f64::min, f64::max]
        .map(|pick: fn(f64, f64) -> f64| known().reduce(pick).map(|work| significant(1e3 * work, 3)));
    let Some((low, high)) = low.zip(high) else { return Ok(Vec::new()) };
    let range = if low == high { low } else { format!("{low} to {high}") };
    let count = known().count();
    let rows =
        if count == shown.len() { String::new() } else { format!(", {count} of {} rows", shown.len()) };
    Ok(wrapped(&format!(
        "Persson-Tosatti, closing and opening: Δγ (1\u{a0}+\u{a0}h'²/2) - U_el = \
         {range}\u{a0}mJ/m²{rows}; h':\u{a0}rms\u{a0}slope."
    )))
}

/// The rows of a sweep under their headings.
fn table(cases: &Frame, rows: &[&Listed], title: &str, results: &Results) -> Result<Vec<String>, StatsError> {
    let mut columns = Vec::new();
    for ((heading, name, factor), width) in results.iter().zip(&WIDTHS[3..]) {
        let cells = rows.iter().map(|listed| mean_sd(cases, name, *factor, listed.row));
        let cells = cells.collect::<Result<Vec<_>, _>>()?;
        columns.push((*heading, Notation::of(heading, &cells, width - 1)));
    }
    let headings = columns.iter().map(|(heading, notation)| notation.heading(heading)).collect();
    let mut lines = labelled(title, ["F_max".to_owned(), "n".to_owned()], four(headings));
    for listed in rows {
        lines.extend(case_lines(cases, listed, results, &columns)?);
    }
    Ok(lines)
}

/// The verdicts on all sweeps, each with the name of its sweep if there are several.
///
/// # Errors
/// If a table lacks a column.
pub fn verdicts_of_sweeps(cases: &Frame, methods: Option<&Frame>) -> Result<Vec<String>, StatsError> {
    let (names, mut all) = (sweeps(cases)?, Vec::new());
    for name in &names {
        let rows: Vec<usize> = listing_of(cases, name)?.iter().map(|listed| listed.row).collect();
        let place =
            if names.len() > 1 && !name.is_empty() { format!("Sweep {name}") } else { "Verdict".to_owned() };
        all.extend(verdicts(cases, methods, &rows)?.iter().map(|sentence| format!("{place}: {sentence}")));
    }
    Ok(all)
}

fn value(cases: &Frame, name: &str, row: usize) -> Result<Option<f64>, StatsError> {
    Ok(cases.f64_or_null(name)?.get(row).copied().flatten())
}

fn mean_sd(cases: &Frame, name: &str, factor: f64, row: usize) -> Result<MeanSd, StatsError> {
    let scaled = |ending: &str| -> Result<Option<f64>, StatsError> {
        Ok(value(cases, &format!("{name}_{ending}"), row)?.map(|value| factor * value))
    };
    Ok((scaled("mean")?, scaled("sd")?))
}

fn case_lines(
    cases: &Frame,
    listed: &Listed,
    of: &Results,
    columns: &[(&str, Notation)],
) -> Result<Vec<String>, StatsError> {
    let count = |name: &str, row: usize| -> Result<i64, StatsError> {
        Ok(cases.i64(name)?.get(row).copied().unwrap_or_default())
    };
    let counts = |row: usize| -> Result<[i64; 2], StatsError> {
        Ok([count("done_count", row)?, count("planned_count", row)?])
    };
    let load = short_load(cases, listed.row)?;
    let [done, planned] = counts(listed.row)?;
    // Means of different surfaces differ by the surfaces too.
    let reference = match listed.reference {
        Some(row) if counts(row)? == [done; 2] && done == planned => Some(row),
        _ => None,
    };
    let (mut results, mut changes) = (Vec::new(), Vec::new());
    for (((_, name, factor), (_, notation)), width) in of.iter().zip(columns).zip(&WIDTHS[3..]) {
        let own = mean_sd(cases, name, *factor, listed.row)?;
        results.push(notation.cell(own, width - 1));
        let other = reference.map(|row| mean_sd(cases, name, *factor, row)).transpose()?;
        let other = other.and_then(|(mean, _)| mean);
        changes.push(own.0.zip(other).and_then(|(own, other)| change(own, other)));
    }
    let label = listed.label.replace(" = ", "=") + if listed.is_reference { "*" } else { "" };
    let mut lines = labelled(&label, [load, format!("{done}/{planned}")], four(results));
    let mut surfaces = Vec::new();
    for (_, name, _) in of {
        let fewer = fewer_surfaces(cases, name, listed.row)?;
        surfaces.push(fewer.map_or_else(String::new, |[count, done]| format!("{count}/{done}")));
    }
    if surfaces.iter().any(|fewer| !fewer.is_empty()) {
        lines.extend(labelled(SURFACES, [String::new(), String::new()], four(surfaces)));
    }
    if changes.iter().any(Option::is_some) {
        let cells = changes.into_iter().map(|change| change.unwrap_or_else(|| "-".to_owned())).collect();
        lines.extend(labelled("  change [%]", [String::new(), String::new()], four(cells)));
    }
    Ok(lines)
}

/// A load reversal with four digits, or with its unit.
fn short_load(cases: &Frame, row: usize) -> Result<String, StatsError> {
    let loads = loads(cases)?;
    if loads.symbol == OVER_MODULUS {
        return Ok(loads.values.get(row).map_or_else(String::new, |load| significant(*load, 4)));
    }
    Ok(loads.all_labels().get(row).cloned().unwrap_or_default())
}

fn four(cells: Vec<String>) -> [String; 4] {
    cells.try_into().unwrap_or_default()
}

/// The relative difference of a mean from that of the reference case, in percent; nothing where the latter is
/// zero.
fn change(own: f64, reference: f64) -> Option<String> {
    let percent = 100.0 * (own - reference) / reference.abs();
    let text = if percent.abs() < 1e4 { format!("{percent:+.1}") } else { format!("{percent:+.1e}") };
    percent.is_finite().then(|| if text == "-0.0" || text == "+0.0" { "0.0".to_owned() } else { text })
}

/// Expected ratios of the results of the asperity model to those of boundary elements, as a sentence; nothing
/// without an expectation.
///
/// # Errors
/// If the table lacks a column.
pub fn expected_ratios(cases: &Frame) -> Result<Option<String>, StatsError> {
    let mut parts = Vec::new();
    for (name, [column, error]) in ["A", "F_po", "Θ"].into_iter().zip(COLUMNS) {
        let errors = cases.f64_or_null(error)?;
        let mut values: Vec<(f64, f64)> = cases
            .f64_or_null(column)?
            .iter()
            .zip(errors.iter())
            .filter_map(|(of, error)| of.zip(*error))
            .collect();
        values.sort_by(|one, other| one.0.total_cmp(&other.0));
        let (Some(low), Some(high)) = (values.first(), values.last()) else { continue };
        let [low, high] = [low, high].map(|(ratio, error)| format!("{ratio:.2} ± {error:.2}"));
        parts.push(if low == high { format!("{name} {low}") } else { format!("{name} {low} to {high}") });
    }
    let parts = parts.join(", ");
    let outdated = outdated().map_or_else(String::new, |text| format!(" {text}"));
    let text = format!(
        "Expected ratio of the asperity model to boundary elements: {parts} (U_el/Δγ of each case, guide: \
         Validity).{outdated}"
    );
    Ok((!parts.is_empty()).then_some(text))
}

/// Lines of [`Shown::Few`].
const FEW: usize = 3;

/// Warnings in one line each: first warnings that are not part of a verdict, then the others. The last line
/// names or counts warnings that are only in the report.
fn few_warnings(cases: &Frame) -> Result<Vec<String>, StatsError> {
    let all = warnings(cases)?;
    if all.is_empty() {
        return Ok(Vec::new());
    }
    let (covered, other): (Vec<&Warning>, Vec<&Warning>) =
        all.iter().partition(|warning| IN_A_VERDICT.contains(&warning.kind.code));
    let row_count = cases.row_count();
    let line = |warning: &&Warning| {
        let head = format!("warning[{}]: {}", warning.kind.code, warning.kind.label);
        let head = if warning.rows.len() == row_count {
            head
        } else {
            format!("{head} ({} of {row_count} rows)", warning.rows.len())
        };
        let whole = format!("{head}: {}", warning.measured);
        if whole.chars().count() <= LINE { whole.replace('\u{a0}', " ") } else { head }
    };
    let mut lines: Vec<String> =
        std::iter::once(String::new()).chain(other.iter().take(FEW - 1).map(line)).collect();
    let left: Vec<&str> =
        other.iter().skip(FEW - 1).chain(&covered).map(|warning| warning.kind.code).collect();
    let last = |more: &str| {
        let first = if more.is_empty() { "C" } else { "c" };
        format!("{more}{first}onsequences and actions: report.html, or --verbose")
    };
    let named = last(&format!("Also {}; ", left.join(", ")));
    lines.push(match left.len() {
        0 => last(""),
        _ if named.chars().count() <= LINE => named,
        count => last(&format!("{}, ", counted(count, "more warning"))),
    });
    Ok(lines)
}

/// The warnings of cases as lines, empty without any: what a quiet run prints of its results.
///
/// # Errors
/// A column is missing.
pub fn warning_text(cases: &Frame) -> Result<String, StatsError> {
    Ok(warning_lines(cases)?.join("\n").trim_start().to_owned())
}

/// One paragraph per warning, with its rows.
fn warning_lines(cases: &Frame) -> Result<Vec<String>, StatsError> {
    let (all, loads) = (listing(cases)?.rows, loads(cases)?.all_labels());
    let mut lines = Vec::new();
    for warning in warnings(cases)? {
        let place = if warning.rows.len() == all.len() {
            String::new()
        } else if warning.rows.len() <= MOST_NAMED {
            let named = all.iter().filter(|listed| warning.rows.contains(&listed.row));
            let names: Vec<String> = named
                .map(|listed| {
                    format!("{}, F_max = {}", listed.label, loads[listed.row]).replace(" = ", "\u{a0}=\u{a0}")
                })
                .collect();
            format!(" ({})", names.join("; "))
        } else {
            format!(" ({} of {} rows)", warning.rows.len(), all.len())
        };
        lines.extend(wrapped(&format!(
            "warning[{}]: {}{place}: {}",
            warning.kind.code, warning.kind.label, warning.measured
        )));
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

/// A mean with its standard deviation over a power of ten, with three significant digits of the larger, or
/// two where three are too wide; nothing where the mean would print as zero, or as a long number.
fn fixed((mean, sd): MeanSd, exponent: i32, width: usize) -> Option<String> {
    let Some(mean) = mean.map(|mean| mean / 10f64.powi(exponent)) else { return Some("-".to_owned()) };
    let sd = sd.map(|sd| sd / 10f64.powi(exponent));
    let largest = mean.abs().max(sd.unwrap_or_default());
    if largest >= LONG {
        return None;
    }
    let text = |digits: usize| {
        let places = decimals(largest, digits);
        let is_lost =
            mean != 0.0 && format!("{:.places$}", mean.abs()).chars().all(|c| matches!(c, '0' | '.'));
        let text =
            sd.map_or_else(|| format!("{mean:.places$}"), |sd| format!("{mean:.places$}±{sd:.places$}"));
        Some(text).filter(|text| !is_lost && text.chars().count() <= width)
    };
    text(3).or_else(|| text(2))
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
fn labelled(
    label: &str,
    [load, count]: [String; 2],
    [area, pull_off, loss, ratio]: [String; 4],
) -> Vec<String> {
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
        // Words are left-aligned, numbers right-aligned.
        let parts = if at == 0 { [cell, gap] } else { [gap, cell] };
        text.extend(parts);
    }
    text.trim_end().to_owned()
}

fn cut(text: &str, width: usize) -> String {
    if text.chars().count() <= width {
        text.to_owned()
    } else {
        text.chars().take(width.saturating_sub(1)).chain(['…']).collect()
    }
}
