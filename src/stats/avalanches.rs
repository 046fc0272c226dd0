//! One row per avalanche of every cycle.

use super::events::{Event, Events};
use super::realizations::case_of;
use super::{CaseInput, CycleInput, StatsError};
use crate::schema::{AVALANCHES, EventCounts};
use crate::store::Frame;

/// Sums the events of each avalanche up; rows are ordered by case, realization and place along the path,
/// whatever the order of the inputs.
///
/// A cycle without events has no row.
///
/// # Errors
/// If a table of events cannot be read or holds what no cycle can hold, or if a cycle names an unknown case.
pub fn avalanches(cases: &[CaseInput], cycles: &[CycleInput]) -> Result<Frame, StatsError> {
    let mut rows: Vec<Avalanche> = Vec::new();
    for (case, input) in ordered(cases, cycles)? {
        let events = Events::read(&input.events)?;
        rows.extend(events.avalanches().filter_map(|of_one| Avalanche::of(case, input, of_one)));
    }
    let each = |value: fn(&Avalanche) -> f64| rows.iter().map(value);
    let frame = Frame::of(&AVALANCHES)
        .text("case_id", rows.iter().map(|row| row.case.case_id.as_str()))
        .text("sweep", rows.iter().map(|row| row.case.sweep.as_str()))
        .i64("realization", rows.iter().map(|row| row.input.realization))
        .text("cycle_id", rows.iter().map(|row| row.input.cycle_id.as_str()))
        .text("surface_id", rows.iter().map(|row| row.input.surface_id.as_str()))
        .text("asperities_id", rows.iter().map(|row| row.input.surface_id.as_str()))
        .text("branch", rows.iter().map(|row| if row.first.loading { "loading" } else { "unloading" }))
        .f64("max_load", rows.iter().map(|row| row.first.max_load))
        .i64("avalanche_id", rows.iter().map(|row| row.first.avalanche_id))
        .i64("step", rows.iter().map(|row| row.first.step))
        .f64("approach_m", each(|row| row.first.approach_m))
        .count("event_count", rows.iter().map(|row| row.counts.sum()))
        .f64("energy_lost_j", each(|row| row.energy_lost_j))
        .f64("energy_lost", each(|row| row.energy_lost_j / row.input.energy_scale_j))
        .f64("load_drop_n", each(|row| row.first.load_before_n - row.last.load_after_n))
        .f64("area_change_m2", each(|row| row.last.area_after_m2 - row.first.area_before_m2));
    Ok(frame.counts(rows.iter().map(|row| row.counts)).build()?)
}

/// Cycles with their cases, ordered by case and realization.
pub(super) fn ordered<'a>(
    cases: &'a [CaseInput],
    cycles: &'a [CycleInput],
) -> Result<Vec<(&'a CaseInput, &'a CycleInput)>, StatsError> {
    let mut ordered: Vec<(&CaseInput, &CycleInput)> = Vec::new();
    for input in cycles {
        ordered.push((case_of(cases, input)?, input));
    }
    ordered.sort_by(|a, b| a.0.case_id.cmp(&b.0.case_id).then(a.1.realization.cmp(&b.1.realization)));
    Ok(ordered)
}

/// The events of one avalanche, summed up.
struct Avalanche<'a> {
    case: &'a CaseInput,
    input: &'a CycleInput,
    first: Event,
    last: Event,
    counts: EventCounts,
    energy_lost_j: f64,
}

impl<'a> Avalanche<'a> {
    fn of(case: &'a CaseInput, input: &'a CycleInput, events: &[Event]) -> Option<Self> {
        let (first, last) = (*events.first()?, *events.last()?);
        let counts = events.iter().map(|event| event.kind).collect();
        let energy_lost_j = events.iter().fold(0.0, |sum, event| sum + event.energy_lost_j);
        Some(Self { case, input, first, last, counts, energy_lost_j })
    }
}
