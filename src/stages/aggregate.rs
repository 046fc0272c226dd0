//! Stage aggregate: from the steps, events and estimates of all cycles to the tables over realizations.

use super::cycle::lattice;
use super::cycle_input::{cycle_input, of_failed};
use super::done::{Clock, Outcome};
use super::error::incomplete;
use super::extent::{Extent, common, own_file};
use super::grids::grid_rule;
use super::measured_loop::{self, MeasuredLoop, measure_loop};
use super::runner::{Context, Single, run_single};
use super::surface::scale;
use super::{StageError, Tally, cutoff, datapackage, scan_spectra};
use crate::campaign::{Campaign, CaseUnit, CycleUnit, STATISTICS, Stage, Standing, SurfaceUnit, Unit};
use crate::model::Choice;
use crate::schema;
use crate::spec::CaseParams;
use crate::stats::{self, CaseInput, CycleInput, Given, Planned, WithGridErrors};
use crate::store::commit::Written;
use crate::store::{Check, Frame, commit, parquet};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Aggregates the finished cycles; without `--partial`, all must be finished.
pub(super) fn run(context: Context<'_>, cycles_check: Check) -> Result<Tally, StageError> {
    let (campaign, task) = (context.campaign, context.task);
    let clock = Clock::start();
    let standings = with_surfaces(campaign, campaign.cycle_standings(cycles_check), cycles_check);
    // A run of several stages aggregates what it has computed.
    let partial = task.partial || task.from != task.until;
    if let (false, Some(error)) = (partial, unfinished(campaign, &standings)) {
        return Err(error);
    }
    let key = campaign.statistics_key(&standings);
    let single = Single {
        unit: Unit { stage: Stage::Aggregate, id: STATISTICS, key: &key },
        name: "statistics",
        clock,
    };
    let compute =
        || Ok((Outcome::of(write(campaign, &standings, &key)?), campaign.statistics_preimages(&standings)));
    run_single(single, context, task.check, || None, compute)
}

/// Status of the cycles, whose row in the statistics needs the row of estimates of their surface as well.
fn with_surfaces(campaign: &Campaign, cycles: Vec<Standing>, check: Check) -> Vec<Standing> {
    let of_surface = |unit: &SurfaceUnit| campaign.standing(&unit.asperities(), check);
    let surfaces: Vec<Standing> = campaign.surfaces.par_iter().map(of_surface).collect();
    let both = |(unit, standing): (&CycleUnit, Standing)| match standing {
        Standing::Done => surfaces[unit.surface].clone(),
        other => other,
    };
    campaign.cycles.iter().zip(cycles).map(both).collect()
}

/// The error of cycles that are neither done nor failed.
fn unfinished(campaign: &Campaign, standings: &[Standing]) -> Option<StageError> {
    let state = |standing: &Standing| {
        if matches!(standing, Standing::Failed(_)) { Standing::Done } else { standing.clone() }
    };
    let inputs: Vec<(String, Standing)> = campaign
        .cycles
        .iter()
        .zip(standings)
        .map(|(unit, standing)| (unit.id.clone(), state(standing)))
        .collect();
    incomplete(campaign, Stage::Aggregate, &inputs)
}

