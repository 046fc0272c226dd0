//! Files that the program wrote, by receipts and marks, so that no command replaces or deletes those of the
//! user.

use super::lost::owner;
use super::{Campaign, REPORT_PAGE, Stage};
use crate::schema::TABLES;
use crate::store::commit::sum;
use crate::store::hdf5::is_own_surface;
use crate::store::{Check, Found, parquet, read_receipt};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Id of a comparison, and name of the folder of its receipt.
pub const COMPARISON: &str = "comparison";
/// Word of the stage in the receipt of a comparison.
pub const COMPARE: &str = "compare";
/// Folders to which only a run writes.
const OWN_FOLDERS: [&str; 11] = [
    "surfaces",
    "asperities",
    "estimates",
    "spectra",
    "cycles",
    "statistics",
    "schemas",
    "figures",
    "receipts",
    "snakemake",
    "slurm",
];
/// Entry in the receipt of a report: figures of earlier reports.
const EARLIER: &str = "earlier_figures";
/// Bytes of a text file that are searched for a mark.
const SEARCHED: u64 = 1 << 16;
/// Mark of the program's pages.
pub const PAGE_MARK: &str = "name=\"hysteron-";
/// Mark of the program's descriptions in JSON.
pub const JSON_MARK: &str = "\"generator\": \"hysteron\"";

/// The receipt of a comparison in a folder.
#[must_use]
pub fn comparison_receipt(dir: &Path) -> PathBuf {
    dir.join("receipts").join(COMPARE).join(format!("{COMPARISON}.json"))
}

/// True if a folder is the output folder of a run.
#[must_use]
pub fn is_run(dir: &Path) -> bool {
    dir.join("receipts/campaign.json").is_file()
}

/// The run to which a path belongs: it is the output folder, or inside a folder to which only the run writes.
#[must_use]
pub fn run_around(path: &Path) -> Option<PathBuf> {
    let whole = resolved(path);
    whole.ancestors().find(|dir| is_run(dir) && is_own_place(dir, &whole)).map(Path::to_owned)
}

fn is_own_place(dir: &Path, path: &Path) -> bool {
    let first = path.strip_prefix(dir).ok().and_then(|rest| rest.components().next());
    first.is_none_or(|first| OWN_FOLDERS.iter().any(|name| first.as_os_str() == *name))
}

/// An absolute path without links as far as it exists.
fn resolved(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let existing = whole.ancestors().find_map(|part| part.canonicalize().ok().map(|found| (part, found)));
    existing.map_or(whole.clone(), |(part, found)| match whole.strip_prefix(part) {
        Ok(rest) if !rest.as_os_str().is_empty() => found.join(rest),
        _ => found,
    })
}

/// Problem of a file of a run or comparison that is to be published, compared with its receipt.
///
/// `place` is its place below the folder, parts separated by `/`. A folder without receipts has no problem.
#[must_use]
pub fn damage(dir: &Path, place: &str) -> Option<String> {
    let receipts = dir.join("receipts");
    if !receipts.is_dir() {
        return None;
    }
    let path = match owner(place) {
        _ if place == "campaign.toml" => receipts.join("campaign.json"),
        Some((stage, id)) => receipts.join(stage.word()).join(format!("{id}.json")),
        None => comparison_receipt(dir),
    };
    let name = path.strip_prefix(dir).unwrap_or(&path).display().to_string();
    match read_receipt(&path) {
        Found::Nothing => Some(format!("{place} has no receipt")),
        Found::Damaged(why) => Some(format!("{name}: {why}")),
        Found::Whole(receipt) => match receipt.files.iter().find(|file| file.path == place) {
            Some(file) => file.fault(dir, Check::Contents).map(|fault| fault.sentence()),
            None => Some(format!("{name} does not name {place}")),
        },
    }
}

/// True if a file carries a mark of this program.
#[must_use]
pub fn is_marked(path: &Path) -> bool {
    let begins = |mark: &str| {
        let mut bytes = Vec::new();
        let read = std::fs::File::open(path).and_then(|file| file.take(SEARCHED).read_to_end(&mut bytes));
        read.is_ok() && bytes.windows(mark.len()).any(|part| part == mark.as_bytes())
    };
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("parquet") => parquet::read_key(path).is_ok(),
        Some("h5") => is_own_surface(path),
        Some("html") => begins(PAGE_MARK),
        Some("json") => begins(JSON_MARK),
        _ => false,
    }
}

