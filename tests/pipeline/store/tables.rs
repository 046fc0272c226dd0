//! Tables in Parquet.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use hysteron::schema::{ASPERITIES, CONTACTS, CURVES, Kind, STEPS, TABLES, Table};
use hysteron::store::Frame;
use hysteron::store::parquet::{METADATA_KEY, read_key, read_metadata, read_table, write_table};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::statistics::Statistics;
use tempfile::{TempDir, tempdir};

use super::{names, sample, says};

fn written(frame: &Frame) -> (TempDir, PathBuf) {
    let directory = tempdir().unwrap();
    let path = directory.path().join(format!("{}.parquet", frame.table().name));
    write_table(&path, frame, &[("key", "0123abcd".to_owned())]).unwrap();
    (directory, path)
}

#[test]
fn e2e_every_table_comes_back_bit_by_bit() {
    for table in TABLES {
        for rows in [0, 1, 37] {
            let frame = sample(table, rows);
            let (directory, path) = written(&frame);
            let back = read_table(&path, table).unwrap();
            assert_eq!(back, frame, "{}", table.name);
            for column in table.columns.iter().filter(|column| frame.f64_or_null(column.name).is_ok()) {
                let bits = |frame: &Frame| -> Vec<_> {
                    let values = frame.f64_or_null(column.name).unwrap();
                    values.iter().map(|value| value.map(f64::to_bits)).collect()
                };
                assert_eq!(bits(&back), bits(&frame), "{}.{}", table.name, column.name);
            }
            assert_eq!(names(directory.path()).len(), 1);
        }
    }
}

#[test]
fn e2e_a_table_of_several_row_groups_comes_back() {
    let rows = 300_000;
    let at = |row: usize| row as f64 * 1e-9;
    let frame = Frame::of(&CONTACTS)
        .text("cycle_id", vec!["H0.80_z256_r00-0123abcd"; rows])
        .text("case_id", vec!["H0.80_z256-0123abcd"; rows])
        .i64("realization", vec![0; rows])
        .count("step", (0..rows).map(|row| row / 700))
        .text("branch", (0..rows).map(|row| if row < 9 { "loading" } else { "unloading" }))
        .f64("max_load", (0..rows).map(|row| (row % 2 == 0).then_some(0.0071)))
        .count("asperity_id", (0..rows).map(|row| row % 700))
        .text("state", (0..rows).map(|_| "contact"))
        .f64("contact_radius_m", (0..rows).map(at))
        .f64("load_n", (0..rows).map(at))
        .f64("penetration_m", (0..rows).map(at))
        .f64("interaction_m", (0..rows).map(at))
        .text("method", vec!["asperities"; rows])
        .f64("centroid_x_m", vec![None; rows])
        .f64("centroid_y_m", vec![None; rows])
        .f64("area_m2", vec![None; rows])
        .f64("perimeter_m", vec![None; rows])
        .i64("summit_count", vec![None; rows])
        .build()
        .unwrap();
    let (_directory, path) = written(&frame);
    assert_eq!(read_table(&path, &CONTACTS).unwrap(), frame);
    let reader = ParquetRecordBatchReaderBuilder::try_new(File::open(&path).unwrap()).unwrap();
    assert_eq!(reader.metadata().num_row_groups(), 3);
    // Steps ascend, so that what each group says of its steps lets a reader of one step pass the others by.
    let bounds: Vec<[i64; 2]> = reader
        .metadata()
        .row_groups()
        .iter()
        .map(|group| match group.column(3).statistics() {
            Some(Statistics::Int64(steps)) => [*steps.min_opt().unwrap(), *steps.max_opt().unwrap()],
            other => panic!("{other:?}"),
        })
        .collect();
    // A column with one value is a dictionary of one entry, and one run per page.
    for group in reader.metadata().row_groups() {
        let identities: i64 = (0..3).map(|column| group.column(column).compressed_size()).sum();
        assert!(identities * 2000 < group.compressed_size(), "{identities} of {} bytes", group.compressed_size());
    }
    assert_eq!((bounds[0][0], bounds[2][1]), (0, (rows as i64 - 1) / 700));
    assert!(bounds.windows(2).all(|pair| pair[0][1] <= pair[1][0]), "{bounds:?}");
}

#[test]
fn e2e_equal_tables_are_equal_bytes() {
    for table in TABLES {
        let (_one, first) = written(&sample(table, 50));
        let (_other, second) = written(&sample(table, 50));
        assert_eq!(fs::read(first).unwrap(), fs::read(second).unwrap(), "{}", table.name);
    }
}

