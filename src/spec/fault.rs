//! Errors in a spec, with their positions.

use std::collections::HashSet;
use std::fmt;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::ops::Range;

use serde::Serialize;

/// All errors of one spec.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpecErrors {
    file: String,
    faults: Vec<Fault>,
    more: usize,
    /// The settings (`--set`) with which the file was read.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    settings: Vec<String>,
}

/// One error of a spec.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fault {
    /// The problem, without a full stop.
    pub message: String,
    /// Recommended action.
    pub help: Option<String>,
    /// Position in the file or in a setting of the command line; `None` if the file could not be read.
    pub place: Option<Place>,
}

/// A place in the text of a spec.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1, in characters.
    pub column: usize,
    /// The line, or the part of a long one around the place.
    pub excerpt: String,
    /// Carets below the excerpt.
    pub carets: String,
    /// True if the text is a setting of the command line.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_setting: bool,
}

impl SpecErrors {
    /// The file, as it was named to the reader.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The faults in the order of their places; at least one.
    #[must_use]
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// These errors, for a spec that was read with settings.
    pub(super) fn with(self, settings: &[String]) -> Self {
        Self { settings: settings.to_vec(), ..self }
    }

    /// The file could not be read at all.
    pub(super) fn unreadable(file: &str, cause: &str) -> Self {
        let message = format!("cannot read the spec: {cause}");
        Self {
            file: file.to_owned(),
            faults: vec![Fault {
                message,
                help: Some("give the path of a spec; `hysteron init > first.toml` writes one".to_owned()),
                place: None,
            }],
            more: 0,
            settings: Vec::new(),
        }
    }

    /// The file is no text: `valid` bytes of it are.
    pub(super) fn not_utf8(bytes: &[u8], valid: usize, file: &str) -> Self {
        let message = "cannot read the spec: not UTF-8 text".to_owned();
        let help = Some("save the file as UTF-8".to_owned());
        let text = String::from_utf8_lossy(bytes);
        let place = Some(Place::new(
            &text,
            &line_starts(&text),
            &(valid..valid + char::REPLACEMENT_CHARACTER.len_utf8()),
        ));
        Self {
            file: file.to_owned(),
            faults: vec![Fault { message, help, place }],
            more: 0,
            settings: Vec::new(),
        }
    }
}

impl std::error::Error for SpecErrors {}

impl fmt::Display for SpecErrors {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, fault) in self.faults.iter().enumerate() {
            if number > 0 {
                writeln!(out)?;
            }
            writeln!(out, "error: {}", fault.message)?;
            let line = fault.place.as_ref().map_or_else(String::new, |place| place.line.to_string());
            let pad = " ".repeat(line.len().max(1) + 1);
            match &fault.place {
                None => writeln!(out, "{pad}--> {}", self.file)?,
                Some(place) => {
                    let file = if place.is_setting { OPTION } else { &self.file };
                    writeln!(out, "{pad}--> {file}:{}:{}", place.line, place.column)?;
                    writeln!(out, "{pad} |")?;
                    writeln!(out, " {line} | {}", place.excerpt)?;
                    writeln!(out, "{pad} | {}", place.carets)?;
                }
            }
            if let Some(help) = &fault.help {
                writeln!(out, "{pad} = help: {help}")?;
            }
        }
        if self.more > 0 {
            writeln!(out, "\n… and {} more", self.more)?;
        }
        if !self.settings.is_empty() {
            writeln!(out, "\nThe spec was read with --set {}", self.settings.join(" --set "))?;
        }
        Ok(())
    }
}

/// The option of settings, as errors name it.
pub(super) const OPTION: &str = "--set";

/// Places from which those in settings begin, and places for each setting: more than an argument of a
/// command may have.
const SETTINGS: usize = usize::MAX / 2;
const STRIDE: usize = 1 << 20;

/// A place in a setting, by its number.
pub(super) fn in_setting(number: usize, span: &Range<usize>) -> Range<usize> {
    let at = |place: usize| SETTINGS.saturating_add(number.saturating_mul(STRIDE)).saturating_add(place);
    at(span.start)..at(span.end)
}

/// Faults that are kept and shown; the others are counted.
const MOST: usize = 20;

/// Characters of a line that are shown, and how many of them before the place.
const WINDOW: usize = 100;
const BEFORE: usize = 40;

