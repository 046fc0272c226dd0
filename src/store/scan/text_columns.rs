//! Headings of columns: names with units, as in `X [um]  Y [um]  Z [nm]`.

use super::text_cells::{Separator, is_value};
use crate::lengths::metres;

/// A column of numbers.
#[derive(Debug, Clone)]
pub(super) struct Column {
    /// Letters and digits of its name in lower case.
    name: String,
    /// Its unit, as the heading has it.
    pub(super) unit: Option<String>,
}

/// Quantity of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    X,
    Y,
    Height,
    /// Wavevector, frequency or spectral density.
    Spectrum,
}

/// Words behind x, y or z in the name of a coordinate.
const COORDINATES: [&str; 7] = ["", "position", "pos", "coordinate", "coord", "axis", "value"];
/// Names and parts of names in spectra.
const SPECTRA: [&str; 6] = ["wavevector", "wavenumber", "frequency", "psd", "powerspectr", "spectraldensity"];

/// The columns that a line names; nothing if a cell is a number.
pub(super) fn columns(line: &str) -> Option<Vec<Column>> {
    let separator = Separator::of_words(line);
    let mut found: Vec<Column> = Vec::new();
    for cell in separator.cells(line) {
        if is_value(cell) {
            return None;
        }
        let column = Column::of(cell);
        match found.last_mut() {
            // "X [um]" between blanks is one column.
            Some(last)
                if separator == Separator::Blank
                    && column.name.is_empty()
                    && last.unit.is_none()
                    && cell.starts_with(['[', '(']) =>
            {
                last.unit = column.unit;
            }
            _ => found.push(column),
        }
    }
    Some(found)
}

/// True if a heading consists of units alone.
pub(super) fn are_units(columns: &[Column]) -> bool {
    columns.iter().all(|column| column.name.is_empty() && column.unit.is_some())
}

impl Column {
    fn of(text: &str) -> Self {
        let text = text.trim();
        let (name, unit) = Self::bracketed(text).or_else(|| Self::behind(text)).unwrap_or((text, None));
        if unit.is_none() && name.len() > 1 && metres(name).is_some() {
            return Self { name: String::new(), unit: Some(name.to_owned()) };
        }
        let name = name.chars().filter(|sign| sign.is_alphanumeric()).flat_map(char::to_lowercase).collect();
        Self { name, unit: unit.map(ToOwned::to_owned) }
    }

    /// A unit in brackets, as in "Height (nm)".
    fn bracketed(text: &str) -> Option<(&str, Option<&str>)> {
        let (name, unit) = text.strip_suffix([']', ')'])?.rsplit_once(['[', '('])?;
        Some((name, Some(unit.trim()).filter(|unit| !unit.is_empty())))
    }

    /// A unit behind a sign or a word, as in "x/um", "z_nm" and "Height in nm".
    fn behind(text: &str) -> Option<(&str, Option<&str>)> {
        let parts = [text.rsplit_once(" in "), text.rsplit_once(['/', '_', ' '])];
        let (name, unit) = parts.into_iter().flatten().find(|(_, unit)| metres(unit).is_some())?;
        Some((name, Some(unit)))
    }

    /// Quantity of the column, if its name states it.
    pub(super) fn role(&self) -> Option<Role> {
        let name = self.name.as_str();
        if ["q", "k", "c", "c1d", "c2d", "ciso"].contains(&name)
            || SPECTRA.iter().any(|part| name.contains(part))
        {
            return Some(Role::Spectrum);
        }
        let coordinate = |sign: char| name.strip_prefix(sign).is_some_and(|rest| COORDINATES.contains(&rest));
        if coordinate('x') {
            Some(Role::X)
        } else if coordinate('y') {
            Some(Role::Y)
        } else if coordinate('z')
            || name == "h"
            || ["height", "topograph", "elevation", "zsensor"].iter().any(|part| name.contains(part))
        {
            Some(Role::Height)
        } else {
            None
        }
    }
}
