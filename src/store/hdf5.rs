//! Surfaces in HDF5.

use std::fs;
use std::path::Path;

use hdf5_metno::file::LibraryVersion;
use hdf5_metno::types::VarLenUnicode;
use hdf5_metno::{Dataset, File, FileBuilder};
use ndarray::{Array2, ArrayView2, s};

use super::axes;
use super::commit::{Written, commit};
use super::dataset::{Outside, dataset, only_field};
use super::error::{Cause, StoreError, fenced};
pub use super::quality::Quality;
use super::scan::room;
pub use super::surface_header::{Generated, Measured, SURFACE_VERSION, SpectrumFit, SurfaceHeader};
use super::{attributes, surface_header};

/// Does something while no other thread is in the HDF5 library, which ends with the program and must not be
/// in use then.
pub fn alone<T>(act: impl FnOnce() -> T) -> T {
    hdf5_metno::sync::sync(act)
}

/// Name of the height field in a surface file.
pub const HEIGHT: &str = "height_m";
/// Help for heights that differ from the heights written.
const DAMAGED: &str = "restore the file, or run `hysteron verify DIR --deep` and `hysteron run DIR` for the \
                       output folder it is in; after a change on purpose, delete the attribute \
                       `height_blake3` of its group `header`";
/// Rows that are written and compared at once.
const BAND: usize = 256;

/// Writes a surface in place of `path`: heights from the mean plane \[m\], rows along x.
///
/// # Errors
/// If the field is not square, empty or not finite, or the file cannot be written whole; what was at `path`
/// is then still there.
pub fn write_surface(
    path: &Path,
    header: &SurfaceHeader,
    heights: ArrayView2<'_, f64>,
) -> Result<Written, StoreError> {
    commit(
        "write the surface to",
        path,
        |temporary| library(|| write_all(temporary, header, heights)),
        |temporary| library(|| check_all(temporary, header, heights)),
    )
}

/// Reads a surface that [`write_surface`] wrote.
///
/// # Errors
/// If the file cannot be read, is damaged, or is no surface of this program.
pub fn read_surface(path: &Path) -> Result<(SurfaceHeader, Array2<f64>), StoreError> {
    library(|| {
        let file = open(path)?;
        let header = surface_header::read(&file)?;
        let data = heights_of(path, &file)?;
        let heights = field(&data, HEIGHT)?;
        match surface_header::read_sum(&file)? {
            Some(sum) if sum != sum_of(heights.view()) => {
                Err(format!("its dataset {HEIGHT:?} differs from its checksum\nhelp: {DAMAGED}").into())
            }
            _ => Ok((header, heights)),
        }
    })
    .map_err(|cause| StoreError::new("read the surface from", path, cause))
}

/// Reads what a surface file says of its surface, without the heights.
///
/// # Errors
/// As [`read_surface`].
pub fn read_header(path: &Path) -> Result<SurfaceHeader, StoreError> {
    library(|| {
        let file = open(path)?;
        heights_of(path, &file)?;
        surface_header::read(&file)
    })
    .map_err(|cause| StoreError::new("read the header of the surface", path, cause))
}

/// Checks that the heights [`read_scan`](super::hdf5_scan::read_scan) or [`read_surface`] would read lie in
/// the file itself.
///
/// # Errors
/// The other file, and what to do. A file that cannot be opened, or has no such dataset, is no error here.
pub fn check_inside(path: &Path, name: Option<&str>) -> Result<(), String> {
    let refusal = library(|| {
        let file = open(path)?;
        let read = match name {
            Some(name) => dataset(&file, name).map(drop),
            None if is_own(&file)? => dataset(&file, HEIGHT).map(drop),
            None => only_field(&file).map(drop),
        };
        Ok(read.err().filter(|cause| cause.is::<Outside>()).map(|cause| cause.to_string()))
    });
    refusal.ok().flatten().map_or(Ok(()), Err)
}

/// BLAKE3 of the heights as little-endian numbers, row after row.
fn sum_of(heights: ArrayView2<'_, f64>) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut bytes = Vec::new();
    for row in heights.rows() {
        bytes.clear();
        bytes.extend(row.iter().flat_map(|height| height.to_le_bytes()));
        hasher.update(&bytes);
    }
    hasher.finalize().to_hex().to_string()
}

