//! All analytical estimates of a surface, and of a cycle on it: one call for each.
//!
//! # Of a surface
//! [`SurfaceEstimates`] does not depend on the material.
//!
//! | estimate | formula | source |
//! |---|---|---|
//! | density of asperities \[1/m²\] | `N/L²` | – |
//! | Nayak's density of summits \[1/m²\] | [`Moments::summit_density_1_m2`] | Nayak 1971 |
//! | flattening, `U_el/E*` \[m\] | [`RelativeFlattening`] | Persson and Tosatti 2001 |
//! | shortest wavelength \[m\] | [`shortest_wavelength`], or `L/ζ` | – |
//!
//! # Of a cycle
//! [`CycleEstimates`] adds the material, [`CycleEstimates::at_load`] the load. `A0 = L²` is the nominal area
//! \[m²\], Δγ the work of adhesion \[J/m²\], E* the reduced modulus \[Pa\].
//!
//! | estimate | formula | source |
//! |---|---|---|
//! | `U_el/Δγ` of all roughness and of the shortest octave | [`Ratios`] | Persson and Tosatti 2001 |
//! | sticky line | `U_el/(2Δγ)` | Wang and Müser 2022 |
//! | Tabor parameter of the asperities | [`Asperity::tabor`] | Eq 3 |
//! | Fuller–Tabor parameter | [`fuller_tabor`] | Fuller and Tabor 1975 |
//! | dissipated energy at `A = A0`, target and realised \[J\] | [`deng_kesari_loss_as_printed`] | Eqs A1–A4 |
//! | the same with the radius of a probe \[J\] | [`DengKesari::of_probe`] | Deng and Kesari 2019 |
//! | dissipated energy at `A = A0` of separation \[J\] | [`dalvi_loss`] | Dalvi et al. 2019 |
//! | dissipated energy at `A = A0` of pinning \[J\] | [`pinning_loss`] | Sanner et al. 2024 |
//! | dissipated energy of isolated asperities \[J\] | [`Asperity::loop_loss`] | Eq A1 |
//! | loop of the JKR curve from the adhesionless one | [`adhesive_curve`], [`curve_loop`] | Ciavarella 2018 |
//! | adhesionless area | [`adhesionless_area`] | Persson 2001 |
//! | adhesionless area at small loads | [`adhesionless_area_small`] | Hyun et al. 2004 |

use super::approximate_jkr::{CurveLoop, CurvePoint, adhesive_curve, curve_loop};
use super::flattening::{Flattening, RelativeFlattening, flattening, shortest_wavelength};
use super::probe_loss::deng_kesari_probe_loss;
use super::{
    adhesionless_area, adhesionless_area_small, curvature_decay, dalvi_loss, deng_kesari_loss_as_printed,
    fuller_tabor, pinning_loss, sticky_line,
};
use crate::PhysicsError;
use crate::jkr::{Asperity, MIN_TABOR};
use crate::model::{Material, Slips};
use crate::surface::SquareMap;
use crate::surface::spectrum::{Moments, Spectrum};
use crate::surface::summits::Summit;

/// Roughness of a realised surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roughness {
    /// Rms height \[m\].
    pub rms_height_m: f64,
    /// Rms gradient.
    pub rms_slope: f64,
    /// Rms Laplacian \[1/m\].
    pub rms_curvature_1_m: f64,
}

impl Roughness {
    /// Spectral moments.
    #[must_use]
    pub fn moments(&self) -> Moments {
        Moments::of_rms(self.rms_height_m, self.rms_slope, self.rms_curvature_1_m)
    }
}

/// Estimates of a surface that do not depend on the material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceEstimates {
    /// Side L of the square \[m\].
    pub length_m: f64,
    /// Roughness of the realised spectrum.
    pub roughness: Roughness,
    /// Number of asperities.
    pub summit_count: usize,
    /// Cut-off wavelength of the low-pass filter \[m\]; nothing for a generated surface.
    pub cut_off_m: Option<f64>,
    /// Shortest wavelength \[m\]: `L/ζ` of a generated surface.
    pub shortest_wavelength_m: f64,
    /// Flattening of the realised spectrum.
    pub flattening: RelativeFlattening,
}

