//! Second derivatives of the energy of the line, for Newton's method and the rate of an equilibrium.

use super::line::{BAND, Gaps, Sweep};
use super::minimise::Minimiser;
use super::passes::Stride;
use crate::elements::line::{beside, laplacian};
use crate::elements::problem::{Problem, State};
use rayon::prelude::*;

impl Minimiser {
    /// Replaces the slopes by the second derivatives of the energy at single points, as far as these do not
    /// come from neighbours, and keeps the rates of φ, for [`Self::add_line_response`].
    pub(super) fn linearise_line(&mut self, problem: &Problem, state: &State) {
        if !problem.law.has_line() {
            return;
        }
        let (columns, factor) = (problem.half_space.columns(), problem.law.line_factor());
        let is_patch = problem.half_space.is_patch();
        let Self { increment, direction, slopes, rates, .. } = self;
        let from = Gaps {
            gap: &increment.gap,
            displacement: &increment.displacement,
            direction,
            bonds: &state.bonds,
        };
        let stride = Stride { length: 0.0, mean: 0.0, centre: 0.0 };
        let bands = slopes.par_chunks_mut(BAND * columns).zip(rates.par_chunks_mut(BAND * columns));
        bands.enumerate().for_each_init(Sweep::default, |sweep, (band, (slopes, rates))| {
            let first = band * BAND;
            sweep.band(problem, from, stride, first..first + slopes.len() / columns, |row, rows| {
                let here = (row - first) * columns;
                rates[here..here + columns].fill(0.0);
                for (k, of) in rows[1].places.iter().map(|k| *k as usize).zip(&rows[1].profiles) {
                    rates[here + k] = of.rate as f32;
                    let bend = laplacian(rows.map(|row| row.value.as_slice()), beside(k, columns, is_patch));
                    slopes[here + k] += (factor * (of.bend * bend - of.rate * of.rate) - of.excess) as f32;
                }
            });
        });
    }

    /// Adds `2λΔγ φ' L(φ' field)` to the response to a field: the second derivatives between neighbours.
    pub(super) fn add_line_response(&self, problem: &Problem, field: &[f32], response: &mut [f32]) {
        if !problem.law.has_line() {
            return;
        }
        let grid = &problem.half_space;
        let (columns, factor, rates) = (grid.columns(), problem.law.line_factor() as f32, &self.rates);
        response.par_chunks_mut(columns).enumerate().with_min_len(BAND).for_each(|(row, response)| {
            let rows = beside(row, grid.rows(), grid.is_patch());
            for (k, response) in response.iter_mut().enumerate() {
                let rate = rates[row * columns + k];
                if rate == 0.0 {
                    continue;
                }
                let places = beside(k, columns, grid.is_patch());
                let values = rows.map(|row| {
                    places.map(|k| f64::from(rates[row * columns + k]) * f64::from(field[row * columns + k]))
                });
                let [up, here, down] = &values;
                *response += factor * rate * laplacian([up, here, down], [0, 1, 2]) as f32;
            }
        });
    }
}