/// True if a file is a surface of this program, by its attributes.
#[must_use]
pub fn is_own_surface(path: &Path) -> bool {
    library(|| is_own(&open(path)?)).unwrap_or(false)
}

fn is_own(file: &File) -> Result<bool, Cause> {
    Ok(file.attr_names()?.iter().any(|name| name == "schema_version"))
}

/// Writes a height field \[m\] as Tamaas' `H5Dumper` does, to be opened with its `read`: the field
/// `surface` of a model of the type `basic_2d`.
///
/// # Errors
/// If the file cannot be written whole.
pub fn write_tamaas(
    path: &Path,
    heights: ArrayView2<'_, f64>,
    size_m: [f64; 2],
) -> Result<Written, StoreError> {
    commit(
        "write the surface to",
        path,
        |temporary| {
            library(|| {
                let file = options().create(temporary)?;
                // Tamaas requires a string of variable length here, and only fields in the root.
                let kind: VarLenUnicode = "model_type.basic_2d".parse()?;
                file.new_attr::<VarLenUnicode>().create("model_type")?.write_scalar(&kind)?;
                file.new_attr::<f64>().shape(2).create("system_size")?.write(&size_m)?;
                let points = [heights.nrows() as i64, heights.ncols() as i64];
                file.new_attr::<i64>().shape(2).create("discretization")?.write(&points)?;
                let data = file.new_dataset::<f64>().shape(heights.dim()).create(TAMAAS_FIELD)?;
                data.write(heights.as_standard_layout().view())?;
                file.flush()?;
                drop(data);
                Ok(file.close()?)
            })
        },
        |temporary| {
            library(|| {
                let same = open(temporary)?.dataset(TAMAAS_FIELD)?.read_2d::<f64>()? == heights;
                if same {
                    Ok(())
                } else {
                    Err("the content read back differs from the content written".into())
                }
            })
        },
    )
}

/// Name of the height field in a file for Tamaas.
const TAMAAS_FIELD: &str = "surface";

/// Runs code of the HDF5 library and puts its error into words at once, while its error stack still exists.
pub(super) fn library<T>(work: impl FnOnce() -> Result<T, Cause>) -> Result<T, Cause> {
    fenced(work).map_err(|cause| cause.to_string().into())
}

/// Options of a file in format 1.10: its metadata have checksums, so that damage is an error and not another
/// surface.
pub(super) fn options() -> FileBuilder {
    options_of(LibraryVersion::V110)
}

/// Options of a file whose objects have the form of a version of the format, which readers without the HDF5
/// library may need.
///
/// The form of attributes is the usual one: these readers open no file with another limit between the two
/// forms.
pub(super) fn options_of(version: LibraryVersion) -> FileBuilder {
    let mut options = File::with_options();
    options.with_fapl(|access| {
        access
            // The upper bound too, so that the file does not change with the library.
            .libver_bounds(version, LibraryVersion::V110)
            // A file is never written under its own name, so there is nothing to lock; and some file systems
            // cannot.
            .file_locking(false)
    });
    // No times, so that equal surfaces are equal bytes.
    options.with_fcpl(|create| create.obj_track_times(false));
    options
}

pub(super) fn open(path: &Path) -> Result<File, Cause> {
    // HDF5 reports "unable to open file" for all causes; the operating system gives the cause.
    let about = fs::metadata(path)?;
    if about.is_dir() {
        return Err("it is a directory".into());
    }
    if !about.is_file() {
        return Err("it is not a regular file".into());
    }
    fs::File::open(path)?;
    Ok(options().open(path)?)
}

