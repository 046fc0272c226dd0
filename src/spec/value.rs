//! From a value as written to a value of the right kind and within its bounds.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeFloat, DeInteger, DeValue};

use super::fault::Faults;
use super::keys::{Key, Kind, Limits, available, unavailable};
use super::nearest::nearest;
use super::{MAX_REALIZATIONS, Value};

type Written<'t> = Spanned<DeValue<'t>>;

/// The value of a key; nothing, with a fault added, if it is not fit.
pub(super) fn read(key: &Key, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<Value> {
    match &key.kind {
        Kind::Number(limits) => number(key.path, limits, value, faults).map(Value::Number),
        Kind::Count {
            low,
            high,
            why,
            note,
        } => {
            let found = integer(key.path, value, faults)?;
            if let Some(count) = u32::try_from(found)
                .ok()
                .filter(|count| (*low..=*high).contains(count))
            {
                return Some(Value::Count(count));
            }
            let why = why
                .iter()
                .find(|(most, _)| found <= *most)
                .map_or(*note, |(_, why)| *why);
            let message = format!(
                "`{}` cannot be {found}: it must be from {low} to {high}",
                key.path
            );
            faults.add(&value.span(), message, why.to_owned());
            None
        }
        Kind::Flag => match value.get_ref() {
            DeValue::Boolean(flag) => Some(Value::Flag(*flag)),
            other => {
                let help = "write true or false, without quotes".to_owned();
                wrong_type(
                    key.path,
                    "true or false",
                    other,
                    &value.span(),
                    help,
                    faults,
                );
                None
            }
        },
        Kind::Word(words) => word(key, &words(), value, faults).map(Value::Word),
        Kind::Numbers(limits, most) => {
            numbers(key, limits, *most, value, faults).map(Value::Numbers)
        }
        Kind::Words(words) => {
            let words = words();
            let elements = array(key.path, "words", value, faults)?;
            let read: Vec<_> = elements
                .iter()
                .map(|element| word(key, &words, element, faults))
                .collect();
            let said: Vec<_> = read.into_iter().collect::<Option<_>>()?;
            // In the order of the choice, so that two orders of writing are one case.
            Some(Value::Words(
                words
                    .into_iter()
                    .filter(|word| said.contains(word))
                    .collect(),
            ))
        }
    }
}

/// A real number within its bounds.
fn number(
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
            wrong_type(path, "a number", other, &span, unquoted(other), faults);
            return None;
        }
    };
    let written = faults.written(&span);
    if !found.is_finite() {
        let what = if found.is_nan() {
            "is not a number"
        } else {
            "is infinite"
        };
        faults.add(
            &span,
            format!(
                "`{path}` cannot be {written}, which {what}: {}",
                allowed(limits)
            ),
            None,
        );
        return None;
    }
    if limits.hold(found) {
        return Some(found);
    }
    let name = path.rsplit('.').next().unwrap_or(path);
    let slip = limits
        .slip
        .filter(|(size, _)| limits.hold(found * size))
        .map(|(size, unit)| {
            let right = short(rounded(found * size));
            format!(
                "is this in {unit}? {name} is in {}: write {right}",
                limits.unit_name
            )
        });
    let help = slip.or_else(|| (!limits.note.is_empty()).then(|| limits.note.to_owned()));
    faults.add(
        &span,
        format!(
            "`{path}` cannot be {written}{}: {}",
            limits.unit,
            allowed(limits)
        ),
        help,
    );
    None
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

/// The array of numbers of a key: ascending, each once.
fn numbers(
    key: &Key,
    limits: &Limits,
    most: usize,
    value: &Written<'_>,
    faults: &mut Faults<'_>,
) -> Option<Vec<f64>> {
    let path = key.path;
    let elements = array(path, "numbers", value, faults)?;
    if elements.is_empty() || elements.len() > most {
        let message = format!(
            "`{path}` cannot have {} values: it must have from 1 to {most}",
            elements.len()
        );
        faults.add(&value.span(), message, None);
        return None;
    }
    let before = faults.count();
    let mut seen: Vec<f64> = Vec::with_capacity(elements.len());
    for element in elements {
        if let Some(found) = number(path, limits, element, faults) {
            if seen.contains(&found) {
                let message = format!("`{path}` has the value {} twice", short(found));
                faults.add(
                    &element.span(),
                    message,
                    "each turning point must stand once".to_owned(),
                );
            }
            seen.push(found);
        }
    }
    seen.sort_by(f64::total_cmp);
    (faults.count() == before).then_some(seen)
}

