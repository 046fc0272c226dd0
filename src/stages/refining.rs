//! Grids of boundary elements for a required grid error of the dissipated energy, from the finished cycles.
//!
//! Nothing is stored. The grids of a case follow from the results on the coarser ones, as the number of
//! realizations follows from the first ones.

use super::StageError;
use super::aggregate::case_input;
use super::cycle::lattice;
use super::cycle_input::cycle_input;
use super::grids::grid_rule;
use super::standings::{by_sizes_first, standings_by};
use super::surface_row::SurfaceRow;
use crate::campaign::{Campaign, CaseUnit, CycleUnit, Standing};
use crate::spec::{CaseParams, MOST_PER_WAVELENGTH};
use crate::stats::{self, CaseInput, CycleInput};
use crate::store::Check;
use rayon::prelude::*;
use std::collections::HashSet;

/// A case whose grid error is above the required one, and whose grid is not refined further.
#[derive(Debug, Clone, PartialEq)]
pub struct AboveError {
    /// Its id.
    pub case_id: String,
    /// Its grid as text.
    pub grid: String,
    /// Estimated grid error of the mean dissipated energy, the largest over the loads; nothing where it is
    /// unknown.
    pub error: Option<f64>,
}

/// The campaign with the grids that its required grid error needs, as far as known: up to the first
/// unfinished cycles of each case.
pub(super) fn refined(campaign: Campaign, check: Check) -> Result<Campaign, StageError> {
    let Some(wanted) = campaign.spec.base.goal.error else { return Ok(campaign) };
    let mut campaign = campaign;
    loop {
        let mut places = Vec::new();
        for (place, error) in known_errors(&campaign, check)? {
            if error.is_some_and(|error| error > wanted) && has_finer_grid(&campaign, place)? {
                places.push(place);
            }
        }
        if places.is_empty() {
            return Ok(campaign);
        }
        let spec = campaign.spec.refined(&places);
        let shown = campaign.shown_cases().count();
        let count = |(place, case): (usize, &crate::spec::Case)| {
            let least = || case.params.surface.scan_count().unwrap_or(spec.realizations.least());
            campaign.counts.get(place).filter(|_| place < shown).copied().unwrap_or_else(least)
        };
        let counts = spec.cases.iter().enumerate().map(count).collect();
        campaign = Campaign::with_counts(spec, campaign.dir, counts);
    }
}

/// Cases whose grids are complete and whose grid error is above the required one, or unknown.
///
/// # Errors
/// If the tables of a finished cycle cannot be read.
pub fn above_error(campaign: &Campaign) -> Result<Vec<AboveError>, StageError> {
    let Some(wanted) = campaign.spec.base.goal.error else { return Ok(Vec::new()) };
    let of = |(place, error): (usize, Option<f64>)| {
        let unit = &campaign.cases[place];
        let grid = unit.case.params.elements()?.grid_in_words();
        let above = AboveError { case_id: unit.id.clone(), grid, error };
        Some(above).filter(|_| error.is_none_or(|error| error > wanted))
    };
    let known = by_sizes_first(|check| known_errors(campaign, check))?;
    Ok(known.into_iter().filter_map(of).collect())
}

/// Cases by boundary elements whose cycles are finished on all grids, by their places, with the largest
/// estimated grid error of their mean dissipated energies at the loads that are reached; nothing where it is
/// unknown.
fn known_errors(campaign: &Campaign, check: Check) -> Result<Vec<(usize, Option<f64>)>, StageError> {
    let standings = standings_by(campaign, check);
    let is_open = |(_, standing): &(&CycleUnit, &Standing)| !standing.is_settled();
    let open: HashSet<usize> =
        campaign.cycles.iter().zip(&standings).filter(is_open).map(|(unit, _)| unit.case).collect();
    let families: Vec<Option<CaseParams>> =
        campaign.cases.iter().map(|unit| unit.case.params.on_any_grid()).collect();
    let shown = campaign.cases.iter().enumerate().filter(|(_, unit)| !unit.case.is_coarser_grid());
    let mut complete = Vec::new();
    let mut members = HashSet::new();
    for (place, _) in shown.filter(|(place, _)| families[*place].is_some()) {
        let family: Vec<usize> =
            (0..families.len()).filter(|other| families[*other] == families[place]).collect();
        if family.iter().all(|other| !open.contains(other)) {
            complete.push(place);
            members.extend(family);
        }
    }
    let (cases, cycles) = inputs(campaign, &standings, &members)?;
    let loops = stats::realizations(&cases, &cycles)?;
    let means = stats::cases(&loops, &cases)?;
    let means = stats::with_grid_errors(&loops, &means, &cases, grid_rule)?.cases;
    let (ids, errors) = (means.text("case_id")?, means.f64_or_null("loss_grid_error")?);
    let done = means.i64("done_count")?;
    let error = |place: usize| {
        // A load that no cycle has reached has no loss, and no error.
        let rows = (0..ids.len()).filter(|row| ids[*row] == campaign.cases[place].id && done[*row] > 0);
        let of_loads: Option<Vec<f64>> = rows.map(|row| errors[row]).collect();
        of_loads.and_then(|errors| errors.into_iter().reduce(f64::max))
    };
    Ok(complete.into_iter().map(|place| (place, error(place))).collect())
}

/// Inputs of the aggregation of some cases with their finished cycles.
fn inputs(
    campaign: &Campaign,
    standings: &[Standing],
    members: &HashSet<usize>,
) -> Result<(Vec<CaseInput>, Vec<CycleInput>), StageError> {
    let is_member = |(place, _): &(usize, &CaseUnit)| members.contains(place);
    let cases = campaign.cases.iter().enumerate().filter(is_member);
    let cases = cases.map(|(place, unit)| case_input(campaign, place, unit, standings));
    let done = campaign
        .cycles
        .par_iter()
        .zip(standings)
        .filter(|(unit, standing)| **standing == Standing::Done && members.contains(&unit.case));
    let cycles = done.map(|(unit, _)| cycle_input(campaign, unit));
    Ok((cases.collect::<Result<_, _>>()?, cycles.collect::<Result<_, _>>()?))
}

/// True if the grid of a case with twice the points is within the limits of the spec.
fn has_finer_grid(campaign: &Campaign, place: usize) -> Result<bool, StageError> {
    let finer = campaign.cases[place].case.params.on_finer_grid();
    let most = campaign.spec.base.goal.max_points;
    let Some(options) = finer.elements() else { return Ok(false) };
    if let Some(points) = options.points {
        return Ok(points <= most);
    }
    // Each scan has its own grid.
    let mut is_within = options.per_wavelength.is_none_or(|number| number <= MOST_PER_WAVELENGTH);
    for cycle in campaign.cycles.iter().filter(|cycle| cycle.case == place) {
        let surface = &campaign.surfaces[cycle.surface];
        if campaign.estimates_path(surface).is_file() {
            let square = SurfaceRow::read(campaign, surface)?.square(&finer)?;
            is_within &=
                lattice(&finer, Some(square)).is_some_and(|grid| grid.points as u64 <= u64::from(most));
        }
    }
    Ok(is_within)
}
