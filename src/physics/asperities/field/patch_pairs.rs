//! Pair distances of a local problem: computed once, reused for all its evaluations.

use super::image_polynomials::{CENTRE, Centre};
use super::multipole::Moments;
use super::spot_field::{AWAY, LANES, SpotColumns, field_at};
use crate::math::grown::Grown;
use crate::model::{Boundary, Interaction as Kind};
use multiversion::multiversion;

/// All pairs of a set of asperities: distance \[m\], its inverse, and the image sums of the first two orders.
///
/// The image sums are in units of the side. Rows are padded to whole passes.
#[derive(Debug, Clone, Default)]
pub(crate) struct PairTable {
    index: Vec<usize>,
    passes: Vec<Pass>,
}

#[derive(Debug, Clone, Copy)]
struct Pass {
    r: [f64; LANES],
    inverse_r: [f64; LANES],
    images: [[f64; LANES]; 2],
}

impl PairTable {
    /// Computes the pairs of the asperities `index` if the set has changed.
    ///
    /// `positions` are in m, and the image sums have six digits.
    pub(crate) fn find(
        &mut self,
        index: &[usize],
        positions: &Grown<[f64; 2]>,
        length: f64,
        boundary: Boundary,
    ) {
        if self.index != index {
            self.index.clear();
            self.index.extend_from_slice(index);
            self.passes.clear();
            find(self, positions, length, boundary);
        }
    }

    /// Displacements at all asperities, and their derivatives to all radii row by row.
    pub(crate) fn fields(&self, by: Sources<'_>, fields: &mut Vec<f64>, slopes: &mut Vec<f64>) {
        evaluate(self, by, fields, slopes);
    }
}

/// Sources of the displacement field.
#[derive(Clone, Copy)]
pub(crate) struct Sources<'a> {
    pub(crate) kind: Kind,
    pub(crate) columns: &'a SpotColumns,
    pub(crate) moments: &'a Moments,
    /// `1/(πE*)` \[1/Pa\].
    pub(crate) compliance: f64,
    pub(crate) pull: f64,
    pub(crate) sag: f64,
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn find(table: &mut PairTable, positions: &Grown<[f64; 2]>, length: f64, boundary: Boundary) {
    let periodic = boundary == Boundary::Periodic;
    let centre: &Centre = &CENTRE;
    for &target in &table.index {
        let [x, y] = positions[target];
        for sources in table.index.chunks(LANES) {
            let (mut dx, mut dy, mut r) = ([0.0; LANES], [0.0; LANES], [AWAY; LANES]);
            for (k, source) in sources.iter().enumerate() {
                [dx[k], dy[k]] = [x - positions[*source][0], y - positions[*source][1]];
            }
            if periodic {
                for k in 0..LANES {
                    dx[k] -= length * (dx[k] / length).round_ties_even();
                    dy[k] -= length * (dy[k] / length).round_ties_even();
                }
            }
            for (k, source) in sources.iter().enumerate() {
                // A spot does not act on its own centre: its distance there stays at `AWAY`.
                if *source != target {
                    r[k] = dx[k].mul_add(dx[k], dy[k] * dy[k]).sqrt();
                }
            }
            let images = if periodic {
                centre.sums(&dx.map(|d| d / length), &dy.map(|d| d / length))
            } else {
                [[0.0; LANES]; 2]
            };
            table.passes.push(Pass { r, inverse_r: r.map(|r| 1.0 / r), images });
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn evaluate(table: &PairTable, by: Sources<'_>, fields: &mut Vec<f64>, slopes: &mut Vec<f64>) {
    let n = table.index.len();
    let columns = [&by.columns.a, &by.columns.root_a, &by.columns.inverse_root_a, &by.columns.inverse_radius];
    let [a, root_a, inverse_root_a, inverse_radius] = columns.map(|column| column.as_chunks::<LANES>().0);
    let [load, load_slope] =
        [&by.columns.load, &by.columns.load_slope].map(|column| column.as_chunks::<LANES>().0);
    let moments: Vec<[[f64; LANES]; 4]> =
        (0..n.div_ceil(LANES)).map(|pass| first_moments(by.moments, pass * LANES, n)).collect();
    fields.clear();
    // Whole passes are written, each over the padding of the one before.
    slopes.clear();
    slopes.resize(n * n + LANES, 0.0);
    for (target, row) in table.passes.chunks(n.div_ceil(LANES).max(1)).enumerate() {
        let mut sums = [0.0; LANES];
        for (pass, (pairs, [values, second_values, rates, second_rates])) in
            row.iter().zip(&moments).enumerate()
        {
            let (mut field, mut slope) = ([0.0; LANES], [0.0; LANES]);
            match by.kind {
                Kind::None => {}
                Kind::Point => {
                    for k in 0..LANES {
                        field[k] = load[pass][k] * by.compliance * pairs.inverse_r[k];
                        slope[k] = load_slope[pass][k] * by.compliance * pairs.inverse_r[k];
                    }
                }
                Kind::Spots => {
                    let shape = (&a[pass], &root_a[pass], &inverse_root_a[pass], &inverse_radius[pass]);
                    (field, slope) = field_at(
                        &pairs.r,
                        &pairs.inverse_r,
                        shape.0,
                        shape.1,
                        shape.2,
                        shape.3,
                        by.pull,
                        by.sag,
                    );
                }
            }
            for k in 0..LANES {
                field[k] += pairs.images[0][k].mul_add(values[k], pairs.images[1][k] * second_values[k]);
                slope[k] += pairs.images[0][k].mul_add(rates[k], pairs.images[1][k] * second_rates[k]);
                sums[k] += field[k];
            }
            slopes[target * n + pass * LANES..][..LANES].copy_from_slice(&slope);
        }
        fields.push(sums.iter().sum());
    }
    slopes.truncate(n * n);
}

/// First two moments of the sources `from` to `n` in one pass, and their derivatives to the radii; 0 for the
/// padding.
#[inline(always)]
fn first_moments(moments: &Moments, from: usize, n: usize) -> [[f64; LANES]; 4] {
    let mut first = [[0.0; LANES]; 4];
    for (lane, j) in (from..n.min(from + LANES)).enumerate() {
        for order in 0..2 {
            first[order][lane] = moments.value[j][order];
            first[2 + order][lane] = moments.slope[j][order];
        }
    }
    first
}
