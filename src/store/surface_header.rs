//! Attributes of the root of a surface file.

use hdf5_metno::{File, Group};
use ndarray::ArrayView2;
use std::f64::consts::TAU;

use crate::model::{Amplitudes, Choice, Detrend, Filter, Normalization, SpectrumEnd};
use crate::physics::surface::SquareMap;
use crate::physics::surface::edges::Edges;
use crate::physics::surface::spectrum::Moments;
use crate::physics::surface::texture::Texture;

use super::attributes::{
    COPIES, choice, finite, number, truth, word, write_copy, write_finite, write_number, write_word,
};
use super::error::Cause;
use super::quality::{Quality, read_quality, write_quality};

/// Version of the layout of a surface file, raised whenever an attribute is renamed, removed, or changes its
/// meaning.
pub const SURFACE_VERSION: u32 = 1;
/// Attribute of that group: BLAKE3 of the heights.
const SUM: &str = "height_blake3";
/// Attributes of a surface file.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceHeader {
    /// Side of the square \[m\].
    pub length_m: f64,
    /// Number of the surface among the surfaces with the same spectrum; 0 for a measured one.
    pub realization: u64,
    /// True if the surface continues periodically.
    pub periodic: bool,
    /// Key of the unit that wrote it.
    pub key: String,
    /// Rms height that the surface has \[m\].
    pub rms_height_m: f64,
    /// Rms of the gradient that it has.
    pub rms_slope: f64,
    /// Rms of the Laplacian that it has \[1/m\].
    pub rms_curvature_1_m: f64,
    /// `m0 m4 / m2²` that it has (Nayak 1971).
    pub nayak_parameter: f64,
    /// Parameters of generation; nothing for a measured surface, whose file lacks these attributes.
    pub generated: Option<Generated>,
    /// Source and preprocessing of a measured surface; nothing for a generated one.
    pub measured: Option<Measured>,
}

/// Exponent of the spectral density above which short wavelengths are noise. Offsets of scan lines alone have
/// -1, self-affine surfaces less than -2.
const NOISE_EXPONENT: f64 = -1.0;

impl SurfaceHeader {
    /// Columns that state the artefacts of a measured surface, as fractions of its points and rms height;
    /// empty if they are unknown.
    #[must_use]
    pub fn artefact_columns(&self) -> Vec<(&'static str, Option<f64>)> {
        let Some((measured, quality)) =
            self.measured.as_ref().and_then(|of| of.quality.as_ref().map(|quality| (of, quality)))
        else {
            return Vec::new();
        };
        let points: u64 = measured.source_point_counts.iter().product();
        let noise = quality.noise_exponent.filter(|exponent| *exponent > NOISE_EXPONENT);
        vec![
            (
                "outlier_share",
                Some(if quality.outlier_effect > 1.0 {
                    quality.outlier_left_count as f64 / points as f64
                } else {
                    0.0
                }),
            ),
            ("line_jump_share", Some(quality.line_jump_m / self.rms_height_m)),
            ("noise_share", Some(noise.map_or(0.0, |_| measured.noise_m / self.rms_height_m))),
            ("curvature_ratio", quality.curvature_ratio),
        ]
    }

    /// The surface with these heights \[m\].
    #[must_use]
    pub fn square<'a>(&self, heights_m: ArrayView2<'a, f64>) -> SquareMap<'a> {
        SquareMap { heights_m, length_m: self.length_m, edges: Edges::of(self.periodic) }
    }

    /// Spectral moments of the realized surface.
    #[must_use]
    pub fn moments(&self) -> Moments {
        Moments::of_rms(self.rms_height_m, self.rms_slope, self.rms_curvature_1_m)
    }
}

/// Source and preprocessing of a measured surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Name of the file, without its folder.
    pub source: String,
    /// BLAKE3 of that file.
    pub source_blake3: String,
    /// Points of that file along rows and along columns.
    pub source_point_counts: [u64; 2],
    /// Spacing of the points along rows and columns \[m\].
    pub source_spacings_m: [f64; 2],
    /// Points that were missing and are filled in.
    pub missing_count: u64,
    /// Form subtracted from the heights.
    pub detrend: Detrend,
    /// Rms height of that \[m\].
    pub trend_m: f64,
    /// Low-pass filter (S-filter).
    pub filter: Filter,
    /// Cut-off wavelength of that \[m\].
    pub shortest_wavelength_m: f64,
    /// Rms height of the removed short wavelengths \[m\].
    pub noise_m: f64,
    /// Largest height of filtered maxima above the unfiltered heights nearby, beyond the noise \[m\].
    pub overshoot_m: f64,
    /// The self-affine spectrum that fits its own; nothing where it has too few modes.
    pub fit: Option<SpectrumFit>,
    /// Texture; nothing in a file of an earlier version.
    pub texture: Option<Texture>,
    /// Corrected and remaining artefacts; nothing in files of versions without the search for artefacts.
    pub quality: Option<Quality>,
}

