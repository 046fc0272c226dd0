//! The path of the contact under displacement control: from one equilibrium to the next, events located on the way.
//!
//! Between events the state is a smooth function of the approach δ, and the load is integrated along it to high order. An event is located
//! in δ to [`EVENT_TOLERANCE`] of the rms height, and taken with everything that follows it at that approach: an avalanche. Within an avalanche
//! one change is taken at a time, the one that is most overdue, and the rest relaxes before the next is looked for. An asperity that
//! left within an avalanche does not return within it.

use super::PhysicsError;
use super::equilibrium::{Solver, Unsettled};
use super::events::{Change, Kind, Trigger};
use super::interaction::Effort;
use super::state::{Problem, State, Status, Totals};

/// Tolerance of an event's approach, of the rms height.
pub const EVENT_TOLERANCE: f64 = 1e-6;

/// A spot counts as at the end of its branch when its penetration is this close to it, of the jump-off penetration.
const END_TOLERANCE: f64 = 2e-5;

/// Where uncovering an asperity is in vain, it is tried again when the covering spot has shrunk to this share of its radius.
const RETRY: f64 = 0.97;

/// Changes other than leaving that one asperity takes between two grid points of the approach.
const FLIPS: u8 = 3;

/// Tolerance of the load at a turning point, relative.
const LOAD_TOLERANCE: f64 = 1e-9;

/// An event as it happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// What happened.
    pub kind: Kind,
    /// To which asperity.
    pub asperity: usize,
    /// At which approach δ \[m\].
    pub approach_m: f64,
    /// Which avalanche it belongs to, counted along the branch.
    pub avalanche: u64,
    /// Load and area before.
    pub before: Totals,
    /// Load and area when the rest has relaxed.
    pub after: Totals,
    /// Potential lost \[J\].
    pub energy_lost_j: f64,
}

/// An equilibrium with all that the path needs to leave it.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) state: State,
    pub(crate) totals: Totals,
    free: Vec<f64>,
    /// `da_i/dδ` of the spots in contact.
    rates: Vec<f64>,
    /// `dF/dδ` \[N/m\].
    load_slope: f64,
}

/// A state on its way.
pub(crate) struct Path<'p> {
    solver: Solver<'p>,
    pub(crate) node: Node,
    pub(crate) events: Vec<Event>,
    /// `∫F dΔ` since the branch began \[J\].
    pub(crate) work_j: f64,
    avalanches: u64,
    /// Penetrations of all free asperities as they were taken last, and the approach of that.
    known: (Vec<f64>, f64),
    /// Least load since this was asked last, events included \[N\].
    least_load_n: f64,
    /// How often each asperity has been covered, uncovered or has jumped in since the last grid point of the approach.
    flips: Vec<u8>,
    /// Changes that were not taken since then because the asperity had flipped too often.
    pub(crate) held: Vec<usize>,
}

/// The nearest approach on the way that is known not to be free of events: what is due there, or nothing where no equilibrium was found.
struct Obstacle {
    approach: f64,
    due: Vec<Trigger>,
    load: f64,
    /// Halved each time that the event was sought before its place (the Illinois rule), since some events come on as a square root.
    weight: f64,
}

impl<'p> Path<'p> {
    /// A path from a state in equilibrium.
    pub(crate) fn new(problem: &'p Problem, state: State) -> Result<Self, PhysicsError> {
        let mut solver = Solver::new(problem);
        let free = solver.free_penetrations(&state);
        let node = settled_node(&mut solver, state, free)?;
        let known = (node.free.clone(), node.state.approach_m);
        Ok(Self {
            solver,
            least_load_n: node.totals.load_n,
            node,
            known,
            events: Vec::new(),
            work_j: 0.0,
            avalanches: 0,
            flips: vec![0; problem.len()],
            held: Vec::new(),
        })
    }

    pub(crate) fn effort(&self) -> Effort {
        self.solver.effort
    }

