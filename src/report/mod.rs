//! HTML pages from tables and figures: the report of a run and the page of a comparison.
//!
//! Templates are compiled and escape all text. Only drawings and the style are inserted as they are.

mod cases;
mod comparison;
mod data;
mod experiment;
mod failures;
mod grids;
mod header;
mod layout;
mod live;
mod methods;
mod numbers;
mod paragraph;
mod results;
mod scans;
mod single_cycle;
mod spectra;
mod theories;
mod validity;
mod works;

pub use comparison::{Compared, comparison_page};
pub use experiment::MeasuredLoops;
pub use failures::Failure;
pub use grids::Grids;
pub use live::{LiveLoop, LiveRun, LiveStage, live_page};
pub use methods::MethodFigures;
pub use single_cycle::SingleCycle;
pub use spectra::ScanSpectra;
pub use works::{Works, simulated as simulated_works};

use crate::figures::{Drawing, Panel};
use crate::stats::StatsError;
use crate::store::Frame;
use crate::store::hdf5::SurfaceHeader;
use crate::text::counted;
use cases::Cases;
use layout::{Numbers, document, grids, heading, legend, prose, switch};
use maud::{Markup, PreEscaped, html};
use paragraph::Study;

/// Content of the report of a run.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// Name of the run.
    pub name: &'a str,
    /// Key of the report.
    pub key: &'a str,
    /// Numbers of cases by the asperity model and by boundary elements.
    pub case_counts: [usize; 2],
    /// Seed of the surfaces.
    pub seed: u64,
    /// Number of realizations in words.
    pub realizations_text: &'a str,
    /// Failed cycles by reason.
    pub failures: &'a [Failure],
    /// Number of planned cycles.
    pub cycle_count: usize,
    /// Table `cases`.
    pub cases: &'a Frame,
    /// Table `realizations`.
    pub realizations: &'a Frame,
    /// Table `methods`.
    pub methods: &'a Frame,
    /// True if the page opens with SI units: the spec has a probe, or loads in newtons or pascals.
    pub is_in_si: bool,
    /// Formats of the files of the figures.
    pub formats: &'a [&'static str],
    /// Relative differences from the reference case.
    pub sensitivity: Option<&'a Drawing>,
    /// Figures of both methods.
    pub method_figures: &'a MethodFigures,
    /// Files of the measured surfaces.
    pub scans: &'a [SurfaceHeader],
    /// Spectra of the scans of `surface.files`, if the spec has any.
    pub scan_spectra: Option<&'a ScanSpectra>,
    /// Measured loops, if the spec has any.
    pub measured_loops: Option<&'a MeasuredLoops>,
    /// Discretization errors of boundary elements.
    pub grids: Option<&'a Grids>,
    /// Works of adhesion over the cut-off wavelength.
    pub works: Option<&'a Works>,
    /// Names of the sweeps with figures, in order; those of common figures are joined by `+`.
    pub sweeps: &'a [String],
    /// Panels, each with the name of its sweep.
    pub drawings: &'a [(String, Panel)],
    /// Single cycles, one for each method.
    pub cycles: &'a [SingleCycle],
    /// Data of the explorer as JSON.
    pub explorer: Option<&'a str>,
    /// Spec with all defaults.
    pub spec: &'a str,
}

/// The report as HTML.
///
/// # Errors
/// If a table lacks a column.
pub fn page(report: &Report<'_>) -> Result<String, StatsError> {
    let cases = Cases::of(report.cases, report.realizations)?;
    let numbers = Numbers::of(report.formats);
    // Without a finished cycle there is nothing to show but the plan.
    let has_results = report.cases.i64("done_count")?.iter().any(|count| *count > 0);
    let body = html! {
        (results::results(&cases)?)
        @if let Some(loops) = report.measured_loops { (experiment::section(loops, &cases, &numbers)?) }
        @if has_results {
            @for sweep in report.sweeps { (figures(report, sweep, &numbers)) }
            @if !report.cycles.is_empty() { (single_cycle::section(&numbers, report.cycles)) }
            @if let Some(data) = report.explorer { (explorer(data, cases.has_spots()?)) }
        }
        (results::changes(&cases)?)
        @if let Some(chart) = report.sensitivity {
            (heading("Sensitivity")) (layout::figure(&numbers, chart))
        }
        (methods::side_by_side(&cases, report.methods, report.method_figures, &numbers)?)
        (scans::scans(report.scans))
        @if let Some(spectra) = report.scan_spectra { (spectra::section(spectra, &numbers)?) }
        @if has_results {
            @if let Some(of) = report.grids {
                @if let Some(section) = grids::section(of, &cases, &numbers)? { (section) }
            }
            (theories::theories(&cases)?)
            @if let Some(of) = report.works { (works::section(of, &cases, &numbers)?) }
            (validity::budget(&cases)?)
            (validity::validity(&cases)?)
        }
        (provenance(report, has_results)?)
    };
    let body = body.into_string();
    let page = html! {
        header {
            h1 { (report.name) } "\n"
            (failures::failures(report.failures, report.cycle_count))
            @if has_results {
                (header::banner(report.cases, report.methods)?)
            } @else if report.failures.is_empty() {
                div.banner.amber role="note" { p { b { "No results: no surface finished." } " `hysteron run` \
                     computes the pending cycles." } } "\n"
            }
            @if has_results { (switch(report.is_in_si)) }
            (header::contents(&body))
        }
        "\n"
        (PreEscaped(&body))
    };
    Ok(document(&format!("{}: adhesive hysteresis", report.name), Some(report.key), &page))
}

