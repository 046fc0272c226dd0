//! aggregate: from the steps of all cycles to the tables over realisations.

use super::cycle::lattice;
use super::done::{Clock, Outcome};
use super::surface::{read_summits, scale, spectrum};
use super::{StageError, Tally, Watch, datapackage, incomplete};
use crate::campaign::{Campaign, CaseUnit, CycleUnit, STATISTICS, Stage, Standing, Unit};
use crate::model::Choice;
use crate::physics::approximate_jkr::{CurvePoint, adhesive_curve, curve_loop};
use crate::physics::jkr::Asperity;
use crate::physics::spectrum::{Moments, Spectrum};
use crate::physics::summits::Summit;
use crate::physics::synthesis::realization_seed;
use crate::physics::theory::{
    adhesionless_area, adhesionless_area_small, curvature_decay, dalvi_loss, deng_kesari_loss_as_printed, fuller_tabor, pinning_loss,
    sticky_line,
};
use crate::physics::validity::{Flattening, LEAST_TABOR, flattening, measured_flattening, realised_flattening};
use crate::schema::{ADHESIONLESS, CaseFacts, PARAMETERS};
use crate::spec::CaseParams;
use crate::stats::{self, CaseInput, CycleInput, Given, Planned, Sample, Value};
use crate::store::hdf5::{SurfaceHeader, read_header, read_surface};
use crate::store::{Check, Frame, commit, parquet};
use rayon::prelude::*;
use std::collections::HashMap;

/// Which cycles are done.
fn done(standings: &[Standing]) -> Vec<bool> {
    standings.iter().map(|standing| *standing == Standing::Done).collect()
}

pub(super) fn run(
    campaign: &Campaign,
    partial: bool,
    (cycles_check, check): (Check, Check),
    watch: &dyn Watch,
) -> Result<Tally, StageError> {
    let clock = Clock::start();
    let standings = campaign.cycle_standings(cycles_check);
    // A failed cycle is finished.
    let state = |standing: &Standing| if matches!(standing, Standing::Failed(_)) { Standing::Done } else { standing.clone() };
    let inputs: Vec<(String, Standing)> =
        campaign.cycles.iter().zip(&standings).map(|(unit, standing)| (unit.id.clone(), state(standing))).collect();
    if let (false, Some(error)) = (partial, incomplete(campaign, Stage::Aggregate, &inputs)) {
        return Err(error);
    }
    let finished = done(&standings);
    let key = campaign.statistics_key(&standings);
    let unit = Unit { stage: Stage::Aggregate, id: STATISTICS, key: &key };
    let mut tally = Tally { planned: 1, ..Tally::default() };
    if campaign.standing(&unit, check) == Standing::Done {
        tally.before = 1;
        watch.begin(Stage::Aggregate, 1, 1);
        watch.end(Stage::Aggregate);
        return Ok(tally);
    }
    watch.begin(Stage::Aggregate, 0, 1);
    let mut cases: Vec<CaseInput> =
        campaign.cases.iter().enumerate().map(|(k, unit)| case_input(campaign, k, unit, &standings)).collect::<Result<_, _>>()?;
    let cycles: Vec<CycleInput> = campaign
        .cycles
        .par_iter()
        .zip(&standings)
        .filter(|(_, standing)| **standing == Standing::Done)
        .map(|(unit, _)| cycle_input(campaign, unit))
        .collect::<Result<_, _>>()?;
    let failed: Vec<(usize, Given)> = campaign
        .cycles
        .par_iter()
        .zip(&standings)
        .filter(|(_, standing)| matches!(standing, Standing::Failed(_)))
        .map(|(unit, _)| (unit.case, of_failed(campaign, unit)))
        .collect();
    for (case, of_surface) in failed {
        cases[case].surfaces.push(of_surface);
    }
    // Without failed cycles the table of realizations has all surfaces.
    let places = cases.iter().enumerate().filter(|(_, case)| case.failed_count > 0);
    let with_failed: HashMap<String, usize> = places.map(|(place, case)| (case.case_id.clone(), place)).collect();
    for cycle in &cycles {
        if let Some(place) = with_failed.get(&cycle.case_id) {
            cases[*place].surfaces.push(cycle.surface.clone());
        }
    }
    let realizations = stats::realizations(&cases, &cycles)?;
    let averaged = stats::cases(&realizations, &cases)?;
    let methods = stats::methods(&cases, &side_by_side(campaign), &realizations)?;
    let curves = stats::curves(&cases, &cycles)?;
    let avalanches = stats::avalanches(&cases, &cycles)?;
    let planned = stats::planned(&cases, &planned_cycles(campaign, &standings))?;
    let write = |frame: &Frame| Ok(parquet::write_table(&campaign.statistics_path(frame.table().name), frame, &[("key", key.clone())])?);
    let tables = [realizations, curves, avalanches, planned, methods, averaged];
    let mut files = tables.iter().map(write).collect::<Result<Vec<_>, StageError>>()?;
    let described = datapackage::text(campaign, &finished);
    files.push(commit::commit_bytes("describe the tables in", &campaign.dir.join("datapackage.json"), described.as_bytes())?);
    clock.receipt(campaign, &unit, campaign.statistics_preimages(&standings), &Outcome::of(files))?;
    watch.progress(Stage::Aggregate, 1.0);
    watch.finished(Stage::Aggregate, "statistics");
    watch.end(Stage::Aggregate);
    tally.computed = 1;
    Ok(tally)
}

