//! Cells of a line of text, and the numbers in them.

use super::Cause;

/// Words for a missing point, in upper or lower case.
const MISSING: [&str; 9] = ["nan", "+nan", "-nan", "bad", "--", "---", "inf", "-inf", "infinite"];
/// Bytes of a cell that an error shows.
const SHOWN: usize = 24;

/// Separator of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::store) enum Separator {
    /// Any number of spaces and tabs.
    Blank,
    /// One sign: nothing between two of them is a missing point.
    Sign(char),
}

impl Separator {
    /// Separator of the numbers of a line.
    pub(in crate::store) fn of(line: &str) -> Self {
        let line = &outside_quotes(line);
        let one_each = |sign: char| line.split(sign).all(|cell| !cell.trim().contains(char::is_whitespace));
        if line.contains(';') {
            Self::Sign(';')
        } else if line.contains('\t') && one_each('\t') {
            Self::Sign('\t')
        } else if line.contains(',') && !has_decimal_commas(line) {
            Self::Sign(',')
        } else {
            Self::Blank
        }
    }

    /// Separator of the words of a line, which may contain blanks themselves.
    pub(in crate::store) fn of_words(line: &str) -> Self {
        let line = &outside_quotes(line);
        ['\t', ';', ','].into_iter().find(|sign| line.contains(*sign)).map_or(Self::Blank, Self::Sign)
    }

    /// Cells of a line without the blanks and quotation marks around them.
    pub(in crate::store) fn cells(self, line: &str) -> Vec<&str> {
        let mut quoted = false;
        let mut ends = |sign: char| {
            quoted ^= sign == '"';
            !quoted
                && match self {
                    Self::Blank => sign.is_whitespace(),
                    Self::Sign(separator) => sign == separator,
                }
        };
        let cells = line.split(|sign: char| ends(sign));
        match self {
            Self::Blank => cells.filter(|cell| !cell.is_empty()).map(unquoted).collect(),
            Self::Sign(_) => cells.map(unquoted).collect(),
        }
    }
}

/// A cell without the blanks and quotation marks around it.
fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(cell, str::trim)
}

/// A line without its quoted parts.
fn outside_quotes(line: &str) -> String {
    line.split('"').step_by(2).collect()
}

/// True if a line is several numbers between blanks, each with a comma inside.
fn has_decimal_commas(line: &str) -> bool {
    let mut cells =
        line.split_whitespace().map(|cell| cell.trim_matches(',').contains(',') && !cell.ends_with(','));
    line.split_whitespace().nth(1).is_some() && cells.all(|inside| inside)
}

/// True for an empty cell or a word for a missing point.
fn is_missing(cell: &str) -> bool {
    cell.is_empty() || MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// A number with a decimal comma.
fn with_comma(cell: &str) -> Option<f64> {
    (cell.matches(',').count() == 1 && !cell.contains('.'))
        .then(|| cell.replace(',', ".").parse().ok())
        .flatten()
}

/// True for a cell of a row: a number, or a missing point.
pub(in crate::store) fn is_value(cell: &str) -> bool {
    is_missing(cell) || cell.parse::<f64>().is_ok() || with_comma(cell).is_some()
}

/// Decimal signs of the numbers of a file.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::store) struct Decimals {
    point: bool,
    pub(in crate::store) comma: bool,
}

impl Decimals {
    /// A height; NaN where a point is missing.
    pub(in crate::store) fn number(&mut self, cell: &str) -> Result<f64, Cause> {
        if is_missing(cell) {
            return Ok(f64::NAN);
        }
        let shown = || cell.chars().take(SHOWN).collect::<String>();
        let value = match cell.parse::<f64>() {
            Ok(value) => {
                self.point |= cell.contains('.');
                value
            }
            Err(_) => {
                self.comma = true;
                with_comma(cell).ok_or_else(|| {
                    format!(
                        "{:?} is not a number\nhelp: write numbers, and nan, bad, -- or nothing for missing \
                         points; skip lines before the numbers with surface.skip_lines (--skip-lines)",
                        shown()
                    )
                })?
            }
        };
        if self.point && self.comma {
            return Err(format!(
                "{:?}: the numbers have decimal points and decimal commas\nhelp: write one of them",
                shown()
            )
            .into());
        }
        if value.is_finite() {
            Ok(value)
        } else {
            Err(format!("{:?} is not a finite number", shown()).into())
        }
    }
}
