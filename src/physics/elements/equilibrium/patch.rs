//! Events on a part of the grid.
//!
//! In most events bonds change in a few places, and the displacement changes little elsewhere. Each place is
//! then relaxed alone: the energy of the whole grid is minimised over displacements that vanish outside a
//! square, a *patch*, with an elastic operator that is exact for offsets of up to half a side. This is a
//! descent within a subspace, by steps of the same limited length, so that it passes over no barrier that the
//! whole grid would not pass over. The cost of an iteration is proportional to the area of the patch. If
//! bonds change at the border of a patch, a patch of twice the side replaces it. Patches of several places do
//! not overlap and are relaxed on several threads; their interaction is neglected until the whole grid is
//! relaxed, which follows.
//!
//! The displacement of a patch may have a mean. A uniform shift of the whole grid removes it. The energy of
//! the shift is included to first order: the shift times the mean of pressure and tension. The second order
//! follows with the whole grid.

use super::minimise::{Accuracy, LocalRelaxation, Minimiser, WorkingState};
use super::places::{Place, Region, SMALLEST_SIDE, places};
use crate::PhysicsError;
use crate::elements::grid::half_space::HalfSpace;
use crate::elements::line::line_tension;
use crate::elements::problem::{Attraction, Bonding, Problem, State};
use crate::memory::filled;
use rayon::prelude::*;

/// Patches that are not in use, by increasing side.
pub struct Patches(Vec<Vec<Patch>>);

struct Patch {
    problem: Problem,
    state: State,
    /// Displacement at the points of the patch when it was cut out \[dx\].
    start: Vec<f64>,
    minimiser: Minimiser,
}

/// A place that is being relaxed on a patch.
struct Job {
    middle: Place,
    patch: Patch,
    /// True once something has moved.
    moved: bool,
}

impl Patches {
    /// Patches for a grid; none for one that is small, is itself a patch, or has attraction everywhere.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn new(problem: &Problem) -> Result<Self, PhysicsError> {
        let grid = &problem.half_space;
        let limits = &problem.numerics.patches;
        let largest = grid.rows().min(grid.columns()) / limits.sides_of_grid;
        if largest < SMALLEST_SIDE
            || grid.is_patch()
            || problem.moves_images_alike()
            || !matches!(problem.attraction, Attraction::Bonded { .. })
        {
            return Ok(Self::none());
        }
        let kernel = grid.kernel()?;
        let sides = std::iter::successors(Some(SMALLEST_SIDE), |side| Some(2 * side))
            .take_while(|side| *side <= largest);
        let points = grid.points().max(limits.points_of_grid * limits.places * limits.always_side.pow(2));
        let count = |side: usize| (points / (limits.points_of_grid * side * side)).clamp(1, limits.places);
        let of_side = |side: usize| {
            (0..count(side)).map(|_| Patch::new(problem, side, &kernel)).collect::<Result<_, _>>()
        };
        sides.map(of_side).collect::<Result<_, _>>().map(Self)
    }

    /// No patches.
    #[must_use]
    pub fn none() -> Self {
        Self(Vec::new())
    }

    /// True if there are no patches.
    pub(crate) fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// Points of the transforms so far.
    pub(crate) fn transformed(&self) -> u64 {
        self.0
            .iter()
            .flatten()
            .map(|patch| patch.minimiser.transforms() * patch.problem.half_space.transformed())
            .sum()
    }

    /// A job with the state of the grid in a region; `None` if all patches of this side are in use.
    fn take(&mut self, on: &WorkingState<'_>, region: Region) -> Option<Job> {
        let mut patch = self.0.get_mut(number(region.side))?.pop()?;
        patch.cut(on, region.middle);
        Some(Job { middle: region.middle, patch, moved: false })
    }

    /// Jobs at the next places that do not overlap, as far as there are patches; others are put off until
    /// these are done.
    fn begin(
        &mut self,
        on: &WorkingState<'_>,
        places: &mut impl Iterator<Item = Region>,
        put_off: &mut Vec<Region>,
        done: &[Region],
    ) -> Vec<Job> {
        let mut jobs: Vec<Job> = Vec::new();
        let mut earlier = std::mem::take(put_off).into_iter();
        while jobs.len() + done.len() < on.problem.numerics.patches.places
            && let Some(next) = earlier.next().or_else(|| places.next())
        {
            let grid = &on.problem.half_space;
            if done.iter().any(|other| next.overlaps(other, grid)) {
                continue;
            }
            let is_open = !jobs.iter().any(|job| next.overlaps(&job.region(), grid));
            match is_open.then(|| self.take(on, next)).flatten() {
                Some(job) => jobs.push(job),
                None => put_off.push(next),
            }
        }
        put_off.extend(earlier);
        jobs
    }

    /// Jobs that continue on larger patches, after all jobs have been relaxed. The other jobs are returned to
    /// the grid; moved regions among them are added to `done`.
    fn settle(
        &mut self,
        on: &mut WorkingState<'_>,
        jobs: Vec<Job>,
        done: &mut Vec<Region>,
        rebonded: &mut Vec<(usize, Bonding)>,
    ) -> Vec<Job> {
        let mut regions: Vec<Region> = jobs.iter().map(Job::region).collect();
        let mut going = Vec::new();
        for (k, job) in jobs.into_iter().enumerate() {
            let larger = Region { side: 2 * regions[k].side, ..regions[k] };
            let others = regions[..k].iter().chain(&regions[k + 1..]).chain(&*done);
            let is_open = !others.into_iter().any(|other| larger.overlaps(other, &on.problem.half_space));
            if job.moved
                && is_open
                && job.patch.has_changed_at_border(on, regions[k].middle)
                && let Some(mut next) = self.take(on, larger)
            {
                next.patch.take_over(&job.patch);
                next.moved = true;
                regions[k] = larger;
                going.push(next);
            } else if job.moved {
                rebonded.extend(job.patch.paste(on, job.middle));
                done.push(job.region());
            }
            self.0[number(job.patch.side())].push(job.patch);
        }
        going
    }
}

