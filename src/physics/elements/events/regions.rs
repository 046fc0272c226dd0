//! Connected regions of contact on the periodic grid, and how they change in an event.

use crate::elements::grid::half_space::HalfSpace;
use crate::elements::problem::{Problem, State};
use crate::event_kind::RegionChange;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// A connected region of contact; points that share an edge or a corner are connected.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// Points.
    pub points: usize,
    /// Sum of the pressures, compression positive \[E* dx²\].
    pub load: f64,
    /// Length of the edge \[dx\], by Crofton's formula along the rows, the columns and the diagonals (Ohser &
    /// Mücklich, *Statistical Analysis of Microstructures in Materials Science*, Wiley 2000).
    pub perimeter: f64,
    /// Centroid, row and column \[dx\]: the mean direction on a circle of the length of the square, and the
    /// mean place on a surface with mirror images. It has no meaning along a direction in which the region
    /// closes on itself across the edges.
    pub centroid: [f64; 2],
    /// Asperities in it.
    pub summits: u32,
}

/// Label of each point: 0 outside contact, else the number of its region plus 1.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Labels {
    /// By point.
    pub of: Vec<u32>,
    /// Number of regions.
    pub count: usize,
}

/// Labels the contact of a state. Of a surface with mirror images, the points of the surface itself alone.
#[must_use]
pub fn label(problem: &Problem, state: &State) -> Labels {
    let columns = problem.half_space.columns();
    let contact: Vec<bool> = (0..problem.half_space.points())
        .map(|k| problem.touches(state.bonds[k], problem.gap(state, k)))
        .collect();
    let all = label_points(&contact, columns);
    if problem.half_space.is_mirrored() { of_the_surface(all, &problem.half_space) } else { all }
}

/// Labels without those of mirror images, numbered again by their first point.
fn of_the_surface(Labels { mut of, count }: Labels, grid: &HalfSpace) -> Labels {
    let mut numbers = vec![0; count];
    let mut own = 0;
    for (k, label) in of.iter_mut().enumerate().filter(|(_, label)| **label > 0) {
        if !grid.is_own(k) {
            *label = 0;
            continue;
        }
        let number = &mut numbers[*label as usize - 1];
        if *number == 0 {
            own += 1;
            *number = own;
        }
        *label = *number;
    }
    Labels { of, count: own as usize }
}

/// Labels marked points of a periodic grid, regions numbered by their first point.
#[must_use]
pub fn label_points(marked: &[bool], columns: usize) -> Labels {
    let rows = marked.len() / columns;
    let mut parent: Vec<u32> = (0..marked.len() as u32).collect();
    for row in 0..rows {
        let below = (row + 1) % rows * columns;
        for column in 0..columns {
            let here = row * columns + column;
            if !marked[here] {
                continue;
            }
            let (left, right) = ((column + columns - 1) % columns, (column + 1) % columns);
            for other in [row * columns + right, below + column, below + left, below + right] {
                if marked[other] {
                    join(&mut parent, here as u32, other as u32);
                }
            }
        }
    }
    let mut number = vec![0; marked.len()];
    let mut count = 0;
    let mut of = vec![0; marked.len()];
    for k in 0..marked.len() {
        if marked[k] {
            let root = root(&mut parent, k as u32) as usize;
            if number[root] == 0 {
                count += 1;
                number[root] = count;
            }
            of[k] = number[root];
        }
    }
    Labels { of, count: count as usize }
}

fn root(parent: &mut [u32], mut k: u32) -> u32 {
    while parent[k as usize] != k {
        parent[k as usize] = parent[parent[k as usize] as usize];
        k = parent[k as usize];
    }
    k
}

fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    if a != b {
        parent[a.max(b) as usize] = a.min(b);
    }
}

