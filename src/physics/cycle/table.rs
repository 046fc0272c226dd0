//! Rows of a cycle: steps, contacts and events.

use crate::model::KeptContacts;
use crate::physics::contact::event::Event;
use crate::physics::contact::merged_spot::Merged;
use crate::physics::contact::state::State;
use crate::physics::contact::transition::Kind;
use crate::physics::half_space::Effort;
use serde::{Deserialize, Serialize};

/// Settings of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Turning points `F/(E* A0)`, ascending.
    pub max_loads: Vec<f64>,
    /// Step of the approach, of the rms height.
    pub approach_step: f64,
    /// Which steps keep their spots.
    pub contacts: KeptContacts,
    /// Approaches, as multiples of so many rms heights, at which the path begins anew from what is to be kept of it, so that it may go on from there in
    /// another process; where there is none, it goes through.
    pub rest_every: Option<f64>,
}

/// The sense of the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Branch {
    /// Approach grows.
    Loading,
    /// Approach falls.
    Unloading,
}

impl Branch {
    /// The word in the tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Loading => "loading",
            Self::Unloading => "unloading",
        }
    }
}

/// The contact at one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Loading or unloading.
    pub branch: Branch,
    /// The turning point from which this unloading began; nothing while loading.
    pub max_load: Option<f64>,
    /// Approach δ \[m\], 0 at the highest summit.
    pub approach_m: f64,
    /// Load \[N\].
    pub load_n: f64,
    /// Least load since the step before, events included \[N\].
    pub least_load_n: f64,
    /// Area Σπa² \[m²\].
    pub area_m2: f64,
    /// Area of the union of the discs \[m²\].
    pub area_union_m2: f64,
    /// Spots in contact.
    pub contact_count: usize,
    /// Asperities under a greater spot.
    pub covered_count: usize,
    /// Spots that touch another one.
    pub touching_count: usize,
    /// Asperities held as they are, since they flipped between states.
    pub held_count: usize,
    /// Events since the step before, in the order of [`Kind::ALL`].
    pub event_counts: [usize; Kind::ALL.len()],
    /// Energy lost in them \[J\].
    pub dissipated_j: f64,
    /// `∫F dΔ` since the branch began \[J\].
    pub work_j: f64,
    /// Worst residual \[m\].
    pub residual_m: f64,
    /// Greatest residual that the whole contact had since the step before, before it was solved \[m\].
    pub drift_m: f64,
    /// Least eigenvalue of the tangent, as [`State::stability`] has it.
    pub stability: f64,
    /// Computational effort since the step before.
    pub effort: Effort,
}

/// A spot at a kept step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Number of the step.
    pub step: usize,
    /// The asperity.
    pub asperity: usize,
    /// True if it is under a greater spot.
    pub covered: bool,
    /// Contact radius \[m\]; 0 if covered.
    pub contact_radius_m: f64,
    /// Load \[N\]; 0 if covered.
    pub load_n: f64,
    /// Local penetration \[m\]; not known of a covered asperity.
    pub penetration_m: Option<f64>,
    /// Displacement by the others ŵ \[m\]; not known of a covered asperity.
    pub interaction_m: Option<f64>,
}

/// A merged spot, its number, and the number of the step to which its merging belongs. Numbers follow those of the summits; an unloading branch goes on
/// with those of its turning point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MergedAt {
    /// Number of the step.
    pub step: usize,
    /// Own number.
    pub asperity: usize,
    /// The spot.
    pub spot: Merged,
}

/// A cycle: every step, the kept spots, and the events with the step that they belong to.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Steps; the number of a step is its place.
    pub steps: Vec<Step>,
    /// Spots at the kept steps.
    pub contacts: Vec<Contact>,
    /// Events, and the number of their step.
    pub events: Vec<(usize, Event)>,
    /// Spots that became one, by branch in the order of their numbers.
    pub merged: Vec<MergedAt>,
    /// For each turning point, its step and its state.
    pub turning: Vec<(usize, State)>,
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
        }
    }
}
