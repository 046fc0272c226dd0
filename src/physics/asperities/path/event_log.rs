//! Record of a path: events, work, and segments of the load.

use crate::asperities::contact::event::Event;
use crate::asperities::contact::transition::Transition;
use crate::cycle::Totals;
use crate::event_kind::{EventKind, SpotStatus};
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

    /// Records the transitions of one relaxation, with the status after it; the first has its energy.
    pub(crate) fn record(
        &mut self,
        moved: &[(Transition, SpotStatus)],
        mean_penetration_m: f64,
        [before, after]: [Totals; 2],
        energy: f64,
    ) {
        let Some((first, _)) = moved.first() else { return };
        self.avalanches += u64::from(std::mem::take(&mut self.fresh));
        let (cause, avalanche) = (self.cause(first.kind), self.avalanches);
        self.charged = self.events.len();
        self.events.extend(moved.iter().enumerate().map(|(k, (change, status))| {
            let Transition { kind, asperity, .. } = *change;
            let (before, energy_lost_j) = if k == 0 { (before, energy) } else { (after, 0.0) };
            Event {
                kind,
                asperity,
                status: *status,
                cause,
                mean_penetration_m,
                avalanche,
                before,
                after,
                energy_lost_j,
            }
        }));
    }

    /// Records a transition without a change of load; later charges still belong to the last relaxation.
    pub(crate) fn note(&mut self, change: (Transition, SpotStatus), mean_penetration: f64, totals: Totals) {
        let charged = self.charged;
        self.record(&[change], mean_penetration, [totals; 2], 0.0);
        self.charged = charged;
    }

    /// Cause of a relaxation whose first event has this `kind`: itself, or merging or splitting before it.
    ///
    /// Merging and splitting exchange contacts at equal energy. They are recorded before the contact is in
    /// equilibrium again, with the energy 0 if nothing moves at once. They cause the relaxations on the way
    /// to that equilibrium, up to the first with an energy. This is mainly the difference between the
    /// potentials of the merged contact and of its parts. Without this rule the energies of merging and
    /// splitting do not cancel: on one surface of Δγ = 0.005 J/m² with ζ = 32, a jump that follows a
    /// splitting has fourteen times Θ.
    fn cause(&self, kind: EventKind) -> EventKind {
        let is_before = |event: &&Event| event.avalanche == self.avalanches && event.energy_lost_j == 0.0;
        let before = self.events.get(self.charged).filter(is_before).map(|event| [event.kind, event.cause]);
        before.into_iter().flatten().find(|kind| kind.is_merging()).unwrap_or(kind)
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

#[cfg(test)]
mod tests {
    use super::{EventKind, EventLog, SpotStatus, Totals, Transition};

    /// Causes of relaxations of one event each, with their energies \[J\].
    fn causes(relaxations: &[(Transition, f64)]) -> Vec<EventKind> {
        let mut log = EventLog::default();
        log.begin_avalanche();
        for (first, energy) in relaxations {
            let moved = [*first, Transition::jump_off(9)].map(|change| (change, SpotStatus::Free));
            log.record(&moved, 0.0, [Totals::default(); 2], *energy);
        }
        log.events.iter().step_by(2).map(|event| event.cause).collect()
    }

    #[test]
    fn law_what_follows_a_splitting_without_energy_is_caused_by_it() {
        let [split, jump, cover] = [Transition::split(5), Transition::jump_off(1), Transition::cover(2, 3)];
        let [of_split, of_jump, of_cover] = [split, jump, cover].map(|change| change.kind);
        assert_eq!(causes(&[(split, 0.0), (jump, 2.0), (cover, 1.0)]), [of_split, of_split, of_cover]);
        assert_eq!(causes(&[(split, 0.0), (cover, 0.0), (jump, 2.0)]), [of_split; 3]);
        assert_eq!(causes(&[(split, 1.0), (jump, 2.0)]), [of_split, of_jump]);
        assert_eq!(causes(&[(jump, 2.0), (split, 0.0)]), [of_jump, of_split]);
    }

    #[test]
    fn law_a_cause_ends_with_its_avalanche_and_with_an_energy() {
        let [split, uncover, jump] =
            [Transition::split(5), Transition::uncover(2, 3), Transition::jump_off(1)];
        let mut log = EventLog::default();
        let record = |log: &mut EventLog, change| {
            log.record(&[(change, SpotStatus::Free)], 0.0, [Totals::default(); 2], 0.0);
        };
        for change in [split, jump, split] {
            log.begin_avalanche();
            record(&mut log, change);
        }
        // A transition without a change of load does not take a later charge, which is that of the splitting.
        log.note((uncover, SpotStatus::Free), 0.0, Totals::default());
        log.charge(1.0);
        record(&mut log, jump);
        let causes: Vec<EventKind> = log.events.iter().map(|event| event.cause).collect();
        assert_eq!(causes, [split, jump, split, split, jump].map(|change| change.kind));
    }
}
