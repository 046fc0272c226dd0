//! Statistics of an imported surface as text and as JSON.

use super::quality::{self, Line};
use super::range::Range;
use crate::model::{Choice, Detrend, Filter, SpectrumEnd};
use crate::spec::quoted;
use crate::stages::Ring;
use crate::stats::{Limit, significant};
use crate::store::hdf5::{Measured, SurfaceHeader};
use crate::text::{counted, wrapped};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::Path;

/// Statistics of an imported surface.
#[derive(Clone, Copy)]
pub(super) struct Statistics<'a> {
    /// The file.
    pub(super) file: &'a Path,
    pub(super) header: &'a SurfaceHeader,
    /// Metres per number of the file; nothing for a surface of this program.
    pub(super) height_factor_m: Option<f64>,
    /// Sentences on how the file was read.
    pub(super) notes: &'a [String],
    pub(super) range: &'a Range<'a>,
    /// Points along a side, asperities, and further ones near the edge.
    pub(super) counts: [usize; 3],
    /// Wavenumbers between which a self-affine spectrum was fitted \[1/m\]; nothing for a surface of this
    /// program.
    pub(super) fitted_1_m: Option<[f64; 2]>,
    /// The file written.
    pub(super) written: Option<&'a Path>,
}

/// A ring of the spectrum as JSON.
fn ring(of: &Ring) -> Value {
    json!({
        "wavenumber_1_m": of.wavenumber_1_m, "density_m4": of.density_m4, "mode_count": of.mode_count,
    })
}

/// The statistics of a surface, with the rings of its spectrum, as JSON.
pub(super) fn answer(of: &Statistics<'_>, rings: &[Ring]) -> Value {
    let Statistics { header, height_factor_m, range, counts: [points, summits, edge], written, .. } = *of;
    let measured = header.measured.as_ref();
    let texture = measured.and_then(|of| of.texture.as_ref());
    let fit = measured.and_then(|of| of.fit).map(|fit| {
        json!({
            "hurst": fit.hurst, "plateau_m4": fit.plateau_m4, "roll_off_1_m": fit.roll_off_1_m,
            "scatter": fit.scatter, "rolls_off": fit.rolls_off,
            "roll_off_m": fit.roll_off_m(header.length_m), "long_cut_m": fit.long_cut_m,
            "short_cut_m": fit.short_cut.map(|(wavelength, _)| wavelength),
            "short_cut_cause": fit.short_cut.map(|(_, cause)| cause.word()),
        })
    });
    let mut answer = json!({
        "file": written.map(|path| path.display().to_string()),
        "point_count": points,
        "length_m": header.length_m,
        "height_factor_m": height_factor_m,
        "notes": of.notes,
        "periodic": header.periodic,
        "rms_height_m": header.rms_height_m,
        "rms_slope": header.rms_slope,
        "rms_curvature_1_m": header.rms_curvature_1_m,
        "rms_laplacian_1_m": header.rms_curvature_1_m,
        "nayak_parameter": header.nayak_parameter,
        "summit_count": summits,
        "edge_count": edge,
        "source_point_counts": measured.map(|of| of.source_point_counts),
        "source_spacings_m": measured.map(|of| of.source_spacings_m),
        "cautions": cautions(header),
        "missing_count": measured.map(|of| of.missing_count),
        "trend_m": measured.map(|of| of.trend_m),
        "filter": measured.map(|of| of.filter.word()),
        "noise_m": measured.map(|of| of.noise_m),
        "overshoot_m": measured.map(|of| of.overshoot_m),
        "shortest_wavelength_m": measured.map(|of| of.shortest_wavelength_m),
        "source_blake3": measured.map(|of| of.source_blake3.as_str()),
        "self_affine": fit,
        "self_affine_lowest_1_m": of.fitted_1_m.map(|band| band[0]),
        "self_affine_highest_1_m": of.fitted_1_m.map(|band| band[1]),
        "density_convention": CONVENTION,
        "texture_aspect": texture.map(|of| of.aspect()),
        "texture_slope_ratio": texture.map(|of| of.slope_ratio),
        "texture_str": texture.map(|of| of.aspect_ratio_str),
        "texture_direction_rad": texture.map(|of| of.direction_rad),
        "flattening_m": range.whole_m,
        "flattening_octave_m": range.octave_m,
        "flattening_octave_shortest_wavelength_m": range.shortest_m,
        "least_modulus_over_adhesion_1_m": range.least_1_m(),
        "spectrum": rings.iter().map(ring).collect::<Vec<_>>(),
    });
    quality::numbers(header).into_iter().for_each(|(name, value)| answer[name] = value);
    answer
}

