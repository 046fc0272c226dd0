//! Result of an import of several scans as text and as JSON.

use super::super::psd::surface_spec;
use super::inputs::Left;
use super::range::Range;
use super::taken::Taken;
use super::text::{Statistics, answer as answer_of, cautions, spec_of};
use crate::model::Choice as _;
use crate::stages::{BandRoughness, CommonRow, Sample};
use crate::stats::significant;
use crate::text::{counted, wrapped};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Result of an import.
pub(super) struct Shown<'a> {
    /// Name of the sample.
    pub(super) name: &'a str,
    pub(super) taken: &'a [Taken],
    pub(super) ranges: &'a [Range<'a>],
    pub(super) left: &'a [Left],
    pub(super) notes: &'a [String],
    /// Sizes that differ from those in the metadata of a container.
    pub(super) differing: &'a [String],
    pub(super) sample: &'a Sample,
    /// Table of the scans and common spectrum, if files were written.
    pub(super) written: Option<&'a [PathBuf]>,
}

impl Shown<'_> {
    fn statistics(&self, place: usize) -> Statistics<'_> {
        let of = &self.taken[place];
        Statistics {
            file: Path::new(&of.label),
            header: &of.imported.header,
            height_factor_m: of.imported.height_factor_m,
            notes: &of.imported.notes,
            range: &self.ranges[place],
            counts: [
                of.imported.prepared.heights_m.nrows(),
                of.examined.estimates.summit_count,
                of.examined.edge_count,
            ],
            fitted_1_m: of
                .imported
                .prepared
                .fit
                .as_ref()
                .filter(|_| of.imported.height_factor_m.is_some())
                .map(|fit| fit.band_1_m),
            written: self.written.map(|_| of.out.as_path()),
        }
    }

    /// Places of the scans of one case: the periodic ones if the first one is periodic, else the other ones.
    fn of_case(&self) -> Vec<usize> {
        let periodic = |place: &usize| self.taken[*place].imported.header.periodic;
        (0..self.taken.len()).filter(|place| periodic(place) == periodic(&0)).collect()
    }

    /// Warnings of the whole import.
    fn warnings(&self) -> Vec<String> {
        let mut warnings: Vec<String> =
            self.left.iter().map(|of| format!("{}: {}", of.label, of.why.replace('\n', "; "))).collect();
        warnings.extend_from_slice(self.differing);
        let others = self.taken.len() - self.of_case().len();
        if others > 0 {
            warnings.push(format!(
                "{} of {} differ from the first in being periodic or not: the spec leaves them out, since \
                 all scans of a case are treated alike",
                others,
                counted(self.taken.len(), "scan")
            ));
        }
        warnings.extend(self.sample.gaps_1_m().iter().map(|[low, high]| {
            format!(
                "gap: no scan is reliable between the wavelengths {:.3e} and {:.3e} m; surface.spectrum \
                 interpolates there, up to a ratio of 4. Add a scan of a size between",
                TAU / low,
                TAU / high
            )
        }));
        if self.sample.common.is_empty() {
            warnings.push("no common spectrum: no scan has a reliable band".to_owned());
        }
        warnings
    }
}

/// Roughness of a band in words.
fn in_words(of: &BandRoughness) -> String {
    format!(
        "h_rms = {} m, rms slope {}, rms Laplacian {} 1/m, U_el/E* = {} m",
        significant(of.moments.rms_height_m(), 4),
        significant(of.moments.rms_slope(), 4),
        significant(of.moments.rms_curvature_1_m(), 4),
        significant(of.flattening_m, 4)
    )
}

/// The result as text of at most 80 columns.
pub(super) fn text(of: &Shown<'_>) -> String {
    let mut text = format!("{} imported, {} left out\n", counted(of.taken.len(), "scan"), of.left.len());
    let mut line = |label: &str, value: &str| {
        text += &wrapped(&format!("  {label:<14}{value}"), "                ");
    };
    of.notes.iter().for_each(|note| line("container", note));
    for (place, (taken, scan)) in of.taken.iter().zip(&of.sample.scans).enumerate() {
        let (header, band) = (&scan.header, scan.spectrum.band);
        let points = taken.imported.prepared.heights_m.nrows();
        line(&format!("scan {place}"), &taken.label);
        line("", &format!("{points} x {points} points, L = {:.4e} m", header.length_m));
        line(
            "",
            &format!(
                "h_rms = {:.3e} m, rms slope {:.4}, U_el/E* = {:.3e} m",
                header.rms_height_m, header.rms_slope, scan.flattening_m
            ),
        );
        line(
            "",
            &format!(
                "reliable from {:.3e} m ({}) to {:.3e} m ({})",
                TAU / band.lowest_1_m,
                band.low.word().replace('_', " "),
                TAU / band.highest_1_m,
                band.high.word().replace('_', " ")
            ),
        );
        let [own, common] = of.sample.beside(scan).map(|of| of.as_ref().map(in_words));
        if let (Some(own), Some(common)) = (own, common) {
            line("", &format!("in this band: {own}"));
            line("", &format!("common spectrum in this band: {common}"));
        }
    }
    if let Some(whole) = of.sample.roughness() {
        let [low, high] = whole.range_1_m;
        line(
            "common",
            &format!(
                "spectrum from {:.3e} to {:.3e} m, {}",
                TAU / low,
                TAU / high,
                counted(of.sample.common.len(), "wavenumber")
            ),
        );
        line("", &in_words(&whole));
    }
    for (place, taken) in of.taken.iter().enumerate() {
        for caution in cautions(of.statistics(place).header) {
            text += &wrapped(&format!("warning: {}: {caution}", taken.label), "  ");
        }
    }
    for warning in of.warnings() {
        text += &wrapped(&format!("warning: {warning}"), "  ");
    }
    text + &of.written.map_or_else(|| "No file was written.\n".to_owned(), |paths| files(of, paths))
}

