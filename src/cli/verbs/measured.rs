//! `import`: a measured surface as the model takes it, and what its spectrum says; and `export` of surfaces to other programs.

use super::{BAD_SPEC, Fault, failed, say};
use crate::cli::{ExportArguments, ImportArguments};
use crate::formats::recognize;
use crate::keys::digest_of_file;
use crate::model::{Choice, Detrend, Material, Missing};
use crate::physics::jkr::Asperity;
use crate::physics::measured::find_measured;
use crate::physics::summits::Summit;
use crate::physics::validity::{Flattening, LEAST_TABOR, measured_flattening};
use crate::spec::{CaseParams, SurfaceParams, quoted};
use crate::stages::{Imported, measure};
use crate::stats::{Limit, significant};
use crate::store::hdf5::{SurfaceHeader, read_surface, write_surface, write_tamaas};
use crate::store::scan::export::write_netcdf3;
use crate::text::{counted, wrapped};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

pub(super) fn import(asked: &ImportArguments) -> Result<u8, Fault> {
    let refused = |why: &dyn std::fmt::Display| failed(format!("cannot import {}: {why}", asked.file.display()));
    recognize(&asked.file).map_err(|error| refused(&error))?.map_err(|refusal| refused(&refusal))?;
    let digest = digest_of_file(&asked.file).map_err(|error| refused(&error))?;
    let params = params(asked);
    if params.periodic && params.detrend != Detrend::Mean {
        let shape = params.detrend.word();
        let text = format!(
            "error: --detrend {shape} with --periodic: the removed shape is not periodic\nhelp: leave --detrend out, or --periodic"
        );
        return Err(Fault { code: BAD_SPEC, text });
    }
    if let Some(pixel_m) = asked.pixel_m.filter(|pixel| !(*pixel > 0.0 && pixel.is_finite())) {
        return Err(failed(format!(
            "cannot import {}: --pixel-m is {pixel_m}\nhelp: give a positive number of metres",
            asked.file.display()
        )));
    }
    let Imported { prepared, header, height_factor_m } = measure(&params, &digest, "").map_err(failed)?;
    let out = asked.out.clone().unwrap_or_else(|| named_after(&asked.file));
    if !asked.dry_run {
        may_be_written(&asked.file, &out)?;
    }
    if !asked.dry_run && out.exists() && !asked.force {
        return Err(failed(format!("cannot write the surface to {}: the file exists\nhelp: use another --out, or --force", out.display())));
    }
    let points = header.measured.as_ref().map_or(0.0, |of| of.shortest_wavelength_m) * prepared.heights_m.nrows() as f64 / header.length_m;
    let (summits, edge) = find_measured(prepared.heights_m.view(), header.length_m, (header.periodic, points)).map_err(failed)?;
    if !asked.dry_run {
        write_surface(&out, &header, prepared.heights_m.view()).map_err(failed)?;
    }
    let written = (!asked.dry_run).then_some(out.as_path());
    let shortest_m = header.measured.as_ref().map_or(0.0, |of| of.shortest_wavelength_m);
    let shape = (header.length_m, header.periodic);
    let unit = measured_flattening(prepared.heights_m.view(), shape, shortest_m, 1.0).map_err(failed)?;
    let range = Range::of(&unit, summits.list.iter().map(Summit::radius_m));
    let counts = [prepared.heights_m.nrows(), summits.list.len(), edge];
    if asked.json {
        let rings: Vec<Value> = prepared
            .rings
            .iter()
            .map(|ring| json!({ "wavenumber_1_m": ring.wavenumber_1_m, "density_m4": ring.density_m4, "mode_count": ring.mode_count }))
            .collect();
        say(&format!("{:#}\n", answer((&header, height_factor_m), &range, (counts, rings), written)))?;
    } else {
        say(&told(&asked.file, (&header, height_factor_m), &range, (counts, written)))?;
    }
    Ok(0)
}

fn params(asked: &ImportArguments) -> SurfaceParams {
    let default = if asked.periodic { Detrend::Mean } else { Detrend::Plane };
    SurfaceParams {
        file: asked.file.to_string_lossy().into_owned(),
        dataset: asked.dataset.clone().unwrap_or_default(),
        periodic: asked.periodic,
        pixel_m: asked.pixel_m.unwrap_or_default(),
        unit: asked.unit.clone().unwrap_or_default(),
        missing: if asked.fill { Missing::Fill } else { Missing::Refuse },
        detrend: asked.detrend.as_deref().and_then(Detrend::from_word).unwrap_or(default),
        points_per_shortest_wavelength: u32::from(asked.points),
        ..SurfaceParams::default()
    }
}

