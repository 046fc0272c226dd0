//! Accuracy and time of the laws of boundary elements: loops of a rough surface at three grids, against the plain law on the finest. `cargo bench -- laws 0.3` takes
//! another Hurst exponent than 0.8.

use crate::paper::{MATERIAL, spectrum};
use crate::watch::{cpu, heading, line, plain};
use hysteron::model::Normalization;
use hysteron::physics::cycle::Method as _;
use hysteron::physics::elements::law::Front;
use hysteron::physics::elements::{Elements, Options};
use hysteron::physics::surface::HeightMap;
use hysteron::physics::surface::spectrum::Spectrum;
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};

/// Magnification, maximum load over E* A0, and points of the grids.
const ZETA: u32 = 8;
const LOAD: f64 = 0.0071;
const GRIDS: [usize; 3] = [64, 128, 256];
/// Surfaces of which the mean is taken.
const SURFACES: u64 = 6;

pub fn run() {
    let hurst = std::env::args().find_map(|word| word.parse().ok()).unwrap_or(0.8);
    heading(&format!("laws: six loops, zeta = {ZETA}, H = {hurst}"), "in those of the plain law on the finest grid");
    let (finest, reference) = loops(Front::PLAIN, GRIDS[2], hurst);
    plain(&format!("plain, {0} x {0}", GRIDS[2]), finest);
    for (name, law) in [("plain", Front::PLAIN), ("corrected", Front::CORRECTED)] {
        for n in GRIDS {
            if (name, n) != ("plain", GRIDS[2]) {
                let (seconds, loss) = loops(law, n, hurst);
                line(&format!("{name}, {n} x {n}"), seconds, seconds / finest);
                println!("{:>36}  dissipated energy over that of the plain law {:.3}", "", loss / reference);
            }
        }
    }
}

/// Processor time of the loops [s] and the sum of their dissipated energies [J].
fn loops(law: Front, n: usize, hurst: f64) -> (f64, f64) {
    let spectrum = Spectrum { normalization: Normalization::Spectrum, hurst, ..spectrum(ZETA) };
    let options = Options { points: n, law, ..Options::default() };
    let mut sum = 0.0;
    let seconds = cpu(|| {
        for realization in 0..SURFACES {
            let surface = synthesize(&spectrum, &realization_seed(2021, realization), n);
            let map = HeightMap {
                heights_m: surface.heights_m.view(),
                length_m: spectrum.length_m,
                is_periodic: true,
                shortest_wavelength_m: spectrum.length_m / f64::from(ZETA),
                rms_height_m: spectrum.rms_height_m,
            };
            let cycle = Elements::new(&map, &MATERIAL, &[LOAD], &options).unwrap().run().unwrap();
            sum += cycle.steps[cycle.turning[0].0].work_j + cycle.steps.last().unwrap().work_j;
        }
    });
    (seconds, sum)
}
