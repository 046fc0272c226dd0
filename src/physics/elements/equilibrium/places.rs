//! Places of events on a grid: squares around points whose bonds have changed.

use crate::elements::grid::half_space::HalfSpace;
use crate::elements::numerics::PatchLimits;

/// Side of the smallest patch.
pub(crate) const SMALLEST_SIDE: usize = 32;

/// A place on the grid, in rows and columns.
pub(crate) type Place = [usize; 2];

/// Square of a patch on the grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Region {
    pub(crate) middle: Place,
    pub(crate) side: usize,
}

impl Region {
    /// True if two squares have points in common.
    pub(crate) fn overlaps(&self, other: &Self, grid: &HalfSpace) -> bool {
        distance(grid, self.middle, other.middle) < self.side.midpoint(other.side)
    }
}

/// Places around points whose bonds have changed, each with the side of its first patch.
pub(crate) fn places(
    grid: &HalfSpace,
    changed: &[usize],
    limits: PatchLimits,
    largest: usize,
) -> impl Iterator<Item = Region> {
    let radius = limits.place_radius;
    let mut rest = changed.to_vec();
    std::iter::from_fn(move || {
        let first = *rest.first()?;
        let (near, others) = std::mem::take(&mut rest)
            .into_iter()
            .partition(|point| distance(grid, place(grid, *point), place(grid, first)) <= radius);
        rest = others;
        let (middle, extent) = surroundings(grid, first, near, radius);
        let side = (limits.side_ratio * extent + limits.side_offset)
            .next_power_of_two()
            .clamp(SMALLEST_SIDE, largest);
        Some(Region { middle, side })
    })
}

/// Larger of the differences of two places along rows and columns of the periodic grid.
fn distance(grid: &HalfSpace, a: Place, b: Place) -> usize {
    let along = |a: usize, b: usize, size: usize| a.abs_diff(b).min(size - a.abs_diff(b));
    along(a[0], b[0], grid.rows()).max(along(a[1], b[1], grid.columns()))
}

fn place(grid: &HalfSpace, point: usize) -> Place {
    [point / grid.columns(), point % grid.columns()]
}

/// Middle and extent of points that are near the first.
fn surroundings(grid: &HalfSpace, first: usize, near: Vec<usize>, radius: usize) -> (Place, usize) {
    let (size, first) = ([grid.rows(), grid.columns()], place(grid, first));
    let (mut low, mut high) = ([radius; 2], [radius; 2]);
    for at in near.into_iter().map(|point| place(grid, point)) {
        for k in 0..2 {
            let offset = (at[k] + size[k] + radius - first[k]) % size[k];
            (low[k], high[k]) = (low[k].min(offset), high[k].max(offset));
        }
    }
    let middle = [0, 1].map(|k| (first[k] + (low[k] + high[k]) / 2 + size[k] - radius) % size[k]);
    (middle, (0..2).map(|k| high[k] - low[k] + 1).max().unwrap_or(1))
}

#[cfg(test)]
mod tests {
    use super::{PatchLimits, Region, SMALLEST_SIDE, places};
    use crate::PhysicsError;
    use crate::elements::grid::half_space::HalfSpace;

    #[test]
    fn law_points_across_the_edge_are_one_place() -> Result<(), PhysicsError> {
        let grid = HalfSpace::new(128, 128)?;
        let point = |row: usize, column: usize| row * 128 + column;
        // The first four points are within 12 of the first, across the corner of the periodic square. Their
        // extent of 12 points, twice and 8, is 32.
        let changed = [point(0, 0), point(127, 2), point(3, 124), point(120, 127), point(64, 64)];
        let found: Vec<Region> = places(&grid, &changed, PatchLimits::DEFAULT, 64).collect();
        assert_eq!(
            found.iter().map(|region| (region.middle, region.side)).collect::<Vec<_>>(),
            [([125, 127], SMALLEST_SIDE), ([64, 64], SMALLEST_SIDE)]
        );
        assert!(!found[0].overlaps(&found[1], &grid));
        // Squares of 32 and 96 points whose middles are 63 apart share points, those of 32 and 64 do not.
        assert!(found[1].overlaps(&Region { side: 96, ..found[0] }, &grid));
        assert!(!found[1].overlaps(&Region { side: 64, ..found[0] }, &grid));
        Ok(())
    }
}
