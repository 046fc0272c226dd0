//! Reader of provenance records.
#![no_main]

mod file;

use hysteron::store::{Found, read_receipt};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Found::Damaged(why) = read_receipt(&file::file(bytes)) {
        assert!(!why.is_empty());
    }
});
