//! `zip` of a sweep: keys whose values advance together.

use std::ops::Range;

use super::Value;
use super::entries::{lost, shown};
use super::fault::Faults;
use super::keys::{KEYS, TABLES, find, names};
use super::written::{Written, array, wrong_type};
use toml::Spanned;
use toml::de::DeValue;

/// An axis whose values are read.
pub(super) struct AxisDraft {
    /// The key's place in [`KEYS`].
    pub(super) key: usize,
    pub(super) values: Vec<Spanned<Value>>,
}

/// Fewest keys of a group.
const FEWEST: usize = 2;

/// One key of a group, by its place in [`KEYS`], and its place in the text.
type Zipped = (usize, Range<usize>);

/// Reads the groups of keys: one array of keys, or an array of such arrays. `listed` are the keys of the
/// sweep by their places in [`KEYS`].
pub(super) fn groups(value: &Written<'_>, listed: &[usize], faults: &mut Faults<'_>) -> Vec<Vec<Zipped>> {
    let Some(elements) = array("zip", "keys", value, faults) else { return Vec::new() };
    let is_nested = elements.first().is_some_and(|first| first.get_ref().is_array());
    let written: Vec<&Written<'_>> = if is_nested { elements.iter().collect() } else { vec![value] };
    let mut known: Vec<usize> = Vec::new();
    written.into_iter().map(|one| group(one, listed, &mut known, faults)).collect()
}

/// Reads one group. `known` are the keys of all groups so far.
fn group(
    value: &Written<'_>,
    listed: &[usize],
    known: &mut Vec<usize>,
    faults: &mut Faults<'_>,
) -> Vec<Zipped> {
    let Some(elements) = array("zip", "keys", value, faults) else { return Vec::new() };
    if elements.len() < FEWEST {
        faults.add(
            &value.span(),
            "`zip` needs at least two keys".to_owned(),
            "name the keys that advance together, or remove `zip`".to_owned(),
        );
    }
    let mut found = Vec::new();
    for element in elements {
        let span = element.span();
        let Some(key) = key(element, faults) else { continue };
        let path = KEYS[key].path;
        if known.contains(&key) {
            let message = format!("`zip` names `{path}` twice");
            faults.add(&span, message, "name each key once".to_owned());
        } else if !listed.contains(&key) {
            let message = format!("`zip` names `{path}`, which the sweep does not set");
            faults.add(&span, message, format!("add its values to the sweep: {path} = […]"));
        } else {
            found.push((key, span));
        }
        known.push(key);
    }
    found
}

/// Place of a key in [`KEYS`] by its path.
fn key(element: &Written<'_>, faults: &mut Faults<'_>) -> Option<usize> {
    let span = element.span();
    let DeValue::String(path) = element.get_ref() else {
        let help = "write table and key in quotes, such as \"surface.magnification\"".to_owned();
        wrong_type("zip", "an array of keys", element.get_ref(), &span, help, faults);
        return None;
    };
    let (table, name) = path.split_once('.').unwrap_or(("", path));
    let found = find(table, name);
    if found.is_none() {
        faults.add_with(&span, || {
            let help = if TABLES.contains(&table) {
                let own: Vec<_> = names(table).collect();
                lost(name, &own, |other| format!("write \"{other}.{name}\""), &format!("keys of [{table}]"))
            } else {
                let whole = |table: &str| format!("write \"{table}.{name}\"");
                lost(name, &TABLES, whole, "write table and key, such as \"surface.hurst\"; tables")
            };
            (format!("unknown key `{}` in `zip`", shown(path)), Some(help))
        });
    }
    found
}

/// Axes that advance together, each axis once: groups of places in `axes`, in the order in which their first
/// axes are written. Adds a fault where the keys of a group have different numbers of values.
pub(super) fn together(
    groups: &[Vec<Zipped>],
    axes: &[AxisDraft],
    faults: &mut Faults<'_>,
) -> Vec<Vec<usize>> {
    let place = |key: usize| axes.iter().position(|axis| axis.key == key);
    for group in groups {
        let of_group = group.iter().filter_map(|(key, at)| Some((&axes[place(*key)?], at)));
        // The first one with most values is complete.
        let count = |axis: &AxisDraft| axis.values.len();
        let longest = of_group.clone().map(|(axis, _)| axis).rev().max_by_key(|axis| count(axis));
        let Some(first) = longest else { continue };
        let wanted = count(first);
        for (axis, at) in of_group.filter(|(axis, _)| count(axis) != wanted) {
            let (path, count) = (KEYS[axis.key].path, axis.values.len());
            let message = format!(
                "`{path}` has {}, `{}` has {wanted}: keys of one `zip` need equally many",
                crate::text::counted(count, "value"),
                KEYS[first.key].path
            );
            let help = if count == 1 && KEYS[axis.key].kind.is_list() {
                format!("write an array of arrays, one for each case: {path} = [[…], […]]")
            } else if count == 1 {
                format!("remove `{path}` from `zip`: a single value holds for all cases")
            } else {
                "complete the shorter array, or remove the key from `zip`: arrays then multiply".to_owned()
            };
            faults.add(at, message, help);
        }
    }
    let mut found: Vec<Vec<usize>> = Vec::new();
    for (at, axis) in axes.iter().enumerate() {
        if found.iter().flatten().any(|known| *known == at) {
            continue;
        }
        let of_axis = groups.iter().find(|group| group.iter().any(|(key, _)| *key == axis.key));
        found.push(match of_axis {
            Some(group) => {
                let mut places: Vec<usize> = group.iter().filter_map(|(key, _)| place(*key)).collect();
                places.sort_unstable();
                places
            }
            None => vec![at],
        });
    }
    found
}
