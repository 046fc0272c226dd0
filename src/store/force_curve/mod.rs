//! Measured loops of force and displacement as text: CSV and the exports of instruments.
//!
//! Lines before the first line of numbers are the heading, with or without a comment sign. Separators are
//! semicolons, tabs, commas or blanks; numbers have a decimal point or a decimal comma. Units that the file
//! does not state are not guessed.

mod heading;
mod units;

use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::Path;

use super::scan::text_cells::{Decimals, Separator, is_value};
use crate::lengths::{LENGTHS, metres};
use crate::model::LoopOptions;
use heading::{Column, Heading, Role};
use units::{AREAS, FORCES, newtons, seconds, square_metres};

/// Starts of a comment.
const COMMENTS: [&str; 3] = ["#", "%", "//"];
/// Most points of a loop.
pub const MOST_POINTS: usize = 2_000_000;
/// Longest line \[bytes\].
const LONGEST: u64 = 1 << 16;

/// Columns of a loop in SI units, with the signs of the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ForceCurve {
    /// Force \[N\].
    pub force_n: Vec<f64>,
    /// Displacement \[m\].
    pub displacement_m: Vec<f64>,
    /// Contact radius \[m\]; 0 without contact.
    pub contact_radius_m: Option<Vec<f64>>,
    /// Time \[s\].
    pub time_s: Option<Vec<f64>>,
    /// Lines of the file of the points, from 1.
    pub lines: Vec<u64>,
    /// Columns and units that were read, as in "force: Load (uN)".
    pub columns: Vec<String>,
}

/// Reads a loop.
///
/// # Errors
/// Problem and help: a file that cannot be read, columns that are missing or ambiguous, units that are
/// missing or unknown, and a line that does not have its numbers, with its number.
pub fn read_force_curve(path: &Path, options: &LoopOptions) -> Result<ForceCurve, String> {
    let table = Table::read(path)?;
    Chosen::of(&table, options)?.curve(&table, options)
}

/// True if the heading of a text names a force and a displacement.
#[must_use]
pub fn is_force_curve(path: &Path) -> bool {
    let named = |table: Table| {
        let has = |wanted: fn(Role) -> bool| table.columns.iter().filter_map(Column::role).any(wanted);
        has(|role| role == Role::Force) && has(|role| matches!(role, Role::Displacement(_)))
    };
    Table::begin(path, 1).is_ok_and(named)
}

/// Lines of numbers with their heading.
#[derive(Debug, Default)]
struct Table {
    columns: Vec<Column>,
    rows: Vec<(u64, Vec<f64>)>,
}

impl Table {
    fn read(path: &Path) -> Result<Self, String> {
        let table = Self::begin(path, MOST_POINTS + 1)?;
        if table.rows.len() > MOST_POINTS {
            return Err(format!("more than {MOST_POINTS} points\nhelp: average neighbouring points"));
        }
        if table.rows.is_empty() {
            let help = "give one line for each point, with a force and a displacement";
            return Err(format!("no line of numbers\nhelp: {help}"));
        }
        Ok(table)
    }

    /// Heading and at most `most` rows.
    fn begin(path: &Path, most: usize) -> Result<Self, String> {
        let unreadable = |error: std::io::Error| {
            format!("{error}\nhelp: give a text with columns of force and displacement")
        };
        if path.is_dir() {
            return Err(
                "it is a directory\nhelp: give a text with columns of force and displacement".to_owned()
            );
        }
        let mut file = BufReader::new(File::open(path).map_err(unreadable)?);
        let (mut heading, mut rows, mut number) = (Heading::default(), Vec::new(), 0_u64);
        let (mut separator, mut decimals, mut bytes) = (None, Decimals::default(), Vec::new());
        while rows.len() < most {
            bytes.clear();
            if file.by_ref().take(LONGEST).read_until(b'\n', &mut bytes).map_err(unreadable)? == 0 {
                break;
            }
            number += 1;
            let text = String::from_utf8(bytes.clone())
                // Latin-1, in which the micro sign is one byte.
                .unwrap_or_else(|_| bytes.iter().map(|byte| char::from(*byte)).collect());
            let line = text.trim_start_matches('\u{feff}').trim_end_matches(['\n', '\r']);
            if line.trim().is_empty() {
                continue;
            }
            if let Some(comment) = COMMENTS.iter().find_map(|sign| line.trim().strip_prefix(sign)) {
                if rows.is_empty() {
                    heading.line(comment);
                }
                continue;
            }
            let by = separator.unwrap_or_else(|| Separator::of(line));
            let cells = by.cells(line);
            let numbers = cells.iter().filter(|cell| is_value(cell) && !cell.is_empty()).count();
            if rows.is_empty() && (numbers == 0 || cells.iter().any(|cell| !is_value(cell))) {
                heading.line(line);
                continue;
            }
            let columns = heading.columns.len();
            let count = cells.len() - usize::from(cells.len() == columns + 1 && cells.last() == Some(&""));
            if rows.is_empty() && columns > 0 && count != columns {
                // A number in the preamble, such as a spring constant, is no point.
                continue;
            }
            separator = Some(by);
            let row =
                row(&cells[..count], &mut decimals).map_err(|cause| format!("line {number}: {cause}"))?;
            let first = rows.first().map(|(_, first): &(u64, Vec<f64>)| first.len());
            if let Some(first) = first.filter(|first| *first != row.len()) {
                return Err(format!(
                    "line {number}: {} numbers, but the previous lines have {first}\nhelp: give each point \
                     all columns; leave a missing contact radius empty",
                    row.len()
                ));
            }
            rows.push((number, row));
        }
        Ok(Self { columns: heading.columns, rows })
    }

