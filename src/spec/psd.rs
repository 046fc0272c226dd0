//! Files of tabulated spectra: columns, units and conventions.
//!
//! A table is a text with a column of wavenumbers q = 2π/λ and one of densities. Its heading states names and
//! units: those of this program, such as `q_1_m` and `c_m4`, or in brackets, as contact.engineering exports
//! them. Everything is converted to the isotropic C(q) \[m⁴\] with `∫ C d²q = h_rms²`.

use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;

use crate::formats::Refusal;
use crate::lengths::metres;
use crate::model::{Choice as _, GeneratedSurface, SpectrumConvention, SpectrumKind, TabulatedSpectrum};
use crate::physics::surface::psd_table::{MAX_GAP, PsdTable, RowFault};

/// Largest file of a spectrum \[bytes\].
const MAX_BYTES: u64 = 64 << 20;

/// A spectrum that has been read.
#[derive(Debug)]
pub(super) struct Read {
    /// Isotropic density.
    pub(super) table: Arc<PsdTable>,
    /// Quantity, convention and conversion in words.
    pub(super) reading: String,
}

fn refused<T>(problem: String, help: &str) -> Result<T, Refusal> {
    Err(Refusal { problem, help: help.to_owned() })
}

/// Reads a spectrum.
pub(super) fn read(path: &Path, of: &TabulatedSpectrum) -> Result<Read, Refusal> {
    let unreadable = |error: std::io::Error| Refusal {
        problem: error.to_string(),
        help: "use a text with columns q and C".to_owned(),
    };
    if std::fs::metadata(path).map_err(unreadable)?.len() > MAX_BYTES {
        return refused(format!("longer than {} MiB", MAX_BYTES >> 20), "average the spectrum in bins of q");
    }
    let bytes = std::fs::read(path).map_err(unreadable)?;
    let Ok(text) = String::from_utf8(bytes) else {
        return refused(
            "not a text in UTF-8".to_owned(),
            "export the spectrum as CSV; of a workbook, save the sheet of the data series as CSV",
        );
    };
    let lines = Lines::of(&text);
    let columns = Columns::of(&lines)?;
    let rows = columns.rows(&lines, &of.series)?;
    columns.converted(&rows, of)
}

/// Relative tolerance of the ends of a table against those of the band.
const ENDS: f64 = 1e-9;

/// Refusal of a surface whose band the table of its spectrum does not cover.
pub(super) fn uncovered(surface: &GeneratedSurface) -> Option<Refusal> {
    let [first, last] = surface.tabulated.table.as_ref()?.range_1_m();
    let [low, high] = surface.spectrum().band_1_m();
    // The ellipses of an anisotropic spectrum reach further.
    let stretch = surface.aspect_ratio.sqrt();
    let (low, high) = (low / stretch, high * stretch);
    let covers = first <= low * (1.0 + ENDS) && last >= high * (1.0 - ENDS);
    (!covers).then(|| Refusal {
        problem: format!(
            "it covers wavelengths from {:.3e} to {:.3e} m, and the roughness has {:.3e} to {:.3e} m",
            2.0 * PI / last,
            2.0 * PI / first,
            2.0 * PI / high,
            2.0 * PI / low
        ),
        help: "choose length_m, longest_wavelength_m and magnification within the table: the shortest \
               wavelength is length_m/magnification; an aspect ratio r needs √r more at both ends"
            .to_owned(),
    })
}

/// Lines of a table: heading and cells, with their numbers from 1.
struct Lines<'a> {
    heading: Option<Vec<&'a str>>,
    cells: Vec<(usize, Vec<&'a str>)>,
}

impl<'a> Lines<'a> {
    fn of(text: &'a str) -> Self {
        let text = text.trim_start_matches('\u{feff}');
        let is_number = |cell: &&str| cell.parse::<f64>().is_ok();
        let (mut heading, mut cells) = (None, Vec::new());
        for (number, line) in text.lines().enumerate() {
            let comment = line.trim_start().strip_prefix(['#', '%']);
            let found = split(comment.unwrap_or(line));
            if found.iter().all(|cell| cell.is_empty()) {
                continue;
            }
            // A heading is the last line before the data that has no number.
            let is_text = !found.iter().any(is_number);
            if cells.is_empty() && is_text && found.len() > 1 {
                heading = Some(found);
            } else if comment.is_none() && !(cells.is_empty() && is_text) {
                cells.push((number + 1, found));
            }
        }
        Self { heading, cells }
    }
}

/// Cells of a line: between semicolons, tabs or commas, or else between spaces.
fn split(line: &str) -> Vec<&str> {
    let line = line.trim();
    match [';', '\t', ','].into_iter().find(|separator| line.contains(*separator)) {
        Some(separator) => line.split(separator).map(|cell| cell.trim().trim_matches('"').trim()).collect(),
        None => words(line),
    }
}

