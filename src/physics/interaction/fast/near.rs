//! The near field: pairs within a reach, found by cells, exact, less what the mesh has of them.

use super::super::ewald::{IMAGES, ORDERS, RemainderSeries};
use super::super::moments::{Moments, product};
use super::super::pair::{LANES, SpotColumns, field};
use super::plan::Plan;
use crate::model::Interaction as Kind;
use multiversion::multiversion;
use std::sync::Arc;

/// What the exact fields of a group of sources are relative to.
#[derive(Debug, Clone)]
pub(super) enum Rest {
    /// Within the reach of a plan; its mesh does the rest.
    Mesh(Arc<Plan>),
    /// Everywhere, with the sums over images: for spots too large for any reach.
    Images,
}

/// Sources of one group, by cells of the square.
#[derive(Debug)]
pub(super) struct Group {
    rest: Rest,
    /// Cells on a side, and how many cells the reach spans.
    cells: usize,
    span: usize,
    /// First source of each cell, and one past the last of all.
    starts: Vec<usize>,
    /// Spot numbers by cells, and their columns.
    spots: Vec<usize>,
    x: Vec<f64>,
    y: Vec<f64>,
    sources: Vec<Near>,
}

/// One source.
#[derive(Debug, Clone, Copy)]
struct Near {
    a: f64,
    root_a: f64,
    inverse_root_a: f64,
    inverse_radius: f64,
    value: [f64; ORDERS],
    slope: [f64; ORDERS],
}

/// How fields are measured: the kind, `sqrt(2πΔγ/E*)` \[m^½\], the factor of `r²/R` inside a spot and the side \[m\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Measure {
    pub(super) kind: Kind,
    pub(super) pull: f64,
    pub(super) sag: f64,
    pub(super) length: f64,
}

/// Fields of near sources at targets: of each target the displacement, and where its entries begin; of each entry the spot and the derivative to its
/// radius, if they are wanted.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) sums: Vec<f64>,
    pub(super) starts: Vec<usize>,
    pub(super) spots: Vec<u32>,
    pub(super) slopes: Vec<f64>,
    pub(super) pairs: u64,
}

/// Sources that were found near a target, and the squares of their distances \[m²\].
#[derive(Debug, Default)]
pub(super) struct Found {
    numbers: Vec<usize>,
    r2: Vec<f64>,
}

