//! Events of an increment, in their order: predicted, located on the solution curve of their local problem,
//! applied, and followed by their avalanche.

use super::avalanche::Avalanche;
use super::conditions::Condition;
use super::equilibrium_path::EquilibriumPath;
use super::expectation::PredictedEvent;
use super::rejection::Rejection;
use crate::asperities::contact::transition::Transition;
use crate::asperities::solve::local::curve::{CurveEnd, CurveSearch};
use crate::asperities::solve::local::{Hold, LocalProblem};
use crate::math::bracket::{End, Illinois};

/// Rate of a penetration from which on a limit point of all contacts is looked for: it is at most about 1
/// elsewhere, and infinite there.
const RATE_AT_FOLD: f64 = 1.5;

/// Position of an event on the solution curve: the local problem is there.
#[derive(Debug, Clone, Copy)]
pub(super) enum Located {
    /// An ordinary point.
    Point,
    /// A fold, met by following this member.
    Fold(usize),
}

/// Change of the radius of a contact towards an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RadiusChange {
    Growing,
    Shrinking,
}

/// Outcome of a predicted event.
enum Outcome {
    /// It does not occur before the target, or not before another one.
    Absent,
    /// These asperities were touched by it and its avalanche, ascending.
    Touched(Vec<usize>),
    /// Local solves do not propagate its avalanche.
    Unpropagated,
}

impl EquilibriumPath {
    /// Finds and applies the events before `target` \[m\], in their order. Where one has changed more than
    /// local solves can propagate, its mean penetration is returned: the global problem is to be solved
    /// there.
    pub(super) fn run_events(&mut self, target: f64) -> Result<Option<f64>, Rejection> {
        let mut queue = self.expect_events(target);
        while let Some(at) = self.earliest(&queue) {
            let event = queue.swap_remove(at);
            self.count_trial(event.mean_penetration, event.transition.asperity)?;
            let touched = match self.run_event(event, target, &mut queue)? {
                Outcome::Absent => continue,
                Outcome::Touched(touched) => touched,
                Outcome::Unpropagated => return Ok(Some(self.neighbourhood.local.mean_penetration)),
            };
            // Predictions for the touched asperities are replaced.
            let is_touched = |i: usize| touched.binary_search(&i).is_ok();
            queue.retain(|event| {
                !is_touched(event.transition.asperity) && !event.transition.by.is_some_and(is_touched)
            });
            for &i in &touched {
                self.predictor.expect(&self.solver.problem, i, target, self.frame.sense, &mut queue);
            }
        }
        Ok(None)
    }

    /// Events that are predicted before `target` \[m\].
    fn expect_events(&self, target: f64) -> Vec<PredictedEvent> {
        let mut queue = Vec::new();
        for &i in self.state().contacts.iter().chain(&self.predictor.candidates) {
            self.predictor.expect(&self.problem(), i, target, self.frame.sense, &mut queue);
        }
        queue.extend(self.common_fold(target));
        queue
    }

    /// The end of the branch of the fastest contact, where a soft spring may make all contacts unstable at
    /// once before any of them is at the end of its own branch. It is looked for along the curve of that
    /// contact.
    fn common_fold(&self, target: f64) -> Option<PredictedEvent> {
        if !self.problem().spring.moves_as_one || self.frame.sense > 0.0 {
            return None;
        }
        let rate = |i: usize| self.predictor.traces[i].rate;
        let fastest = self
            .state()
            .contacts
            .iter()
            .copied()
            .max_by(|i, j| rate(*i).total_cmp(&rate(*j)).then(j.cmp(i)))?;
        (rate(fastest) > RATE_AT_FOLD)
            .then(|| PredictedEvent { mean_penetration: target, transition: Transition::jump_off(fastest) })
    }

    /// Position of the earliest event in the queue.
    fn earliest(&self, queue: &[PredictedEvent]) -> Option<usize> {
        let key = |event: &PredictedEvent| {
            (event.mean_penetration * self.frame.sense, event.transition.asperity, event.transition.kind)
        };
        (0..queue.len()).min_by(|a, b| {
            let (u, v) = (key(&queue[*a]), key(&queue[*b]));
            u.0.total_cmp(&v.0).then(u.1.cmp(&v.1)).then(u.2.cmp(&v.2))
        })
    }

    /// Locates and applies an event with its avalanche.
    fn run_event(
        &mut self,
        event: PredictedEvent,
        target: f64,
        queue: &mut Vec<PredictedEvent>,
    ) -> Result<Outcome, Rejection> {
        let transition = event.transition;
        if !self.chatter.admit(&transition, self.solver.problem.numerics.events.changes_per_asperity) {
            return Ok(Outcome::Absent);
        }
        self.gather(&transition, None);
        let mut avalanche = Avalanche::default();
        self.log.begin_avalanche();
        if self.has_pending() {
            self.apply_pending(&transition, &mut avalanche)?;
            avalanche.open.extend([Some(transition.asperity), transition.by].into_iter().flatten());
        } else {
            let Some(located) = self.locate(&event, target) else { return Ok(Outcome::Absent) };
            let mean_penetration = self.neighbourhood.local.mean_penetration;
            let tolerance = self.numerics().events.position_tolerance * self.problem().unit_m;
            if queue
                .iter()
                .any(|other| (mean_penetration - other.mean_penetration) * self.frame.sense > tolerance)
            {
                queue.push(PredictedEvent { mean_penetration, ..event });
                return Ok(Outcome::Absent);
            }
            self.finish_location(located, &transition, &mut avalanche);
            self.apply(transition, Some(located), &mut avalanche)?;
        }
        Ok(self.run_avalanche(avalanche)?.map_or(Outcome::Unpropagated, Outcome::Touched))
    }

