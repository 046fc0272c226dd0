//! The events of a stretch: each is located in its neighbourhood, taken, and followed by all that it brings about.

use super::PhysicsError;
use super::equilibrium::Unsettled;
use super::events::{Change, Kind, Trigger};
use super::front::{CurvePoint, Due, gauss, hermite_slope, work, work_along};
use super::locate::{Found, Point};
use super::patch::{Hold, Trace};
use super::path::{EVENT_TOLERANCE, FLIPS, Halt, Path};
use super::state::Status;
use crate::model::Interaction;

/// Share of its radius by which a spot is moved over a fold.
const NUDGE: f64 = 1e-3;

/// How an event was found: which member was followed, and whether a fold came first.
#[derive(Debug, Clone, Copy)]
struct Located {
    leader: Option<usize>,
    fold: bool,
}

impl Path<'_> {
    /// Finds and takes the events on the way to `target` \[m\], in their order. Where one moves what is outside its neighbourhood by more
    /// than `limit` \[m\], its approach is returned: the whole contact is to be solved there.
    pub(crate) fn events_until(&mut self, target: f64, limit: f64) -> Result<Option<f64>, Halt> {
        let problem = self.problem();
        let tolerance = EVENT_TOLERANCE * problem.rms_height_m;
        let mut queue = Vec::new();
        for &i in self.front.state.contacts.iter().chain(&self.front.candidates) {
            self.front.expect(problem, i, target, self.sign, &mut queue);
        }
        self.queue = queue;
        let mut looks = 0;
        while let Some(at) = self.first_due() {
            let due = self.queue.swap_remove(at);
            looks += 1;
            if looks > 100 * (problem.len() + 100) {
                return Err(Unsettled { residual_m: f64::NAN, asperity: due.change.asperity }.into());
            }
            let Some(located) = self.locate(&due, target) else { continue };
            let approach = self.patch.approach;
            if self.queue.iter().any(|other| (approach - other.approach) * self.sign > tolerance) {
                self.queue.push(Due { approach, ..due });
                continue;
            }
            self.close(located, due.change.kind);
            self.log.avalanches += 1;
            self.shift = 0.0;
            let mut moved = Vec::new();
            let mut open = Vec::new();
            self.take(due.change, Some(located), &mut moved, &mut open)?;
            self.rest(moved, open)?;
            if self.shift > limit {
                return Ok(Some(self.patch.approach));
            }
            // What has been touched is expected anew.
            let touched = std::mem::take(&mut self.touched);
            self.queue.retain(|due| {
                let is = |i: usize| touched.binary_search(&i).is_ok();
                !is(due.change.asperity) && !due.change.by.is_some_and(is)
            });
            let mut queue = std::mem::take(&mut self.queue);
            for &i in &touched {
                self.front.expect(problem, i, target, self.sign, &mut queue);
            }
            self.queue = queue;
        }
        Ok(None)
    }

    fn first_due(&self) -> Option<usize> {
        let key = |due: &Due| (due.approach * self.sign, due.change.asperity, due.change.kind);
        (0..self.queue.len()).min_by(|a, b| {
            let (u, v) = (key(&self.queue[*a]), key(&self.queue[*b]));
            u.0.total_cmp(&v.0).then(u.1.cmp(&v.1)).then(u.2.cmp(&v.2))
        })
    }

    /// Gathers the neighbourhood of a change, at an approach or where its spots were known last.
    fn gather(&mut self, change: &Change, approach: Option<f64>) {
        let problem = self.problem();
        let centre = match change.kind {
            Kind::Cover | Kind::Uncover => change.by.unwrap_or(change.asperity),
            _ => change.asperity,
        };
        let most = if problem.rules.interaction == Interaction::None { 1 } else { self.spots };
        let place = problem.positions[centre];
        let contacts = &self.front.state.contacts;
        let distance = |i: usize| problem.neighbours.distance(&place, &problem.positions[i]);
        self.halo.clear();
        let (members, reach) = if contacts.len() <= most {
            (contacts.clone(), f64::INFINITY)
        } else {
            let mut near: Vec<(f64, usize)> = contacts.iter().map(|&i| (distance(i), i)).collect();
            near.select_nth_unstable_by(most - 1, |u, v| u.0.total_cmp(&v.0).then(u.1.cmp(&v.1)));
            let reach = near[..most].iter().map(|(r, _)| *r).fold(0.0, f64::max);
            let mut members: Vec<usize> = near[..most].iter().map(|(_, i)| *i).collect();
            for i in [Some(change.asperity), change.by].into_iter().flatten() {
                if self.front.state.status[i] == Status::Contact && !members.contains(&i) {
                    members.push(i);
                }
            }
            members.sort_unstable();
            self.halo.extend(contacts.iter().copied().filter(|i| members.binary_search(i).is_err()));
            (members, reach)
        };
        let traces = &self.front.traces;
        let mut watched: Vec<usize> =
            self.front.candidates.iter().copied().filter(|i| !traces[*i].value.is_nan() && distance(*i) <= reach).collect();
        if change.kind == Kind::JumpIn
            && let Err(at) = watched.binary_search(&change.asperity)
        {
            watched.insert(at, change.asperity);
        }
        let approach = approach.unwrap_or_else(|| {
            let asperity = (change.kind == Kind::JumpIn).then_some(change.asperity);
            let known = members.iter().copied().chain(asperity).map(|i| traces[i].at);
            known.max_by(|u, v| (u * self.sign).total_cmp(&(v * self.sign))).unwrap_or(self.front.state.approach_m)
        });
        let of = |list: Vec<usize>| -> Vec<(usize, Trace)> { list.into_iter().map(|i| (i, traces[i])).collect() };
        self.patch.gather(problem, &of(members), &of(watched), approach, &mut self.solver.effort);
    }

    /// Goes to where a change happens: the patch stands there, before it. Nothing where it does not happen before `target`.
    fn locate(&mut self, due: &Due, target: f64) -> Option<Located> {
        self.gather(&due.change, None);
        let problem = self.problem();
        let (patch, effort) = (&mut self.patch, &mut self.solver.effort);
        let Change { kind, asperity: i, by } = due.change;
        let start = patch.approach;
        self.origin.clear();
        self.origin.extend(patch.radius.iter().copied());
        self.reference = start;
        if kind == Kind::JumpIn {
            let watched = patch.watched.iter().position(|w| w.asperity == i)?;
            if patch.penetration_of(problem, watched, effort) < problem.jump_in[i] {
                // From near the place where it is expected, so that Newton's method has a short way.
                let guess = if (due.approach - start) * self.sign > 0.0 { due.approach } else { start };
                patch.ahead(problem, guess);
                patch.solve(problem, Hold::Penetration(watched, problem.jump_in[i]), effort).ok()?;
            }
            let way = (patch.approach - start) * self.sign;
            let inside = way >= -EVENT_TOLERANCE * problem.rms_height_m && (patch.approach - target) * self.sign <= 0.0;
            return inside.then_some(Located { leader: None, fold: false });
        }
        let (spot, bound) = match (kind, self.front.state.status[i]) {
            (Kind::JumpOff, _) => (i, problem.asperities[i].jump_off_radius()),
            (Kind::Cover, _) => {
                let by = by?;
                (by, problem.neighbours.distance(&problem.positions[i], &problem.positions[by]))
            }
            (Kind::Uncover, Status::Covered { by, release_m }) => (by, release_m),
            (Kind::Snap, _) => (i, 1.5 * patch.radius[patch.find(i)?]),
            _ => return None,
        };
        let at = patch.find(spot)?;
        let grows = matches!(kind, Kind::Cover | Kind::Snap);
        let there = if grows { patch.radius[at] >= bound } else { patch.radius[at] <= bound };
        if there {
            return Some(Located { leader: None, fold: false });
        }
        match patch.follow(problem, at, bound, (target, self.sign), effort) {
            Ok(Found::Fold) => Some(Located { leader: Some(at), fold: true }),
            Ok(Found::Bound) if kind != Kind::Snap && (patch.approach - target) * self.sign <= 0.0 => {
                Some(Located { leader: Some(at), fold: false })
            }
            _ => None,
        }
    }

    /// Brings the front of the patch to where the patch stands now, before an event, and counts the work on the way.
    fn close(&mut self, located: Located, kind: Kind) {
        let problem = self.problem();
        let (approach, reference) = (self.patch.approach, self.reference);
        // Near the end of a branch the radius is the parameter in which all is smooth; at the edge of a spot it is the approach.
        let stations = if located.fold || kind == Kind::JumpOff { std::mem::take(&mut self.patch.way) } else { Vec::new() };
        let rates = if located.fold { None } else { Some(self.patch.rates(problem).0) };
        self.lag_on_the_way(&stations);
        for k in 0..self.patch.members.len() {
            let (i, a) = (self.patch.members[k].asperity, self.patch.radius[k]);
            let asperity = &problem.asperities[i];
            let from = self.front.traces[i];
            let value = asperity.penetration(a);
            let rate = match &rates {
                Some(rates) => asperity.penetration_slope(a) * rates[k],
                None if approach == from.at => from.rate,
                None => (value - from.value) / (approach - from.at),
            };
            let trace = Trace { at: approach, value, rate };
            let parts = stations.windows(2).map(|pair| work_along(problem, i, pair[1].at - pair[0].at, pair[0].of(k), pair[1].of(k)));
            self.log.work_j += if from.at == reference && stations.len() > 1 { parts.sum() } else { work(problem, i, from, trace) };
            self.pending.push((i, a, trace));
        }
        self.commit();
    }

    /// The field at the spots outside the neighbourhood is another by `moved` \[m\], and they do not know it yet. What they will do to the load
    /// is known to first order: by reciprocity the whole load answers to a displacement under one spot as that spot's load answers to
    /// the approach.
    fn lag(&mut self, moved: Vec<f64>) {
        let problem = self.problem();
        let mut answer = 0.0;
        for (&j, moved) in self.halo.iter().zip(moved) {
            self.lags[j] += moved;
            self.shift = self.shift.max(self.lags[j].abs());
            answer -= problem.asperities[j].load_slope(self.front.state.radius[j]) * self.front.speed(problem, j) * moved;
        }
        self.far_load(self.patch.approach, answer);
    }

    /// Where the neighbourhood has gone another way than in proportion to the approach, the spots outside it do not know it yet: the same.
    fn lag_on_the_way(&mut self, stations: &[Point]) {
        if self.halo.is_empty() {
            return;
        }
        let problem = self.problem();
        let effort = &mut self.solver.effort;
        let (there, approach) = (self.patch.radius.clone(), self.patch.approach);
        let now = self.patch.fields_at(problem, &self.halo, effort);
        let speeds: Vec<f64> = self.patch.members.iter().map(|m| self.front.speed(problem, m.asperity)).collect();
        self.patch.radius.clone_from(&self.origin);
        self.patch.approach = self.reference;
        self.patch.evaluate(problem, effort);
        let way = approach - self.reference;
        let expected = self.patch.fields_ahead(problem, &self.halo, &speeds, way, effort);
        self.patch.radius = there;
        self.patch.approach = approach;
        self.patch.evaluate(problem, effort);
        let before = self.far;
        self.lag(now.iter().zip(&expected).map(|(now, expected)| now - expected).collect());
        // It has grown on the way, slowly at first.
        let grown = self.far - before;
        self.log.work_j += grown * mean_square(stations, way);
    }

    /// Brings spots of the patch that were known at an earlier approach to the present one, and counts their work on the way.
    fn catch_up(&mut self) {
        let problem = self.problem();
        let approach = self.patch.approach;
        for (member, a) in self.patch.members.iter().zip(&self.patch.radius) {
            let i = member.asperity;
            let from = self.front.traces[i];
            if from.at != approach {
                let to = Trace { at: approach, value: problem.asperities[i].penetration(*a), ..from };
                self.log.work_j += work(problem, i, from, to);
                self.pending.push((i, *a, to));
            }
        }
        self.commit();
    }

    /// Puts the pending traces of spots into the front and its sums.
    fn commit(&mut self) {
        let problem = self.problem();
        let pending = std::mem::take(&mut self.pending);
        for (i, a, trace) in &pending {
            if !self.front.traces[*i].value.is_nan() {
                self.front.count(problem, *i, -1.0, trace.at);
            }
            self.front.state.radius[*i] = *a;
            self.front.traces[*i] = *trace;
            self.front.count(problem, *i, 1.0, trace.at);
        }
        self.pending = pending;
        self.pending.clear();
    }

    /// An event that is due at the present approach, and all that follows it there.
    pub(crate) fn avalanche(&mut self, first: Change) -> Result<(), Halt> {
        self.gather(&first, Some(self.front.state.approach_m));
        self.catch_up();
        let (mut moved, mut open) = (Vec::new(), Vec::new());
        self.take(first, None, &mut moved, &mut open)?;
        self.rest(moved, open)
    }

    /// Takes what is due among the `open` asperities until nothing is. What would undo a change at once is remembered at the end, and waits
    /// for the path to go on (see [`super::events`]).
    fn rest(&mut self, mut moved: Vec<Change>, mut open: Vec<usize>) -> Result<(), Halt> {
        let problem = self.problem();
        let approach = self.patch.approach;
        let bound = 10 * problem.len() + 100;
        let mut taken = 0;
        loop {
            open.sort_unstable();
            open.dedup();
            let due = self.due(&open, &open);
            let next = due
                .into_iter()
                .filter(|trigger| !trigger.change.returns(&moved, &self.front.state))
                .max_by(|u, v| u.overshoot.total_cmp(&v.overshoot).then(v.change.asperity.cmp(&u.change.asperity)));
            let Some(next) = next else { break };
            taken += 1;
            if taken > bound {
                let asperity = next.change.asperity;
                return Err(Halt::Error(PhysicsError::EndlessAvalanche { approach_m: approach, events: taken, asperity }));
            }
            self.gather(&next.change, Some(approach));
            self.catch_up();
            self.take(next.change, None, &mut moved, &mut open)?;
        }
        for change in &moved {
            let i = change.asperity;
            match self.front.state.status[i] {
                Status::Covered { by, release_m } => {
                    if self.front.state.radius[by] < release_m {
                        // The covering spot has shrunk by covering it.
                        self.keep_covered(i);
                    }
                }
                Status::Contact => {}
                Status::Free => self.front.state.barred[i] = self.front.traces[i].value >= problem.jump_in[i],
            }
        }
        self.touched = open;
        Ok(())
    }

    /// The changes that are due, but for those of asperities that flip to and fro: such an asperity is held as it is for a while, and counted.
    /// Two spots that each grow when the other is there, and withdraw when it is not, have no rest otherwise.
    pub(crate) fn due(&mut self, touched: &[usize], free: &[usize]) -> Vec<Trigger> {
        let mut due = self.problem().triggers(&self.front, touched, free);
        let state = &self.front.state;
        due.retain(|trigger| {
            let i = trigger.change.asperity;
            let orphan = matches!(state.status[i], Status::Covered { by, .. } if state.radius[by] == 0.0);
            let taken = trigger.change.kind == Kind::JumpOff || orphan || self.flips[i] < FLIPS;
            if !taken && !self.held.contains(&i) {
                self.held.push(i);
            }
            taken
        });
        due
    }

    /// Applies one change in the patch that stands at it, lets the patch relax and writes both down: adds the changes to what has `moved`,
    /// and all asperities whose state is another now to those that are `open`.
    fn take(&mut self, change: Change, located: Option<Located>, moved: &mut Vec<Change>, open: &mut Vec<usize>) -> Result<(), Halt> {
        let problem = self.problem();
        let i = change.asperity;
        let before = self.front.totals(self.patch.approach);
        self.log.pass(self.patch.approach, before.load_n);
        let mut potential = self.patch.totals(problem).1;
        let halo = self.patch.fields_at(problem, &self.halo, &mut self.solver.effort);
        let mut taken = Vec::new();
        if let Some(Located { leader: Some(at), fold: true }) = located {
            let sense = if self.patch.radius[at] > self.origin[at] { 1.0 } else { -1.0 };
            let gap = self.sign * EVENT_TOLERANCE * problem.rms_height_m;
            potential += gap * self.patch.potential_slope(problem);
            self.log.work_j += gap * self.patch.totals(problem).0;
            let leader = self.patch.members[at].asperity;
            self.patch.nudge(problem, at, sense * NUDGE, gap);
            taken = self.patch.relax(problem, None, &mut self.solver.effort)?;
            if taken.is_empty() {
                taken.push(Change { kind: Kind::Snap, asperity: leader, by: None });
            }
        } else {
            if !self.change(change) {
                return Ok(());
            }
            taken.push(change);
            let start = self.patch.radius.clone();
            let settled = self.patch.solve(problem, Hold::Approach, &mut self.solver.effort).is_ok() && self.patch.rates(problem).1;
            if !settled {
                self.patch.radius = start;
                let uncovered = (change.kind == Kind::Uncover).then_some(&change);
                match self.patch.relax(problem, uncovered, &mut self.solver.effort) {
                    Ok(further) => taken.extend(further),
                    Err(_) if uncovered.is_some() => {
                        self.keep_covered(i);
                        return Ok(());
                    }
                    Err(unsettled) => return Err(unsettled.into()),
                }
            }
            if change.kind == Kind::Uncover && self.vain(&change, &taken) {
                self.keep_covered(i);
                return Ok(());
            }
        }
        let after_potential = self.patch.totals(problem).1;
        let moved_by = self.patch.fields_at(problem, &self.halo, &mut self.solver.effort);
        self.lag(halo.iter().zip(&moved_by).map(|(before, after)| after - before).collect());
        for change in &taken {
            self.enter(change, open);
        }
        let (rates, _) = self.patch.rates(problem);
        for (k, rate) in rates.iter().enumerate() {
            let (i, a) = (self.patch.members[k].asperity, self.patch.radius[k]);
            let asperity = &problem.asperities[i];
            let trace = Trace { at: self.patch.approach, value: asperity.penetration(a), rate: asperity.penetration_slope(a) * rate };
            self.pending.push((i, a, trace));
            open.push(i);
        }
        self.commit();
        let watched = self.patch.watch(problem, &rates, &mut self.solver.effort);
        for (place, trace) in self.patch.watched.iter().zip(watched) {
            self.front.traces[place.asperity] = trace;
            self.front.state.barred[place.asperity] &= trace.value >= problem.jump_in[place.asperity];
            open.push(place.asperity);
        }
        let after = self.front.totals(self.patch.approach);
        self.log.restart(self.patch.approach, after.load_n);
        self.record(&taken, self.patch.approach, before, after, potential - after_potential);
        moved.extend(taken);
        Ok(())
    }

    /// Applies a change to the patch, without relaxing it; says whether there is anything to be relaxed or written down.
    fn change(&mut self, change: Change) -> bool {
        let problem = self.problem();
        let i = change.asperity;
        let asperity = &problem.asperities[i];
        match change.kind {
            Kind::JumpIn => {
                if let Some(at) = self.patch.watched.iter().position(|w| w.asperity == i) {
                    let place = self.patch.watched[at];
                    let penetration = self.patch.penetration_of(problem, at, &mut self.solver.effort);
                    self.patch.insert(place, asperity.radius_at_penetration(penetration).unwrap_or(asperity.jump_off_radius()));
                }
            }
            Kind::JumpOff => self.patch.remove(i, true),
            Kind::Cover => self.patch.remove(i, false),
            Kind::Uncover => {
                if let Some((by, release_m)) = problem.covering(&self.front.state, i, change.by) {
                    // Another spot covers it as well: nothing moves.
                    self.front.set(i, Status::Covered { by, release_m }, 0.0);
                    return false;
                }
                let approach = self.patch.approach;
                let spots: Vec<(usize, f64)> = self.front.radii(problem, approach);
                let displacement = self.solver.displacement(&spots, i);
                let place = self.patch.place(problem, i, displacement, &mut self.solver.effort);
                match asperity.radius_at_penetration(approach + problem.heights[i] - displacement) {
                    Some(radius) => self.patch.insert(place, radius),
                    None => self.patch.watched.push(place),
                }
            }
            Kind::Snap => {}
        }
        true
    }

    /// Whether an uncovering was in vain: it was undone on the way, or is to be undone at once.
    fn vain(&self, uncovering: &Change, taken: &[Change]) -> bool {
        let problem = self.problem();
        let Some(by) = uncovering.by else { return false };
        let i = uncovering.asperity;
        let radius = |j: usize| self.patch.find(j).map_or(0.0, |k| self.patch.radius[k]);
        let distance = problem.neighbours.distance(&problem.positions[i], &problem.positions[by]);
        let (mine, its) = (radius(i), radius(by));
        taken.iter().any(|change| change.undoes(uncovering)) || (its >= distance && mine < its) || (mine >= distance && its < mine)
    }

    /// Enters the status after a change into the front.
    fn enter(&mut self, change: &Change, open: &mut Vec<usize>) {
        let problem = self.problem();
        let i = change.asperity;
        let approach = self.patch.approach;
        open.push(i);
        let now = match change.kind {
            Kind::Snap => return,
            Kind::JumpIn | Kind::Uncover if self.patch.find(i).is_some() => Status::Contact,
            _ => change.status(problem),
        };
        if self.front.state.status[i] == Status::Contact && now != Status::Contact && !self.front.traces[i].value.is_nan() {
            self.front.count(problem, i, -1.0, approach);
        }
        self.front.traces[i].value = f64::NAN;
        self.front.set(i, now, 0.0);
    }
}

/// `∫s² dδ` along a way on which s goes from 0 to 1 in proportion to the radius that is followed, or to the approach \[m\].
fn mean_square(stations: &[Point], way: f64) -> f64 {
    let (Some(first), Some(last)) = (stations.first(), stations.last()) else { return way / 3.0 };
    let whole = last.at - first.at;
    if whole == 0.0 {
        return way / 3.0;
    }
    let part = |pair: &[Point]| {
        let span = pair[1].at - pair[0].at;
        gauss(|p| {
            let s = (pair[0].at + p * span - first.at) / whole;
            s * s * hermite_slope(p, pair[0].approach, pair[1].approach, pair[0].slope * span, pair[1].slope * span)
        })
    };
    stations.windows(2).map(part).sum()
}

impl Point {
    /// The point as one member has it.
    fn of(&self, member: usize) -> CurvePoint {
        CurvePoint { radius: [self.radius[member], self.direction[member]], approach: [self.approach, self.slope] }
    }
}
