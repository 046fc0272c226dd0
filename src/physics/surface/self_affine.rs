//! Fit of a self-affine spectrum with a roll-off to the part of a measured spectrum that holds data.
//!
//! A measured spectrum holds more than the surface: rounding where a filter removed wavelengths, leakage of
//! the window and of filters, and white noise. The fit therefore determines the band of rings together with
//! the spectrum: it minimizes the sum of the squared residuals of the rings inside, over their variances, and
//! of a constant cost for each ring outside. Shapes of the spectrum: a power law, with a sharp or a smooth
//! roll-off, with or without damping by a Gaussian filter.

use super::psd_bin::{Estimate, Ring};
pub use super::spectral_band::ShortCut;
use super::spectral_band::{Band, OUTSIDE, OVER_NOISE, Sampling, top_density, white_noise_beyond};
use super::spectral_line::{Damping, Form, Line, Point, Shape, Sums};
use std::cmp::Ordering;
use std::f64::consts::{LN_2, LN_10};
use std::ops::RangeInclusive;

/// Self-affine spectrum with a roll-off: `C0` up to `q_r`, then `C0 (q/q_r)^(−2(H+1))` (Eq 10).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfAffine {
    /// Hurst exponent H.
    ///
    /// A value outside (0, 1) means that the surface is not self-affine in the band.
    pub hurst: f64,
    /// Plateau C0 \[m⁴\].
    pub plateau_m4: f64,
    /// Roll-off wavenumber q_r \[1/m\]; the lowest wavenumber of the band if there is no roll-off.
    pub roll_off_1_m: f64,
    /// True if there is a roll-off within the band.
    pub rolls_off: bool,
    /// Wavenumbers of the first and last ring of the fit \[1/m\].
    pub band_1_m: [f64; 2],
    /// Rms deviation of log10 C from the fit, weighted by the inverse variance.
    pub scatter: f64,
    /// Wavenumber below which the spectrum holds no data \[1/m\]; nothing if it holds data up to the longest
    /// wavelength.
    pub long_cut_1_m: Option<f64>,
    /// End of the spectrum at short wavelengths; nothing if it holds data up to the grid's limit.
    pub short_cut: Option<ShortCut>,
}

/// Decrease of the cost that a roll-off, and that damping, must yield; an L-filter, which resembles a
/// roll-off, must yield more.
const OF_SHAPE: f64 = 8.0;
/// Fewest rings of a fit.
pub(super) const MIN_RINGS: usize = 5;
/// Fewest rings of the power law beyond a roll-off.
pub(super) const MIN_RINGS_BEYOND: usize = 4;
/// Minimum fraction of the mean square height of all rings that the band holds: leakage and rounding hold
/// less.
pub(super) const SHARE: f64 = 0.1;
/// Decrease of ln C by a filter that hardly changes the exponent.
const SMALL_DAMPING: f64 = 0.35;
/// Decrease of ln C at the last ring of a damped band: a Gaussian filter reaches `2 ln 2` at its cut-off.
///
/// Above it the density varies too much within a ring.
const DAMPING: RangeInclusive<f64> = 2.0 * LN_2..=3.0;
/// Ratio to a damped spectrum below which a ring is beyond a sharp end.
const END: f64 = 0.1;
/// Hurst exponents of a self-affine surface, with a margin for the error of the fit.
const HURST: RangeInclusive<f64> = -0.05..=1.1;
/// Largest rms deviation from a fit \[decades\].
pub(super) const MAX_SCATTER: f64 = 0.5;
/// Exponents of a spectrum that is fitted at all, from a density that grows with q to that of a smooth form.
const ANY: RangeInclusive<f64> = -1.5..=3.0;
/// Cost beyond that of any power law at which a self-affine spectrum is given up: four rings that it leaves
/// out.
const MISFIT: f64 = 4.0 * OUTSIDE;
/// White noise over the density at the shortest wavelengths.
const NOISE: [f64; 6] = [0.0, 0.3, 0.55, 0.75, 0.9, 1.0];
/// Corrections of the white noise for the spectrum that reaches into it, and of the rings for the width of
/// the window.
const PASSES: usize = 2;