/// Ids of cases of the same surface and material, one by asperities and one by boundary elements.
fn side_by_side(campaign: &Campaign) -> Vec<[String; 2]> {
    let same = |a: &CaseParams, b: &CaseParams| a.surface == b.surface && a.material == b.material;
    let (elements, asperities): (Vec<&CaseUnit>, Vec<&CaseUnit>) = campaign.cases.iter().partition(|unit| unit.case.params.by_elements());
    let pairs = |one: &CaseUnit| {
        let others = elements.iter().filter(|other| same(&one.case.params, &other.case.params));
        others.map(|other| [one.id.clone(), other.id.clone()]).collect::<Vec<_>>()
    };
    asperities.into_iter().flat_map(pairs).collect()
}

/// Every cycle of every case with its status.
fn planned_cycles(campaign: &Campaign, standings: &[Standing]) -> Vec<Planned> {
    let row = |(unit, standing): (&CycleUnit, &Standing)| Planned {
        case_id: campaign.cases[unit.case].id.clone(),
        realization: i64::from(campaign.surfaces[unit.surface].realization),
        cycle_id: unit.id.clone(),
        surface_id: campaign.surfaces[unit.surface].id.clone(),
        status: match standing {
            Standing::Done => "done",
            Standing::Failed(_) => "failed",
            _ => "planned",
        },
        failure: campaign.failure_in_tables(standing),
    };
    campaign.cycles.iter().zip(standings).map(row).collect()
}

fn case_input(campaign: &Campaign, number: usize, unit: &CaseUnit, standings: &[Standing]) -> Result<CaseInput, StageError> {
    let params = &unit.case.params;
    let surface = &params.surface;
    // The import of a measured surface may have failed.
    let is_there = |cycle: &&CycleUnit| !surface.is_measured() || campaign.surface_path(&campaign.surfaces[cycle.surface]).is_file();
    let of_case = campaign.cycles.iter().find(|cycle| cycle.case == number).filter(is_there);
    let scale = of_case.map(|cycle| scale(campaign, &campaign.surfaces[cycle.surface])).transpose()?;
    let lattice = of_case.map(|cycle| lattice(campaign, cycle)).transpose()?.flatten();
    let facts = CaseFacts {
        params,
        surface_file: surface.is_measured().then(|| campaign.file_label(&surface.file)),
        length_m: scale.map(|scale| scale.length_m),
        rms_height_m: scale.map(|scale| scale.rms_height_m),
        element_points: lattice.map(|lattice| lattice.points as f64),
        attraction_range_m: lattice.and_then(|lattice| lattice.range_m),
    };
    let parameters = PARAMETERS.iter().map(|parameter| (parameter.column.name.to_owned(), (parameter.get)(&facts).into())).collect();
    let failed = |(cycle, standing): (&CycleUnit, &Standing)| cycle.case == number && matches!(standing, Standing::Failed(_));
    Ok(CaseInput {
        case_id: unit.id.clone(),
        sweep: unit.case.sweeps.join("+"),
        parameters,
        max_loads: params.cycle.max_load.clone(),
        precision: campaign.spec.realizations.until().map(|until| (until.of.word().to_owned(), until.until_relative_ci)),
        planned_count: campaign.counts[number] as usize,
        failed_count: campaign.cycles.iter().zip(standings).filter(|pair| failed(*pair)).count(),
        surfaces: Vec::new(),
    })
}

/// Columns of a failed cycle that depend on its surface and the material alone. Those of a surface that could not be made, or of which no asperities were found,
/// are missing.
fn of_failed(campaign: &Campaign, unit: &CycleUnit) -> Given {
    let surface = &campaign.surfaces[unit.surface];
    let mut columns = flattenings(campaign, unit, read_header(&campaign.surface_path(surface)).ok().as_ref()).unwrap_or_default();
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
        Some(measured_flattening(heights.view(), (header.length_m, header.periodic), measured.shortest_wavelength_m, modulus)?)
    } else {
        None
    };
    let continuous = target(params).map(|asked| flattening(&asked, modulus));
    // Without adhesion the ratios are infinite, and missing in the table.
    let adhesion = params.material.work_of_adhesion_j_m2;
    let ratio = |of: Option<&Flattening>, ratio: fn(&Flattening, f64) -> f64| of.filter(|_| adhesion > 0.0).map(|of| ratio(of, adhesion));
    Ok(named([
        ("conformity", ratio(continuous.as_ref(), Flattening::conformity).into()),
        ("conformity_realised", ratio(of_modes.as_ref(), Flattening::conformity).into()),
        ("persson_tosatti", ratio(continuous.as_ref(), Flattening::persson_tosatti).into()),
        ("persson_tosatti_realised", ratio(of_modes.as_ref(), Flattening::persson_tosatti).into()),
        ("sticky_line", ratio(of_modes.as_ref(), Flattening::persson_tosatti).map(sticky_line).into()),
    ]))
}

