//! Zip archives with several measurements: containers of contact.engineering and of SurfaceTopography, and
//! archives of files of scans.
//!
//! The metadata of a container are in `index.json`. Of an archive that has `meta.yml` alone, the names of the
//! parts are read. NetCDF-3 files with the processed heights are preferred to the files of the instrument.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};

use serde_json::Value;
use zip::ZipArchive;

use super::error::{Cause, StoreError, fenced};
use crate::formats::{is_of_container, is_regular};

/// Metadata of a container.
const INDEX: &str = "index.json";
/// Metadata of containers of earlier versions.
const EARLIER_INDEX: &str = "meta.yml";
/// Bytes from which the first part is recognised.
const FIRST: u64 = 512;
/// Bytes that the metadata may have.
const MOST_INDEX: u64 = 1 << 26;
/// Parts that an archive may have.
const MOST_PARTS: usize = 10_000;
/// Bytes that a measurement may have.
const MOST_BYTES: u64 = 1 << 32;
/// Compression ratio of deflate on zeros: a larger part is damaged.
const MOST_PACKED: u64 = 1100;
/// Endings of files of scans in an archive without metadata.
const ENDINGS: [&str; 10] = ["nc", "x3p", "h5", "hdf5", "npy", "txt", "csv", "asc", "dat", "xyz"];

/// A measurement of a container.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Its name in the metadata, or that of its file.
    pub name: String,
    /// Path of its file in the archive.
    pub part: String,
    /// Sizes in its unit of length; empty if the metadata do not state them.
    pub size: Vec<f64>,
    /// Unit of its lengths, if it is stated.
    pub unit: Option<String>,
    /// True if it is stated to be periodic.
    pub is_periodic: bool,
    /// Factor of the heights of a file of the instrument, if one is stated.
    pub height_scale: Option<f64>,
}

/// A container.
#[derive(Debug, Clone, PartialEq)]
pub struct Container {
    path: PathBuf,
    /// Its measurements, in their order.
    pub members: Vec<Member>,
    /// Sentences on how it was read.
    pub notes: Vec<String>,
    /// Measurements of the metadata whose files are missing.
    pub lost: Vec<String>,
}

impl Container {
    /// Reads the list of a zip archive with several measurements. Nothing for another file: one X3P scan and
    /// a NumPy archive are zip archives too. Nothing either for a file that is missing or cannot be opened:
    /// [`recognize`](crate::formats::recognize) has the reason.
    ///
    /// # Errors
    /// If the file cannot be read, or the archive or its metadata are damaged.
    pub fn open(path: &Path) -> Result<Option<Self>, StoreError> {
        fenced(|| Self::read(path)).map_err(|cause| refused(path, cause))
    }

    fn read(path: &Path) -> Result<Option<Self>, Cause> {
        if !is_regular(path).unwrap_or_default() {
            return Ok(None);
        }
        let Ok(file) = File::open(path) else { return Ok(None) };
        let mut first = Vec::new();
        file.take(FIRST).read_to_end(&mut first)?;
        if !first.starts_with(b"PK\x03\x04") {
            return Ok(None);
        }
        let damaged = |error: zip::result::ZipError| -> Cause {
            format!("damaged zip archive: {error}\nhelp: download or copy the file again").into()
        };
        let mut archive = match ZipArchive::new(BufReader::new(File::open(path)?)) {
            Ok(archive) => archive,
            // The reader of X3P reports a damaged scan.
            Err(error) => return if begins_container(&first) { Err(damaged(error)) } else { Ok(None) },
        };
        if archive.len() > MOST_PARTS {
            return Err(
                format!("the archive has {} parts, at most {MOST_PARTS} are read", archive.len()).into()
            );
        }
        let names: Vec<String> = archive
            .file_names()
            .map(|name| name.map(|name| name.into_owned()).map_err(damaged))
            .collect::<Result<_, _>>()?;
        let has = |wanted: &str| names.iter().any(|name| name == wanted);
        if has(INDEX) {
            let text = contents(&mut archive, INDEX, MOST_INDEX)?;
            return Ok(Some(Self { path: path.to_owned(), ..of_index(&text, &names)? }));
        }
        let is_x3p = names.iter().any(|name| name.rsplit('/').next() == Some("main.xml"));
        let members: Vec<Member> = names.iter().filter(|name| is_scan(name)).map(|name| bare(name)).collect();
        let is_npz = !names.is_empty() && names.iter().all(|name| name.ends_with(".npy"));
        if has(EARLIER_INDEX) {
            let note = format!("{EARLIER_INDEX} is not read: sizes and units are those of the files");
            return Ok(Some(Self { path: path.to_owned(), members, notes: vec![note], lost: Vec::new() }));
        }
        let is_other = is_x3p || is_npz || members.is_empty();
        Ok((!is_other).then(|| Self { path: path.to_owned(), members, notes: Vec::new(), lost: Vec::new() }))
    }

