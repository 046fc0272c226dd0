//! Attributes of a height field, whichever format holds them.

use super::numbers::Number;

/// Attributes of one object of a file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Attributes {
    entries: Vec<(String, Value)>,
}

/// Value of an attribute.
#[derive(Debug, Clone)]
pub(crate) enum Value {
    /// Text without padding.
    Text(String),
    /// Numbers, and their kind in the file.
    Numbers(Vec<f64>, Number),
}

impl Attributes {
    /// Adds an attribute.
    pub(crate) fn push(&mut self, name: String, value: Value) {
        self.entries.push((name, value));
    }

    /// Adds an attribute, if it has a value.
    pub(crate) fn extend(&mut self, name: String, value: Option<Value>) {
        self.entries.extend(value.map(|value| (name, value)));
    }

    /// All attributes in the order of the file.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.entries.iter().map(|(name, value)| (name.as_str(), value))
    }

    /// Text of an attribute, if it is there and not empty.
    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        self.iter().find_map(|(other, value)| match value {
            Value::Text(text) if other == name && !text.is_empty() => Some(text.as_str()),
            _ => None,
        })
    }

    /// Numbers of an attribute, and their kind in the file.
    pub(crate) fn numbers(&self, name: &str) -> Option<(&[f64], Number)> {
        self.iter().find_map(|(other, value)| match value {
            Value::Numbers(numbers, kind) if other == name => Some((numbers.as_slice(), *kind)),
            _ => None,
        })
    }

    /// First number of an attribute.
    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        self.numbers(name)?.0.first().copied()
    }

    /// Unit as `unit` or `units`, the names of SurfaceTopography and of the CF conventions.
    pub(crate) fn unit(&self) -> Option<&str> {
        self.text("unit").or_else(|| self.text("units"))
    }
}

/// Bytes as text: UTF-8, or else Latin-1, in which instruments write their µ. A µ in UTF-8 that was read as
/// Latin-1 before is one again.
pub(crate) fn decoded(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.replace("\u{c2}\u{b5}", "\u{b5}"),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}
