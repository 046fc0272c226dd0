//! generate and extract: a surface from its spec, its asperities from the surface.

use super::StageError;
use super::done::Outcome;
use super::measure::{Imported, measure};
use crate::campaign::{Campaign, SurfaceUnit};
use crate::formats::recognize;
use crate::keys::digest_of_file;
use crate::physics::PhysicsError;
use crate::physics::measured::find_measured;
use crate::physics::memory;
use crate::physics::spectrum::Spectrum;
use crate::physics::summits::{Summit, find_summits};
use crate::physics::synthesis::{realization_seed, synthesis_bytes, synthesize};
use crate::schema;
use crate::spec::SurfaceParams;
use crate::store::hdf5::{Generated, SurfaceHeader, read_header, read_surface, write_surface};
use crate::store::{Frame, parquet};
use std::iter::repeat_n;
use std::path::Path;

/// The spectrum that a spec asks for.
pub(super) fn spectrum(params: &SurfaceParams) -> Spectrum {
    Spectrum {
        length_m: params.length_m,
        rms_height_m: params.rms_height_m,
        hurst: params.hurst,
        magnification: params.magnification,
        normalization: params.normalization,
        amplitudes: params.amplitudes,
    }
}

/// What lengths and heights of a surface are measured by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// Side of the square \[m\].
    pub(super) length_m: f64,
    /// Rms height: the one that was asked for, or that a measured surface has \[m\].
    pub(super) rms_height_m: f64,
}

/// The scale of a surface, which of a measured one its file tells.
pub(super) fn scale(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Scale, StageError> {
    if unit.params.is_measured() {
        let SurfaceHeader { length_m, rms_height_m, .. } = read_header(&campaign.surface_path(unit))?;
        return Ok(Scale { length_m, rms_height_m });
    }
    Ok(Scale { length_m: unit.params.length_m, rms_height_m: unit.params.rms_height_m })
}

/// Takes a measured surface into the run.
fn take(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Outcome, StageError> {
    let path = Path::new(&unit.params.file);
    let refuse = |why: String| StageError::Changed { path: path.to_owned(), why };
    // A file in an unknown format may be too large to be hashed for nothing.
    recognize(path)
        .map_err(|error| refuse(error.to_string()))?
        .map_err(|refusal| StageError::Measured { path: path.to_owned(), why: refusal.to_string() })?;
    let digest = digest_of_file(path).map_err(|error| refuse(error.to_string()))?;
    if campaign.spec.files.get(&unit.params.file) != Some(&digest) {
        return Err(refuse(
            "the file differs from its checksum in [files] of the spec\nhelp: remove this line to recompute with the present file"
                .to_owned(),
        ));
    }
    let Imported { prepared, header, .. } = measure(&unit.params, &digest, &unit.key)?;
    Ok(Outcome::of(vec![write_surface(&campaign.surface_path(unit), &header, prepared.heights_m.view())?]))
}

pub(super) fn generate(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Outcome, StageError> {
    let params = &unit.params;
    if params.is_measured() {
        return take(campaign, unit);
    }
    let seed = realization_seed(campaign.spec.seed, u64::from(unit.realization));
    let (spectrum, grid) = (spectrum(params), params.grid() as usize);
    memory::check(synthesis_bytes(&spectrum, grid))?;
    let surface = synthesize(&spectrum, &seed, grid);
    // One that no file may hold is the failure of this surface.
    if let Some(value) = surface.heights_m.iter().copied().find(|height| !height.is_finite()) {
        let [action, quantity, allowed] = ["the heights of the surface", "a height [m]", "finite heights"];
        return Err(PhysicsError::Domain { action, quantity, value, allowed }.into());
    }
    let header = SurfaceHeader {
        length_m: params.length_m,
        realization: u64::from(unit.realization),
        periodic: true,
        key: unit.key.clone(),
        rms_height_m: surface.moments.rms_height_m(),
        rms_slope: surface.moments.rms_slope(),
        rms_curvature_1_m: surface.moments.rms_curvature_1_m(),
        nayak_parameter: surface.moments.nayak_parameter(),
        generated: Some(Generated {
            target_rms_height_m: params.rms_height_m,
            hurst: params.hurst,
            magnification: f64::from(params.magnification),
            seed: campaign.spec.seed,
            points_per_shortest_wavelength: f64::from(params.points_per_shortest_wavelength),
            normalization: params.normalization,
            amplitudes: params.amplitudes,
        }),
        measured: None,
    };
    Ok(Outcome::of(vec![write_surface(&campaign.surface_path(unit), &header, surface.heights_m.view())?]))
}

pub(super) fn extract(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Outcome, StageError> {
    let (header, heights) = read_surface(&campaign.surface_path(unit))?;
    let (found, edge) = match &header.measured {
        Some(measured) => {
            let points = measured.shortest_wavelength_m * heights.nrows() as f64 / header.length_m;
            find_measured(heights.view(), header.length_m, (header.periodic, points))?
        }
        None => (find_summits(heights.view(), header.length_m, f64::from(unit.params.points_per_shortest_wavelength))?, 0),
    };
    let list = &found.list;
    let frame = Frame::of(&schema::ASPERITIES)
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
        .build()?;
    let area = header.length_m * header.length_m;
    let moments = header.moments();
    let mut keys = vec![
        ("key", unit.asperities_key.clone()),
        // Nayak's density of the realised moments beside the one that was found.
        ("nayak_density_1_m2", moments.summit_density_1_m2().to_string()),
        ("summit_density_1_m2", (list.len() as f64 / area).to_string()),
        ("rejected_count", found.rejected.to_string()),
        ("unrefined_count", found.unrefined.to_string()),
    ];
    if header.measured.is_some() {
        keys.push(("edge_count", edge.to_string()));
    }
    Ok(Outcome::of(vec![parquet::write_table(&campaign.asperities_path(unit), &frame, &keys)?]))
}

/// The asperities of a table, as the physics takes them.
pub(super) fn read_summits(path: &Path) -> Result<Vec<Summit>, StageError> {
    let frame = parquet::read_table(path, &schema::ASPERITIES)?;
    let [x, y, height, curvature, least, most] =
        ["x_m", "y_m", "height_m", "curvature_1_m", "curvature_min_1_m", "curvature_max_1_m"].map(|name| frame.f64(name));
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
