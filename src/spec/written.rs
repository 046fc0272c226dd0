//! Values as written, and faults of their types.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeValue};

use super::fault::Faults;

/// A value and its place in the text.
pub(super) type Written<'t> = Spanned<DeValue<'t>>;

/// The elements of an array.
pub(super) fn array<'v, 't>(
    path: &str,
    of: &str,
    value: &'v Written<'t>,
    faults: &mut Faults<'_>,
) -> Option<&'v DeArray<'t>> {
    match value.get_ref() {
        DeValue::Array(elements) => Some(elements),
        other => {
            let span = value.span();
            let help = format!("write [{}]", faults.written(&span));
            wrong_type(path, &format!("an array of {of}"), other, &span, help, faults);
            None
        }
    }
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
        other => format!("`{path}` must be {wanted}, not the {} {}", other.type_str(), faults.written(span)),
    };
    faults.add(span, message, help);
}