#[test]
fn e2e_units_meanings_and_sources_travel_with_the_file() {
    for table in TABLES {
        let (_directory, path) = written(&sample(table, 4));
        let reader = ParquetRecordBatchReaderBuilder::try_new(File::open(&path).unwrap()).unwrap();
        for (field, column) in reader.schema().fields().iter().zip(table.columns) {
            let note = |name| field.metadata().get(name).map_or("", |text| text.as_str());
            assert_eq!(field.name(), column.name);
            assert_eq!(field.is_nullable(), column.nullable);
            assert_eq!(note("unit"), column.unit);
            assert_eq!(note("description"), column.doc);
            assert_eq!(note("source"), column.source);
        }
        let file = reader.metadata().file_metadata();
        assert_eq!(file.created_by(), Some("hysteron"));
        let own = file.key_value_metadata().unwrap().iter().find(|entry| entry.key == METADATA_KEY);
        let own = own.unwrap().value.as_deref().unwrap();
        // Readers of the Arrow schema see the same.
        assert_eq!(reader.schema().metadata().get(METADATA_KEY).map(|text| text.as_str()), Some(own));
        let own: serde_json::Value = serde_json::from_str(own).unwrap();
        assert_eq!(own["table"], table.name);
        assert_eq!(own["key"], "0123abcd");
        assert_eq!(own["columns"][0]["description"], table.columns[0].doc);
        assert_eq!(read_key(&path).unwrap().as_deref(), Some("0123abcd"));
        assert_eq!(read_metadata(&path, "seed").unwrap(), None);
    }
}

#[test]
fn law_a_metadata_key_is_given_once_and_is_not_the_schemas_own() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("steps.parquet");
    let frame = sample(&STEPS, 2);
    for keys in [vec!["columns"], vec!["key", "key"], vec!["version"]] {
        let keys: Vec<_> = keys.into_iter().map(|name| (name, "x".to_owned())).collect();
        let message = write_table(&path, &frame, &keys).unwrap_err().to_string();
        says(&message, &path, &["the metadata key", "given twice or belongs to the schema"]);
    }
    assert!(names(directory.path()).is_empty());
}

#[test]
fn e2e_every_truncation_is_refused() {
    let (directory, path) = written(&sample(&CONTACTS, 5));
    let whole = fs::read(&path).unwrap();
    let short = directory.path().join("short.parquet");
    for length in 0..whole.len() {
        fs::write(&short, &whole[..length]).unwrap();
        let message = read_table(&short, &CONTACTS).unwrap_err().to_string();
        says(&message, &short, &["cannot read the table contacts from"]);
        assert!(length % 16 != 0 || read_key(&short).is_err(), "{length} of {}", whole.len());
    }
}

/// A changed byte gives an error or a table, never a panic; what a table then holds only a content hash can tell.
#[test]
fn e2e_no_changed_byte_ends_the_program() {
    let (directory, path) = written(&sample(&CONTACTS, 5));
    let whole = fs::read(&path).unwrap();
    let other = directory.path().join("other.parquet");
    for at in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[at] ^= [0x01, 0x80, 0xff][at % 3];
        fs::write(&other, &bytes).unwrap();
        let _ = read_table(&other, &CONTACTS);
    }
}

/// A file with these columns that says it is this table.
fn foreign(path: &Path, own: Option<String>, columns: Vec<(&str, ArrayRef)>) {
    let batch = RecordBatch::try_from_iter(columns).unwrap();
    let notes = own.map(|text| vec![KeyValue::new(METADATA_KEY.to_owned(), text)]);
    let properties = WriterProperties::builder().set_key_value_metadata(notes).build();
    let mut writer = ArrowWriter::try_new(File::create(path).unwrap(), batch.schema(), Some(properties)).unwrap();
    writer.write(&batch).unwrap();
    writer.close().unwrap();
}

fn identity(table: &Table, version: u32) -> String {
    format!("{{\"table\":\"{}\",\"version\":{version}}}", table.name)
}

