//! Lines of x, y and z, in any order, as a matrix of heights on a regular grid. A place of the grid without a
//! line is a missing point.

use ndarray::Array2;

use super::numbers::{points, room, shaped};
use super::{Cause, MOST_POINTS};

/// Coordinates that differ by less than this fraction of their range, over the root of the number of points,
/// are the same.
const SAME: f64 = 1e-6;
/// Fraction of a grid spacing by which a coordinate may be off, as rounding in a file makes it.
const OFF: f64 = 0.1;
/// Gaps of an axis up to this multiple of the median gap are one spacing, and wider ones are several.
const ONE_GAP: f64 = 1.5;
/// Places of a grid per line at most: with fewer lines, the points are scattered. In-fill takes as many
/// missing points.
const MOST_PLACES: u64 = 2;
/// Help for points that are not on a regular grid.
const HELP: &str = "interpolate the points to a regular grid first (scipy.interpolate.griddata in Python, or \
     Gwyddion), and write nan where heights are missing";

/// Heights on a grid, and the distance of its points along x and along y, all in the numbers of the file.
#[derive(Debug)]
pub(super) struct Grid {
    pub(super) heights: Array2<f64>,
    pub(super) spacing: [f64; 2],
    /// Places without a line.
    pub(super) absent: usize,
}

/// Sorts values x, y, z, x, y, z … into a grid, every place of which has one height; NaN is a height that is
/// missing.
pub(super) fn grid(values: &[f64]) -> Result<Grid, Cause> {
    let count = values.len() / 3;
    let x = Axis::of("x", values.iter().step_by(3), count)?;
    let y = Axis::of("y", values.iter().skip(1).step_by(3), count)?;
    let extent = [x.count as u64, y.count as u64];
    let places = extent[0].saturating_mul(extent[1]);
    if places > MOST_PLACES.saturating_mul(count as u64) {
        return Err(refused(format!(
            "three columns are read as x, y and z: {} by {} places of a grid need {places} lines, and it has \
             {count}",
            extent[0], extent[1]
        )));
    }
    points(extent[0], extent[1])?;
    let mut heights = room(places)?;
    heights.resize(places as usize, f64::NAN);
    let mut taken = Vec::new();
    taken
        .try_reserve_exact(heights.len())
        .map_err(|_| "its heights do not fit into the memory of this machine")?;
    taken.resize(heights.len(), false);
    for point in values.chunks_exact(3) {
        let place = x.place(point[0])? * y.count + y.place(point[1])?;
        if std::mem::replace(&mut taken[place], true) {
            return Err(refused(format!(
                "three columns are read as x, y and z: the point x = {}, y = {} is there twice",
                point[0], point[1]
            )));
        }
        heights[place] = point[2];
    }
    let absent = taken.iter().filter(|taken| !**taken).count();
    Ok(Grid { heights: shaped(extent, heights)?, spacing: [x.spacing, y.spacing], absent })
}

fn refused(problem: String) -> Cause {
    format!("{problem}\nhelp: {HELP}").into()
}

/// Evenly spaced coordinates.
struct Axis {
    name: &'static str,
    first: f64,
    spacing: f64,
    count: usize,
}

impl Axis {
    fn of<'a>(
        name: &'static str,
        values: impl Iterator<Item = &'a f64>,
        count: usize,
    ) -> Result<Self, Cause> {
        let mut sorted = room(count as u64)?;
        sorted.extend(values);
        if sorted.iter().any(|value| !value.is_finite()) {
            return Err(refused(format!(
                "three columns are read as x, y and z: a value of {name} is missing"
            )));
        }
        sorted.sort_unstable_by(f64::total_cmp);
        let (Some(first), Some(last)) = (sorted.first().copied(), sorted.last().copied()) else {
            return Err("it has no points".into());
        };
        let same = SAME * (last - first) / (count as f64).sqrt();
        sorted.dedup_by(|next, kept| *next - *kept <= same);
        if sorted.len() < 2 || !(last - first).is_finite() {
            return Err(refused(format!(
                "three columns are read as x, y and z: all values of {name} are {first}"
            )));
        }
        let of = |count: usize| Self { name, first, spacing: (last - first) / (count - 1) as f64, count };
        let [full, gapped] = [of(sorted.len()), of(Self::with_gaps(&sorted, last - first))];
        if full.holds(&sorted) {
            Ok(full)
        } else if gapped.holds(&sorted) && gapped.count as u64 <= MOST_PLACES * sorted.len() as u64 {
            Ok(gapped)
        } else {
            Err(full.uneven(&sorted))
        }
    }

    /// Number of places of an axis where some coordinates have no line, from the mean of the gaps that are
    /// one spacing.
    fn with_gaps(sorted: &[f64], range: f64) -> usize {
        let mut gaps: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).collect();
        gaps.sort_unstable_by(f64::total_cmp);
        let median = gaps.get(gaps.len() / 2).copied().unwrap_or(range);
        // More than half of the gaps may be wide, where the points are few.
        let one = if gaps.first().is_some_and(|least| *least < 0.75 * median) {
            gaps.first().copied().unwrap_or(median)
        } else {
            median
        };
        let single: Vec<f64> = gaps.into_iter().filter(|gap| *gap < ONE_GAP * one).collect();
        let spacing = single.iter().sum::<f64>() / single.len().max(1) as f64;
        let places = (range / spacing).round();
        if places < MOST_POINTS as f64 { (places as usize + 1).max(2) } else { sorted.len() }
    }

    /// True if every coordinate is at a place of the axis.
    fn holds(&self, sorted: &[f64]) -> bool {
        sorted.iter().all(|value| {
            let place = (value - self.first) / self.spacing;
            (place - place.round()).abs() <= OFF
        }) && self.count >= sorted.len()
    }

    /// The refusal of coordinates that are not evenly spaced, with the widest gap.
    fn uneven(&self, sorted: &[f64]) -> Cause {
        let gap = |pair: &&[f64]| pair[1] - pair[0];
        let widest = sorted.windows(2).max_by(|a, b| gap(a).total_cmp(&gap(b)));
        let narrowest = sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let (from, to) = widest.map_or((f64::NAN, f64::NAN), |pair| (pair[0], pair[1]));
        refused(format!(
            "three columns are read as x, y and z: the {} values of {} are not evenly spaced, \
             {narrowest:.3e} to {:.3e} apart (from {from} to {to})",
            sorted.len(),
            self.name,
            to - from
        ))
    }

    /// Place of a coordinate, which is one of the coordinates of the axis.
    fn place(&self, value: f64) -> Result<usize, Cause> {
        let place = ((value - self.first) / self.spacing).round();
        if (0.0..self.count as f64).contains(&place) {
            Ok(place as usize)
        } else {
            Err(format!("its {} of {value} is off the grid", self.name).into())
        }
    }
}
