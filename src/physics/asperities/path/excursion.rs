//! Excursions: a second path through the last increment, to a state between its ends.

use super::equilibrium_path::EquilibriumPath;
use super::step_control::StepControl;
use crate::PhysicsError;
use crate::math::bracket::{End, Illinois};

/// Relative load above the smallest one so far up to which a lower one is looked for: with the machine of
/// load control the contact goes on beyond the minimum, until `1 + c dF/dΔ = 0`.
const NEAR_PULL_OFF: f64 = 1e-3;

/// Maximum number of excursions that locate a pull-off.
const PULL_OFF_TRIALS: usize = 60;

/// Part of the last increment in which the load passes a value.
struct Crossing {
    /// Mean penetrations at its ends \[m\].
    ends: [f64; 2],
    /// Load above the value at its ends \[N\].
    excess: [f64; 2],
}

impl EquilibriumPath {
    /// A path from before the last increment to `target` within it; its effort is counted here.
    pub(crate) fn excursion(&mut self, target: f64) -> Result<Self, PhysicsError> {
        let steps = StepControl::new(self.problem().increments(), self.frame.sense, self.steps.longest(), 0);
        let mut other = Self::new(self.problem(), self.predictor.clone(), self.frame, steps);
        match self.checkpoint.as_deref() {
            Some(checkpoint) => other.restore(checkpoint),
            None => other.restore(&self.checkpoint()),
        }
        other.chatter.clear_frozen();
        while other.state().mean_penetration_m != target {
            other.step(Some(target))?;
        }
        self.solver.effort += other.effort();
        Ok(other)
    }

    /// The part of the last increment in which the load reaches `load` \[N\].
    fn crossing(&self, load: f64) -> Option<Crossing> {
        let checkpoint = self.checkpoint.as_deref()?;
        let mut before = (checkpoint.state().mean_penetration_m, checkpoint.totals.load_n);
        for segment in &self.log.segments[checkpoint.segments..] {
            if segment.load >= load {
                return Some(Crossing {
                    ends: [before.0, segment.mean_penetration],
                    excess: [before.1 - load, segment.load - load],
                });
            }
            before = (segment.mean_penetration, segment.load);
        }
        None
    }

    /// The first state of the last increment with a load \[N\], on an excursion; none where only the
    /// predictor had it.
    pub(crate) fn turning(&mut self, load: f64) -> Result<Option<Self>, PhysicsError> {
        if self.checkpoint.is_none() && self.totals.load_n >= load {
            return self.excursion(self.state().mean_penetration_m).map(Some);
        }
        let Some(Crossing { ends: [mut low, mut high], excess: [under, over] }) = self.crossing(load) else {
            return Ok(None);
        };
        let tolerance = self.numerics().steps.load_tolerance;
        let mut ends = Illinois::new(under, over);
        for _ in 0..100 {
            let middle = low + ends.share(0.01) * (high - low);
            let trial = self.excursion(middle)?;
            let off = trial.totals.load_n - load;
            // A load that jumps over the value reverses where it jumps.
            let closed = (high - low).abs() <= tolerance * self.problem().unit_m;
            if off.abs() <= tolerance * load.abs() || (closed && off >= 0.0) {
                return Ok(Some(trial));
            }
            if closed {
                break;
            }
            if off < 0.0 {
                low = middle;
                ends.narrow(End::Low, off);
            } else {
                high = middle;
                ends.narrow(End::High, off);
            }
        }
        let found = self.reaching(high, load)?;
        Ok((found.totals.load_n >= load - tolerance * load.abs()).then_some(found))
    }

    /// The state of the last increment of an unloading at its smallest load, if that is tensile and below
    /// `least` \[N\] and the load rises again: the pull-off of a load-controlled contact.
    ///
    /// The load has a minimum between two events where its derivative vanishes, or just before an event at
    /// which it jumps.
    pub(crate) fn pull_off(&mut self, mut least: f64) -> Result<Option<Self>, PhysicsError> {
        let Some(checkpoint) = self.checkpoint.as_deref() else { return Ok(None) };
        let gap = self.numerics().events.position_tolerance * self.problem().unit_m;
        let mut high = checkpoint.state().mean_penetration_m;
        let mut ends: Vec<(f64, f64)> = self.log.events[checkpoint.events..]
            .iter()
            .map(|event| (event.mean_penetration_m, event.before.load_n))
            .collect();
        ends.dedup_by_key(|end| end.0);
        let events = ends.len();
        ends.push((self.state().mean_penetration_m, self.totals.load_n));
        let rises = self.predictor.load_rate_of_all() < 0.0;
        let mut found = None;
        for (k, (at, load)) in ends.into_iter().enumerate() {
            let is_event = k < events;
            let low = if is_event { at + gap } else { at };
            let is_low = load < 0.0 && load <= least + NEAR_PULL_OFF * least.abs();
            if is_low && (is_event || rises) && high - low > gap {
                let state = self.least_between([low, high], load, gap)?;
                if state.totals.load_n < least {
                    least = state.totals.load_n;
                    found = Some(state);
                }
            }
            high = at - gap;
        }
        Ok(found)
    }

    /// The state with the smallest load between two displacements \[m\] without an event, to a tolerance
    /// \[m\]. The load at the lower one is known \[N\]: an excursion may meet the event there a little
    /// earlier.
    fn least_between(
        &mut self,
        [mut low, mut high]: [f64; 2],
        load: f64,
        tolerance: f64,
    ) -> Result<Self, PhysicsError> {
        let (mut bottom, mut further) = (self.excursion(low)?, tolerance);
        while bottom.totals.load_n > load + NEAR_PULL_OFF * load.abs() && low + further < high {
            low += further;
            further *= 4.0;
            bottom = self.excursion(low)?;
        }
        let below = bottom.predictor.load_rate_of_all();
        if below >= 0.0 {
            return Ok(bottom);
        }
        let mut best = self.excursion(high)?;
        let above = best.predictor.load_rate_of_all();
        if above <= 0.0 {
            return Ok(best);
        }
        let mut ends = Illinois::new(below, above);
        for _ in 0..PULL_OFF_TRIALS {
            if high - low <= tolerance {
                break;
            }
            let middle = low + ends.share(0.02) * (high - low);
            let trial = self.excursion(middle)?;
            let rate = trial.predictor.load_rate_of_all();
            if rate < 0.0 {
                low = middle;
                ends.narrow(End::Low, rate);
            } else {
                high = middle;
                ends.narrow(End::High, rate);
            }
            if trial.totals.load_n < best.totals.load_n {
                best = trial;
            }
        }
        Ok(best)
    }

    /// The state of the last increment at a mean penetration or soon after it with a load of at least `load`
    /// \[N\]: an excursion may meet a jump a little later than the increment did. Without one, the state with
    /// the largest load.
    fn reaching(&mut self, mut at: f64, load: f64) -> Result<Self, PhysicsError> {
        let (end, sense) = (self.state().mean_penetration_m, self.frame.sense);
        let mut further = self.numerics().steps.load_tolerance * self.problem().unit_m;
        let mut best = self.excursion(at)?;
        while best.totals.load_n < load && at != end {
            further *= 4.0;
            at = if (end - at) * sense > further { at + sense * further } else { end };
            let trial = self.excursion(at)?;
            if trial.totals.load_n > best.totals.load_n {
                best = trial;
            }
        }
        Ok(best)
    }
}
