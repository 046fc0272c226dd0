//! Parts of the report: results with confidence intervals, data access and citation.

use super::StageError;
use super::page::escape;
use super::trust::{Cases, ENERGIES, NAME_HEADS, Scale, Shown, scaled, shown};
use crate::stats::{Difference, FEW, difference_of, singles};
use std::fmt::Write as _;

/// Heading, column of the table `cases` without its ending, and whether the quantity cannot be negative.
const RESULTS: [(&str, &str, bool); 7] = [
    ("A/A<sub>0</sub>", "area_at_max_load", true),
    ("Δ/h<sub>rms</sub>", "penetration_at_max_load", false),
    ("F<sub>po</sub>/(E*A<sub>0</sub>)", "pull_off_load", true),
    ("Θ/(E*A<sub>0</sub>h<sub>rms</sub>)", "loss", true),
    ("Θ<sub>DK</sub>, target spectrum", "loss_dk", true),
    ("Θ/Θ<sub>DK</sub>", "loss_ratio_dk", true),
    ("Θ<sub>DK</sub>, realised spectrum", "loss_dk_realised", true),
];

/// Quantities compared with the reference case.
const CHANGES: [(&str, &str); 5] = [
    ("A/A<sub>0</sub>", "area_at_max_load"),
    ("Δ/h<sub>rms</sub>", "penetration_at_max_load"),
    ("F<sub>po</sub>", "pull_off_load"),
    ("Θ", "loss"),
    ("Θ/Θ<sub>DK</sub>", "loss_ratio_dk"),
];

