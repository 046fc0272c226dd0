//! Measured surfaces, in the files that instruments and other programs write.
//!
//! A reader takes a file for what its first bytes say, believes none of its numbers before comparing them with the
//! length of the file, and gives heights, or a sentence that says why there are none. What a file does not say, of its
//! size or its unit for instance, is not guessed.

pub mod export;
mod netcdf;
mod netcdf_header;
mod npy;
mod numbers;
mod text;
mod text_heading;
mod text_points;
mod units;
mod x3p;

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use ndarray::Array2;

use super::error::{Cause, StoreError, fenced};
pub use crate::formats::{Format, Found, detect};
pub(super) use numbers::room;

/// Points that a scan may have: as many heights take 2 GiB of memory.
pub const MOST_POINTS: u64 = 1 << 28;

/// A height field as a file has it.
#[derive(Debug, Clone)]
pub struct Scan {
    /// Heights \[m\] where [`unit`](Self::unit) is there, in the file's own numbers where it is not; NaN where a point
    /// is missing. The row index runs along x, the column index along y.
    pub heights: Array2<f64>,
    /// Size along the row index and along the column index \[m\], points times distance of points, if the file says.
    pub size_m: Option<[f64; 2]>,
    /// The unit of length that the file gives its heights in, and from which they have been taken to metres.
    pub unit: Option<String>,
    /// Factor by which the reader multiplied the file's own numbers: unit of length times scale.
    pub factor: f64,
    /// True if the surface continues periodically, if the file says.
    pub periodic: Option<bool>,
    /// Distance of points along the row index and along the column index in the file's own numbers, if it has positions; their unit is that of the heights where
    /// [`size_m`](Self::size_m) is unknown.
    pub spacing: Option<[f64; 2]>,
}

/// Reads a scan. `variable` is the name of the height field where a format has names, which is NetCDF; without it,
/// the field is called `heights`.
///
/// # Errors
/// If the file cannot be read, is damaged, or holds no field of heights, or one of more than [`MOST_POINTS`].
pub fn read(path: &Path, format: Format, variable: Option<&str>) -> Result<Scan, StoreError> {
    fenced(|| {
        if let Some(name) = variable.filter(|_| format != Format::NetCdf3) {
            return Err(format!(
                "no dataset {name:?}: the format {} has one unnamed field\nhelp: remove surface.dataset (--dataset)",
                format.name()
            )
            .into());
        }
        let source = Source::open(path)?;
        match format {
            Format::Npy => npy::read(source),
            Format::NetCdf3 => netcdf::read(source, variable),
            Format::X3p => x3p::read(source),
            Format::Text => text::read(source),
        }
    })
    .map_err(|cause| StoreError::new("read the surface from", path, cause))
}

/// An open file and its length, which bounds whatever it says of itself.
struct Source {
    file: BufReader<File>,
    length: u64,
}

impl Source {
    fn open(path: &Path) -> Result<Self, Cause> {
        let about = fs::metadata(path)?;
        if about.is_dir() {
            return Err("it is a directory".into());
        }
        if !about.is_file() {
            return Err("not a regular file".into());
        }
        Ok(Self { file: BufReader::with_capacity(1 << 16, File::open(path)?), length: about.len() })
    }
}
