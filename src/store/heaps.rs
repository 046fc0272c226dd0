//! Check of the global heaps of an HDF5 file, which hold its strings of variable length.
//!
//! The HDF5 library does not return from a heap in which an object has no size. So a damaged heap is an error
//! before the library opens the file. Source: HDF5 File Format Specification, section III.E (global heap).

use super::error::Cause;
use std::fs::File;
use std::io::{Read, Seek as _, SeekFrom};
use std::path::Path;

/// Begin of a collection of a global heap: signature, version 1 and three zeros.
const BEGIN: [u8; 8] = *b"GCOL\x01\0\0\0";

/// Bytes of the head of a collection, and of that of an object, with sizes of eight bytes.
const HEAD: u64 = 16;

/// Bytes that are searched at a time.
const PIECE: usize = 1 << 20;

/// Checks the objects of all collections of a file.
///
/// # Errors
/// A file that cannot be read, or a collection with an object of an impossible size.
pub(super) fn check(path: &Path) -> Result<(), Cause> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    for begin in collections(&mut file)? {
        file.seek(SeekFrom::Start(begin + BEGIN.len() as u64))?;
        let size = number(&mut file)?;
        // A collection that does not fit is an error of the library.
        if size > length - begin {
            continue;
        }
        let mut at = HEAD;
        while at + HEAD <= size {
            file.seek(SeekFrom::Start(begin + at))?;
            // Index and number of references; then the size, which of free space includes the head.
            let free = number(&mut file)? & 0xffff == 0;
            let stored = number(&mut file)?;
            let needed = if free {
                Some(stored)
            } else {
                stored.checked_next_multiple_of(8).and_then(|padded| padded.checked_add(HEAD))
            };
            match needed {
                Some(needed) if needed > 0 && needed <= size - at => at += needed,
                _ => return Err("the file is damaged (global heap of its strings)".into()),
            }
        }
    }
    Ok(())
}

/// Places of the collections.
fn collections(file: &mut File) -> Result<Vec<u64>, Cause> {
    let mut found = Vec::new();
    let mut piece = Vec::with_capacity(PIECE + BEGIN.len());
    let mut first = 0;
    loop {
        let kept = piece.len();
        (&mut *file).take(PIECE as u64).read_to_end(&mut piece)?;
        if piece.len() == kept {
            return Ok(found);
        }
        let starts = piece.windows(BEGIN.len()).enumerate().filter(|(_, bytes)| **bytes == BEGIN);
        found.extend(starts.map(|(at, _)| first + at as u64));
        // The last bytes may be the begin of a signature.
        let done = piece.len().saturating_sub(BEGIN.len() - 1);
        piece.drain(..done);
        first += done as u64;
    }
}

fn number(file: &mut File) -> Result<u64, Cause> {
    let mut bytes = [0; 8];
    file.read_exact(&mut bytes)?;
    Ok(u64::from_le_bytes(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A collection of 64 bytes with an object of 5 bytes and free space, whose sizes are those given. It is
    /// not an HDF5 file.
    fn is_sound(object: u64, free: u64) -> Result<bool, Cause> {
        let mut bytes = vec![7; 3];
        bytes.extend(BEGIN);
        for number in [64, 1, object, 0, 0, free, 0, 0] {
            bytes.extend(u64::to_le_bytes(number));
        }
        let file = tempfile::NamedTempFile::new()?;
        std::fs::write(file.path(), bytes)?;
        Ok(check(file.path()).is_ok())
    }

    #[test]
    fn law_objects_of_a_heap_have_a_size_within_it() -> Result<(), Cause> {
        assert!(is_sound(5, 24)? && is_sound(8, 24)?);
        for (object, free) in [(5, 0), (5, 25), (5, u64::MAX), (u64::MAX, 24), (100, 24)] {
            assert!(!is_sound(object, free)?, "{object} {free}");
        }
        Ok(())
    }
}
