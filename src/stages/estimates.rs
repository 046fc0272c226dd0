//! Asperities and analytical estimates of a surface, their table, and the estimates of a failed cycle.

use super::StageError;
use crate::campaign::{Campaign, CycleUnit, SurfaceUnit};
use crate::model::{GeneratedSurface, Material};
use crate::physics::jkr::Asperity;
use crate::physics::surface::edges::Edges;
use crate::physics::surface::measured::find_measured;
use crate::physics::surface::spectrum::Spectrum;
use crate::physics::surface::summits::{Summit, Summits, find_summits};
use crate::physics::surface::synthesis::realization_seed;
use crate::physics::surface::texture::Texture;
use crate::physics::theory::estimates::{Ratios, Roughness, SurfaceEstimates};
use crate::physics::theory::flattening::RelativeFlattening;
use crate::schema::SURFACE_ESTIMATES;
use crate::spec::CaseParams;
use crate::store::hdf5::SurfaceHeader;
use crate::store::{Frame, FrameError, parquet};
use ndarray::ArrayView2;
use std::path::Path;

/// Target spectrum of a case; a measured surface has none, nor has a table whose file is missing.
pub(super) fn target(params: &CaseParams) -> Option<Spectrum> {
    params.surface.generated().filter(|surface| surface.has_spectrum()).map(GeneratedSurface::spectrum)
}

/// True for a number that a table may hold.
pub(super) fn finite(value: &f64) -> bool {
    value.is_finite()
}

/// Asperities of a surface, with its estimates.
pub struct Examined {
    /// Asperities.
    pub(super) found: Summits,
    /// Asperities too close to an edge, which are excluded.
    pub edge_count: usize,
    /// Estimates.
    pub estimates: SurfaceEstimates,
    /// Texture; nothing for a generated surface with an isotropic spectrum, and for a few points.
    pub(super) texture: Option<Texture>,
}

impl Examined {
    /// Of the heights \[m\] of a measured surface.
    ///
    /// # Errors
    /// Too few points per shortest wavelength; too little memory.
    pub fn of_measured(header: &SurfaceHeader, heights: ArrayView2<'_, f64>) -> Result<Self, StageError> {
        let square = header.square(heights);
        let cut_off_m = header.measured.as_ref().map_or(0.0, |of| of.shortest_wavelength_m);
        let points = cut_off_m * heights.nrows() as f64 / header.length_m;
        let (found, edge_count) = find_measured(square, points)?;
        let estimates =
            SurfaceEstimates::of_measured(square, cut_off_m, roughness(header), found.list.len())?;
        let texture = header.measured.as_ref().and_then(|of| of.texture);
        Ok(Self { found, edge_count, estimates, texture })
    }

    /// Of the heights \[m\] of a generated surface.
    pub(super) fn of_generated(
        surface: &GeneratedSurface,
        seed: &[u8; 32],
        header: &SurfaceHeader,
        heights: ArrayView2<'_, f64>,
    ) -> Result<Self, StageError> {
        let found =
            find_summits(heights, header.length_m, f64::from(surface.points_per_shortest_wavelength))?;
        let estimates =
            SurfaceEstimates::of_generated(&surface.spectrum(), seed, roughness(header), found.list.len());
        let is_isotropic = surface.spectrum().shape.is_isotropic();
        let texture = if is_isotropic { None } else { Texture::of(heights, Edges::Periodic)? };
        Ok(Self { found, edge_count: 0, estimates, texture })
    }

    /// Tabor parameter of the sharpest asperity; nothing without asperities.
    #[must_use]
    pub fn least_tabor(&self, material: &Material) -> Option<f64> {
        let radius_m = self.found.list.iter().map(Summit::radius_m).reduce(f64::min)?;
        Some(Asperity::new(radius_m, material).ok()?.tabor(material.interaction_range_m))
    }
}

fn roughness(header: &SurfaceHeader) -> Roughness {
    let SurfaceHeader { rms_height_m, rms_slope, rms_curvature_1_m, .. } = *header;
    Roughness { rms_height_m, rms_slope, rms_curvature_1_m }
}

pub(super) fn seed(campaign: &Campaign, unit: &SurfaceUnit) -> [u8; 32] {
    realization_seed(campaign.spec.seed, u64::from(unit.realization))
}