/// The statistics of a surface as text of at most 80 columns.
pub(super) fn text(of: &Statistics<'_>) -> String {
    let mut text = format!("{}\n", of.file.display());
    let lines = [
        source(of),
        quality::lines(of.header),
        preprocessing(of.header),
        roughness(of),
        texture(of.header),
        self_affinity(of.header, of.fitted_1_m),
    ];
    for (label, value) in lines.concat() {
        text += &wrapped(&format!("  {label:<14}{value}"), "                ");
    }
    text += &wrapped(&format!("  {:<14}{}", "model range", of.range.text()), "                ");
    for caution in cautions(of.header) {
        text += &wrapped(&format!("warning: {caution}"), "  ");
    }
    text + &of.written.map_or_else(|| "No file was written.\n".to_owned(), |path| spec(path, of))
}

/// Points and units of the file, and the central square.
fn source(of: &Statistics<'_>) -> Vec<Line> {
    let mut lines = Vec::new();
    if let Some(measured) = &of.header.measured {
        let ([rows, columns], [a, b]) = (measured.source_point_counts, measured.source_spacings_m);
        lines
            .push(("file", format!("{rows} x {columns} points along x and y, {a:.4e} m by {b:.4e} m apart")));
        lines.extend(of.notes.iter().map(|note| ("", note.clone())));
        if (a / b - 1.0).abs() > 1e-3 {
            lines.push(("", format!("interpolated to points {:.4e} m apart both ways", a.min(b))));
        }
    }
    let factor =
        of.height_factor_m.map(|factor| format!("{} m per number of the file", significant(factor, 6)));
    lines.push((
        "height factor",
        factor.unwrap_or_else(|| "1 (surface of this program, in metres)".to_owned()),
    ));
    let continued = if of.header.periodic { "periodic" } else { "not periodic" };
    let points = of.counts[0];
    lines.push(("square", format!("{points} x {points} points, {:.4e} m, {continued}", of.header.length_m)));
    lines
}

/// Missing points, and removed form and wavelengths.
fn preprocessing(header: &SurfaceHeader) -> Vec<Line> {
    let lines = |of: &Measured| {
        let missing = counted(usize::try_from(of.missing_count).unwrap_or(usize::MAX), "point");
        let filled = if of.missing_count > 0 { ", interpolated (harmonic in-fill)" } else { "" };
        let form = if of.detrend == Detrend::Mean {
            "the mean".to_owned()
        } else {
            format!("a {}: {:.3e} m rms", shape(of.detrend), of.trend_m)
        };
        vec![
            ("missing", format!("{missing}{filled}")),
            ("removed", form),
            (
                "",
                format!(
                    "wavelengths below {:.3e} m ({}): {:.3e} m rms",
                    of.shortest_wavelength_m,
                    kind(of.filter),
                    of.noise_m
                ),
            ),
        ]
    };
    header.measured.as_ref().map(lines).unwrap_or_default()
}

/// Rms values and asperities.
fn roughness(of: &Statistics<'_>) -> Vec<Line> {
    let SurfaceHeader { length_m, rms_height_m, rms_slope, rms_curvature_1_m, nayak_parameter, .. } =
        *of.header;
    let [_, summits, edge] = of.counts;
    let nayak = of.header.moments().summit_density_1_m2() * length_m * length_m;
    let mut lines = vec![
        (
            "heights",
            format!(
                "{rms_height_m:.4e} m rms, slope {rms_slope:.4} rms, Laplacian {rms_curvature_1_m:.3e} 1/m \
                 rms"
            ),
        ),
        ("", format!("mean curvature {:.3e} 1/m rms: half the Laplacian", 0.5 * rms_curvature_1_m)),
        (
            "summits",
            format!(
                "{summits}, and {nayak:.0} predicted by Nayak (bandwidth parameter {nayak_parameter:.2})"
            ),
        ),
    ];
    if edge > 0 {
        lines.push(("", format!("{edge} more near the edge are excluded")));
    }
    lines
}

