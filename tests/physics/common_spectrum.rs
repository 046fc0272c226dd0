//! Spectra of several scans: limits of reliability, the S-filter undone, the common spectrum and its roughness.

use hysteron::model::{Filter, HighEnd, LowEnd, SpectrumEnd};
use hysteron::physics::surface::common_spectrum::{Band, ScanLimits, ScanSpectrum, band_roughness, before_filter, common_spectrum, nodes};
use hysteron::physics::surface::edges::Edges;
use hysteron::physics::surface::periodogram::Ring;
use std::f64::consts::{PI, TAU};

const LIMITS: ScanLimits = ScanLimits {
    length_m: 1e-5,
    spacing_m: 1e-8,
    edges: Edges::Open,
    long_cut_m: None,
    short_cut: None,
    tip_cutoff_m: None,
    filtered_m: None,
};

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() <= tolerance, "{found} instead of {expected}");
}

/// A spectrum `level q^-exponent` in rings, four per octave, reliable in a band.
fn scan(level: f64, exponent: f64, [low, high]: [f64; 2]) -> ScanSpectrum {
    let ring = |k: i32| {
        let wavenumber_1_m = 1e5 * 2f64.powf(0.25 * f64::from(k));
        Ring { wavenumber_1_m, density_m4: level * wavenumber_1_m.powf(-exponent), mode_count: 10 }
    };
    let band = Band { lowest_1_m: low, low: LowEnd::Window, highest_1_m: high, high: HighEnd::Grid };
    ScanSpectrum { rings: (0..60).map(ring).collect(), band }
}

#[test]
fn law_the_strictest_limit_holds() {
    let band = LIMITS.band();
    // Three modes of the side, four points per wavelength.
    close(band.lowest_1_m, 3.0 * TAU / 1e-5, 1e-15);
    close(band.highest_1_m, TAU / 4e-8, 1e-15);
    assert_eq!((band.low, band.high), (LowEnd::Window, HighEnd::Grid));
    let periodic = ScanLimits { edges: Edges::Periodic, ..LIMITS }.band();
    close(periodic.lowest_1_m, TAU / 1e-5, 1e-15);
    assert_eq!(periodic.low, LowEnd::Side);
    let cut = ScanLimits { long_cut_m: Some(2e-6), ..LIMITS }.band();
    close(cut.lowest_1_m, TAU / 2e-6, 1e-15);
    assert_eq!(cut.low, LowEnd::LongCut);
    assert_eq!(ScanLimits { long_cut_m: Some(5e-6), ..LIMITS }.band().low, LowEnd::Window);
    let ends = [
        (ScanLimits { tip_cutoff_m: Some(1e-7), ..LIMITS }, 1.0, HighEnd::Tip),
        (ScanLimits { filtered_m: Some(1e-7), ..LIMITS }, 1.0, HighEnd::Filter),
        (ScanLimits { short_cut: Some((1e-7, SpectrumEnd::GaussianFilter)), ..LIMITS }, 0.4, HighEnd::GaussianFilter),
        (ScanLimits { short_cut: Some((1e-7, SpectrumEnd::WhiteNoise)), ..LIMITS }, 0.6, HighEnd::WhiteNoise),
        (ScanLimits { short_cut: Some((1e-7, SpectrumEnd::Empty)), ..LIMITS }, 0.8, HighEnd::Empty),
    ];
    for (limits, part, cause) in ends {
        close(limits.band().highest_1_m, part * TAU / 1e-7, 1e-15);
        assert_eq!(limits.band().high, cause);
    }
    let both = ScanLimits { tip_cutoff_m: Some(2e-7), filtered_m: Some(1e-7), ..LIMITS };
    assert_eq!(both.band().high, HighEnd::Tip);
    // At 0.4 of its cut-off a Gaussian filter, of power 4^-(q/qc)^2, transmits 80 %.
    close(4f64.powf(-0.4 * 0.4), 0.8, 2e-3);
}

#[test]
fn law_undoing_the_filter_is_its_inverse() {
    let spectrum = scan(1e-10, 3.6, [1e5, 1e9]);
    let cut_off_m = TAU / 3e7;
    let damped: Vec<Ring> = spectrum
        .rings
        .iter()
        .map(|ring| Ring { density_m4: ring.density_m4 * 4f64.powf(-(ring.wavenumber_1_m / 3e7).powi(2)), ..*ring })
        .collect();
    let undone = before_filter(&damped, Filter::Gaussian, cut_off_m);
    assert_eq!(undone.len(), spectrum.rings.iter().filter(|ring| ring.wavenumber_1_m <= 3e7).count());
    undone.iter().zip(&spectrum.rings).for_each(|(found, ring)| close(found.density_m4, ring.density_m4, 1e-14));
    let sharp = before_filter(&spectrum.rings, Filter::Sharp, cut_off_m);
    assert!(sharp.iter().zip(&spectrum.rings).all(|(found, ring)| found == ring) && sharp.len() == undone.len());
}

