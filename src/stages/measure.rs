//! A measured surface: read, made fit for the model, and put into words.

use super::StageError;
use super::correction::{corrected, refused};
use super::scan_spectra::scan_spectrum;
use crate::formats::recognize;
use crate::lengths::{LENGTHS, SAME_SIZE, metres};
use crate::model::MeasuredSurface;
use crate::model::{Detrend, Filter};
use crate::physics::surface::common_spectrum::ScanSpectrum;
use crate::physics::surface::edges::Edges;
use crate::physics::surface::measured::{Prepared, Treatment, square_side};
use crate::physics::surface::periodogram::{Estimate, periodogram, windowed_periodogram};
use crate::physics::surface::self_affine::{SelfAffine, fit_self_affine};
use crate::physics::surface::texture::Texture;
use crate::store::hdf5::{Measured, SpectrumFit, SurfaceHeader, is_own_surface, read_surface};
use crate::store::hdf5_scan::read_scan;
use crate::store::scan::{Asked, FirstIndex, Found, Scan, read};
use ndarray::Array2;
use std::f64::consts::TAU;
use std::ops::RangeInclusive;
use std::path::Path;

/// A measured surface after all preprocessing steps.
pub struct Imported {
    /// Heights and spectrum.
    pub prepared: Prepared,
    /// Header of its file in a run.
    pub header: SurfaceHeader,
    /// Factor from the numbers of the file to heights \[m\]; nothing for a surface of this program, which is
    /// in metres.
    pub height_factor_m: Option<f64>,
    /// Sentences on how the file was read.
    pub notes: Vec<String>,
}

impl Imported {
    /// Spectrum before the S-filter, with its limits of reliability. A surface of this program has passed the
    /// filter already.
    #[must_use]
    pub fn spectrum(&self) -> ScanSpectrum {
        scan_spectrum(&self.header, &self.prepared.rings, self.height_factor_m.is_none())
    }
}

/// A measured surface with the preprocessing of the spec, and the header of its file in a run. `digest` is
/// the BLAKE3 of its file. A surface written by this program, for example by `import`, is used without
/// changes.
///
/// # Errors
/// A file that cannot be read or lacks required data; a surface that
/// [`crate::physics::surface::measured::prepare`] refuses.
pub fn measure(params: &MeasuredSurface, digest: &str, key: &str) -> Result<Imported, StageError> {
    let path = Path::new(&params.file);
    let scan = match source(path, params)? {
        Source::Own(header, heights) => {
            uncorrected(params)?;
            same_size(params, header.length_m, heights.nrows())?;
            let (prepared, header) = own(params, *header, heights, digest, key)?;
            return Ok(Imported { prepared, header, height_factor_m: None, notes: Vec::new() });
        }
        Source::Scan(scan) => scan,
    };
    let (rows, columns) = scan.heights.dim();
    complete(params, &scan)?;
    let unit = unit(params, &scan)?;
    let height_factor_m = Some(unit * scan.factor);
    let spacing = plausible(params, spacing(params, &scan)?)?;
    let notes = notes(params, &scan);
    agree(path, scan.periodic, params.periodic)?;
    let treatment = Treatment {
        missing: params.missing,
        detrend: params.detrend,
        periodic: params.periodic,
        filter: params.filter,
        points_per_shortest_wavelength: f64::from(params.points_per_shortest_wavelength),
    };
    let (prepared, quality) =
        corrected(params, in_metres(path, scan.heights, unit)?, spacing, scan.first, &treatment)?;
    let measured = Measured {
        source: path
            .file_name()
            .map(|name| name.to_string_lossy().chars().take(60).collect())
            .unwrap_or_default(),
        source_blake3: digest.to_owned(),
        source_point_counts: [rows as u64, columns as u64],
        source_spacings_m: spacing,
        missing_count: prepared.missing_count as u64,
        detrend: params.detrend,
        trend_m: prepared.trend_m,
        shortest_wavelength_m: prepared.shortest_wavelength_m,
        filter: params.filter,
        noise_m: prepared.noise_m,
        overshoot_m: prepared.overshoot_m,
        fit: prepared.fit.as_ref().map(stored),
        texture: Texture::of(prepared.heights_m.view(), Edges::of(params.periodic))?,
        quality: Some(quality),
    };
    let header = header(&prepared, params.periodic, key, measured);
    Ok(Imported { prepared, header, height_factor_m, notes })
}

