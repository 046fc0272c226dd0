//! Number of realizations for a target precision of a mean, from the finished cycles.
//!
//! Nothing is stored. The number of realizations of a case follows from the results of the first ones, step
//! by step. The same results give the same number: in a run that was killed, in a run with more threads, and
//! in `status`.

use super::StageError;
use super::grids::cycle_results;
use super::refining::refined;
use super::standings::{by_sizes_first, standings_by};
use crate::campaign::{Campaign, CycleUnit, Standing};
use crate::model::Choice;
use crate::spec::Until;
use crate::stats::{Sample, Value};
use crate::store::Check;
use rayon::prelude::*;

/// Results of one realization of a case at each load reversal; nothing if it failed.
type Outcome = Option<Vec<f64>>;

/// Number of realizations of a case, of which `outcomes` are known: those, if its means are precise enough,
/// or the maximum is reached.
///
/// Half the 95 % interval falls as `1/√n`, so from its present share `h` of the mean `n (h/wanted)²` are
/// expected to be enough; no more than twice as many as there are, since a spread of few is known badly.
/// Where half of them failed, more would fail, and none is added.
fn enough(outcomes: &[Outcome], until: &Until) -> u32 {
    let now = outcomes.len() as u32;
    let done: Vec<&Vec<f64>> = outcomes.iter().flatten().collect();
    if now >= until.max || done.len() < 2 || 2 * done.len() < outcomes.len() {
        return now;
    }
    let loads = done.first().map_or(0, |values| values.len());
    let shares = (0..loads).map(|load| {
        let sample =
            Sample::of(&done.iter().filter_map(|values| values.get(load).copied()).collect::<Vec<f64>>());
        match (sample.mean, sample.ci95) {
            (Some(mean), Some(half)) if mean != 0.0 => half / mean.abs(),
            // All results are zero, as without adhesion: exactly known.
            (Some(_), Some(0.0)) => 0.0,
            _ => f64::INFINITY,
        }
    });
    let widest = shares.fold(0.0, f64::max);
    if widest <= until.until_relative_ci {
        return now;
    }
    let expected = f64::from(now) * (widest / until.until_relative_ci).powi(2);
    (expected.min(2.0 * f64::from(now)).ceil() as u32).clamp(now + 1, until.max)
}

/// The campaign with the grids and the number of realizations of each case that its precision requires, as
/// far as known: up to the first unfinished ones. A cycle with a damaged file is unfinished.
///
/// # Errors
/// If the tables of a finished cycle cannot be read.
pub fn sampled(campaign: Campaign) -> Result<Campaign, StageError> {
    if !follows_from_results(&campaign) {
        return Ok(campaign);
    }
    by_sizes_first(|check| sampled_by(campaign.clone(), check))
}

/// True if grids or realizations follow from results.
fn follows_from_results(campaign: &Campaign) -> bool {
    campaign.spec.base.goal.error.is_some() || campaign.spec.realizations.until().is_some()
}

/// Unfinished cycles, if grids or realizations follow from their results; 0 otherwise.
#[must_use]
pub fn undecided(campaign: &Campaign, check: Check) -> usize {
    if !follows_from_results(campaign) {
        return 0;
    }
    standings_by(campaign, check).iter().filter(|standing| !standing.is_settled()).count()
}

fn sampled_by(campaign: Campaign, check: Check) -> Result<Campaign, StageError> {
    let mut campaign = refined(campaign, check)?;
    let Some(until) = campaign.spec.realizations.until() else { return Ok(campaign) };
    loop {
        let standings = standings_by(&campaign, check);
        let counts: Vec<u32> = (0..campaign.cases.len())
            .into_par_iter()
            .map(|case| count(&campaign, case, &standings, &until))
            .collect::<Result<_, _>>()?;
        if counts == campaign.counts {
            return Ok(campaign);
        }
        campaign = Campaign::with_counts(campaign.spec, campaign.dir, counts);
    }
}

fn count(campaign: &Campaign, case: usize, standings: &[Standing], until: &Until) -> Result<u32, StageError> {
    let units = campaign.cycles.iter().zip(standings).filter(|(unit, _)| unit.case == case);
    let outcomes: Vec<Option<Outcome>> = units
        .map(|(unit, standing)| match standing {
            Standing::Done => outcome(campaign, unit, until).map(|values| Some(Some(values))),
            Standing::Failed(_) => Ok(Some(None)),
            _ => Ok(None),
        })
        .collect::<Result<_, StageError>>()?;
    let known: Option<Vec<Outcome>> = outcomes.into_iter().collect();
    let of_case = &campaign.cases[case].case;
    if of_case.params.surface.measured().is_some() || of_case.is_coarser_grid() {
        return Ok(campaign.counts[case]);
    }
    Ok(known.map_or(campaign.counts[case], |known| enough(&known, until)))
}

/// The chosen statistic of a finished cycle, at each load reversal.
fn outcome(campaign: &Campaign, unit: &CycleUnit, until: &Until) -> Result<Vec<f64>, StageError> {
    let results = cycle_results(campaign, unit)?;
    let value = |(name, value): &(String, Value)| match value {
        Value::Real(value) if name == until.of.word() => Some(*value),
        _ => None,
    };
    Ok(results.iter().filter_map(|(_, columns)| columns.iter().find_map(value)).collect())
}
