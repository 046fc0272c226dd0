//! Units of length in files.

use super::Cause;
use crate::lengths::{LENGTHS, metres};

/// As [`metres`], with a sentence for what is no length; `what` is, for instance, "its heights are".
pub(super) fn length(what: &str, unit: &str) -> Result<f64, Cause> {
    metres(unit).ok_or_else(|| {
        format!("{what} in {unit:?}, not a known unit of length\nhelp: use one of {LENGTHS}").into()
    })
}
