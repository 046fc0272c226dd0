//! Steps of a branch whose maps are kept, besides those at its ends.
//!
//! Loading has the first steps at or above 1/10, 2/10, … 9/10 of the largest load. Unloading has the first
//! steps at or below 4/5, 3/5, … 0 of the load of its reversal, and then those at which the contact area is
//! at or below 5/6, 4/6, … 1/6 of that at zero load.

use super::records::Step;

/// Stations of loading, and of the compressive and the tensile part of unloading.
pub(crate) const MAP_STATIONS: [usize; 3] = [9, 5, 5];

/// Maximum number of points along a side of the maps of these steps: of larger grids they have every second,
/// third, … point. Each map has 8 bytes for each point, in memory and in each checkpoint.
pub(crate) const MAX_MAP_SIDE: usize = 256;

/// Stations of loading that have been passed at a load.
pub(crate) fn of_loading(load: f64, largest: f64) -> usize {
    let count = MAP_STATIONS[0];
    (1..=count).filter(|k| load >= *k as f64 / (count + 1) as f64 * largest).count()
}

/// Stations of unloading that have been passed after each step of a branch.
pub(crate) fn of_unloading<'a>(steps: impl Iterator<Item = &'a Step>, max_load: f64) -> Vec<usize> {
    let [_, compressive, tensile] = MAP_STATIONS;
    let mut at_zero = None;
    let mut passed = 0;
    let of_step = |step: &Step| {
        let (load, area) = (step.totals.load, step.totals.contact as f64);
        if load <= 0.0 && at_zero.is_none() {
            at_zero = Some(area);
        }
        let now = match at_zero {
            None => (1..=compressive)
                .filter(|k| load <= (1.0 - *k as f64 / compressive as f64) * max_load)
                .count(),
            Some(whole) => {
                compressive
                    + (1..=tensile)
                        .filter(|k| area <= (1.0 - *k as f64 / (tensile + 1) as f64) * whole)
                        .count()
            }
        };
        passed = passed.max(now);
        passed
    };
    steps.map(of_step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::problem::Totals;

    #[test]
    fn law_stations_of_a_branch_are_passed_once() {
        // Of the load 10: 1, 2, … 9 are stations of loading.
        assert_eq!([-1.0, 0.9, 1.0, 5.5, 9.0, 10.0].map(|load| of_loading(load, 10.0)), [0, 0, 1, 5, 9, 9]);
        // Unloading: 8, 6, 4, 2 and 0, then areas of 100 points and less of 120.
        let step = |load: f64, contact: usize| Step {
            totals: Totals { load, contact, ..Totals::default() },
            ..Step::default()
        };
        let steps = [
            (9.0, 400),
            (8.0, 300),
            (3.0, 200),
            (-1.0, 120),
            (0.5, 110),
            (-2.0, 100),
            (-3.0, 39),
            (-1.0, 60),
            (0.0, 0),
        ];
        let steps = steps.map(|(load, contact)| step(load, contact));
        assert_eq!(of_unloading(steps.iter(), 10.0), [0, 1, 3, 5, 5, 6, 9, 9, 10]);
    }
}
