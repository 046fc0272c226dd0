//! Approximate inverse of the Jacobian, by groups of contacts.
//!
//! Restricted additive Schwarz method (Cai & Sarkis, SIAM J. Sci. Comput. 21:792, 1999): contacts are divided into small groups. Each is
//! solved with the contacts around it, and the solution for the group itself is kept. The response of a contact is determined by its
//! neighbours, which lose what it gains.

use crate::physics::contact::problem::Problem;
use crate::physics::contact::state::{State, Status};
use crate::physics::half_space::Tangent;
use crate::physics::math::dense::Lu;
use crate::physics::math::gmres::Preconditioner;

/// Maximum number of contacts in a group, and number of contacts that are solved together for it.
const GROUP: usize = 24;
const TOGETHER: usize = 44;

/// Distance over radius beyond which a contact acts by its load alone.
const ALOOF: f64 = 2.0;

/// Solutions that one approximate inverse serves.
const MOST_SOLUTIONS: usize = 4;

/// An approximate inverse that serves several solutions: it only makes them short.
#[derive(Debug, Default)]
pub(super) struct CachedInverse {
    inverse: Option<LocalInverse>,
    /// Solutions that have begun since it was computed.
    solutions: usize,
}

impl CachedInverse {
    /// Begins a solution.
    pub(super) fn begin(&mut self) {
        self.solutions += 1;
    }

    /// An approximate inverse of a tangent and a diagonal; none for a dense one, whose products cost little.
    pub(super) fn of(&mut self, problem: &Problem, state: &State, tangent: &Tangent, diagonal: &[f64]) -> Option<&dyn Preconditioner> {
        if tangent.is_exact() {
            self.inverse = None;
            return None;
        }
        let serves = |known: &LocalInverse| self.solutions < MOST_SOLUTIONS && known.index == state.contacts;
        let inverse = self.inverse.take().filter(serves).unwrap_or_else(|| {
            self.solutions = 0;
            LocalInverse::new(problem, state, tangent, diagonal)
        });
        Some(self.inverse.insert(inverse))
    }
}

/// Rows of an approximate inverse.
#[derive(Debug, Default)]
pub(crate) struct LocalInverse {
    /// Asperities in contact.
    index: Vec<usize>,
    starts: Vec<usize>,
    spots: Vec<u32>,
    values: Vec<f32>,
}

impl LocalInverse {
    /// Approximate inverse of a tangent and a diagonal, at the contacts of a state.
    pub(crate) fn new(problem: &Problem, state: &State, tangent: &Tangent, diagonal: &[f64]) -> Self {
        let mut groups = Vec::new();
        let mut all: Vec<usize> = (0..state.contacts.len()).collect();
        part(&mut all, &|k, along| problem.place(state.contacts[k])[along], &mut groups);
        let mut rows: Vec<(usize, Vec<f32>)> = Vec::with_capacity(all.len());
        let mut members: Vec<Vec<u32>> = Vec::with_capacity(groups.len());
        let (mut lu, mut unit) = (Lu::default(), Vec::new());
        for group in &groups {
            let near = around(problem, state, &all[group.clone()]);
            let matrix = transposed(problem, state, &near, tangent, diagonal);
            lu.factor(&matrix, near.len());
            let columns = group.len();
            unit.clear();
            unit.resize(near.len() * columns, 0.0);
            for (column, k) in all[group.clone()].iter().enumerate() {
                if let Ok(at) = near.binary_search_by_key(k, |(j, _)| *j) {
                    unit[at * columns + column] = 1.0;
                }
            }
            lu.solve_all(&mut unit, columns);
            rows.extend((0..columns).map(|column| (members.len(), unit.iter().skip(column).step_by(columns).map(|v| *v as f32).collect())));
            members.push(near.iter().map(|(j, _)| *j as u32).collect());
        }
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_unstable_by_key(|at| all[*at]);
        let mut found = Self { index: state.contacts.clone(), starts: vec![0], ..Self::default() };
        for at in order {
            let (group, row) = &rows[at];
            found.spots.extend_from_slice(&members[*group]);
            found.values.extend_from_slice(row);
            found.starts.push(found.spots.len());
        }
        found
    }
}

