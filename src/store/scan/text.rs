//! Numbers as text: a matrix, points x, y, z on a grid, or one column of a stated width.
//!
//! The first line of numbers determines the separator of the file; quotation marks around cells do not count.
//! Lines before it are the heading, with or without a comment sign: sizes and units in the words of several
//! programs, and names of columns.
//!
//! A line of a matrix is a scan line along x, as in the exports of Gwyddion and in SurfaceTopography: the
//! place in the line is x, the line is y.

use std::io::{BufRead, Read};

use super::attributes::decoded;
use super::numbers::{points, shaped, turned};
use super::text_cells::{Decimals, Separator, is_value};
use super::text_columns::{Column, Role, are_units, columns};
use super::text_heading::{Heading, Meaning};
use super::text_points::grid;
use super::{Asked, Cause, FirstIndex, MOST_POINTS, Scan, Source};
use crate::text::counted;

/// Starts of a comment.
const COMMENTS: [&str; 3] = ["#", "%", "//"];
/// Lines from which on few columns are coordinates: a matrix needs as many columns as that to be of use.
const MANY: u64 = 16;

/// Reads the numbers.
pub(super) fn read(source: Source, asked: &Asked<'_>) -> Result<Scan, Cause> {
    let mut matrix = Matrix { width: asked.width, ..Matrix::default() };
    let (mut file, mut line, mut number) = (source.file, Vec::new(), 0_u64);
    // No line is longer than the file was when it was opened, even if it grows.
    let mut left = source.length;
    loop {
        line.clear();
        let read = file.by_ref().take(left).read_until(b'\n', &mut line)?;
        if read == 0 {
            break;
        }
        left = left.saturating_sub(read as u64);
        number += 1;
        if number <= asked.skip_lines {
            continue;
        }
        let text = decoded(&line);
        let text = if number == 1 { text.strip_prefix('\u{feff}').unwrap_or(&text) } else { &text };
        let text = text.strip_suffix('\n').unwrap_or(text);
        matrix
            .line(text.strip_suffix('\r').unwrap_or(text))
            .map_err(|cause| format!("its line {number}: {cause}"))?;
    }
    matrix.finish()
}

/// Rows of numbers that have been read.
#[derive(Default)]
struct Matrix {
    heading: Heading,
    /// Columns that the heading names.
    named: Vec<Column>,
    /// Points of a scan line, where lines of the file are not scan lines.
    width: Option<u64>,
    separator: Option<Separator>,
    decimals: Decimals,
    values: Vec<f64>,
    rows: u64,
    columns: u64,
    /// Rows that do not end with a separator.
    closed: u64,
    /// Lines of the heading without a comment sign.
    unsigned: u64,
}

impl Matrix {
    fn line(&mut self, line: &str) -> Result<(), Cause> {
        let text = line.trim();
        if text.is_empty() && !self.is_row_of_tabs(line) {
            return Ok(());
        }
        if let Some(comment) = COMMENTS.iter().find_map(|sign| text.strip_prefix(sign)) {
            self.heading.line(comment)?;
            if self.rows == 0 && !comment.contains(['=', ':']) {
                self.name(comment);
            }
            return Ok(());
        }
        if text.contains('\r') {
            return Err("unsupported line endings (CR only)\nhelp: convert the file to LF or CR LF".into());
        }
        if self.rows == 0 && is_heading(text) {
            self.unsigned += 1;
            if text.starts_with(char::is_alphabetic) && text.contains(['=', ':']) {
                return self.heading.line(text);
            }
            self.name(text);
            return self.heading.words(text);
        }
        self.row(line)
    }

    /// Reads a line as the names of columns, or as the units of the columns named before.
    fn name(&mut self, line: &str) {
        let Some(found) = columns(line) else { return };
        if are_units(&found) && found.len() == self.named.len() {
            for (column, units) in self.named.iter_mut().zip(found) {
                column.unit = units.unit;
            }
        } else if !found.is_empty() {
            self.named = found;
        }
    }

    /// True if a line of nothing but blanks is a row of which every point is missing.
    fn is_row_of_tabs(&self, line: &str) -> bool {
        line.contains('\t') && matches!(self.separator, None | Some(Separator::Sign('\t')))
    }

