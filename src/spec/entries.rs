//! Entries of the tables of a spec, and help for unknown keys.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fault::Faults;
use super::keys::{TABLES, find, names};
use super::nearest::nearest;
use super::written::wrong_type;

/// A key, its place in the text, and its value.
pub(super) type Entry<'a, 't> = (&'a str, Range<usize>, &'a Spanned<DeValue<'t>>);

/// The entries of a table in the order written.
pub(super) fn entries<'a, 't>(table: &'a DeTable<'t>) -> Vec<Entry<'a, 't>> {
    let mut entries: Vec<Entry<'a, 't>> =
        table.iter().map(|(key, value)| (key.get_ref().as_ref(), key.span(), value)).collect();
    entries.sort_by_key(|(_, span, _)| span.start);
    entries
}

/// The known keys of a table, each with its place among all keys, its place in the text, and its value.
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
        wrong_type(table, "a table", written.get_ref(), at, help, faults);
        return Vec::new();
    };
    let mut known = Vec::new();
    for (name, span, written) in entries(found) {
        if let Some(place) = find(table, name) {
            known.push((place, span, written));
        } else {
            faults.add_with(&span, || {
                let own: Vec<_> = names(table).collect();
                let help = lost(
                    name,
                    &own,
                    |other| format!("`{name}` belongs in [{other}]"),
                    &format!("keys of [{table}]"),
                );
                (format!("unknown key `{}` in [{table}]", shown(name)), Some(help))
            });
        }
    }
    known
}

/// Help for an unknown key: the table of a known one, the most similar one, and all keys.
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
        "e" | "estar" | "youngsmodulus" | "youngmodulus" | "modulus" | "reducedmodulus"
        | "elasticmodulus" => ("material", "contact_modulus_pa", "E* = E/(1 − ν²)"),
        "deltagamma" | "dgamma" | "gamma" | "δγ" | "γ" | "adhesion" | "surfaceenergy" => {
            ("material", "work_of_adhesion_j_m2", "Δγ")
        }
        "epsilon" | "eps" | "ε" | "range" => ("material", "interaction_range_m", "ε"),
        "fmax" | "load" | "maxforce" | "force" => ("cycle", "max_load", "F_max/(E* A0)"),
        "step" | "outputstep" => ("cycle", "approach_step", "the output step Δ/h_rms"),
        _ => return None,
    })
}

/// A key in a form for messages; a quoted key may hold any characters.
pub(super) fn shown(key: &str) -> String {
    let plain: String = key.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).take(41).collect();
    if plain.chars().count() > 40 { plain.chars().take(39).chain(['…']).collect() } else { plain }
}
