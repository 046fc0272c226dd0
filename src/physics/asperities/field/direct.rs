//! Direct sums over all pairs: exact, and the reference for the fast sum.

mod at_many;
mod point_load;
pub(crate) use point_load::PointLoad;

use super::ewald::{IMAGES, ORDERS, RemainderSeries};
use super::image_polynomials::{CENTRE, Centre};
use super::multipole::{Moments, product};
use super::patch_pairs::{PairTable, Sources};
use super::spot_field::{LANES, Place, Spot, SpotColumns, sag, spot_fields};
use super::{Interaction, Spots, Tangent};
use crate::cycle::Effort;
use crate::math::grown::Grown;
use crate::math::vector::dot;
use crate::model::{Boundary, Interaction as Kind, Material, Slips};
use multiversion::multiversion;
use std::sync::Arc;

/// Maximum number of asperities for a table of image sums: 32 bytes per pair, 32 MB in all.
pub(super) const TABLE_LIMIT: usize = 1000;

/// Sum over all pairs: exact field of the nearest image, multipole field of the other images.
#[derive(Debug, Clone)]
pub struct DirectSum {
    kind: Kind,
    boundary: Boundary,
    positions: Grown<[f64; 2]>,
    length: f64,
    pull: f64,
    sag: f64,
    /// `1/(πE*)` \[1/Pa\].
    compliance: f64,
    /// Image sums of every pair of asperities; empty if they are computed when needed.
    table: Arc<Vec<[f64; ORDERS]>>,
    /// True if six digits of the image sums are enough.
    rough: bool,
}

impl DirectSum {
    /// Asperities at `positions` \[m\] on the square of side `length_m`.
    ///
    /// Of `slips` only Eq 8 is used.
    #[must_use]
    pub fn new(
        positions: Vec<[f64; 2]>,
        length_m: f64,
        material: &Material,
        kind: Kind,
        boundary: Boundary,
        slips: Slips,
    ) -> Self {
        Self {
            kind,
            boundary,
            positions: positions.into(),
            length: length_m,
            pull: material.pull(),
            sag: sag(slips),
            compliance: material.compliance(),
            table: Arc::default(),
            rough: false,
        }
    }

    /// This sum with six digits of the image sums, without a table.
    pub(super) fn to_six_digits(&self) -> Self {
        Self { table: Arc::default(), rough: true, ..self.clone() }
    }

    /// Tabulates the image sums of every pair if there are at most `TABLE_LIMIT` asperities.
    #[must_use]
    pub fn with_table(self) -> Self {
        let (n, positions) = (self.positions.len(), &self.positions);
        if !self.is_periodic() || self.kind == Kind::None || n > TABLE_LIMIT {
            return self;
        }
        let mut table = vec![[0.0; ORDERS]; n * n];
        for i in 0..n {
            for j in 0..=i {
                let [dx, dy] = [0, 1].map(|k| {
                    let d = (positions[i][k] - positions[j][k]) / self.length;
                    d - d.round_ties_even()
                });
                let sums = IMAGES.sums(dx, dy);
                table[i * n + j] = sums;
                table[j * n + i] = sums;
            }
        }
        Self { table: Arc::new(table), ..self }
    }

    /// True if the image sums of every pair are tabulated.
    pub(super) fn has_table(&self) -> bool {
        !self.table.is_empty()
    }

    /// Adds an asperity at `place` \[m\] with the next number, and discards the table.
    pub(crate) fn add(&mut self, place: [f64; 2]) {
        self.table = Arc::default();
        self.positions.push(place);
    }

    /// Multipole moments of the spots, for the fields of their images.
    fn is_periodic(&self) -> bool {
        self.boundary == Boundary::Periodic
    }

    fn moments(&self, spots: &SpotColumns) -> Moments {
        Moments::of(self.kind, spots, self.pull, self.compliance, self.length)
    }

    /// A target or source at a position \[m\].
    fn place(&self, [x, y]: [f64; 2]) -> Place {
        let inverse_length = if self.is_periodic() { 1.0 / self.length } else { 0.0 };
        Place { x, y, length: self.length, inverse_length, pull: self.pull, sag: self.sag }
    }

