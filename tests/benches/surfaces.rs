//! Surfaces: generation against a bare inverse transform of the same size, summits against a copy of the heights.

use crate::paper::spectrum;
use crate::watch::{heading, line, plain, race};
use hysteron::physics::surface::summits::find_summits;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

pub fn run() {
    heading("surfaces: of n x n points", "over what is plain");
    for (magnification, rounds) in [(128, 5), (512, 3)] {
        let spectrum = spectrum(magnification);
        let n = 8 * magnification as usize;
        let half = n / 2 + 1;
        let (rows, columns) = (RealFftPlanner::<f64>::new().plan_fft_inverse(n), FftPlanner::<f64>::new().plan_fft_inverse(n));
        let (mut waves, mut points) = (vec![Complex::new(1.0, 0.0); n * half], vec![0.0; n * n]);
        let bare = || {
            // As many transforms as a surface takes when all of its waves are there, without turning or waves.
            waves.fill(Complex::new(1.0, 0.0));
            columns.process(&mut waves);
            for (line, row) in waves.chunks_mut(half).zip(points.chunks_mut(n)) {
                line[0].im = 0.0;
                line[half - 1].im = 0.0;
                rows.process(line, row).unwrap();
            }
            points[0]
        };
        let seed = realization_seed(2021, 0);
        let (made, transformed) = race(rounds, || synthesize(&spectrum, &seed, n), bare);
        plain(&format!("{n}: bare inverse transforms"), transformed);
        line(&format!("{n}: a surface"), made, made / transformed);
        let surface = synthesize(&spectrum, &seed, n);
        let (found, copied) = race(rounds, || find_summits(surface.heights_m.view(), 1e-3, 8.0).unwrap(), || surface.heights_m.clone());
        let rate = |seconds: f64| 8.0 * (n * n) as f64 / seconds / 1e9;
        plain(&format!("{n}: a copy, {:.2} GB/s", rate(copied)), copied);
        line(&format!("{n}: its summits, {:.2} GB/s", rate(found)), found, found / copied);
    }
}
