//! Displacement by point loads at many targets: the effect of an event on the contacts around it.

use super::at_many::Targets;
use super::{DirectSum, in_sides};
use crate::asperities::field::image_polynomials::{CENTRE, Centre};
use crate::asperities::field::spot_field::{LANES, Place, squared_distances};
use crate::math::vector::nearest_image;
use multiversion::multiversion;

impl DirectSum {
    /// Displacement \[m\] at each of `targets` farther than `reach` \[m\] from a load \[N\] at `place` \[m\],
    /// by the load and its images; 0 at the others.
    ///
    /// The image sums have six digits.
    pub(crate) fn far_from_load(
        &self,
        load: f64,
        place: &[f64; 2],
        reach: f64,
        targets: &[usize],
    ) -> Vec<f64> {
        let columns = self.columns(targets);
        let (place, moment) = (self.place(*place), self.moment(load));
        let mut sums = vec![[0.0; LANES]; columns.x.len()];
        if self.is_periodic() {
            image_fields(place, moment, &columns, &mut sums);
            leave_out(place, BEYOND.sqrt() * reach, &columns, &mut sums);
        }
        load_field(place, moment, BEYOND.sqrt() * reach, &columns, &mut sums);
        sums.as_flattened()[..targets.len()].to_vec()
    }

    /// Displacement \[m\] at each of `targets` by loads next to one another, each where the target is farther
    /// than its reach, and by the images of their sum at `centre` \[m\].
    ///
    /// The image sums have six digits.
    pub(crate) fn of_loads(&self, loads: &[PointLoad], centre: &[f64; 2], targets: &[usize]) -> Vec<f64> {
        let mut images = vec![[0.0; LANES]; targets.len().div_ceil(LANES)];
        if self.is_periodic() {
            let whole: f64 = loads.iter().map(|load| load.load_n).sum();
            image_fields(self.place(*centre), self.moment(whole), &self.columns(targets), &mut images);
        }
        let mut near = vec![[0.0; SHORT_LANES]; targets.len().div_ceil(SHORT_LANES)];
        let side = if self.is_periodic() { 1.0 } else { 0.0 };
        load_fields(&self.short_loads(loads, centre), &self.short_columns(targets, centre), side, &mut near);
        let near = near.as_flattened().iter().copied().map(f64::from);
        images.as_flattened()[..targets.len()].iter().zip(near).map(|(images, near)| images + near).collect()
    }

    /// Vector from a centre \[m\] to the nearest image of a place, in sides.
    fn vector_from(&self, place: &[f64; 2], centre: &[f64; 2]) -> [f32; 2] {
        [0, 1].map(|k| {
            let share = (place[k] - centre[k]) / self.length;
            (if self.is_periodic() { nearest_image(share, 1.0) } else { share }) as f32
        })
    }

    fn short_loads(&self, loads: &[PointLoad], centre: &[f64; 2]) -> Vec<ShortLoad> {
        let short = |load: &PointLoad| ShortLoad {
            place: self.vector_from(&load.place, centre),
            moment: self.moment(load.load_n) as f32,
            reach: (load.reach_m / self.length) as f32,
        };
        loads.iter().map(short).collect()
    }

    fn short_columns(&self, targets: &[usize], centre: &[f64; 2]) -> Vec<[[f32; SHORT_LANES]; 2]> {
        let mut columns = vec![[[0.0; SHORT_LANES]; 2]; targets.len().div_ceil(SHORT_LANES)];
        for (k, target) in targets.iter().enumerate() {
            let [x, y] = self.vector_from(&self.positions[*target], centre);
            let [xs, ys] = &mut columns[k / SHORT_LANES];
            (xs[k % SHORT_LANES], ys[k % SHORT_LANES]) = (x, y);
        }
        columns
    }

    fn columns(&self, targets: &[usize]) -> Targets {
        let mut columns = Targets::default();
        columns.set(targets.iter().map(|target| self.positions[*target]));
        columns
    }

    /// Displacement by a load \[N\] at a distance of one side \[m\].
    fn moment(&self, load: f64) -> f64 {
        load * self.compliance / self.length
    }
}

/// Square of the distance over that of the reach from which a target is beyond it: rounding must not decide
/// on one at the reach itself.
const BEYOND: f64 = 1.0 + 1e-12;

/// A load, and the distance beyond which it acts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointLoad {
    pub(crate) place: [f64; 2],
    pub(crate) load_n: f64,
    pub(crate) reach_m: f64,
}

/// Number of targets at once in single precision.
const SHORT_LANES: usize = 16;

/// [`PointLoad`] in single precision: place from the centre and reach in sides, and moment \[m\].
struct ShortLoad {
    place: [f32; 2],
    moment: f32,
    reach: f32,
}

