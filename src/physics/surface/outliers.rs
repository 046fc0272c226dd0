//! Isolated outliers of a scan: spikes and dips of up to four points.
//!
//! A point is a candidate if it differs from the median of its neighbours, the 24 other points of a square of
//! 5 x 5, by more than six robust standard deviations: 1.4826 times the median absolute deviation of all
//! points from the median of their neighbours. The candidate is an outlier if it is isolated in two respects;
//! steps, corners, ridges and apices are not:
//! - At half of its height at most three more points are connected to it (the group).
//! - It differs from the points around the group more than three times as much as these differ from the next
//!   ring of points.

use super::edges::Edges;
use ndarray::{Array2, ArrayView2};
use rayon::prelude::*;

/// Standard deviation of a normal distribution over its median absolute deviation.
const DEVIATION: f64 = 1.4826;
/// Robust standard deviations beyond which a point is a candidate.
pub const OUTLIER_LIMIT: f64 = 6.0;
/// Maximum number of points of a group.
pub(super) const LARGEST_GROUP: usize = 4;
/// Minimum contrast of a group, over the difference of the two rings of points around it.
pub(super) const CONTRAST: f64 = 3.0;
/// Points of a square of 5 x 5 without its centre.
const NEIGHBOURS: usize = 24;
/// Minimum number of neighbours that are not missing.
const MIN_NEIGHBOURS: usize = 5;
/// Maximum number of points from which the standard deviation is taken.
const SAMPLE: usize = 1 << 20;
/// Sweeps of the in-fill, enough for groups of [`LARGEST_GROUP`] points to rounding.
const SWEEPS: usize = 60;

/// Row and column of a point.
type Place = (usize, usize);

/// Rows down and columns to the right.
type Step = (isize, isize);

/// Outliers of a scan in the order of its points. Heights that are not finite are missing.
#[must_use]
pub fn find_outliers(heights: ArrayView2<'_, f64>, edges: Edges) -> Vec<Place> {
    let (rows, columns) = heights.dim();
    if rows < 5 || columns < 5 {
        return Vec::new();
    }
    let scan = Scan { heights, edges };
    let limit = OUTLIER_LIMIT * scan.deviation();
    let of_row = |row: usize| {
        (0..columns).map(move |column| (row, column)).filter(|place| scan.is_outlier(*place, limit))
    };
    (0..rows).into_par_iter().flat_map_iter(of_row).collect()
}

/// Heights of points above the median of their neighbours; 0 where too few are known.
#[must_use]
pub fn deviations(heights: ArrayView2<'_, f64>, places: &[Place], edges: Edges) -> Vec<f64> {
    let scan = Scan { heights, edges };
    places.iter().map(|place| scan.median(*place).map_or(0.0, |median| heights[*place] - median)).collect()
}

/// Replaces outliers by the harmonic in-fill: each height is the mean of its four neighbours.
///
/// Missing points have no part in the means, and remain missing. Where all four are missing the height is the
/// median of the neighbours.
pub fn replace_outliers(heights: &mut Array2<f64>, outliers: &[Place], edges: Edges) {
    outliers.iter().for_each(|place| heights[*place] = f64::NAN);
    let medians: Vec<f64> = {
        let scan = Scan { heights: heights.view(), edges };
        outliers.iter().map(|place| scan.median(*place).unwrap_or(f64::NAN)).collect()
    };
    outliers.iter().zip(medians).for_each(|(place, median)| heights[*place] = median);
    for _ in 0..SWEEPS {
        for place in outliers {
            let scan = Scan { heights: heights.view(), edges };
            let around = [(-1, 0), (1, 0), (0, -1), (0, 1)]
                .into_iter()
                .filter_map(|step| scan.height_at(*place, step));
            let (sum, count) = around.fold((0.0, 0.0), |(sum, count), height| (sum + height, count + 1.0));
            if count > 0.0 {
                heights[*place] = sum / count;
            }
        }
    }
}

/// Heights and the continuation at their edges.
#[derive(Clone, Copy)]
struct Scan<'a> {
    heights: ArrayView2<'a, f64>,
    edges: Edges,
}