impl Job {
    fn region(&self) -> Region {
        Region { middle: self.middle, side: self.patch.side() }
    }
}

impl LocalRelaxation for Patches {
    /// Places are taken in the order of their largest residuals, and relaxed side by side; one that overlaps
    /// an earlier one is left to the whole grid.
    fn relax(
        &mut self,
        mut on: WorkingState<'_>,
        changed: &[usize],
        centre: f64,
        accuracy: Accuracy,
    ) -> Vec<(usize, Bonding)> {
        let problem = on.problem;
        let limits = problem.numerics.patches;
        let accuracy = Accuracy {
            rms: f64::INFINITY,
            largest: limits.residual * accuracy.largest,
            iterations: limits.iterations,
        };
        let largest = SMALLEST_SIDE << (self.0.len() - 1);
        let mut places = places(&problem.half_space, changed, limits, largest);
        let (mut put_off, mut done, mut rebonded) = (Vec::new(), Vec::new(), Vec::new());
        loop {
            let mut jobs = self.begin(&on, &mut places, &mut put_off, &done);
            if jobs.is_empty() {
                return rebonded;
            }
            while !jobs.is_empty() {
                jobs.par_iter_mut().with_max_len(1).for_each(|job| {
                    let Patch { problem, state, minimiser, .. } = &mut job.patch;
                    minimiser.centre = centre;
                    let outcome = minimiser.minimise(problem, state, accuracy);
                    job.moved |= outcome.iterations > 0;
                });
                jobs = self.settle(&mut on, jobs, &mut done, &mut rebonded);
            }
        }
    }
}

/// Number of a side.
fn number(side: usize) -> usize {
    (side / SMALLEST_SIDE).ilog2() as usize
}

impl Patch {
    fn new(whole: &Problem, side: usize, kernel: &[f64]) -> Result<Self, PhysicsError> {
        let field = || filled(side * side, 0.0);
        let problem = Problem {
            half_space: whole.half_space.patch(side, kernel)?,
            law: whole.law.clone(),
            heights: field()?,
            attraction: whole.attraction,
            machine_compliance: 0.0,
            numerics: whole.numerics,
        };
        let state = State {
            mean_penetration: 0.0,
            displacement: field()?,
            pressure: field()?,
            bonds: filled(side * side, Bonding::Free)?,
        };
        Ok(Self { minimiser: Minimiser::new(&problem)?, problem, state, start: field()? })
    }

