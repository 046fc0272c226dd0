//! Spectra of the scans of one sample, their limits, and their common spectrum.

use super::StageError;
use super::estimates::read_surface_estimates;
use crate::campaign::{Campaign, Standing, SurfaceUnit};
use crate::model::Choice as _;
use crate::physics::surface::common_spectrum::{
    BandRoughness, CommonRow, ScanLimits, ScanSpectrum, band_roughness, before_filter, common_spectrum, nodes,
};
use crate::physics::surface::edges::Edges;
use crate::physics::surface::periodogram::{Ring, periodogram, windowed_periodogram};
use crate::schema::{SCAN_SPECTRA, SCANS, SPECTRUM};
use crate::store::hdf5::{SurfaceHeader, read_surface};
use crate::store::{Check, Frame, FrameError};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt::Write as _;

/// A scan of a sample.
#[derive(Debug, Clone)]
pub struct SampleScan {
    /// Number of the realization.
    pub realization: usize,
    /// Identifier of the surface; the name of its file where there is no run.
    pub surface_id: String,
    /// Label of its file.
    pub file: String,
    /// Header of the surface.
    pub header: SurfaceHeader,
    /// Spectrum with its limits.
    pub spectrum: ScanSpectrum,
    /// `U_el/E*` of the surface \[m\].
    pub flattening_m: f64,
}

/// The scans of a case, and their common spectrum.
#[derive(Debug, Clone)]
pub struct Sample {
    /// Case.
    pub case_id: String,
    /// Scans.
    pub scans: Vec<SampleScan>,
    /// Common spectrum.
    pub common: Vec<CommonRow>,
}

/// Spectrum of a scan. Rings of heights after the S-filter are divided by its transmission.
pub(super) fn scan_spectrum(header: &SurfaceHeader, rings: &[Ring], is_filtered: bool) -> ScanSpectrum {
    let measured = header.measured.as_ref();
    let fit = measured.and_then(|of| of.fit);
    let spacing_m = measured.map_or(0.0, |of| of.source_spacings_m[0].max(of.source_spacings_m[1]));
    let filter =
        measured.filter(|of| is_filtered && of.shortest_wavelength_m > 0.0).map(|of| (of.filter, of));
    let limits = ScanLimits {
        length_m: header.length_m,
        spacing_m,
        edges: Edges::of(header.periodic),
        long_cut_m: fit.and_then(|fit| fit.long_cut_m),
        short_cut: fit.and_then(|fit| fit.short_cut),
        tip_cutoff_m: measured.and_then(|of| of.quality?.tip_cutoff_m),
        filtered_m: filter.map(|(_, of)| of.shortest_wavelength_m),
    };
    let rings = match filter {
        Some((kind, of)) => before_filter(rings, kind, of.shortest_wavelength_m),
        None => rings.to_vec(),
    };
    ScanSpectrum { rings, band: limits.band() }
}

impl Sample {
    /// Of scans.
    #[must_use]
    pub fn of(case_id: &str, scans: Vec<SampleScan>) -> Self {
        let spectra: Vec<ScanSpectrum> = scans.iter().map(|scan| scan.spectrum.clone()).collect();
        Self { case_id: case_id.to_owned(), scans, common: common_spectrum(&spectra) }
    }

    /// Rows of q \[1/m\] and C \[m⁴\] of the common spectrum between two wavenumbers.
    fn rows(&self, [low, high]: [f64; 2]) -> Vec<[f64; 2]> {
        let inside = self.common.iter().filter(|row| (low..=high).contains(&row.wavenumber_1_m));
        inside.map(|row| [row.wavenumber_1_m, row.density_m4]).collect()
    }

    /// Roughness of the common spectrum.
    #[must_use]
    pub fn roughness(&self) -> Option<BandRoughness> {
        band_roughness(&self.rows([0.0, f64::INFINITY]))
    }

    /// Roughness of the band of a scan: of its own spectrum, and of the common one.
    #[must_use]
    pub fn beside(&self, scan: &SampleScan) -> [Option<BandRoughness>; 2] {
        let band = scan.spectrum.band;
        let own: Vec<[f64; 2]> = nodes(std::slice::from_ref(&scan.spectrum))
            .into_iter()
            .filter_map(|q| Some([q, scan.spectrum.density_m4(q)?]))
            .collect();
        let ends = own.first().zip(own.last()).map(|(first, last)| [first[0], last[0]]);
        let common = self.rows(ends.unwrap_or([band.lowest_1_m, band.highest_1_m]));
        [band_roughness(&own), band_roughness(&common)]
    }

