//! Excursions: a second path through the last increment, to a state between its ends.

use super::equilibrium_path::EquilibriumPath;
use super::step_control::StepControl;
use crate::PhysicsError;
use crate::math::bracket::{End, Illinois};

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
        let steps = StepControl::new(self.numerics().steps, self.frame.sense, self.steps.longest(), 0);
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
            let closed = (high - low).abs() <= tolerance * self.problem().rms_height_m;
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

    /// The state of the last increment at a mean penetration or soon after it with a load of at least `load`
    /// \[N\]: an excursion may meet a jump a little later than the increment did. Without one, the state with
    /// the largest load.
    fn reaching(&mut self, mut at: f64, load: f64) -> Result<Self, PhysicsError> {
        let (end, sense) = (self.state().mean_penetration_m, self.frame.sense);
        let mut further = self.numerics().steps.load_tolerance * self.problem().rms_height_m;
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
