//! Stage generate: surfaces from their spectra, and import of measured surfaces.

use super::StageError;
use super::done::Outcome;
use super::measure::{Imported, measure};
use super::surface::SurfaceStage;
use crate::campaign::{Campaign, Stage, SurfaceUnit, Unit};
use crate::formats::recognize;
use crate::keys::digest_of_file;
use crate::model::{GeneratedSurface, MeasuredSurface, SurfaceSource};
use crate::paths::whole;
use crate::physics::PhysicsError;
use crate::physics::memory;
use crate::physics::surface::synthesis::{realization_seed, synthesis_bytes, synthesize};
use crate::store::hdf5::{Generated, SurfaceHeader, write_surface};
use std::path::Path;

/// The stage generate.
pub(super) struct Generate;

impl SurfaceStage for Generate {
    const STAGE: Stage = Stage::Generate;

    fn unit(of: &SurfaceUnit) -> Unit<'_> {
        of.surface()
    }

    fn input(_: &SurfaceUnit) -> Option<Unit<'_>> {
        None
    }

    fn compute(campaign: &Campaign, of: &SurfaceUnit) -> Result<Outcome, StageError> {
        generate(campaign, of)
    }
}

const OTHER_FILE: &str = "the file differs from its checksum in [files] of the spec\nhelp: remove this line \
                          to recompute with the present file";

/// Imports a measured surface.
fn import(campaign: &Campaign, unit: &SurfaceUnit, surface: &MeasuredSurface) -> Result<Outcome, StageError> {
    // Messages name the file by a path that holds in any folder.
    let path = &whole(Path::new(&surface.file));
    let refuse = |why: String| StageError::Changed { path: path.clone(), why };
    let lost = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            StageError::Lost { path: path.clone(), places: campaign.places_of(&surface.file) }
        }
        _ => refuse(error.to_string()),
    };
    // A file in an unknown format may be too large to be hashed for nothing.
    recognize(path)
        .map_err(lost)?
        .map_err(|refusal| StageError::Measured { path: path.clone(), why: refusal.to_string() })?;
    let digest = digest_of_file(path).map_err(|error| refuse(error.to_string()))?;
    if campaign.spec.files.get(&surface.file) != Some(&digest) {
        return Err(refuse(OTHER_FILE.to_owned()));
    }
    let params =
        MeasuredSurface { file: path.to_str().unwrap_or(&surface.file).to_owned(), ..surface.clone() };
    let Imported { prepared, header, .. } = measure(&params, &digest, &unit.key)?;
    Ok(Outcome::of(vec![write_surface(&campaign.surface_path(unit), &header, prepared.heights_m.view())?]))
}

/// Checks that the file of a tabulated spectrum has been read, and is that of the checksum.
fn check_table(campaign: &Campaign, surface: &GeneratedSurface) -> Result<(), StageError> {
    let file = &surface.tabulated.file;
    let path = whole(Path::new(file));
    let digest = match digest_of_file(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return Err(StageError::Lost { path, places: campaign.places_of(file) });
        }
        Err(error) => return Err(StageError::Changed { path, why: error.to_string() }),
        Ok(digest) => digest,
    };
    if campaign.spec.files.get(file) != Some(&digest) || !surface.has_spectrum() {
        return Err(StageError::Changed { path, why: OTHER_FILE.to_owned() });
    }
    Ok(())
}

/// Synthesizes a surface, or imports a measured one.
fn generate(campaign: &Campaign, unit: &SurfaceUnit) -> Result<Outcome, StageError> {
    let params = match &unit.params {
        SurfaceSource::Measured(surface) => return import(campaign, unit, surface),
        SurfaceSource::Generated(surface) => surface,
    };
    if params.is_tabulated() {
        check_table(campaign, params)?;
    }
    let seed = realization_seed(campaign.spec.seed, u64::from(unit.realization));
    let (spectrum, grid) = (params.spectrum(), params.grid() as usize);
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
            longest_wavelength_m: params.longest_wavelength_m,
            roll_off_m: params.roll_off_m,
            aspect_ratio: params.aspect_ratio,
            angle_deg: params.angle_deg,
            left_out_m: params.is_tabulated().then(|| spectrum.left_out_m()),
        }),
        measured: None,
    };
    Ok(Outcome::of(vec![write_surface(&campaign.surface_path(unit), &header, surface.heights_m.view())?]))
}
