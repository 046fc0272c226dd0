//! The `[[sweep]]`s: what each overrides, every value checked by itself.

use std::collections::HashSet;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::coarser::refuses_sweep;
use super::entries::{entries, keys, lost, shown};
use super::fault::Faults;
use super::keys::{KEYS, TABLES};
use super::zip::{self, AxisDraft};
use super::{top, value};

/// A sweep whose values are read.
pub(super) struct SweepDraft {
    pub(super) name: String,
    /// Start in the text.
    pub(super) span: Range<usize>,
    pub(super) axes: Vec<AxisDraft>,
    /// Places of axes that advance together; each axis once.
    pub(super) together: Vec<Vec<usize>>,
}

impl SweepDraft {
    /// Number of values of each group of axes.
    pub(super) fn counts(&self) -> impl Iterator<Item = usize> {
        let count = |group: &Vec<usize>| group.first().map_or(1, |axis| self.axes[*axis].values.len());
        self.together.iter().map(count)
    }
}

/// Keys of a sweep.
const IN_SWEEP: [&str; 10] = [
    "name",
    "zip",
    "surface",
    "material",
    "model",
    "boundary_elements",
    "cycle",
    "probe",
    "machine",
    "substrate",
];

/// Reads the sweeps.
pub(super) fn sweeps(
    written: &Spanned<DeValue<'_>>,
    span: &Range<usize>,
    read: &mut Vec<Option<SweepDraft>>,
    faults: &mut Faults<'_>,
) {
    let DeValue::Array(tables) = written.get_ref() else {
        let help = "write [[sweep]], in double brackets".to_owned();
        faults.add(span, "`sweep` must be an array of tables".to_owned(), help);
        return;
    };
    let mut names: HashSet<String> = HashSet::new();
    for table in tables.iter() {
        let DeValue::Table(found) = table.get_ref() else {
            let help = "write [[sweep]], in double brackets".to_owned();
            super::written::wrong_type(
                "sweep",
                "an array of tables",
                table.get_ref(),
                &table.span(),
                help,
                faults,
            );
            continue;
        };
        read.push(sweep(found, table.span(), &mut names, faults));
    }
}

/// Reads one sweep.
fn sweep(
    found: &DeTable<'_>,
    at: Range<usize>,
    known: &mut HashSet<String>,
    faults: &mut Faults<'_>,
) -> Option<SweepDraft> {
    let before = faults.count();
    let (mut name, mut zipped) = (None, None);
    let mut overrides = Vec::new();
    let entries = entries(found);
    if !entries.iter().any(|(key, ..)| *key == "name") {
        faults.add(
            &at,
            "the sweep has no `name`".to_owned(),
            "add a line such as name = \"loads\"".to_owned(),
        );
    }
    for (key, span, written) in entries {
        match key {
            "name" => {
                name = top::name("sweep.name", written, faults);
                if let Some(name) = &name
                    && !known.insert(name.clone())
                {
                    let message = format!("two sweeps have the name \"{name}\"");
                    faults.add(&written.span(), message, "give each sweep a different name".to_owned());
                }
            }
            "zip" => zipped = Some(written),
            table if TABLES.contains(&table) => {
                overrides.extend(keys(table, written, &span, faults));
            }
            unknown => faults.add_with(&span, || {
                let help = if unknown == "seed" || unknown == "realizations" {
                    format!("`{unknown}` is the same for all sweeps: move it to the top of the spec")
                } else {
                    lost(unknown, &IN_SWEEP, |table| format!("write {table}.{unknown}"), "keys of [[sweep]]")
                };
                (format!("unknown key `{}` in [[sweep]]", shown(unknown)), Some(help))
            }),
        }
    }
    // Keys of different tables may alternate; the grid follows the order written.
    overrides.sort_by_key(|(_, span, _)| span.start);
    let listed: Vec<usize> = overrides.iter().map(|(place, ..)| *place).collect();
    let groups = zipped.map_or_else(Vec::new, |written| zip::groups(written, &listed, faults));
    let axes: Vec<_> =
        overrides.into_iter().filter_map(|(place, _, written)| axis(place, written, faults)).collect();
    let together = zip::together(&groups, &axes, faults);
    let name = name.filter(|_| faults.count() == before)?;
    Some(SweepDraft { name, span: at, axes, together })
}

/// Reads one axis: an array of values, or a single one. An array is one value for a key that takes an array.
fn axis(place: usize, written: &Spanned<DeValue<'_>>, faults: &mut Faults<'_>) -> Option<AxisDraft> {
    let key = &KEYS[place];
    if refuses_sweep(key, &written.span(), faults) {
        return None;
    }
    let one = |value: &Spanned<DeValue<'_>>, faults: &mut Faults<'_>| {
        value::read(key, value, faults).map(|read| Spanned::new(value.span(), read))
    };
    let values = match written.get_ref() {
        DeValue::Array(many)
            if !key.kind.is_list() || many.first().is_some_and(|first| first.get_ref().is_array()) =>
        {
            if many.is_empty() {
                let message = format!("the sweep of `{}` has no values", key.path);
                faults.add(&written.span(), message, "give at least one value, or remove the key".to_owned());
                return None;
            }
            many.iter().map(|value| one(value, faults)).collect::<Vec<_>>()
        }
        _ => vec![one(written, faults)],
    };
    let values = values.into_iter().collect::<Option<_>>()?;
    Some(AxisDraft { key: place, values })
}