    /// Writes the file of a measurement into a folder, and gives its path.
    ///
    /// # Errors
    /// If the part is missing, damaged or too large, or the file cannot be written.
    pub fn extract(&self, member: &Member, folder: &Path) -> Result<PathBuf, StoreError> {
        let write = || {
            let mut archive = ZipArchive::new(BufReader::new(File::open(&self.path)?))?;
            let mut part = archive
                .by_name(&member.part)
                .map_err(|error| format!("{:?} cannot be read: {error}", member.part))?;
            let (size, packed) = (part.size(), part.compressed_size());
            if size > MOST_BYTES || size > packed.saturating_mul(MOST_PACKED) {
                return Err(format!("{:?} claims {size} bytes", member.part).into());
            }
            let path = folder.join(file_name(&member.part));
            let mut file = File::create(&path)?;
            std::io::copy(&mut (&mut part).take(MOST_BYTES), &mut file)
                .map_err(|error| format!("{:?} is damaged: {error}", member.part))?;
            file.flush()?;
            Ok(path)
        };
        fenced(write).map_err(|cause| refused(&self.path, cause))
    }
}

/// The error of a container, with help.
fn refused(path: &Path, cause: Cause) -> StoreError {
    let why = cause.to_string();
    let help = "download or export the container again, or unpack it and import its files";
    let cause = if why.contains("\nhelp: ") { cause } else { format!("{why}\nhelp: {help}").into() };
    StoreError::new("read the container", path, cause)
}

/// True if the first part of an archive is one of a container: its name begins at byte 30.
fn begins_container(first: &[u8]) -> bool {
    let length = first.get(26).copied().map_or(0, usize::from);
    first.get(30..30 + length).is_some_and(is_of_container)
}

/// Name of a file without its folders.
fn file_name(part: &str) -> String {
    let name = part.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = |c: char| if c.is_control() || matches!(c, ':' | '\\') { '_' } else { c };
    let name: String = name.chars().map(plain).take(200).collect();
    if matches!(name.as_str(), "" | "." | "..") { "scan".to_owned() } else { name }
}

/// True for a part that may be a scan, by its ending.
fn is_scan(name: &str) -> bool {
    let file = name.rsplit('/').next().unwrap_or_default();
    let is_about = ["readme", "license", "."].iter().any(|start| file.to_lowercase().starts_with(start));
    let ending = file.rsplit_once('.').map(|(_, ending)| ending.to_lowercase());
    !is_about
        && !name.starts_with("__MACOSX/")
        && ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()))
}

/// A measurement of which the archive states the name alone.
fn bare(part: &str) -> Member {
    Member {
        name: file_name(part),
        part: part.to_owned(),
        size: Vec::new(),
        unit: None,
        is_periodic: false,
        height_scale: None,
    }
}

/// The contents of a part of at most `most` bytes as text.
fn contents(archive: &mut ZipArchive<BufReader<File>>, name: &str, most: u64) -> Result<String, Cause> {
    let part = archive.by_name(name).map_err(|error| format!("{name} cannot be read: {error}"))?;
    let mut bytes = Vec::new();
    part.take(most + 1).read_to_end(&mut bytes).map_err(|error| format!("{name} is damaged: {error}"))?;
    if bytes.len() as u64 > most {
        return Err(format!("{name} has more than {most} bytes").into());
    }
    String::from_utf8(bytes).map_err(|_| format!("{name} is not in UTF-8").into())
}

/// A container with these metadata.
fn of_index(text: &str, names: &[String]) -> Result<Container, Cause> {
    let index: Value = serde_json::from_str(text).map_err(|error| format!("{INDEX} is damaged: {error}"))?;
    let Some(surfaces) = index["surfaces"].as_array() else {
        return Err(format!("{INDEX} has no list of surfaces").into());
    };
    let (mut members, mut notes, mut lost) = (Vec::new(), Vec::new(), Vec::new());
    for surface in surfaces {
        for measurement in surface["topographies"].as_array().into_iter().flatten() {
            match member(measurement, names) {
                Ok(found) => members.push(found),
                Err(why) => lost.push(why),
            }
        }
    }
    if surfaces.len() > 1 {
        notes.push(format!("{} surfaces: their measurements are taken together", surfaces.len()));
    }
    let mut known: HashMap<&str, usize> = HashMap::new();
    members.iter().for_each(|of| *known.entry(of.part.as_str()).or_default() += 1);
    match known.into_iter().find(|(_, count)| *count > 1) {
        Some((part, _)) => Err(format!("{INDEX} names {part:?} twice").into()),
        None => Ok(Container { path: PathBuf::new(), members, notes, lost }),
    }
}

/// A measurement of the metadata, or what is missing.
fn member(of: &Value, names: &[String]) -> Result<Member, String> {
    let word = |value: &Value| value.as_str().filter(|text| !text.is_empty()).map(ToOwned::to_owned);
    let files = ["squeezed-netcdf", "original"].map(|key| word(&of["datafile"][key]));
    let is_there = |part: &&String| names.contains(*part);
    let part = files.iter().flatten().find(is_there).cloned();
    let name = word(&of["name"]);
    let Some(part) = part else {
        let name = name.unwrap_or_else(|| "a measurement".to_owned());
        let help = "export the container again with its data files";
        return Err(format!("{name:?} has no data file in the archive\nhelp: {help}"));
    };
    let is_processed = files[0].as_ref() == Some(&part);
    let sizes = of["size"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    Ok(Member {
        name: name.unwrap_or_else(|| file_name(&part)),
        size: sizes,
        unit: word(&of["unit"]),
        is_periodic: of["is_periodic"].as_bool().unwrap_or_default(),
        height_scale: of["height_scale"].as_f64().filter(|scale| !is_processed && *scale != 1.0),
        part,
    })
}
