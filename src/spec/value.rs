//! From a value as written to a value of the right kind and within its bounds.

use toml::de::DeValue;

use super::Value;
use super::fault::Faults;
use super::keys::{Key, Kind, words};
use super::nearest::nearest;
use super::number::{integer, number, numbers};
use super::written::{Written, array, wrong_type};
use crate::lengths::{LENGTHS, metres};

/// The value of a key; nothing, with a fault added, if it is not fit.
pub(super) fn read(key: &Key, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<Value> {
    match &key.kind {
        Kind::Number(limits) => number(key.path, limits, value, faults).map(Value::Number),
        Kind::Count { low, high, why, note } => {
            let found = integer(key.path, value, faults)?;
            if let Some(count) = u32::try_from(found).ok().filter(|count| (*low..=*high).contains(count)) {
                return Some(Value::Count(count));
            }
            let why = why.iter().find(|(most, _)| found <= *most).map_or(*note, |(_, why)| *why);
            let message = format!("`{}` cannot be {found}: it must be from {low} to {high}", key.path);
            faults.add(&value.span(), message, why.to_owned());
            None
        }
        Kind::Flag => match value.get_ref() {
            DeValue::Boolean(flag) => Some(Value::Flag(*flag)),
            other => {
                let help = "write true or false, without quotes".to_owned();
                wrong_type(key.path, "true or false", other, &value.span(), help, faults);
                None
            }
        },
        Kind::Word(choice) => word(key.path, &words(choice), value, faults).map(Value::Word),
        Kind::Numbers(limits, most) => numbers(key, limits, *most, value, faults).map(Value::Numbers),
        Kind::Text(most, note) => text(key.path, *most, note, value, faults).map(Value::Text),
        Kind::Length(note) => length(key.path, note, value, faults).map(Value::Text),
        Kind::Texts(count, most, note) => {
            texts(key.path, (*count, *most), note, value, faults).map(Value::Texts)
        }
        Kind::Words(choice) => {
            let words = words(choice);
            let elements = array(key.path, "strings", value, faults)?;
            let read: Vec<_> =
                elements.iter().map(|element| word(key.path, &words, element, faults)).collect();
            let said: Vec<_> = read.into_iter().collect::<Option<_>>()?;
            // In the order of the choice, so that two orders of writing are one case.
            Some(Value::Words(words.into_iter().filter(|word| said.contains(word)).collect()))
        }
    }
}

/// A text on one line.
fn text(path: &str, most: usize, note: &str, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<String> {
    let span = value.span();
    let DeValue::String(found) = value.get_ref() else {
        wrong_type(path, "a string", value.get_ref(), &span, format!("it is {note}"), faults);
        return None;
    };
    if found.is_empty() && ["surface.file", "surface.spectrum"].contains(&path) {
        let without = if path == "surface.file" { "generated surface" } else { "power law" };
        faults.add(
            &span,
            format!("`{path}` is empty: it is {note}"),
            format!("remove the key for a {without}"),
        );
        return None;
    }
    if found.len() > most || found.chars().any(char::is_control) {
        let message = format!("`{path}` cannot be {}: it is {note}", faults.written(&span));
        faults.add(&span, message, format!("use at most {most} bytes without control characters"));
        return None;
    }
    Some(found.to_string())
}

/// Texts on one line, at least one and each once.
fn texts(
    path: &str,
    (count, most): (usize, usize),
    note: &str,
    value: &Written<'_>,
    faults: &mut Faults<'_>,
) -> Option<Vec<String>> {
    let elements = array(path, "strings", value, faults)?;
    if elements.is_empty() || elements.len() > count {
        let is_empty = elements.is_empty();
        let number =
            if is_empty { "is empty".to_owned() } else { format!("has {} elements", elements.len()) };
        let help = if is_empty {
            "name at least one file, or remove the key".to_owned()
        } else {
            format!("use at most {count}")
        };
        faults.add(&value.span(), format!("`{path}` {number}: it is {note}"), help);
        return None;
    }
    let mut found: Vec<String> = Vec::with_capacity(elements.len());
    for element in elements {
        let read = text(path, most, note, element, faults)?;
        if read.is_empty() || found.contains(&read) {
            let problem = if read.is_empty() {
                format!("`{path}` has an empty name")
            } else {
                format!("`{path}` names {} twice", faults.written(&element.span()))
            };
            faults.add(
                &element.span(),
                problem,
                "remove this entry: each scan is one realization".to_owned(),
            );
            return None;
        }
        found.push(read);
    }
    Some(found)
}

/// A unit of length, or none.
fn length(path: &str, note: &str, value: &Written<'_>, faults: &mut Faults<'_>) -> Option<String> {
    let found = text(path, 16, note, value, faults)?;
    if found.is_empty() || metres(&found).is_some() {
        return Some(found);
    }
    let span = value.span();
    faults.add(
        &span,
        format!("`{path}` cannot be {}: not a unit of length", faults.written(&span)),
        format!("use one of {LENGTHS}"),
    );
    None
}

/// Values that earlier versions had: key, value, help.
const REMOVED: [(&str, &str, &str); 1] = [(
    "model.interaction",
    "reciprocal",
    "use \"point\", which has an exact potential too, or \"spots\", the default",
)];

/// One of the words of a key.
pub(super) fn word(
    path: &str,
    words: &[&'static str],
    value: &Written<'_>,
    faults: &mut Faults<'_>,
) -> Option<&'static str> {
    let span = value.span();
    let listed = || {
        format!(
            "use one of {}",
            words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
        )
    };
    let DeValue::String(found) = value.get_ref() else {
        wrong_type(path, "a string", value.get_ref(), &span, listed(), faults);
        return None;
    };
    let Some(known) = words.iter().find(|word| **word == found.as_ref()) else {
        let written = faults.written(&span);
        let removed = REMOVED.iter().find(|(key, word, _)| *key == path && *word == found.as_ref());
        faults.add_with(&span, || {
            if let Some((.., help)) = removed {
                return (format!("value {written} of `{path}` was removed"), Some((*help).to_owned()));
            }
            let help = match nearest(found, words.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"? {}", listed()),
                None => listed(),
            };
            (format!("unknown value {written} of `{path}`"), Some(help))
        });
        return None;
    };
    Some(known)
}
