//! Displacements of contacts by events that are not yet in their predictors.
//!
//! An event changes the field everywhere: next to it by a change that is known exactly, far from it by that
//! of a point load. Free asperities have no response, so the change is entered into their predictors.
//! Contacts have it as a pending displacement: a local solve applies what its members have pending, and a
//! global solve accounts for all of it.

use crate::asperities::contact::Status;

/// Displacements that are pending since the last global solve.
#[derive(Debug, Clone)]
pub(super) struct PendingField {
    /// Pending displacement by asperity \[m\]; zero out of contact.
    values: Vec<f64>,
    /// Contacts whose pending displacement has exceeded the limit next to an event.
    over_limit: Vec<usize>,
    /// True if nothing was added.
    is_smooth: bool,
}

impl PendingField {
    /// Nothing pending for `n` asperities.
    pub(super) fn new(n: usize) -> Self {
        Self { values: vec![0.0; n], over_limit: Vec::new(), is_smooth: true }
    }

    /// Makes room for `n` asperities.
    pub(super) fn grow(&mut self, n: usize) {
        self.values.resize(n, 0.0);
    }

    /// Discards all pending displacements, since a global solve has accounted for them.
    pub(super) fn clear(&mut self) {
        self.values.fill(0.0);
        self.over_limit.clear();
        self.is_smooth = true;
    }

    /// True if no event has changed the field.
    pub(super) fn is_smooth(&self) -> bool {
        self.is_smooth
    }

    /// Adds a displacement \[m\] to a contact far from an event. Alone it is no reason for a local solve.
    pub(super) fn add_far(&mut self, i: usize, displacement: f64) {
        self.values[i] += displacement;
        self.is_smooth = false;
    }

    /// Adds a displacement \[m\] to a contact next to an event.
    pub(super) fn add_near(&mut self, i: usize, displacement: f64, limit: f64) {
        self.add_far(i, displacement);
        if self.values[i].abs() > limit && !self.over_limit.contains(&i) {
            self.over_limit.push(i);
        }
    }

    /// Marks the displacement of an asperity as applied.
    pub(super) fn set_applied(&mut self, i: usize) {
        self.values[i] = 0.0;
    }

    /// Pending displacement of an asperity \[m\].
    pub(super) fn of(&self, i: usize) -> f64 {
        self.values[i]
    }

    /// Pending displacements by asperity \[m\].
    pub(super) fn all(&self) -> &[f64] {
        &self.values
    }

    /// Contact with the largest pending displacement next to an event, if that exceeds `limit` \[m\].
    pub(super) fn worst(&mut self, status: &[Status], limit: f64) -> Option<usize> {
        let values = &self.values;
        self.over_limit.retain(|i| status[*i] == Status::Contact && values[*i].abs() > limit);
        self.over_limit
            .iter()
            .copied()
            .max_by(|i, j| values[*i].abs().total_cmp(&values[*j].abs()).then(j.cmp(i)))
    }
}
