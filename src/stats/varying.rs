//! Which parameters tell the cases of a table apart.

use super::StatsError;
use super::digits::labels_with_unit;
use crate::store::{ColumnData, Frame};

/// Columns that may define a case, with the symbol and the axis label of each; labels have the markup of the figures.
pub(super) const PARAMETERS: [(&str, &str, &str); 26] = [
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
    ("method", "method", "method"),
    ("element_points", "N", "grid points along a side"),
    ("attraction", "attraction", "attraction"),
    ("attraction_range_m", "ρ", "ρ [m]"),
    ("nucleation", "nucleation", "nucleation"),
    ("opening", "opening", "opening"),
    ("precision", "precision", "precision"),
    ("interaction", "interaction", "interaction"),
    ("boundary", "boundary", "boundary"),
    ("coalescence", "coalescence", "coalescence"),
    ("jump_in", "jump_in", "jump-in criterion"),
    ("normalization", "normalization", "normalization"),
    ("amplitudes", "amplitudes", "amplitudes"),
    ("as_printed", "as_printed", "uncorrected equations"),
];

/// Parameters that only one of the methods reads: they vary if they differ between cases of one method.
const OF_METHOD: [&str; 11] = [
    "approach_step",
    "interaction",
    "boundary",
    "coalescence",
    "jump_in",
    "element_points",
    "attraction",
    "attraction_range_m",
    "nucleation",
    "opening",
    "precision",
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
    /// Rows whose method does not read the parameter.
    absent: Vec<bool>,
}

impl Varying {
    /// A parameter with its values.
    pub fn new((name, symbol, label): (&'static str, &'static str, &'static str), values: Values) -> Self {
        let texts: Vec<String> = match &values {
            Values::Numbers(numbers) => {
                let known: Vec<f64> = numbers.iter().flatten().copied().collect();
                let mut texts = labels_with_unit(name, &known).into_iter();
                numbers.iter().map(|number| number.and_then(|_| texts.next()).unwrap_or_else(|| "?".to_owned())).collect()
            }
            Values::Words(words) => words.iter().map(|word| if word.is_empty() { "none".to_owned() } else { word.clone() }).collect(),
        };
        let absent = match &values {
            _ if !OF_METHOD.contains(&name) => vec![false; texts.len()],
            Values::Numbers(numbers) => numbers.iter().map(Option::is_none).collect(),
            Values::Words(words) => words.iter().map(String::is_empty).collect(),
        };
        Self { name, symbol, label, values, texts, absent }
    }

    /// The value of a row as a label: `64`, `0.5 nm`, `spots`, or `?` where it is missing.
    pub fn text(&self, row: usize) -> &str {
        self.texts.get(row).map_or("?", String::as_str)
    }

    /// True if the method of a row does not read the parameter: labels omit it.
    pub fn is_absent(&self, row: usize) -> bool {
        self.absent.get(row).copied().unwrap_or_default()
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

/// True if the values of a parameter differ: of one that only one method reads, between the rows of one method.
fn differ<T: PartialEq>(name: &str, picked: &[T], same_method: &[usize]) -> bool {
    let first = |place: usize| if OF_METHOD.contains(&name) { same_method[place] } else { 0 };
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
    let places = (0..rows.len()).map(|place| rows.iter().position(|row| methods.get(*row) == methods.get(rows[place])).unwrap_or(place));
    // The first row with the method of each row.
    let same_method: Vec<usize> = places.collect();
    // What a measured surface is as large and rough as follows from which it is, and names none.
    for (name, symbol, label) in PARAMETERS.into_iter().filter(|(name, ..)| !measured || !matches!(*name, "rms_height_m" | "length_m")) {
        let values = match cases.column(name)? {
            ColumnData::F64(all) => {
                let picked: Vec<Option<f64>> = rows.iter().map(|row| all.get(*row).copied().flatten()).collect();
                differ(name, &picked, &same_method).then_some(Values::Numbers(picked))
            }
            ColumnData::Text(all) => {
                let picked: Vec<String> = rows.iter().map(|row| all.get(*row).cloned().flatten().unwrap_or_default()).collect();
                differ(name, &picked, &same_method).then_some(Values::Words(picked))
            }
            ColumnData::I64(_) | ColumnData::Bool(_) => None,
        };
        found.extend(values.map(|values| Varying::new((name, symbol, label), values)));
    }
    Ok(found)
}
