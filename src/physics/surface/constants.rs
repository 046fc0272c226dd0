//! Limits of measured surfaces.

use super::continuation::LEAST_MARGIN;
use super::measured::{FEWEST_POINTS, LEAST_CURVATURE_SHARE, MAX_MISSING_FRACTION, MAX_SPACING_RATIO, MOST_POINTS, SPACING_TOLERANCE};
use super::measured_summits::{RIDGE, ROUNDING_OF_RIPPLES};
use super::outliers::{CONTRAST, LARGEST_GROUP, OUTLIER_LIMIT};
use super::rows::{COMMON, PERIODIC};
use super::self_affine::{FEWEST, FEWEST_BEYOND, MOST_SCATTER, SHARE};
use crate::constants::Constant;

/// Limits of a measured surface.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "points along a side",
        &[FEWEST_POINTS as f64, MOST_POINTS as f64],
        "",
        "Minimum and maximum, after the crop.",
        "measured",
    ),
    Constant::new("missing points", &[MAX_MISSING_FRACTION], "of all points", "Maximum that `--fill` interpolates.", "measured"),
    Constant::new(
        "difference of the pixel sizes",
        &[SPACING_TOLERANCE],
        "relative",
        "Smaller ones along x and y count as equal.",
        "measured",
    ),
    Constant::new("ratio of the pixel sizes", &[MAX_SPACING_RATIO], "", "A larger one is an error.", "measured"),
    Constant::new(
        "outlier",
        &[OUTLIER_LIMIT],
        "robust standard deviations",
        "Deviation from the median of the neighbours beyond which a point may be an outlier.",
        "outliers",
    ),
    Constant::new("points of an outlier", &[LARGEST_GROUP as f64], "", "Maximum that are connected at half of its height.", "outliers"),
    Constant::new(
        "contrast of an outlier",
        &[CONTRAST],
        "",
        "Minimum, over the difference of the two rings of points around it.",
        "outliers",
    ),
    Constant::new(
        "common part of line offsets",
        &[COMMON],
        "of the variance",
        "Minimum that all parts of a scan line have in common.",
        "rows",
    ),
    Constant::new("correlation of line offsets", &[PERIODIC], "", "A larger one is that of a periodic surface.", "rows"),
    Constant::new(
        "rings of a spectrum fit",
        &[FEWEST as f64, FEWEST_BEYOND as f64],
        "",
        "Minimum, and minimum beyond a roll-off.",
        "self_affine",
    ),
    Constant::new(
        "deviation from a spectrum fit",
        &[MOST_SCATTER],
        "decades",
        "With a larger rms deviation there is no fit.",
        "self_affine",
    ),
    Constant::new(
        "band of a spectrum fit",
        &[SHARE],
        "of `h_rms²`",
        "A band that holds less is leakage or rounding, and no data.",
        "self_affine",
    ),
    Constant::new(
        "margin of a non-periodic scan",
        &[LEAST_MARGIN as f64],
        "points",
        "Minimum, else half a cut-off wavelength; asperities closer to an edge are left out.",
        "continuation",
    ),
    Constant::new(
        "curvature of rounding",
        &[ROUNDING_OF_RIPPLES],
        "of the height range times `(2π/λc)²`",
        "A maximum whose smaller principal curvature is below is rejected.",
        "measured_summits",
    ),
    Constant::new(
        "curvature of a ridge",
        &[RIDGE],
        "of the larger principal curvature",
        "A maximum whose smaller principal curvature is below is rejected.",
        "measured_summits",
    ),
    Constant::new(
        "share of the shortest octave",
        &[LEAST_CURVATURE_SHARE],
        "of the mean square Laplacian",
        "Wavelengths that hold less do not count as shortest wavelengths.",
        "measured",
    ),
];
