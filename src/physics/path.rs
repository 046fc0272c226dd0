//! The path of the contact under displacement control, from event to event.
//!
//! The path goes in stretches. At both ends of a stretch the whole contact is in equilibrium (residual 1e-10 of the rms height). Between them
//! every event is found and solved in its own neighbourhood ([`super::patch`]), in the order of the approaches; what the rest of the contact
//! does to a neighbourhood changes in proportion to the approach meanwhile. At the end the whole contact is solved: what its residual was
//! before is the error of all this, and where it is more than [`DRIFT`] the stretch is done again in halves. Nothing of it depends on where
//! the path is asked for its state: the steps of the approach are read off the path, and do not make it.
//!
//! An event takes everything with it that follows at the same approach: an avalanche. Within it one change is taken at a time, the most
//! overdue, and the neighbourhood relaxes before the next is looked for. An asperity that left within an avalanche does not return within it.

use super::PhysicsError;
use super::equilibrium::{Solver, Unsettled};
use super::events::{Change, Kind};
use super::front::{Due, Front, work};
use super::interaction::Effort;
use super::patch::{Patch, Trace};
use super::state::{Problem, State, Status, Totals};

/// Greatest residual of the whole contact at the end of a stretch, before it is solved, and greatest lateness of an event; of the mean jump-off penetration.
pub const DRIFT: f64 = 2e-3;

/// Tolerance of an event's approach, of the rms height, where the order of two is decided or a fold is passed.
pub const EVENT_TOLERANCE: f64 = 1e-6;

/// Tolerance of the load at a turning point, relative; and of its approach, of the rms height, where the load jumps over it.
const LOAD_TOLERANCE: f64 = 1e-9;

/// Longest stretch, of the mean jump-off penetration.
const STRETCH: f64 = 0.05;

/// Least scale of lengths along the path, of the rms height: below it adhesion does not set the scale.
const LEAST_SCALE: f64 = 0.02;

/// How often a stretch is halved before the whole contact is relaxed in place of it.
const HALVINGS: u32 = 14;

/// How often a stretch is halved before its drift is let pass.
const PATIENCE: u32 = 6;

/// Where uncovering an asperity is in vain, it is tried again when the covering spot has shrunk to this share of its radius.
const RETRY: f64 = 0.97;

/// Changes other than leaving that one asperity takes in one longest stretch.
pub(crate) const FLIPS: u8 = 3;

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

/// What a path has left behind.
#[derive(Debug, Clone, Default)]
pub(crate) struct Log {
    pub(crate) events: Vec<Event>,
    /// Which of them has the energy of the last relaxation.
    charged: usize,
    /// `∫F dΔ` since the branch began \[J\].
    pub(crate) work_j: f64,
    pub(crate) avalanches: u64,
    /// The way of the load, from event to event.
    pub(crate) ways: Vec<Way>,
    /// Load where it was known last \[N\].
    last: f64,
    /// Greatest residual before the whole contact was solved, since this was asked last \[m\].
    pub(crate) drift_m: f64,
}

/// A part of the way of the load on which it does not jump.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way {
    /// Approach and load at its end \[m, N\].
    pub(crate) approach: f64,
    load: f64,
    /// Least load on it \[N\].
    pub(crate) least: f64,
}

/// Where a path was, to go back to.
struct Mark {
    front: Front,
    events: usize,
    ways: usize,
    log: Log,
    totals: Totals,
    balance: f64,
    flips: Vec<u8>,
    held: Vec<usize>,
}