/// Side of the square of a measured surface \[m\], from its file.
///
/// # Errors
/// The problem and the help if the file cannot be read or lacks required data.
pub fn scan_side_m(params: &MeasuredSurface) -> Result<f64, (String, String)> {
    let read = || {
        let scan = match source(Path::new(&params.file), params)? {
            Source::Own(header, heights) => {
                same_size(params, header.length_m, heights.nrows())?;
                return Ok(header.length_m);
            }
            Source::Scan(scan) => scan,
        };
        complete(params, &scan)?;
        let (rows, columns) = scan.heights.dim();
        Ok(square_side([rows, columns], plausible(params, spacing(params, &scan)?)?))
    };
    read().map_err(|error: StageError| {
        let why = error.to_string();
        let (problem, help) = why.split_once("\nhelp: ").unwrap_or((&why, "check the file"));
        (problem.to_owned(), help.to_owned())
    })
}

/// Spacings of the points \[m\], unless they are those of no scan.
fn plausible(params: &MeasuredSurface, spacing_m: [f64; 2]) -> Result<[f64; 2], StageError> {
    let Some(apart) = spacing_m.iter().find(|apart| !PIXEL_SIZES.contains(apart)) else {
        return Ok(spacing_m);
    };
    let why = format!(
        "its points are {apart:e} m apart\nhelp: check the unit and the pixel size; a scan has points 1e-12 \
         m to 0.1 m apart"
    );
    Err(refused(Path::new(&params.file), &why))
}

/// Header of a measured surface in a run.
fn header(prepared: &Prepared, periodic: bool, key: &str, measured: Measured) -> SurfaceHeader {
    let moments = &prepared.moments;
    SurfaceHeader {
        length_m: prepared.length_m,
        realization: 0,
        periodic,
        key: key.to_owned(),
        rms_height_m: moments.rms_height_m(),
        rms_slope: moments.rms_slope(),
        rms_curvature_1_m: moments.rms_curvature_1_m(),
        nayak_parameter: moments.nayak_parameter(),
        generated: None,
        measured: Some(measured),
    }
}

/// A surface of this program, which has been treated already.
fn own(
    params: &MeasuredSurface,
    header: SurfaceHeader,
    heights_m: Array2<f64>,
    digest: &str,
    key: &str,
) -> Result<(Prepared, SurfaceHeader), StageError> {
    let path = Path::new(&params.file);
    agree(path, Some(header.periodic), params.periodic)?;
    let points = heights_m.nrows();
    let spacing = header.length_m / points as f64;
    // A generated surface has no waves below its shortest wavelength.
    let shortest = header.generated.map_or(0.0, |of| of.points_per_shortest_wavelength * spacing);
    let of_rings = if header.periodic { periodogram } else { windowed_periodogram };
    let rings = of_rings(heights_m.view(), header.length_m)?;
    // A surface of this program that is not periodic has been imported, and its header holds the fit.
    let fit =
        if header.periodic { fit_self_affine(&rings, header.length_m, Estimate::Periodogram) } else { None };
    let texture = Texture::of(heights_m.view(), Edges::of(header.periodic))?;
    let measured = header.measured.clone().unwrap_or_else(|| Measured {
        source: path
            .file_name()
            .map(|name| name.to_string_lossy().chars().take(60).collect())
            .unwrap_or_default(),
        source_blake3: digest.to_owned(),
        source_point_counts: [points as u64; 2],
        source_spacings_m: [spacing; 2],
        missing_count: 0,
        detrend: Detrend::Mean,
        trend_m: 0.0,
        // No filter: nothing is removed.
        filter: Filter::Sharp,
        shortest_wavelength_m: shortest,
        noise_m: 0.0,
        overshoot_m: 0.0,
        fit: fit.as_ref().map(stored),
        texture,
        quality: None,
    });
    let prepared = Prepared {
        heights_m,
        length_m: header.length_m,
        moments: header.moments(),
        rings,
        fit,
        missing_count: measured.missing_count as usize,
        trend_m: measured.trend_m,
        noise_m: measured.noise_m,
        overshoot_m: measured.overshoot_m,
        shortest_wavelength_m: measured.shortest_wavelength_m,
    };
    Ok((
        prepared,
        SurfaceHeader {
            realization: 0,
            key: key.to_owned(),
            generated: None,
            measured: Some(measured),
            ..header
        },
    ))
}

