//! `export csv`: the tables of statistics, and on request of cycles, as comma-separated values (RFC 4180).

use super::outputs::{may_replace, undamaged, written};
use super::place::folder_of;
use super::{Fault, failed, make_folder, say};
use crate::campaign::owned::run_around;
use crate::cli::CsvArguments;
use crate::schema::{COMPARISON, TABLES, Table};
use crate::store::{ColumnData, Frame, parquet};
use crate::text::{counted, shown};
use serde_json::json;
use std::borrow::Cow;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

pub(super) fn export(asked: &CsvArguments) -> Result<u8, Fault> {
    let dir = folder_of(&asked.dir)?;
    let out = asked.out.clone().unwrap_or_else(|| dir.join("csv"));
    let tables: Vec<&'static Table> = TABLES.iter().copied().filter(|table| has(&dir, table)).collect();
    if tables.is_empty() {
        let dir = shown(&dir);
        return Err(failed(format!(
            "cannot export the tables of {dir}: it has no statistics/*.parquet and no comparison.parquet\n\
             help: run `hysteron run SPEC` first, or name the folder of a comparison"
        )));
    }
    let mut wanted: Vec<(PathBuf, &'static Table)> =
        tables.into_iter().map(|table| (PathBuf::from(table.file), table)).collect();
    if asked.cycles {
        wanted.extend(of_cycles(&dir)?);
    }
    if let Some(run) = run_around(&out.join("cases.csv")) {
        let (out, run) = (shown(&out), shown(&run));
        return Err(failed(format!(
            "cannot write the tables to {out}: only `hysteron run` writes there, in {run}\nhelp: use another \
             --out"
        )));
    }
    let (mut files, mut contents) = (Vec::new(), Vec::new());
    for (file, table) in wanted {
        undamaged("export the tables of", &dir, &file.to_string_lossy().replace('\\', "/"))?;
        let frame = parquet::read_table(&dir.join(&file), table).map_err(failed)?;
        let path = out.join(file.strip_prefix("statistics").unwrap_or(&file).with_extension("csv"));
        contents.push((path.clone(), text(&frame).into_bytes()));
        files.push((path, frame.row_count()));
    }
    may_replace("the table", &contents, asked.force)?;
    for (path, _) in &contents {
        path.parent().map_or(Ok(()), make_folder)?;
    }
    written("write the table", &contents)?;
    if asked.json {
        let files: Vec<_> = files
            .iter()
            .map(|(path, rows)| json!({ "file": path.display().to_string(), "row_count": rows }))
            .collect();
        say(&format!("{:#}\n", json!({ "files": files })))?;
        return Ok(0);
    }
    for (path, rows) in &files {
        say(&format!("Written: {}, {}\n", shown(path), counted(*rows, "row")))?;
    }
    Ok(0)
}

/// True if a table is one of statistics or that of a comparison, and in the folder.
fn has(dir: &Path, table: &Table) -> bool {
    (table.file.starts_with("statistics/") || table.file == COMPARISON.file) && dir.join(table.file).is_file()
}

/// Folder of the tables of one cycle in the file of a table.
const OF_CYCLE: &str = "cycles/<id>/";

/// The tables of the cycles in a folder, with their files relative to it, in order of the ids.
fn of_cycles(dir: &Path) -> Result<Vec<(PathBuf, &'static Table)>, Fault> {
    let folder = dir.join("cycles");
    let refused = |error: io::Error| failed(format!("cannot list {}: {error}", shown(&folder)));
    let mut ids = Vec::new();
    // A run whose cycles have all failed has no such folder.
    for entry in if folder.is_dir() { Some(fs::read_dir(&folder).map_err(refused)?) } else { None }
        .into_iter()
        .flatten()
    {
        ids.push(entry.map_err(refused)?.file_name());
    }
    ids.sort();
    let names =
        || TABLES.iter().filter_map(|table| table.file.strip_prefix(OF_CYCLE).map(|name| (name, *table)));
    let files = ids
        .iter()
        .flat_map(|id| names().map(move |(name, table)| (Path::new("cycles").join(id).join(name), table)));
    Ok(files.filter(|(file, _)| dir.join(file).is_file()).collect())
}

/// A table as CSV: column names, then rows; a null is empty, an empty text is quoted.
fn text(frame: &Frame) -> String {
    let names: Vec<&str> = frame.columns().map(|(column, _)| column.name).collect();
    let mut text = names.join(",") + "\r\n";
    for row in 0..frame.row_count() {
        let cells: Vec<Cow<'_, str>> = frame.columns().map(|(_, data)| cell(data, row)).collect();
        text += &cells.join(",");
        text += "\r\n";
    }
    text
}

fn cell(data: &ColumnData, row: usize) -> Cow<'_, str> {
    let or_empty = |text: Option<String>| Cow::from(text.unwrap_or_default());
    match data {
        // The shortest form that reads back to the same number.
        ColumnData::F64(values) => or_empty(values[row].map(|number| format!("{number:?}"))),
        ColumnData::I64(values) => or_empty(values[row].map(|number| number.to_string())),
        ColumnData::Bool(values) => or_empty(values[row].map(|flag| flag.to_string().to_uppercase())),
        ColumnData::Text(values) => match values[row].as_deref() {
            None => Cow::from(""),
            Some(word) if word.is_empty() || word.contains([',', '"', '\r', '\n']) => {
                Cow::from(format!("\"{}\"", word.replace('"', "\"\"")))
            }
            Some(word) => Cow::from(word),
        },
    }
}
