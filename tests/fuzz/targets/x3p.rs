//! Reader of X3P archives.
#![no_main]

mod file;
mod scan;

use hysteron::store::scan::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| scan::scan(bytes, Format::X3p));
