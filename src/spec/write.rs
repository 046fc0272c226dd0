//! A spec as TOML, with every default written out.

use std::fmt::{Error, Write as _};

use super::figures::arrays;
use super::keys::{
    GENERATED, KEYS, Key, MEASURED, NAMES, OPTIONAL_TABLES, OTHER_GRIDS, OTHER_LOADS, REPLACED, TABLES,
    WHERE_USED,
};
use super::values::Values;
use super::{Case, Spec, Value, coarser};
use crate::model::{Choice as _, Method};
use crate::text::quoted;

/// The text of a spec.
pub(super) fn toml(spec: &Spec) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail; the error is a formality of the trait.
    let _: Result<(), Error> = write(spec, &mut text);
    text
}

fn write(spec: &Spec, text: &mut String) -> Result<(), Error> {
    // Names hold letters, digits, - and _ only, and words are ours: no string needs an escape.
    writeln!(text, "name = \"{}\"", spec.name)?;
    writeln!(text, "seed = {}", spec.seed)?;
    writeln!(text, "realizations = {}", spec.realizations)?;
    writeln!(text, "figures = {}", spec.figures)?;
    if !spec.auto_methods.is_empty() && !spec.auto_methods.contains(&Method::Auto) {
        let methods = spec.auto_methods.iter().map(|method| format!("\"{}\"", method.word()));
        writeln!(text, "auto_methods = [{}]", list(methods))?;
    }
    if !spec.scan_sides_m.is_empty() {
        let sides = spec.scan_sides_m.iter().map(|side| format!("{side:?}"));
        writeln!(text, "{} = [{}]", super::sides::KEY, list(sides))?;
    }
    for table in TABLES {
        let is_written = |key: &&Key| key.table == table && is_read(key, &spec.base) && !follows(key, spec);
        let mut keys = KEYS.iter().filter(is_written).peekable();
        if keys.peek().is_some() {
            writeln!(text, "\n[{table}]")?;
        }
        for key in keys {
            let of_base = value(&(key.get)(&spec.base));
            let of_base = if coarser::LISTS.contains(&key.path) && !spec.coarser_points.is_empty() {
                let coarser = spec.coarser_points.iter().map(u32::to_string);
                format!("[{}]", list(coarser.chain([of_base])))
            } else {
                of_base
            };
            writeln!(text, "{} = {of_base}", key.name)?;
        }
    }
    for sweep in &spec.sweeps {
        writeln!(text, "\n[[sweep]]\nname = \"{}\"", sweep.name)?;
        if !sweep.zip.is_empty() {
            writeln!(text, "zip = {}", arrays(&sweep.zip))?;
        }
        for axis in &sweep.axes {
            match axis.values.as_slice() {
                [only] => writeln!(text, "{} = {}", axis.key, value(only))?,
                many => writeln!(text, "{} = [{}]", axis.key, list(many.iter().map(value)))?,
            }
        }
    }
    if let Some(experiment) = &spec.experiment {
        text.push_str(&super::experiment::toml(experiment));
    }
    if !spec.files.is_empty() {
        writeln!(text, "\n[files]")?;
    }
    for (name, digest) in &spec.files {
        writeln!(text, "{} = \"{digest}\"", quoted(name))?;
    }
    Ok(())
}

/// True if the base's kind of surface reads a key, or it says something other than its default. A table that
/// a spec need not have is written where one of its keys says something, and loads in the unit of the spec.
fn is_read(key: &Key, base: &Values) -> bool {
    let default = Values::default();
    let says = |key: &Key| (key.get)(base) != (key.get)(&default);
    let is_generated = !base.measured.is_named();
    match key.table {
        "surface" => {
            let others: &[&str] = if is_generated { &MEASURED } else { &GENERATED };
            let is_replaced = is_generated && base.generated.is_tabulated() && REPLACED.contains(&key.name);
            let is_optional = WHERE_USED.contains(&key.name) || NAMES.contains(&key.name);
            !(others.contains(&key.name) || is_replaced || is_optional) || says(key)
        }
        "cycle" if OTHER_LOADS.contains(&key.name) => says(key),
        "cycle" if key.name == "max_load" => base.max_force_n.is_empty() && base.max_pressure_pa.is_empty(),
        "boundary_elements" if key.name == "points" => {
            base.elements.per_wavelength.is_none() && base.goal.error.is_none()
        }
        "boundary_elements" if OTHER_GRIDS.contains(&key.name) => {
            says(key) || key.name == "max_points" && base.goal.error.is_some()
        }
        table if OPTIONAL_TABLES.contains(&table) => {
            KEYS.iter().any(|other| other.table == table && says(other))
                && (key.name != "compliance_m_n" || base.stiffness_n_m.is_none())
                && (key.name != "stiffness_n_m" || base.stiffness_n_m.is_some())
        }
        _ => true,
    }
}

/// True if a value was left to its default, which differs between the cases of a sweep that does not set it:
/// written out, it would hold for all of them.
fn follows(key: &Key, spec: &Spec) -> bool {
    let set = |name: &str| {
        spec.sweeps
            .iter()
            .any(|sweep| sweep.name == name && sweep.axes.iter().any(|axis| axis.key == key.path))
    };
    let differs = |case: &Case| (key.get)(&Values::from(&case.params)) != (key.get)(&spec.base);
    ["surface.detrend", "machine.compliance"].contains(&key.path)
        && spec
            .cases
            .iter()
            .filter(|case| !case.is_coarser_grid())
            .any(|case| differs(case) && !case.sweeps.iter().all(|name| set(name)))
}

/// A value as TOML. Rust's shortest form of a float is also TOML's, and reads back to the same bits.
pub(super) fn value(value: &Value) -> String {
    match value {
        Value::Number(number) => format!("{number:?}"),
        Value::Count(count) => count.to_string(),
        Value::Flag(flag) => flag.to_string(),
        Value::Word(word) => format!("\"{word}\""),
        Value::Text(text) => quoted(text),
        Value::Texts(texts) => format!("[{}]", list(texts.iter().map(|text| quoted(text)))),
        Value::Numbers(numbers) => format!("[{}]", list(numbers.iter().map(|number| format!("{number:?}")))),
        Value::Words(words) => {
            format!("[{}]", list(words.iter().map(|word| format!("\"{word}\""))))
        }
    }
}

fn list(values: impl Iterator<Item = String>) -> String {
    values.collect::<Vec<_>>().join(", ")
}
