//! `import`: a measured surface as the model takes it, and what its spectrum says; and `export` of surfaces to other programs.

use super::{Fault, failed, say};
use crate::cli::{ExportArguments, ImportArguments};
use crate::keys::digest_of_file;
use crate::model::{Choice, Detrend, Missing};
use crate::physics::measured::find_measured;
use crate::spec::SurfaceParams;
use crate::stages::measure;
use crate::store::hdf5::{SurfaceHeader, read_surface, write_surface, write_tamaas};
use crate::store::scan::export::write_netcdf3;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

pub(super) fn import(asked: &ImportArguments) -> Result<u8, Fault> {
    let digest =
        digest_of_file(&asked.file).map_err(|error| failed(format!("cannot take the surface {}: {error}", asked.file.display())))?;
    let params = params(asked);
    let (prepared, header) = measure(&params, &digest, "").map_err(failed)?;
    let out = asked.out.clone().unwrap_or_else(|| named_after(&asked.file));
    if !asked.dry_run && out.exists() && !asked.force {
        return Err(failed(format!(
            "cannot write the surface to {}: it is there already; allowed: another --out, or --force",
            out.display()
        )));
    }
    let points = header.measured.as_ref().map_or(0.0, |of| of.shortest_wavelength_m) * prepared.heights_m.nrows() as f64 / header.length_m;
    let (summits, edge) = find_measured(prepared.heights_m.view(), header.length_m, (header.periodic, points)).map_err(failed)?;
    if !asked.dry_run {
        write_surface(&out, &header, prepared.heights_m.view()).map_err(failed)?;
    }
    let written = (!asked.dry_run).then_some(out.as_path());
    let counts = [prepared.heights_m.nrows(), summits.list.len(), edge];
    if asked.json {
        let rings: Vec<Value> = prepared
            .rings
            .iter()
            .map(|ring| json!({ "wavenumber_1_m": ring.wavenumber_1_m, "density_m4": ring.density_m4, "mode_count": ring.mode_count }))
            .collect();
        say(&format!("{:#}\n", answer(&header, counts, rings, written)))?;
    } else {
        say(&told(&asked.file, &header, counts, written))?;
    }
    Ok(0)
}

fn params(asked: &ImportArguments) -> SurfaceParams {
    SurfaceParams {
        file: asked.file.to_string_lossy().into_owned(),
        dataset: asked.dataset.clone().unwrap_or_default(),
        periodic: asked.periodic,
        pixel_m: asked.pixel_m.unwrap_or_default(),
        unit: asked.unit.clone().unwrap_or_default(),
        missing: if asked.fill { Missing::Fill } else { Missing::Refuse },
        detrend: Detrend::from_word(&asked.detrend).unwrap_or(Detrend::Plane),
        points_per_shortest_wavelength: u32::from(asked.points),
        ..SurfaceParams::default()
    }
}

/// `<name of the file>.h5` in the present folder.
fn named_after(file: &Path) -> PathBuf {
    PathBuf::from(file.file_stem().unwrap_or(file.as_os_str())).with_extension("h5")
}

/// What is known of a surface, as JSON.
fn answer(header: &SurfaceHeader, [points, summits, edge]: [usize; 3], rings: Vec<Value>, written: Option<&Path>) -> Value {
    let measured = header.measured.as_ref();
    let fit = measured
        .and_then(|of| of.fit)
        .map(|fit| json!({ "hurst": fit.hurst, "plateau_m4": fit.plateau_m4, "roll_off_1_m": fit.roll_off_1_m, "scatter": fit.scatter }));
    json!({
        "file": written.map(|path| path.display().to_string()),
        "point_count": points,
        "length_m": header.length_m,
        "periodic": header.periodic,
        "rms_height_m": header.rms_height_m,
        "rms_slope": header.rms_slope,
        "rms_curvature_1_m": header.rms_curvature_1_m,
        "nayak_parameter": header.nayak_parameter,
        "summit_count": summits,
        "edge_count": edge,
        "missing_count": measured.map(|of| of.missing_count),
        "trend_m": measured.map(|of| of.trend_m),
        "noise_m": measured.map(|of| of.noise_m),
        "shortest_wavelength_m": measured.map(|of| of.shortest_wavelength_m),
        "source_blake3": measured.map(|of| of.source_blake3.as_str()),
        "self_affine": fit,
        "spectrum": rings,
    })
}

/// The same in words, eighty columns wide.
fn told(file: &Path, header: &SurfaceHeader, [points, summits, edge]: [usize; 3], written: Option<&Path>) -> String {
    let (length, rms) = (header.length_m, header.rms_height_m);
    let area = length * length;
    let [m2, m4] = [0.5 * header.rms_slope.powi(2), 0.375 * header.rms_curvature_1_m.powi(2)];
    let nayak = m4 / (6.0 * std::f64::consts::PI * 3f64.sqrt() * m2) * area;
    let mut text = format!("{}\n", file.display());
    let mut line = |what: &str, value: String| text += &format!("  {what:<14}{value}\n");
    let continued = if header.periodic { "continues periodically" } else { "does not continue periodically" };
    line("square", format!("{points} x {points} points, {length:.4e} m, {continued}"));
    if let Some(of) = &header.measured {
        line(
            "missing",
            format!("{} points{}", of.missing_count, if of.missing_count > 0 { ", filled in as a membrane would be" } else { "" }),
        );
        let what =
            if of.detrend == Detrend::Mean { "the mean".to_owned() } else { format!("a {}: {:.3e} m rms", shape(of.detrend), of.trend_m) };
        line("taken off", what);
        line("", format!("waves below {:.3e} m: {:.3e} m rms", of.shortest_wavelength_m, of.noise_m));
    }
    line("heights", format!("{rms:.4e} m rms, slope {:.4} rms, curvature {:.3e} 1/m rms", header.rms_slope, header.rms_curvature_1_m));
    line("summits", format!("{summits}, and {nayak:.0} after Nayak (his parameter: {:.2})", header.nayak_parameter));
    if edge > 0 {
        line("", format!("{edge} more are too near to the edge and left out"));
    }
    match header.measured.as_ref().and_then(|of| of.fit) {
        Some(fit) => {
            line("self-affine", format!("H = {:.3}, C0 = {:.3e} m⁴, scatter {:.2} decades", fit.hurst, fit.plateau_m4, fit.scatter));
            if !(0.0..=1.0).contains(&fit.hurst) {
                line("", "H beyond 0 to 1: in this band it is not self-affine".to_owned());
            }
            let longest = TAU / fit.roll_off_1_m;
            let rolls = if longest < 0.7 * length { format!("at {longest:.3e} m") } else { "none within the scan".to_owned() };
            line("roll-off", rolls);
        }
        None => line("self-affine", "too few waves for a fit".to_owned()),
    }
    match written {
        Some(path) => {
            let boundary = if header.periodic { "periodic = true" } else { "[model]\nboundary = \"isolated\"" };
            text += &format!("Written: {}. In a spec:\n\n[surface]\nfile = \"{}\"\n{boundary}\n", path.display(), path.display());
        }
        None => text += "Nothing was written.\n",
    }
    text
}

fn shape(detrend: Detrend) -> &'static str {
    match detrend {
        Detrend::Mean => "mean",
        Detrend::Plane => "plane",
        Detrend::Quadratic => "surface of second order",
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
            if header.periodic { "" } else { "Caution: Tamaas takes every surface for periodic, and this one is not.\n" }
        }
    };
    say(&format!("Written: {}\n{note}", asked.out.display()))?;
    Ok(0)
}
