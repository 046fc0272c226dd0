//! Errors of files and tables.

use std::any::Any;
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use crate::text::shown;

/// Any reason for a failure.
pub(super) type Cause = Box<dyn Error + Send + Sync + 'static>;

/// Something that could not be done with a file.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {}: {source}", shown(path))]
pub struct StoreError {
    /// Failed action, as in "write the table steps to".
    pub action: String,
    /// The file.
    pub path: PathBuf,
    /// Why it failed.
    pub source: Cause,
}

impl StoreError {
    pub(super) fn new(action: &str, path: &Path, source: impl Into<Cause>) -> Self {
        Self { action: action.to_owned(), path: path.to_owned(), source: source.into() }
    }
}

/// Something that does not fit the schema of a table.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the table {table} {problem}")]
pub struct FrameError {
    /// Name of the table.
    pub table: &'static str,
    /// Problem, as in "has no column \"a\"".
    pub problem: String,
}

impl FrameError {
    pub(super) fn new(table: &'static str, problem: impl Into<String>) -> Self {
        Self { table, problem: problem.into() }
    }
}

/// Runs code of a library that may panic on a damaged file, and gives the panic as a cause.
///
/// The libraries promise errors, and mostly keep it; a table that someone else damaged must not end the
/// program.
pub(super) fn fenced<T>(work: impl FnOnce() -> Result<T, Cause>) -> Result<T, Cause> {
    caught(work, |panic| format!("the file is damaged ({panic})").into())
}

/// Runs code that may panic, and gives the panic as an error, made from its message.
pub(crate) fn caught<T, E>(
    work: impl FnOnce() -> Result<T, E>,
    error: impl FnOnce(&str) -> E,
) -> Result<T, E> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(error(panic_text(panic.as_ref()))))
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no reason given")
}
