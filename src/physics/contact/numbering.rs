//! How asperities are numbered and placed inside, so that nothing depends on how a caller does.

use crate::physics::PhysicsError;
use crate::physics::surface::summits::Summit;

/// Places are rounded to this share of the side: far below what a grid tells, and far above what rounding makes of a shift.
const GRAIN: f64 = 1.0 / (1u64 << 40) as f64;

/// From the caller's numbers and places to those inside, and back.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    /// The caller's numbers, from the highest summit down.
    pub(crate) numbers: Vec<usize>,
    /// The caller's place of what is the origin inside \[m\].
    origin: [f64; 2],
    length: f64,
    periodic: bool,
}

impl Places {
    /// Of summits on a square of side `length` \[m\]. The origin is the highest summit, or, where there are no images, the corner of all.
    pub(crate) fn new(summits: &[Summit], length: f64, periodic: bool) -> Result<Self, PhysicsError> {
        let mut numbers: Vec<usize> = (0..summits.len()).collect();
        let height = |i: &usize| summits[*i].height_m;
        let highest = numbers.iter().copied().max_by(|i, j| height(i).total_cmp(&height(j))).ok_or(PhysicsError::NoSummit)?;
        let least = |of: fn(&Summit) -> f64| summits.iter().map(of).fold(f64::INFINITY, f64::min);
        let origin = if periodic { [summits[highest].x_m, summits[highest].y_m] } else { [least(|s| s.x_m), least(|s| s.y_m)] };
        let mut places = Self { numbers: Vec::new(), origin, length, periodic };
        let inside: Vec<[f64; 2]> = summits.iter().map(|s| places.inward([s.x_m, s.y_m])).collect();
        numbers.sort_by(|i, j| {
            let place = |k: usize| inside[*i][k].total_cmp(&inside[*j][k]);
            height(j).total_cmp(&height(i)).then(place(0)).then(place(1))
        });
        places.numbers = numbers;
        Ok(places)
    }

    /// A place of the caller's, inside \[m\].
    pub(crate) fn inward(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            let share = (place[k] - self.origin[k]) / self.length;
            let grains = ((if self.periodic { share - share.floor() } else { share }) / GRAIN).round();
            let grains = if self.periodic && grains * GRAIN >= 1.0 { 0.0 } else { grains };
            grains * GRAIN * self.length
        })
    }

    /// A place inside, as the caller has it \[m\].
    pub(crate) fn outward(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            let there = place[k] + self.origin[k];
            if self.periodic && there >= self.length { there - self.length } else { there }
        })
    }

    /// From the caller's numbers of the summits to those inside.
    pub(crate) fn inside(&self) -> Vec<usize> {
        let mut inside = vec![0; self.numbers.len()];
        for (i, number) in self.numbers.iter().enumerate() {
            inside[*number] = i;
        }
        inside
    }
}
