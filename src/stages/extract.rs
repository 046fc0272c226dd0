//! Stage extract: asperities of a surface, and its analytical estimates.

use super::done::Outcome;
use super::estimates::{Examined, seed, surface_table};
use super::surface::SurfaceStage;
use super::{StageError, spectra};
use crate::campaign::{Campaign, Stage, SurfaceUnit, Unit};
use crate::model::SurfaceSource;
use crate::physics::surface::summits::Summit;
use crate::schema;
use crate::store::hdf5::read_surface;
use crate::store::{Frame, FrameError, parquet};
use std::iter::repeat_n;
use std::path::Path;

/// The stage extract.
pub(super) struct Extract;

impl SurfaceStage for Extract {
    const STAGE: Stage = Stage::Extract;

    fn unit(of: &SurfaceUnit) -> Unit<'_> {
        of.asperities()
    }

    fn input(of: &SurfaceUnit) -> Option<Unit<'_>> {
        Some(of.surface())
    }

    fn compute(campaign: &Campaign, of: &SurfaceUnit) -> Result<Outcome, StageError> {
        extract(campaign, of)
    }
}

/// Finds the asperities of a surface and writes their table and that of its estimates.
fn extract(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Outcome, StageError> {
    let (header, heights) = read_surface(&campaign.surface_path(unit))?;
    let Examined { found, edge_count, estimates, texture } = match &unit.params {
        SurfaceSource::Measured(_) => Examined::of_measured(&header, heights.view())?,
        SurfaceSource::Generated(of) => {
            Examined::of_generated(of, &seed(campaign, unit), &header, heights.view())?
        }
    };
    let frame = table(unit, &found.list)?;
    let mut keys = vec![
        ("key", unit.asperities_key.clone()),
        // Nayak's density of the realised moments, for comparison with the density found.
        ("nayak_density_1_m2", estimates.roughness.moments().summit_density_1_m2().to_string()),
        ("summit_density_1_m2", estimates.summit_density_1_m2().to_string()),
        ("rejected_count", found.rejected.to_string()),
        ("unrefined_count", found.unrefined.to_string()),
    ];
    if header.measured.is_some() {
        keys.push(("edge_count", edge_count.to_string()));
    }
    let waves = spectra::long_waves(campaign, unit, &header, heights.view(), &estimates)?;
    let estimates = surface_table(unit, &header, &estimates, texture.as_ref())?;
    Ok(Outcome::of(vec![
        parquet::write_table(&campaign.asperities_path(unit), &frame, &keys)?,
        parquet::write_table(&campaign.estimates_path(unit), &estimates, &keys[..1])?,
        parquet::write_table(&campaign.spectra_path(unit), &spectra::table(unit, &waves)?, &keys[..1])?,
    ]))
}

/// Table of the asperities of a surface.
fn table(unit: &SurfaceUnit, list: &[Summit]) -> Result<Frame, FrameError> {
    Frame::of(&schema::ASPERITIES)
        .text("surface_id", repeat_n(unit.id.as_str(), list.len()))
        .i64("realization", repeat_n(i64::from(unit.realization), list.len()))
        .i64("asperity_id", (0..list.len()).map(|k| k as i64))
        .f64("x_m", list.iter().map(|s| s.x_m))
        .f64("y_m", list.iter().map(|s| s.y_m))
        .f64("height_m", list.iter().map(|s| s.height_m))
        .f64("radius_m", list.iter().map(Summit::radius_m))
        .f64("curvature_1_m", list.iter().map(|s| s.curvature_1_m))
        .f64("curvature_min_1_m", list.iter().map(|s| s.curvature_min_1_m))
        .f64("curvature_max_1_m", list.iter().map(|s| s.curvature_max_1_m))
        .i64("grid_row", list.iter().map(|s| s.grid_row as i64))
        .i64("grid_col", list.iter().map(|s| s.grid_col as i64))
        .bool("refined", list.iter().map(|s| s.refined))
        .build()
}

/// Reads a table of asperities.
pub(super) fn read_summits(path: &Path) -> Result<Vec<Summit>, StageError> {
    let frame = parquet::read_table(path, &schema::ASPERITIES)?;
    let [x, y, height, curvature, least, most] =
        ["x_m", "y_m", "height_m", "curvature_1_m", "curvature_min_1_m", "curvature_max_1_m"]
            .map(|name| frame.f64(name));
    let (x, y, height, curvature, least, most) = (x?, y?, height?, curvature?, least?, most?);
    let (rows, columns, refined) = (frame.i64("grid_row")?, frame.i64("grid_col")?, frame.bool("refined")?);
    Ok((0..frame.row_count())
        .map(|k| Summit {
            x_m: x[k],
            y_m: y[k],
            height_m: height[k],
            curvature_1_m: curvature[k],
            curvature_min_1_m: least[k],
            curvature_max_1_m: most[k],
            grid_row: rows[k] as usize,
            grid_col: columns[k] as usize,
            refined: refined[k],
        })
        .collect())
}
