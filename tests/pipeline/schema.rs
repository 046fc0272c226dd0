//! The schemas: consistent in themselves, and the files made from them up to date.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use hysteron::schema::{
    ASPERITIES, AVALANCHES, CASES, CYCLES, Column, DIRECTORY, EVENT_KINDS, Kind, POOLED_EVENTS, REALIZATIONS, TABLES, Table, files,
    metadata_json, readme_markdown, schema_json,
};
use hysteron::spec::{SCHEMA_FILE, json_schema};

/// The unit that a column's name promises: suffixes from the longest, as the contract has them.
fn promised(name: &str) -> &'static str {
    let stem = ["_mean", "_sd", "_ci95_low", "_ci95_high"].iter().find_map(|end| name.strip_suffix(end)).unwrap_or(name);
    [
        ("_j_m2", "J/m^2"),
        ("_n_m", "N/m"),
        ("_m_n", "m/N"),
        ("_1_m2", "1/m^2"),
        ("_1_m", "1/m"),
        ("_m2", "m^2"),
        ("_m4", "m^4"),
        ("_pa", "Pa"),
        ("_m", "m"),
        ("_n", "N"),
        ("_j", "J"),
        ("_deg", "deg"),
        ("_s", "s"),
    ]
    .iter()
    .find(|(end, _)| stem.ends_with(end))
    .map_or("1", |(_, unit)| unit)
}

#[test]
fn law_names_and_units_agree() {
    for table in TABLES {
        for column in table.columns {
            let place = format!("{}.{}", table.name, column.name);
            match column.kind {
                Kind::F64 => assert_eq!(column.unit, promised(column.name), "{place}"),
                Kind::I64 if column.name.contains("_count") => {
                    assert_eq!(column.unit, "1", "{place}");
                }
                Kind::I64 | Kind::Bool | Kind::Text => assert_eq!(column.unit, "", "{place}"),
            }
        }
    }
}

#[test]
fn law_names_are_unique_plain_words_and_documented() {
    let names: BTreeSet<_> = TABLES.iter().map(|table| table.name).collect();
    assert_eq!(names.len(), TABLES.len());
    for table in TABLES {
        assert!(table.version >= 1 && table.doc.ends_with('.'), "{}", table.name);
        let mut seen = BTreeSet::new();
        for column in table.columns {
            let place = format!("{}.{}", table.name, column.name);
            assert!(seen.insert(column.name), "{place} is there twice");
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            assert!(!column.name.is_empty() && column.name.chars().all(plain), "{place}");
            assert!(column.doc.len() > 3 && !column.doc.ends_with('.'), "{place}: {}", column.doc);
            assert_eq!(table.column(column.name), Some(column));
        }
        assert_eq!(table.column("no such column"), None);
    }
}

/// Seven results, six of them in SI units and nine of a probe, nine numbers of theories, and what the events lost; its two branches and every kind of event; what tells how far to trust the row; the numbers of surfaces behind four works. The losses are
/// there in both units.
#[test]
fn val_cases_have_statistics_of_every_result() {
    assert_eq!(CASES.columns.len(), 2 + 48 + 3 + (12 + 15 + 6) * 4 + (2 + EVENT_KINDS.len()) * 2 * 4 + 24 * 2 + 4 + 9 + 8);
}

/// Columns by which tables are joined.
#[test]
fn law_every_table_names_what_its_rows_belong_to() {
    let has = |table: &Table, names: &[&str]| names.iter().for_each(|name| assert!(table.column(name).is_some(), "{}.{name}", table.name));
    for table in TABLES.iter().filter(|table| table.file.starts_with("cycles/")) {
        has(table, &["cycle_id", "case_id", "realization"]);
    }
    for table in [&REALIZATIONS, &AVALANCHES, &POOLED_EVENTS, &CYCLES] {
        has(table, &["cycle_id", "case_id", "realization", "surface_id", "asperities_id"]);
    }
    has(&ASPERITIES, &["surface_id", "realization", "asperity_id"]);
    // A cycle has the parameters of its case, under the same names and of the same kind.
    let is_result = |column: &Column| column.name.starts_with("max_load") || column.name.ends_with("_grid_error");
    let parameters = REALIZATIONS.columns.iter().filter(|column| CASES.columns.contains(column) && !is_result(column));
    let mut count = 0;
    for column in parameters {
        assert_eq!(CYCLES.column(column.name), Some(column));
        count += 1;
    }
    assert_eq!(count, 2 + 45);
}

#[test]
fn law_every_kind_of_event_has_its_columns() {
    for kind in EVENT_KINDS {
        assert!(AVALANCHES.column(&format!("{kind}_count")).is_some(), "{kind}");
        for unit in ["", "_j"] {
            assert!(REALIZATIONS.column(&format!("dissipated_{kind}{unit}")).is_some(), "{kind}");
            assert!(CASES.column(&format!("dissipated_{kind}{unit}_mean")).is_some(), "{kind}");
        }
    }
}

#[test]
fn law_json_says_all_that_the_schema_says() {
    for table in TABLES {
        let text = schema_json(table);
        assert_eq!(text, schema_json(table));
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(json["table"], table.name);
        assert_eq!(json["version"], table.version);
        let columns = json["columns"].as_array().unwrap();
        assert_eq!(columns.len(), table.columns.len());
        for (found, column) in columns.iter().zip(table.columns) {
            assert_eq!(found["name"], column.name);
            assert_eq!(found["kind"], column.kind.word());
            assert_eq!(found["unit"], column.unit);
            assert_eq!(found["nullable"], column.nullable);
            assert_eq!(found["description"], column.doc);
            assert_eq!(found["source"], column.source);
        }
        let keys = BTreeMap::from([("key", "0a\"1"), ("program", "hysteron")]);
        let carried: serde_json::Value = serde_json::from_str(&metadata_json(table, &keys)).unwrap();
        assert_eq!(carried["columns"], json["columns"]);
        assert_eq!(carried["key"], "0a\"1");
    }
}

#[test]
fn law_markdown_has_a_row_for_every_column() {
    for table in TABLES {
        let page = readme_markdown(table);
        let rows: Vec<_> = page.lines().filter(|line| line.starts_with("| `")).collect();
        assert_eq!(rows.len(), table.columns.len());
        for (row, column) in rows.iter().zip(table.columns) {
            assert!(row.starts_with(&format!("| `{}` | ", column.name)));
            assert_eq!(row.replace("\\|", "").matches('|').count(), 7, "{row}");
        }
    }
}

#[test]
fn e2e_schema_files_are_up_to_date() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join(DIRECTORY);
    let mut expected: BTreeMap<_, _> = files().into_iter().map(|file| (file.name, file.content)).collect();
    expected.insert(SCHEMA_FILE.to_owned(), json_schema());
    let mut wrong = Vec::new();
    for (name, content) in &expected {
        if fs::read_to_string(directory.join(name)).ok().as_ref() != Some(content) {
            wrong.push(name.clone());
        }
    }
    for entry in fs::read_dir(&directory).into_iter().flatten() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        // Schemas of earlier versions stay, for the files that were written with them.
        let earlier = TABLES.iter().any(|table| (1..table.version).any(|version| name == format!("{}.v{version}.json", table.name)));
        if !expected.contains_key(&name) && !earlier {
            wrong.push(name);
        }
    }
    assert!(
        wrong.is_empty(),
        "schemas/ differs from src/schema/ in {}; to renew it: cargo run --release -- schema --write",
        wrong.join(", ")
    );
}
