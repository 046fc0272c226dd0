//! A measured surface: read, made fit for the model, and put into words.

use super::StageError;
use crate::physics::measured::{Prepared, Treatment, prepare};
use crate::physics::selfaffine::fit_self_affine;
use crate::spec::SurfaceParams;
use crate::store::hdf5::{Measured, SpectrumFit, SurfaceHeader, is_own_surface, read_heights, read_surface};
use crate::store::scan::{Format, Found, LENGTHS, Scan, detect, metres, read};
use std::f64::consts::TAU;
use std::io::Read as _;
use std::path::Path;

/// How far a distance of points that is given may be from that of the file.
const SAME: f64 = 1e-3;

/// A measured surface as the spec's parameters ask for it, with what its file in a run says of it. `digest` is the BLAKE3 of its file.
///
/// # Errors
/// A file that cannot be read or does not say what is needed; what [`prepare`] refuses.
pub fn measure(params: &SurfaceParams, digest: &str, key: &str) -> Result<(Prepared, SurfaceHeader), StageError> {
    let path = Path::new(&params.file);
    let scan = scanned(path, &params.dataset)?;
    let refuse = |why: String| StageError::Measured { path: path.to_owned(), why };
    let (rows, columns) = scan.heights.dim();
    let pixel = match (scan.size_m, params.pixel_m > 0.0) {
        (None, false) => {
            return Err(refuse(
                "it does not say how far apart its points are; give pixel_m, the size of the scan over its number of points".to_owned(),
            ));
        }
        (None, true) => [params.pixel_m; 2],
        (Some(size), given) => {
            let own = [size[0] / rows as f64, size[1] / columns as f64];
            if given && own.iter().any(|own| (params.pixel_m / own - 1.0).abs() > SAME) {
                let (given, [a, b]) = (params.pixel_m, own);
                return Err(refuse(format!("its points are {a:.4e} m and {b:.4e} m apart, and pixel_m is {given:e} m; leave pixel_m out")));
            }
            own
        }
    };
    let unit = match (&scan.unit, params.unit.is_empty()) {
        (Some(_), true) => 1.0,
        (Some(unit), false) if metres(&params.unit) == metres(unit) => 1.0,
        (Some(unit), false) => {
            return Err(refuse(format!("its heights are in {unit}, and the unit {:?} was given; leave it out", params.unit)));
        }
        (None, true) => return Err(refuse("it does not say the unit of its heights; give the unit, such as \"nm\"".to_owned())),
        (None, false) => metres(&params.unit)
            .ok_or_else(|| refuse(format!("the unit {:?} that was given for its heights is no length; allowed: {LENGTHS}", params.unit)))?,
    };
    if scan.periodic == Some(false) && params.periodic {
        return Err(refuse("it says that it is not periodic, and periodic = true was given".to_owned()));
    }
    let treatment = Treatment {
        missing: params.missing,
        detrend: params.detrend,
        periodic: params.periodic,
        points_per_shortest_wavelength: f64::from(params.points_per_shortest_wavelength),
    };
    let prepared = prepare(scan.heights.mapv(|h| unit * h), pixel, &treatment).map_err(|error| refuse(error.to_string()))?;
    // Where short waves go and noise begins the fit ends, too.
    let fit = fit_self_affine(&prepared.rings, TAU / prepared.shortest_wavelength_m);
    let moments = &prepared.moments;
    let header = SurfaceHeader {
        length_m: prepared.length_m,
        realization: 0,
        periodic: params.periodic,
        key: key.to_owned(),
        rms_height_m: moments.rms_height_m(),
        rms_slope: moments.rms_slope(),
        rms_curvature_1_m: moments.rms_curvature_1_m(),
        nayak_parameter: moments.nayak_parameter(),
        generated: None,
        measured: Some(Measured {
            source: path.file_name().map(|name| name.to_string_lossy().chars().take(60).collect()).unwrap_or_default(),
            source_blake3: digest.to_owned(),
            missing_count: prepared.missing_count as u64,
            detrend: params.detrend,
            trend_m: prepared.trend_m,
            shortest_wavelength_m: prepared.shortest_wavelength_m,
            noise_m: prepared.noise_m,
            fit: fit.map(|fit| SpectrumFit {
                hurst: fit.hurst,
                plateau_m4: fit.plateau_m4,
                roll_off_1_m: fit.roll_off_1_m,
                scatter: fit.scatter,
            }),
        }),
    };
    Ok((prepared, header))
}

/// The height field of a file, in whatever format it is.
fn scanned(path: &Path, dataset: &str) -> Result<Scan, StageError> {
    let dataset = (!dataset.is_empty()).then_some(dataset);
    let refuse = |why: String| StageError::Measured { path: path.to_owned(), why };
    let mut first = Vec::new();
    std::fs::File::open(path).and_then(|file| file.take(512).read_to_end(&mut first)).map_err(|error| refuse(error.to_string()))?;
    match detect(&first) {
        // A surface of this program says all of it.
        Some(Found::Hdf5) if dataset.is_none() && is_own_surface(path) => {
            let (header, heights) = read_surface(path)?;
            Ok(Scan { heights, size_m: Some([header.length_m; 2]), unit: Some("m".to_owned()), periodic: Some(header.periodic) })
        }
        Some(Found::Hdf5) => Ok(Scan { heights: read_heights(path, dataset)?, size_m: None, unit: None, periodic: None }),
        Some(Found::Scan(format)) => Ok(read(path, format, dataset)?),
        None => {
            let known = [Format::NetCdf3, Format::X3p, Format::Npy, Format::Text].map(Format::name).join(", ");
            Err(refuse(format!("it is in no format that is read here: HDF5, {known}")))
        }
    }
}