impl SurfaceEstimates {
    /// Estimates of a generated surface from its spectrum and seed.
    #[must_use]
    pub fn of_generated(
        spectrum: &Spectrum,
        seed: &[u8; 32],
        roughness: Roughness,
        summit_count: usize,
    ) -> Self {
        Self {
            length_m: spectrum.length_m,
            roughness,
            summit_count,
            cut_off_m: None,
            shortest_wavelength_m: spectrum.length_m / f64::from(spectrum.magnification),
            flattening: RelativeFlattening::realised(spectrum, seed),
        }
    }

    /// Estimates of heights on a square after a filter with a cut-off \[m\].
    ///
    /// # Errors
    /// Too little memory.
    pub fn of_measured(
        map: SquareMap<'_>,
        cut_off_m: f64,
        roughness: Roughness,
        summit_count: usize,
    ) -> Result<Self, PhysicsError> {
        let shortest_wavelength_m = shortest_wavelength(map, cut_off_m)?;
        let flattening = RelativeFlattening::measured(map, shortest_wavelength_m)?;
        let (length_m, cut_off_m) = (map.length_m, Some(cut_off_m));
        Ok(Self { length_m, roughness, summit_count, cut_off_m, shortest_wavelength_m, flattening })
    }

    /// Nominal area L² \[m²\].
    #[must_use]
    pub fn nominal_area_m2(&self) -> f64 {
        self.length_m * self.length_m
    }

    /// Grid points per shortest wavelength, from those per cut-off wavelength.
    #[must_use]
    pub fn per_shortest_wavelength(&self, per_cut_off: f64) -> f64 {
        let longer = self.cut_off_m.filter(|cut_off| self.shortest_wavelength_m > *cut_off);
        longer.map_or(per_cut_off, |cut_off| per_cut_off * self.shortest_wavelength_m / cut_off)
    }

    /// Number of asperities per nominal area \[1/m²\].
    #[must_use]
    pub fn summit_density_1_m2(&self) -> f64 {
        self.summit_count as f64 / self.nominal_area_m2()
    }
}

/// Ratios of flattening energies and work of adhesion; all missing without adhesion, where they are infinite.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Ratios {
    /// `U_el/Δγ` of the shortest octave of the continuous spectrum.
    pub conformity: Option<f64>,
    /// `U_el/Δγ` of the shortest octave of the realised spectrum.
    pub conformity_realised: Option<f64>,
    /// `U_el/Δγ` of the continuous spectrum.
    pub persson_tosatti: Option<f64>,
    /// `U_el/Δγ` of the realised spectrum.
    pub persson_tosatti_realised: Option<f64>,
    /// `U_el/(2Δγ)` of the realised spectrum.
    pub sticky_line: Option<f64>,
}

impl Ratios {
    /// Ratios of a material: with the target spectrum of a generated surface, and with the flattening of the
    /// realised one.
    #[must_use]
    pub fn of(target: Option<&Spectrum>, realised: Option<&RelativeFlattening>, material: &Material) -> Self {
        let adhesion = material.work_of_adhesion_j_m2;
        if adhesion <= 0.0 {
            return Self::default();
        }
        let continuous = target.map(|spectrum| flattening(spectrum, material.contact_modulus_pa));
        let realised = realised.map(|relative| relative.energies(material.contact_modulus_pa));
        let octave = |of: Option<Flattening>| of.map(|of| of.conformity(adhesion));
        let whole = |of: Option<Flattening>| of.map(|of| of.persson_tosatti(adhesion));
        Self {
            conformity: octave(continuous),
            conformity_realised: octave(realised),
            persson_tosatti: whole(continuous),
            persson_tosatti_realised: whole(realised),
            sticky_line: whole(realised).map(sticky_line),
        }
    }
}

