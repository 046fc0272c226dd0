//! Surfaces in HDF5.

use std::fs;
use std::path::Path;

use hdf5_metno::file::LibraryVersion;
use hdf5_metno::types::VarLenUnicode;
use hdf5_metno::{Dataset, File, FileBuilder};
use ndarray::{Array2, ArrayView2, s};

use super::axes;
use super::commit::{Written, commit};
use super::dataset::{Outside, dataset};
use super::error::{Cause, StoreError, fenced};
use super::scan::{MOST_POINTS, room};
use super::surface_header;
pub use super::surface_header::{Generated, Measured, SURFACE_VERSION, SpectrumFit, SurfaceHeader};

/// Does something while no other thread is in the HDF5 library, which ends with the program and must not be in use then.
pub fn alone<T>(act: impl FnOnce() -> T) -> T {
    hdf5_metno::sync::sync(act)
}

/// Name of the height field in a surface file.
pub const HEIGHT: &str = "height_m";
/// Rows and columns of a chunk.
const CHUNK: usize = 256;
/// A file cannot hold more than this many times its size: what deflate reaches on zeros. Own files are not packed.
const MOST_PACKED: u64 = 1100;

/// Writes a surface in place of `path`: heights from the mean plane \[m\], rows along x.
///
/// # Errors
/// If the field is not square, empty or not finite, or the file cannot be written whole; what was at `path` is then
/// still there.
pub fn write_surface(path: &Path, header: &SurfaceHeader, heights: ArrayView2<'_, f64>) -> Result<Written, StoreError> {
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
        Ok((header, field(&data, HEIGHT)?))
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

/// Reads a height field from any HDF5 file, a measured one for instance, where missing points may be no numbers. Without a name it is the only field in the root.
///
/// # Errors
/// If the file cannot be read, or has no two-dimensional dataset of numbers by that name.
pub fn read_heights(path: &Path, name: Option<&str>) -> Result<Array2<f64>, StoreError> {
    library(|| {
        let file = open(path)?;
        let name = match name {
            Some(name) => name.to_owned(),
            None => only_field(&file)?,
        };
        let Some(data) = dataset(&file, &name)? else {
            return Err(format!("no dataset {name:?}\nhelp: the root contains {}", file.member_names()?.join(", ")).into());
        };
        let (rows, columns) = check_extent(path, &data, &name, MOST_PACKED)?;
        if (rows as u64).saturating_mul(columns as u64) > MOST_POINTS {
            return Err(format!("dataset {name:?} has {rows} by {columns} values, more than the limit of 2^28").into());
        }
        values(&data, [rows, columns])
    })
    .map_err(|cause| StoreError::new("read the surface from", path, cause))
}

/// Checks that the heights [`read_heights`] or [`read_surface`] would read lie in the file itself.
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

/// The name of the one two-dimensional dataset in the root. What leaves the file does not count, unless there is nothing else.
fn only_field(file: &File) -> Result<String, Cause> {
    let (mut names, mut outside) = (Vec::new(), None);
    for name in file.member_names()? {
        match dataset(file, &name) {
            Ok(Some(data)) if data.ndim() == 2 => names.push(name),
            Ok(_) => {}
            Err(cause) => outside = Some(cause),
        }
    }
    match (&names[..], outside) {
        ([name], _) => Ok(name.clone()),
        ([], Some(cause)) => Err(cause),
        ([], None) => Err("no two-dimensional dataset in the root\nhelp: select one of another group as \"group/dataset\"".into()),
        (many, _) => {
            Err(format!("several two-dimensional datasets: {}\nhelp: select one with surface.dataset (--dataset)", many.join(", ")).into())
        }
    }
}

/// True if a file is a surface of this program, by its attributes.
#[must_use]
pub fn is_own_surface(path: &Path) -> bool {
    library(|| is_own(&open(path)?)).unwrap_or(false)
}

fn is_own(file: &File) -> Result<bool, Cause> {
    Ok(file.attr_names()?.iter().any(|name| name == "schema_version"))
}

/// Writes a height field \[m\] as Tamaas' `H5Dumper` does, to be opened with its `read`: the field `surface` of a model of the type `basic_2d`.
///
/// # Errors
/// If the file cannot be written whole.
pub fn write_tamaas(path: &Path, heights: ArrayView2<'_, f64>, size_m: [f64; 2]) -> Result<Written, StoreError> {
    commit(
        "write the surface to",
        path,
        |temporary| {
            library(|| {
                let file = options().create(temporary)?;
                // Tamaas wants a string of variable length here, and nothing but fields in the root.
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
                if same { Ok(()) } else { Err("the content read back differs from the content written".into()) }
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

pub(super) fn options() -> FileBuilder {
    let mut options = File::with_options();
    // Format 1.10: its metadata have checksums, so that damage is an error and not another surface. It is also the
    // upper bound, so that the file does not change with the library.
    options.with_fapl(|access| {
        access
            .libver_bounds(LibraryVersion::V110, LibraryVersion::V110)
            // A file is never written under its own name, so there is nothing to lock; and some file systems cannot.
            .file_locking(false)
    });
    // Neither times nor the second form that attributes take beyond eight, so that equal surfaces are equal bytes.
    options.with_fcpl(|create| create.obj_track_times(false).attr_phase_change(64, 0));
    options
}

pub(super) fn open(path: &Path) -> Result<File, Cause> {
    // HDF5 says "unable to open file" of whatever is wrong; the operating system knows better.
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
        return Err(format!("its height in row {row}, column {column} is {height}, and must be finite").into());
    }
    let (file, kind) = axes::start(path, &options())?;
    surface_header::write(&file, header)?;
    let chunk = CHUNK.min(rows);
    let data = file.new_dataset::<f64>().shape((rows, rows)).chunk((chunk, chunk)).create(HEIGHT)?;
    surface_header::write_text(&data, "unit", "m")?;
    axes::write(&file, &kind, &data, header.length_m)?;
    for first in (0..rows).step_by(chunk) {
        let band = first..rows.min(first + chunk);
        // HDF5 wants a contiguous band; where the field is not, this copy is the one extra chunk row.
        let values = heights.slice(s![band.clone(), ..]);
        data.write_slice(values.as_standard_layout().view(), s![band, ..])?;
    }
    // While the dataset is open: closing it writes what is left of it too, and tells nobody if that fails.
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
    for first in (0..heights.nrows()).step_by(CHUNK) {
        let band = first..heights.nrows().min(first + CHUNK);
        same = same && data.read_slice_2d::<f64, _>(s![band.clone(), ..])? == heights.slice(s![band, ..]);
    }
    if same { Ok(()) } else { Err("the content read back differs from the content written".into()) }
}

/// The height field of a surface file, square and no larger than the file.
fn heights_of(path: &Path, file: &File) -> Result<Dataset, Cause> {
    let data = dataset(file, HEIGHT)?.ok_or_else(|| format!("it has no dataset {HEIGHT:?}"))?;
    let (rows, columns) = check_extent(path, &data, HEIGHT, 1)?;
    if rows == columns { Ok(data) } else { Err(format!("its field has {rows} by {columns} heights, and must be square").into()) }
}

/// Rows and columns of a dataset that the file can really hold, before memory is asked for.
fn check_extent(path: &Path, data: &Dataset, name: &str, packed: u64) -> Result<(usize, usize), Cause> {
    let [rows, columns] = data.get_shape()?[..] else {
        return Err(format!("its dataset {name:?} is not two-dimensional").into());
    };
    let most = fs::metadata(path)?.len().saturating_mul(packed);
    let width = data.dtype()?.size() as u64;
    let bytes = (rows as u64).checked_mul(columns as u64).and_then(|count| count.checked_mul(width));
    match bytes {
        Some(bytes) if bytes > 0 && bytes <= most => Ok((rows, columns)),
        _ => Err(format!("its dataset {name:?} claims {rows} by {columns} values, which a file of its size cannot hold").into()),
    }
}

/// A whole two-dimensional dataset, every value of which must be finite.
fn field(data: &Dataset, name: &str) -> Result<Array2<f64>, Cause> {
    let [rows, columns] = data.get_shape()?[..] else { return Err(format!("its dataset {name:?} is not two-dimensional").into()) };
    let values = values(data, [rows, columns])?;
    match values.indexed_iter().find(|(_, value)| !value.is_finite()) {
        None => Ok(values),
        Some(((row, column), value)) => Err(format!("its dataset {name:?} has {value} in row {row}, column {column}").into()),
    }
}

/// The values of a two-dimensional dataset of this extent.
fn values(data: &Dataset, [rows, columns]: [usize; 2]) -> Result<Array2<f64>, Cause> {
    let count = rows.checked_mul(columns).ok_or("its extent is too large")?;
    let mut values = room(count as u64)?;
    values.resize(count, 0.0);
    data.read_into_raw(&mut values)?;
    Ok(Array2::from_shape_vec((rows, columns), values)?)
}