/// Writes the tables over realizations and their description.
fn write(campaign: &Campaign, standings: &[Standing], key: &str) -> Result<Vec<Written>, StageError> {
    let (all_cases, all_cycles) = inputs(campaign, standings)?;
    let all_loops = stats::realizations(&all_cases, &all_cycles)?;
    let means = stats::cases(&all_loops, &all_cases)?;
    let WithGridErrors { realizations, cases: averaged, grids } =
        stats::with_grid_errors(&all_loops, &means, &all_cases, grid_rule)?;
    let planned = stats::planned(&all_cases, &planned_cycles(campaign, standings))?;
    let (cases, cycles) = without_coarser(all_cases, all_cycles);
    let methods = stats::methods(&cases, &side_by_side(campaign), &realizations)?;
    let curves = stats::curves(&cases, &cycles)?;
    let avalanches = stats::avalanches(&cases, &cycles)?;
    let write = |frame: &Frame| {
        Ok(parquet::write_table(
            &campaign.statistics_path(frame.table().name),
            frame,
            &[("key", key.to_owned())],
        )?)
    };
    let events = parquet::write_parts(
        &campaign.dir.join(schema::POOLED_EVENTS.file),
        &schema::POOLED_EVENTS,
        stats::pooled_events(&cases, &cycles)?,
        &[("key", key.to_owned())],
    )?;
    let over_cut_offs = cutoff::table(campaign, standings)?;
    let tables = [realizations, curves, avalanches, planned, methods, averaged, grids, over_cut_offs];
    let mut files = tables.iter().map(write).collect::<Result<Vec<_>, StageError>>()?;
    files.push(events);
    if let Some(loops) = measured_loops(campaign)? {
        files.push(write(&measured_loop::rows(&loops)?)?);
        files.push(write(&measured_loop::steps(&loops)?)?);
    }
    let samples = scan_spectra::samples(campaign)?;
    if !samples.is_empty() {
        files.push(write(&scan_spectra::scans_table(&samples)?)?);
        files.push(write(&scan_spectra::scan_spectra_table(&samples)?)?);
        files.push(write(&scan_spectra::spectrum_table(&samples)?)?);
    }
    let finished: Vec<bool> = standings.iter().map(|standing| *standing == Standing::Done).collect();
    for (place, text) in datapackage::files(campaign, &finished) {
        let path = campaign.dir.join(place);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|source| StageError::Folder { path: folder.to_owned(), source })?;
        }
        files.push(commit::commit_bytes("describe the tables in", &path, text.as_bytes())?);
    }
    Ok(files)
}

/// The inputs without cases that are only coarser grids of others.
fn without_coarser(cases: Vec<CaseInput>, cycles: Vec<CycleInput>) -> (Vec<CaseInput>, Vec<CycleInput>) {
    let (hidden, cases): (Vec<CaseInput>, Vec<CaseInput>) =
        cases.into_iter().partition(|case| case.is_coarser_grid);
    let hidden: HashSet<String> = hidden.into_iter().map(|case| case.case_id).collect();
    let cycles = cycles.into_iter().filter(|cycle| !hidden.contains(&cycle.case_id)).collect();
    (cases, cycles)
}

/// The measured loops of the spec, whose files must be as they were when the spec was read.
fn measured_loops(campaign: &Campaign) -> Result<Option<Vec<MeasuredLoop>>, StageError> {
    let spec = &campaign.spec;
    let (Some(experiment), Some(options)) = (&spec.experiment, spec.loop_options()) else { return Ok(None) };
    let one = |name: &String| {
        let found = measure_loop(Path::new(name), &campaign.file_label(name), &options)?;
        if spec.files.get(name) == Some(&found.digest) {
            return Ok(found);
        }
        let why = "the file changed after the spec was read\nhelp: run the command again".to_owned();
        Err(StageError::Loop { path: Path::new(name).to_owned(), why })
    };
    experiment.loops.iter().map(one).collect::<Result<_, _>>().map(Some)
}

/// Inputs of the aggregation: all cases, and the finished cycles.
fn inputs(
    campaign: &Campaign,
    standings: &[Standing],
) -> Result<(Vec<CaseInput>, Vec<CycleInput>), StageError> {
    let mut cases: Vec<CaseInput> = campaign
        .cases
        .iter()
        .enumerate()
        .map(|(k, unit)| case_input(campaign, k, unit, standings))
        .collect::<Result<_, _>>()?;
    let cycles: Vec<CycleInput> = campaign
        .cycles
        .par_iter()
        .zip(standings)
        .filter(|(_, standing)| **standing == Standing::Done)
        .map(|(unit, _)| cycle_input(campaign, unit))
        .collect::<Result<_, _>>()?;
    let failed: Vec<(usize, Given)> = campaign
        .cycles
        .par_iter()
        .zip(standings)
        .filter(|(_, standing)| matches!(standing, Standing::Failed(_)))
        .map(|(unit, _)| (unit.case, of_failed(campaign, unit)))
        .collect();
    for (case, of_surface) in failed {
        cases[case].surfaces.push(of_surface);
    }
    // Without failed cycles the table of realizations has all surfaces.
    let places = cases.iter().enumerate().filter(|(_, case)| case.failed_count > 0);
    let with_failed: HashMap<String, usize> =
        places.map(|(place, case)| (case.case_id.clone(), place)).collect();
    for cycle in &cycles {
        if let Some(place) = with_failed.get(&cycle.case_id) {
            cases[*place].surfaces.push(cycle.surface.clone());
        }
    }
    Ok((cases, cycles))
}

