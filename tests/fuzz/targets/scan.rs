//! A measured surface from the bytes of the fuzzer.

use super::file::file;
use hysteron::store::scan::{Format, MOST_POINTS, read};

/// Reads the bytes as a surface: the result is a height field within the limit, or an error with a message.
pub fn scan(bytes: &[u8], format: Format) {
    match read(&file(bytes), format, None) {
        Ok(scan) => assert!(!scan.heights.is_empty() && scan.heights.len() as u64 <= MOST_POINTS),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
