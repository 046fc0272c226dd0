//! The one way in which a file comes into being.
//!
//! A file is written under another name in its own directory, flushed to the disk, opened again and checked,
//! and only then given its name. If the program ends at any time, even by a power cut, the name refers to the
//! complete file or to the previous content. The provenance record of the task has the size and hash of the
//! written content.

use std::ffi::OsStr;
use std::fs::{File, Permissions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use super::error::{Cause, StoreError};
use crate::text::shown;

/// Prefix of the name of a file that is being written.
pub const TEMPORARY_PREFIX: &str = ".hysteron-";
/// Suffix of the name of a file that is being written.
pub const TEMPORARY_SUFFIX: &str = ".tmp";

/// Bytes that are compared at once.
const COMPARED: usize = 1 << 16;

/// Read lock: each writer. Write lock: no writer can begin.
static WRITING: RwLock<()> = RwLock::new(());

/// Waits until no file is being written, and blocks new writers until the returned guard is dropped.
pub fn quiet() -> RwLockWriteGuard<'static, ()> {
    WRITING.write().unwrap_or_else(PoisonError::into_inner)
}

/// Blocks [`quiet`] until the returned guard is dropped.
pub(super) fn writing() -> RwLockReadGuard<'static, ()> {
    WRITING.read().unwrap_or_else(PoisonError::into_inner)
}

/// A file that has been put in place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Place.
    pub path: PathBuf,
    /// Length \[bytes\].
    pub size_bytes: u64,
    /// The BLAKE3 hash of its content, hexadecimal.
    pub blake3: String,
}

/// Length and hash of a file's content.
///
/// # Errors
/// If it cannot be read.
pub fn sum(path: &Path) -> io::Result<(u64, String)> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path)?)?;
    Ok((hasher.count(), hasher.finalize().to_hex().to_string()))
}

/// True if this is the name of a file that is being written, or was when the program was killed.
#[must_use]
pub fn is_temporary(path: &Path) -> bool {
    path.file_name()
        .and_then(OsStr::to_str)
        .is_some_and(|name| name.starts_with(TEMPORARY_PREFIX) && name.ends_with(TEMPORARY_SUFFIX))
}

/// True if no process is writing this temporary file.
#[must_use]
pub fn is_abandoned(path: &Path) -> bool {
    is_temporary(path) && path.is_file() && File::open(path).is_ok_and(|file| file.try_lock().is_ok())
}

/// Writes a file with `write`, checks with `check` what can be read back, and puts it in place of `path`.
///
/// `action` is what an error says was tried, as in "write the surface to". Both closures are given the path
/// of the temporary file, which `write` finds empty.
///
/// # Errors
/// If any step fails. The temporary file is then gone and what was at `path` is still there; only if the very
/// last step fails, which makes the new name last through a power cut, is the new file in place.
pub fn commit(
    action: &str,
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), Cause>,
    check: impl FnOnce(&Path) -> Result<(), Cause>,
) -> Result<Written, StoreError> {
    commit_inner(path, write, check).map_err(|cause| StoreError::new(action, path, cause))
}

/// Puts a file with exactly these bytes in place of `path`.
///
/// # Errors
/// As [`commit`].
pub fn commit_bytes(action: &str, path: &Path, bytes: &[u8]) -> Result<Written, StoreError> {
    commit_parts(action, path, &[bytes])
}

/// As [`commit_bytes`], for bytes in several parts.
pub(super) fn commit_parts(action: &str, path: &Path, parts: &[&[u8]]) -> Result<Written, StoreError> {
    commit(
        action,
        path,
        |temporary| {
            let mut file = File::create(temporary)?;
            parts.iter().try_for_each(|part| file.write_all(part))?;
            Ok(())
        },
        |temporary| {
            if consists_of(temporary, parts)? {
                Ok(())
            } else {
                Err("the content read back differs from the content written".into())
            }
        },
    )
}

/// True if a file consists of the parts.
fn consists_of(path: &Path, parts: &[&[u8]]) -> io::Result<bool> {
    let mut file = File::open(path)?;
    if file.metadata()?.len() != parts.iter().map(|part| part.len() as u64).sum::<u64>() {
        return Ok(false);
    }
    let mut read = vec![0; COMPARED];
    for expected in parts.iter().flat_map(|part| part.chunks(COMPARED)) {
        let read = &mut read[..expected.len()];
        file.read_exact(read)?;
        if read != expected {
            return Ok(false);
        }
    }
    Ok(true)
}

fn commit_inner(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), Cause>,
    check: impl FnOnce(&Path) -> Result<(), Cause>,
) -> Result<Written, Cause> {
    let _writing = writing();
    let directory = match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
        Some(parent) => parent,
        None => return Err("not a path of a file".into()),
    };
    if !directory.is_dir() {
        let state = if directory.exists() { "is not a directory" } else { "does not exist" };
        return Err(format!("{} {state}", shown(directory)).into());
    }
    if path.is_dir() {
        return Err("a directory of this name exists".into());
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY_PREFIX).suffix(TEMPORARY_SUFFIX);
    // Temporary files are private by default; this one becomes an ordinary file, as the umask has it.
    #[cfg(unix)]
    builder.permissions(<Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666));
    let (held, temporary) = builder.tempfile_in(directory)?.into_parts();
    // This lock shows that the file is in use when the files of killed runs are removed. On file systems
    // without locks, the age of the file decides.
    let _ = held.try_lock();
    write(&temporary)?;
    File::open(&temporary)?.sync_all()?;
    check(&temporary)?;
    let (size_bytes, blake3) = sum(&temporary)?;
    temporary.persist(path)?;
    #[cfg(unix)]
    File::open(directory)?.sync_all()?;
    Ok(Written { path: path.to_owned(), size_bytes, blake3 })
}
