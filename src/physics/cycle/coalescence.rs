//! Merging and splitting along a path: located by bisection, applied between two paths.

use crate::model::Coalescence;
use crate::physics::PhysicsError;
use crate::physics::contact::event::Event;
use crate::physics::contact::merged_spot::Known;
use crate::physics::contact::merging::{Meeting, ROUNDING, TOUCH};
use crate::physics::contact::problem::Problem;
use crate::physics::contact::state::{State, Status};
use crate::physics::contact::transition::{Change, Kind};
use crate::physics::math::bracket::{End, Illinois};
use crate::physics::path::{Carried, Path};

/// Way within which they merge where they come to touch by a jump, of the rms height.
const SUDDEN: f64 = 1e-6;

impl Path<'_> {
    /// The approach \[m\] at which the first of the meetings comes that are due at the end of the last stretch; nothing where none is.
    pub(crate) fn meeting(&self, known: &Known) -> Result<Option<f64>, PhysicsError> {
        let problem = self.problem();
        let end = self.state();
        let due = problem.meetings(end, &problem.touching(end), known);
        let furthest = |state: &State| due.iter().map(|(_, m)| problem.beyond(state, *m)).fold(f64::NEG_INFINITY, f64::max);
        let (Some((over, _)), Some(start)) = (due.first(), self.start()) else { return Ok(None) };
        let (mut low, mut high, mut over) = (start.approach_m, end.approach_m, *over);
        // What is looked for is a little beyond the meeting.
        let aim = |value: f64| value - 0.5 * TOUCH;
        let mut ends = Illinois::new(aim(furthest(start).min(0.0)), aim(over));
        let sudden = SUDDEN * problem.rms_height_m;
        // Where an event of the spots themselves has brought it about, it is looked for there, on both sides.
        let mut sides =
            self.last_event_of(&due).map_or(Vec::new(), |at| vec![at - 0.4 * self.sign * sudden, at + 0.4 * self.sign * sudden]);
        sides.retain(|side| (side - low) * self.sign > 0.0 && (high - side) * self.sign > 0.0);
        for round in 0.. {
            if over <= TOUCH || (high - low).abs() <= sudden {
                break;
            }
            // Where a straight line does not lead there, one of the ends is before a jump.
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

    /// The approach of the last event within the last stretch by which one of these spots came to be \[m\].
    fn last_event_of(&self, due: &[(f64, Meeting)]) -> Option<f64> {
        let spots = |meeting: &Meeting| match *meeting {
            Meeting::Touch(i, j) => [i, j],
            Meeting::Part(m) => [m, m],
            Meeting::Leave => [usize::MAX; 2],
        };
        let mut events = self.recent_events().iter().rev().filter(|event| matches!(event.kind, Kind::JumpIn | Kind::Uncover));
        events.find(|event| due.iter().any(|(_, meeting)| spots(meeting).contains(&event.asperity))).map(|event| event.approach_m)
    }

    /// The contact is in equilibrium after a meeting. A spot that has become smaller by merging does not part again at once.
    pub(crate) fn settle_meeting(&mut self) {
        let (totals, state) = (self.totals, &mut self.front.state);
        for (k, spot) in state.merged.iter_mut().enumerate().filter(|(_, spot)| spot.approach_m == state.approach_m) {
            let radius = state.radius[self.solver.problem.summits + k];
            if radius > 0.0 {
                spot.release_m = spot.release_m.min((1.0 - ROUNDING) * radius);
            }
        }
        if let Some(event) = self.log.events.last_mut().filter(|event| matches!(event.kind, Kind::Merge | Kind::Split)) {
            event.after = totals;
        }
    }

    /// Meetings that are due where the path is; where none is, what touches there is known from now on.
    pub(crate) fn due_meeting(&self, known: &mut Known) -> Result<Option<Meeting>, PhysicsError> {
        let problem = self.problem();
        if problem.rules.coalescence != Coalescence::Merge {
            return Ok(None);
        }
        problem.check_room(self.state(), self.totals.area_m2)?;
        let state = self.state();
        if (0..problem.summits + state.merged.len()).any(|i| state.is_orphan(i)) {
            return Ok(Some(Meeting::Leave));
        }
        let touching = problem.touching(state);
        let due = problem.meetings(state, &touching, known).first().map(|(_, meeting)| *meeting);
        if due.is_none() {
            // A pair of which one is part of another spot has not been apart.
            known.retain(|(i, j)| [i, j].iter().any(|k| matches!(state.status[**k], Status::Merged { .. })));
            known.extend(touching);
        }
        Ok(due)
    }
}

impl Carried {
    /// Does what is to be done; `problem` is the path's own.
    pub(crate) fn meet(&mut self, problem: &mut Problem, meeting: Meeting, known: &mut Known) -> Result<(), PhysicsError> {
        let (kind, asperity) = match meeting {
            Meeting::Touch(i, j) => (Kind::Merge, problem.join(&mut self.state, i, j)?),
            Meeting::Part(number) => {
                problem.part(&mut self.state, number);
                let [i, j] = self.state.merged[number - problem.summits].parts;
                known.insert((i.min(j), i.max(j)));
                // Others have grown up to them meanwhile.
                let theirs = |(k, l): &(usize, usize)| [i, j].contains(k) || [i, j].contains(l);
                known.extend(problem.touching(&self.state).into_iter().filter(theirs));
                (Kind::Split, number)
            }
            Meeting::Leave => {
                problem.free_orphans(&mut self.state);
                return Ok(());
            }
        };
        let here = self.state.approach_m;
        let follows = |event: &Event| event.approach_m == here && matches!(event.kind, Kind::Merge | Kind::Split);
        if !self.log.events.last().is_some_and(follows) {
            self.log.begin_avalanche();
        }
        // What is lost is charged when the whole contact is in equilibrium again.
        self.log.record(&[Change { kind, asperity, by: None }], here, self.totals, self.totals, 0.0);
        Ok(())
    }
}
