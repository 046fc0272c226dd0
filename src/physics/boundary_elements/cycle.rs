//! Loading and unloading under displacement control, with the energy dissipated in every step.

use super::contact::{Attraction, Problem, State, Totals};
use super::minimise::{Accuracy, Minimiser};
use crate::physics::PhysicsError;

/// Settings of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Loads at which the path reverses \[E* dx²\], ascending.
    pub max_loads: Vec<f64>,
    /// Step of the approach \[dx\].
    pub step: f64,
    /// How often a step with an event is halved.
    pub halvings: u32,
    /// Accuracy of an equilibrium.
    pub accuracy: Accuracy,
}

/// An equilibrium on the path and the energy dissipated since the one before.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Step {
    /// Load reversal from which the step unloads; none while loading.
    pub reversal: Option<usize>,
    /// Approach Δ \[dx\].
    pub approach: f64,
    /// Load, energy and area.
    pub totals: Totals,
    /// Energy dissipated since the step before, `∫F dΔ − ΔΠ` \[E* dx³\].
    pub dissipated: f64,
    /// Iterations.
    pub iterations: usize,
    /// Transforms, those of refused attempts included.
    pub transforms: u64,
    /// Residual, of the maximum tension.
    pub residual: f64,
    /// Whether the accuracy was reached.
    pub converged: bool,
}

/// A path on its way.
struct Walk<'a> {
    problem: &'a Problem,
    settings: &'a Settings,
    minimiser: Minimiser,
    state: State,
    /// Displacement one step before and the approach that it belongs to, if no event lies between.
    before: Option<(f64, Vec<f64>)>,
    last: Step,
    dissipated: f64,
    level: u32,
    steps: Vec<Step>,
}

/// Loads to the largest of the loads and unloads from each. All steps, loading first.
///
/// # Errors
/// Not enough memory; a load that is not reached.
pub fn run(problem: &Problem, settings: &Settings) -> Result<Vec<Step>, PhysicsError> {
    let start = match problem.attraction {
        Attraction::Bonded { nucleation, .. } => -nucleation,
        Attraction::Range => -problem.law.end_gap(),
    };
    let mut state = problem.apart(start)?;
    if let Attraction::Bonded { .. } = problem.attraction {
        // The step before the first contact.
        state.approach = start - 1e-9;
    }
    let mut walk = Walk {
        problem,
        settings,
        minimiser: Minimiser::new(problem)?,
        state,
        before: None,
        last: Step { approach: start, ..Step::default() },
        dissipated: 0.0,
        level: 0,
        steps: Vec::new(),
    };
    walk.state.approach = start;
    walk.first()?;
    let mut turning = Vec::new();
    for (reversal, max_load) in settings.max_loads.iter().enumerate() {
        while walk.last.totals.load < *max_load {
            walk.advance(1.0, Some(*max_load))?;
            if walk.last.approach > 1e6 {
                return Err(PhysicsError::LoadNotReached {
                    wanted: *max_load,
                    reached: walk.last.totals.load,
                    approach_m: walk.last.approach,
                });
            }
            if (walk.last.totals.load / max_load - 1.0).abs() < LOAD_ACCURACY {
                break;
            }
        }
        turning.push((reversal, walk.state.clone(), walk.last));
    }
    for (reversal, state, last) in turning {
        walk.state = state;
        walk.before = None;
        walk.level = 0;
        walk.last = Step { reversal: Some(reversal), ..last };
        while !walk.is_apart() {
            walk.advance(-1.0, None)?;
        }
    }
    Ok(walk.steps)
}

/// Relative accuracy of the load at a reversal.
const LOAD_ACCURACY: f64 = 1e-6;

