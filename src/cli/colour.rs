//! Colours of the labels `error:`, `warning:` and `help:` on a terminal.

use std::borrow::Cow;

/// Labels at the beginning of a line, with their attributes (ECMA-48).
const LABELS: [(&str, &str); 4] =
    [("error:", "1;31"), ("warning:", "1;33"), ("warning[", "1;33"), ("help:", "1;36")];

/// A text whose labels are coloured, if it goes to a terminal and `NO_COLOR` is not set.
pub(super) fn painted(text: Cow<'_, str>, is_terminal: bool) -> Cow<'_, str> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    if !is_terminal || set("NO_COLOR").is_some() || set("TERM").is_some_and(|name| name == "dumb") {
        return text;
    }
    let line = |line: &str| match LABELS.iter().find(|(label, _)| line.starts_with(label)) {
        Some((label, attributes)) => {
            // To the colon: `warning[tabor]:`.
            let (label, rest) = line.split_at(line.find(':').map_or(label.len(), |at| at + 1));
            format!("\x1b[{attributes}m{label}\x1b[0m{rest}")
        }
        None => line.to_owned(),
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n").into()
}
