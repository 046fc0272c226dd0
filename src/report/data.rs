//! Parts of the report: data access and citation.

use super::layout::{heading, line, prose};
use maud::{Markup, html};

const DATA: &str = "All numbers of this report are in the tables of this folder. `datapackage.json` describes each column with unit and \
    equation. `statistics/panels.parquet` holds the data of the figures. In Python, with the folder of this report as working directory:";

const PYTHON: &str = r#"import polars as pl          # or pandas: pd.read_parquet, or DuckDB: SELECT * FROM 'statistics/cases.parquet'
cases = pl.read_parquet("statistics/cases.parquet")
print(cases.select("case_id", "max_load", "loss_mean", "loss_ci95_low", "loss_ci95_high"))
# All events with the parameters of their cycle. Cases that share a cycle have one row each in the table cycles: keep one of them.
cycles = pl.scan_parquet("statistics/cycles.parquet").drop("case_id", "realization").unique("cycle_id")
events = pl.scan_parquet("cycles/*/events.parquet").join(cycles, on="cycle_id").collect()"#;

const R: &str = r#"cases <- read.csv("csv/cases.csv")
plot(cases$area_at_max_load_mean, cases$loss_mean)"#;

const CITATION: &str = "Model: G. Violano and L. Afferrante, “Roughness-induced adhesive hysteresis in self-affine fractal surfaces”, \
    Lubricants 9(1):7, 2021, with corrected equations; the guide of hysteron lists the corrections. The provenance records in `receipts/` state program, \
    commit and compiler of each file.";

/// Data access and citation.
pub(super) fn usage() -> Markup {
    html! {
        (heading("Data"))
        (line(&html! { p { (prose(DATA)) } }))
        (line(&html! { pre { (PYTHON) } }))
        (line(&html! { p { (prose("In R, after `hysteron export csv .`:")) } }))
        (line(&html! { pre { (R) } }))
        (heading("Citation"))
        (line(&html! { p { "Computed with hysteron " (env!("CARGO_PKG_VERSION")) " (MIT OR Apache-2.0). " (prose(CITATION)) } }))
    }
}
