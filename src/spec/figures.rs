//! Files of the figures: formats, width on paper and font.

use std::fmt;
use std::ops::Range;

use serde::Serialize;
use toml::de::DeValue;

use super::entries::{entries, shown};
use super::fault::Faults;
use super::keys::Limits;
use super::nearest::nearest;
use super::number::number;
use super::sweep::SweepDraft;
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
const TAKES: [&str; 5] = ["format", "width_mm", "font", "loads", "across"];

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
    /// Groups of sweeps with figures of all of their cases.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub across: Vec<Vec<String>>,
}

impl Default for Figures {
    fn default() -> Self {
        Self {
            format: FORMATS.to_vec(),
            width_mm: 88.0,
            font: DEFAULT_FONT.to_owned(),
            loads: LOADS[0],
            across: Vec::new(),
        }
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
            "{{ format = [{}], width_mm = {:?}, font = \"{}\", loads = \"{}\"",
            formats.join(", "),
            self.width_mm,
            self.font,
            self.loads
        )?;
        if !self.across.is_empty() {
            write!(f, ", across = {}", arrays(&self.across))?;
        }
        f.write_str(" }")
    }
}

/// Groups of words as TOML: one array for one group, an array of arrays for several.
pub(super) fn arrays(groups: &[Vec<impl AsRef<str>>]) -> String {
    let quoted = |word: &str| format!("\"{word}\"");
    let one = |group: &Vec<_>| -> String {
        let words: Vec<String> = group.iter().map(|word: &_| quoted(AsRef::as_ref(word))).collect();
        format!("[{}]", words.join(", "))
    };
    match groups {
        [only] => one(only),
        many => format!("[{}]", many.iter().map(one).collect::<Vec<_>>().join(", ")),
    }
}

/// Names of sweeps in `across`, and their places in the text.
pub(super) type Across = Vec<(String, Range<usize>)>;

/// The table of a spec, with the names of sweeps in it.
pub(super) fn figures(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<(Figures, Across)> {
    let DeValue::Table(table) = value.get_ref() else {
        let help = "write { format = [\"svg\", \"pdf\"], width_mm = 88 }".to_owned();
        wrong_type("figures", "a table", value.get_ref(), &value.span(), help, faults);
        return None;
    };
    let (mut read, mut names) = (Figures::default(), Across::new());
    for (name, span, written) in entries(table) {
        match name {
            "format" => read.format = formats(written, faults)?,
            "width_mm" => read.width_mm = number("figures.width_mm", &WIDTH, written, faults)?,
            "font" => read.font = font(written, faults)?,
            "loads" => read.loads = word("figures.loads", &LOADS, written, faults)?,
            "across" => read.across = across(written, &mut names, faults)?,
            unknown => {
                let listed = format!("keys of `figures`: {}", TAKES.join(", "));
                let help = nearest(unknown, TAKES)
                    .map_or_else(|| listed.clone(), |near| format!("did you mean `{near}`? {listed}"));
                faults.add(&span, format!("unknown key `{}` in `figures`", shown(unknown)), help);
                return None;
            }
        }
    }
    Some((read, names))
}

/// Groups of at least two sweeps: one array of names, or an array of such arrays.
fn across(value: &Written<'_>, names: &mut Across, faults: &mut Faults<'_>) -> Option<Vec<Vec<String>>> {
    const PATH: &str = "figures.across";
    let elements = array(PATH, "names of sweeps", value, faults)?;
    let is_nested = elements.first().is_some_and(|first| first.get_ref().is_array());
    let groups: Vec<&Written<'_>> = if is_nested { elements.iter().collect() } else { vec![value] };
    let mut found = Vec::new();
    for group in groups {
        let mut of_group: Vec<String> = Vec::new();
        for element in array(PATH, "names of sweeps", group, faults)? {
            let name = super::top::name(PATH, element, faults)?;
            if of_group.contains(&name) {
                let message = format!("`{PATH}` names the sweep \"{name}\" twice");
                faults.add(&element.span(), message, "name each sweep once".to_owned());
                return None;
            }
            names.push((name.clone(), element.span()));
            of_group.push(name);
        }
        if of_group.len() < 2 {
            let message = format!("`{PATH}` needs at least two sweeps");
            faults.add(&group.span(), message, "each sweep has figures of its own already".to_owned());
            return None;
        }
        found.push(of_group);
    }
    Some(found)
}

/// Adds a fault for each name in `across` that no sweep has.
pub(super) fn check_across(across: &Across, sweeps: &[&SweepDraft], faults: &mut Faults<'_>) {
    let sweeps: Vec<&str> = sweeps.iter().map(|sweep| sweep.name.as_str()).collect();
    for (name, at) in across.iter().filter(|(name, _)| !sweeps.contains(&name.as_str())) {
        let listed = format!("sweeps of the spec: {}", sweeps.join(", "));
        let help = match nearest(name, sweeps.iter().copied()) {
            _ if sweeps.is_empty() => "the spec has no sweeps: remove the key".to_owned(),
            Some(near) => format!("did you mean \"{near}\"? {listed}"),
            None => listed,
        };
        faults.add(at, format!("unknown sweep \"{name}\" in `figures.across`"), help);
    }
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
