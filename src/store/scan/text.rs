//! A matrix of numbers as text: every line a row.
//!
//! The first line of numbers determines the separator of the file. Lines that begin with a
//! comment sign may say sizes and units; so may lines before the first numbers that say something of the form
//! "width = 10 µm", as some instruments write it without a sign.
//!
//! Three columns of many lines are points x, y, z on a grid, and not a matrix.

use std::io::{BufRead, Read};

use super::numbers::{points, shaped};
use super::text_heading::Heading;
use super::text_points::grid;
use super::{Cause, MOST_POINTS, Scan, Source};

/// Starts of a comment.
const COMMENTS: [&str; 3] = ["#", "%", "//"];
/// Words for a missing point, in upper or lower case.
const MISSING: [&str; 9] = ["nan", "+nan", "-nan", "bad", "--", "---", "inf", "-inf", "infinite"];
/// Lines from which on few columns are coordinates: a matrix needs as many columns as that to be of use.
const MANY: u64 = 16;
/// Bytes of a cell that an error shows.
const SHOWN: usize = 24;

/// Separator of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Separator {
    /// As many spaces and tabs as you like.
    Blank,
    /// This sign, once: nothing between two of them is a missing point.
    Sign(char),
}

/// Reads the matrix.
pub(super) fn read(source: Source) -> Result<Scan, Cause> {
    let mut matrix = Matrix::default();
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
        let text = decoded(&line);
        let text = if number == 1 { text.strip_prefix('\u{feff}').unwrap_or(&text) } else { &text };
        let text = text.strip_suffix('\n').unwrap_or(text);
        matrix.line(text.strip_suffix('\r').unwrap_or(text)).map_err(|cause| format!("its line {number}: {cause}"))?;
    }
    matrix.finish()
}

/// Bytes as text: UTF-8, or else Latin-1, in which instruments write their µ.
fn decoded(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}

/// Rows of a matrix that have been read.
struct Matrix {
    heading: Heading,
    separator: Option<Separator>,
    values: Vec<f64>,
    rows: u64,
    columns: u64,
    /// True if all rows so far end with a separator.
    open: bool,
    /// True if a line of words says that the columns are x, y and z.
    points: bool,
}

impl Default for Matrix {
    fn default() -> Self {
        Self { heading: Heading::default(), separator: None, values: Vec::new(), rows: 0, columns: 0, open: true, points: false }
    }
}

impl Matrix {
    fn line(&mut self, line: &str) -> Result<(), Cause> {
        let text = line.trim();
        if text.is_empty() && !self.is_row_of_tabs(line) {
            return Ok(());
        }
        if let Some(comment) = COMMENTS.iter().find_map(|sign| text.strip_prefix(sign)) {
            return self.heading.line(comment);
        }
        if self.rows == 0 && text.starts_with(char::is_alphabetic) && text.contains(['=', ':']) {
            return self.heading.line(text);
        }
        if text.contains('\r') {
            return Err("unsupported line endings (CR only)\nhelp: convert the file to LF or CR LF".into());
        }
        if self.rows == 0 && names_points(text) {
            self.points = true;
            return Ok(());
        }
        self.row(line)
    }

    /// True if a line of nothing but blanks is a row of which every point is missing.
    fn is_row_of_tabs(&self, line: &str) -> bool {
        line.contains('\t') && matches!(self.separator, None | Some(Separator::Sign('\t')))
    }

    fn row(&mut self, line: &str) -> Result<(), Cause> {
        let separator = *self.separator.get_or_insert_with(|| separator(line));
        let before = self.values.len();
        match separator {
            Separator::Blank => self.cells(line.split_whitespace())?,
            Separator::Sign(sign) => self.cells(line.split(sign).map(str::trim))?,
        }
        let count = (self.values.len() - before) as u64;
        if self.rows == 0 {
            self.columns = count;
        } else if count != self.columns {
            return Err(format!("{count} numbers, but the previous lines have {}", self.columns).into());
        }
        self.rows += 1;
        self.open &= matches!(separator, Separator::Sign(sign) if line.trim_matches(' ').ends_with(sign));
        Ok(())
    }

