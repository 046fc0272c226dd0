//! Records of a cycle, for every method and in SI units: steps, contacts, events, maps and load reversals.

use super::effort::Effort;
use crate::LoopError;
use crate::event_kind::{EventCounts, EventKind, RegionChange, SpotStatus};
use serde::{Deserialize, Serialize};

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

/// Accuracy and effort of one step. A quantity that a method does not have is missing.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct StepNumerics {
    /// True for an equilibrium to the accuracy of the method.
    pub is_converged: bool,
    /// Largest residual \[m\].
    pub residual_m: Option<f64>,
    /// Largest residual of the global problem before a global solve, since the step before \[m\].
    pub drift_m: Option<f64>,
    /// Smallest eigenvalue of the tangent: 0 at a limit point.
    pub stability: Option<f64>,
    /// Root mean square of the residual, relative to the maximum tension.
    pub relative_residual: Option<f64>,
    /// Stiffness `dF/dΔ` between events \[N/m\].
    pub stiffness_n_m: Option<f64>,
    /// Computational effort since the step before.
    pub effort: Effort,
}

/// Load and area of a state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// Load F \[N\].
    pub load_n: f64,
    /// Area Σπa² \[m²\].
    pub area_m2: f64,
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
    pub mean_penetration_m: f64,
    /// Displacement of the machine `Δ + cF` \[m\], with the compliance c of its spring; missing under load
    /// control.
    pub machine_displacement_m: Option<f64>,
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

/// Contact spot or absorbed asperity at a stored step. A quantity that a method does not have is missing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Number of the step.
    pub step: usize,
    /// The asperity.
    pub asperity: Option<usize>,
    /// True if it is absorbed by a larger spot.
    pub covered: bool,
    /// Contact radius, or that of a disc of the same area \[m\]; 0 if absorbed.
    pub contact_radius_m: f64,
    /// Load \[N\]; 0 if absorbed.
    pub load_n: f64,
    /// Local penetration \[m\].
    pub penetration_m: Option<f64>,
    /// Displacement ŵ by the other spots \[m\].
    pub interaction_m: Option<f64>,
    /// Centre or centroid along x and y \[m\].
    pub centroid_m: Option<[f64; 2]>,
    /// Area, length of the edge and number of asperities of a region.
    pub region: Option<RegionShape>,
}

/// Shape of a connected region of contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RegionShape {
    /// Area \[m²\].
    pub area_m2: f64,
    /// Length of the edge \[m\].
    pub perimeter_m: f64,
    /// Number of asperities in it.
    pub summits: u32,
}

/// A sudden change of the contact, with its load, area and energy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Number of the step at or before which it happens.
    pub step: usize,
    /// Kind, by which it is counted.
    pub kind: EventKind,
    /// Asperity that changes state, or change of a region.
    pub site: Site,
    /// Status of the asperity afterwards; `None` for a region.
    pub status: Option<SpotStatus>,
    /// Kind of the event that causes the relaxation in which it happens. For a region the kind itself.
    pub cause: EventKind,
    /// Mean penetration Δ \[m\].
    pub mean_penetration_m: f64,
    /// Number of its avalanche, increasing along the branch.
    pub avalanche: u64,
    /// Load and area before.
    pub before: Totals,
    /// Load and area after.
    pub after: Totals,
    /// Dissipated energy: decrease of the potential \[J\].
    pub energy_lost_j: f64,
}

/// Place of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Site {
    /// An asperity, by its number.
    Asperity(usize),
    /// A region, by what happens to it.
    Region(RegionChange),
}

impl Event {
    /// Word of the kind in the tables.
    #[must_use]
    pub fn word(&self) -> &'static str {
        self.word_of(self.kind)
    }

    /// Word of the cause in the tables.
    #[must_use]
    pub fn cause_word(&self) -> &'static str {
        self.word_of(self.cause)
    }

    fn word_of(&self, kind: EventKind) -> &'static str {
        match self.site {
            Site::Asperity(_) => kind.word(),
            Site::Region(change) => change.word(),
        }
    }

    /// The asperity, if it happens at one.
    #[must_use]
    pub fn asperity(&self) -> Option<usize> {
        if let Site::Asperity(number) = self.site { Some(number) } else { None }
    }
}

/// Gap and pressure at a step, at every `stride`-th grid point along both sides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Number of the step.
    pub step: usize,
    /// Distance of two points along a side, in grid points.
    pub stride: usize,
    /// True for a further map along a branch, not at a load reversal or at the maximum tensile load.
    pub is_further: bool,
    /// Gap \[m\].
    pub gap_m: Vec<f32>,
    /// Pressure, compression positive \[Pa\].
    pub pressure_pa: Vec<f32>,
}

