//! Part of the report: scans of one sample and their common spectrum.

use super::layout::{Numbers, grid, heading, prose, wide};
use super::numbers::{Shown, shown};
use crate::figures::Panel;
use crate::stats::StatsError;
use crate::store::Frame;
use maud::{Markup, html};

/// Scans with their common spectrum and its figures.
#[derive(Debug, Clone)]
pub struct ScanSpectra {
    /// Table `scans`.
    pub scans: Frame,
    /// A panel for each case.
    pub panels: Vec<Panel>,
}

const NOTE: &str = "λ: limits of reliability with their causes; outside them a scan does not contribute to \
    the common spectrum. h_{rms}, rms slope, U_{el}/E*: of the spectrum of the scan between its limits / of \
    the common spectrum between the same limits. U_{el}: elastic energy per area that flattens the \
    roughness. Scans of one surface agree within the scatter of their few long wavelengths. \
    Data: `scans.parquet`, `scan_spectra.parquet` and `spectrum.parquet` in `statistics`; \
    `hysteron export psd` writes the common spectrum as a table for `surface.spectrum`.";

/// Heading and columns: of the scan, and of the common spectrum.
const PAIRS: [(&str, &str); 3] =
    [("h_{rms} [m]", "rms_height_m"), ("rms slope", "rms_slope"), ("U_{el}/E* [m]", "flattening_m")];

/// One table and the figures of all scans.
pub(super) fn section(of: &ScanSpectra, numbers: &Numbers<'_>) -> Result<Markup, StatsError> {
    let head = html! {
        th { "scan" } th { "L [m]" } th { "longest λ [m]" } th { "shortest λ [m]" }
        @for (heading, _) in PAIRS { th { (prose(heading)) } }
    };
    let files = of.scans.text_or_null("surface_file")?;
    let lengths = of.scans.f64_or_null("length_m")?;
    let mut rows = Vec::new();
    for (row, file) in files.iter().enumerate() {
        let name = file.clone().unwrap_or_else(|| "common spectrum".to_owned());
        let value = |column: &str| -> Result<Option<f64>, StatsError> {
            Ok(of.scans.f64_or_null(column)?.get(row).copied().flatten())
        };
        let mut limits = Vec::new();
        for [limit, cause] in [["lowest_1_m", "lowest_cause"], ["highest_1_m", "highest_cause"]] {
            let cause = of.scans.text_or_null(cause)?.get(row).cloned().flatten();
            let wavelength = value(limit)?.map(|wavenumber| std::f64::consts::TAU / wavenumber);
            limits.push(html! {
                (shown(wavelength, Shown::Plain))
                @if let Some(cause) = cause { " (" (cause.replace('_', " ")) ")" }
            });
        }
        let mut pairs = Vec::new();
        for (_, column) in PAIRS {
            let (own, common) = (value(&format!("band_{column}"))?, value(&format!("common_{column}"))?);
            pairs.push(html! {
                (shown(own, Shown::Plain)) @if file.is_some() { " / " (shown(common, Shown::Plain)) }
            });
        }
        rows.push(html! {
            td { (name) } td { (shown(lengths.get(row).copied().flatten(), Shown::Plain)) }
            @for cell in limits.iter().chain(&pairs) { td { (cell) } }
        });
    }
    Ok(html! {
        (heading("Common spectrum"))
        p { (prose(NOTE)) } "\n"
        (wide("scans", &head, &rows))
        @for panel in &of.panels { (grid(numbers, [panel])) }
    })
}
