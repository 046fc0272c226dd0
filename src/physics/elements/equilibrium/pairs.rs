//! Pairs of steps and gradient changes of L-BFGS. Their products are kept, so that a direction takes one pass
//! over the fields for a new pair and one for each of the two loops.

use super::passes::{PAIRS, new_pair, products};
use crate::PhysicsError;
use crate::elements::grid::sums::{PANEL, total};
use crate::memory::filled;
use rayon::prelude::*;

/// A step `s`, per its length, and the change of the gradient `y` that it brought, per the same length.
struct Pair {
    step: Vec<f32>,
    change: Vec<f32>,
    /// Mean of the step.
    mean: f64,
}

/// Gradient of the energy in E*: `values − mean`.
pub(crate) struct Gradient {
    pub(crate) values: Vec<f32>,
    pub(crate) mean: f64,
}

/// The pairs `(s, y)`.
pub(crate) struct Pairs {
    pairs: [Pair; PAIRS],
    /// `products[i][j] = s_i·y_j`.
    products: [[f64; PAIRS]; PAIRS],
    /// `g·s_i` of the gradient of the last call of [`Self::push_pair`] or [`Self::project_gradient`].
    onto: [f64; PAIRS],
    /// Places of the pairs, from the oldest to the newest.
    order: Vec<usize>,
}

impl Pairs {
    pub(crate) fn new(points: usize) -> Result<Self, PhysicsError> {
        let pair = || {
            Ok::<_, PhysicsError>(Pair {
                step: filled(points, 0.0)?,
                change: filled(points, 0.0)?,
                mean: 0.0,
            })
        };
        Ok(Self {
            pairs: [pair()?, pair()?],
            products: [[0.0; PAIRS]; PAIRS],
            onto: [0.0; PAIRS],
            order: Vec::with_capacity(PAIRS),
        })
    }

    pub(crate) fn clear(&mut self) {
        self.order.clear();
    }

    /// Moves a field out as a scratch buffer, until [`Self::return_scratch`]. Removes the pairs.
    pub(crate) fn take_scratch(&mut self) -> Vec<f32> {
        self.clear();
        std::mem::take(&mut self.pairs[0].step)
    }

    pub(crate) fn return_scratch(&mut self, field: Vec<f32>) {
        self.pairs[0].step = field;
    }

    /// Keeps `direction`, a step of length `length` along which the gradient changed from
    /// `before`, in place of the oldest pair, unless the curvature along it is not positive. What `direction`
    /// holds then has no meaning.
    pub(crate) fn push_pair(
        &mut self,
        direction: &mut Vec<f32>,
        mean: f64,
        length: f64,
        gradient: &Gradient,
        before: &Gradient,
    ) {
        let place = if self.order.len() < PAIRS {
            (0..PAIRS).find(|place| !self.order.contains(place)).unwrap_or(0)
        } else {
            self.order.remove(0)
        };
        std::mem::swap(&mut self.pairs[place].step, direction);
        self.pairs[place].mean = mean;
        let other = 1 - place;
        let mut change = std::mem::take(&mut self.pairs[place].change);
        let (shift, unit) = ((gradient.mean - before.mean) as f32, (1.0 / length) as f32);
        let [new, old] = [place, other].map(|k| &self.pairs[k]);
        let fields = (
            change.par_chunks_mut(PANEL),
            gradient.values.par_chunks(PANEL),
            before.values.par_chunks(PANEL),
            new.step.par_chunks(PANEL),
            old.step.par_chunks(PANEL),
            old.change.par_chunks(PANEL),
        );
        let sums: [f64; 6] = total(
            fields
                .into_par_iter()
                .map(|(y, g, old, s, sa, ya)| new_pair(y, [g, old, s, sa, ya], shift, unit)),
        );
        self.pairs[place].change = change;
        let [own, square, with_other, of_other, onto, onto_other] = sums;
        self.products[place][place] = own;
        (self.products[place][other], self.products[other][place]) = (with_other, of_other);
        (self.onto[place], self.onto[other]) = (onto, onto_other);
        self.centre(gradient);
        if own > 1e-12 * square {
            self.order.push(place);
        }
    }

    /// Products of the steps with a gradient that no step has led to.
    pub(crate) fn project_gradient(&mut self, gradient: &Gradient) {
        let [a, b] = self.steps().map(|step| step.par_chunks(PANEL));
        self.onto = total(
            (gradient.values.par_chunks(PANEL), a, b).into_par_iter().map(|(g, a, b)| products(g, [a, b])),
        );
        self.centre(gradient);
    }

    /// Products with the gradient less its mean.
    fn centre(&mut self, gradient: &Gradient) {
        let sum = gradient.mean * gradient.values.len() as f64;
        for (onto, pair) in self.onto.iter_mut().zip(&self.pairs) {
            *onto -= sum * pair.mean;
        }
    }

    /// Weights of the first loop, from the newest pair to the oldest: the direction before the preconditioner
    /// is `gradient − Σ w_i y_i`.
    pub(crate) fn first(&self) -> [f64; PAIRS] {
        let mut weights = [0.0; PAIRS];
        for (k, i) in self.order.iter().enumerate().rev() {
            let newer: f64 = self.order[k + 1..].iter().map(|j| weights[*j] * self.products[*i][*j]).sum();
            weights[*i] = (self.onto[*i] - newer) / self.products[*i][*i];
        }
        weights
    }

    /// Weights of the second loop: after the preconditioner `Σ w_i s_i` is added. `onto` are the products of
    /// the direction with the changes.
    pub(crate) fn second(&self, first: [f64; PAIRS], onto: [f64; PAIRS]) -> [f64; PAIRS] {
        let mut added = [0.0; PAIRS];
        for (k, i) in self.order.iter().enumerate() {
            let older: f64 = self.order[..k].iter().map(|j| added[*j] * self.products[*j][*i]).sum();
            added[*i] = first[*i] - (onto[*i] + older) / self.products[*i][*i];
        }
        added
    }

    /// The changes, in the order of the weights.
    pub(crate) fn changes(&self) -> [&[f32]; PAIRS] {
        [0, 1].map(|k| self.pairs[k].change.as_slice())
    }

    /// The steps, in the order of the weights.
    pub(crate) fn steps(&self) -> [&[f32]; PAIRS] {
        [0, 1].map(|k| self.pairs[k].step.as_slice())
    }
}