impl Scan<'_> {
    /// The point at a distance from another; nothing beyond an edge.
    fn place(&self, from: Place, step: Step) -> Option<Place> {
        let to = |at: usize, by: isize, count: usize| match self.edges {
            Edges::Periodic => Some((at as isize + by).rem_euclid(count as isize) as usize),
            Edges::Open => at.checked_add_signed(by).filter(|moved| *moved < count),
        };
        let (rows, columns) = self.heights.dim();
        Some((to(from.0, step.0, rows)?, to(from.1, step.1, columns)?))
    }

    /// The height there; nothing if it is missing.
    fn height_at(&self, place: Place, step: Step) -> Option<f64> {
        self.place(place, step).map(|place| self.heights[place]).filter(|height| height.is_finite())
    }

    /// Median of the neighbours; nothing if too few are known.
    fn median(&self, place: Place) -> Option<f64> {
        let (mut known, mut count) = ([0.0; NEIGHBOURS], 0);
        for down in -2..=2 {
            for right in -2..=2 {
                if let Some(height) = self.height_at(place, (down, right)).filter(|_| (down, right) != (0, 0))
                {
                    known[count] = height;
                    count += 1;
                }
            }
        }
        (count >= MIN_NEIGHBOURS).then(|| median(&mut known[..count]))
    }

    /// Robust standard deviation of the points from the median of their neighbours; at least the smallest
    /// step between two adjacent heights, so that single steps of a quantized scan are none.
    fn deviation(&self) -> f64 {
        let (rows, columns) = self.heights.dim();
        // An odd stride meets every phase of a pattern with an even period.
        let stride = (rows * columns).div_ceil(SAMPLE) | 1;
        let of_point = |k: usize| {
            let place = (k / columns, k % columns);
            self.median(place)
                .map(|median| (self.heights[place] - median).abs())
                .filter(|deviation| deviation.is_finite())
        };
        let mut deviations: Vec<f64> =
            (0..rows * columns).into_par_iter().step_by(stride).filter_map(of_point).collect();
        if deviations.is_empty() {
            f64::INFINITY
        } else {
            (DEVIATION * median(&mut deviations)).max(self.quantum())
        }
    }

    /// Smallest difference of two adjacent heights that differ.
    fn quantum(&self) -> f64 {
        let smallest = |row: usize| {
            let of_point = |column: usize| {
                let height = self.heights[(row, column)];
                let next =
                    [(0, 1), (1, 0)].into_iter().filter_map(move |step| self.height_at((row, column), step));
                next.map(move |other| (other - height).abs())
                    .filter(|step| *step > 0.0)
                    .fold(f64::INFINITY, f64::min)
            };
            (0..self.heights.ncols()).map(of_point).fold(f64::INFINITY, f64::min)
        };
        let quantum =
            (0..self.heights.nrows()).into_par_iter().map(smallest).reduce(|| f64::INFINITY, f64::min);
        if quantum.is_finite() { quantum } else { 0.0 }
    }

    fn is_outlier(&self, place: Place, limit: f64) -> bool {
        let height = self.heights[place];
        let Some(base) = self.median(place).filter(|base| (height - base).abs() > limit) else {
            return false;
        };
        let Some(group) = self.group(place, base) else { return false };
        let near = self.ring(&group);
        let far = self.ring(&[group.as_slice(), near.as_slice()].concat());
        let level = |ring: &[Place]| {
            let mut heights: Vec<f64> = ring.iter().map(|place| self.heights[*place]).collect();
            (heights.len() > 1).then(|| median(&mut heights))
        };
        let levels = level(&near).zip(level(&far));
        levels.is_some_and(|(near, far)| (height - near).abs() > CONTRAST * (near - far).abs())
    }

    /// The points that are connected to one at half of its height above the `base`, or depth below; nothing
    /// if they are too many.
    fn group(&self, place: Place, base: f64) -> Option<Vec<Place>> {
        let height = self.heights[place] - base;
        let mut group = vec![place];
        loop {
            let mut more = self.ring(&group);
            more.retain(|other| (self.heights[*other] - base) * height >= 0.5 * height * height);
            group.extend(&more);
            if group.len() > LARGEST_GROUP {
                return None;
            }
            if more.is_empty() {
                return Some(group);
            }
        }
    }

    /// The known points around a group, in order.
    fn ring(&self, group: &[Place]) -> Vec<Place> {
        let around = |place: &Place| {
            let place = *place;
            (-1..=1).flat_map(move |down| (-1..=1).filter_map(move |right| self.place(place, (down, right))))
        };
        let mut ring: Vec<Place> =
            group.iter().flat_map(around).filter(|place| self.heights[*place].is_finite()).collect();
        ring.sort_unstable();
        ring.dedup();
        ring.retain(|place| !group.contains(place));
        ring
    }
}

/// Median of values; of an even number the mean of the two in the middle.
pub(super) fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    let even = values.len().is_multiple_of(2);
    let (below, high, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let high = *high;
    if even { below.iter().copied().reduce(f64::max).map_or(high, |low| 0.5 * (low + high)) } else { high }
}