    fn row(&mut self, line: &str) -> Result<(), Cause> {
        let separator = *self.separator.get_or_insert_with(|| match Separator::of(line) {
            // One number with a decimal comma, and not two.
            Separator::Sign(',') if self.width.is_some() && line.matches(',').count() == 1 => {
                Separator::Blank
            }
            separator => separator,
        });
        let before = self.values.len();
        for (at, cell) in separator.cells(line).into_iter().enumerate() {
            let value = self.decimals.number(cell).map_err(|cause| format!("column {}: {cause}", at + 1))?;
            self.push(value)?;
        }
        let count = (self.values.len() - before) as u64;
        if self.rows == 0 {
            self.columns = count;
        } else if count != self.columns && self.width.is_none() {
            let help = "each line must have the same count; skip lines of a heading with surface.skip_lines \
                 (--skip-lines)";
            return Err(format!(
                "{count} numbers, but the previous lines have {}\nhelp: {help}",
                self.columns
            )
            .into());
        }
        self.rows += 1;
        let open = matches!(separator, Separator::Sign(sign) if line.trim_matches(' ').ends_with(sign));
        self.closed += u64::from(!open);
        Ok(())
    }

    fn push(&mut self, value: f64) -> Result<(), Cause> {
        if self.values.len() as u64 >= MOST_POINTS {
            return Err(format!("more than {MOST_POINTS} points, the limit of a surface").into());
        }
        if self.values.len() == self.values.capacity() {
            let more = self.values.len().max(1 << 12);
            self.values
                .try_reserve(more)
                .map_err(|_| "its heights do not fit into the memory of this machine")?;
        }
        self.values.push(value);
        Ok(())
    }

    fn finish(mut self) -> Result<Scan, Cause> {
        if self.rows == 0 {
            return Err(
                "no line of numbers\nhelp: give a matrix of heights, or three columns x, y and z".into()
            );
        }
        // A separator behind the last number of every line is not one more column.
        if self.closed == 0 && self.columns > 1 {
            let (columns, mut at) = (self.columns, 0);
            self.values.retain(|_| {
                at += 1;
                at % columns != 0
            });
            self.columns -= 1;
        }
        if let Some(width) = self.width {
            return self.lines_of(width);
        }
        let roles: Vec<_> = self.named.iter().map(Column::role).collect();
        let place = |role| roles.iter().position(|other| *other == Some(role));
        let fits = roles.len() as u64 == self.columns;
        if fits && place(Role::Spectrum).is_some() && self.columns <= 4 {
            return Err(self.spectrum());
        }
        match (place(Role::X), place(Role::Y), place(Role::Height)) {
            (Some(x), Some(y), Some(z)) if fits => return self.positions([x, y, z]),
            _ if self.columns == 3 && self.rows >= MANY => return self.positions([0, 1, 2]),
            _ => {}
        }
        match self.columns {
            1 if self.heading.width().is_some() => {
                self.heading.width().map_or_else(|| Err("no width".into()), |width| self.lines_of(width))
            }
            1 if self.rows >= MANY => Err(self.column()),
            2 if self.rows >= MANY && self.decays() => Err(self.spectrum()),
            2 if self.rows >= MANY => Err(line_scan()),
            columns => self.lines_of(columns),
        }
    }

    /// Heights in lines of `width` points, independently of the lines of the file.
    fn lines_of(mut self, width: u64) -> Result<Scan, Cause> {
        let count = self.values.len() as u64;
        if width == 0 || !count.is_multiple_of(width) {
            return Err(format!(
                "its {count} numbers are no whole number of lines of {width} points\nhelp: correct \
                 surface.width (--width); {}",
                widths(count)
            )
            .into());
        }
        let extent = [count / width, width];
        points(extent[0], extent[1])?;
        if self.named.len() as u64 == self.columns || self.columns == 1 {
            self.heading.unit_of_heights(&self.named);
        }
        let meaning = self.heading.meaning(extent)?;
        let notes = self.notes();
        let mut heights = turned(shaped(extent, self.values)?)?;
        heights *= meaning.factor;
        Ok(scan(meaning, notes, Scan::bare(heights, FirstIndex::Y)))
    }