fn write_all(path: &Path, header: &SurfaceHeader, heights: ArrayView2<'_, f64>) -> Result<(), Cause> {
    let (rows, columns) = heights.dim();
    if rows != columns || rows == 0 {
        return Err(format!("its field has {rows} by {columns} heights, and must be square").into());
    }
    if let Some(((row, column), height)) = heights.indexed_iter().find(|(_, height)| !height.is_finite()) {
        return Err(
            format!("its height in row {row}, column {column} is {height}, and must be finite").into()
        );
    }
    let (file, kind) = axes::start(path, &options())?;
    surface_header::write(&file, header)?;
    surface_header::write_sum(&file, &sum_of(heights))?;
    // Contiguous: some readers do not support the index of chunks of this format.
    let data = file.new_dataset::<f64>().shape((rows, rows)).create(HEIGHT)?;
    attributes::write_text(&data, "unit", "m")?;
    axes::write(&file, &kind, &data, header.length_m)?;
    for first in (0..rows).step_by(BAND) {
        let band = first..rows.min(first + BAND);
        // HDF5 requires a contiguous band; if the field is not contiguous, this copy needs the memory of one
        // band.
        let values = heights.slice(s![band.clone(), ..]);
        data.write_slice(values.as_standard_layout().view(), s![band, ..])?;
    }
    // Flushed while the dataset is open: closing it also writes the rest, but does not report a failure.
    file.flush()?;
    drop(data);
    file.close()?;
    Ok(())
}

fn check_all(path: &Path, header: &SurfaceHeader, heights: ArrayView2<'_, f64>) -> Result<(), Cause> {
    let file = open(path)?;
    let data = heights_of(path, &file)?;
    let mut same = surface_header::read(&file)? == *header && data.get_shape()? == heights.shape();
    same = same && axes::are_as_written(&file, heights.nrows(), header.length_m)?;
    for first in (0..heights.nrows()).step_by(BAND) {
        let band = first..heights.nrows().min(first + BAND);
        same = same && data.read_slice_2d::<f64, _>(s![band.clone(), ..])? == heights.slice(s![band, ..]);
    }
    if same { Ok(()) } else { Err("the content read back differs from the content written".into()) }
}

/// The height field of a surface file, square and no larger than the file.
fn heights_of(path: &Path, file: &File) -> Result<Dataset, Cause> {
    let data = dataset(file, HEIGHT)?.ok_or_else(|| format!("it has no dataset {HEIGHT:?}"))?;
    let (rows, columns) = check_extent(path, &data, HEIGHT, 1)?;
    if rows == columns {
        Ok(data)
    } else {
        Err(format!("its field has {rows} by {columns} heights, and must be square").into())
    }
}

/// Rows and columns of a dataset, checked against the size of the file before memory is allocated.
fn check_extent(path: &Path, data: &Dataset, name: &str, packed: u64) -> Result<(usize, usize), Cause> {
    let [rows, columns] = data.get_shape()?[..] else {
        return Err(format!("its dataset {name:?} is not two-dimensional").into());
    };
    check_bytes(path, data, [rows, columns], packed)
        .map_err(|cause| format!("its dataset {name:?} {cause}"))?;
    Ok((rows, columns))
}

/// Checks that a file of this size can hold these rows and columns of a dataset, packed by at most this
/// factor.
pub(super) fn check_bytes(
    path: &Path,
    data: &Dataset,
    [rows, columns]: [usize; 2],
    packed: u64,
) -> Result<(), Cause> {
    let most = fs::metadata(path)?.len().saturating_mul(packed);
    let width = data.dtype()?.size() as u64;
    let bytes = (rows as u64).checked_mul(columns as u64).and_then(|count| count.checked_mul(width));
    match bytes {
        Some(bytes) if bytes > 0 && bytes <= most => Ok(()),
        _ => Err(format!("claims {rows} by {columns} values, which a file of its size cannot hold").into()),
    }
}

/// A whole two-dimensional dataset, every value of which must be finite.
fn field(data: &Dataset, name: &str) -> Result<Array2<f64>, Cause> {
    let [rows, columns] = data.get_shape()?[..] else {
        return Err(format!("its dataset {name:?} is not two-dimensional").into());
    };
    let values = values(data, [rows, columns])?;
    match values.indexed_iter().find(|(_, value)| !value.is_finite()) {
        None => Ok(values),
        Some(((row, column), value)) => {
            Err(format!("its dataset {name:?} has {value} in row {row}, column {column}").into())
        }
    }
}

/// The values of a dataset of this extent, besides dimensions of a single point.
pub(super) fn values(data: &Dataset, [rows, columns]: [usize; 2]) -> Result<Array2<f64>, Cause> {
    let count = rows.checked_mul(columns).ok_or("its extent is too large")?;
    let mut values = room(count as u64)?;
    values.resize(count, 0.0);
    data.read_into_raw(&mut values)?;
    Ok(Array2::from_shape_vec((rows, columns), values)?)
}