/// A state on its way.
pub(crate) struct Path<'p> {
    pub(crate) solver: Solver<'p>,
    pub(crate) front: Front,
    pub(crate) log: Log,
    /// Sense of the path: 1 inwards, −1 outwards.
    pub(crate) sign: f64,
    /// Load and area at the end of the last stretch.
    pub(crate) totals: Totals,
    /// The longest stretch \[m\], and how often it is halved now.
    longest: f64,
    halvings: u32,
    /// Spots in a neighbourhood.
    pub(crate) spots: usize,
    /// Spots next to the neighbourhood, and how far the avalanche at hand has moved the surface under them \[m\].
    pub(crate) halo: Vec<usize>,
    pub(crate) shift: f64,
    /// Displacement under each spot since the whole contact was solved, as far as it does not know it yet \[m\]; what that will do to the
    /// load \[N\], and the approach from which on it has been counted \[m\].
    pub(crate) lags: Vec<f64>,
    pub(crate) far: f64,
    far_at: f64,
    /// How many events there were when the whole contact was solved last, at which approach, and the balance `Π + Σ energy lost − work` then \[J\].
    settled: usize,
    settled_at: f64,
    balance: f64,
    /// Whether the balance is to be closed by what the last event has lost.
    unbalanced: bool,
    /// The neighbourhood of the event at hand; the radii that its spots had at the approach `reference` \[m\], before they went to the event.
    pub(crate) patch: Patch,
    pub(crate) origin: Vec<f64>,
    pub(crate) reference: f64,
    /// Traces to be put into the front: asperity, radius, trace.
    pub(crate) pending: Vec<(usize, f64, Trace)>,
    /// Asperities that the last avalanche has touched.
    pub(crate) touched: Vec<usize>,
    /// Events expected in this stretch.
    pub(crate) queue: Vec<Due>,
    /// Penetrations of all free asperities as they were taken last, and the approach of that.
    known: (Vec<f64>, f64),
    /// How often each asperity has been covered, uncovered or has jumped in within the present longest stretch.
    pub(crate) flips: Vec<u8>,
    /// Changes that were not taken since the last record because the asperity had flipped too often.
    pub(crate) held: Vec<usize>,
    /// Before the last stretch.
    mark: Option<Box<Mark>>,
}

/// Why a stretch was not done.
pub(crate) enum Halt {
    /// It is too long, or leads to no equilibrium.
    Unsettled(Unsettled),
    /// It cannot be done at all.
    Error(PhysicsError),
}

impl From<Unsettled> for Halt {
    fn from(unsettled: Unsettled) -> Self {
        Self::Unsettled(unsettled)
    }
}

impl<'p> Path<'p> {
    /// A path from a state in equilibrium, in the sense `sign`.
    pub(crate) fn new(problem: &'p Problem, state: State, sign: f64) -> Result<Self, PhysicsError> {
        let n = problem.len();
        let off = problem.asperities.iter().map(|a| a.jump_off_penetration().abs()).sum::<f64>() / n as f64;
        // Where adhesion is next to nothing, the roughness sets the scale.
        let off = off.max(LEAST_SCALE * problem.rms_height_m);
        // A power of two of a hundredth of the rms height, so that round steps of the approach end stretches.
        let unit = 0.01 * problem.rms_height_m;
        let longest = unit * (STRETCH * off / unit).log2().floor().exp2();
        let approach = state.approach_m;
        let mut path = Self {
            solver: Solver::new(problem),
            front: Front::new(problem, state),
            log: Log::default(),
            sign,
            totals: Totals::default(),
            longest,
            halvings: 0,
            spots: problem.spots_in_patch,
            halo: Vec::new(),
            shift: 0.0,
            lags: vec![0.0; n],
            far: 0.0,
            far_at: approach,
            settled: 0,
            settled_at: approach,
            balance: 0.0,
            unbalanced: false,
            patch: Patch::default(),
            origin: Vec::new(),
            reference: approach,
            pending: Vec::new(),
            touched: Vec::new(),
            queue: Vec::new(),
            known: (Vec::new(), approach),
            flips: vec![0; n],
            held: Vec::new(),
            mark: None,
        };
        match path.settle(approach, f64::INFINITY, true) {
            Ok(()) => {}
            Err(Halt::Unsettled(unsettled)) => return Err(path.stuck(unsettled)),
            Err(Halt::Error(error)) => return Err(error),
        }
        path.log = Log { last: path.log.last, ..Log::default() };
        Ok(path)
    }

