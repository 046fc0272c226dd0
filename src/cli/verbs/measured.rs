//! `import`: a measured surface as the model takes it, and what its spectrum says; and `export` of surfaces
//! to other programs.

mod inputs;
mod kinds;
mod loops;
mod quality;
mod range;
mod several;
mod several_text;
mod taken;
mod text;

use super::outputs::{may_be_written, undamaged_surface};
use super::{BAD_SPEC, Fault, failed, say};
use crate::cli::{ExportArguments, ImportArguments};
use crate::constants::{Constant, Constants};
use crate::formats::recognize;
use crate::keys::digest_of_file;
use crate::lengths::sizes;
use crate::model::MeasuredSurface;
use crate::model::{Choice, Detrend, FastAxis, Filter, Missing};
use crate::stages::{Examined, Imported, measure};
use crate::store::hdf5::{read_surface, write_surface, write_tamaas};
use crate::store::scan::export::write_netcdf3;
use range::Range;
use std::path::{Path, PathBuf};
use text::{Statistics, answer, text};

/// Limits of the warnings of `import`.
pub(in crate::cli) const LIMITS: Constants = Constants {
    subject: "Warnings of `import`",
    module: "cli",
    rows: &[
        Constant::new(
            "part outside the central square",
            &[text::DROPPED],
            "of the scan",
            "With more, the warning `crop` is printed.",
            "",
        ),
        Constant::new(
            "rms slope",
            &[text::FLAT, text::STEEP],
            "",
            "Outside this range the units are probably wrong.",
            "",
        ),
        Constant::new("rms height", &[text::LOW_M], "m", "Below it the units are probably wrong.", ""),
    ],
};

/// Pixels per cut-off wavelength of the S-filter without `--points`.
const POINTS: u32 = 8;

pub(super) fn import(asked: &ImportArguments) -> Result<u8, Fault> {
    if asked.files.len() > 1 && asked.files.iter().any(|file| loops::is_meant(asked, file)) {
        return loops::import_all(asked);
    }
    if inputs::are_several(&asked.files)? {
        return several::import(asked);
    }
    let file = &asked.files[0];
    recognize(file)
        .map_err(|error| inputs::unreadable(file, &error))?
        .map_err(|refusal| failed(format!("cannot import {}: {refusal}", file.display())))?;
    if loops::is_meant(asked, file) { loops::import(asked, file) } else { surface(asked, file) }
}

/// Checks options for surfaces that no single one shows, and that none is for loops.
fn check_options(asked: &ImportArguments, file: &Path) -> Result<(), Fault> {
    kinds::no_options_of_loops(asked, file)?;
    let params = params(asked, file)?;
    if params.periodic && params.detrend != Detrend::Mean {
        let shape = params.detrend.word();
        let text = format!(
            "error: --detrend {shape} with --periodic: the removed shape is not periodic\nhelp: leave \
             --detrend out, or --periodic"
        );
        return Err(Fault { code: BAD_SPEC, text });
    }
    for (name, length) in [("pixel-m", asked.pixel_m), ("tip-radius", asked.tip_radius)] {
        if let Some(length) = length.filter(|length| !(*length > 0.0 && length.is_finite())) {
            let file = file.display();
            return Err(failed(format!(
                "cannot import {file}: --{name} is {length}\nhelp: give a positive number of metres"
            )));
        }
    }
    Ok(())
}

/// Imports a measured surface.
fn surface(asked: &ImportArguments, file: &Path) -> Result<u8, Fault> {
    let refused = |why: &dyn std::fmt::Display| failed(format!("cannot import {}: {why}", file.display()));
    let digest = digest_of_file(file).map_err(|error| refused(&error))?;
    check_options(asked, file)?;
    let params = params(asked, file)?;
    let Imported { prepared, header, height_factor_m, notes } =
        measure(&params, &digest, "").map_err(failed)?;
    let out = asked.out.clone().unwrap_or_else(|| named_after(file));
    if !asked.dry_run {
        may_be_written("the surface", &out, file, asked.force)?;
    }
    let examined = Examined::of_measured(&header, prepared.heights_m.view()).map_err(failed)?;
    if !asked.dry_run {
        write_surface(&out, &header, prepared.heights_m.view()).map_err(failed)?;
    }
    let written = (!asked.dry_run).then_some(out.as_path());
    let range = Range::of(&examined);
    let counts = [prepared.heights_m.nrows(), examined.estimates.summit_count, examined.edge_count];
    let statistics = Statistics {
        file,
        header: &header,
        height_factor_m,
        notes: &notes,
        range: &range,
        counts,
        fitted_1_m: prepared.fit.as_ref().filter(|_| height_factor_m.is_some()).map(|fit| fit.band_1_m),
        written,
    };
    if asked.json {
        say(&format!("{:#}\n", answer(&statistics, &prepared.rings)))?;
    } else {
        say(&text(&statistics))?;
    }
    Ok(0)
}

