//! Roughness of a surface over the cut-off wavelength, and its table.

use super::StageError;
use super::estimates::seed;
use crate::campaign::{Campaign, SurfaceUnit};
use crate::model::{GeneratedSurface, SurfaceSource};
use crate::physics::theory::cut_off::{LongWaves, cut_offs, measured_long_waves, realised_long_waves};
use crate::physics::theory::estimates::SurfaceEstimates;
use crate::schema::SPECTRA;
use crate::store::hdf5::SurfaceHeader;
use crate::store::{Frame, FrameError, parquet};
use ndarray::ArrayView2;
use std::iter::repeat_n;

/// Roughness over the cut-off wavelength of a surface with its heights \[m\].
pub(super) fn long_waves(
    campaign: &Campaign,
    unit: &SurfaceUnit,
    header: &SurfaceHeader,
    heights: ArrayView2<'_, f64>,
    of: &SurfaceEstimates,
) -> Result<Vec<LongWaves>, StageError> {
    if let SurfaceSource::Generated(surface) = &unit.params {
        return Ok(of_generated(campaign, unit, surface));
    }
    let shortest_m = of.cut_off_m.filter(|cut_off_m| *cut_off_m > 0.0).unwrap_or(of.shortest_wavelength_m);
    Ok(measured_long_waves(header.square(heights), &cut_offs(header.length_m, shortest_m))?)
}

fn of_generated(campaign: &Campaign, unit: &SurfaceUnit, surface: &GeneratedSurface) -> Vec<LongWaves> {
    let spectrum = surface.spectrum();
    let shortest_m = spectrum.length_m / f64::from(spectrum.magnification);
    realised_long_waves(&spectrum, &seed(campaign, unit), &cut_offs(spectrum.length_m, shortest_m))
}

/// Table of the roughness over the cut-off wavelength.
pub(super) fn table(unit: &SurfaceUnit, waves: &[LongWaves]) -> Result<Frame, FrameError> {
    Frame::of(&SPECTRA)
        .text("surface_id", repeat_n(unit.id.as_str(), waves.len()))
        .i64("realization", repeat_n(i64::from(unit.realization), waves.len()))
        .f64("cut_off_m", waves.iter().map(|of| of.cut_off_m))
        .f64("rms_height_m", waves.iter().map(|of| of.rms_height_m))
        .f64("rms_slope", waves.iter().map(|of| of.rms_slope))
        .f64("flattening_m", waves.iter().map(|of| of.flattening_m))
        .build()
}

/// Roughness over the cut-off wavelength of a surface by its table; nothing for a surface that was not made.
///
/// An earlier version of the stage wrote no such table. The spectrum of a generated surface follows from the
/// spec and the seed.
pub(super) fn read(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Vec<LongWaves>, StageError> {
    let path = campaign.spectra_path(unit);
    if !path.is_file() {
        return Ok(match unit.params.generated().filter(|surface| surface.has_spectrum()) {
            Some(surface) => of_generated(campaign, unit, surface),
            None => Vec::new(),
        });
    }
    let frame = parquet::read_table(&path, &SPECTRA)?;
    let [cut_off, height, slope, flattening] =
        ["cut_off_m", "rms_height_m", "rms_slope", "flattening_m"].map(|name| frame.f64(name));
    let (cut_off, height, slope, flattening) = (cut_off?, height?, slope?, flattening?);
    let row = |k: usize| LongWaves {
        cut_off_m: cut_off[k],
        rms_height_m: height[k],
        rms_slope: slope[k],
        flattening_m: flattening[k],
    };
    Ok((0..frame.row_count()).map(row).collect())
}
