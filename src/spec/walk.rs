//! From the text to a draft: every key looked up, every value checked by itself.

use std::collections::{BTreeMap, HashSet};
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fault::Faults;
use super::files::files;
use super::keys::{KEYS, TABLES, find, names};
use super::nearest::nearest;
use super::realizations::{DEFAULT, Realizations, realizations};
use super::sweep::{SweepDraft, sweeps};
use super::{CaseParams, top, value};

/// A spec whose values are read and not yet combined.
pub(super) struct Draft {
    pub(super) name: Option<String>,
    pub(super) seed: u64,
    pub(super) realizations: Realizations,
    pub(super) base: CaseParams,
    /// Where the base's value of each key comes from, in the order of [`KEYS`].
    pub(super) origins: Vec<Origin>,
    /// The sweeps; nothing for one that has a fault, of which the cases are unknown.
    pub(super) sweeps: Vec<Option<SweepDraft>>,
    /// Where the number of realizations is written.
    pub(super) realizations_at: Option<Range<usize>>,
    /// BLAKE3 of the files that are named, and where it is written.
    pub(super) files: BTreeMap<String, (String, Range<usize>)>,
}

/// Where a value of the base comes from.
#[derive(Clone)]
pub(super) enum Origin {
    /// The spec does not say it.
    Default,
    /// It is written here.
    Written(Range<usize>),
    /// What is written has a fault of its own, so that nothing follows from it.
    Faulty,
}