/// Tabor parameters of the asperities of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tabor {
    /// Smallest one.
    pub min: f64,
    /// Median; the upper one of an even number.
    pub median: f64,
    /// Largest one.
    pub max: f64,
    /// Mean.
    pub mean: f64,
    /// Fraction of the asperities below [`MIN_TABOR`].
    pub low_share: f64,
}

impl Tabor {
    /// Of asperities with a range of attraction \[m\]; nothing without asperities.
    fn of(asperities: &[Asperity], range_m: f64) -> Option<Self> {
        let mut tabor: Vec<f64> = asperities.iter().map(|asperity| asperity.tabor(range_m)).collect();
        tabor.sort_by(f64::total_cmp);
        let low = tabor.iter().filter(|number| **number < MIN_TABOR).count();
        let count = tabor.len() as f64;
        Some(Self {
            min: *tabor.first()?,
            median: *tabor.get(tabor.len() / 2)?,
            max: *tabor.last()?,
            mean: tabor.iter().sum::<f64>() / count,
            low_share: low as f64 / count,
        })
    }
}

/// Deng and Kesari's dissipated energy at `A = A0` \[J\], by the uncorrected equations in use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DengKesari {
    /// Corrected, Eq A2 as printed, Eq A3 as printed, both as printed. Missing where the printed Eq A2 has no
    /// integral.
    pub nominal_j: [Option<f64>; 4],
}

impl DengKesari {
    /// Equations of the four values.
    pub const ERRATA: [Slips; 4] = [
        Slips::NONE,
        Slips { a2: true, ..Slips::NONE },
        Slips { a3: true, ..Slips::NONE },
        Slips { a2: true, a3: true, ..Slips::NONE },
    ];

    fn of(moments: &Moments, material: &Material, area_m2: f64) -> Result<Self, PhysicsError> {
        Self::each(moments, |slips| deng_kesari_loss_as_printed(moments, material, area_m2, slips))
    }

    /// With the radius of a probe \[m\] as that of the tip, at `A = area_m2` \[m²\].
    ///
    /// # Errors
    /// As [`deng_kesari_probe_loss`].
    pub fn of_probe(
        moments: &Moments,
        material: &Material,
        area_m2: f64,
        radius_m: f64,
    ) -> Result<Self, PhysicsError> {
        let per_area = |slips| deng_kesari_probe_loss(moments, material, radius_m, slips);
        Self::each(moments, |slips| Ok(area_m2 * per_area(slips)?))
    }

    fn each(
        moments: &Moments,
        loss_j: impl Fn(Slips) -> Result<f64, PhysicsError>,
    ) -> Result<Self, PhysicsError> {
        let mut nominal_j = [None; 4];
        for (value, slips) in nominal_j.iter_mut().zip(Self::ERRATA) {
            if curvature_decay(moments.nayak_parameter(), slips).is_some() {
                *value = Some(loss_j(slips)?);
            }
        }
        Ok(Self { nominal_j })
    }
}

/// Estimates of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleEstimates {
    /// Ratios of flattening energies and work of adhesion.
    pub ratios: Ratios,
    /// Tabor parameters; nothing without asperities.
    pub tabor: Option<Tabor>,
    /// Fuller–Tabor parameter; nothing for fewer than two asperities and without adhesion.
    pub fuller_tabor: Option<f64>,
    /// Deng and Kesari's estimate with the moments of the continuous spectrum; nothing for a measured
    /// surface.
    pub deng_kesari: Option<DengKesari>,
    /// Deng and Kesari's estimate with the moments of the realised spectrum.
    pub deng_kesari_realised: DengKesari,
    /// Dissipated energy `Δγ A0` \[J\].
    pub dalvi_nominal_j: f64,
    /// Dissipated energy of crack-front pinning at `A = A0` \[J\]; nothing where it is undefined.
    pub pinning_nominal_j: Option<f64>,
    /// Dissipated energy of each asperity in isolation \[J\].
    asperity_loss_j: Vec<f64>,
    /// Adhesive states from the adhesionless curve, by ascending area.
    curve: Vec<CurvePoint>,
    surface: SurfaceEstimates,
}

