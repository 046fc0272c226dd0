//! Length of the path increments.
//!
//! An increment ends on a multiple of `h = h_0/2^k`. A rejected one is halved; an accepted one may be followed by one of twice the length
//! where that ends on a multiple of itself. So the increments do not depend on where a path began.

use super::rejection::Rejection;
use crate::physics::PhysicsError;
use crate::physics::contact::transition::Transition;

/// Maximum number of halvings before the global problem is relaxed instead.
const MOST_HALVINGS: u32 = 14;

/// Number of halvings from which on the predictor residual is accepted.
const ACCEPTS_RESIDUAL: u32 = 6;

/// Maximum number of changes of status within one increment, per asperity: [`super::chatter::ChatterGuard`] allows each asperity a few.
const MOST_EVENTS: usize = 20;

/// Lengths of the increments and the events that earlier attempts have missed.
#[derive(Debug, Clone)]
pub(super) struct StepControl {
    /// Sense of the path: 1 loading, −1 unloading.
    sense: f64,
    /// Longest increment `h_0` \[m\].
    longest: f64,
    /// Number of halvings k.
    halvings: u32,
    /// Transitions that were found too late in earlier attempts of this increment.
    missed: Vec<Transition>,
    /// Number of events at which this increment ends with an error.
    event_limit: usize,
}

/// Next attempt after a rejected increment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Recovery {
    /// The same increment with the missed transitions in the queue.
    Repeat,
    /// Half the increment.
    Halve,
    /// The longest increment with uncovered asperities kept absorbed.
    KeepCovered,
    /// Relaxation of the global problem at the end of the increment.
    RelaxGlobally,
}

impl StepControl {
    pub(super) fn new(sense: f64, longest: f64, halvings: u32) -> Self {
        Self { sense, longest, halvings, missed: Vec::new(), event_limit: usize::MAX }
    }

    /// Longest increment \[m\].
    pub(super) fn longest(&self) -> f64 {
        self.longest
    }

    /// Number of halvings.
    pub(super) fn halvings(&self) -> u32 {
        self.halvings
    }

    /// Transitions that earlier attempts have missed.
    pub(super) fn missed(&self) -> &[Transition] {
        &self.missed
    }

    /// True if the predictor residual must be small for the increment to be accepted.
    pub(super) fn is_strict(&self) -> bool {
        self.halvings < ACCEPTS_RESIDUAL
    }

    fn size(&self, halvings: u32) -> f64 {
        self.longest * 0.5f64.powi(halvings as i32)
    }

    /// End of the increment that begins at `here`, not beyond `bound` \[m\].
    pub(super) fn target(&self, here: f64, bound: Option<f64>) -> f64 {
        let size = self.size(self.halvings);
        let target = next_multiple(here, size, self.sense);
        match bound {
            Some(bound) if (target - bound) * self.sense > -1e-9 * size => bound,
            _ => target,
        }
    }

    /// Accepts the increment to `target`; true if it ends a longest one.
    pub(super) fn accept(&mut self, target: f64) -> bool {
        let size = self.size(self.halvings);
        if self.halvings > 0 && next_multiple(target, size, self.sense) == next_multiple(target, 2.0 * size, self.sense) {
            self.halvings -= 1;
        }
        self.missed.clear();
        is_multiple(target, self.longest)
    }

    /// Chooses the next attempt after a rejection of the increment from `here` \[m\]; `uncovered` if asperities were uncovered in it that
    /// are absorbed at its beginning.
    pub(super) fn reject(&mut self, here: f64, rejection: &Rejection, uncovered: bool) -> Recovery {
        if self.add_missed(rejection) {
            return Recovery::Repeat;
        }
        if !self.is_strict() && uncovered {
            self.halvings = 0;
            return Recovery::KeepCovered;
        }
        if self.halvings >= MOST_HALVINGS {
            self.halvings = MOST_HALVINGS / 2;
            return Recovery::RelaxGlobally;
        }
        // Half an increment may end where the full one did.
        let end = |control: &Self, halvings: u32| next_multiple(here, control.size(halvings), control.sense);
        let ended = end(self, self.halvings);
        self.halvings += 1;
        while end(self, self.halvings) == ended && self.halvings < MOST_HALVINGS {
            self.halvings += 1;
        }
        Recovery::Halve
    }

