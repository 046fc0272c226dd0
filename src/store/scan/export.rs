//! Surfaces for other programs.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use ndarray::ArrayView2;

use super::super::commit::{Written, commit};
use super::super::error::{Cause, StoreError};
use super::numbers::points;
use super::{Source, netcdf};

/// Tag of a list of dimensions.
const DIMENSIONS: u32 = 10;
/// Tag of a list of variables.
const VARIABLES: u32 = 11;
/// Tag of a list of attributes.
const ATTRIBUTES: u32 = 12;
/// The kinds of numbers that are written.
const CHAR: u32 = 2;
const INT: u32 = 4;
const DOUBLE: u32 = 6;

/// Writes heights \[m\] in place of
/// `path` as NetCDF (CDF-2), in the layout that SurfaceTopography reads: variables `x(x)`,
/// `y(y)` and `heights(x, y)` of doubles, with the attributes `length`, `periodic` and `unit`. `size_m` is
/// the size along the row index and along the column index \[m\].
///
/// # Errors
/// If a height is not finite, a size not positive, there are no points or too many of them, or the file
/// cannot be written whole; what was at `path` is then still there.
pub fn write_netcdf3(
    path: &Path,
    heights: ArrayView2<'_, f64>,
    size_m: [f64; 2],
    periodic: bool,
) -> Result<Written, StoreError> {
    commit(
        "write the surface to",
        path,
        |temporary| write_all(temporary, heights, size_m, periodic),
        |temporary| {
            let back = netcdf::read(Source::open(temporary)?, None)?;
            let same =
                back.heights == heights && back.size_m == Some(size_m) && back.periodic == Some(periodic);
            if same { Ok(()) } else { Err("the content read back differs from the content written".into()) }
        },
    )
}

fn write_all(
    path: &Path,
    heights: ArrayView2<'_, f64>,
    size_m: [f64; 2],
    periodic: bool,
) -> Result<(), Cause> {
    let (rows, columns) = heights.dim();
    points(rows as u64, columns as u64)?;
    if let Some(((row, column), height)) = heights.indexed_iter().find(|(_, height)| !height.is_finite()) {
        return Err(
            format!("its height in row {row}, column {column} is {height}, and must be finite").into()
        );
    }
    if let Some(size) = size_m.iter().find(|size| !size.is_finite() || **size <= 0.0) {
        return Err(format!("its size is {size} m, and must be positive").into());
    }
    let axes = [("x", rows, size_m[0]), ("y", columns, size_m[1])];
    // How long the header is does not depend on what it says of the places behind it.
    let start = header(axes, periodic, 0)?.len() as u64;
    let mut file = BufWriter::new(File::create(path)?);
    file.write_all(&header(axes, periodic, start)?)?;
    for (_, points, size) in axes {
        for at in 0..points {
            file.write_all(&(at as f64 / points as f64 * size).to_be_bytes())?;
        }
    }
    for height in heights {
        file.write_all(&height.to_be_bytes())?;
    }
    Ok(file.into_inner()?.sync_all()?)
}

/// The header of a file whose numbers begin at `start`.
fn header([x, y]: [(&str, usize, f64); 2], periodic: bool, start: u64) -> Result<Vec<u8>, Cause> {
    let mut bytes = Vec::from(*b"CDF\x02");
    // No records.
    word(&mut bytes, 0);
    list(&mut bytes, DIMENSIONS, 2);
    for (axis, points, _) in [x, y] {
        name(&mut bytes, axis);
        word(&mut bytes, u32::try_from(points)?);
    }
    // No attributes of the whole file.
    list(&mut bytes, 0, 0);
    list(&mut bytes, VARIABLES, 3);
    let mut begin = start;
    for (place, (axis, points, size)) in [(0, x), (1, y)] {
        name(&mut bytes, axis);
        list(&mut bytes, 1, place);
        list(&mut bytes, ATTRIBUTES, 3);
        name(&mut bytes, "length");
        list(&mut bytes, DOUBLE, 1);
        bytes.extend(size.to_be_bytes());
        name(&mut bytes, "periodic");
        list(&mut bytes, INT, 1);
        word(&mut bytes, u32::from(periodic));
        metres(&mut bytes);
        begin = place_of(&mut bytes, points as u64, begin)?;
    }
    name(&mut bytes, "heights");
    list(&mut bytes, 2, 0);
    word(&mut bytes, 1);
    list(&mut bytes, ATTRIBUTES, 1);
    metres(&mut bytes);
    place_of(&mut bytes, x.1 as u64 * y.1 as u64, begin)?;
    Ok(bytes)
}

/// The end of a variable: kind, bytes and place; what comes behind it.
fn place_of(bytes: &mut Vec<u8>, points: u64, begin: u64) -> Result<u64, Cause> {
    word(bytes, DOUBLE);
    word(bytes, u32::try_from(points * 8)?);
    bytes.extend(begin.to_be_bytes());
    Ok(begin + points * 8)
}

/// The attribute that says that it is all in metres.
fn metres(bytes: &mut Vec<u8>) {
    name(bytes, "unit");
    word(bytes, CHAR);
    name(bytes, "m");
}

fn word(bytes: &mut Vec<u8>, value: u32) {
    bytes.extend(value.to_be_bytes());
}

/// Two words, the second of which counts what follows or says which one it is.
fn list(bytes: &mut Vec<u8>, tag: u32, count: u32) {
    word(bytes, tag);
    word(bytes, count);
}

/// A text, with zeros up to the next multiple of four.
fn name(bytes: &mut Vec<u8>, text: &str) {
    word(bytes, text.len() as u32);
    bytes.extend(text.bytes());
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}
