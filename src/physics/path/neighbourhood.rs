//! The neighbourhood of an event within the whole contact: its spots are solved together, those around it learn of it later.
//!
//! What a neighbourhood does to the spots next to it is a lag: a displacement that they have and do not know. A spot learns of its lag when it
//! is in a neighbourhood next, and so does everything that has come to lag too far; a wave of small solutions goes out from an event until
//! what is left of it is small. Their answer to the load is counted before, to first order: by reciprocity, what the loads of a neighbourhood
//! do to the rest of the contact is what the rest does to them as the approach goes on.

use super::equilibrium_path::{Halt, Path};
use super::pending::Ripple;
use super::predictor::{CurvePoint, work, work_along};
use crate::model::Interaction;
use crate::physics::contact::problem::Totals;
use crate::physics::contact::state::Status;
use crate::physics::contact::transition::{Change, Kind};
use crate::physics::math::quadrature::{gauss, hermite_slope};
use crate::physics::solve::local::outside::Stood;
use crate::physics::solve::local::{Hold, Place, Point};
use crate::physics::solve::trace::Trace;

/// Spots that learn of an event at once or lag, over those that are solved with it.
const AROUND: usize = 5;

/// Spots that are solved together where few find no rest, over the usual number.
const WIDE: usize = 4;

/// Free asperities next to an event are watched from so many jump-off penetrations before their jump-in.
const SPAN: f64 = 5.0;

/// Distance over reach from which on a ripple is the same for a whole neighbourhood.
const AFAR: f64 = 4.0;

/// Share of the largest lag that spots of a neighbourhood may have when it is solved.
const LEAST_LAG: f64 = 0.1;

/// A neighbourhood before it is changed.
pub(crate) struct Before {
    totals: Totals,
    pub(crate) potential: f64,
    /// Spots.
    stood: Vec<Stood>,
    /// Load of its spots, and what the rest of the contact does to their loads as the approach goes on \[N\].
    load: f64,
    pull: f64,
}