impl Measured {
    /// Fraction of the scan's area that is outside the square of side `length_m` \[m\] that was made of it.
    #[must_use]
    pub fn dropped(&self, length_m: f64) -> f64 {
        let [rows, columns] = self.source_point_counts.map(|count| count as f64);
        let [along_rows, along_columns] = self.source_spacings_m;
        (1.0 - length_m * length_m / (rows * along_rows * columns * along_columns)).max(0.0)
    }
}

/// A self-affine spectrum with a roll-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectrumFit {
    /// Hurst exponent H.
    pub hurst: f64,
    /// C0 \[m⁴\].
    pub plateau_m4: f64,
    /// Wavenumber of the roll-off \[1/m\]; that of the longest wavelength with data, if there is none.
    pub roll_off_1_m: f64,
    /// True if there is a roll-off; nothing in a file of an earlier version.
    pub rolls_off: Option<bool>,
    /// Rms deviation of log10 C.
    pub scatter: f64,
    /// Wavelength above which the spectrum holds no data \[m\]; nothing if it holds data up to the longest.
    pub long_cut_m: Option<f64>,
    /// Wavelength below which it holds no data \[m\], and its cause; nothing if it holds data down to the
    /// points.
    pub short_cut: Option<(f64, SpectrumEnd)>,
}

impl SpectrumFit {
    /// Wavelength of the roll-off of a surface of side L \[m\]; nothing without one. In a file without a
    /// statement there is one well within the scan.
    #[must_use]
    pub fn roll_off_m(&self, length_m: f64) -> Option<f64> {
        let at = TAU / self.roll_off_1_m;
        self.rolls_off.unwrap_or(at < 0.7 * length_m).then_some(at)
    }
}

/// Parameters of a generated surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Generated {
    /// Target rms height \[m\].
    pub target_rms_height_m: f64,
    /// Hurst exponent (Eq 10).
    pub hurst: f64,
    /// Longest over shortest wavelength (Eq 10).
    pub magnification: f64,
    /// Seed of its phases.
    pub seed: u64,
    /// Grid points per shortest wavelength.
    pub points_per_shortest_wavelength: f64,
    /// Normalization of the rms height.
    pub normalization: Normalization,
    /// The moduli of its Fourier modes.
    pub amplitudes: Amplitudes,
    /// Longest wavelength \[m\], if it is below L.
    pub longest_wavelength_m: Option<f64>,
    /// Roll-off wavelength \[m\], if there is one.
    pub roll_off_m: Option<f64>,
    /// Aspect ratio of the roughness.
    pub aspect_ratio: f64,
    /// Direction of the lay \[°\].
    pub angle_deg: f64,
    /// Flattening `U_el/E*` of the wavelengths of a tabulated spectrum below the shortest one \[m\];
    /// nothing for
    /// a power law. The Hurst exponent has no meaning for a table.
    pub left_out_m: Option<f64>,
}

/// Writes a header as attributes of the root.
pub(super) fn write(file: &File, header: &SurfaceHeader) -> Result<(), Cause> {
    file.create_group_builder().obj_track_times(false).create(COPIES)?;
    write_number(file, "schema_version", SURFACE_VERSION)?;
    write_word(file, "key", &header.key)?;
    write_finite(file, "length_m", header.length_m)?;
    write_number(file, "realization", header.realization)?;
    // A number: NetCDF has no truth values, and its readers skip them.
    write_number(file, "periodic", u8::from(header.periodic))?;
    write_finite(file, "rms_height_m", header.rms_height_m)?;
    write_finite(file, "rms_slope", header.rms_slope)?;
    write_finite(file, "rms_curvature_1_m", header.rms_curvature_1_m)?;
    write_finite(file, "nayak_parameter", header.nayak_parameter)?;
    if let Some(measured) = &header.measured {
        write_measured(file, measured)?;
    }
    let Some(generated) = &header.generated else {
        return Ok(());
    };
    write_finite(file, "target_rms_height_m", generated.target_rms_height_m)?;
    write_finite(file, "hurst", generated.hurst)?;
    write_finite(file, "magnification", generated.magnification)?;
    write_number(file, "seed", generated.seed)?;
    write_finite(file, "points_per_shortest_wavelength", generated.points_per_shortest_wavelength)?;
    write_word(file, "normalization", generated.normalization.word())?;
    write_word(file, "amplitudes", generated.amplitudes.word())?;
    write_shape(file, generated)
}

