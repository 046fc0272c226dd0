//! Part of the report: measured surfaces.

use super::layout::{heading, prose, wide};
use super::numbers::minus;
use crate::model::Choice;
use crate::stats::{labels_with_unit, significant};
use crate::store::hdf5::{Measured, SpectrumFit, SurfaceHeader};
use maud::{Markup, html};

/// Significant digits of a length.
const DIGITS: usize = 4;

/// Head of a column, and its meaning unless the head states it.
type Column = (&'static str, &'static str);

const COLUMNS: [Column; 18] = [
    ("file", ""),
    ("points", ""),
    ("area kept", "Area kept: fraction of the scan in the central square of side L."),
    ("L", ""),
    ("h_{rms}", "h_{rms} and rms slope: after levelling and S-filter."),
    ("rms slope", ""),
    ("S-filter", "S-filter: low-pass filter, Gaussian (ISO 16610-61) or sharp, with its cut-off wavelength."),
    ("cut-off", ""),
    ("removed by S-filter", "Removed: rms heights of the short wavelengths and of the form."),
    ("removed by levelling", ""),
    ("overshoot", "Overshoot: height of filtered maxima above measured heights nearby, beyond the noise."),
    ("filled", "Filled: missing points interpolated (harmonic in-fill)."),
    (
        "outliers replaced / left",
        "Outliers: isolated points beyond 6 robust standard deviations of their neighbours.",
    ),
    ("line offsets removed / left", "Line offsets: rms offset between scan lines."),
    ("tip cut-off", "Tip cut-off: shortest wavelength that a tip of the stated radius traces reliably."),
    (
        "texture aspect",
        "Texture aspect: larger of the ratio of the principal rms slopes and 1/Str (ISO 25178).",
    ),
    (
        "H",
        "H: Hurst exponent of the self-affine fit, with its rms deviation in decades; outside 0 to 1 the \
         spectrum is not self-affine.",
    ),
    ("long cut / roll-off / short cut", "Cuts: wavelengths between which the spectrum holds data."),
];

/// Columns that are left out if all of their cells are empty or zero.
const OPTIONAL: [&str; 6] = [
    "overshoot",
    "filled",
    "outliers replaced / left",
    "line offsets removed / left",
    "tip cut-off",
    "long cut / roll-off / short cut",
];

/// A table of the measured surfaces of a campaign, if it has any.
pub(super) fn scans(surfaces: &[SurfaceHeader]) -> Markup {
    let measured = surfaces.iter().filter_map(|header| header.measured.as_ref().map(|of| row(header, of)));
    let rows: Vec<[String; 18]> = measured.collect();
    if rows.is_empty() {
        return Markup::default();
    }
    let is_empty = |text: &str| text.split(" / ").all(|part| matches!(part, "–" | "0"));
    let kept: Vec<usize> = (0..COLUMNS.len())
        .filter(|at| !OPTIONAL.contains(&COLUMNS[*at].0) || rows.iter().any(|row| !is_empty(&row[*at])))
        .collect();
    let head = html! { @for at in &kept { th { (prose(COLUMNS[*at].0)) } } };
    let cells = |row: &[String; 18]| html! { @for at in &kept { td { (row[*at]) } } };
    html! {
        (heading("Measured surfaces"))
        p {
            "Each measured surface is one realization, without a standard deviation."
            @for at in &kept { @if !COLUMNS[*at].1.is_empty() { " " (prose(COLUMNS[*at].1)) } }
        } "\n"
        (wide("surfaces", &head, &rows.iter().map(cells).collect::<Vec<_>>()))
    }
}

/// Outliers, offsets of scan lines and the cut-off of the tip.
fn artefacts(of: &Measured) -> [String; 3] {
    let Some(quality) = of.quality else { return ["–"; 3].map(str::to_owned) };
    let jump = Some(quality.line_jump_m).filter(|jump| *jump > 0.0);
    [
        format!("{} / {}", quality.outlier_count, quality.outlier_left_count),
        format!("{} / {}", length(quality.line_offset_m), length(jump)),
        length(quality.tip_cutoff_m),
    ]
}

/// Cells of a surface, in the order of the columns.
fn row(header: &SurfaceHeader, of: &Measured) -> [String; 18] {
    let [a, b] = of.source_point_counts;
    let [outliers, lines, tip] = artefacts(of);
    let dash = || "–".to_owned();
    [
        of.source.clone(),
        format!("{a}\u{a0}×\u{a0}{b}"),
        format!("{:.0}\u{a0}%", 100.0 * (1.0 - of.dropped(header.length_m))),
        length(Some(header.length_m)),
        length(Some(header.rms_height_m)),
        format!("{:.3}", header.rms_slope),
        of.filter.word().to_owned(),
        length(Some(of.shortest_wavelength_m)),
        length(Some(of.noise_m)),
        length(Some(of.trend_m)),
        length(Some(of.overshoot_m)),
        of.missing_count.to_string(),
        outliers,
        lines,
        tip,
        of.texture.map_or_else(dash, |texture| format!("{:.2}", texture.aspect())),
        of.fit.map_or_else(dash, |fit| minus(&format!("{:.2} (±{:.2} decades)", fit.hurst, fit.scatter))),
        of.fit.map_or_else(dash, |fit| ends(&fit, header.length_m)),
    ]
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
