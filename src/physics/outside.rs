//! What a neighbourhood does to those outside it, and they to its load.

use super::patch::Patch;
use super::state::Problem;

/// A member as it stood: the asperity, its radius, and by how much that was expected to change \[m\].
pub(crate) type Stood = (usize, f64, f64);

/// A member as those outside feel it: its radius now and before (0 out of contact), by how much that was expected to change, and how much more load it
/// has than expected.
struct Source {
    asperity: usize,
    radius: f64,
    was: f64,
    more: f64,
    load: f64,
}

/// Distance over radius from which on a spot's load alone is felt: what else there is is 2 % of it there, and less beyond.
const ALOOF: f64 = 2.0;

impl Source {
    fn before(problem: &Problem, asperity: usize, was: f64, more: f64) -> Self {
        let sphere = &problem.asperities[asperity];
        Self { asperity, radius: 0.0, was, more, load: -sphere.load(was) - more * sphere.load_slope(was) }
    }

    fn new(problem: &Problem, asperity: usize, radius: f64) -> Self {
        Self { asperity, radius, was: 0.0, more: 0.0, load: problem.asperities[asperity].load(radius) }
    }

    fn become_of(&mut self, problem: &Problem, radius: f64) {
        self.radius = radius;
        self.load += problem.asperities[self.asperity].load(radius);
    }

    /// What it does at a place beyond what was expected \[m\], without images.
    fn field(&self, problem: &Problem, place: &[f64; 2], compliance: f64) -> f64 {
        let r = problem.neighbours.distance(place, &problem.positions[self.asperity]);
        if r > ALOOF * self.radius.max(self.was) {
            return compliance * self.load / r;
        }
        let field = |a: f64| if a > 0.0 { problem.spot_field(self.asperity, r, a) } else { (0.0, 0.0) };
        let (was, slope) = field(self.was);
        field(self.radius).0 - was - self.more * slope
    }
}

/// How much of the way of the approach what is outside takes up, where it tells how loads answer.
fn part(drift: f64) -> f64 {
    drift.clamp(-1.0, 2.0)
}

impl Patch {
    /// How the members stand, as [`Self::moved_at`] wants it, if nothing more is expected of them.
    pub(crate) fn stand(&self) -> Vec<Stood> {
        self.members.iter().zip(&self.radius).map(|(member, a)| (member.asperity, *a, 0.0)).collect()
    }

    /// By how much the displacements at asperities are other than they were expected to be, when members stood as they did before \[m\]: what the loads
    /// do from their centres, and near a spot, where that is not enough, its field.
    pub(crate) fn moved_at(&self, problem: &Problem, asperities: &[usize], centre: &[f64; 2], before: &[Stood]) -> Vec<f64> {
        let mut sources: Vec<Source> = before.iter().map(|&(i, a, more)| Source::before(problem, i, a, more)).collect();
        for (member, &a) in self.members.iter().zip(&self.radius) {
            match before.binary_search_by_key(&member.asperity, |stood| stood.0) {
                Ok(at) => sources[at].become_of(problem, a),
                Err(_) => sources.push(Source::new(problem, member.asperity, a)),
            }
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

    /// What the spots outside do to the loads of the members as the approach goes on, `Σ F_i ∂ŵ_i/∂δ`; by reciprocity, what these loads do to the
    /// load of the others \[N\].
    pub(crate) fn pull(&self, problem: &Problem) -> f64 {
        self.members.iter().zip(&self.radius).map(|(m, a)| part(m.drift) * problem.asperities[m.asperity].load(*a)).sum()
    }

    /// By how much the load of the members is other than it was expected to be, and by how much what the spots outside do to it is, both as the
    /// radii were to change \[N\].
    pub(crate) fn off(&self, problem: &Problem, before: &[Stood]) -> (f64, f64) {
        let (mut load, mut pull) = (0.0, 0.0);
        for ((member, &a), &(i, was, more)) in self.members.iter().zip(&self.radius).zip(before) {
            let asperity = &problem.asperities[i];
            let off = asperity.load(a) - asperity.load(was) - more * asperity.load_slope(was);
            load += off;
            pull += part(member.drift) * off;
        }
        (load, pull)
    }
}
