//! Measured surfaces before a run, read as the run reads them.

use super::StageError;
use super::measure::measure;
use crate::campaign::{Campaign, SurfaceUnit};
use crate::formats::recognize;
use crate::model::MeasuredSurface;
use crate::physics::surface::measured::find_measured;
use crate::physics::surface::summits::Summit;
use crate::physics::theory::flattening::{Flattening, measured_flattening, shortest_wavelength};
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
    /// Energies of flattening at a modulus of 1 Pa, and asperities; nothing for a surface of many points.
    pub(super) details: Option<Result<Details, String>>,
}

/// Energies and asperities of a measured surface.
pub(super) struct Details {
    /// Energies of flattening at a modulus of 1 Pa.
    pub(super) unit: Flattening,
    /// Shortest wavelength over the cut-off of the filter.
    pub(super) shortest: f64,
    /// Asperities.
    pub(super) summits: Vec<Summit>,
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
        let details = (heights.nrows() <= most_points).then(|| details(&header, heights).map_err(|error| error.to_string()));
        Self::Known(Box::new(Known { header, details }))
    }

    /// The surface, if it was read.
    pub(super) fn known(&self) -> Option<&Known> {
        if let Self::Known(known) = self { Some(known) } else { None }
    }
}

impl Known {
    /// Energies and asperities, if they were computed.
    pub(super) fn found(&self) -> Option<&Details> {
        self.details.as_ref()?.as_ref().ok()
    }
}

fn details(header: &SurfaceHeader, heights: &Array2<f64>) -> Result<Details, StageError> {
    let cut_off_m = header.measured.as_ref().map_or(0.0, |of| of.shortest_wavelength_m);
    let (square, points) = (header.square(heights.view()), cut_off_m * heights.nrows() as f64 / header.length_m);
    let (found, _) = find_measured(square, points)?;
    let shortest_m = shortest_wavelength(square, cut_off_m)?;
    let unit = measured_flattening(square, shortest_m, 1.0)?;
    let shortest = if shortest_m > cut_off_m { shortest_m / cut_off_m } else { 1.0 };
    Ok(Details { unit, shortest, summits: found.list })
}
