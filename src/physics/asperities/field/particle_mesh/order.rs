//! Z-order of positions: neighbouring points are stored together, for memory locality.
//!
//! With a million spots in any other order, a sum waits for memory seven times as long as it computes.

use crate::asperities::field::Spots;
use crate::math::grown::Grown;

/// Asperities in the order of the Z-curve (Morton 1966) through the square.
#[derive(Debug, Clone)]
pub(super) struct Order {
    /// Positions in Z-order \[m\].
    pub(super) positions: Grown<[f64; 2]>,
    /// Rank of each asperity in the order.
    ranks: Grown<u32>,
}

impl Order {
    /// Sorts positions \[m\] on the periodic square of side `length` \[m\].
    pub(super) fn new(given: Vec<[f64; 2]>, length: f64) -> Self {
        let mut numbers: Vec<u32> = (0..given.len() as u32).collect();
        numbers.sort_by_cached_key(|i| (z_index(given[*i as usize], length), *i));
        let mut ranks = vec![0; given.len()];
        for (rank, i) in numbers.iter().enumerate() {
            ranks[*i as usize] = rank as u32;
        }
        Self { positions: numbers.iter().map(|i| given[*i as usize]).collect(), ranks: ranks.into() }
    }

    /// Adds an asperity at `place` \[m\]; it gets the next number and the last rank.
    pub(super) fn add(&mut self, place: [f64; 2]) {
        self.ranks.push(self.positions.len() as u32);
        self.positions.push(place);
    }

    /// Ranks of the given asperities, sorted.
    pub(super) fn of(&self, numbers: &[usize]) -> Ordered {
        let mut pairs: Vec<(u32, u32)> =
            numbers.iter().enumerate().map(|(k, i)| (self.ranks[*i], k as u32)).collect();
        pairs.sort_unstable();
        Ordered {
            ranks: pairs.iter().map(|pair| pair.0 as usize).collect(),
            from: pairs.iter().map(|pair| pair.1 as usize).collect(),
        }
    }

    /// Spots in Z-order, identified by rank, and their original positions.
    pub(super) fn spots(&self, spots: &Spots) -> (Spots, Vec<usize>) {
        let Ordered { ranks, from } = self.of(&spots.index);
        (Spots { index: ranks, columns: spots.columns.in_order(&from) }, from)
    }
}

/// Asperities in Z-order: their ranks, ascending, and their original positions in the list.
pub(super) struct Ordered {
    pub(super) ranks: Vec<usize>,
    pub(super) from: Vec<usize>,
}

/// Permutes values from the original order to Z-order.
pub(super) fn inward(from: &[usize], given: &[f64], ordered: &mut Vec<f64>) {
    ordered.clear();
    ordered.extend(from.iter().map(|k| given[*k]));
}

/// Permutes values from Z-order to the original order.
pub(super) fn outward(from: &[usize], ordered: &[f64], given: &mut [f64]) {
    for (k, value) in from.iter().zip(ordered) {
        given[*k] = *value;
    }
}

/// Index of a point along the Z-curve.
fn z_index(place: [f64; 2], length: f64) -> u64 {
    let bits = place.map(|p| {
        let share = p / length;
        let cell = ((share - share.floor()) * 65536.0) as u64 & 0xFFFF;
        let cell = (cell | cell << 8) & 0x00FF_00FF;
        let cell = (cell | cell << 4) & 0x0F0F_0F0F;
        let cell = (cell | cell << 2) & 0x3333_3333;
        (cell | cell << 1) & 0x5555_5555
    });
    bits[0] << 1 | bits[1]
}
