//! Neighbour search by a grid of cells.

use crate::math::grown::Grown;
use crate::math::vector::nearest_image;
use crate::model::Boundary;
use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;

/// Order of distances with their asperities.
pub(crate) fn nearer(u: &(f64, usize), v: &(f64, usize)) -> Ordering {
    u.0.total_cmp(&v.0).then(u.1.cmp(&v.1))
}

/// Asperities on the square, sorted by cells of two mean spacings.
#[derive(Clone)]
pub(crate) struct Neighbours {
    positions: Grown<[f64; 2]>,
    length: f64,
    boundary: Boundary,
    /// Number of cells on a side, and the side of a cell \[m\].
    cells: usize,
    side: f64,
    surface: Arc<Table>,
    /// Merged contacts by cell; empty without any.
    added: Arc<Vec<Vec<u32>>>,
}

/// Asperities of the surface.
#[derive(Default)]
struct Table {
    /// Asperities by cell, and the first entry of each cell.
    members: Vec<u32>,
    starts: Vec<usize>,
    /// For each asperity, the others within one cell side, nearest first.
    near: Vec<Vec<(f64, usize)>>,
}

impl Neighbours {
    pub(crate) fn new(positions: Vec<[f64; 2]>, length: f64, boundary: Boundary) -> Self {
        let reach = (2.0 * length / (positions.len() as f64).sqrt()).min(0.5 * length);
        let cells = ((length / reach) as usize).max(1);
        let mut found = Self {
            positions: positions.into(),
            length,
            boundary,
            cells,
            side: length / cells as f64,
            surface: Arc::default(),
            added: Arc::default(),
        };
        let positions = found.positions.base();
        let cell = |p: &[f64; 2]| found.cell(p);
        let mut members: Vec<u32> = (0..positions.len() as u32).collect();
        members.sort_by_key(|i| (cell(&positions[*i as usize]), *i));
        let mut starts = vec![0; cells * cells + 1];
        for p in positions {
            starts[cell(p) + 1] += 1;
        }
        for k in 0..cells * cells {
            starts[k + 1] += starts[k];
        }
        found.surface =
            Arc::new(Table { members: members.clone(), starts: starts.clone(), near: Vec::new() });
        // Most searches at each step are within this radius.
        let near = (0..found.positions.len()).map(|i| found.others(i, found.side)).collect();
        found.surface = Arc::new(Table { members, starts, near });
        found
    }

    /// Adds a merged contact at `place` \[m\]; it gets the next number.
    pub(crate) fn add(&mut self, place: [f64; 2]) {
        let number = self.positions.len() as u32;
        let cell = self.cell(&place);
        let added = Arc::make_mut(&mut self.added);
        added.resize(self.cells * self.cells, Vec::new());
        added[cell].push(number);
        self.positions.push(place);
    }

    /// Takes a merged contact that is gone for good out of all searches.
    pub(crate) fn remove(&mut self, number: usize) {
        let cell = self.cell(&self.positions[number]);
        Arc::make_mut(&mut self.added)[cell].retain(|added| *added as usize != number);
    }

    /// Position of an asperity \[m\].
    pub(crate) fn place(&self, i: usize) -> &[f64; 2] {
        &self.positions[i]
    }

    /// Cell of a place.
    fn cell(&self, place: &[f64; 2]) -> usize {
        let [x, y] = place.map(|coordinate| ((coordinate / self.side) as usize).min(self.cells - 1));
        x * self.cells + y
    }

    pub(crate) fn distance(&self, p: &[f64; 2], q: &[f64; 2]) -> f64 {
        let [dx, dy] = self.apart(p, q);
        (dx * dx + dy * dy).sqrt()
    }