impl Group {
    /// The group of the spots `members`.
    pub(super) fn new(rest: Rest, members: &[usize], columns: &SpotColumns, moments: &Moments, length: f64) -> Self {
        let reach = match &rest {
            Rest::Mesh(plan) => plan.reach,
            Rest::Images => 1.0,
        };
        // Three cells to the reach; no more cells than sources.
        let cells = ((3.0 / reach) as usize).min((members.len() as f64).sqrt().ceil() as usize).max(1);
        let cell = |j: usize| cell_of(columns.x[j], length, cells) * cells + cell_of(columns.y[j], length, cells);
        let mut starts = vec![0; cells * cells + 1];
        for &j in members {
            starts[cell(j) + 1] += 1;
        }
        for k in 0..cells * cells {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut spots = vec![0; members.len()];
        for &j in members {
            let place = &mut next[cell(j)];
            spots[*place] = j;
            *place += 1;
        }
        let near = |&j: &usize| Near {
            a: columns.a[j],
            root_a: columns.root_a[j],
            inverse_root_a: columns.inverse_root_a[j],
            inverse_radius: columns.inverse_radius[j],
            value: moments.value[j],
            slope: moments.slope[j],
        };
        Self {
            rest,
            cells,
            span: (reach * cells as f64).ceil() as usize,
            starts,
            x: spots.iter().map(|j| columns.x[*j]).collect(),
            y: spots.iter().map(|j| columns.y[*j]).collect(),
            sources: spots.iter().map(near).collect(),
            spots,
        }
    }

    /// The displacement at the place `[x, y]` \[m\]; the entries are added to `rows` where `SLOPES`.
    pub(super) fn add<const SLOPES: bool>(&self, measure: Measure, place: [f64; 2], found: &mut Found, rows: &mut Rows) -> f64 {
        found.numbers.clear();
        found.r2.clear();
        let reach2 = match &self.rest {
            Rest::Mesh(plan) => (plan.reach * measure.length).powi(2),
            Rest::Images => f64::INFINITY,
        };
        let mut look = |range: std::ops::Range<usize>| {
            let (x, y) = (&self.x[range.clone()], &self.y[range.clone()]);
            search(x, y, range.start, measure.length, place, reach2, &mut found.numbers, &mut found.r2);
        };
        if 2 * self.span + 1 >= self.cells {
            look(0..self.spots.len());
        } else {
            let [cx, cy] = place.map(|p| cell_of(p, measure.length, self.cells));
            for i in 0..=2 * self.span {
                let line = (cx + self.cells + i - self.span) % self.cells * self.cells;
                let (from, to) = (cy as isize - self.span as isize, cy + self.span + 1);
                let range = |a: usize, b: usize| self.starts[line + a]..self.starts[line + b];
                if from < 0 {
                    look(range((from + self.cells as isize) as usize, self.cells));
                }
                look(range(from.max(0) as usize, to.min(self.cells)));
                if to > self.cells {
                    look(range(0, to - self.cells));
                }
            }
        }
        rows.pairs += found.numbers.len() as u64;
        if SLOPES {
            rows.spots.extend(found.numbers.iter().map(|number| self.spots[*number] as u32));
        }
        fields::<SLOPES>(self, measure, place, found, &mut rows.slopes)
    }
}

/// The cell of a coordinate \[m\] on the periodic side.
fn cell_of(coordinate: f64, length: f64, cells: usize) -> usize {
    let share = coordinate / length;
    (((share - share.floor()) * cells as f64) as usize).min(cells - 1)
}

#[allow(clippy::too_many_arguments)]
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn search(x: &[f64], y: &[f64], from: usize, length: f64, place: [f64; 2], reach2: f64, found: &mut Vec<usize>, squares: &mut Vec<f64>) {
    let start = found.len();
    // All are written and the count goes on where one is near: no branch to be guessed.
    found.resize(start + x.len(), 0);
    squares.resize(start + x.len(), 0.0);
    let (places, distances) = (&mut found[start..], &mut squares[start..]);
    let inverse_length = 1.0 / length;
    let mut count = 0;
    for (k, (xj, yj)) in x.iter().zip(y).enumerate() {
        let dx = place[0] - xj;
        let dy = place[1] - yj;
        let dx = dx - length * (dx * inverse_length).round_ties_even();
        let dy = dy - length * (dy * inverse_length).round_ties_even();
        let r2 = dx.mul_add(dx, dy * dy);
        places[count] = from + k;
        distances[count] = r2;
        count += usize::from(r2 < reach2);
    }
    found.truncate(start + count);
    squares.truncate(start + count);
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn fields<const SLOPES: bool>(group: &Group, measure: Measure, place: [f64; 2], found: &Found, slopes: &mut Vec<f64>) -> f64 {
    let images: &RemainderSeries = &IMAGES;
    let length = measure.length;
    let mut all = [0.0; LANES];
    for (found, squares) in found.numbers.chunks(LANES).zip(found.r2.chunks(LANES)) {
        let (mut values, mut rates) = ([0.0; LANES], [0.0; LANES]);
        if measure.kind == Kind::Spots {
            let mut r2 = [1.0; LANES];
            let [mut a, mut root_a, mut inverse_root_a, mut inverse_radius] = [[1.0; LANES]; 4];
            for (k, (&number, &square)) in found.iter().zip(squares).enumerate() {
                let source = &group.sources[number];
                (r2[k], a[k], root_a[k]) = (square, source.a, source.root_a);
                (inverse_root_a[k], inverse_radius[k]) = (source.inverse_root_a, source.inverse_radius);
            }
            (values, rates) = field(&r2, &a, &root_a, &inverse_root_a, &inverse_radius, measure.pull, measure.sag);
        } else {
            for (k, (&number, &square)) in found.iter().zip(squares).enumerate() {
                let unit = length / square.sqrt();
                (values[k], rates[k]) = (group.sources[number].value[0] * unit, group.sources[number].slope[0] * unit);
            }
        }
        // What the mesh has of these fields, or what all other images are.
        let mut others = [[0.0; ORDERS]; LANES];
        match &group.rest {
            Rest::Mesh(plan) => {
                let share = 1.0 / (plan.reach * plan.reach * length * length);
                for (other, square) in others.iter_mut().zip(squares) {
                    *other = plan.smooth.at(share * square).map(|sum| -sum);
                }
            }
            Rest::Images => {
                let (mut dx, mut dy) = ([0.0; LANES], [0.0; LANES]);
                for (k, &number) in found.iter().enumerate() {
                    dx[k] = (place[0] - group.x[number]) / length;
                    dy[k] = (place[1] - group.y[number]) / length;
                    dx[k] -= dx[k].round_ties_even();
                    dy[k] -= dy[k].round_ties_even();
                }
                others = images.local(&dx, &dy);
            }
        }
        for (k, (&number, &square)) in found.iter().zip(squares).enumerate() {
            let source = &group.sources[number];
            // A spot does not act on its own centre.
            let apart = square > 0.0;
            all[k] += product(&others[k], &source.value) + if apart { values[k] } else { 0.0 };
            if SLOPES {
                rates[k] = product(&others[k], &source.slope) + if apart { rates[k] } else { 0.0 };
            }
        }
        if SLOPES {
            slopes.extend_from_slice(&rates[..found.len()]);
        }
    }
    all.iter().sum()
}
