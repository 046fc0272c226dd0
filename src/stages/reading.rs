//! The parts of the report that are about the report: the numbers with their intervals, how to load them, how to cite them.

use super::StageError;
use super::trust::{Cases, Shown, shown};
use crate::store::Frame;
use std::fmt::Write as _;

/// Heading, column of the table `cases` without its ending, and what numbers are multiplied by.
const RESULTS: [(&str, &str, f64); 7] = [
    ("A/A<sub>0</sub>", "area_at_max_load", 1.0),
    ("Δ/h<sub>rms</sub>", "penetration_at_max_load", 1.0),
    ("F<sub>po</sub>/(E*A<sub>0</sub>), 1e-3", "pull_off_load", 1e3),
    ("Θ/(E*A<sub>0</sub>h<sub>rms</sub>), 1e-3", "loss", 1e3),
    ("Θ<sub>DK</sub>, 1e-3", "loss_dk", 1e3),
    ("Θ/Θ<sub>DK</sub>", "loss_ratio_dk", 1.0),
    ("Θ<sub>DK</sub> with the surfaces’ own moments, 1e-3", "loss_dk_realised", 1e3),
];

/// The results with the 95 % intervals of their means, and how many realizations they are of.
pub(super) fn results(html: &mut String, cases: &Frame) -> Result<(), StageError> {
    let (done, planned, failed) = (cases.i64("done_count")?, cases.i64("planned_count")?, cases.i64("failed_count")?);
    let cases = Cases::of(cases)?;
    html.push_str(
        "<h2>Results</h2>\n<p>Means over realizations at the end of loading, F<sub>po</sub> while unloading, and Θ of the whole loop; in brackets the 95 % \
         interval of the mean (Student), which takes two realizations.</p>\n<div class=\"wide\"><table>\n<tr><th>case</th><th>max load</th><th>done of planned</th>",
    );
    for (heading, ..) in RESULTS {
        let _ = write!(html, "<th>{heading}</th>");
    }
    html.push_str("</tr>\n");
    for row in cases.rows() {
        let lost = if failed[row] > 0 { format!(", {} failed", failed[row]) } else { String::new() };
        let _ = write!(html, "<tr>{}<td>{} of {}{lost}</td>", cases.name(row), done[row], planned[row]);
        for (_, column, unit) in RESULTS {
            let number = |end: &str| Ok::<_, StageError>(cases.number(&format!("{column}_{end}"), row)?.map(|number| unit * number));
            let text = |number: Option<f64>| shown(number, Shown::Plain);
            let (mean, low, high) = (number("mean")?, number("ci95_low")?, number("ci95_high")?);
            let interval = if low.is_some() { format!(" [{}, {}]", text(low), text(high)) } else { String::new() };
            let _ = write!(html, "<td>{}{interval}</td>", text(mean));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    Ok(())
}

/// How to load the tables, and how to cite them.
pub(super) fn usage(html: &mut String) {
    let _ = write!(
        html,
        "<h2>The data</h2>\n<p>Every number of this page stands in a table beside it; <code>datapackage.json</code> says what each column means, in which unit, \
         and from which equation. What the panels show is in <code>statistics/panels.parquet</code>. In Python, in the folder of this page:</p>\n\
         <pre>import polars as pl          # or pandas: pd.read_parquet, or DuckDB: SELECT * FROM 'statistics/cases.parquet'\n\
         cases = pl.read_parquet(\"statistics/cases.parquet\")\n\
         print(cases.select(\"case_id\", \"max_load\", \"loss_mean\", \"loss_ci95_low\", \"loss_ci95_high\"))\n\
         steps = pl.read_parquet(\"cycles/*/steps.parquet\", include_file_paths=\"file\")   # all cycles, step by step</pre>\n<p>In R:</p>\n\
         <pre>library(arrow)\ncases &lt;- read_parquet(\"statistics/cases.parquet\")\nplot(cases$area_at_max_load_mean, cases$loss_mean)</pre>\n\
         <h2>How to cite</h2>\n<p>Computed with hysteron {} (Rust; MIT OR Apache-2.0). The model is that of G. Violano and L. Afferrante, \
         “Roughness-induced adhesive hysteresis in self-affine fractal surfaces”, Lubricants 9(1):7, 2021, with its slips corrected as the README of hysteron \
         lists them. Which program, commit and compiler made each file is in <code>receipts/</code>.</p>\n",
        env!("CARGO_PKG_VERSION")
    );
}
