//! The one way in which a file comes into being.
//!
//! It is written under another name in its own directory, flushed to the disk, opened again and checked, and only then
//! given its name. Whenever the program ends, even by a power cut, the name stands for a whole file or for what was
//! there before.

use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::path::Path;
use std::sync::{PoisonError, RwLock, RwLockWriteGuard};

use super::error::{Cause, StoreError};

/// How the name of a file that is still being written begins.
pub const TEMPORARY_PREFIX: &str = ".hysteron-";
/// How the name of a file that is still being written ends.
pub const TEMPORARY_SUFFIX: &str = ".tmp";

/// Held by all that write, and by one that lets nobody begin.
static WRITING: RwLock<()> = RwLock::new(());

/// Waits until no file is being written, and lets none begin while what is returned is held.
pub fn quiet() -> RwLockWriteGuard<'static, ()> {
    WRITING.write().unwrap_or_else(PoisonError::into_inner)
}

/// Whether this is the name of a file that is being written, or was when the program was killed.
#[must_use]
pub fn is_temporary(path: &Path) -> bool {
    path.file_name().and_then(OsStr::to_str).is_some_and(|name| name.starts_with(TEMPORARY_PREFIX) && name.ends_with(TEMPORARY_SUFFIX))
}

/// Writes a file with `write`, checks with `check` what can be read back, and puts it in place of `path`.
///
/// `action` is what an error says was tried, as in "write the surface to". Both closures are given the path of the
/// temporary file, which `write` finds empty.
///
/// # Errors
/// If any step fails. The temporary file is then gone and what was at `path` is still there; only if the very last
/// step fails, which makes the new name last through a power cut, is the new file in place.
pub fn commit(
    action: &str,
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), Cause>,
    check: impl FnOnce(&Path) -> Result<(), Cause>,
) -> Result<(), StoreError> {
    commit_inner(path, write, check).map_err(|cause| StoreError::new(action, path, cause))
}

/// Puts a file with exactly these bytes in place of `path`.
///
/// # Errors
/// As [`commit`].
pub fn commit_bytes(action: &str, path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    commit(
        action,
        path,
        |temporary| Ok(fs::write(temporary, bytes)?),
        |temporary| {
            if fs::read(temporary)? == bytes { Ok(()) } else { Err("what was read back is not what was written".into()) }
        },
    )
}

fn commit_inner(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), Cause>,
    check: impl FnOnce(&Path) -> Result<(), Cause>,
) -> Result<(), Cause> {
    let _writing = WRITING.read().unwrap_or_else(PoisonError::into_inner);
    let directory = match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
        Some(parent) => parent,
        None => return Err("it is not the path of a file".into()),
    };
    if !directory.is_dir() {
        let state = if directory.exists() { "is not a directory" } else { "does not exist" };
        return Err(format!("{} {state}", directory.display()).into());
    }
    if path.is_dir() {
        return Err("there is a directory of that name".into());
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY_PREFIX).suffix(TEMPORARY_SUFFIX);
    // Temporary files are private by default; this one becomes an ordinary file, as the umask has it.
    #[cfg(unix)]
    builder.permissions(<Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666));
    let temporary = builder.tempfile_in(directory)?.into_temp_path();
    write(&temporary)?;
    File::open(&temporary)?.sync_all()?;
    check(&temporary)?;
    temporary.persist(path)?;
    #[cfg(unix)]
    File::open(directory)?.sync_all()?;
    Ok(())
}
