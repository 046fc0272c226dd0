//! Common spectrum of several scans of one surface, each in the band of wavenumbers where it is reliable.
//!
//! Scans of different size and resolution measure different bands of one spectrum. The instrument sets the
//! ends of a band: the side of the scan, the distance of its points, the tip, noise and filters. The common
//! spectrum at a wavenumber is the mean over the scans whose band contains it (Jacobs, Junge and Pastewka,
//! Surf. Topogr. 5:013001, 2017; the container averages of SurfaceTopography have the same weights).

use super::edges::Edges;
use super::pieces::Pieces;
use super::psd_bin::Ring;
use super::psd_table::pieces_of;
use super::spectrum::Moments;
use crate::model::{Filter, HighEnd, LowEnd, SpectrumEnd};
use std::f64::consts::{PI, TAU};

/// Wavenumbers of a common spectrum per decade.
pub const PER_DECADE: i32 = 10;
/// Lowest mode number of a scan under a Hann window: levelling and the main lobe of the window change lower
/// ones.
pub(super) const LOWEST_WINDOWED: f64 = 3.0;
/// Points per shortest wavelength of a scan: on a finer scale the instrument averages and noise is aliased.
pub(super) const POINTS_PER_WAVELENGTH: f64 = 4.0;
/// Highest wavenumber over that of the end of a spectrum by a Gaussian filter, white noise and a sharp end.
///
/// A Gaussian filter transmits 80 % of the power there; of a self-affine spectrum with H = 0.8, white noise
/// is 16 % of the density.
pub(super) const BEFORE_END: [f64; 3] = [0.4, 0.6, 0.8];

/// Sampling of a scan, and the ends of its spectrum as far as they are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanLimits {
    /// Side of the square \[m\].
    pub length_m: f64,
    /// Larger distance of the points of the scan \[m\].
    pub spacing_m: f64,
    /// Edges of the square.
    pub edges: Edges,
    /// Wavelength above which the spectrum holds no data \[m\].
    pub long_cut_m: Option<f64>,
    /// Wavelength below which it holds no data \[m\], and its cause.
    pub short_cut: Option<(f64, SpectrumEnd)>,
    /// Reliability cut-off of the tip \[m\].
    pub tip_cutoff_m: Option<f64>,
    /// Cut-off wavelength of the filter that the heights have passed \[m\].
    pub filtered_m: Option<f64>,
}

/// Band of wavenumbers in which the spectrum of a scan is reliable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Lowest wavenumber \[1/m\], and its cause.
    pub lowest_1_m: f64,
    /// Cause of the lower end.
    pub low: LowEnd,
    /// Highest wavenumber \[1/m\].
    pub highest_1_m: f64,
    /// Cause of the upper end.
    pub high: HighEnd,
}

impl ScanLimits {
    /// The band in which the spectrum is reliable. It is empty, with the highest wavenumber below the lowest,
    /// for a scan of few points.
    ///
    /// Lower end: three modes under a window, one mode of a periodic surface; the long cut-off of the
    /// spectrum if that is shorter. Upper end: the smallest of four points per wavelength, the cut-offs of
    /// tip and filter, and the end of the spectrum, with a margin for noise and damping.
    #[must_use]
    pub fn band(&self) -> Band {
        let (modes, side) = match self.edges {
            Edges::Periodic => (1.0, LowEnd::Side),
            Edges::Open => (LOWEST_WINDOWED, LowEnd::Window),
        };
        let by_side = (modes * TAU / self.length_m, side);
        let low = match self.long_cut_m.map(|cut| TAU / cut).filter(|lowest| *lowest > by_side.0) {
            Some(lowest) => (lowest, LowEnd::LongCut),
            None => by_side,
        };
        let of_spectrum = |(wavelength_m, cause): (f64, SpectrumEnd)| {
            let (part, end) = match cause {
                SpectrumEnd::GaussianFilter => (BEFORE_END[0], HighEnd::GaussianFilter),
                SpectrumEnd::WhiteNoise => (BEFORE_END[1], HighEnd::WhiteNoise),
                SpectrumEnd::Empty => (BEFORE_END[2], HighEnd::Empty),
            };
            (part * TAU / wavelength_m, end)
        };
        let grid = (TAU / (POINTS_PER_WAVELENGTH * self.spacing_m), HighEnd::Grid);
        let others = [
            self.filtered_m.map(|cut| (TAU / cut, HighEnd::Filter)),
            self.tip_cutoff_m.map(|cut| (TAU / cut, HighEnd::Tip)),
            self.short_cut.map(of_spectrum),
        ];
        let high = others.into_iter().flatten().fold(grid, |a, b| if b.0 < a.0 { b } else { a });
        Band { lowest_1_m: low.0, low: low.1, highest_1_m: high.0, high: high.1 }
    }
}

/// Rings of heights before an S-filter of cut-off λc, from those after it: `C 4^((λc/λ)²)` for a Gaussian
/// filter, whose amplitude is `2^(−(λc/λ)²)`. Rings beyond the cut-off are omitted.
#[must_use]
pub fn before_filter(rings: &[Ring], filter: Filter, cut_off_m: f64) -> Vec<Ring> {
    let undamped = |ring: &Ring| {
        let ratio = cut_off_m * ring.wavenumber_1_m / TAU;
        let gain = match filter {
            Filter::Gaussian => (2.0 * ratio * ratio).exp2(),
            Filter::Sharp => 1.0,
        };
        (ratio <= 1.0).then_some(Ring { density_m4: gain * ring.density_m4, ..*ring })
    };
    rings.iter().filter_map(undamped).collect()
}