/// Writes the shape of a spectrum that is no plain power law.
fn write_shape(file: &File, generated: &Generated) -> Result<(), Cause> {
    if let Some(longest_m) = generated.longest_wavelength_m {
        write_finite(file, "longest_wavelength_m", longest_m)?;
    }
    if let Some(roll_off_m) = generated.roll_off_m {
        write_finite(file, "roll_off_m", roll_off_m)?;
    }
    if generated.aspect_ratio != 1.0 {
        write_finite(file, "aspect_ratio", generated.aspect_ratio)?;
        write_finite(file, "angle_deg", generated.angle_deg)?;
    }
    if let Some(left_out_m) = generated.left_out_m {
        write_finite(file, "tabulated_left_out_m", left_out_m)?;
    }
    Ok(())
}

fn write_measured(file: &File, measured: &Measured) -> Result<(), Cause> {
    write_word(file, "source", &measured.source)?;
    write_word(file, "source_blake3", &measured.source_blake3)?;
    let [rows, columns] = measured.source_point_counts;
    write_number(file, "source_row_count", rows)?;
    write_number(file, "source_column_count", columns)?;
    let [along_rows, along_columns] = measured.source_spacings_m;
    write_finite(file, "source_row_spacing_m", along_rows)?;
    write_finite(file, "source_column_spacing_m", along_columns)?;
    write_number(file, "missing_count", measured.missing_count)?;
    write_word(file, "detrend", measured.detrend.word())?;
    write_finite(file, "trend_m", measured.trend_m)?;
    write_word(file, "filter", measured.filter.word())?;
    write_finite(file, "shortest_wavelength_m", measured.shortest_wavelength_m)?;
    write_finite(file, "noise_m", measured.noise_m)?;
    write_finite(file, "overshoot_m", measured.overshoot_m)?;
    if let Some(texture) = &measured.texture {
        write_finite(file, "texture_slope_ratio", texture.slope_ratio)?;
        write_finite(file, "texture_direction_rad", texture.direction_rad)?;
        write_finite(file, "texture_str", texture.aspect_ratio_str)?;
        write_finite(file, "texture_decay_length", texture.decay_length)?;
    }
    if let Some(quality) = &measured.quality {
        write_quality(file, quality)?;
    }
    let Some(fit) = &measured.fit else { return Ok(()) };
    if let Some(rolls_off) = fit.rolls_off {
        write_number(file, "fit_rolls_off", rolls_off)?;
    }
    if let Some(long_cut_m) = fit.long_cut_m {
        write_finite(file, "fit_long_cut_m", long_cut_m)?;
    }
    if let Some((short_cut_m, cause)) = fit.short_cut {
        write_finite(file, "fit_short_cut_m", short_cut_m)?;
        write_word(file, "fit_short_cut_cause", cause.word())?;
    }
    write_finite(file, "fit_hurst", fit.hurst)?;
    write_finite(file, "fit_plateau_m4", fit.plateau_m4)?;
    write_finite(file, "fit_roll_off_1_m", fit.roll_off_1_m)?;
    write_finite(file, "fit_scatter", fit.scatter)
}

