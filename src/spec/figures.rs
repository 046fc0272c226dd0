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

/// Key of groups of sweeps.
const PATH: &str = "figures.across";

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

/// Groups of sweeps in `across`, and their places in the text.
#[derive(Clone, Default)]
pub(super) struct Across {
    /// Names of sweeps in all groups.
    names: Vec<(String, Range<usize>)>,
    /// Names of the figures of each group.
    stems: Vec<(String, Range<usize>)>,
}

impl Across {
    /// All places in the text.
    pub(super) fn places(&mut self) -> impl Iterator<Item = &mut Range<usize>> {
        self.names.iter_mut().chain(&mut self.stems).map(|(_, at)| at)
    }
}

/// The table of a spec, with the names of sweeps in it. Keys that it lacks keep their values before.
pub(super) fn figures(
    value: &Written<'_>,
    (mut read, mut names): (Figures, Across),
    faults: &mut Faults<'_>,
) -> Option<(Figures, Across)> {
    let DeValue::Table(table) = value.get_ref() else {
        let help = "write { format = [\"svg\", \"pdf\"], width_mm = 88 }".to_owned();
        wrong_type("figures", "a table", value.get_ref(), &value.span(), help, faults);
        return None;
    };
    for (name, span, written) in entries(table) {
        match name {
            "format" => read.format = formats(written, faults)?,
            "width_mm" => read.width_mm = number("figures.width_mm", &WIDTH, written, faults)?,
            "font" => read.font = font(written, faults)?,
            "loads" => read.loads = word("figures.loads", &LOADS, written, faults)?,
            "across" => (read.across, names) = across(written, faults)?,
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
fn across(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<(Vec<Vec<String>>, Across)> {
    let elements = array(PATH, "names of sweeps", value, faults)?;
    let is_nested = elements.first().is_some_and(|first| first.get_ref().is_array());
    let groups: Vec<&Written<'_>> = if is_nested { elements.iter().collect() } else { vec![value] };
    let (mut found, mut places) = (Vec::<Vec<String>>::new(), Across::default());
    for group in groups {
        let mut of_group: Vec<String> = Vec::new();
        for element in array(PATH, "names of sweeps", group, faults)? {
            let name = super::top::name(PATH, element, faults)?;
            if of_group.contains(&name) {
                let message = format!("`{PATH}` names the sweep \"{name}\" twice");
                faults.add(&element.span(), message, "name each sweep once".to_owned());
                return None;
            }
            places.names.push((name.clone(), element.span()));
            of_group.push(name);
        }
        if of_group.len() < 2 {
            let message = format!("`{PATH}` needs at least two sweeps");
            faults.add(&group.span(), message, "each sweep has figures of its own already".to_owned());
            return None;
        }
        let is_same = |other: &Vec<String>| {
            other.len() == of_group.len() && of_group.iter().all(|name| other.contains(name))
        };
        if found.iter().any(is_same) {
            let message = format!("`{PATH}` has the sweeps {} twice", of_group.join(", "));
            faults.add(&group.span(), message, "name each group once".to_owned());
            return None;
        }
        places.stems.push((of_group.join("-"), group.span()));
        found.push(of_group);
    }
    Some((found, places))
}

/// Adds a fault for each name in `across` that no sweep has, and for figures of two names in one file.
pub(super) fn check_across(across: &Across, sweeps: &[&SweepDraft], faults: &mut Faults<'_>) {
    let sweeps: Vec<&str> = sweeps.iter().map(|sweep| sweep.name.as_str()).collect();
    let groups = across.stems.iter().enumerate();
    for (place, (stem, at)) in groups {
        let is_known = |(other, _): &(String, Range<usize>)| other == stem;
        if sweeps.contains(&stem.as_str()) || across.stems[..place].iter().any(is_known) {
            let message = format!("figures of `{PATH}` have the names of others: {stem}_A");
            faults.add(at, message, "rename one of the sweeps".to_owned());
        }
    }
    for (name, at) in across.names.iter().filter(|(name, _)| !sweeps.contains(&name.as_str())) {
        let listed = format!("sweeps of the spec: {}", sweeps.join(", "));
        let help = match nearest(name, sweeps.iter().copied()) {
            _ if sweeps.is_empty() => "the spec has no sweeps: remove the key".to_owned(),
            Some(near) => format!("did you mean \"{near}\"? {listed}"),
            None => listed,
        };
        faults.add(at, format!("unknown sweep \"{name}\" in `{PATH}`"), help);
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