/// Refuses corrections of a surface of this program, which is used as it is.
fn uncorrected(params: &MeasuredSurface) -> Result<(), StageError> {
    let asked = [
        (params.outliers, "outliers"),
        (params.align_rows, "align_rows"),
        (params.tip_radius_m > 0.0, "tip_radius_m"),
    ];
    let Some((_, name)) = asked.into_iter().find(|(is_set, _)| *is_set) else { return Ok(()) };
    let why = format!(
        "surface.{name} corrects a scan, and this is a surface that hysteron wrote, which is used as it is\n\
         help: import the scan itself again with this option, or name it as surface.file"
    );
    Err(refused(Path::new(&params.file), &why))
}

/// Refuses a size or a unit that contradicts a surface which this program wrote, of a side \[m\].
fn same_size(params: &MeasuredSurface, length_m: f64, points: usize) -> Result<(), StageError> {
    let pixel_m = length_m / points as f64;
    let stated = [
        ("size_m", params.size_m, length_m),
        ("size_y_m", params.size_y_m, length_m),
        ("pixel_m", params.pixel_m, pixel_m),
    ];
    let differs = |(_, given, own): &&(&str, f64, f64)| *given > 0.0 && (given / own - 1.0).abs() > SAME_SIZE;
    let why = match stated.iter().find(differs) {
        Some((name, given, own)) => {
            format!(
                "surface.{name} is {given:.4e} m, and {own:.4e} m in the file\nhelp: remove surface.{name}"
            )
        }
        None if !matches!(params.unit.as_str(), "" | "m") => format!(
            "surface.unit is \"{}\", and a surface that hysteron wrote has heights in metres\n\
             help: remove surface.unit",
            params.unit
        ),
        None => return Ok(()),
    };
    Err(refused(Path::new(&params.file), &why))
}

/// Heights times their unit, in the same memory; infinite ones are missing, as NaN is.
fn in_metres(path: &Path, mut heights: Array2<f64>, unit: f64) -> Result<Array2<f64>, StageError> {
    let too_large = heights.iter().find(|h| h.is_finite() && !(unit * **h).is_finite());
    if let Some(height) = too_large {
        let why = format!(
            "heights too large: {height:e} in the unit {unit:e} m\nhelp: check the unit of the heights \
             (--unit, surface.unit)"
        );
        return Err(refused(path, &why));
    }
    heights *= unit;
    Ok(heights)
}

/// Checks that a file which says whether its surface is periodic agrees with what was given.
fn agree(path: &Path, own: Option<bool>, given: bool) -> Result<(), StageError> {
    match own {
        Some(true) if !given => Err(refused(
            path,
            "the file says that the surface is periodic, and periodic = false was given\nhelp: set \
             surface.periodic = true in a spec, or --periodic on the command line",
        )),
        Some(false) if given => Err(refused(
            path,
            "the file says that the surface is not periodic, and periodic = true was given\nhelp: leave out \
             surface.periodic in a spec, or --periodic on the command line",
        )),
        _ => Ok(()),
    }
}

