//! Receipt of a finished task: its key and key inputs, its files with their hashes, and its provenance.
//!
//! A provenance record is written after the files of the task, each of which was put in place as a complete
//! file. A task with a provenance record is finished, and one without is not, whatever files are there. Only
//! the provenance record has times, the host and the version of the program.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::io::ErrorKind;
use std::path::{Component, Path};

use super::commit::{Written, commit_bytes, sum};
use super::error::StoreError;

/// Version of this format.
pub const RECEIPT_VERSION: u32 = 1;

/// Text before the hash of the preceding bytes.
const SEAL: &str = ",\n  \"seal\": \"";

/// More than any receipt of this program has \[bytes\]: that of the statistics of 10⁵ cycles has 10 MB.
const MOST_BYTES: u64 = 1 << 28;

/// A unit that is done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Receipt {
    /// [`RECEIPT_VERSION`].
    pub receipt: u32,
    /// The stage's word.
    pub stage: String,
    /// The unit.
    pub id: String,
    /// Key.
    pub key: String,
    /// Key inputs of the task and of all tasks that it depends on, by stage.
    pub preimages: Map<String, Value>,
    /// Files.
    pub files: Vec<Kept>,
    /// Origin of the files.
    pub made: Made,
}

/// A file of a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept {
    /// Place below the output folder, parts separated by `/`.
    pub path: String,
    /// Length \[bytes\].
    pub size_bytes: u64,
    /// The BLAKE3 hash of its content, hexadecimal.
    pub blake3: String,
}

/// Origin of files. No part of it enters a key.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Made {
    /// Version of the program.
    pub version: String,
    /// Commit that it was built from, if that is known; `+` after it where files had been changed since.
    pub commit: Option<String>,
    /// The compiler, and what it compiled for.
    pub toolchain: String,
    /// The machine.
    pub host: String,
    /// Threads of the run.
    pub threads: usize,
    /// When the unit was begun.
    pub began: String,
    /// Run time \[s\].
    pub seconds: f64,
    /// Counted effort.
    pub effort: Map<String, Value>,
}

/// Comparison of a file with its provenance record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Check {
    /// It is there, and as long as it was.
    Sizes,
    /// Content has the hash that it had.
    Contents,
}

/// Content at the path of a provenance record.
#[derive(Debug)]
pub enum Found {
    /// Nothing.
    Nothing,
    /// A receipt.
    Whole(Box<Receipt>),
    /// Something that is none: why.
    Damaged(String),
}

/// Fault of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Fault {
    /// It is not there.
    Missing(String),
    /// It is another one than was written.
    Changed(String),
}

impl Fault {
    /// Description of the fault.
    #[must_use]
    pub fn sentence(self) -> String {
        match self {
            Self::Missing(why) | Self::Changed(why) => why,
        }
    }
}

impl Kept {
    /// Of a file below `dir` that was written.
    #[must_use]
    pub fn of(written: &Written, dir: &Path) -> Self {
        let path = written.path.strip_prefix(dir).unwrap_or(&written.path);
        let parts: Vec<String> =
            path.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
        Self { path: parts.join("/"), size_bytes: written.size_bytes, blake3: written.blake3.clone() }
    }

    /// Fault of the file below `dir`, if any.
    #[must_use]
    pub fn fault(&self, dir: &Path, check: Check) -> Option<Fault> {
        let path = dir.join(&self.path);
        let size = match std::fs::metadata(&path) {
            Ok(found) if !found.is_file() => {
                return Some(Fault::Changed(format!("{} is not a file", self.path)));
            }
            Ok(found) => found.len(),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Some(Fault::Missing(format!("{} is missing", self.path)));
            }
            Err(error) => return Some(Fault::Changed(format!("cannot access {}: {error}", self.path))),
        };
        if size != self.size_bytes {
            return Some(Fault::Changed(format!(
                "{} has {size} bytes instead of {}",
                self.path, self.size_bytes
            )));
        }
        if check == Check::Sizes {
            return None;
        }
        match sum(&path) {
            Ok((_, found)) if found == self.blake3 => None,
            Ok(_) => Some(Fault::Changed(format!("{} differs from its checksum", self.path))),
            Err(error) => Some(Fault::Changed(format!("cannot read {}: {error}", self.path))),
        }
    }
}

/// Puts a receipt in place of `path`.
///
/// # Errors
/// As [`commit_bytes`].
pub fn write_receipt(path: &Path, receipt: &Receipt) -> Result<(), StoreError> {
    const ACTION: &str = "write the receipt";
    let text = serde_json::to_string_pretty(receipt).map_err(|error| StoreError::new(ACTION, path, error))?;
    let body = text.trim_end_matches("\n}");
    let seal = blake3::hash(body.as_bytes()).to_hex();
    commit_bytes(ACTION, path, format!("{body}{SEAL}{seal}\"\n}}\n").as_bytes()).map(drop)
}

/// Reads a receipt; one that is not as it was written is none.
#[must_use]
pub fn read_receipt(path: &Path) -> Found {
    let bytes = match std::fs::metadata(path).map(|found| found.is_file() && found.len() <= MOST_BYTES) {
        Ok(true) => std::fs::read(path),
        Ok(false) => return Found::Damaged("not a file, or too long for a provenance record".to_owned()),
        Err(error) => Err(error),
    };
    let text = match bytes {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Found::Nothing,
        Err(error) => return Found::Damaged(error.to_string()),
    };
    match parse(&text).and_then(|receipt| fits(receipt, path)) {
        Ok(receipt) => Found::Whole(Box::new(receipt)),
        Err(why) => Found::Damaged(why),
    }
}

/// A receipt that is where it belongs, and names files of its folder only.
fn fits(receipt: Receipt, path: &Path) -> Result<Receipt, String> {
    if path.file_stem().is_none_or(|stem| stem != receipt.id.as_str()) {
        return Err(format!("provenance record of another task, {:?}", receipt.id));
    }
    let folder = path.parent().and_then(Path::file_name);
    if receipt.stage != "spec" && folder.is_none_or(|folder| folder != receipt.stage.as_str()) {
        return Err(format!("provenance record of another stage, {:?}", receipt.stage));
    }
    let inside = |path: &str| {
        !path.is_empty() && Path::new(path).components().all(|part| matches!(part, Component::Normal(_)))
    };
    match receipt.files.iter().find(|file| !inside(&file.path)) {
        _ if receipt.files.is_empty() => Err("no file in the provenance record".to_owned()),
        Some(strange) => Err(format!("{:?} is not a file of the directory", strange.path)),
        None => Ok(receipt),
    }
}

fn parse(bytes: &[u8]) -> Result<Receipt, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| error.to_string())?;
    let (body, rest) = text.rsplit_once(SEAL).ok_or("no checksum of the provenance record")?;
    if rest != format!("{}\"\n}}\n", blake3::hash(body.as_bytes()).to_hex()) {
        return Err("wrong checksum of the provenance record".to_owned());
    }
    let receipt: Receipt = serde_json::from_str(&format!("{body}}}")).map_err(|error| error.to_string())?;
    if receipt.receipt == RECEIPT_VERSION {
        Ok(receipt)
    } else {
        Err(format!(
            "version {} of the provenance record; this program reads version {RECEIPT_VERSION}",
            receipt.receipt
        ))
    }
}