impl Path<'_> {
    /// Gathers the neighbourhood of a change, at an approach or where its spots were known last.
    pub(crate) fn gather(&mut self, change: &Change, approach: Option<f64>) {
        self.gather_so_many(change, approach, self.problem().spots_in_patch);
    }

    /// The same, of so many spots.
    fn gather_so_many(&mut self, change: &Change, approach: Option<f64>, spots: usize) {
        let problem = self.problem();
        let centre = match change.kind {
            Kind::Cover | Kind::Uncover => change.by.unwrap_or(change.asperity),
            _ => change.asperity,
        };
        let alone = problem.rules.interaction == Interaction::None;
        let most = if alone { 1 } else { spots };
        let place = problem.positions[centre];
        let (state, traces) = (&self.front.state, &self.front.traces);
        // An event next to a free asperity moves it by some jump-off penetrations.
        let span = SPAN * self.scale();
        let near_jump_in = |i: &usize| state.status[*i] == Status::Free && traces[*i].value > problem.jump_in[*i] - span;
        self.halo.clear();
        let (members, mut watched): (Vec<usize>, Vec<usize>) = if state.contacts.len() <= most {
            (state.contacts.clone(), (0..problem.len()).filter(near_jump_in).collect())
        } else {
            let near = problem
                .neighbours
                .nearest(&place, most.saturating_mul(AROUND), state.contacts.len(), |i| state.status[i] == Status::Contact);
            let mut members: Vec<usize> = near[..most].iter().map(|(_, i)| *i).collect();
            for i in [Some(change.asperity), change.by].into_iter().flatten() {
                if state.status[i] == Status::Contact && !members.contains(&i) {
                    members.push(i);
                }
            }
            members.sort_unstable();
            let reach = near[most - 1].0;
            let mut watched = Vec::new();
            if !alone {
                self.halo_reach = near.last().map_or(reach, |(r, _)| *r);
                self.halo.extend(near[most..].iter().map(|(_, i)| *i).filter(|i| members.binary_search(i).is_err()));
                problem.neighbours.around(&place, self.halo_reach, |r, i| {
                    if near_jump_in(&i) {
                        if r <= reach { &mut watched } else { &mut self.halo }.push(i);
                    }
                });
            }
            watched.sort_unstable();
            (members, watched)
        };
        if change.kind == Kind::JumpIn
            && let Err(at) = watched.binary_search(&change.asperity)
        {
            watched.insert(at, change.asperity);
            self.halo.retain(|i| *i != change.asperity);
        }
        self.centre = place;
        let approach = approach.unwrap_or_else(|| {
            let asperity = (change.kind == Kind::JumpIn).then_some(change.asperity);
            let known = members.iter().copied().chain(asperity).map(|i| traces[i].at);
            known.max_by(|u, v| (u * self.sign).total_cmp(&(v * self.sign))).unwrap_or(self.front.state.approach_m)
        });
        let members: Vec<_> = members.into_iter().map(|i| (i, traces[i], self.front.radius(problem, i, approach))).collect();
        let watched: Vec<_> = watched.into_iter().map(|i| (i, traces[i])).collect();
        let local = members.len() < self.front.state.contacts.len();
        self.patch.gather(problem, &members, &watched, approach, local, &mut self.solver.effort);
        self.learn();
    }

    /// What the spots of the neighbourhood do not know yet; the free asperities learn it, since they have nothing to answer.
    fn learn(&mut self) {
        let problem = self.problem();
        self.missed.clear();
        self.missed.extend(self.patch.members.iter().map(|m| self.lags[m.asperity]));
        let places = self.patch.members.iter().chain(&self.patch.watched);
        let oldest = places.clone().map(|place| self.heard[place.asperity]).min().unwrap_or(0);
        let mut missed_by_free = vec![0.0; self.patch.watched.len()];
        for (number, ripple) in self.ripples.iter().enumerate().skip(oldest) {
            let field = |place: &[f64; 2]| ripple.field(problem, place);
            // From afar it is the same for all.
            let afar = problem.neighbours.distance(&self.centre, &ripple.place) > AFAR * ripple.reach;
            let all = if afar { Some(field(&self.centre)) } else { None };
            let heard = |i: usize| {
                let place = &problem.positions[i];
                let hears = self.heard[i] <= number && (afar || ripple.passes(problem, place));
                if hears { all.unwrap_or_else(|| field(place)) } else { 0.0 }
            };
            for (missed, member) in self.missed.iter_mut().zip(&self.patch.members) {
                *missed += heard(member.asperity);
            }
            for (missed, place) in missed_by_free.iter_mut().zip(&self.patch.watched) {
                *missed += heard(place.asperity);
            }
        }
        for (place, missed) in self.patch.watched.iter_mut().zip(missed_by_free) {
            place.outside += missed;
        }
    }

    /// Lags of all spots, with what has come from afar.
    pub(crate) fn gather_lags(&mut self) {
        for k in 0..self.front.state.contacts.len() {
            let i = self.front.state.contacts[k];
            self.whole_lags[i] = self.whole_lag(i);
        }
    }

    fn whole_lag(&self, i: usize) -> f64 {
        let problem = self.problem();
        let place = &problem.positions[i];
        let afar = self.ripples[self.heard[i]..].iter().filter(|ripple| ripple.passes(problem, place));
        self.lags[i] + afar.map(|ripple| ripple.field(problem, place)).sum::<f64>()
    }

    /// True if spots of the neighbourhood have lags that matter.
    pub(crate) fn lagging(&self) -> bool {
        let limit = LEAST_LAG * self.lag_limit();
        self.missed.iter().any(|lag| lag.abs() > limit)
    }

    /// The spot that lags most, if that is too much.
    pub(crate) fn most_lagging(&mut self) -> Option<usize> {
        let limit = self.lag_limit();
        let (lags, status) = (&self.lags, &self.front.state.status);
        self.urgent.retain(|i| status[*i] == Status::Contact && lags[*i].abs() > limit);
        self.urgent.iter().copied().max_by(|i, j| lags[*i].abs().total_cmp(&lags[*j].abs()).then(j.cmp(i)))
    }

    /// The spots of the neighbourhood of a change, which was gathered, learn of their lags. What leaves or is covered by that is added to what has `moved`, and
    /// all asperities whose state is another now to those that are `open`.
    pub(crate) fn absorb(&mut self, change: &Change, moved: &mut Vec<Change>, open: &mut Vec<usize>) -> Result<(), Halt> {
        let problem = self.problem();
        let approach = self.patch.approach;
        let mut spots = problem.spots_in_patch;
        let (before, start, taken) = loop {
            self.catch_up();
            let before = self.begin();
            for (member, lag) in self.patch.members.iter_mut().zip(&self.missed) {
                member.outside += lag;
            }
            let load = |k: usize| problem.asperities[self.patch.members[k].asperity].load(self.patch.radius[k]);
            let start: Vec<(usize, f64, f64, f64)> =
                (0..self.missed.len()).map(|k| (self.patch.members[k].asperity, self.patch.radius[k], load(k), self.missed[k])).collect();
            if self.patch.solve(problem, Hold::Approach, &mut self.solver.effort).is_ok() && self.patch.rates(problem).1 {
                break (before, start, Vec::new());
            }
            // Few spots may find no rest where more do.
            if spots == problem.spots_in_patch && self.patch.members.len() < self.front.state.contacts.len() {
                spots = spots.saturating_mul(WIDE);
                self.gather_so_many(change, Some(approach), spots);
                continue;
            }
            for (radius, from) in self.patch.radius.iter_mut().zip(&start) {
                *radius = from.1;
            }
            let mut taken = self.patch.relax(problem, None, &mut self.solver.effort)?;
            if taken.is_empty() {
                taken.push(Change { kind: Kind::Snap, asperity: change.asperity, by: None });
            }
            break (before, start, taken);
        };
        // The event that is the cause was charged as if the loads here had not changed: their work on the lags is no part of the energy.
        let mut energy = before.potential - self.patch.totals(problem).1;
        let mut expected = 0.0;
        for (i, _, load, lag) in start {
            (self.lags[i], self.heard[i]) = (0.0, self.ripples.len());
            energy -= lag * load;
            expected += self.front.answer(problem, i) * lag;
        }
        self.far_load(approach, expected);
        if taken.is_empty() {
            self.log.charge(energy);
        }
        self.finish(&before, taken, energy, moved, open);
        Ok(())
    }

    /// Before the neighbourhood changes at its approach.
    pub(crate) fn begin(&mut self) -> Before {
        let problem = self.problem();
        let totals = self.front.totals(self.patch.approach);
        self.log.pass(self.patch.approach, totals.load_n);
        let (load, potential) = self.patch.totals(problem);
        Before { totals, potential, load, stood: self.patch.stand(problem), pull: self.patch.pull(problem) }
    }

    /// After the neighbourhood has changed: the front has it so, and the changes that were `taken` are written down, and lost so much energy \[J\].
    pub(crate) fn finish(&mut self, before: &Before, taken: Vec<Change>, energy: f64, moved: &mut Vec<Change>, open: &mut Vec<usize>) {
        let problem = self.problem();
        let approach = self.patch.approach;
        let moved_by = self.patch.moved_at(problem, &self.halo, &self.centre, &before.stood);
        let load = self.patch.totals(problem).0 - before.load;
        self.lag(&moved_by, load, before.pull - self.patch.pull(problem), open);
        for change in &taken {
            self.enter(change, open);
        }
        let (rates, _) = self.patch.rates(problem);
        for (k, rate) in rates.iter().enumerate() {
            let (i, a) = (self.patch.members[k].asperity, self.patch.radius[k]);
            let trace = Trace::of(&problem.asperities[i], approach, a, *rate);
            self.pending.push((i, a, trace));
            open.push(i);
        }
        self.commit();
        let watched = self.patch.watch(problem, &rates, &mut self.solver.effort);
        for (place, trace) in self.patch.watched.iter().zip(watched) {
            self.front.traces[place.asperity] = trace;
            self.heard[place.asperity] = self.ripples.len();
            self.front.state.barred[place.asperity] &= trace.value >= problem.jump_in[place.asperity];
            open.push(place.asperity);
        }
        let after = self.front.totals(approach);
        self.log.restart(approach, after.load_n);
        self.record(&taken, approach, before.totals, after, energy);
        moved.extend(taken);
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
        self.lags[i] = 0.0;
        self.front.traces[i].value = f64::NAN;
        self.front.set(i, now, 0.0);
    }

    /// The field around the neighbourhood is another by `moved` \[m\], since its load is another by `load`. Free asperities take it, spots do not
    /// know it yet; the load of the contact will be another by `answer` \[N\] when they do.
    fn lag(&mut self, moved: &[f64], load: f64, answer: f64, open: &mut Vec<usize>) {
        let limit = self.lag_limit();
        let problem = self.problem();
        for (&j, &moved) in self.halo.iter().zip(moved) {
            if self.front.state.status[j] == Status::Contact {
                self.lags[j] += moved;
                if self.lags[j].abs() > limit && !self.urgent.contains(&j) {
                    self.urgent.push(j);
                }
            } else {
                let trace = &mut self.front.traces[j];
                trace.value -= moved;
                self.front.state.barred[j] &= trace.value >= problem.jump_in[j];
                open.push(j);
            }
        }
        if !self.halo.is_empty() {
            self.ripples.push(Ripple { place: self.centre, reach: self.halo_reach, load_n: load });
        }
        self.far_load(self.patch.approach, answer);
    }

    /// Where the neighbourhood has gone another way than in proportion to the approach, the spots outside it do not know it yet: the same.
    pub(crate) fn lag_on_the_way(&mut self, stations: &[Point], open: &mut Vec<usize>) {
        if self.halo.is_empty() {
            return;
        }
        let problem = self.problem();
        let way = self.patch.approach - self.reference;
        let stood = |(m, a): (&Place, &f64)| {
            let i = m.asperity;
            Stood { asperity: i, sphere: problem.asperities[i], radius: *a, more: self.front.speed(problem, i) * way }
        };
        let stood: Vec<Stood> = self.patch.members.iter().zip(&self.origin).map(stood).collect();
        let moved = self.patch.moved_at(problem, &self.halo, &self.centre, &stood);
        let (load, pull) = self.patch.off(&stood);
        let before = self.far;
        self.lag(&moved, load, -pull, open);
        // It has grown on the way, slowly at first.
        let grown = self.far - before;
        self.log.work_j += grown * mean_square(stations, way);
    }

    /// Counts the work of the load that spots will have when they know what events have done, up to an approach; from there on it is
    /// greater by `more` \[N\].
    pub(crate) fn far_load(&mut self, approach: f64, more: f64) {
        self.log.work_j += self.far * (approach - self.far_at);
        self.far_at = approach;
        self.far += more;
        self.front.add_load(more);
    }

    /// Brings the front of the patch to where the patch stands now, before an event, and counts the work on the way, by `stations` if it went
    /// along a radius. At a fold the rates are infinite.
    pub(crate) fn bring(&mut self, stations: &[Point], fold: bool) {
        let problem = self.problem();
        let (approach, reference) = (self.patch.approach, self.reference);
        let rates = if fold { None } else { Some(self.patch.rates(problem).0) };
        for k in 0..self.patch.members.len() {
            let (i, a) = (self.patch.members[k].asperity, self.patch.radius[k]);
            let asperity = &problem.asperities[i];
            let from = self.front.traces[i];
            let value = asperity.penetration(a);
            let trace = match &rates {
                Some(rates) => Trace::of(asperity, approach, a, rates[k]),
                None if approach == from.at => Trace { value, ..from },
                None => Trace { at: approach, value, rate: (value - from.value) / (approach - from.at) },
            };
            let parts = stations.windows(2).map(|pair| work_along(problem, i, pair[1].at - pair[0].at, pair[0].of(k), pair[1].of(k)));
            self.log.work_j += if from.at == reference && stations.len() > 1 { parts.sum() } else { work(problem, i, from, trace) };
            self.pending.push((i, a, trace));
        }
        self.commit();
    }

    /// Brings spots of the patch that were known at an earlier approach to the present one, and counts their work on the way.
    pub(crate) fn catch_up(&mut self) {
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
