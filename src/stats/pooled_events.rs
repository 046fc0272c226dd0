//! The events of all cycles in one table.

use super::avalanches::ordered;
use super::events::{Event, Events};
use super::{CaseInput, CycleInput, StatsError};
use crate::schema::POOLED_EVENTS;
use crate::store::Frame;

/// Rows of the events of each cycle, one cycle at a time: ordered by case, realization and place along the
/// path, whatever the order of the inputs.
///
/// # Errors
/// If a cycle names an unknown case; of a cycle, if its table cannot be read or holds what no cycle can hold.
pub fn pooled_events<'a>(
    cases: &'a [CaseInput],
    cycles: &'a [CycleInput],
) -> Result<impl Iterator<Item = Result<Frame, StatsError>> + 'a, StatsError> {
    Ok(ordered(cases, cycles)?.into_iter().map(|(case, input)| of_cycle(case, input)))
}

/// Rows of one cycle.
fn of_cycle(case: &CaseInput, input: &CycleInput) -> Result<Frame, StatsError> {
    let events = Events::read(&input.events)?;
    let rows = events.all();
    let same = |text: &str| vec![text.to_owned(); rows.len()];
    let each = |value: fn(&Event) -> f64| rows.iter().map(value);
    let branch = |event: &Event| if event.loading { "loading" } else { "unloading" };
    let frame = Frame::of(&POOLED_EVENTS)
        .text("case_id", same(&case.case_id))
        .text("sweep", same(&case.sweep))
        .i64("realization", rows.iter().map(|_| input.realization))
        .text("cycle_id", same(&input.cycle_id))
        .text("surface_id", same(&input.surface_id))
        .text("asperities_id", same(&input.surface_id))
        .text("branch", rows.iter().map(branch))
        .f64("max_load", rows.iter().map(|event| event.max_load))
        .i64("step", rows.iter().map(|event| event.step))
        .i64("avalanche_id", rows.iter().map(|event| event.avalanche_id))
        .text("kind", rows.iter().map(|event| event.kind.word()))
        .text("cause", rows.iter().map(|event| event.cause.word()))
        .i64("asperity_id", rows.iter().map(|event| event.asperity_id))
        .f64("approach_m", each(|event| event.approach_m))
        .f64("load_before_n", each(|event| event.load_before_n))
        .f64("load_drop_n", each(|event| event.load_before_n - event.load_after_n))
        .f64("area_change_m2", each(|event| event.area_after_m2 - event.area_before_m2))
        .f64("energy_lost_j", each(|event| event.energy_lost_j))
        .f64("energy_lost", rows.iter().map(|event| event.energy_lost_j / input.energy_scale_j));
    Ok(frame.build()?)
}