    /// Adds the transitions that the attempt has found too late; true if one is new.
    fn add_missed(&mut self, rejection: &Rejection) -> bool {
        let Rejection::Late(late, _) = rejection else { return false };
        let known = self.missed.len();
        for transition in late {
            if !self.missed.contains(transition) {
                self.missed.push(*transition);
            }
        }
        self.missed.len() > known
    }

    /// Begins to count the events of an increment of a path with `events` events and `n` asperities.
    pub(super) fn limit_events(&mut self, events: usize, n: usize) {
        self.event_limit = events + MOST_EVENTS * (n + 10);
    }

    /// Ends an increment whose events go on without end; `asperity` is the caller's number of the one that changed last.
    pub(super) fn check_events(&self, events: usize, n: usize, approach_m: f64, asperity: usize) -> Result<(), PhysicsError> {
        if events <= self.event_limit {
            return Ok(());
        }
        Err(PhysicsError::EndlessAvalanche { approach_m, events: MOST_EVENTS * (n + 10), asperity })
    }
}

/// True if `value` is a multiple of `size` to rounding, which grows with their ratio.
pub(crate) fn is_multiple(value: f64, size: f64) -> bool {
    let count = value / size;
    (count - count.round()).abs() < 1e-9 + 4.0 * f64::EPSILON * count.abs()
}

/// The next multiple of `size` after `here` in a sense.
fn next_multiple(here: f64, size: f64, sense: f64) -> f64 {
    let count = here / size * sense;
    let next = if is_multiple(here, size) { count.round() + 1.0 } else { count.ceil() };
    next * sense * size
}

#[cfg(test)]
mod tests {
    use super::{MOST_HALVINGS, Recovery, Rejection, StepControl};
    use crate::physics::contact::transition::{Kind, Transition};
    use crate::physics::solve::residual::NotConverged;

    fn failed() -> Rejection {
        Rejection::NotConverged(NotConverged::residual(1.0, 0))
    }

    #[test]
    fn law_increments_end_on_multiples_and_grow_back() {
        let mut control = StepControl::new(-1.0, 1.0, 0);
        assert_eq!(control.target(0.3, None), 0.0);
        assert_eq!(control.target(0.3, Some(0.1)), 0.1);
        assert_eq!(control.reject(0.3, &failed(), false), Recovery::Halve);
        // Half an increment from 0.3 ends at 0 too; a quarter ends at 0.25.
        assert_eq!((control.halvings(), control.target(0.3, None)), (2, 0.25));
        // The next quarter ends at 0 and so does the next half: it is tried.
        assert!(!control.accept(0.25));
        assert_eq!(control.halvings(), 1);
        // The next half ends at −½ and the next full increment at −1: it waits.
        assert!(control.accept(0.0));
        assert_eq!(control.halvings(), 1);
        assert!(!control.accept(-0.5));
        assert_eq!(control.halvings(), 0);
    }

    #[test]
    fn law_a_rejected_increment_has_an_end() {
        let mut control = StepControl::new(1.0, 1.0, 0);
        let late = |asperity| Rejection::Late(vec![Transition { kind: Kind::JumpIn, asperity, by: None }], NotConverged::residual(1.0, 0));
        assert_eq!(control.reject(0.0, &late(3), false), Recovery::Repeat);
        assert_eq!(control.missed().len(), 1);
        // The same transition again is no news.
        assert_eq!(control.reject(0.0, &late(3), false), Recovery::Halve);
        let mut rejections = 0;
        while control.reject(0.0, &failed(), false) != Recovery::RelaxGlobally {
            rejections += 1;
            assert!(rejections <= MOST_HALVINGS);
        }
        assert_eq!(control.halvings(), MOST_HALVINGS / 2);
        assert_eq!(control.reject(0.0, &failed(), true), Recovery::KeepCovered);
        assert_eq!(control.halvings(), 0);
    }
}