    /// Wavenumbers \[1/m\] between which no scan is reliable, with a ratio above that of two rows.
    #[must_use]
    pub fn gaps_1_m(&self) -> Vec<[f64; 2]> {
        let pairs = self.common.windows(2).map(|pair| [pair[0].wavenumber_1_m, pair[1].wavenumber_1_m]);
        pairs.filter(|[before, after]| after / before > LARGEST_STEP).collect()
    }

    /// The common spectrum as the table of `surface.spectrum`: q \[1/m\] and C \[m⁴\] in the convention
    /// `plain`.
    #[must_use]
    pub fn csv(&self) -> String {
        csv(self.common.iter().map(|row| [row.wavenumber_1_m, row.density_m4]))
    }
}

/// Ratio of neighbouring rows of a common spectrum without a gap: ten per decade, with a margin for rounding.
const LARGEST_STEP: f64 = 1.3;

/// Rows of q \[1/m\] and C \[m⁴\] as the table of `surface.spectrum`.
#[must_use]
pub fn csv(rows: impl Iterator<Item = [f64; 2]>) -> String {
    let mut text = "q_1_m,c_m4\n".to_owned();
    for [wavenumber, density] in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{wavenumber:.6e},{density:.6e}");
    }
    text
}

/// Header and spectrum of a scan, and `U_el/E*` of its surface \[m\].
type ScanRead = (SurfaceHeader, ScanSpectrum, f64);

fn examined(campaign: &Campaign, unit: &SurfaceUnit) -> Result<ScanRead, StageError> {
    let (header, heights) = read_surface(&campaign.surface_path(unit))?;
    let of_rings = if header.periodic { periodogram } else { windowed_periodogram };
    let spectrum = scan_spectrum(&header, &of_rings(heights.view(), header.length_m)?, true);
    let estimates = read_surface_estimates(&campaign.estimates_path(unit))?;
    Ok((header, spectrum, estimates.flattening.energies(1.0).whole_j_m2))
}

/// The scans of all cases with a list of them, of surfaces that have been imported and examined.
///
/// # Errors
/// If a surface or its estimates cannot be read.
pub(super) fn samples(campaign: &Campaign) -> Result<Vec<Sample>, StageError> {
    let mut found = Vec::new();
    let mut known: Vec<&[String]> = Vec::new();
    let mut read: HashMap<usize, ScanRead> = HashMap::new();
    for (place, case) in campaign.cases.iter().enumerate() {
        let Some(surface) = case.case.params.surface.measured().filter(|of| !of.files.is_empty()) else {
            continue;
        };
        let is_known =
            campaign.cases[..place].iter().any(|of| of.case.params.surface == case.case.params.surface);
        if is_known && known.contains(&surface.files.as_slice()) {
            continue;
        }
        known.push(&surface.files);
        let mut scans = Vec::new();
        for cycle in campaign.cycles.iter().filter(|cycle| cycle.case == place) {
            let unit = &campaign.surfaces[cycle.surface];
            let is_done = |standing: Standing| standing == Standing::Done;
            if !is_done(campaign.standing(&unit.surface(), Check::Sizes))
                || !is_done(campaign.standing(&unit.asperities(), Check::Sizes))
            {
                continue;
            }
            let (header, spectrum, flattening_m) = match read.entry(cycle.surface) {
                Entry::Occupied(known) => known.get().clone(),
                Entry::Vacant(place) => place.insert(examined(campaign, unit)?).clone(),
            };
            scans.push(SampleScan {
                realization: cycle.realization as usize,
                surface_id: unit.id.clone(),
                file: campaign.label_of(&unit.params).unwrap_or_default(),
                header,
                spectrum,
                flattening_m,
            });
        }
        found.push(Sample::of(&case.id, scans));
    }
    Ok(found)
}

/// Table of the common spectra.
pub(super) fn spectrum_table(samples: &[Sample]) -> Result<Frame, FrameError> {
    let all = || samples.iter().flat_map(|of| of.common.iter().map(move |row| (of, row)));
    let numbers = |value: fn(&CommonRow) -> f64| all().map(|(_, row)| value(row)).collect::<Vec<_>>();
    Frame::of(&SPECTRUM)
        .text("case_id", all().map(|(of, _)| of.case_id.clone()))
        .f64("wavenumber_1_m", numbers(|row| row.wavenumber_1_m))
        .f64("density_m4", numbers(|row| row.density_m4))
        .count("scan_count", all().map(|(_, row)| row.scan_count))
        .f64("density_min_m4", numbers(|row| row.lowest_m4))
        .f64("density_max_m4", numbers(|row| row.highest_m4))
        .f64("scatter_decades", all().map(|(_, row)| row.scatter_decades))
        .build()
}

