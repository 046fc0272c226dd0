//! The files of measured surfaces: what a spec knows of their contents.
//!
//! Units are keyed by what a file holds and not by its name. A spec that was resolved has the hashes in its table `[files]`, so that a finished run tells how it stands
//! without the files; where they are not written, the files are read.

use std::collections::{BTreeMap, HashSet};
use std::ops::Range;
use std::path::Path;

use toml::de::DeValue;

use super::fault::Faults;
use super::value::{Written, wrong_type};
use super::walk::{entries, shown};
use super::{Case, Spec, SpecErrors};
use crate::keys::digest_of_file;

/// Reads the table `[files]`.
pub(super) fn files(written: &Written<'_>, span: &Range<usize>, faults: &mut Faults<'_>) -> BTreeMap<String, (String, Range<usize>)> {
    let mut found = BTreeMap::new();
    let DeValue::Table(table) = written.get_ref() else {
        wrong_type("files", "a table", written.get_ref(), span, "write [files] on a line of its own".to_owned(), faults);
        return found;
    };
    for (name, span, value) in entries(table) {
        match value.get_ref() {
            DeValue::String(digest) if digest.len() == 64 && digest.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f')) => {
                found.insert(name.to_owned(), (digest.to_string(), span));
            }
            _ => {
                let help = "64 hexadecimal digits, as `b3sum` tells them; leave the line out, and the file is read".to_owned();
                faults.add(&span, "an entry of [files] must be the BLAKE3 of a file".to_owned(), help);
            }
        }
    }
    found
}

/// Refuses the hash of a file that no case names, and gives the others.
pub(super) fn named(files: BTreeMap<String, (String, Range<usize>)>, cases: &[Case], faults: &mut Faults<'_>) -> BTreeMap<String, String> {
    let wanted: HashSet<&str> = cases.iter().map(|case| case.params.surface.file.as_str()).collect();
    for (name, (_, span)) in files.iter().filter(|(name, _)| !wanted.contains(name.as_str())) {
        let message = format!("[files] has the hash of \"{}\", which no case reads", shown(name));
        faults.add(span, message, "remove the line, or name the file as surface.file exactly as it is written here".to_owned());
    }
    files.into_iter().map(|(name, (digest, _))| (name, digest)).collect()
}

/// The spec with the hashes of all files that it names, and of no others.
pub(super) fn digested(mut spec: Spec, text: &str, file: &str) -> Result<Spec, SpecErrors> {
    let known = std::mem::take(&mut spec.files);
    let mut faults = Faults::new(text, file);
    for case in &spec.cases {
        let name = &case.params.surface.file;
        if name.is_empty() || spec.files.contains_key(name) {
            continue;
        }
        let digest = known.get(name).cloned().map_or_else(|| digest_of_file(Path::new(name)), Ok);
        match digest {
            Ok(digest) => {
                spec.files.insert(name.clone(), digest);
            }
            Err(why) => {
                let at = if faults.is_full() { 0 } else { text.find(name.as_str()).unwrap_or_default() };
                let help = match std::env::current_dir() {
                    Ok(here) if Path::new(name).is_relative() => {
                        format!("it was looked for from {}, where the command is run", here.display())
                    }
                    _ => "a file in a format that `hysteron import` reads is wanted".to_owned(),
                };
                let message = format!("the measured surface \"{name}\" cannot be read: {why}");
                faults.add(&(at..at + name.len().min(text.len() - at)), message, help);
            }
        }
    }
    faults.finish(Some(spec))
}
