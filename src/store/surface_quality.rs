//! Artefacts of a measured surface in the attributes of its file.

use super::error::Cause;
use super::surface_header::{SurfaceHeader, choice, finite, number, write_finite, write_number, write_word};
use crate::model::{Choice, FastAxis};
use hdf5_metno::{File, Group};

/// Corrected and remaining artefacts of a measured surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// Outliers that were replaced.
    pub outlier_count: u64,
    /// Outliers that remain.
    pub outlier_left_count: u64,
    /// Largest effect of the remaining outliers on the filtered surface, over its limit.
    pub outlier_effect: f64,
    /// Direction of the scan lines whose offsets were removed, or remain.
    pub line_axis: FastAxis,
    /// Rms offset of scan lines that was removed \[m\]; nothing if the lines were not aligned.
    pub line_offset_m: Option<f64>,
    /// Rms offset of scan lines that remains \[m\]; 0 if there is none.
    pub line_jump_m: f64,
    /// Radius of the tip \[m\].
    pub tip_radius_m: Option<f64>,
    /// Reliability cut-off of the tip \[m\]; nothing if all wavelengths are reliable.
    pub tip_cutoff_m: Option<f64>,
    /// Exponent of the spectral density of the removed short wavelengths.
    pub noise_exponent: Option<f64>,
    /// Curvature of the sharpest summits over that of the sharpest valleys, if the surface is rounded nearly everywhere and no tip radius was given.
    pub curvature_ratio: Option<f64>,
}

/// Exponent of the spectral density above which short wavelengths are noise. Offsets of scan lines alone have -1, self-affine surfaces less than -2.
const NOISE_EXPONENT: f64 = -1.0;

impl SurfaceHeader {
    /// Columns that state the artefacts of a measured surface, as fractions of its points and rms height; empty if they are unknown.
    #[must_use]
    pub fn artefact_columns(&self) -> Vec<(&'static str, Option<f64>)> {
        let Some((measured, quality)) = self.measured.as_ref().and_then(|of| of.quality.as_ref().map(|quality| (of, quality))) else {
            return Vec::new();
        };
        let points: u64 = measured.source_point_counts.iter().product();
        let noise = quality.noise_exponent.filter(|exponent| *exponent > NOISE_EXPONENT);
        vec![
            ("outlier_share", Some(if quality.outlier_effect > 1.0 { quality.outlier_left_count as f64 / points as f64 } else { 0.0 })),
            ("line_jump_share", Some(quality.line_jump_m / self.rms_height_m)),
            ("noise_share", Some(noise.map_or(0.0, |_| measured.noise_m / self.rms_height_m))),
            ("curvature_ratio", quality.curvature_ratio),
        ]
    }
}

/// Numbers that a file lacks where they do not apply.
fn optional(of: &Quality) -> [(&'static str, Option<f64>); 5] {
    [
        ("line_offset_m", of.line_offset_m),
        ("tip_radius_m", of.tip_radius_m),
        ("tip_cutoff_m", of.tip_cutoff_m),
        ("noise_exponent", of.noise_exponent),
        ("curvature_ratio", of.curvature_ratio),
    ]
}

pub(super) fn write_quality(file: &File, of: &Quality) -> Result<(), Cause> {
    write_number(file, "outlier_count", of.outlier_count)?;
    write_number(file, "outlier_left_count", of.outlier_left_count)?;
    write_finite(file, "outlier_effect", of.outlier_effect)?;
    write_word(file, "line_axis", of.line_axis.word())?;
    write_finite(file, "line_jump_m", of.line_jump_m)?;
    optional(of).into_iter().filter_map(|(name, value)| Some((name, value?))).try_for_each(|(name, value)| write_finite(file, name, value))
}

/// The artefacts in a file; nothing in files of versions that did not look for any.
pub(super) fn read_quality(file: &File, words: &Group, names: &[String]) -> Result<Option<Quality>, Cause> {
    let has = |name: &str| names.iter().any(|known| known == name);
    if !has("outlier_left_count") {
        return Ok(None);
    }
    let optional = |name: &str| has(name).then(|| finite(file, name)).transpose();
    Ok(Some(Quality {
        outlier_count: number(file, "outlier_count")?,
        outlier_left_count: number(file, "outlier_left_count")?,
        outlier_effect: finite(file, "outlier_effect")?,
        line_axis: choice(words, "line_axis")?,
        line_offset_m: optional("line_offset_m")?,
        line_jump_m: finite(file, "line_jump_m")?,
        tip_radius_m: optional("tip_radius_m")?,
        tip_cutoff_m: optional("tip_cutoff_m")?,
        noise_exponent: optional("noise_exponent")?,
        curvature_ratio: optional("curvature_ratio")?,
    }))
}