    fn cells<'a>(&mut self, cells: impl Iterator<Item = &'a str>) -> Result<(), Cause> {
        for (at, cell) in cells.enumerate() {
            let value = number(cell).map_err(|cause| format!("column {}: {cause}", at + 1))?;
            if self.values.len() as u64 >= MOST_POINTS {
                return Err(format!("more than {MOST_POINTS} points, the limit of a surface").into());
            }
            if self.values.len() == self.values.capacity() {
                let more = self.values.len().max(1 << 12);
                self.values.try_reserve(more).map_err(|_| "its heights do not fit into the memory of this machine")?;
            }
            self.values.push(value);
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Scan, Cause> {
        if self.rows == 0 {
            return Err("no line of numbers".into());
        }
        // A separator behind the last number of every line is not one more column.
        if self.open && self.columns > 1 {
            let (columns, mut at) = (self.columns, 0);
            self.values.retain(|_| {
                at += 1;
                at % columns != 0
            });
            self.columns -= 1;
        }
        if self.columns == 3 && (self.points || self.rows >= MANY) {
            return self.positions();
        }
        if self.columns < 3 && self.rows >= MANY {
            let what = if self.columns == 2 { "two columns are a line scan (x and height)" } else { "one column is a line of heights" };
            return Err(format!("{what}\nhelp: give a matrix of heights, or three columns x, y and z").into());
        }
        let extent = [self.rows, self.columns];
        points(self.rows, self.columns)?;
        let meaning = self.heading.meaning(extent)?;
        let mut heights = shaped(extent, self.values)?;
        heights *= meaning.factor;
        Ok(Scan { heights, size_m: meaning.size_m, unit: meaning.unit, factor: meaning.factor, periodic: None, spacing: None })
    }

    /// The heights of points. Where the file says a unit of the heights, it holds for x and y, unless these have their own.
    fn positions(self) -> Result<Scan, Cause> {
        let found = grid(&self.values)?;
        drop(self.values);
        let extent = [found.heights.nrows() as u64, found.heights.ncols() as u64];
        let meaning = self.heading.of_points(found.spacing, extent)?;
        let mut heights = found.heights;
        heights *= meaning.factor;
        Ok(Scan {
            heights,
            size_m: meaning.size_m,
            unit: meaning.unit,
            factor: meaning.factor,
            periodic: None,
            spacing: Some(found.spacing),
        })
    }
}

/// True if a line is the words x, y and z, as a heading of columns.
fn names_points(line: &str) -> bool {
    let words = line.split(|sign: char| sign.is_whitespace() || matches!(sign, ',' | ';')).filter(|word| !word.is_empty());
    words.map(|word| word.trim_matches('"').to_ascii_lowercase()).eq(["x", "y", "z"])
}

/// Separator of the numbers of this line.
fn separator(line: &str) -> Separator {
    let one_each = |sign: char| line.split(sign).all(|cell| !cell.trim().contains(char::is_whitespace));
    if line.contains(';') {
        Separator::Sign(';')
    } else if line.contains('\t') && one_each('\t') {
        Separator::Sign('\t')
    } else if line.contains(',') && !has_decimal_commas(line) {
        Separator::Sign(',')
    } else {
        Separator::Blank
    }
}

/// True if a line is several numbers between blanks, each with a comma inside.
fn has_decimal_commas(line: &str) -> bool {
    let mut cells = line.split_whitespace().map(|cell| cell.trim_matches(',').contains(',') && !cell.ends_with(','));
    line.split_whitespace().nth(1).is_some() && cells.all(|inside| inside)
}

/// A height; NaN where a point is missing.
fn number(cell: &str) -> Result<f64, Cause> {
    if cell.is_empty() || MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word)) {
        return Ok(f64::NAN);
    }
    let shown: String = cell.chars().take(SHOWN).collect();
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("{shown:?} is not a finite number").into()),
        Err(_) if cell.matches(',').count() == 1 && cell.replace(',', ".").parse::<f64>().is_ok() => {
            Err(format!("{shown:?} has a decimal comma\nhelp: write a decimal point").into())
        }
        Err(_) => Err(format!(
            "{shown:?} is not a number\nhelp: write numbers, and nan, bad, -- or nothing for missing points; headings start with #"
        )
        .into()),
    }
}
