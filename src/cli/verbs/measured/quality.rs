//! Artefacts of an imported scan: numbers, lines of the text, and warnings.

use crate::model::{Choice, FastAxis};
use crate::stages::ARTEFACTS;
use crate::stats::{CAUTIONS, Limit, measured_text};
use crate::store::hdf5::{Quality, SurfaceHeader};
use crate::text::counted;
use serde_json::{Value, json};

/// A line of the text: label and value.
pub(super) type Line = (&'static str, String);

fn of(header: &SurfaceHeader) -> Option<&Quality> {
    header.measured.as_ref().and_then(|of| of.quality.as_ref())
}

/// The artefacts as JSON; null where they are unknown.
pub(super) fn numbers(header: &SurfaceHeader) -> [(&'static str, Value); 10] {
    let quality = of(header);
    [
        ("outlier_count", json!(quality.map(|of| of.outlier_count))),
        ("outlier_left_count", json!(quality.map(|of| of.outlier_left_count))),
        ("outlier_effect", json!(quality.map(|of| of.outlier_effect))),
        ("line_axis", json!(quality.map(|of| of.line_axis.word()))),
        ("line_offset_m", json!(quality.and_then(|of| of.line_offset_m))),
        ("line_jump_m", json!(quality.map(|of| of.line_jump_m))),
        ("tip_radius_m", json!(quality.and_then(|of| of.tip_radius_m))),
        ("tip_cutoff_m", json!(quality.and_then(|of| of.tip_cutoff_m))),
        ("noise_exponent", json!(quality.and_then(|of| of.noise_exponent))),
        ("curvature_ratio", json!(quality.and_then(|of| of.curvature_ratio))),
    ]
}

/// Corrections of the scan as lines of the text.
pub(super) fn lines(header: &SurfaceHeader) -> Vec<Line> {
    let Some(quality) = of(header) else { return Vec::new() };
    let count = |count: u64| counted(usize::try_from(count).unwrap_or(usize::MAX), "point");
    let mut lines = vec![(
        "outliers",
        format!("{} replaced, {} left", count(quality.outlier_count), quality.outlier_left_count),
    )];
    let axis = if quality.line_axis == FastAxis::Columns { "columns" } else { "rows" };
    if let Some(offset) = quality.line_offset_m {
        lines.push(("scan lines", format!("offsets of {axis} removed: {offset:.3e} m rms")));
    }
    if quality.line_jump_m > 0.0 {
        lines.push(("scan lines", format!("offsets of {axis} left: {:.3e} m rms", quality.line_jump_m)));
    }
    if let Some(radius) = quality.tip_radius_m {
        let reliable = match quality.tip_cutoff_m {
            Some(cutoff) => format!("radius {radius:.3e} m, wavelengths below {cutoff:.3e} m are unreliable"),
            None => format!("radius {radius:.3e} m, all wavelengths are reliable"),
        };
        lines.push(("tip", reliable));
    }
    lines
}

/// Warnings of the artefacts that remain.
pub(super) fn warnings(header: &SurfaceHeader) -> Vec<String> {
    let columns = header.artefact_columns();
    let warning = |code: &str| {
        let (limit, kind) = (Limit::of(code)?, CAUTIONS.iter().find(|kind| kind.code == code)?);
        let (_, value) = columns.iter().find(|(name, _)| *name == limit.of_one())?;
        let value = value.filter(|value| limit.is_passed(Some(*value)))?;
        Some(format!(
            "{code}: {}. {} {}",
            measured_text(kind, limit, &[value]),
            kind.consequence,
            kind.action
        ))
    };
    ARTEFACTS.into_iter().filter_map(warning).collect()
}
