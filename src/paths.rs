//! Paths that do not depend on the working directory.

use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};

/// The absolute path of a file, without links in its folders and without `.` and `..`. The name of the file
/// remains, also if it is a link.
#[must_use]
pub fn whole(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let Some(name) = path.file_name() else { return folder(&path) };
    path.parent().map_or_else(|| path.clone(), |parent| folder(parent).join(name))
}

/// The absolute path of a folder without links; of one that does not exist as far as it exists.
fn folder(path: &Path) -> PathBuf {
    let mut missing: Vec<OsString> = Vec::new();
    let mut present = path.to_owned();
    loop {
        if let Ok(found) = present.canonicalize() {
            return without_detours(&missing.iter().rev().fold(found, |path, part| path.join(part)));
        }
        let last = present.components().next_back().map(|part| part.as_os_str().to_owned());
        match (last, present.parent().map(Path::to_owned)) {
            (Some(last), Some(parent)) => {
                missing.push(last);
                present = parent;
            }
            _ => return without_detours(path),
        }
    }
}

/// A path without `.` and `..`, by its text alone.
fn without_detours(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

/// The way from a folder to a file; the absolute path of the file if no relative one leads there (another
/// drive).
#[must_use]
pub fn relative(file: &Path, folder: &Path) -> PathBuf {
    let (file, folder) =
        (whole(file), self::folder(&std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned())));
    let shared = file.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return file;
    }
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(file.components().skip(shared)).collect()
}
