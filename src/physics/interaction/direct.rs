//! Direct sums over all pairs: exact, and the measure of every faster way.

use super::ewald::{IMAGES, ORDERS, RemainderSeries};
use super::moments::{Moments, product};
use super::pair::{LANES, Place, SpotColumns, sag, spot_fields};
use super::{Effort, Interaction, Spots, Tangent};
use crate::model::{Boundary, Interaction as Kind, Material, Slips};
use crate::physics::krylov::dot;
use multiversion::multiversion;
use std::f64::consts::PI;

/// Up to this many asperities the sums over images of every pair are kept, 32 bytes each: 290 MB; beyond, each is computed when needed.
pub(crate) const TABLE_LIMIT: usize = 3000;

/// All pairs, one by one: the exact field of the nearest image of every spot, and of its other images what is seen from afar.
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
    /// [`super::ewald::image_sums`] of every pair of asperities, or nothing above the limit.
    table: Vec<[f64; ORDERS]>,
}

impl DirectSum {
    /// Asperities at `positions` \[m\] on the square of side `length_m`; of the slips only that of Eq 8 is read.
    #[must_use]
    pub fn new(positions: Vec<[f64; 2]>, length_m: f64, material: &Material, kind: Kind, boundary: Boundary, slips: Slips) -> Self {
        let periodic = boundary == Boundary::Periodic;
        let n = positions.len();
        let mut table = Vec::new();
        if periodic && kind != Kind::None && n <= TABLE_LIMIT {
            table.resize(n * n, [0.0; ORDERS]);
            for i in 0..n {
                for j in 0..=i {
                    let [dx, dy] = [0, 1].map(|k| {
                        let d = (positions[i][k] - positions[j][k]) / length_m;
                        d - d.round_ties_even()
                    });
                    let sums = IMAGES.sums(dx, dy);
                    table[i * n + j] = sums;
                    table[j * n + i] = sums;
                }
            }
        }
        Self {
            kind,
            periodic,
            positions,
            length: length_m,
            pull: (2.0 * PI * material.work_of_adhesion_j_m2 / material.contact_modulus_pa).sqrt(),
            sag: sag(slips),
            compliance: 1.0 / (PI * material.contact_modulus_pa),
            table,
        }
    }

    /// What the images of the spots need.
    fn moments(&self, spots: &Spots) -> Moments {
        Moments::of(self.kind, &spots.columns, self.pull, self.compliance, self.length)
    }

    /// Fields of all spots at each of `targets`, one by one \[m\], and their derivatives to the radii: `visit` is given the number of the target
    /// in the list, the fields and the derivatives.
    pub(crate) fn rows(&self, spots: &Spots, targets: &[usize], effort: &mut Effort, mut visit: impl FnMut(usize, &[f64], &[f64])) {
        let n = spots.index.len();
        let moments = self.moments(spots);
        let (mut values, mut slopes) = (vec![0.0; spots.columns.padded()], vec![0.0; spots.columns.padded()]);
        for (k, target) in targets.iter().enumerate() {
            self.row(spots, &moments, *target, &mut values, &mut slopes);
            visit(k, &values[..n], &slopes[..n]);
        }
        effort.pairs += (n * targets.len()) as u64;
    }

    /// Fields of all spots at asperity `target`, one by one, with their slopes.
    fn row(&self, spots: &Spots, moments: &Moments, target: usize, values: &mut [f64], slopes: &mut [f64]) {
        let columns = &spots.columns;
        let [x, y] = self.positions[target];
        let inverse_length = if self.periodic { 1.0 / self.length } else { 0.0 };
        let place = Place { x, y, length: self.length, inverse_length, pull: self.pull, sag: self.sag };
        match self.kind {
            Kind::None => {
                values.fill(0.0);
                slopes.fill(0.0);
                return;
            }
            Kind::Spots => spot_fields(place, columns, values, slopes),
            Kind::Point => {
                for j in 0..columns.len() {
                    let [dx, dy] = [x - columns.x[j], y - columns.y[j]].map(|d| d - self.length * (d * inverse_length).round_ties_even());
                    let unit = self.compliance / dx.hypot(dy);
                    values[j] = columns.load[j] * unit;
                    slopes[j] = columns.load_slope[j] * unit;
                }
            }
        }
        let me = spots.index.binary_search(&target);
        if let Ok(me) = me {
            values[me] = 0.0;
            slopes[me] = 0.0;
        }
        if self.periodic {
            let n = self.positions.len();
            match self.table.get(target * n..(target + 1) * n) {
                Some(line) => known_image_fields(&spots.index, line, moments, values, slopes),
                None => image_fields(place, columns, moments, values, slopes),
            }
        }
    }
}