#[test]
fn law_a_power_law_comes_back_and_scans_have_one_weight() {
    let scans = [scan(1e-10, 3.6, [1e6, 4e7]), scan(3e-10, 3.6, [1e7, 9e7]), scan(2e-10, 3.6, [2e7, 9e7])];
    let rows = common_spectrum(&scans);
    // Ten a decade from 10^6 to the last below 9e7, the ends included.
    assert_eq!((rows.len(), rows[0].scan_count), (20, 1));
    close(rows[0].wavenumber_1_m, 1e6, 1e-12);
    for row in &rows {
        let q = row.wavenumber_1_m;
        let levels: Vec<f64> = [(1e-10, 1e6, 4e7), (3e-10, 1e7, 9e7), (2e-10, 2e7, 9e7)]
            .into_iter()
            .filter(|(_, low, high)| *low <= q * (1.0 + 1e-12) && q * (1.0 - 1e-12) <= *high)
            .map(|(level, ..)| level * q.powf(-3.6))
            .collect();
        let count = levels.len() as f64;
        assert_eq!(row.scan_count, levels.len());
        // Interpolation of a power law between rings is exact up to rounding.
        close(row.density_m4, levels.iter().sum::<f64>() / count, 1e-12);
        close(row.lowest_m4, levels.iter().copied().fold(f64::MAX, f64::min), 1e-12);
        close(row.highest_m4, levels.iter().copied().fold(0.0, f64::max), 1e-12);
        if levels.len() == 2 {
            // The standard deviation of two values is their difference over sqrt 2.
            let scatter = (levels[0] / levels[1]).log10().abs() / 2f64.sqrt();
            close(row.scatter_decades.unwrap(), scatter, 1e-9);
        }
        assert_eq!(row.scatter_decades.is_none(), levels.len() == 1);
    }
    // The order of the scans has no effect beyond rounding of the sums.
    let turned: Vec<ScanSpectrum> = scans.iter().rev().cloned().collect();
    for (a, b) in rows.iter().zip(common_spectrum(&turned)) {
        close(a.density_m4, b.density_m4, 1e-15);
    }
}

#[test]
fn lim_outside_the_bands_there_are_no_rows() {
    let apart = [scan(1e-10, 3.6, [1e6, 2e6]), scan(1e-10, 3.6, [1e8, 2e8])];
    let rows = common_spectrum(&apart);
    assert!(rows.iter().all(|row| row.wavenumber_1_m < 2e6 || row.wavenumber_1_m > 0.99e8) && rows.len() >= 6);
    assert!(nodes(&apart).len() > rows.len());
    // An empty band, no scan, and rings that end before the band.
    assert!(common_spectrum(&[scan(1e-10, 3.6, [2e6, 1e6])]).is_empty() && common_spectrum(&[]).is_empty());
    let short = ScanSpectrum { rings: scan(1.0, 2.0, [1e6, 1e9]).rings[..20].to_vec(), ..scan(1.0, 2.0, [1e6, 1e9]) };
    assert_eq!(short.density_m4(1e8), None);
    assert!(short.is_reliable(1e8) && !short.is_reliable(1e5));
    assert_eq!(short.density_m4(short.rings[3].wavenumber_1_m), Some(short.rings[3].density_m4));
}

#[test]
fn val_roughness_of_a_power_law_in_closed_form() {
    // C = c q^-4 from a to b: ∫q^n C dq = c (b^(n-3) - a^(n-3))/(n-3), a logarithm at n = 3.
    let (a, b, c) = (1e6, 1e8, 1e-5);
    let rows: Vec<[f64; 2]> = (0..=20).map(|k| a * 10f64.powf(0.1 * f64::from(k))).map(|q| [q, c * q.powi(-4)]).collect();
    let found = band_roughness(&rows).unwrap();
    let over = |n: f64| if n == 3.0 { (b / a).ln() } else { (b.powf(n - 3.0) - a.powf(n - 3.0)) / (n - 3.0) };
    close(found.range_1_m[1], b, 1e-12);
    close(found.moments.rms_height_m(), (TAU * c * over(1.0)).sqrt(), 1e-10);
    close(found.moments.rms_slope(), (TAU * c * over(3.0)).sqrt(), 1e-10);
    close(found.moments.rms_curvature_1_m(), (TAU * c * over(5.0)).sqrt(), 1e-10);
    close(found.flattening_m, 0.5 * PI * c * over(2.0), 1e-10);
    assert!(band_roughness(&rows[..1]).is_none() && band_roughness(&[]).is_none());
}
