//! Measured surfaces before a run, read as the run reads them.

use super::estimates::Examined;
use super::measure::measure;
use crate::campaign::{Campaign, SurfaceUnit};
use crate::formats::recognize;
use crate::model::MeasuredSurface;
use crate::store::hdf5::{SurfaceHeader, read_header, read_surface};
use ndarray::Array2;
use std::path::Path;

/// Largest file of a measured surface that is read before a run \[bytes\].
const LARGEST_FILE: u64 = 1 << 28;
/// Most points along a side of a surface whose energies and asperities are computed before a run.
const MOST_POINTS: usize = 2048;

/// A measured surface before a run.
pub(super) enum Preview {
    /// Read.
    Known(Box<Known>),
    /// Refused, as the run refuses it.
    Refused(String),
    /// Too large to be read before the run.
    Large,
}

/// A measured surface that was read.
pub(super) struct Known {
    /// Header of its file in a run.
    pub(super) header: SurfaceHeader,
    /// Asperities and estimates; nothing for a surface of many points.
    pub(super) details: Option<Result<Examined, String>>,
}

impl Preview {
    /// Of a surface of a campaign: from its file in the run, or else from the scan.
    pub(super) fn of(campaign: &Campaign, surface: &SurfaceUnit, params: &MeasuredSurface) -> Self {
        let path = campaign.surface_path(surface);
        match read_header(&path) {
            Ok(header) if header.key == surface.key => match read_surface(&path) {
                Ok((header, heights)) => Self::read(header, &heights, MOST_POINTS),
                Err(error) => Self::Refused(error.to_string()),
            },
            _ => Self::of_scan(params, LARGEST_FILE, MOST_POINTS),
        }
    }

    /// Of a scan, unless its file has more bytes; without details if it has more points along a side.
    pub(super) fn of_scan(params: &MeasuredSurface, most_bytes: u64, most_points: usize) -> Self {
        let path = Path::new(&params.file);
        if std::fs::metadata(path).is_ok_and(|about| about.len() > most_bytes || !about.is_file()) {
            return Self::Large;
        }
        // The run refuses a file of another kind in the words of `recognize` too.
        match recognize(path).is_ok().then(|| measure(params, "", "")) {
            Some(Ok(found)) => Self::read(found.header, &found.prepared.heights_m, most_points),
            Some(Err(error)) => Self::Refused(error.to_string()),
            None => Self::Large,
        }
    }

    fn read(header: SurfaceHeader, heights: &Array2<f64>, most_points: usize) -> Self {
        let details = (heights.nrows() <= most_points)
            .then(|| Examined::of_measured(&header, heights.view()).map_err(|error| error.to_string()));
        Self::Known(Box::new(Known { header, details }))
    }

    /// The surface, if it was read.
    pub(super) fn known(&self) -> Option<&Known> {
        if let Self::Known(known) = self { Some(known) } else { None }
    }
}

impl Known {
    /// Asperities and estimates, if they were computed.
    pub(super) fn found(&self) -> Option<&Examined> {
        self.details.as_ref()?.as_ref().ok()
    }
}
