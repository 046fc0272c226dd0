//! Measured surfaces, in the files that instruments and other programs write.
//!
//! The first bytes of a file determine its format. Its numbers are compared with the length of the file
//! before they are used. A reader returns heights, or a sentence with the reason of the failure. Properties
//! that the file does not state, such as its size or its unit, are not guessed.

pub(super) mod attributes;
pub mod export;
pub(super) mod field;
mod netcdf;
mod netcdf_header;
mod npy;
pub(super) mod numbers;
mod packing;
mod stated;
mod text;
pub(super) mod text_cells;
mod text_columns;
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

/// Error of a file that was cut off.
const CUT: &str = "the file ends within the header\nhelp: copy or download the file again";

/// A height field as a file has it.
#[derive(Debug, Clone)]
pub struct Scan {
    /// Heights \[m\] where [`unit`](Self::unit) is there, in the file's own numbers where it is not; NaN
    /// where a point is missing. The row index runs along x, the column index along y, whichever order the
    /// file has.
    pub heights: Array2<f64>,
    /// Size along x and y \[m\], points times distance of points, if the file says.
    pub size_m: Option<[f64; 2]>,
    /// The unit of length that the file gives its heights in, and from which they have been taken to metres.
    pub unit: Option<String>,
    /// Factor by which the reader multiplied the file's own numbers: unit of length times scale.
    pub factor: f64,
    /// True if the surface continues periodically, if the file says.
    pub periodic: Option<bool>,
    /// Distance of points along x and y in the file's own numbers, if it has positions; their unit is that of
    /// the heights where [`size_m`](Self::size_m) is unknown.
    pub spacing: Option<[f64; 2]>,
    /// Axis of the first index of the file: of the lines of a text, of the rows of an array.
    pub first: FirstIndex,
    /// Statements of the file that were interpreted or not used, one sentence each.
    pub notes: Vec<String>,
}

impl Scan {
    /// A scan whose file states nothing but heights.
    fn bare(heights: Array2<f64>, first: FirstIndex) -> Self {
        Self {
            heights,
            size_m: None,
            unit: None,
            factor: 1.0,
            periodic: None,
            spacing: None,
            first,
            notes: Vec::new(),
        }
    }

    /// Scan with x and y exchanged.
    ///
    /// # Errors
    /// If the memory of this machine does not suffice.
    pub fn transposed(mut self, path: &Path) -> Result<Self, StoreError> {
        self.heights = numbers::turned(self.heights)
            .map_err(|cause| StoreError::new("read the surface from", path, cause))?;
        self.size_m = self.size_m.map(|[x, y]| [y, x]);
        self.spacing = self.spacing.map(|[x, y]| [y, x]);
        self.first = if self.first == FirstIndex::X { FirstIndex::Y } else { FirstIndex::X };
        Ok(self)
    }
}

/// Axis along which the first index of a file runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstIndex {
    /// Along x, as in surfaces of this program, of SurfaceTopography and of Tamaas.
    X,
    /// Along y: a line of a text or of an image is a scan line along x.
    Y,
}

/// Properties of a file that its user states.
#[derive(Debug, Clone, Copy, Default)]
pub struct Asked<'a> {
    /// Name of the height field where a format has names; without it, the only one or the one called
    /// `heights`.
    pub field: Option<&'a str>,
    /// Lines of a text before its numbers that are not read.
    pub skip_lines: u64,
    /// Points of a scan line of a text whose lines are not scan lines.
    pub width: Option<u64>,
}

/// Reads a scan.
///
/// # Errors
/// If the file cannot be read, is damaged, or holds no field of heights, or one of more than [`MOST_POINTS`].
pub fn read(path: &Path, format: Format, asked: &Asked<'_>) -> Result<Scan, StoreError> {
    fenced(|| {
        if let Some(name) = asked.field.filter(|_| format != Format::NetCdf3) {
            return Err(format!(
                "no dataset {name:?}: the format {} has one unnamed field\nhelp: remove surface.dataset \
                 (--dataset)",
                format.name()
            )
            .into());
        }
        if format != Format::Text {
            asked.of_text(format.name())?;
        }
        let source = Source::open(path)?;
        match format {
            Format::Npy => npy::read(source),
            Format::NetCdf3 => netcdf::read(source, asked.field),
            Format::X3p => x3p::read(source),
            Format::Text => text::read(source, asked),
        }
    })
    .map_err(|cause| StoreError::new("read the surface from", path, cause))
}

/// True for a NetCDF-3 file whose heights are those of a line scan.
#[must_use]
pub fn is_line_scan(path: &Path) -> bool {
    fenced(|| netcdf::is_line(Source::open(path)?)).unwrap_or_default()
}

impl Asked<'_> {
    /// Refuses properties of a text for another format.
    pub(super) fn of_text(&self, format: &str) -> Result<(), Cause> {
        if self.skip_lines > 0 {
            return Err(format!(
                "the format {format} has no lines to skip\nhelp: remove surface.skip_lines (--skip-lines)"
            )
            .into());
        }
        match self.width {
            Some(width) => Err(format!(
                "the format {format} states its points per line; {width} was given\nhelp: remove \
                     surface.width (--width)"
            )
            .into()),
            None => Ok(()),
        }
    }
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
