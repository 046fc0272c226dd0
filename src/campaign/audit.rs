//! All receipts of a folder against the files that they name, whatever spec they are of.

use super::lost::Sound;
use super::{Campaign, Stage};
use crate::store::{Check, Fault, Found, Receipt, read_receipt};
use rayon::prelude::*;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Result of an audit.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Audit {
    /// Receipts that were read.
    pub receipt_count: usize,
    /// Files that they name.
    pub file_count: usize,
    /// Their bytes.
    pub size_bytes: u64,
    /// True if contents were compared, and not lengths alone.
    pub deep: bool,
    /// Files and receipts that are not as they were written: a sentence for each.
    pub faults: Vec<String>,
    /// Tasks of the spec that have no receipt, although files of theirs or results built on them are there:
    /// `cycle H0.80_z8_r00-1a2b3c4d`.
    pub unreceipted: Vec<String>,
    /// Other files in the program's own folders that no receipt names, by their places.
    pub unnamed: Vec<String>,
    /// Those of `unnamed` that the program wrote and `hysteron gc --delete` deletes.
    pub left_over: Vec<String>,
}

impl Audit {
    /// Number of faults of all kinds.
    #[must_use]
    pub fn fault_count(&self) -> usize {
        self.faults.len() + self.unreceipted.len() + self.unnamed.len()
    }

    /// One of them, as a sentence.
    #[must_use]
    pub fn first_fault(&self) -> Option<String> {
        let unreceipted =
            || self.unreceipted.first().map(|task| format!("{task} has results and no receipt"));
        let unnamed = || self.unnamed.first().map(|file| format!("no receipt names {file}"));
        self.faults.first().cloned().or_else(unreceipted).or_else(unnamed)
    }
}

impl Campaign {
    /// Compares every file of the folder that a receipt names with it, and looks for what has no receipt.
    #[must_use]
    pub fn audit(&self, check: Check) -> Audit {
        let (paths, faults) = self.receipt_paths();
        let parts: Vec<(Audit, Option<Receipt>)> =
            paths.par_iter().map(|path| self.audit_one(path, check)).collect();
        let mut whole = Audit { deep: check == Check::Contents, faults, ..Audit::default() };
        let mut sound = Sound::default();
        for (path, (part, receipt)) in paths.into_iter().zip(parts) {
            whole.receipt_count += part.receipt_count;
            whole.file_count += part.file_count;
            whole.size_bytes = whole.size_bytes.saturating_add(part.size_bytes);
            whole.faults.extend(part.faults);
            if part.receipt_count > 0 {
                sound.enter(path, receipt);
            }
        }
        (whole.unreceipted, whole.unnamed) = self.lost(&sound);
        if !whole.unnamed.is_empty() {
            let leftovers = self.leftovers(&[]);
            let goes = |place: &&String| leftovers.iter().any(|left| left.takes(&self.dir.join(place)));
            whole.left_over = whole.unnamed.iter().filter(goes).cloned().collect();
        }
        whole
    }

    /// All receipts of the folder that can be read, the spec's first, then by stage and id.
    #[must_use]
    pub fn all_receipts(&self) -> Vec<Receipt> {
        readable(&self.receipt_paths().0)
    }

    /// All receipts of a stage that can be read, by id.
    pub(super) fn receipts(&self, stage: Stage) -> Vec<Receipt> {
        readable(&self.receipts_of(stage).unwrap_or_default())
    }

    /// Time of the longest finished cycle \[s\], if one is finished.
    #[must_use]
    pub fn longest_cycle_s(&self) -> Option<f64> {
        self.receipts(Stage::Cycle).iter().map(|receipt| receipt.made.seconds).reduce(f64::max)
    }

    /// A receipt against its files; and itself, if it can be read.
    fn audit_one(&self, path: &Path, check: Check) -> (Audit, Option<Receipt>) {
        let name = path.strip_prefix(&self.dir).unwrap_or(path).display();
        let mut audit = Audit { receipt_count: 1, ..Audit::default() };
        let mut sound = None;
        match read_receipt(path) {
            // It has gone since the folder was listed.
            Found::Nothing => audit.receipt_count = 0,
            Found::Damaged(why) => audit.faults.push(format!("{name}: {why}")),
            Found::Whole(receipt) => {
                let faults = receipt.files.iter().filter_map(|file| file.fault(&self.dir, check));
                audit.faults.extend(faults.map(Fault::sentence));
                audit.file_count = receipt.files.len();
                audit.size_bytes =
                    receipt.files.iter().fold(0, |sum, file| sum.saturating_add(file.size_bytes));
                sound = Some(*receipt);
            }
        }
        (audit, sound)
    }

    /// Paths of receipts: the spec's, then those of each stage in the order of their names; and folders that
    /// could not be listed.
    fn receipt_paths(&self) -> (Vec<PathBuf>, Vec<String>) {
        let (mut paths, mut faults) = (vec![self.spec_receipt_path()], Vec::new());
        for stage in Stage::ALL {
            match self.receipts_of(stage) {
                Ok(found) => paths.extend(found),
                Err(error) => faults.push(format!("receipts/{} cannot be listed: {error}", stage.word())),
            }
        }
        (paths, faults)
    }

    /// Paths of the receipts of a stage, in the order of their names.
    fn receipts_of(&self, stage: Stage) -> std::io::Result<Vec<PathBuf>> {
        let entries = match std::fs::read_dir(self.receipts_dir(stage)) {
            // No unit of this stage has been done yet.
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => entries?,
        };
        let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<PathBuf>>>()?;
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
        paths.sort();
        Ok(paths)
    }
}

/// Those of some receipts that can be read.
fn readable(paths: &[PathBuf]) -> Vec<Receipt> {
    let found = paths.par_iter().filter_map(|path| match read_receipt(path) {
        Found::Whole(receipt) => Some(*receipt),
        _ => None,
    });
    found.collect()
}
