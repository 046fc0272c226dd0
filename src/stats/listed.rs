//! Rows of the table `cases` as tables and reports list them: labelled by the parameters that vary, the
//! reference case first, the others in the order of the spec.

use super::varying::{Varying, varying};
use super::{StatsError, digits};
use crate::store::Frame;

/// A row of the table `cases` in a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listed {
    /// The row.
    pub row: usize,
    /// The parameters that vary in the list, with the values of this row.
    pub label: String,
    /// True if the row is of the reference case.
    pub is_reference: bool,
    /// The row of the reference case at the same load; nothing for the reference case itself, and where there
    /// is none.
    pub reference: Option<usize>,
}

/// All rows of the table `cases`, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listing {
    /// The rows.
    pub rows: Vec<Listed>,
    /// The parameters of the reference case that vary in the campaign; nothing without such a case.
    pub reference: Option<String>,
}

/// The names of all sweeps, each once, in the order of the rows: the column
/// `sweep` joins those of a case by `+`.
///
/// # Errors
/// If the table lacks the column.
pub fn sweeps(cases: &Frame) -> Result<Vec<String>, StatsError> {
    let mut names: Vec<String> = Vec::new();
    for name in cases.text("sweep")?.iter().flat_map(|joined| joined.split('+')) {
        if !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }
    Ok(names)
}

/// The rows of one sweep: the reference case first, the others in the order of the table, which is that of
/// the spec. Labels are the parameters that vary within the sweep.
///
/// # Errors
/// If the table lacks a column.
pub fn listing_of(cases: &Frame, sweep: &str) -> Result<Vec<Listed>, StatsError> {
    let joined = cases.text("sweep")?;
    let rows: Vec<usize> =
        (0..joined.len()).filter(|row| joined[*row].split('+').any(|name| name == sweep)).collect();
    let list = List::of(cases, rows)?;
    let label = |place: usize| {
        said(&list.differing, place).map(|parameter| parameter.named(place)).collect::<Vec<_>>().join(", ")
    };
    list.listed(cases, label)
}

/// All rows: the reference case first, the others in the order of the table. With a reference case, the label
/// of another case has the parameters that differ from it; otherwise the parameters that vary in the
/// campaign.
///
/// # Errors
/// If the table lacks a column.
pub fn listing(cases: &Frame) -> Result<Listing, StatsError> {
    let list = List::of(cases, (0..cases.row_count()).collect())?;
    let all = |place: usize| {
        said(&list.differing, place).map(|parameter| parameter.assigned(place)).collect::<Vec<_>>().join(", ")
    };
    let base = list.references.iter().position(|is| *is);
    let label = |place: usize| match base {
        Some(base) => {
            let own = said(&list.differing, place)
                .filter(|parameter| parameter.text(place) != parameter.text(base));
            let parts: Vec<String> = own.map(|parameter| parameter.assigned(place)).collect();
            if parts.is_empty() { "reference".to_owned() } else { parts.join(", ") }
        }
        None => all(place),
    };
    Ok(Listing { rows: list.listed(cases, label)?, reference: base.map(all) })
}

/// The reference case: the one that belongs to more sweeps than every other.
fn reference_case(cases: &Frame) -> Result<Option<String>, StatsError> {
    let (ids, joined) = (cases.text("case_id")?, cases.text("sweep")?);
    let count = |row: usize| joined[row].split('+').count();
    let most = (0..ids.len()).map(count).max().unwrap_or_default();
    let mut found: Vec<&str> = (0..ids.len()).filter(|row| count(*row) == most).map(|row| ids[row]).collect();
    found.sort_unstable();
    found.dedup();
    Ok(match found[..] {
        [id] if most > 1 => Some(id.to_owned()),
        _ => None,
    })
}

/// The parameters of a row that its method reads.
fn said(differing: &[Varying], place: usize) -> impl Iterator<Item = &Varying> {
    differing.iter().filter(move |parameter| !parameter.is_absent(place))
}

/// Rows with what varies among them.
struct List {
    rows: Vec<usize>,
    differing: Vec<Varying>,
    loads: Vec<f64>,
    /// True for each row of the reference case.
    references: Vec<bool>,
}

impl List {
    fn of(cases: &Frame, rows: Vec<usize>) -> Result<Self, StatsError> {
        let (ids, loads, reference) =
            (cases.text("case_id")?, super::loads(cases)?.values, reference_case(cases)?);
        let references = rows.iter().map(|row| reference.as_deref() == Some(ids[*row])).collect();
        Ok(Self {
            differing: varying(cases, &rows)?,
            loads: rows.iter().map(|row| loads[*row]).collect(),
            rows,
            references,
        })
    }

    fn listed(&self, cases: &Frame, label: impl Fn(usize) -> String) -> Result<Vec<Listed>, StatsError> {
        let mut places: Vec<usize> = (0..self.rows.len()).collect();
        places.sort_by_key(|place| !self.references[*place]);
        let same_load = |place: usize| {
            (0..self.rows.len()).find(|k| self.references[*k] && self.loads[*k] == self.loads[place])
        };
        let one = |place: usize| -> Result<Listed, StatsError> {
            let is_reference = self.references[place];
            let label =
                if self.differing.is_empty() { case_label(cases, self.rows[place])? } else { label(place) };
            let reference = same_load(place).filter(|_| !is_reference).map(|k| self.rows[k]);
            Ok(Listed { row: self.rows[place], label, is_reference, reference })
        };
        places.into_iter().map(one).collect()
    }
}

/// The label of a case where nothing varies: the file of a measured surface, or ζ and H.
pub(super) fn case_label(cases: &Frame, row: usize) -> Result<String, StatsError> {
    if let Some(file) = cases.text_or_null("surface_file")?.get(row).cloned().flatten() {
        return Ok(file);
    }
    let mut parts = Vec::new();
    for (symbol, column) in [("ζ", "magnification"), ("H", "hurst")] {
        let value = cases.f64_or_null(column)?.get(row).copied().flatten();
        parts.extend(value.map(|value| format!("{symbol} = {}", digits::significant(value, 4))));
    }
    Ok(parts.join(", "))
}