/// Cells between spaces; a unit in brackets belongs to the name before it.
fn words(line: &str) -> Vec<&str> {
    let mut cells: Vec<&str> = Vec::new();
    let mut start = 0;
    for word in line.split_whitespace() {
        let at = word.as_ptr() as usize - line.as_ptr() as usize;
        if word.starts_with(['(', '[']) && cells.pop().is_some() {
            cells.push(&line[start..at + word.len()]);
        } else {
            start = at;
            cells.push(word.trim_matches('"'));
        }
    }
    cells
}

/// Columns of a table.
#[derive(Debug, Default, PartialEq)]
struct Columns {
    wavenumber: usize,
    density: usize,
    /// Units of both: a length \[m\] and its power.
    units: [Option<(f64, i32)>; 2],
    /// Columns of subject and data series of a contact.engineering table.
    series: Option<(Option<usize>, usize)>,
    /// Quantity that the chosen data series states.
    kind: Option<SpectrumKind>,
}

impl Columns {
    fn of(lines: &Lines<'_>) -> Result<Self, Refusal> {
        let width = lines.cells.first().map_or(0, |(_, cells)| cells.len());
        let Some(heading) = &lines.heading else {
            if width < 2 {
                return refused(
                    "no two columns of numbers".to_owned(),
                    "write a line of q and C for each wavenumber, below a heading such as q_1_m,c_m4",
                );
            }
            return Ok(Self { density: 1, ..Self::default() });
        };
        let named: Vec<(String, Option<(f64, i32)>)> =
            heading.iter().map(|cell| name_and_unit(cell)).collect();
        let find = |names: &[&str]| named.iter().position(|(name, _)| names.contains(&name.as_str()));
        if let Some((name, _)) =
            named.iter().find(|(name, _)| ["frequency", "wavelength", "lambda", "λ"].contains(&name.as_str()))
        {
            return refused(
                format!("the heading has a column \"{name}\", and a spectrum is over q = 2π/λ"),
                "convert the first column to the wavenumber q = 2π/λ, and C with it",
            );
        }
        let (mut q, mut c) = (find(&WAVENUMBERS), find(&DENSITIES));
        if q.is_none() && c.is_none() && heading.len() == 2 {
            (q, c) = (Some(0), Some(1));
        }
        let (Some(wavenumber), Some(density)) = (q, c) else {
            let missing = if q.is_none() { "wavenumber q" } else { "density C" };
            return refused(
                format!("no column of the {missing} in the heading: {}", heading.join(", ")),
                "name the columns q and C, with their units, such as q_1_m,c_m4 or q (1/m),C (m^4)",
            );
        };
        let series = find(&["data series"]).map(|series| (find(&["subject name"]), series));
        Ok(Self { wavenumber, density, units: [named[wavenumber].1, named[density].1], series, kind: None })
    }

    /// Rows \[unit of the table\] with the numbers of their lines, of the wanted data series.
    fn rows(&self, lines: &Lines<'_>, wanted: &str) -> Result<Rows, Refusal> {
        let name = |cells: &[&str]| self.series.map(|(subject, series)| series_name(cells, subject, series));
        let mut names: Vec<[String; 2]> = lines.cells.iter().filter_map(|(_, cells)| name(cells)).collect();
        names.dedup();
        names.sort();
        names.dedup();
        let chosen: Vec<&[String; 2]> = names
            .iter()
            .filter(|[subject, series]| {
                wanted.is_empty() || wanted == series || wanted == format!("{subject}: {series}")
            })
            .collect();
        if self.series.is_none() && !wanted.is_empty() {
            return refused(
                format!("no column \"Data series\", and surface.spectrum_series is \"{wanted}\""),
                "remove surface.spectrum_series",
            );
        }
        if self.series.is_some() && chosen.len() != 1 {
            let listed: Vec<String> =
                names.iter().take(12).map(|[subject, series]| format!("\"{subject}: {series}\"")).collect();
            return refused(
                format!(
                    "{} data series in the table, one is needed",
                    if wanted.is_empty() { names.len() } else { chosen.len() }
                ),
                &format!("write surface.spectrum_series as one of {}", listed.join(", ")),
            );
        }
        let chosen = chosen.first().copied();
        let mut rows = Rows { values: Vec::new(), lines: Vec::new(), series: chosen.map(|of| of[1].clone()) };
        for (line, cells) in &lines.cells {
            if name(cells).as_ref() != chosen {
                continue;
            }
            rows.values.push([
                number(cells, self.wavenumber, *line, "q")?,
                number(cells, self.density, *line, "C")?,
            ]);
            rows.lines.push(*line);
        }
        Ok(rows)
    }