/// Table of the spectra of scans.
pub(super) fn scan_spectra_table(samples: &[Sample]) -> Result<Frame, FrameError> {
    let of_scan = |scan: &'_ SampleScan| scan.spectrum.rings.clone();
    let rows: Vec<(&Sample, &SampleScan, Ring)> = samples
        .iter()
        .flat_map(|sample| sample.scans.iter().map(move |scan| (sample, scan)))
        .flat_map(|(sample, scan)| of_scan(scan).into_iter().map(move |ring| (sample, scan, ring)))
        .collect();
    Frame::of(&SCAN_SPECTRA)
        .text("case_id", rows.iter().map(|(sample, ..)| sample.case_id.clone()))
        .count("realization", rows.iter().map(|(_, scan, _)| scan.realization))
        .text("surface_id", rows.iter().map(|(_, scan, _)| scan.surface_id.clone()))
        .f64("wavenumber_1_m", rows.iter().map(|(.., ring)| ring.wavenumber_1_m))
        .f64("density_m4", rows.iter().map(|(.., ring)| ring.density_m4))
        .count("mode_count", rows.iter().map(|(.., ring)| ring.mode_count as usize))
        .bool("reliable", rows.iter().map(|(_, scan, ring)| scan.spectrum.is_reliable(ring.wavenumber_1_m)))
        .build()
}

/// A number of a roughness.
type Measure = fn(&BandRoughness) -> f64;

/// Columns of a roughness without their prefix.
const ROUGHNESS: [(&str, Measure); 4] = [
    ("rms_height_m", |of| of.moments.rms_height_m()),
    ("rms_slope", |of| of.moments.rms_slope()),
    ("rms_curvature_1_m", |of| of.moments.rms_curvature_1_m()),
    ("flattening_m", |of| of.flattening_m),
];

/// Table of the limits and the roughness of scans, and of the common spectra.
///
/// # Errors
/// A number that is not finite.
pub fn scans_table(samples: &[Sample]) -> Result<Frame, FrameError> {
    // A row without a scan is that of the common spectrum.
    let rows: Vec<(&Sample, Option<&SampleScan>)> = samples
        .iter()
        .flat_map(|sample| sample.scans.iter().map(Some).chain([None]).map(move |scan| (sample, scan)))
        .collect();
    let text =
        |value: fn(&SampleScan) -> String| rows.iter().map(|(_, scan)| scan.map(value)).collect::<Vec<_>>();
    let number =
        |value: fn(&SampleScan) -> f64| rows.iter().map(|(_, scan)| scan.map(value)).collect::<Vec<_>>();
    let band = |end: usize, of: fn(&SampleScan) -> f64| {
        let one = |(sample, scan): &(&Sample, Option<&SampleScan>)| match scan {
            Some(scan) => Some(of(scan)),
            None => sample.roughness().map(|of| of.range_1_m[end]),
        };
        rows.iter().map(one).collect::<Vec<_>>()
    };
    let roughness: Vec<[Option<BandRoughness>; 2]> = rows
        .iter()
        .map(|(sample, scan)| scan.map_or([sample.roughness(); 2], |scan| sample.beside(scan)))
        .collect();
    let mut frame = Frame::of(&SCANS)
        .text("case_id", rows.iter().map(|(sample, _)| sample.case_id.clone()))
        .i64("realization", rows.iter().map(|(_, scan)| scan.map(|of| of.realization as i64)))
        .text_or_null("surface_id", text(|of| of.surface_id.clone()))
        .text_or_null("surface_file", text(|of| of.file.clone()))
        .f64("length_m", number(|of| of.header.length_m))
        .f64("lowest_1_m", band(0, |of| of.spectrum.band.lowest_1_m))
        .text_or_null("lowest_cause", text(|of| of.spectrum.band.low.word().to_owned()))
        .f64("highest_1_m", band(1, |of| of.spectrum.band.highest_1_m))
        .text_or_null("highest_cause", text(|of| of.spectrum.band.high.word().to_owned()))
        .f64("rms_height_m", number(|of| of.header.rms_height_m))
        .f64("rms_slope", number(|of| of.header.rms_slope))
        .f64("rms_curvature_1_m", number(|of| of.header.rms_curvature_1_m))
        .f64("flattening_m", number(|of| of.flattening_m));
    for (name, value) in ROUGHNESS {
        for (place, prefix) in ["band", "common"].into_iter().enumerate() {
            let values = roughness.iter().map(|of| of[place].as_ref().map(value));
            frame = frame.f64(&format!("{prefix}_{name}"), values);
        }
    }
    frame.build()
}
