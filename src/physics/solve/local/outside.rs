//! Effect of a local problem on the contacts outside it, and of these on its load.

use super::{LocalProblem, OutsideField};
use crate::physics::contact::problem::Problem;
use crate::physics::jkr::Asperity;

/// Member before a change.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReferenceState {
    pub(crate) asperity: usize,
    pub(crate) sphere: Asperity,
    /// Radius \[m\].
    pub(crate) radius: f64,
    /// Expected change of the radius \[m\].
    pub(crate) more: f64,
}

impl ReferenceState {
    /// Expected load \[N\].
    fn load(&self) -> f64 {
        let (sphere, was) = (&self.sphere, self.radius);
        sphere.load(was) + self.more * sphere.load_slope(was)
    }
}

/// Member as a source for the outside: present state, state before, and load beyond the expected one \[N\].
struct Source {
    asperity: usize,
    now: Option<(Asperity, f64)>,
    before: Option<ReferenceState>,
    load: f64,
}

/// Distance over radius beyond which a contact acts by its load alone: the rest is 2 % there, and less beyond.
const ALOOF: f64 = 2.0;

impl Source {
    fn before(stood: &ReferenceState) -> Self {
        Self { asperity: stood.asperity, now: None, before: Some(*stood), load: -stood.load() }
    }

    fn new(asperity: usize) -> Self {
        Self { asperity, now: None, before: None, load: 0.0 }
    }

    fn become_of(&mut self, sphere: Asperity, radius: f64) {
        self.now = Some((sphere, radius));
        self.load += sphere.load(radius);
    }

    /// Displacement at a place beyond the expected one \[m\], without images.
    fn field(&self, problem: &Problem, place: &[f64; 2], compliance: f64) -> f64 {
        let r = problem.neighbours.distance(place, &problem.positions[self.asperity]);
        let (radius, was) = (self.now.map_or(0.0, |now| now.1), self.before.map_or(0.0, |before| before.radius));
        if r > ALOOF * radius.max(was) {
            return compliance * self.load / r;
        }
        let field = |sphere: &Asperity, a: f64| problem.spot_field(sphere, r, a);
        let (was, slope) = self.before.map_or((0.0, 0.0), |before| field(&before.sphere, before.radius));
        let more = self.before.map_or(0.0, |before| before.more);
        self.now.map_or(0.0, |(sphere, a)| field(&sphere, a).0) - was - more * slope
    }
}

/// Bounded share of Δ that the displacement by the outside takes up, in estimates of the response of loads.
fn part(drift: f64) -> f64 {
    drift.clamp(-1.0, 2.0)
}

impl LocalProblem {
    /// Members before a change, as [`Self::displacement_changes`] needs them, without expected changes.
    pub(crate) fn reference_states(&self, problem: &Problem) -> Vec<ReferenceState> {
        let stood = |(member, a): (&OutsideField, &f64)| ReferenceState {
            asperity: member.asperity,
            sphere: problem.asperities[member.asperity],
            radius: *a,
            more: 0.0,
        };
        self.members.iter().zip(&self.radius).map(stood).collect()
    }

    /// Changes of the displacements at asperities beyond the expected ones \[m\]: of the loads as points, and next to a contact of its
    /// field.
    pub(crate) fn displacement_changes(
        &self,
        problem: &Problem,
        asperities: &[usize],
        centre: &[f64; 2],
        before: &[ReferenceState],
    ) -> Vec<f64> {
        let mut sources: Vec<Source> = before.iter().map(Source::before).collect();
        for (member, &a) in self.members.iter().zip(&self.radius) {
            let at = before.binary_search_by_key(&member.asperity, |stood| stood.asperity).unwrap_or_else(|_| {
                sources.push(Source::new(member.asperity));
                sources.len() - 1
            });
            sources[at].become_of(problem.asperities[member.asperity], a);
        }
        let whole: f64 = sources.iter().map(|source| source.load).sum();
        let compliance = problem.material.compliance();
        let of = |&i: &usize| {
            let place = &problem.positions[i];
            let near: f64 = sources.iter().map(|source| source.field(problem, place, compliance)).sum();
            near + compliance * whole * problem.neighbours.image_kernel(place, centre)
        };
        asperities.iter().map(of).collect()
    }

    /// `Σ F_i ∂ŵ_i/∂Δ` of the members by the outside \[N\]: by reciprocity, the effect of these loads on the load of the outside.
    pub(crate) fn reciprocal_load_rate(&self, problem: &Problem) -> f64 {
        self.members.iter().zip(&self.radius).map(|(m, a)| part(m.drift) * problem.asperities[m.asperity].load(*a)).sum()
    }

    /// Load of the members beyond the expected one, and the same for its effect on the load of the outside \[N\].
    pub(crate) fn unexpected_load(&self, before: &[ReferenceState]) -> (f64, f64) {
        let (mut load, mut pull) = (0.0, 0.0);
        for ((member, &a), stood) in self.members.iter().zip(&self.radius).zip(before) {
            let (sphere, was) = (&stood.sphere, stood.radius);
            let off = sphere.load(a) - sphere.load(was) - stood.more * sphere.load_slope(was);
            load += off;
            pull += part(member.drift) * off;
        }
        (load, pull)
    }
}
