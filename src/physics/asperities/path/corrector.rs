//! Global corrector: the contact solved at the end of an increment, and new predictors of everything.

use super::arrival::Arrival;
use super::equilibrium_path::EquilibriumPath;
use super::rejection::Rejection;
use super::triggers::Trigger;
use super::work::{work, work_of_all};
use crate::Reason;
use crate::asperities::contact::Status;
use crate::asperities::contact::transition::Transition;
use crate::asperities::solve::descent::{Failing, Relaxed};
use crate::asperities::solve::precision::Precision;
use crate::asperities::solve::residual::NotConverged;
use crate::asperities::solve::trace::PenetrationTrace;
use crate::cycle::Totals;
use crate::math::vector::dot;

/// Reason for the difference between the predictors and the solution.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Since {
    /// Growth along the increment alone.
    Growth,
    /// Growth, and events whose pending displacements are known.
    Events,
    /// A jump of the contact at the present mean penetration.
    Jump,
}

impl EquilibriumPath {
    /// Solves the global problem at a mean penetration \[m\], from the predictors, and applies the
    /// transitions that are overdue there.
    pub(super) fn correct(
        &mut self,
        target: f64,
        arrival: Arrival,
        precision: Precision,
    ) -> Result<(), Rejection> {
        let (is_checked, has_jumped) = (arrival == Arrival::CheckedIncrement, arrival == Arrival::Jump);
        self.precision = precision;
        let pending = self.pending.all().to_vec();
        self.solver.begin(precision);
        let mut rounds = 0;
        loop {
            self.predictor.go_to(&self.problem(), target);
            let first = self.solver.evaluate(&mut self.predictor.state);
            if is_checked && rounds == 0 && (first.residual_m.is_nan() || self.is_astray(&pending)) {
                return Err(first.into());
            }
            if !first.residual_m.is_nan() {
                self.log.drift_m = self.log.drift_m.max(first.residual_m);
            }
            let rates = if is_checked {
                self.solve_globally(first, Failing::EndsAtOnce)?.0
            } else {
                self.solve_or_relax(first, target)?
            };
            let since = match (has_jumped || rounds > 0, self.pending.is_smooth()) {
                (true, _) => Since::Jump,
                (false, true) => Since::Growth,
                (false, false) => Since::Events,
            };
            self.restart_predictors(&rates, since, &pending);
            let due = self.overdue(arrival);
            let Some(&(lateness, worst)) = due.first() else {
                self.predictor.forget_parted(&self.solver.problem);
                return Ok(());
            };
            if is_checked && rounds == 0 && lateness > self.accuracy().lateness() * self.frame.scale {
                return Err(NotConverged::residual(lateness, worst.asperity).into());
            }
            rounds += 1;
            self.count_trial(target, worst.asperity)?;
            self.apply_overdue(due)?;
        }
    }

    /// Solves the global problem from the state that was evaluated last. Where contacts have no equilibrium
    /// nearby they relax, at last all of them; what leaves or is absorbed on the way belongs to the present
    /// avalanche. The rates are returned.
    fn solve_or_relax(&mut self, first: NotConverged, target: f64) -> Result<Vec<f64>, Rejection> {
        let (start, before) = (self.state().clone(), self.predictor.totals(target));
        match self.solve_globally(first, Failing::Relaxes) {
            Ok((rates, relaxed)) => {
                if let Some(leader) = relaxed.leader {
                    self.enter_relaxed(&relaxed.transitions, before, target);
                    if relaxed.transitions.is_empty() {
                        self.record_snap(leader, before, target);
                    }
                }
                Ok(rates)
            }
            Err(_) => {
                self.predictor.state = start;
                self.relax_contact(target)?;
                Ok(self.finite_rates(first)?)
            }
        }
    }

    /// Solves the global problem from the state that was evaluated last; its rates are returned if it is
    /// stable, with the relaxations on the way.
    fn solve_globally(
        &mut self,
        first: NotConverged,
        failing: Failing,
    ) -> Result<(Vec<f64>, Relaxed), NotConverged> {
        let tolerance = match self.precision {
            Precision::Exact => self.problem().tolerance_m(),
            Precision::Sufficient => self.accuracy().sufficient() * self.frame.scale,
        };
        let relaxed = self.solver.newton(&mut self.predictor.state, first, failing, tolerance)?;
        let rates = self.finite_rates(first)?;
        let stable = self.state().stability > 0.0;
        if stable {
            Ok((rates, relaxed))
        } else {
            Err(NotConverged::because(Reason::Unstable, first.asperity))
        }
    }