/// `<name of the file>.h5` in the present folder, and of one in HDF5 `<name of the file>_taken.h5`, which is not the file itself.
fn named_after(file: &Path) -> PathBuf {
    let mut name = file.file_stem().unwrap_or(file.as_os_str()).to_owned();
    let own = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("h5"));
    name.push(if own { "_taken.h5" } else { ".h5" });
    PathBuf::from(name)
}

/// Refuses to overwrite the scan itself, and anything that is not a file.
fn may_be_written(scan: &Path, out: &Path) -> Result<(), Fault> {
    let refused = |why: &str| failed(format!("cannot write the surface to {}: {why}\nhelp: use another --out", out.display()));
    let Ok(there) = std::fs::metadata(out) else { return Ok(()) };
    if !there.is_file() {
        return Err(refused("it is not a regular file"));
    }
    let same = |a: &Path, b: &Path| matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    if same(scan, out) { Err(refused("it is the measured surface itself")) } else { Ok(()) }
}

/// Range of the asperity model on a surface: the elastic energies that flatten its roughness are proportional to E*.
struct Range {
    /// `U_el/E*` \[m\], of all roughness.
    whole_m: f64,
    /// `U_1/E*` \[m\], of the shortest octave; 0 where that is unknown.
    octave_m: f64,
    /// Smallest radius of an asperity \[m\]; nothing without asperities.
    radius_m: Option<f64>,
}

/// Work of adhesion of the printed spec \[J/m²\].
const ADHESION_J_M2: f64 = 0.05;

/// Modulus of the printed spec over the smallest one inside the range, at least.
const MARGIN: f64 = 1.5;

/// Limits of `U_el/Δγ` and `U_1/Δγ`.
fn limits() -> [f64; 2] {
    ["sticky", "conformed"].map(|code| Limit::of(code).map_or(f64::NAN, |limit| limit.bound))
}

impl Range {
    /// Of the energies at a modulus of 1 Pa, and the radii of the asperities \[m\].
    fn of(unit: &Flattening, radii_m: impl Iterator<Item = f64>) -> Self {
        Self { whole_m: unit.whole_j_m2, octave_m: unit.octave_j_m2, radius_m: radii_m.reduce(f64::min) }
    }

    /// The ratios `U_el/Δγ` and `U_1/Δγ` of a material.
    fn ratios(&self, modulus_pa: f64, adhesion_j_m2: f64) -> [f64; 2] {
        [self.whole_m, self.octave_m].map(|length| modulus_pa * length / adhesion_j_m2)
    }

    /// Smallest `E*/Δγ` inside the range \[1/m\]: both ratios are at their limits or above.
    fn least_1_m(&self) -> f64 {
        let [whole, octave] = limits();
        let of_octave = if self.octave_m > 0.0 { octave / self.octave_m } else { 0.0 };
        of_octave.max(whole / self.whole_m)
    }

    /// A round modulus inside the range for [`ADHESION_J_M2`] \[Pa\]; the largest of a spec if that is smaller.
    fn modulus_pa(&self) -> f64 {
        let least = MARGIN * self.least_1_m() * ADHESION_J_M2;
        let decade = 10_f64.powf(least.log10().floor());
        let round = [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * decade).find(|modulus| *modulus >= least);
        round.unwrap_or(f64::INFINITY).clamp(1.0, 1e13)
    }

    /// The condition as a paragraph.
    fn text(&self) -> String {
        let [whole, octave] = limits();
        let octave = if self.octave_m > 0.0 { format!(" and U_1/Δγ ≥ {octave}") } else { String::new() };
        format!(
            "U_el/Δγ ≥ {whole}{octave}, that is E*/Δγ ≥ {:.2e} 1/m. U_el = E* x {:.3e} m flattens all roughness, U_1 = E* x {:.3e} m its shortest octave. \
             A softer or more adhesive contact is outside the range of the asperity model.",
            self.least_1_m(),
            self.whole_m,
            self.octave_m
        )
    }

    /// Material and model of the printed spec.
    fn spec(&self, periodic: bool) -> String {
        let modulus = self.modulus_pa();
        let [whole, octave] = self.ratios(modulus, ADHESION_J_M2).map(|ratio| significant(ratio, 2));
        let [at_least, and] = limits();
        let ratios = format!("# U_el/Δγ = {whole} (limit ≥ {at_least}), U_1/Δγ = {octave} (limit ≥ {and})");
        let mut text = format!("[material]      {ratios}\ncontact_modulus_pa = {modulus:e}\nwork_of_adhesion_j_m2 = {ADHESION_J_M2}\n");
        let range_m = CaseParams::default().material.interaction_range_m;
        let material = Material { contact_modulus_pa: modulus, work_of_adhesion_j_m2: ADHESION_J_M2, interaction_range_m: range_m };
        let asperity = self.radius_m.and_then(|radius| Asperity::new(radius, &material).ok());
        let tabor = asperity.map(|asperity| asperity.tabor(range_m));
        let jump_in = tabor.filter(|tabor| *tabor < LEAST_TABOR).map(|tabor| {
            format!("jump_in = \"jkr\"      # Tabor parameter μ ≥ {}; \"wu\" requires {LEAST_TABOR}\n", significant(tabor, 2))
        });
        let boundary = (!periodic).then(|| "boundary = \"isolated\"\n".to_owned());
        let model: Vec<String> = [boundary, jump_in].into_iter().flatten().collect();
        if !model.is_empty() {
            text += &format!("[model]\n{}", model.concat());
        }
        text
    }
}