/// A merged spot, which replaces two contact spots.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Merged {
    /// Parts: asperities of the surface, or merged spots themselves.
    pub parts: [usize; 2],
    /// Contact radii of the parts at merging \[m\].
    pub radii_m: [f64; 2],
    /// Centre \[m\].
    pub place_m: [f64; 2],
    /// Radius of curvature R \[m\].
    pub radius_m: f64,
    /// Height relative to the highest asperity \[m\], without the difference fields of other merged contacts.
    pub height_m: f64,
    /// Constant of its potential \[J\].
    pub offset_j: f64,
    /// Contact radius at which the spot splits \[m\].
    pub release_m: f64,
    /// Mean penetration at merging \[m\].
    pub mean_penetration_m: f64,
}

impl Merged {
    /// Contact radius of the spot at merging \[m\].
    #[must_use]
    pub fn contact_radius_m(&self) -> f64 {
        self.radii_m[0].hypot(self.radii_m[1])
    }

    /// This contact at another size of both parts.
    pub(crate) fn scaled(&self, share: f64) -> Self {
        Self { radii_m: self.radii_m.map(|a| share * a), ..*self }
    }
}

/// Merged spot, its number, and the step at which it was created.
///
/// Numbers follow those of the asperities of the surface. An unloading branch continues the numbers of its
/// load reversal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MergedAt {
    /// Number of the step.
    pub step: usize,
    /// Number of the merged spot.
    pub asperity: usize,
    /// The merged spot.
    pub spot: Merged,
}

/// Results of a cycle, with the states of its method at the load reversals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cycle<S> {
    /// Steps; the number of a step is its index.
    pub steps: Vec<Step>,
    /// Spots at the stored steps.
    pub contacts: Vec<Contact>,
    /// Events.
    pub events: Vec<Event>,
    /// Merged spots, by branch in the order of their numbers.
    pub merged: Vec<MergedAt>,
    /// Maps, of a method that has them.
    pub maps: Vec<Map>,
    /// Step and state of each load reversal, sufficient to unload from there.
    pub turning: Vec<(usize, S)>,
    /// Load reversals without a result, by their place in the settings, with the error.
    #[serde(skip)]
    pub unreached: Vec<(usize, LoopError)>,
}

impl<S> Default for Cycle<S> {
    fn default() -> Self {
        Self {
            steps: Vec::new(),
            contacts: Vec::new(),
            events: Vec::new(),
            merged: Vec::new(),
            maps: Vec::new(),
            turning: Vec::new(),
            unreached: Vec::new(),
        }
    }
}

impl<S> Cycle<S> {
    /// The cycle without the states, which the method alone reads.
    #[must_use]
    pub fn without_states(self) -> Cycle<()> {
        let Self { steps, contacts, events, merged, maps, turning, unreached } = self;
        let turning = turning.into_iter().map(|(step, _)| (step, ())).collect();
        Cycle { steps, contacts, events, merged, maps, turning, unreached }
    }
}

impl<S> Cycle<S> {
    /// The unloading branch of a cycle with one load reversal, numbered from its first step.
    pub(crate) fn unloading_alone(self) -> Self {
        let loading = self.steps.iter().take_while(|step| step.branch == Branch::Loading).count();
        let rest = |step: usize| step.checked_sub(loading);
        Self {
            steps: self.steps[loading..].to_vec(),
            contacts: self
                .contacts
                .into_iter()
                .filter_map(|c| Some(Contact { step: rest(c.step)?, ..c }))
                .collect(),
            events: self
                .events
                .into_iter()
                .filter_map(|e| Some(Event { step: rest(e.step)?, ..e }))
                .collect(),
            merged: self
                .merged
                .into_iter()
                .filter_map(|m| Some(MergedAt { step: rest(m.step)?, ..m }))
                .collect(),
            ..Self::default()
        }
    }

    /// Removes the steps from the first one of the unloading from a load on, which is the last branch.
    pub(crate) fn remove_unloading(&mut self, max_load: f64) {
        let of = |step: &Step| step.max_load == Some(max_load);
        let Some(first) = self.steps.iter().position(of) else { return };
        self.steps.truncate(first);
        self.contacts.retain(|contact| contact.step < first);
        self.events.retain(|event| event.step < first);
        self.merged.retain(|merged| merged.step < first);
    }
}