/// Adds to the fields of the nearest images those of all others.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn image_fields(place: Place, spots: &SpotColumns, moments: &Moments, values: &mut [f64], slopes: &mut [f64]) {
    let images: &RemainderSeries = &IMAGES;
    let columns = [&spots.x, &spots.y].map(|column| column.as_chunks::<LANES>().0);
    for (pass, (x, y)) in columns[0].iter().zip(columns[1]).enumerate() {
        let (mut dx, mut dy) = ([0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            dx[k] = (place.x - x[k]) * place.inverse_length;
            dy[k] = (place.y - y[k]) * place.inverse_length;
            dx[k] -= dx[k].round_ties_even();
            dy[k] -= dy[k].round_ties_even();
        }
        let sums = images.local(&dx, &dy);
        let from = pass * LANES;
        for (sums, j) in sums.iter().zip(from..spots.len()) {
            values[j] += product(sums, &moments.value[j]);
            slopes[j] += product(sums, &moments.slope[j]);
        }
    }
}

/// The same by the sums that are known.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn known_image_fields(index: &[usize], line: &[[f64; ORDERS]], moments: &Moments, values: &mut [f64], slopes: &mut [f64]) {
    for (j, &source) in index.iter().enumerate() {
        values[j] += product(&line[source], &moments.value[j]);
        slopes[j] += product(&line[source], &moments.slope[j]);
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
        let moments = self.moments(spots);
        let (mut values, mut slopes) = (vec![0.0; spots.columns.padded()], vec![0.0; spots.columns.padded()]);
        for (target, displacement) in targets.iter().zip(displacements.iter_mut()) {
            self.row(spots, &moments, *target, &mut values, &mut slopes);
            *displacement = strand_sum(&values[..n]);
        }
        effort.pairs += (n * targets.len()) as u64;
    }

    fn linearise(&self, spots: &Spots, displacements: &mut Vec<f64>, tangent: &mut Tangent, effort: &mut Effort) {
        let n = spots.index.len();
        let mut matrix = tangent.take_dense(n);
        displacements.clear();
        displacements.resize(n, 0.0);
        if n == 0 || self.kind == Kind::None {
            tangent.set_dense(n, matrix);
            return;
        }
        let moments = self.moments(spots);
        let (mut values, mut slopes) = (vec![0.0; spots.columns.padded()], vec![0.0; spots.columns.padded()]);
        for ((target, displacement), line) in spots.index.iter().zip(displacements.iter_mut()).zip(matrix.chunks_mut(n)) {
            self.row(spots, &moments, *target, &mut values, &mut slopes);
            line.copy_from_slice(&slopes[..n]);
            *displacement = strand_sum(&values[..n]);
        }
        effort.pairs += (n * n) as u64;
        tangent.set_dense(n, matrix);
    }

    fn approach(
        &self,
        spots: &Spots,
        rates: &[f64],
        targets: &[usize],
        displacements: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
        effort: &mut Effort,
    ) {
        for column in [&mut *displacements, &mut *slopes] {
            column.clear();
            column.resize(targets.len(), 0.0);
        }
        if self.kind == Kind::None {
            return;
        }
        let n = spots.index.len();
        let moments = self.moments(spots);
        let (mut fields, mut gradients) = (vec![0.0; spots.columns.padded()], vec![0.0; spots.columns.padded()]);
        for ((target, displacement), slope) in targets.iter().zip(displacements.iter_mut()).zip(slopes.iter_mut()) {
            self.row(spots, &moments, *target, &mut fields, &mut gradients);
            *displacement = strand_sum(&fields[..n]);
            *slope = dot(&gradients[..n], &rates[..n]);
        }
        effort.pairs += (n * targets.len()) as u64;
    }
}