/// Fields of loads at targets, each beyond the reach of the load, with periodic images at a distance of
/// `side`, or none at 0. Places from a centre have seven digits, displacements five or more: next to a load,
/// its field as a point has two.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn load_fields(
    loads: &[ShortLoad],
    targets: &[[[f32; SHORT_LANES]; 2]],
    side: f32,
    sums: &mut [[f32; SHORT_LANES]],
) {
    for ([x, y], sums) in targets.iter().zip(sums) {
        let mut sum = [0.0; SHORT_LANES];
        for load in loads {
            for k in 0..SHORT_LANES {
                let (dx, dy) = (x[k] - load.place[0], y[k] - load.place[1]);
                let (dx, dy) = (dx - side * dx.round_ties_even(), dy - side * dy.round_ties_even());
                let r2 = dx.mul_add(dx, dy * dy);
                sum[k] += if r2 > load.reach * load.reach { load.moment / r2.sqrt() } else { 0.0 };
            }
        }
        *sums = sum;
    }
}

/// Adds the field of a load of this moment \[m\] at targets farther than `reach` \[m\], with seven digits.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn load_field(place: Place, moment: f64, reach: f64, targets: &Targets, sums: &mut [[f64; LANES]]) {
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let r2 = squared_distances(place, x, y);
        for k in 0..LANES {
            let inverse_r = f64::from(1.0 / (r2[k] as f32).sqrt());
            sum[k] += if r2[k] > reach * reach { moment * place.length * inverse_r } else { 0.0 };
        }
    }
}

/// Adds the field of the images of a load of this moment \[m\].
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn image_fields(place: Place, moment: f64, targets: &Targets, sums: &mut [[f64; LANES]]) {
    let centre: &Centre = &CENTRE;
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let (dx, dy) = in_sides(place, x, y);
        let images = centre.first(&dx, &dy);
        for k in 0..LANES {
            sum[k] += moment * images[k];
        }
    }
}

/// Sets the field to zero at targets that are not farther than `reach` \[m\].
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn leave_out(place: Place, reach: f64, targets: &Targets, sums: &mut [[f64; LANES]]) {
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        let r2 = squared_distances(place, x, y);
        for k in 0..LANES {
            if r2[k] <= reach * reach {
                sum[k] = 0.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::DirectSum;
    use super::PointLoad;
    use crate::asperities::field::spot_field::Spot;
    use crate::model::{Boundary, Interaction as Kind, Material, Slips};

    #[test]
    fn law_the_field_of_a_load_is_that_of_a_point() {
        let material =
            Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
        let positions: Vec<[f64; 2]> =
            (0..29).map(|k| [f64::from(k * 7 % 29) * 3e-5, f64::from(k * 11 % 29) * 3.4e-5]).collect();
        let (at, load, reach) = (positions[5], 4e-6, 2e-4);
        let spot = Spot { x: at[0], y: at[1], a: 1e-6, radius: 3e-5, load, load_slope: 0.1 };
        let targets: Vec<usize> = (0..29).collect();
        let sum =
            |boundary| DirectSum::new(positions.clone(), 1e-3, &material, Kind::Point, boundary, Slips::NONE);
        let free = sum(Boundary::Isolated).at_many(&[(1.0, spot)], 0..29);
        let periodic = sum(Boundary::Periodic).at_many(&[(1.0, spot)], 0..29);
        for (boundary, wanted) in [(Boundary::Isolated, &free), (Boundary::Periodic, &periodic)] {
            let found = sum(boundary).far_from_load(load, &at, reach, &targets);
            for ((found, wanted), place) in found.iter().zip(wanted).zip(&positions) {
                let apart = [0, 1].map(|k| {
                    let d: f64 = place[k] - at[k];
                    if boundary == Boundary::Periodic { d - 1e-3 * (d / 1e-3).round() } else { d }
                });
                let wanted = if apart[0].hypot(apart[1]) > reach { *wanted } else { 0.0 };
                // Six digits of the images, of at most four times the displacement of the load at half a
                // side.
                assert!((found - wanted).abs() <= 1e-5 * wanted.abs(), "{boundary:?}: {found:e} {wanted:e}");
            }
        }
        // Of two loads at one place, only the one with a short reach acts within the long one, and both
        // images do.
        let share = |load_n: f64, reach_m: f64| PointLoad { place: at, load_n, reach_m };
        let loads = [share(0.25 * load, 0.0), share(0.75 * load, reach)];
        let found = sum(Boundary::Periodic).of_loads(&loads, &at, &targets);
        let near = sum(Boundary::Periodic).far_from_load(load, &at, reach, &targets);
        for (((found, place), whole), near) in
            found.iter().zip(&positions).zip(periodic.iter().zip(&free)).zip(&near)
        {
            // Where the nearest image is the load itself, the images are the difference of the two squares.
            if *place != at && (0..2).all(|k| (place[k] - at[k]).abs() < 5e-4) {
                let acting = if *near == 0.0 { 0.25 } else { 1.0 };
                let wanted = whole.0 - whole.1 + acting * whole.1;
                assert!((found - wanted).abs() <= 1e-5 * wanted.abs(), "{found:e} {whole:?}");
            }
        }
    }
}
