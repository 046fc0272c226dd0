//! Pairs of steps and gradient changes of L-BFGS, with their products, so that each of its two loops is two passes over the fields.

use super::sums::{PANEL, grain, remove_mean, sums_of};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;

/// Pairs that are kept.
const PAIRS: usize = 3;

/// The pairs `(s, y)`, the newest last.
pub(super) struct Pairs {
    steps: [Vec<f64>; PAIRS],
    changes: [Vec<f64>; PAIRS],
    /// `products[i][j] = s_i·y_j`.
    products: [[f64; PAIRS]; PAIRS],
    /// Places of the pairs, from the oldest to the newest.
    order: Vec<usize>,
    weights: [f64; PAIRS],
}

impl Pairs {
    pub(super) fn new(points: usize) -> Result<Self, PhysicsError> {
        let field = || filled(points, 0.0);
        Ok(Self {
            steps: [field()?, field()?, field()?],
            changes: [field()?, field()?, field()?],
            products: [[0.0; PAIRS]; PAIRS],
            order: Vec::with_capacity(PAIRS),
            weights: [0.0; PAIRS],
        })
    }

    pub(super) fn clear(&mut self) {
        self.order.clear();
    }

    /// Keeps a step and the change of the gradient that it brought, unless the curvature along it is not positive.
    pub(super) fn remember(&mut self, step: &[f64], gradient: &[f64], before: &[f64]) {
        let [curvature, square] = sums_of([step, gradient, before, before], |[s, g, b, _]| [s * (g - b), s * s]);
        if curvature <= 1e-12 * square {
            return;
        }
        let place =
            if self.order.len() < PAIRS { (0..PAIRS).find(|place| !self.order.contains(place)).unwrap_or(0) } else { self.order.remove(0) };
        self.order.push(place);
        self.steps[place].copy_from_slice(step);
        let fields = self.changes[place].par_chunks_mut(PANEL).zip(gradient.par_chunks(PANEL)).zip(before.par_chunks(PANEL));
        fields.with_min_len(grain(PANEL)).for_each(|((to, new), old)| {
            to.iter_mut().zip(new.iter().zip(old)).for_each(|(y, (g, b))| *y = g - b);
        });
        // Products of the new step with all changes, and of all steps with the new change.
        let row = Self::dots(&self.steps[place], &self.changes);
        let column = Self::dots(&self.changes[place], &self.steps);
        for k in 0..PAIRS {
            self.products[place][k] = row[k];
            self.products[k][place] = column[k];
        }
    }

    fn dots(one: &[f64], all: &[Vec<f64>; PAIRS]) -> [f64; PAIRS] {
        sums_of([one, &all[0], &all[1], &all[2]], |[x, a, b, c]| [x * a, x * b, x * c])
    }

    /// `direction ← gradient − Σ α_i y_i`, the first loop.
    pub(super) fn first(&mut self, gradient: &[f64], direction: &mut [f64]) {
        direction.copy_from_slice(gradient);
        if self.order.is_empty() {
            return;
        }
        let onto = Self::dots(gradient, &self.steps);
        self.weights = [0.0; PAIRS];
        for (k, i) in self.order.iter().enumerate().rev() {
            let newer: f64 = self.order[k + 1..].iter().map(|j| self.weights[*j] * self.products[*i][*j]).sum();
            self.weights[*i] = (onto[*i] - newer) / self.products[*i][*i];
        }
        combine(direction, self.weights.map(|weight| -weight), &self.changes);
    }

    /// `direction ← −(direction + Σ (α_i − β_i) s_i)` without its mean, the second loop.
    pub(super) fn second(&mut self, direction: &mut [f64]) {
        let mut added = [0.0; PAIRS];
        if !self.order.is_empty() {
            let onto = Self::dots(direction, &self.changes);
            for (k, i) in self.order.iter().enumerate() {
                let older: f64 = self.order[..k].iter().map(|j| added[*j] * self.products[*j][*i]).sum();
                added[*i] = self.weights[*i] - (onto[*i] + older) / self.products[*i][*i];
            }
            combine(direction, added, &self.steps);
        }
        direction.par_chunks_mut(PANEL).with_min_len(grain(PANEL)).for_each(|part| part.iter_mut().for_each(|x| *x = -*x));
        remove_mean(direction);
    }
}

/// `to ← to + Σ factors_i fields_i`; fields without a factor may hold anything finite.
fn combine(to: &mut [f64], factors: [f64; PAIRS], fields: &[Vec<f64>; PAIRS]) {
    let [a, b, c] = fields;
    let all = to.par_chunks_mut(PANEL).zip(a.par_chunks(PANEL)).zip(b.par_chunks(PANEL)).zip(c.par_chunks(PANEL));
    all.with_min_len(grain(PANEL)).for_each(|(((to, a), b), c)| {
        for (((x, a), b), c) in to.iter_mut().zip(a).zip(b).zip(c) {
            *x += factors[0] * a + factors[1] * b + factors[2] * c;
        }
    });
}
