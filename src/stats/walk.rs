//! One branch of a cycle, walked away from its load reversal, and interpolated at given loads.
//!
//! The path is displacement controlled and its load jumps, so the load of a branch is not single valued. The
//! branch is therefore walked away from its load reversal, and the **first** crossing of a load is used.
//! While unloading this is the order of time. The loading branch is walked backwards: its crossing is the
//! last in time and has the largest penetration. Between two steps all quantities are linear in the load,
//! also across a jump.

/// Stations of a branch: their number from the load reversal down to zero load, both included.
pub const COMPRESSION_STATIONS: usize = 151;
/// Stations below zero load, the last one at the branch's lowest load.
pub const TENSION_STATIONS: usize = 50;
/// All stations of a branch.
pub const STATIONS: usize = COMPRESSION_STATIONS + TENSION_STATIONS;

/// Point of a branch; all dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Load `F/(E* A0)`.
    pub load: f64,
    /// Contact area `A/A0`.
    pub area: f64,
    /// Mean penetration `Δ/h_rms`.
    pub penetration: f64,
}

/// A branch as points in the order of a walk away from the load reversal, which is its first point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Walk(pub Vec<Point>);

impl Walk {
    /// The first point at which the walk is at or below a load, or nothing if the load is above its start or
    /// never reached.
    pub fn at(&self, load: f64) -> Option<Point> {
        let first = self.0.first()?;
        if load > first.load {
            return None;
        }
        let beyond = self.0.iter().position(|point| point.load <= load)?;
        let after = self.0.get(beyond)?;
        let Some(before) = beyond.checked_sub(1).and_then(|index| self.0.get(index)) else {
            return Some(Point { load, ..*after });
        };
        // Every earlier point is above `load` and this one is not, so the difference is never zero.
        let share = (before.load - load) / (before.load - after.load);
        let between = |from: f64, to: f64| from + share * (to - from);
        Some(Point {
            load,
            area: between(before.area, after.area),
            penetration: between(before.penetration, after.penetration),
        })
    }

    /// The lowest load of the walk if it is a tension, and zero otherwise.
    pub fn greatest_tension(&self) -> f64 {
        self.0.iter().fold(0.0, |least, point| point.load.min(least))
    }

    /// The walk at every station: loads spaced evenly from `max_load` to zero, the same for every
    /// realization, and then evenly from zero to this walk's own lowest load.
    ///
    /// Below zero each realization has a different end, its pull-off. On a common grid of loads the mean
    /// would there lose one realization after another and jump each time; stations at equal fractions of each
    /// one's own tension keep them all, and the mean curve ends at the mean pull-off.
    pub fn stations(&self, max_load: f64) -> Vec<Option<Point>> {
        let tension = self.greatest_tension();
        let steps = (COMPRESSION_STATIONS - 1) as f64;
        (0..STATIONS)
            .map(|index| match tension_fraction(index) {
                // The fraction is rounded first, so that it is exactly one at the load reversal and never
                // more.
                None => self.at(max_load * ((steps - index as f64) / steps)),
                Some(fraction) => self.at(tension * fraction),
            })
            .collect()
    }
}

/// Fraction of each walk's own maximum tensile load at a station below zero load; nothing where the load is
/// common to all walks.
pub(super) fn tension_fraction(station: usize) -> Option<f64> {
    let below = (station + 1).checked_sub(COMPRESSION_STATIONS).filter(|below| *below > 0);
    below.map(|below| below as f64 / TENSION_STATIONS as f64)
}
