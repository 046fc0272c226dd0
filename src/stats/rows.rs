//! Rows of mixed values, put together one by one and turned into a checked table.

use super::{Given, StatsError};
use crate::schema::{Kind, ParameterValue, Table};
use crate::store::{ColumnData, Frame};

/// One value of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A real number.
    Real(f64),
    /// A whole number.
    Whole(i64),
    /// A word.
    Word(String),
    /// A missing value.
    Missing,
}

impl Value {
    /// The value as a number; nothing for text and for a missing value.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Real(real) => Some(*real),
            Self::Whole(whole) => Some(*whole as f64),
            Self::Word(_) | Self::Missing => None,
        }
    }

    /// The value as a word; nothing for numbers and for a missing value.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        if let Self::Word(word) = self { Some(word) } else { None }
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Real(value)
    }
}

impl From<i64> for Value {
    fn from(value: i64) -> Self {
        Self::Whole(value)
    }
}

impl From<usize> for Value {
    /// A count that no signed integer holds is missing, which the table then refuses.
    fn from(value: usize) -> Self {
        i64::try_from(value).map_or(Self::Missing, Self::Whole)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Word(value.to_owned())
    }
}

impl From<ParameterValue> for Value {
    fn from(value: ParameterValue) -> Self {
        match value {
            ParameterValue::Number(number) => Self::Real(number),
            ParameterValue::Word(word) => Self::Word(word),
        }
    }
}

impl<T: Into<Self>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Missing, Into::into)
    }
}

/// The rows of a table.
pub(super) struct Rows {
    table: &'static Table,
    rows: Vec<Vec<Value>>,
}

impl Rows {
    pub(super) fn of(table: &'static Table) -> Self {
        Self { table, rows: Vec::new() }
    }

    /// Adds a row: each column takes the first value of its name, and is missing if there is none. Values of
    /// no column of this table are left out.
    pub(super) fn push(&mut self, sources: &[&Given]) {
        let find =
            |name: &str| sources.iter().flat_map(|given| given.iter()).find(|(known, _)| known == name);
        let row = self
            .table
            .columns
            .iter()
            .map(|column| find(column.name).map_or(Value::Missing, |(_, value)| value.clone()));
        self.rows.push(row.collect());
    }

    /// The rows as a table, which checks kinds, nulls and finiteness.
    pub(super) fn build(self) -> Result<Frame, StatsError> {
        let mut frame = Frame::of(self.table);
        for (at, column) in self.table.columns.iter().enumerate() {
            let values = self.rows.iter().filter_map(|row| row.get(at));
            // A value of another kind becomes missing, and is then refused where the column must be complete.
            let data = match column.kind {
                Kind::F64 => ColumnData::F64(values.map(Value::number).collect()),
                Kind::I64 => ColumnData::I64(
                    values
                        .map(|value| if let Value::Whole(whole) = value { Some(*whole) } else { None })
                        .collect(),
                ),
                Kind::Text => ColumnData::Text(
                    values
                        .map(|value| if let Value::Word(word) = value { Some(word.clone()) } else { None })
                        .collect(),
                ),
                Kind::Bool => ColumnData::Bool(values.map(|_| None).collect()),
            };
            frame = frame.with(column.name, data);
        }
        Ok(frame.build()?)
    }
}
