//! From a frame to the bytes of a file.

use std::collections::BTreeMap;
use std::fs::File;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use ::parquet::arrow::ArrowWriter;
use ::parquet::basic::{Compression, ZstdLevel};
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties};
use ::parquet::schema::types::ColumnPath;
use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{Field, Schema};

use crate::schema::{Kind, OWN_KEYS, Table, metadata_json};

use super::super::error::Cause;
use super::super::frame::{ColumnData, Frame};
use super::{METADATA_KEY, data_type};

/// Rows of a row group: some megabytes, so that a reader can skip and a writer stays small.
const ROW_GROUP: usize = 1 << 17;

/// The Arrow schema of a table: unit, description and source at every field, and the file-level metadata once
/// more for readers of the Arrow schema.
fn arrow_schema(table: &Table, own: &str) -> Arc<Schema> {
    let fields: Vec<Field> = table
        .columns
        .iter()
        .map(|column| {
            let known = [("unit", column.unit), ("description", column.doc), ("source", column.source)];
            let known: BTreeMap<String, String> = known
                .into_iter()
                .filter(|(_, value)| !value.is_empty())
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .collect();
            Field::new(column.name, data_type(column.kind), column.nullable).with_metadata(known)
        })
        .collect();
    Arc::new(Schema::new_with_metadata(fields, [(METADATA_KEY.to_owned(), own.to_owned())]))
}

fn own_json(table: &Table, keys: &[(&str, String)]) -> Result<String, Cause> {
    let mut given = BTreeMap::new();
    for (name, value) in keys {
        if OWN_KEYS.contains(name) || given.insert(*name, value.as_str()).is_some() {
            return Err(format!("the metadata key {name:?} was given twice or belongs to the schema").into());
        }
    }
    Ok(metadata_json(table, &given))
}

fn writer_properties(table: &Table, own: String) -> Result<WriterProperties, Cause> {
    let mut properties = WriterProperties::builder()
        // The same text in files of all versions: the provenance record has the version, not the data.
        .set_created_by("hysteron".to_owned())
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        .set_max_row_group_row_count(Some(ROW_GROUP))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(vec![KeyValue::new(METADATA_KEY.to_owned(), own)]));
    for column in table.columns.iter().filter(|column| column.kind == Kind::F64) {
        // Real numbers hardly repeat: a dictionary of them is larger than they are.
        properties = properties.set_column_dictionary_enabled(ColumnPath::from(column.name), false);
    }
    Ok(properties.build())
}

/// A table that is being written.
struct Writer {
    schema: Arc<Schema>,
    writer: ArrowWriter<File>,
}

impl Writer {
    /// Begins the file at `path`, which is there already.
    fn begin(path: &Path, table: &Table, keys: &[(&str, String)]) -> Result<Self, Cause> {
        let own = own_json(table, keys)?;
        let schema = arrow_schema(table, &own);
        let properties = writer_properties(table, own)?;
        let file = File::options().write(true).open(path)?;
        let writer = ArrowWriter::try_new(file, Arc::clone(&schema), Some(properties))?;
        Ok(Self { schema, writer })
    }

    /// Adds the rows of a frame.
    fn add(&mut self, frame: &Frame) -> Result<(), Cause> {
        // Batch by batch: a column of repeated identities is large in memory, though not in the file.
        for first in (0..frame.row_count().max(1)).step_by(ROW_GROUP) {
            let rows = first..frame.row_count().min(first + ROW_GROUP);
            let arrays = frame.columns().map(|(_, data)| array(data, rows.clone())).collect();
            self.writer.write(&RecordBatch::try_new(Arc::clone(&self.schema), arrays)?)?;
        }
        Ok(())
    }
}

/// Writes a frame into the file at `path`, which is there already.
pub(super) fn rows(path: &Path, frame: &Frame, keys: &[(&str, String)]) -> Result<(), Cause> {
    let mut writer = Writer::begin(path, frame.table(), keys)?;
    writer.add(frame)?;
    writer.writer.close()?;
    Ok(())
}

/// Writes the parts of a table into the file at `path`, which is there already; gives the number of rows. At
/// most one part and one row group are in memory.
pub(super) fn parts(
    path: &Path,
    table: &Table,
    parts: impl Iterator<Item = Result<Frame, Cause>>,
    keys: &[(&str, String)],
) -> Result<usize, Cause> {
    let mut writer = Writer::begin(path, table, keys)?;
    let mut count = 0;
    for part in parts {
        let part = part?;
        writer.add(&part)?;
        count += part.row_count();
    }
    writer.writer.close()?;
    Ok(count)
}

/// These rows of a column.
fn array(data: &ColumnData, rows: Range<usize>) -> ArrayRef {
    match data {
        ColumnData::F64(values) => Arc::new(Float64Array::from(values[rows].to_vec())),
        ColumnData::I64(values) => Arc::new(Int64Array::from(values[rows].to_vec())),
        ColumnData::Bool(values) => Arc::new(BooleanArray::from(values[rows].to_vec())),
        ColumnData::Text(values) => {
            Arc::new(values[rows].iter().map(Option::as_deref).collect::<StringArray>())
        }
    }
}
