//! Loading and unloading: one loading path to the greatest load, and an unloading path from every turning point on it.
//!
//! The loop begins before the first jump-in and ends with the last separation, so its area is the whole loss `Θ = ∮F dΔ`.

use super::PhysicsError;
use super::events::Kind;
use super::path::{Event, Path};
use super::state::{Problem, State, Status};
use crate::model::KeptContacts;

/// What a cycle is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Turning points `F/(E* A0)`, ascending.
    pub max_loads: Vec<f64>,
    /// Step of the approach, of the rms height.
    pub approach_step: f64,
    /// Which steps keep their spots.
    pub contacts: KeptContacts,
}

/// The sense of the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
#[derive(Debug, Clone, PartialEq)]
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
    /// Events since the step before, by kind: jump-in, jump-off, cover, uncover, snap.
    pub event_counts: [usize; 5],
    /// Energy lost in them \[J\].
    pub dissipated_j: f64,
    /// `∫F dΔ` since the branch began \[J\].
    pub work_j: f64,
    /// Worst residual \[m\].
    pub residual_m: f64,
    /// Newton and relaxation iterations since the step before.
    pub iterations: u64,
    /// Pair fields evaluated since the step before.
    pub pairs: u64,
}

/// A spot at a kept step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Number of the step.
    pub step: usize,
    /// The asperity.
    pub asperity: usize,
    /// Whether it is under a greater spot.
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

/// A cycle: every step, the kept spots, and the events with the step that they belong to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cycle {
    /// Steps; the number of a step is its place.
    pub steps: Vec<Step>,
    /// Spots at the kept steps.
    pub contacts: Vec<Contact>,
    /// Events, and the number of their step.
    pub events: Vec<(usize, Event)>,
    /// For each turning point, its step and its state.
    pub turning: Vec<(usize, State)>,
}

/// Loads to the greatest of the loads, and unloads from each. `progress` is told how much is done, from 0 to 1.
///
/// # Errors
/// A load that is not reached within 100 rms heights; an approach without an equilibrium.
pub fn run(problem: &Problem, settings: &Settings, progress: &dyn Fn(f64)) -> Result<Cycle, PhysicsError> {
    let mut cycle = Cycle::default();
    load(problem, settings, &mut cycle, &|done| progress(0.5 * done))?;
    let branches = settings.max_loads.len() as f64;
    for (k, max_load) in settings.max_loads.iter().enumerate() {
        let state = cycle.turning[k].1.clone();
        unload(problem, settings, *max_load, state, &mut cycle, &|done| progress(0.5 + 0.5 * (k as f64 + done) / branches))?;
    }
    Ok(cycle)
}

/// The steps lie on one grid of approaches, the same for both senses and for every turning point.
fn grid(problem: &Problem, settings: &Settings) -> f64 {
    settings.approach_step * problem.rms_height_m
}

fn load(problem: &Problem, settings: &Settings, cycle: &mut Cycle, progress: &dyn Fn(f64)) -> Result<(), PhysicsError> {
    let spacing = grid(problem, settings);
    let mut number = (problem.first_contact_m() / spacing).floor() - 1.0;
    let mut path = Path::new(problem, State::free(problem, number * spacing))?;
    let mut recorder = Recorder::new(Branch::Loading, None);
    recorder.record(problem, settings, &mut path, cycle, false);
    let last = settings.max_loads.last().copied().unwrap_or(0.0);
    let mut turns = settings.max_loads.iter();
    let mut turn = turns.next();
    while let Some(max_load) = turn {
        let target = (number + 1.0) * spacing;
        if path.advance(target, Some(max_load * problem.load_unit_n()))? {
            recorder.record(problem, settings, &mut path, cycle, true);
            cycle.turning.push((cycle.steps.len() - 1, path.node.state.clone()));
            turn = turns.next();
        } else {
            number += 1.0;
            recorder.record(problem, settings, &mut path, cycle, false);
        }
        let reached = path.node.totals.load_n / problem.load_unit_n();
        if target > 100.0 * problem.rms_height_m {
            return Err(PhysicsError::LoadNotReached { wanted: *max_load, reached, approach_m: target });
        }
        progress((reached / last).clamp(0.0, 1.0));
    }
    Ok(())
}

