//! Guard against asperities that change their status to and fro, and contacts that merge and split to and
//! fro.

use crate::asperities::contact::transition::Transition;
use serde::{Deserialize, Serialize};

/// Changes of each asperity within the present longest increment, and asperities that are frozen by it.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct ChatterGuard {
    changes: Vec<u8>,
    /// Asperities with a change that was not applied since the last record.
    frozen: Vec<usize>,
}

impl ChatterGuard {
    /// Makes room for `n` asperities.
    pub(super) fn grow(&mut self, n: usize) {
        self.changes.resize(n, 0);
    }

    /// Makes room for a merged contact, which goes on with the changes of its parts: it is a new one after
    /// every merging.
    pub(super) fn join(&mut self, parts: [usize; 2]) {
        self.changes.push(parts.map(|part| self.changes[part]).into_iter().max().unwrap_or(0));
        parts.iter().for_each(|part| self.count(*part));
    }

    /// True if a transition may be applied, where an asperity may change `most` times other than out of
    /// contact.
    pub(super) fn allows(&self, transition: &Transition, most: u8) -> bool {
        transition.limited_by().all(|i| self.changes[i] < most)
    }

    /// True if a transition may be applied; otherwise its asperity is frozen.
    pub(super) fn admit(&mut self, transition: &Transition, most: u8) -> bool {
        let allowed = self.allows(transition, most);
        if !allowed {
            self.freeze(transition.asperity);
        }
        allowed
    }

    /// Counts a change.
    pub(super) fn count(&mut self, i: usize) {
        self.changes[i] = self.changes[i].saturating_add(1);
    }

    /// Begins a longest increment.
    pub(super) fn restart(&mut self) {
        self.changes.fill(0);
    }

    /// Marks an asperity as frozen, once.
    pub(super) fn freeze(&mut self, i: usize) {
        if !self.frozen.contains(&i) {
            self.frozen.push(i);
        }
    }

    /// Number of frozen asperities since the last record.
    pub(crate) fn frozen_count(&self) -> usize {
        self.frozen.len()
    }

    /// Begins a record.
    pub(crate) fn clear_frozen(&mut self) {
        self.frozen.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::{ChatterGuard, Transition};
    use crate::asperities::numerics::Events;

    const MAX_CHANGES: u8 = Events::DEFAULT.changes_per_asperity;

    #[test]
    fn law_a_merged_contact_goes_on_with_the_changes_of_its_parts() {
        let mut guard = ChatterGuard::default();
        guard.grow(2);
        let merge = Transition::merge(0, 1);
        // Each merging of the same pair makes a new contact; its splitting is counted with it.
        for number in 2..2 + usize::from(MAX_CHANGES) {
            assert!(guard.allows(&merge, MAX_CHANGES));
            guard.join([0, 1]);
            let split = Transition::split(number);
            assert!(guard.allows(&split, MAX_CHANGES));
            guard.count(number);
        }
        assert!(!guard.allows(&merge, MAX_CHANGES));
    }

    #[test]
    fn law_an_asperity_is_frozen_after_its_changes_until_the_next_increment() {
        let mut guard = ChatterGuard::default();
        guard.grow(2);
        let change = |asperity| Transition::cover(asperity, 2);
        for _ in 0..MAX_CHANGES {
            assert!(guard.allows(&change(1), MAX_CHANGES));
            guard.count(1);
        }
        assert!(!guard.allows(&change(1), MAX_CHANGES) && guard.allows(&change(0), MAX_CHANGES));
        assert!(guard.allows(&Transition::jump_off(1), MAX_CHANGES));
        guard.freeze(1);
        guard.freeze(1);
        assert_eq!(guard.frozen_count(), 1);
        guard.restart();
        assert!(guard.allows(&change(1), MAX_CHANGES));
        guard.clear_frozen();
        assert_eq!(guard.frozen_count(), 0);
    }
}