/// The statistics of a surface as JSON.
fn answer(
    (header, height_factor_m): (&SurfaceHeader, Option<f64>),
    range: &Range,
    ([points, summits, edge], rings): ([usize; 3], Vec<Value>),
    written: Option<&Path>,
) -> Value {
    let measured = header.measured.as_ref();
    let fit = measured
        .and_then(|of| of.fit)
        .map(|fit| json!({ "hurst": fit.hurst, "plateau_m4": fit.plateau_m4, "roll_off_1_m": fit.roll_off_1_m, "scatter": fit.scatter }));
    json!({
        "file": written.map(|path| path.display().to_string()),
        "point_count": points,
        "length_m": header.length_m,
        "height_factor_m": height_factor_m,
        "periodic": header.periodic,
        "rms_height_m": header.rms_height_m,
        "rms_slope": header.rms_slope,
        "rms_curvature_1_m": header.rms_curvature_1_m,
        "rms_laplacian_1_m": header.rms_curvature_1_m,
        "nayak_parameter": header.nayak_parameter,
        "summit_count": summits,
        "edge_count": edge,
        "source_point_counts": measured.map(|of| of.source_point_counts),
        "source_spacings_m": measured.map(|of| of.source_spacings_m),
        "cautions": cautions(header),
        "missing_count": measured.map(|of| of.missing_count),
        "trend_m": measured.map(|of| of.trend_m),
        "noise_m": measured.map(|of| of.noise_m),
        "shortest_wavelength_m": measured.map(|of| of.shortest_wavelength_m),
        "source_blake3": measured.map(|of| of.source_blake3.as_str()),
        "self_affine": fit,
        "flattening_m": range.whole_m,
        "flattening_octave_m": range.octave_m,
        "least_modulus_over_adhesion_1_m": range.least_1_m(),
        "spectrum": rings,
    })
}

/// The same as text of at most 80 columns.
fn told(
    file: &Path,
    (header, height_factor_m): (&SurfaceHeader, Option<f64>),
    range: &Range,
    ([points, summits, edge], written): ([usize; 3], Option<&Path>),
) -> String {
    let (length, rms) = (header.length_m, header.rms_height_m);
    let area = length * length;
    let nayak = header.moments().summit_density_1_m2() * area;
    let mut text = format!("{}\n", file.display());
    let mut line = |what: &str, value: String| text += &format!("  {what:<14}{value}\n");
    let continued = if header.periodic { "periodic" } else { "not periodic" };
    if let Some(of) = &header.measured {
        let ([rows, columns], [a, b]) = (of.source_point_counts, of.source_spacings_m);
        line("file", format!("{rows} x {columns} points, {a:.4e} m by {b:.4e} m apart"));
        line("", "rows x columns; the row index runs along x".to_owned());
        if (a / b - 1.0).abs() > 1e-3 {
            line("", format!("interpolated to points {:.4e} m apart both ways", a.min(b)));
        }
    }
    match height_factor_m {
        Some(factor) => line("height factor", format!("{} m per number of the file", significant(factor, 6))),
        None => line("height factor", "1 (surface of this program, in metres)".to_owned()),
    }
    line("square", format!("{points} x {points} points, {length:.4e} m, {continued}"));
    if let Some(of) = &header.measured {
        line(
            "missing",
            format!(
                "{}{}",
                counted(usize::try_from(of.missing_count).unwrap_or(usize::MAX), "point"),
                if of.missing_count > 0 { ", interpolated (harmonic in-fill)" } else { "" }
            ),
        );
        let what =
            if of.detrend == Detrend::Mean { "the mean".to_owned() } else { format!("a {}: {:.3e} m rms", shape(of.detrend), of.trend_m) };
        line("removed", what);
        line("", format!("wavelengths below {:.3e} m: {:.3e} m rms", of.shortest_wavelength_m, of.noise_m));
    }
    line("heights", format!("{rms:.4e} m rms, slope {:.4} rms, Laplacian {:.3e} 1/m rms", header.rms_slope, header.rms_curvature_1_m));
    line("", format!("mean curvature {:.3e} 1/m rms: half the Laplacian", 0.5 * header.rms_curvature_1_m));
    line("summits", format!("{summits}, and {nayak:.0} predicted by Nayak (bandwidth parameter {:.2})", header.nayak_parameter));
    if edge > 0 {
        line("", format!("{edge} more near the edge are excluded"));
    }
    match header.measured.as_ref().and_then(|of| of.fit) {
        Some(fit) => {
            line("self-affine", format!("H = {:.3}, C0 = {:.3e} m⁴, scatter {:.2} decades", fit.hurst, fit.plateau_m4, fit.scatter));
            let longest = TAU / fit.roll_off_1_m;
            let rolls = if longest < 0.7 * length { format!("at {longest:.3e} m") } else { "none within the scan".to_owned() };
            line("roll-off", rolls);
        }
        None => line("self-affine", "no fit".to_owned()),
    }
    text += &wrapped(&format!("  {:<14}{}", "model range", range.text()), "                ");
    for caution in cautions(header) {
        text += &wrapped(&format!("warning: {caution}"), "  ");
    }
    match written {
        Some(path) => {
            let periodic = if header.periodic { "periodic = true\n" } else { "" };
            let stem: String =
                path.file_stem().unwrap_or_default().to_string_lossy().chars().filter(|c| c.is_ascii_alphanumeric()).take(32).collect();
            let file = quoted(&path.to_string_lossy());
            text += &format!("Written: {}. Spec for this surface; replace the material constants:\n\n", path.display());
            text += &format!("name = \"of_{stem}\"\n[surface]\nfile = {file}\n{periodic}{}", range.spec(header.periodic));
            text += "[cycle]\nmax_load = [0.004]       # F/(E* A0)\n";
        }
        None => text += "No file was written.\n",
    }
    text
}

