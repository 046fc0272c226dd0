//! Near field: pairs within a cutoff, found by cells.
//!
//! It contains the exact field less the smooth field on the mesh.

use super::plan::Plan;
use crate::asperities::field::ewald::{IMAGES, ORDERS};
use crate::asperities::field::spot_field::SpotColumns;
use crate::model::{Boundary, Interaction as Kind};
use multiversion::multiversion;
use std::sync::Arc;

/// Complement of the exact fields of a group of sources.
#[derive(Debug, Clone)]
pub(super) enum Rest {
    /// Exact fields act within the cutoff of a plan; its mesh supplies the rest.
    Mesh(Arc<Plan>),
    /// Exact fields act everywhere, with image sums if periodic: for spots too large for any cutoff.
    Images,
}

/// Sources of one group, sorted by cells of the square.
#[derive(Debug)]
pub(super) struct Group {
    rest: Rest,
    /// Cells on a side, and number of cells that the cutoff spans.
    cells: usize,
    span: usize,
    /// First source of each cell, and the total number of sources.
    starts: Vec<usize>,
    /// Spot numbers by cell, and their positions.
    pub(super) spots: Vec<usize>,
    x: Vec<f64>,
    y: Vec<f64>,
}

/// Parameters of the field.
///
/// Interaction, boundary, `sqrt(2πΔγ/E*)` \[m^½\], factor of `r²/R` inside a spot, and side \[m\].
///
/// For an isolated square the side is that of the surrounding empty square.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measure {
    pub(super) kind: Kind,
    pub(super) boundary: Boundary,
    pub(super) pull: f64,
    pub(super) sag: f64,
    pub(super) length: f64,
}

impl Measure {
    /// Sums over all images but the nearest, at a distance in units of the side.
    pub(super) fn images(self, dx: f64, dy: f64) -> [f64; ORDERS] {
        match self.boundary {
            Boundary::Periodic => IMAGES.sums(dx, dy),
            Boundary::Isolated => [0.0; ORDERS],
        }
    }
}

/// Sources near a target, and the squares of their distances \[m²\].
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) numbers: Vec<usize>,
    pub(super) r2: Vec<f64>,
}

impl Group {
    /// The group of the spots `members`.
    pub(super) fn new(rest: Rest, members: &[usize], columns: &SpotColumns, length: f64) -> Self {
        let reach = match &rest {
            Rest::Mesh(plan) => plan.reach,
            Rest::Images => 1.0,
        };
        // Three cells per cutoff, but no more cells than sources.
        let cells = ((3.0 / reach) as usize).min((members.len() as f64).sqrt().ceil() as usize).max(1);
        let cell =
            |j: usize| cell_of(columns.x[j], length, cells) * cells + cell_of(columns.y[j], length, cells);
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
        Self {
            rest,
            cells,
            span: (reach * cells as f64).ceil() as usize,
            starts,
            x: spots.iter().map(|j| columns.x[*j]).collect(),
            y: spots.iter().map(|j| columns.y[*j]).collect(),
            spots,
        }
    }

    /// Finds the sources near the point `[x, y]` \[m\].
    pub(super) fn find(&self, measure: Measure, place: [f64; 2], found: &mut Found) {
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
    }

    /// Factors of the moments at a distance from a source.
    ///
    /// They are minus the mesh field, or the sums over the other images.
    #[inline(always)]
    pub(super) fn rest_at(
        &self,
        measure: Measure,
        place: [f64; 2],
        number: usize,
        square: f64,
    ) -> [f64; ORDERS] {
        match &self.rest {
            Rest::Mesh(plan) => {
                plan.smooth.at(square / (plan.reach * measure.length).powi(2)).map(|sum| -sum)
            }
            Rest::Images => {
                let [dx, dy] = [place[0] - self.x[number], place[1] - self.y[number]].map(|d| {
                    let share = d / measure.length;
                    share - share.round_ties_even()
                });
                measure.images(dx, dy)
            }
        }
    }
}

/// The cell of a coordinate \[m\] on the periodic side.
fn cell_of(coordinate: f64, length: f64, cells: usize) -> usize {
    let share = coordinate / length;
    (((share - share.floor()) * cells as f64) as usize).min(cells - 1)
}

#[allow(clippy::too_many_arguments)]
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn search(
    x: &[f64],
    y: &[f64],
    from: usize,
    length: f64,
    place: [f64; 2],
    reach2: f64,
    found: &mut Vec<usize>,
    squares: &mut Vec<f64>,
) {
    let start = found.len();
    // Write every candidate and advance the count only for near ones: no unpredictable branch.
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