impl Campaign {
    /// A file at a place where this run writes, and that no run wrote.
    #[must_use]
    pub fn foreign_file(&self) -> Option<PathBuf> {
        let statistics = TABLES
            .iter()
            .filter(|table| table.file.starts_with("statistics/"))
            .map(|table| table.file.to_owned());
        let schemas = TABLES.iter().map(|table| format!("schemas/{}.json", table.name));
        let others = ["datapackage.json", "report.html"].map(str::to_owned);
        let named = self.named();
        let is_foreign = |place: &String| {
            let path = self.dir.join(place);
            path.is_file() && !named.contains(place) && !is_marked(&path)
        };
        let found = others
            .into_iter()
            .chain(statistics)
            .chain(schemas)
            .find(is_foreign)
            .map(|place| self.dir.join(place));
        found.or_else(|| self.foreign_spec()).or_else(|| {
            let comparison = self.dir.join(crate::schema::COMPARISON.file);
            (!is_run(&self.dir) && comparison.is_file()).then_some(comparison)
        })
    }

    /// `campaign.toml`, if it is a spec of the user: no provenance record names it, and it is not this spec
    /// in its resolved form.
    fn foreign_spec(&self) -> Option<PathBuf> {
        let path = self.dir.join("campaign.toml");
        let is_named = !matches!(read_receipt(&self.spec_receipt_path()), Found::Nothing);
        let is_this = || std::fs::read_to_string(&path).is_ok_and(|text| text == self.resolved_toml());
        (path.is_file() && !is_named && !is_this()).then_some(path)
    }

    /// Places that the receipts of statistics and report name.
    fn named(&self) -> BTreeSet<String> {
        let receipts = [Stage::Aggregate, Stage::Report].into_iter().flat_map(|stage| self.receipts(stage));
        receipts.flat_map(|receipt| receipt.files).map(|file| file.path).collect()
    }

    /// Figures that reports of this folder wrote: place and BLAKE3.
    #[must_use]
    pub fn drawn(&self) -> BTreeSet<(String, String)> {
        let receipts = self.receipts(Stage::Report).into_iter().filter(|receipt| receipt.id == REPORT_PAGE);
        let mut drawn = BTreeSet::new();
        for receipt in receipts {
            let earlier =
                receipt.made.effort.get(EARLIER).and_then(Value::as_array).cloned().unwrap_or_default();
            let entry = |line: &Value| {
                line.as_str()?.split_once(' ').map(|(hash, place)| (place.to_owned(), hash.to_owned()))
            };
            drawn.extend(earlier.iter().filter_map(entry));
            drawn.extend(receipt.files.into_iter().map(|file| (file.path, file.blake3)));
        }
        drawn
    }

    /// Figures of earlier reports that are there and that a report with these figures does not write, for its
    /// receipt.
    #[must_use]
    pub fn earlier_figures(&self, figures: &[(String, Vec<u8>)]) -> Map<String, Value> {
        let is_earlier = |(place, _): &&(String, String)| {
            place.starts_with("figures/")
                && self.dir.join(place).is_file()
                && figures.iter().all(|(new, _)| new != place)
        };
        let earlier: Vec<Value> = self
            .drawn()
            .iter()
            .filter(is_earlier)
            .map(|(place, hash)| json!(format!("{hash} {place}")))
            .collect();
        if earlier.is_empty() {
            Map::new()
        } else {
            Map::from_iter([(EARLIER.to_owned(), Value::Array(earlier))])
        }
    }

    /// The first figure in the place of one of these that no report wrote, and that differs from it.
    #[must_use]
    pub fn foreign_figure(&self, figures: &[(String, Vec<u8>)]) -> Option<PathBuf> {
        let drawn = self.drawn();
        let is_foreign = |(place, bytes): &&(String, Vec<u8>)| {
            let path = self.dir.join(place);
            let is_known = drawn.iter().any(|(known, _)| known == place);
            path.is_file() && !is_known && std::fs::read(&path).map_or(true, |present| present != *bytes)
        };
        figures.iter().find(is_foreign).map(|(place, _)| self.dir.join(place))
    }

    /// True if a figure is one that a report of this folder wrote, unchanged.
    pub(super) fn is_drawn(&self, drawn: &BTreeSet<(String, String)>, path: &Path) -> bool {
        let place = path.strip_prefix(&self.dir).unwrap_or(path).to_string_lossy().replace('\\', "/");
        sum(path).is_ok_and(|(_, hash)| drawn.contains(&(place, hash)))
    }
}