    /// All values of a column; one that is missing is an error with its line.
    fn values(&self, place: usize, factor: f64) -> Result<Vec<f64>, String> {
        let value = |(line, row): &(u64, Vec<f64>)| {
            let value = row[place] * factor;
            if value.is_finite() {
                return Ok(value);
            }
            let text = &self.columns[place].text;
            Err(format!(
                "line {line}: no number in the column {text:?}\nhelp: remove the line, or give the number"
            ))
        };
        self.rows.iter().map(value).collect()
    }
}

fn row(cells: &[&str], decimals: &mut Decimals) -> Result<Vec<f64>, String> {
    let number = |cell: &&str| {
        decimals.number(cell).map_err(|_| {
            let shown: String = cell.chars().take(24).collect();
            format!(
                "{shown:?} is not a number\nhelp: give one loop with one heading; write numbers with a \
                point or a comma, not both"
            )
        })
    };
    cells.iter().map(number).collect()
}

/// The columns; two of one name are refused.
fn distinct(columns: &[Column]) -> Result<&[Column], String> {
    let is_twin = |column: &&Column| columns.iter().filter(|other| other.text == column.text).count() > 1;
    match columns.iter().find(is_twin) {
        None => Ok(columns),
        Some(twin) => Err(format!(
            "two columns are named {:?}\nhelp: give them different names in the heading",
            twin.text
        )),
    }
}

/// Columns that are read.
struct Chosen {
    force: usize,
    displacement: usize,
    radius: Option<usize>,
    time: Option<usize>,
}

impl Chosen {
    fn of(table: &Table, options: &LoopOptions) -> Result<Self, String> {
        let columns = distinct(&table.columns)?;
        let listed =
            || columns.iter().map(|column| format!("{:?}", column.text)).collect::<Vec<_>>().join(", ");
        if columns.is_empty() {
            return Err(
                "no heading with the names of the columns\nhelp: begin the file with a line such as \
                 force_nN,displacement_um,contact_radius_um"
                    .to_owned(),
            );
        }
        let width = table.rows.first().map_or(0, |(_, row)| row.len());
        if width != columns.len() {
            return Err(format!(
                "the heading names {} columns ({}), but the lines have {width} numbers\nhelp: give each \
                 column a name",
                columns.len(),
                listed()
            ));
        }
        let called = |name: &str, option: &str| {
            columns
                .iter()
                .position(|column| column.is_called(name))
                .ok_or_else(|| format!("no column {name:?} ({option})\nhelp: the columns are {}", listed()))
        };
        let first = |wanted: &dyn Fn(Role) -> bool| {
            columns.iter().position(|column| column.role().is_some_and(wanted))
        };
        let missing = |what: &str, option: &str| {
            format!(
                "no column of the {what} is recognised\nhelp: name it with {option}; the columns are {}",
                listed()
            )
        };
        let force = match options.force.as_str() {
            "" => first(&|role| role == Role::Force)
                .ok_or_else(|| missing("force", "--force-column (force)"))?,
            name => called(name, "--force-column (force)")?,
        };
        let ranked = || {
            let ranks = columns.iter().enumerate().filter_map(|(place, column)| match column.role()? {
                Role::Displacement(rank) => Some((rank, place)),
                _ => None,
            });
            // A stiffness is that of the machine, whose displacement is meant.
            let is_machine = options.machine_stiffness_n_m.is_some();
            let key = |(rank, _): &(u8, usize)| (is_machine && *rank == 0, *rank);
            ranks.min_by_key(key).map(|(_, place)| place)
        };
        let displacement = match options.displacement.as_str() {
            "" => ranked().ok_or_else(|| missing("displacement", "--displacement-column (displacement)"))?,
            name => called(name, "--displacement-column (displacement)")?,
        };
        let radius = match options.radius.as_str() {
            "" => first(&|role| role == Role::Radius || role == Role::Area),
            name => Some(called(name, "--radius-column (radius)")?),
        };
        Ok(Self { force, displacement, radius, time: first(&|role| role == Role::Time) })
    }

