//! Unreferenced files: no spec names them.

use super::{Campaign, REPORT_PAGE, Stage, Standing};
use crate::store::commit::is_abandoned;
use crate::store::{Check, Found, read_receipt};
use std::collections::HashSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Something that can go.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Leftover {
    /// A file, or the folder of a cycle.
    pub path: PathBuf,
    /// The bytes of its files.
    pub size_bytes: u64,
    /// Why it can go.
    pub why: &'static str,
}

const UNNAMED: &str = "no spec names it";
const UNSHOWN: &str = "the report does not show it";
const TORN: &str = "a killed run left it";
const PAST: &str = "its cycle is done";

impl Campaign {
    /// Files that neither this campaign nor `others` in the same folder name: receipts first, so that removal in this order leaves no receipt
    /// without its files. Files that this program does not write are not looked at.
    #[must_use]
    pub fn leftovers(&self, others: &[Self]) -> Vec<Leftover> {
        let all = || std::iter::once(self).chain(others);
        let surfaces: HashSet<&str> = all().flat_map(|campaign| &campaign.surfaces).map(|unit| unit.id.as_str()).collect();
        let cycles: HashSet<&str> = all().flat_map(|campaign| &campaign.cycles).map(|unit| unit.id.as_str()).collect();
        let mut found = Vec::new();
        for (stage, known) in [(Stage::Cycle, &cycles), (Stage::Extract, &surfaces), (Stage::Generate, &surfaces)] {
            unnamed(&self.receipts_dir(stage), Some("json"), known, &mut found);
        }
        unnamed(&self.dir.join("cycles"), None, &cycles, &mut found);
        unnamed(&self.dir.join("asperities"), Some("parquet"), &surfaces, &mut found);
        unnamed(&self.dir.join("surfaces"), Some("h5"), &surfaces, &mut found);
        if let Found::Whole(receipt) = read_receipt(&self.receipts_dir(Stage::Report).join(format!("{REPORT_PAGE}.json"))) {
            let kept: HashSet<PathBuf> = receipt.files.iter().map(|file| self.dir.join(&file.path)).collect();
            let pictures = entries(&self.dir.join("figures")).into_iter().filter(|path| is_picture(path));
            found.extend(pictures.filter(|path| !kept.contains(path)).map(|path| Leftover { size_bytes: size(&path), path, why: UNSHOWN }));
        }
        for campaign in all() {
            for unit in campaign.distinct_cycles() {
                for path in [self.failure_path(&unit), self.halfway_path(&unit)] {
                    if path.is_file() && self.cycle_standing(&unit, Check::Sizes) == Standing::Done {
                        found.push(Leftover { size_bytes: size(&path), path, why: PAST });
                    }
                }
            }
        }
        let folders = ["", "surfaces", "asperities", "statistics", "figures", "receipts"].map(|name| self.dir.join(name));
        let receipts = Stage::ALL.map(|stage| self.receipts_dir(stage));
        let cycles = entries(&self.dir.join("cycles")).into_iter().filter(|path| path.is_dir());
        for folder in folders.into_iter().chain(receipts).chain(cycles) {
            let torn = entries(&folder).into_iter().filter(|path| is_abandoned(path));
            found.extend(torn.map(|path| Leftover { size_bytes: size(&path), path, why: TORN }));
        }
        let mut seen: HashSet<PathBuf> = HashSet::new();
        found.retain(|left| !left.path.ancestors().skip(1).any(|folder| seen.contains(folder)) && seen.insert(left.path.clone()));
        found
    }
}

impl Leftover {
    /// Takes it away.
    ///
    /// # Errors
    /// If it is there and cannot be taken away.
    pub fn remove(&self) -> std::io::Result<()> {
        let removed = if self.path.is_dir() { std::fs::remove_dir_all(&self.path) } else { std::fs::remove_file(&self.path) };
        removed.or_else(|error| if error.kind() == ErrorKind::NotFound { Ok(()) } else { Err(error) })
    }
}

/// Entries of a folder that have the name of a task, but of none that is known; folders if there is no extension.
fn unnamed(folder: &Path, extension: Option<&str>, known: &HashSet<&str>, found: &mut Vec<Leftover>) {
    for path in entries(folder) {
        let is_kind = if extension.is_some() { path.extension().and_then(|e| e.to_str()) == extension } else { path.is_dir() };
        let stem = if extension.is_some() { path.file_stem() } else { path.file_name() };
        let Some(id) = stem.and_then(|stem| stem.to_str()) else { continue };
        if is_kind && is_id(id) && !known.contains(id) {
            found.push(Leftover { size_bytes: size(&path), path, why: UNNAMED });
        }
    }
}

/// True if a file has the name of a figure that the program draws, as `zeta_A.svg` or `closer_loop.png`, in one of its formats.
fn is_picture(path: &Path) -> bool {
    let stem = path.file_stem().and_then(|stem| stem.to_str()).and_then(|stem| stem.rsplit_once('_'));
    let drawn = |(sweep, panel): (&str, &str)| {
        sweep == "closer" || (!sweep.is_empty() && panel.len() == 1 && panel.bytes().all(|letter| letter.is_ascii_uppercase()))
    };
    path.extension().and_then(|e| e.to_str()).is_some_and(|e| matches!(e, "svg" | "png" | "pdf")) && stem.is_some_and(drawn)
}

/// True if a name is that of a surface or a cycle, as `H0.80_z128_r03-1a2b3c4d` or `scan_r00-1a2b3c4d`: nothing else may be taken for one, since it may be
/// somebody's own.
pub(super) fn is_id(name: &str) -> bool {
    let digits = |text: &str| text.len() >= 2 && text.bytes().all(|b| b.is_ascii_digit());
    let key = |text: &str| matches!(text.len(), 8 | 16) && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
    let plain = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'_' | b'-'));
    let parts = || {
        let (readable, end) = name.rsplit_once('-')?;
        let (kind, realization) = readable.rsplit_once("_r")?;
        Some(plain(kind) && digits(realization) && key(end))
    };
    parts().unwrap_or(false)
}

/// Entries of a folder, by name; nothing if it cannot be read.
pub(super) fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).map(|all| all.flatten().map(|entry| entry.path()).collect()).unwrap_or_default();
    paths.sort();
    paths
}

/// The bytes of a file, or of all files below a folder.
fn size(path: &Path) -> u64 {
    if path.is_dir() { entries(path).iter().map(|inner| size(inner)).sum() } else { std::fs::metadata(path).map_or(0, |found| found.len()) }
}
