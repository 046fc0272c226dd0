//! Part of the report: measured surfaces.

use super::layout::{heading, prose, wide};
use super::numbers::minus;
use crate::model::Choice;
use crate::stats::{labels_with_unit, significant};
use crate::store::hdf5::{Measured, SpectrumFit, SurfaceHeader};
use maud::{Markup, html};

const NOTE: &str = "Each measured surface is one realization, without a standard deviation. Area kept: \
    fraction of the scan in the central square of side L. h_{rms} and rms slope: after levelling and \
    S-filter. S-filter: low-pass filter, Gaussian (ISO 16610-61) or sharp. Removed: rms heights of the short \
    wavelengths and of the form subtracted by levelling. Overshoot: height of filtered maxima above the \
    measured heights nearby, beyond the noise. Filled: missing points interpolated (harmonic in-fill). \
    Outliers: isolated points beyond 6 robust standard deviations of their neighbours, replaced and left. \
    Line offsets: rms offset between scan lines, removed and left. Tip cut-off: shortest wavelength that a \
    tip of the stated radius traces reliably. H: Hurst exponent of the self-affine fit, with its rms \
    deviation in decades; outside 0 to 1 the spectrum is not self-affine. Texture aspect: larger of the \
    ratio of the principal rms slopes and 1/Str (ISO 25178). Cuts: wavelengths between which the spectrum \
    holds data.";

/// Significant digits of a length.
const DIGITS: usize = 4;

const HEADS: [&str; 18] = [
    "file",
    "points",
    "area kept",
    "L",
    "h_{rms}",
    "rms slope",
    "S-filter",
    "cut-off",
    "removed by S-filter",
    "overshoot",
    "removed by levelling",
    "filled",
    "outliers replaced / left",
    "line offsets removed / left",
    "tip cut-off",
    "texture aspect",
    "H",
    "long cut / roll-off / short cut",
];

/// A table of the measured surfaces of a campaign, if it has any.
pub(super) fn scans(surfaces: &[SurfaceHeader]) -> Markup {
    let measured = surfaces.iter().filter_map(|header| header.measured.as_ref().map(|of| row(header, of)));
    let rows: Vec<Markup> = measured.collect();
    if rows.is_empty() {
        return Markup::default();
    }
    let head = html! { @for name in HEADS { th { (prose(name)) } } };
    html! { (heading("Measured surfaces")) p { (prose(NOTE)) } "\n" (wide("surfaces", &head, &rows)) }
}

/// Outliers, offsets of scan lines and the cut-off of the tip.
fn artefacts(of: &Measured) -> Markup {
    let Some(quality) = of.quality else { return html! { td { "–" } td { "–" } td { "–" } } };
    html! {
        td { (quality.outlier_count) " / " (quality.outlier_left_count) }
        td {
            (length(quality.line_offset_m)) " / "
            (length(Some(quality.line_jump_m).filter(|jump| *jump > 0.0)))
        }
        td { (length(quality.tip_cutoff_m)) }
    }
}

fn row(header: &SurfaceHeader, of: &Measured) -> Markup {
    let [a, b] = of.source_point_counts;
    let lengths = |values: &[f64]| html! { @for value in values { td { (length(Some(*value))) } } };
    html! {
        td { (of.source) }
        td { (a) "\u{a0}×\u{a0}" (b) }
        td { (format!("{:.0}\u{a0}%", 100.0 * (1.0 - of.dropped(header.length_m)))) }
        (lengths(&[header.length_m, header.rms_height_m]))
        td { (format!("{:.3}", header.rms_slope)) }
        td { (of.filter.word()) }
        (lengths(&[of.shortest_wavelength_m, of.noise_m, of.overshoot_m, of.trend_m]))
        td { (of.missing_count) }
        (artefacts(of))
        td { (of.texture.map_or_else(|| "–".to_owned(), |texture| format!("{:.2}", texture.aspect()))) }
        td {
            (of.fit.map_or_else(
                || "–".to_owned(),
                |fit| minus(&format!("{:.2} (±{:.2} decades)", fit.hurst, fit.scatter)),
            ))
        }
        td { (of.fit.map_or_else(|| "–".to_owned(), |fit| ends(&fit, header.length_m))) }
    }
}

/// Long cut-off, roll-off and short cut-off of the spectrum of a surface of side L \[m\].
fn ends(fit: &SpectrumFit, length_m: f64) -> String {
    [fit.long_cut_m, fit.roll_off_m(length_m), fit.short_cut.map(|(length, _)| length)]
        .map(length)
        .join(" / ")
}

/// A length \[m\] with four digits and its unit, or a dash.
fn length(length: Option<f64>) -> String {
    let rounded = |length: f64| significant(length, DIGITS).parse().unwrap_or(length);
    match length {
        None => "–".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(length) => labels_with_unit("_m", &[rounded(length)]).concat().replace(' ', "\u{a0}"),
    }
}
