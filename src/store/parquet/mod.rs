//! Tables in Parquet.

mod read;
mod write;

use std::cell::Cell;
use std::path::Path;

use arrow_schema::DataType;

use crate::schema::{Kind, Table};

use super::commit::{Written, commit};
use super::error::{Cause, StoreError};
use super::frame::Frame;

/// The file-level key under which a table carries its own schema, since Polars, pandas and DuckDB drop that
/// of columns.
pub const METADATA_KEY: &str = "hysteron";
/// Writes a table in place of `path`. `keys` are added to its file-level metadata in addition to the schema,
/// for example `key`.
///
/// # Errors
/// If the file cannot be written whole; what was at `path` is then still there.
pub fn write_table(path: &Path, frame: &Frame, keys: &[(&str, String)]) -> Result<Written, StoreError> {
    let action = format!("write the table {} to", frame.table().name);
    commit(
        &action,
        path,
        |temporary| write::rows(temporary, frame, keys),
        |temporary| {
            if &read::rows(temporary, frame.table())? == frame {
                Ok(())
            } else {
                Err("the content read back differs from the content written".into())
            }
        },
    )
}

/// Writes a table of which one part at a time is in memory in place of `path`. `keys` as of [`write_table`].
///
/// # Errors
/// If a part cannot be made or the file cannot be written whole; what was at `path` is then still there.
pub fn write_parts<E: Into<Cause>>(
    path: &Path,
    table: &'static Table,
    parts: impl IntoIterator<Item = Result<Frame, E>>,
    keys: &[(&str, String)],
) -> Result<Written, StoreError> {
    let written = Cell::new(0);
    commit(
        &format!("write the table {} to", table.name),
        path,
        |temporary| {
            written.set(write::parts(
                temporary,
                table,
                parts.into_iter().map(|part| part.map_err(Into::into)),
                keys,
            )?);
            Ok(())
        },
        |temporary| match read::row_count(temporary, table)? {
            found if found == written.get() => Ok(()),
            found => Err(format!("{found} rows read back instead of {} written", written.get()).into()),
        },
    )
}

/// Reads a table whose file must fit the schema in name, version, columns, kinds and nulls.
///
/// # Errors
/// If the file cannot be read, is damaged, or is another table.
pub fn read_table(path: &Path, table: &'static Table) -> Result<Frame, StoreError> {
    read::rows(path, table)
        .map_err(|cause| StoreError::new(&format!("read the table {} from", table.name), path, cause))
}

/// Reads one of the keys that were given to [`write_table`], if the file has it.
///
/// # Errors
/// If the file cannot be read, is damaged, or is no table of this program.
pub fn read_metadata(path: &Path, name: &str) -> Result<Option<String>, StoreError> {
    read::metadata(path, name).map_err(|cause| StoreError::new("read the metadata of the table", path, cause))
}

/// Reads the key of the unit that wrote the table, if the file has one.
///
/// # Errors
/// As [`read_metadata`].
pub fn read_key(path: &Path) -> Result<Option<String>, StoreError> {
    read_metadata(path, "key")
}

fn data_type(kind: Kind) -> DataType {
    match kind {
        Kind::F64 => DataType::Float64,
        Kind::I64 => DataType::Int64,
        Kind::Bool => DataType::Boolean,
        Kind::Text => DataType::Utf8,
    }
}