    /// The heights of points. Where the file says a unit of the heights, it holds for x and y, unless these
    /// have their own.
    fn positions(mut self, places: [usize; 3]) -> Result<Scan, Cause> {
        if let [Some(x), Some(y), Some(z)] =
            places.map(|place| self.named.get(place).filter(|_| self.named.len() as u64 == self.columns))
        {
            self.heading.units_of_points(x, y, z);
        }
        let mut notes = self.notes();
        let values = std::mem::take(&mut self.values);
        let columns = self.columns as usize;
        let found = if places == [0, 1, 2] && columns == 3 {
            grid(&values)?
        } else {
            let chosen: Vec<f64> = values
                .chunks_exact(columns)
                .flat_map(|row| places.map(|place| row.get(place).copied().unwrap_or(f64::NAN)))
                .collect();
            grid(&chosen)?
        };
        drop(values);
        if found.absent > 0 {
            notes.push(format!(
                "{} of the grid without a line, taken as missing",
                counted(found.absent, "point")
            ));
        }
        let extent = [found.heights.nrows() as u64, found.heights.ncols() as u64];
        let meaning = self.heading.of_points(found.spacing, extent)?;
        let mut heights = found.heights;
        heights *= meaning.factor;
        Ok(Scan { spacing: Some(found.spacing), ..scan(meaning, notes, Scan::bare(heights, FirstIndex::X)) })
    }

    /// Sentences on how the text was read.
    fn notes(&self) -> Vec<String> {
        let heading = (self.unsigned > 0).then(|| {
            format!("{} before the numbers, read as a heading", counted(self.unsigned as usize, "line"))
        });
        let comma = self.decimals.comma.then(|| "decimal commas".to_owned());
        [heading, comma].into_iter().flatten().collect()
    }

    /// The refusal of a spectrum.
    fn spectrum(&self) -> Cause {
        format!(
            "this looks like a power spectral density, not a height map: {} with a wavevector\n\
             help: give the heights that the spectrum was computed from, or generate surfaces of such a \
             spectrum from a spec",
            counted(self.columns as usize, "column")
        )
        .into()
    }

    /// True if the first of two columns increases from above 0 and the second, above 0, decreases by more
    /// than a decade, as a spectrum does.
    fn decays(&self) -> bool {
        let pairs = || self.values.chunks_exact(2);
        let positive = pairs().all(|pair| pair.iter().all(|value| *value > 0.0));
        let rises = pairs().zip(pairs().skip(1)).all(|(one, next)| one[0] < next[0]);
        let ends = [pairs().next(), pairs().last()].map(|pair| pair.map_or(f64::NAN, |pair| pair[1]));
        positive && rises && ends[0] > 10.0 * ends[1]
    }

    /// The refusal of one column without a width.
    fn column(&self) -> Cause {
        format!(
            "one column of {} numbers: a line scan, or a map whose points per line are not stated\n\
             help: give the points per scan line as surface.width (--width); {}",
            self.rows,
            widths(self.rows)
        )
        .into()
    }
}

/// The refusal of two columns.
fn line_scan() -> Cause {
    "two columns are a line scan (x and height), or one column with decimal commas\n\
     help: give a matrix of heights, or three columns x, y and z; for one column with decimal commas give \
     its points per line (--width)"
        .into()
}

/// Possible numbers of points per line.
fn widths(count: u64) -> String {
    let root = count.isqrt();
    if root * root == count {
        format!("{count} = {root} x {root}")
    } else {
        format!("{count} is no square number")
    }
}

/// A scan with the unit and size of a heading.
fn scan(meaning: Meaning, notes: Vec<String>, bare: Scan) -> Scan {
    Scan { size_m: meaning.size_m, unit: meaning.unit, factor: meaning.factor, notes, ..bare }
}

/// True if a line before the numbers is no row: its first cell is neither a number nor a missing point.
fn is_heading(text: &str) -> bool {
    if text.starts_with(char::is_alphabetic) && text.contains(['=', ':']) {
        return true;
    }
    let cells = Separator::of(text).cells(text);
    cells.iter().find(|cell| !cell.is_empty()).is_some_and(|cell| !is_value(cell))
}
