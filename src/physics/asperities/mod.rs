//! The asperity model of a height map, in SI units: asperities, contact problem and settings from a surface,
//! a material and options.
//!
//! [`Asperities::new`] finds the asperities; [`Asperities::run`](crate::cycle::Method::run) loads and unloads
//! them. Asperities are JKR contacts that interact through the elastic displacement [`field`] of the
//! half-space. The algorithm is at the head of [`path`].

mod constants;
pub mod contact;
mod cycle;
pub mod field;
pub mod numerics;
pub mod path;
mod probe;
mod recorder;
mod retrace;
mod settings;
pub(crate) mod solve;

use crate::cycle::Method;
use crate::model::{KeptContacts, Machine, Material, Probe};
use crate::surface::HeightMap;
use crate::surface::measured::find_measured;
use crate::surface::summits::{Summit, find_summits};
use crate::{LoopPosition, PhysicsError};
pub(crate) use constants::{PATH, SOLVERS};
use contact::{Problem, Rules, State};
pub use cycle::Checkpoint;
use cycle::{AsperityRun, unload_through};
pub use numerics::Numerics;
pub use probe::summits_on_probe;
pub use settings::{Cycle, Settings};

/// Versions of cycles of the asperity model.
const VERSIONS: &[(u32, &str)] = &[
    (7, "free asperities are followed from three length scales before jump-in"),
    (8, "equilibria and fast sums to 1e-8 rms heights"),
    (9, "local problems to 1e-7 rms heights with the contacts outside"),
];

/// Options of a cycle of the asperity model, with those of the program as default.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Options of the contact model.
    pub rules: Rules,
    /// Sphere that carries the asperities, if the surface is not flat.
    pub probe: Option<Probe>,
    /// Machine that moves the surface.
    pub machine: Machine,
    /// Step of mean penetration over the rms height, or over the JKR length of the probe. It does not change
    /// results, which are located between the steps.
    pub approach_step: f64,
    /// Steps of which the contact spots are kept.
    pub contacts: KeptContacts,
    /// Numerical choices.
    pub numerics: Numerics,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rules: Rules::default(),
            probe: None,
            machine: Machine::default(),
            approach_step: 0.01,
            contacts: KeptContacts::Turning,
            numerics: Numerics::DEFAULT,
        }
    }
}

/// A surface whose asperities are loaded and unloaded.
pub struct Asperities {
    /// Problem.
    pub problem: Problem,
    /// Settings.
    pub settings: Settings,
}

impl Asperities {
    /// The asperities of a surface, with loads `F/(E* A0)` at the load reversals, ascending.
    ///
    /// # Errors
    /// A surface without asperities or with too few points per shortest wavelength; Tabor parameters below 2
    /// with Wu's criterion.
    pub fn new(
        map: &HeightMap<'_>,
        material: &Material,
        max_loads: &[f64],
        options: &Options,
    ) -> Result<Self, PhysicsError> {
        let points = map.shortest_wavelength_m * map.heights_m.nrows() as f64 / map.length_m;
        let summits = if map.is_periodic {
            find_summits(map.heights_m, map.length_m, points)?.list
        } else {
            find_measured(map.square(), points)?.0.list
        };
        Self::of_summits(&summits, map.length_m, map.rms_height_m, material, max_loads, options)
    }

    /// Given asperities of a flat surface on a square of a side \[m\], with the rms height \[m\] of the
    /// surface; the options put them on a probe.
    ///
    /// # Errors
    /// No asperities; a radius of the probe that is not positive; a negative compliance; Tabor parameters
    /// below 2 with Wu's criterion.
    pub fn of_summits(
        summits: &[Summit],
        length_m: f64,
        rms_height_m: f64,
        material: &Material,
        max_loads: &[f64],
        options: &Options,
    ) -> Result<Self, PhysicsError> {
        check_compliance(options.machine.compliance_m_n)?;
        let Options { rules, probe, machine, approach_step, contacts, numerics } = *options;
        let on_probe = match probe {
            Some(probe) => summits_on_probe(summits, probe, length_m, rules.boundary)?,
            None => summits.to_vec(),
        };
        // Without adhesion the roughness sets the scale.
        let unit_m = probe.map(|probe| probe.jkr_length_m(material)).filter(|unit| *unit > 0.0);
        let problem = Problem::new(&on_probe, length_m, rms_height_m, *material, rules)?
            .with_unit(unit_m.unwrap_or(rms_height_m))
            .with_numerics(numerics);
        let most_load_n = max_loads.iter().copied().fold(0.0, f64::max) * problem.load_unit_n();
        let problem = problem.on_machine(&machine, most_load_n);
        let rest_every =
            (summits.len() >= numerics.steps.checkpoints_from).then_some(numerics.steps.checkpoint_interval);
        Ok(Self {
            problem,
            settings: Settings { max_loads: max_loads.to_vec(), approach_step, contacts, rest_every },
        })
    }
}

/// Refuses a compliance \[m/N\] that is negative or not a number.
fn check_compliance(value: f64) -> Result<(), PhysicsError> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(PhysicsError::Domain {
        action: "the contact on a machine",
        quantity: "the compliance of the machine [m/N]",
        value,
        allowed: "zero or a positive, finite number",
    })
}

impl Method for Asperities {
    type Checkpoint = Checkpoint;
    type State = State;

    const NAME: &'static str = "asperities";
    const VERSIONS: &'static [(u32, &'static str)] = VERSIONS;

    fn run_from(
        &self,
        checkpoint: Option<Checkpoint>,
        keep: &mut (dyn FnMut(&Checkpoint) + Send),
        progress: &(dyn Fn(LoopPosition) + Sync),
    ) -> Result<Cycle, PhysicsError> {
        AsperityRun::new(&self.problem, &self.settings, checkpoint).follow(keep, progress)
    }

    fn unload_from(&self, reversal: usize, state: State) -> Result<Cycle, PhysicsError> {
        let loads = &self.settings.max_loads;
        let unknown = PhysicsError::UnknownReversal { reversal, count: loads.len() };
        let max_load = *loads.get(reversal).ok_or(unknown)?;
        if self.problem.is_adhesionless() {
            // The state at the reversal does not hold the loading path, which the unloading repeats.
            let settings = Settings { max_loads: vec![max_load], ..self.settings.clone() };
            let whole = AsperityRun::new(&self.problem, &settings, None).follow(&mut |_| {}, &|_| {})?;
            return Ok(whole.unloading_alone());
        }
        let mut cycle = Cycle::default();
        unload_through(&self.problem, &self.settings, Some(max_load), state, &mut cycle)?;
        Ok(cycle)
    }

    fn size(&self) -> (&'static str, u64) {
        ("asperity_count", self.problem.len() as u64)
    }
}