    pub(crate) fn problem(&self) -> &'p Problem {
        self.solver.problem
    }

    pub(crate) fn state(&self) -> &State {
        &self.front.state
    }

    pub(crate) fn effort(&self) -> Effort {
        self.solver.effort
    }

    /// The mean jump-off penetration, rounded down \[m\].
    fn scale(&self) -> f64 {
        self.longest / STRETCH
    }

    /// Error that is let pass at the end of a stretch \[m\].
    fn drift_limit(&self) -> f64 {
        DRIFT * self.scale()
    }

    /// What is needed to come back to the present state, in which the whole contact is solved.
    fn mark(&self) -> Mark {
        Mark {
            front: self.front.clone(),
            events: self.log.events.len(),
            ways: self.log.ways.len(),
            log: self.log.clone_without_events(),
            totals: self.totals,
            balance: self.balance,
            flips: self.flips.clone(),
            held: self.held.clone(),
        }
    }

    /// Goes on by one stretch, but not beyond `bound` \[m\].
    pub(crate) fn stretch(&mut self, bound: Option<f64>) -> Result<(), PhysicsError> {
        let mut mark = self.mark();
        loop {
            let here = self.front.state.approach_m;
            let size = self.longest * 0.5f64.powi(self.halvings as i32);
            let mut target = next_multiple(here, size, self.sign);
            if bound.is_some_and(|bound| (target - bound) * self.sign > -1e-9 * size) {
                target = bound.unwrap_or(target);
            }
            let done = self.events_and_settle(target);
            match done {
                Ok(()) => {
                    // Whether the next longer stretch may be tried: it must end on a multiple of itself.
                    if self.halvings > 0 && next_multiple(target, size, self.sign) == next_multiple(target, 2.0 * size, self.sign) {
                        self.halvings -= 1;
                    }
                    if is_multiple(target, self.longest) {
                        self.flips.fill(0);
                    }
                    self.mark = Some(Box::new(mark));
                    return Ok(());
                }
                Err(Halt::Error(error)) => return Err(error),
                Err(Halt::Unsettled(unsettled)) => {
                    let mut uncovered: Vec<usize> =
                        self.log.events[mark.events..].iter().filter(|e| e.kind == Kind::Uncover).map(|e| e.asperity).collect();
                    self.back_to(&mark);
                    uncovered.retain(|i| matches!(self.front.state.status[*i], Status::Covered { .. }));
                    if self.halvings >= PATIENCE && !uncovered.is_empty() {
                        // At the edge of a spot the field is steepest, and there may be no equilibrium with an asperity there: it stays
                        // covered for a while, and is counted.
                        for i in uncovered {
                            self.keep_covered(i);
                            self.held.push(i);
                        }
                        mark.front.clone_from(&self.front);
                        mark.held.clone_from(&self.held);
                        self.halvings = 0;
                    } else if self.halvings >= HALVINGS {
                        self.collapse(target).map_err(|_| self.stuck(unsettled))?;
                        self.halvings = HALVINGS / 2;
                        self.mark = Some(Box::new(mark));
                        return Ok(());
                    } else {
                        self.halvings += 1;
                    }
                }
            }
        }
    }

    /// Takes the events on the way to `target` and solves the whole contact there; on the way too, after events that move all of it.
    fn events_and_settle(&mut self, target: f64) -> Result<(), Halt> {
        let limit = self.drift_limit();
        while let Some(approach) = self.events_until(target, limit)? {
            // What such an event does to the rest is no error: the neighbourhood has relaxed first, and now the rest does.
            self.settle(approach, f64::INFINITY, true)?;
            if approach == target {
                return Ok(());
            }
        }
        self.settle(target, if self.halvings < PATIENCE { limit } else { f64::INFINITY }, false)
    }

    /// Another path, from before the last stretch to `target` within it.
    pub(crate) fn excursion(&self, target: f64) -> Result<Self, PhysicsError> {
        let mark = self.mark.as_deref();
        let mut other = Self {
            solver: Solver::new(self.problem()),
            front: mark.map_or_else(|| self.front.clone(), |m| m.front.clone()),
            log: mark.map_or_else(|| self.log.clone_without_events(), |m| m.log.clone_without_events()),
            totals: mark.map_or(self.totals, |m| m.totals),
            halvings: 0,
            spots: self.problem().spots_in_patch,
            halo: Vec::new(),
            shift: 0.0,
            lags: vec![0.0; self.problem().len()],
            far: 0.0,
            far_at: mark.map_or(self.far_at, |m| m.front.state.approach_m),
            settled: 0,
            settled_at: mark.map_or(self.settled_at, |m| m.front.state.approach_m),
            balance: mark.map_or(self.balance, |m| m.balance),
            unbalanced: false,
            patch: Patch::default(),
            origin: Vec::new(),
            pending: Vec::new(),
            touched: Vec::new(),
            queue: Vec::new(),
            known: (Vec::new(), self.known.1),
            flips: mark.map_or_else(|| self.flips.clone(), |m| m.flips.clone()),
            held: Vec::new(),
            mark: None,
            ..*self
        };
        while other.front.state.approach_m != target {
            other.stretch(Some(target))?;
        }
        Ok(other)
    }

    /// The part of the last stretch on which the load comes to `load` \[N\]: where it begins and where it ends, and what is missing at both.
    fn crossing(&self, load: f64) -> Option<([f64; 2], [f64; 2])> {
        let mark = self.mark.as_deref()?;
        let mut before = (mark.front.state.approach_m, mark.totals.load_n);
        for way in &self.log.ways[mark.ways..] {
            if way.load >= load {
                return Some(([before.0, way.approach], [before.1 - load, way.load - load]));
            }
            before = (way.approach, way.load);
        }
        None
    }

    /// Whether the load was as great on the last stretch \[N\].
    pub(crate) fn reaches(&self, load: f64) -> bool {
        self.crossing(load).is_some()
    }

    /// The first state of the last stretch that has this load \[N\], on an excursion.
    pub(crate) fn turning(&self, load: f64) -> Result<Self, PhysicsError> {
        let Some(([mut low, mut high], [mut under, mut over])) = self.crossing(load) else {
            return self.excursion(self.front.state.approach_m);
        };
        let mut side = 0.0;
        for _ in 0..100 {
            let share = under / (under - over);
            let middle = low + share.clamp(0.01, 0.99) * (high - low);
            let trial = self.excursion(middle)?;
            let off = trial.totals.load_n - load;
            // A load that jumps over what is wanted is met where it jumps.
            let closed = (high - low).abs() <= LOAD_TOLERANCE * self.problem().rms_height_m;
            if off.abs() <= LOAD_TOLERANCE * load.abs() || (closed && off >= 0.0) {
                return Ok(trial);
            }
            if closed {
                return self.excursion(high);
            }
            if off < 0.0 {
                (low, under) = (middle, off);
                if side < 0.0 {
                    over *= 0.5;
                }
                side = -1.0;
            } else {
                (high, over) = (middle, off);
                if side > 0.0 {
                    under *= 0.5;
                }
                side = 1.0;
            }
        }
        self.excursion(high)
    }

    /// Puts an uncovering off until the covering spot has shrunk further.
    pub(crate) fn keep_covered(&mut self, i: usize) {
        if let Status::Covered { by, release_m } = self.front.state.status[i] {
            let radius = self.front.state.radius[by].min(release_m);
            self.front.state.status[i] = Status::Covered { by, release_m: RETRY * radius };
        }
    }

    fn back_to(&mut self, mark: &Mark) {
        self.front.clone_from(&mark.front);
        self.log.events.truncate(mark.events);
        self.log.ways.truncate(mark.ways);
        let (events, ways) = (std::mem::take(&mut self.log.events), std::mem::take(&mut self.log.ways));
        self.log = Log { events, ways, ..mark.log.clone_without_events() };
        self.totals = mark.totals;
        (self.far, self.far_at, self.settled) = (0.0, mark.front.state.approach_m, mark.events);
        (self.settled_at, self.balance, self.unbalanced) = (mark.front.state.approach_m, mark.balance, false);
        self.lags.fill(0.0);
        self.flips.clone_from(&mark.flips);
        self.held.clone_from(&mark.held);
    }

    /// Solves the whole contact at an approach, from where the traces lead; takes the events that are overdue there.
    ///
    /// After an event the whole contact jumps here (`jump`): up to here it went on as its traces had it. Otherwise the difference grew on
    /// the way.
    fn settle(&mut self, target: f64, limit: f64, jump: bool) -> Result<(), Halt> {
        let problem = self.problem();
        let mut rounds = 0;
        let mut before_uncovering: Option<(Mark, usize)> = None;
        loop {
            self.front.state.approach_m = target;
            for k in 0..self.front.state.contacts.len() {
                let i = self.front.state.contacts[k];
                let trace = self.front.traces[i];
                if trace.at != target && !trace.value.is_nan() {
                    let asperity = &problem.asperities[i];
                    self.front.state.radius[i] = asperity.radius_at_penetration(trace.ahead(target)).unwrap_or(asperity.jump_off_radius());
                }
            }
            let whole = limit.is_infinite();
            let start = if whole { self.front.state.radius.clone() } else { Vec::new() };
            match self.solver.newton(&mut self.front.state, limit) {
                Ok(drift) => self.log.drift_m = self.log.drift_m.max(drift),
                Err(_) if before_uncovering.is_some() => {
                    // There is no equilibrium with that asperity at the edge of the spot: it stays covered for a while, and is counted.
                    if let Some((mark, i)) = before_uncovering.take() {
                        self.back_to(&mark);
                        self.keep_covered(i);
                        self.held.push(i);
                    }
                    continue;
                }
                Err(_) if whole => {
                    self.front.state.radius = start;
                    self.relax_whole(target)?;
                }
                Err(unsettled) => return Err(unsettled.into()),
            }
            let lagged = self.log.events.len() > self.settled;
            self.retrace(jump || rounds > 0 || lagged);
            self.settled = self.log.events.len();
            let due = self.overdue();
            let Some(first) = due.first() else { break };
            if due.iter().any(|(late, _)| *late > limit) {
                return Err(Unsettled { residual_m: first.0, asperity: first.1.asperity }.into());
            }
            rounds += 1;
            if rounds > 10 * problem.len() + 100 {
                let asperity = first.1.asperity;
                return Err(Halt::Error(PhysicsError::EndlessAvalanche { approach_m: target, events: rounds, asperity }));
            }
            let change = first.1;
            before_uncovering = (change.kind == Kind::Uncover).then(|| (self.mark(), change.asperity));
            self.log.avalanches += 1;
            self.avalanche(change)?;
        }
        Ok(())
    }

    /// Counts the work of the load that spots will have when they know what events have done, up to an approach; from there on it is
    /// greater by `more` \[N\].
    pub(crate) fn far_load(&mut self, approach: f64, more: f64) {
        self.log.work_j += self.far * (approach - self.far_at);
        self.far_at = approach;
        self.far += more;
        self.front.add_load(more);
    }

    /// New traces of everything after the whole contact was solved; the work since the old ones is counted.
    fn retrace(&mut self, jump: bool) {
        let problem = self.problem();
        let target = self.front.state.approach_m;
        let rates = self.solver.rates(&self.front.state);
        if jump {
            self.log.pass(target, self.front.totals(target).load_n);
        }
        self.far_load(target, 0.0);
        self.far = 0.0;
        let mut relaxed = 0.0;
        for (k, rate) in rates.iter().enumerate() {
            let i = self.front.state.contacts[k];
            let (asperity, a) = (&problem.asperities[i], self.front.state.radius[i]);
            let trace = Trace { at: target, value: asperity.penetration(a), rate: asperity.penetration_slope(a) * rate };
            let from = self.front.traces[i];
            if !from.value.is_nan() {
                let to = if jump { Trace { at: target, value: from.ahead(target), ..from } } else { trace };
                self.log.work_j += work(problem, i, from, to);
                if self.lags[i] != 0.0 {
                    let expected = asperity.radius_at_penetration(to.value).unwrap_or(asperity.jump_off_radius());
                    relaxed += 0.5 * self.lags[i] * (asperity.load(a) - asperity.load(expected));
                }
            }
            self.lags[i] = 0.0;
            self.front.traces[i] = trace;
        }
        // Events were charged with the potential of a contact whose other spots keep their loads; those have answered now.
        if let Some(event) = self.log.charged() {
            event.energy_lost_j += relaxed;
        }
        self.front.recount(problem);
        let (totals, potential) = problem.totals(&self.front.state);
        self.totals = totals;
        let lost: f64 = self.log.events[self.settled..].iter().map(|event| event.energy_lost_j).sum();
        let balance = potential + lost - self.log.work_j;
        if std::mem::take(&mut self.unbalanced)
            && let Some(event) = self.log.charged()
        {
            event.energy_lost_j += self.balance - balance;
        }
        // From one solution of the whole to the next only the events since are counted.
        self.balance = potential - self.log.work_j;
        self.settled_at = target;
        if jump {
            self.log.restart(target, self.front.totals(target).load_n);
        } else {
            self.log.pass(target, self.front.totals(target).load_n);
        }
        self.watch(&rates);
    }

    /// New traces of the free asperities that may come to their jump-in. All penetrations are taken anew now and then; between, only those
    /// that can have come near: the half-space follows the surface, so that none grows by more than three times the way, and an event
    /// next to an asperity moves it by no more than a jump-off penetration.
    fn watch(&mut self, rates: &[f64]) {
        let problem = self.problem();
        let (target, unit) = (self.front.state.approach_m, problem.rms_height_m);
        let way = (target - self.known.1).abs();
        let block = |approach: f64| (approach / (0.05 * unit)).floor();
        let anew = self.known.0.is_empty() || block(target) != block(self.known.1);
        let margin = 3.0 * way + self.scale();
        let status = &self.front.state.status;
        let free = |i: &usize| status[*i] == Status::Free;
        let wanted: Vec<usize> = (0..problem.len())
            .filter(free)
            .filter(|i| anew || self.known.0[*i].is_nan() || self.known.0[*i] > problem.jump_in[*i] - margin)
            .collect();
        let found = self.solver.penetrations(&self.front.state, rates, &wanted);
        if anew {
            self.known = (vec![f64::NAN; problem.len()], target);
        }
        let span = 3.0 * self.longest + self.scale();
        self.front.candidates.clear();
        for (i, trace) in wanted.into_iter().zip(found) {
            if anew {
                self.known.0[i] = trace.value;
            }
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
        let changes = self.solver.relax(&mut self.front.state, None)?;
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
    fn collapse(&mut self, target: f64) -> Result<(), Halt> {
        self.log.avalanches += 1;
        let events = self.log.events.len();
        let asperity = self.front.state.contacts.first().copied().unwrap_or(0);
        self.front.state.approach_m = target;
        for (i, a) in self.front.radii(self.problem(), target) {
            self.front.state.radius[i] = a;
        }
        self.relax_whole(target)?;
        if self.log.events.len() == events {
            let (before, (after, _)) = (self.totals, self.problem().totals(&self.front.state));
            self.record(&[Change { kind: Kind::Snap, asperity, by: None }], target, before, after, 0.0);
        }
        for i in self.front.state.contacts.clone() {
            self.front.traces[i].value = f64::NAN;
        }
        self.log.work_j += self.totals.load_n * (target - self.settled_at);
        self.settle(target, f64::INFINITY, true)
    }

    /// Writes changes of one relaxation down; its energy is the first one's.
    pub(crate) fn record(&mut self, moved: &[Change], approach: f64, before: Totals, after: Totals, energy: f64) {
        self.log.charged = self.log.events.len();
        for (k, change) in moved.iter().enumerate() {
            if change.kind != Kind::JumpOff {
                self.flips[change.asperity] = self.flips[change.asperity].saturating_add(1);
            }
            let (from, energy_lost_j) = if k == 0 { (before, energy) } else { (after, 0.0) };
            self.log.events.push(Event {
                kind: change.kind,
                asperity: change.asperity,
                approach_m: approach,
                avalanche: self.log.avalanches,
                before: from,
                after,
                energy_lost_j,
            });
        }
    }

    pub(crate) fn stuck(&self, unsettled: Unsettled) -> PhysicsError {
        PhysicsError::NoEquilibrium {
            approach_m: self.front.state.approach_m,
            residual_m: unsettled.residual_m,
            asperity: unsettled.asperity,
            iterations: self.solver.effort.iterations,
        }
    }
}

impl Log {
    fn charged(&mut self) -> Option<&mut Event> {
        self.events.get_mut(self.charged)
    }

    /// The load has gone on without a jump; it is known at the ends of the parts of a stretch, a twentieth of a jump-off penetration apart.
    pub(crate) fn pass(&mut self, approach: f64, load: f64) {
        self.ways.push(Way { approach, load, least: load.min(self.last) });
        self.last = load;
    }

    /// The load has jumped.
    pub(crate) fn restart(&mut self, approach: f64, load: f64) {
        self.ways.push(Way { approach, load, least: load });
        self.last = load;
    }

    /// The same, of a path that has had no event.
    fn clone_without_events(&self) -> Self {
        Self { events: Vec::new(), ways: Vec::new(), ..*self }
    }
}

fn is_multiple(value: f64, size: f64) -> bool {
    let count = value / size;
    (count - count.round()).abs() < 1e-9
}

/// The next multiple of `size` after `here` in the sense `sign`.
fn next_multiple(here: f64, size: f64, sign: f64) -> f64 {
    let count = here / size * sign;
    let next = if is_multiple(here, size) { count.round() + 1.0 } else { count.ceil() };
    next * sign * size
}