/// Ids of cases of the same surface and material by different methods, in the order of the methods.
fn side_by_side(campaign: &Campaign) -> Vec<[String; 2]> {
    let same = |a: &CaseParams, b: &CaseParams| a.surface == b.surface && a.material == b.material;
    let pairs = |one: &CaseUnit| {
        let is_later = |other: &&CaseUnit| other.case.params.method.kind() > one.case.params.method.kind();
        let others = campaign
            .shown_cases()
            .filter(is_later)
            .filter(|other| same(&one.case.params, &other.case.params));
        others.map(|other| [one.id.clone(), other.id.clone()]).collect::<Vec<_>>()
    };
    campaign.shown_cases().flat_map(pairs).collect()
}

/// Every cycle of every case with its status.
fn planned_cycles(campaign: &Campaign, standings: &[Standing]) -> Vec<Planned> {
    let row = |(unit, standing): (&CycleUnit, &Standing)| Planned {
        case_id: campaign.cases[unit.case].id.clone(),
        realization: i64::from(unit.realization),
        cycle_id: unit.id.clone(),
        surface_id: campaign.surfaces[unit.surface].id.clone(),
        status: match standing {
            Standing::Done => "done",
            Standing::Failed(_) => "failed",
            _ => "planned",
        },
        failure: match standing {
            Standing::Done => campaign.not_reached_in_tables(unit),
            _ => campaign.failure_in_tables(unit, standing),
        },
        own: own_file(campaign, unit),
    };
    campaign.cycles.iter().zip(standings).map(row).collect()
}

/// Input of the aggregation from a case, by its number.
pub(super) fn case_input(
    campaign: &Campaign,
    number: usize,
    unit: &CaseUnit,
    standings: &[Standing],
) -> Result<CaseInput, StageError> {
    let params = &unit.case.params;
    let surface = &params.surface;
    let mut of_case = campaign
        .cycles
        .iter()
        .filter(|cycle| cycle.case == number)
        .map(|cycle| &campaign.surfaces[cycle.surface]);
    let extent = if surface.measured().is_some() {
        // The import of a measured surface may have failed.
        let read = of_case.filter(|of| campaign.estimates_path(of).is_file());
        common(&read.map(|of| Extent::of_scan(campaign, of, params)).collect::<Result<Vec<_>, _>>()?)
    } else {
        let known = of_case.next().and_then(|of| Some(scale(campaign, of).ok()?.rms_height_m));
        let lattice = lattice(params, None);
        Extent {
            length_m: surface.generated().map(|of| of.length_m),
            rms_height_m: known,
            element_points: lattice.map(|lattice| lattice.points as f64),
            attraction_range_m: lattice.and_then(|lattice| lattice.range_m),
        }
    };
    let parameters = extent.parameters(params, campaign.label_of(surface), |_| true);
    let failed = |(cycle, standing): (&CycleUnit, &Standing)| {
        cycle.case == number && matches!(standing, Standing::Failed(_))
    };
    Ok(CaseInput {
        case_id: unit.id.clone(),
        sweep: unit.case.sweeps.join("+"),
        family: params.on_any_grid().map(|params| format!("{params:?}")),
        is_coarser_grid: unit.case.is_coarser_grid(),
        is_shifted_copy: unit.case.is_shifted_copy(),
        parameters,
        max_loads: params.cycle.max_load.clone(),
        load_unit: campaign.spec.load_unit(),
        precision: campaign
            .spec
            .realizations
            .until()
            .map(|until| (until.of.word().to_owned(), until.until_relative_ci)),
        grid_error_goal: campaign.spec.base.goal.error.filter(|_| params.elements().is_some()),
        planned_count: campaign.counts[number] as usize,
        failed_count: campaign.cycles.iter().zip(standings).filter(|pair| failed(*pair)).count(),
        surfaces: Vec::new(),
    })
}