/// Aspect ratio of the texture.
fn texture(header: &SurfaceHeader) -> Vec<Line> {
    let Some(of) = header.measured.as_ref().and_then(|of| of.texture.as_ref()) else { return Vec::new() };
    let (aspect, ratio) = (significant(of.aspect(), 3), significant(of.slope_ratio, 3));
    let (str, direction) = (significant(of.aspect_ratio_str, 2), of.direction_rad.to_degrees());
    let ridges = format!("rms slope smallest at {direction:.0}° from x to y");
    vec![
        ("texture", format!("aspect ratio {aspect}: rms slopes {ratio}, Str {str} (ISO 25178)")),
        ("", ridges),
    ]
}

/// Warning of a texture beyond the limit.
fn texture_caution(of: &Measured) -> Option<String> {
    let (aspect, limit) = (of.texture.as_ref()?.aspect(), Limit::of("texture")?);
    limit.is_passed(Some(aspect)).then(|| {
        format!(
            "texture: aspect ratio {} (limit {}); expected ratios to boundary elements and the statistics of \
             Nayak and of Deng and Kesari hold for isotropic surfaces only; use method = \
             \"boundary_elements\"",
            significant(aspect, 3),
            limit.bound
        )
    })
}

/// Normalization of the spectral density, with the factor to that of other programs.
const CONVENTION: &str =
    "integral of C(q) over d2q = h_rms^2; SurfaceTopography and contact.engineering: 4 pi^2 = 39.48 times C";

/// Fit of a self-affine spectrum, and the band of wavelengths that holds data.
fn self_affinity(header: &SurfaceHeader, fitted_1_m: Option<[f64; 2]>) -> Vec<Line> {
    let Some(fit) = header.measured.as_ref().and_then(|of| of.fit) else {
        return vec![("self-affine", "no fit".to_owned())];
    };
    let rolls = fit
        .roll_off_m(header.length_m)
        .map_or_else(|| "none within the scan".to_owned(), |at| format!("at {at:.3e} m"));
    let long = fit
        .long_cut_m
        .map_or_else(|| "none within the scan".to_owned(), |at| format!("no data above {at:.3e} m"));
    let short = fit.short_cut.map_or_else(
        || "none".to_owned(),
        |(at, cause)| match cause {
            SpectrumEnd::Empty => format!("no data below {at:.3e} m"),
            SpectrumEnd::GaussianFilter => format!("{at:.3e} m, half of the amplitude of a Gaussian filter"),
            SpectrumEnd::WhiteNoise => format!("white noise below {at:.3e} m"),
        },
    );
    let range = fitted_1_m.map(|[low, high]| {
        ("", format!("fitted to wavelengths from {:.3e} to {:.3e} m", TAU / low, TAU / high))
    });
    let mut lines = vec![
        (
            "self-affine",
            format!(
                "H = {:.3}, C0 = {:.3e} m⁴, scatter {:.2} decades",
                fit.hurst, fit.plateau_m4, fit.scatter
            ),
        ),
        ("", "∫C(q)d²q = h_rms²; SurfaceTopography: 4π² = 39.48 times C".to_owned()),
        ("roll-off", rolls),
        ("long cut", long),
        ("short cut", short),
    ];
    lines.splice(1..1, range);
    lines
}

/// The written file and a spec for it.
fn spec(path: &Path, of: &Statistics<'_>) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let stem: String = stem.chars().filter(|c| c.is_ascii_alphanumeric()).take(32).collect();
    let file = format!("file = {}", quoted(&path.to_string_lossy()));
    format!(
        "Written: {}. Spec for this surface; replace the material constants:\n\n{}",
        path.display(),
        spec_of(&format!("of_{stem}"), &file, of.header.periodic, of.range)
    )
}