impl Place {
    /// The place of a range of bytes, which need not lie within the text nor on the bounds of characters.
    /// `starts` are those of the text's lines.
    fn new(text: &str, starts: &[usize], span: &Range<usize>) -> Self {
        let start = boundary(text, span.start);
        let end = boundary(text, span.end).max(start);
        let line = line_of(starts, start);
        let line_start = starts[line - 1];
        let source = text.get(line_start..).and_then(|rest| rest.split('\n').next()).unwrap_or_default();
        let line_text = source.strip_suffix('\r').unwrap_or(source);
        let before = text.get(line_start..start).unwrap_or_default();
        // A byte order mark is no character that an editor shows or counts.
        let hidden = usize::from(line_text.starts_with('\u{feff}'));
        let column = before.chars().count().saturating_sub(hidden);
        let marked =
            text.get(start..end).and_then(|part| part.split(['\n', '\r']).next()).unwrap_or_default();

        let from = if column > WINDOW - 10 { column - BEFORE } else { 0 };
        let shown: Vec<char> = line_text.chars().skip(hidden + from).take(WINDOW).collect();
        let more = line_text.chars().count() > hidden + from + shown.len();
        let lead = if from > 0 { "…" } else { "" };
        let tail = if more { "…" } else { "" };
        // Control characters could move the cursor of a terminal; tabs stay, and the carets repeat them to
        // stay below.
        let excerpt: String =
            shown.iter().map(|&c| if c != '\t' && c.is_control() { '\u{fffd}' } else { c }).collect();
        let offset = column - from;
        let pad: String = shown.iter().take(offset).map(|&c| if c == '\t' { '\t' } else { ' ' }).collect();
        let width = marked.chars().count().min(shown.len().saturating_sub(offset)).max(1);
        Self {
            line,
            column: column + 1,
            excerpt: format!("{lead}{excerpt}{tail}"),
            carets: format!("{}{pad}{}", if from > 0 { " " } else { "" }, "^".repeat(width)),
            is_setting: false,
        }
    }
}

/// The last bound of a character that is not beyond `at`.
fn boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// Starts of the lines of a text \[bytes\]; the first one at 0.
fn line_starts(text: &str) -> Vec<usize> {
    std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect()
}

/// The number of the line of a place, from 1.
fn line_of(starts: &[usize], at: usize) -> usize {
    starts.partition_point(|start| *start <= at)
}

/// Collects the faults of one text, in a time that grows as the text does.
pub(super) struct Faults<'t> {
    text: &'t str,
    file: String,
    /// Starts of the lines.
    starts: Vec<usize>,
    /// Settings as TOML.
    settings: Vec<String>,
    found: Vec<(Range<usize>, Fault)>,
    /// Hashes of all faults, so that each is counted once.
    seen: HashSet<u64>,
    more: usize,
}

impl<'t> Faults<'t> {
    /// No fault yet.
    pub(super) fn new(text: &'t str, file: &str) -> Self {
        Self {
            text,
            file: file.to_owned(),
            starts: line_starts(text),
            settings: Vec::new(),
            found: Vec::new(),
            seen: HashSet::new(),
            more: 0,
        }
    }

    /// With the settings that the text was read with, as TOML.
    pub(super) fn with(self, settings: Vec<String>) -> Self {
        Self { settings, ..self }
    }

    /// The place of a range of bytes in the text or in a setting.
    fn place(&self, span: &Range<usize>) -> Option<Place> {
        let Some(at) = span.start.checked_sub(SETTINGS) else {
            return Some(Place::new(self.text, &self.starts, span));
        };
        let text = self.settings.get(at / STRIDE)?;
        let own = at % STRIDE..at % STRIDE + span.len();
        Some(Place { is_setting: true, ..Place::new(text, &line_starts(text), &own) })
    }

    /// Adds a fault; a second one with the same words at the same place says nothing new.
    pub(super) fn add(&mut self, span: &Range<usize>, message: String, help: impl Into<Option<String>>) {
        let mut hasher = DefaultHasher::new();
        (span, &message).hash(&mut hasher);
        if !self.seen.insert(hasher.finish()) {
            return;
        }
        if self.is_full() {
            self.more += 1;
            return;
        }
        let place = self.place(span);
        self.found.push((span.clone(), Fault { message, help: help.into(), place }));
    }

    /// Adds a fault of its own place. Its message and help are made only if it is shown.
    pub(super) fn add_with(&mut self, span: &Range<usize>, words: impl FnOnce() -> (String, Option<String>)) {
        if self.is_full() {
            self.more += 1;
            return;
        }
        let (message, help) = words();
        self.add(span, message, help);
    }

    /// True if further faults are only counted.
    pub(super) fn is_full(&self) -> bool {
        self.found.len() >= MOST
    }

    /// Number of faults.
    pub(super) fn count(&self) -> usize {
        self.found.len() + self.more
    }

    /// Line of a place, from 1.
    pub(super) fn line(&self, span: &Range<usize>) -> usize {
        line_of(&self.starts, boundary(self.text, span.start))
    }

    /// Text at a place, on one line and not too long.
    pub(super) fn written(&self, span: &Range<usize>) -> String {
        let text = self.text.get(span.clone()).unwrap_or_default();
        let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
        let line: String = line.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
        if line.chars().count() > 40 { line.chars().take(39).chain(['…']).collect() } else { line }
    }

    /// The value, if there are no faults.
    pub(super) fn finish<T>(mut self, read: Option<T>) -> Result<T, SpecErrors> {
        match read {
            Some(read) if self.found.is_empty() => Ok(read),
            _ => {
                self.found.sort_by_key(|(span, _)| span.start);
                let faults = self.found.into_iter().map(|(_, fault)| fault).collect();
                Err(SpecErrors { file: self.file, faults, more: self.more, settings: Vec::new() })
            }
        }
    }
}
