//! Displacement by one point load at many targets: the effect of an event far from it.

use super::at_many::Targets;
use super::{DirectSum, in_sides};
use crate::physics::half_space::image_polynomials::{CENTRE, Centre};
use crate::physics::half_space::spot_field::{LANES, Place, squared_distances};
use multiversion::multiversion;

impl DirectSum {
    /// Displacement \[m\] at each of `targets` farther than `reach` \[m\] from a load \[N\] at `place` \[m\], by the load and its images; 0 at the others.
    ///
    /// The image sums have six digits.
    pub(crate) fn far_from_load(&self, load: f64, place: &[f64; 2], reach: f64, targets: &[usize]) -> Vec<f64> {
        self.of_load(load, place, Part::Beyond(reach), targets)
    }

    /// Displacement \[m\] at each of `targets` by all images but the nearest of a load \[N\] at `place` \[m\], to six digits.
    pub(crate) fn images_of_load(&self, load: f64, place: &[f64; 2], targets: &[usize]) -> Vec<f64> {
        self.of_load(load, place, Part::Images, targets)
    }

    fn of_load(&self, load: f64, place: &[f64; 2], part: Part, targets: &[usize]) -> Vec<f64> {
        let mut columns = Targets::default();
        columns.set(targets.iter().map(|target| self.positions[*target]));
        let moment = load * self.compliance / self.length;
        let mut sums = vec![[0.0; LANES]; columns.x.len()];
        load_fields(self.place(*place), moment, (part, self.periodic), &columns, &mut sums);
        sums.as_flattened()[..targets.len()].to_vec()
    }
}

/// Square of the distance over that of the reach from which a target is beyond it: rounding must not decide on one at the reach itself.
const BEYOND: f64 = 1.0 + 1e-12;

/// Part of the displacement that is wanted.
#[derive(Debug, Clone, Copy)]
enum Part {
    /// The load and its images, at targets farther than this \[m\].
    Beyond(f64),
    /// The images.
    Images,
}

/// Fields of a load of this moment \[m\] at targets, with images if `periodic`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn load_fields(place: Place, moment: f64, (part, periodic): (Part, bool), targets: &Targets, sums: &mut [[f64; LANES]]) {
    let centre: &Centre = &CENTRE;
    for ((x, y), sum) in targets.x.iter().zip(&targets.y).zip(sums) {
        if periodic {
            let (dx, dy) = in_sides(place, x, y);
            *sum = centre.first(&dx, &dy).map(|images| moment * images);
        }
        if let Part::Beyond(reach) = part {
            let r2 = squared_distances(place, x, y);
            for k in 0..LANES {
                sum[k] = if r2[k] > BEYOND * reach * reach { sum[k] + moment * place.length / r2[k].sqrt() } else { 0.0 };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::DirectSum;
    use crate::model::{Boundary, Interaction as Kind, Material, Slips};
    use crate::physics::half_space::spot_field::Spot;

    #[test]
    fn law_the_field_of_a_load_is_that_of_a_point() {
        let material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.07, interaction_range_m: 1e-9 };
        let positions: Vec<[f64; 2]> = (0..29).map(|k| [f64::from(k * 7 % 29) * 3e-5, f64::from(k * 11 % 29) * 3.4e-5]).collect();
        let (at, load, reach) = (positions[5], 4e-6, 2e-4);
        let spot = Spot { x: at[0], y: at[1], a: 1e-6, radius: 3e-5, load, load_slope: 0.1 };
        let targets: Vec<usize> = (0..29).collect();
        let sum = |boundary| DirectSum::new(positions.clone(), 1e-3, &material, Kind::Point, boundary, Slips::NONE);
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
                // Six digits of the images, of at most four times the displacement of the load at half a side.
                assert!((found - wanted).abs() <= 1e-5 * wanted.abs(), "{boundary:?}: {found:e} {wanted:e}");
            }
        }
        // Where the nearest image is the load itself, the images are the difference of the two squares.
        let images = sum(Boundary::Periodic).images_of_load(load, &at, &targets);
        for ((found, place), whole) in images.iter().zip(&positions).zip(periodic.iter().zip(&free)) {
            if (0..2).all(|k| (place[k] - at[k]).abs() < 5e-4) {
                assert!((found - (whole.0 - whole.1)).abs() <= 1e-5 * found.abs(), "{found:e} {whole:?}");
            }
        }
        assert!(sum(Boundary::Isolated).images_of_load(load, &at, &targets).iter().all(|found| *found == 0.0));
    }
}