/// A spec for measured surfaces with this line of files.
pub(super) fn spec_of(name: &str, files: &str, is_periodic: bool, range: &Range<'_>) -> String {
    let periodic = if is_periodic { "periodic = true\n" } else { "" };
    format!(
        "name = \"{name}\"\n[surface]\n{files}\n{periodic}{}[cycle]\nmax_load = [0.004]       # F/(E* A0)\n",
        range.spec(is_periodic)
    )
}

/// Hurst exponents of self-affine surfaces, with the error of the fit.
const SELF_AFFINE: std::ops::RangeInclusive<f64> = -0.05..=1.05;

/// Fraction of a scan that the central crop may drop without a warning.
pub(super) const DROPPED: f64 = 0.1;

/// Rms slopes that are too steep and too flat to be likely, and an rms height that is too small \[m\].
pub(super) const STEEP: f64 = 1.0;
pub(super) const FLAT: f64 = 1e-5;
pub(super) const LOW_M: f64 = 1e-10;

/// Warnings: what the central square leaves out, units or values that are unlikely, and a spectrum that is
/// not self-affine.
pub(super) fn cautions(header: &SurfaceHeader) -> Vec<String> {
    let mut cautions = Vec::new();
    if let Some(of) = &header.measured {
        let ([rows, columns], dropped) = (of.source_point_counts, of.dropped(header.length_m));
        if dropped > DROPPED {
            let points = (header.length_m / of.source_spacings_m[0].min(of.source_spacings_m[1])).round();
            let [a, b] = [rows as f64 * of.source_spacings_m[0], columns as f64 * of.source_spacings_m[1]];
            cautions.push(format!(
                "crop: {:.0} % of the scan ({rows} x {columns} points, {a:.3e} m x {b:.3e} m) is outside the \
                 central square and dropped (limit {:.0} %); {points} x {points} points remain, and all \
                 results are of these",
                100.0 * dropped,
                100.0 * DROPPED
            ));
        }
        cautions.extend(texture_caution(of));
        cautions.extend(overshoot(of, header.rms_height_m));
        match of.fit {
            Some(fit) if !SELF_AFFINE.contains(&fit.hurst) => cautions.push(format!(
                "fit: H = {:.2} is outside 0 to 1, so the spectrum is not self-affine in the band of \
                 wavelengths that holds data; do not use H",
                fit.hurst
            )),
            Some(_) => {}
            None => cautions.push(
                "fit: too few wavelengths with data for a self-affine fit; use a larger \
                 scan"
                    .to_owned(),
            ),
        }
    }
    cautions.extend(quality::warnings(header));
    if header.rms_slope > STEEP {
        cautions.push(format!(
            "an rms slope of {:.3} is steeper than 45 degrees; check the units, and values of missing points",
            header.rms_slope
        ));
    }
    if header.rms_slope < FLAT {
        cautions.push(format!(
            "an rms slope of {:.1e} is flatter than any measured surface; check the units",
            header.rms_slope
        ));
    }
    if header.rms_height_m < LOW_M {
        cautions.push(format!("{:.1e} m rms is less than an atom; check the units", header.rms_height_m));
    }
    cautions
}

/// Warning of a filter that rings at steps.
fn overshoot(of: &Measured, rms_height_m: f64) -> Option<String> {
    let limit =
        Limit::of("overshoot").filter(|limit| limit.is_passed(Some(of.overshoot_m / rms_height_m)))?;
    Some(format!(
        "overshoot: filtered heights exceed the measured heights nearby by {:.2e} m beyond the noise (limit \
         {:.0} % of h_rms, {:.2e} m); the sharp low-pass filter rings at steps, and its asperities there do \
         not exist. Apply --filter gaussian",
        of.overshoot_m,
        100.0 * limit.bound,
        limit.bound * rms_height_m
    ))
}

fn kind(filter: Filter) -> &'static str {
    match filter {
        Filter::Gaussian => "Gaussian filter",
        Filter::Sharp => "sharp cut-off",
    }
}

fn shape(detrend: Detrend) -> &'static str {
    match detrend {
        Detrend::Mean => "mean",
        Detrend::Plane => "plane",
        Detrend::Quadratic => "quadratic surface",
    }
}