/// The fit of a spectrum as a file holds it: cut-offs as wavelengths.
fn stored(fit: &SelfAffine) -> SpectrumFit {
    SpectrumFit {
        hurst: fit.hurst,
        plateau_m4: fit.plateau_m4,
        roll_off_1_m: fit.roll_off_1_m,
        rolls_off: Some(fit.rolls_off),
        scatter: fit.scatter,
        long_cut_m: fit.long_cut_1_m.map(|wavenumber| TAU / wavenumber),
        short_cut: fit.short_cut.map(|cut| (TAU / cut.wavenumber_1_m, cut.cause)),
    }
}

/// Distances between the points of a scan \[m\]: from below an atom to the largest `pixel_m` of a spec.
const PIXEL_SIZES: RangeInclusive<f64> = 1e-12..=0.1;

/// Pixel size along x and y that the user states, if any: `pixel_m`, or `size_m` over the numbers of points.
fn stated(params: &MeasuredSurface, scan: &Scan) -> Option<[f64; 2]> {
    let (x, y) = scan.heights.dim();
    let along_x = params.size_m / x as f64;
    match (params.size_m > 0.0, params.size_y_m > 0.0) {
        (true, true) => Some([along_x, params.size_y_m / y as f64]),
        // Square pixels, unless the file has positions.
        (true, false) => Some([along_x, along_x * scan.spacing.map_or(1.0, |[a, b]| b / a)]),
        _ => (params.pixel_m > 0.0).then_some([params.pixel_m; 2]),
    }
}

/// Checks that unit and pixel size are known, and names everything that is missing at once.
fn complete(params: &MeasuredSurface, scan: &Scan) -> Result<(), StageError> {
    let no_unit = scan.unit.is_none() && params.unit.is_empty();
    let no_size = scan.size_m.is_none() && scan.spacing.is_none() && stated(params, scan).is_none();
    let (x, y) = scan.heights.dim();
    let twice = match (params.size_m > 0.0, params.pixel_m > 0.0) {
        (true, true) => Some(("size_m and pixel_m both state the pixel size", "remove one of them")),
        (false, _) if params.size_y_m > 0.0 => {
            Some(("size_y_m without size_m", "state size_m, the size along x"))
        }
        _ => None,
    };
    if let Some((problem, help)) = twice {
        return Err(refused(Path::new(&params.file), &format!("{problem}\nhelp: {help}")));
    }
    let size = format!(
        "--size (along x, for example 5um), --pixel-m, or surface.size_m in a spec; {x} x {y} points"
    );
    let (problem, help) = match (no_unit, no_size) {
        (false, false) => return Ok(()),
        (true, false) => (
            "no unit of the heights in the file",
            "give the unit (--unit, or surface.unit in a spec), for example \"nm\"".to_owned(),
        ),
        (false, true) => ("no pixel size in the file", format!("give {size}")),
        (true, true) => (
            "no unit of the heights in the file, and no pixel size",
            format!("give --unit or surface.unit (of the heights, for example nm), and {size}"),
        ),
    };
    let notes: String = scan
        .notes
        .iter()
        .filter(|note| note.starts_with("sizes: "))
        .map(|note| format!(" ({note})"))
        .collect();
    Err(refused(Path::new(&params.file), &format!("{problem}{notes}\nhelp: {help}")))
}

/// Sentences on how a file was read: which index is x, and notes of the reader.
fn notes(params: &MeasuredSurface, scan: &Scan) -> Vec<String> {
    let order = match (scan.first, params.transpose) {
        (FirstIndex::X, false) => "the first index of the file runs along x, the second along y",
        (FirstIndex::Y, false) => "a line of the file runs along x; its first index is y",
        (FirstIndex::X, true) => "x and y exchanged: the first index of the file runs along x",
        (FirstIndex::Y, true) => "x and y exchanged: a line of the file runs along y",
    };
    std::iter::once(order.to_owned()).chain(scan.notes.iter().cloned()).collect()
}