/// Unloads from a turning state to the last separation. The state is all that it needs.
fn unload(
    problem: &Problem,
    settings: &Settings,
    max_load: f64,
    state: State,
    cycle: &mut Cycle,
    progress: &dyn Fn(f64),
) -> Result<(), PhysicsError> {
    let spacing = grid(problem, settings);
    let start = state.approach_m;
    let mut path = Path::new(problem, state)?;
    let mut recorder = Recorder::new(Branch::Unloading, Some(max_load));
    recorder.record(problem, settings, &mut path, cycle, false);
    let mut number = (start / spacing).ceil();
    let full = path.node.totals.area_m2;
    while !path.node.state.contacts.is_empty() {
        number -= 1.0;
        path.advance(number * spacing, None)?;
        recorder.record(problem, settings, &mut path, cycle, false);
        progress(1.0 - path.node.totals.area_m2 / full);
    }
    Ok(())
}

/// Writes the steps of one branch down.
struct Recorder {
    branch: Branch,
    max_load: Option<f64>,
    events_before: usize,
    iterations_before: u64,
    pairs_before: u64,
}

impl Recorder {
    fn new(branch: Branch, max_load: Option<f64>) -> Self {
        Self { branch, max_load, events_before: 0, iterations_before: 0, pairs_before: 0 }
    }

    fn record(&mut self, problem: &Problem, settings: &Settings, path: &mut Path<'_>, cycle: &mut Cycle, turning: bool) {
        let number = cycle.steps.len();
        let least_load_n = path.take_least_load();
        let recent = &path.events[self.events_before..];
        let count = |kind: Kind| recent.iter().filter(|event| event.kind == kind).count();
        let node = &path.node;
        let effort = path.effort();
        cycle.steps.push(Step {
            branch: self.branch,
            max_load: self.max_load,
            approach_m: node.state.approach_m,
            load_n: node.totals.load_n,
            least_load_n,
            area_m2: node.totals.area_m2,
            area_union_m2: super::union::area(problem, &node.state),
            contact_count: node.state.contacts.len(),
            covered_count: node.state.covered_count(),
            touching_count: touching(problem, &node.state),
            held_count: path.held.len(),
            event_counts: [Kind::JumpIn, Kind::JumpOff, Kind::Cover, Kind::Uncover, Kind::Snap].map(count),
            dissipated_j: recent.iter().map(|event| event.energy_lost_j).sum(),
            work_j: path.work_j,
            residual_m: node.state.residual_m,
            iterations: effort.iterations - self.iterations_before,
            pairs: effort.pairs - self.pairs_before,
        });
        cycle.events.extend(recent.iter().map(|event| (number, *event)));
        self.events_before = path.events.len();
        self.iterations_before = effort.iterations;
        self.pairs_before = effort.pairs;
        let keep = match settings.contacts {
            KeptContacts::All => true,
            KeptContacts::Turning => turning,
            KeptContacts::None => false,
        };
        if keep {
            cycle.contacts.extend(spots_of(problem, &node.state, number));
        }
    }
}

/// How many spots touch another one.
fn touching(problem: &Problem, state: &State) -> usize {
    let greatest = state.contacts.iter().map(|&i| state.radius[i]).fold(0.0, f64::max);
    let touches = |i: usize| {
        let a = state.radius[i];
        let mut found = false;
        problem.neighbours.within(&problem.positions, i, a + greatest, |r, j| found |= state.radius[j] > 0.0 && r < a + state.radius[j]);
        found
    };
    state.contacts.iter().filter(|i| touches(**i)).count()
}

fn spots_of(problem: &Problem, state: &State, step: usize) -> Vec<Contact> {
    let mut spots: Vec<Contact> = state
        .contacts
        .iter()
        .zip(&state.displacement)
        .map(|(&i, w)| {
            let (asperity, a) = (&problem.asperities[i], state.radius[i]);
            Contact {
                step,
                asperity: i,
                covered: false,
                contact_radius_m: a,
                load_n: asperity.load(a),
                penetration_m: Some(asperity.penetration(a)),
                interaction_m: Some(*w),
            }
        })
        .collect();
    let covered = state.status.iter().enumerate().filter(|(_, status)| matches!(status, Status::Covered { .. }));
    spots.extend(covered.map(|(i, _)| Contact {
        step,
        asperity: i,
        covered: true,
        contact_radius_m: 0.0,
        load_n: 0.0,
        penetration_m: None,
        interaction_m: None,
    }));
    spots.sort_by_key(|spot| spot.asperity);
    spots
}