fn params(asked: &ImportArguments, file: &Path) -> Result<MeasuredSurface, Fault> {
    let default = if asked.periodic { Detrend::Mean } else { Detrend::Plane };
    let [size_m, size_y_m] = size_m(asked, file)?;
    Ok(MeasuredSurface {
        file: file.to_string_lossy().into_owned(),
        files: Vec::new(),
        dataset: asked.dataset.clone().unwrap_or_default(),
        periodic: asked.periodic,
        pixel_m: asked.pixel_m.unwrap_or_default(),
        size_m,
        size_y_m,
        skip_lines: asked.skip_lines.unwrap_or_default(),
        width: asked.width.unwrap_or_default(),
        transpose: asked.transpose,
        unit: asked.unit.clone().unwrap_or_default(),
        missing: if asked.fill { Missing::Fill } else { Missing::Refuse },
        detrend: asked.detrend.as_deref().and_then(Detrend::from_word).unwrap_or(default),
        filter: asked.filter.as_deref().and_then(Filter::from_word).unwrap_or(Filter::Gaussian),
        outliers: asked.outliers,
        align_rows: asked.align_rows,
        fast_axis: asked.fast_axis.as_deref().and_then(FastAxis::from_word).unwrap_or(FastAxis::Auto),
        tip_radius_m: asked.tip_radius.unwrap_or_default(),
        points_per_shortest_wavelength: asked.points.map_or(POINTS, u32::from),
    })
}

/// Sizes along x and y \[m\] by `--size`; 0 where they are not stated.
fn size_m(asked: &ImportArguments, file: &Path) -> Result<[f64; 2], Fault> {
    let Some(text) = &asked.size else { return Ok([0.0; 2]) };
    let read = sizes(text).filter(|sizes| sizes.iter().all(|size| (1e-9..=100.0).contains(size)));
    match read.as_deref() {
        Some([x]) => Ok([*x, 0.0]),
        Some([x, y]) => Ok([*x, *y]),
        _ => {
            let help = "give the size along x, or along x and y, with a unit of length (5um, \"5um x 3um\") \
                 or in metres (5e-6)";
            Err(failed(format!("cannot import {}: --size is {text:?}\nhelp: {help}", file.display())))
        }
    }
}

/// `<name of the file>.h5` in the present folder, and of one in HDF5 `<name of the file>_taken.h5`, which is
/// not the file itself.
fn named_after(file: &Path) -> PathBuf {
    let mut name = file.file_stem().unwrap_or(file.as_os_str()).to_owned();
    let own = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("h5"));
    name.push(if own { "_taken.h5" } else { ".h5" });
    PathBuf::from(name)
}

/// File format of an exported surface.
pub(super) enum Layout {
    /// NetCDF-3 as SurfaceTopography reads it.
    NetCdf,
    /// HDF5 as Tamaas reads it.
    Tamaas,
}

pub(super) fn export(asked: &ExportArguments, layout: &Layout) -> Result<u8, Fault> {
    may_be_written("the surface", &asked.out, &asked.surface, asked.force)?;
    undamaged_surface(&asked.surface)?;
    let (header, heights) = read_surface(&asked.surface).map_err(failed)?;
    let size = [header.length_m; 2];
    let note = match layout {
        Layout::NetCdf => {
            write_netcdf3(&asked.out, heights.view(), size, header.periodic).map_err(failed)?;
            ""
        }
        Layout::Tamaas => {
            write_tamaas(&asked.out, heights.view(), size).map_err(failed)?;
            if header.periodic {
                ""
            } else {
                "warning: Tamaas assumes a periodic surface; this one is not periodic\n"
            }
        }
    };
    say(&format!("Written: {}\n{note}", asked.out.display()))?;
    Ok(0)
}
