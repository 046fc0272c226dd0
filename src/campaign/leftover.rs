//! Unreferenced files: no spec names them.

use super::lost::{entries, owner};
use super::owned::is_marked;
use super::{Campaign, REPORT_PAGE, Stage, Standing};
use crate::schema::TABLES;
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
const UNMADE: &str = "the statistics do not have it";
const TORN: &str = "a killed run left it";
/// Folders of files that are put in place.
const FOLDERS: [&str; 9] =
    ["", "surfaces", "asperities", "estimates", "spectra", "statistics", "schemas", "figures", "receipts"];

const PAST: &str = "its cycle is done";

impl Campaign {
    /// Files that neither this campaign nor `others` in the same folder name: receipts first, so that removal
    /// in this order leaves no receipt without its files. Only files that the program wrote are listed, by a
    /// receipt or by their marks.
    #[must_use]
    pub fn leftovers(&self, others: &[Self]) -> Vec<Leftover> {
        let all = || std::iter::once(self).chain(others);
        let surfaces: HashSet<&str> =
            all().flat_map(|campaign| &campaign.surfaces).map(|unit| unit.id.as_str()).collect();
        let cycles: HashSet<&str> =
            all().flat_map(|campaign| &campaign.cycles).map(|unit| unit.id.as_str()).collect();
        let mut found = Vec::new();
        for (stage, known) in
            [(Stage::Cycle, &cycles), (Stage::Extract, &surfaces), (Stage::Generate, &surfaces)]
        {
            unnamed(&self.receipts_dir(stage), Some("json"), known, &mut found);
        }
        for (folder, ending, stage, known) in [
            ("cycles", None, Stage::Cycle, &cycles),
            ("asperities", Some("parquet"), Stage::Extract, &surfaces),
            ("estimates", Some("parquet"), Stage::Extract, &surfaces),
            ("spectra", Some("parquet"), Stage::Extract, &surfaces),
            ("surfaces", Some("h5"), Stage::Generate, &surfaces),
        ] {
            let mut files = Vec::new();
            unnamed(&self.dir.join(folder), ending, known, &mut files);
            files.retain(|left| self.is_written(stage, &left.path));
            found.extend(files);
        }
        if let Found::Whole(receipt) =
            read_receipt(&self.receipts_dir(Stage::Report).join(format!("{REPORT_PAGE}.json")))
        {
            let drawn = self.drawn();
            let kept: HashSet<PathBuf> = receipt.files.iter().map(|file| self.dir.join(&file.path)).collect();
            let pictures = entries(&self.dir.join("figures")).into_iter().filter(|path| is_picture(path));
            let unshown = pictures.filter(|path| !kept.contains(path) && self.is_drawn(&drawn, path));
            found.extend(unshown.map(|path| Leftover { size_bytes: size(&path), path, why: UNSHOWN }));
        }
        found.extend(self.earlier_tables());
        for campaign in all() {
            for unit in campaign.distinct_cycles() {
                for path in [self.failure_path(&unit), self.halfway_path(&unit)] {
                    if path.is_file() && self.cycle_standing(&unit, Check::Sizes) == Standing::Done {
                        found.push(Leftover { size_bytes: size(&path), path, why: PAST });
                    }
                }
            }
        }
        let folders = FOLDERS.map(|name| self.dir.join(name));
        let receipts = Stage::ALL.map(|stage| self.receipts_dir(stage));
        let cycles = entries(&self.dir.join("cycles")).into_iter().filter(|path| path.is_dir());
        for folder in folders.into_iter().chain(receipts).chain(cycles) {
            let torn = entries(&folder).into_iter().filter(|path| is_abandoned(path));
            found.extend(torn.map(|path| Leftover { size_bytes: size(&path), path, why: TORN }));
        }
        let mut seen: HashSet<PathBuf> = HashSet::new();
        found.retain(|left| {
            !left.path.ancestors().skip(1).any(|folder| seen.contains(folder))
                && seen.insert(left.path.clone())
        });
        found
    }
}

impl Campaign {
    /// Tables of earlier statistics and panels that the present ones do not have, with their schemas.
    fn earlier_tables(&self) -> Vec<Leftover> {
        let tables = TABLES.iter().filter(|table| table.file.starts_with("statistics/"));
        let places = tables.map(|table| table.file.to_owned());
        let schemas = TABLES.iter().map(|table| format!("schemas/{}.json", table.name));
        let is_earlier = |place: &String| {
            let receipt = owner(place).map(|(stage, id)| self.receipts_dir(stage).join(format!("{id}.json")));
            let is_named = receipt.is_none_or(|path| match read_receipt(&path) {
                Found::Whole(receipt) => receipt.files.iter().any(|file| file.path == *place),
                _ => true,
            });
            let path = self.dir.join(place);
            !is_named && path.is_file() && is_marked(&path)
        };
        let paths = places.chain(schemas).filter(is_earlier).map(|place| self.dir.join(place));
        paths.map(|path| Leftover { size_bytes: size(&path), path, why: UNMADE }).collect()
    }

