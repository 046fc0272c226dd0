//! The table that a person reads at the end of a run.

use super::StatsError;
use super::varying::{Values, Varying, varying};
use crate::store::Frame;

/// Widths of the columns: case, max load, realizations, and four results; 80 letters together.
const WIDTHS: [usize; 7] = [18, 8, 6, 12, 12, 12, 12];

const HEADER: &str = "\
Mean ± standard deviation over realizations. F_max, F_po: loads over E* A0; Θ:
loss over E* A0 h_rms; all in 1e-3. A: contact area over A0. n: done/planned.";

/// The results of every case as lines of at most 80 letters, grouped by sweep and ordered by what varies.
///
/// # Errors
/// If the table lacks one of its columns.
pub fn summary(cases: &Frame) -> Result<String, StatsError> {
    let sweeps = cases.text("sweep")?;
    let max_loads = cases.f64("max_load")?;
    let mut names = sweeps.clone();
    names.sort_unstable();
    names.dedup();
    let mut lines = vec![HEADER.to_owned()];
    for name in names {
        let mut rows: Vec<usize> = (0..sweeps.len()).filter(|row| sweeps.get(*row) == Some(&name)).collect();
        let differing = varying(cases, &rows)?;
        let places: Vec<usize> = {
            let mut places: Vec<usize> = (0..rows.len()).collect();
            let load = |place: &usize| rows.get(*place).and_then(|row| max_loads.get(*row)).copied().unwrap_or_default();
            places.sort_by(|a, b| order(&differing, *a, *b).then(load(a).total_cmp(&load(b))));
            places
        };
        let labels: Vec<String> = places.iter().map(|place| label(cases, &differing, &rows, *place)).collect::<Result<_, _>>()?;
        rows = places.iter().filter_map(|place| rows.get(*place).copied()).collect();
        lines.push(String::new());
        let title = if name.is_empty() { "case" } else { name };
        lines.push(line([title, "F_max", "n", "A", "F_po", "Θ", "Θ/Θ_DK"].map(str::to_owned)));
        for (row, label) in rows.into_iter().zip(labels) {
            lines.extend(case_lines(cases, row, label)?);
        }
    }
    lines.push(String::new());
    Ok(lines.join("\n"))
}

fn order(differing: &[Varying], a: usize, b: usize) -> std::cmp::Ordering {
    let compared = differing.iter().map(|parameter| match &parameter.values {
        Values::Numbers(numbers) => {
            let number = |at: usize| numbers.get(at).copied().flatten().unwrap_or(f64::INFINITY);
            number(a).total_cmp(&number(b))
        }
        Values::Words(words) => words.get(a).cmp(&words.get(b)),
    });
    compared.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
}

/// What tells the case from the others of its sweep; its identity, shortened, if nothing does.
fn label(cases: &Frame, differing: &[Varying], rows: &[usize], place: usize) -> Result<String, StatsError> {
    if differing.is_empty() {
        let ids = cases.text("case_id")?;
        return Ok(rows.get(place).and_then(|row| ids.get(*row)).map_or_else(String::new, |id| id.chars().take(12).collect()));
    }
    let shown = |parameter: &Varying| match parameter.values {
        Values::Numbers(_) => format!("{}={}", parameter.symbol, parameter.text(place)),
        Values::Words(_) => parameter.text(place),
    };
    Ok(differing.iter().map(shown).collect::<Vec<_>>().join(" "))
}

fn case_lines(cases: &Frame, row: usize, label: String) -> Result<Vec<String>, StatsError> {
    let value = |name: &str| -> Result<Option<f64>, StatsError> { Ok(cases.f64_or_null(name)?.get(row).copied().flatten()) };
    let pair = |name: &str, unit: f64| -> Result<String, StatsError> {
        let (mean, sd) = (value(&format!("{name}_mean"))?, value(&format!("{name}_sd"))?);
        Ok(mean_and_sd(mean.map(|mean| mean / unit), sd.map(|sd| sd / unit)))
    };
    let count = |name: &str| -> Result<i64, StatsError> { Ok(cases.i64(name)?.get(row).copied().unwrap_or_default()) };
    let load = value("max_load")?.map_or_else(String::new, |load| plain(load * 1e3));
    let counts = format!("{}/{}", count("done_count")?, count("planned_count")?);
    let results = [pair("area_at_max_load", 1.0)?, pair("pull_off_load", 1e-3)?, pair("loss", 1e-3)?, pair("loss_ratio_dk", 1.0)?];
    let [area, pull_off, loss, ratio] = results;
    let mut lines = vec![line([label, load, counts, area, pull_off, loss, ratio])];
    let caution = cases.text("caution")?.get(row).copied().unwrap_or_default();
    if !caution.is_empty() {
        lines.extend(caution_lines(caution));
    }
    Ok(lines)
}

/// The cautions of a row, as many on a line as fit.
fn caution_lines(joined: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in joined.split('+') {
        match lines.last_mut().filter(|line| line.chars().count() + 2 + word.chars().count() <= 79) {
            Some(line) => {
                line.push_str(", ");
                line.push_str(word);
            }
            None => {
                // A comma ends each line that another one follows.
                if let Some(line) = lines.last_mut() {
                    line.push(',');
                }
                lines.push(format!("  {}{word}", if lines.is_empty() { "caution: " } else { "         " }));
            }
        }
    }
    lines
}

/// A load in thousandths, with as many digits as it has.
fn plain(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn mean_and_sd(mean: Option<f64>, sd: Option<f64>) -> String {
    let Some(mean) = mean else {
        return "-".to_owned();
    };
    let greatest = mean.abs().max(sd.unwrap_or_default().abs());
    // Five letters for each number, so that both fit their column; numbers beyond are written with an exponent, without spread.
    let digits = match greatest {
        size if size < 10.0 => 3,
        size if size < 100.0 => 2,
        size if size < 1000.0 => 1,
        size if size < 1e5 => 0,
        _ => return format!("{mean:.2e}"),
    };
    match sd {
        Some(sd) => format!("{mean:.digits$}±{sd:.digits$}"),
        None => format!("{mean:.digits$}"),
    }
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
