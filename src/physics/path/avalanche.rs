//! The events of a stretch: each is located in its neighbourhood, taken, and followed by all that it brings about.

use super::equilibrium_path::{EVENT_TOLERANCE, FLIPS, Halt, Path};
use super::predictor::Due;
use super::triggers::Trigger;
use crate::physics::contact::state::Status;
use crate::physics::contact::transition::{Change, Kind};
use crate::physics::solve::local::Hold;
use crate::physics::solve::local::curve::Found;
use crate::physics::solve::residual::Unsettled;
use crate::physics::{PhysicsError, Reason};

/// Share of its radius by which a spot is moved over a fold.
const NUDGE: f64 = 1e-3;

/// Relative change of a radius that an equilibrium does not tell from none.
const EDGE: f64 = 1e-8;

/// Small solutions that follow one event, at least; and the share of the spots in contact that may be as many.
const MOST: usize = 16;

/// Where an event was found.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// Where the patch stands.
    Here,
    /// There too, at a fold that was met following this member.
    Fold(usize),
}

impl Path<'_> {
    /// Finds and takes the events on the way to `target` \[m\], in their order. Where one has moved more than neighbourhoods can follow, its approach
    /// is returned: the whole contact is to be solved there.
    pub(crate) fn events_until(&mut self, target: f64) -> Result<Option<f64>, Halt> {
        let problem = self.problem();
        let tolerance = EVENT_TOLERANCE * problem.rms_height_m;
        self.queue.clear();
        self.queue.extend(self.foreseen.iter().map(|change| Due { approach: self.front.state.approach_m, change: *change }));
        for &i in self.front.state.contacts.iter().chain(&self.front.candidates) {
            self.front.expect(problem, i, target, self.sign, &mut self.queue);
        }
        let mut looks = 0;
        while let Some(at) = self.first_due() {
            let due = self.queue.swap_remove(at);
            looks += 1;
            if looks > 100 * (problem.len() + 100) {
                return Err(Unsettled::because(Reason::EndlessEvents, due.change.asperity).into());
            }
            self.check_event_count(due.approach, due.change.asperity)?;
            self.gather(&due.change, None);
            let (mut moved, mut open) = (Vec::new(), Vec::new());
            self.log.begin_avalanche();
            if self.lagging() {
                self.absorb(&due.change, &mut moved, &mut open)?;
                open.extend([Some(due.change.asperity), due.change.by].into_iter().flatten());
            } else {
                let Some(place) = self.locate(&due, target) else { continue };
                let approach = self.patch.approach;
                if self.queue.iter().any(|other| (approach - other.approach) * self.sign > tolerance) {
                    self.queue.push(Due { approach, ..due });
                    continue;
                }
                self.close(place, due.change.kind, &mut open);
                self.take(due.change, Some(place), &mut moved, &mut open)?;
            }
            let Some(touched) = self.rest(moved, open)? else { return Ok(Some(self.patch.approach)) };
            // What has been touched is expected anew.
            self.queue.retain(|due| {
                let is = |i: usize| touched.binary_search(&i).is_ok();
                !is(due.change.asperity) && !due.change.by.is_some_and(is)
            });
            for &i in &touched {
                self.front.expect(problem, i, target, self.sign, &mut self.queue);
            }
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

    /// Goes to where a change happens, from where the neighbourhood is known: the patch stands there, before it. Nothing where it does not happen before
    /// `target`.
    fn locate(&mut self, due: &Due, target: f64) -> Option<Place> {
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
            return inside.then_some(Place::Here);
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
            return Some(Place::Here);
        }
        // Most of what is looked for is not met: where the neighbourhood gets to the target without a fold, only the bound matters.
        if let Some(radius) = patch.glance(problem, target, effort)
            && (kind == Kind::Snap || if grows { radius[at] < bound } else { radius[at] > bound })
        {
            return None;
        }
        match patch.follow(problem, at, bound, (target, self.sign), effort) {
            Ok(Found::Fold) => Some(Place::Fold(at)),
            Ok(Found::Bound) if kind != Kind::Snap && (patch.approach - target) * self.sign <= 0.0 => Some(Place::Here),
            _ => None,
        }
    }

    /// Brings the front to where the patch stands now, before an event, and counts the work on the way.
    fn close(&mut self, place: Place, kind: Kind, open: &mut Vec<usize>) {
        let fold = matches!(place, Place::Fold(_));
        // Near the end of a branch the radius is the parameter in which all is smooth; at the edge of a spot it is the approach.
        let stations = if fold || kind == Kind::JumpOff { std::mem::take(&mut self.patch.way) } else { Vec::new() };
        self.lag_on_the_way(&stations, open);
        self.bring(&stations, fold);
    }

    /// An event that is due at the present approach, and all that follows it there.
    pub(crate) fn avalanche(&mut self, first: Change) -> Result<(), Halt> {
        self.log.begin_avalanche();
        self.gather(&first, Some(self.front.state.approach_m));
        self.catch_up();
        let (mut moved, mut open) = (Vec::new(), Vec::new());
        self.take(first, None, &mut moved, &mut open)?;
        self.rest(moved, open).map(|_| ())
    }

    /// Takes what is due among the `open` asperities until nothing is, and no spot lags too far; all that were touched are returned. What would
    /// undo a change at once is remembered at the end, and waits for the path to go on (see [`crate::physics::contact::transition`]). Nothing is returned where the wave
    /// of small solutions does not come to an end: the whole contact is to be solved.
    fn rest(&mut self, mut moved: Vec<Change>, mut open: Vec<usize>) -> Result<Option<Vec<usize>>, Halt> {
        let problem = self.problem();
        let approach = self.patch.approach;
        let bound = 10 * problem.len() + 100;
        let (mut taken, mut absorbed) = (0, 0);
        let mut all = true;
        loop {
            // Most of them are in order: only a stable sort makes use of it.
            open.sort();
            open.dedup();
            let due = self.due(&open, &open);
            let next = due
                .into_iter()
                .filter(|trigger| !trigger.change.returns(&moved, &self.front.state))
                .max_by(|u, v| u.overshoot.total_cmp(&v.overshoot).then(v.change.asperity.cmp(&u.change.asperity)))
                .map(|trigger| trigger.change);
            let lagging = |asperity| Change { kind: Kind::Snap, asperity, by: None };
            let Some(change) = next.or_else(|| self.most_lagging().map(lagging)) else { break };
            taken += 1;
            self.check_event_count(approach, change.asperity)?;
            if taken > bound {
                return Err(Halt::Error(PhysicsError::EndlessAvalanche {
                    approach_m: approach,
                    events: taken,
                    asperity: problem.number(change.asperity),
                }));
            }
            self.gather(&change, Some(approach));
            if next.is_none() || self.lagging() {
                absorbed += 1;
                all = absorbed <= MOST.max(self.front.state.contacts.len() / MOST);
                if !all {
                    break;
                }
                self.absorb(&change, &mut moved, &mut open)?;
            } else {
                self.catch_up();
                self.take(change, None, &mut moved, &mut open)?;
            }
        }
        for change in &moved {
            let i = change.asperity;
            match self.front.state.status[i] {
                Status::Covered { by, release_m } => {
                    let edge = (1.0 - EDGE) * release_m;
                    if self.front.state.radius[by] < edge {
                        // The covering spot has shrunk by covering it, or has left since.
                        self.keep_covered(i, self.patch.approach);
                    } else {
                        // It stands at the edge, and rounding must not decide whether it has shrunk.
                        self.front.state.status[i] = Status::Covered { by, release_m: edge };
                    }
                }
                Status::Contact | Status::Merged { .. } => {}
                Status::Free => self.front.state.barred[i] |= self.front.traces[i].value >= problem.jump_in[i],
            }
        }
        Ok(all.then_some(open))
    }

    /// The changes that are due, but for those of asperities that flip to and fro: such an asperity is held as it is for a while, and counted.
    /// Two spots that each grow when the other is there, and withdraw when it is not, have no rest otherwise; nor have three of which each covers the next
    /// as soon as the third has covered it.
    pub(crate) fn due(&mut self, touched: &[usize], free: &[usize]) -> Vec<Trigger> {
        let mut due = self.problem().triggers(&self.front, touched, free);
        let state = &self.front.state;
        let mut riding: Vec<usize> = Vec::new();
        due.retain(|trigger| {
            let i = trigger.change.asperity;
            let mut taken = trigger.change.kind == Kind::JumpOff || self.flips[i] < FLIPS;
            if let Status::Covered { by, .. } = state.status[i]
                && state.radius[by] == 0.0
                && !taken
            {
                // Its covering spot is none any more: it is uncovered, or it rides on with the one that covers that.
                taken = state.carrier(by).is_none();
                if !taken {
                    riding.push(i);
                }
            }
            if !taken && !self.held.contains(&i) {
                self.held.push(i);
            }
            taken
        });
        for i in riding {
            self.keep_covered(i, self.patch.approach);
        }
        due
    }

    /// Applies one change in the patch that stands at it, lets the patch relax and writes both down: adds the changes to what has `moved`,
    /// and all asperities whose state is another now to those that are `open`.
    fn take(&mut self, change: Change, place: Option<Place>, moved: &mut Vec<Change>, open: &mut Vec<usize>) -> Result<(), Halt> {
        let problem = self.problem();
        let i = change.asperity;
        let mut before = self.begin();
        let mut taken = Vec::new();
        if let Some(Place::Fold(at)) = place {
            let sense = if self.patch.radius[at] > self.origin[at] { 1.0 } else { -1.0 };
            let gap = self.sign * EVENT_TOLERANCE * problem.rms_height_m;
            before.potential += gap * self.patch.potential_slope(problem);
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
                        self.keep_covered(i, self.patch.approach);
                        return Ok(());
                    }
                    Err(unsettled) => return Err(unsettled.into()),
                }
            }
            if change.kind == Kind::Uncover && self.vain(&change, &taken) {
                self.keep_covered(i, self.patch.approach);
                return Ok(());
            }
        }
        let energy = before.potential - self.patch.totals(problem).1;
        self.finish(&before, taken, energy, moved, open);
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
                    self.patch.insert(place, asperity.radius_ahead(penetration));
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
                // What is outside moves with the approach here as it does next to it.
                let drift = change.by.and_then(|by| self.patch.find(by)).map_or(0.0, |k| self.patch.members[k].drift);
                let place = self.patch.place(problem, i, (displacement, drift), &mut self.solver.effort);
                match asperity.radius_at_penetration(approach + problem.heights[i] - displacement) {
                    Some(radius) => self.patch.insert(place, radius),
                    None => self.patch.watched.push(place),
                }
            }
            Kind::Snap | Kind::Merge | Kind::Split => {}
        }
        true
    }

    /// True if an uncovering was in vain: it was undone on the way, or is to be undone at once.
    fn vain(&self, uncovering: &Change, taken: &[Change]) -> bool {
        let problem = self.problem();
        let Some(by) = uncovering.by else { return false };
        let i = uncovering.asperity;
        let radius = |j: usize| self.patch.find(j).map_or(0.0, |k| self.patch.radius[k]);
        let distance = problem.neighbours.distance(&problem.positions[i], &problem.positions[by]);
        let (mine, its) = (radius(i), radius(by));
        taken.iter().any(|change| change.undoes(uncovering)) || (its >= distance && mine < its) || (mine >= distance && its < mine)
    }
}
