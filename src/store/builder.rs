//! Putting a table together, with every mistake found before anything is written.

use crate::schema::{EventCounts, EventKind, Table};

use super::error::FrameError;
use super::frame::{ColumnData, Frame, position, wrong_kind};

/// A table that is being put together. What does not fit is reported by [`FrameBuilder::build`], the first
/// fault first.
#[derive(Debug)]
pub struct FrameBuilder {
    table: &'static Table,
    columns: Vec<Option<ColumnData>>,
    error: Option<FrameError>,
}

impl Frame {
    /// Begins a table; its columns are given by name, in any order.
    #[must_use]
    pub fn of(table: &'static Table) -> FrameBuilder {
        FrameBuilder::new(table)
    }
}

impl FrameBuilder {
    pub(super) fn new(table: &'static Table) -> Self {
        Self { table, columns: vec![None; table.columns.len()], error: None }
    }

    /// Gives a column of real numbers: `f64`, or `Option<f64>` where values may be missing.
    #[must_use]
    pub fn f64<T: Into<Option<f64>>>(self, name: &str, values: impl IntoIterator<Item = T>) -> Self {
        self.with(name, ColumnData::F64(values.into_iter().map(Into::into).collect()))
    }

    /// Gives a column of whole numbers: `i64`, or `Option<i64>` where values may be missing.
    #[must_use]
    pub fn i64<T: Into<Option<i64>>>(self, name: &str, values: impl IntoIterator<Item = T>) -> Self {
        self.with(name, ColumnData::I64(values.into_iter().map(Into::into).collect()))
    }

    /// Gives a column of counts or positions. One that no signed integer can hold becomes missing, and is
    /// refused where it may not be.
    #[must_use]
    pub fn count(self, name: &str, values: impl IntoIterator<Item = usize>) -> Self {
        let values = values.into_iter().map(|value| i64::try_from(value).ok());
        self.with(name, ColumnData::I64(values.collect()))
    }

    /// Gives the columns of event counts, one for each kind.
    #[must_use]
    pub fn counts(self, counts: impl IntoIterator<Item = EventCounts>) -> Self {
        let counts: Vec<EventCounts> = counts.into_iter().collect();
        EventKind::ALL.into_iter().fold(self, |frame, kind| {
            frame.count(&format!("{}_count", kind.word()), counts.iter().map(|of| of[kind]))
        })
    }

    /// Gives a column of truth values: `bool`, or `Option<bool>` where values may be missing.
    #[must_use]
    pub fn bool<T: Into<Option<bool>>>(self, name: &str, values: impl IntoIterator<Item = T>) -> Self {
        self.with(name, ColumnData::Bool(values.into_iter().map(Into::into).collect()))
    }

    /// Gives a column of words, none missing.
    #[must_use]
    pub fn text<T: Into<String>>(self, name: &str, values: impl IntoIterator<Item = T>) -> Self {
        self.text_or_null(name, values.into_iter().map(Some))
    }

    /// Gives a column of words, some of which may be missing.
    #[must_use]
    pub fn text_or_null<T: Into<String>>(
        self,
        name: &str,
        values: impl IntoIterator<Item = Option<T>>,
    ) -> Self {
        let values = values.into_iter().map(|value| value.map(Into::into));
        self.with(name, ColumnData::Text(values.collect()))
    }

    /// Gives a column.
    #[must_use]
    pub fn with(mut self, name: &str, data: ColumnData) -> Self {
        if let Err(error) = self.place(name, data) {
            self.error.get_or_insert(error);
        }
        self
    }

    fn place(&mut self, name: &str, data: ColumnData) -> Result<(), FrameError> {
        let at = position(self.table, name)?;
        let column = &self.table.columns[at];
        if data.kind() != column.kind {
            return Err(wrong_kind(self.table, name, column.kind, data.kind()));
        }
        if self.columns[at].is_some() {
            return Err(self.fault(format!("was given the column {name:?} twice")));
        }
        if let Some((row, value)) = data.first_not_finite() {
            return Err(self.fault(format!(
                "was given {value} in the column {name:?}, row {row}: every number must be finite, and a \
                 missing one is null"
            )));
        }
        if let (false, Some(row)) = (column.nullable, data.first_missing()) {
            return Err(self.fault(format!(
                "lacks a value in the column {name:?}, row {row}: this column must be complete"
            )));
        }
        self.columns[at] = Some(data);
        Ok(())
    }

    fn fault(&self, problem: String) -> FrameError {
        FrameError::new(self.table.name, problem)
    }

    /// The table, if it fits.
    ///
    /// # Errors
    /// If a column was unknown, given twice, of another kind, not finite, or null where it may not be; if one
    /// is missing; or if they differ in length.
    pub fn build(mut self) -> Result<Frame, FrameError> {
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        let names = || self.table.columns.iter().map(|column| column.name);
        let absent: Vec<&str> =
            names().zip(&self.columns).filter_map(|(name, data)| data.is_none().then_some(name)).collect();
        if !absent.is_empty() {
            return Err(self.fault(format!("was not given: {}", absent.join(", "))));
        }
        let columns: Vec<ColumnData> = self.columns.iter_mut().filter_map(Option::take).collect();
        let rows = columns.first().map_or(0, ColumnData::len);
        let uneven = names().zip(&columns).find(|(_, data)| data.len() != rows);
        if let Some((name, data)) = uneven {
            return Err(self.fault(format!(
                "has columns of different length: {} values in {name:?}, {rows} in {:?}",
                data.len(),
                self.table.columns[0].name
            )));
        }
        Ok(Frame { table: self.table, rows, columns })
    }
}