impl Preconditioner for LocalInverse {
    fn apply(&self, x: &[f64], y: &mut [f64]) {
        for (ends, yi) in self.starts.windows(2).zip(y) {
            let mut strands = [0.0; 4];
            let ((spots, left), (values, over)) =
                (self.spots[ends[0]..ends[1]].as_chunks::<4>(), self.values[ends[0]..ends[1]].as_chunks::<4>());
            for (spot, value) in spots.iter().zip(values) {
                for k in 0..4 {
                    strands[k] += f64::from(value[k]) * x[spot[k] as usize];
                }
            }
            for (spot, value) in left.iter().zip(over) {
                strands[0] += f64::from(*value) * x[*spot as usize];
            }
            *yi = strands.iter().sum();
        }
    }
}

/// Divides contacts into groups by bisection across their longer side; groups are ranges of `all`, which is put in order.
fn part(all: &mut [usize], place: &dyn Fn(usize, usize) -> f64, groups: &mut Vec<std::ops::Range<usize>>) {
    fn halve(all: &mut [usize], from: usize, place: &dyn Fn(usize, usize) -> f64, groups: &mut Vec<std::ops::Range<usize>>) {
        if all.len() <= GROUP {
            groups.push(from..from + all.len());
            return;
        }
        let span = |along: usize| {
            let ends =
                all.iter().map(|k| place(*k, along)).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (p.min(low), p.max(high)));
            ends.1 - ends.0
        };
        let along = usize::from(span(1) > span(0));
        let middle = all.len() / 2;
        all.select_nth_unstable_by(middle, |u, v| place(*u, along).total_cmp(&place(*v, along)).then(u.cmp(v)));
        let (low, high) = all.split_at_mut(middle);
        halve(low, from, place, groups);
        halve(high, from + middle, place, groups);
    }
    halve(all, 0, place, groups);
}

/// A group of contacts and those around it, each with its position relative to the centre of the group \[m\].
fn around(problem: &Problem, state: &State, group: &[usize]) -> Vec<(usize, [f64; 2])> {
    let place = |k: usize| *problem.place(state.contacts[k]);
    let count = group.len() as f64;
    let centre = [0, 1].map(|along| group.iter().map(|k| place(*k)[along]).sum::<f64>() / count);
    let near = problem.neighbours.nearest(&centre, TOGETHER, state.contacts.len(), |i| state.status[i] == Status::Contact);
    let mut spots: Vec<usize> =
        near.iter().filter_map(|(_, i)| state.contacts.binary_search(i).ok()).chain(group.iter().copied()).collect();
    spots.sort_unstable();
    spots.dedup();
    spots.into_iter().map(|k| (k, problem.neighbours.apart(&place(k), &centre))).collect()
}

/// Jacobian among some contacts, column by column.
fn transposed(problem: &Problem, state: &State, spots: &[(usize, [f64; 2])], tangent: &Tangent, diagonal: &[f64]) -> Vec<f64> {
    let mut matrix = Vec::with_capacity(spots.len() * spots.len());
    for (j, [x, y]) in spots {
        let i = state.contacts[*j];
        let a = state.radius[i];
        let slope = problem.material.compliance() * problem.asperities[i].load_slope(a);
        // Image fields are nearly the same for all of them.
        let images = tangent.own(*j);
        for (k, [u, v]) in spots {
            let r = ((u - x) * (u - x) + (v - y) * (v - y)).sqrt();
            let by = if k == j {
                diagonal[*j]
            } else if r > ALOOF * a {
                slope / r
            } else {
                problem.spot_field(&problem.asperities[i], r, a).1
            };
            matrix.push(by + images);
        }
    }
    matrix
}
