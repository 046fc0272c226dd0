//! All receipts of a folder against the files that they name, whatever spec they are of.

use super::Campaign;
use crate::store::{Check, Fault, Found, Receipt, read_receipt};
use rayon::prelude::*;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What an audit has found.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Audit {
    /// Receipts that were read.
    pub receipt_count: usize,
    /// Files that they name.
    pub file_count: usize,
    /// Their bytes.
    pub size_bytes: u64,
    /// Whether contents were compared, and not lengths alone.
    pub deep: bool,
    /// What is wrong: a sentence for each file.
    pub faults: Vec<String>,
}

impl Campaign {
    /// Compares every file of the folder that a receipt names with it.
    #[must_use]
    pub fn audit(&self, check: Check) -> Audit {
        let mut paths = Vec::new();
        receipts_below(&self.dir.join("receipts"), &mut paths);
        let parts: Vec<Audit> = paths.par_iter().map(|path| self.audit_one(path, check)).collect();
        let mut whole = Audit { deep: check == Check::Contents, ..Audit::default() };
        for part in parts {
            whole.receipt_count += part.receipt_count;
            whole.file_count += part.file_count;
            whole.size_bytes += part.size_bytes;
            whole.faults.extend(part.faults);
        }
        whole
    }

    /// All receipts of the folder that can be read, the spec's first, then by stage and id.
    #[must_use]
    pub fn all_receipts(&self) -> Vec<Receipt> {
        let mut paths = Vec::new();
        receipts_below(&self.dir.join("receipts"), &mut paths);
        let found = paths.par_iter().filter_map(|path| match read_receipt(path) {
            Found::Whole(receipt) => Some(*receipt),
            _ => None,
        });
        found.collect()
    }

    fn audit_one(&self, path: &Path, check: Check) -> Audit {
        let name = path.strip_prefix(&self.dir).unwrap_or(path).display();
        let mut audit = Audit { receipt_count: 1, ..Audit::default() };
        match read_receipt(path) {
            // It has gone since the folder was listed.
            Found::Nothing => audit.receipt_count = 0,
            Found::Damaged(why) => audit.faults.push(format!("{name}: {why}")),
            Found::Whole(receipt) => {
                let faults = receipt.files.iter().filter_map(|file| file.fault(&self.dir, check));
                audit.faults.extend(faults.map(Fault::sentence));
                audit.file_count = receipt.files.len();
                audit.size_bytes = receipt.files.iter().map(|file| file.size_bytes).sum();
            }
        }
        audit
    }
}

/// All receipts below a folder, in the order of their names.
fn receipts_below(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            receipts_below(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "json") {
            found.push(path);
        }
    }
}
