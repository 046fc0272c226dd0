//! A path that begins, and one that goes on with other asperities.

use super::equilibrium_path::{Depth, Halt, Path, UNIT};
use super::event_log::Log;
use super::predictor::Front;
use crate::physics::PhysicsError;
use crate::physics::contact::event::Event;
use crate::physics::contact::merged_spot::Known;
use crate::physics::contact::problem::{Problem, Totals};
use crate::physics::contact::state::State;
use crate::physics::half_space::Effort;
use serde::{Deserialize, Serialize};

/// Longest stretch, of the mean jump-off penetration.
const STRETCH: f64 = 0.05;

/// The same where every event is solved with all spots: nothing is left out then, and the work is to be as exact as the events.
const FINE_STRETCH: f64 = 0.00625;

/// Least scale of lengths along the path, of the rms height: below it adhesion does not set the scale.
const LEAST_SCALE: f64 = 0.02;

/// What goes on where a path goes on with other asperities.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Carried {
    pub(crate) state: State,
    pub(crate) sign: f64,
    /// The longest stretch, and the scale of lengths \[m\].
    lengths: (f64, f64),
    pub(crate) log: Log,
    /// Load and area, and the balance, when the whole contact was solved last; how many events there were.
    pub(crate) totals: Totals,
    balance: f64,
    settled: usize,
    halvings: u32,
    flips: Vec<u8>,
    held: Vec<usize>,
    effort: Effort,
    /// Pairs that touch and are no news, where the path has rested.
    pub(crate) known: Option<Known>,
}

impl Carried {
    /// At the beginning of a path.
    pub(crate) fn begin(problem: &Problem, state: State, sign: f64) -> Self {
        let summits = &problem.asperities[..problem.summits];
        let off = summits.iter().map(|a| a.jump_off_penetration().abs()).sum::<f64>() / summits.len() as f64;
        // Where adhesion is next to nothing, the roughness sets the scale.
        let off = off.max(LEAST_SCALE * problem.rms_height_m);
        // A power of two of the unit, so that round steps of the approach end stretches.
        let unit = UNIT * problem.rms_height_m;
        let share = if problem.solves_whole() { FINE_STRETCH } else { STRETCH };
        let longest = unit * (share * off / unit).log2().floor().exp2();
        Self {
            state,
            sign,
            lengths: (longest, longest / share),
            log: Log::default(),
            totals: Totals::default(),
            balance: 0.0,
            settled: 0,
            halvings: 0,
            flips: Vec::new(),
            held: Vec::new(),
            effort: Effort::default(),
            known: None,
        }
    }
}

impl<'p> Path<'p> {
    /// A path that begins, or goes on with what another has carried here. The state need be no equilibrium: what the potential loses is charged to the
    /// last event, and how far it was from one is no drift.
    pub(crate) fn resume(problem: &'p Problem, carried: Carried) -> Result<Self, PhysicsError> {
        let (approach, drift) = (carried.state.approach_m, carried.log.drift_m);
        let mut path = Self::bare(problem, Front::new(problem, carried.state), carried.sign, carried.lengths);
        path.front.expect_totals(carried.totals);
        path.solver.effort = carried.effort;
        (path.log, path.totals, path.balance) = (carried.log, carried.totals, carried.balance);
        (path.halvings, path.settled, path.unbalanced) = (carried.halvings, carried.settled, carried.settled < path.log.events.len());
        path.held = carried.held;
        path.limit_events();
        for (mine, flips) in path.flips.iter_mut().zip(carried.flips) {
            *mine = flips;
        }
        match path.settle(approach, false, true, Depth::Whole) {
            Ok(()) => {
                path.log.drift_m = drift;
                Ok(path)
            }
            Err(Halt::Unsettled(unsettled) | Halt::Late(_, unsettled)) => Err(path.stuck(unsettled)),
            Err(Halt::Error(error)) => Err(error),
        }
    }

    /// Ends here, where the whole contact is solved.
    pub(crate) fn carry(self) -> Carried {
        Carried {
            state: self.front.state,
            sign: self.sign,
            lengths: (self.longest, self.scale),
            settled: self.log.events.len(),
            log: self.log,
            totals: self.totals,
            balance: self.balance,
            halvings: self.halvings,
            flips: self.flips,
            held: self.held,
            effort: self.solver.effort,
            known: None,
        }
    }

    /// The state before the last stretch.
    pub(crate) fn start(&self) -> Option<&State> {
        self.mark.as_deref().map(|mark| &mark.front.state)
    }

    /// Events of the last stretch.
    pub(crate) fn recent_events(&self) -> &[Event] {
        &self.log.events[self.mark.as_deref().map_or(0, |mark| mark.events)..]
    }

    /// Goes back to before the last stretch.
    pub(crate) fn rewind(&mut self) {
        if let Some(mark) = self.mark.take() {
            self.back_to(&mark);
        }
    }
}
