//! Artefacts of a measured surface: their correction, the tip that measured it, and what its file says of
//! them.

use super::StageError;
use crate::model::MeasuredSurface;
use crate::physics::surface::artefacts::{Artefacts, Corrections, correct, noise_exponent, outlier_effect};
use crate::physics::surface::measured::{Prepared, Treatment, prepare};
use crate::physics::surface::tip::{curvature_ratio, reliability_cutoff};
use crate::store::hdf5::Quality;
use crate::store::scan::FirstIndex;
use ndarray::{Array2, ArrayView2};
use std::path::Path;

/// Largest reliability cut-off of a tip, as a fraction of the side of the square.
const LARGEST_CUTOFF: f64 = 0.5;

/// The surface after corrections and preprocessing of heights \[m\], and its artefacts.
pub(super) fn corrected(
    params: &MeasuredSurface,
    heights_m: Array2<f64>,
    spacing_m: [f64; 2],
    first: FirstIndex,
    treatment: &Treatment,
) -> Result<(Prepared, Quality), StageError> {
    // Rows and columns are those of the file.
    let in_order =
        |heights: Array2<f64>| if first == FirstIndex::Y { heights.reversed_axes() } else { heights };
    let mut of_file = in_order(heights_m);
    let artefacts = correct(&mut of_file, &corrections(params));
    let heights_m = in_order(of_file);
    let curvature_ratio = rounded(params, heights_m.view(), spacing_m);
    let (prepared, tip_cutoff_m) = with_tip(params, heights_m, spacing_m, treatment)?;
    let shortest_m = prepared.shortest_wavelength_m;
    let points = shortest_m / spacing_m[0].max(spacing_m[1]);
    let quality = Quality {
        outlier_effect: outlier_effect(&artefacts, &prepared.moments, points, shortest_m),
        tip_cutoff_m,
        curvature_ratio,
        noise_exponent: noise_exponent(&prepared.rings, shortest_m),
        ..quality(params, &artefacts)
    };
    Ok((prepared, quality))
}

/// Corrections of a surface by its parameters.
fn corrections(params: &MeasuredSurface) -> Corrections {
    Corrections {
        outliers: params.outliers,
        align: params.align_rows.then_some(params.fast_axis),
        periodic: params.periodic,
    }
}

/// Curvature of the sharpest summits over that of the sharpest valleys; nothing where the tip is known, or
/// the surface is not rounded nearly everywhere.
fn rounded(params: &MeasuredSurface, heights_m: ArrayView2<'_, f64>, spacing_m: [f64; 2]) -> Option<f64> {
    // A quarter of the shortest wavelength resolves its curvature.
    let step = (params.points_per_shortest_wavelength / 4).max(1) as usize;
    if params.tip_radius_m > 0.0 { None } else { curvature_ratio(heights_m, spacing_m, step) }
}

/// The surface with an S-filter cut-off that is at least the reliability cut-off of its tip \[m\], and that
/// cut-off.
fn with_tip(
    params: &MeasuredSurface,
    heights_m: Array2<f64>,
    spacing_m: [f64; 2],
    treatment: &Treatment,
) -> Result<(Prepared, Option<f64>), StageError> {
    let path = Path::new(&params.file);
    let radius_m = params.tip_radius_m;
    let made = |heights: Array2<f64>, treatment: &Treatment| {
        prepare(heights, spacing_m, treatment).map_err(|error| refused(path, &error.to_string()))
    };
    if radius_m <= 0.0 {
        return Ok((made(heights_m, treatment)?, None));
    }
    let prepared = made(heights_m.clone(), treatment)?;
    let Some(cutoff_m) = reliability_cutoff(&prepared.rings, prepared.length_m, radius_m) else {
        return Ok((prepared, None));
    };
    if cutoff_m > LARGEST_CUTOFF * prepared.length_m {
        let why = format!(
            "a tip of radius {radius_m:.3e} m measures wavelengths above {cutoff_m:.3e} m only: shorter ones \
             have a rms curvature of 1/R or more, and the square has a side of {:.3e} m\n\
             help: use a sharper tip or a larger scan; check tip_radius_m (--tip-radius)",
            prepared.length_m
        );
        return Err(refused(path, &why));
    }
    if cutoff_m <= prepared.shortest_wavelength_m {
        return Ok((prepared, Some(cutoff_m)));
    }
    let points = treatment.points_per_shortest_wavelength * cutoff_m / prepared.shortest_wavelength_m;
    Ok((
        made(heights_m, &Treatment { points_per_shortest_wavelength: points, ..*treatment })?,
        Some(cutoff_m),
    ))
}

/// Artefacts as the file of a surface states them.
fn quality(params: &MeasuredSurface, artefacts: &Artefacts) -> Quality {
    Quality {
        outlier_count: artefacts.outlier_count as u64,
        outlier_left_count: artefacts.outlier_left_count as u64,
        outlier_effect: 0.0,
        line_axis: artefacts.aligned.map_or(artefacts.jump_axis, |aligned| aligned.axis),
        line_offset_m: artefacts.aligned.map(|aligned| aligned.offset),
        line_jump_m: artefacts.line_jump_m,
        tip_radius_m: (params.tip_radius_m > 0.0).then_some(params.tip_radius_m),
        tip_cutoff_m: None,
        noise_exponent: None,
        curvature_ratio: None,
    }
}

pub(super) fn refused(path: &Path, why: &str) -> StageError {
    StageError::Measured { path: path.to_owned(), why: why.to_owned() }
}
