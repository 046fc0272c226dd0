//! Line tension of fronts during a minimisation.
//!
//! The step φ of a point follows from its gap, so that no field of it is kept. A band of rows is evaluated
//! from the first to the last, with three rows of φ at a time.

use super::passes::{Found, Stride};
use crate::elements::grid::sums::{panel_largest, panel_sums};
use crate::elements::law::{Bonding, Crack, Law, Profile};
use crate::elements::line::{beside, laplacian};
use crate::elements::problem::Problem;
use multiversion::multiversion;
use rayon::prelude::*;

/// Rows that are evaluated one after another.
pub(super) const BAND: usize = 16;
/// Points of a row that are evaluated together.
const BLOCK: usize = 64;

/// Gaps and directions at all points.
#[derive(Clone, Copy)]
pub(super) struct Gaps<'a> {
    pub(super) gap: &'a [f32],
    pub(super) displacement: &'a [f32],
    pub(super) direction: &'a [f32],
    pub(super) bonds: &'a [Bonding],
}

impl<'a> Gaps<'a> {
    fn part(&self, range: std::ops::Range<usize>) -> Self {
        Gaps {
            gap: &self.gap[range.clone()],
            displacement: &self.displacement[range.clone()],
            direction: &self.direction[range.clone()],
            bonds: &self.bonds[range],
        }
    }
}

/// Step φ of a row. Its derivatives are those of the points where φ changes with the gap, or has changed in
/// the last step, one after another.
#[derive(Default)]
pub(super) struct Row {
    pub(super) value: Vec<f64>,
    /// Change in the last step.
    change: Vec<f64>,
    /// These points.
    pub(super) places: Vec<u32>,
    pub(super) profiles: Vec<Steep>,
}

/// Derivatives of φ at a point, as in [`Profile`], and its change of first order in the last step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Steep {
    pub(super) rate: f64,
    pub(super) bend: f64,
    pub(super) excess: f64,
    linear: f64,
}

/// Values of a block of points.
struct Block {
    /// 1 where φ or its change has to be evaluated.
    is_steep: [u8; BLOCK],
    /// Gap of these points one after another, and its change in the step; φ after it and before it.
    gap: [f64; BLOCK],
    moved: [f64; BLOCK],
    after: [Profile; BLOCK],
    before: [Profile; BLOCK],
}

impl Default for Block {
    fn default() -> Self {
        Self {
            is_steep: [0; BLOCK],
            gap: [0.0; BLOCK],
            moved: [0.0; BLOCK],
            after: [Profile::default(); BLOCK],
            before: [Profile::default(); BLOCK],
        }
    }
}

impl Row {
    /// Evaluates a row of gaps.
    fn evaluate(&mut self, law: &Crack, from: Gaps<'_>, stride: Stride, block: &mut Block) {
        let columns = from.gap.len();
        self.value.resize(columns, 0.0);
        self.change.resize(columns, 0.0);
        self.places.iter().for_each(|k| self.change[*k as usize] = 0.0);
        self.places.clear();
        self.profiles.clear();
        for start in (0..columns).step_by(BLOCK) {
            let range = start..columns.min(start + BLOCK);
            let from = from.part(range.clone());
            if flat(law, from, stride, &mut self.value[range], &mut block.is_steep) {
                self.add_steep(law, from, stride, start, block);
            }
        }
    }

    /// Evaluates the points of a block at which φ changes.
    fn add_steep(&mut self, law: &Crack, from: Gaps<'_>, stride: Stride, start: usize, block: &mut Block) {
        let first = self.places.len();
        for k in (0..from.gap.len()).filter(|k| block.is_steep[*k] != 0) {
            let j = self.places.len() - first;
            self.places.push((start + k) as u32);
            [block.gap[j], block.moved[j]] = gap_after(from, stride, k);
        }
        let count = self.places.len() - first;
        profiles(law, block, count);
        for (j, k) in self.places[first..].iter().map(|k| *k as usize).enumerate() {
            let (after, before) = (block.after[j], block.before[j]);
            self.value[k] = after.value;
            self.change[k] = after.value - before.value;
            let linear = before.rate * block.moved[j];
            self.profiles.push(Steep { rate: after.rate, bend: after.bend, excess: after.excess, linear });
        }
    }
}

/// Gap of a point, and its change in the step.
#[inline(always)]
fn gap_after(from: Gaps<'_>, stride: Stride, k: usize) -> [f64; 2] {
    let gap = f64::from(from.gap[k]) + f64::from(from.displacement[k]);
    [gap, f64::from(stride.length * (from.direction[k] - stride.mean))]
}