    /// Moves the local problem along its solution curve to an event, just before it; nothing if the event
    /// does not occur before `target` \[m\].
    fn locate(&mut self, event: &PredictedEvent, target: f64) -> Option<Located> {
        self.neighbourhood.set_origin();
        match self.problem().condition(&event.transition, &self.predictor.state)? {
            Condition::Penetration { asperity, value_m } => {
                self.locate_penetration(asperity, value_m, event.mean_penetration, target)
            }
            Condition::Touching { pair: [i, by] } => self.locate_merging(i, by, target),
            Condition::Shrinking { contact, value_m } => {
                self.locate_radius(contact, value_m, RadiusChange::Shrinking, target)
            }
            Condition::Growing { contact, value_m } => {
                self.locate_radius(contact, value_m, RadiusChange::Growing, target)
            }
        }
    }

    /// Locates where the radius of a contact reaches `bound` \[m\], or a fold before that.
    fn locate_radius(
        &mut self,
        spot: usize,
        bound: f64,
        change: RadiusChange,
        target: f64,
    ) -> Option<Located> {
        let (problem, sense) = (&*self.problem(), self.frame.sense);
        let (local, effort) = (&mut self.neighbourhood.local, &mut self.solver.effort);
        let at = local.find(spot)?;
        let is_there = match change {
            RadiusChange::Growing => local.radius[at] >= bound,
            RadiusChange::Shrinking => local.radius[at] <= bound,
        };
        if is_there {
            return Some(Located::Point);
        }
        match local.trace_curve(problem, CurveSearch { member: at, bound, target, path_sense: sense }, effort)
        {
            Ok(CurveEnd::Fold) => Some(Located::Fold(at)),
            Ok(CurveEnd::Bound) if (local.mean_penetration - target) * sense <= 0.0 => Some(Located::Point),
            _ => None,
        }
    }

    /// Locates where the penetration of an asperity out of contact reaches
    /// `bound` \[m\], near the mean penetration `predicted` \[m\].
    fn locate_penetration(&mut self, i: usize, bound: f64, predicted: f64, target: f64) -> Option<Located> {
        let (problem, sense) = (&*self.problem(), self.frame.sense);
        let (local, effort) = (&mut self.neighbourhood.local, &mut self.solver.effort);
        let start = local.mean_penetration;
        let watched = local.watched.iter().position(|place| place.asperity == i)?;
        if local.penetration_of(problem, watched, effort) < bound {
            // From near the predicted position, for a short way of Newton's method.
            let guess = if (predicted - start) * sense > 0.0 { predicted } else { start };
            local.ahead(problem, guess);
            local.solve(problem, Hold::Penetration(watched, bound), effort).ok()?;
        }
        let way = (local.mean_penetration - start) * sense;
        let inside = way >= -problem.numerics.events.position_tolerance * problem.unit_m
            && (local.mean_penetration - target) * sense <= 0.0;
        inside.then_some(Located::Point)
    }

    /// Locates a merging, where two contacts touch, by bracketing on the solution curve.
    fn locate_merging(&mut self, i: usize, j: usize, target: f64) -> Option<Located> {
        let problem = &*self.problem();
        let (local, effort) = (&mut self.neighbourhood.local, &mut self.solver.effort);
        let pair = [local.find(i)?, local.find(j)?];
        let meeting = |local: &LocalProblem| problem.meeting([i, j], pair.map(|at| local.radius[at]));
        let (mut low, mut high) = (local.mean_penetration, target);
        let first = meeting(local);
        if first >= 0.0 {
            return Some(Located::Point);
        }
        let mut go_to = |local: &mut LocalProblem, mean_penetration: f64| {
            local.ahead(problem, mean_penetration);
            local.solve(problem, Hold::MeanPenetration, effort).ok()?;
            Some(meeting(local))
        };
        let end = go_to(local, high).filter(|end| *end >= 0.0)?;
        let mut ends = Illinois::new(first, end);
        let mut now = end;
        let (limits, touch) = (&problem.numerics.events, problem.numerics.events.merging_overlap);
        for _ in 0..limits.merging_trials {
            if (0.0..=touch).contains(&now)
                || (high - low).abs() <= limits.position_tolerance * problem.unit_m
            {
                break;
            }
            // The aim lies slightly beyond touching.
            let middle = low + ends.share(0.02) * (high - low);
            let trial = go_to(local, middle)?;
            if trial < 0.0 {
                low = middle;
                ends.narrow(End::Low, trial - 0.5 * touch);
            } else {
                (high, now) = (middle, trial);
                ends.narrow(End::High, trial - 0.5 * touch);
            }
        }
        if local.mean_penetration != high {
            go_to(local, high)?;
        }
        local.rates(problem).1.then_some(Located::Point)
    }

    /// Advances the predictor of the members to a located event, and counts the work.
    fn finish_location(&mut self, located: Located, transition: &Transition, avalanche: &mut Avalanche) {
        let fold = matches!(located, Located::Fold(_));
        // Near the end of a branch the state is smooth in the radius; at the edge of a contact it is smooth
        // in the mean penetration.
        let curve = if fold || transition.ends_contact() {
            std::mem::take(&mut self.neighbourhood.local.way)
        } else {
            Vec::new()
        };
        self.propagate_curve(&curve, avalanche);
        // At a fold they are infinite.
        let rates = (!fold).then(|| self.neighbourhood.local.rates(&self.solver.problem).0);
        self.advance_members(&curve, rates.as_deref());
    }
}