/// Area, load, edge, centroid and asperities of each region; `summits` are the grid points of the asperities.
#[must_use]
pub fn regions(problem: &Problem, state: &State, labels: &Labels, summits: &[usize]) -> Vec<Region> {
    let columns = problem.half_space.columns();
    let rows = problem.half_space.rows();
    let is_mirrored = problem.half_space.is_mirrored();
    let beside = neighbours(&problem.half_space);
    let mut all =
        vec![Region { points: 0, load: 0.0, perimeter: 0.0, centroid: [0.0; 2], summits: 0 }; labels.count];
    // Sums of exp(i 2π x/n) along each direction: the centroid on a circle.
    let mut circles = vec![[0.0_f64; 4]; labels.count];
    for (k, label) in labels.of.iter().enumerate().filter(|(_, label)| **label > 0) {
        let region = &mut all[*label as usize - 1];
        let (row, column) = (k / columns, k % columns);
        region.points += 1;
        region.load -= problem.tension(state, k);
        let outside = |down: i64, right: i64| labels.of[beside(k, down, right)] != *label;
        let count = |places: [(i64, i64); 4]| {
            places.into_iter().filter(|(down, right)| outside(*down, *right)).count() as f64
        };
        let straight = count([(0, 1), (0, -1), (1, 0), (-1, 0)]);
        let oblique = count([(1, 1), (1, -1), (-1, 1), (-1, -1)]);
        region.perimeter += PI / 8.0 * (straight + oblique / 2.0_f64.sqrt());
        let circle = &mut circles[*label as usize - 1];
        for (place, size, at) in [(row, rows, 0), (column, columns, 2)] {
            let (sine, cosine) = (TAU * place as f64 / size as f64).sin_cos();
            circle[at] += cosine;
            circle[at + 1] += sine;
            // A part of a surface with mirror images does not close on itself.
            region.centroid[at / 2] += if is_mirrored { place as f64 } else { 0.0 };
        }
    }
    for (region, circle) in all.iter_mut().zip(circles) {
        for (at, size) in [(0, rows), (1, columns)] {
            if is_mirrored {
                region.centroid[at] /= region.points.max(1) as f64;
                continue;
            }
            region.centroid[at] =
                (circle[2 * at + 1].atan2(circle[2 * at]) / TAU).rem_euclid(1.0) * size as f64;
        }
    }
    for label in summits.iter().filter_map(|point| labels.of.get(*point)).filter(|label| **label > 0) {
        all[*label as usize - 1].summits += 1;
    }
    all
}

/// Neighbour of a point, at an offset in rows and columns: across the edges of a periodic grid, and the
/// mirror image of itself beyond the edges of a surface with mirror images.
fn neighbours(grid: &HalfSpace) -> impl Fn(usize, i64, i64) -> usize + use<> {
    let (size, [own_rows, own_columns], is_mirrored) =
        ([grid.rows(), grid.columns()], grid.own(), grid.is_mirrored());
    let on = move |at: usize, by: i64, size: usize, own: usize| {
        let next = at as i64 + by;
        if is_mirrored {
            next.clamp(0, own as i64 - 1) as usize
        } else {
            next.rem_euclid(size as i64) as usize
        }
    };
    move |point, down, right| {
        on(point / size[1], down, size[0], own_rows) * size[1]
            + on(point % size[1], right, size[1], own_columns)
    }
}

/// Kind of the change from one labelling to the next: that of the region whose area changed most.
#[must_use]
pub fn change(before: &Labels, after: &Labels) -> RegionChange {
    let mut overlap: std::collections::BTreeMap<(u32, u32), usize> = std::collections::BTreeMap::new();
    let (mut size_before, mut size_after) = (vec![0_i64; before.count], vec![0_i64; after.count]);
    for (a, b) in before.of.iter().zip(&after.of) {
        if *a > 0 {
            size_before[*a as usize - 1] += 1;
        }
        if *b > 0 {
            size_after[*b as usize - 1] += 1;
        }
        if *a > 0 && *b > 0 {
            *overlap.entry((*a, *b)).or_default() += 1;
        }
    }
    // (change of area, kind) of every region, the largest first found.
    let mut most = (-1, RegionChange::Grown);
    let mut consider = |size: i64, kind| {
        if size > most.0 {
            most = (size, kind);
        }
    };
    for (k, size) in size_after.iter().enumerate() {
        let from: Vec<i64> = overlap
            .keys()
            .filter(|(_, b)| *b as usize == k + 1)
            .map(|(a, _)| size_before[*a as usize - 1])
            .collect();
        match from[..] {
            [] => consider(*size, RegionChange::Formed),
            [one] if *size >= one => consider(size - one, RegionChange::Grown),
            [_] => {}
            _ => consider(size - from.iter().max().copied().unwrap_or(0), RegionChange::Joined),
        }
    }
    for (k, size) in size_before.iter().enumerate() {
        let to: Vec<i64> = overlap
            .keys()
            .filter(|(a, _)| *a as usize == k + 1)
            .map(|(_, b)| size_after[*b as usize - 1])
            .collect();
        match to[..] {
            [] => consider(*size, RegionChange::Lost),
            [one] if one < *size => consider(size - one, RegionChange::Shrunk),
            [_] => {}
            _ => consider(size - to.iter().max().copied().unwrap_or(0), RegionChange::Parted),
        }
    }
    most.1
}
