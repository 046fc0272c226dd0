//! A spec as TOML, with every default written out.

use std::fmt::{Error, Write as _};

use super::keys::{KEYS, TABLES};
use super::{Spec, Value};

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
    for table in TABLES {
        writeln!(text, "\n[{table}]")?;
        for key in KEYS.iter().filter(|key| key.table == table) {
            writeln!(text, "{} = {}", key.name, value(&(key.get)(&spec.base)))?;
        }
    }
    for sweep in &spec.sweeps {
        writeln!(text, "\n[[sweep]]\nname = \"{}\"", sweep.name)?;
        for axis in &sweep.axes {
            match axis.values.as_slice() {
                [only] => writeln!(text, "{} = {}", axis.key, value(only))?,
                many => writeln!(text, "{} = [{}]", axis.key, list(many.iter().map(value)))?,
            }
        }
    }
    Ok(())
}

/// A value as TOML. Rust's shortest form of a float is also TOML's, and reads back to the same bits.
fn value(value: &Value) -> String {
    match value {
        Value::Number(number) => format!("{number:?}"),
        Value::Count(count) => count.to_string(),
        Value::Flag(flag) => flag.to_string(),
        Value::Word(word) => format!("\"{word}\""),
        Value::Numbers(numbers) => format!("[{}]", list(numbers.iter().map(|number| format!("{number:?}")))),
        Value::Words(words) => {
            format!("[{}]", list(words.iter().map(|word| format!("\"{word}\""))))
        }
    }
}

fn list(values: impl Iterator<Item = String>) -> String {
    values.collect::<Vec<_>>().join(", ")
}
