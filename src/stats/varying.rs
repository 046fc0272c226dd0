//! Which parameters tell the cases of a table apart.

use super::StatsError;
use super::digits::labels_with_unit;
use crate::store::{ColumnData, Frame};

/// Columns that may define a case, with the symbol and the axis label of each; labels have the markup of the figures.
pub(super) const PARAMETERS: [(&str, &str, &str); 19] = [
    ("surface_file", "surface", "surface"),
    ("surface_dataset", "dataset", "dataset"),
    ("detrend", "detrend", "levelling"),
    ("magnification", "ζ", "magnification ζ"),
    ("hurst", "H", "Hurst exponent H"),
    ("rms_height_m", "h", "h_{rms} [m]"),
    ("length_m", "L", "L [m]"),
    ("points_per_shortest_wavelength", "n", "points per shortest wavelength"),
    ("contact_modulus_pa", "E*", "E^{*} [Pa]"),
    ("work_of_adhesion_j_m2", "Δγ", "Δγ [J/m^{2}]"),
    ("interaction_range_m", "ε", "ε [m]"),
    ("approach_step", "step", "output step/h_{rms}"),
    ("interaction", "interaction", "interaction"),
    ("boundary", "boundary", "boundary"),
    ("coalescence", "coalescence", "coalescence"),
    ("jump_in", "jump_in", "jump-in criterion"),
    ("normalization", "normalization", "normalization"),
    ("amplitudes", "amplitudes", "amplitudes"),
    ("as_printed", "as_printed", "uncorrected equations"),
];

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
    /// Its values, in the order of the rows that were asked for.
    pub values: Values,
    /// The values as labels.
    texts: Vec<String>,
}

impl Varying {
    /// A parameter with its values.
    pub fn new((name, symbol, label): (&'static str, &'static str, &'static str), values: Values) -> Self {
        let texts = match &values {
            Values::Numbers(numbers) => {
                let known: Vec<f64> = numbers.iter().flatten().copied().collect();
                let mut texts = labels_with_unit(name, &known).into_iter();
                numbers.iter().map(|number| number.and_then(|_| texts.next()).unwrap_or_else(|| "?".to_owned())).collect()
            }
            Values::Words(words) => words.iter().map(|word| if word.is_empty() { "none".to_owned() } else { word.clone() }).collect(),
        };
        Self { name, symbol, label, values, texts }
    }

    /// The value of a row as a label: `64`, `0.5 nm`, `spots`, or `?` where it is missing.
    pub fn text(&self, row: usize) -> &str {
        self.texts.get(row).map_or("?", String::as_str)
    }

    /// The value of a row with the symbol before it: `ζ = 64`, `interaction = none`; a word that names its parameter stands alone.
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

/// The parameters that differ between the given rows of the table `cases`, those of the surface first.
///
/// # Errors
/// If the table lacks one of the columns.
pub fn varying(cases: &Frame, rows: &[usize]) -> Result<Vec<Varying>, StatsError> {
    let mut found = Vec::new();
    let files = cases.text_or_null("surface_file")?;
    let measured = rows.iter().any(|row| files.get(*row).is_some_and(Option::is_some));
    // What a measured surface is as large and rough as follows from which it is, and names none.
    for (name, symbol, label) in PARAMETERS.into_iter().filter(|(name, ..)| !measured || !matches!(*name, "rms_height_m" | "length_m")) {
        let values = match cases.column(name)? {
            ColumnData::F64(all) => {
                let picked: Vec<Option<f64>> = rows.iter().map(|row| all.get(*row).copied().flatten()).collect();
                picked.windows(2).any(|pair| pair.first() != pair.last()).then_some(Values::Numbers(picked))
            }
            ColumnData::Text(all) => {
                let picked: Vec<String> = rows.iter().map(|row| all.get(*row).cloned().flatten().unwrap_or_default()).collect();
                picked.windows(2).any(|pair| pair.first() != pair.last()).then_some(Values::Words(picked))
            }
            ColumnData::I64(_) | ColumnData::Bool(_) => None,
        };
        found.extend(values.map(|values| Varying::new((name, symbol, label), values)));
    }
    Ok(found)
}