impl CycleEstimates {
    /// Estimates of a cycle with a material on a surface with these asperities.
    ///
    /// `target` is the spectrum of a generated surface. `adhesionless` is the curve of the same surface
    /// without adhesion; empty if it is unknown.
    ///
    /// # Errors
    /// A material or radius that an asperity refuses; moments that Deng and Kesari's estimate refuses.
    pub fn of(
        surface: &SurfaceEstimates,
        target: Option<&Spectrum>,
        summits: &[Summit],
        material: &Material,
        adhesionless: &[CurvePoint],
    ) -> Result<Self, PhysicsError> {
        let new = |summit: &Summit| Asperity::new(summit.radius_m(), material);
        let asperities: Vec<Asperity> = summits.iter().map(new).collect::<Result<_, _>>()?;
        let nominal = surface.nominal_area_m2();
        let ratios = Ratios::of(target, Some(&surface.flattening), material);
        let energy_j_m2 = ratios.persson_tosatti_realised.map(|ratio| ratio * material.work_of_adhesion_j_m2);
        let deng_kesari = |moments: &Moments| DengKesari::of(moments, material, nominal);
        Ok(Self {
            ratios,
            tabor: Tabor::of(&asperities, material.interaction_range_m),
            fuller_tabor: fuller_tabor_of(summits, material),
            deng_kesari: target.map(|spectrum| deng_kesari(&spectrum.moments())).transpose()?,
            deng_kesari_realised: deng_kesari(&surface.roughness.moments())?,
            dalvi_nominal_j: dalvi_loss(material, nominal),
            pinning_nominal_j: energy_j_m2.and_then(|energy| pinning_loss(material, energy, nominal)),
            asperity_loss_j: asperities.iter().map(Asperity::loop_loss).collect(),
            curve: adhesive_curve(adhesionless, material.adhesion_length_m()),
            surface: *surface,
        })
    }

    /// Energy that asperities, by their numbers, dissipate in isolation \[J\]. Other numbers, as of merged
    /// contacts, do not count.
    #[must_use]
    pub fn isolated_loss_j(&self, numbers: &[usize]) -> f64 {
        numbers.iter().filter_map(|number| self.asperity_loss_j.get(*number)).sum()
    }

    /// Estimates at a load `F/(E* A0)`.
    #[must_use]
    pub fn at_load(&self, load: f64) -> LoadEstimates {
        let slope = self.surface.roughness.rms_slope;
        LoadEstimates {
            jkr_curve: curve_loop(&self.curve, load * self.surface.nominal_area_m2()),
            area_adhesionless: adhesionless_area(load, slope),
            area_adhesionless_small: adhesionless_area_small(load, slope),
        }
    }
}

/// Estimates of a cycle at a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadEstimates {
    /// Loop along the JKR curve from the adhesionless one, where that is valid.
    pub jkr_curve: Option<CurveLoop>,
    /// Area over A0 without adhesion.
    pub area_adhesionless: f64,
    /// Area over A0 without adhesion at small loads.
    pub area_adhesionless_small: f64,
}

/// Fuller–Tabor parameter of asperities, with the standard deviation (n − 1) of their heights.
fn fuller_tabor_of(summits: &[Summit], material: &Material) -> Option<f64> {
    if summits.len() < 2 || material.work_of_adhesion_j_m2 <= 0.0 {
        return None;
    }
    let count = summits.len() as f64;
    let mean = summits.iter().map(|summit| summit.height_m).sum::<f64>() / count;
    let squares: f64 = summits.iter().map(|summit| (summit.height_m - mean).powi(2)).sum();
    let radius = summits.iter().map(Summit::radius_m).sum::<f64>() / count;
    Some(fuller_tabor(material, (squares / (count - 1.0)).sqrt(), radius))
}
