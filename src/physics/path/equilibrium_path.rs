//! The path of the contact under displacement control, from event to event.
//!
//! The path goes in stretches. At both ends of a stretch the whole contact is in equilibrium (residual 1e-10 of the rms height). Between them
//! every event is found and solved in its own neighbourhood ([`crate::physics::solve::local`]), in the order of the approaches; what the rest of the contact
//! does to a neighbourhood changes in proportion to the approach meanwhile. At the end the whole contact is solved: what its residual was
//! before is the error of all this, and where it is more than [`DRIFT`] the stretch is done again in halves. Nothing of it depends on where
//! the path is asked for its state: the steps of the approach are read off the path, and do not make it.
//!
//! An event takes everything with it that follows at the same approach: an avalanche. Within it one change is taken at a time, the most
//! overdue, and the neighbourhood relaxes before the next is looked for. An asperity that left within an avalanche does not return within it.

use super::event_log::Log;
use super::pending::Ripple;
use super::predictor::{Due, Front};
use crate::physics::contact::problem::{Problem, Totals};
use crate::physics::contact::state::{State, Status};
use crate::physics::contact::transition::{Change, Kind};
use crate::physics::half_space::Effort;
use crate::physics::math::bracket::{End, Illinois};
use crate::physics::solve::global::Solver;
use crate::physics::solve::local::Patch;
use crate::physics::solve::residual::Unsettled;
use crate::physics::solve::trace::Trace;
use crate::physics::{PhysicsError, Reason};

/// Greatest root mean square of the residuals at the end of a stretch, before the whole contact is solved; of the mean jump-off penetration.
pub const DRIFT: f64 = 1e-2;

/// Greatest residual of one spot there.
pub(crate) const WORST: f64 = 1e-1;

/// Greatest lateness of an event that is found there.
pub(crate) const LATE: f64 = 5e-3;

/// Greatest lag of a spot next to a neighbourhood, until it learns of it.
const LAG: f64 = 5e-3;

/// Tolerance of an event's approach, of the rms height, where the order of two is decided or a fold is passed.
pub const EVENT_TOLERANCE: f64 = 1e-6;

/// Tolerance of the load at a turning point, relative; and of its approach, of the rms height, where the load jumps over it.
const LOAD_TOLERANCE: f64 = 1e-9;

/// Grid of approaches, of the rms height, on which the whole contact is solved to the last digits.
pub(crate) const UNIT: f64 = 0.01;

/// How often a stretch is halved before the whole contact is relaxed in place of it.
const HALVINGS: u32 = 14;

/// How often a stretch is halved before its drift is let pass.
const PATIENCE: u32 = 6;

/// Where uncovering an asperity is in vain, it is tried again when the covering spot has shrunk to this share of its radius.
const RETRY: f64 = 0.97;

/// Changes other than leaving that one asperity takes in one longest stretch.
pub(crate) const FLIPS: u8 = 3;

/// How well the whole contact is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Depth {
    /// To the last digits: the state is one to be written down.
    Whole,
    /// A good deal better than [`LAG`] and [`LATE`]: what is left is found at the next solution.
    Enough,
}

/// Where a path was, to go back to.
pub(crate) struct Mark {
    pub(super) front: Front,
    pub(super) events: usize,
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
    /// The longest stretch, the mean jump-off penetration rounded down \[m\], and how often a stretch is halved now.
    pub(crate) longest: f64,
    pub(super) scale: f64,
    pub(super) halvings: u32,
    /// Spots and free asperities next to the neighbourhood, how far they reach \[m\], and where it is.
    pub(crate) halo: Vec<usize>,
    pub(crate) halo_reach: f64,
    pub(crate) centre: [f64; 2],
    /// What its spots do not know yet \[m\].
    pub(crate) missed: Vec<f64>,
    /// What neighbourhoods have done from afar since the whole contact was solved, and how many of these each asperity has heard of.
    pub(crate) ripples: Vec<Ripple>,
    pub(crate) heard: Vec<usize>,
    /// Displacement under each spot since the whole contact was solved, as far as it does not know it yet \[m\]; what all that will do to the
    /// load \[N\], and the approach from which on it has been counted \[m\].
    pub(crate) lags: Vec<f64>,
    /// The same with what has come from afar, when the whole contact is being solved \[m\].
    pub(crate) whole_lags: Vec<f64>,
    pub(crate) far: f64,
    pub(crate) far_at: f64,
    /// Spots that lag too far.
    pub(crate) urgent: Vec<usize>,
    /// Changes that were found too late when this stretch was tried before.
    pub(crate) foreseen: Vec<Change>,
    /// How many events there were when the whole contact was solved last, at which approach, and the balance `Π + Σ energy lost − work` then \[J\].
    pub(crate) settled: usize,
    pub(crate) settled_at: f64,
    pub(crate) balance: f64,
    /// True if the balance is to be closed by what the last event has lost.
    pub(crate) unbalanced: bool,
    /// The neighbourhood of the event at hand; the radii that its spots had at the approach `reference` \[m\], before they went to the event.
    pub(crate) patch: Patch,
    pub(crate) origin: Vec<f64>,
    pub(crate) reference: f64,
    /// Traces to be put into the front: asperity, radius, trace.
    pub(crate) pending: Vec<(usize, f64, Trace)>,
    /// Events expected in this stretch.
    pub(crate) queue: Vec<Due>,
    /// Where the penetrations of all free asperities were taken last \[m\].
    pub(crate) watched_at: Option<f64>,
    /// How often each asperity has been covered, uncovered or has jumped in within the present longest stretch.
    pub(crate) flips: Vec<u8>,
    /// Changes that were not taken since the last record because the asperity had flipped too often.
    pub(crate) held: Vec<usize>,
    /// How well the whole contact is solved where the path is.
    pub(crate) solved: Depth,
    /// Number of events at which the present increment of the approach ends with an error.
    pub(super) event_limit: usize,
    /// Before the last stretch.
    pub(super) mark: Option<Box<Mark>>,
}

