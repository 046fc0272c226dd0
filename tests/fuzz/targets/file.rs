//! A file with the bytes of the fuzzer, for readers of files.

use std::path::PathBuf;

/// Writes the bytes to a file of this process.
pub fn file(bytes: &[u8]) -> PathBuf {
    let path = std::env::temp_dir().join(format!("hysteron-fuzz-{}", std::process::id()));
    std::fs::write(&path, bytes).expect("a temporary file");
    path
}
