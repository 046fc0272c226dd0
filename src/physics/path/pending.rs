//! Far-field load changes that are not yet in the displacements of all asperities.

use crate::physics::contact::problem::Problem;

/// What a neighbourhood does from afar, to those who were not told.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ripple {
    pub(crate) place: [f64; 2],
    /// Those nearer than this know better \[m\].
    pub(crate) reach: f64,
    /// Change of its load \[N\].
    pub(crate) load_n: f64,
}

impl Ripple {
    /// True if a place was not told of it.
    pub(crate) fn passes(&self, problem: &Problem, place: &[f64; 2]) -> bool {
        problem.neighbours.distance(place, &self.place) > self.reach
    }

    /// What it does to a place \[m\].
    pub(crate) fn field(&self, problem: &Problem, place: &[f64; 2]) -> f64 {
        self.load_n * problem.material.compliance() * problem.neighbours.kernel(place, &self.place)
    }
}