/// Fraction of a scan that the central crop may drop without a warning.
const DROPPED: f64 = 0.1;

/// Warnings: what the central square leaves out, units or values that are unlikely, and a spectrum that is not self-affine.
fn cautions(header: &SurfaceHeader) -> Vec<String> {
    let mut cautions = Vec::new();
    if let Some(of) = &header.measured {
        let ([rows, columns], dropped) = (of.source_point_counts, of.dropped(header.length_m));
        if dropped > DROPPED {
            let points = (header.length_m / of.source_spacings_m[0].min(of.source_spacings_m[1])).round();
            let [a, b] = [rows as f64 * of.source_spacings_m[0], columns as f64 * of.source_spacings_m[1]];
            cautions.push(format!(
                "crop: {:.0} % of the scan ({rows} x {columns} points, {a:.3e} m x {b:.3e} m) is outside the central square and dropped (limit {:.0} %); \
                 {points} x {points} points remain, and all results are of these",
                100.0 * dropped,
                100.0 * DROPPED
            ));
        }
        match of.fit {
            Some(fit) if !(0.0..=1.0).contains(&fit.hurst) => cautions.push(format!(
                "fit: H = {:.2} is outside 0 to 1, so the spectrum is not self-affine between the longest wavelength and the cut-off; do not use H",
                fit.hurst
            )),
            Some(_) => {}
            None => cautions.push("fit: too few wavelengths above the cut-off for a self-affine fit; use a larger scan, or a lower cut-off (--points)".to_owned()),
        }
    }
    if header.rms_slope > 1.0 {
        cautions.push(format!(
            "an rms slope of {:.3} is steeper than 45 degrees; check the units, and values of missing points",
            header.rms_slope
        ));
    }
    if header.rms_slope < 1e-5 {
        cautions.push(format!("an rms slope of {:.1e} is flatter than any measured surface; check the units", header.rms_slope));
    }
    if header.rms_height_m < 1e-10 {
        cautions.push(format!("{:.1e} m rms is less than an atom; check the units", header.rms_height_m));
    }
    cautions
}

fn shape(detrend: Detrend) -> &'static str {
    match detrend {
        Detrend::Mean => "mean",
        Detrend::Plane => "plane",
        Detrend::Quadratic => "quadratic surface",
    }
}

/// Where an exported surface goes to, and in which layout.
pub(super) enum Layout {
    /// NetCDF-3 as SurfaceTopography reads it.
    NetCdf,
    /// HDF5 as Tamaas reads it.
    Tamaas,
}

pub(super) fn export(asked: &ExportArguments, layout: &Layout) -> Result<u8, Fault> {
    let (header, heights) = read_surface(&asked.surface).map_err(failed)?;
    let size = [header.length_m; 2];
    let note = match layout {
        Layout::NetCdf => {
            write_netcdf3(&asked.out, heights.view(), size, header.periodic).map_err(failed)?;
            ""
        }
        Layout::Tamaas => {
            write_tamaas(&asked.out, heights.view(), size).map_err(failed)?;
            if header.periodic { "" } else { "warning: Tamaas assumes a periodic surface; this one is not periodic\n" }
        }
    };
    say(&format!("Written: {}\n{note}", asked.out.display()))?;
    Ok(0)
}