    /// Displacement \[m\] by all spots at each of `targets`, and its derivatives to the radii of all spots.
    ///
    /// `visit` receives the index in `targets`, the displacement and the derivatives.
    pub(crate) fn rows(
        &self,
        spots: &Spots,
        targets: &[usize],
        effort: &mut Effort,
        mut visit: impl FnMut(usize, f64, &[f64]),
    ) {
        let n = spots.index.len();
        let mut slopes = vec![0.0; spots.columns.padded()];
        let moments = self.moments(&spots.columns);
        for (k, target) in targets.iter().enumerate() {
            let sum = self.row::<true>(spots, &moments, *target, &mut slopes);
            visit(k, sum, &slopes[..n]);
        }
        effort.pairs += (n * targets.len()) as u64;
    }

    /// Displacement \[m\] at a target by spots whose fields are added (1) or subtracted (−1).
    ///
    /// There must be no table of image sums: adding an asperity has discarded it.
    pub(crate) fn at_one(&self, spots: &[(f64, Spot)], target: usize) -> f64 {
        debug_assert!(!self.has_table());
        let by = |sign: f64| {
            let mut chosen = Spots::default();
            chosen.columns.set(spots.iter().filter(|(times, _)| *times == sign).map(|(_, spot)| *spot));
            sign * self.row::<false>(&chosen, &self.moments(&chosen.columns), target, &mut [])
        };
        by(1.0) + by(-1.0)
    }

    /// Displacements at the spots themselves, with derivatives to all radii row by row.
    ///
    /// The image sums have six digits.
    pub(crate) fn among(
        &self,
        spots: &Spots,
        table: &mut PairTable,
        fields: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
        effort: &mut Effort,
    ) {
        table.find(&spots.index, &self.positions, self.length, self.boundary);
        let moments = self.moments(&spots.columns);
        let Self { kind, compliance, pull, sag, .. } = *self;
        table.fields(
            Sources { kind, columns: &spots.columns, moments: &moments, compliance, pull, sag },
            fields,
            slopes,
        );
        effort.pairs += (spots.index.len() * spots.index.len()) as u64;
    }

    /// Displacement at asperity `target` by all spots.
    ///
    /// With `SLOPES`, also its derivatives to their radii.
    fn row<const SLOPES: bool>(
        &self,
        spots: &Spots,
        moments: &Moments,
        target: usize,
        slopes: &mut [f64],
    ) -> f64 {
        let columns = &spots.columns;
        let [x, y] = self.positions[target];
        let place = self.place([x, y]);
        let mut sum = match self.kind {
            Kind::None => {
                slopes.fill(0.0);
                return 0.0;
            }
            Kind::Spots => spot_fields::<SLOPES>(place, columns, slopes),
            Kind::Point => {
                let mut sum = 0.0;
                for (j, load) in columns.load[..columns.len()].iter().enumerate() {
                    let [dx, dy] = [x - columns.x[j], y - columns.y[j]]
                        .map(|d| d - self.length * (d * place.inverse_length).round_ties_even());
                    let r = dx.hypot(dy);
                    let unit = if r > 0.0 { self.compliance / r } else { 0.0 };
                    sum += load * unit;
                    if SLOPES {
                        slopes[j] = columns.load_slope[j] * unit;
                    }
                }
                sum
            }
        };
        if self.is_periodic() {
            let n = self.positions.len();
            sum += if self.rough {
                rough_image_fields::<SLOPES>(place, columns, moments, slopes)
            } else {
                match self.table.get(target * n..(target + 1) * n) {
                    Some(line) => known_image_fields::<SLOPES>(&spots.index, line, moments, slopes),
                    None => image_fields::<SLOPES>(place, columns, moments, slopes),
                }
            };
        }
        sum
    }
}

/// Field of all images but the nearest; adds its derivatives to `slopes`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn image_fields<const SLOPES: bool>(
    place: Place,
    spots: &SpotColumns,
    moments: &Moments,
    slopes: &mut [f64],
) -> f64 {
    let images: &RemainderSeries = &IMAGES;
    let columns = [&spots.x, &spots.y].map(|column| column.as_chunks::<LANES>().0);
    let mut all = [0.0; ORDERS];
    for (pass, (x, y)) in columns[0].iter().zip(columns[1]).enumerate() {
        let (dx, dy) = in_sides(place, x, y);
        let sums = images.local(&dx, &dy);
        let from = pass * LANES;
        for (sums, j) in sums.iter().zip(from..spots.len()) {
            gather(&mut all, sums, &moments.value[j]);
            if SLOPES {
                slopes[j] += product(sums, &moments.slope[j]);
            }
        }
    }
    all.iter().sum()
}

