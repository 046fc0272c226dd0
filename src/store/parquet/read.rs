//! From the bytes of a file to a frame, or to what is wrong with them.

use std::fs::File;
use std::path::Path;

use ::parquet::arrow::arrow_reader::{ArrowReaderOptions, ParquetRecordBatchReaderBuilder};
use ::parquet::file::metadata::ParquetMetaData;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef};
use arrow_schema::Schema;
use serde_json::Value;

use crate::schema::{Kind, Table};

use super::super::error::{Cause, fenced};
use super::super::frame::{ColumnData, Frame};
use super::{METADATA_KEY, data_type};

/// More rows than any table of this program has. A file with more is damaged, and is refused before memory is
/// allocated.
const MOST_ROWS: i64 = 1 << 31;
/// More bytes than any table of this program has when unpacked.
const MOST_BYTES: i64 = 1 << 36;

/// A key of the file-level metadata other than the schema.
pub(super) fn metadata(path: &Path, name: &str) -> Result<Option<String>, Cause> {
    let file = File::open(path)?;
    fenced(|| {
        let reader = ParquetRecordBatchReaderBuilder::try_new_with_options(file, reader_options())?;
        let own = own_metadata(reader.metadata())?;
        Ok(own.get(name).and_then(Value::as_str).map(str::to_owned))
    })
}

/// Types as Parquet has them: a file is judged by its columns, not by what it says of them for Arrow.
fn reader_options() -> ArrowReaderOptions {
    ArrowReaderOptions::new().with_skip_arrow_metadata(true)
}

/// The rows of a table, if the file fits its schema.
pub(super) fn rows(path: &Path, table: &'static Table) -> Result<Frame, Cause> {
    let file = File::open(path)?;
    fenced(|| {
        let reader = ParquetRecordBatchReaderBuilder::try_new_with_options(file, reader_options())?;
        check_identity(table, &own_metadata(reader.metadata())?)?;
        check_columns(table, reader.schema())?;
        let claimed = check_size(reader.metadata())?;
        let present: Vec<bool> =
            table.columns.iter().map(|column| reader.schema().field_with_name(column.name).is_ok()).collect();
        let mut columns: Vec<ColumnData> = table.columns.iter().map(|column| empty(column.kind)).collect();
        for batch in reader.build()? {
            let batch = batch?;
            let written =
                columns.iter_mut().zip(&present).filter(|(_, present)| **present).map(|(data, _)| data);
            for (data, array) in written.zip(batch.columns()) {
                append(data, array)?;
            }
        }
        let rows = usize::try_from(claimed)?;
        columns
            .iter_mut()
            .zip(&present)
            .filter(|(_, present)| !**present)
            .for_each(|(data, _)| fill(data, rows));
        let mut builder = Frame::of(table);
        for (column, data) in table.columns.iter().zip(columns) {
            builder = builder.with(column.name, data);
        }
        let frame = builder.build()?;
        if i64::try_from(frame.row_count()).is_ok_and(|read| read == claimed) {
            Ok(frame)
        } else {
            Err(format!("{} rows instead of the claimed {claimed}", frame.row_count()).into())
        }
    })
}

/// Number of rows of a table whose file fits its schema; every row is decoded, and none is kept.
pub(super) fn row_count(path: &Path, table: &'static Table) -> Result<usize, Cause> {
    let file = File::open(path)?;
    fenced(|| {
        let reader = ParquetRecordBatchReaderBuilder::try_new_with_options(file, reader_options())?;
        check_identity(table, &own_metadata(reader.metadata())?)?;
        check_columns(table, reader.schema())?;
        check_size(reader.metadata())?;
        let mut count = 0;
        for batch in reader.build()? {
            count += batch?.num_rows();
        }
        Ok(count)
    })
}

