//! Parameters that distinguish the cases of a table.

use super::StatsError;
use super::digits::labels_with_unit;
use crate::schema::{Parameter, parameters_by_rank};
use crate::store::{ColumnData, Frame};
use std::collections::HashMap;

/// Parameters that are not known before a measured surface is read; of others a missing value is none.
const UNKNOWN: [&str; 2] = ["length_m", "rms_height_m"];

/// The values of a parameter, one per row.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers; those of measured surfaces may be missing.
    Numbers(Vec<Option<f64>>),
    /// Words.
    Words(Vec<String>),
}

/// A parameter that differs between rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Varying {
    /// Name of its column.
    pub name: &'static str,
    /// Its symbol, a word if it has none.
    pub symbol: &'static str,
    /// Its name on an axis.
    pub label: &'static str,
    /// Its values, in the order of the requested rows.
    pub values: Values,
    /// The values as labels.
    texts: Vec<String>,
    /// Rows whose case does not read the parameter.
    absent: Vec<bool>,
}

impl Varying {
    /// A parameter with its values.
    pub fn new(parameter: &Parameter, values: Values) -> Self {
        let mut varying = Self::named_as([parameter.column.name, parameter.symbol, parameter.label], values);
        if parameter.of_method {
            varying.absent = match &varying.values {
                Values::Numbers(numbers) => numbers.iter().map(Option::is_none).collect(),
                Values::Words(words) => words.iter().map(String::is_empty).collect(),
            };
        }
        varying
    }

    /// A quantity with its values: name, symbol and label. It belongs to no method.
    pub fn named_as([name, symbol, label]: [&'static str; 3], values: Values) -> Self {
        let texts: Vec<String> = match &values {
            Values::Numbers(numbers) => {
                let known: Vec<f64> = numbers.iter().flatten().copied().collect();
                let mut texts = labels_with_unit(name, &known).into_iter();
                let missing = if UNKNOWN.contains(&name) { "?" } else { "none" };
                numbers
                    .iter()
                    .map(|number| number.and_then(|_| texts.next()).unwrap_or_else(|| missing.to_owned()))
                    .collect()
            }
            Values::Words(words) => words
                .iter()
                .map(|word| if word.is_empty() { "none".to_owned() } else { word.clone() })
                .collect(),
        };
        let absent = vec![false; texts.len()];
        Self { name, symbol, label, values, texts, absent }
    }

    /// The value of a row as a label: `64`, `0.5 nm`, `spots`, `none`, or `?` where it is not known.
    pub fn text(&self, row: usize) -> &str {
        self.texts.get(row).map_or("?", String::as_str)
    }

    /// True if the case of a row does not read the parameter: labels omit it.
    pub fn is_absent(&self, row: usize) -> bool {
        self.absent.get(row).copied().unwrap_or_default()
    }

    /// The value of a row with the symbol before it: `ζ = 64`, `interaction = none`. A word that names its
    /// parameter has no symbol.
    pub fn named(&self, row: usize) -> String {
        match self.values {
            Values::Words(_) if self.text(row) != "none" => self.text(row).to_owned(),
            _ => self.assigned(row),
        }
    }

    /// The value of a row with the symbol before it, whatever the value is: `interaction = point`.
    pub fn assigned(&self, row: usize) -> String {
        format!("{} = {}", self.symbol, self.text(row))
    }
}

/// True if the values of a parameter differ: of one that only one method reads, between the rows of one
/// method.
fn differ<T: PartialEq>(parameter: &Parameter, picked: &[T], same_method: &[usize]) -> bool {
    let first = |place: usize| if parameter.of_method { same_method[place] } else { 0 };
    (0..picked.len()).any(|place| picked[place] != picked[first(place)])
}

/// The parameters that differ between the given rows of the table `cases`, those of the surface first.
///
/// # Errors
/// If the table lacks one of the columns.
pub fn varying(cases: &Frame, rows: &[usize]) -> Result<Vec<Varying>, StatsError> {
    let mut found = Vec::new();
    let files = cases.text_or_null("surface_file")?;
    let measured = rows.iter().any(|row| files.get(*row).is_some_and(Option::is_some));
    let methods = cases.text_or_null("method")?;
    let places = (0..rows.len()).map(|place| {
        rows.iter().position(|row| methods.get(*row) == methods.get(rows[place])).unwrap_or(place)
    });
    // The first row with the method of each row.
    let same_method: Vec<usize> = places.collect();
    // The size and roughness of a measured surface follow from its file and are not named; nor are those of
    // a table.
    let tables = cases.text_or_null("spectrum_file")?;
    let tabulated = rows.iter().any(|row| tables.get(*row).is_some_and(Option::is_some));
    // One file of two sizes is two cases.
    let sides = cases.f64_or_null("length_m")?;
    let mut side_of = HashMap::new();
    let has_sizes = rows.iter().any(|row| {
        let Some(file) = &files[*row] else { return false };
        *side_of.entry(file).or_insert(sides[*row]) != sides[*row]
    });
    let follows = |name: &str| {
        measured && (name == "rms_height_m" || name == "length_m" && !has_sizes)
            || tabulated && matches!(name, "rms_height_m" | "spectrum_reading" | "left_out_ratio")
    };
    for parameter in parameters_by_rank().into_iter().filter(|parameter| !follows(parameter.column.name)) {
        let values = match cases.column(parameter.column.name)? {
            ColumnData::F64(all) => {
                let picked: Vec<Option<f64>> =
                    rows.iter().map(|row| all.get(*row).copied().flatten()).collect();
                differ(parameter, &picked, &same_method).then_some(Values::Numbers(picked))
            }
            ColumnData::Text(all) => {
                let picked: Vec<String> =
                    rows.iter().map(|row| all.get(*row).cloned().flatten().unwrap_or_default()).collect();
                differ(parameter, &picked, &same_method).then_some(Values::Words(picked))
            }
            ColumnData::I64(_) | ColumnData::Bool(_) => None,
        };
        found.extend(values.map(|values| Varying::new(parameter, values)));
    }
    Ok(found)
}
