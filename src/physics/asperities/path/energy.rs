//! Energy balance of a path: work of the load, potential, and energy dissipated in events.
//!
//! Between two global solves `Π + Σ energy dissipated − work` is constant. The events and the work are in the
//! event log, and a whole branch is checked in `cycle::soundness`. Events are accounted for with the
//! potential of their local problem while the rest of the contact keeps its loads; the response of the rest
//! is known to first order (`expected_n`) until the next global solve measures it.

use super::event_log::EventLog;

/// State of the energy balance since the last global solve.
#[derive(Debug, Clone, Copy)]
pub(super) struct EnergyLedger {
    /// Number of events at the last global solve.
    events: usize,
    /// Mean penetration of the last global solve \[m\].
    at: f64,
    /// `Π − work` at the last global solve \[J\].
    balance: f64,
    /// If set, the last event is charged with the difference at the next global solve.
    open: bool,
    /// Change of the load that contacts will have when pending displacements are applied \[N\].
    expected_n: f64,
    /// Mean penetration up to which the work of that change is counted \[m\].
    expected_at: f64,
}

impl EnergyLedger {
    /// Ledger at a global solve at a mean penetration \[m\], with the number of events and the balance
    /// `Π − work` \[J\].
    pub(super) fn new(at: f64, events: usize, balance: f64) -> Self {
        Self { events, at, balance, open: false, expected_n: 0.0, expected_at: at }
    }

    /// Mean penetration of the last global solve \[m\].
    pub(super) fn at(&self) -> f64 {
        self.at
    }

    /// `Π − work` at the last global solve \[J\].
    pub(super) fn balance(&self) -> f64 {
        self.balance
    }

    /// Expected change of the load \[N\].
    pub(super) fn expected_n(&self) -> f64 {
        self.expected_n
    }

    /// Charges the last event with the difference at the next global solve.
    pub(super) fn charge_last_event(&mut self) {
        self.open = true;
    }

    /// Work of the expected change of the load up to a mean penetration \[J\]; from there on the change is
    /// larger by `more` \[N\].
    pub(super) fn expect_load(&mut self, mean_penetration: f64, more: f64) -> f64 {
        let work = self.expected_n * (mean_penetration - self.expected_at);
        self.expected_at = mean_penetration;
        self.expected_n += more;
        work
    }

    /// Takes the expected change of the load, since a global solve has measured it \[N\].
    pub(super) fn take_expected(&mut self) -> f64 {
        std::mem::take(&mut self.expected_n)
    }

    /// Closes the balance at a global solve with the potential \[J\], and opens the next one.
    pub(super) fn close(&mut self, log: &mut EventLog, mean_penetration: f64, potential: f64) {
        let dissipated: f64 = log.events[self.events..].iter().map(|event| event.energy_lost_j).sum();
        if std::mem::take(&mut self.open) {
            log.charge(self.balance - (potential + dissipated - log.work_j));
        }
        self.balance = potential - log.work_j;
        self.at = mean_penetration;
        self.events = log.events.len();
    }
}

#[cfg(test)]
mod tests {
    use super::EnergyLedger;
    use crate::asperities::contact::transition::Transition;
    use crate::asperities::path::event_log::EventLog;
    use crate::cycle::Totals;
    use crate::event_kind::SpotStatus;

    #[test]
    fn law_the_work_of_an_expected_load_is_counted_from_where_it_is_expected() {
        let mut ledger = EnergyLedger::new(1.0, 0, 0.0);
        assert_eq!(ledger.expect_load(2.0, 3.0), 0.0);
        assert_eq!(ledger.expect_load(4.0, -1.0), 6.0);
        assert_eq!(ledger.expect_load(5.0, 0.0), 2.0);
        assert_eq!((ledger.take_expected(), ledger.expected_n()), (2.0, 0.0));
    }

    #[test]
    fn law_an_open_balance_is_charged_to_the_last_event() {
        let mut log = EventLog::default();
        let mut ledger = EnergyLedger::new(0.0, 0, 10.0);
        log.begin_avalanche();
        log.record(&[(Transition::snap(0), SpotStatus::Contact)], 0.0, [Totals::default(); 2], 1.0);
        log.work_j = 2.0;
        ledger.charge_last_event();
        // Π + dissipated − work stays 10: with Π = 5 and 2 of work the event has dissipated 7.
        ledger.close(&mut log, 1.0, 5.0);
        assert_eq!(log.events[0].energy_lost_j, 7.0);
        assert_eq!((ledger.balance(), ledger.at()), (3.0, 1.0));
        // A closed balance charges nothing.
        ledger.close(&mut log, 2.0, 4.0);
        assert_eq!(log.events[0].energy_lost_j, 7.0);
    }
}
