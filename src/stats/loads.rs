//! Load reversals of the table `cases` in the unit of the spec.

use super::digits::labels_with_unit;
use super::{CaseInput, Given, StatsError, Value};
use crate::store::Frame;

/// Load reversals in one unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Loads {
    /// Values, one for each row.
    pub values: Vec<f64>,
    /// Symbol of the quantity, with the markup of the report.
    pub symbol: &'static str,
    /// Column of the values.
    column: &'static str,
}

/// Symbols of a load over `E* A0`, in newtons and in pascals.
pub(super) const OVER_MODULUS: &str = "F_{max}/(E*A_{0})";
pub(super) const FORCE: &str = "F_{max}";
const PRESSURE: &str = "F_{max}/A_{0}";

/// Significant digits of a load in newtons or pascals, which was divided by `E* A0` and multiplied again.
const DIGITS: usize = 12;

impl Loads {
    /// Labels of some rows, with their unit.
    #[must_use]
    pub fn labels(&self, rows: impl IntoIterator<Item = usize>) -> Vec<String> {
        let picked: Vec<f64> = rows.into_iter().filter_map(|row| self.values.get(row)).copied().collect();
        labels_with_unit(self.column, &picked)
    }

    /// Labels of all rows.
    #[must_use]
    pub fn all_labels(&self) -> Vec<String> {
        self.labels(0..self.values.len())
    }
}

/// The load reversals of the rows of the table `cases`: in newtons or pascals if the spec gives them so, else
/// over `E* A0`.
///
/// # Errors
/// If the table lacks a column.
pub fn loads(cases: &Frame) -> Result<Loads, StatsError> {
    let units = cases.text_or_null("load_unit")?;
    let is_all = |unit: &str| !units.is_empty() && units.iter().all(|of| of.as_deref() == Some(unit));
    for (unit, column, symbol) in [("N", "max_load_n", FORCE), ("Pa", "max_load_pa", PRESSURE)] {
        let known: Option<Vec<f64>> = cases.f64_or_null(column)?.iter().copied().collect();
        if let Some(values) = known.filter(|_| is_all(unit)) {
            return Ok(Loads { values: values.into_iter().map(rounded).collect(), symbol, column });
        }
    }
    Ok(Loads { values: cases.f64("max_load")?, symbol: OVER_MODULUS, column: "max_load" })
}

/// A load reversal `F/(E* A0)` in the unit of a spec: `F_max = 2 µN`. Newtons need the side of the square
/// \[m\].
#[must_use]
pub fn load_in_words(max_load: f64, unit: &str, modulus_pa: f64, side_m: Option<f64>) -> String {
    let pressure_pa = modulus_pa * max_load;
    let (symbol, column, value) = match (unit, side_m) {
        ("N", Some(side_m)) => ("F_max", "max_load_n", pressure_pa * side_m * side_m),
        ("Pa", _) => ("F_max/A₀", "max_load_pa", pressure_pa),
        _ => ("F_max/(E*A₀)", "max_load", max_load),
    };
    format!("{symbol} = {}", labels_with_unit(column, &[rounded(value)]).concat())
}

fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

/// Columns of a load reversal `F/(E* A0)` of a case.
pub(super) fn columns(case: &CaseInput, max_load: f64) -> Given {
    let number = |column: &str| {
        case.parameters.iter().find(|(name, _)| name == column).and_then(|(_, value)| value.number())
    };
    let pressure_pa = number("contact_modulus_pa").map(|modulus_pa| modulus_pa * max_load);
    let force_n = pressure_pa.zip(number("length_m")).map(|(pressure_pa, side)| pressure_pa * side * side);
    vec![
        ("max_load".to_owned(), max_load.into()),
        ("max_load_n".to_owned(), force_n.into()),
        ("max_load_pa".to_owned(), pressure_pa.into()),
        ("load_unit".to_owned(), Value::from(case.load_unit)),
    ]
}
