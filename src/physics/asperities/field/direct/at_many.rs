//! Displacement by few spots at many targets: lanes run over the targets.

use super::{DirectSum, in_sides};
use crate::asperities::field::ewald::ORDERS;
use crate::asperities::field::image_polynomials::ImageField;
use crate::asperities::field::spot_field::{LANES, Place, Spot, SpotColumns, field, squared_distances};
use crate::model::Interaction as Kind;
use multiversion::multiversion;

/// Distance over radius from which a spot acts by its moments: their relative error is 6e-10 there, and falls
/// with the eighth power of the distance.
const FAR: f64 = 8.0;

/// Targets of one block: their columns stay in the fastest cache for all spots.
const BLOCK: usize = 64 * LANES;

/// Targets as columns, padded to whole passes.
#[derive(Debug, Default)]
pub(super) struct Targets {
    pub(super) x: Vec<[f64; LANES]>,
    pub(super) y: Vec<[f64; LANES]>,
}

impl Targets {
    /// Replaces the columns by these places.
    pub(super) fn set(&mut self, places: impl ExactSizeIterator<Item = [f64; 2]>) {
        let passes = places.len().div_ceil(LANES);
        for column in [&mut self.x, &mut self.y] {
            column.clear();
            column.resize(passes, [0.0; LANES]);
        }
        for (k, [x, y]) in places.enumerate() {
            (self.x[k / LANES][k % LANES], self.y[k / LANES][k % LANES]) = (x, y);
        }
    }
}

/// A spot as a source: its field near and far from it, and that of its images.
struct Source<'a> {
    place: Place,
    /// The spot and its factor; nothing for point loads, which have only moments.
    near: Option<(f64, &'a Spot)>,
    moments: [f64; ORDERS],
    images: Option<ImageField>,
}

impl Source<'_> {
    /// Adds its field at the targets.
    fn add(&self, targets: &Targets, sums: &mut [[f64; LANES]]) {
        add_spot(self.place, self.near, &self.moments, targets, sums);
        if let Some(images) = &self.images {
            add_images(self.place, images, targets, sums);
        }
    }
}

impl DirectSum {
    /// Displacement \[m\] by spots at each of `targets`, without that of a spot at its own centre; by number,
    /// 0 elsewhere.
    ///
    /// The displacement by each spot is multiplied by its factor in `spots`.
    pub(crate) fn at_many(
        &self,
        spots: &[(f64, Spot)],
        mut targets: impl Iterator<Item = usize>,
    ) -> Vec<f64> {
        let mut found = vec![0.0; self.positions.len()];
        if self.kind == Kind::None {
            return found;
        }
        let sources = self.sources(spots);
        let (mut block, mut columns, mut sums) = (Vec::with_capacity(BLOCK), Targets::default(), Vec::new());
        loop {
            block.clear();
            block.extend(targets.by_ref().take(BLOCK));
            if block.is_empty() {
                return found;
            }
            columns.set(block.iter().map(|target| self.positions[*target]));
            sums.clear();
            sums.resize(columns.x.len(), [0.0; LANES]);
            for source in &sources {
                source.add(&columns, &mut sums);
            }
            for (target, sum) in block.iter().zip(sums.as_flattened()) {
                found[*target] = *sum;
            }
        }
    }

    /// The spots as sources.
    fn sources<'a>(&self, spots: &'a [(f64, Spot)]) -> Vec<Source<'a>> {
        let mut columns = SpotColumns::default();
        columns.set(spots.iter().map(|(_, spot)| *spot));
        let moments = self.moments(&columns);
        let source = |((times, spot), moments): (&'a (f64, Spot), &[f64; ORDERS])| {
            let moments = moments.map(|moment| times * moment);
            let near = (self.kind == Kind::Spots).then_some((*times, spot));
            Source {
                place: self.place([spot.x, spot.y]),
                near,
                moments,
                images: self.is_periodic().then(|| ImageField::of(&moments)),
            }
        };
        spots.iter().zip(&moments.value).map(source).collect()
    }
}

/// Adds the field of a spot: far from it, and without a `spot` everywhere, that of its moments.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_spot(
    place: Place,
    spot: Option<(f64, &Spot)>,
    moments: &[f64; ORDERS],
    targets: &Targets,
    sums: &mut [[f64; LANES]],
) {
    let near = spot.map_or(0.0, |(_, spot)| (FAR * spot.a).powi(2));
    let (times, a, curvature) =
        spot.map_or((0.0, 0.0, 0.0), |(times, spot)| (times, spot.a, 1.0 / spot.radius));
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
fn add_images(place: Place, images: &ImageField, targets: &Targets, sums: &mut [[f64; LANES]]) {
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let (dx, dy) = in_sides(place, x, y);
        let found = images.at(&dx, &dy);
        for k in 0..LANES {
            sum[k] += found[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::DirectSum;
    use super::{Kind, Spot};
    use crate::asperities::field::{Interaction as _, Spots};
    use crate::cycle::Effort;
    use crate::model::{Boundary, Material, Slips};

    #[test]
    fn law_lanes_over_targets_give_the_sums_over_sources() {
        let material =
            Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
        let positions: Vec<[f64; 2]> =
            (0..29).map(|k| [f64::from(k * 7 % 29) * 3e-5, f64::from(k * 11 % 29) * 3.4e-5]).collect();
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
                let found = sum.at_many(&spots.map(|(_, spot)| (1.0, spot)), 0..29);
                // Far from a spot its moments are used, and of the fields of the images a polynomial; point
                // loads have only one moment.
                let tolerance =
                    if kind == Kind::Spots || boundary == Boundary::Periodic { 1e-9 } else { 1e-14 };
                let largest = wanted.iter().fold(0.0f64, |most, w| most.max(w.abs()));
                for (found, wanted) in found.iter().zip(&wanted) {
                    assert!(
                        (found - wanted).abs() <= tolerance * largest,
                        "{kind:?} {boundary:?}: {found:e} {wanted:e}"
                    );
                }
                let signed = [(1.0, spots[0].1), (-1.0, spots[1].1)];
                for (target, wanted) in sum.at_many(&signed, 0..29).into_iter().enumerate() {
                    let found = sum.at_one(&signed, target);
                    assert!(
                        (found - wanted).abs() <= tolerance * largest,
                        "{kind:?} {boundary:?}: {found:e} {wanted:e}"
                    );
                }
            }
        }
    }
}