    /// Goes to the approach `target` \[m\], or to the load `stop` \[N\] if that is reached first on the way in; says whether it was.
    pub(crate) fn advance(&mut self, target: f64, stop: Option<f64>) -> Result<bool, PhysicsError> {
        let unit = self.solver.problem.rms_height_m;
        let tolerance = EVENT_TOLERANCE * unit;
        let mut obstacle: Option<Obstacle> = None;
        let mut tries = 0;
        self.flips.fill(0);
        self.held.clear();
        loop {
            let here = self.node.state.approach_m;
            if stop.is_some_and(|stop| self.node.totals.load_n >= stop * (1.0 - LOAD_TOLERANCE)) {
                return Ok(true);
            }
            if here == target {
                return Ok(false);
            }
            let sign = (target - here).signum();
            let end = self.branch_end(sign);
            if let Some((asperity, _, true)) = end {
                self.avalanche(Change { kind: Kind::JumpOff, asperity, by: None })?;
                (obstacle, tries) = (None, 0);
                continue;
            }
            let mut trial = match &obstacle {
                None => target,
                Some(known) => self.aim(known, stop, tolerance, tries),
            };
            let reach = end.map_or(f64::INFINITY, |(_, reach, _)| reach);
            if 0.98 * reach < (trial - here).abs() {
                trial = here + sign * 0.98 * reach;
            }
            tries += 1;
            match self.attempt(trial) {
                Err(_) if (trial - here).abs() <= tolerance => {
                    self.collapse(trial)?;
                    (obstacle, tries) = (None, 0);
                }
                Err(_) => obstacle = Some(Obstacle { approach: trial, due: Vec::new(), load: f64::NAN, weight: 1.0 }),
                Ok(mut next) => {
                    next.free = if trial == target {
                        self.solver.free_penetrations(&next.state)
                    } else {
                        self.solver.near_penetrations(&next.state, &self.known.0, self.known.1)
                    };
                    let due = self.due(&next.state, &next.free);
                    let over = stop.is_some_and(|stop| next.totals.load_n > stop * (1.0 + LOAD_TOLERANCE));
                    if due.is_empty() && !over {
                        if trial == target {
                            self.known = (next.free.clone(), trial);
                        }
                        self.accept(next, reach);
                        match &mut obstacle {
                            Some(known) if (known.approach - trial) * sign > 0.0 => known.weight *= 0.5,
                            _ => (obstacle, tries) = (None, 0),
                        }
                        continue;
                    }
                    let known = Obstacle { approach: trial, due, load: next.totals.load_n, weight: 1.0 };
                    let first = self.first_due(&known, stop);
                    let close =
                        (trial - first.map_or(here, |(approach, _)| approach)).abs() <= tolerance || (trial - here).abs() <= tolerance;
                    match first {
                        // A load that jumps at an event is met by the event; one that cannot be met more closely is met.
                        Some((_, None)) if tries >= 60 => self.accept(next, reach),
                        Some((_, Some(change))) if close => {
                            self.accept(next, reach);
                            self.avalanche(change)?;
                            (obstacle, tries) = (None, 0);
                        }
                        _ => obstacle = Some(known),
                    }
                }
            }
        }
    }