    /// True if a file of a task, or the folder of a cycle, is of the program: a receipt names it, or it has
    /// the marks of one.
    fn is_written(&self, stage: Stage, path: &Path) -> bool {
        if path.is_dir() {
            return !cycle_files(path).is_empty() || entries(path).is_empty();
        }
        let receipt = path
            .file_stem()
            .map(|id| self.receipts_dir(stage).join(format!("{}.json", id.to_string_lossy())));
        receipt.is_some_and(|path| matches!(read_receipt(&path), Found::Whole(_))) || is_marked(path)
    }
}

impl Leftover {
    /// True if its removal takes a file away.
    pub(super) fn takes(&self, file: &Path) -> bool {
        self.path == file
            || file.parent() == Some(&self.path) && cycle_files(&self.path).iter().any(|own| own == file)
    }

    /// Takes it away; of a folder only the files of a cycle, and the folder if nothing else is in it.
    ///
    /// # Errors
    /// If it is there and cannot be taken away.
    pub fn remove(&self) -> std::io::Result<()> {
        if self.path.is_dir() {
            for file in cycle_files(&self.path) {
                removed(std::fs::remove_file(file))?;
            }
            return if entries(&self.path).is_empty() {
                removed(std::fs::remove_dir(&self.path))
            } else {
                Ok(())
            };
        }
        removed(std::fs::remove_file(&self.path))
    }
}

/// Success also where there was nothing to remove.
fn removed(result: std::io::Result<()>) -> std::io::Result<()> {
    result.or_else(|error| if error.kind() == ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

/// Files in the folder of a cycle that the program writes.
fn cycle_files(folder: &Path) -> Vec<PathBuf> {
    const OTHERS: [&str; 4] = ["maps.h5", "turning.bin", "failed.json", "halfway.bin"];
    let is_own = |path: &PathBuf| {
        let is_table =
            |name: &str| TABLES.iter().any(|table| table.file.strip_prefix("cycles/<id>/") == Some(name));
        let name = path.file_name().and_then(|name| name.to_str());
        is_abandoned(path) || name.is_some_and(|name| OTHERS.contains(&name) || is_table(name))
    };
    entries(folder).into_iter().filter(|path| !path.is_dir() && is_own(path)).collect()
}

/// Entries of a folder that have the name of a task, but of none that is known; folders if there is no
/// extension.
fn unnamed(folder: &Path, extension: Option<&str>, known: &HashSet<&str>, found: &mut Vec<Leftover>) {
    for path in entries(folder) {
        let is_kind = if extension.is_some() {
            path.extension().and_then(|e| e.to_str()) == extension
        } else {
            path.is_dir()
        };
        let stem = if extension.is_some() { path.file_stem() } else { path.file_name() };
        let Some(id) = stem.and_then(|stem| stem.to_str()) else { continue };
        if is_kind && is_id(id) && !known.contains(id) {
            found.push(Leftover { size_bytes: size(&path), path, why: UNNAMED });
        }
    }
}

/// True if a file has the name of a figure that the program draws, as `zeta_A.svg`, `zeta_A_SI.svg` or
/// `closer_loop.png`, in one of its formats.
fn is_picture(path: &Path) -> bool {
    let name = path.file_stem().and_then(|stem| stem.to_str());
    let stem = name.map(|stem| stem.trim_end_matches("_SI")).and_then(|stem| stem.rsplit_once('_'));
    let drawn = |(sweep, panel): (&str, &str)| {
        matches!(
            (sweep, panel),
            ("closer" | "elements", _) | ("contact", "maps") | ("method", "ratios") | ("measured", "loops")
        ) || (matches!(sweep, "works" | "spectrum") && panel.bytes().all(|digit| digit.is_ascii_digit()))
            || (!sweep.is_empty()
                && panel.len() == 1
                && panel.bytes().all(|letter| letter.is_ascii_uppercase()))
    };
    path.extension().and_then(|e| e.to_str()).is_some_and(|e| matches!(e, "svg" | "png" | "pdf"))
        && (name == Some("spectrum") || stem.is_some_and(drawn))
}

/// True if a name is that of a surface or a cycle, as `H0.80_z128_r03-1a2b3c4d` or `scan_r00-1a2b3c4d`. No
/// other name passes: it may belong to a file of the user.
pub(super) fn is_id(name: &str) -> bool {
    let digits = |text: &str| text.len() >= 2 && text.bytes().all(|b| b.is_ascii_digit());
    let key = |text: &str| {
        matches!(text.len(), 8 | 16) && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
    };
    let plain = |text: &str| {
        !text.is_empty() && text.bytes().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'_' | b'-'))
    };
    let parts = || {
        let (readable, end) = name.rsplit_once('-')?;
        let (kind, realization) = readable.rsplit_once("_r")?;
        Some(plain(kind) && digits(realization) && key(end))
    };
    parts().unwrap_or(false)
}

/// The bytes of a file, or of the files of a cycle in its folder.
fn size(path: &Path) -> u64 {
    if path.is_dir() {
        cycle_files(path).iter().map(|inner| size(inner)).sum()
    } else {
        std::fs::metadata(path).map_or(0, |found| found.len())
    }
}