/// φ where it is 1 or 0. True if there are other points.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn flat(law: &Crack, from: Gaps<'_>, stride: Stride, value: &mut [f64], is_steep: &mut [u8; BLOCK]) -> bool {
    let n = value.len().min(BLOCK);
    let from = from.part(0..n);
    let [first, last] = law.steep_gaps();
    let mut any = 0;
    for k in 0..n {
        let [after, moved] = gap_after(from, stride, k);
        let before = after - moved;
        let (is_bonded, is_sealed) =
            (from.bonds[k] as u8 == Bonding::Bonded as u8, from.bonds[k] as u8 == Bonding::Sealed as u8);
        let is_inside = is_sealed | (is_bonded & (after < first));
        value[k] = if is_inside { 1.0 } else { 0.0 };
        let is_open = (after > last) & (before > last);
        let is_closed = (after < first) & (before < first);
        is_steep[k] = u8::from(is_bonded & !is_open & !is_closed);
        any |= is_steep[k];
    }
    any != 0
}

/// φ at the first points of a block.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn profiles(law: &Crack, block: &mut Block, count: usize) {
    for k in 0..count.min(BLOCK) {
        block.after[k] = law.profile(block.gap[k]);
        block.before[k] = law.profile(block.gap[k] - block.moved[k]);
    }
}

/// Three rows, and work space.
#[derive(Default)]
pub(super) struct Sweep {
    rows: [Row; 3],
    block: Block,
}

impl Sweep {
    /// Calls `with` for each row of a band with φ in the row before, in it and in the row after.
    pub(super) fn band(
        &mut self,
        problem: &Problem,
        from: Gaps<'_>,
        stride: Stride,
        band: std::ops::Range<usize>,
        mut with: impl FnMut(usize, [&Row; 3]),
    ) {
        let (grid, columns) = (&problem.half_space, problem.half_space.columns());
        let Law::Crack(law) = &problem.law else { return };
        let Self { rows, block } = self;
        let mut evaluate = |to: &mut Row, row: usize| {
            to.evaluate(law, from.part(row * columns..(row + 1) * columns), stride, block);
        };
        for row in band.clone() {
            let [before, here, after] = beside(row, grid.rows(), grid.is_patch());
            if row == band.start {
                evaluate(&mut rows[0], before);
                evaluate(&mut rows[1], here);
            } else {
                rows.rotate_left(1);
            }
            evaluate(&mut rows[2], after);
            with(row, [&rows[0], &rows[1], &rows[2]]);
        }
    }
}

/// Adds the tension of the line to the gradient. Adds to the slopes, for the preconditioner, the excess of
/// the slope of the tension of a straight front over that of the law, and a mean stiffness of the line for
/// waves along the front. Returns the sums of [`Found`] but that of the elastic response.
pub(super) fn add_line(
    problem: &Problem,
    from: Gaps<'_>,
    gradient: &mut [f32],
    slopes: &mut [f32],
    stride: Stride,
) -> Found {
    let (columns, factor) = (problem.half_space.columns(), problem.law.line_factor());
    let is_patch = problem.half_space.is_patch();
    let bands = gradient.par_chunks_mut(BAND * columns).zip(slopes.par_chunks_mut(BAND * columns));
    let parts: Vec<Vec<Found>> = bands
        .enumerate()
        .map_init(Sweep::default, |sweep, (band, (gradient, slopes))| {
            let first = band * BAND;
            let mut parts = Vec::with_capacity(BAND);
            sweep.band(problem, from, stride, first..first + gradient.len() / columns, |row, rows| {
                let here = (row - first) * columns..(row - first + 1) * columns;
                let (gradient, slopes) = (&mut gradient[here.clone()], &mut slopes[here]);
                let direction = &from.direction[row * columns..(row + 1) * columns];
                parts.push(bend_row(rows, gradient, slopes, direction, factor, is_patch));
            });
            parts
        })
        .collect();
    let mut all = Found::default();
    parts.iter().flatten().for_each(|part| all.add(part));
    all
}

/// As [`add_line`], in a row.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn bend_row(
    rows: [&Row; 3],
    gradient: &mut [f32],
    slopes: &mut [f32],
    direction: &[f32],
    factor: f64,
    is_patch: bool,
) -> Found {
    let here = rows[1];
    let (values, changes) = (rows.map(|row| row.value.as_slice()), rows.map(|row| row.change.as_slice()));
    let mut beyond = 0.0;
    for (k, of) in here.places.iter().map(|k| *k as usize).zip(&here.profiles) {
        let at = beside(k, here.value.len(), is_patch);
        let [bend, bend_change] = [laplacian(values, at), laplacian(changes, at)];
        gradient[k] += (factor * of.rate * bend) as f32;
        slopes[k] += (of.excess + factor * of.rate * of.rate) as f32;
        let change = here.change[k];
        beyond += factor * (0.5 * change * bend_change + (bend - bend_change) * (change - of.linear));
    }
    let [sum, square, slope] = panel_sums([&*gradient, direction], |[g, d]| [g, g * g, g * d]);
    Found { gradient: [sum, square], slope, largest: panel_largest(gradient), beyond, ..Found::default() }
}