/// Spacings of the points of a scan along x and y \[m\].
fn spacing(params: &MeasuredSurface, scan: &Scan) -> Result<[f64; 2], StageError> {
    let path = Path::new(&params.file);
    let (x, y) = scan.heights.dim();
    let (key, option) = if params.size_m > 0.0 { ("size_m", "--size") } else { ("pixel_m", "--pixel-m") };
    let differs = |own: [f64; 2], given: [f64; 2]| {
        own.iter().zip(given).any(|(own, given)| (own / given - 1.0).abs() > SAME_SIZE)
    };
    match (
        scan.size_m.map(|size| [size[0] / x as f64, size[1] / y as f64]),
        scan.spacing,
        stated(params, scan),
    ) {
        (Some([a, b]), _, Some(given)) if differs([a, b], given) => {
            let [c, d] = given;
            let why = format!(
                "the pixel size is {a:.4e} m x {b:.4e} m in the file, but {c:.4e} m x {d:.4e} m by \
                 {key}\nhelp: remove {key} ({option})"
            );
            Err(refused(path, &why))
        }
        (Some(own), ..) => Ok(own),
        // Positions whose unit is unknown: the statement gives their scale.
        (None, Some([a, b]), Some([c, d])) if ((a / b) / (c / d) - 1.0).abs() > SAME_SIZE => {
            let why = format!(
                "the pixel sizes along x and y are {a} and {b} in the file, but {c:.4e} m and {d:.4e} m by \
                 {key}\nhelp: remove {key} ({option}), or give both sizes (--size, for example \"5um x 3um\")"
            );
            Err(refused(path, &why))
        }
        (None, _, Some(given)) => Ok(given),
        // Without a unit of its own the file has one for all columns.
        (None, Some(own), None) => {
            metres(&params.unit).map(|unit| own.map(|spacing| unit * spacing)).ok_or_else(|| unitless(path))
        }
        (None, None, None) => Err(unitless(path)),
    }
}

/// Factor from the heights of a scan to metres.
fn unit(params: &MeasuredSurface, scan: &Scan) -> Result<f64, StageError> {
    let path = Path::new(&params.file);
    let given = &params.unit;
    match &scan.unit {
        Some(own) if !given.is_empty() && metres(given) != metres(own) => Err(refused(
            path,
            &format!(
                "the heights are in {own} in the file, but the unit {given:?} was given\nhelp: remove the \
                 unit (--unit)"
            ),
        )),
        Some(_) => Ok(1.0),
        None if given.is_empty() => Err(unitless(path)),
        None => metres(given).ok_or_else(|| {
            refused(
                path,
                &format!(
                    "the unit of the heights {given:?} is not a unit of length\nhelp: use one of {LENGTHS}"
                ),
            )
        }),
    }
}

fn unitless(path: &Path) -> StageError {
    refused(path, "no unit of the heights in the file\nhelp: give the unit (--unit), for example \"nm\"")
}

/// A file's heights: those of a surface of this program, which says all of it, or a scan.
enum Source {
    Own(Box<SurfaceHeader>, Array2<f64>),
    Scan(Scan),
}

/// The height field of a file, in whatever format it is.
fn source(path: &Path, params: &MeasuredSurface) -> Result<Source, StageError> {
    let field = (!params.dataset.is_empty()).then_some(params.dataset.as_str());
    let asked = Asked {
        field,
        skip_lines: u64::from(params.skip_lines),
        width: (params.width > 0).then_some(u64::from(params.width)),
    };
    let found = recognize(path).map_err(|error| refused(path, &error.to_string()))?;
    let scan = match found.map_err(|refusal| refused(path, &refusal.to_string()))? {
        Found::Hdf5 if field.is_none() && is_own_surface(path) => {
            let (header, heights) = read_surface(path).map_err(StageError::Scan)?;
            return Ok(Source::Own(Box::new(header), heights));
        }
        Found::Hdf5 => read_scan(path, &asked),
        Found::Scan(format) => read(path, format, &asked),
        Found::Foreign(foreign) => return Err(refused(path, foreign.name)),
    };
    let scan = scan.map_err(StageError::Scan)?;
    Ok(Source::Scan(if params.transpose { scan.transposed(path).map_err(StageError::Scan)? } else { scan }))
}
