//! Input of the aggregation: scales, analytical estimates and columns of a cycle and its surface.

use super::StageError;
use super::cycle::lattice;
use super::extract::read_summits;
use super::surface::{scale, target};
use crate::campaign::{Campaign, CycleUnit, SurfaceUnit};
use crate::model::Material;
use crate::physics::jkr::Asperity;
use crate::physics::jkr::MIN_TABOR;
use crate::physics::surface::spectrum::Moments;
use crate::physics::surface::summits::Summit;
use crate::physics::surface::synthesis::realization_seed;
use crate::physics::surface::texture::Texture;
use crate::physics::theory::approximate_jkr::{CurvePoint, adhesive_curve, curve_loop};
use crate::physics::theory::flattening::{Flattening, flattening, measured_flattening, realised_flattening, shortest_wavelength};
use crate::physics::theory::{
    adhesionless_area, adhesionless_area_small, curvature_decay, dalvi_loss, deng_kesari_loss_as_printed, fuller_tabor, pinning_loss,
    sticky_line,
};
use crate::schema::ADHESIONLESS;
use crate::spec::CaseParams;
use crate::stats::{CycleInput, Given, Sample, Value};
use crate::store::hdf5::{SurfaceHeader, read_header, read_surface};
use crate::store::parquet;

/// Columns of a failed cycle that depend on its surface and the material alone. Those of a surface that could not be made, or of which no asperities were found,
/// are missing.
pub(super) fn of_failed(campaign: &Campaign, unit: &CycleUnit) -> Given {
    let surface = &campaign.surfaces[unit.surface];
    let header = read_header(&campaign.surface_path(surface)).ok();
    let mut columns = flattenings(campaign, unit, header.as_ref()).unwrap_or_default();
    columns.extend(header.as_ref().map(artefacts).unwrap_or_default());
    let summits = read_summits(&campaign.asperities_path(surface)).ok();
    columns.extend(named([("summit_count", summits.map(|summits| summits.len()).into())]));
    columns
}

/// `U_el/Δγ` of all roughness and of the shortest octave. For a generated surface they follow from the spec and the seed.
fn flattenings(campaign: &Campaign, unit: &CycleUnit, header: Option<&SurfaceHeader>) -> Result<Given, StageError> {
    let params = &campaign.cases[unit.case].case.params;
    let surface = &campaign.surfaces[unit.surface];
    let modulus = params.material.contact_modulus_pa;
    let measured = header.and_then(|header| header.measured.as_ref().map(|measured| (header, measured)));
    let of_modes = if let Some(asked) = target(params) {
        let seed = realization_seed(campaign.spec.seed, u64::from(surface.realization));
        Some(realised_flattening(&asked, &seed, modulus))
    } else if let Some((header, measured)) = measured {
        let (_, heights) = read_surface(&campaign.surface_path(surface))?;
        let square = header.square(heights.view());
        let shortest_m = shortest_wavelength(square, measured.shortest_wavelength_m)?;
        Some(measured_flattening(square, shortest_m, modulus)?)
    } else {
        None
    };
    let continuous = target(params).map(|asked| flattening(&asked, modulus));
    // Without adhesion the ratios are infinite, and missing in the table.
    let adhesion = params.material.work_of_adhesion_j_m2;
    let ratio = |of: Option<&Flattening>, ratio: fn(&Flattening, f64) -> f64| of.filter(|_| adhesion > 0.0).map(|of| ratio(of, adhesion));
    Ok(named([
        ("filter_overshoot", measured.map(|(header, measured)| measured.overshoot_m / header.rms_height_m).into()),
        ("conformity", ratio(continuous.as_ref(), Flattening::conformity).into()),
        ("conformity_realised", ratio(of_modes.as_ref(), Flattening::conformity).into()),
        ("persson_tosatti", ratio(continuous.as_ref(), Flattening::persson_tosatti).into()),
        ("persson_tosatti_realised", ratio(of_modes.as_ref(), Flattening::persson_tosatti).into()),
        ("sticky_line", ratio(of_modes.as_ref(), Flattening::persson_tosatti).map(sticky_line).into()),
    ]))
}