/// Field of all images but the nearest, with image sums of six digits.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn rough_image_fields<const SLOPES: bool>(
    place: Place,
    spots: &SpotColumns,
    moments: &Moments,
    slopes: &mut [f64],
) -> f64 {
    let centre: &Centre = &CENTRE;
    let columns = [&spots.x, &spots.y].map(|column| column.as_chunks::<LANES>().0);
    let mut sum = 0.0;
    for (pass, (x, y)) in columns[0].iter().zip(columns[1]).enumerate() {
        let (dx, dy) = in_sides(place, x, y);
        let [first, second] = centre.sums(&dx, &dy);
        let from = pass * LANES;
        for (k, j) in (from..spots.len().min(from + LANES)).enumerate() {
            sum += first[k].mul_add(moments.value[j][0], second[k] * moments.value[j][1]);
            if SLOPES {
                slopes[j] += first[k].mul_add(moments.slope[j][0], second[k] * moments.slope[j][1]);
            }
        }
    }
    sum
}

/// Field of all images but the nearest, with tabulated image sums.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn known_image_fields<const SLOPES: bool>(
    index: &[usize],
    line: &[[f64; ORDERS]],
    moments: &Moments,
    slopes: &mut [f64],
) -> f64 {
    let mut all = [[0.0; ORDERS]; 2];
    for (j, &source) in index.iter().enumerate() {
        gather(&mut all[j % 2], &line[source], &moments.value[j]);
        if SLOPES {
            slopes[j] += product(&line[source], &moments.slope[j]);
        }
    }
    all.iter().flatten().sum()
}

#[inline(always)]
fn gather(all: &mut [f64; ORDERS], sums: &[f64; ORDERS], moments: &[f64; ORDERS]) {
    for m in 0..ORDERS {
        all[m] = sums[m].mul_add(moments[m], all[m]);
    }
}

/// Components of the distances to the nearest images, in units of the side.
#[inline(always)]
fn in_sides(place: Place, x: &[f64; LANES], y: &[f64; LANES]) -> ([f64; LANES], [f64; LANES]) {
    let (mut dx, mut dy) = ([0.0; LANES], [0.0; LANES]);
    for k in 0..LANES {
        dx[k] = (place.x - x[k]) * place.inverse_length;
        dy[k] = (place.y - y[k]) * place.inverse_length;
        dx[k] -= dx[k].round_ties_even();
        dy[k] -= dy[k].round_ties_even();
    }
    (dx, dy)
}

impl Interaction for DirectSum {
    fn displacements(
        &self,
        spots: &Spots,
        targets: &[usize],
        displacements: &mut Vec<f64>,
        effort: &mut Effort,
    ) {
        displacements.clear();
        effort.pairs += (spots.index.len() * targets.len()) as u64;
        let moments = self.moments(&spots.columns);
        displacements
            .extend(targets.iter().map(|target| self.row::<false>(spots, &moments, *target, &mut [])));
    }

    fn linearise(
        &self,
        spots: &Spots,
        displacements: &mut Vec<f64>,
        tangent: &mut Tangent,
        effort: &mut Effort,
    ) {
        let n = spots.index.len();
        let mut matrix = tangent.take_dense(n);
        displacements.clear();
        self.rows(spots, &spots.index, effort, |k, sum, slopes| {
            displacements.push(sum);
            matrix[k * n..(k + 1) * n].copy_from_slice(slopes);
        });
        tangent.set_dense(n, matrix);
    }

    fn along_path(
        &self,
        spots: &Spots,
        rates: &[f64],
        targets: &[usize],
        found: [&mut Vec<f64>; 2],
        _kept: &mut Tangent,
        effort: &mut Effort,
    ) {
        let [displacements, slopes] = found;
        displacements.clear();
        slopes.clear();
        self.rows(spots, targets, effort, |_, sum, row| {
            displacements.push(sum);
            slopes.push(dot(row, rates));
        });
    }
}
