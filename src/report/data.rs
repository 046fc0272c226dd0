//! Parts of the report: data access and citation.

use super::layout::{heading, line, prose};
use crate::citation::bibtex;
use crate::stats::{StatsError, labels_with_unit};
use crate::store::Frame;
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

/// Parts of a study.
pub(super) struct Study<'a> {
    /// Numbers of cases by the asperity model and by boundary elements.
    pub(super) case_counts: [usize; 2],
    /// Number of realizations in words.
    pub(super) realizations_text: &'a str,
    pub(super) seed: u64,
    /// True if surfaces are measured.
    pub(super) is_measured: bool,
}

/// A paragraph that describes the method, to be adapted for a publication.
pub(super) fn methods(cases: &Frame, study: &Study<'_>) -> Result<Markup, StatsError> {
    let [asperities, elements] = study.case_counts;
    let range = |column: &str| -> Result<Option<String>, StatsError> {
        let values: Vec<f64> = cases.f64_or_null(column)?.iter().flatten().copied().collect();
        let [low, high] =
            [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick));
        Ok(low.zip(high).map(|(low, high)| {
            let texts = labels_with_unit(column, &[low, high]);
            if low == high { texts[..1].concat() } else { texts.join(" to ") }
        }))
    };
    let mut text = unfinished(cases)?;
    if let (Some(zeta), Some(hurst)) = (range("magnification")?, range("hurst")?) {
        text += &format!(
            "Self-affine rough surfaces with Hurst exponent H = {hurst} and magnification ζ = {zeta} were \
             generated from their power spectrum ({} per case, seed {}). ",
            study.realizations_text, study.seed
        );
    }
    if study.is_measured {
        text += "Measured surfaces were levelled, filtered and cropped as listed in this report. ";
    }
    let program = concat!("hysteron ", env!("CARGO_PKG_VERSION"));
    if asperities > 0 {
        text += &format!(
            "Loading–unloading cycles of elastically interacting JKR asperities were computed with {program} \
             after Violano and Afferrante (2021), with corrected equations. "
        );
    }
    if elements > 0 {
        text += &format!(
            "Adhesive boundary-element cycles under displacement control were computed with {program}. "
        );
    }
    for (words, column) in [
        ("The reduced modulus was E* = ", "contact_modulus_pa"),
        ("the work of adhesion Δγ = ", "work_of_adhesion_j_m2"),
        ("the rms height h_rms = ", "rms_height_m"),
        ("the side of the nominal area L = ", "length_m"),
    ] {
        text += &range(column)?.map_or_else(String::new, |range| format!("{words}{range}, "));
    }
    text += &format!("the maximum load F_max/(E*A₀) = {}. ", range("max_load")?.unwrap_or_default());
    text += "The dissipated energy Θ is the area of the force–penetration loop. ";
    // Of one surface there is neither a mean nor an interval.
    text += if cases.i64("done_count")?.iter().any(|count| *count > 1) {
        "Values are means over surfaces with 95 % confidence intervals (Student)."
    } else {
        "Values are those of one surface."
    };
    Ok(html! { (heading("Methods paragraph")) pre.text.copy { (text) } "\n" })
}

/// A sentence on planned cycles without a result; empty if all have one.
fn unfinished(cases: &Frame) -> Result<String, StatsError> {
    let (ids, done, planned) =
        (cases.text("case_id")?, cases.i64("done_count")?, cases.i64("planned_count")?);
    let firsts: Vec<usize> =
        (0..ids.len()).filter(|row| ids.iter().position(|id| id == &ids[*row]) == Some(*row)).collect();
    let sum = |counts: &[i64]| firsts.iter().map(|row| counts[*row]).sum::<i64>();
    let (done, planned) = (sum(&done), sum(&planned));
    Ok(if done < planned {
        format!("Results exist for {done} of {planned} planned cycles. ")
    } else {
        String::new()
    })
}

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
