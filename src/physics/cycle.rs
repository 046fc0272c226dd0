//! Loading and unloading: one loading path to the greatest load, and an unloading path from every turning point on it.
//!
//! The loop begins before the first jump-in and ends with the last separation, so its area is the whole loss `Θ = ∮F dΔ`.

use super::PhysicsError;
use super::events::Kind;
use super::interaction::Effort;
use super::log::Event;
use super::merge::Merged;
use super::path::{Carried, Depth, Path};
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
    /// What has been done since the step before.
    pub effort: Effort,
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

/// A merged spot, its number, and the number of the step to which its merging belongs. Numbers follow those of the summits; an unloading branch goes on
/// with those of its turning point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MergedAt {
    /// Number of the step.
    pub step: usize,
    /// Its own number.
    pub asperity: usize,
    /// The spot.
    pub spot: Merged,
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
    /// Spots that became one, by branch in the order of their numbers.
    pub merged: Vec<MergedAt>,
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
        unload(problem, settings, Some(*max_load), state, &mut cycle, &|done| progress(0.5 + 0.5 * (k as f64 + done) / branches))?;
    }
    Ok(cycle)
}

/// Unloads from a state that was kept at a turning point, `max_load` its `F/(E* A0)`: step by step what [`run`] does from there.
///
/// # Errors
/// An approach without an equilibrium.
pub fn unload_from(problem: &Problem, settings: &Settings, max_load: f64, state: State) -> Result<Cycle, PhysicsError> {
    let mut cycle = Cycle::default();
    unload(problem, settings, Some(max_load), state, &mut cycle, &|_| {})?;
    Ok(cycle)
}

/// Loads to the approach `turn` \[m\] and unloads from there, under displacement control alone: the load at the turn may be a tension. The
/// turning loads of the settings are not read; the unloading steps have none.
///
/// # Errors
/// An approach without an equilibrium.
pub fn run_to(problem: &Problem, settings: &Settings, turn: f64) -> Result<Cycle, PhysicsError> {
    let mut cycle = Cycle::default();
    let (state, number) = begin(problem, settings);
    let mut recorder = Recorder::new(settings, Branch::Loading, None, number);
    travel(problem, state, 1.0, Some(turn), &mut |path| {
        recorder.grid_points(path, &mut cycle)?;
        let there = path.state().approach_m >= turn;
        if there {
            recorder.turn(path, None, &mut cycle)?;
        }
        Ok(there)
    })?;
    let state = cycle.turning[0].1.clone();
    unload(problem, settings, None, state, &mut cycle, &|_| {})?;
    Ok(cycle)
}

/// The steps lie on one grid of approaches, the same for both senses and for every turning point.
fn grid(problem: &Problem, settings: &Settings) -> f64 {
    settings.approach_step * problem.rms_height_m
}

/// A point of the grid before the first jump-in: the state there, and the number of the point.
fn begin(problem: &Problem, settings: &Settings) -> (State, f64) {
    let spacing = grid(problem, settings);
    let number = (problem.first_contact_m() / spacing).floor() - 1.0;
    (State::free(problem, number * spacing), number)
}

fn load(problem: &Problem, settings: &Settings, cycle: &mut Cycle, progress: &dyn Fn(f64)) -> Result<(), PhysicsError> {
    let (state, number) = begin(problem, settings);
    let mut recorder = Recorder::new(settings, Branch::Loading, None, number);
    let last = settings.max_loads.last().copied().unwrap_or(0.0);
    let mut turns = settings.max_loads.iter().peekable();
    travel(problem, state, 1.0, None, &mut |path| {
        while let Some(max_load) = turns.peek() {
            let Some(turning) = path.turning(**max_load * problem.load_unit_n())? else { break };
            turns.next();
            recorder.turn(path, Some(&turning), cycle)?;
        }
        let Some(max_load) = turns.peek() else { return Ok(true) };
        recorder.grid_points(path, cycle)?;
        let (reached, approach_m) = (path.totals.load_n / problem.load_unit_n(), path.state().approach_m);
        if approach_m > 100.0 * problem.rms_height_m {
            return Err(PhysicsError::LoadNotReached { wanted: **max_load, reached, approach_m });
        }
        progress((reached / last).clamp(0.0, 1.0));
        Ok(false)
    })
}

