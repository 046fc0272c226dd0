//! Recording of a branch: steps at grid points and load reversals, and events.

use super::contact::event::Event as PathEvent;
use super::contact::problem::Problem;
use super::contact::state::{State, Status};
use super::path::EquilibriumPath;
use super::settings::{Cycle, Settings};
use crate::PhysicsError;
use crate::cycle::{Branch, Contact, Effort, Event, MergedAt, Site, Step, StepCounts, StepNumerics, Totals};
use crate::event_kind::{EventKind, SpotStatus};
use crate::model::KeptContacts;
use serde::{Deserialize, Serialize};

/// Reason for which a step is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StepReason {
    /// A point of the grid of mean penetrations, or the beginning or end of a branch.
    GridPoint,
    /// A load reversal.
    Reversal,
    /// The maximum tension so far under load control.
    PullOff,
}

/// Maximum tension of an unloading under load control, beyond which there is no equilibrium.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct PullOff {
    step: usize,
    load_n: f64,
    /// Potential of the contact \[J\].
    potential_j: f64,
    /// Mean penetration \[m\], and area \[m²\].
    mean_penetration_m: f64,
    area_m2: f64,
    /// Contacts, by the caller's numbers.
    contacts: Vec<usize>,
}

/// Records the steps of one branch.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Recorder {
    branch: Branch,
    max_load: Option<f64>,
    /// Number of the last grid point in the sense of the path; true after the first record.
    number: f64,
    begun: bool,
    events_before: usize,
    ways_before: usize,
    merged_before: usize,
    effort_before: Effort,
    /// Load of the last record \[N\]; most negative load of all records, with its spots.
    load_before: Option<f64>,
    pulled: Option<(f64, Vec<Contact>)>,
    /// Load at the beginning of the branch \[N\].
    load_begun: Option<f64>,
    pull_off: Option<PullOff>,
}

impl Recorder {
    /// Recorder of a branch that begins at grid point `number`, or between it and the next.
    ///
    /// `merged_before` is the number of merged spots at the beginning.
    pub(crate) fn new(branch: Branch, max_load: Option<f64>, number: f64, merged_before: usize) -> Self {
        let effort_before = Effort::default();
        Self {
            branch,
            max_load,
            number,
            begun: false,
            events_before: 0,
            ways_before: 0,
            merged_before,
            effort_before,
            load_before: None,
            pulled: None,
            load_begun: None,
            pull_off: None,
        }
    }

    /// True if events have happened since the last record.
    pub(crate) fn lacks_events(&self, path: &EquilibriumPath) -> bool {
        self.events_before < path.log().events.len()
    }

    /// Records the beginning, and the grid points passed in the last increment.
    pub(crate) fn grid_points(
        &mut self,
        settings: &Settings,
        path: &mut EquilibriumPath,
        cycle: &mut Cycle,
    ) -> Result<(), PhysicsError> {
        let end = path.state().mean_penetration_m;
        self.grid_points_until(end, settings, path, cycle)
    }

    fn grid_points_until(
        &mut self,
        end: f64,
        settings: &Settings,
        path: &mut EquilibriumPath,
        cycle: &mut Cycle,
    ) -> Result<(), PhysicsError> {
        if !std::mem::replace(&mut self.begun, true) {
            self.record(settings, path, None, cycle, StepReason::GridPoint);
        }
        let spacing = settings.grid(&path.problem());
        loop {
            let next = (self.number + 1.0) * path.sense() * spacing;
            if (next - end) * path.sense() > 1e-9 * spacing {
                return Ok(());
            }
            self.number += 1.0;
            if path.is_exact() && (next - path.state().mean_penetration_m).abs() <= 1e-9 * spacing {
                self.record(settings, path, None, cycle, StepReason::GridPoint);
            } else {
                let excursion = path.excursion(next)?;
                self.record(settings, path, Some(&excursion), cycle, StepReason::GridPoint);
            }
        }
    }

    /// True if the load has passed half of a maximum load since the last record, or zero during unloading.
    fn passes_landmark(&self, settings: &Settings, problem: &Problem, load: f64) -> bool {
        let Some(before) = self.load_before else { return false };
        match self.branch {
            Branch::Loading => settings
                .max_loads
                .iter()
                .any(|most| (before..load).contains(&(0.5 * most * problem.load_unit_n()))),
            Branch::Unloading => before > 0.0 && load <= 0.0,
        }
    }

    /// Ends the branch and keeps the spots at its maximum tensile load, where a load-controlled branch ends.
    pub(crate) fn end(self, cycle: &mut Cycle) {
        if let Some(pull_off) = self.pull_off {
            pull_off.end(cycle);
        }
        cycle.contacts.extend(self.pulled.map(|pulled| pulled.1).unwrap_or_default());
    }

