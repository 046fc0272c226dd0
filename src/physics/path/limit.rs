//! The limit on events within one increment of the approach: a contact whose events recur without end is an error.

use super::equilibrium_path::{Halt, Path};
use crate::physics::PhysicsError;

/// Changes of state within one increment of the approach, per asperity, beyond which the events have no end: [`super::equilibrium_path::FLIPS`] allows each asperity a few.
const MOST_EVENTS: usize = 20;

impl Path<'_> {
    /// Begins an increment of the approach: its events are counted from here.
    pub(super) fn limit_events(&mut self) {
        self.event_limit = self.log.events.len() + MOST_EVENTS * (self.problem().len() + 10);
    }

    /// Ends an increment of the approach whose events go on without end.
    pub(crate) fn check_event_count(&self, approach_m: f64, asperity: usize) -> Result<(), Halt> {
        let count = self.log.events.len();
        if count <= self.event_limit {
            return Ok(());
        }
        let events = MOST_EVENTS * (self.problem().len() + 10);
        Err(Halt::Error(PhysicsError::EndlessAvalanche { approach_m, events, asperity: self.problem().number(asperity) }))
    }
}