    /// The isotropic table of some rows.
    fn converted(&self, rows: &Rows, of: &TabulatedSpectrum) -> Result<Read, Refusal> {
        let is_contact_engineering = rows.series.is_some();
        let (scale_q, scale_c, power) = self.scales(of)?;
        let kind = kind_of(of.kind, power, rows.series.as_deref())?;
        let convention = match of.convention {
            SpectrumConvention::Auto if is_contact_engineering => SpectrumConvention::TwoPi,
            SpectrumConvention::Auto => {
                return refused(
                    "unknown normalization: it differs by a factor of 4π² between programs".to_owned(),
                    "write surface.spectrum_convention = \"plain\" (∫ C d²q = h_rms²) or \"two_pi\" (∫ C \
                     d²q/(2π)² = h_rms², contact.engineering)",
                );
            }
            convention => convention,
        };
        let Some(factor) = factor(kind, convention) else {
            return refused(
                "surface.spectrum_convention = \"one_sided\" is of C1 in m^3".to_owned(),
                "write \"plain\" or \"two_pi\"",
            );
        };
        let at_line = |fault: RowFault| {
            let at = rows.lines.get(fault.row).map_or_else(String::new, |line| format!("line {line}: "));
            Refusal { problem: format!("{at}{}", fault.problem), help: help_for(kind) }
        };
        // Faults are those of the numbers as written.
        PsdTable::of(&rows.values).map_err(at_line)?;
        let in_si = rows.values.iter().map(|[q, c]| {
            let q = scale_q * q;
            // The two-sided C1 with ∫ C1 dq = h_rms² is 2 q C if it is q C/π in the convention of 2π.
            [q, factor * scale_c * c / if kind == SpectrumKind::QOverPi { 2.0 * q } else { 1.0 }]
        });
        let in_si: Vec<[f64; 2]> = in_si.collect();
        let table =
            if kind == SpectrumKind::Profile { PsdTable::of_profile(&in_si) } else { PsdTable::of(&in_si) };
        let table = table.map_err(at_line)?;
        let converted = match kind {
            SpectrumKind::Profile => ", by Abel's inversion",
            SpectrumKind::QOverPi => ", C1 = q C/π",
            _ => "",
        };
        let reading = format!("{}, {}{converted}", kind.word(), convention.word());
        Ok(Read { table: Arc::new(table), reading })
    }

    /// Scales of both columns to SI units, and the power of the length in C.
    fn scales(&self, of: &TabulatedSpectrum) -> Result<(f64, f64, i32), Refusal> {
        let power_of_kind = match of.kind {
            SpectrumKind::Auto => None,
            SpectrumKind::Isotropic => Some(4),
            SpectrumKind::Profile | SpectrumKind::QOverPi => Some(3),
        };
        let unit = metres(&of.unit).filter(|_| !of.unit.is_empty());
        let [q, c] = match (self.units, unit) {
            ([Some(_), _] | [_, Some(_)], Some(_)) => {
                return refused(
                    "the heading has units, and surface.spectrum_unit is set".to_owned(),
                    "remove one of the two",
                );
            }
            ([Some(q), Some(c)], None) => [q, c],
            (_, Some(length)) => {
                let Some(power) = power_of_kind else {
                    return refused(
                        "the heading has no unit of C, and surface.spectrum_kind is \"auto\"".to_owned(),
                        "write surface.spectrum_kind = \"isotropic\", \"profile\" or \"q_over_pi\"",
                    );
                };
                [(length, -1), (length, power)]
            }
            _ => {
                return refused(
                    "units missing: the heading does not state those of q and C".to_owned(),
                    "write a heading such as q_1_m,c_m4 or q (1/um),C (um^4), or surface.spectrum_unit and \
                     surface.spectrum_kind",
                );
            }
        };
        if q.1 != -1 {
            return refused("the unit of q is not an inverse length".to_owned(), "use 1/m, 1/um or 1/nm");
        }
        if !(3..=4).contains(&c.1) || power_of_kind.is_some_and(|power| power != c.1) {
            let problem = match of.kind {
                SpectrumKind::Auto => format!("the unit of C is a length to the power {}", c.1),
                kind => format!(
                    "surface.spectrum_kind is \"{}\", and the unit of C is a length to the power {}",
                    kind.word(),
                    c.1
                ),
            };
            return refused(problem, "an isotropic C is in m^4, that of profiles and q C/π in m^3");
        }
        Ok((1.0 / q.0, c.0.powi(c.1), c.1))
    }
}

/// Rows of a data series with the numbers of their lines.
struct Rows {
    values: Vec<[f64; 2]>,
    lines: Vec<usize>,
    series: Option<String>,
}

const WAVENUMBERS: [&str; 6] = ["q", "k", "wavevector", "wavenumber", "wave vector", "wave number"];
const DENSITIES: [&str; 9] =
    ["c", "c(q)", "c1", "c1d", "c2d", "ciso", "psd", "density", "power spectral density"];

