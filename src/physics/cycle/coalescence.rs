//! Merging and splitting along a path: located by bracketing, applied between two paths.

use crate::model::Coalescence;
use crate::physics::PhysicsError;
use crate::physics::contact::event::Event;
use crate::physics::contact::merged_spot::TouchingPairs;
use crate::physics::contact::merging::{CoalescenceEvent, TOUCH};
use crate::physics::contact::problem::Problem;
use crate::physics::contact::state::{State, Status};
use crate::physics::contact::transition::{Kind, Transition};
use crate::physics::math::bracket::{End, Illinois};
use crate::physics::path::{EquilibriumPath, PathCheckpoint};

/// Location tolerance, relative to the rms height, if spots overlap through a jump.
const JUMP_TOLERANCE: f64 = 1e-6;

impl EquilibriumPath<'_> {
    /// Mean penetration \[m\] of the first coalescence event in the last increment, if any.
    pub(crate) fn next_coalescence(&self, known: &TouchingPairs) -> Result<Option<f64>, PhysicsError> {
        let problem = self.problem();
        let end = self.state();
        let due = problem.meetings(end, &problem.touching(end), known);
        let furthest = |state: &State| due.iter().map(|(_, m)| problem.beyond(state, *m)).fold(f64::NEG_INFINITY, f64::max);
        let (Some((over, _)), Some(start)) = (due.first(), self.previous_state()) else { return Ok(None) };
        let (mut low, mut high, mut over) = (start.approach_m, end.approach_m, *over);
        // The target is slightly past the event.
        let aim = |value: f64| value - 0.5 * TOUCH;
        let mut ends = Illinois::new(aim(furthest(start).min(0.0)), aim(over));
        let sudden = JUMP_TOLERANCE * problem.rms_height_m;
        // If a jump-in or release of the spots themselves caused it, the search begins on both sides of that event.
        let mut sides =
            self.last_event_of(&due).map_or(Vec::new(), |at| vec![at - 0.4 * self.sense() * sudden, at + 0.4 * self.sense() * sudden]);
        sides.retain(|side| (side - low) * self.sense() > 0.0 && (high - side) * self.sense() > 0.0);
        for round in 0.. {
            if over <= TOUCH || (high - low).abs() <= sudden {
                break;
            }
            // If linear interpolation fails, one end of the bracket is before a jump.
            let margin = if round < 3 { 0.02 } else { 0.3 };
            let middle = sides.pop().unwrap_or(low + ends.share(margin) * (high - low));
            let trial = furthest(self.excursion(middle)?.state());
            if trial < 0.0 {
                low = middle;
                ends.narrow(End::Low, aim(trial));
                sides.clear();
            } else {
                (high, over) = (middle, trial);
                ends.narrow(End::High, aim(trial));
            }
        }
        Ok(Some(high))
    }

    /// Mean penetration \[m\] of the last jump-in or release of one of these spots in the last increment.
    fn last_event_of(&self, due: &[(f64, CoalescenceEvent)]) -> Option<f64> {
        let spots = |meeting: &CoalescenceEvent| match *meeting {
            CoalescenceEvent::Touch(i, j) => [i, j],
            CoalescenceEvent::Part(m) => [m, m],
            CoalescenceEvent::Leave => [usize::MAX; 2],
        };
        let mut events = self.recent_events().iter().rev().filter(|event| matches!(event.kind, Kind::JumpIn | Kind::Uncover));
        events.find(|event| due.iter().any(|(_, meeting)| spots(meeting).contains(&event.asperity))).map(|event| event.approach_m)
    }

    /// Coalescence event due at the current state.
    ///
    /// If there is none, the overlapping pairs are added to `known`.
    pub(crate) fn due_coalescence(&self, known: &mut TouchingPairs) -> Result<Option<CoalescenceEvent>, PhysicsError> {
        let problem = self.problem();
        if problem.rules.coalescence != Coalescence::Merge {
            return Ok(None);
        }
        problem.check_room(self.state(), self.totals().area_m2)?;
        let state = self.state();
        if (0..problem.summits() + state.merged.len()).any(|i| state.is_orphan(i)) {
            return Ok(Some(CoalescenceEvent::Leave));
        }
        let touching = problem.touching(state);
        let due = problem.meetings(state, &touching, known).first().map(|(_, meeting)| *meeting);
        if due.is_none() {
            // A pair with a part of a merged spot has not been apart.
            known.retain(|(i, j)| [i, j].iter().any(|k| matches!(state.status[**k], Status::Merged { .. })));
            known.extend(touching);
        }
        Ok(due)
    }
}

impl PathCheckpoint {
    /// Applies a coalescence event; `problem` is the problem of this path.
    pub(crate) fn meet(&mut self, problem: &mut Problem, meeting: CoalescenceEvent, known: &mut TouchingPairs) -> Result<(), PhysicsError> {
        let (kind, asperity) = match meeting {
            CoalescenceEvent::Touch(i, j) => (Kind::Merge, problem.join(&mut self.state, i, j)?),
            CoalescenceEvent::Part(number) => {
                problem.part(&mut self.state, number);
                let [i, j] = self.state.merged[number - problem.summits()].parts;
                known.insert((i.min(j), i.max(j)));
                // Others may have grown to overlap the parts meanwhile.
                let theirs = |(k, l): &(usize, usize)| [i, j].contains(k) || [i, j].contains(l);
                known.extend(problem.touching(&self.state).into_iter().filter(theirs));
                (Kind::Split, number)
            }
            CoalescenceEvent::Leave => {
                problem.free_orphans(&mut self.state);
                return Ok(());
            }
        };
        let here = self.state.approach_m;
        let follows = |event: &Event| event.approach_m == here && matches!(event.kind, Kind::Merge | Kind::Split);
        if !self.log.events.last().is_some_and(follows) {
            self.log.begin_avalanche();
        }
        // The dissipated energy is assigned when the global problem is in equilibrium again.
        self.log.record(&[Transition { kind, asperity, by: None }], here, self.totals, self.totals, 0.0);
        Ok(())
    }
}
