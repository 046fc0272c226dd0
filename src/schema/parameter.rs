//! A parameter of a case: column, symbol, axis label and value.

use super::Column;
use crate::model::CaseParams;

/// Value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValue {
    /// Number in the unit of the column.
    Number(f64),
    /// Word.
    Word(String),
}

/// Parameters of a case, and the parameters derived from its files.
#[derive(Debug, Clone)]
pub struct CaseFacts<'a> {
    /// Parameters of the spec.
    pub params: &'a CaseParams,
    /// Label of the file of a measured surface.
    pub surface_file: Option<String>,
    /// Side of the square \[m\].
    pub length_m: Option<f64>,
    /// Root-mean-square height: target of a generated surface, value of a measured one \[m\].
    pub rms_height_m: Option<f64>,
    /// Grid points of boundary elements along a side.
    pub element_points: Option<f64>,
    /// Range ρ of the Morse law \[m\].
    pub attraction_range_m: Option<f64>,
}

/// One parameter of a case.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Column of the tables over realizations.
    pub column: Column,
    /// Symbol; a word if there is none.
    pub symbol: &'static str,
    /// Label of an axis, with the markup of the figures.
    pub label: &'static str,
    /// Place in the labels of cases, from 0.
    pub rank: u8,
    /// True if only some cases read it, as those of one method: it varies if it differs between cases of one
    /// method, and labels of other cases omit it.
    pub of_method: bool,
    /// Value in a case; nothing if the case has none.
    pub get: fn(&CaseFacts<'_>) -> Option<ParameterValue>,
}

impl Parameter {
    /// The parameter as one that only some cases read.
    pub(super) const fn of_method(mut self) -> Self {
        self.of_method = true;
        self
    }
}

/// A parameter with symbol and label that both methods read.
pub(super) const fn parameter(
    column: Column,
    [symbol, label]: [&'static str; 2],
    rank: u8,
    get: fn(&CaseFacts<'_>) -> Option<ParameterValue>,
) -> Parameter {
    Parameter { column, symbol, label, rank, of_method: false, get }
}
