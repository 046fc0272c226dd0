//! Direct sums over all pairs: exact, and the measure of every faster way.

use super::ewald::{RemainderSeries, remainder};
use super::pair::{Place, sag, spot_fields};
use super::{Effort, Interaction, Spots, Tangent};
use crate::model::{Boundary, Interaction as Kind, Material, Slips};
use std::f64::consts::PI;

/// Above this many asperities the table of remainders (8 bytes a pair) would outgrow a laptop's memory, and each is computed when needed.
const TABLE_LIMIT: usize = 12_000;

/// All pairs, one by one.
#[derive(Debug)]
pub struct DirectSum {
    kind: Kind,
    periodic: bool,
    positions: Vec<[f64; 2]>,
    length: f64,
    pull: f64,
    sag: f64,
    /// `1/(πE*)` \[1/Pa\].
    compliance: f64,
    series: RemainderSeries,
    /// `G − 1/(πE*r)` \[m/N\] for every pair of asperities, or nothing above the limit.
    table: Vec<f64>,
    /// The same at a load's own centre.
    own: f64,
}

impl DirectSum {
    /// Asperities at `positions` \[m\] on the square of side `length_m`; of the slips only that of Eq 8 is read.
    #[must_use]
    pub fn new(positions: Vec<[f64; 2]>, length_m: f64, material: &Material, kind: Kind, boundary: Boundary, slips: Slips) -> Self {
        let compliance = 1.0 / (PI * material.contact_modulus_pa);
        let periodic = boundary == Boundary::Periodic;
        let own = if periodic && kind != Kind::None { compliance / length_m * remainder(0.0, 0.0, 2.5) } else { 0.0 };
        let mut field = Self {
            kind,
            periodic,
            positions,
            length: length_m,
            pull: (2.0 * PI * material.work_of_adhesion_j_m2 / material.contact_modulus_pa).sqrt(),
            sag: sag(slips),
            compliance,
            series: RemainderSeries::new(),
            table: Vec::new(),
            own,
        };
        let n = field.positions.len();
        if periodic && kind != Kind::None && n <= TABLE_LIMIT {
            let mut table = vec![0.0; n * n];
            for i in 0..n {
                for j in 0..i {
                    let value = field.pair_remainder(i, j);
                    table[i * n + j] = value;
                    table[j * n + i] = value;
                }
            }
            field.table = table;
        }
        field
    }

    fn pair_remainder(&self, i: usize, j: usize) -> f64 {
        let [dx, dy] = [0, 1].map(|k| {
            let d = (self.positions[i][k] - self.positions[j][k]) / self.length;
            d - d.round_ties_even()
        });
        self.compliance / self.length * self.series.at(dx, dy)
    }

    /// Fields of all spots at asperity `target`, one by one, with their slopes.
    fn row(&self, spots: &Spots, target: usize, values: &mut [f64], slopes: &mut [f64]) {
        let columns = &spots.columns;
        let [x, y] = self.positions[target];
        let inverse_length = if self.periodic { 1.0 / self.length } else { 0.0 };
        match self.kind {
            Kind::None => {
                values.fill(0.0);
                slopes.fill(0.0);
                return;
            }
            Kind::Spots => {
                let place = Place { x, y, length: self.length, inverse_length, pull: self.pull, sag: self.sag };
                spot_fields(place, columns, values, slopes);
            }
            Kind::Point => {
                for j in 0..columns.len() {
                    let [dx, dy] = [x - columns.x[j], y - columns.y[j]].map(|d| d - self.length * (d * inverse_length).round_ties_even());
                    let unit = self.compliance / dx.hypot(dy);
                    values[j] = columns.load[j] * unit;
                    slopes[j] = columns.load_slope[j] * unit;
                }
            }
        }
        if self.periodic {
            let line = self.table.get(target * self.positions.len()..(target + 1) * self.positions.len());
            let rest = spots.index.iter().map(|&source| match line {
                Some(line) => line[source],
                None => self.pair_remainder(target, source),
            });
            let fields = values.iter_mut().zip(slopes.iter_mut()).zip(columns.load.iter().zip(&columns.load_slope));
            for (((value, slope), (load, load_slope)), rest) in fields.zip(rest) {
                *value += load * rest;
                *slope += load_slope * rest;
            }
        }
        if let Ok(me) = spots.index.binary_search(&target) {
            values[me] = columns.load[me] * self.own;
            slopes[me] = columns.load_slope[me] * self.own;
        }
    }
}

/// A sum in eight fixed strands: the same on every machine, and open to vector instructions.
pub(crate) fn strand_sum(values: &[f64]) -> f64 {
    let mut strands = [0.0; 8];
    let (whole, rest) = values.as_chunks::<8>();
    for chunk in whole {
        for (strand, value) in strands.iter_mut().zip(chunk) {
            *strand += value;
        }
    }
    for (strand, value) in strands.iter_mut().zip(rest) {
        *strand += value;
    }
    strands.iter().sum()
}

impl Interaction for DirectSum {
    fn displacements(&self, spots: &Spots, targets: &[usize], displacements: &mut Vec<f64>, effort: &mut Effort) {
        displacements.clear();
        displacements.resize(targets.len(), 0.0);
        if self.kind == Kind::None {
            return;
        }
        let n = spots.index.len();
        let (mut values, mut slopes) = (vec![0.0; spots.columns.padded()], vec![0.0; spots.columns.padded()]);
        for (target, displacement) in targets.iter().zip(displacements.iter_mut()) {
            self.row(spots, *target, &mut values, &mut slopes);
            *displacement = strand_sum(&values[..n]);
        }
        effort.pairs += (n * targets.len()) as u64;
    }

    fn linearise(&self, spots: &Spots, displacements: &mut Vec<f64>, tangent: &mut Tangent, effort: &mut Effort) {
        let n = spots.index.len();
        tangent.size = n;
        tangent.matrix.clear();
        tangent.matrix.resize(n * n, 0.0);
        displacements.clear();
        displacements.resize(n, 0.0);
        if n == 0 || self.kind == Kind::None {
            return;
        }
        let (mut values, mut slopes) = (vec![0.0; spots.columns.padded()], vec![0.0; spots.columns.padded()]);
        for ((target, displacement), line) in spots.index.iter().zip(displacements.iter_mut()).zip(tangent.matrix.chunks_mut(n)) {
            self.row(spots, *target, &mut values, &mut slopes);
            line.copy_from_slice(&slopes[..n]);
            *displacement = strand_sum(&values[..n]);
        }
        effort.pairs += (n * n) as u64;
    }
}
