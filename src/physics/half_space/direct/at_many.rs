//! Displacement by few spots at many targets: lanes run over the targets.

use super::{DirectSum, in_sides};
use crate::model::Interaction as Kind;
use crate::physics::half_space::ewald::{IMAGES, ORDERS, RemainderSeries};
use crate::physics::half_space::multipole::{Moments, product};
use crate::physics::half_space::spot_field::{LANES, Place, Spot, SpotColumns, field, squared_distances};
use multiversion::multiversion;

/// Distance over radius from which a spot acts by its moments: their relative error is 6e-10 there, and falls with the eighth power of the distance.
const FAR: f64 = 8.0;

/// Targets as columns, padded to whole passes.
#[derive(Debug, Default)]
struct Targets {
    x: Vec<[f64; LANES]>,
    y: Vec<[f64; LANES]>,
}

impl DirectSum {
    /// Displacement \[m\] by spots at each of `targets`, without that of a spot at its own centre.
    ///
    /// The displacement by each spot is multiplied by the number beside it.
    pub(crate) fn at_many(&self, spots: &[(f64, Spot)], targets: &[usize]) -> Vec<f64> {
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
        let mut sources = SpotColumns::default();
        sources.set(spots.iter().map(|(_, spot)| *spot));
        let moments = Moments::of(self.kind, &sources, self.pull, self.compliance, self.length);
        let inverse_length = if self.periodic { 1.0 / self.length } else { 0.0 };
        for ((times, spot), moments) in spots.iter().zip(&moments.value) {
            let place = Place { x: spot.x, y: spot.y, length: self.length, inverse_length, pull: self.pull, sag: self.sag };
            let moments = moments.map(|moment| times * moment);
            match self.kind {
                Kind::None => {}
                Kind::Point => add_spot(place, None, &moments, &columns, &mut sums),
                Kind::Spots => add_spot(place, Some((*times, spot)), &moments, &columns, &mut sums),
            }
            if self.periodic && self.kind != Kind::None {
                add_images(place, &moments, &columns, &mut sums);
            }
        }
        sums.into_iter().flatten().take(targets.len()).collect()
    }
}

/// Adds the field of a spot: far from it, and without a `spot` everywhere, that of its moments.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_spot(place: Place, spot: Option<(f64, &Spot)>, moments: &[f64; ORDERS], targets: &Targets, sums: &mut [[f64; LANES]]) {
    let near = spot.map_or(0.0, |(_, spot)| (FAR * spot.a).powi(2));
    let (times, a, curvature) = spot.map_or((0.0, 0.0, 0.0), |(times, spot)| (times, spot.a, 1.0 / spot.radius));
    let (root, inverse_root) = (a.sqrt(), 1.0 / a.sqrt());
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let r2 = squared_distances(place, x, y);
        if r2.iter().any(|r2| *r2 < near) {
            let shape = (&[a; LANES], &[root; LANES], &[inverse_root; LANES], &[curvature; LANES]);
            let (value, _) = field(&r2, shape.0, shape.1, shape.2, shape.3, place.pull, place.sag);
            for k in 0..LANES {
                sum[k] += if r2[k] == 0.0 { 0.0 } else { times * value[k] };
            }
        } else {
            for k in 0..LANES {
                let inverse = if r2[k] == 0.0 { 0.0 } else { place.length / r2[k].sqrt() };
                let square = inverse * inverse;
                let more = square.mul_add(square.mul_add(moments[3], moments[2]), moments[1]);
                sum[k] += inverse * square.mul_add(more, moments[0]);
            }
        }
    }
}

/// Adds the field of all images but the nearest.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_images(place: Place, moments: &[f64; ORDERS], targets: &Targets, sums: &mut [[f64; LANES]]) {
    let images: &RemainderSeries = &IMAGES;
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let (dx, dy) = in_sides(place, x, y);
        for (sum, sums) in sum.iter_mut().zip(images.local(&dx, &dy)) {
            *sum += product(&sums, moments);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::DirectSum;
    use super::{Kind, Spot};
    use crate::model::{Boundary, Material, Slips};
    use crate::physics::half_space::{Effort, Interaction as _, Spots};

    #[test]
    fn law_lanes_over_targets_give_the_sums_over_sources() {
        let material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
        let positions: Vec<[f64; 2]> = (0..29).map(|k| [f64::from(k * 7 % 29) * 3e-5, f64::from(k * 11 % 29) * 3.4e-5]).collect();
        let spots = [(3, 2e-5), (17, 9e-6)].map(|(i, a): (usize, f64)| {
            let [x, y] = positions[i];
            (i, Spot { x, y, a, radius: 3e-5, load: -4e-6 * a / 2e-5, load_slope: 0.1 })
        });
        let targets: Vec<usize> = (0..29).collect();
        for kind in [Kind::Spots, Kind::Point, Kind::None] {
            for boundary in [Boundary::Periodic, Boundary::Isolated] {
                let sum = DirectSum::new(positions.clone(), 1e-3, &material, kind, boundary, Slips::NONE);
                let mut sources = Spots { index: spots.map(|(i, _)| i).to_vec(), ..Spots::default() };
                sources.columns.set(spots.iter().map(|(_, spot)| *spot));
                let mut wanted = Vec::new();
                sum.displacements(&sources, &targets, &mut wanted, &mut Effort::default());
                let found = sum.at_many(&spots.map(|(_, spot)| (1.0, spot)), &targets);
                // The order of summation differs. Far from a spot its moments are used; a point load has no others.
                let tolerance = if kind == Kind::Spots { 1e-9 } else { 1e-14 };
                let largest = wanted.iter().fold(0.0f64, |most, w| most.max(w.abs()));
                for (found, wanted) in found.iter().zip(&wanted) {
                    assert!((found - wanted).abs() <= tolerance * largest, "{kind:?} {boundary:?}: {found:e} {wanted:e}");
                }
                let signed = [(1.0, spots[0].1), (-1.0, spots[1].1)];
                for (target, wanted) in sum.at_many(&signed, &targets).into_iter().enumerate() {
                    let found = sum.at_one(&signed, target);
                    assert!((found - wanted).abs() <= tolerance * largest, "{kind:?} {boundary:?}: {found:e} {wanted:e}");
                }
            }
        }
    }
}