/// Target spectrum of a case; a measured surface has none.
pub(super) fn target(params: &CaseParams) -> Option<Spectrum> {
    (!params.surface.is_measured()).then(|| spectrum(&params.surface))
}

pub(super) fn cycle_input(campaign: &Campaign, unit: &CycleUnit) -> Result<CycleInput, StageError> {
    let case = &campaign.cases[unit.case];
    let params = &case.case.params;
    let surface = &campaign.surfaces[unit.surface];
    let header = read_header(&campaign.surface_path(surface))?;
    let summits = read_summits(&campaign.asperities_path(surface))?;
    let realised = header.moments();
    let area = header.length_m * header.length_m;
    let lattice = lattice(campaign, unit)?;
    // A square that is continued by mirror images is four times as large.
    let nominal = lattice.map_or(area, |lattice| lattice.length_m * lattice.length_m);
    let mut tabor = summits
        .iter()
        .map(|s| Ok(Asperity::new(s.radius_m(), &params.material)?.tabor(params.material.interaction_range_m)))
        .collect::<Result<Vec<f64>, StageError>>()?;
    tabor.sort_by(f64::total_cmp);
    let low = tabor.iter().filter(|number| **number < LEAST_TABOR).count();
    let over_all = |sum: f64| (!tabor.is_empty()).then(|| sum / tabor.len() as f64);
    let scale = scale(campaign, surface)?;
    let asked = target(params);
    let adhesion = params.material.work_of_adhesion_j_m2;
    let losses =
        summits.iter().map(|s| Ok(Asperity::new(s.radius_m(), &params.material)?.loop_loss())).collect::<Result<Vec<f64>, StageError>>()?;
    let heights: Vec<f64> = summits.iter().map(|s| s.height_m).collect();
    let radii: f64 = summits.iter().map(Summit::radius_m).sum();
    let spread = Sample::of(&heights).sd.map(|sd| fuller_tabor(&params.material, sd, radii / summits.len() as f64));
    let free = jkr_curve(campaign, unit)?;
    let at_max_load = |load: &f64| {
        let found = curve_loop(&free, load * nominal);
        let columns: [(&str, Value); 5] = [
            ("area_jkr_curve", found.map(|found| found.area_m2 / nominal).into()),
            ("pull_off_jkr_curve", found.map(|found| found.pull_off_m2 / nominal).into()),
            ("loss_jkr_curve", found.map(|found| found.loss_m3 / (nominal * scale.rms_height_m)).into()),
            ("area_adhesionless", adhesionless_area(*load, header.rms_slope).into()),
            ("area_adhesionless_small", adhesionless_area_small(*load, header.rms_slope).into()),
        ];
        (*load, named(columns))
    };
    let numbers: [(&str, Value); 13] = [
        ("summit_count", summits.len().into()),
        ("summit_density_1_m2", (summits.len() as f64 / area).into()),
        ("nayak_density_1_m2", realised.summit_density_1_m2().into()),
        ("tabor_min", tabor.first().copied().into()),
        ("tabor_median", tabor.get(tabor.len() / 2).copied().into()),
        ("tabor_max", tabor.last().copied().into()),
        ("tabor_mean", over_all(tabor.iter().sum()).into()),
        ("low_tabor_share", over_all(low as f64).into()),
        ("fuller_tabor", spread.filter(|_| adhesion > 0.0).into()),
        ("rms_slope", header.rms_slope.into()),
        ("rms_curvature_1_m", header.rms_curvature_1_m.into()),
        ("nayak_parameter", header.nayak_parameter.into()),
        ("elements_per_wavelength", lattice.map(|lattice| lattice.per_wavelength).into()),
    ];
    let mut of_surface = flattenings(campaign, unit, Some(&header))?;
    let flattened = of_surface.iter().find(|(name, _)| name == "persson_tosatti_realised").and_then(|(_, ratio)| ratio.number());
    let pinning = flattened.and_then(|ratio| pinning_loss(&params.material, ratio * adhesion, nominal));
    of_surface.extend(named(numbers));
    Ok(CycleInput {
        case_id: case.id.clone(),
        realization: i64::from(surface.realization),
        cycle_id: unit.id.clone(),
        surface_id: surface.id.clone(),
        steps: campaign.cycle_dir(unit).join("steps.parquet"),
        events: campaign.cycle_dir(unit).join("events.parquet"),
        energy_scale_j: params.material.contact_modulus_pa * nominal * scale.rms_height_m,
        loss_dk_per_area_j: match &asked {
            Some(asked) => deng_kesari(&asked.moments(), params, nominal)?,
            None => None,
        },
        loss_dk_realised_per_area_j: deng_kesari(&realised, params, nominal)?,
        loss_dalvi_per_area_j: dalvi_loss(&params.material, nominal),
        loss_pinning_per_area_j: pinning,
        asperity_loss_j: losses,
        at_max_load: params.cycle.max_load.iter().map(at_max_load).collect(),
        surface: of_surface,
    })
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