/// Input of the aggregation from a finished cycle.
pub(super) fn cycle_input(campaign: &Campaign, unit: &CycleUnit) -> Result<CycleInput, StageError> {
    let case = &campaign.cases[unit.case];
    let params = &case.case.params;
    let surface = &campaign.surfaces[unit.surface];
    let header = read_header(&campaign.surface_path(surface))?;
    let summits = read_summits(&campaign.asperities_path(surface))?;
    let nominal = header.length_m * header.length_m;
    let lattice = lattice(campaign, unit)?;
    let scale = scale(campaign, surface)?;
    let free = jkr_curve(campaign, unit)?;
    let at_max_load = |load: &f64| (*load, load_columns(&free, &header, *load, [nominal, scale.rms_height_m]));
    let mut of_surface = flattenings(campaign, unit, Some(&header))?;
    let flattened = of_surface.iter().find(|(name, _)| name == "persson_tosatti_realised").and_then(|(_, ratio)| ratio.number());
    let pinning = flattened.and_then(|ratio| pinning_loss(&params.material, ratio * params.material.work_of_adhesion_j_m2, nominal));
    of_surface.extend(asperity_columns(&summits, &params.material)?);
    of_surface.extend(surface_columns(&header, summits.len()));
    of_surface.extend(named([("nominal_area_m2", nominal.into())]));
    of_surface.extend(artefacts(&header));
    let per_wavelength = lattice.map(|lattice| per_wavelength(campaign, surface, &header, lattice.per_wavelength)).transpose()?;
    of_surface.extend(named([("elements_per_wavelength", per_wavelength.into())]));
    let continuous = target(params).map(|asked| deng_kesari(&asked.moments(), params, nominal)).transpose()?.flatten();
    Ok(CycleInput {
        case_id: case.id.clone(),
        realization: i64::from(surface.realization),
        cycle_id: unit.id.clone(),
        surface_id: surface.id.clone(),
        steps: campaign.cycle_dir(unit).join("steps.parquet"),
        events: campaign.cycle_dir(unit).join("events.parquet"),
        energy_scale_j: params.material.contact_modulus_pa * nominal * scale.rms_height_m,
        loss_dk_per_area_j: continuous,
        loss_dk_realised_per_area_j: deng_kesari(&header.moments(), params, nominal)?,
        loss_dalvi_per_area_j: dalvi_loss(&params.material, nominal),
        loss_pinning_per_area_j: pinning,
        asperity_loss_j: asperities(&summits, &params.material)?.iter().map(Asperity::loop_loss).collect(),
        at_max_load: params.cycle.max_load.iter().map(at_max_load).collect(),
        surface: of_surface,
    })
}

/// Grid points per shortest wavelength that a surface has, from those per cut-off wavelength.
fn per_wavelength(campaign: &Campaign, surface: &SurfaceUnit, header: &SurfaceHeader, per_cut_off: f64) -> Result<f64, StageError> {
    let Some(measured) = &header.measured else { return Ok(per_cut_off) };
    let (_, heights) = read_surface(&campaign.surface_path(surface))?;
    let cut_off = measured.shortest_wavelength_m;
    let shortest = shortest_wavelength(header.square(heights.view()), cut_off)?;
    Ok(if shortest > cut_off { per_cut_off * shortest / cut_off } else { per_cut_off })
}

/// Columns of analytical models at a load reversal; `free` is the adhesive curve from the adhesionless one.
fn load_columns(free: &[CurvePoint], header: &SurfaceHeader, load: f64, [nominal_m2, rms_height_m]: [f64; 2]) -> Given {
    let found = curve_loop(free, load * nominal_m2);
    named([
        ("area_jkr_curve", found.map(|found| found.area_m2 / nominal_m2).into()),
        ("pull_off_jkr_curve", found.map(|found| found.pull_off_m2 / nominal_m2).into()),
        ("loss_jkr_curve", found.map(|found| found.loss_m3 / (nominal_m2 * rms_height_m)).into()),
        ("area_adhesionless", adhesionless_area(load, header.rms_slope).into()),
        ("area_adhesionless_small", adhesionless_area_small(load, header.rms_slope).into()),
    ])
}

