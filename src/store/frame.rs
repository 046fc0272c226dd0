//! The rows of a table in memory, column by column, checked against its schema.

use crate::schema::{Column, Kind, Table};

use super::error::FrameError;

/// The values of one column; `None` is a missing one.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnData {
    /// Real numbers, all finite.
    F64(Vec<Option<f64>>),
    /// Whole numbers.
    I64(Vec<Option<i64>>),
    /// Truth values.
    Bool(Vec<Option<bool>>),
    /// Words.
    Text(Vec<Option<String>>),
}

impl ColumnData {
    /// Kind of the values.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::F64(_) => Kind::F64,
            Self::I64(_) => Kind::I64,
            Self::Bool(_) => Kind::Bool,
            Self::Text(_) => Kind::Text,
        }
    }

    /// Number of values, missing ones included.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::I64(values) => values.len(),
            Self::Bool(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// True if there are no values.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn first_missing(&self) -> Option<usize> {
        match self {
            Self::F64(values) => values.iter().position(Option::is_none),
            Self::I64(values) => values.iter().position(Option::is_none),
            Self::Bool(values) => values.iter().position(Option::is_none),
            Self::Text(values) => values.iter().position(Option::is_none),
        }
    }

    pub(super) fn first_not_finite(&self) -> Option<(usize, f64)> {
        let Self::F64(values) = self else { return None };
        values
            .iter()
            .enumerate()
            .find_map(|(row, value)| value.filter(|number| !number.is_finite()).map(|number| (row, number)))
    }
}

/// A table that fits its schema: every column is there, of the right kind, equally long, with nulls only
/// where they may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    pub(super) table: &'static Table,
    pub(super) rows: usize,
    pub(super) columns: Vec<ColumnData>,
}

impl Frame {
    /// Schema.
    #[must_use]
    pub fn table(&self) -> &'static Table {
        self.table
    }

    /// Number of rows.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.rows
    }

    /// Columns with their schemas, in order.
    pub fn columns(&self) -> impl Iterator<Item = (&'static Column, &ColumnData)> {
        self.table.columns.iter().zip(&self.columns)
    }

    /// The values of a column, whatever it holds.
    ///
    /// # Errors
    /// If the table has no such column.
    pub fn column(&self, name: &str) -> Result<&ColumnData, FrameError> {
        position(self.table, name).map(|at| &self.columns[at])
    }

    /// The real numbers of a column, missing ones as `None`.
    ///
    /// # Errors
    /// If the table has no such column, or the column holds something else. The same goes for all that
    /// follow.
    pub fn f64_or_null(&self, name: &str) -> Result<&[Option<f64>], FrameError> {
        match self.column(name)? {
            ColumnData::F64(values) => Ok(values),
            other => Err(self.wrong_kind(name, other, Kind::F64)),
        }
    }

    /// The whole numbers of a column, missing ones as `None`.
    pub fn i64_or_null(&self, name: &str) -> Result<&[Option<i64>], FrameError> {
        match self.column(name)? {
            ColumnData::I64(values) => Ok(values),
            other => Err(self.wrong_kind(name, other, Kind::I64)),
        }
    }

    /// The truth values of a column, missing ones as `None`.
    pub fn bool_or_null(&self, name: &str) -> Result<&[Option<bool>], FrameError> {
        match self.column(name)? {
            ColumnData::Bool(values) => Ok(values),
            other => Err(self.wrong_kind(name, other, Kind::Bool)),
        }
    }

    /// The words of a column, missing ones as `None`.
    pub fn text_or_null(&self, name: &str) -> Result<&[Option<String>], FrameError> {
        match self.column(name)? {
            ColumnData::Text(values) => Ok(values),
            other => Err(self.wrong_kind(name, other, Kind::Text)),
        }
    }

    /// The real numbers of a column that has no missing ones.
    pub fn f64(&self, name: &str) -> Result<Vec<f64>, FrameError> {
        let values = self.f64_or_null(name)?.iter().copied();
        values.collect::<Option<_>>().ok_or_else(|| self.missing(name))
    }

    /// The real number of a column in the first row.
    pub fn first_f64(&self, name: &str) -> Result<f64, FrameError> {
        self.f64_or_null(name)?.first().copied().flatten().ok_or_else(|| self.missing(name))
    }

    /// The whole numbers of a column that has no missing ones.
    pub fn i64(&self, name: &str) -> Result<Vec<i64>, FrameError> {
        let values = self.i64_or_null(name)?.iter().copied();
        values.collect::<Option<_>>().ok_or_else(|| self.missing(name))
    }

    /// The truth values of a column that has no missing ones.
    pub fn bool(&self, name: &str) -> Result<Vec<bool>, FrameError> {
        let values = self.bool_or_null(name)?.iter().copied();
        values.collect::<Option<_>>().ok_or_else(|| self.missing(name))
    }

    /// The words of a column that has no missing ones.
    pub fn text(&self, name: &str) -> Result<Vec<&str>, FrameError> {
        let values = self.text_or_null(name)?.iter().map(Option::as_deref);
        values.collect::<Option<_>>().ok_or_else(|| self.missing(name))
    }

    fn missing(&self, name: &str) -> FrameError {
        FrameError::new(
            self.table.name,
            format!("has missing values in the column {name:?}, where none were expected"),
        )
    }

    fn wrong_kind(&self, name: &str, found: &ColumnData, wanted: Kind) -> FrameError {
        wrong_kind(self.table, name, found.kind(), wanted)
    }
}

/// Error of a column that holds another kind than the expected one.
pub(super) fn wrong_kind(table: &'static Table, name: &str, is: Kind, wanted: Kind) -> FrameError {
    FrameError::new(table.name, format!("holds {} in the column {name:?}, not {}", is.word(), wanted.word()))
}

/// Place of a column in its table.
pub(super) fn position(table: &'static Table, name: &str) -> Result<usize, FrameError> {
    table.columns.iter().position(|column| column.name == name).ok_or_else(|| {
        let allowed: Vec<_> = table.columns.iter().map(|column| column.name).collect();
        FrameError::new(
            table.name,
            format!("has no column {name:?}\nhelp: use one of {}", allowed.join(", ")),
        )
    })
}
