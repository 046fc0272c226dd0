//! A scan of several that are imported.

use crate::stages::{Examined, Imported};
use std::path::PathBuf;

/// A scan that was read.
pub(super) struct Taken {
    /// Its name in messages.
    pub(super) label: String,
    pub(super) imported: Imported,
    pub(super) examined: Examined,
    /// File of its surface.
    pub(super) out: PathBuf,
}
