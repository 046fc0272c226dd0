//! Files of the figures: formats, width on paper and font.

use std::fmt;

use serde::Serialize;
use toml::de::DeValue;

use super::entries::{entries, shown};
use super::fault::Faults;
use super::keys::Limits;
use super::nearest::nearest;
use super::number::number;
use super::value::word;
use super::written::{Written, array, wrong_type};

/// Formats of figures.
pub const FORMATS: [&str; 3] = ["svg", "png", "pdf"];

/// Formats that this build writes: PNG and PDF need the feature `raster`.
const WRITTEN: &[&str] = if cfg!(feature = "raster") { &FORMATS } else { &["svg"] };

/// Font of a spec that states none; its letters are part of the program.
pub(super) const DEFAULT_FONT: &str = "DejaVu Sans";

/// Bytes of the name of a font, at most.
pub(super) const LONGEST_FONT: usize = 64;

/// Keys of the table.
const TAKES: [&str; 4] = ["format", "width_mm", "font", "loads"];

/// Loads of the panels of a sweep.
pub(super) const LOADS: [&str; 2] = ["largest", "all"];

/// Bounds of the width of a panel without labels at its right.
pub(super) const WIDTH: Limits = Limits {
    low: 20.0,
    above: false,
    high: 400.0,
    unit: " mm",
    unit_name: "millimetres",
    slip: None,
    note: "a journal column is about 88 mm wide",
};

/// Files of the figures of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figures {
    /// Formats, in the order of [`FORMATS`].
    pub format: Vec<&'static str>,
    /// Width of a panel on paper \[mm\].
    pub width_mm: f64,
    /// Font family of the SVG files.
    pub font: String,
    /// Loads in the panels of sweeps of other parameters, of [`LOADS`].
    pub loads: &'static str,
}

impl Default for Figures {
    fn default() -> Self {
        Self { format: FORMATS.to_vec(), width_mm: 88.0, font: DEFAULT_FONT.to_owned(), loads: LOADS[0] }
    }
}

impl Figures {
    /// True if panels of sweeps have all loads.
    #[must_use]
    pub fn has_all_loads(&self) -> bool {
        self.loads == LOADS[1]
    }

    /// The formats that are chosen and that this build writes; SVG if it writes none of them.
    #[must_use]
    pub fn written(&self) -> Vec<&'static str> {
        let written: Vec<_> = self.format.iter().copied().filter(|format| WRITTEN.contains(format)).collect();
        if written.is_empty() && !self.format.is_empty() { vec!["svg"] } else { written }
    }

    /// The formats that are chosen and that this build does not write.
    #[must_use]
    pub fn left_out(&self) -> Vec<&'static str> {
        self.format.iter().copied().filter(|format| !WRITTEN.contains(format)).collect()
    }
}

/// As a spec has it.
impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let formats: Vec<String> = self.format.iter().map(|format| format!("\"{format}\"")).collect();
        write!(
            f,
            "{{ format = [{}], width_mm = {:?}, font = \"{}\", loads = \"{}\" }}",
            formats.join(", "),
            self.width_mm,
            self.font,
            self.loads
        )
    }
}

/// The table of a spec.
pub(super) fn figures(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<Figures> {
    let DeValue::Table(table) = value.get_ref() else {
        let help = "write { format = [\"svg\", \"pdf\"], width_mm = 88 }".to_owned();
        wrong_type("figures", "a table", value.get_ref(), &value.span(), help, faults);
        return None;
    };
    let mut read = Figures::default();
    for (name, span, written) in entries(table) {
        match name {
            "format" => read.format = formats(written, faults)?,
            "width_mm" => read.width_mm = number("figures.width_mm", &WIDTH, written, faults)?,
            "font" => read.font = font(written, faults)?,
            "loads" => read.loads = word("figures.loads", &LOADS, written, faults)?,
            unknown => {
                let listed = format!("keys of `figures`: {}", TAKES.join(", "));
                let help = nearest(unknown, TAKES)
                    .map_or_else(|| listed.clone(), |near| format!("did you mean `{near}`? {listed}"));
                faults.add(&span, format!("unknown key `{}` in `figures`", shown(unknown)), help);
                return None;
            }
        }
    }
    Some(read)
}

/// One format, or an array of formats.
fn formats(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<Vec<&'static str>> {
    if matches!(value.get_ref(), DeValue::String(_)) {
        return word("figures.format", &FORMATS, value, faults).map(|format| vec![format]);
    }
    let elements = array("figures.format", "strings", value, faults)?;
    let read: Vec<_> =
        elements.iter().map(|element| word("figures.format", &FORMATS, element, faults)).collect();
    let said: Vec<_> = read.into_iter().collect::<Option<_>>()?;
    Some(FORMATS.into_iter().filter(|format| said.contains(format)).collect())
}

/// The name of a font family.
fn font(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<String> {
    let span = value.span();
    let DeValue::String(found) = value.get_ref() else {
        wrong_type(
            "figures.font",
            "a string",
            value.get_ref(),
            &span,
            "write the name of a font family in quotes".to_owned(),
            faults,
        );
        return None;
    };
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == ' ' || c == '-';
    if (1..=LONGEST_FONT).contains(&found.len()) && found.chars().all(is_plain) {
        return Some(found.to_string());
    }
    let message =
        format!("`figures.font` cannot be {}: not the name of a font family", faults.written(&span));
    faults.add(&span, message, format!("use 1 to {LONGEST_FONT} letters, digits, spaces and -"));
    None
}