fn asperities(summits: &[Summit], material: &Material) -> Result<Vec<Asperity>, StageError> {
    Ok(summits.iter().map(|summit| Asperity::new(summit.radius_m(), material)).collect::<Result<_, _>>()?)
}

/// Tabor and Fuller-Tabor parameters of the asperities of a surface.
fn asperity_columns(summits: &[Summit], material: &Material) -> Result<Given, StageError> {
    let mut tabor: Vec<f64> = asperities(summits, material)?.iter().map(|asperity| asperity.tabor(material.interaction_range_m)).collect();
    tabor.sort_by(f64::total_cmp);
    let low = tabor.iter().filter(|number| **number < MIN_TABOR).count();
    let over_all = |sum: f64| (!tabor.is_empty()).then(|| sum / tabor.len() as f64);
    let heights: Vec<f64> = summits.iter().map(|s| s.height_m).collect();
    let radii: f64 = summits.iter().map(Summit::radius_m).sum();
    let spread = Sample::of(&heights).sd.map(|sd| fuller_tabor(material, sd, radii / summits.len() as f64));
    Ok(named([
        ("tabor_min", tabor.first().copied().into()),
        ("tabor_median", tabor.get(tabor.len() / 2).copied().into()),
        ("tabor_max", tabor.last().copied().into()),
        ("tabor_mean", over_all(tabor.iter().sum()).into()),
        ("low_tabor_share", over_all(low as f64).into()),
        ("fuller_tabor", spread.filter(|_| material.work_of_adhesion_j_m2 > 0.0).into()),
    ]))
}

/// Summit densities and moments of a surface.
fn surface_columns(header: &SurfaceHeader, summit_count: usize) -> Given {
    let texture = header.measured.as_ref().and_then(|of| of.texture.as_ref());
    named([
        ("summit_count", summit_count.into()),
        ("summit_density_1_m2", (summit_count as f64 / (header.length_m * header.length_m)).into()),
        ("nayak_density_1_m2", header.moments().summit_density_1_m2().into()),
        ("rms_slope", header.rms_slope.into()),
        ("rms_curvature_1_m", header.rms_curvature_1_m.into()),
        ("nayak_parameter", header.nayak_parameter.into()),
        ("texture_aspect", texture.map(Texture::aspect).into()),
        ("texture_slope_ratio", texture.map(|of| of.slope_ratio).into()),
        ("texture_str", texture.map(|of| of.aspect_ratio_str).into()),
    ])
}

/// Remaining artefacts of a measured surface.
fn artefacts(header: &SurfaceHeader) -> Given {
    header.artefact_columns().into_iter().map(|(name, value)| (name.to_owned(), value.into())).collect()
}

/// Adhesive states that follow from the adhesionless curve of a cycle; none for asperities.
fn jkr_curve(campaign: &Campaign, unit: &CycleUnit) -> Result<Vec<CurvePoint>, StageError> {
    let material = &campaign.cases[unit.case].case.params.material;
    let path = campaign.cycle_dir(unit).join("adhesionless.parquet");
    if !path.exists() {
        return Ok(Vec::new());
    }
    let frame = parquet::read_table(&path, &ADHESIONLESS)?;
    let (approaches, loads, areas) = (frame.f64("approach_m")?, frame.f64("load_n")?, frame.f64("area_m2")?);
    let point = |k: usize| CurvePoint { penetration_m: approaches[k], load_m2: loads[k] / material.contact_modulus_pa, area_m2: areas[k] };
    let curve: Vec<CurvePoint> = (0..approaches.len()).map(point).collect();
    Ok(adhesive_curve(&curve, material.adhesion_length_m()))
}

/// Deng and Kesari's loss of an area \[J\]; nothing where the printed Eq A2 defines none.
fn deng_kesari(moments: &Moments, params: &CaseParams, area_m2: f64) -> Result<Option<f64>, StageError> {
    let slips = params.model.slips();
    let defined = curvature_decay(moments.nayak_parameter(), slips).is_some();
    Ok(if defined { Some(deng_kesari_loss_as_printed(moments, &params.material, area_m2, slips)?) } else { None })
}

fn named<const N: usize>(values: [(&str, Value); N]) -> Given {
    values.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}