fn own_metadata(metadata: &ParquetMetaData) -> Result<Value, Cause> {
    let text = metadata
        .file_metadata()
        .key_value_metadata()
        .and_then(|all| all.iter().find(|entry| entry.key == METADATA_KEY))
        .and_then(|entry| entry.value.as_deref())
        .ok_or_else(|| format!("not a table of hysteron: no metadata key {METADATA_KEY:?}"))?;
    Ok(serde_json::from_str(text)?)
}

fn check_identity(table: &Table, own: &Value) -> Result<(), Cause> {
    let name = own.get("table").and_then(Value::as_str).unwrap_or_default();
    if name != table.name {
        return Err(format!("the file contains the table {name:?}").into());
    }
    let version = own.get("version").and_then(Value::as_u64);
    if version == Some(u64::from(table.version)) {
        return Ok(());
    }
    let version = version.map_or("no version".to_owned(), |number| format!("version {number}"));
    Err(format!("{version} of this table; this program reads version {}", table.version).into())
}

fn check_columns(table: &Table, found: &Schema) -> Result<(), Cause> {
    for column in table.columns {
        let Ok(field) = found.field_with_name(column.name) else {
            // Columns that were added later are null in earlier tables.
            if column.nullable {
                continue;
            }
            return Err(format!("no column {:?}", column.name).into());
        };
        if *field.data_type() != data_type(column.kind) {
            let (name, kind) = (column.name, column.kind.word());
            return Err(format!("its column {name:?} holds {}, not {kind}", field.data_type()).into());
        }
    }
    let strange = found.fields().iter().find(|field| table.column(field.name()).is_none());
    if let Some(field) = strange {
        return Err(format!("unknown column {:?} in version {}", field.name(), table.version).into());
    }
    let mut known = table.columns.iter();
    if found.fields().iter().all(|field| known.any(|column| column.name == field.name())) {
        Ok(())
    } else {
        Err("its columns are repeated or in another order".into())
    }
}

/// The rows that the footer promises, if neither they nor their bytes are beyond reason.
fn check_size(metadata: &ParquetMetaData) -> Result<i64, Cause> {
    let rows = metadata.file_metadata().num_rows();
    let groups = metadata.row_groups();
    let bytes = groups.iter().try_fold(0_i64, |sum, group| sum.checked_add(group.total_byte_size()));
    if (0..=MOST_ROWS).contains(&rows) && bytes.is_some_and(|bytes| (0..=MOST_BYTES).contains(&bytes)) {
        Ok(rows)
    } else {
        Err(format!("claims {rows} rows, more than any such table").into())
    }
}

fn empty(kind: Kind) -> ColumnData {
    match kind {
        Kind::F64 => ColumnData::F64(Vec::new()),
        Kind::I64 => ColumnData::I64(Vec::new()),
        Kind::Bool => ColumnData::Bool(Vec::new()),
        Kind::Text => ColumnData::Text(Vec::new()),
    }
}

/// A column without values.
fn fill(data: &mut ColumnData, rows: usize) {
    match data {
        ColumnData::F64(values) => values.resize(rows, None),
        ColumnData::I64(values) => values.resize(rows, None),
        ColumnData::Bool(values) => values.resize(rows, None),
        ColumnData::Text(values) => values.resize(rows, None),
    }
}

fn append(data: &mut ColumnData, array: &ArrayRef) -> Result<(), Cause> {
    let unexpected = || format!("a column holds {}", array.data_type());
    match data {
        ColumnData::F64(values) => {
            values.extend(array.as_primitive_opt::<Float64Type>().ok_or_else(unexpected)?.iter());
        }
        ColumnData::I64(values) => {
            values.extend(array.as_primitive_opt::<Int64Type>().ok_or_else(unexpected)?.iter());
        }
        ColumnData::Bool(values) => {
            values.extend(array.as_boolean_opt().ok_or_else(unexpected)?.iter());
        }
        ColumnData::Text(values) => {
            let words = array.as_string_opt::<i32>().ok_or_else(unexpected)?;
            values.extend(words.iter().map(|word| word.map(str::to_owned)));
        }
    }
    Ok(())
}
