//! The estimates of a surface, as a row of its table.

use super::StageError;
use super::cycle::Square;
use crate::campaign::{Campaign, SurfaceUnit};
use crate::schema::SURFACE_ESTIMATES;
use crate::spec::CaseParams;
use crate::store::{Frame, FrameError, parquet};

/// The row of a surface in its table of estimates.
pub(super) struct SurfaceRow(pub(super) Frame);

impl SurfaceRow {
    pub(super) fn read(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Self, StageError> {
        Ok(Self(parquet::read_table(&campaign.estimates_path(unit), &SURFACE_ESTIMATES)?))
    }

    /// Root-mean-square height \[m\].
    pub(super) fn rms_height_m(&self) -> Result<f64, FrameError> {
        self.0.first_f64("rms_height_m")
    }

    /// Square with the cut-off wavelength of a measured surface.
    pub(super) fn square(&self, params: &CaseParams) -> Result<Square, FrameError> {
        let number = |name: &str| self.0.first_f64(name);
        let is_periodic = self.0.bool("periodic")?.first().copied().unwrap_or_default();
        let is_mirrored = !is_periodic && params.probe.is_none();
        Ok(Square { length_m: number("length_m")?, shortest_wavelength_m: number("cut_off_m")?, is_mirrored })
    }
}