fn series_name(cells: &[&str], subject: Option<usize>, series: usize) -> [String; 2] {
    let cell = |at: Option<usize>| at.and_then(|at| cells.get(at)).map_or("", |cell| *cell).to_owned();
    [cell(subject), cell(Some(series))]
}

fn number(cells: &[&str], column: usize, line: usize, name: &str) -> Result<f64, Refusal> {
    let cell = cells.get(column).copied().unwrap_or_default();
    cell.parse().or_else(|_| {
        let shown: String = cell.chars().filter(|c| !c.is_control()).take(20).collect();
        let problem = if cell.is_empty() {
            format!("line {line}: no value of {name}")
        } else {
            format!("line {line}: {name} is \"{shown}\", which is not a number")
        };
        refused(problem, "use decimal points and no thousands separators; remove rows without data")
    })
}

/// Quantity of a table by its key, the unit of C and the data series.
fn kind_of(given: SpectrumKind, power: i32, series: Option<&str>) -> Result<SpectrumKind, Refusal> {
    let of_series = match series {
        Some(name) if name.starts_with("q/π") => Some(SpectrumKind::QOverPi),
        Some(name) if name.starts_with("1D PSD") => Some(SpectrumKind::Profile),
        Some(name) if given == SpectrumKind::Auto => {
            return refused(
                format!("unknown data series \"{name}\""),
                "write surface.spectrum_kind = \"profile\", \"q_over_pi\" or \"isotropic\"",
            );
        }
        _ => None,
    };
    let of_unit = if power == 4 { SpectrumKind::Isotropic } else { SpectrumKind::Profile };
    Ok(if given == SpectrumKind::Auto { of_series.unwrap_or(of_unit) } else { given })
}

/// Factor from C of the table to C with `∫ C d²q = h_rms²`, or to a two-sided C1 with `∫ C1 dq = h_rms²`.
fn factor(kind: SpectrumKind, convention: SpectrumConvention) -> Option<f64> {
    let is_profile = kind != SpectrumKind::Isotropic;
    Some(match convention {
        SpectrumConvention::TwoPi if is_profile => 1.0 / (2.0 * PI),
        SpectrumConvention::TwoPi => 1.0 / (4.0 * PI * PI),
        // Half of the mean square height is at negative q.
        SpectrumConvention::OneSided if is_profile => 1.0 / (4.0 * PI),
        SpectrumConvention::OneSided => return None,
        SpectrumConvention::Plain | SpectrumConvention::Auto => 1.0,
    })
}

fn help_for(kind: SpectrumKind) -> String {
    let rows = format!("rows must have ascending q, positive C, and neighbours within a factor of {MAX_GAP}");
    if kind == SpectrumKind::Profile {
        return format!(
            "{rows}; a profile must decrease with q on average: smooth it, or use the approximation \
             surface.spectrum_kind = \"q_over_pi\""
        );
    }
    rows
}

/// Name of a column in lower case, and its unit: a length \[m\] and its power.
fn name_and_unit(cell: &str) -> (String, Option<(f64, i32)>) {
    let cell = cell.trim();
    let lower = |name: &str| name.trim().to_lowercase();
    for (end, power) in [("_1_m", -1), ("_m4", 4), ("_m3", 3)] {
        if let Some(name) = cell.strip_suffix(end) {
            return (lower(name), Some((1.0, power)));
        }
    }
    let inside = cell.strip_suffix([')', ']']).and_then(|rest| rest.rfind(['(', '[']).map(|at| (at, rest)));
    if let Some((at, rest)) = inside
        && let Some(unit) = power_of_length(&rest[at + 1..])
    {
        return (lower(&rest[..at]), Some(unit));
    }
    (lower(cell), None)
}

/// A unit such as "1/µm", "m⁻¹", "nm^4" or "m³": a length \[m\] and its power.
fn power_of_length(unit: &str) -> Option<(f64, i32)> {
    let plain: String = unit
        .chars()
        .filter(|c| !matches!(c, '^' | '*' | ' '))
        .map(|c| match c {
            '⁻' | '−' => '-',
            '¹' => '1',
            '²' => '2',
            '³' => '3',
            '⁴' => '4',
            other => other,
        })
        .collect();
    let (inverse, rest) = match plain.strip_prefix("1/").or_else(|| plain.strip_prefix("rad/")) {
        Some(rest) => (-1, rest),
        None => (1, plain.as_str()),
    };
    let end = rest.find(|c: char| c == '-' || c.is_ascii_digit()).unwrap_or(rest.len());
    let (length, power) = rest.split_at(end);
    let power: i32 = if power.is_empty() { 1 } else { power.parse().ok()? };
    Some((metres(length)?, inverse * power))
}