    /// Applies overdue transitions, each with its avalanche, if it is still due.
    fn apply_overdue(&mut self, due: Vec<(f64, Transition)>) -> Result<(), Rejection> {
        // Contacts meet in equilibrium, one pair at a time.
        let (mut coalescing, others): (Vec<_>, Vec<_>) =
            due.into_iter().partition(|(_, transition)| transition.kind.is_merging());
        coalescing.truncate(1);
        for (_, transition) in if others.is_empty() { coalescing } else { others } {
            if self.problem().is_due(&transition, &self.predictor) {
                self.start_avalanche(transition)?;
            }
        }
        Ok(())
    }

    /// Rates of the contacts at the equilibrium that was evaluated last; where they are not numbers, the
    /// reason is `first`.
    fn finite_rates(&mut self, first: NotConverged) -> Result<Vec<f64>, NotConverged> {
        let rates = self.solver.rates(&mut self.predictor.state, self.precision);
        if rates.iter().all(|rate| rate.is_finite()) { Ok(rates) } else { Err(first) }
    }

    /// True if the predictors are too far from the equilibrium, apart from pending displacements.
    fn is_astray(&self, pending: &[f64]) -> bool {
        let contacts = &self.state().contacts;
        let off: Vec<f64> =
            contacts.iter().zip(&self.solver.residual).map(|(&i, residual)| residual + pending[i]).collect();
        let worst = off.iter().map(|r| r.abs()).fold(0.0, f64::max);
        let rms = (dot(&off, &off) / off.len().max(1) as f64).sqrt();
        worst > self.accuracy().worst_residual() * self.frame.scale
            || rms > self.accuracy().drift() * self.frame.scale
    }

    /// Replaces all predictors after a global solve, and counts the work since the last one.
    fn restart_predictors(&mut self, rates: &[f64], since: Since, pending: &[f64]) {
        let problem = &*self.problem();
        let target = self.state().mean_penetration_m;
        let has_jumped = since != Since::Growth;
        if has_jumped {
            self.log.pass(target, self.predictor.totals(target).load_n);
        }
        self.expect_load(target, 0.0);
        let expected = self.energy.take_expected();
        let (relaxed, grown) = self.replace_traces(rates, since, pending, -expected);
        self.pending.clear();
        if since == Since::Events {
            // The part that pending displacements do not explain has grown with the square of the way.
            self.log.work_j += grown * (target - self.energy.at()) / 3.0;
        }
        self.predictor.recount(problem);
        let (totals, potential) = problem.totals(self.state());
        self.totals = totals;
        if since == Since::Jump {
            // At constant penetration no work is done: the jump dissipates the decrease of the potential.
            self.energy.charge_last_event();
        } else {
            // Events were charged with the potential of a contact whose other members keep their loads; these
            // have responded now.
            self.log.charge(relaxed);
        }
        self.energy.close(&mut self.log, target, potential);
        let load = self.predictor.totals(target).load_n;
        if has_jumped {
            self.log.restart(target, load);
        } else {
            self.log.pass(target, load);
        }
        let merged_here =
            |number: &usize| self.state().merged[number - problem.summits()].mean_penetration_m == target;
        for number in (problem.summits()..problem.len()).filter(merged_here).collect::<Vec<_>>() {
            self.predictor.keep_merged(problem, number);
        }
        self.predict_jump_ins(rates);
    }

    /// Replaces the predictors of all contacts, and counts their work. The energy of their response to
    /// pending displacements \[J\] is returned, and the change of their load beyond the prediction \[N\],
    /// added to `grown`.
    fn replace_traces(&mut self, rates: &[f64], since: Since, pending: &[f64], mut grown: f64) -> (f64, f64) {
        let problem = &*self.problem();
        let has_jumped = since != Since::Growth;
        let target = self.state().mean_penetration_m;
        let (mut relaxed, mut together) = (0.0, Vec::new());
        for (k, rate) in rates.iter().enumerate() {
            let i = self.state().contacts[k];
            let (asperity, a) = (&problem.asperities[i], self.state().radius[i]);
            let trace = PenetrationTrace::of(asperity, target, a, *rate);
            let from = self.predictor.traces[i];
            if from.is_known() {
                let to = if has_jumped { from.moved_to(target) } else { trace };
                if problem.spring.moves_as_one && !has_jumped {
                    together.push((i, from, to));
                } else {
                    self.log.work_j += work(problem, i, from, to);
                }
                if has_jumped {
                    let more = asperity.load(a) - asperity.load(from.radius_ahead(asperity, target));
                    // A contact that has merged since has nothing pending.
                    relaxed += 0.5 * pending.get(i).copied().unwrap_or(0.0) * more;
                    grown += more;
                }
            }
            self.predictor.traces[i] = trace;
        }
        self.log.work_j += work_of_all(problem, &together);
        (relaxed, grown)
    }

