//! Length of the path increments.
//!
//! An increment ends on a multiple of `h = h_0/2^k`. A rejected one is halved; an accepted one may be
//! followed by one of twice the length where that ends on a multiple of itself. So the increments do not
//! depend on where a path began.

use crate::asperities::numerics::Steps;
use crate::{LoopError, PhysicsError};

/// Lengths of the increments.
#[derive(Debug, Clone)]
pub(super) struct StepControl {
    /// Sense of the path: 1 loading, −1 unloading.
    sense: f64,
    /// Numbers of halvings.
    limits: Steps,
    /// Longest increment `h_0` \[m\].
    longest: f64,
    /// Number of halvings k.
    halvings: u32,
    /// Trials of transitions within this attempt.
    trials: usize,
}

impl StepControl {
    pub(super) fn new(limits: Steps, sense: f64, longest: f64, halvings: u32) -> Self {
        Self { sense, limits, longest, halvings, trials: 0 }
    }

    /// Longest increment \[m\].
    pub(super) fn longest(&self) -> f64 {
        self.longest
    }

    /// Number of halvings.
    pub(super) fn halvings(&self) -> u32 {
        self.halvings
    }

    /// True if the predictor residual must be small for the increment to be accepted.
    pub(super) fn is_strict(&self) -> bool {
        self.halvings < self.limits.strict_halvings
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
        if self.halvings > 0
            && next_multiple(target, size, self.sense) == next_multiple(target, 2.0 * size, self.sense)
        {
            self.halvings -= 1;
        }
        is_multiple(target, self.longest)
    }

    /// Halves the increment from `here` \[m\] after a rejection; false if the global problem is to be relaxed
    /// instead.
    pub(super) fn halve(&mut self, here: f64) -> bool {
        let most = self.limits.max_halvings;
        if self.halvings >= most {
            self.halvings = most / 2;
            return false;
        }
        // Half an increment may end where the full one did.
        let end = |control: &Self, halvings: u32| next_multiple(here, control.size(halvings), control.sense);
        let ended = end(self, self.halvings);
        self.halvings += 1;
        while end(self, self.halvings) == ended && self.halvings < most {
            self.halvings += 1;
        }
        true
    }

    /// Begins an attempt.
    pub(super) fn begin_attempt(&mut self) {
        self.trials = 0;
    }

    /// Counts a trial, of `most`; `asperity` is the caller's number of the one that is to change.
    pub(super) fn count_trial(
        &mut self,
        most: usize,
        mean_penetration_m: f64,
        asperity: usize,
    ) -> Result<(), PhysicsError> {
        self.trials += 1;
        if self.trials <= most {
            Ok(())
        } else {
            Err(LoopError::EndlessAvalanche { mean_penetration_m, events: most, asperity }.into())
        }
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
    use super::{StepControl, Steps};

    #[test]
    fn law_increments_end_on_multiples_and_grow_back() {
        let mut control = StepControl::new(Steps::DEFAULT, -1.0, 1.0, 0);
        assert_eq!(control.target(0.3, None), 0.0);
        assert_eq!(control.target(0.3, Some(0.1)), 0.1);
        assert!(control.halve(0.3));
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
        let mut control = StepControl::new(Steps::DEFAULT, 1.0, 1.0, 0);
        let mut rejections = 0;
        while control.halve(0.0) {
            rejections += 1;
            assert!(rejections <= Steps::DEFAULT.max_halvings);
        }
        assert_eq!(control.halvings(), Steps::DEFAULT.max_halvings / 2);
    }
}
