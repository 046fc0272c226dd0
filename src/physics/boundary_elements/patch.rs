//! Events on a part of the grid.
//!
//! In most events bonds change in a few places, and the displacement changes little elsewhere. Each place is then relaxed alone: the energy of the whole
//! grid is minimised over displacements that vanish outside a square, a *patch*, with an elastic operator that is exact for offsets of up to half a
//! side. This is a descent within a subspace, by steps of the same limited length, so that it passes over no barrier that the whole grid would not pass
//! over. The cost of an iteration is proportional to the area of the patch. If bonds change at the border of a patch, a patch of twice the side replaces
//! it. Patches of several places do not overlap, and their interaction is neglected until the whole grid is relaxed, which follows.
//!
//! The displacement of a patch may have a mean. A uniform shift of the whole grid removes it. The energy of the shift is included to first order: the
//! shift times the mean of pressure and tension. The second order follows with the whole grid.

use super::contact::{Attraction, Bonding, Problem, State};
use super::grid::HalfSpace;
use super::minimise::{Accuracy, Follow, Minimiser, Underway};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;

/// Side of the smallest patch.
const SMALLEST: usize = 32;
/// Least side of the grid, in sides of a patch.
const PARTS: usize = 4;
/// Most places that are followed at once.
const PLACES: usize = 8;
/// Distance from its first point up to which points belong to a place.
const NEAR: usize = 12;
/// The border of a patch has the width of its side over this.
const BORDER: usize = 8;
/// Side of a patch at first: this many times the extent of the changed bonds, and points.
const ROOM: (usize, usize) = (2, 8);
/// Largest residual of a relaxed patch, relative to that of an equilibrium.
const FINISH: f64 = 3.0;
/// Most iterations on a patch.
const ITERATIONS: usize = 600;

/// Patches of growing size.
pub struct Patches(Vec<Patch>);

struct Patch {
    problem: Problem,
    state: State,
    /// Displacement at the points of the patch when it was cut out \[dx\].
    start: Vec<f64>,
    minimiser: Minimiser,
}

/// A place of a patch on the grid: its middle, in rows and columns.
type Place = [usize; 2];

impl Patches {
    /// Patches for a grid; none for one that is small, is itself a patch, or has attraction everywhere.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn new(problem: &Problem) -> Result<Self, PhysicsError> {
        let grid = &problem.half_space;
        let largest = grid.rows().min(grid.columns()) / PARTS;
        if largest < SMALLEST || grid.is_patch() || !matches!(problem.attraction, Attraction::Bonded { .. }) {
            return Ok(Self::none());
        }
        let kernel = grid.kernel()?;
        let sides = std::iter::successors(Some(SMALLEST), |side| Some(2 * side)).take_while(|side| *side <= largest);
        sides.map(|side| Patch::new(problem, side, &kernel)).collect::<Result<_, _>>().map(Self)
    }

    /// No patches.
    #[must_use]
    pub fn none() -> Self {
        Self(Vec::new())
    }

    /// True if there are no patches.
    pub(super) fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// Points of the transforms so far.
    pub(super) fn transformed(&self) -> u64 {
        self.0.iter().map(|patch| patch.minimiser.transforms() * patch.problem.half_space.transformed()).sum()
    }

    /// Relaxes around a place on patches of increasing side, from the `smallest` on, as long as the next `is_open`. The side of the last,
    /// and the points whose bond has changed, with the bond before; `None` if nothing moved.
    fn relax(
        &mut self,
        on: &mut Underway<'_>,
        place: Place,
        smallest: usize,
        is_open: impl Fn(usize) -> bool,
        (centre, accuracy): (f64, Accuracy),
    ) -> Option<(usize, Vec<(usize, Bonding)>)> {
        let mut k = smallest;
        self.0[k].cut(on, place);
        loop {
            let (smaller, larger) = self.0.split_at_mut(k + 1);
            let patch = &mut smaller[k];
            patch.minimiser.centre = centre;
            let outcome = patch.minimiser.minimise(&patch.problem, &mut patch.state, accuracy);
            if k == smallest && outcome.iterations == 0 {
                return None;
            }
            match larger.first_mut() {
                Some(larger) if is_open(larger.side()) && patch.has_changed_at_border(on, place) => {
                    larger.cut(on, place);
                    larger.take_over(patch);
                    k += 1;
                }
                _ => {
                    let changed = patch.paste(on, place);
                    return Some((patch.side(), changed));
                }
            }
        }
    }
}

