//! Tables of a cycle: steps, contacts and events.

use crate::contact::event::Event;
use crate::contact::merged_spot::Merged;
use crate::contact::state::State;
use crate::event_kind::EventCounts;
use crate::half_space::Effort;
use crate::model::KeptContacts;
use serde::{Deserialize, Serialize};

/// Settings of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Loads `F/(E* A0)` at the load reversals, ascending.
    pub max_loads: Vec<f64>,
    /// Step of mean penetration over the rms height.
    pub approach_step: f64,
    /// Selection of the steps at which spots are stored.
    pub contacts: KeptContacts,
    /// Interval of mean penetration, in rms heights, between checkpoints.
    ///
    /// `None` for a run without checkpoints.
    /// At a checkpoint the path restarts from the stored state, so that another process can continue it.
    pub rest_every: Option<f64>,
}

/// Sense of the path: loading or unloading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Branch {
    /// Increasing mean penetration.
    Loading,
    /// Decreasing mean penetration.
    Unloading,
}

impl Branch {
    /// Name in the tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Loading => "loading",
            Self::Unloading => "unloading",
        }
    }
}

/// Numbers of contacts and events of one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepCounts {
    /// Contact spots.
    pub contacts: usize,
    /// Absorbed asperities.
    pub covered: usize,
    /// Spots that overlap another one.
    pub touching: usize,
    /// Frozen asperities, which alternated between states.
    pub held: usize,
    /// Events since the step before.
    pub events: EventCounts,
}

/// Accuracy and effort of one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepNumerics {
    /// Largest residual \[m\].
    pub residual_m: f64,
    /// Largest residual of the global problem before a global solve, since the step before \[m\].
    pub drift_m: f64,
    /// Smallest eigenvalue of the tangent, as in [`State::stability`].
    pub stability: f64,
    /// Computational effort since the step before.
    pub effort: Effort,
}

/// Contact quantities at one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Loading or unloading.
    pub branch: Branch,
    /// Maximum load `F/(E* A0)` at the reversal before this unloading.
    ///
    /// `None` while loading.
    pub max_load: Option<f64>,
    /// Mean penetration Δ \[m\], 0 at the highest summit.
    pub approach_m: f64,
    /// Load F \[N\], positive in compression.
    pub load_n: f64,
    /// Smallest load since the step before, events included \[N\].
    pub least_load_n: f64,
    /// Area Σπa² \[m²\].
    pub area_m2: f64,
    /// Area of the union of the discs \[m²\].
    pub area_union_m2: f64,
    /// Numbers of contacts and events.
    pub counts: StepCounts,
    /// Energy dissipated in these events \[J\].
    pub dissipated_j: f64,
    /// `∫F dΔ` since the branch began \[J\].
    pub work_j: f64,
    /// Accuracy and effort.
    pub numerics: StepNumerics,
}

/// Contact spot or absorbed asperity at a stored step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Number of the step.
    pub step: usize,
    /// The asperity.
    pub asperity: usize,
    /// True if it is absorbed by a larger spot.
    pub covered: bool,
    /// Contact radius \[m\]; 0 if absorbed.
    pub contact_radius_m: f64,
    /// Load \[N\]; 0 if absorbed.
    pub load_n: f64,
    /// Local penetration \[m\]; `None` if absorbed.
    pub penetration_m: Option<f64>,
    /// Displacement ŵ by the other spots \[m\]; `None` if absorbed.
    pub interaction_m: Option<f64>,
}

/// Merged spot, its number, and the step at which it was created.
///
/// Numbers follow those of the asperities of the surface. An unloading branch continues the numbers of its load reversal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MergedAt {
    /// Number of the step.
    pub step: usize,
    /// Number of the merged spot.
    pub asperity: usize,
    /// The merged spot.
    pub spot: Merged,
}

/// Results of a cycle: steps, stored spots, and events with the number of their step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Steps; the number of a step is its index.
    pub steps: Vec<Step>,
    /// Spots at the stored steps.
    pub contacts: Vec<Contact>,
    /// Number of the step, and event.
    pub events: Vec<(usize, Event)>,
    /// Merged spots, by branch in the order of their numbers.
    pub merged: Vec<MergedAt>,
    /// Step and state of each load reversal.
    pub turning: Vec<(usize, State)>,
    /// Load reversals without a result, by their place in the settings, with the error.
    #[serde(skip)]
    pub unreached: Vec<(usize, String)>,
}

impl Cycle {
    /// The unloading branch of a cycle with one load reversal, numbered from its first step.
    pub(crate) fn unloading_alone(self) -> Self {
        let loading = self.steps.iter().take_while(|step| step.branch == Branch::Loading).count();
        let rest = |step: usize| step.checked_sub(loading);
        Self {
            steps: self.steps[loading..].to_vec(),
            contacts: self.contacts.into_iter().filter_map(|c| Some(Contact { step: rest(c.step)?, ..c })).collect(),
            events: self.events.into_iter().filter_map(|(step, event)| Some((rest(step)?, event))).collect(),
            merged: self.merged.into_iter().filter_map(|m| Some(MergedAt { step: rest(m.step)?, ..m })).collect(),
            turning: Vec::new(),
            unreached: Vec::new(),
        }
    }

    /// Removes the steps from the first one of the unloading from a load on, which is the last branch.
    pub(super) fn remove_unloading(&mut self, max_load: f64) {
        let of = |step: &Step| step.max_load == Some(max_load);
        let Some(first) = self.steps.iter().position(of) else { return };
        self.steps.truncate(first);
        self.contacts.retain(|contact| contact.step < first);
        self.events.retain(|(step, _)| *step < first);
        self.merged.retain(|merged| merged.step < first);
    }
}
