//! The whole contact, solved at the end of every stretch: the traces begin anew.

use super::equilibrium_path::{DRIFT, Depth, Halt, LATE, Mark, Path, WORST};
use super::predictor::work;
use crate::physics::contact::problem::Totals;
use crate::physics::contact::state::Status;
use crate::physics::contact::transition::{Change, Kind};
use crate::physics::math::vector::dot;
use crate::physics::solve::residual::Unsettled;
use crate::physics::solve::trace::Trace;
use crate::physics::{PhysicsError, Reason};

/// Residual of the whole contact where its state is not asked for, of the mean jump-off penetration.
const ENOUGH: f64 = 2e-5;

/// What has led the whole contact away from its traces since it was solved last.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Since {
    /// The approach alone.
    Growth,
    /// The approach, and events whose lags are known.
    Both,
    /// A jump of all of it, here, where the potential, less the work of the loads on what they lag, was so much \[J\].
    Jump(f64),
}

impl Path<'_> {
    /// Solves the whole contact at an approach, from where the traces lead; takes the events that are overdue there. Where `strict`, it is refused
    /// if the traces have led too far from it.
    ///
    /// After a jump of the whole contact (`jump`) it went on as its traces had it up to here. Otherwise the difference grew on the way.
    pub(crate) fn settle(&mut self, target: f64, strict: bool, jump: bool, depth: Depth) -> Result<(), Halt> {
        let problem = self.problem();
        let tolerance = match depth {
            Depth::Whole => problem.tolerance_m(),
            Depth::Enough => ENOUGH * self.scale(),
        };
        self.solved = depth;
        self.gather_lags();
        self.solver.begin(depth == Depth::Enough);
        let mut rounds = 0;
        let mut uncovering: Option<(Mark, Vec<usize>)> = None;
        loop {
            self.front.go_to(problem, target);
            let start = if strict { Vec::new() } else { self.front.state.radius.clone() };
            let first = self.solver.evaluate(&mut self.front.state);
            let strange = first.residual_m.is_nan();
            if strict && rounds == 0 && (strange || self.astray()) {
                return Err(first.into());
            }
            // The state as it is now is an equilibrium at approaches that differ by the residuals.
            let shifted = problem.totals(&self.front.state).1 + self.work_on_residuals();
            if !strange {
                self.log.drift_m = self.log.drift_m.max(first.residual_m);
            }
            let found = self.solver.newton(&mut self.front.state, first, !strict, tolerance).and_then(|()| {
                let rates = self.finite_rates(first)?;
                let stable = self.front.state.stability > 0.0;
                if stable { Ok(rates) } else { Err(Unsettled::because(Reason::Unstable, first.asperity)) }
            });
            let rates = match found {
                Ok(rates) => rates,
                Err(unsettled) => {
                    if let Some((mark, uncovered)) = uncovering.take() {
                        // There is no equilibrium with those asperities at the edge of the spot.
                        self.back_to(&mark);
                        self.hold_covered(&uncovered);
                        continue;
                    }
                    if strict {
                        return Err(unsettled.into());
                    }
                    self.front.state.radius = start;
                    self.relax_whole(target)?;
                    self.finite_rates(first)?
                }
            };
            self.retrace(
                &rates,
                if jump || rounds > 0 {
                    Since::Jump(shifted)
                } else if self.ripples.is_empty() {
                    Since::Growth
                } else {
                    Since::Both
                },
            );
            self.settled = self.log.events.len();
            let due = self.overdue();
            let Some(first) = due.first() else { return Ok(()) };
            if strict && rounds == 0 {
                let late: Vec<Change> = due.iter().filter(|(late, _)| *late > LATE * self.scale()).map(|(_, change)| *change).collect();
                if !late.is_empty() {
                    return Err(Halt::Late(late, Unsettled::residual(first.0, first.1.asperity)));
                }
            }
            rounds += 1;
            self.check_event_count(target, first.1.asperity)?;
            if rounds > 10 * problem.len() + 100 {
                let asperity = problem.number(first.1.asperity);
                return Err(Halt::Error(PhysicsError::EndlessAvalanche { approach_m: target, events: rounds, asperity }));
            }
            let uncovered: Vec<usize> =
                due.iter().filter(|(_, change)| change.kind == Kind::Uncover).map(|(_, change)| change.asperity).collect();
            uncovering = (!uncovered.is_empty()).then(|| (self.mark(), uncovered));
            for (_, change) in due {
                // Another one may have brought it about, or made it needless.
                if problem.is_due(&change, &self.front) {
                    self.avalanche(change)?;
                }
            }
        }
    }

    /// Rates of the spots at the equilibrium that was evaluated last; where they are no numbers, `first` tells why.
    fn finite_rates(&mut self, first: Unsettled) -> Result<Vec<f64>, Unsettled> {
        let rates = match self.solved {
            Depth::Whole => self.solver.rates(&mut self.front.state),
            Depth::Enough => self.solver.rough_rates(&mut self.front.state),
        };
        if rates.iter().all(|rate| rate.is_finite()) { Ok(rates) } else { Err(first) }
    }

    /// `Σ F r` over the residuals that were evaluated last \[J\].
    fn work_on_residuals(&self) -> f64 {
        let state = &self.front.state;
        let load = |i: usize| self.problem().asperities[i].load(state.radius[i]);
        state.contacts.iter().zip(&self.solver.residual).map(|(&i, residual)| load(i) * residual).sum()
    }

    /// True if the traces have led too far from the equilibrium of the whole contact, but for what they were known to lack.
    fn astray(&self) -> bool {
        let contacts = &self.front.state.contacts;
        let off: Vec<f64> = contacts.iter().zip(&self.solver.residual).map(|(&i, residual)| residual + self.whole_lags[i]).collect();
        let worst = off.iter().map(|r| r.abs()).fold(0.0, f64::max);
        let rms = (dot(&off, &off) / off.len().max(1) as f64).sqrt();
        worst > WORST * self.scale() || rms > DRIFT * self.scale()
    }

    /// New traces of everything after the whole contact was solved; the work since the old ones is counted.
    fn retrace(&mut self, rates: &[f64], since: Since) {
        let problem = self.problem();
        let target = self.front.state.approach_m;
        let jump = since != Since::Growth;
        let shifted = match since {
            Since::Jump(shifted) if !shifted.is_nan() => Some(shifted),
            _ => None,
        };
        if jump {
            self.log.pass(target, self.front.totals(target).load_n);
        }
        self.far_load(target, 0.0);
        let (mut relaxed, mut grown) = (0.0, -std::mem::take(&mut self.far));
        for (k, rate) in rates.iter().enumerate() {
            let i = self.front.state.contacts[k];
            let (asperity, a) = (&problem.asperities[i], self.front.state.radius[i]);
            let trace = Trace::of(asperity, target, a, *rate);
            let from = self.front.traces[i];
            if !from.value.is_nan() {
                let to = if jump { Trace { at: target, value: from.ahead(target), ..from } } else { trace };
                self.log.work_j += work(problem, i, from, to);
                if jump {
                    let more = asperity.load(a) - asperity.load(asperity.radius_ahead(to.value));
                    if shifted.is_none() {
                        relaxed += 0.5 * self.whole_lags[i] * more;
                    }
                    grown += more;
                }
            }
            self.front.traces[i] = trace;
        }
        self.forget();
        if since == Since::Both {
            // What the lags do not explain has grown with the square of the way.
            self.log.work_j += grown * (target - self.settled_at) / 3.0;
        }
        self.front.recount(problem);
        let (totals, potential) = problem.totals(&self.front.state);
        self.totals = totals;
        // Events were charged with the potential of a contact whose other spots keep their loads; those have answered now.
        self.log.charge(shifted.map_or(relaxed, |shifted| shifted - potential));
        let lost: f64 = self.log.events[self.settled..].iter().map(|event| event.energy_lost_j).sum();
        let balance = potential + lost - self.log.work_j;
        if std::mem::take(&mut self.unbalanced) {
            self.log.charge(self.balance - balance);
        }
        // From one solution of the whole to the next only the events since are counted.
        self.balance = potential - self.log.work_j;
        self.settled_at = target;
        if jump {
            self.log.restart(target, self.front.totals(target).load_n);
        } else {
            self.log.pass(target, self.front.totals(target).load_n);
        }
        self.watch(rates);
    }

    /// New traces of the free asperities that may come to their jump-in. All are taken anew now and then; between, only those that can have come
    /// near: the half-space follows the surface, so that none grows by more than three times the way.
    fn watch(&mut self, rates: &[f64]) {
        let problem = self.problem();
        let (target, unit) = (self.front.state.approach_m, problem.rms_height_m);
        let block = |approach: f64| (approach / (0.05 * unit)).floor();
        let anew = self.watched_at.is_none_or(|at| block(target) != block(at));
        let near = |i: &usize| {
            let trace = &self.front.traces[*i];
            let margin = 3.0 * (target - trace.at).abs() + self.scale();
            anew || trace.value.is_nan() || trace.value > problem.jump_in[*i] - margin
        };
        let wanted: Vec<usize> = (0..problem.len()).filter(|i| self.front.state.status[*i] == Status::Free).filter(near).collect();
        let found = self.solver.penetrations(&self.front.state, rates, &wanted);
        if anew {
            self.watched_at = Some(target);
        }
        let span = 3.0 * self.longest + self.scale();
        self.front.candidates.clear();
        for (i, trace) in wanted.into_iter().zip(found) {
            self.front.traces[i] = trace;
            self.front.state.barred[i] &= trace.value >= problem.jump_in[i];
            if trace.value > problem.jump_in[i] - span {
                self.front.candidates.push(i);
            }
        }
    }

    /// Changes that are due in the whole contact, the most overdue first, each with its lateness \[m\].
    fn overdue(&mut self) -> Vec<(f64, Change)> {
        let problem = self.problem();
        let contacts = self.front.state.contacts.clone();
        let candidates = self.front.candidates.clone();
        let due = self.due(&contacts, &candidates);
        let mut late: Vec<(f64, Change)> = due.iter().map(|t| (problem.lateness(t, &self.front), t.change)).collect();
        late.sort_by(|u, v| v.0.total_cmp(&u.0).then(u.1.asperity.cmp(&v.1.asperity)));
        late
    }

    /// Where Newton's method finds no equilibrium of the whole contact, it relaxes. What leaves or is covered on the way belongs to the avalanche at
    /// hand; what the potential loses is charged to it when the whole is counted.
    fn relax_whole(&mut self, target: f64) -> Result<(), Halt> {
        let before = self.front.totals(target);
        let changes = self.solver.relax(&mut self.front.state)?;
        for change in &changes {
            self.front.traces[change.asperity].value = f64::NAN;
            self.front.set(change.asperity, change.status(self.problem()), 0.0);
        }
        let (after, _) = self.problem().totals(&self.front.state);
        self.record(&changes, target, before, after, 0.0);
        self.unbalanced = true;
        Ok(())
    }

    /// Last resort: the whole contact goes to `target` and relaxes there.
    pub(crate) fn collapse(&mut self, target: f64) -> Result<(), Halt> {
        self.log.begin_avalanche();
        let events = self.log.events.len();
        let asperity = self.front.state.contacts.first().copied().unwrap_or(0);
        self.front.go_to(self.problem(), target);
        self.relax_whole(target)?;
        if self.log.events.len() == events {
            let (before, (after, _)) = (self.totals, self.problem().totals(&self.front.state));
            self.record(&[Change { kind: Kind::Snap, asperity, by: None }], target, before, after, 0.0);
        }
        for i in self.front.state.contacts.clone() {
            self.front.traces[i].value = f64::NAN;
        }
        self.log.work_j += self.totals.load_n * (target - self.settled_at);
        self.settle(target, false, true, Depth::Whole)
    }

    /// Writes changes of one relaxation down; its energy is the first one's.
    pub(crate) fn record(&mut self, moved: &[Change], approach: f64, before: Totals, after: Totals, energy: f64) {
        for change in moved.iter().filter(|change| change.kind != Kind::JumpOff) {
            self.flips[change.asperity] = self.flips[change.asperity].saturating_add(1);
        }
        self.log.record(moved, approach, before, after, energy);
    }
}
