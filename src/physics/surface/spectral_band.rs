//! Rings of a measured spectrum: variances, white noise, and the band that holds data.

use super::psd_bin::{Estimate, Ring};
use super::spectral_line::{Line, Point, Shape};
use crate::model::SpectrumEnd;
use std::f64::consts::{LN_2, PI, TAU};

/// Relative variance of a ring's density times its number of modes; half of the modes are conjugates of the
/// others.
const OF_MODES: f64 = 2.0;
/// Factor of the variance with two sine tapers u, v along each direction: `(∫(½(u² + v²))²)²`, with
/// `∫u² = ∫v² = 1`.
const TAPERED: f64 = 1.25 * 1.25;
/// Half the second moment along a direction of the power of these tapers, `½ (1² + 2²)/8` in units of the
/// lowest wavenumber squared.
///
/// A power law of exponent p gains the fraction `p²/k²` times this at the mode number k, since
/// `∇²k^(−p) = p² k^(−p−2)` in two dimensions.
const WIDTH: f64 = 0.3125;
/// Exponent of a spectrum before one is found.
const USUAL_EXPONENT: f64 = 3.0;
/// Cost of a ring outside the band: a deviation of two standard deviations.
pub(crate) const OUTSIDE: f64 = 4.0;
/// Deviation of ln C of a spectrum from a power law.
const OF_MODEL: f64 = 0.1;
/// Lowest mode number of a tapered ring that levelling and the main lobe of the tapers do not dominate.
const LOWEST_TAPERED: f64 = 2.5;
/// Minimum density over white noise of a ring with data.
pub(crate) const OVER_NOISE: f64 = 2.0;
/// Rings at the shortest wavelengths that define the white noise.
const TOP: usize = 3;
/// Ratio of densities below which a ring is empty.
const EMPTY: f64 = 0.5;
/// Ratio of densities above which a ring is full.
const FULL: f64 = 0.8;
/// Rings next to the band of which an end of the spectrum empties one: the first may be full, and the second
/// divided.
const NEXT: usize = 3;
/// Rings next to the band of which white noise dominates one.
const NEXT_OF_NOISE: usize = 2;
/// Lower edge of a ring over its mean wavenumber.
const LOWER_RING_EDGE: f64 = 0.95;

fn relative_variance(ring: &Ring, estimate: Estimate) -> f64 {
    let of_estimate = match estimate {
        Estimate::Periodogram => 1.0,
        Estimate::Tapered => TAPERED,
    };
    OF_MODES * of_estimate / ring.mode_count as f64
}

/// Density at a mode number under the tapers over that without, of a power law.
fn widened(exponent: f64, mode: f64) -> f64 {
    let first = WIDTH * (exponent / mode).powi(2);
    1.0 + first + 0.5 * first * WIDTH * ((exponent + 2.0) / mode).powi(2)
}

impl Point {
    /// True if a line predicts more than the ring holds, beyond three standard deviations: rings of few modes
    /// are low by chance.
    pub(crate) fn is_empty(&self, line: &Line) -> bool {
        self.y - line.at(self.x) < EMPTY.ln() - 3.0 * self.variance.sqrt()
    }

    /// Mean square height over the area of a mode \[m⁴\].
    pub(crate) fn power(&self) -> f64 {
        self.modes * self.y.exp()
    }
}

/// Sampling of a surface.
pub(crate) struct Sampling {
    /// Side of the square \[m\].
    pub(crate) length_m: f64,
    /// Estimate of the rings.
    pub(crate) estimate: Estimate,
}

impl Sampling {
    /// All rings, less white noise \[m⁴\] and less the power that the tapers move from longer wavelengths of
    /// a spectrum.
    pub(crate) fn points(&self, rings: &[Ring], noise_m4: f64, line: Option<&Line>) -> Vec<Point> {
        let lowest = TAU / self.length_m;
        let is_tapered = self.estimate == Estimate::Tapered;
        let from = if is_tapered { LOWEST_TAPERED * lowest } else { 0.0 };
        let point = |ring: &Ring| {
            let of_surface = (ring.density_m4 - noise_m4).max(1e-3 * noise_m4).max(f64::MIN_POSITIVE);
            let relative = relative_variance(ring, self.estimate) * (ring.density_m4 / of_surface).powi(2);
            let x = ring.wavenumber_1_m.ln();
            let mut y = of_surface.ln();
            if is_tapered {
                let exponent = line.map_or(USUAL_EXPONENT, |line| line.exponent(x));
                y += 0.5 * relative - widened(exponent, ring.wavenumber_1_m / lowest).ln();
            }
            let is_data = ring.wavenumber_1_m > from && ring.density_m4 > OVER_NOISE * noise_m4;
            Point { x, y, variance: relative + OF_MODEL * OF_MODEL, modes: ring.mode_count as f64, is_data }
        };
        rings.iter().map(point).collect()
    }

    /// Sum over the rings of white noise of the squared deviations of ln C over their variances.
    pub(crate) fn noise_squares(&self, rings: &[Ring], noise_m4: f64, line: &Line) -> f64 {
        let of_noise = rings.iter().filter(|ring| ring.density_m4 <= OVER_NOISE * noise_m4);
        let square = |ring: &Ring| {
            let expected = noise_m4
                + if ring.wavenumber_1_m.ln() > line.band[1] {
                    line.at(ring.wavenumber_1_m.ln()).exp()
                } else {
                    0.0
                };
            (ring.density_m4 / expected).ln().powi(2)
                / (relative_variance(ring, self.estimate) + OF_MODEL * OF_MODEL)
        };
        of_noise.map(square).map(|square| square.min(OUTSIDE)).sum()
    }
}