/// The written files and two specs: of the scans, and of surfaces with the common spectrum.
fn files(of: &Shown<'_>, paths: &[PathBuf]) -> String {
    let places = of.of_case();
    let first = &of.taken[places[0]];
    let files: Vec<String> =
        places.iter().map(|place| crate::spec::quoted(&of.taken[*place].out.to_string_lossy())).collect();
    let strictest =
        places.iter().copied().max_by(|a, b| of.ranges[*a].least_1_m().total_cmp(&of.ranges[*b].least_1_m()));
    let range = &of.ranges[strictest.unwrap_or_default()];
    let mut written: Vec<String> = of.taken.iter().map(|taken| taken.out.display().to_string()).collect();
    written.extend(paths.iter().map(|path| path.display().to_string()));
    let list = format!("[\n    {},\n]", files.join(",\n    "));
    let mut text = format!("Written:\n  {}\n", written.join("\n  "));
    text += "Spec for these scans as realizations of one case; replace the material constants:\n\n";
    text += &spec_of(of.name, &format!("files = {list}"), first.imported.header.periodic, range);
    if let Some(psd) = paths.get(1).filter(|_| of.sample.common.len() > 1) {
        let ends = [of.sample.common.first(), of.sample.common.last()];
        let name = crate::spec::quoted(&psd.to_string_lossy());
        text += "\nThe common spectrum as surface.spectrum of generated surfaces:\n\n";
        text += &surface_spec(&name, ends.map(|row| row.map(|row| row.wavenumber_1_m)));
    }
    text
}

fn path_text(path: &Path) -> String {
    path.display().to_string()
}

/// The result as JSON.
pub(super) fn answer(of: &Shown<'_>) -> Value {
    let roughness = |of: Option<BandRoughness>| {
        of.map(|of| {
            json!({
                "lowest_1_m": of.range_1_m[0], "highest_1_m": of.range_1_m[1],
                "rms_height_m": of.moments.rms_height_m(), "rms_slope": of.moments.rms_slope(),
                "rms_curvature_1_m": of.moments.rms_curvature_1_m(), "flattening_m": of.flattening_m,
            })
        })
    };
    let scan = |place: usize| {
        let (scan, taken) = (&of.sample.scans[place], &of.taken[place]);
        let mut found = answer_of(&of.statistics(place), &scan.spectrum.rings);
        let (band, [own, common]) = (scan.spectrum.band, of.sample.beside(scan));
        found["name"] = json!(taken.label);
        found["reliable"] = json!({
            "lowest_1_m": band.lowest_1_m, "lowest_cause": band.low.word(),
            "highest_1_m": band.highest_1_m, "highest_cause": band.high.word(),
            "band": roughness(own), "common": roughness(common),
        });
        found
    };
    let row = |row: &CommonRow| {
        json!({
            "wavenumber_1_m": row.wavenumber_1_m, "density_m4": row.density_m4,
            "density_min_m4": row.lowest_m4, "density_max_m4": row.highest_m4,
            "scatter_decades": row.scatter_decades, "scan_count": row.scan_count,
        })
    };
    let left = |of: &Left| json!({ "name": of.label, "why": of.why, "failed": of.is_failure });
    json!({
        "scans": (0..of.taken.len()).map(scan).collect::<Vec<_>>(),
        "left_out": of.left.iter().map(left).collect::<Vec<_>>(),
        "notes": of.notes,
        "warnings": of.warnings(),
        "common_spectrum": of.sample.common.iter().map(row).collect::<Vec<_>>(),
        "common": roughness(of.sample.roughness()),
        "files": of.written.map(|paths| paths.iter().map(|path| path_text(path)).collect::<Vec<_>>()),
    })
}
