//! Parts of the report: data access and citation.

use super::layout::{heading, line, prose};
use crate::citation::bibtex;
use maud::{Markup, html};

const DATA: &str = "All numbers of this report are in the tables of this folder. `datapackage.json` \
    describes each column with unit and equation. `statistics/panels.parquet` holds the data of the figures. \
    In Python, with the folder of this report as working directory:";

const PYTHON: &str = concat!(
    "import polars as pl          # or pandas: pd.read_parquet, or DuckDB: SELECT * FROM \
     'statistics/cases.parquet'\n",
    "cases = pl.read_parquet(\"statistics/cases.parquet\")\n",
    "print(cases.select(\"case_id\", \"max_load\", \"loss_mean\", \"loss_ci95_low\", \"loss_ci95_high\"))\n",
    "# All events with the parameters of their cycle. Cases that share a cycle have one row each in the \
     table cycles: keep one of them.\n",
    "cycles = pl.scan_parquet(\"statistics/cycles.parquet\")\
     .drop(\"case_id\", \"realization\", \"method\", \"status\").unique(\"cycle_id\")\n",
    "events = pl.scan_parquet(\"cycles/*/events.parquet\").join(cycles, on=\"cycle_id\").collect()",
);

const R: &str = r#"cases <- read.csv("csv/cases.csv")
plot(cases$area_at_max_load_mean, cases$loss_mean)"#;

const CITATION: &str = "These entries are the program, its methods and the models whose estimates are next \
    to the results; `hysteron cite` prints them for a run. The equations of Violano and Afferrante are \
    corrected; the guide of hysteron lists the corrections. The provenance records in `receipts/` state \
    program, commit and compiler of each file.";

/// Files and folders of the run that the page links.
const FILES: [&str; 5] = ["campaign.toml", "datapackage.json", "statistics/", "figures/", "receipts/"];

/// Data access.
pub(super) fn usage() -> Markup {
    html! {
        (heading("Data"))
        (line(&html! { p { (prose(DATA)) } }))
        (line(&html! { pre.copy { (PYTHON) } }))
        (line(&html! { p { (prose("In R, after `hysteron export csv .`:")) } }))
        (line(&html! { pre { (R) } }))
    }
}

/// Citation and files.
pub(super) fn citation(case_counts: [usize; 2]) -> Markup {
    html! {
        (heading("Citation"))
        (line(&html! {
            p {
                "Computed with hysteron " (env!("CARGO_PKG_VERSION")) " (MIT OR Apache-2.0). "
                (prose(CITATION))
            }
        }))
        (line(&html! { pre.copy { (bibtex(case_counts)) } }))
        (line(&html! {
            p {
                "Files: "
                @for (place, name) in FILES.iter().enumerate() {
                    @if place > 0 { " · " } a href=(name) { (name) }
                }
            }
        }))
    }
}
