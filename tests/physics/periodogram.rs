//! The spectrum that a surface has.

use hysteron::model::{Amplitudes, Normalization};
use hysteron::physics::surface::periodogram::periodogram;
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use ndarray::Array2;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

#[test]
fn law_the_periodogram_of_a_synthetic_surface_is_the_spectrum_that_it_was_made_from() {
    for n in [128, 250] {
        let spectrum = Spectrum {
            length_m: 1e-3,
            rms_height_m: 5e-6,
            hurst: 0.7,
            magnification: 40,
            normalization: Normalization::Spectrum,
            amplitudes: Amplitudes::Fixed,
            shape: Shape::default(),
        };
        let surface = synthesize(&spectrum, &realization_seed(7, 1), n);
        let found = periodogram(surface.heights_m.view(), spectrum.length_m).unwrap();
        // The same rings, over all wavevectors of the disc one by one.
        let mut rings: BTreeMap<i64, (f64, f64, u64)> = BTreeMap::new();
        let reach = n as i64 / 2;
        for kx in -reach..=reach {
            for ky in -reach..=reach {
                let squared = (kx * kx + ky * ky) as u64;
                if squared > 0 && squared < (reach * reach) as u64 {
                    let mode = (squared as f64).sqrt();
                    let ring = rings.entry((4.0 * mode.log2()).round() as i64).or_default();
                    *ring = (ring.0 + mode, ring.1 + spectrum.density(squared), ring.2 + 1);
                }
            }
        }
        assert_eq!(found.len(), rings.len());
        let unit = TAU / spectrum.length_m;
        let mut variance = 0.0;
        for (ring, (modes, density, count)) in found.iter().zip(rings.into_values()) {
            assert_eq!(ring.mode_count, count);
            let mean = density / count as f64;
            assert!((ring.wavenumber_1_m - unit * modes / count as f64).abs() < 1e-9 * ring.wavenumber_1_m);
            // Rounding of a transform is of its greatest wave, which has C0.
            assert!((ring.density_m4 - mean).abs() < 1e-12 * spectrum.prefactor(), "{} for {mean}", ring.density_m4);
            variance += ring.density_m4 * ring.mode_count as f64 * unit * unit;
        }
        let heights = surface.heights_m.iter().map(|h| h * h).sum::<f64>() / (n * n) as f64;
        assert!((variance - heights).abs() < 1e-12 * heights, "{variance} for {heights}");
    }
}

#[test]
fn val_one_wave_is_in_one_ring() {
    let n = 64;
    let wave = Array2::from_shape_fn((n, n), |(i, j)| 3.0 * (TAU * (2.0 * i as f64 + 5.0 * j as f64) / n as f64).cos());
    let found = periodogram(wave.view(), 2.0).unwrap();
    let filled: Vec<_> = found.iter().filter(|ring| ring.density_m4 > 1e-20).collect();
    assert_eq!(filled.len(), 1);
    // 3 cos = 1.5 at each of two wavevectors.
    let power = filled[0].density_m4 * filled[0].mode_count as f64 * (TAU / 2.0_f64).powi(2);
    assert!((power - 4.5).abs() < 1e-12, "{power}");
    let mode = filled[0].wavenumber_1_m / (TAU / 2.0);
    assert!((mode / 29_f64.sqrt()).log2().abs() < 0.125, "{mode}");
}
