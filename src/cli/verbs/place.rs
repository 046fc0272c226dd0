//! Specs and output folders: either may be given where the other is expected.

use super::{BAD_SPEC, Fault, failed};
use crate::campaign::{Campaign, with_recorded_files};
use crate::cli::{FolderArguments, OutputArguments};
use crate::spec::{ScanReader, Spec};
use crate::stages;
use crate::text::{shell_path, shown};
use std::path::{Path, PathBuf};

/// The resolved spec in an output folder.
const RESOLVED: &str = "campaign.toml";

/// The spec that a path names: itself, or the resolved spec of an output folder.
pub(super) fn spec_file(spec: &Path) -> PathBuf {
    if spec.is_dir() { spec.join(RESOLVED) } else { spec.to_owned() }
}

/// The campaign of a spec in its output folder. An output folder stands for its resolved spec.
pub(super) fn open(spec: &Path, output: &OutputArguments) -> Result<Campaign, Fault> {
    let resolved = spec_file(spec);
    if !spec.is_dir() {
        return read(spec, output.out.as_deref(), &output.set);
    }
    if !resolved.is_file() {
        let dir = shown(spec);
        return Err(Fault {
            code: BAD_SPEC,
            ..failed(format!("{dir} has no {RESOLVED}\nhelp: name a spec, or the output folder of a run"))
        });
    }
    read(&resolved, Some(output.out.as_deref().unwrap_or(spec)), &output.set)
}

fn read(spec: &Path, out: Option<&Path>, settings: &[String]) -> Result<Campaign, Fault> {
    let is_resolved = spec.file_name().is_some_and(|name| name == RESOLVED);
    let folder = spec.parent().map(Path::to_owned).filter(|_| is_resolved);
    let spec = parsed(spec, settings)?;
    let spec = match folder {
        Some(folder) => with_recorded_files(spec, &folder),
        None => spec,
    };
    let dir = out.map_or_else(|| usual(&spec), Path::to_owned);
    not_the_root(&dir)?;
    stages::sampled(Campaign::new(spec, dir)).map_err(failed)
}

fn parsed(spec: &Path, settings: &[String]) -> Result<Spec, Fault> {
    let reader = ScanReader { method: &stages::chosen_method, side_m: &stages::scan_side_m };
    Spec::read_choosing(spec, settings, &reader)
        .map_err(|errors| Fault { code: BAD_SPEC, text: errors.to_string() })
}

/// The output folder of a spec without --out.
fn usual(spec: &Spec) -> PathBuf {
    PathBuf::from("data/runs").join(&spec.name)
}

/// The output folder that a command is given: itself, or a spec and its folder.
pub(super) fn folder(asked: &FolderArguments) -> Result<PathBuf, Fault> {
    if asked.out.is_some() && asked.dir.is_dir() {
        let text = format!(
            "error: {} is a folder, and --out names another one\nhelp: name one of the two",
            shown(&asked.dir)
        );
        return Err(Fault { code: BAD_SPEC, text });
    }
    match &asked.out {
        Some(out) => Ok(out.clone()),
        None => folder_of(&asked.dir),
    }
}

/// An output folder, or that of a spec.
pub(super) fn folder_of(given: &Path) -> Result<PathBuf, Fault> {
    if given.is_file() { parsed(given, &[]).map(|spec| usual(&spec)) } else { Ok(given.to_owned()) }
}

/// The campaign whose results a folder holds.
pub(super) fn open_dir(action: &str, dir: &Path) -> Result<Campaign, Fault> {
    let path = dir.join(RESOLVED);
    if !path.is_file() {
        let shown = shown(dir);
        return Err(failed(format!(
            "cannot {action} {shown}: it has no {RESOLVED}\nhelp: name the output folder of a run, or a spec \
             that was run"
        )));
    }
    read(&path, Some(dir), &[])
}

/// Refuses the root folder as an output folder.
pub(super) fn not_the_root(dir: &Path) -> Result<(), Fault> {
    match dir.canonicalize() {
        Ok(found) if found.parent().is_none() => {
            let text = format!(
                "error: the output folder cannot be {}, the root folder\nhelp: name another folder (--out \
                 DIR)",
                shown(dir)
            );
            Err(Fault { code: BAD_SPEC, text })
        }
        _ => Ok(()),
    }
}

/// The absolute path of a file or folder for scripts of other programs, which read it as text.
pub(super) fn script_path(dir: &Path) -> Result<PathBuf, Fault> {
    let refused = |why: String| failed(format!("cannot write the path {} into scripts: {why}", shown(dir)));
    let dir = std::path::absolute(dir).map_err(|error| refused(error.to_string()))?;
    let strange = |c: char| c.is_control() || matches!(c, '{' | '}' | '%' | '"' | '\\');
    match dir.to_str().map(|name| name.chars().find(|c| strange(*c))) {
        Some(None) => Ok(dir),
        Some(Some(c)) => Err(refused(format!(
            "its name has {c:?}\nhelp: use a path without control characters and without {{ }} % \" \\"
        ))),
        None => Err(refused("its name is not Unicode\nhelp: use a path with a Unicode name".to_owned())),
    }
}

/// The command that continues a campaign.
pub(super) fn resuming(dir: &Path) -> String {
    format!("hysteron run {}", shell_path(dir))
}