/// Why a stretch was not done.
pub(crate) enum Halt {
    /// It is too long, or leads to no equilibrium.
    Unsettled(Unsettled),
    /// These changes were found too late.
    Late(Vec<Change>, Unsettled),
    /// It cannot be done at all.
    Error(PhysicsError),
}

impl From<Unsettled> for Halt {
    fn from(unsettled: Unsettled) -> Self {
        Self::Unsettled(unsettled)
    }
}

impl<'p> Path<'p> {
    /// A path that knows nothing but its front.
    pub(super) fn bare(problem: &'p Problem, front: Front, sign: f64, (longest, scale): (f64, f64)) -> Self {
        let (n, approach) = (problem.len(), front.state.approach_m);
        Self {
            solver: Solver::new(problem),
            front,
            log: Log::default(),
            sign,
            totals: Totals::default(),
            longest,
            scale,
            halvings: 0,
            halo: Vec::new(),
            halo_reach: 0.0,
            centre: [0.0; 2],
            missed: Vec::new(),
            ripples: Vec::new(),
            heard: vec![0; n],
            lags: vec![0.0; n],
            whole_lags: vec![0.0; n],
            far: 0.0,
            far_at: approach,
            urgent: Vec::new(),
            foreseen: Vec::new(),
            settled: 0,
            settled_at: approach,
            balance: 0.0,
            unbalanced: false,
            patch: Patch::default(),
            origin: Vec::new(),
            reference: approach,
            pending: Vec::new(),
            queue: Vec::new(),
            watched_at: None,
            flips: vec![0; n],
            held: Vec::new(),
            solved: Depth::Whole,
            event_limit: usize::MAX,
            mark: None,
        }
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
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Lag that a spot may have \[m\].
    pub(crate) fn lag_limit(&self) -> f64 {
        LAG * self.scale()
    }

    /// The whole contact has been solved: nothing is to be learned.
    pub(crate) fn forget(&mut self) {
        self.lags.fill(0.0);
        self.heard.fill(0);
        self.ripples.clear();
        self.urgent.clear();
    }

    /// What is needed to come back to the present state, in which the whole contact is solved.
    pub(crate) fn mark(&self) -> Mark {
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
        self.limit_events();
        loop {
            let here = self.front.state.approach_m;
            let size = self.longest * 0.5f64.powi(self.halvings as i32);
            let mut target = next_multiple(here, size, self.sign);
            if bound.is_some_and(|bound| (target - bound) * self.sign > -1e-9 * size) {
                target = bound.unwrap_or(target);
            }
            let strict = self.halvings < PATIENCE;
            let unsettled = match self.events_and_settle(target, strict, self.depth(target, bound)).and_then(|()| self.sound(mark.events)) {
                Ok(()) => {
                    // Whether the next longer stretch may be tried: it must end on a multiple of itself.
                    if self.halvings > 0 && next_multiple(target, size, self.sign) == next_multiple(target, 2.0 * size, self.sign) {
                        self.halvings -= 1;
                    }
                    if is_multiple(target, self.longest) {
                        self.flips.fill(0);
                    }
                    self.foreseen.clear();
                    self.mark = Some(Box::new(mark));
                    return Ok(());
                }
                Err(Halt::Error(error)) => return Err(error),
                Err(Halt::Late(late, unsettled)) => {
                    let known = self.foreseen.len();
                    for change in late {
                        if !self.foreseen.contains(&change) {
                            self.foreseen.push(change);
                        }
                    }
                    if self.foreseen.len() > known {
                        self.back_to(&mark);
                        continue;
                    }
                    unsettled
                }
                Err(Halt::Unsettled(unsettled)) => unsettled,
            };
            let mut uncovered: Vec<usize> =
                self.log.events[mark.events..].iter().filter(|e| e.kind == Kind::Uncover).map(|e| e.asperity).collect();
            self.back_to(&mark);
            uncovered.retain(|i| matches!(self.front.state.status[*i], Status::Covered { .. }));
            if self.halvings >= PATIENCE && !uncovered.is_empty() {
                // At the edge of a spot the field is steepest, and there may be no equilibrium with an asperity there.
                self.hold_covered(&uncovered);
                mark = self.mark();
                self.halvings = 0;
            } else if self.halvings >= HALVINGS {
                self.collapse(target).and_then(|()| self.sound(mark.events)).map_err(|halt| match halt {
                    Halt::Error(error) => error,
                    Halt::Unsettled(_) | Halt::Late(..) => self.stuck(unsettled),
                })?;
                self.halvings = HALVINGS / 2;
                self.mark = Some(Box::new(mark));
                return Ok(());
            } else {
                // Half a stretch may end where the whole one did.
                let end = |halvings: u32| next_multiple(here, self.longest * 0.5f64.powi(halvings as i32), self.sign);
                let ended = end(self.halvings);
                self.halvings += 1;
                while end(self.halvings) == ended && self.halvings < HALVINGS {
                    self.halvings += 1;
                }
            }
        }
    }

    /// Takes the events on the way to `target` and solves the whole contact there; on the way too, after events that move all of it.
    fn events_and_settle(&mut self, target: f64, strict: bool, depth: Depth) -> Result<(), Halt> {
        while let Some(approach) = self.events_until(target)? {
            let there = approach == target;
            self.settle(approach, false, true, if there { depth } else { self.between() })?;
            if there {
                return Ok(());
            }
        }
        self.settle(target, strict, false, depth)
    }

    /// How well the whole contact is solved where its state is not asked for: where neighbourhoods hold all spots, as well as they are.
    fn between(&self) -> Depth {
        if self.problem().solves_whole() { Depth::Whole } else { Depth::Enough }
    }

    /// How well it is solved at the end of a stretch. States are asked for on the grid of [`UNIT`] mostly, and wherever a path is bound to go.
    fn depth(&self, target: f64, bound: Option<f64>) -> Depth {
        let asked = bound == Some(target) || is_multiple(target, UNIT * self.problem().rms_height_m);
        if asked { Depth::Whole } else { self.between() }
    }

    /// True if all that was counted is a number: a load that was not must not spoil a sum without a word.
    fn sound(&self, events: usize) -> Result<(), Halt> {
        let energies = self.log.events[events..].iter().map(|event| event.energy_lost_j + event.before.load_n + event.after.load_n);
        if self.log.work_j.is_finite() && self.totals.load_n.is_finite() && energies.into_iter().all(f64::is_finite) {
            return Ok(());
        }
        let asperity = self.front.state.contacts.first().copied().unwrap_or(0);
        Err(Unsettled::because(Reason::NotANumber, asperity).into())
    }

    /// Another path, from before the last stretch to `target` within it.
    pub(crate) fn excursion(&self, target: f64) -> Result<Self, PhysicsError> {
        let mut other = Self::bare(self.problem(), self.front.clone(), self.sign, (self.longest, self.scale));
        (other.far_at, other.settled_at) = (self.far_at, self.settled_at);
        match self.mark.as_deref() {
            Some(mark) => other.back_to(mark),
            None => {
                other.log = self.log.clone_without_events();
                (other.totals, other.balance) = (self.totals, self.balance);
                other.flips.clone_from(&self.flips);
            }
        }
        other.held.clear();
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

    /// The first state of the last stretch that has this load \[N\], on an excursion; nothing where only the traces had it.
    pub(crate) fn turning(&mut self, load: f64) -> Result<Option<Self>, PhysicsError> {
        if self.mark.is_none() && self.totals.load_n >= load {
            return self.excursion(self.front.state.approach_m).map(Some);
        }
        let Some(([mut low, mut high], [under, over])) = self.crossing(load) else { return Ok(None) };
        let mut ends = Illinois::new(under, over);
        for _ in 0..100 {
            let middle = low + ends.share(0.01) * (high - low);
            let trial = self.excursion(middle)?;
            self.solver.effort += trial.effort();
            let off = trial.totals.load_n - load;
            // A load that jumps over what is wanted is met where it jumps.
            let closed = (high - low).abs() <= LOAD_TOLERANCE * self.problem().rms_height_m;
            if off.abs() <= LOAD_TOLERANCE * load.abs() || (closed && off >= 0.0) {
                return Ok(Some(trial));
            }
            if closed {
                break;
            }
            if off < 0.0 {
                low = middle;
                ends.narrow(End::Low, off);
            } else {
                high = middle;
                ends.narrow(End::High, off);
            }
        }
        let found = self.reaching(high, load)?;
        Ok((found.totals.load_n >= load - LOAD_TOLERANCE * load.abs()).then_some(found))
    }

    /// The state of the last stretch at an approach or soon after it that has so much load \[N\]: where the load jumps over it, an excursion may
    /// meet the jump a little later than the stretch did. Where none has, the one with the greatest load.
    fn reaching(&mut self, mut at: f64, load: f64) -> Result<Self, PhysicsError> {
        let end = self.front.state.approach_m;
        let mut further = LOAD_TOLERANCE * self.problem().rms_height_m;
        let mut best = self.excursion(at)?;
        self.solver.effort += best.effort();
        while best.totals.load_n < load && at != end {
            further *= 4.0;
            at = if (end - at) * self.sign > further { at + self.sign * further } else { end };
            let trial = self.excursion(at)?;
            self.solver.effort += trial.effort();
            if trial.totals.load_n > best.totals.load_n {
                best = trial;
            }
        }
        Ok(best)
    }

    /// Puts an uncovering off until the covering spot has shrunk further. Where that is no spot any more, the asperity rides with the one that carries it; where
    /// there is none, it is free, and as one that has left it does not jump in before its penetration has been below the jump-in.
    pub(crate) fn keep_covered(&mut self, i: usize, approach: f64) {
        let Status::Covered { by, release_m } = self.front.state.status[i] else { return };
        let radius = &self.front.state.radius;
        match self.front.state.carrier(by) {
            Some(carrier) if carrier == by => {
                self.front.state.status[i] = Status::Covered { by, release_m: RETRY * radius[by].min(release_m) };
            }
            Some(carrier) => {
                let release_m = RETRY * radius[carrier];
                self.front.set(i, Status::Covered { by: carrier, release_m }, 0.0);
            }
            None => {
                self.front.set(i, Status::Free, 0.0);
                self.front.state.barred[i] = true;
                self.front.traces[i].value = f64::NAN;
                let totals = self.front.totals(approach);
                self.log.note(Change { kind: Kind::Uncover, asperity: i, by: Some(by) }, approach, totals);
            }
        }
    }

    /// Asperities that find no equilibrium where they are uncovered stay covered for a while, and are counted.
    pub(crate) fn hold_covered(&mut self, uncovered: &[usize]) {
        for &i in uncovered {
            self.keep_covered(i, self.front.state.approach_m);
            self.held.push(i);
        }
    }

    pub(crate) fn back_to(&mut self, mark: &Mark) {
        self.front.clone_from(&mark.front);
        self.log.back_to(&mark.log, mark.events, mark.ways);
        self.totals = mark.totals;
        (self.far, self.far_at, self.settled) = (0.0, mark.front.state.approach_m, self.log.events.len());
        (self.settled_at, self.balance, self.unbalanced) = (mark.front.state.approach_m, mark.balance, false);
        self.forget();
        self.flips.clone_from(&mark.flips);
        self.held.clone_from(&mark.held);
    }

    pub(crate) fn stuck(&self, unsettled: Unsettled) -> PhysicsError {
        PhysicsError::NoEquilibrium {
            approach_m: self.front.state.approach_m,
            reason: unsettled.reason,
            residual_m: unsettled.residual_m,
            asperity: self.problem().number(unsettled.asperity),
            iterations: self.solver.effort.iterations,
        }
    }
}

/// True if `value` is a multiple of `size` to rounding, which grows with their ratio.
pub(crate) fn is_multiple(value: f64, size: f64) -> bool {
    let count = value / size;
    (count - count.round()).abs() < 1e-9 + 4.0 * f64::EPSILON * count.abs()
}

/// The next multiple of `size` after `here` in the sense `sign`.
fn next_multiple(here: f64, size: f64, sign: f64) -> f64 {
    let count = here / size * sign;
    let next = if is_multiple(here, size) { count.round() + 1.0 } else { count.ceil() };
    next * sign * size
}