    /// The changes that are due, but for those of asperities that flip to and fro: such an asperity is held as it is up to the next grid
    /// point, and counted. Two spots that each grow when the other is there, and withdraw when it is not, have no rest otherwise.
    fn due(&mut self, state: &State, free: &[f64]) -> Vec<Trigger> {
        let mut due = self.solver.problem.triggers(state, free);
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

    /// The first obstacle's approach by linear interpolation from here: of a change, or (nothing) of the load at which to stop.
    fn first_due(&self, known: &Obstacle, stop: Option<f64>) -> Option<(f64, Option<Change>)> {
        let here = self.node.state.approach_m;
        let across = |before: f64, beyond: f64| {
            let share = if before < 0.0 && beyond > 0.0 { -before / (known.weight * beyond - before) } else { 0.0 };
            here + share * (known.approach - here)
        };
        let changes = known.due.iter().map(|trigger| {
            let before = self.solver.problem.overshoot(&trigger.change, &self.node.state, &self.node.free);
            (across(before, trigger.overshoot), Some(trigger.change))
        });
        let load = stop.filter(|stop| known.load > *stop).map(|stop| (across(self.node.totals.load_n - stop, known.load - stop), None));
        changes.chain(load).min_by(|(a, _), (b, _)| (a - here).abs().total_cmp(&(b - here).abs()))
    }

    /// Where to look next before an obstacle.
    fn aim(&self, known: &Obstacle, stop: Option<f64>, tolerance: f64, tries: u32) -> f64 {
        let here = self.node.state.approach_m;
        let gap = (known.approach - here).abs();
        let middle = 0.5 * (here + known.approach);
        match self.first_due(known, stop) {
            // At a load itself.
            Some((approach, None)) if tries < 60 => approach,
            _ if gap <= tolerance => known.approach,
            // A little beyond a change, so that it is found due.
            Some((approach, Some(_))) if tries < 12 || tries.is_multiple_of(2) => {
                let aimed = approach + (0.3 * tolerance).copysign(known.approach - here);
                if (aimed - here).abs() < gap { aimed } else { middle }
            }
            _ => middle,
        }
    }

    /// The spot whose own branch ends first on the way: who, in what distance, and whether it is there.
    fn branch_end(&self, sign: f64) -> Option<(usize, f64, bool)> {
        let node = &self.node;
        node.state
            .contacts
            .iter()
            .zip(&node.rates)
            .filter_map(|(&i, rate)| {
                let asperity = &self.solver.problem.asperities[i];
                let a = node.state.radius[i];
                let sinking = -sign * asperity.penetration_slope(a) * rate;
                let left = asperity.penetration(a) - asperity.jump_off_penetration();
                // Nor can it be told closer than equilibria are solved for.
                let there = left <= END_TOLERANCE * asperity.jump_off_penetration().abs() + 4.0 * self.solver.problem.tolerance_m();
                (sinking > 0.0).then(|| (i, left / sinking, there))
            })
            .min_by(|u, v| v.2.cmp(&u.2).then(u.1.total_cmp(&v.1)).then(u.0.cmp(&v.0)))
    }

    /// The equilibrium with the same spots at another approach, if there is one near.
    fn attempt(&mut self, approach: f64) -> Result<Node, Unsettled> {
        let change = approach - self.node.state.approach_m;
        let mut state = self.node.state.clone();
        state.approach_m = approach;
        let mut guess = Vec::with_capacity(state.contacts.len());
        for (&i, rate) in state.contacts.iter().zip(&self.node.rates) {
            let asperity = &self.solver.problem.asperities[i];
            let a = state.radius[i];
            // Penetration is nearly linear in the approach, up to the end of the branch; the radius is not.
            let ahead = asperity.penetration(a) + asperity.penetration_slope(a) * rate * change;
            let end = asperity.jump_off_radius() * (1.0 + 1e-4);
            guess.push(asperity.radius_at_penetration(ahead).unwrap_or(end).clamp(0.05 * a, 4.0 * a));
        }
        for (&i, radius) in self.node.state.contacts.iter().zip(&guess) {
            state.radius[i] = *radius;
        }
        self.solver.newton(&mut state)?;
        // A state far from where the path led is another path's.
        let far = state.contacts.iter().zip(&guess).find(|(i, radius)| (state.radius[**i] - **radius).abs() > 0.3 * **radius);
        if let Some((&asperity, _)) = far {
            return Err(Unsettled { residual_m: f64::NAN, asperity });
        }
        Ok(node(&mut self.solver, state, Vec::new()))
    }

    /// Makes `next` the present node, and adds the work of the load on the way. `reach` is the distance to the end of a spot's branch.
    fn accept(&mut self, mut next: Node, reach: f64) {
        let distance = next.state.approach_m - self.node.state.approach_m;
        let (f0, f1) = (self.node.totals.load_n, next.totals.load_n);
        let (s0, s1) = (self.node.load_slope, next.load_slope);
        let span = distance.abs();
        self.work_j += if reach < 4.0 * span {
            // Near the end of a branch the load is smooth in s = sqrt(distance to the end), not in δ: cubic Hermite in s.
            let (u0, u1) = (reach.sqrt(), (reach - span).max(0.0).sqrt());
            let sign = distance.signum();
            // dF/ds = dF/dδ · dδ/ds, and s falls as the path goes on.
            let (t0, t1) = (-2.0 * u0 * sign * s0, -2.0 * u1 * sign * s1);
            sign * hermite_moment(u1, u0, f1, f0, t1, t0)
        } else {
            distance * 0.5 * (f0 + f1) + distance * distance / 12.0 * (s0 - s1)
        };
        if next.state.barred.contains(&true) {
            for i in 0..next.state.barred.len() {
                next.state.barred[i] &= next.free[i] >= self.solver.problem.jump_in[i];
            }
        }
        self.least_load_n = self.least_load_n.min(f1);
        self.node = next;
    }

    /// The least load since this was asked last, events included \[N\]: the load is a saw-tooth whose teeth stand at the events.
    pub(crate) fn take_least_load(&mut self) -> f64 {
        std::mem::replace(&mut self.least_load_n, self.node.totals.load_n)
    }

    /// Beyond a fold: the spots relax to the next equilibrium at `approach`.
    fn collapse(&mut self, approach: f64) -> Result<(), PhysicsError> {
        let mut state = self.node.state.clone();
        self.work_j += self.node.totals.load_n * (approach - state.approach_m);
        state.approach_m = approach;
        let before = self.node.totals;
        let changes = self.solver.relax(&mut state, None).map_err(|unsettled| stuck(&state, unsettled, self.solver.effort))?;
        self.avalanches += 1;
        let moved = if changes.is_empty() {
            let most = |i: &usize| (state.radius[*i] / self.node.state.radius[*i] - 1.0).abs();
            let asperity = state.contacts.iter().copied().max_by(|i, j| most(i).total_cmp(&most(j))).unwrap_or(0);
            vec![Change { kind: Kind::Snap, asperity, by: None }]
        } else {
            changes
        };
        let after = self.record(&moved, before, &state);
        self.follow(state, after, moved)
    }

    /// An event at the present approach, and all that follows it there.
    fn avalanche(&mut self, first: Change) -> Result<(), PhysicsError> {
        self.avalanches += 1;
        let mut state = self.node.state.clone();
        let free = std::mem::take(&mut self.node.free);
        let mut moved = Vec::new();
        let after = self.take(&mut state, first, &free, self.node.totals, &mut moved)?;
        self.follow(state, after, moved)
    }

    /// Takes what is due until nothing is.
    fn follow(&mut self, mut state: State, mut totals: Totals, mut moved: Vec<Change>) -> Result<(), PhysicsError> {
        let bound = 10 * self.solver.problem.len() + 100;
        loop {
            let free = self.solver.free_penetrations(&state);
            let next = self
                .due(&state, &free)
                .into_iter()
                .filter(|trigger| !trigger.change.returns(&moved, &state))
                .max_by(|u, v| u.overshoot.total_cmp(&v.overshoot).then(v.change.asperity.cmp(&u.change.asperity)));
            let Some(next) = next else {
                self.latch(&mut state, &free, &moved);
                // Nothing has moved since these penetrations were taken.
                self.node = settled_node(&mut self.solver, state, free)?;
                self.known = (self.node.free.clone(), self.node.state.approach_m);
                return Ok(());
            };
            if moved.len() > bound {
                let asperity = next.change.asperity;
                return Err(PhysicsError::EndlessAvalanche { approach_m: state.approach_m, events: moved.len(), asperity });
            }
            totals = self.take(&mut state, next.change, &free, totals, &mut moved)?;
        }
    }

    /// Applies one change, lets the rest relax and writes both down, and adds them to what has `moved` in this avalanche.
    fn take(
        &mut self,
        state: &mut State,
        change: Change,
        free: &[f64],
        before: Totals,
        moved: &mut Vec<Change>,
    ) -> Result<Totals, PhysicsError> {
        let i = change.asperity;
        let asperity = self.solver.problem.asperities[i];
        let covered = state.clone();
        match change.kind {
            Kind::JumpIn => {
                let landed = free.get(i).and_then(|d| asperity.radius_at_penetration(*d)).unwrap_or(asperity.jump_off_radius());
                state.set(i, Status::Contact, landed);
            }
            Kind::Uncover => {
                if let Some((by, release_m)) = self.solver.problem.covering(state, i) {
                    // Another spot covers it as well: nothing moves.
                    state.set(i, Status::Covered { by, release_m }, 0.0);
                    return Ok(before);
                }
                match asperity.radius_at_penetration(self.solver.penetration_of(state, i)) {
                    Some(radius) => state.set(i, Status::Contact, radius),
                    None => state.set(i, Status::Free, 0.0),
                }
            }
            Kind::JumpOff | Kind::Cover | Kind::Snap => state.set(i, change.status(self.solver.problem), 0.0),
        }
        let start = state.clone();
        let mut taken = vec![change];
        if self.solver.newton(state).is_err() {
            *state = start;
            let uncovered = (change.kind == Kind::Uncover).then_some(&change);
            taken.extend(self.solver.relax(state, uncovered).map_err(|unsettled| stuck(state, unsettled, self.solver.effort))?);
        }
        if change.kind == Kind::Uncover && self.vain(&change, &taken, state) {
            *state = covered;
            if let Status::Covered { by, .. } = state.status[i] {
                state.status[i] = Status::Covered { by, release_m: RETRY * state.radius[by] };
            }
            return Ok(before);
        }
        let after = self.record(&taken, before, state);
        moved.extend(taken);
        Ok(after)
    }

    /// Whether an uncovering was in vain: it was undone on the way, or is to be undone at once.
    fn vain(&self, uncovering: &Change, taken: &[Change], state: &State) -> bool {
        taken.iter().any(|change| change.undoes(uncovering))
            || self.solver.problem.triggers(state, &[]).iter().any(|trigger| trigger.change.undoes(uncovering))
    }

    /// Writes changes down that led from `before` to `state`; the energy of changes within one relaxation is the first one's.
    fn record(&mut self, moved: &[Change], before: Totals, state: &State) -> Totals {
        let after = self.solver.problem.totals(state);
        self.least_load_n = self.least_load_n.min(after.load_n);
        for (k, change) in moved.iter().enumerate() {
            if change.kind != Kind::JumpOff {
                self.flips[change.asperity] = self.flips[change.asperity].saturating_add(1);
            }
            let from = if k == 0 { before } else { after };
            self.events.push(Event {
                kind: change.kind,
                asperity: change.asperity,
                approach_m: state.approach_m,
                avalanche: self.avalanches,
                before: from,
                after,
                energy_lost_j: from.potential_j - after.potential_j,
            });
        }
        after
    }

    /// At the end of an avalanche: what would undo a change at once is remembered, and waits for the path to go on (see [`super::events`]).
    fn latch(&self, state: &mut State, free: &[f64], moved: &[Change]) {
        let problem = self.solver.problem;
        for change in moved {
            let i = change.asperity;
            match state.status[i] {
                Status::Covered { by, release_m } => {
                    let radius = state.radius[by];
                    state.status[i] = Status::Covered { by, release_m: release_m.min(radius) };
                }
                Status::Contact => {}
                Status::Free => state.barred[i] = free[i] >= problem.jump_in[i],
            }
        }
    }
}

/// A node from an equilibrium: the solve only confirms it, and has its tangent.
fn settled_node(solver: &mut Solver<'_>, mut state: State, free: Vec<f64>) -> Result<Node, PhysicsError> {
    solver.newton(&mut state).map_err(|unsettled| stuck(&state, unsettled, solver.effort))?;
    Ok(node(solver, state, free))
}

/// The node of the equilibrium that was solved last.
fn node(solver: &mut Solver<'_>, state: State, free: Vec<f64>) -> Node {
    let totals = solver.problem.totals(&state);
    let rates = solver.rates(&state);
    let load_slope = load_slope(solver.problem, &state, &rates);
    Node { state, totals, free, rates, load_slope }
}

fn load_slope(problem: &Problem, state: &State, rates: &[f64]) -> f64 {
    state.contacts.iter().zip(rates).map(|(&i, rate)| problem.asperities[i].load_slope(state.radius[i]) * rate).sum()
}

/// `∫ F(s) 2s ds` over `[u, v]`, of the cubic with values `f` and slopes `t` at the ends: exact by three-point Gauss quadrature.
fn hermite_moment(u: f64, v: f64, fu: f64, fv: f64, tu: f64, tv: f64) -> f64 {
    let width = v - u;
    let cubic = |x: f64| {
        let y = 1.0 - x;
        y * y * (1.0 + 2.0 * x) * fu + x * x * (1.0 + 2.0 * y) * fv + width * x * y * (y * tu - x * tv)
    };
    let offset = 0.5 * 0.6f64.sqrt();
    [(0.5 - offset, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + offset, 5.0 / 18.0)]
        .iter()
        .map(|(x, weight)| weight * width * cubic(*x) * 2.0 * (u + x * width))
        .sum()
}

fn stuck(state: &State, unsettled: Unsettled, effort: Effort) -> PhysicsError {
    PhysicsError::NoEquilibrium {
        approach_m: state.approach_m,
        residual_m: unsettled.residual_m,
        asperity: unsettled.asperity,
        iterations: effort.iterations,
    }
}