/// Mean over the modes of rings.
fn mean(rings: &[Ring], value: impl Fn(&Ring) -> f64) -> f64 {
    let modes: f64 = rings.iter().map(|ring| ring.mode_count as f64).sum();
    rings.iter().map(|ring| ring.mode_count as f64 * value(ring)).sum::<f64>() / modes
}

/// Mean density of the rings at the shortest wavelengths \[m⁴\].
pub(crate) fn top_density(rings: &[Ring]) -> f64 {
    mean(&rings[rings.len().saturating_sub(TOP)..], |ring| ring.density_m4)
}

/// White noise \[m⁴\] less the part of the spectrum that reaches into its rings.
pub(crate) fn white_noise_beyond(rings: &[Ring], line: &Line, noise_m4: f64) -> f64 {
    let of_noise: Vec<Ring> =
        rings.iter().rev().take_while(|ring| ring.density_m4 < OVER_NOISE * noise_m4).copied().collect();
    if of_noise.is_empty() {
        return noise_m4;
    }
    mean(&of_noise, |ring| ring.density_m4 - line.at(ring.wavenumber_1_m.ln()).exp()).max(0.1 * noise_m4)
}

/// End of a spectrum at short wavelengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShortCut {
    /// Wavenumber of the end \[1/m\].
    pub wavenumber_1_m: f64,
    /// Cause of the end.
    pub cause: SpectrumEnd,
}

/// Band of rings with data.
pub(crate) struct Band<'a> {
    pub(crate) points: &'a [Point],
    pub(crate) line: &'a Line,
    pub(crate) noise_m4: f64,
    pub(crate) length_m: f64,
}

impl Band<'_> {
    /// Fraction of the modes of a ring that the spectrum fills.
    fn filled(&self, point: &Point) -> f64 {
        (point.y - self.line.at(point.x)).exp().min(1.0)
    }

    /// Wavenumber below which the spectrum holds no data \[1/m\]: that of an L-filter, or of the disc of the
    /// modes that are not filled.
    pub(crate) fn long_cut_1_m(&self) -> Option<f64> {
        if self.line.shape == Shape::Filtered {
            return Some(self.line.corner.exp());
        }
        let rings = || self.points.iter().rev().filter(|point| point.is_data);
        // The fit leaves out a first ring next to an empty one even if it is full.
        let full = rings()
            .filter(|point| point.x <= self.line.band[0])
            .take_while(|point| self.filled(point) > FULL)
            .last();
        let first = full.map_or(self.line.band[0], |point| point.x);
        let below = || rings().filter(|point| point.x < first);
        if !below().take(NEXT).any(|point| point.is_empty(self.line)) {
            return None;
        }
        let filled: f64 = below().map(|point| point.modes * self.filled(point)).sum();
        let empty = (self.modes_below(first) - filled).max(0.0);
        // Rings of long wavelengths have few modes: the next shorter wavelength is known better than the
        // area.
        Some(
            (empty * self.cell())
                .sqrt()
                .max(LOWER_RING_EDGE * first.exp() * f64::from(u8::from(filled < 1.0))),
        )
    }

    /// Area of a mode over π \[1/m²\].
    fn cell(&self) -> f64 {
        (TAU / self.length_m).powi(2) / PI
    }

    /// Number of modes of the rings below `x`, with the mean.
    fn modes_below(&self, x: f64) -> f64 {
        1.0 + self.points.iter().filter(|point| point.x < x).map(|point| point.modes).sum::<f64>()
    }

    /// End of the spectrum at short wavelengths.
    pub(crate) fn short_cut(&self) -> Option<ShortCut> {
        if self.line.damping > 0.0 {
            // The power of a Gaussian filter is ¼ at its cut-off.
            let wavenumber_1_m = (2.0 * LN_2 / self.line.damping).sqrt();
            return Some(ShortCut { wavenumber_1_m, cause: SpectrumEnd::GaussianFilter });
        }
        let last = self.line.band[1];
        let beyond = || self.points.iter().filter(|point| point.x > last);
        let is_noise = |point: &Point| {
            self.noise_m4 > 0.0 && self.line.at(point.x).exp() < 2.0 * OVER_NOISE * self.noise_m4
        };
        if beyond().take(NEXT_OF_NOISE).any(is_noise) {
            let crossing = beyond().find(|point| self.line.at(point.x).exp() < self.noise_m4)?;
            return Some(ShortCut { wavenumber_1_m: crossing.x.exp(), cause: SpectrumEnd::WhiteNoise });
        }
        let filled: f64 = beyond().map(|point| point.modes * self.filled(point)).sum();
        let wavenumber_1_m = ((self.modes_below(last) + self.modes_at(last) + filled) * self.cell()).sqrt();
        beyond()
            .take(NEXT)
            .any(|point| point.is_empty(self.line))
            .then_some(ShortCut { wavenumber_1_m, cause: SpectrumEnd::Empty })
    }

    fn modes_at(&self, x: f64) -> f64 {
        self.points.iter().filter(|point| point.x == x).map(|point| point.modes).sum()
    }
}
