//! Unloading without adhesion: the loading path in reverse.
//!
//! At `Δγ = 0` the half-space is elastic and the contact has no memory: its state is a function of the mean
//! penetration alone. The loop encloses no area, and the unloading branch is the loading branch in reverse.
//! Each event is reversed at its mean penetration and returns its energy: Θ is exactly 0.

use super::settings::Cycle;
use crate::cycle::{Branch, Contact, Effort, Event, Step, StepCounts, StepNumerics};
use crate::event_kind::SpotStatus;
use crate::model::KeptContacts;
use std::collections::BTreeMap;

/// Appends the unloading from the `k`-th load reversal of a loading path without adhesion.
///
/// `max_load` is its `F/(E* A0)`, `None` under displacement control.
pub(crate) fn retrace(cycle: &mut Cycle, k: usize, max_load: Option<f64>, contacts: KeptContacts) {
    let reversal = cycle.turning[k].0;
    let others: Vec<usize> = cycle.turning[..k].iter().map(|(step, _)| *step).collect();
    let work_j = cycle.steps[reversal].work_j;
    let avalanches = cycle
        .events
        .iter()
        .filter(|event| event.step <= reversal)
        .map(|event| event.avalanche)
        .max()
        .unwrap_or(0);
    let mut reverse = undo(&cycle.events, reversal, avalanches);
    let mut pending: Vec<Event> = Vec::new();
    let mut least_load_n = f64::INFINITY;
    for at in (0..=reversal).rev() {
        let step = cycle.steps[at].clone();
        least_load_n = least_load_n.min(step.load_n);
        // Steps at smaller load reversals are not grid points of an unloading branch.
        if !others.contains(&at) {
            let number = cycle.steps.len();
            let undone: Vec<Event> = std::mem::take(&mut pending);
            cycle.steps.push(reversed(&step, max_load, &undone, least_load_n, work_j));
            cycle.events.extend(undone.into_iter().map(|event| Event { step: number, ..event }));
            if contacts == KeptContacts::All {
                let kept: Vec<Contact> = cycle
                    .contacts
                    .iter()
                    .filter(|c| c.step == at)
                    .map(|c| Contact { step: number, ..*c })
                    .collect();
                cycle.contacts.extend(kept);
            }
            least_load_n = step.load_n;
            if at < reversal && step.counts.contacts == 0 {
                return;
            }
        }
        pending.extend(std::iter::from_fn(|| reverse.pop_if(|event| event.step == at)));
    }
}

/// A loading step as a step of the unloading branch, with the events reversed since the step before it.
fn reversed(step: &Step, max_load: Option<f64>, undone: &[Event], least_load_n: f64, work_j: f64) -> Step {
    Step {
        branch: Branch::Unloading,
        max_load,
        least_load_n,
        counts: StepCounts {
            held: 0,
            events: undone.iter().map(|event| event.kind).collect(),
            ..step.counts.clone()
        },
        dissipated_j: undone.iter().map(|event| event.energy_lost_j).sum(),
        work_j: step.work_j - work_j,
        numerics: StepNumerics { drift_m: Some(0.0), effort: Effort::default(), ..step.numerics.clone() },
        ..step.clone()
    }
}

/// Events up to a step, each in reverse; avalanches are numbered along the branch.
fn undo(events: &[Event], last: usize, avalanches: u64) -> Vec<Event> {
    let mut known = BTreeMap::new();
    let reverse = |event: &Event| {
        let (kind, cause) = (event.kind.reversed(), event.cause.reversed());
        // Before its first event an asperity is free, and a merged contact is two.
        let first = if kind.is_merging() { SpotStatus::Split } else { SpotStatus::Free };
        let status = known.insert(event.asperity(), event.status).flatten().or(Some(first));
        let avalanche = avalanches + 1 - event.avalanche;
        let (before, after, energy_lost_j) = (event.after, event.before, -event.energy_lost_j);
        Event { kind, status, cause, avalanche, before, after, energy_lost_j, ..*event }
    };
    events.iter().filter(|event| event.step <= last).map(reverse).collect()
}