/// Table of one row with the estimates of a surface.
pub(super) fn surface_table(
    unit: &SurfaceUnit,
    header: &SurfaceHeader,
    of: &SurfaceEstimates,
    texture: Option<&Texture>,
) -> Result<Frame, FrameError> {
    let artefacts = header.artefact_columns();
    let artefact =
        |name: &str| artefacts.iter().find(|(known, _)| *known == name).and_then(|(_, value)| *value);
    let overshoot = header.measured.as_ref().map(|measured| measured.overshoot_m / header.rms_height_m);
    let frame = Frame::of(&SURFACE_ESTIMATES)
        .text("surface_id", [unit.id.as_str()])
        .i64("realization", [i64::from(unit.realization)])
        .f64("length_m", [header.length_m])
        .f64("rms_height_m", [header.rms_height_m])
        .bool("periodic", [header.periodic])
        .f64("cut_off_m", [of.cut_off_m])
        .f64("shortest_wavelength_m", [of.shortest_wavelength_m])
        .f64("flattening_wavenumber_1_m", [of.flattening.wavenumber_1_m])
        .f64("flattening_m2", [of.flattening.whole_m2])
        .f64("flattening_octave_m2", [of.flattening.octave_m2])
        .f64("nominal_area_m2", [of.nominal_area_m2()])
        .count("summit_count", [of.summit_count])
        .f64("summit_density_1_m2", [of.summit_density_1_m2()])
        .f64("nayak_density_1_m2", [of.roughness.moments().summit_density_1_m2()])
        .f64("rms_slope", [header.rms_slope])
        .f64("rms_curvature_1_m", [header.rms_curvature_1_m])
        .f64("nayak_parameter", [header.nayak_parameter])
        .f64("texture_aspect", [texture.map(Texture::aspect)])
        .f64("texture_slope_ratio", [texture.map(|of| of.slope_ratio)])
        .f64("texture_str", [texture.map(|of| of.aspect_ratio_str)])
        .f64("filter_overshoot", [overshoot.filter(finite)]);
    ["outlier_share", "line_jump_share", "noise_share", "curvature_ratio"]
        .into_iter()
        .fold(frame, |frame, name| frame.f64(name, [artefact(name).filter(finite)]))
        .build()
}

/// Reads the estimates of a surface.
pub(super) fn read_surface_estimates(path: &Path) -> Result<SurfaceEstimates, StageError> {
    let frame = parquet::read_table(path, &SURFACE_ESTIMATES)?;
    let number = |name: &str| frame.first_f64(name);
    Ok(SurfaceEstimates {
        length_m: number("length_m")?,
        roughness: Roughness {
            rms_height_m: number("rms_height_m")?,
            rms_slope: number("rms_slope")?,
            rms_curvature_1_m: number("rms_curvature_1_m")?,
        },
        summit_count: frame.i64("summit_count")?.first().map_or(0, |count| *count as usize),
        cut_off_m: frame.f64_or_null("cut_off_m")?.first().copied().flatten(),
        shortest_wavelength_m: number("shortest_wavelength_m")?,
        flattening: RelativeFlattening {
            wavenumber_1_m: number("flattening_wavenumber_1_m")?,
            whole_m2: number("flattening_m2")?,
            octave_m2: number("flattening_octave_m2")?,
        },
    })
}

/// Estimates of a failed cycle that depend on its surface and the material alone, by their columns in the
/// table `estimates`.
///
/// The spectrum of a generated surface that could not be made is known from the spec and the seed.
pub(super) fn of_failed(campaign: &Campaign, unit: &CycleUnit) -> Vec<(&'static str, f64)> {
    let (params, surface) = (&campaign.cases[unit.case].case.params, &campaign.surfaces[unit.surface]);
    let target = target(params);
    let known = read_surface_estimates(&campaign.estimates_path(surface)).ok().map(|of| of.flattening);
    let of_seed =
        || target.as_ref().map(|spectrum| RelativeFlattening::realised(spectrum, &seed(campaign, surface)));
    let ratios = Ratios::of(target.as_ref(), known.or_else(of_seed).as_ref(), &params.material);
    ratio_columns(&ratios)
        .into_iter()
        .filter_map(|(name, value)| Some((name, value.filter(finite)?)))
        .collect()
}

/// Columns of the ratios of energies.
pub(super) fn ratio_columns(of: &Ratios) -> [(&'static str, Option<f64>); 5] {
    [
        ("conformity", of.conformity),
        ("conformity_realised", of.conformity_realised),
        ("persson_tosatti", of.persson_tosatti),
        ("persson_tosatti_realised", of.persson_tosatti_realised),
        ("sticky_line", of.sticky_line),
    ]
}
