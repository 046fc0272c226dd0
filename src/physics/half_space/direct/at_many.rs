//! Displacement by few spots at many targets: lanes run over the targets.

use super::DirectSum;
use crate::model::Interaction as Kind;
use crate::physics::half_space::multipole::Moments;
use crate::physics::half_space::rough_images::{CENTRE, Centre};
use crate::physics::half_space::spot_field::{LANES, Place, Spot, SpotColumns, field};
use multiversion::multiversion;

/// Targets as columns, padded to whole passes.
#[derive(Debug, Default)]
struct Targets {
    x: Vec<[f64; LANES]>,
    y: Vec<[f64; LANES]>,
}

impl DirectSum {
    /// Displacement \[m\] by spots at each of `targets`, without that of a spot at its own centre. The image sums have six digits.
    pub(crate) fn at_many(&self, spots: &[Spot], targets: &[usize]) -> Vec<f64> {
        let mut columns = Targets::default();
        for chunk in targets.chunks(LANES) {
            let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
            for (k, target) in chunk.iter().enumerate() {
                [x[k], y[k]] = self.positions[*target];
            }
            columns.x.push(x);
            columns.y.push(y);
        }
        let mut sums = vec![[0.0; LANES]; columns.x.len()];
        for spot in spots {
            let mut column = SpotColumns::default();
            column.set(std::iter::once(*spot));
            let moments = Moments::of(self.kind, &column, self.pull, self.compliance, self.length);
            let inverse_length = if self.periodic { 1.0 / self.length } else { 0.0 };
            let place = Place { x: spot.x, y: spot.y, length: self.length, inverse_length, pull: self.pull, sag: self.sag };
            match self.kind {
                Kind::None => {}
                Kind::Point => add_point(place, self.compliance * spot.load, &columns, &mut sums),
                Kind::Spots => add_spot(place, spot, &columns, &mut sums),
            }
            if self.periodic && self.kind != Kind::None {
                add_images(place, [moments.value[0][0], moments.value[0][1]], &columns, &mut sums);
            }
        }
        sums.into_iter().flatten().take(targets.len()).collect()
    }
}

/// Squared distances of a pass of targets to the nearest image of a spot.
#[inline(always)]
fn squares(place: Place, x: &[f64; LANES], y: &[f64; LANES]) -> [f64; LANES] {
    let mut r2 = [0.0; LANES];
    for k in 0..LANES {
        let (dx, dy) = (x[k] - place.x, y[k] - place.y);
        let dx = dx - place.length * (dx * place.inverse_length).round_ties_even();
        let dy = dy - place.length * (dy * place.inverse_length).round_ties_even();
        r2[k] = dx.mul_add(dx, dy * dy);
    }
    r2
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_spot(place: Place, spot: &Spot, targets: &Targets, sums: &mut [[f64; LANES]]) {
    let root = spot.a.sqrt();
    let (a, root_a, inverse_root_a) = ([spot.a; LANES], [root; LANES], [1.0 / root; LANES]);
    let curvature = [1.0 / spot.radius; LANES];
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let r2 = squares(place, x, y);
        let (value, _) = field(&r2, &a, &root_a, &inverse_root_a, &curvature, place.pull, place.sag);
        for k in 0..LANES {
            sum[k] += if r2[k] == 0.0 { 0.0 } else { value[k] };
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_point(place: Place, strength: f64, targets: &Targets, sums: &mut [[f64; LANES]]) {
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let r2 = squares(place, x, y);
        for k in 0..LANES {
            sum[k] += if r2[k] == 0.0 { 0.0 } else { strength / r2[k].sqrt() };
        }
    }
}

/// Adds the field of all images but the nearest.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_images(place: Place, moments: [f64; 2], targets: &Targets, sums: &mut [[f64; LANES]]) {
    let centre: &Centre = &CENTRE;
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let (mut dx, mut dy) = ([0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            dx[k] = (x[k] - place.x) * place.inverse_length;
            dy[k] = (y[k] - place.y) * place.inverse_length;
            dx[k] -= dx[k].round_ties_even();
            dy[k] -= dy[k].round_ties_even();
        }
        let [first, second] = centre.sums(&dx, &dy);
        for k in 0..LANES {
            sum[k] += first[k].mul_add(moments[0], second[k] * moments[1]);
        }
    }
}
