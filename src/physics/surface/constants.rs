//! Limits of measured surfaces.

use super::common_spectrum::{BEFORE_END, LOWEST_WINDOWED, POINTS_PER_WAVELENGTH};
use super::continuation::MIN_MARGIN;
use super::measured::{
    MAX_MISSING_FRACTION, MAX_POINTS, MAX_SPACING_RATIO, MIN_CURVATURE_SHARE, MIN_POINTS, SPACING_TOLERANCE,
};
use super::measured_summits::{RIDGE, ROUNDING_OF_RIPPLES};
use super::outliers::{CONTRAST, LARGEST_GROUP, OUTLIER_LIMIT};
use super::rows::{COMMON, PERIODIC};
use super::self_affine::{MAX_SCATTER, MIN_RINGS, MIN_RINGS_BEYOND, SHARE};
use crate::constants::Constant;

/// Limits of a measured surface.
pub(crate) const CONSTANTS: &[Constant] = &[
    Constant::new(
        "points along a side",
        &[MIN_POINTS as f64, MAX_POINTS as f64],
        "",
        "Minimum and maximum, after the crop.",
        "measured",
    ),
    Constant::new(
        "missing points",
        &[MAX_MISSING_FRACTION],
        "of all points",
        "Maximum that `--fill` interpolates.",
        "measured",
    ),
    Constant::new(
        "difference of the pixel sizes",
        &[SPACING_TOLERANCE],
        "relative",
        "Smaller ones along x and y count as equal.",
        "measured",
    ),
    Constant::new(
        "ratio of the pixel sizes",
        &[MAX_SPACING_RATIO],
        "",
        "A larger one is an error.",
        "measured",
    ),
    Constant::new(
        "outlier",
        &[OUTLIER_LIMIT],
        "robust standard deviations",
        "Deviation from the median of the neighbours beyond which a point may be an outlier.",
        "outliers",
    ),
    Constant::new(
        "points of an outlier",
        &[LARGEST_GROUP as f64],
        "",
        "Maximum that are connected at half of its height.",
        "outliers",
    ),
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
    Constant::new(
        "correlation of line offsets",
        &[PERIODIC],
        "",
        "A larger one is that of a periodic surface.",
        "rows",
    ),
    Constant::new(
        "rings of a spectrum fit",
        &[MIN_RINGS as f64, MIN_RINGS_BEYOND as f64],
        "",
        "Minimum, and minimum beyond a roll-off.",
        "self_affine",
    ),
    Constant::new(
        "deviation from a spectrum fit",
        &[MAX_SCATTER],
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
        &[MIN_MARGIN as f64],
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
        &[MIN_CURVATURE_SHARE],
        "of the mean square Laplacian",
        "Wavelengths that hold less do not count as shortest wavelengths.",
        "measured",
    ),
    Constant::new(
        "lowest mode of a scan",
        &[LOWEST_WINDOWED],
        "`2π/L`",
        "Common spectrum: a non-periodic scan contributes from here on.",
        "common_spectrum",
    ),
    Constant::new(
        "points per wavelength of a scan",
        &[POINTS_PER_WAVELENGTH],
        "",
        "Common spectrum: a scan contributes down to this wavelength.",
        "common_spectrum",
    ),
    Constant::new(
        "margin of the end of a spectrum",
        &BEFORE_END,
        "of its wavenumber",
        "Common spectrum: a scan contributes up to here, before a Gaussian filter, white noise and a \
         sharp end.",
        "common_spectrum",
    ),
];
