//! What a path leaves behind: its events, its work, and the way of its load.

use crate::physics::contact::event::Event;
use crate::physics::contact::problem::Totals;
use crate::physics::contact::transition::Transition;
use serde::{Deserialize, Serialize};

/// What a path has left behind.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct EventLog {
    pub(crate) events: Vec<Event>,
    /// Which of them has the energy of the last relaxation.
    charged: usize,
    /// `∫F dΔ` since the branch began \[J\].
    pub(crate) work_j: f64,
    avalanches: u64,
    /// True if the next event is of another avalanche.
    fresh: bool,
    /// The way of the load, from event to event.
    pub(crate) segments: Vec<LoadSegment>,
    /// Load where it was known last \[N\].
    last: f64,
    /// Greatest residual before the whole contact was solved, since this was asked last \[m\].
    pub(crate) drift_m: f64,
}

/// A part of the way of the load on which it does not jump.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct LoadSegment {
    /// Approach and load at its end \[m, N\].
    pub(crate) approach: f64,
    pub(crate) load: f64,
    /// Least load on it \[N\].
    pub(crate) least: f64,
}

impl EventLog {
    /// Adds to the energy of the last relaxation \[J\].
    pub(crate) fn charge(&mut self, energy: f64) {
        if let Some(event) = self.events.get_mut(self.charged) {
            event.energy_lost_j += energy;
        }
    }

    /// The next event is of another avalanche.
    pub(crate) fn begin_avalanche(&mut self) {
        self.fresh = true;
    }

    /// Writes changes of one relaxation down; its energy is the first one's.
    pub(crate) fn record(&mut self, moved: &[Transition], approach: f64, before: Totals, after: Totals, energy: f64) {
        if moved.is_empty() {
            return;
        }
        self.avalanches += u64::from(std::mem::take(&mut self.fresh));
        self.charged = self.events.len();
        for (k, change) in moved.iter().enumerate() {
            let (from, energy) = if k == 0 { (before, energy) } else { (after, 0.0) };
            self.enter(change, approach, from, after, energy);
        }
    }

    /// Writes a change down that moves nothing; what is charged belongs to the last relaxation still.
    pub(crate) fn note(&mut self, change: Transition, approach: f64, totals: Totals) {
        self.avalanches += u64::from(std::mem::take(&mut self.fresh));
        self.enter(&change, approach, totals, totals, 0.0);
    }

    fn enter(&mut self, change: &Transition, approach_m: f64, before: Totals, after: Totals, energy_lost_j: f64) {
        let (kind, asperity, avalanche) = (change.kind, change.asperity, self.avalanches);
        self.events.push(Event { kind, asperity, approach_m, avalanche, before, after, energy_lost_j });
    }

    /// The load has gone on without a jump; it is known at the ends of the parts of a stretch, a twentieth of a jump-off penetration apart.
    pub(crate) fn pass(&mut self, approach: f64, load: f64) {
        self.segments.push(LoadSegment { approach, load, least: load.min(self.last) });
        self.last = load;
    }

    /// The load has jumped.
    pub(crate) fn restart(&mut self, approach: f64, load: f64) {
        self.segments.push(LoadSegment { approach, load, least: load });
        self.last = load;
    }

    /// Back to what it `was` when it had so many events and segments.
    pub(crate) fn restore(&mut self, was: &Self, events: usize, segments: usize) {
        self.events.truncate(events);
        self.segments.truncate(segments);
        let (events, segments) = (std::mem::take(&mut self.events), std::mem::take(&mut self.segments));
        *self = Self { events, segments, ..*was };
    }

    /// The same, of a path that has had no event.
    pub(crate) fn clone_without_events(&self) -> Self {
        Self { events: Vec::new(), segments: Vec::new(), ..*self }
    }
}