/// The results with confidence intervals or values of single surfaces, and the number of realizations.
pub(super) fn results(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    let count = |name: &str| cases.frame.i64(name);
    let (done, planned, failed) = (count("done_count")?, count("planned_count")?, count("failed_count")?);
    let _ = write!(
        html,
        "<h2>Results</h2>\n<p>Means over realizations: contact area A and mean penetration Δ at load reversal, pull-off force F<sub>po</sub> (maximum tensile \
         load during unloading), dissipated energy Θ (area of the loop), and its estimate Θ<sub>DK</sub> by Deng and Kesari (target spectrum). Brackets: \
         95 % confidence interval of the mean (Student). A lower limit below 0 of a quantity that cannot be negative is replaced by 0 and marked with †. \
         Braces: values of the single surfaces, for fewer than {FEW}. A power of ten in a column head is the unit of \
         its numbers.{}</p>\n<div class=\"wide\"><table>\n{NAME_HEADS}<th>finished of planned</th>",
        cases.reference().map_or_else(String::new, |of| format!(
            " Reference case: {}. It belongs to the most sweeps; the other cases are named by the parameters that differ from it.",
            escape(of)
        ))
    );
    let mut scales = Vec::new();
    for (heading, column, _) in RESULTS {
        let scale = if ENERGIES.contains(&column) { cases.scale(&ENERGIES)? } else { cases.scale(&[column])? };
        let _ = write!(html, "<th>{heading}{}</th>", scale.head());
        scales.push(scale);
    }
    html.push_str("</tr>\n");
    for listed in cases.rows() {
        let row = listed.row;
        let lost = if failed[row] > 0 { format!(", {} failed", failed[row]) } else { String::new() };
        let _ = write!(html, "<tr>{}<td>{} of {}{lost}</td>", cases.name(listed), done[row], planned[row]);
        for ((_, column, positive), scale) in RESULTS.into_iter().zip(&scales) {
            let _ = write!(html, "<td>{}</td>", result(cases, row, column, (*scale, positive))?);
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    changes(html, cases)
}

/// A mean with its confidence interval, or with the values of the single surfaces.
fn result(cases: &Cases<'_>, row: usize, column: &str, (scale, positive): (Scale, bool)) -> Result<String, StageError> {
    let number = |end: &str| cases.number(&format!("{column}_{end}"), row);
    let (mean, low, high) = (number("mean")?, number("ci95_low")?, number("ci95_high")?);
    let text = |number: f64| scaled(Some(number), scale);
    let values = singles(cases.frame, cases.realizations, row, column)?;
    let spread = match (low, high) {
        (Some(_), Some(_)) if values.len() < FEW => {
            format!(" {{{}}}", values.iter().map(|value| text(*value)).collect::<Vec<_>>().join("; "))
        }
        (Some(low), Some(high)) => {
            let cut = positive && low < 0.0 && mean.is_some_and(|mean| mean >= 0.0);
            format!(" [{}, {}]", if cut { "0†".to_owned() } else { text(low) }, text(high))
        }
        _ => String::new(),
    };
    Ok(format!("{}{spread}", scaled(mean, scale)))
}

/// Differences of the means of each case from those of the reference case at the same load; empty without such a case.
fn changes(html: &mut String, cases: &Cases<'_>) -> Result<(), StageError> {
    let compared = || cases.rows().iter().filter_map(|listed| listed.reference.map(|reference| (listed, reference)));
    if compared().next().is_none() {
        return Ok(());
    }
    let _ = write!(
        html,
        "<h2>Differences from the reference case</h2>\n<p>Difference of the means from the reference case at the same load, as a fraction of its mean, with the \
         half-width of the 95 % confidence interval: surface by surface where both cases have the same surfaces, otherwise of two independent means \
         (Welch). Differences larger than their half-width are bold.</p>\n<div class=\"wide\"><table>\n{NAME_HEADS}"
    );
    for (heading, _) in CHANGES {
        let _ = write!(html, "<th>{heading}</th>");
    }
    html.push_str("</tr>\n");
    for (listed, reference) in compared() {
        let _ = write!(html, "<tr>{}", cases.name(listed));
        for (_, column) in CHANGES {
            let found = difference_of(cases.frame, cases.realizations, [listed.row, reference], column)?;
            let clear = found.is_some_and(|found| found.ci95.is_some_and(|half| found.of.abs() > half));
            let share = |found: Difference, part: f64| Some(part / found.means[1].abs()).filter(|share| share.is_finite());
            let change = found.and_then(|found| share(found, found.of));
            let half = found.and_then(|found| found.ci95.and_then(|half| share(found, half)));
            let half = half.map_or_else(String::new, |half| format!(" (±\u{a0}{})", shown(Some(half), Shown::Percent)));
            let class = if clear { " class=\"clear\"" } else { "" };
            let _ = write!(html, "<td{class}>{}{half}</td>", shown(change, Shown::Percent));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    Ok(())
}

/// Data access and citation.
pub(super) fn usage(html: &mut String) {
    let _ = write!(
        html,
        "<h2>Data</h2>\n<p>All numbers of this report are in the tables of this folder. <code>datapackage.json</code> describes each column with unit and \
         equation. <code>statistics/panels.parquet</code> holds the data of the figures. In Python, with the folder of this report as working directory:</p>\n\
         <pre>import polars as pl          # or pandas: pd.read_parquet, or DuckDB: SELECT * FROM 'statistics/cases.parquet'\n\
         cases = pl.read_parquet(\"statistics/cases.parquet\")\n\
         print(cases.select(\"case_id\", \"max_load\", \"loss_mean\", \"loss_ci95_low\", \"loss_ci95_high\"))\n\
         # All events with the parameters of their cycle. Cases that share a cycle have one row each in the table cycles: keep one of them.\n\
         cycles = pl.scan_parquet(\"statistics/cycles.parquet\").drop(\"case_id\", \"realization\").unique(\"cycle_id\")\n\
         events = pl.scan_parquet(\"cycles/*/events.parquet\").join(cycles, on=\"cycle_id\").collect()</pre>\n<p>In R, after <code>hysteron export csv .</code>:</p>\n\
         <pre>cases &lt;- read.csv(\"csv/cases.csv\")\nplot(cases$area_at_max_load_mean, cases$loss_mean)</pre>\n\
         <h2>Citation</h2>\n<p>Computed with hysteron {} (MIT OR Apache-2.0). Model: G. Violano and L. Afferrante, \
         “Roughness-induced adhesive hysteresis in self-affine fractal surfaces”, Lubricants 9(1):7, 2021, with corrected equations; \
         the guide of hysteron lists the corrections. The provenance records in <code>receipts/</code> state program, commit and compiler of each file.</p>\n",
        env!("CARGO_PKG_VERSION")
    );
}
