//! Linear predictors: the contact between two global solves.
//!
//! The penetration of a contact is nearly linear in the mean penetration, up to the end of its branch; its
//! radius is not. Each asperity has a [`PenetrationTrace`] from the last global solve, or from the last event
//! next to it. Its state at a later mean penetration follows from there.

use crate::asperities::contact::merged_spot::{TouchingPairs, pair_of};
use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::state::{State, Status};
use crate::asperities::contact::transition::Transition;
use crate::asperities::solve::trace::PenetrationTrace;
use crate::cycle::{Merged, Totals};
use crate::jkr::Asperity;

/// Number of contacts whose radii are computed at once.
const LANES: usize = 8;

/// Contact as it is known between two global solves.
#[derive(Debug, Clone)]
pub(crate) struct Predictor {
    /// Status of each asperity, and radii at their predictors.
    pub(crate) state: State,
    /// Predictors of contacts and of free asperities near their jump-in.
    pub(crate) traces: Vec<PenetrationTrace>,
    /// Free asperities that are near their jump-in, ascending.
    pub(crate) candidates: Vec<usize>,
    /// Absorbed asperities by absorbing contact: `(by, absorbed)`, ascending.
    covered_by: Vec<(usize, usize)>,
    /// Pairs that overlap and do not merge before they have been apart.
    pub(crate) parted: TouchingPairs,
    /// Load and area, with their derivatives, at the mean penetration of the last change.
    sums: Sums,
}

#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    at: f64,
    load: f64,
    load_rate: f64,
    area: f64,
    area_rate: f64,
}

impl Sums {
    /// Extrapolates to a mean penetration \[m\].
    fn go_to(&mut self, mean_penetration: f64) {
        let way = mean_penetration - self.at;
        self.load += self.load_rate * way;
        self.area += self.area_rate * way;
        self.at = mean_penetration;
    }

    /// Adds (1) or subtracts (−1) other sums at the same mean penetration.
    fn add(&mut self, other: &Self, sign: f64) {
        self.load += sign * other.load;
        self.load_rate += sign * other.load_rate;
        self.area += sign * other.area;
        self.area_rate += sign * other.area_rate;
    }
}

impl Predictor {
    pub(crate) fn new(problem: &Problem, state: State) -> Self {
        let unknown = PenetrationTrace::unknown(state.mean_penetration_m);
        let mut covered_by: Vec<(usize, usize)> = state
            .status
            .iter()
            .enumerate()
            .filter_map(|(i, status)| match status {
                Status::Covered { by, .. } => Some((*by, i)),
                _ => None,
            })
            .collect();
        covered_by.sort_unstable();
        Self {
            traces: vec![unknown; problem.len()],
            candidates: Vec::new(),
            covered_by,
            parted: TouchingPairs::new(),
            sums: Sums::default(),
            state,
        }
    }

    /// Changes the status of an asperity.
    pub(crate) fn set(&mut self, i: usize, status: Status, radius: f64) {
        if let Status::Covered { by, .. } = self.state.status[i]
            && let Ok(at) = self.covered_by.binary_search(&(by, i))
        {
            self.covered_by.remove(at);
        }
        if let Status::Covered { by, .. } = status
            && let Err(at) = self.covered_by.binary_search(&(by, i))
        {
            self.covered_by.insert(at, (by, i));
        }
        match (self.candidates.binary_search(&i), status) {
            (Err(at), Status::Free) => self.candidates.insert(at, i),
            (Ok(at), Status::Contact | Status::Covered { .. }) => {
                self.candidates.remove(at);
            }
            _ => {}
        }
        self.state.set(i, status, radius);
    }

