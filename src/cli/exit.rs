//! Exit codes of the program.

pub(super) const FAILED: u8 = 1;
pub(super) const BAD_SPEC: u8 = 2;
pub(super) const FAILED_CASES: u8 = 3;
pub(super) const INTERRUPTED: u8 = 130;
