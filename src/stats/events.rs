//! The events of one cycle, in the order of the path.

use std::path::Path;

use super::StatsError;
use crate::schema::{EVENT_KINDS, EVENTS, EventKind, event_kind};
use crate::store::parquet::read_table;
use crate::store::{Frame, FrameError};

/// One event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Event {
    pub(super) step: i64,
    pub(super) loading: bool,
    /// Nothing while loading.
    pub(super) max_load: Option<f64>,
    pub(super) kind: EventKind,
    pub(super) cause: EventKind,
    /// Nothing for boundary elements.
    pub(super) asperity_id: Option<i64>,
    pub(super) approach_m: f64,
    pub(super) avalanche_id: i64,
    pub(super) load_before_n: f64,
    pub(super) load_after_n: f64,
    pub(super) area_before_m2: f64,
    pub(super) area_after_m2: f64,
    pub(super) energy_lost_j: f64,
}

/// The events of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Events(Vec<Event>);

/// The energy lost in the events of one loop \[J\], in parts.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Lost {
    pub(super) loading: f64,
    pub(super) unloading: f64,
    /// By the kind of the cause, as [`EVENT_KINDS`] has them.
    pub(super) kinds: [f64; EVENT_KINDS.len()],
}

impl Events {
    /// Reads a table of events. One without rows is a cycle in which nothing happened.
    pub(super) fn read(path: &Path) -> Result<Self, StatsError> {
        let events = rows(&read_table(path, &EVENTS)?)?.into_iter().collect::<Result<Vec<Event>, String>>();
        let mut events = events.map_err(|problem| StatsError::Events { path: path.to_owned(), problem })?;
        events.sort_by_key(|event| event.avalanche_id);
        Ok(Self(events))
    }

    /// The avalanches, in the order of the path; none is empty.
    pub(super) fn avalanches(&self) -> impl Iterator<Item = &[Event]> {
        self.0.chunk_by(|a, b| a.avalanche_id == b.avalanche_id)
    }

    /// All events, in the order of the path.
    pub(super) fn all(&self) -> &[Event] {
        &self.0
    }

    /// Events of the loop of a load reversal, whose step is given.
    fn of_loop(&self, turning_step: i64, max_load: f64) -> impl Iterator<Item = &Event> {
        // A load reversal is a copied number of the spec; the tolerance only allows for its rounding in a
        // file.
        let back = move |event: &Event| {
            event.max_load.is_some_and(|load| (load - max_load).abs() <= 1e-9 * max_load.abs())
        };
        self.0
            .iter()
            .filter(move |event| if event.loading { event.step <= turning_step } else { back(event) })
    }

    /// Energies dissipated up to a load reversal, whose step is given, and while unloading from it.
    ///
    /// One loading path serves every load reversal: events beyond the step of this one are not part of its
    /// loop.
    pub(super) fn lost(&self, turning_step: i64, max_load: f64) -> Lost {
        let mut lost = Lost::default();
        for event in self.of_loop(turning_step, max_load) {
            let branch = if event.loading { &mut lost.loading } else { &mut lost.unloading };
            *branch += event.energy_lost_j;
            lost.kinds[event.cause as usize] += event.energy_lost_j;
        }
        lost
    }
}

/// The events of a table, or why a row is none.
fn rows(frame: &Frame) -> Result<Vec<Result<Event, String>>, FrameError> {
    let (steps, avalanches) = (frame.i64("step")?, frame.i64("avalanche_id")?);
    let (branches, max_loads) = (frame.text("branch")?, frame.f64_or_null("max_load")?);
    let (kinds, causes) = (frame.text("kind")?, frame.text("cause")?);
    let known = |word: &str| {
        event_kind(word)
            .ok_or_else(|| format!("hold the kind {word:?}; there are: {}", EVENT_KINDS.join(", ")))
    };
    let asperities = frame.i64_or_null("asperity_id")?;
    let (approaches, energies) = (frame.f64("approach_m")?, frame.f64("energy_lost_j")?);
    let (loads_before, loads_after) = (frame.f64("load_before_n")?, frame.f64("load_after_n")?);
    let (areas_before, areas_after) = (frame.f64("area_before_m2")?, frame.f64("area_after_m2")?);
    let event = |row: usize| {
        let (branch, max_load) = (branches[row], max_loads[row]);
        let loading = match (branch, max_load) {
            ("loading", None) => true,
            ("unloading", Some(_)) => false,
            _ => {
                return Err(format!(
                    "hold a branch {branch:?} with max_load {max_load:?}; loading has none, unloading has one"
                ));
            }
        };
        Ok(Event {
            step: steps[row],
            loading,
            max_load,
            kind: known(kinds[row])?,
            cause: known(causes[row])?,
            asperity_id: asperities[row],
            approach_m: approaches[row],
            avalanche_id: avalanches[row],
            load_before_n: loads_before[row],
            load_after_n: loads_after[row],
            area_before_m2: areas_before[row],
            area_after_m2: areas_after[row],
            energy_lost_j: energies[row],
        })
    };
    Ok((0..frame.row_count()).map(event).collect())
}