    fn side(&self) -> usize {
        self.problem.half_space.rows()
    }

    /// Points of the whole grid, in the order of the patch.
    fn points(&self, grid: &HalfSpace, place: Place) -> impl Iterator<Item = usize> + use<> {
        let (side, rows, columns) = (self.side(), grid.rows(), grid.columns());
        let [row, column] = [place[0] + rows - side / 2, place[1] + columns - side / 2];
        (0..side * side).map(move |k| (row + k / side) % rows * columns + (column + k % side) % columns)
    }

    /// Takes heights and state from the whole grid.
    fn cut(&mut self, on: &WorkingState<'_>, place: Place) {
        for (k, from) in self.points(&on.problem.half_space, place).enumerate() {
            self.problem.heights[k] = on.problem.heights[from];
            self.start[k] = on.displacement(from);
            self.state.displacement[k] = self.start[k];
            self.state.pressure[k] = on.state.pressure[from] + f64::from(on.pressure_change[from]);
            self.state.bonds[k] = on.state.bonds[from];
        }
        self.state.mean_penetration = on.state.mean_penetration;
        self.hold_line_at_border(on, place);
    }

    /// Adds the tension of the line that points beyond the border of the patch cause at it, as a pressure.
    fn hold_line_at_border(&mut self, on: &WorkingState<'_>, place: Place) {
        let (law, side) = (&on.problem.law, self.side());
        if !law.has_line() {
            return;
        }
        let of_grid = |at: usize| {
            let gap = on.displacement(at) - on.state.mean_penetration - on.problem.heights[at];
            law.profile(on.state.bonds[at], gap)
        };
        let is_border = |k: usize| [k / side, k % side].iter().any(|at| *at == 0 || *at == side - 1);
        let grid = &on.problem.half_space;
        let held: Vec<(usize, f64)> = self
            .points(grid, place)
            .enumerate()
            .filter(|(k, _)| is_border(*k))
            .map(|(k, at)| {
                let whole = line_tension(grid, law, at, of_grid);
                (k, whole - self.problem.line_tension(&self.state, k))
            })
            .collect();
        held.into_iter().for_each(|(k, tension)| self.state.pressure[k] += tension);
    }

    /// Takes over what has happened on a smaller patch with the same middle.
    fn take_over(&mut self, smaller: &Self) {
        let (side, inner) = (self.side(), smaller.side());
        let first = side / 2 - inner / 2;
        let mut moved = vec![0.0; side * side];
        for k in 0..inner * inner {
            let to = (k / inner + first) * side + k % inner + first;
            moved[to] = smaller.state.displacement[k] - smaller.start[k];
            self.state.displacement[to] += moved[to];
            self.state.bonds[to] = smaller.state.bonds[k];
        }
        self.minimiser.add_pressure(&self.problem, &mut self.state, &moved);
    }

    fn has_changed_at_border(&self, on: &WorkingState<'_>, place: Place) -> bool {
        let side = self.side();
        let border = side / self.problem.numerics.patches.borders_of_side;
        let inside = border..side - border;
        self.points(&on.problem.half_space, place).enumerate().any(|(k, at)| {
            let at_border = !inside.contains(&(k / side)) || !inside.contains(&(k % side));
            at_border && self.state.bonds[k] != on.state.bonds[at]
        })
    }

    /// Gives displacement and bonds to the whole grid. The points whose bond has changed, with the bond
    /// before.
    fn paste(&self, on: &mut WorkingState<'_>, place: Place) -> Vec<(usize, Bonding)> {
        let mut changed = Vec::new();
        for (k, to) in self.points(&on.problem.half_space, place).enumerate() {
            on.relaxed[to] += (self.state.displacement[k] - self.start[k]) as f32;
            let before = std::mem::replace(&mut on.state.bonds[to], self.state.bonds[k]);
            if before != self.state.bonds[k] {
                changed.push((to, before));
            }
        }
        changed
    }
}
