//! The schemas for readers: JSON for machines, Markdown for people.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{TABLES, Table};

/// Directory of the schema files, from the root of the repository.
pub const DIRECTORY: &str = "schemas";

/// A file below [`DIRECTORY`], as it must be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SchemaFile {
    /// File name, without directory.
    pub name: String,
    /// The whole content.
    pub content: String,
}

#[derive(Serialize)]
struct TableJson {
    table: &'static str,
    version: u32,
    file: &'static str,
    description: &'static str,
    columns: Vec<ColumnJson>,
}

#[derive(Serialize)]
struct WithKeys<'a> {
    #[serde(flatten)]
    table: TableJson,
    #[serde(flatten)]
    keys: &'a BTreeMap<&'a str, &'a str>,
}

#[derive(Serialize)]
struct ColumnJson {
    name: &'static str,
    kind: &'static str,
    unit: &'static str,
    nullable: bool,
    description: &'static str,
    source: &'static str,
}

fn table_json(table: &Table) -> TableJson {
    TableJson {
        table: table.name,
        version: table.version,
        file: table.file,
        description: table.doc,
        columns: table
            .columns
            .iter()
            .map(|column| ColumnJson {
                name: column.name,
                kind: column.kind.word(),
                unit: column.unit,
                nullable: column.nullable,
                description: column.doc,
                source: column.source,
            })
            .collect(),
    }
}

/// The names in [`metadata_json`] that are the schema's own.
pub const OWN_KEYS: [&str; 5] = ["table", "version", "file", "description", "columns"];

/// The schema of a table as one line of JSON with further keys beside it: what each data file carries with it.
///
/// The order of everything in it is fixed by the types, not by the JSON library, whose maps sort or do not sort
/// depending on what else is built with it.
#[must_use]
pub fn metadata_json(table: &Table, keys: &BTreeMap<&str, &str>) -> String {
    let all = WithKeys { table: table_json(table), keys };
    // Strings, integers and truth values always serialize, so nothing is lost by the default.
    serde_json::to_string(&all).unwrap_or_default()
}

/// The schema of a table as indented JSON with a final newline, the same at every call.
#[must_use]
pub fn schema_json(table: &Table) -> String {
    // Strings, integers and truth values always serialize, so nothing is lost by the default.
    let mut json = serde_json::to_string_pretty(&table_json(table)).unwrap_or_default();
    json.push('\n');
    json
}

/// The name of a table's schema file: `<name>.v<version>.json`.
#[must_use]
pub fn schema_file_name(table: &Table) -> String {
    format!("{}.v{}.json", table.name, table.version)
}

/// The columns of a table as a Markdown table.
#[must_use]
pub fn readme_markdown(table: &Table) -> String {
    let mut page = format!(
        "### `{}`, version {}\n\n`{}`. {}\n\n| column | kind | unit | null | meaning | source |\n|---|---|---|---|---|---|\n",
        table.name, table.version, table.file, table.doc
    );
    for column in table.columns {
        let cells = [
            format!("`{}`", column.name),
            column.kind.word().to_owned(),
            column.unit.to_owned(),
            if column.nullable { "yes".to_owned() } else { String::new() },
            column.doc.replace('|', "\\|"),
            column.source.to_owned(),
        ];
        page.push_str("| ");
        page.push_str(&cells.join(" | "));
        page.push_str(" |\n");
    }
    page
}

/// Every file that belongs below [`DIRECTORY`].
#[must_use]
pub fn files() -> Vec<SchemaFile> {
    let mut all: Vec<SchemaFile> =
        TABLES.iter().map(|table| SchemaFile { name: schema_file_name(table), content: schema_json(table) }).collect();
    let pages: Vec<String> = TABLES.iter().map(|table| readme_markdown(table)).collect();
    all.push(SchemaFile {
        name: "README.md".to_owned(),
        content: format!(
            "# Tables\n\nWritten by `hysteron schema --write` from `src/schema/`; do not edit. Sources such as \"Eq 2\" are \
             equations of Violano and Afferrante, Lubricants 9(1):7, 2021. Missing is null, never 0.\n\n{}",
            pages.join("\n")
        ),
    });
    all
}