impl Follow for Patches {
    /// Places follow one another in the order of their largest residuals; one that would overlap an earlier one is left to the whole grid.
    fn follow(&mut self, mut on: Underway<'_>, changed: &[usize], centre: f64, accuracy: Accuracy) -> Vec<(usize, Bonding)> {
        let grid = &on.problem.half_space;
        let accuracy = Accuracy { rms: f64::INFINITY, largest: FINISH * accuracy.largest, iterations: ITERATIONS };
        let mut rest = changed.to_vec();
        let mut done: Vec<(Place, usize)> = Vec::new();
        let mut rebonded = Vec::new();
        while let Some(first) = rest.first().copied().filter(|_| done.len() < PLACES) {
            let (near, others) = rest.into_iter().partition(|point| distance(grid, place(grid, *point), place(grid, first)) <= NEAR);
            rest = others;
            let (place, extent) = surroundings(grid, first, near);
            let is_open = |side: usize| done.iter().all(|(other, its)| distance(grid, place, *other) >= side.midpoint(*its));
            let enough = ROOM.0 * extent + ROOM.1;
            let smallest = self.0.iter().position(|patch| patch.side() >= enough).unwrap_or(self.0.len() - 1);
            if is_open(self.0[smallest].side())
                && let Some((side, changed)) = self.relax(&mut on, place, smallest, is_open, (centre, accuracy))
            {
                done.push((place, side));
                rebonded.extend(changed);
            }
        }
        rebonded
    }
}

impl Patch {
    fn new(whole: &Problem, side: usize, kernel: &[f64]) -> Result<Self, PhysicsError> {
        let field = || filled(side * side, 0.0);
        let problem = Problem {
            half_space: whole.half_space.patch(side, kernel)?,
            law: whole.law.clone(),
            heights: field()?,
            attraction: whole.attraction,
        };
        let state = State { approach: 0.0, displacement: field()?, pressure: field()?, bonds: filled(side * side, Bonding::Free)? };
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
    fn cut(&mut self, on: &Underway<'_>, place: Place) {
        for (k, from) in self.points(&on.problem.half_space, place).enumerate() {
            self.problem.heights[k] = on.problem.heights[from];
            self.start[k] = on.displacement(from);
            self.state.displacement[k] = self.start[k];
            self.state.pressure[k] = on.state.pressure[from] + f64::from(on.pressed[from]);
            self.state.bonds[k] = on.state.bonds[from];
        }
        self.state.approach = on.state.approach;
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
        self.minimiser.press(&self.problem, &mut self.state, &moved);
    }

    fn has_changed_at_border(&self, on: &Underway<'_>, place: Place) -> bool {
        let side = self.side();
        let inside = side / BORDER..side - side / BORDER;
        self.points(&on.problem.half_space, place).enumerate().any(|(k, at)| {
            let at_border = !inside.contains(&(k / side)) || !inside.contains(&(k % side));
            at_border && self.state.bonds[k] != on.state.bonds[at]
        })
    }

    /// Gives displacement and bonds to the whole grid. The points whose bond has changed, with the bond before.
    fn paste(&self, on: &mut Underway<'_>, place: Place) -> Vec<(usize, Bonding)> {
        let mut changed = Vec::new();
        for (k, to) in self.points(&on.problem.half_space, place).enumerate() {
            on.change[to] += (self.state.displacement[k] - self.start[k]) as f32;
            let before = std::mem::replace(&mut on.state.bonds[to], self.state.bonds[k]);
            if before != self.state.bonds[k] {
                changed.push((to, before));
            }
        }
        changed
    }
}

/// Larger of the differences of two places along rows and columns of the periodic grid.
fn distance(grid: &HalfSpace, a: Place, b: Place) -> usize {
    let along = |a: usize, b: usize, size: usize| a.abs_diff(b).min(size - a.abs_diff(b));
    along(a[0], b[0], grid.rows()).max(along(a[1], b[1], grid.columns()))
}

fn place(grid: &HalfSpace, point: usize) -> Place {
    [point / grid.columns(), point % grid.columns()]
}

/// Middle and extent of points that are near the first.
fn surroundings(grid: &HalfSpace, first: usize, near: Vec<usize>) -> (Place, usize) {
    let (size, first) = ([grid.rows(), grid.columns()], place(grid, first));
    let (mut low, mut high) = ([NEAR; 2], [NEAR; 2]);
    for at in near.into_iter().map(|point| place(grid, point)) {
        for k in 0..2 {
            let offset = (at[k] + size[k] + NEAR - first[k]) % size[k];
            (low[k], high[k]) = (low[k].min(offset), high[k].max(offset));
        }
    }
    let middle = [0, 1].map(|k| (first[k] + (low[k] + high[k]) / 2 + size[k] - NEAR) % size[k]);
    (middle, (0..2).map(|k| high[k] - low[k] + 1).max().unwrap_or(1))
}
