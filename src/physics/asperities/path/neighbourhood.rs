//! Local problem around an event, and the shell of asperities next to it.
//!
//! The contacts of the local problem are solved together, with the displacement by all others to first order
//! in the mean penetration. Asperities of the shell receive the change of the field by the event: free ones
//! that may come near jump-in at once, contacts as a pending displacement.

use super::pending::PendingField;
use super::predictor::Predictor;
use crate::asperities::contact::neighbours::nearer;
use crate::asperities::contact::transition::Transition;
use crate::asperities::contact::{Problem, Status};
use crate::asperities::solve::local::{Extent, LocalProblem};
use crate::cycle::Effort;
use crate::model::Interaction;

/// Local problem of an event with its shell.
#[derive(Debug, Default)]
pub(super) struct Neighbourhood {
    /// The local problem.
    pub(super) local: LocalProblem,
    /// Contacts and free asperities around it.
    pub(super) shell: Vec<usize>,
    /// Radius of the shell \[m\].
    pub(super) reach: f64,
    /// Centre of the shell \[m\].
    pub(super) centre: [f64; 2],
    /// Pending displacements of the members \[m\].
    pub(super) to_apply: Vec<f64>,
    /// Radii of the members at the mean penetration `reference`, before the event was located \[m\].
    pub(super) origin: Vec<f64>,
    /// Mean penetration at which the members were known \[m\].
    pub(super) reference: f64,
}

/// Contact around an event, as it is known.
pub(super) struct Surroundings<'a> {
    pub(super) problem: &'a Problem,
    pub(super) predictor: &'a Predictor,
    pub(super) pending: &'a PendingField,
    /// Sense of the path.
    pub(super) sense: f64,
    /// Length scale \[m\].
    pub(super) scale: f64,
    /// Distance from jump-in within which free asperities take the change of the field \[m\]: farther ones
    /// are evaluated before they come near.
    pub(super) displaced: f64,
}

/// Members, free asperities among them, and the shell.
struct Selection {
    members: Vec<usize>,
    watched: Vec<usize>,
    shell: Vec<usize>,
    reach: f64,
}

impl Neighbourhood {
    /// Gathers the contacts nearest to a transition, at a mean penetration \[m\] or where they were known
    /// last.
    pub(super) fn gather(
        &mut self,
        within: &Surroundings<'_>,
        transition: &Transition,
        mean_penetration: Option<f64>,
        effort: &mut Effort,
    ) {
        let Surroundings { problem, predictor, pending, sense, .. } = within;
        self.centre = *problem.place(transition.by.unwrap_or(transition.asperity));
        let Selection { members, mut watched, shell, reach } = within.select(transition, &self.centre);
        (self.shell, self.reach) = (shell, reach);
        if transition.kind.begins_contact()
            && let Err(at) = watched.binary_search(&transition.asperity)
        {
            watched.insert(at, transition.asperity);
            self.shell.retain(|i| *i != transition.asperity);
        }
        let traces = &predictor.traces;
        let mean_penetration = mean_penetration.unwrap_or_else(|| {
            let asperity = transition.kind.begins_contact().then_some(transition.asperity);
            let known = members.iter().copied().chain(asperity).map(|i| traces[i].at);
            known
                .max_by(|u, v| (u * sense).total_cmp(&(v * sense)))
                .unwrap_or(predictor.state.mean_penetration_m)
        });
        let members: Vec<_> = members
            .into_iter()
            .map(|i| (i, traces[i], predictor.radius(problem, i, mean_penetration)))
            .collect();
        let watched: Vec<_> = watched.into_iter().map(|i| (i, traces[i])).collect();
        let extent = Extent::of(members.len(), predictor.state.contacts.len());
        self.local.gather(problem, &members, &watched, mean_penetration, extent, effort);
        self.to_apply.clear();
        self.to_apply.extend(self.local.members.iter().map(|member| pending.of(member.asperity)));
    }

    /// Stores the known radii and the mean penetration of the members, before an event is located.
    pub(super) fn set_origin(&mut self) {
        self.origin.clone_from(&self.local.radius);
        self.reference = self.local.mean_penetration;
    }
}

impl Surroundings<'_> {
    /// Chooses members, free asperities and shell around a place \[m\]; all lists ascend.
    fn select(&self, transition: &Transition, place: &[f64; 2]) -> Selection {
        let problem = self.problem;
        let (state, traces) = (&self.predictor.state, &self.predictor.traces);
        let alone = problem.rules.interaction == Interaction::None && problem.field.uniform() == 0.0;
        let limits = &problem.numerics.events;
        let most = if alone { 1 } else { limits.local_contacts };
        let span = limits.jump_in_distance * self.scale;
        let near_jump_in =
            |i: &usize| state.status[*i] == Status::Free && traces[*i].exceeds(problem.jump_in[*i] - span);
        if state.contacts.len() <= most {
            let watched = (0..problem.len()).filter(near_jump_in).collect();
            return Selection { members: state.contacts.clone(), watched, shell: Vec::new(), reach: 0.0 };
        }
        let count = most.saturating_mul(limits.shell_ratio);
        let mut near = problem
            .neighbours
            .nearest(place, count, state.contacts.len(), |i| state.status[i] == Status::Contact);
        let reach = near.iter().fold(0.0f64, |reach, (r, _)| reach.max(*r));
        let inner = near.select_nth_unstable_by(most - 1, nearer).1.0;
        let mut members: Vec<usize> = near[..most].iter().map(|(_, i)| *i).collect();
        for i in [Some(transition.asperity), transition.by].into_iter().flatten() {
            if state.status[i] == Status::Contact && !members.contains(&i) {
                members.push(i);
            }
        }
        members.sort_unstable();
        let (mut watched, mut shell) = (Vec::new(), Vec::new());
        if !alone {
            shell.extend(near[most..].iter().map(|(_, i)| *i).filter(|i| members.binary_search(i).is_err()));
            problem.neighbours.around(
                place,
                reach,
                |i| state.status[i] == Status::Free && traces[i].exceeds(problem.jump_in[i] - self.displaced),
                |r, i| {
                    if r <= inner && near_jump_in(&i) { &mut watched } else { &mut shell }.push(i);
                },
            );
        }
        watched.sort_unstable();
        shell.sort_unstable();
        Selection { members, watched, shell, reach }
    }
}
