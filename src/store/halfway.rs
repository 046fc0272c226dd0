//! Checkpoint of an unfinished task, as bytes that only the program reads. The key of the task and a hash
//! exclude checkpoints of other tasks and incomplete ones.

use super::commit::{Written, commit_parts};
use super::error::StoreError;
use std::io::Read as _;
use std::path::Path;

/// Length of a key and of a hash, as hexadecimal digits.
const DIGITS: usize = 64;

/// Version of the layout of the bytes. A checkpoint of another version does not match its hash, and the unit
/// starts again. Raise it with every change of a type that a checkpoint holds.
pub const CHECKPOINT_VERSION: u8 = 6;

/// Hash of a checkpoint and its version, as hexadecimal digits.
fn seal(bytes: &[u8]) -> blake3::Hash {
    blake3::Hasher::new().update(&[CHECKPOINT_VERSION]).update(bytes).finalize()
}

/// Puts the bytes of the unit `key` in place of `path`.
///
/// # Errors
/// As [`commit_bytes`](super::commit::commit_bytes).
pub fn write_halfway(path: &Path, key: &str, bytes: &[u8]) -> Result<(), StoreError> {
    write_state(path, key, bytes).map(drop)
}

/// Writes the state that a finished task keeps; [`read_halfway`] reads it.
///
/// # Errors
/// As [`commit_bytes`](super::commit::commit_bytes).
pub fn write_state(path: &Path, key: &str, bytes: &[u8]) -> Result<Written, StoreError> {
    commit_parts(
        "keep what is needed to go on in",
        path,
        &[key.as_bytes(), seal(bytes).to_hex().as_bytes(), bytes],
    )
}

/// True if `path` begins as one of the unit `key` does. Whether it is whole is seen when it is read.
#[must_use]
pub fn is_halfway(path: &Path, key: &str) -> bool {
    let mut head = [0; DIGITS];
    path.is_file()
        && std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut head)).is_ok()
        && head == *key.as_bytes()
}

/// The bytes at `path`, if they are whole and of the unit `key`.
#[must_use]
pub fn read_halfway(path: &Path, key: &str) -> Option<Vec<u8>> {
    // A pipe in its place would be waited for.
    let mut whole = path.is_file().then(|| std::fs::read(path).ok())??;
    let (head, bytes) = whole.split_at_checked(2 * DIGITS)?;
    let is_its = head[..DIGITS] == *key.as_bytes() && head[DIGITS..] == *seal(bytes).to_hex().as_bytes();
    is_its.then(|| {
        whole.drain(..2 * DIGITS);
        whole
    })
}
