//! Lines of x, y and z, in any order, as a matrix of heights on a regular grid.

use ndarray::Array2;

use super::Cause;
use super::numbers::{points, room, shaped};

/// Coordinates that differ by less than this fraction of their range, over the root of the number of points, are the same.
const SAME: f64 = 1e-6;
/// Fraction of a grid spacing by which a coordinate may be off, as rounding in a file makes it.
const OFF: f64 = 0.1;
/// Help for points that are not on a regular grid.
const HELP: &str = "interpolate the points to a regular grid first (scipy.interpolate.griddata in Python, or Gwyddion), and write nan where heights are missing";

/// Heights on a grid, and the distance of its points along x and along y, all in the numbers of the file.
#[derive(Debug)]
pub(super) struct Grid {
    pub(super) heights: Array2<f64>,
    pub(super) spacing: [f64; 2],
}

/// Sorts values x, y, z, x, y, z … into a grid, every place of which has one height; NaN is a height that is missing.
pub(super) fn grid(values: &[f64]) -> Result<Grid, Cause> {
    let count = values.len() / 3;
    let x = Axis::of("x", values.iter().step_by(3), count)?;
    let y = Axis::of("y", values.iter().skip(1).step_by(3), count)?;
    let extent = [x.count as u64, y.count as u64];
    let places = points(extent[0], extent[1])?;
    if places > count as u64 {
        return Err(refused(format!(
            "three columns are read as x, y and z: {} by {} places of a grid need {places} lines, and it has {count}",
            extent[0], extent[1]
        )));
    }
    let mut heights = room(places)?;
    heights.resize(places as usize, 0.0);
    let mut taken = Vec::new();
    taken.try_reserve_exact(heights.len()).map_err(|_| "its heights do not fit into the memory of this machine")?;
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
    if let Some(place) = taken.iter().position(|taken| !taken) {
        let (at_x, at_y) = (x.first + x.spacing * (place / y.count) as f64, y.first + y.spacing * (place % y.count) as f64);
        return Err(refused(format!("three columns are read as x, y and z: there is no point at x = {at_x}, y = {at_y}")));
    }
    Ok(Grid { heights: shaped(extent, heights)?, spacing: [x.spacing, y.spacing] })
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
    fn of<'a>(name: &'static str, values: impl Iterator<Item = &'a f64>, count: usize) -> Result<Self, Cause> {
        let mut sorted = room(count as u64)?;
        sorted.extend(values);
        if sorted.iter().any(|value| !value.is_finite()) {
            return Err(refused(format!("three columns are read as x, y and z: a value of {name} is missing")));
        }
        sorted.sort_unstable_by(f64::total_cmp);
        let (Some(first), Some(last)) = (sorted.first().copied(), sorted.last().copied()) else { return Err("it has no points".into()) };
        let same = SAME * (last - first) / (count as f64).sqrt();
        sorted.dedup_by(|next, kept| *next - *kept <= same);
        let count = sorted.len();
        let spacing = (last - first) / (count.max(2) - 1) as f64;
        if count < 2 || !spacing.is_finite() {
            return Err(refused(format!("three columns are read as x, y and z: all values of {name} are {first}")));
        }
        let axis = Self { name, first, spacing, count };
        for (at, value) in sorted.iter().enumerate() {
            let due = first + spacing * at as f64;
            if (value - due).abs() > OFF * spacing {
                return Err(axis.uneven(&sorted));
            }
        }
        Ok(axis)
    }

    /// The refusal of coordinates that are not evenly spaced, with the widest gap.
    fn uneven(&self, sorted: &[f64]) -> Cause {
        let gap = |pair: &&[f64]| pair[1] - pair[0];
        let widest = sorted.windows(2).max_by(|a, b| gap(a).total_cmp(&gap(b)));
        let narrowest = sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let (from, to) = widest.map_or((f64::NAN, f64::NAN), |pair| (pair[0], pair[1]));
        refused(format!(
            "three columns are read as x, y and z: the {} values of {} are not evenly spaced, {narrowest:.3e} to {:.3e} apart (from {from} to {to})",
            self.count,
            self.name,
            to - from
        ))
    }

    /// The place of a coordinate, which is one of those that the axis was made of.
    fn place(&self, value: f64) -> Result<usize, Cause> {
        let place = ((value - self.first) / self.spacing).round();
        if (0.0..self.count as f64).contains(&place) {
            Ok(place as usize)
        } else {
            Err(format!("its {} of {value} is off the grid", self.name).into())
        }
    }
}
