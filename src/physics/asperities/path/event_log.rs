//! Record of a path: events, work, and segments of the load.

use crate::asperities::contact::event::Event;
use crate::asperities::contact::transition::Transition;
use crate::cycle::Totals;
use serde::{Deserialize, Serialize};

/// Events, work and load along a branch.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct EventLog {
    pub(crate) events: Vec<Event>,
    /// Position of the event that has the energy of the last relaxation.
    charged: usize,
    /// `∫F dΔ` since the branch began \[J\].
    pub(crate) work_j: f64,
    avalanches: u64,
    /// True if the next event begins an avalanche.
    fresh: bool,
    /// Segments of the load between events.
    pub(crate) segments: Vec<LoadSegment>,
    /// Load at the end of the last segment \[N\].
    last: f64,
    /// Largest predictor residual before a global solve since the last record \[m\].
    pub(crate) drift_m: f64,
}

/// Segment of the path on which the load does not jump.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct LoadSegment {
    /// Mean penetration and load at its end \[m, N\].
    pub(crate) mean_penetration: f64,
    pub(crate) load: f64,
    /// Smallest load on it \[N\].
    pub(crate) least: f64,
}

impl EventLog {
    /// Adds to the energy of the last relaxation \[J\].
    pub(crate) fn charge(&mut self, energy: f64) {
        if let Some(event) = self.events.get_mut(self.charged) {
            event.energy_lost_j += energy;
        }
    }

    /// Begins an avalanche.
    pub(crate) fn begin_avalanche(&mut self) {
        self.fresh = true;
    }

    /// Records the transitions of one relaxation; the first has its energy.
    pub(crate) fn record(&mut self, moved: &[Transition], mean_penetration: f64, before: Totals, after: Totals, energy: f64) {
        if moved.is_empty() {
            return;
        }
        self.avalanches += u64::from(std::mem::take(&mut self.fresh));
        self.charged = self.events.len();
        for (k, change) in moved.iter().enumerate() {
            let (from, energy) = if k == 0 { (before, energy) } else { (after, 0.0) };
            self.enter(change, mean_penetration, from, after, energy);
        }
    }

    /// Records a transition without a change of load; later charges still belong to the last relaxation.
    pub(crate) fn note(&mut self, change: Transition, mean_penetration: f64, totals: Totals) {
        self.avalanches += u64::from(std::mem::take(&mut self.fresh));
        self.enter(&change, mean_penetration, totals, totals, 0.0);
    }

    fn enter(&mut self, change: &Transition, mean_penetration_m: f64, before: Totals, after: Totals, energy_lost_j: f64) {
        let (kind, asperity, avalanche) = (change.kind, change.asperity, self.avalanches);
        self.events.push(Event { kind, asperity, mean_penetration_m, avalanche, before, after, energy_lost_j });
    }

    /// Ends a segment without a jump of the load, which is known at its ends only.
    pub(crate) fn pass(&mut self, mean_penetration: f64, load: f64) {
        self.segments.push(LoadSegment { mean_penetration, load, least: load.min(self.last) });
        self.last = load;
    }

    /// Begins a segment after a jump of the load.
    pub(crate) fn restart(&mut self, mean_penetration: f64, load: f64) {
        self.segments.push(LoadSegment { mean_penetration, load, least: load });
        self.last = load;
    }

    /// Restores an earlier log with its numbers of events and segments.
    pub(crate) fn restore(&mut self, was: &Self, events: usize, segments: usize) {
        self.events.truncate(events);
        self.segments.truncate(segments);
        let (events, segments) = (std::mem::take(&mut self.events), std::mem::take(&mut self.segments));
        *self = Self { events, segments, ..*was };
    }

    /// Copy without events and segments.
    pub(crate) fn clone_without_events(&self) -> Self {
        Self { events: Vec::new(), segments: Vec::new(), ..*self }
    }
}