fn read_measured(file: &File, words: &Group, names: &[String]) -> Result<Measured, Cause> {
    let has = |wanted: &str| names.iter().any(|name| name == wanted);
    let texture = || -> Result<Texture, Cause> {
        Ok(Texture {
            slope_ratio: finite(file, "texture_slope_ratio")?,
            direction_rad: finite(file, "texture_direction_rad")?,
            aspect_ratio_str: finite(file, "texture_str")?,
            decay_length: finite(file, "texture_decay_length")?,
        })
    };
    let short_cut = || -> Result<(f64, SpectrumEnd), Cause> {
        Ok((finite(file, "fit_short_cut_m")?, choice(words, "fit_short_cut_cause")?))
    };
    let fit = || -> Result<SpectrumFit, Cause> {
        Ok(SpectrumFit {
            hurst: finite(file, "fit_hurst")?,
            plateau_m4: finite(file, "fit_plateau_m4")?,
            roll_off_1_m: finite(file, "fit_roll_off_1_m")?,
            scatter: finite(file, "fit_scatter")?,
            rolls_off: has("fit_rolls_off").then(|| truth(file, "fit_rolls_off")).transpose()?,
            long_cut_m: has("fit_long_cut_m").then(|| finite(file, "fit_long_cut_m")).transpose()?,
            short_cut: has("fit_short_cut_m").then(short_cut).transpose()?,
        })
    };
    Ok(Measured {
        source: word(words, "source")?,
        source_blake3: word(words, "source_blake3")?,
        source_point_counts: [number(file, "source_row_count")?, number(file, "source_column_count")?],
        source_spacings_m: [finite(file, "source_row_spacing_m")?, finite(file, "source_column_spacing_m")?],
        missing_count: number(file, "missing_count")?,
        detrend: choice(words, "detrend")?,
        trend_m: finite(file, "trend_m")?,
        // A file without the attribute has the sharp cut-off, which was the only one.
        filter: if has("filter") { choice(words, "filter")? } else { Filter::Sharp },
        shortest_wavelength_m: finite(file, "shortest_wavelength_m")?,
        noise_m: finite(file, "noise_m")?,
        overshoot_m: if has("overshoot_m") { finite(file, "overshoot_m")? } else { 0.0 },
        fit: has("fit_hurst").then(fit).transpose()?,
        texture: has("texture_str").then(texture).transpose()?,
        quality: read_quality(file, words, names)?,
    })
}

/// Reads the header from the attributes of the root.
pub(super) fn read(file: &File) -> Result<SurfaceHeader, Cause> {
    let names = file.attr_names()?;
    if !names.iter().any(|name| name == "schema_version") {
        return Err("not a surface file of hysteron: no attribute \"schema_version\"".into());
    }
    let version: u32 = number(file, "schema_version")?;
    if version != SURFACE_VERSION {
        return Err(format!(
            "unsupported layout version {version}; this program reads version {SURFACE_VERSION}"
        )
        .into());
    }
    let words = &file.group(if file.link_exists(COPIES) { COPIES } else { "/" })?;
    let has = |wanted: &str| names.iter().any(|name| name == wanted);
    let of_shape = |name: &str| has(name).then(|| finite(file, name)).transpose();
    let generated = if has("hurst") {
        Some(Generated {
            target_rms_height_m: finite(file, "target_rms_height_m")?,
            hurst: finite(file, "hurst")?,
            magnification: finite(file, "magnification")?,
            seed: number(file, "seed")?,
            points_per_shortest_wavelength: finite(file, "points_per_shortest_wavelength")?,
            normalization: choice(words, "normalization")?,
            amplitudes: choice(words, "amplitudes")?,
            longest_wavelength_m: of_shape("longest_wavelength_m")?,
            roll_off_m: of_shape("roll_off_m")?,
            aspect_ratio: of_shape("aspect_ratio")?.unwrap_or(1.0),
            angle_deg: of_shape("angle_deg")?.unwrap_or(0.0),
            left_out_m: of_shape("tabulated_left_out_m")?,
        })
    } else {
        None
    };
    Ok(SurfaceHeader {
        length_m: finite(file, "length_m")?,
        realization: number(file, "realization")?,
        periodic: truth(file, "periodic")?,
        key: word(words, "key")?,
        rms_height_m: finite(file, "rms_height_m")?,
        rms_slope: finite(file, "rms_slope")?,
        rms_curvature_1_m: finite(file, "rms_curvature_1_m")?,
        nayak_parameter: finite(file, "nayak_parameter")?,
        generated,
        measured: if names.iter().any(|name| name == "source") {
            Some(read_measured(file, words, &names)?)
        } else {
            None
        },
    })
}

/// Writes the checksum of the heights, which the format does not check.
pub(super) fn write_sum(file: &File, sum: &str) -> Result<(), Cause> {
    write_copy(file, SUM, sum)
}

/// The checksum of the heights; nothing in files of earlier versions.
pub(super) fn read_sum(file: &File) -> Result<Option<String>, Cause> {
    if !file.link_exists(COPIES) {
        return Ok(None);
    }
    let words = file.group(COPIES)?;
    if words.attr_names()?.iter().any(|name| name == SUM) { word(&words, SUM).map(Some) } else { Ok(None) }
}