/// Parameters, texts for a publication, data access and the spec.
fn provenance(report: &Report<'_>, has_results: bool) -> Result<Markup, StatsError> {
    let study = Study {
        case_counts: report.case_counts,
        realizations_text: report.realizations_text,
        seed: report.seed,
        is_measured: !report.scans.is_empty(),
    };
    Ok(html! {
        (heading("Parameters"))
        p { (introduction(report)) } "\n"
        (header::facts(report.cases, report.seed, report.realizations_text)?)
        @if has_results {
            (paragraph::methods(report.cases, &study)?)
            (data::usage())
        }
        (data::citation(report.case_counts))
        (heading("Spec with all defaults"))
        details { summary { "TOML" } pre { (report.spec) } } "\n"
    })
}

const EXPLORER_NOTE: &str = "One cycle of each case. The slider moves along the loop.";

const SPOTS_NOTE: &str = " Rings mark the events of a step or of an avalanche. Contacts between stored steps \
    follow from the events; `contacts = \"all\"` in the spec stores every step.";

const MAPS_NOTE: &str = " The map is the stored one that is nearest on the loop.";

/// The explorer of a loop, which needs a browser with scripts.
fn explorer(data: &str, has_spots: bool) -> Markup {
    html! {
        section.screen {
            (heading("Loop explorer"))
            p { (EXPLORER_NOTE) (prose(if has_spots { SPOTS_NOTE } else { MAPS_NOTE })) } "\n"
            div #explorer { noscript { p { "This part needs a browser with scripts." } } } "\n"
            script #explorer-data type="application/json" { (PreEscaped(data)) } "\n"
            script { (PreEscaped(include_str!("explorer.js"))) } "\n"
        }
        "\n"
    }
}

/// The figures of a sweep with their legend.
fn figures(report: &Report<'_>, sweep: &str, numbers: &Numbers<'_>) -> Markup {
    let panels: Vec<&Panel> =
        report.drawings.iter().filter(|(of, _)| of == sweep).map(|(_, panel)| panel).collect();
    html! {
        // A run without sweeps has the cases of its base.
        (heading(&match sweep {
            "" | "base" => "Figures".to_owned(),
            joined if joined.contains('+') => format!("Sweeps {}", joined.replace('+', ", ")),
            one => format!("Sweep {one}"),
        }))
        @if panels.is_empty() {
            p { "No cycle of this sweep has finished." } "\n"
        } @else {
            section {
                (legend(panels.first().map_or(&[], |panel| &panel.cases))) (grids(numbers, &panels))
            } "\n"
        }
    }
}

const SYMBOLS: &str = "E*: reduced modulus; A_{0}: nominal area; h_{rms}: root-mean-square height; Δγ: work \
    of adhesion; Δ: mean penetration; F: normal load, positive in compression.";

const ASPERITIES: &str = "Interacting asperities of Johnson, Kendall and Roberts (JKR) after Violano and \
     Afferrante, Lubricants 9(1):7 (2021), with corrected equations. ";

const ELEMENTS: &str = "Adhesive boundary elements: the rough surface on a grid, loaded and unloaded under \
     displacement control. ";

/// Number of cases and realizations, methods and symbols.
fn introduction(report: &Report<'_>) -> Markup {
    let [asperities, elements] = report.case_counts;
    html! {
        "Adhesive hysteresis of rough surfaces: " (counted(asperities + elements, "case")) ", "
        (report.realizations_text) " each. "
        @if asperities > 0 { (ASPERITIES) }
        @if elements > 0 { (ELEMENTS) }
        (prose(SYMBOLS))
    }
}