/// The elements of an array.
fn array<'v, 't>(
    path: &str,
    of: &str,
    value: &'v Written<'t>,
    faults: &mut Faults<'_>,
) -> Option<&'v toml::de::DeArray<'t>> {
    match value.get_ref() {
        DeValue::Array(elements) => Some(elements),
        other => {
            let span = value.span();
            let help = format!("write [{}]", faults.written(&span));
            wrong_type(
                path,
                &format!("an array of {of}"),
                other,
                &span,
                help,
                faults,
            );
            None
        }
    }
}

/// One of the words of a key.
fn word(
    key: &Key,
    words: &[&'static str],
    value: &Written<'_>,
    faults: &mut Faults<'_>,
) -> Option<&'static str> {
    let span = value.span();
    let can = available(key, words);
    let listed = if can.is_empty() {
        "allowed now: an empty array".to_owned()
    } else {
        format!(
            "allowed now: {}",
            can.iter()
                .map(|word| format!("\"{word}\""))
                .collect::<Vec<_>>()
                .join(", ")
        )
    };
    let DeValue::String(found) = value.get_ref() else {
        wrong_type(
            key.path,
            "a word in quotes",
            value.get_ref(),
            &span,
            listed,
            faults,
        );
        return None;
    };
    let Some(known) = words.iter().find(|word| **word == found.as_ref()) else {
        let help = match nearest(found, can.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"? {listed}"),
            None => listed,
        };
        faults.add(
            &span,
            format!(
                "`{}` does not know the word {}",
                key.path,
                faults.written(&span)
            ),
            help,
        );
        return None;
    };
    if let Some(reason) = unavailable(key, known) {
        let message = format!(
            "`{}` cannot be \"{known}\": {reason} is not available in this version",
            key.path
        );
        faults.add(&span, message, listed);
        return None;
    }
    Some(known)
}

/// A whole number.
fn integer(path: &str, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<i128> {
    let span = value.span();
    let DeValue::Integer(found) = value.get_ref() else {
        let help = match value.get_ref() {
            DeValue::Float(float) if real(float).fract() == 0.0 && real(float).abs() < 1e15 => {
                Some(format!("write {:.0}, without a point", real(float)))
            }
            other => unquoted(other),
        };
        wrong_type(path, "an integer", value.get_ref(), &span, help, faults);
        return None;
    };
    let whole = whole(found);
    if whole.is_none() {
        let message = format!(
            "`{path}` cannot be {}: a TOML integer has at most 64 bits",
            faults.written(&span)
        );
        faults.add(&span, message, None);
    }
    whole
}

/// The seed of the campaign.
pub(super) fn seed(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<u64> {
    let found = integer("seed", value, faults)?;
    let seed = u64::try_from(found).ok();
    if seed.is_none() {
        let message = format!(
            "`seed` cannot be {found}: it must be from 0 to {}",
            i64::MAX
        );
        faults.add(&value.span(), message, None);
    }
    seed
}

/// The number of realisations.
pub(super) fn realizations(value: &Written<'_>, faults: &mut Faults<'_>) -> Option<u32> {
    let found = integer("realizations", value, faults)?;
    let count = u32::try_from(found)
        .ok()
        .filter(|count| (1..=MAX_REALIZATIONS).contains(count));
    if count.is_none() {
        let message =
            format!("`realizations` cannot be {found}: it must be from 1 to {MAX_REALIZATIONS}");
        faults.add(&value.span(), message, None);
    }
    count
}

/// A name that can name a folder on every system.
pub(super) fn name(of: &str, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<String> {
    let span = value.span();
    let DeValue::String(found) = value.get_ref() else {
        let help = "write it in quotes".to_owned();
        wrong_type(of, "a name in quotes", value.get_ref(), &span, help, faults);
        return None;
    };
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if (1..=64).contains(&found.len()) && found.chars().all(allowed) {
        return Some(found.to_string());
    }
    let message = format!(
        "`{of}` cannot be {}: it names a folder or a table row",
        faults.written(&span)
    );
    faults.add(
        &span,
        message,
        "1 to 64 of the letters A-Z and a-z, digits, - and _ are allowed".to_owned(),
    );
    None
}

/// Adds the fault of a value of a wrong type.
pub(super) fn wrong_type(
    path: &str,
    wanted: &str,
    found: &DeValue<'_>,
    span: &Range<usize>,
    help: impl Into<Option<String>>,
    faults: &mut Faults<'_>,
) {
    let message = match found {
        DeValue::Table(_) => format!("`{path}` must be {wanted}, not a table"),
        DeValue::Array(_) => format!("`{path}` must be {wanted}, not an array"),
        other => format!(
            "`{path}` must be {wanted}, not the {} {}",
            other.type_str(),
            faults.written(span)
        ),
    };
    faults.add(span, message, help);
}

/// What to say of a number in quotes.
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
    i64::from_str_radix(integer.as_str(), integer.radix())
        .ok()
        .map(i128::from)
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