/// Unloads from a turning state to the last separation. The state is all that it needs.
fn unload(
    problem: &Problem,
    settings: &Settings,
    max_load: Option<f64>,
    state: State,
    cycle: &mut Cycle,
    progress: &dyn Fn(f64),
) -> Result<(), PhysicsError> {
    let number = -(state.approach_m / grid(problem, settings)).ceil();
    let mut recorder = Recorder::new(settings, Branch::Unloading, max_load, number);
    recorder.merged_before = state.merged.len();
    let mut full = None;
    travel(problem, state, -1.0, None, &mut |path| {
        let full = *full.get_or_insert(path.totals.area_m2);
        recorder.grid_points(path, cycle)?;
        let over = path.state().contacts.is_empty();
        if over && recorder.events_before < path.log.events.len() {
            // The last spot has gone between two points of the grid.
            recorder.record(path, None, cycle, false);
        }
        progress(1.0 - path.totals.area_m2 / full);
        Ok(over)
    })
}

/// Goes along a branch from a state in equilibrium, in the sense `sign`, but not beyond `bound` \[m\]; spots merge and part on the way. At the beginning, after every
/// stretch and after every meeting `visit` is shown where the path is, and says whether that is the end.
fn travel(
    problem: &Problem,
    state: State,
    sign: f64,
    bound: Option<f64>,
    visit: &mut dyn FnMut(&mut Path<'_>) -> Result<bool, PhysicsError>,
) -> Result<(), PhysicsError> {
    let mut own = problem.grown(&state.merged)?;
    let mut known = own.as_ref().unwrap_or(problem).touching(&state);
    let mut carried = Carried::begin(problem, state, sign);
    loop {
        let mut path = Path::resume(own.as_ref().unwrap_or(problem), carried)?;
        path.settle_meeting();
        let meeting = loop {
            if visit(&mut path)? {
                return Ok(());
            }
            if let Some(meeting) = path.due_meeting(&mut known)? {
                break meeting;
            }
            let mut bound = bound;
            loop {
                path.stretch(bound)?;
                match path.meeting(&known)? {
                    Some(at) if at != path.state().approach_m => {
                        path.rewind();
                        bound = Some(at);
                    }
                    _ => break,
                }
            }
        };
        carried = path.carry();
        carried.meet(own.get_or_insert_with(|| problem.clone()), meeting, &mut known)?;
    }
}

/// Writes the steps of one branch down.
struct Recorder<'s> {
    settings: &'s Settings,
    branch: Branch,
    max_load: Option<f64>,
    /// Number of the last point of the grid, counted in the sense of the path; whether the beginning has been recorded.
    number: f64,
    begun: bool,
    events_before: usize,
    ways_before: usize,
    merged_before: usize,
    effort_before: Effort,
}

impl<'s> Recorder<'s> {
    fn new(settings: &'s Settings, branch: Branch, max_load: Option<f64>, number: f64) -> Self {
        let effort_before = Effort::default();
        Self { settings, branch, max_load, number, begun: false, events_before: 0, ways_before: 0, merged_before: 0, effort_before }
    }

    /// Records the points of the grid that the last stretch has passed, and the beginning.
    fn grid_points(&mut self, path: &mut Path<'_>, cycle: &mut Cycle) -> Result<(), PhysicsError> {
        let end = path.state().approach_m;
        self.grid_points_until(end, path, cycle)
    }

    fn grid_points_until(&mut self, end: f64, path: &mut Path<'_>, cycle: &mut Cycle) -> Result<(), PhysicsError> {
        if !std::mem::replace(&mut self.begun, true) {
            self.record(path, None, cycle, false);
        }
        let spacing = grid(path.problem(), self.settings);
        loop {
            let next = (self.number + 1.0) * path.sign * spacing;
            if (next - end) * path.sign > 1e-9 * spacing {
                return Ok(());
            }
            self.number += 1.0;
            if path.solved == Depth::Whole && (next - path.state().approach_m).abs() <= 1e-9 * spacing {
                self.record(path, None, cycle, false);
            } else {
                let excursion = path.excursion(next)?;
                path.solver.effort += excursion.effort();
                self.record(path, Some(&excursion), cycle, false);
            }
        }
    }