/// Fits a self-affine spectrum to the rings of a surface of side L \[m\].
///
/// Fewer than five rings with data give `None`, and so does a spectrum of few waves, from which any power law
/// deviates by more than half a decade.
#[must_use]
pub fn fit_self_affine(rings: &[Ring], length_m: f64, estimate: Estimate) -> Option<SelfAffine> {
    let sampling = Sampling { length_m, estimate };
    let found = NOISE.iter().filter_map(|part| Found::of(rings, &sampling, part * top_density(rings), None));
    let mut found = found.min_by(Found::order)?;
    for _ in 0..PASSES {
        let noise_m4 = white_noise_beyond(rings, &found.line, found.noise_m4);
        found = Found::of(rings, &sampling, noise_m4, Some(&found.line)).unwrap_or(found);
    }
    let Found { points, line, noise_m4, .. } = found;
    if line.scatter > MAX_SCATTER * LN_10 {
        return None;
    }
    let band = Band { points: &points, line: &line, noise_m4, length_m };
    Some(SelfAffine {
        hurst: line.hurst(),
        plateau_m4: line.level.exp(),
        roll_off_1_m: line.corner.exp(),
        rolls_off: line.shape.rolls_off(),
        band_1_m: line.band.map(f64::exp),
        scatter: line.scatter / LN_10,
        long_cut_1_m: band.long_cut_1_m(),
        short_cut: band.short_cut(),
    })
}

/// Line, rings and white noise of a fit.
struct Found {
    points: Vec<Point>,
    line: Line,
    noise_m4: f64,
    /// True if the Hurst exponent is that of a self-affine surface.
    is_self_affine: bool,
    cost: f64,
}

impl Found {
    /// The line of minimum cost with this white noise; `known` is the line of an earlier pass.
    fn of(rings: &[Ring], sampling: &Sampling, noise_m4: f64, known: Option<&Line>) -> Option<Self> {
        let points = sampling.points(rings, noise_m4, known);
        let data: Vec<Point> = points.iter().filter(|point| point.is_data).copied().collect();
        // White noise counts: a band of a few rings that exceed it by chance is none.
        let of_noise = rings
            .iter()
            .filter(|ring| ring.density_m4 <= OVER_NOISE * noise_m4)
            .map(|ring| ring.mode_count as f64 * ring.density_m4);
        let search =
            Search { data: &data, power: data.iter().map(Point::power).sum::<f64>() + of_noise.sum::<f64>() };
        let [self_affine, any] = search.least([&HURST, &ANY]);
        let any = any?;
        let self_affine = self_affine.filter(|found| found.cost <= any.cost + MISFIT);
        let is_self_affine = self_affine.is_some();
        let Candidate { cost, band, line } = self_affine.unwrap_or(any);
        let of_noise =
            if noise_m4 > 0.0 { OF_SHAPE + sampling.noise_squares(rings, noise_m4, &line) } else { 0.0 };
        let line = search.without_partial_rings(band, line);
        Some(Self { points, line, noise_m4, is_self_affine, cost: cost + of_noise })
    }

    /// Self-affine spectra first, then the minimum cost.
    fn order(&self, other: &Self) -> Ordering {
        other.is_self_affine.cmp(&self.is_self_affine).then(self.cost.total_cmp(&other.cost))
    }
}

/// Rings with data, and the sum of the mean square heights of these and of white noise.
struct Search<'a> {
    data: &'a [Point],
    power: f64,
}

/// A line through a band of rings.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    cost: f64,
    /// First ring, and the ring after the last.
    band: [usize; 2],
    line: Line,
}

