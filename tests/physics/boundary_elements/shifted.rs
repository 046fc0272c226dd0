//! Grids whose points are shifted by a part of their spacing.

use crate::support::{Dice, close};
use hysteron::physics::elements::{Elements, Options};
use hysteron::physics::model::Material;
use hysteron::physics::surface::HeightMap;
use ndarray::Array2;
use std::f64::consts::TAU;

/// Waves of a band-limited surface: wavenumbers along x and y, and phase.
fn waves() -> Vec<([f64; 2], f64)> {
    let mut dice = Dice(5);
    let numbers = [[1.0, 0.0], [0.0, 1.0], [2.0, -1.0], [-3.0, 2.0], [1.0, 3.0]];
    numbers.into_iter().map(|q| (q, TAU * dice.roll())).collect()
}

/// Height at a place, in sides of the square; each wave has the amplitude `amplitude_m`.
fn height(amplitude_m: f64, [x, y]: [f64; 2]) -> f64 {
    waves().into_iter().map(|([u, v], phase)| amplitude_m * (TAU * (u * x + v * y) + phase).cos()).sum()
}

/// The heights of a shifted grid are those of the surface at the shifted places, to the rounding of the transforms, on coarser, equal and
/// finer grids than that of the surface. Places of points and asperities follow.
#[test]
fn law_a_shifted_grid_has_the_heights_at_its_places() {
    let (count, length_m, amplitude_m) = (16, 1e-3, 1e-6);
    let at = |k: usize, n: usize, shift: f64| (k as f64 + shift) / n as f64;
    let heights = Array2::from_shape_fn((count, count), |(i, j)| height(amplitude_m, [at(i, count, 0.0), at(j, count, 0.0)]));
    let rms_height_m = heights.iter().map(|z| z * z).sum::<f64>().sqrt() / count as f64;
    let map = HeightMap { heights_m: heights.view(), length_m, is_periodic: true, shortest_wavelength_m: length_m / 4.0, rms_height_m };
    for points in [8, 12, 16, 32] {
        for shift in [0.0, 0.25, 0.5, 7.0 / 9.0] {
            let options = Options { points, shift, ..Options::default() };
            let found = Elements::new(&map, &Material::default(), &[0.01], &options).unwrap();
            let spacing_m = length_m / points as f64;
            close("first point", found.units.first_m, shift * spacing_m, 1e-15);
            let wanted: Vec<f64> =
                (0..points * points).map(|k| height(amplitude_m, [at(k / points, points, shift), at(k % points, points, shift)])).collect();
            let top = wanted.iter().copied().fold(f64::MIN, f64::max);
            for (got, want) in found.problem.heights.iter().zip(wanted) {
                let error_m = got * spacing_m - (want - top);
                assert!(error_m.abs() < 1e-12 * rms_height_m, "{points} {shift}: {error_m}");
            }
            // An asperity half a spacing before the first point is at the last one, or at the first if it is closer.
            let found = found.with_summits([[0.0, 0.0]]);
            let place = if shift > 0.5 { points - 1 } else { 0 };
            assert!(shift == 0.5 || found.settings.summits == [place * points + place], "{points} {shift}");
        }
    }
}
