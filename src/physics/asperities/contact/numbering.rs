//! Internal numbering and positions, which make results independent of the caller's order and origin.

use crate::PhysicsError;
use crate::model::Boundary;
use crate::surface::summits::Summit;

/// Position quantum relative to the side.
///
/// It is far below the grid spacing and far above the rounding error of a shift.
const POSITION_QUANTUM: f64 = 1.0 / (1u64 << 40) as f64;

/// Conversion between the caller's numbers and positions and the internal ones.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    /// The caller's numbers, from the highest asperity down.
    pub(crate) numbers: Vec<usize>,
    /// Internal origin in the caller's coordinates \[m\].
    origin: [f64; 2],
    length: f64,
    boundary: Boundary,
}

impl Places {
    /// Numbering of summits on a square of side `length` \[m\].
    ///
    /// The origin is the highest summit, or, without periodic images, the minimum of each coordinate.
    pub(crate) fn new(summits: &[Summit], length: f64, boundary: Boundary) -> Result<Self, PhysicsError> {
        let mut numbers: Vec<usize> = (0..summits.len()).collect();
        let height = |i: &usize| summits[*i].height_m;
        let highest = numbers
            .iter()
            .copied()
            .max_by(|i, j| height(i).total_cmp(&height(j)))
            .ok_or(PhysicsError::NoSummit)?;
        let least = |of: fn(&Summit) -> f64| summits.iter().map(of).fold(f64::INFINITY, f64::min);
        let origin = match boundary {
            Boundary::Periodic => [summits[highest].x_m, summits[highest].y_m],
            Boundary::Isolated => [least(|s| s.x_m), least(|s| s.y_m)],
        };
        let mut places = Self { numbers: Vec::new(), origin, length, boundary };
        let inside: Vec<[f64; 2]> = summits.iter().map(|s| places.inward([s.x_m, s.y_m])).collect();
        numbers.sort_by(|i, j| {
            let place = |k: usize| inside[*i][k].total_cmp(&inside[*j][k]);
            height(j).total_cmp(&height(i)).then(place(0)).then(place(1))
        });
        places.numbers = numbers;
        Ok(places)
    }

    fn is_periodic(&self) -> bool {
        self.boundary == Boundary::Periodic
    }

    /// Internal position \[m\] of a position of the caller.
    pub(crate) fn inward(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            let share = (place[k] - self.origin[k]) / self.length;
            let grains =
                ((if self.is_periodic() { share - share.floor() } else { share }) / POSITION_QUANTUM).round();
            let grains = if self.is_periodic() && grains * POSITION_QUANTUM >= 1.0 { 0.0 } else { grains };
            grains * POSITION_QUANTUM * self.length
        })
    }

    /// The caller's position \[m\] of an internal position.
    pub(crate) fn outward(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            let there = place[k] + self.origin[k];
            if self.is_periodic() && there >= self.length { there - self.length } else { there }
        })
    }

    /// Internal number of each of the caller's numbers.
    pub(crate) fn inside(&self) -> Vec<usize> {
        let mut inside = vec![0; self.numbers.len()];
        for (i, number) in self.numbers.iter().enumerate() {
            inside[*number] = i;
        }
        inside
    }
}
