//! HTML pages from tables and figures: the report of a run and the page of a comparison.
//!
//! Templates are compiled and escape all text. Only drawings and the style are inserted as they are.

mod cases;
mod comparison;
mod data;
mod layout;
mod methods;
mod numbers;
mod results;
mod scans;
mod single_cycle;
mod theories;
mod validity;

pub use comparison::{Compared, comparison_page};
pub use methods::{ContactMaps, MethodFigures};
pub use single_cycle::SingleCycle;

use crate::figures::Panel;
use crate::stats::{StatsError, summary};
use crate::store::Frame;
use crate::store::hdf5::SurfaceHeader;
use crate::text::counted;
use cases::Cases;
use layout::{document, grid, heading, prose};
use maud::{Markup, html};

/// Content of the report of a run.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// Name of the run.
    pub name: &'a str,
    /// Key of the report.
    pub key: &'a str,
    /// Numbers of cases by the asperity model and by boundary elements.
    pub case_counts: [usize; 2],
    /// Number of realizations in words.
    pub realizations_text: &'a str,
    /// Table `cases`.
    pub cases: &'a Frame,
    /// Table `realizations`.
    pub realizations: &'a Frame,
    /// Table `methods`.
    pub methods: &'a Frame,
    /// Figures of both methods.
    pub method_figures: &'a MethodFigures,
    /// Files of the measured surfaces.
    pub scans: &'a [SurfaceHeader],
    /// Names of the sweeps, in order.
    pub sweeps: &'a [String],
    /// Panels, each with the name of its sweep.
    pub drawings: &'a [(String, Panel)],
    /// A single cycle.
    pub cycle: Option<&'a SingleCycle>,
    /// Spec with all defaults.
    pub spec: &'a str,
}

/// The report as HTML.
///
/// # Errors
/// If a table lacks a column.
pub fn page(report: &Report<'_>) -> Result<String, StatsError> {
    let cases = Cases::of(report.cases, report.realizations)?;
    let body = html! {
        h1 { (report.name) } "\n"
        p { (introduction(report)) } "\n"
        pre { (summary(report.cases)?) } "\n"
        (results::results(&cases)?)
        (methods::side_by_side(&cases, report.methods, report.method_figures)?)
        (scans::scans(report.scans))
        @for (number, sweep) in report.sweeps.iter().enumerate() {
            (heading(&if sweep.is_empty() { "Figures".to_owned() } else { format!("Sweep {sweep}") }))
            (grid(number + 1, report.drawings.iter().filter(|(of, _)| of == sweep).map(|(_, panel)| panel)))
        }
        @if let Some(cycle) = report.cycle { (single_cycle::section(report.sweeps.len() + 1, cycle)) }
        (theories::theories(&cases)?)
        (validity::budget(&cases)?)
        (validity::validity(&cases)?)
        (data::usage())
        (heading("Spec with all defaults"))
        pre { (report.spec) } "\n"
    };
    Ok(document(&format!("{}: adhesive hysteresis", report.name), Some(report.key), &body))
}

const SYMBOLS: &str = "E*: reduced modulus; A_{0}: nominal area; h_{rms}: root-mean-square height; Δγ: work of adhesion; Δ: mean penetration; \
    F: normal load, positive in compression.";

const ASPERITIES: &str = "Interacting asperities of Johnson, Kendall and Roberts (JKR) after Violano and Afferrante, Lubricants 9(1):7 (2021), with corrected equations. ";

const ELEMENTS: &str = "Adhesive boundary elements: the rough surface on a grid, loaded and unloaded under displacement control. ";

/// Number of cases and realizations, methods and symbols.
fn introduction(report: &Report<'_>) -> Markup {
    let [asperities, elements] = report.case_counts;
    html! {
        "Adhesive hysteresis of rough surfaces: " (counted(asperities + elements, "case")) ", " (report.realizations_text) " each. "
        @if asperities > 0 { (ASPERITIES) }
        @if elements > 0 { (ELEMENTS) }
        (prose(SYMBOLS))
    }
}