    /// Records the maximum tension of the last increment under load control, if it is the largest so far.
    pub(crate) fn pull_off(
        &mut self,
        settings: &Settings,
        path: &mut EquilibriumPath,
        cycle: &mut Cycle,
    ) -> Result<(), PhysicsError> {
        let least = self.pull_off.as_ref().map_or(0.0, |pull_off| pull_off.load_n);
        let Some(found) = path.pull_off(least)? else { return Ok(()) };
        let (problem, state) = (found.problem(), found.state());
        self.grid_points_until(state.mean_penetration_m, settings, path, cycle)?;
        self.record(settings, path, Some(&found), cycle, StepReason::PullOff);
        let (totals, potential_j) = problem.totals(state);
        self.pull_off = Some(PullOff {
            step: cycle.steps.len() - 1,
            load_n: totals.load_n,
            potential_j: potential_j - problem.spring_energy_j(totals.load_n),
            mean_penetration_m: problem.mean_penetration_m(state.mean_penetration_m, totals.load_n),
            area_m2: totals.area_m2,
            contacts: state.contacts.iter().map(|i| problem.number(*i)).collect(),
        });
        Ok(())
    }

    /// Records a load reversal, at the path or at an excursion from it, and the grid points before it.
    pub(crate) fn turn(
        &mut self,
        settings: &Settings,
        path: &mut EquilibriumPath,
        excursion: Option<&EquilibriumPath>,
        cycle: &mut Cycle,
    ) -> Result<(), PhysicsError> {
        let state = excursion.map_or_else(|| path.state().clone(), |at| at.state().clone());
        self.grid_points_until(state.mean_penetration_m, settings, path, cycle)?;
        self.record(settings, path, excursion, cycle, StepReason::Reversal);
        cycle.turning.push((cycle.steps.len() - 1, state));
        Ok(())
    }

    /// Records the state of the path, or that of an excursion from it.
    pub(crate) fn record(
        &mut self,
        settings: &Settings,
        path: &mut EquilibriumPath,
        excursion: Option<&EquilibriumPath>,
        cycle: &mut Cycle,
        reason: StepReason,
    ) {
        let number = cycle.steps.len();
        let at = excursion.unwrap_or(path);
        let problem = &*at.problem();
        let state = at.state();
        let passed = |mean_penetration: f64| {
            excursion.is_none() || (mean_penetration - state.mean_penetration_m) * path.sense() <= 0.0
        };
        let recent: Vec<PathEvent> = path.log().events[self.events_before..]
            .iter()
            .take_while(|event| passed(event.mean_penetration_m))
            .copied()
            .collect();
        let ways: Vec<f64> = path.log().segments[self.ways_before..]
            .iter()
            .take_while(|way| passed(way.mean_penetration))
            .map(|way| way.least)
            .collect();
        let effort = path.effort();
        let load_n = at.totals().load_n;
        let begun_n = *self.load_begun.get_or_insert(load_n);
        let spring_j = problem.spring_energy_j(load_n) - problem.spring_energy_j(begun_n);
        let (drift_m, of_step) = (Some(path.log().drift_m), effort - self.effort_before);
        cycle.steps.push(Step {
            branch: self.branch,
            max_load: self.max_load,
            mean_penetration_m: problem.mean_penetration_m(state.mean_penetration_m, load_n),
            machine_displacement_m: (!problem.spring.holds_load).then_some(state.mean_penetration_m),
            load_n,
            least_load_n: ways.iter().copied().fold(load_n, f64::min),
            area_m2: at.totals().area_m2,
            area_union_m2: super::contact::union_area::area(problem, state),
            counts: counts(at, &recent),
            dissipated_j: recent.iter().map(|event| event.energy_lost_j).sum(),
            work_j: at.log().work_j - spring_j,
            numerics: StepNumerics { drift_m, effort: of_step, ..numerics(problem, state) },
        });
        self.events_before += recent.len();
        self.ways_before += ways.len();
        self.effort_before = effort;
        cycle.events.extend(recent.iter().map(|event| recorded(event, number, problem)));
        self.keep_spots(settings, at, cycle, reason);
        let merged = state.merged.iter().enumerate().skip(self.merged_before);
        cycle.merged.extend(merged.map(|(k, spot)| MergedAt {
            step: number,
            asperity: problem.summits() + k,
            spot: problem.outward(spot),
        }));
        self.merged_before = state.merged.len();
        path.begin_record();
    }

    /// Keeps the spots of the step that was recorded last, if the settings select it.
    fn keep_spots(
        &mut self,
        settings: &Settings,
        at: &EquilibriumPath,
        cycle: &mut Cycle,
        reason: StepReason,
    ) {
        let (problem, state, load, number) =
            (&*at.problem(), at.state(), at.totals().load_n, cycle.steps.len() - 1);
        let keep = match settings.contacts {
            KeptContacts::All => true,
            KeptContacts::Turning => {
                reason == StepReason::Reversal || self.passes_landmark(settings, problem, load)
            }
            KeptContacts::None => false,
        };
        if keep {
            cycle.contacts.extend(spots_of(problem, state, number));
        }
        let pulls = load < self.pulled.as_ref().map_or(0.0, |pulled| pulled.0);
        if settings.contacts == KeptContacts::Turning && self.branch == Branch::Unloading && pulls {
            // The spots of a kept step are stored already.
            self.pulled = Some((load, if keep { Vec::new() } else { spots_of(problem, state, number) }));
        }
        self.load_before = Some(load);
    }
}

