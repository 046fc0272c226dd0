//! Line tension of fronts during a minimisation.
//!
//! The step φ of a point follows from its gap, so that no field of it is kept. A band of rows is evaluated
//! from the first to the last, with three rows of φ at a time.

use super::passes::{Found, Stride};
use crate::elements::grid::sums::{panel_largest, panel_sums};
use crate::elements::law::{Bonding, Profile};
use crate::elements::line::{beside, laplacian};
use crate::elements::problem::Problem;
use rayon::prelude::*;

/// Rows that are evaluated one after another.
pub(super) const BAND: usize = 16;

/// Gaps and directions at all points.
#[derive(Clone, Copy)]
pub(super) struct Gaps<'a> {
    pub(super) gap: &'a [f32],
    pub(super) displacement: &'a [f32],
    pub(super) direction: &'a [f32],
    pub(super) bonds: &'a [Bonding],
}

/// Step φ of a row.
#[derive(Clone, Default)]
pub(super) struct Row {
    pub(super) value: Vec<f64>,
    /// Change in the last step, and that of first order.
    change: Vec<f64>,
    linear: Vec<f64>,
    pub(super) of: Vec<Profile>,
}

impl Row {
    fn evaluate(&mut self, problem: &Problem, from: Gaps<'_>, row: usize, stride: Stride) {
        let columns = problem.half_space.columns();
        self.value.resize(columns, 0.0);
        self.change.resize(columns, 0.0);
        self.linear.resize(columns, 0.0);
        self.of.resize(columns, Profile::default());
        for k in 0..columns {
            let at = row * columns + k;
            let gap = f64::from(from.gap[at]) + f64::from(from.displacement[at]);
            let bonding = from.bonds[at];
            let after = problem.law.profile(bonding, gap);
            (self.of[k], self.value[k]) = (after, after.value);
            let step = if bonding == Bonding::Bonded {
                f64::from(stride.length * (from.direction[at] - stride.mean))
            } else {
                0.0
            };
            if step == 0.0 {
                (self.change[k], self.linear[k]) = (0.0, 0.0);
            } else {
                let before = problem.law.profile(bonding, gap - step);
                (self.change[k], self.linear[k]) = (after.value - before.value, before.rate * step);
            }
        }
    }
}

/// Calls `with` for each row of a band with φ in the row before, in it and in the row after.
pub(super) fn sweep(
    problem: &Problem,
    from: Gaps<'_>,
    stride: Stride,
    band: std::ops::Range<usize>,
    mut with: impl FnMut(usize, [&Row; 3]),
) {
    let grid = &problem.half_space;
    let mut rows = [Row::default(), Row::default(), Row::default()];
    for row in band.clone() {
        let [before, here, after] = beside(row, grid.rows(), grid.is_patch());
        if row == band.start {
            rows[0].evaluate(problem, from, before, stride);
            rows[1].evaluate(problem, from, here, stride);
        } else {
            rows.rotate_left(1);
        }
        rows[2].evaluate(problem, from, after, stride);
        let [before, here, after] = &rows;
        with(row, [before, here, after]);
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
        .map(|(band, (gradient, slopes))| {
            let first = band * BAND;
            let mut parts = Vec::with_capacity(BAND);
            sweep(problem, from, stride, first..first + gradient.len() / columns, |row, rows| {
                let here = (row - first) * columns..(row - first + 1) * columns;
                let (gradient, slopes) = (&mut gradient[here.clone()], &mut slopes[here]);
                let beyond = bend_row(rows, gradient, slopes, factor, is_patch);
                let direction = &from.direction[row * columns..(row + 1) * columns];
                let [sum, square, slope] = panel_sums([&*gradient, direction], |[g, d]| [g, g * g, g * d]);
                let largest = panel_largest(gradient);
                parts.push(Found { gradient: [sum, square], slope, largest, beyond, ..Found::default() });
            });
            parts
        })
        .collect();
    let mut all = Found::default();
    parts.iter().flatten().for_each(|part| all.add(part));
    all
}

/// As [`add_line`], in a row. The change of the energy in the last step beyond first order.
fn bend_row(rows: [&Row; 3], gradient: &mut [f32], slopes: &mut [f32], factor: f64, is_patch: bool) -> f64 {
    let columns = gradient.len();
    let here = rows[1];
    let mut beyond = 0.0;
    for k in 0..columns {
        let of = &here.of[k];
        if of.rate == 0.0 && here.change[k] == 0.0 && here.linear[k] == 0.0 {
            continue;
        }
        let at = beside(k, columns, is_patch);
        let bend = laplacian(rows.map(|row| row.value.as_slice()), at);
        let bend_change = laplacian(rows.map(|row| row.change.as_slice()), at);
        gradient[k] += (factor * of.rate * bend) as f32;
        slopes[k] += (of.excess + factor * of.rate * of.rate) as f32;
        let change = here.change[k];
        beyond += factor * (0.5 * change * bend_change + (bend - bend_change) * (change - here.linear[k]));
    }
    beyond
}
