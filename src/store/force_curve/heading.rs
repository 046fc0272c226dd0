//! Headings of measured loops: names and units of columns, as instruments write them.
//!
//! Known forms are `Force (nN)`, `F [mN]`, `force_nN`, `Load uN` and `Kraft/mN` in one line; names in one
//! line and units in the next; and the lines `# columns:` and `# units:` of JPK. Names may be in quotes.

use super::units::is_unit;
use crate::store::scan::text_cells::Separator;

/// A column of numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Column {
    /// Its text in the heading.
    pub(super) text: String,
    /// Letters and digits of its name in lower case.
    pub(super) name: String,
    /// Its unit, as the heading has it.
    pub(super) unit: Option<String>,
}

/// Quantity of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Force,
    /// Displacement or penetration, with a rank: lower ones are preferred.
    Displacement(u8),
    Radius,
    Area,
    Time,
}

const FORCES: [&str; 15] = [
    "force",
    "f",
    "load",
    "normalforce",
    "normalload",
    "fn",
    "fz",
    "p",
    "verticaldeflection",
    "vdeflection",
    "deflection",
    "defl",
    "kraft",
    "last",
    "normalkraft",
];
const PENETRATIONS: [&str; 9] = [
    "penetration",
    "indentation",
    "depth",
    "approach",
    "penetrationdepth",
    "indentationdepth",
    "delta",
    "d",
    "tipsampleseparation",
];
const DISPLACEMENTS: [&str; 16] = [
    "displacement",
    "disp",
    "extension",
    "position",
    "piezo",
    "zpiezo",
    "height",
    "measuredheight",
    "heightmeasured",
    "heightmeasuredsmoothed",
    "smoothedcapacitivesensorheight",
    "z",
    "zposition",
    "distance",
    "weg",
    "stroke",
];
const RADII: [&str; 5] = ["contactradius", "radius", "a", "radiusofcontact", "kontaktradius"];
const AREAS: [&str; 3] = ["contactarea", "area", "areaofcontact"];
const TIMES: [&str; 6] = ["time", "t", "segmenttime", "seriestime", "elapsedtime", "zeit"];

impl Column {
    fn of(text: &str) -> Self {
        let text = text.trim();
        let bracketed = || {
            let (name, unit) = text.strip_suffix([']', ')'])?.rsplit_once(['[', '('])?;
            is_unit(unit).then_some((name, unit))
        };
        let behind = || {
            let (name, unit) = text.rsplit_once(['/', '_', ' '])?;
            is_unit(unit).then_some((name, unit))
        };
        let (name, unit) =
            bracketed().or_else(behind).map_or((text, None), |(name, unit)| (name, Some(unit)));
        Self { text: text.to_owned(), name: plain(name), unit: unit.map(|unit| unit.trim().to_owned()) }
    }

    /// Quantity of the column, if its name states it.
    pub(super) fn role(&self) -> Option<Role> {
        let name = self.name.as_str();
        if FORCES.contains(&name) {
            Some(Role::Force)
        } else if PENETRATIONS.contains(&name) {
            Some(Role::Displacement(0))
        } else if let Some(rank) = DISPLACEMENTS.iter().position(|known| *known == name) {
            Some(Role::Displacement(1 + rank as u8))
        } else if RADII.contains(&name) {
            Some(Role::Radius)
        } else if AREAS.contains(&name) {
            Some(Role::Area)
        } else if TIMES.contains(&name) {
            Some(Role::Time)
        } else {
            None
        }
    }

    /// True if a name given by a user is that of the column.
    pub(super) fn is_called(&self, name: &str) -> bool {
        self.text == name.trim() || self.name == plain(name) || plain(&self.text) == plain(name)
    }
}

/// Letters and digits in lower case.
pub(super) fn plain(name: &str) -> String {
    name.chars().filter(|sign| sign.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Names and units of columns from the lines before the numbers.
#[derive(Debug, Default)]
pub(super) struct Heading {
    /// Columns of the last line with several names.
    pub(super) columns: Vec<Column>,
}

impl Heading {
    /// Reads a line before the first numbers, without its comment sign.
    pub(super) fn line(&mut self, line: &str) {
        let line = line.trim();
        let labelled = |label: &str| {
            let start = line.get(..label.len())?;
            start.eq_ignore_ascii_case(label).then(|| &line[label.len()..])
        };
        if let Some(names) = labelled("columns:") {
            self.columns = names.split_whitespace().map(Column::of).collect();
            return;
        }
        if let Some(units) = labelled("units:") {
            self.units(&units.split_whitespace().collect::<Vec<_>>());
            return;
        }
        let separator = Separator::of_words(line);
        let cells = separator.cells(line);
        let bare = |cell: &&str| cell.trim_matches(['(', ')', '[', ']']).to_owned();
        let stripped: Vec<String> = cells.iter().map(bare).collect();
        if cells.len() == self.columns.len()
            && stripped.iter().all(|unit| unit.is_empty() || is_unit(unit))
            && self.columns.iter().any(|column| column.role().is_some())
        {
            self.units(&stripped.iter().map(String::as_str).collect::<Vec<_>>());
            return;
        }
        let columns = joined(separator, &cells);
        if columns.len() > 1 && columns.iter().any(|column| column.role().is_some()) {
            self.columns = columns;
        }
    }

    fn units(&mut self, units: &[&str]) {
        if units.len() == self.columns.len() {
            for (column, unit) in self.columns.iter_mut().zip(units) {
                column.unit = Some((*unit).to_owned()).filter(|unit| !unit.is_empty());
            }
        }
    }
}

/// Columns of a line; between blanks a unit in brackets belongs to the name before it.
fn joined(separator: Separator, cells: &[&str]) -> Vec<Column> {
    let mut texts: Vec<String> = Vec::new();
    for cell in cells {
        match texts.last_mut() {
            Some(last) if separator == Separator::Blank && cell.starts_with(['[', '(']) => {
                *last = format!("{last} {cell}");
            }
            _ => texts.push((*cell).to_owned()),
        }
    }
    texts.iter().map(|text| Column::of(text)).collect()
}