    /// Replaces the predictors of the free asperities that may jump into contact. All of them are evaluated
    /// on a grid of mean penetrations. Between grid points, only asperities near their jump-in are evaluated.
    fn predict_jump_ins(&mut self, rates: &[f64]) {
        let problem = &*self.problem();
        let target = self.state().mean_penetration_m;
        let all = self.solver.begins_block(target) || problem.spring.moves_as_one;
        let near = |i: &usize| {
            let trace = &self.predictor.traces[*i];
            all || !trace.is_known()
                || trace.exceeds(problem.jump_in[*i] - self.out_of_reach(target - trace.at))
        };
        let wanted: Vec<usize> =
            (0..problem.summits()).filter(|i| self.state().status[*i] == Status::Free).filter(near).collect();
        let found = self.solver.penetrations(&self.predictor.state, rates, &wanted);
        let span = self.out_of_reach(self.steps.longest());
        self.predictor.candidates.clear();
        for (i, trace) in wanted.into_iter().zip(found) {
            self.predictor.traces[i] = trace;
            self.predictor.state.barred[i] &= trace.has_reached(problem.jump_in[i]);
            if trace.exceeds(problem.jump_in[i] - span) {
                self.predictor.candidates.push(i);
            }
        }
    }

    /// Transitions that are due anywhere, the most overdue first, each with its lateness \[m\]. At the mean
    /// penetration of a jump, postponed transitions remain postponed.
    fn overdue(&mut self, arrival: Arrival) -> Vec<(f64, Transition)> {
        let problem = &*self.problem();
        let postponed = std::mem::take(&mut self.postponed);
        let contacts = self.state().contacts.clone();
        let candidates = self.predictor.candidates.clone();
        let mut due = self.due_transitions(&contacts, &candidates);
        due.extend(self.due_coalescence(&contacts));
        if arrival == Arrival::Jump {
            due.retain(|trigger| !postponed.contains(&trigger.transition.asperity));
            self.postponed.extend_from_slice(&postponed);
        }
        let lateness = |trigger: &Trigger| {
            let waits = postponed.contains(&trigger.transition.asperity);
            if waits { 0.0 } else { problem.lateness(trigger, &self.predictor) }
        };
        let mut late: Vec<(f64, Transition)> =
            due.iter().map(|trigger| (lateness(trigger), trigger.transition)).collect();
        late.sort_by(|u, v| v.0.total_cmp(&u.0).then(u.1.asperity.cmp(&v.1.asperity)));
        late
    }

    /// Relaxes all contacts where Newton's method finds no equilibrium.
    fn relax_contact(&mut self, target: f64) -> Result<(), Rejection> {
        let before = self.predictor.totals(target);
        let changes = self.solver.relax(&mut self.predictor.state)?;
        self.enter_relaxed(&changes, before, target);
        Ok(())
    }

    /// Enters the transitions of a relaxation; the last event is charged with the loss of the potential at
    /// the next global solve.
    fn enter_relaxed(&mut self, changes: &[Transition], before: Totals, target: f64) {
        for change in changes {
            self.predictor.traces[change.asperity].forget();
            self.predictor.set(change.asperity, change.status(&self.problem()), 0.0);
            if change.ends_contact() {
                self.free_parts(change.asperity);
            }
        }
        let (after, _) = self.problem().totals(self.state());
        self.record(changes, target, before, after, 0.0);
        self.energy.charge_last_event();
    }

    /// Records a relaxation without transitions as a snap of a contact.
    fn record_snap(&mut self, asperity: usize, before: Totals, target: f64) {
        let (after, _) = self.problem().totals(self.state());
        self.record(&[Transition::snap(asperity)], target, before, after, 0.0);
    }

    /// Relaxes the contact at `target` \[m\], as the last resort.
    pub(super) fn relax_globally(&mut self, target: f64) -> Result<(), Rejection> {
        self.log.begin_avalanche();
        let events = self.log.events.len();
        let asperity = self.state().contacts.first().copied().unwrap_or(0);
        self.predictor.go_to(&self.problem(), target);
        self.relax_contact(target)?;
        if self.log.events.len() == events {
            self.record_snap(asperity, self.totals, target);
        }
        for i in self.state().contacts.clone() {
            self.predictor.traces[i].forget();
        }
        self.log.work_j += self.totals.load_n * (target - self.energy.at());
        self.correct(target, Arrival::Jump, Precision::Exact)
    }
}