#[test]
fn e2e_another_table_is_told_from_this_one() {
    let (directory, path) = written(&sample(&STEPS, 3));
    says(
        &read_table(&path, &CURVES).unwrap_err().to_string(),
        &path,
        &["cannot read the table curves from", "the file contains the table \"steps\""],
    );
    let reals = || Arc::new(Float64Array::from(vec![1.0])) as ArrayRef;
    let whole = || Arc::new(Int64Array::from(vec![1])) as ArrayRef;
    let message = |own: Option<String>, columns: Vec<(&str, ArrayRef)>| {
        let path = directory.path().join("foreign.parquet");
        foreign(&path, own, columns);
        let error = read_table(&path, &ASPERITIES).unwrap_err().to_string();
        says(&error, &path, &["cannot read the table asperities from"]);
        error
    };
    let good = || Some(identity(&ASPERITIES, 1));
    assert!(message(None, vec![("x_m", reals())]).contains("not a table of hysteron: no metadata key \"hysteron\""));
    assert!(message(Some("{".to_owned()), vec![("x_m", reals())]).contains("EOF"));
    assert!(message(Some("[]".to_owned()), vec![("x_m", reals())]).contains("the file contains the table \"\""));
    assert!(
        message(Some(identity(&ASPERITIES, 2)), vec![("x_m", reals())]).contains("version 2 of this table; this program reads version 1")
    );
    assert!(message(good(), vec![("x_m", reals())]).contains("no column \"surface_id\""));
    assert!(message(good(), vec![("surface_id", reals())]).contains("its column \"surface_id\" holds Float64, not text"));
    let all = |last: Option<&'static str>| {
        let mut columns: Vec<(&str, ArrayRef)> = ASPERITIES
            .columns
            .iter()
            .filter(|column| column.name != "refined")
            .map(|column| match column.kind {
                Kind::F64 => (column.name, reals()),
                Kind::Text => (column.name, Arc::new(StringArray::from(vec!["a"])) as ArrayRef),
                _ => (column.name, whole()),
            })
            .collect();
        columns.push(("refined", Arc::new(BooleanArray::from(vec![true]))));
        columns.extend(last.map(|name| (name, reals())));
        columns
    };
    assert!(message(good(), all(Some("mood"))).contains("unknown column \"mood\" in version 1"));
    let mut swapped = all(None);
    swapped.swap(0, 1);
    assert!(message(good(), swapped).contains("its columns are repeated or in another order"));
    let x = ASPERITIES.columns.iter().position(|column| column.name == "x_m").unwrap();
    let mut holed = all(None);
    holed[x].1 = Arc::new(Float64Array::from(vec![None]));
    assert!(message(good(), holed).contains("lacks a value in the column \"x_m\", row 0"));
    let mut endless = all(None);
    endless[x].1 = Arc::new(Float64Array::from(vec![f64::NAN]));
    assert!(message(good(), endless).contains("was given NaN in the column \"x_m\", row 0"));
}

#[test]
fn e2e_what_is_no_parquet_file_is_refused() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.parquet");
    says(&read_table(&path, &STEPS).unwrap_err().to_string(), &path, &["No such file"]);
    fs::write(&path, "not a table, whatever its name says").unwrap();
    says(&read_table(&path, &STEPS).unwrap_err().to_string(), &path, &["cannot read the table steps from"]);
    let error = read_table(directory.path(), &STEPS).unwrap_err();
    says(&error.to_string(), directory.path(), &["directory"]);
}

/// Columns that were added to a table later are null in files of earlier versions.
#[test]
fn law_missing_columns_are_null_where_they_may_be() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("steps.parquet");
    let columns = |without: &[&str]| -> Vec<(&str, ArrayRef)> {
        let kept = STEPS.columns.iter().filter(|column| !without.contains(&column.name));
        kept.map(|column| {
            let array: ArrayRef = match column.kind {
                Kind::F64 => Arc::new(Float64Array::from(vec![1.0, 2.0])),
                Kind::I64 => Arc::new(Int64Array::from(vec![1, 2])),
                Kind::Bool => Arc::new(BooleanArray::from(vec![true, false])),
                Kind::Text => Arc::new(StringArray::from(vec!["a", "b"])),
            };
            (column.name, array)
        })
        .collect()
    };
    foreign(&path, Some(identity(&STEPS, STEPS.version)), columns(&["method", "residual", "reversal_load"]));
    let frame = read_table(&path, &STEPS).unwrap();
    assert_eq!(frame.text_or_null("method").unwrap(), [None, None]);
    assert_eq!(frame.f64("load").unwrap(), [1.0, 2.0]);
    // A column that is never null must be there.
    foreign(&path, Some(identity(&STEPS, STEPS.version)), columns(&["load_n"]));
    assert!(read_table(&path, &STEPS).unwrap_err().to_string().contains("no column \"load_n\""));
}
