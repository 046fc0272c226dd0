//! Text for people and for shells: counted nouns, visible names, quoted words.

use std::borrow::Cow;
use std::path::Path;

/// A count with its noun: "1 task", "20 tasks".
#[must_use]
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Values in a list; a unit that all have follows the last one: "0.01, 0.02 J/m²".
#[must_use]
pub fn with_one_unit(values: &[&str]) -> String {
    let parts: Vec<(&str, &str)> = values.iter().filter_map(|value| value.split_once(' ')).collect();
    match parts[..] {
        [(_, unit), ..] if parts.len() == values.len() && parts.iter().all(|(_, other)| *other == unit) => {
            let numbers: Vec<&str> = parts.iter().map(|(number, _)| *number).collect();
            format!("{} {unit}", numbers.join(", "))
        }
        _ => values.join(", "),
    }
}

/// A duration as a person writes it: "5.1 s", "2m 30s", "3h 5m".
#[must_use]
pub fn in_words(seconds: f64) -> String {
    if seconds.is_nan() || seconds < 59.95 {
        return format!("{:.1} s", seconds.max(0.0));
    }
    // Beyond an hour, seconds are no information.
    let unit = if seconds < 3600.0 { 1.0 } else { 60.0 };
    let rounded = std::time::Duration::try_from_secs_f64((seconds / unit).round() * unit)
        .unwrap_or(std::time::Duration::MAX);
    humantime::format_duration(rounded).to_string()
}

/// Lines of at most `columns` columns: the first begins with `first`, later ones with `indent`.
fn filled<'a>(first: &str, indent: &str, words: impl Iterator<Item = &'a str>, columns: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        let start = if lines.is_empty() { first } else { indent };
        match lines.last_mut().filter(|line| line.chars().count() + 1 + word.chars().count() <= columns) {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(format!("{start}{word}")),
        }
    }
    lines.join("\n")
}

/// A paragraph as lines of at most 80 columns; the second and later ones begin with `indent`.
#[must_use]
pub fn wrapped(paragraph: &str, indent: &str) -> String {
    filled("", indent, paragraph.split(' '), 80) + "\n"
}

/// A paragraph of Markdown as lines of at most 100 columns, or an entry of a list if `marker` is that of one.
#[must_use]
pub fn paragraph(marker: &str, text: &str) -> String {
    filled(marker, &" ".repeat(marker.len()), text.split_whitespace(), 100)
}

/// Plain text as Markdown: outside of code spans, characters of links, tags and emphasis are escaped.
#[must_use]
pub fn markdown(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    let mut in_code = false;
    for c in text.chars() {
        in_code ^= c == '`';
        if !in_code && "[]<>*|".contains(c) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

/// A name on one line: control characters and marks that reorder text are written as escapes.
#[must_use]
pub fn visible(name: &str) -> String {
    escaped(name, hides)
}

/// A path as it appears in a message.
#[must_use]
pub fn shown(path: &Path) -> String {
    visible(&path.to_string_lossy())
}

/// A text of several lines, with escapes as [`visible`] has them. Line ends and tabs remain.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    let hides = |c: char| hides(c) && !matches!(c, '\n' | '\t');
    if text.chars().any(hides) { escaped(text, hides).into() } else { text.into() }
}

/// A string literal of TOML, which Python reads alike.
#[must_use]
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted += &format!("\\u{:04x}", c as u32),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// One word of a command that is meant to be pasted into a POSIX shell; `$'…'` for control characters, as
/// bash, zsh and ksh have it.
#[must_use]
pub fn shell_quote(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "_@%+=:,./-".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    if word.chars().any(hides) {
        let word = word.replace('\\', "\\\\").replace('\'', "\\'");
        return format!("$'{}'", escaped(&word, hides));
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// A path as one word of a shell.
#[must_use]
pub fn shell_path(path: &Path) -> String {
    shell_quote(&path.to_string_lossy())
}

/// True if a character could move a cursor, end a line, or reorder what is around it.
fn hides(c: char) -> bool {
    c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The escapes are those of JSON, so that JSON text stays valid; bash reads the same ones.
fn escaped(text: &str, hides: impl Fn(char) -> bool) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' if hides(c) => shown.push_str("\\n"),
            '\r' if hides(c) => shown.push_str("\\r"),
            '\t' if hides(c) => shown.push_str("\\t"),
            c if hides(c) => shown.push_str(&format!("\\u{:04x}", c as u32)),
            c => shown.push(c),
        }
    }
    shown
}