    /// Asperities absorbed by contact `by`, ascending.
    pub(crate) fn covered_by(&self, by: usize) -> impl Iterator<Item = usize> + '_ {
        let from = self.covered_by.partition_point(|(j, _)| *j < by);
        self.covered_by[from..].iter().take_while(move |(j, _)| *j == by).map(|(_, i)| *i)
    }

    /// `da/dΔ` of a contact at its predictor.
    pub(crate) fn radius_rate(&self, problem: &Problem, i: usize) -> f64 {
        self.traces[i].bounded_speed(&problem.asperities[i], self.state.radius[i])
    }

    /// `dF/dΔ` of a contact \[N/m\], at most that of a flat punch of three times its size: it is infinite at
    /// the end of the branch, over a short way.
    pub(crate) fn load_rate(&self, problem: &Problem, i: usize) -> f64 {
        let (asperity, a) = (&problem.asperities[i], self.state.radius[i]);
        let most = 6.0 * problem.material.contact_modulus_pa * a;
        (asperity.load_slope(a) * self.radius_rate(problem, i)).clamp(-most, most)
    }

    /// Predicted contact radius at a mean penetration \[m\]. At the predictor's own it may lie beyond the end
    /// of the branch, where the penetration has another radius.
    pub(crate) fn radius(&self, problem: &Problem, i: usize, mean_penetration: f64) -> f64 {
        let trace = self.traces[i];
        if trace.at == mean_penetration {
            self.state.radius[i]
        } else {
            trace.radius_ahead(&problem.asperities[i], mean_penetration)
        }
    }

    /// Predicted contact radii at a mean penetration \[m\].
    pub(crate) fn radii(&self, problem: &Problem, mean_penetration: f64) -> Vec<(usize, f64)> {
        let mut radii = Vec::with_capacity(self.state.contacts.len());
        for contacts in self.state.contacts.chunks(LANES) {
            // Lanes beyond the last contact repeat it.
            let lanes: [usize; LANES] = std::array::from_fn(|lane| contacts[lane.min(contacts.len() - 1)]);
            let ahead = Asperity::radii_ahead(
                lanes.map(|i| &problem.asperities[i]),
                lanes.map(|i| self.traces[i].ahead(mean_penetration)),
            );
            let known = |i: usize| (self.traces[i].at == mean_penetration).then_some(self.state.radius[i]);
            radii.extend(contacts.iter().zip(ahead).map(|(&i, ahead)| (i, known(i).unwrap_or(ahead))));
        }
        radii
    }

    /// Moves all contacts to their predicted states at a mean penetration \[m\].
    pub(crate) fn go_to(&mut self, problem: &Problem, mean_penetration: f64) {
        self.state.mean_penetration_m = mean_penetration;
        for (i, a) in self.radii(problem, mean_penetration) {
            if self.traces[i].is_known() {
                self.state.radius[i] = a;
            }
        }
    }

    /// Load and area of a contact at its predictor, with their derivatives.
    fn share(&self, problem: &Problem, i: usize) -> Sums {
        let (asperity, a, speed) =
            (&problem.asperities[i], self.state.radius[i], self.radius_rate(problem, i));
        let load_rate = self.load_rate(problem, i);
        let turn = 2.0 * std::f64::consts::PI * a;
        Sums {
            at: self.traces[i].at,
            load: asperity.load(a),
            load_rate,
            area: 0.5 * turn * a,
            area_rate: turn * speed,
        }
    }

    /// Predicted load and area at a mean penetration.
    pub(crate) fn totals(&self, mean_penetration: f64) -> Totals {
        let mut sums = self.sums;
        sums.go_to(mean_penetration);
        Totals { load_n: sums.load, area_m2: sums.area }
    }

    /// `dF/dΔ` of all contacts where they were known last \[N/m\].
    pub(crate) fn load_rate_of_all(&self) -> f64 {
        self.sums.load_rate
    }

    /// Removes a contact from the sums (−1) or adds it (+1), as predicted at a mean penetration.
    pub(crate) fn count(&mut self, problem: &Problem, i: usize, sign: f64, mean_penetration: f64) {
        let mut share = self.share(problem, i);
        share.go_to(mean_penetration);
        self.sums.go_to(mean_penetration);
        self.sums.add(&share, sign);
    }

    /// Replaces the predictors of contacts: asperity, radius \[m\], trace.
    pub(crate) fn replace_all(&mut self, problem: &Problem, traces: &[(usize, f64, PenetrationTrace)]) {
        for (i, a, trace) in traces {
            if self.traces[*i].is_known() {
                self.count(problem, *i, -1.0, trace.at);
            }
            self.state.radius[*i] = *a;
            self.traces[*i] = *trace;
            self.count(problem, *i, 1.0, trace.at);
        }
    }

    /// Adds the load with which contacts will respond to pending displacements \[N\].
    pub(crate) fn add_load(&mut self, load: f64) {
        self.sums.load += load;
    }

    /// Sets load and area before any predictor is known.
    pub(crate) fn expect_totals(&mut self, totals: Totals) {
        self.sums = Sums {
            at: self.state.mean_penetration_m,
            load: totals.load_n,
            area: totals.area_m2,
            ..Sums::default()
        };
    }

    /// Recomputes the sums when all predictors are at one mean penetration.
    pub(crate) fn recount(&mut self, problem: &Problem) {
        let mut sums = Sums { at: self.state.mean_penetration_m, ..Sums::default() };
        for &i in &self.state.contacts {
            sums.add(&self.share(problem, i), 1.0);
        }
        self.sums = sums;
    }

    /// Changes the displacement of a free asperity \[m\].
    pub(crate) fn displace(&mut self, problem: &Problem, i: usize, change: f64) {
        self.traces[i].displace(change);
        self.state.barred[i] &= self.traces[i].has_reached(problem.jump_in[i]);
    }

    /// Adds a merged contact; it gets the next number.
    pub(crate) fn extend(&mut self, merged: Merged) {
        self.traces.push(PenetrationTrace::unknown(self.state.mean_penetration_m));
        self.state.extend(merged);
    }

    /// Allows pairs to merge again that have been apart since they split.
    pub(crate) fn forget_parted(&mut self, problem: &Problem) {
        let state = &self.state;
        let is_part = |i: usize| matches!(state.status[i], Status::Merged { .. });
        let overlaps =
            |i: usize, j: usize| problem.meeting([i, j], [state.radius[i], state.radius[j]]) >= 0.0;
        self.parted.retain(|(i, j)| is_part(*i) || is_part(*j) || overlaps(*i, *j));
    }

    /// A contact that has become smaller by merging does not split at once: its radius of release is at most
    /// its radius, to rounding.
    pub(crate) fn keep_merged(&mut self, problem: &Problem, number: usize) {
        let (radius, merged) =
            (self.state.radius[number], &mut self.state.merged[number - problem.summits()]);
        if radius > 0.0 {
            merged.release_m =
                merged.release_m.min((1.0 - problem.numerics.events.radius_resolution) * radius);
        }
    }

    /// True if two contacts may merge when they touch.
    pub(crate) fn may_merge(&self, i: usize, j: usize) -> bool {
        let both = self.state.status[i] == Status::Contact && self.state.status[j] == Status::Contact;
        both && !self.parted.contains(&pair_of(i, j))
    }

    /// Calls `visit(i, distance)` for those contacts of [`Self::near`] that may merge with contact `j`.
    pub(crate) fn pairs(&self, problem: &Problem, j: usize, reach: f64, mut visit: impl FnMut(usize, f64)) {
        self.near(problem, j, reach, |i, r| {
            if self.may_merge(i, j) {
                visit(i, r);
            }
        });
    }

    /// Calls `visit(i, distance)` for the contacts that would touch asperity `j` if it had the radius `reach`
    /// \[m\] and they grew by a fifth.
    pub(crate) fn near(&self, problem: &Problem, j: usize, reach: f64, mut visit: impl FnMut(usize, f64)) {
        let (radius, growth) = (&self.state.radius, problem.numerics.events.neighbour_growth);
        let mut offer = |i: usize, r: f64| {
            if i != j && r <= reach + growth * radius[i] {
                visit(i, r);
            }
        };
        // Small contacts are found by their place. Few are large.
        let listed = problem.neighbours.listed_m();
        let small = ((listed - reach) / growth).max(0.0);
        if small > 0.0 {
            problem.neighbours.within(j, listed, |r, i| {
                if radius[i] > 0.0 && radius[i] <= small {
                    offer(i, r);
                }
            });
        }
        for &i in self.state.contacts.iter().filter(|i| radius[**i] > small) {
            offer(i, problem.distance(j, i));
        }
    }

    /// The merging of two contacts: the smaller one, by the larger one.
    pub(crate) fn merging(&self, i: usize, j: usize) -> Transition {
        let radius = &self.state.radius;
        let first = (radius[i], j) < (radius[j], i);
        let (asperity, by) = if first { (i, j) } else { (j, i) };
        Transition::merge(asperity, by)
    }
}
