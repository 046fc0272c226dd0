//! Displacements caused by events that are not yet in the penetrations of all asperities.
//!
//! An event changes the field everywhere. Next to it the change is known exactly and stored per contact (`near`). Far from it the change is
//! that of a point load (`far`), evaluated when the displacement of an asperity is needed. A local solve applies what its members have
//! pending; a global solve accounts for all of it.

use crate::physics::contact::{Problem, Status};
use crate::physics::solve::local::LocalProblem;

/// Distance over the reach of a far-field change beyond which it is uniform over a local problem.
const UNIFORM: f64 = 4.0;

/// Far-field change by an event: a point load at its centre.
#[derive(Debug, Clone, Copy)]
pub(super) struct Monopole {
    pub(super) place: [f64; 2],
    /// Distance within which the change is stored per contact instead \[m\].
    pub(super) reach: f64,
    /// Change of the load \[N\].
    pub(super) load_n: f64,
}

impl Monopole {
    /// True if the change at a place is not stored per contact.
    fn acts_on(&self, problem: &Problem, place: &[f64; 2]) -> bool {
        problem.neighbours.distance(place, &self.place) > self.reach
    }

    /// Displacement at a place \[m\].
    fn field(&self, problem: &Problem, place: &[f64; 2]) -> f64 {
        self.load_n * problem.material.compliance() * problem.neighbours.kernel(place, &self.place)
    }
}

/// Displacements that are pending since the last global solve.
#[derive(Debug, Clone)]
pub(super) struct PendingField {
    /// Pending displacement of each contact next to events \[m\].
    near: Vec<f64>,
    /// Far-field changes in their order.
    far: Vec<Monopole>,
    /// Number of far-field changes that are in the penetration of each asperity.
    applied: Vec<usize>,
    /// Contacts whose pending displacement has exceeded the limit.
    over_limit: Vec<usize>,
}

impl PendingField {
    /// Nothing pending for `n` asperities.
    pub(super) fn new(n: usize) -> Self {
        Self { near: vec![0.0; n], far: Vec::new(), applied: vec![0; n], over_limit: Vec::new() }
    }

    /// Makes room for `n` asperities.
    pub(super) fn grow(&mut self, n: usize) {
        self.near.resize(n, 0.0);
        self.applied.resize(n, 0);
    }

    /// Discards all pending displacements, since a global solve has accounted for them.
    pub(super) fn clear(&mut self) {
        self.near.fill(0.0);
        self.applied.fill(0);
        self.far.clear();
        self.over_limit.clear();
    }

    /// True if no event has changed the far field.
    pub(super) fn is_smooth(&self) -> bool {
        self.far.is_empty()
    }

    /// Adds a displacement \[m\] to a contact next to an event.
    pub(super) fn add_near(&mut self, i: usize, displacement: f64, limit: f64) {
        self.near[i] += displacement;
        if self.near[i].abs() > limit && !self.over_limit.contains(&i) {
            self.over_limit.push(i);
        }
    }

    /// Adds a far-field change.
    pub(super) fn add_far(&mut self, change: Monopole) {
        self.far.push(change);
    }

    /// Marks everything as applied to a contact.
    pub(super) fn set_applied(&mut self, i: usize) {
        self.near[i] = 0.0;
        self.applied[i] = self.far.len();
    }

    /// Marks the far field as applied to a free asperity.
    pub(super) fn set_far_applied(&mut self, i: usize) {
        self.applied[i] = self.far.len();
    }

    /// Discards the near displacement of an asperity that changes its status.
    pub(super) fn drop_near(&mut self, i: usize) {
        self.near[i] = 0.0;
    }

    /// Pending displacement of a contact, near and far \[m\].
    fn of(&self, problem: &Problem, i: usize) -> f64 {
        let place = problem.place(i);
        let far = self.far[self.applied[i]..].iter().filter(|change| change.acts_on(problem, place));
        self.near[i] + far.map(|change| change.field(problem, place)).sum::<f64>()
    }

    /// Pending displacements of contacts \[m\], by the number of the asperity; zero for all others.
    pub(super) fn of_contacts(&self, problem: &Problem, contacts: &[usize]) -> Vec<f64> {
        let mut all = vec![0.0; problem.len()];
        for &i in contacts {
            all[i] = self.of(problem, i);
        }
        all
    }

    /// Contact with the largest pending displacement, if that exceeds `limit` \[m\].
    pub(super) fn worst(&mut self, status: &[Status], limit: f64) -> Option<usize> {
        let near = &self.near;
        self.over_limit.retain(|i| status[*i] == Status::Contact && near[*i].abs() > limit);
        self.over_limit.iter().copied().max_by(|i, j| near[*i].abs().total_cmp(&near[*j].abs()).then(j.cmp(i)))
    }

    /// Pending displacements of the members of a local problem at `centre` \[m\], and of its free asperities.
    pub(super) fn of_local(&self, problem: &Problem, local: &LocalProblem, centre: &[f64; 2]) -> (Vec<f64>, Vec<f64>) {
        let mut members: Vec<f64> = local.members.iter().map(|member| self.near[member.asperity]).collect();
        let mut free = vec![0.0; local.watched.len()];
        let places = local.members.iter().chain(&local.watched);
        let oldest = places.map(|place| self.applied[place.asperity]).min().unwrap_or(0);
        for (number, change) in self.far.iter().enumerate().skip(oldest) {
            let uniform = problem.neighbours.distance(centre, &change.place) > UNIFORM * change.reach;
            let everywhere = if uniform { Some(change.field(problem, centre)) } else { None };
            let at = |i: usize| {
                let place = problem.place(i);
                let pending = self.applied[i] <= number && (uniform || change.acts_on(problem, place));
                if pending { everywhere.unwrap_or_else(|| change.field(problem, place)) } else { 0.0 }
            };
            for (sum, member) in members.iter_mut().zip(&local.members) {
                *sum += at(member.asperity);
            }
            for (sum, place) in free.iter_mut().zip(&local.watched) {
                *sum += at(place.asperity);
            }
        }
        (members, free)
    }
}
