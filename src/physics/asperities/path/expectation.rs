//! Events that are expected before a mean penetration, by the linear predictors.

use super::conditions::Condition;
use super::predictor::Predictor;
use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::state::Status;
use crate::asperities::contact::transition::{Transition, absorbing_radius};

/// Transition that is expected, with its mean penetration \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PredictedEvent {
    pub(crate) mean_penetration: f64,
    pub(crate) transition: Transition,
}

impl Predictor {
    /// Adds the merging that is expected of contact `j` before `target`.
    fn expect_merging(
        &self,
        problem: &Problem,
        j: usize,
        target: f64,
        sign: f64,
        due: &mut Vec<PredictedEvent>,
    ) {
        let (here, there) = (self.state.radius[j], self.radius(problem, j, target));
        let mut found = Vec::new();
        self.pairs(problem, j, here.max(there), |i, _| found.push(i));
        for i in found {
            let at = self.traces[j].at;
            let (start, end) = (
                problem.meeting([j, i], [here, self.radius(problem, i, at)]),
                problem.meeting([j, i], [there, self.radius(problem, i, target)]),
            );
            let transition = self.merging(i, j);
            let ends = start + 1.1 * (end - start);
            if (start >= 0.0 || ends >= 0.0) && !due.iter().any(|event| event.transition == transition) {
                let share = if start >= 0.0 { 0.0 } else { (start / (start - end)).clamp(0.0, 1.0) };
                due.push(PredictedEvent {
                    mean_penetration: at + sign * share * ((target - at) * sign).max(0.0),
                    transition,
                });
            }
        }
    }

    /// Adds the events expected of asperity `i` before `target`, in the sense `sign`.
    pub(crate) fn expect(
        &self,
        problem: &Problem,
        i: usize,
        target: f64,
        sign: f64,
        due: &mut Vec<PredictedEvent>,
    ) {
        match self.state.status[i] {
            Status::Free => self.expect_jump_in(problem, i, target, sign, due),
            Status::Contact => {
                self.expect_of_spot(problem, i, target, sign, due);
                if problem.merges() {
                    self.expect_merging(problem, i, target, sign, due);
                }
            }
            Status::Covered { .. } | Status::Merged { .. } => {}
        }
    }

    fn expect_jump_in(
        &self,
        problem: &Problem,
        i: usize,
        target: f64,
        sign: f64,
        due: &mut Vec<PredictedEvent>,
    ) {
        let trace = self.traces[i];
        let Some(penetration) = trace.penetration().filter(|_| !self.state.barred[i]) else { return };
        let left = problem.jump_in[i] - penetration;
        let speed = sign * trace.rate;
        let way = if left <= 0.0 { 0.0 } else { left / speed };
        let left = (target - trace.at) * sign;
        // A curved way may end a little earlier than a straight one.
        if (left > 0.0 && speed > 0.0 || way == 0.0) && way <= 1.1 * left {
            due.push(PredictedEvent {
                mean_penetration: trace.at + sign * way,
                transition: Transition::jump_in(i),
            });
        }
    }

    fn expect_of_spot(
        &self,
        problem: &Problem,
        j: usize,
        target: f64,
        sign: f64,
        due: &mut Vec<PredictedEvent>,
    ) {
        let (trace, asperity, a) = (self.traces[j], &problem.asperities[j], self.state.radius[j]);
        let penetration = trace.penetration_or_nan();
        let speed = sign * trace.rate;
        let left = (target - trace.at) * sign;
        let mut offer = |way: f64, transition: Transition| {
            due.push(PredictedEvent { mean_penetration: trace.at + sign * way.max(0.0), transition });
        };
        if speed < 0.0 {
            let way = (penetration - asperity.jump_off_penetration()) / -speed;
            if way <= problem.numerics.events.branch_end_distance * left {
                offer(way.min(left), Transition::jump_off(j));
            }
            let uncover = |i: usize| Transition::uncover(i, j);
            for transition in std::iter::once(Transition::split(j)).chain(self.covered_by(j).map(uncover)) {
                let Some(Condition::Shrinking { value_m, .. }) = problem.condition(&transition, &self.state)
                else {
                    continue;
                };
                let way = (penetration - asperity.penetration(value_m)) / -speed;
                if a <= value_m || way <= 1.1 * left {
                    offer(if a <= value_m { 0.0 } else { way }, transition);
                }
            }
        } else if speed > 0.0 && problem.covers() {
            let most = penetration + 1.1 * speed * left;
            let Some(reach) = asperity.radius_at_penetration(most) else { return };
            let twins = problem.numerics.events.common_fold_distance;
            problem.neighbours.within(j, reach / twins, |r, i| {
                let r = absorbing_radius(r);
                let open = problem.can_be_covered(&self.state, i) && self.state.radius[i] < r;
                // Two contacts that grow towards one another's centres have a fold before they reach them.
                if open && r >= a && (reach >= r || self.state.radius[i] > twins * r) {
                    offer(
                        ((asperity.penetration(r) - penetration) / speed).min(left),
                        Transition::cover(i, j),
                    );
                }
            });
        }
    }
}
