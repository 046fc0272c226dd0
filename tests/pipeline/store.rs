//! Files: what is written is read back, what is damaged is refused with a sentence, and nothing is ever half there.

mod commit;
mod frames;
mod halfway;
mod surfaces;
mod tables;

use std::fs;
use std::path::Path;

use hysteron::schema::{Kind, Table};
use hysteron::store::{ColumnData, Frame};

/// A table with nulls wherever they may be, and values that are awkward to store.
fn sample(table: &'static Table, rows: usize) -> Frame {
    let real = [0.0, -0.0, 1.0 / 3.0, -1.5e-300, f64::MAX, f64::MIN_POSITIVE, 5e-324, 0.0071];
    let word = ["loading", "unloading", "", "Δγ ≥ 0 µm", "with \"quotes\", and\nlines"];
    table
        .columns
        .iter()
        .enumerate()
        .fold(Frame::of(table), |builder, (at, column)| {
            let there = |row: usize| !column.nullable || !(row + at).is_multiple_of(3);
            let rows = 0..rows;
            let data = match column.kind {
                Kind::F64 => {
                    ColumnData::F64(rows.map(|row| there(row).then(|| real[(row * 7 + at) % real.len()] / (1 + row / 8) as f64)).collect())
                }
                Kind::I64 => {
                    ColumnData::I64(rows.map(|row| there(row).then(|| [i64::MAX, i64::MIN, row as i64][(row + at) % 3])).collect())
                }
                Kind::Bool => ColumnData::Bool(rows.map(|row| there(row).then_some((row + at) % 5 < 2)).collect()),
                Kind::Text => ColumnData::Text(rows.map(|row| there(row).then(|| word[(row + at) % word.len()].to_owned())).collect()),
            };
            builder.with(column.name, data)
        })
        .build()
        .unwrap()
}

/// The names in a directory, in order.
fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Asserts that a message is one sentence that names the file and says this.
fn says(message: &str, path: &Path, parts: &[&str]) {
    assert!(message.starts_with("cannot "), "{message}");
    assert!(message.contains(&path.display().to_string()), "{message}");
    for part in parts {
        assert!(message.contains(part), "{message:?} lacks {part:?}");
    }
}