impl Search<'_> {
    /// Lines of minimum cost with exponents in two ranges. A roll-off is at a ring, or between two.
    fn least(&self, ranges: [&RangeInclusive<f64>; 2]) -> [Option<Candidate>; 2] {
        let mut found = [None; 2];
        self.straight(ranges, &mut found);
        for (at, point) in self.data.iter().enumerate().skip(1) {
            for shape in [Shape::Sharp, Shape::Smooth, Shape::Filtered] {
                let sums = Sums::of(self.data, shape, point.x);
                for first in 0..at {
                    for end in (first + MIN_RINGS).max(at + 1 + MIN_RINGS_BEYOND)..=self.data.len() {
                        self.compare(&sums, [first, end], ranges, &mut found);
                    }
                }
            }
        }
        std::array::from_fn(|k| found[k].map(|found| self.between_rings(found, ranges[k])))
    }

    /// Lines without a roll-off.
    fn straight(&self, ranges: [&RangeInclusive<f64>; 2], found: &mut [Option<Candidate>; 2]) {
        let Some(point) = self.data.first() else { return };
        let sums = Sums::of(self.data, Shape::Straight, point.x);
        for first in 0..self.data.len() {
            for end in first + MIN_RINGS..=self.data.len() {
                self.compare(&sums, [first, end], ranges, found);
            }
        }
    }

    /// Compares the lines of a shape through a band, with and without damping, with the best ones.
    fn compare(
        &self,
        sums: &Sums,
        band: [usize; 2],
        ranges: [&RangeInclusive<f64>; 2],
        found: &mut [Option<Candidate>; 2],
    ) {
        if sums.power(band) < SHARE * self.power {
            return;
        }
        for damping in [Damping::None, Damping::Gaussian] {
            let Some((hurst, squares)) = sums.solved(band, damping) else { continue };
            let corner = if sums.shape == Shape::Straight { self.data[band[0]].x } else { sums.corner };
            let form = Form { shape: sums.shape, corner, damping };
            let cost = self.cost(squares, band, form);
            for (best, range) in found.iter_mut().zip(ranges) {
                if range.contains(&hurst)
                    && best.as_ref().is_none_or(|best| cost < best.cost)
                    && let Some(line) = self.line(band, form, range)
                {
                    *best = Some(line);
                }
            }
        }
    }

    fn cost(&self, squares: f64, band: [usize; 2], form: Form) -> f64 {
        let of_shape = match form.shape {
            Shape::Straight => 0.0,
            Shape::Sharp | Shape::Smooth => OF_SHAPE,
            Shape::Filtered => 2.0 * OF_SHAPE,
        };
        let outside = self.data.len() - (band[1] - band[0]);
        squares
            + OUTSIDE * outside as f64
            + of_shape
            + if form.damping == Damping::Gaussian { OF_SHAPE } else { 0.0 }
    }

    /// A line through a band; nothing if its exponent or its damping is not admitted.
    fn line(&self, band: [usize; 2], form: Form, hurst: &RangeInclusive<f64>) -> Option<Candidate> {
        let inside = &self.data[band[0]..band[1]];
        let line = Line::of(inside, form).filter(|line| hurst.contains(&line.hurst()))?;
        if form.damping == Damping::Gaussian && !is_damped(&line, inside, self.data.get(band[1])) {
            return None;
        }
        Some(Candidate { cost: self.cost(line.squares, band, form), band, line })
    }

    /// The line without a first or last ring that the end of the spectrum divides: the next ring is empty.
    fn without_partial_rings(&self, [first, end]: [usize; 2], line: Line) -> Line {
        let is_empty = |at: Option<usize>| {
            at.and_then(|at| self.data.get(at)).is_some_and(|point| point.is_empty(&line))
        };
        let from = first + usize::from(is_empty(first.checked_sub(1)));
        let to = end - usize::from(line.damping == 0.0 && is_empty(Some(end)));
        if to < from + MIN_RINGS || line.shape.rolls_off() && self.data[from].x >= line.corner {
            return line;
        }
        let corner = if line.shape == Shape::Straight { self.data[from].x } else { line.corner };
        Line::of(&self.data[from..to], line.form(corner)).unwrap_or(line)
    }

    /// A line whose roll-off may be between two rings.
    fn between_rings(&self, found: Candidate, hurst: &RangeInclusive<f64>) -> Candidate {
        let Candidate { band, line, .. } = found;
        if line.shape == Shape::Straight {
            return found;
        }
        let width = self.data[band[0] + 1].x - self.data[band[0]].x;
        let corners = (-8..=8).map(|k| line.corner + 0.125 * f64::from(k) * width);
        let lines = corners.filter_map(|corner| self.line(band, line.form(corner), hurst));
        lines.fold(found, |least, other| if other.cost < least.cost { other } else { least })
    }
}

/// True if damping reaches the cut-off of the filter in the band, is small over enough rings beyond the
/// corner, and continues in the next ring.
fn is_damped(line: &Line, inside: &[Point], next: Option<&Point>) -> bool {
    let damping = |point: &Point| line.damping * (2.0 * point.x).exp();
    let small = inside.iter().filter(|point| point.x >= line.corner && damping(point) < SMALL_DAMPING);
    let continues = next.is_none_or(|point| point.y - line.at(point.x) > END.ln());
    small.count() >= MIN_RINGS_BEYOND
        && continues
        && inside.last().is_some_and(|point| DAMPING.contains(&damping(point)))
}