    fn curve(&self, table: &Table, options: &LoopOptions) -> Result<ForceCurve, String> {
        let columns = &table.columns;
        let said =
            |what: &str, place: usize, unit: &str| format!("{what}: {:?} in {unit}", columns[place].text);
        let (force_unit, force) = self.force(columns, options)?;
        let option = "--displacement-unit (displacement_unit)";
        let column = &columns[self.displacement];
        let way_unit = unit(column, &options.displacement_unit, option, LENGTHS)?;
        let way = metres(&way_unit).ok_or_else(|| unknown(column, &way_unit, option, LENGTHS))?;
        let mut read =
            vec![said("force", self.force, &force_unit), said("displacement", self.displacement, &way_unit)];
        let radius = self.radius.map(|place| {
            let (known, option) = (format!("{LENGTHS}; {AREAS}"), "--radius-unit (radius_unit)");
            let unit = unit(&columns[place], &options.radius_unit, option, &known)?;
            let area = square_metres(&unit);
            let factor = area.or_else(|| metres(&unit));
            let factor = factor.ok_or_else(|| unknown(&columns[place], &unit, option, &known))?;
            read.push(said(if area.is_some() { "contact area" } else { "contact radius" }, place, &unit));
            table.radii(place, factor, area.is_some())
        });
        let time = self.time.and_then(|place| Some((place, seconds(columns[place].unit.as_deref()?)?)));
        Ok(ForceCurve {
            force_n: table.values(self.force, force)?,
            displacement_m: table.values(self.displacement, way)?,
            contact_radius_m: radius.transpose()?,
            time_s: time.map(|(place, factor)| table.values(place, factor)).transpose()?,
            lines: table.rows.iter().map(|(line, _)| *line).collect(),
            columns: read,
        })
    }

    /// Unit of the force and its size \[N\]. A deflection of a spring of known stiffness is a force.
    fn force(&self, columns: &[Column], options: &LoopOptions) -> Result<(String, f64), String> {
        let (column, option) = (&columns[self.force], "--force-unit (force_unit)");
        let unit = unit(column, &options.force_unit, option, FORCES)?;
        let spring = options.machine_stiffness_n_m.zip(metres(&unit)).map(|(k, length)| k * length);
        match newtons(&unit).or(spring) {
            Some(size) => Ok((unit, size)),
            None if metres(&unit).is_some() => Err(format!(
                "the column {:?} is a deflection in {unit}, not a force\nhelp: give the stiffness of the \
                 cantilever with --machine-stiffness (machine_stiffness_n_m), in N/m",
                column.text
            )),
            None => Err(unknown(column, &unit, option, FORCES)),
        }
    }
}

/// Unit of a column, by its heading or by an option.
fn unit(column: &Column, given: &str, option: &str, known: &str) -> Result<String, String> {
    match &column.unit {
        Some(own) if !given.is_empty() && own != given => Err(format!(
            "the column {:?} has the unit {own:?}, but {given:?} was given\nhelp: remove {option}",
            column.text
        )),
        Some(own) => Ok(own.clone()),
        None if given.is_empty() => Err(format!(
            "the column {:?} has no unit\nhelp: give it with {option}, or in the heading; units are \
             {known}",
            column.text
        )),
        None => Ok(given.to_owned()),
    }
}

fn unknown(column: &Column, unit: &str, option: &str, known: &str) -> String {
    format!(
        "the column {:?} is in {unit:?}, which is not read\nhelp: give a unit with {option}: {known}",
        column.text
    )
}

impl Table {
    /// Contact radii; missing ones are without contact.
    fn radii(&self, place: usize, factor: f64, is_area: bool) -> Result<Vec<f64>, String> {
        let radius = |(line, row): &(u64, Vec<f64>)| {
            let value = row[place] * factor;
            match (value.is_nan(), value < 0.0) {
                (true, _) => Ok(0.0),
                (_, true) => Err(format!(
                    "line {line}: the contact radius or area is negative\nhelp: leave it empty without \
                     contact"
                )),
                _ if is_area => Ok((value / std::f64::consts::PI).sqrt()),
                _ => Ok(value),
            }
        };
        self.rows.iter().map(radius).collect()
    }
}