    /// Records a turning point, where the path is or on an excursion from it, and the points of the grid before it.
    fn turn(&mut self, path: &mut Path<'_>, excursion: Option<&Path<'_>>, cycle: &mut Cycle) -> Result<(), PhysicsError> {
        let state = excursion.map_or_else(|| path.state().clone(), |at| at.state().clone());
        self.grid_points_until(state.approach_m, path, cycle)?;
        self.record(path, excursion, cycle, true);
        cycle.turning.push((cycle.steps.len() - 1, state));
        Ok(())
    }

    /// Records the state of the path, or that of an excursion from it.
    fn record(&mut self, path: &mut Path<'_>, excursion: Option<&Path<'_>>, cycle: &mut Cycle, turning: bool) {
        let (number, problem) = (cycle.steps.len(), path.problem());
        let at = excursion.unwrap_or(path);
        let state = at.state();
        let passed = |approach: f64| excursion.is_none() || (approach - state.approach_m) * path.sign <= 0.0;
        let recent: Vec<Event> =
            path.log.events[self.events_before..].iter().take_while(|event| passed(event.approach_m)).copied().collect();
        let ways: Vec<f64> = path.log.ways[self.ways_before..].iter().take_while(|way| passed(way.approach)).map(|way| way.least).collect();
        let count = |kind: Kind| recent.iter().filter(|event| event.kind == kind).count();
        let effort = path.effort();
        cycle.steps.push(Step {
            branch: self.branch,
            max_load: self.max_load,
            approach_m: state.approach_m,
            load_n: at.totals.load_n,
            least_load_n: ways.iter().copied().fold(at.totals.load_n, f64::min),
            area_m2: at.totals.area_m2,
            area_union_m2: super::union::area(problem, state),
            contact_count: state.contacts.len(),
            covered_count: state.covered_count(),
            touching_count: touching(problem, state),
            held_count: at.held.len(),
            event_counts: Kind::ALL.map(count),
            dissipated_j: recent.iter().map(|event| event.energy_lost_j).sum(),
            work_j: at.log.work_j,
            residual_m: state.residual_m,
            drift_m: path.log.drift_m,
            stability: state.stability,
            effort: effort - self.effort_before,
        });
        self.events_before += recent.len();
        self.ways_before += ways.len();
        self.effort_before = effort;
        cycle.events.extend(recent.into_iter().map(|event| (number, Event { asperity: problem.number(event.asperity), ..event })));
        let keep = match self.settings.contacts {
            KeptContacts::All => true,
            KeptContacts::Turning => turning,
            KeptContacts::None => false,
        };
        if keep {
            cycle.contacts.extend(spots_of(problem, state, number));
        }
        let merged = state.merged.iter().enumerate().skip(self.merged_before);
        cycle.merged.extend(merged.map(|(k, spot)| MergedAt { step: number, asperity: problem.summits + k, spot: problem.outward(spot) }));
        self.merged_before = state.merged.len();
        path.log.drift_m = 0.0;
        path.held.clear();
    }
}

/// How many spots touch another one.
fn touching(problem: &Problem, state: &State) -> usize {
    let greatest = state.greatest_radius();
    let touches = |i: usize| {
        let a = state.radius[i];
        let mut found = false;
        problem.neighbours.within(i, a + greatest, |r, j| found |= state.radius[j] > 0.0 && r < a + state.radius[j]);
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
            let (asperity, a) = (state.asperity(problem, i), state.radius[i]);
            Contact {
                step,
                asperity: problem.number(i),
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
        asperity: problem.number(i),
        covered: true,
        contact_radius_m: 0.0,
        load_n: 0.0,
        penetration_m: None,
        interaction_m: None,
    }));
    spots.sort_by_key(|spot| spot.asperity);
    spots
}
