//! Reader of NumPy arrays.
#![no_main]

mod file;
mod scan;

use hysteron::store::scan::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| scan::scan(bytes, Format::Npy));
