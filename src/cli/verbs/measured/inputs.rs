//! Files of `import`: scans, and the measurements of containers, which are unpacked into a temporary folder.

use super::super::{Fault, failed};
use super::{ImportArguments, params};
use crate::formats::{Format, Found, recognize};
use crate::lengths::metres;
use crate::model::MeasuredSurface;
use crate::store::container::{Container, Member};
use crate::store::scan::is_line_scan;
use crate::text::shown;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A scan to be read.
pub(super) struct Input {
    /// Its name in messages.
    pub(super) label: String,
    /// Name of the file of its surface, without ending.
    pub(super) stem: String,
    /// Its file.
    pub(super) path: PathBuf,
    pub(super) params: MeasuredSurface,
    /// Parameters with size and unit of the metadata of a container, if they state these.
    pub(super) stated: Option<MeasuredSurface>,
}

/// A scan that is not imported.
pub(super) struct Left {
    /// Its name in messages.
    pub(super) label: String,
    pub(super) why: String,
    /// True if it could not be read; false for a line scan and for a copy.
    pub(super) is_failure: bool,
}

/// Scans to be read, scans that are left out, and notes on containers.
pub(super) type Inputs = (Vec<Input>, Vec<Left>, Vec<String>);

const LINE: &str = "line scan: left out, since a contact needs an area";

/// Scans of all files, scans that are left out, and notes on containers.
pub(super) fn inputs(asked: &ImportArguments, work: &TempDir) -> Result<Inputs, Fault> {
    let (mut found, mut left, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    for file in &asked.files {
        let mut fails = |why: String| left.push(Left { label: shown(file), why, is_failure: true });
        match Container::open(file) {
            Err(error) => fails(error.source.to_string()),
            Ok(Some(container)) => {
                let archive = shown(file);
                notes.extend(container.notes.iter().map(|note| format!("{archive}: {note}")));
                container.lost.iter().for_each(|why| fails(why.clone()));
                for member in &container.members {
                    match unpacked(asked, &archive, &container, member, work) {
                        Ok(input) => found.push(input),
                        Err(why) => left.push(why),
                    }
                }
            }
            Ok(None) => match recognize(file) {
                Err(error) => fails(reason(&error)),
                Ok(Err(refusal)) => fails(refusal.to_string()),
                Ok(Ok(Found::Scan(Format::NetCdf3))) if is_line_scan(file) => {
                    left.push(Left { label: shown(file), why: LINE.to_owned(), is_failure: false });
                }
                Ok(Ok(_)) => found.push(Input {
                    label: shown(file),
                    stem: file.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
                    path: file.clone(),
                    params: params(asked, file)?,
                    stated: None,
                }),
            },
        }
    }
    Ok((found, left, notes))
}

/// The reason of an error of the system, with help.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file\nhelp: check the path".to_owned(),
        _ => format!("{error}\nhelp: check the path and the permissions of the file"),
    }
}

/// The error of a file that is missing or cannot be read.
pub(super) fn unreadable(file: &Path, error: &io::Error) -> Fault {
    failed(format!("cannot read {}: {}", shown(file), reason(error)))
}

/// A measurement of a container as a file.
fn unpacked(
    asked: &ImportArguments,
    archive: &str,
    container: &Container,
    member: &Member,
    work: &TempDir,
) -> Result<Input, Left> {
    let label = format!("{archive}: {}", member.name);
    let is_line = member.size.len() == 1;
    let left = |why: String, is_failure: bool| Left { label: label.clone(), why, is_failure };
    if is_line {
        return Err(left(LINE.to_owned(), false));
    }
    if let Some(scale) = member.height_scale {
        let why = format!(
            "its heights need the factor {scale}\nhelp: unpack it and import the file with --unit, or export \
             it as NetCDF"
        );
        return Err(left(why, true));
    }
    // Files of one name in different folders of the archive.
    let folder =
        tempfile::tempdir_in(work).map(TempDir::keep).map_err(|error| left(error.to_string(), true))?;
    let path = container.extract(member, &folder).map_err(|error| left(error.source.to_string(), true))?;
    match recognize(&path) {
        Err(error) => return Err(left(error.to_string(), true)),
        Ok(Err(refusal)) => {
            return Err(left(refusal.to_string().replace(&shown(&path), &label), true));
        }
        Ok(Ok(Found::Scan(Format::NetCdf3))) if is_line_scan(&path) => {
            return Err(left(LINE.to_owned(), false));
        }
        Ok(Ok(_)) => {}
    }
    let given = params(asked, &path).map_err(|fault| left(fault.text, true))?;
    let params = MeasuredSurface { periodic: given.periodic || member.is_periodic, ..given };
    let stem = Path::new(&member.name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Input { label, stem, path, stated: stated(&params, member), params })
}

/// Parameters with size and unit of the metadata, where the command line does not state them.
fn stated(params: &MeasuredSurface, member: &Member) -> Option<MeasuredSurface> {
    let (unit, [x, y]) = (member.unit.as_ref()?, <[f64; 2]>::try_from(member.size.as_slice()).ok()?);
    let factor = metres(unit)?;
    let is_free = params.pixel_m == 0.0 && params.size_m == 0.0;
    let [size_m, size_y_m] =
        if is_free { [x * factor, y * factor] } else { [params.size_m, params.size_y_m] };
    let unit = if params.unit.is_empty() { unit.clone() } else { params.unit.clone() };
    Some(MeasuredSurface { size_m, size_y_m, unit, ..params.clone() })
}

/// True if the files are more than one scan.
pub(super) fn are_several(files: &[PathBuf]) -> Result<bool, Fault> {
    match files {
        [file] => Container::open(file).map(|of| of.is_some()).map_err(failed),
        _ => Ok(true),
    }
}