/// Spectrum of a scan.
#[derive(Debug, Clone, PartialEq)]
pub struct ScanSpectrum {
    /// Power spectral density in rings, with `∫ C d²q = h_rms²`.
    pub rings: Vec<Ring>,
    /// Band in which it is reliable.
    pub band: Band,
}

impl ScanSpectrum {
    /// Density \[m⁴\] at a wavenumber \[1/m\]: a power law between the rings. Nothing outside them.
    #[must_use]
    pub fn density_m4(&self, wavenumber_1_m: f64) -> Option<f64> {
        let after = self.rings.partition_point(|ring| ring.wavenumber_1_m < wavenumber_1_m);
        let next = self.rings.get(after)?;
        if next.wavenumber_1_m == wavenumber_1_m {
            return Some(next.density_m4).filter(|density| *density > 0.0);
        }
        let before = self.rings.get(after.checked_sub(1)?)?;
        if before.density_m4 <= 0.0 || next.density_m4 <= 0.0 {
            return None;
        }
        let span = (next.wavenumber_1_m / before.wavenumber_1_m).ln();
        let exponent = (next.density_m4 / before.density_m4).ln() / span;
        Some(before.density_m4 * (wavenumber_1_m / before.wavenumber_1_m).powf(exponent))
    }

    /// True if the scan contributes to the common spectrum at a wavenumber \[1/m\].
    #[must_use]
    pub fn is_reliable(&self, wavenumber_1_m: f64) -> bool {
        (self.band.lowest_1_m..=self.band.highest_1_m).contains(&wavenumber_1_m)
    }
}

/// Row of a common spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonRow {
    /// Wavenumber q = 2π/λ \[1/m\].
    pub wavenumber_1_m: f64,
    /// Mean density C \[m⁴\].
    pub density_m4: f64,
    /// Smallest density of a scan \[m⁴\].
    pub lowest_m4: f64,
    /// Largest density of a scan \[m⁴\].
    pub highest_m4: f64,
    /// Standard deviation of log10 C over the scans (n − 1) \[decades\]; nothing with one scan.
    pub scatter_decades: Option<f64>,
    /// Number of scans that contribute.
    pub scan_count: usize,
}

/// Wavenumbers `10^(k/10)` \[1/m\] from the lowest to the highest that is reliable in a scan.
#[must_use]
pub fn nodes(scans: &[ScanSpectrum]) -> Vec<f64> {
    let step = |wavenumber: f64| f64::from(PER_DECADE) * wavenumber.log10();
    let low = scans.iter().map(|scan| scan.band.lowest_1_m).fold(f64::INFINITY, f64::min);
    let high = scans.iter().map(|scan| scan.band.highest_1_m).fold(0.0, f64::max);
    if !(low > 0.0 && high > low && high.is_finite()) {
        return Vec::new();
    }
    (step(low).ceil() as i32..=step(high).floor() as i32)
        .map(|k| 10_f64.powf(f64::from(k) / f64::from(PER_DECADE)))
        .collect()
}

/// Common spectrum of scans at ten wavenumbers per decade.
///
/// Each scan that is reliable at a wavenumber has the same weight: `C = Σ C_i/n`, whatever its number of
/// modes. Wavenumbers without a reliable scan are omitted.
#[must_use]
pub fn common_spectrum(scans: &[ScanSpectrum]) -> Vec<CommonRow> {
    let row = |wavenumber_1_m: f64| {
        let reliable = scans.iter().filter(|scan| scan.is_reliable(wavenumber_1_m));
        let densities: Vec<f64> = reliable.filter_map(|scan| scan.density_m4(wavenumber_1_m)).collect();
        let count = densities.len();
        let mean = |of: &dyn Fn(f64) -> f64| densities.iter().map(|c| of(*c)).sum::<f64>() / count as f64;
        let centre = mean(&f64::log10);
        let squares = mean(&|c| (c.log10() - centre).powi(2)) * count as f64;
        (count > 0).then(|| CommonRow {
            wavenumber_1_m,
            density_m4: mean(&|c| c),
            lowest_m4: densities.iter().copied().fold(f64::INFINITY, f64::min),
            highest_m4: densities.iter().copied().fold(0.0, f64::max),
            scatter_decades: (count > 1).then(|| (squares / (count - 1) as f64).sqrt()),
            scan_count: count,
        })
    };
    nodes(scans).into_iter().filter_map(row).collect()
}

/// Roughness of a band of an isotropic spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandRoughness {
    /// First and last wavenumber \[1/m\].
    pub range_1_m: [f64; 2],
    /// Spectral moments.
    pub moments: Moments,
    /// Elastic energy of flattening per area over E\* \[m\].
    pub flattening_m: f64,
}

/// Roughness of the band of an isotropic spectrum, given as rows of q \[1/m\] and C \[m⁴\] with power laws
/// between them. Nothing with fewer than two rows.
///
/// `h_rms² = 2π∫qC dq`, `h'_rms² = 2π∫q³C dq`, `h''_rms² = 2π∫q⁵C dq`, and `U_el/E* = (π/2)∫q²C dq` (Persson
/// and Tosatti 2001).
#[must_use]
pub fn band_roughness(rows: &[[f64; 2]]) -> Option<BandRoughness> {
    let [low, high] = [rows.first()?[0], rows.last()?[0]];
    let pieces = Pieces(pieces_of(rows));
    let over = |power: f64| pieces.integral(power, low, high);
    let rms = |power: f64| (TAU * over(power)).sqrt();
    (rows.len() > 1).then(|| BandRoughness {
        range_1_m: [low, high],
        moments: Moments::of_rms(rms(1.0), rms(3.0), rms(5.0)),
        flattening_m: 0.5 * PI * over(2.0),
    })
}