impl Walk<'_> {
    fn is_apart(&self) -> bool {
        match self.problem.attraction {
            Attraction::Bonded { .. } => self.last.totals.contact == 0,
            Attraction::Range => self.last.totals.contact == 0 && self.state.approach <= -self.problem.law.end_gap(),
        }
    }

    fn first(&mut self) -> Result<(), PhysicsError> {
        let mut state = self.state.clone();
        let step = self.equilibrium(&mut state, &Step { approach: self.state.approach, ..Step::default() })?;
        self.accept(state, step);
        Ok(())
    }

    /// Equilibrium of `state` at its approach with all contacts that form there; `from` is the step before.
    fn equilibrium(&mut self, state: &mut State, from: &Step) -> Result<Step, PhysicsError> {
        let before = self.minimiser.waves.transforms;
        let mut iterations = 0;
        let mut outcome;
        loop {
            outcome = self.minimiser.minimise(self.problem, state, self.settings.accuracy)?;
            iterations += outcome.iterations;
            if !self.problem.update_bonds(state, true) {
                break;
            }
        }
        let totals = self.problem.totals(state);
        self.problem.settle_bonds(state);
        let work = 0.5 * (from.totals.load + totals.load) * (state.approach - from.approach);
        Ok(Step {
            reversal: from.reversal,
            approach: state.approach,
            totals,
            dissipated: work - (totals.energy - from.totals.energy),
            iterations,
            transforms: self.minimiser.waves.transforms - before,
            residual: outcome.residual,
            converged: outcome.converged,
        })
    }

    /// Attempt at an approach, from the last state extrapolated.
    fn attempt(&mut self, approach: f64) -> Result<(State, Step), PhysicsError> {
        let mut state = self.state.clone();
        if let Some((at, displacement)) = &self.before {
            let ratio = (approach - state.approach) / (state.approach - at);
            for (to, from) in state.displacement.iter_mut().zip(displacement) {
                *to += ratio * (*to - from);
            }
        }
        state.approach = approach;
        let from = self.last;
        let step = self.equilibrium(&mut state, &from)?;
        Ok((state, step))
    }

    fn accept(&mut self, state: State, step: Step) {
        let quiet = step.dissipated.abs() <= self.threshold();
        let old = std::mem::replace(&mut self.state, state);
        self.before = (quiet && old.approach != self.state.approach).then_some((old.approach, old.displacement));
        self.dissipated += step.dissipated.max(0.0);
        self.last = step;
        self.steps.push(step);
    }

    /// Dissipated energy from which a step contains an event.
    fn threshold(&self) -> f64 {
        1e-3 * self.dissipated
    }

    /// One step along the path; one with an event is halved, one across `max_load` ends there.
    fn advance(&mut self, sense: f64, max_load: Option<f64>) -> Result<(), PhysicsError> {
        let mut spent = 0;
        loop {
            let length = sense * self.settings.step / f64::from(1_u32 << self.level);
            let (state, mut step) = self.attempt(self.state.approach + length)?;
            spent += step.transforms;
            let event = step.dissipated > self.threshold();
            if event && self.level < self.settings.halvings {
                self.level += 1;
                continue;
            }
            if let Some(max_load) = max_load.filter(|most| step.totals.load > *most) {
                let (state, mut step) = self.reach(max_load, (state, step))?;
                step.transforms += spent;
                self.accept(state, step);
                return Ok(());
            }
            step.transforms = spent;
            self.level = if event { self.settings.halvings.min(1) } else { self.level.saturating_sub(1) };
            self.accept(state, step);
            return Ok(());
        }
    }

    /// The equilibrium at `max_load` between the last state and one beyond it.
    fn reach(&mut self, max_load: f64, mut beyond: (State, Step)) -> Result<(State, Step), PhysicsError> {
        let (mut low, mut high) = ((self.last.approach, self.last.totals.load), (beyond.1.approach, beyond.1.totals.load));
        for _ in 0..40 {
            let part = ((max_load - low.1) / (high.1 - low.1)).clamp(0.02, 0.98);
            let approach = low.0 + part * (high.0 - low.0);
            beyond = self.attempt(approach)?;
            let load = beyond.1.totals.load;
            if (load / max_load - 1.0).abs() < LOAD_ACCURACY || (high.0 - low.0).abs() < 1e-12 {
                break;
            }
            if load > max_load { high = (approach, load) } else { low = (approach, load) }
        }
        Ok(beyond)
    }
}
