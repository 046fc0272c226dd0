//! Effect of a local problem on the contacts outside it, and of these on its load.

use super::{LocalProblem, OutsideField};
use crate::asperities::contact::problem::Problem;
use crate::asperities::field::PointLoad;

/// Member before a change.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReferenceState {
    pub(crate) asperity: usize,
    /// Radius \[m\].
    pub(crate) radius: f64,
    /// Expected change of the radius \[m\].
    pub(crate) more: f64,
}

impl ReferenceState {
    /// Expected load \[N\].
    fn load(&self, problem: &Problem) -> f64 {
        let asperity = &problem.asperities[self.asperity];
        asperity.load(self.radius) + self.more * asperity.load_slope(self.radius)
    }
}

/// Member as a source for the outside: present radius \[m\], state before, and load beyond the expected one
/// \[N\].
struct Source {
    asperity: usize,
    now: Option<f64>,
    before: Option<ReferenceState>,
    load: f64,
}

impl Source {
    fn before(problem: &Problem, state: &ReferenceState) -> Self {
        Self { asperity: state.asperity, now: None, before: Some(*state), load: -state.load(problem) }
    }

    fn new(asperity: usize) -> Self {
        Self { asperity, now: None, before: None, load: 0.0 }
    }

    fn set_now(&mut self, problem: &Problem, radius: f64) {
        self.now = Some(radius);
        self.load += problem.asperities[self.asperity].load(radius);
    }

    /// Distance beyond which it acts by its load alone \[m\].
    fn reach(&self, problem: &Problem) -> f64 {
        problem.numerics.solver.groups.point_load_distance
            * self.now.unwrap_or(0.0).max(self.before.map_or(0.0, |before| before.radius))
    }

    /// Displacement at a distance r beyond the expected one \[m\], without images.
    fn field(&self, problem: &Problem, r: f64) -> f64 {
        let field = |a: f64| problem.spot_field(&problem.asperities[self.asperity], r, a);
        let (was, slope) = self.before.map_or((0.0, 0.0), |before| field(before.radius));
        let more = self.before.map_or(0.0, |before| before.more);
        self.now.map_or(0.0, |a| field(a).0) - was - more * slope
    }
}

/// Bounded share of Δ that the displacement by the outside takes up, in estimates of the response of loads.
fn part(drift: f64) -> f64 {
    drift.clamp(-1.0, 2.0)
}

impl LocalProblem {
    /// Members before a change, as [`Self::displacement_changes`] needs them, without expected changes.
    pub(crate) fn reference_states(&self) -> Vec<ReferenceState> {
        let state = |(member, a): (&OutsideField, &f64)| ReferenceState {
            asperity: member.asperity,
            radius: *a,
            more: 0.0,
        };
        self.members.iter().zip(&self.radius).map(state).collect()
    }

    /// Changes of the displacements at asperities (ascending) beyond the expected ones \[m\]: of the loads as
    /// points, and next to a contact of its field.
    pub(crate) fn displacement_changes(
        &self,
        problem: &Problem,
        asperities: &[usize],
        centre: &[f64; 2],
        before: &[ReferenceState],
    ) -> Vec<f64> {
        let mut sources: Vec<Source> = before.iter().map(|state| Source::before(problem, state)).collect();
        for (member, &a) in self.members.iter().zip(&self.radius) {
            let at =
                before.binary_search_by_key(&member.asperity, |state| state.asperity).unwrap_or_else(|_| {
                    sources.push(Source::new(member.asperity));
                    sources.len() - 1
                });
            sources[at].set_now(problem, a);
        }
        let as_point = |source: &Source| PointLoad {
            place: *problem.place(source.asperity),
            load_n: source.load,
            reach_m: source.reach(problem),
        };
        let loads: Vec<PointLoad> = sources.iter().map(as_point).collect();
        let mut changes = problem.field.of_loads(&loads, centre, asperities);
        for source in &sources {
            problem.neighbours.within(source.asperity, source.reach(problem), |r, i| {
                if let Ok(at) = asperities.binary_search(&i) {
                    changes[at] += source.field(problem, r);
                }
            });
        }
        changes
    }

    /// `Σ F_i ∂ŵ_i/∂Δ` of the members by the outside \[N\]: by reciprocity, the effect of these loads on the
    /// load of the outside.
    pub(crate) fn reciprocal_load_rate(&self, problem: &Problem) -> f64 {
        self.members
            .iter()
            .zip(&self.radius)
            .map(|(m, a)| part(m.drift) * problem.asperities[m.asperity].load(*a))
            .sum()
    }

    /// Load of the members beyond the expected one, and the same for its effect on the load of the outside
    /// \[N\].
    pub(crate) fn unexpected_load(&self, problem: &Problem, before: &[ReferenceState]) -> (f64, f64) {
        let (mut load, mut pull) = (0.0, 0.0);
        for ((member, &a), state) in self.members.iter().zip(&self.radius).zip(before) {
            let (asperity, was) = (&problem.asperities[member.asperity], state.radius);
            let off = asperity.load(a) - asperity.load(was) - state.more * asperity.load_slope(was);
            load += off;
            pull += part(member.drift) * off;
        }
        (load, pull)
    }
}