/// A key, where it stands, and its value.
pub(super) type Entry<'a, 't> = (&'a str, Range<usize>, &'a Spanned<DeValue<'t>>);

/// What the top of a spec takes.
const TOP: [&str; 10] = ["name", "seed", "realizations", "surface", "material", "model", "boundary_elements", "cycle", "sweep", "files"];

/// The entries of a table in the order written.
pub(super) fn entries<'a, 't>(table: &'a DeTable<'t>) -> Vec<Entry<'a, 't>> {
    let mut entries: Vec<Entry<'a, 't>> = table.iter().map(|(key, value)| (key.get_ref().as_ref(), key.span(), value)).collect();
    entries.sort_by_key(|(_, span, _)| span.start);
    entries
}

/// Reads a whole spec. Nothing, with the faults added, if it is no TOML.
pub(super) fn document(text: &str, faults: &mut Faults<'_>) -> Option<Draft> {
    let (root, broken) = DeTable::parse_recoverable(text);
    if !broken.is_empty() {
        let mut lines = HashSet::new();
        for error in broken {
            let span = error.span().unwrap_or(text.len()..text.len());
            let line = faults.line(&span);
            // A parser that recovers stumbles over the rest of the same line.
            if lines.insert(line) {
                faults.add_with(&span, || (format!("the spec is not valid TOML: {}", error.message()), None));
            }
        }
        return None;
    }
    let mut draft = Draft {
        name: None,
        seed: top::DEFAULT_SEED,
        realizations: Realizations::Exactly(DEFAULT),
        realizations_at: None,
        base: CaseParams::default(),
        origins: vec![Origin::Default; KEYS.len()],
        sweeps: Vec::new(),
        files: BTreeMap::new(),
    };
    let entries = entries(root.get_ref());
    if !entries.iter().any(|(key, ..)| *key == "name") {
        let what = if entries.is_empty() { "the spec is empty: it needs a `name`" } else { "the spec has no `name`" };
        faults.add(&(0..0), what.to_owned(), "add a first line such as name = \"first\"".to_owned());
    }
    for entry in entries {
        enter(entry, &mut draft, faults);
    }
    Some(draft)
}

/// Reads an entry of the top into a draft.
pub(super) fn enter((key, span, written): Entry<'_, '_>, draft: &mut Draft, faults: &mut Faults<'_>) {
    match key {
        "name" => draft.name = top::name("name", written, faults),
        "seed" => draft.seed = top::seed(written, faults).unwrap_or(draft.seed),
        "realizations" => {
            draft.realizations_at = Some(written.span());
            draft.realizations = realizations(written, faults).unwrap_or(draft.realizations);
        }
        "files" => draft.files = files(written, &span, faults),
        "sweep" => sweeps(written, &span, &mut draft.sweeps, faults),
        table if TABLES.contains(&table) => base(table, written, &span, draft, faults),
        unknown => faults.add_with(&span, || {
            let help = lost(unknown, &TOP, |table| format!("`{unknown}` belongs in [{table}]"), "keys of a spec");
            (format!("unknown key `{}` at the top of the spec", shown(unknown)), Some(help))
        }),
    }
}

/// Reads a table of the base.
fn base(table: &str, written: &Spanned<DeValue<'_>>, span: &Range<usize>, draft: &mut Draft, faults: &mut Faults<'_>) {
    for (place, _, written) in keys(table, written, span, faults) {
        let key = &KEYS[place];
        let read = if !key.kind.is_list() && written.get_ref().is_array() {
            let message = format!("`{}` must be a single value here, not an array", key.path);
            faults.add(&written.span(), message, "move the array to a [[sweep]]".to_owned());
            None
        } else {
            value::read(key, written, faults)
        };
        draft.origins[place] = match read {
            Some(value) => {
                (key.set)(&mut draft.base, &value);
                Origin::Written(written.span())
            }
            None => Origin::Faulty,
        };
    }
}

/// The known keys of a table, each with its place in [`KEYS`], where it stands, and its value.
pub(super) fn keys<'a, 't>(
    table: &str,
    written: &'a Spanned<DeValue<'t>>,
    span: &Range<usize>,
    faults: &mut Faults<'_>,
) -> Vec<(usize, Range<usize>, &'a Spanned<DeValue<'t>>)> {
    let DeValue::Table(found) = written.get_ref() else {
        let help = format!("write [{table}] on a line of its own, and the keys below it");
        let of_value = written.span();
        let at = if of_value.is_empty() { span } else { &of_value };
        value::wrong_type(table, "a table", written.get_ref(), at, help, faults);
        return Vec::new();
    };
    let mut known = Vec::new();
    for (name, span, written) in entries(found) {
        if let Some(place) = find(table, name) {
            known.push((place, span, written));
        } else {
            faults.add_with(&span, || {
                let own: Vec<_> = names(table).collect();
                let help = lost(name, &own, |other| format!("`{name}` belongs in [{other}]"), &format!("keys of [{table}]"));
                (format!("unknown key `{}` in [{table}]", shown(name)), Some(help))
            });
        }
    }
    known
}

/// Where an unknown key belongs, what it was meant to be, and what there is.
pub(super) fn lost(unknown: &str, here: &[&str], elsewhere: impl Fn(&str) -> String, takes: &str) -> String {
    let listed = format!("{takes}: {}", here.join(", "));
    if let Some(table) = TABLES.iter().find(|table| find(table, unknown).is_some()) {
        return elsewhere(table);
    }
    if let Some((table, name, meaning)) = of_symbol(unknown) {
        let section = if here.contains(&name) { String::new() } else { format!(" in [{table}]") };
        return format!("{meaning} is `{name}`{section}");
    }
    match nearest(unknown, here.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? {listed}"),
        None => listed,
    }
}

/// Table and key of a symbol or another name of a quantity, with the quantity.
fn of_symbol(unknown: &str) -> Option<(&'static str, &'static str, &'static str)> {
    let plain: String = unknown.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
    Some(match plain.as_str() {
        "zeta" | "ζ" => ("surface", "magnification", "ζ"),
        "hrms" | "rmsheight" | "rms" | "sq" | "rmsroughness" => ("surface", "rms_height_m", "h_rms"),
        "h" | "hurstexponent" => ("surface", "hurst", "H"),
        "l" | "size" | "lateralsize" => ("surface", "length_m", "L, the side of the square,"),
        "e" | "estar" | "youngsmodulus" | "youngmodulus" | "modulus" | "reducedmodulus" | "elasticmodulus" => {
            ("material", "contact_modulus_pa", "E* = E/(1 − ν²)")
        }
        "deltagamma" | "dgamma" | "gamma" | "δγ" | "γ" | "adhesion" | "surfaceenergy" => ("material", "work_of_adhesion_j_m2", "Δγ"),
        "epsilon" | "eps" | "ε" | "range" => ("material", "interaction_range_m", "ε"),
        "fmax" | "load" | "maxforce" | "force" => ("cycle", "max_load", "F_max/(E* A0)"),
        "step" | "outputstep" => ("cycle", "approach_step", "the output step Δ/h_rms"),
        _ => return None,
    })
}

/// A key as it can stand in a sentence: a quoted key may hold anything.
pub(super) fn shown(key: &str) -> String {
    let plain: String = key.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).take(41).collect();
    if plain.chars().count() > 40 { plain.chars().take(39).chain(['…']).collect() } else { plain }
}