    /// Vector from `q` to the nearest image of `p` \[m\].
    pub(crate) fn apart(&self, p: &[f64; 2], q: &[f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            let d = p[k] - q[k];
            if self.boundary == Boundary::Periodic { nearest_image(d, self.length) } else { d }
        })
    }

    /// Rows or columns of cells that a circle may intersect.
    fn lines(&self, coordinate: f64, radius: f64) -> Vec<usize> {
        let (low, high) =
            (((coordinate - radius) / self.side).floor(), ((coordinate + radius) / self.side).floor());
        let cells = self.cells as f64;
        if high - low + 1.0 >= cells {
            return (0..self.cells).collect();
        }
        let all = (0..=(high - low) as usize).map(|k| low + k as f64);
        if self.boundary == Boundary::Periodic {
            all.map(|line| line.rem_euclid(cells) as usize).collect()
        } else {
            all.filter(|line| (0.0..cells).contains(line)).map(|line| line as usize).collect()
        }
    }

    /// Calls `visit(distance, asperity)` for every asperity within `radius` of `place` that is `wanted`, in
    /// no order.
    pub(crate) fn around(
        &self,
        place: &[f64; 2],
        radius: f64,
        wanted: impl Fn(usize) -> bool,
        mut visit: impl FnMut(f64, usize),
    ) {
        let Table { members, starts, .. } = &*self.surface;
        self.visit_cells(place, radius, |cell| {
            let added = self.added.get(cell).into_iter().flatten();
            for &i in
                members[starts[cell]..starts[cell + 1]].iter().chain(added).filter(|i| wanted(**i as usize))
            {
                let r = self.distance(place, &self.positions[i as usize]);
                if r <= radius {
                    visit(r, i as usize);
                }
            }
        });
    }

    /// Calls `visit` for every cell that a circle may intersect.
    fn visit_cells(&self, place: &[f64; 2], radius: f64, mut visit: impl FnMut(usize)) {
        let columns = self.lines(place[1], radius);
        for x in self.lines(place[0], radius) {
            for &y in &columns {
                visit(x * self.cells + y);
            }
        }
    }

    /// Other asperities within `radius` of asperity `j`, nearest first.
    fn others(&self, j: usize, radius: f64) -> Vec<(f64, usize)> {
        let mut list = Vec::new();
        self.around(&self.positions[j], radius, |i| i != j, |r, i| list.push((r, i)));
        list.sort_unstable_by(nearer);
        list
    }

    /// Distance \[m\] up to which the asperities next to another are listed.
    pub(crate) fn listed_m(&self) -> f64 {
        self.side
    }

    /// Calls `visit(distance, asperity)` for every other asperity within `radius` of asperity `j`, in no
    /// order.
    pub(crate) fn within(&self, j: usize, radius: f64, mut visit: impl FnMut(f64, usize)) {
        let near = self.surface.near.get(j).filter(|_| radius <= self.side);
        let Some(near) = near else {
            self.around(&self.positions[j], radius, |i| i != j, visit);
            return;
        };
        for &(r, i) in near.iter().take_while(|(r, _)| *r <= radius) {
            visit(r, i);
        }
        if !self.added.is_empty() {
            let place = &self.positions[j];
            self.visit_cells(place, radius, |cell| {
                for &i in self.added.get(cell).into_iter().flatten() {
                    let r = self.distance(place, &self.positions[i as usize]);
                    if r <= radius {
                        visit(r, i as usize);
                    }
                }
            });
        }
    }

    /// The `count` nearest `wanted` asperities to `place`, or fewer, unordered.
    ///
    /// `all` is the number of `wanted` asperities.
    pub(crate) fn nearest(
        &self,
        place: &[f64; 2],
        count: usize,
        all: usize,
        wanted: impl Fn(usize) -> bool,
    ) -> Vec<(f64, usize)> {
        // Radius that contains 1.5 times as many if they are uniformly distributed.
        let mut radius = self.length * (1.5 * count as f64 / (PI * all.max(1) as f64)).sqrt();
        loop {
            let mut list = Vec::new();
            let whole = radius >= self.length;
            self.around(place, if whole { f64::INFINITY } else { radius }, &wanted, |r, i| list.push((r, i)));
            if list.len() >= count || whole {
                if list.len() > count {
                    list.select_nth_unstable_by(count, nearer);
                    list.truncate(count);
                }
                return list;
            }
            radius *= 1.3;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Neighbours, nearer};
    use crate::model::Boundary;

    /// Points of a fixed sequence in the unit square.
    fn places(count: usize) -> Vec<[f64; 2]> {
        (1..=count)
            .map(|i| [(i as f64 * 0.618_033_988_749_895).fract(), (i as f64 * 0.754_877_666_246_693).fract()])
            .collect()
    }

    #[test]
    fn law_the_nearest_are_those_of_a_search_through_all() {
        let all = places(200);
        for boundary in [Boundary::Periodic, Boundary::Isolated] {
            let neighbours = Neighbours::new(all.clone(), 1.0, boundary);
            for place in [[0.01, 0.99], [0.5, 0.5], [0.3, 0.02]] {
                let mut expected: Vec<(f64, usize)> =
                    all.iter().enumerate().map(|(i, p)| (neighbours.distance(p, &place), i)).collect();
                expected.sort_by(|u, v| u.0.total_cmp(&v.0));
                let mut found = neighbours.nearest(&place, 12, all.len(), |_| true);
                found.sort_unstable_by(nearer);
                assert_eq!(found, expected[..12], "{place:?}, {boundary:?}");
                let mut around = Vec::new();
                neighbours.around(&place, 0.2, |_| true, |r, i| around.push((r, i)));
                around.sort_by(|u, v| u.0.total_cmp(&v.0));
                let within: Vec<(f64, usize)> = expected.iter().copied().filter(|(r, _)| *r <= 0.2).collect();
                assert_eq!(around, within, "{place:?}, {boundary:?}");
            }
        }
    }

    #[test]
    fn law_distances_are_to_the_nearest_image() {
        let periodic = Neighbours::new(places(4), 1.0, Boundary::Periodic);
        assert!((periodic.distance(&[0.05, 0.5], &[0.95, 0.5]) - 0.1).abs() < 1e-15);
        let isolated = Neighbours::new(places(4), 1.0, Boundary::Isolated);
        assert!((isolated.distance(&[0.05, 0.5], &[0.95, 0.5]) - 0.9).abs() < 1e-15);
    }
}
