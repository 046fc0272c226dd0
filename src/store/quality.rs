//! Artefacts of a measured surface in its file.

use super::attributes::{choice, finite, number, write_finite, write_number, write_word};
use super::error::Cause;
use crate::model::{Choice as _, FastAxis};
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
    /// Curvature of the sharpest summits over that of the sharpest valleys, if the surface is rounded nearly
    /// everywhere and no tip radius was given.
    pub curvature_ratio: Option<f64>,
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
    optional(of)
        .into_iter()
        .filter_map(|(name, value)| Some((name, value?)))
        .try_for_each(|(name, value)| write_finite(file, name, value))
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
