//! Coordinates of a surface file, attached to the height field as HDF5 dimension scales.

use std::fs;
use std::path::Path;

use hdf5_metno::types::{FixedAscii, VarLenArray, VarLenUnicode};
use hdf5_metno::{Dataset, Datatype, File, FileBuilder, ObjectReference, ObjectReference1};

use super::attributes::write_text;
use super::error::Cause;

/// Datasets of the coordinates: along the rows of the height field, and along its columns.
const AXES: [&str; 2] = ["x_m", "y_m"];

/// An empty file whose root has the attribute [`CLASS`], as `tests/python/start.py` makes it.
///
/// The HDF5 library accepts a dimension scale only if this attribute is a null-terminated string of 16 bytes,
/// and the crate creates no such strings. Their type is therefore taken from this file.
const START: &[u8] = include_bytes!("start.h5");
/// Name and text of the attribute that marks a dimension scale.
const CLASS: (&str, &str) = ("CLASS", "DIMENSION_SCALE");

/// Creates an empty file at `path`, and the string type of the attributes of dimension scales.
pub(super) fn start(path: &Path, options: &FileBuilder) -> Result<(File, Datatype), Cause> {
    fs::write(path, START)?;
    let file = options.open_rw(path)?;
    let kind = file.attr(CLASS.0)?.dtype()?;
    file.delete_attr(CLASS.0)?;
    Ok((file, kind))
}

/// Coordinates \[m\] of the points along a side.
fn coordinates(points: usize, length_m: f64) -> Vec<f64> {
    (0..points).map(|at| at as f64 / points as f64 * length_m).collect()
}

/// Writes the coordinates of a square field and attaches them to it.
pub(super) fn write(file: &File, kind: &Datatype, heights: &Dataset, length_m: f64) -> Result<(), Cause> {
    let points = heights.get_shape()?.first().copied().unwrap_or_default();
    for name in AXES {
        let axis = file.new_dataset::<f64>().shape(points).create(name)?;
        axis.write(&coordinates(points, length_m))?;
        write_text(&axis, "unit", "m")?;
        write_short(&axis, kind, CLASS.0, CLASS.1)?;
        write_short(&axis, kind, "NAME", name)?;
        // While the dataset is open: closing it writes what is buffered, and reports no error.
        file.flush()?;
    }
    let scales =
        AXES.map(|name| ObjectReference1::create(file, name).map(|scale| VarLenArray::from_slice(&[scale])));
    let [x, y] = scales;
    heights
        .new_attr::<VarLenArray<ObjectReference1>>()
        .shape(2)
        .create("DIMENSION_LIST")?
        .write(&[x?, y?])?;
    let [x, y] = AXES.map(str::parse::<VarLenUnicode>);
    Ok(heights.new_attr::<VarLenUnicode>().shape(2).create("DIMENSION_LABELS")?.write(&[x?, y?])?)
}

/// True if the coordinates that a file holds are these.
pub(super) fn are_as_written(file: &File, points: usize, length_m: f64) -> Result<bool, Cause> {
    let wanted = coordinates(points, length_m);
    let mut same = true;
    for name in AXES {
        same = same && file.dataset(name)?.read_raw::<f64>()? == wanted;
    }
    Ok(same)
}

/// Writes a null-terminated string as an attribute.
fn write_short(axis: &Dataset, kind: &Datatype, name: &str, text: &str) -> Result<(), Cause> {
    Ok(axis
        .new_attr_builder()
        .empty_as(kind)
        .create(name)?
        .write_scalar(&FixedAscii::<16>::from_ascii(text)?)?)
}
