//! Numbers as written, and numbers within their bounds.

use toml::de::{DeFloat, DeInteger, DeValue};

use super::fault::Faults;
use super::keys::{Key, Limits};
use super::written::{Written, array, wrong_type};

/// A real number within its bounds.
pub(super) fn number(
    path: &str,
    limits: &Limits,
    value: &Written<'_>,
    faults: &mut Faults<'_>,
) -> Option<f64> {
    let span = value.span();
    let found = match value.get_ref() {
        DeValue::Float(float) => real(float),
        DeValue::Integer(_) => integer(path, value, faults)? as f64,
        other => {
            let help = unquoted(other).unwrap_or_else(|| note(limits));
            wrong_type(path, "a number", other, &span, help, faults);
            return None;
        }
    };
    let written = faults.written(&span);
    if !found.is_finite() {
        let what = if found.is_nan() { "is not a number" } else { "is infinite" };
        let message = format!("`{path}` cannot be {written}, which {what}: {}", allowed(limits));
        faults.add(&span, message, note(limits));
        return None;
    }
    if limits.hold(found) {
        return Some(found);
    }
    let name = path.rsplit('.').next().unwrap_or(path);
    let slip = limits.slip.filter(|(size, _)| limits.hold(found * size)).map(|(size, unit)| {
        let right = short(rounded(found * size));
        format!("is this in {unit}? {name} is in {}: write {right}", limits.unit_name)
    });
    let help = slip.unwrap_or_else(|| note(limits));
    faults.add(&span, format!("`{path}` cannot be {written}{}: {}", limits.unit, allowed(limits)), help);
    None
}

/// Meaning of the number, as far as it is stated, or its unit.
fn note(limits: &Limits) -> String {
    match (limits.note, limits.unit_name) {
        ("", "") => "write a number within these bounds".to_owned(),
        ("", unit) => format!("it is in {unit}"),
        (note, _) => note.to_owned(),
    }
}

/// The bounds as half a sentence.
fn allowed(limits: &Limits) -> String {
    let (low, high, unit) = (short(limits.low), short(limits.high), limits.unit);
    if limits.above {
        format!("it must be greater than {low} and at most {high}{unit}")
    } else {
        format!("it must be from {low} to {high}{unit}")
    }
}

/// Minimum relative difference of two loads: boundary elements reach each to 1e-5.
const APART: f64 = 1e-4;

/// The array of numbers of a key: ascending, each once.
pub(super) fn numbers(
    key: &Key,
    limits: &Limits,
    most: usize,
    value: &Written<'_>,
    faults: &mut Faults<'_>,
) -> Option<Vec<f64>> {
    let path = key.path;
    let elements = array(path, "numbers", value, faults)?;
    if elements.is_empty() || elements.len() > most {
        let message =
            format!("`{path}` cannot have {} values: it must have from 1 to {most}", elements.len());
        faults.add(&value.span(), message, note(limits));
        return None;
    }
    let before = faults.count();
    let mut seen: Vec<f64> = Vec::with_capacity(elements.len());
    for element in elements {
        if let Some(found) = number(path, limits, element, faults) {
            if seen.contains(&found) {
                let message = format!("`{path}` has the value {} twice", short(found));
                faults.add(&element.span(), message, "list each load reversal once".to_owned());
            }
            let other = seen
                .iter()
                .find(|other| found != **other && (found - **other).abs() < APART * found.max(**other));
            if let Some(other) = other {
                let message = format!(
                    "`{path}` has the values {} and {}, which differ by less than 1e-4 of them",
                    short(found),
                    short(*other)
                );
                faults.add(
                    &element.span(),
                    message,
                    "a load reversal is reached to 1e-5: list one of them".to_owned(),
                );
            }
            if found < f64::MIN_POSITIVE {
                let message =
                    format!("`{path}` cannot be {}: it is below the smallest normal number", short(found));
                faults.add(&element.span(), message, limits.note.to_owned());
            }
            seen.push(found);
        }
    }
    seen.sort_by(f64::total_cmp);
    (faults.count() == before).then_some(seen)
}

/// A whole number.
pub(super) fn integer(path: &str, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<i128> {
    let span = value.span();
    let DeValue::Integer(found) = value.get_ref() else {
        let help = match value.get_ref() {
            DeValue::Float(float) if real(float).fract() == 0.0 && real(float).abs() < 1e15 => {
                Some(format!("write {:.0}, without a point", real(float)))
            }
            other => Some(unquoted(other).unwrap_or_else(|| "write a whole number, such as 8".to_owned())),
        };
        wrong_type(path, "an integer", value.get_ref(), &span, help, faults);
        return None;
    };
    let whole = whole(found);
    if whole.is_none() {
        let message =
            format!("`{path}` cannot be {}: a TOML integer has at most 64 bits", faults.written(&span));
        faults.add(&span, message, format!("write at most {}", i64::MAX));
    }
    whole
}

/// Help for a number in quotes.
fn unquoted(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) if text.trim().parse::<f64>().is_ok() => {
            Some("write it without quotes".to_owned())
        }
        _ => None,
    }
}

/// The value of a float; the parser has seen that it is one.
fn real(float: &DeFloat<'_>) -> f64 {
    float.as_str().parse().unwrap_or(f64::NAN)
}

/// The value of an integer, if it has at most 64 bits.
fn whole(integer: &DeInteger<'_>) -> Option<i128> {
    i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(i128::from)
}

/// A number as one would write it: 1e-9, 0.2, 64, 1e13.
pub(super) fn short(value: f64) -> String {
    if value.abs() >= 1e6 {
        return format!("{value:e}");
    }
    let text = format!("{value:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// A number with twelve digits, so that a unit's factor leaves no `5.000000000000001e-6`.
fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}