impl PullOff {
    /// Ends a branch at its maximum tension: what follows is removed. All contacts leave there, and the last
    /// step is out of contact at the same mean penetration. The dissipated energy of that is the potential of
    /// the contact: the work of the load beyond is not a part of the loop.
    fn end(self, cycle: &mut Cycle) {
        let count = self.step + 1;
        cycle.steps.truncate(count);
        cycle.events.retain(|event| event.step < count);
        cycle.contacts.retain(|contact| contact.step < count);
        cycle.merged.retain(|merged| merged.step < count);
        let Some(last) = cycle.steps.last().cloned() else { return };
        let (from, left) =
            (Totals { load_n: self.load_n, area_m2: self.area_m2 }, Totals { load_n: 0.0, area_m2: 0.0 });
        let avalanche = cycle.events.last().map_or(0, |event| event.avalanche) + 1;
        let event = |(k, number): (usize, usize)| Event {
            step: count,
            kind: EventKind::JumpOff,
            site: Site::Asperity(number),
            status: Some(SpotStatus::Free),
            cause: EventKind::JumpOff,
            mean_penetration_m: self.mean_penetration_m,
            avalanche,
            before: if k == 0 { from } else { left },
            after: left,
            energy_lost_j: if k == 0 { self.potential_j } else { 0.0 },
        };
        let events: Vec<Event> = self.contacts.iter().copied().enumerate().map(event).collect();
        let counts = StepCounts {
            contacts: 0,
            covered: 0,
            touching: 0,
            held: 0,
            events: events.iter().map(|event| event.kind).collect(),
        };
        cycle.steps.push(Step {
            load_n: 0.0,
            least_load_n: self.load_n,
            area_m2: 0.0,
            area_union_m2: 0.0,
            counts,
            dissipated_j: self.potential_j,
            numerics: StepNumerics {
                residual_m: Some(0.0),
                drift_m: Some(0.0),
                stability: Some(1.0),
                effort: Effort::default(),
                ..last.numerics.clone()
            },
            ..last
        });
        cycle.events.extend(events);
    }
}

/// Accuracy of a state.
fn numerics(problem: &Problem, state: &State) -> StepNumerics {
    let tolerance_m = problem.numerics.solver.converged_residual * problem.unit_m;
    StepNumerics {
        is_converged: state.residual_m <= tolerance_m,
        residual_m: Some(state.residual_m),
        stability: Some(state.stability),
        ..StepNumerics::default()
    }
}

/// An event of a path as an event of a step.
fn recorded(event: &PathEvent, step: usize, problem: &Problem) -> Event {
    Event {
        step,
        kind: event.kind,
        site: Site::Asperity(problem.number(event.asperity)),
        status: Some(event.status),
        cause: event.cause,
        mean_penetration_m: problem.mean_penetration_m(event.mean_penetration_m, event.before.load_n),
        avalanche: event.avalanche,
        before: event.before,
        after: event.after,
        energy_lost_j: event.energy_lost_j,
    }
}

/// Numbers of contacts, and of the events since the step before.
fn counts(at: &EquilibriumPath, recent: &[PathEvent]) -> StepCounts {
    let state = at.state();
    StepCounts {
        contacts: state.contacts.len(),
        covered: state.covered_count(),
        touching: overlapping_count(&at.problem(), state),
        held: at.frozen_count(),
        events: recent.iter().map(|event| event.kind).collect(),
    }
}

/// Number of spots that overlap another one.
fn overlapping_count(problem: &Problem, state: &State) -> usize {
    let largest = state.largest_radius();
    let touches = |i: usize| {
        let a = state.radius[i];
        let mut found = false;
        problem
            .neighbours
            .within(i, a + largest, |r, j| found |= state.radius[j] > 0.0 && r < a + state.radius[j]);
        found
    };
    state.contacts.iter().filter(|i| touches(**i)).count()
}

fn spots_of(problem: &Problem, state: &State, step: usize) -> Vec<Contact> {
    let by_machine = problem.spring.machine_m_n * problem.totals(state).0.load_n;
    let mut spots: Vec<Contact> = state
        .contacts
        .iter()
        .zip(&state.displacement)
        .map(|(&i, w)| {
            let (asperity, a) = (&problem.asperities[i], state.radius[i]);
            Contact {
                step,
                asperity: Some(problem.number(i)),
                contact_radius_m: a,
                load_n: asperity.load(a),
                penetration_m: Some(asperity.penetration(a)),
                interaction_m: Some(if by_machine == 0.0 { *w } else { w - by_machine }),
                ..Contact::default()
            }
        })
        .collect();
    let covered =
        state.status.iter().enumerate().filter(|(_, status)| matches!(status, Status::Covered { .. }));
    spots.extend(covered.map(|(i, _)| Contact {
        step,
        asperity: Some(problem.number(i)),
        covered: true,
        ..Contact::default()
    }));
    spots.sort_by_key(|spot| spot.asperity);
    spots
}
