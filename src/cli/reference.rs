//! The reference page of the command line, and every generated file of the repository.

use super::Arguments;
use super::exit::{BAD_SPEC, FAILED, FAILED_CASES, INTERRUPTED};
use crate::text::{markdown, paragraph};
use crate::{schema, spec};
use clap::{Arg, Command, CommandFactory};
use std::path::{Path, PathBuf};

/// The folder of the guide, from the root of the repository.
pub const GUIDE: &str = "src/guide";

/// Every generated file: its path from the root of the repository, and its content.
#[must_use]
pub fn generated() -> Vec<(PathBuf, String)> {
    let schemas = Path::new(schema::DIRECTORY);
    let mut files: Vec<_> =
        schema::files().into_iter().map(|file| (schemas.join(file.name), file.content)).collect();
    files.push((schemas.join(spec::SCHEMA_FILE), spec::json_schema()));
    files.push((Path::new(GUIDE).join("reference_spec.md"), spec::reference()));
    files.push((Path::new(GUIDE).join("reference_cli.md"), page()));
    files.push((Path::new(GUIDE).join("reference_limits.md"), super::reference_limits::page()));
    files
}

/// The page in Markdown.
fn page() -> String {
    let mut program = Arguments::command();
    program.build();
    let mut page = format!(
        "\
# Command line

Written by `hysteron schema --write` from `src/cli.rs`; do not edit.

This page lists every command with its arguments, options and defaults. `hysteron COMMAND --help`
prints the same text. `DIR` is the output directory of a run.

## Exit codes

| code | meaning |
|---|---|
| 0 | finished |
| {FAILED} | failed |
| {BAD_SPEC} | invalid spec or command line |
| {FAILED_CASES} | finished, but cycles have failed or loads are not reached |
| {INTERRUPTED} | interrupted; the same command resumes |
"
    );
    for command in commands(&program) {
        section(command, "hysteron", &mut page);
    }
    page
}

fn commands(parent: &Command) -> impl Iterator<Item = &Command> {
    parent.get_subcommands().filter(|command| command.get_name() != "help" && !command.is_hide_set())
}

/// A command and the commands below it.
fn section(command: &Command, parent: &str, page: &mut String) {
    let name = format!("{parent} {}", command.get_name());
    let about = command.get_long_about().or(command.get_about()).map(ToString::to_string).unwrap_or_default();
    let usage = command.clone().render_usage().to_string();
    *page += &format!("\n## `{name}`\n\n");
    for part in about.split("\n\n") {
        *page += &format!("{}\n\n", sentence(part));
    }
    let aliases: Vec<String> =
        command.get_visible_aliases().map(|alias| format!("`{parent} {alias}`")).collect();
    if !aliases.is_empty() {
        *page += &format!("Alias: {}\n\n", aliases.join(", "));
    }
    *page += &format!("```text\n{}\n```\n", usage.strip_prefix("Usage: ").unwrap_or(&usage).trim_end());
    let arguments: Vec<String> =
        command.get_arguments().filter(|argument| is_own(argument)).map(entry).collect();
    if !arguments.is_empty() {
        *page += &format!("\n{}", arguments.concat());
    }
    if let Some(notes) = command.get_after_long_help().or(command.get_after_help()) {
        *page += &format!("\n```text\n{}\n```\n", notes.to_string().trim_end());
    }
    for inner in commands(command) {
        section(inner, &name, page);
    }
}

/// True if an argument is one that other commands do not have too.
fn is_own(argument: &Arg) -> bool {
    !argument.is_hide_set() && !matches!(argument.get_id().as_str(), "help" | "version")
}

/// An argument as an entry of a list: spelling, meaning, values, default.
fn entry(argument: &Arg) -> String {
    let takes_value = argument.is_positional() || argument.get_action().takes_values();
    let names = argument
        .get_value_names()
        .unwrap_or_default()
        .iter()
        .map(|name| format!("<{name}>"))
        .collect::<Vec<_>>()
        .join(" ");
    let short = argument.get_short().map(|short| format!("-{short}"));
    let long = argument.get_long().map(|long| format!("--{long}"));
    let spelling = [short, long].into_iter().flatten().collect::<Vec<_>>().join(", ");
    let spelling = [spelling, if takes_value { names } else { String::new() }].join(" ");
    let help = argument.get_long_help().or(argument.get_help()).map(ToString::to_string).unwrap_or_default();
    let mut text = format!("`{}`: {}", spelling.trim(), sentence(&help));
    let values: Vec<String> =
        argument.get_possible_values().iter().map(|value| format!("`{}`", value.get_name())).collect();
    // A help text that lists the values itself hides them.
    if takes_value && !values.is_empty() && !argument.is_hide_possible_values_set() {
        text += &format!(" Values: {}.", values.join(", "));
    }
    let defaults: Vec<String> =
        argument.get_default_values().iter().map(|value| format!("`{}`", value.to_string_lossy())).collect();
    if takes_value && !defaults.is_empty() {
        text += &format!(" Default: {}.", defaults.join(", "));
    }
    format!("{}\n", paragraph("- ", &text))
}

/// A text of the command line as a paragraph that ends with a full stop.
fn sentence(text: &str) -> String {
    let text = paragraph("", &markdown(text));
    if text.is_empty() || text.ends_with('.') { text } else { text + "." }
}
