//! Numerical settings of a problem: they decide on cost and digits, and on nothing else.

/// Number of contacts in the local problem of an event.
///
/// They lie within about five screening lengths of it. All other contacts respond to first order.
pub(super) const SPOTS_IN_PATCH: usize = 24;

/// Accuracy of a path, unless it is set.
pub(crate) const ACCURACY: Accuracy = Accuracy(1e-2);

/// Numerical settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Numerics {
    /// Number of contacts in the local problem of an event.
    pub(crate) spots_in_patch: usize,
    /// Accuracy of the path.
    pub(crate) accuracy: Accuracy,
}

impl Default for Numerics {
    fn default() -> Self {
        Self { spots_in_patch: SPOTS_IN_PATCH, accuracy: ACCURACY }
    }
}

/// Accuracy of a path between two exact global solves: one tolerance, from which all limits follow. They are lengths in units of the scale of the path, the
/// mean jump-off penetration rounded down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Accuracy(pub(crate) f64);

impl Accuracy {
    /// Longest increment.
    pub(crate) const fn longest_increment(self) -> f64 {
        5.0 * self.0
    }

    /// Longest increment where local problems hold all contacts: nothing is neglected then, and the work is to be as exact as the events.
    pub(crate) const fn longest_increment_of_whole(self) -> f64 {
        5.0 * self.0 / 8.0
    }

    /// Maximum root-mean-square predictor residual at the end of an increment.
    pub(crate) const fn drift(self) -> f64 {
        self.0
    }

    /// Maximum predictor residual of one contact there.
    pub(crate) const fn worst_residual(self) -> f64 {
        10.0 * self.0
    }

    /// Maximum lateness of a transition that is found there.
    pub(crate) const fn lateness(self) -> f64 {
        2.0 * self.0
    }

    /// Maximum pending displacement of a contact.
    pub(crate) const fn pending(self) -> f64 {
        self.0
    }

    /// Residual of a global solve whose state is not written down.
    pub(crate) const fn sufficient(self) -> f64 {
        self.0 / 500.0
    }
}
